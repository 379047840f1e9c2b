# SPDX-License-Identifier: Apache-2.0
"""What is published when, by a node that only writes it down."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from gridmerge import OccupancyGrid, TeamAnswer, TeamComponent, Transform

pytest.importorskip("rclpy", reason="tests beside ROS 2: './dev test --ros' runs them")

from gridmerge_ros.parameters import read_settings
from gridmerge_ros.publishers import Publishers
from gridmerge_ros.status import Diagnosis, NamedTransform
from rclpy.qos import DurabilityPolicy
from rclpy.time import Time


class Topic:
    def __init__(self, name: str, qos: Any) -> None:
        self.name = name
        self.qos = qos
        self.sent: list[Any] = []

    def publish(self, message: Any) -> None:
        self.sent.append(message)


class Notes:
    """A node's methods: `topics` are those that are there, in their order."""

    def __init__(self) -> None:
        self.topics: list[Topic] = []

    def resolve_topic_name(self, name: str) -> str:
        return f"/fleet/{name}"

    def create_publisher(self, kind: Any, name: str, qos: Any) -> Topic:
        self.topics.append(Topic(name, qos))
        return self.topics[-1]

    def destroy_publisher(self, topic: Topic) -> None:
        self.topics.remove(topic)

    def get_clock(self) -> Any:
        return self

    def now(self) -> Time:
        return Time(seconds=42)

    def on(self, name: str) -> Topic:
        (topic,) = [one for one in self.topics if one.name == name]
        return topic


def publishers(**parameters: object) -> tuple[Notes, Publishers]:
    node: Any = Notes()
    return node, Publishers(node, read_settings(parameters))


def answer(*values: int | None) -> TeamAnswer:
    """With a component for each value, whose map is of such cells, and a gap in their numbers for each None."""
    grids = {
        number: OccupancyGrid(np.full((2, 3), value, np.int8), 0.05, (1.0, 2.0, 0.5))
        for number, value in enumerate(values, 1)
        if value is not None
    }
    components = tuple(TeamComponent(number, "a", ("a", "b"), grid) for number, grid in grids.items())
    return TeamAnswer(1, components, (), (), 0.0, True)


def transform(child: str, x: float) -> NamedTransform:
    return NamedTransform("world", child, Transform(x, 0.0, 1.0))


def test_maps_are_sent_when_they_have_changed() -> None:
    node, one = publishers(world_frame="hall")
    merged = node.on("/fleet/merged_map")
    assert merged.qos.durability == DurabilityPolicy.TRANSIENT_LOCAL
    one.send_maps(answer())
    assert merged.sent == []
    one.send_maps(answer(0))
    one.send_maps(answer(0))
    one.send_maps(answer(100))
    assert [message.data.tolist() for message in merged.sent] == [[0] * 6, [100] * 6]
    assert (merged.sent[0].header.frame_id, merged.sent[0].header.stamp.sec) == ("hall", 42)


def test_each_component_has_a_topic_while_it_is_there() -> None:
    node, one = publishers()
    one.send_maps(answer(0, 100, 0))
    assert [message.header.frame_id for message in node.on("/fleet/merged_map_2").sent] == ["world_2"]
    assert node.on("/fleet/merged_map_3").sent[0].data.tolist() == [0] * 6
    one.send_maps(answer(0))
    assert [topic.name for topic in node.topics if "merged" in topic.name] == ["/fleet/merged_map"]
    assert len(node.on("/fleet/merged_map").sent) == 1
    # Who listens from now on gets no map of a component that is no more.
    first = node.on("/fleet/merged_map")
    one.send_maps(answer())
    assert node.on("/fleet/merged_map") is not first
    assert node.on("/fleet/merged_map").sent == []
    one.send_maps(answer(0))
    assert len(node.on("/fleet/merged_map").sent) == 1


def test_a_component_keeps_its_topic_when_another_one_goes() -> None:
    node, one = publishers()
    one.send_maps(answer(0, 100))
    second = node.on("/fleet/merged_map_2")
    one.send_maps(answer(None, 100))
    assert node.on("/fleet/merged_map_2") is second
    assert len(second.sent) == 1
    assert node.on("/fleet/merged_map").sent == []


def test_static_transforms() -> None:
    node, one = publishers()
    static = node.on("/tf_static")
    assert static.qos.durability == DurabilityPolicy.TRANSIENT_LOCAL
    one.send_transforms([])
    one.send_transforms([transform("a/map", 1.0)])
    one.send_transforms([transform("a/map", 1.0)])
    one.send_transforms([transform("a/map", 1.0), transform("b/map", 2.0)])
    assert [len(message.transforms) for message in static.sent] == [1, 2]
    stamped = static.sent[0].transforms[0]
    assert (stamped.header.frame_id, stamped.child_frame_id, stamped.header.stamp.sec) == (
        "world",
        "a/map",
        42,
    )
    assert stamped.transform.translation.x == 1.0
    assert stamped.transform.rotation.z == pytest.approx(np.sin(0.5))
    one.send_transforms([])
    assert node.on("/tf_static") is not static
    one.send_transforms([transform("a/map", 1.0)])
    assert len(node.on("/tf_static").sent) == 1


def test_dynamic_transforms() -> None:
    node, one = publishers(transforms="dynamic")
    for _ in range(3):
        one.send_transforms([transform("a/map", 1.0)])
    one.send_transforms([])
    assert len(node.on("/tf").sent) == 3
    node, one = publishers(transforms="none")
    one.send_transforms([transform("a/map", 1.0)])
    assert {topic.name for topic in node.topics} == {"/diagnostics", "/fleet/merged_map"}


def test_diagnoses() -> None:
    node, one = publishers()
    one.send_diagnoses([Diagnosis(1, "gridmerge: tb1", "left out", "tb1", (("state", "left_out"),))])
    (message,) = node.on("/diagnostics").sent
    (status,) = message.status
    assert (status.level, status.name, status.hardware_id) == (b"\x01", "gridmerge: tb1", "tb1")
    assert [(one.key, one.value) for one in status.values] == [("state", "left_out")]
    assert message.header.stamp.sec == 42


def test_nothing_is_left() -> None:
    node, one = publishers()
    one.send_maps(answer(0, 100))
    one.close()
    assert node.topics == []
