# SPDX-License-Identifier: Apache-2.0
"""Messages with the fields of ROS's own, for tests that need no ROS."""

from __future__ import annotations

import array
from types import SimpleNamespace
from typing import Any


def header(frame: str, second: int) -> Any:
    return SimpleNamespace(frame_id=frame, stamp=SimpleNamespace(sec=second, nanosec=0))


def map_message(values: list[int], width: int, height: int, frame: str = "tb1/map", second: int = 100) -> Any:
    origin = SimpleNamespace(
        position=SimpleNamespace(x=-1.0, y=2.0, z=0.0),
        orientation=SimpleNamespace(x=0.0, y=0.0, z=0.0, w=1.0),
    )
    # As 32 bits have it.
    info = SimpleNamespace(resolution=0.05000000074505806, width=width, height=height, origin=origin)
    return SimpleNamespace(header=header(frame, second), info=info, data=array.array("b", values))


def update_message(
    values: list[int], width: int, height: int, frame: str = "tb1/map", second: int = 100
) -> Any:
    data = array.array("b", values)
    return SimpleNamespace(header=header(frame, second), x=0, y=0, width=width, height=height, data=data)
