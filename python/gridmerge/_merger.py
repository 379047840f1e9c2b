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
from ._transform import PoseLike


class Merger:
    """merge() for maps that come one after the other, or grow: pairs that have not changed are not matched again.

    The result is that of merge() with all the maps that are in it, in the order in which they were added. Arguments
    are those of merge(). RuntimeError for who uses it while another call of its methods is at work.
    """

    def __init__(
        self, *, threads: int = 0, accept: float = 0.8, output_resolution: float | None = None
    ) -> None:
        self._core = _core.Merger(
            _arguments.threads(threads),
            _arguments.share("accept", accept),
            to_output_resolution(output_resolution),
        )
        self._maps: dict[int, tuple[OccupancyGrid, str]] = {}
        self._use = threading.Lock()

    def add(
        self,
        map: MapLike,
        *,
        name: str | None = None,
        pose: InitialPose | PoseLike | None = None,
        fixed: bool = False,
    ) -> int:
        """Takes in one more map, with what is known of its pose, and returns its id. Nothing is matched yet."""
        grid = to_map("map", map)
        if pose is None and fixed:
            pose = (0.0, 0.0, 0.0)
        known = None if pose is None else to_core(pose, "pose", bool(fixed))
        with self._alone():
            map_id = self._core.add(grid._core, known)
            self._maps[map_id] = (grid, name or grid.source or f"map {map_id}")
        return map_id

    def update(self, map_id: int, map: MapLike) -> None:
        """Another map in the place of one that was added: of the same robot, later. KeyError for an unknown id."""
        grid = to_map("map", map)
        with self._alone():
            name = self._known(map_id)[1]
            self._core.update(map_id, grid._core)
            self._maps[map_id] = (grid, name)

    def remove(self, map_id: int) -> None:
        """Takes a map out again. KeyError for an unknown id."""
        with self._alone():
            self._known(map_id)
            self._core.remove(map_id)
            del self._maps[map_id]

    @property
    def ids(self) -> tuple[int, ...]:
        """Of the maps that are in it, in the order in which they were added: a result speaks of them by their place
        in this order."""
        return tuple(self._maps)

    def result(self, *, progress: Progress | None = None) -> MergeResult:
        """Matches the pairs that are new or have changed, and merges."""
        with self._alone():
            merged = self._core.result(_arguments.progress(progress))
            grids = [grid for grid, _ in self._maps.values()]
            names = [name for _, name in self._maps.values()]
        return to_merge_result(merged, grids, names, ())

    @contextmanager
    def _alone(self) -> Iterator[None]:
        if not self._use.acquire(blocking=False):
            raise RuntimeError("the Merger is at work")
        try:
            yield
        finally:
            self._use.release()

    def _known(self, map_id: int) -> tuple[OccupancyGrid, str]:
        if map_id not in self._maps:
            raise KeyError(f"there is no map {map_id}")
        return self._maps[map_id]
