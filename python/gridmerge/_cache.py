# SPDX-License-Identifier: Apache-2.0
"""Matches that are kept on disk, as `--cache` of the command line keeps them."""

from __future__ import annotations

import os

from . import _arguments, _core, _inputs


class CacheWarning(UserWarning):
    """A match that was kept is damaged, or one cannot be kept: it is made again, or not kept, and the work goes on."""


def to_cache(directory: _arguments.PathLike | None) -> _core.MatchCache | None:
    """The cache in that directory, which is made if need be; none if there is none."""
    if directory is None:
        return None
    # The program may go to another directory before it is done.
    return _core.MatchCache(os.path.abspath(_arguments.path("cache", directory)))


def warn(cache: _core.MatchCache | None) -> None:
    """Issues what the cache has to tell."""
    if cache is not None:
        _inputs.warn(cache.take_warnings(), CacheWarning)
