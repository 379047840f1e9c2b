# SPDX-License-Identifier: Apache-2.0
"""Matches as tasks that any process can do: what a worker runs, and what it is sent.

A task is made of tuples, strings and numbers alone, and names the engine that it is for, so that a worker of another
version can say so.
"""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Sequence
from typing import Literal, TypeAlias

from . import _core
from ._grid import OccupancyGrid

FileSpec: TypeAlias = tuple[Literal["file"], bytes, float, bool, str]
"""A path, how it is read (resolution, literal thresholds), and what its map holds: content_id()."""
GridSpec: TypeAlias = tuple[Literal["grid"], OccupancyGrid, str]
"""A map, and what it holds."""
MapSpec: TypeAlias = FileSpec | GridSpec
PairSpec: TypeAlias = tuple[int, int, str, bytes]
"""Two maps of the task by their indices, the search, and what an earlier quick search of them has found."""
Made: TypeAlias = tuple[bytes, bytes]
"""A match, and what a quick search has found, for another look."""
Answer: TypeAlias = tuple[str, int, list[Made] | str]
"""What became of the task, its number, and what it made or a word about what went wrong."""

_MOST_CELLS = 2**25  # of the maps that a worker keeps


class _Shelf:
    """Maps that are ready to be matched, those used last."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._maps: OrderedDict[str, tuple[_core.Prepared, int]] = OrderedDict()

    def get(self, content: str) -> _core.Prepared | None:
        with self._lock:
            if content not in self._maps:
                return None
            self._maps.move_to_end(content)
            return self._maps[content][0]

    def put(self, content: str, prepared: _core.Prepared, cells: int) -> None:
        with self._lock:
            self._maps[content] = (prepared, cells)
            while len(self._maps) > 1 and sum(size for _, size in self._maps.values()) > _MOST_CELLS:
                self._maps.popitem(last=False)


_shelf = _Shelf()


class _FileChanged(Exception):
    pass


def match_pairs(
    engine: str,
    number: int,
    maps: Sequence[MapSpec],
    pairs: Sequence[PairSpec],
    accept: float,
    hypotheses: int,
) -> Answer:
    """The matches of these pairs, with one thread. Depends on nothing but its arguments, and changes nothing."""
    if engine != _core.engine_id():
        return "engine", number, _core.engine_id()
    try:
        prepared = [_prepare(one) for one in maps]
    except _core.FileError as error:
        return "file", number, str(error)
    except _FileChanged as error:
        return "file", number, str(error)
    return (
        "matches",
        number,
        [
            _core.match_prepared(prepared[fixed], prepared[moving], search, accept, hypotheses, found)
            for fixed, moving, search, found in pairs
        ],
    )


def _prepare(spec: MapSpec) -> _core.Prepared:
    kept = _shelf.get(spec[-1])
    if kept is not None:
        return kept
    if spec[0] == "grid":
        core = spec[1]._core
    else:
        _, path, resolution, literal_thresholds, content = spec
        core = _core.load_regular(path, resolution, literal_thresholds)
        if _core.content_id(core) != content:
            raise _FileChanged(
                f"{path.decode('utf-8', 'surrogateescape')}: is not the map that it was when the work began"
            )
    prepared = _core.prepare(core)
    _shelf.put(spec[-1], prepared, core.width * core.height)
    return prepared
