# SPDX-License-Identifier: Apache-2.0
"""Matches that are kept on disk, as `--cache` of the command line keeps them."""

from __future__ import annotations

import logging
import os

from . import _arguments, _core, _inputs
from ._repr import count

_logger = logging.getLogger("gridmerge")


class CacheWarning(UserWarning):
    """A match that was kept is damaged, or one cannot be kept: it is made again, or not kept, and the work goes on.
    Or the directory holds matches or shards that do not fit, which are not used: of another version of gridmerge, of
    other options, maps or numbers of shards."""


def to_cache(directory: _arguments.PathLike | None) -> _core.MatchCache | None:
    """The cache in that directory, which is made if need be; none if there is none."""
    if directory is None:
        return None
    # The program may go to another directory before it is done.
    return _core.MatchCache(os.path.abspath(_arguments.path("cache", directory)))


def warn(cache: _core.MatchCache) -> None:
    """Issues what the cache has to tell by now."""
    _inputs.warn(cache.take_warnings(), CacheWarning)


def close(cache: _core.MatchCache | None) -> None:
    """Issues the rest, and logs how much of the work the cache has spared."""
    if cache is not None:
        found, made = cache.counted()
        _logger.info("%s of the cache, %d made", count(found, "match", "matches"), made)
        warn(cache)
