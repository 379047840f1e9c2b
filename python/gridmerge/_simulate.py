# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _arguments, _core
from ._arguments import Progress
from ._grid import OccupancyGrid
from ._repr import count, short_pose
from ._transform import Transform

BUILDING_KINDS: tuple[str, ...] = tuple(_core.building_kinds())
"""The kinds of buildings that simulate() knows."""


@dataclass(frozen=True, slots=True)
class SimulatedMap:
    """The map that one robot brought home."""

    grid: OccupancyGrid
    """In a frame of its own, with probabilities."""
    transform: Transform
    """T_building_map: lays the map best on the building (least squares over what was drawn)."""
    bend: float
    """Root mean square error that is left then [m]."""
    path: NDArray[np.float64] = field(repr=False, compare=False)
    """Where it scanned: true poses (x, y, theta) in the building's frame [m, rad], of shape (scans, 3)."""
    earlier: tuple[OccupancyGrid, ...] = field(default=(), repr=False, compare=False)
    """As it was at the moments that `steps` of simulate() asks for, except for the last one, which is `grid`."""

    def __repr__(self) -> str:
        return (
            f"SimulatedMap({self.grid.width} x {self.grid.height} cells, transform={short_pose(self.transform)}, "
            f"bend={self.bend:.3f})"
        )


@dataclass(frozen=True, slots=True)
class SimulatedPair:
    """Two maps that share a place."""

    fixed: int
    """Index of the map."""
    moving: int
    """Index of the map."""
    transform: Transform
    """T_fixed_moving: lays the moving map best on the fixed one, over the places that both drew."""
    tolerance: float
    """Largest root mean square displacement of a correct estimate [m]."""
    overlap: float
    """Share of the smaller map's area that both have drawn."""
    tier: str
    """How hard the pair is: "A", "B" or "C", by the walls that both have."""
    shared_wall: float
    """Walls of the moving map where the fixed one knows something: occupied cells times their side [m]."""

    def __repr__(self) -> str:
        return (
            f"SimulatedPair({self.fixed}, {self.moving}, tier={self.tier!r}, transform={short_pose(self.transform)}, "
            f"overlap={self.overlap:.2f})"
        )


@dataclass(frozen=True, slots=True)
class Simulation:
    """An invented building, and what robots made of it."""

    building: OccupancyGrid
    """The building itself, in its own frame."""
    maps: tuple[SimulatedMap, ...]
    """The robots' maps, in their order."""
    pairs: tuple[SimulatedPair, ...]
    """Maps that share a place; pairs that hardly share any are neither here nor among the strangers."""
    strangers: tuple[tuple[int, int], ...]
    """Indices of maps that have no place in common."""
    elsewhere: tuple[SimulatedMap, ...]
    """Maps of other buildings."""
    overlap: float
    """What simulate() was asked for, as it came out."""
    _core: _core.Dataset = field(repr=False, compare=False)

    def __repr__(self) -> str:
        return (
            f"Simulation({count(len(self.maps), 'map')} of a building of {self.building.width} x "
            f"{self.building.height} cells, {count(len(self.pairs), 'pair')}, "
            f"{count(len(self.strangers), 'pair')} of strangers, {len(self.elsewhere)} elsewhere)"
        )

    def __reduce__(self) -> tuple[Any, ...]:
        return _unpickle, (self._core.state(),)

    def save(self, directory: str | os.PathLike[str], *, probabilities: bool = False) -> None:
        """Writes the files that `gridmerge simulate` writes: robot_1.yaml and so on, elsewhere_1.yaml and so on,
        building.yaml, and the truth as evaluate() reads it: pairs.tsv, negatives.tsv and sets.tsv, and building.tsv
        of the robots' maps on building.yaml.

        With `probabilities` the maps are written in mode raw. simulation.sha256 lists all files. What an earlier
        dataset has left there is replaced, or removed where this one has no such file. Raises FileError when files
        cannot be written, or would take the place of others: all stays as it was then.
        """
        self._core.save(_arguments.path("directory", directory), bool(probabilities))


def simulate(
    kind: str = "office",
    *,
    size: tuple[float, float] = (40.0, 25.0),
    robots: int = 2,
    overlap: float | None = None,
    starts: Sequence[tuple[float, float]] | None = None,
    headings: Sequence[float] | None = None,
    longest_way: float = 0.0,
    steps: int = 1,
    clutter: float = 1.0,
    others: int = 1,
    drift: float = 0.3,
    resolution: float = 0.05,
    range: float = 8.0,
    field_of_view: float = math.radians(270.0),
    angular_step: float = math.radians(0.5),
    noise: float = 0.02,
    stray: float = 0.002,
    missed: float = 0.02,
    tidy: float | None = None,
    seed: int = 1,
    threads: int = 0,
    progress: Progress | None = None,
) -> Simulation:
    """Invents a building, sends robots through it, and draws the map that each would bring home, with the truth.

    Args:
        kind: of building, one of BUILDING_KINDS.
        size: of the building: width and height [m].
        robots: how many.
        overlap: wanted overlap of each robot with the one that it shares most with, on average; None lets every
            robot go wherever it can.
        starts: where the robots start, (x, y) [m] in the building, one for each; None spreads them.
        headings: which way the robots set off [rad], one for each; a robot goes only to places ahead of its start. None
            lets them go anywhere.
        longest_way: after which a robot stops [m]; 0 = when it has seen all.
        steps: keep each robot's map at so many moments, after equal parts of its way.
        clutter: how much stands and walks about that differs from robot to robot.
        others: how many maps of other buildings to add.
        drift: how much maps bend: 0 not at all, 1 as hand-held mapping does.
        resolution: of the maps [m/cell].
        range, field_of_view, angular_step, noise: of the range finder [m, rad, rad, m].
        stray, missed: shares of beams that end too early, or come back with nothing.
        tidy: without specks, and with walls so much thicker on each side [m]; None = as the range finder left them.
        seed: the same seed gives the same maps on the same machine.
        threads: 0 = one per core. The result does not depend on it.
        progress: called now and then, in the calling thread, with the share of the work that is done.

    Other Python threads run meanwhile, and Ctrl-C ends the work. Raises TypeError, or ValueError for what cannot be
    had.
    """
    options = _core.SimulateOptions()
    options.set_kind(_arguments.choice("kind", kind, BUILDING_KINDS))
    options.width, options.height = _two_numbers("size", size)
    options.robots = _arguments.whole("robots", robots, 1, 1000)
    options.overlap = None if overlap is None else _arguments.share("overlap", overlap)
    for start in _checked_starts(starts):
        options.add_start(*start)
    for heading in _checked_headings(headings):
        options.add_heading(heading)
    options.longest_way = _arguments.not_negative("longest_way", longest_way)
    options.steps = _arguments.whole("steps", steps, 1, 1000)
    options.clutter = _arguments.not_negative("clutter", clutter)
    options.drift = _arguments.not_negative("drift", drift)
    options.resolution = _arguments.number("resolution", resolution)
    sensor = options.sensor
    sensor.range = _arguments.number("range", range)
    sensor.field_of_view = _arguments.number("field_of_view", field_of_view)
    sensor.angular_step = _arguments.number("angular_step", angular_step)
    sensor.noise = _arguments.not_negative("noise", noise)
    sensor.stray_share = _arguments.share("stray", stray)
    sensor.missed_share = _arguments.share("missed", missed)
    options.sensor = sensor
    options.tidy = None if tidy is None else _arguments.not_negative("tidy", tidy)
    options.seed = _arguments.whole("seed", seed, 0, 2**64 - 1)
    options.threads = _arguments.threads(threads)
    return _to_simulation(
        _core.simulate(options, _arguments.whole("others", others, 0, 1000), _arguments.progress(progress))
    )


def _checked_starts(starts: object) -> list[tuple[float, float]]:
    if starts is None:
        return []
    points = _arguments.several("starts", starts, "a sequence of points")
    return [_two_numbers(f"starts[{i}]", start) for i, start in enumerate(points)]


def _checked_headings(headings: object) -> list[float]:
    if headings is None:
        return []
    angles = _arguments.several("headings", headings, "a sequence of angles")
    return [_arguments.number(f"headings[{i}]", heading) for i, heading in enumerate(angles)]


def _two_numbers(name: str, values: object) -> tuple[float, float]:
    numbers = _arguments.several(name, values, "two numbers")
    if len(numbers) != 2:
        raise TypeError(f"{name}: must be two numbers, is {values!r}")
    first, second = numbers
    return _arguments.number(name, first), _arguments.number(name, second)


def _unpickle(state: list[bytes]) -> Simulation:
    return _to_simulation(_core.Dataset.from_state(state))


def _to_simulation(dataset: _core.Dataset) -> Simulation:
    return Simulation(
        building=OccupancyGrid._of(dataset.building()),
        maps=tuple(_to_map(one) for one in dataset.maps),
        pairs=tuple(
            SimulatedPair(
                pair.fixed,
                pair.moving,
                Transform(*pair.transform),
                pair.tolerance,
                pair.overlap,
                pair.tier,
                pair.shared_wall,
            )
            for pair in dataset.pairs
        ),
        strangers=tuple(dataset.strangers),
        elsewhere=tuple(_to_map(one) for one in dataset.elsewhere),
        overlap=dataset.overlap,
        _core=dataset,
    )


def _to_map(robot: _core.RobotMap) -> SimulatedMap:
    return SimulatedMap(
        OccupancyGrid._of(robot.grid),
        Transform(*robot.transform),
        robot.bend,
        robot.path(),
        tuple(OccupancyGrid._of(grid) for grid in robot.earlier),
    )
