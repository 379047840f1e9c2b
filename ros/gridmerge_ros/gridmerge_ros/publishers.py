# SPDX-License-Identifier: Apache-2.0
"""What the node tells others: merged maps, transforms and diagnostics."""

from __future__ import annotations

import math
from collections.abc import Sequence

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import TransformStamped
from gridmerge import OccupancyGrid, TeamAnswer
from nav_msgs.msg import OccupancyGrid as OccupancyGridMessage
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from tf2_msgs.msg import TFMessage

from gridmerge_ros.names import numbered
from gridmerge_ros.parameters import Settings
from gridmerge_ros.status import Diagnosis, NamedTransform


def latched(depth: int = 1) -> QoSProfile:
    """Reliable, and kept for whoever listens later."""
    return QoSProfile(
        depth=depth, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL
    )


class Publishers:
    """Stamps are of the node's clock, which is that of the simulation where use_sim_time is set."""

    def __init__(self, node: Node, settings: Settings) -> None:
        self._node = node
        self._settings = settings
        self._maps: dict[int, tuple[Publisher, OccupancyGrid | None]] = {}
        """By number of the component, with what was sent last; the first is always there."""
        self._diagnostics = node.create_publisher(DiagnosticArray, "/diagnostics", 10)
        # A remapping of the first map's topic holds for the further ones too.
        self._map_topic = node.resolve_topic_name(settings.merged_map_topic)
        self._transforms: Publisher | None = None
        self._sent: tuple[NamedTransform, ...] = ()
        if settings.transforms == "static":
            self._transforms = self._new_static_publisher()
        elif settings.transforms == "dynamic":
            self._transforms = node.create_publisher(TFMessage, "/tf", 100)
        self._maps[1] = (self._new_map_publisher(1), None)

    def close(self) -> None:
        """Nothing is published any more, and latched messages are gone."""
        for publisher in (*(one for one, _ in self._maps.values()), self._transforms, self._diagnostics):
            if publisher is not None:
                self._node.destroy_publisher(publisher)
        self._maps.clear()

    def send_maps(self, answer: TeamAnswer) -> None:
        """The maps of all components that are not as they were."""
        # A component that is no more takes its latched map along, also that of the first topic.
        for number in self._maps.keys() - {one.number for one in answer.components}:
            publisher, sent = self._maps[number]
            if number == 1 and sent is None:
                continue
            self._node.destroy_publisher(publisher)
            del self._maps[number]
        for number in {1, *(one.number for one in answer.components)} - self._maps.keys():
            self._maps[number] = (self._new_map_publisher(number), None)
        for component in answer.components:
            publisher, sent = self._maps[component.number]
            if sent is not None and sent == component.grid:
                continue
            publisher.publish(
                component.grid.to_msg(
                    OccupancyGridMessage,
                    frame_id=numbered(self._settings.world_frame, component.number),
                    stamp=self._now(),
                    probabilities=False,
                )
            )
            self._maps[component.number] = (publisher, component.grid)

    def send_transforms(self, transforms: Sequence[NamedTransform]) -> None:
        """Static ones are sent when they have changed, dynamic ones each time."""
        if self._transforms is None:
            return
        if self._settings.transforms == "static":
            if tuple(transforms) == self._sent:
                return
            if not transforms:
                # Who comes from now on is not told what was true once.
                self._node.destroy_publisher(self._transforms)
                self._transforms = self._new_static_publisher()
        self._sent = tuple(transforms)
        if not transforms:
            return
        stamp = self._now()
        message = TFMessage()
        for one in transforms:
            stamped = TransformStamped()
            stamped.header.stamp = stamp
            stamped.header.frame_id = one.parent
            stamped.child_frame_id = one.child
            stamped.transform.translation.x = one.T_parent_child.x
            stamped.transform.translation.y = one.T_parent_child.y
            stamped.transform.rotation.z = math.sin(one.T_parent_child.theta / 2.0)
            stamped.transform.rotation.w = math.cos(one.T_parent_child.theta / 2.0)
            message.transforms.append(stamped)
        self._transforms.publish(message)

    def send_diagnoses(self, diagnoses: Sequence[Diagnosis]) -> None:
        """All in one message."""
        message = DiagnosticArray()
        message.header.stamp = self._now()
        for one in diagnoses:
            status = DiagnosticStatus()
            status.level = bytes([one.level])
            status.name = one.name
            status.message = one.message
            status.hardware_id = one.hardware
            status.values = [KeyValue(key=key, value=value) for key, value in one.values]
            message.status.append(status)
        self._diagnostics.publish(message)

    def _new_map_publisher(self, number: int) -> Publisher:
        topic = numbered(self._map_topic, number)
        return self._node.create_publisher(OccupancyGridMessage, topic, latched())

    def _new_static_publisher(self) -> Publisher:
        return self._node.create_publisher(TFMessage, "/tf_static", latched())

    def _now(self) -> object:
        return self._node.get_clock().now().to_msg()
