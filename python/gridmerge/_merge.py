# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from concurrent.futures import Executor
from typing import Literal, TypeAlias

from . import _arguments, _cache, _core, _executor, _inputs
from ._arguments import Progress
from ._grid import MapLike, OccupancyGrid
from ._inputs import to_maps_and_files
from ._known_poses import InitialPoses, MapKey, NamedMaps, to_known_poses
from ._match import is_joint
from ._merge_result import MergeResult, to_merge_result
from ._plan import choose_plan

Strategy: TypeAlias = Literal["joint", "tree"]


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
    transform: str | None = None,
    elastic: bool = False,
    plan: MapLike | None = None,
    plan_scale: tuple[float, float] | None = None,
    search: str = "exhaustive",
    executor: Executor | None = None,
    cache: str | os.PathLike[str] | None = None,
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
        fix: a map whose pose is the truth, or several, named in the same ways: they are not changed, and the merged map
            is in this map's frame, or in that of `init`.
        threads: 0 = one per core. The result does not depend on it.
        accept: maps are joined from this probability on, 0.95 if None. Of the random walk it is the acceptance index,
            0.98 if None.
        max_false_joins: so many joins of the whole merge may be expected to be false, or of more than 50 maps for every
            50; those that are least sure are not made. The parts on a plan have a second budget of the same size. It
            holds beside `accept`. "tree" does not use it.
        max_missed: of more than 50 maps match likely pairs only: the others may hide this share of all joins, 0.25 or
            so. Up to 0.2 all pairs are matched, as signatures do not see one join in five. "tree" does not use it.
        output_resolution: of the merged maps [m]; None = the finest of the maps', or so much coarser, up to 16 times,
            that it has at most 2^28 cells.
        transform: what may be done to maps so that walls that several have seen come to lie on each other: "rigid",
            which is the default, turns and shifts them; "similarity" gives each a scale of its own, "affine" scales
            along two axes, and shear; "elastic" bends them, as drift has. See Member.deformation. Fixed maps stay as
            they are. It changes neither which maps join nor how sure that is.
        elastic: True is the transform "elastic".
        plan: an architect's plan of unknown scale, a line drawing or a map, that the maps are hung on: see
            MergeResult.plan. Maps that nothing else joins are joined by it. The component on the plan is in the plan's
            frame, in the maps' metres, and holds the maps alone. Not for "tree", and not together with `fix`.
        plan_scale: the smallest and the largest factor by which the plan may be too small; (0.5, 2.0) if None.
        search: as of match(). With "exhaustive" the thorough look is for pairs whose maps the quick one leaves apart.
            "random-walk" needs the strategy "tree".
        executor: makes the matches: any concurrent.futures.Executor, of processes, threads, Dask or MPI. The result is
            the same, bit by bit, with the same C library and processors of one kind. Maps that are given as paths are
            read by the workers, under the same paths; others are sent to them. Each task takes one thread, and is
            tried again when its worker dies. "tree" takes none.
        cache: a directory in which the match of each pair is kept, as `--cache` of the command line does; made if need
            be. A merge that was ended goes on from it, and others may share it. Not for "tree".
        progress: called now and then, in the calling thread, with the share of the work that is done. It never falls:
            each round of matches takes half of what is left, as nobody knows how many follow. It is 1.0 when the maps
            are merged; the plan comes after that.

    The frame of a component is that of its first member, unless a member is fixed. Other Python threads run meanwhile,
    and Ctrl-C ends the work, also what an executor has not begun. Raises FileError for a file that is no map, or that
    changes before a worker reads it, and for a cache that cannot be written to; ExecutorError for an executor that
    fails; and TypeError or ValueError, naming the argument, for other mistakes and for merged maps of more than 2^28
    cells.
    """
    given = to_maps_and_files("maps", maps)
    grids = [grid for grid, _ in given]
    called = to_names(names, grids)
    up_the_tree = _arguments.choice("strategy", strategy, ("joint", "tree")) == "tree"
    if up_the_tree and (init is not None or fix is not None):
        raise ValueError("strategy: init and fix need 'joint'")
    search = _arguments.choice("search", search, tuple(_core.search_methods()))
    if not is_joint(search) and not up_the_tree:
        raise ValueError(
            f"search: {search!r} needs the strategy 'tree': it has one pose per pair, no probability"
        )
    chosen_transform = to_transform(transform, elastic)
    if chosen_transform != "rigid" and up_the_tree:
        raise ValueError(f"strategy: {chosen_transform} needs 'joint'")
    if _executor.check(executor) is not None and up_the_tree:
        raise ValueError("executor: needs the strategy 'joint': a tree's matches wait for each other")
    if cache is not None and up_the_tree:
        raise ValueError("cache: needs the strategy 'joint'")
    threads = _arguments.threads(threads)
    chosen = choose_plan(grids, plan, plan_scale, up_the_tree, fix is not None, search, threads)
    # The program may go to another directory before it saves.
    more_inputs: tuple[bytes, ...] = (
        (os.fsencode(os.path.abspath(init)),) if isinstance(init, (str, os.PathLike)) else ()
    )
    known = to_known_poses(NamedMaps(called, grids), init, fix)
    checked_accept = None if accept is None else _arguments.share("accept", accept)
    max_false_joins = _arguments.not_negative("max_false_joins", max_false_joins)
    max_missed = _arguments.share("max_missed", max_missed)
    resolution = to_output_resolution(output_resolution)
    if not up_the_tree:
        warn_of_all_pairs(max_missed, len(grids))
    told = _arguments.progress(progress)
    kept = _cache.to_cache(cache)
    if executor is None and kept is None:
        merged = _core.merge(
            [grid._core for grid in grids],
            known,
            threads,
            checked_accept,
            max_false_joins,
            max_missed,
            resolution,
            up_the_tree,
            chosen_transform,
            search,
            told,
        )
    else:
        merger = _core.Merger(
            threads,
            to_joint_accept(checked_accept),
            max_false_joins,
            max_missed,
            resolution,
            chosen_transform,
            search,
        )
        ids = [merger.add(grid._core, pose) for grid, pose in zip(grids, known, strict=True)]
        if executor is not None:
            shared = {
                i: _executor.of_map(grid, is_file) for i, (grid, is_file) in zip(ids, given, strict=True)
            }
            matching = _executor.MatchingExecutor(executor, *merger.match_options(), kept)
            _executor.match_due(matching, [(merger, shared)], told)
        merged = merger.solve(None if executor is not None else kept, told)
        _cache.close(kept)
    if chosen is not None:
        drawing, scales = chosen
        merged = _core.place_on_plan(
            merged,
            drawing._core,
            _arguments.to_bytes(drawing.source or drawing.frame_id or "plan"),
            scales,
            threads,
            checked_accept,
            max_false_joins,
            resolution,
            search,
        )
        more_inputs += tuple(drawing._core.files)
    return to_merge_result(merged, grids, called, more_inputs, to_joint_accept(checked_accept))


def to_joint_accept(accept: float | None) -> float:
    """From which probability on maps are joined."""
    return _core.DEFAULT_ACCEPT if accept is None else _arguments.share("accept", accept)


def warn_of_all_pairs(max_missed: float, maps: int) -> None:
    """Of a share that spares no pair, although it was asked for."""
    if 0.0 < max_missed <= _core.HIDDEN_SHARE and maps > _core.FEW_MAPS:
        _inputs.warn(
            [
                f"max_missed: {max_missed:g} means that all pairs are matched, as signatures do not see one join in "
                f"five: more than {_core.HIDDEN_SHARE:g} matches likely pairs only"
            ],
            UserWarning,
        )


def own_names(grids: Sequence[OccupancyGrid], numbers: Iterable[int]) -> list[str]:
    """What to call maps that nobody has named: by their files, their frames, or these numbers."""
    frames = [grid.frame_id for grid in grids]
    return [
        # A frame that several maps are said to be in names none of them.
        grid.source or (frame if frame and frames.count(frame) == 1 else f"map {number}")
        for grid, frame, number in zip(grids, frames, numbers, strict=True)
    ]


def to_names(names: Sequence[str] | None, grids: Sequence[OccupancyGrid]) -> list[str]:
    if names is None:
        return own_names(grids, range(len(grids)))
    if isinstance(names, (str, bytes)) or not isinstance(names, Iterable):
        raise TypeError(f"names: must be a sequence of strings, is {_arguments.kind_of(names)}")
    called = list(names)
    for i, name in enumerate(called):
        _arguments.map_name(f"names[{i}]", name)
    if len(called) != len(grids):
        raise ValueError(f"names: there are {len(called)} for {len(grids)} maps")
    return called


def to_transform(transform: str | None, elastic: bool) -> str:
    if transform is None:
        return "elastic" if elastic else "rigid"
    chosen = _arguments.choice("transform", transform, tuple(_core.map_transforms()))
    if elastic and chosen != "elastic":
        raise ValueError(f"elastic: contradicts the transform {chosen!r}")
    return chosen


def to_output_resolution(value: float | None) -> float:
    if value is None:
        return 0.0
    resolution = _arguments.number("output_resolution", value)
    if not _core.MIN_RESOLUTION <= resolution <= _core.MAX_RESOLUTION:
        raise ValueError(
            f"output_resolution: must be between {_core.MIN_RESOLUTION:g} and {_core.MAX_RESOLUTION:g} metres per cell"
            f", is {value}"
        )
    return resolution
