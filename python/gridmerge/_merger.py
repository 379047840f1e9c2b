# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager

from . import _arguments, _core
from ._arguments import Progress
from ._grid import MapLike, OccupancyGrid
from ._inputs import to_map
from ._known_poses import InitialPose, to_core
from ._merge import MergeResult, to_merge_result, to_output_resolution
from ._repr import count
from ._transform import PoseLike, Transform

_IDENTITY = Transform(0.0, 0.0, 0.0)


class Merger:
    """merge() for maps that come one after the other, or grow: pairs that have not changed are not matched again.

    The result is that of merge() with all the maps that are in it, in the order in which they were added. Arguments
    are those of merge(). RuntimeError for who uses it while another call of its methods is at work.
    """

    def __init__(
        self,
        *,
        threads: int = 0,
        accept: float = _core.DEFAULT_ACCEPT,
        max_false_joins: float = _core.DEFAULT_MAX_FALSE_JOINS,
        max_missed: float = _core.DEFAULT_MAX_MISSED,
        output_resolution: float | None = None,
    ) -> None:
        self._core = _core.Merger(
            _arguments.threads(threads),
            _arguments.share("accept", accept),
            _arguments.not_negative("max_false_joins", max_false_joins),
            _arguments.share("max_missed", max_missed),
            to_output_resolution(output_resolution),
        )
        self._maps: dict[int, tuple[OccupancyGrid, str]] = {}
        self._posed: set[int] = set()  # of which a pose is known
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
            _arguments.text("name", name)
        known = None if pose is None else to_core(pose, "pose", bool(fixed))
        holds = fixed and pose is None
        with self._alone():
            if holds and (self._posed or self._holder is not None):
                raise ValueError("pose: a fixed map needs one, because other maps are fixed or have one")
            if known is not None and self._holder is not None:
                raise ValueError(
                    f"pose: has no meaning beside map {self._holder}, which is fixed without one"
                )
            map_id = self._core.add(grid._core, to_core(_IDENTITY, "pose", True) if holds else known)
            if holds:
                self._holder = map_id
            if known is not None:
                self._posed.add(map_id)
            taken = {called for _, called in self._maps.values()}
            frame = grid.frame_id if grid.frame_id not in taken else None
            self._maps[map_id] = (grid, name or grid.source or frame or f"map {map_id}")
        return map_id

    def update(self, map_id: int, map: MapLike) -> None:
        """Another map in the place of one that was added: of the same robot, later, in the same frame. Its pairs are
        matched again. KeyError for an unknown id."""
        grid = to_map("map", map)
        with self._alone():
            map_id, name = self._known(map_id)
            self._core.update(map_id, grid._core)
            self._maps[map_id] = (grid, name)

    def grow(self, map_id: int, map: MapLike) -> None:
        """As update(), for a map that is little different: what its pairs said stays until search_again().

        Where the maps lie is adjusted to the new map all the same, so a map follows a robot that explores at the cost
        of a joint solution instead of a match with each other map. KeyError for an unknown id.
        """
        grid = to_map("map", map)
        with self._alone():
            map_id, name = self._known(map_id)
            self._core.grow(map_id, grid._core)
            self._maps[map_id] = (grid, name)

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

    def solve(self, *, progress: Progress | None = None) -> MergeResult:
        """Matches the pairs that are new or have changed, and merges: seconds to minutes for many maps."""
        with self._alone():
            merged = self._core.solve(_arguments.progress(progress))
            grids = [grid for grid, _ in self._maps.values()]
            names = [name for _, name in self._maps.values()]
        return to_merge_result(merged, grids, names, ())

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

    def _known(self, map_id: object) -> tuple[int, str]:
        """The id and the name of a map that is in it."""
        known = _arguments.index("map_id", map_id)
        if known not in self._maps:
            raise KeyError(f"there is no map {known}")
        return known, self._maps[known][1]
