# SPDX-License-Identifier: Apache-2.0
"""What poses are worth, by the measures of Birk & Carpin (2006) and by the engine."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from . import _arguments, _core
from ._grid import MapLike, OccupancyGrid
from ._inputs import to_map, to_maps
from ._repr import count, probability, short_pose
from ._transform import PoseLike, Transform, to_pose

CellClass: TypeAlias = Literal["occupied", "free", "unknown"]
"""What a map says of a cell."""
DistancePass: TypeAlias = Literal["start", "forward", "backward"]
"""Where distance_map() stops: before its two passes, after the first, or after both."""

_CLASSES: tuple[CellClass, ...] = ("unknown", "free", "occupied")
_PASSES: tuple[DistancePass, ...] = ("start", "forward", "backward")
_NO_DISTANCE = 0xFFFF

_POSE_COLUMNS = (
    *(("x", np.float64), ("y", np.float64), ("theta", np.float64), ("psi", np.float64)),
    *(("agreement", np.int64), ("disagreement", np.int64), ("omega", np.int64)),
    *(("acceptance_index", np.float64), ("undefined_terms", np.int64)),
)


@dataclass(frozen=True, slots=True)
class PsiTerms:
    """The four mean distances that psi adds up [cells]; None where a map has no such cell, which counts as 0."""

    fixed_moving_occupied: float | None
    """From the fixed map's occupied cells to the moving map's nearest one."""
    fixed_moving_free: float | None
    """From the fixed map's free cells to the moving map's nearest one."""
    moving_fixed_occupied: float | None
    """From the moving map's occupied cells to the fixed map's nearest one."""
    moving_fixed_free: float | None
    """From the moving map's free cells to the fixed map's nearest one."""

    def __repr__(self) -> str:
        terms = (
            f"{name}={'None' if value is None else f'{value:.3f}'}"
            for name in self.__slots__
            for value in [getattr(self, name)]
        )
        return f"PsiTerms({', '.join(terms)})"


@dataclass(frozen=True, slots=True)
class CommonCells:
    """The cells known in both maps, by what the maps say of them."""

    occupied_occupied: int
    """Occupied in both maps."""
    free_free: int
    """Free in both maps."""
    contradicting: int
    """Free in the one map and occupied in the other."""


@dataclass(frozen=True, slots=True)
class PoseMeasure:
    """What a pose of two maps is worth. Cells are those of the fixed map's lattice."""

    transform: Transform
    """T_fixed_moving."""
    omega: int
    """Cells of the fixed map that have the same value in both maps, unknown included."""
    cells: int
    """Cells of the fixed map."""
    psi: float
    """The sum of the four mean distances; 0 for equal maps."""
    psi_terms: PsiTerms
    """The four mean distances."""
    agreement: int
    """Cells known in both maps and equal."""
    disagreement: int
    """Cells known in both maps and different."""
    acceptance_index: float
    """agreement / (agreement + disagreement); 0 when nothing is known in common."""
    common: CommonCells
    """Agreement and disagreement by what the maps say."""
    probability: float
    """That the pose is the true one, by the engine."""
    figures: Mapping[str, float]
    """What the engine's model looks at, by name: ``gridmerge evaluate --features`` explains them."""

    def __repr__(self) -> str:
        return (
            f"PoseMeasure(transform={short_pose(self.transform)}, psi={self.psi:.3f}, agreement={self.agreement}, "
            f"disagreement={self.disagreement}, omega={self.omega}, acceptance_index={self.acceptance_index:.4f}, "
            f"{probability(self.probability)})"
        )

    def delta(self, c_lock: float = 0.0) -> float:
        """Delta = psi + c_lock * (disagreement - agreement), which the paper minimises."""
        return self.psi + _arguments.not_negative("c_lock", c_lock) * (self.disagreement - self.agreement)


@dataclass(frozen=True, slots=True)
class JointMeasure:
    """What poses of several maps on one are worth."""

    omega: int
    """Cells of the fixed map at which all maps have the same value, unknown included."""
    cells: int
    """Cells of the fixed map."""
    pairs: tuple[PoseMeasure, ...]
    """Each moving map on the fixed one, in their order."""

    def __repr__(self) -> str:
        return f"JointMeasure(omega={self.omega} of {self.cells} cells, {count(len(self.pairs), 'pair')})"


def measure(fixed: MapLike, moving: MapLike, pose: PoseLike, *, threads: int = 0) -> PoseMeasure:
    """Says what it is worth to lay `moving` on `fixed` at `pose`, T_fixed_moving [m, rad].

    The same as ``gridmerge measure``. Takes about the time of match(). Raises ValueError for a pose that puts the
    maps apart, and as match() does.
    """
    core = _core.measure(
        to_map("fixed", fixed)._core,
        [to_map("moving", moving)._core],
        [to_pose("pose", pose)],
        _arguments.threads(threads),
    )
    return _to_measure(core.pairs[0])


def measure_maps(
    fixed: MapLike, moving: Sequence[MapLike], poses: Sequence[PoseLike], *, threads: int = 0
) -> JointMeasure:
    """The same of several maps on one: `poses` has the T_fixed_moving of each.

    A map may lie on another moving map only. Raises ValueError for one that lies on none.
    """
    grids = to_maps("moving", moving)
    if not grids:
        raise ValueError("moving: holds no map")
    core = _core.measure(
        to_map("fixed", fixed)._core,
        [grid._core for grid in grids],
        _to_poses(poses, len(grids)),
        _arguments.threads(threads),
    )
    return JointMeasure(core.omega, core.cells, tuple(_to_measure(pair) for pair in core.pairs))


def draw_on_lattice(lattice: MapLike, grid: MapLike, pose: PoseLike) -> OccupancyGrid:
    """`grid` at `pose` on the cells of `lattice`, whose size, resolution and origin the result has.

    `pose` takes points of the map's frame to the lattice's [m, rad]. Each cell takes the value of the map's cell in
    which its centre falls; it is unknown where there is none. This is the T(m) of the paper.
    """
    drawn = _core.draw_on_lattice(
        to_map("lattice", lattice)._core,
        to_map("grid", grid)._core,
        to_pose("pose", pose),
    )
    return OccupancyGrid._of(drawn)


def count_equal_cells(lattice: MapLike, maps: Sequence[MapLike], poses: Sequence[PoseLike]) -> int:
    """omega: the cells of `lattice` at which all maps at their poses have the same value, unknown included."""
    grids = to_maps("maps", maps)
    return _core.count_equal_cells(
        to_map("lattice", lattice)._core, [grid._core for grid in grids], _to_poses(poses, len(grids))
    )


def distance_map(
    grid: MapLike, value: CellClass = "occupied", *, after: DistancePass = "backward"
) -> NDArray[np.float32]:
    """The paper's d-map: the Manhattan distance [cells] from each cell to the nearest one of a class.

    float32 of shape (height, width), row 0 at the bottom; infinite where there is none. `after` tells how far the
    algorithm got: "start", after the "forward" pass from the upper left corner, or after the "backward" pass, which
    is all. ValueError for a map whose width and height add up to more than 32000 cells.
    """
    cell_class = _CLASSES.index(_arguments.choice("value", value, _CLASSES))
    which = _PASSES.index(_arguments.choice("after", after, _PASSES))
    given = to_map("grid", grid)
    raw = _core.distance_maps(given._core, cell_class)[which]
    distances = np.frombuffer(raw, dtype=np.uint16).reshape(given.shape)
    return np.where(distances == _NO_DISTANCE, np.float32(np.inf), distances.astype(np.float32))


def measure_poses(
    fixed: MapLike, moving: MapLike, poses: Iterable[PoseLike], *, threads: int = 0
) -> NDArray[np.void]:
    """The paper's measures of many poses of one pair, without the engine's: a landscape.

    A structured array with an element for each pose, and the fields ``x``, ``y``, ``theta``, ``psi``, ``agreement``,
    ``disagreement``, ``omega``, ``acceptance_index`` and ``undefined_terms``: how many of psi's four distances are
    undefined and count as 0. All four are at a pose that puts the maps too far apart to be measured.
    """
    try:
        given = list(poses)
    except TypeError:
        raise TypeError(f"poses: must be several poses, is {_arguments.kind_of(poses)}") from None
    at = [to_pose(f"poses[{i}]", pose) for i, pose in enumerate(given)]
    raw = _core.measure_poses(
        to_map("fixed", fixed)._core, to_map("moving", moving)._core, at, _arguments.threads(threads)
    )
    return to_table(raw, _POSE_COLUMNS)


def poses_between(moving: MapLike, start: PoseLike, end: PoseLike, count: int) -> tuple[Transform, ...]:
    """Evenly spaced poses of `moving` from `start` to `end`, both included, for measure_poses().

    The centre of the map's known rectangle goes straight, and the map turns the shorter way.
    """
    cut = _core.poses_between(
        to_map("moving", moving)._core,
        to_pose("start", start),
        to_pose("end", end),
        _arguments.whole("count", count, 2, 10**6),
    )
    return tuple(Transform(*pose) for pose in cut)


def to_table(raw: bytes, columns: Sequence[tuple[str, Any]]) -> NDArray[np.void]:
    """A structured array of rows of float64."""
    rows = np.frombuffer(raw, dtype=np.float64).reshape(-1, len(columns))
    table = np.empty(len(rows), dtype=list(columns))
    for i, (name, dtype) in enumerate(columns):
        table[name] = rows[:, i].astype(dtype)
    return table


def _to_poses(poses: Sequence[PoseLike], count: int) -> list[tuple[float, float, float]]:
    if isinstance(poses, Transform) or not isinstance(poses, Sequence):
        raise TypeError(f"poses: must be a sequence of poses, is {_arguments.kind_of(poses)}")
    if len(poses) != count:
        raise ValueError(f"poses: there are {len(poses)} for {count} maps")
    return [to_pose(f"poses[{i}]", pose) for i, pose in enumerate(poses)]


def _to_measure(core: _core.PoseMeasure) -> PoseMeasure:
    return PoseMeasure(
        transform=Transform(*core.transform),
        omega=core.omega,
        cells=core.cells,
        psi=core.psi,
        psi_terms=PsiTerms(*core.psi_terms),
        agreement=core.agreement,
        disagreement=core.disagreement,
        acceptance_index=core.acceptance_index,
        common=CommonCells(core.occupied_occupied, core.free_free, core.contradicting),
        probability=core.probability,
        figures=core.figures,
    )
