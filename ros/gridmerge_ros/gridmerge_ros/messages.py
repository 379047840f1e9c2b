# SPDX-License-Identifier: Apache-2.0
"""Maps and updates out of messages that nobody vouches for.

`gridmerge node` has the same rules.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from gridmerge import OccupancyGrid

MOST_CELLS = 2**28
"""Of one map."""

_LONGEST_FRAME = 255
_RESOLUTIONS = 1e-6, 1e3  # least and most [m]
_FARTHEST_ORIGIN = 1e7  # [m]


class RefusedMessage(ValueError):
    """A message that is no map, and why."""


@dataclass(frozen=True, slots=True)
class HeardMap:
    """What a `nav_msgs/OccupancyGrid` says."""

    frame: str
    grid: OccupancyGrid


@dataclass(frozen=True, slots=True)
class HeardPart:
    """What a `map_msgs/OccupancyGridUpdate` says."""

    frame: str
    column: int
    row: int
    grid: OccupancyGrid
    """Of the part's cells; its resolution and origin say nothing."""


def read_map(message: Any) -> HeardMap:
    """Raises RefusedMessage. Sizes are looked at before cells are. O(cells)."""
    frame = _read_header(message.header)
    info = message.info
    _check_size(info.width, info.height, len(message.data))
    # Messages have it with 32 bits: the number that was meant is the shortest that gives these bits.
    info.resolution = float(str(np.float32(info.resolution)))
    least, most = _RESOLUTIONS
    if not least <= info.resolution <= most:
        raise RefusedMessage(f"info.resolution: is {info.resolution} m")
    place, turn = info.origin.position, info.origin.orientation
    if not (max(abs(place.x), abs(place.y)) <= _FARTHEST_ORIGIN and math.isfinite(place.z)):
        raise RefusedMessage(f"info.origin.position: is ({place.x}, {place.y}, {place.z})")
    if not any((turn.x, turn.y, turn.z, turn.w)):
        turn.w = 1.0  # who sets none of them means no turn
    try:
        return HeardMap(frame, OccupancyGrid.from_msg(message))
    except (TypeError, ValueError) as error:
        raise RefusedMessage(str(error)) from None


def read_update(message: Any) -> HeardPart:
    """Raises RefusedMessage. O(cells)."""
    frame = _read_header(message.header)
    _check_size(message.width, message.height, len(message.data))
    if message.x < 0 or message.y < 0:
        raise RefusedMessage(f"an update at ({message.x}, {message.y})")
    try:
        values = np.asarray(message.data, dtype=np.int8).reshape(message.height, message.width)
        grid = OccupancyGrid(values, 1.0)
    except (TypeError, ValueError) as error:
        raise RefusedMessage(str(error)) from None
    return HeardPart(frame, message.x, message.y, grid)


def read_frame(frame: str) -> str:
    """A frame's name without a first slash. Raises ValueError for one that TF could not name."""
    name = frame.removeprefix("/")
    if not name:
        raise ValueError("is empty")
    if name.startswith("/"):
        raise ValueError("begins with more than one '/'")
    if len(name) > _LONGEST_FRAME:
        raise ValueError(f"has {len(name)} characters")
    if not all("!" <= character <= "~" for character in name):
        raise ValueError("has other than printable ASCII characters")
    return name


def _read_header(header: Any) -> str:
    """The frame."""
    if header.stamp.nanosec >= 10**9:
        raise RefusedMessage(f"header.stamp: has {header.stamp.nanosec} ns")
    try:
        return read_frame(header.frame_id)
    except ValueError as error:
        raise RefusedMessage(f"header.frame_id: {error}") from None


def _check_size(width: int, height: int, values: int) -> None:
    if width == 0 or height == 0:
        raise RefusedMessage(f"a size of {width} x {height} cells")
    if width * height > MOST_CELLS:
        raise RefusedMessage(f"{width} x {height} cells are above 2^28")
    if values != width * height:
        raise RefusedMessage(f"{values} values for {width} x {height} cells")
