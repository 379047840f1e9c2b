# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arguments, _core, _executor, _html
from ._arguments import Progress
from ._deformation import Deformation
from ._grid import MapLike, OccupancyGrid
from ._inputs import to_maps_and_files
from ._known_poses import InitialPoses, MapKey, NamedMaps, to_known_poses
from ._match import MatchResult, PairPose, Reason, pair_pose, to_match_result
from ._plan import PlanPlacement, choose_plan, to_plan_placement
from ._repr import count, listed, probability, short_pose, shortened
from ._transform import Transform

if TYPE_CHECKING:
    from matplotlib.axes import Axes

JoinOutcome: TypeAlias = Literal["refused", "accepted", "rescued", "rejected", "known"]
"""What became of a comparison of two maps: "rescued" is too weak by itself and agrees with the others, "rejected" would
be believed by itself and contradicts them, "known" lies so because it is known beforehand."""
Strategy: TypeAlias = Literal["joint", "tree"]
ExportFormat: TypeAlias = Literal["g2o", "open-rmf", "geojson"]
"""What other programs read of a merge."""


@dataclass(frozen=True, slots=True)
class Member:
    """A map in a component."""

    map: int
    """Index of the input map."""
    name: str
    """Of the map: its file, or what merge() was told to call it."""
    transform: Transform
    """Takes points of the map's frame to the component's."""
    probability: float | None
    """That the map lies there, with all that the other maps say of it. The tree does not know."""
    sd_position: float | None
    """Standard deviation of the middle of the map's known cells [m]; 0 for what holds the frame, None up the tree."""
    sd_theta: float | None
    """Standard deviation of the direction [rad]; 0 for what holds the frame, None up the tree."""
    deformation: Deformation | None = None
    """How the map is bent, in its own frame, before the transform takes it to the component's. None for a straight map,
    as all are without ``elastic=True``."""

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
    """The merged map, with probabilities, in the frame of the first member, or the world's."""
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
    """Of the map: its file, or what merge() was told to call it."""
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
    """With all that the other maps say; 0.1 or more."""

    def __repr__(self) -> str:
        return (
            f"OpenWay({self.fixed}, {self.moving}, transform={short_pose(self.transform)}, "
            f"{probability(self.probability)})"
        )


@dataclass(frozen=True, slots=True)
class MergeResult:
    """What became of the maps that were merged."""

    components: tuple[Component, ...]
    """Of two or more maps each, most members first."""
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
    plan: PlanPlacement | None
    """Which maps hang on the plan, and how; None if none was given."""
    _core: _core.Merged = field(repr=False, compare=False)
    _more_inputs: tuple[bytes, ...] = field(repr=False, compare=False)

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
        return _unpickle, (self.maps, self.names, self._core.state(), self._more_inputs)

    def save(self, directory: str | os.PathLike[str]) -> None:
        """Writes the files that `gridmerge merge` writes: merged.yaml and merged.pgm (and merged_2.yaml and so on for
        further components), transforms.json, preview.png and report.html.

        The directory is made if need be; merged maps of an earlier run are removed from it. Raises FileError when it
        cannot be written to, or holds an input under the name of an output; then nothing is changed.
        """
        path = _arguments.path("directory", directory)
        self._core.save(path, [_arguments.to_bytes(name) for name in self.names], list(self._more_inputs))

    def export(self, format: ExportFormat, file: str | os.PathLike[str]) -> None:
        """Writes where the maps lie for other programs, as `gridmerge merge --export` does.

        Args:
            format: "g2o" is a pose graph, "open-rmf" has the points by which fleet adapters find where maps lie, and
                "geojson" has the outlines of all placed maps.
            file: is replaced as a whole.

        Metres and radians, in the frame of each merged map. Raises ValueError for another format, and FileError if no
        map was placed, or if the file cannot be written or is an input.
        """
        name = _arguments.choice("format", format, tuple(_core.export_formats()))
        path = _arguments.path("file", file)
        self._core.export(name, path, [_arguments.to_bytes(one) for one in self.names])

    def plot(self, ax: Axes | None = None, *, component: int = 0) -> Axes:
        """Draws a component: each input map in its own colour, where it lies in the component's frame [m].

        Without components the axes stay empty but for a title that says so. Needs matplotlib:
        ``pip install 'gridmerge[plot]'``. Raises IndexError for a component that there is not.
        """
        from . import _plot

        return _plot.plot_component(self, component, ax)


def merge(
    maps: Iterable[MapLike],
    *,
    names: Sequence[str] | None = None,
    strategy: Strategy = "joint",
    init: InitialPoses | None = None,
    fix: MapKey | Iterable[MapKey] | None = None,
    threads: int = 0,
    accept: float | None = None,
    max_false_joins: float = _core.DEFAULT_MAX_FALSE_JOINS,
    max_missed: float = _core.DEFAULT_MAX_MISSED,
    output_resolution: float | None = None,
    elastic: bool = False,
    plan: MapLike | None = None,
    plan_scale: tuple[float, float] | None = None,
    search: str = "exhaustive",
    executor: Executor | None = None,
    progress: Progress | None = None,
) -> MergeResult:
    """Merges maps by what all pairs of them say together; a map that does not belong is left out.

    Args:
        maps: maps, paths of map files, or messages like nav_msgs/OccupancyGrid.
        names: what to call the maps; by default the paths they were loaded from, the frames that their messages name
            (each of which one map alone may have), or "map 0", "map 1", ...
        strategy: "joint", or "tree": pairwise up a tree, as Birk & Carpin (2006).
        init: what is known of the maps' poses: the path of a table, which names the maps' files, or poses by map index,
            name, or path that the map was loaded from.
        fix: a map whose pose is the truth, or several, told in the same ways: they are not changed, and the merged map
            is in this map's frame, or in that of `init`.
        threads: 0 = one a core. The result does not depend on it.
        accept: maps are joined from this probability on, 0.95 if None. Of the random walk it is the acceptance index,
            0.98 if None.
        max_false_joins: so many joins of the whole merge may be expected to be false, or of more than 50 maps for every
            50; those that are least sure are not made. It holds beside `accept`. "tree" does not use it.
        max_missed: of more than 50 maps match likely pairs only: the others may hide this share of all joins, 0.25 or
            so. Up to 0.2 all pairs are matched. "tree" does not use it.
        output_resolution: of the merged maps [m]; None = the finest of the maps'.
        elastic: whether maps are bent so that walls that several have seen come to lie on each other: for maps that
            drift has bent. See Member.deformation. Fixed maps stay straight. It changes neither which maps join nor
            how sure that is, and needs the strategy "joint".
        plan: an architect's plan of unknown scale, a line drawing or a map, that the maps are hung on: see
            MergeResult.plan. Maps that nothing else joins are joined by it. The component on the plan is in the plan's
            frame, in the maps' metres, and holds the maps alone. Not for "tree", and not together with `fix`.
        plan_scale: the smallest and the largest factor by which the plan may be too small; (0.5, 2.0) if None.
        search: as of match(). With "exhaustive" the thorough look is for pairs whose maps the quick one leaves apart.
            "random-walk" needs the strategy "tree".
        executor: makes the matches: any concurrent.futures.Executor, of processes, threads, Dask or MPI. The result is
            the same, bit by bit. Maps that are given as paths are read by the workers, under the same paths; others are
            sent to them. Each task takes one thread, and is tried again when its worker dies. "tree" takes none.
        progress: called now and then, in the calling thread, with the share of the pairs that are matched. The plan
            comes after them.

    The frame of a component is that of its first member, unless a member is fixed. Other Python threads run meanwhile,
    and Ctrl-C ends the work, also what an executor has not begun. Raises FileError for a file that is no map, or that
    changes before a worker reads it; ExecutorError for an executor that fails; and TypeError or ValueError, naming the
    argument, for other mistakes and for merged maps of more than 2^28 cells.
    """
    given = to_maps_and_files("maps", maps)
    grids = [grid for grid, _ in given]
    called = to_names(names, grids)
    up_the_tree = _arguments.choice("strategy", strategy, ("joint", "tree")) == "tree"
    if up_the_tree and (init is not None or fix is not None):
        raise ValueError("strategy: init and fix need 'joint'")
    if search == "random-walk" and not up_the_tree:
        raise ValueError(
            "search: 'random-walk' needs the strategy 'tree': it has one pose per pair, no probability"
        )
    if elastic and up_the_tree:
        raise ValueError("strategy: elastic needs 'joint'")
    if _executor.check(executor) is not None and up_the_tree:
        raise ValueError("executor: needs the strategy 'joint': a tree's matches wait for each other")
    chosen = choose_plan(grids, plan, plan_scale, up_the_tree, fix is not None, search)
    # The program may go to another directory before it saves.
    more_inputs: tuple[bytes, ...] = (
        (os.fsencode(os.path.abspath(init)),) if isinstance(init, (str, os.PathLike)) else ()
    )
    known = to_known_poses(NamedMaps(called, grids), init, fix)
    checked_accept = None if accept is None else _arguments.share("accept", accept)
    max_false_joins = _arguments.not_negative("max_false_joins", max_false_joins)
    max_missed = _arguments.share("max_missed", max_missed)
    resolution = to_output_resolution(output_resolution)
    search = _arguments.choice("search", search, tuple(_core.search_methods()))
    told = _arguments.progress(progress)
    if executor is None:
        merged = _core.merge(
            [grid._core for grid in grids],
            known,
            _arguments.threads(threads),
            checked_accept,
            max_false_joins,
            max_missed,
            resolution,
            up_the_tree,
            bool(elastic),
            search,
            told,
        )
    else:
        merger = _core.Merger(
            _arguments.threads(threads),
            _core.DEFAULT_ACCEPT if checked_accept is None else checked_accept,
            max_false_joins,
            max_missed,
            resolution,
            bool(elastic),
            search,
        )
        ids = [merger.add(grid._core, pose) for grid, pose in zip(grids, known, strict=True)]
        shared = {i: _executor.of_map(grid, is_file) for i, (grid, is_file) in zip(ids, given, strict=True)}
        matching = _executor.MatchingExecutor(executor, *merger.match_options())
        _executor.match_due(matching, [(merger, shared)], told)
        merged = merger.solve(None)
    if chosen is not None:
        drawing, scales = chosen
        merged = _core.place_on_plan(
            merged,
            drawing._core,
            _arguments.to_bytes(drawing.source or drawing.frame_id or "plan"),
            scales,
            _arguments.threads(threads),
            checked_accept,
            max_false_joins,
            resolution,
            search,
        )
        more_inputs += tuple(drawing._core.files)
    return to_merge_result(merged, grids, called, more_inputs)


def _unpickle(
    grids: Sequence[OccupancyGrid], names: Sequence[str], state: bytes, more_inputs: tuple[bytes, ...]
) -> MergeResult:
    merged = _core.Merged.from_state([grid._core for grid in grids], state)
    return to_merge_result(merged, grids, names, more_inputs)


def to_names(names: Sequence[str] | None, grids: Sequence[OccupancyGrid]) -> list[str]:
    if names is None:
        frames = [grid.frame_id for grid in grids]
        return [
            # A frame that several maps are said to be in names none of them.
            grid.source or (frame if frame and frames.count(frame) == 1 else f"map {i}")
            for i, (grid, frame) in enumerate(zip(grids, frames, strict=True))
        ]
    if isinstance(names, (str, bytes)) or not isinstance(names, Iterable):
        raise TypeError(f"names: must be a sequence of strings, is {_arguments.kind_of(names)}")
    called = list(names)
    for i, name in enumerate(called):
        _arguments.text(f"names[{i}]", name)
    if len(called) != len(grids):
        raise ValueError(f"names: there are {len(called)} for {len(grids)} maps")
    return called


def to_output_resolution(value: float | None) -> float:
    if value is None:
        return 0.0
    resolution = _arguments.number("output_resolution", value)
    if not _core.MIN_RESOLUTION <= resolution <= _core.MAX_RESOLUTION:
        raise ValueError(
            f"output_resolution: must be between {_core.MIN_RESOLUTION:g} and {_core.MAX_RESOLUTION:g} metres a cell, "
            f"is {value}"
        )
    return resolution


def to_merge_result(
    merged: _core.Merged, grids: Sequence[OccupancyGrid], names: Sequence[str], more_inputs: tuple[bytes, ...]
) -> MergeResult:
    return MergeResult(
        components=tuple(_to_component(merged, i, names) for i in range(merged.component_count)),
        joins=tuple(_to_join(join) for join in merged.joins),
        left_out=tuple(
            LeftOut(index, names[index], cast(Reason, reason), explanation)
            for index, reason, explanation in merged.left_out
        ),
        maps=tuple(grids),
        names=tuple(names),
        open_ways=tuple(_to_open_way(way) for way in merged.open_ways),
        expected_false_joins=merged.expected_false_joins,
        plan=None if merged.plan is None else to_plan_placement(merged.plan, names),
        _core=merged,
        _more_inputs=more_inputs,
    )


def _to_component(merged: _core.Merged, index: int, names: Sequence[str]) -> Component:
    agreeing, conflicting, omega = merged.counts(index)
    return Component(
        members=tuple(_to_member(member, names) for member in merged.members(index)),
        grid=OccupancyGrid._of(merged.grid(index)),
        agreeing=agreeing,
        conflicting=conflicting,
        omega=omega,
        in_world_frame=merged.is_in_world_frame(index),
    )


def _to_member(member: _core.Member, names: Sequence[str]) -> Member:
    return Member(
        map=member.map,
        name=names[member.map],
        transform=Transform(*member.transform),
        probability=member.probability,
        sd_position=None if member.sd is None else member.sd.position,
        sd_theta=None if member.sd is None else member.sd.theta,
        deformation=None if member.deformation.is_identity else Deformation._of(member.deformation),
    )


def _to_open_way(way: _core.OpenWay) -> OpenWay:
    return OpenWay(way.fixed, way.moving, Transform(*way.transform), way.probability)


def _to_join(join: _core.Join) -> Join:
    return Join(
        **pair_pose(join),
        fixed=join.fixed,
        moving=join.moving,
        outcome=cast(JoinOutcome, join.outcome),
        used=join.used,
        reason=None if join.reason == "none" else cast(Reason, join.reason),
        match=to_match_result(join.match),
    )
