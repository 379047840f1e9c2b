# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import math
import random
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from gridmerge_ros.messages import RefusedMessage, read_frame, read_map, read_update
from messages_like_ros import map_message, update_message


def test_a_map() -> None:
    heard = read_map(map_message([-1, 0, 100, 0, 0, 100], 3, 2, "/tb1/map", 7))
    assert heard.frame == "tb1/map"
    assert heard.grid.shape == (2, 3)
    assert heard.grid.resolution == 0.05
    assert tuple(heard.grid.origin) == (-1.0, 2.0, 0.0)
    assert heard.grid.to_numpy().tolist() == [[-1, 0, 100], [0, 0, 100]]


def test_an_update() -> None:
    message = update_message([0, 100, -1, 0], 2, 2)
    message.x, message.y = 3, 4
    part = read_update(message)
    assert (part.column, part.row, part.frame) == (3, 4, "tb1/map")
    assert part.grid.to_numpy().tolist() == [[0, 100], [-1, 0]]


def spoil(path: str, value: object) -> Callable[[Any], None]:
    def apply(message: Any) -> None:
        *parents, field = path.split(".")
        for parent in parents:
            message = getattr(message, parent)
        setattr(message, field, value)

    return apply


WRONG = [
    ("info.width", 0, "a size of 0 x 2"),
    ("info.height", 0, "a size of 3 x 0"),
    ("info.width", 2, "6 values for 2 x 2"),
    ("info.width", 2**32 - 1, "above 2^28"),
    ("info.resolution", math.nan, "info.resolution"),
    ("info.resolution", math.inf, "info.resolution"),
    ("info.resolution", 0.0, "info.resolution"),
    ("info.resolution", -0.05, "info.resolution"),
    ("info.resolution", 1e30, "info.resolution"),
    ("info.origin.position.x", math.nan, "info.origin.position"),
    ("info.origin.position.y", math.inf, "info.origin.position"),
    ("info.origin.position.x", 1e300, "info.origin"),
    ("info.origin.position.y", -1.1e7, "info.origin.position"),
    ("info.origin.position.z", math.nan, "info.origin.position"),
    ("info.resolution", 1e-7, "info.resolution"),
    ("info.resolution", 1001.0, "info.resolution"),
    ("header.stamp.nanosec", 10**9, "header.stamp"),
    ("info.origin.orientation.w", 0.7, "info.origin.orientation"),
    ("info.origin.orientation.z", math.nan, "info.origin.orientation"),
    ("info.origin.orientation.x", 0.7, "info.origin.orientation"),
    ("header.frame_id", "", "header.frame_id"),
    ("header.frame_id", "/", "header.frame_id"),
    ("header.frame_id", "a b", "header.frame_id"),
    ("header.frame_id", "a\0b", "header.frame_id"),
    ("header.frame_id", "é", "header.frame_id"),
    ("header.frame_id", "f" * 256, "256 characters"),
    ("header.frame_id", "//map", "more than one '/'"),
]


@pytest.mark.parametrize(("path", "value", "why"), WRONG)
def test_what_is_no_map(path: str, value: object, why: str) -> None:
    message = map_message([-1, 0, 100, 0, 0, 100], 3, 2)
    spoil(path, value)(message)
    with pytest.raises(RefusedMessage) as refused:
        read_map(message)
    assert why in str(refused.value)


@pytest.mark.parametrize("value", [-128, -2, 101, 127])
def test_cells_that_are_none(value: int) -> None:
    with pytest.raises(RefusedMessage):
        read_map(map_message([0, value], 2, 1))
    with pytest.raises(RefusedMessage):
        read_update(update_message([0, value], 2, 1))


@pytest.mark.parametrize(
    ("path", "value"),
    [("x", -1), ("y", -(2**31)), ("width", 0), ("height", 3), ("width", 2**32 - 1), ("header.frame_id", "")],
)
def test_what_is_no_update(path: str, value: object) -> None:
    message = update_message([0, 100, -1, 0], 2, 2)
    spoil(path, value)(message)
    with pytest.raises(RefusedMessage):
        read_update(message)


def test_whatever_a_message_says_it_is_read_or_refused() -> None:
    chance = random.Random(5)
    numbers = [0.0, -0.0, 1.0, -1.0, 0.5, math.nan, math.inf, -math.inf, 1e-30, 1e30, 0.05]
    sizes = [0, 1, 2, 3, 6, 2**16, 2**31, 2**32 - 1]
    read = 0
    for _ in range(3000):
        message = map_message([chance.choice([-1, 0, 50, 100, -7, 120]) for _ in range(6)], 3, 2)
        if chance.random() < 0.7:
            message.data = map_message([chance.choice([-1, 0, 100]) for _ in range(6)], 3, 2).data
        for path in ("info.width", "info.height"):
            if chance.random() < 0.2:
                spoil(path, chance.choice(sizes))(message)
        paths = ["info.resolution", "info.origin.position.x"]
        paths += [f"info.origin.orientation.{axis}" for axis in "xyzw"]
        for path in paths:
            if chance.random() < 0.15:
                spoil(path, chance.choice(numbers))(message)
        expected = np.array(message.data, np.int8)
        try:
            heard = read_map(message)
        except RefusedMessage:
            continue
        read += 1
        assert (heard.grid.to_numpy().ravel() == expected).all()
        assert all(math.isfinite(value) for value in (*heard.grid.origin, heard.grid.resolution))
    assert 100 < read < 2500


def test_a_turn_that_is_not_set_is_none() -> None:
    message = map_message([0], 1, 1)
    message.info.origin.orientation.w = 0.0
    assert read_map(message).grid.origin.theta == 0.0


def test_frames() -> None:
    assert read_frame("/map") == "map"
    assert read_frame("tb1/map") == "tb1/map"
