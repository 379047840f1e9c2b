# SPDX-License-Identifier: Apache-2.0
"""Maps from messages like nav_msgs/OccupancyGrid, whatever made them."""

from __future__ import annotations

import math
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from . import _arguments
from ._transform import Transform

# A tilt of a twentieth of a degree: what is left when a flat pose went through 32-bit floats.
_LEAST_UPRIGHT = 1.0 - 4e-7
_UNIT = 1e-3


class OccupancyGridMessage(Protocol):
    """What a map message has to have: the fields of nav_msgs/OccupancyGrid, from ROS 1, ROS 2 or anywhere.

    ``info.width`` and ``info.height`` [cells], ``info.resolution`` [m], ``info.origin.position`` (x, y [m]) and
    ``info.origin.orientation`` (x, y, z, w), and ``data``: width * height values -1 to 100, row 0 at the bottom; an
    array.array, a list, a tuple or a numpy array.
    """

    @property
    def info(self) -> Any: ...

    @property
    def data(self) -> Any: ...


def read_message(message: object, name: str = "") -> tuple[NDArray[np.int8], float, Transform]:
    """Data of shape (height, width), the resolution [m] and the origin of a message.

    `name` is what to call the message in errors, which name the field: TypeError for one that is missing or of a
    wrong type, ValueError for one with a wrong value.
    """
    prefix = f"{name}." if name else ""
    fields = _Fields(message, prefix)
    most = 2**31 - 1
    width = _arguments.whole(f"{prefix}info.width", fields.get("info.width"), 1, most)
    height = _arguments.whole(f"{prefix}info.height", fields.get("info.height"), 1, most)
    resolution = _arguments.number(f"{prefix}info.resolution", fields.get("info.resolution"))
    origin = Transform(
        fields.number("info.origin.position.x"), fields.number("info.origin.position.y"), _yaw(fields)
    )
    values = _values(f"{prefix}data", fields.get("data"))
    if values.size != width * height:
        raise ValueError(
            f"{prefix}data: has {values.size} values, but info.width * info.height is {width * height}"
        )
    return values.reshape(height, width), resolution, origin


class _Fields:
    def __init__(self, message: object, prefix: str) -> None:
        self._message = message
        self._prefix = prefix

    def get(self, path: str) -> Any:
        value: Any = self._message
        for part in path.split("."):
            if not hasattr(value, part):
                raise TypeError(f"{self._prefix}{path}: the message has no such field")
            value = getattr(value, part)
        return value

    def number(self, path: str) -> float:
        return _arguments.number(f"{self._prefix}{path}", self.get(path))

    def error(self, path: str, cause: str) -> ValueError:
        return ValueError(f"{self._prefix}{path}: {cause}")


def _yaw(fields: _Fields) -> float:
    path = "info.origin.orientation"
    x, y, z, w = (fields.number(f"{path}.{axis}") for axis in "xyzw")
    if abs(x) > 1.0 + _UNIT or abs(y) > 1.0 + _UNIT or abs(z) > 1.0 + _UNIT or abs(w) > 1.0 + _UNIT:
        raise fields.error(path, "must be a quaternion of length 1")
    length = math.sqrt(x * x + y * y + z * z + w * w)
    if abs(length - 1.0) > _UNIT:
        raise fields.error(
            path, f"must be a quaternion of length 1, not {length:.6g} (upright is 0, 0, 0, 1)"
        )
    if 1.0 - 2.0 * (x * x + y * y) / (length * length) < _LEAST_UPRIGHT:
        raise fields.error(path, "the map is tilted: only a turn about z is a map's")
    return 2.0 * math.atan2(z, w)


def _values(name: str, data: object) -> NDArray[np.int8]:
    if isinstance(data, np.ma.MaskedArray):
        raise TypeError(f"{name}: masked arrays are not taken; data.filled(-1) makes masked cells unknown")
    if isinstance(data, (list, tuple)):
        return _listed_values(name, data)
    if isinstance(data, (str, bytes, bytearray)):
        raise TypeError(f"{name}: must hold int8 values, is {_arguments.kind_of(data)}")
    try:
        values = np.asarray(data)
    except (TypeError, ValueError) as error:
        raise TypeError(f"{name}: cannot be read as an array: {error}") from None
    if values.dtype != np.int8:
        raise TypeError(f"{name}: must hold int8 values, holds {values.dtype}")
    return values


def _listed_values(name: str, data: list[Any] | tuple[Any, ...]) -> NDArray[np.int8]:
    if not data:
        return np.empty(0, dtype=np.int8)
    try:
        values = np.array(data)
    except (TypeError, ValueError, OverflowError) as error:
        raise TypeError(f"{name}: cannot be read as an array: {error}") from None
    if values.dtype.kind not in "iu":
        raise TypeError(f"{name}: must hold whole numbers, holds {values.dtype}")
    wrong = values[(values < -1) | (values > 100)]
    if wrong.size:
        raise ValueError(
            f"{name}: the value {wrong[0]} is neither -1 (unknown) nor a percentage from 0 to 100"
        )
    return values.astype(np.int8)
