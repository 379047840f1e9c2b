# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import os
import threading
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from typing import Any

import numpy as np

from . import _arguments, _cache, _core, _executor
from ._arguments import Progress
from ._grid import MapLike, OccupancyGrid
from ._inputs import to_map
from ._known_poses import CoreKnown, InitialPose, to_core
from ._match import to_joint_search
from ._merge import own_names, to_joint_accept, to_output_resolution, to_transform, warn_of_all_pairs
from ._merge_result import MergeResult, to_merge_result
from ._repr import count
from ._transform import PoseLike, Transform

_IDENTITY = Transform(0.0, 0.0, 0.0)


class Merger:
    """merge() for maps that come one after the other, or grow: pairs that have not changed are not matched again.

    The result is that of merge() with all the maps that are in it, in the order in which they were added. Arguments
    are those of merge(). RuntimeError for who uses it while another call of its methods is at work. It can be pickled,
    with its maps and matches: whoever loads it goes on where it was.
    """

    def __init__(
        self,
        *,
        threads: int = 0,
        accept: float | None = None,
        max_false_joins: float = _core.DEFAULT_MAX_FALSE_JOINS,
        max_missed: float = _core.DEFAULT_MAX_MISSED,
        output_resolution: float | None = None,
        transform: str | None = None,
        elastic: bool = False,
        search: str = "exhaustive",
    ) -> None:
        self._set_up(
            (
                _arguments.threads(threads),
                to_joint_accept(accept),
                _arguments.not_negative("max_false_joins", max_false_joins),
                _arguments.share("max_missed", max_missed),
                to_output_resolution(output_resolution),
                to_transform(transform, elastic),
                to_joint_search(search),
            )
        )

    def _set_up(self, options: tuple[int, float, float, float, float, str, str]) -> None:
        self._options = options
        self._core = _core.Merger(*options)
        self._maps: dict[int, tuple[OccupancyGrid, str | None]] = {}  # with the names that they were given
        self._poses: dict[int, CoreKnown] = {}  # that are known, of the engine's maps
        self._posed: set[int] = set()  # of which the user has given one
        self._files: set[int] = set()  # that were given as paths
        self._next = 0  # no map has had this id or a higher one
        self._holder: int | None = None  # fixed without a pose: holds its own frame
        self._use = threading.Lock()
        self._settled = True  # the engine has the same maps

    def __repr__(self) -> str:
        return f"Merger({count(len(self._maps), 'map')})"

    def add(
        self,
        map: MapLike,
        *,
        name: str | None = None,
        pose: InitialPose | PoseLike | None = None,
        fixed: bool = False,
    ) -> int:
        """Takes in one more map, with what is known of its pose, and returns its id. Nothing is matched yet.

        A single map may be fixed without a pose, while no other map's pose is known: it holds its own frame.
        """
        grid = to_map("map", map)
        if name is not None:
            _arguments.map_name("name", name)
        known = None if pose is None else to_core(pose, "pose", bool(fixed))
        holds = fixed and pose is None
        with self._alone():
            if holds and (self._posed or self._holder is not None):
                raise ValueError("pose: a fixed map needs one, because other maps are fixed or have one")
            if known is not None and self._holder is not None:
                raise ValueError(
                    f"pose: has no meaning beside map {self._holder}, which is fixed without one"
                )
            told = to_core(_IDENTITY, "pose", True) if holds else known
            map_id = self._core.add(grid._core, told)
            self._next = map_id + 1
            if told is not None:
                self._poses[map_id] = told
            if holds:
                self._holder = map_id
            if known is not None:
                self._posed.add(map_id)
            self._maps[map_id] = (grid, name)
            self._note_file(map_id, map)
        return map_id

    def update(self, map_id: int, map: MapLike) -> None:
        """Another map in the place of one that was added: of the same robot, later, in the same frame. Its pairs are
        matched again. KeyError for an unknown id."""
        grid = to_map("map", map)
        with self._alone():
            map_id, name = self._known(map_id)
            self._core.update(map_id, grid._core)
            self._maps[map_id] = (grid, name)
            self._note_file(map_id, map)

    def grow(self, map_id: int, map: MapLike) -> None:
        """As update(), for a map that is little different: what its pairs said stays until search_again().

        Where the maps lie is adjusted to the new map all the same, so a map follows a robot that explores at the cost
        of a joint solution instead of a match with each other map. A map that was left out stays left out until
        search_again() or update(). KeyError for an unknown id.
        """
        grid = to_map("map", map)
        with self._alone():
            map_id, name = self._known(map_id)
            self._core.grow(map_id, grid._core)
            self._maps[map_id] = (grid, name)
            self._note_file(map_id, map)

    def search_again(self, map_id: int) -> None:
        """The map's pairs are matched again by the next solve(). KeyError for an unknown id."""
        with self._alone():
            map_id, _ = self._known(map_id)
            self._core.search_again(map_id)

    def remove(self, map_id: int) -> None:
        """Takes a map out again. KeyError for an unknown id."""
        with self._alone():
            map_id, _ = self._known(map_id)
            del self._maps[map_id]
            self._core.remove(map_id)
            self._posed.discard(map_id)
            if map_id == self._holder:
                self._holder = None

    @property
    def ids(self) -> tuple[int, ...]:
        """Of the maps that are in it, in the order in which they were added: a result speaks of them by their place
        in this order."""
        return tuple(self._maps)

    def solve(
        self,
        *,
        executor: Executor | None = None,
        cache: str | os.PathLike[str] | None = None,
        progress: Progress | None = None,
    ) -> MergeResult:
        """Matches the pairs that are new or have changed, and merges: seconds to minutes for many maps.

        An executor makes the matches, and a cache keeps them on disk, as for merge(). Those that the executor has made
        when it fails are kept by the Merger, too, and the next call goes on with them.
        """
        _executor.check(executor)
        kept = _cache.to_cache(cache)
        with self._alone():
            told = _arguments.progress(progress)
            warn_of_all_pairs(self._options[3], len(self._maps))
            if executor is not None:
                shared = {
                    map_id: _executor.of_map(grid, map_id in self._files)
                    for map_id, (grid, _) in self._maps.items()
                }
                matching = _executor.MatchingExecutor(executor, *self._core.match_options(), kept)
                _executor.match_due(matching, [(self._core, shared)], told)
            merged = self._core.solve(None if executor is not None else kept, told)
            grids = [grid for grid, _ in self._maps.values()]
            own = own_names(grids, self._maps)
            names = [given or name for (_, given), name in zip(self._maps.values(), own, strict=True)]
        _cache.close(kept)
        return to_merge_result(merged, grids, names, (), self._options[1])

    def __getstate__(self) -> dict[str, Any]:
        with self._alone():
            return {
                "options": self._options,
                "next": self._next,
                "maps": dict(self._maps),
                "poses": {map_id: self._poses[map_id] for map_id in self._maps if map_id in self._poses},
                "posed": set(self._posed),
                "holder": self._holder,
                "files": self._files & self._maps.keys(),
                "matches": self._core.matches(),
            }

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._set_up(state["options"])
        maps: dict[int, tuple[OccupancyGrid, str | None]] = state["maps"]
        gone = OccupancyGrid(np.full((1, 1), -1, np.int8), 1.0)  # holds the ids of maps that were removed
        for map_id in range(state["next"]):
            grid = maps[map_id][0] if map_id in maps else gone
            self._core.add(grid._core, state["poses"].get(map_id))
            if map_id not in maps:
                self._core.remove(map_id)
        for match in state["matches"]:
            self._core.hand_in(*match)
        self._next = state["next"]
        self._maps = maps
        self._poses = state["poses"]
        self._posed = state["posed"]
        self._holder = state["holder"]
        self._files = state["files"]

    def _note_file(self, map_id: int, map: MapLike) -> None:
        self._files.discard(map_id)
        if isinstance(map, (str, os.PathLike)):
            self._files.add(map_id)

    @contextmanager
    def _alone(self) -> Iterator[None]:
        if not self._use.acquire(blocking=False):
            raise RuntimeError("the Merger is at work")
        try:
            if not self._settled:
                self._core.keep([(map_id, grid._core) for map_id, (grid, _) in self._maps.items()])
                self._posed &= self._maps.keys()
                self._holder = self._holder if self._holder in self._maps else None
            self._settled = False
            yield
            self._settled = True
        finally:
            self._use.release()

    def _known(self, map_id: object) -> tuple[int, str | None]:
        """The id of a map that is in it, and the name that it was given."""
        known = _arguments.index("map_id", map_id)
        if known not in self._maps:
            raise KeyError(f"there is no map {known}")
        return known, self._maps[known][1]
