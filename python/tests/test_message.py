# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import array
import math
from types import SimpleNamespace as Fields
from typing import Any

import gridmerge
import numpy as np
import pytest

VALUES = [-1, 0, 19, 20, 64, 65, 100, 50, 3, -1, 0, 100]


def message(data: Any = None, yaw: float = 0.3) -> Any:
    """As rclpy makes them, but for the classes."""
    position = Fields(x=1.5, y=-2.0, z=0.0)
    orientation = Fields(x=0.0, y=0.0, z=math.sin(0.5 * yaw), w=math.cos(0.5 * yaw))
    info = Fields(width=4, height=3, resolution=0.05000000074505806)
    info.origin = Fields(position=position, orientation=orientation)
    return Fields(info=info, data=array.array("b", VALUES) if data is None else data)


@pytest.mark.parametrize(
    "data",
    [
        array.array("b", VALUES),
        VALUES,
        tuple(VALUES),
        np.array(VALUES, dtype=np.int8),
        np.array(VALUES, dtype=np.int8).reshape(3, 4),
        np.array(VALUES, dtype=np.int8)[::-1].copy()[::-1],
        memoryview(array.array("b", VALUES)),
        [np.int8(value) for value in VALUES],
    ],
)
def test_every_kind_of_data(data: Any) -> None:
    grid = gridmerge.OccupancyGrid.from_msg(message(data))
    assert grid.shape == (3, 4)
    np.testing.assert_array_equal(grid.to_numpy().reshape(-1), VALUES)
    assert grid.resolution == 0.05000000074505806


@pytest.mark.parametrize("yaw", [0.0, 0.3, -2.0, math.pi, 3.0, -3.1])
def test_origin(yaw: float) -> None:
    origin = gridmerge.OccupancyGrid.from_msg(message(yaw=yaw)).origin
    assert (origin.x, origin.y) == (1.5, -2.0)
    assert math.isclose(math.remainder(origin.theta - yaw, 2.0 * math.pi), 0.0, abs_tol=1e-15)


def test_the_other_sign_of_a_quaternion_is_the_same_turn() -> None:
    turned = message(yaw=2.5)
    orientation = turned.info.origin.orientation
    orientation.z, orientation.w = -orientation.z, -orientation.w
    assert gridmerge.OccupancyGrid.from_msg(turned).origin.theta == pytest.approx(2.5, abs=1e-15)


def test_matching_and_merging_take_messages(robots: list[str]) -> None:
    messages = []
    for path in robots[:2]:
        grid = gridmerge.load(path)
        one = message(array.array("b", grid.to_numpy().tobytes()), yaw=0.0)
        one.info.width, one.info.height, one.info.resolution = grid.width, grid.height, grid.resolution
        one.info.origin.position.x, one.info.origin.position.y = grid.origin.x, grid.origin.y
        messages.append(one)
    of_messages, of_files = gridmerge.match(*messages), gridmerge.match(*robots[:2])
    assert of_messages.transform == of_files.transform
    assert of_messages.hypotheses == of_files.hypotheses
    merged = gridmerge.merge(messages)
    assert merged.names == ("map 0", "map 1")
    assert merged.components[0].grid == gridmerge.merge(robots[:2]).components[0].grid


PATHS = [
    "info",
    "data",
    "info.width",
    "info.height",
    "info.resolution",
    "info.origin",
    "info.origin.position",
    "info.origin.position.x",
    "info.origin.position.y",
    "info.origin.orientation",
    "info.origin.orientation.x",
    "info.origin.orientation.w",
]


def parent_of(of: Any, path: str) -> tuple[Any, str]:
    *parts, last = path.split(".")
    for part in parts:
        of = getattr(of, part)
    return of, last


@pytest.mark.parametrize("path", PATHS)
def test_missing_fields(path: str) -> None:
    lacking = message()
    delattr(*parent_of(lacking, path))
    with pytest.raises(TypeError, match=f"^{path}[.\\w]*: the message has no such field"):
        gridmerge.OccupancyGrid.from_msg(lacking)
    with pytest.raises(
        TypeError, match=f"^fixed.{path}[.\\w]*: " if path not in ("info", "data") else "^fixed"
    ):
        gridmerge.match(lacking, lacking)


NAN = float("nan")
WRONG: list[tuple[type[Exception], str, Any]] = [
    (ValueError, "info.width", 0),
    (ValueError, "info.width", -4),
    (ValueError, "info.width", 2**40),
    (TypeError, "info.width", 4.0),
    (TypeError, "info.width", "4"),
    (TypeError, "info.width", None),
    (TypeError, "info.width", True),
    (ValueError, "info.height", 0),
    (ValueError, "info.resolution", 0.0),
    (ValueError, "info.resolution", -1.0),
    (ValueError, "info.resolution", NAN),
    (TypeError, "info.resolution", "0.05"),
    (ValueError, "info.origin.position.x", NAN),
    (ValueError, "info.origin.position.y", float("inf")),
    (TypeError, "info.origin.position.y", None),
    (ValueError, "info.origin.orientation.z", NAN),
    (ValueError, "info.origin.orientation", Fields(x=0.0, y=0.0, z=0.0, w=0.0)),
    (ValueError, "info.origin.orientation", Fields(x=0.0, y=0.0, z=0.0, w=2.0)),
    (ValueError, "info.origin.orientation", Fields(x=1e200, y=0.0, z=0.0, w=1.0)),
    (ValueError, "info.origin.orientation", Fields(x=1.0, y=0.0, z=0.0, w=0.0)),
    (ValueError, "info.origin.orientation", Fields(x=0.01, y=0.0, z=0.0, w=math.sqrt(1 - 1e-4))),
    (ValueError, "data", VALUES[:-1]),
    (ValueError, "data", [*VALUES, 0]),
    (ValueError, "data", []),
    (ValueError, "data", [*VALUES[:-1], 101]),
    (ValueError, "data", [*VALUES[:-1], -2]),
    (ValueError, "data", [*VALUES[:-1], 10**6]),
    (ValueError, "data", np.full(12, 101, dtype=np.int8)),
    (TypeError, "data", [*VALUES[:-1], 0.5]),
    (TypeError, "data", [*VALUES[:-1], NAN]),
    (TypeError, "data", [*VALUES[:-1], None]),
    (TypeError, "data", [*VALUES[:-1], 10**30]),
    (TypeError, "data", [[1, 2], [3]]),
    (TypeError, "data", np.zeros(12)),
    (TypeError, "data", np.zeros(12, dtype=np.uint8)),
    (TypeError, "data", array.array("B", [0] * 12)),
    (TypeError, "data", "000000000000"),
    (TypeError, "data", bytes(12)),
    (TypeError, "data", None),
    (TypeError, "data", np.ma.masked_array(np.zeros(12, dtype=np.int8), mask=True)),
]


@pytest.mark.parametrize(("error", "path", "value"), WRONG)
def test_wrong_fields(error: type[Exception], path: str, value: Any) -> None:
    wrong = message()
    parent, last = parent_of(wrong, path)
    setattr(parent, last, value)
    with pytest.raises(error, match=f"^{path}: "):
        gridmerge.OccupancyGrid.from_msg(wrong)
    with pytest.raises(error, match=f"^moving.{path}: "):
        gridmerge.match(message(), wrong)


def test_too_many_cells() -> None:
    huge = message(np.broadcast_to(np.int8(0), (2**15, 2**14)))
    huge.info.width, huge.info.height = 2**14, 2**15
    with pytest.raises(
        ValueError, match=r"^data: has more than 268435456 cells: its shape is \(32768, 16384\)"
    ):
        gridmerge.OccupancyGrid.from_msg(huge)
    with pytest.raises(ValueError, match=r"^fixed.data: has more than 268435456 cells"):
        gridmerge.match(huge, huge)


def test_what_is_no_message_at_all() -> None:
    nothing: Any = object()
    with pytest.raises(TypeError, match="^info"):
        gridmerge.OccupancyGrid.from_msg(nothing)
