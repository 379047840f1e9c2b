# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import array
import json
import math
import pickle
import tracemalloc
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
    assert grid.resolution == 0.05  # as a map file has it


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


def empty_message() -> Any:
    """As the class of a ROS 2 message makes it."""
    stamp = Fields(sec=0, nanosec=0)
    origin = Fields(position=Fields(x=0.0, y=0.0, z=0.0), orientation=Fields(x=0.0, y=0.0, z=0.0, w=1.0))
    info = Fields(map_load_time=Fields(sec=0, nanosec=0), resolution=0.0, width=0, height=0, origin=origin)
    return Fields(header=Fields(stamp=stamp, frame_id=""), info=info, data=array.array("b"))


GRID = gridmerge.OccupancyGrid(np.array(VALUES, dtype=np.int8).reshape(3, 4), 0.05, (1.5, -2.0, 2.5))


@pytest.mark.parametrize("message_class", [None, empty_message])
def test_a_message_of_a_map_gives_the_map(message_class: Any) -> None:
    back = gridmerge.OccupancyGrid.from_msg(GRID.to_msg(message_class, frame_id="robot_1/map"))
    np.testing.assert_array_equal(back.to_numpy(), GRID.to_numpy())
    assert back.resolution == GRID.resolution
    assert tuple(back.origin) == pytest.approx(tuple(GRID.origin), abs=1e-15)
    assert back.frame_id == "robot_1/map"
    assert back.to_msg(message_class) == GRID.to_msg(message_class, frame_id="robot_1/map"), "twice the same"


def test_a_message_as_json() -> None:
    fields = json.loads(json.dumps(GRID.to_msg()))
    assert fields["header"] == {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": "map"}
    assert (fields["info"]["width"], fields["info"]["height"]) == (4, 3)
    assert fields["data"] == VALUES
    assert gridmerge.OccupancyGrid.from_msg(fields).origin.theta == pytest.approx(2.5)


def test_a_message_of_a_class_keeps_what_is_not_of_the_map() -> None:
    filled = GRID.to_msg(empty_message)
    assert filled.data == array.array("b", VALUES)
    assert filled.header.stamp.sec == 0
    stamp = Fields(sec=5, nanosec=7)
    stamped = GRID.to_msg(empty_message, stamp=stamp)
    assert stamped.header.stamp is stamp
    assert stamped.info.map_load_time is stamp
    assert isinstance(stamped.info.resolution, float)


def test_merged_maps_become_messages(robots: list[str]) -> None:
    merged = gridmerge.merge(robots[:2]).components[0].grid
    back = gridmerge.OccupancyGrid.from_msg(merged.to_msg())
    np.testing.assert_array_equal(back.cells, merged.cells)
    percent = gridmerge.OccupancyGrid.from_msg(merged.to_msg(probabilities=True)).probability
    assert percent is not None
    assert merged.probability is not None
    np.testing.assert_allclose(percent, merged.probability, atol=0.0051)


def test_what_no_message_can_be_made_of() -> None:
    unwritable: Any = 5
    with pytest.raises(TypeError, match="^frame_id: must be a string, is of type int"):
        GRID.to_msg(frame_id=unwritable)
    with pytest.raises(TypeError, match="^message_class: must be a class of messages, is of type str"):
        GRID.to_msg(unwritable if False else "nav_msgs/OccupancyGrid")  # type: ignore[call-overload]
    with pytest.raises(ValueError, match="probabilities"):
        gridmerge.OccupancyGrid(np.zeros((2, 2), dtype=np.int8), 0.1).to_msg(probabilities=True)


def named(frame_id: Any, yaw: float) -> Any:
    one = message(yaw=yaw)
    one.header = Fields(frame_id=frame_id)
    return one


def test_maps_are_called_by_their_frames() -> None:
    result = gridmerge.merge([named("robot_1/map", 0.1), message(), named("robot_2/map", 0.2)])
    assert result.names == ("robot_1/map", "map 1", "robot_2/map")
    assert gridmerge.merge([named("map", 0.1), named("map", 0.2), named("", 0.3)]).names == (
        "map 0",
        "map 1",
        "map 2",
    ), "a frame that several are in names none of them"
    assert gridmerge.merge([named("a", 0.1), named("b", 0.2)], names=["c", "d"]).names == ("c", "d")
    posed = gridmerge.merge(
        [named("a", 0.1), named("b", 0.2)], init={"a": (0.0, 0.0, 0.0), "b": (1.0, 0.0, 0.0)}
    )
    assert posed.names == ("a", "b")
    merger = gridmerge.Merger()
    for frame in ("a", "a", "b"):
        merger.add(named(frame, 0.1))
    merger.add(named("c", 0.1), name="d")
    assert merger.solve().names == ("map 0", "map 1", "b", "d")


def test_a_frame_goes_with_its_map() -> None:
    grid = gridmerge.OccupancyGrid.from_msg(named("robot_1/map", 0.1))
    assert pickle.loads(pickle.dumps(grid)).frame_id == "robot_1/map"
    assert grid.to_msg()["header"]["frame_id"] == "robot_1/map"
    assert gridmerge.OccupancyGrid.from_msg(message()).frame_id is None
    with pytest.raises(TypeError, match=r"^moving.header.frame_id: must be a string, is of type int"):
        gridmerge.match(message(), named(7, 0.1))
    with pytest.raises(ValueError, match=r"^header.frame_id: "):
        gridmerge.OccupancyGrid.from_msg(named("\ud800", 0.1))


def test_a_dict_that_lacks_a_field() -> None:
    fields = GRID.to_msg()
    del fields["info"]["origin"]["position"]["y"]
    with pytest.raises(TypeError, match=r"^fixed.info.origin.position.y: the message has no such field"):
        gridmerge.match(fields, GRID)
    with pytest.raises(TypeError, match=r"^maps: must be a sequence of maps, is of type dict"):
        gridmerge.merge(fields)


def test_the_times_of_a_message_are_two(robots: list[str]) -> None:
    for stamp in (None, {"sec": 3, "nanosec": 0}):
        message = gridmerge.load(robots[0]).to_msg(stamp=stamp)
        message["header"]["stamp"]["sec"] = 5
        assert message["info"]["map_load_time"]["sec"] != 5


def test_a_message_of_a_class_is_made_without_a_list_of_its_cells() -> None:
    grid = gridmerge.OccupancyGrid(np.zeros((1500, 1500), dtype=np.int8), 0.05)
    empty = Fields(header=Fields(), info=Fields(origin=Fields(position=Fields(), orientation=Fields())))
    tracemalloc.start()
    try:
        grid.to_msg(lambda: empty)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 4 * 1500 * 1500  # [bytes]; a list takes eight for each cell


def test_data_of_two_dimensions_has_the_shape_of_the_map() -> None:
    values = np.arange(12, dtype=np.int8).reshape(3, 4)
    message = gridmerge.OccupancyGrid(values, 0.05).to_msg()
    for data in (values, values.tolist()):
        np.testing.assert_array_equal(
            gridmerge.OccupancyGrid.from_msg({**message, "data": data}).to_numpy(), values
        )
    wrong: list[Any] = [values.T.copy(), values.reshape(4, 3).tolist(), values.reshape(1, 3, 4)]
    for data in wrong:
        with pytest.raises(ValueError, match=r"^data: is of shape"):
            gridmerge.OccupancyGrid.from_msg({**message, "data": data})
