# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arguments, _core, _html
from ._deformation import Deformation
from ._grid import OccupancyGrid
from ._match import MatchResult, PairPose, Reason, pair_pose, to_match_result
from ._plan import PlanPlacement, to_plan_placement
from ._repr import count, listed, probability, short_pose, shortened
from ._transform import Transform

if TYPE_CHECKING:
    from matplotlib.axes import Axes

JoinOutcome: TypeAlias = Literal["refused", "accepted", "rescued", "rejected", "known"]
"""What became of a comparison of two maps: "rescued" is too weak by itself and agrees with the others, "rejected" would
be believed by itself and contradicts them, "known" lies so because it is known beforehand."""
ExportFormat: TypeAlias = Literal["g2o", "open-rmf", "geojson", "geotiff"]
"""What other programs read of a merge."""


@dataclass(frozen=True, slots=True)
class Member:
    """A map in a component."""

    map: int
    """Index of the input map."""
    name: str
    """Of the map: its file, or the name that merge() was given for it."""
    transform: Transform
    """Takes points of the map's frame to the component's."""
    probability: float | None
    """That the map lies there, with all that the other maps say of it. The tree does not know."""
    sd_position: float | None
    """Standard deviation of the middle of the map's known cells [m]; 0 for what holds the frame, None up the tree."""
    sd_theta: float | None
    """Standard deviation of the direction [rad]; 0 for what holds the frame, None up the tree."""
    deformation: Deformation | None = None
    """How the map is bent or stretched, in its own frame, before the transform takes it to the component's. None for a
    map that is not, as all are with the transform "rigid"."""

    def to_component(self, points: ArrayLike) -> NDArray[np.float64]:
        """Where points of the map's frame lie in the component's [m]: an array of shape (..., 2), and so is the result.

        Raises ValueError for another shape.
        """
        return self.transform.apply(points if self.deformation is None else self.deformation.bend(points))

    def to_map(self, points: ArrayLike) -> NDArray[np.float64]:
        """Where points of the component's frame lie in the map's: the inverse of to_component()."""
        placed = self.transform.inverse().apply(points)
        return placed if self.deformation is None else self.deformation.straighten(placed)

    def __repr__(self) -> str:
        return (
            f"Member({shortened(self.name)}, transform={short_pose(self.transform)}, "
            f"{probability(self.probability)})"
        )


@dataclass(frozen=True, slots=True)
class Component:
    """Maps that were joined, and the map that they make."""

    members: tuple[Member, ...]
    """Ascending by index, two or more."""
    grid: OccupancyGrid
    """The merged map, with probabilities. Its frame is that of the first member, the world's if a member's pose is
    fixed, or the plan's."""
    agreeing: int
    """Cells known in two or more inputs, all equal."""
    conflicting: int
    """Cells that some input calls free and another occupied."""
    omega: int | None
    """Cells at which all inputs have the same value, unknown included (Birk & Carpin 2006); None where the inputs'
    cells differ in size from the merged map's by more than 100 times."""
    in_world_frame: bool
    """Whether the frame is that of the initial poses, because a member's pose is fixed, or that of the plan."""

    def __repr__(self) -> str:
        return (
            f"Component({count(len(self.members), 'map')}: {listed([member.name for member in self.members])}; "
            f"{self.grid.width} x {self.grid.height} cells)"
        )

    def _repr_html_(self) -> str:
        return self.grid._repr_html_()


@dataclass(frozen=True, slots=True)
class Join(PairPose):
    """A comparison of two maps, and what became of it.

    The pose is the one that was used, or the best hypothesis if none was. The probability is that from these two maps
    alone.
    """

    fixed: int
    """Index of the input map."""
    moving: int
    """Index of the input map."""
    outcome: JoinOutcome
    """What became of the comparison in the merge."""
    used: bool
    """Whether the maps lie so in the result."""
    reason: Reason | None
    """Why the merge did not use it; None if it did."""
    match: MatchResult
    """What the two maps say by themselves."""

    def __repr__(self) -> str:
        why = "" if self.reason is None else f": {self.reason}"
        return (
            f"Join({self.fixed}, {self.moving}, {self.outcome}{why}, transform={short_pose(self.transform)}, "
            f"{probability(self.probability)})"
        )


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A map that joined nothing."""

    map: int
    """Index of the input map."""
    name: str
    """Of the map: its file, or the name that merge() was given for it."""
    reason: Reason
    """Of the refused join that was most probable."""
    explanation: str
    """The reason as the end of a sentence that begins with the map's name."""

    def __repr__(self) -> str:
        return f"LeftOut({shortened(self.name)}: {self.explanation})"


@dataclass(frozen=True, slots=True)
class OpenWay:
    """A way in which maps that lie apart may lie together: too likely to be passed over, and not sure enough to be
    taken, or one of several among which nothing decides."""

    fixed: int
    """Index of the first map of its component, or of one that was left out."""
    moving: int
    """Likewise, after `fixed`."""
    transform: Transform
    """T_fixed_moving between the frames of these two maps."""
    probability: float
    """With all that the other maps say; 0.05 or more."""

    def __repr__(self) -> str:
        return (
            f"OpenWay({self.fixed}, {self.moving}, transform={short_pose(self.transform)}, "
            f"{probability(self.probability)})"
        )


@dataclass(frozen=True, slots=True)
class NotCompared:
    """Pairs of maps that `max_missed` has left out."""

    pairs: int
    """How many pairs of maps that count: copies of a map do not."""
    expected_joins: float
    """How many joins of maps that lie apart these pairs may hide, by the signatures of their maps and by what was found
    of the pairs that were compared."""


@dataclass(frozen=True, slots=True)
class MergeResult:
    """What became of the maps that were merged."""

    components: tuple[Component, ...]
    """Of two or more maps each, most members first; those of a team by number, as in its answer."""
    joins: tuple[Join, ...]
    """Every comparison that was made, whatever its outcome."""
    left_out: tuple[LeftOut, ...]
    """Maps that joined nothing."""
    maps: tuple[OccupancyGrid, ...]
    """The inputs."""
    names: tuple[str, ...]
    """Of the inputs."""
    open_ways: tuple[OpenWay, ...]
    """How maps that lie apart may lie together, most probable first. Empty for the strategy "tree"."""
    expected_false_joins: float | None
    """How many of all joins are expected to be false. None for the strategy "tree", which does not know."""
    not_compared: NotCompared | None
    """Pairs of which nothing is known; None if all pairs were compared."""
    plan: PlanPlacement | None
    """Which maps hang on the plan, and how; None if none was given."""
    _core: _core.Merged = field(repr=False, compare=False)
    _more_inputs: tuple[bytes, ...] = field(repr=False, compare=False)
    _accept: float = field(repr=False, compare=False)

    @property
    def complete(self) -> bool:
        """Whether all maps are in one component, and on the plan if one was given."""
        on_plan = self.plan is None or all(part.on_plan for part in self.plan.parts)
        return len(self.components) == 1 and not self.left_out and on_plan

    def __repr__(self) -> str:
        joined = sum(len(component.members) for component in self.components)
        left_out = f"; left out: {listed([one.name for one in self.left_out])}" if self.left_out else ""
        return (
            f"MergeResult({joined} of {count(len(self.maps), 'map')} in "
            f"{count(len(self.components), 'component')}{left_out})"
        )

    def _repr_html_(self) -> str:
        return _html.merge_html(self)

    def __reduce__(self) -> tuple[Any, ...]:
        return _unpickle, (self.maps, self.names, self._core.state(), self._more_inputs, self._accept)

    def save(self, directory: str | os.PathLike[str]) -> None:
        """Writes the files that `gridmerge merge` writes: merged.yaml and merged.pgm (and merged_2.yaml and so on for
        further components), transforms.json, preview.png and report.html.

        The directory is made if need be; merged maps of an earlier run are removed from it. Raises FileError when it
        cannot be written to, or holds an input under the name of an output; then nothing is changed.
        """
        path = _arguments.path("directory", directory)
        self._core.save(path, [_arguments.to_bytes(name) for name in self.names], list(self._more_inputs))

    def export(self, format: ExportFormat, file: str | os.PathLike[str]) -> None:
        """Writes the merge for other programs, as `gridmerge merge --export` does.

        Args:
            format: "g2o" is a pose graph, "open-rmf" has the points by which fleet adapters find where maps lie, and
                "geojson" has the outlines of all placed maps. "geotiff" is the merged map itself in the cells of its
                finest map, of up to 2^36 cells; further components go to files beside it: x_2.tif for x.tif.
            file: is replaced as a whole.

        Metres and radians, in the frame of each merged map. Raises ValueError for another format, and FileError if no
        map was placed, or if the file cannot be written or is an input.
        """
        name = _arguments.choice("format", format, tuple(_core.export_formats()))
        path = _arguments.path("file", file)
        names = [_arguments.to_bytes(one) for one in self.names]
        self._core.export(name, path, names, list(self._more_inputs))

    def plot(self, ax: Axes | None = None, *, component: int = 0) -> Axes:
        """Draws a component: each input map in its own colour, where it lies in the component's frame [m].

        Without components the axes stay empty but for a title that says so. Needs matplotlib:
        ``pip install 'gridmerge[plot]'``. Raises IndexError for a component that there is not.
        """
        from . import _plot

        return _plot.plot_component(self, component, ax)


def _unpickle(
    grids: Sequence[OccupancyGrid],
    names: Sequence[str],
    state: bytes,
    more_inputs: tuple[bytes, ...],
    accept: float,
) -> MergeResult:
    merged = _core.Merged.from_state([grid._core for grid in grids], state)
    return to_merge_result(merged, grids, names, more_inputs, accept)


def to_merge_result(
    merged: _core.Merged,
    grids: Sequence[OccupancyGrid],
    names: Sequence[str],
    more_inputs: tuple[bytes, ...],
    accept: float,
) -> MergeResult:
    """`more_inputs`: files that save() and export() must not write over. `accept`: that the maps were merged with."""
    return MergeResult(
        components=tuple(_to_component(merged, i, names) for i in range(merged.component_count)),
        joins=tuple(_to_join(join, accept) for join in merged.joins),
        left_out=tuple(to_left_out(one, names) for one in merged.left_out),
        maps=tuple(grids),
        names=tuple(names),
        open_ways=tuple(_to_open_way(way) for way in merged.open_ways),
        expected_false_joins=merged.expected_false_joins,
        not_compared=None if merged.not_compared is None else NotCompared(*merged.not_compared),
        plan=None if merged.plan is None else to_plan_placement(merged.plan, names),
        _core=merged,
        _more_inputs=more_inputs,
        _accept=accept,
    )


def _to_component(merged: _core.Merged, index: int, names: Sequence[str]) -> Component:
    agreeing, conflicting, omega = merged.counts(index)
    return Component(
        members=tuple(to_member(member, names) for member in merged.members(index)),
        grid=OccupancyGrid._of(merged.grid(index)),
        agreeing=agreeing,
        conflicting=conflicting,
        omega=omega,
        in_world_frame=merged.is_in_world_frame(index),
    )


def to_member(member: _core.Member, names: Sequence[str]) -> Member:
    return Member(
        map=member.map,
        name=names[member.map],
        transform=Transform(*member.transform),
        probability=member.probability,
        sd_position=None if member.sd is None else member.sd.position,
        sd_theta=None if member.sd is None else member.sd.theta,
        deformation=None if member.deformation.is_identity else Deformation._of(member.deformation),
    )


def to_left_out(core: tuple[int, str, str], names: Sequence[str]) -> LeftOut:
    index, reason, explanation = core
    return LeftOut(index, names[index], cast(Reason, reason), explanation)


def _to_open_way(way: _core.OpenWay) -> OpenWay:
    return OpenWay(way.fixed, way.moving, Transform(*way.transform), way.probability)


def _to_join(join: _core.Join, accept: float) -> Join:
    return Join(
        **pair_pose(join),
        fixed=join.fixed,
        moving=join.moving,
        outcome=cast(JoinOutcome, join.outcome),
        used=join.used,
        reason=None if join.reason == "none" else cast(Reason, join.reason),
        match=to_match_result(join.match, accept),
    )
