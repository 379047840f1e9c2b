# SPDX-License-Identifier: Apache-2.0
"""Maps from messages like nav_msgs/OccupancyGrid, whatever made them, and such messages from maps."""

from __future__ import annotations

import array
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from . import _arguments, _core
from ._transform import Transform

# A tilt of a twentieth of a degree: what is left when a flat pose went through 32-bit floats.
_LEAST_UPRIGHT = 1.0 - 4e-7
_UNIT = 1e-3


class OccupancyGridMessage(Protocol):
    """What a map message has to have: the fields of nav_msgs/OccupancyGrid, from ROS 1, ROS 2 or anywhere.

    ``info.width`` and ``info.height`` [cells], ``info.resolution`` [m], ``info.origin.position`` (x, y [m]) and
    ``info.origin.orientation`` (x, y, z, w), and ``data``: width * height values -1 to 100, row 0 at the bottom; an
    array.array, a list, a tuple or a numpy array. ``header.frame_id`` may be there too; it names the map.
    """

    @property
    def info(self) -> Any:
        """Size, resolution and origin of the map."""

    @property
    def data(self) -> Any:
        """The cells, row 0 at the bottom: -1 is unknown, 0 to 100 a probability of being occupied in per cent."""


Stamp: TypeAlias = Any
"""A time as a class of messages has it: of ROS 1, of ROS 2, or a dict."""


@dataclass(frozen=True, slots=True, eq=False)
class Content:
    """What a message says of a map."""

    values: NDArray[np.int8]
    """Of shape (height, width)."""
    resolution: float
    """[m]"""
    origin: Transform
    frame_id: str | None
    """None: it has no header, or an empty name."""


def read_message(message: object, name: str = "") -> Content:
    """What a message, or a mapping with its fields, says.

    `name` is what to call the message in errors, which name the field: TypeError for one that is missing or of a
    wrong type, ValueError for one with a wrong value.
    """
    prefix = f"{name}." if name else ""
    fields = _Fields(message, prefix)
    most = 2**31 - 1
    width = _arguments.whole(f"{prefix}info.width", fields.get("info.width"), 1, most)
    height = _arguments.whole(f"{prefix}info.height", fields.get("info.height"), 1, most)
    # A message has a 32-bit float, a map file the decimal that it was made from.
    resolution = _core.decimal_of(
        _arguments.number(f"{prefix}info.resolution", fields.get("info.resolution"))
    )
    origin = Transform(
        fields.number("info.origin.position.x"), fields.number("info.origin.position.y"), _yaw(fields)
    )
    values = _values(f"{prefix}data", fields.get("data"))
    if values.size != width * height:
        raise ValueError(
            f"{prefix}data: has {values.size} values, but info.width * info.height is {width * height}"
        )
    if values.ndim > 1 and values.shape != (height, width):
        raise ValueError(
            f"{prefix}data: is of shape {values.shape}, but (info.height, info.width) is {(height, width)}"
        )
    return Content(values.reshape(height, width), resolution, origin, fields.frame_id())


def to_fields(content: Content, stamp: Stamp | None) -> dict[str, Any]:
    """The fields of a message as plain values."""
    return {**_fields_but_data(content, stamp), "data": content.values.reshape(-1).tolist()}


def _fields_but_data(content: Content, stamp: Stamp | None) -> dict[str, Any]:
    height, width = content.values.shape
    x, y, theta = content.origin
    time = {"sec": 0, "nanosec": 0} if stamp is None else stamp
    return {
        "header": {"stamp": time, "frame_id": content.frame_id},
        "info": {
            "map_load_time": dict(time) if isinstance(time, dict) else time,
            "resolution": content.resolution,
            "width": width,
            "height": height,
            "origin": {
                "position": {"x": x, "y": y, "z": 0.0},
                "orientation": {"x": 0.0, "y": 0.0, "z": math.sin(0.5 * theta), "w": math.cos(0.5 * theta)},
            },
        },
    }


def fill_message(message: Any, content: Content, stamp: Stamp | None) -> Any:
    """Sets the fields of an empty message, and returns it."""
    fields = _fields_but_data(content, stamp)
    if stamp is None:
        del fields["header"]["stamp"], fields["info"]["map_load_time"]
    # What rclpy holds such data in; rospy takes it as well.
    fields["data"] = array.array("b", content.values.tobytes())
    _set_fields(message, fields)
    return message


def _set_fields(message: Any, fields: dict[str, Any]) -> None:
    for field, value in fields.items():
        if (
            isinstance(value, dict)
            and hasattr(message, field)
            and not isinstance(getattr(message, field), dict)
        ):
            _set_fields(getattr(message, field), value)
        else:
            setattr(message, field, value)


class _Fields:
    def __init__(self, message: object, prefix: str) -> None:
        self._message = message
        self._prefix = prefix

    def get(self, path: str) -> Any:
        value: Any = self._message
        for part in path.split("."):
            if not _has(value, part):
                raise TypeError(f"{self._prefix}{path}: the message has no such field")
            value = _field(value, part)
        return value

    def frame_id(self) -> str | None:
        if not _has(self._message, "header") or not _has(_field(self._message, "header"), "frame_id"):
            return None
        return _arguments.text(f"{self._prefix}header.frame_id", self.get("header.frame_id")) or None

    def number(self, path: str) -> float:
        return _arguments.number(f"{self._prefix}{path}", self.get(path))

    def error(self, path: str, cause: str) -> ValueError:
        return ValueError(f"{self._prefix}{path}: {cause}")


def _has(value: Any, field: str) -> bool:
    return field in value if isinstance(value, Mapping) else hasattr(value, field)


def _field(value: Any, field: str) -> Any:
    return value[field] if isinstance(value, Mapping) else getattr(value, field)


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
