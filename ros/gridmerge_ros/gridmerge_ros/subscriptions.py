# SPDX-License-Identifier: Apache-2.0
"""Who publishes maps, and what they send."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import OccupancyGrid
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message
from rclpy.subscription import Subscription
from rclpy.topic_endpoint_info import TopicEndpointInfo

from gridmerge_ros.ages import read_ages
from gridmerge_ros.names import Selection
from gridmerge_ros.robots import KnownPose, Publisher, Robots

try:
    from map_msgs.msg import OccupancyGridUpdate
except ImportError:
    OccupancyGridUpdate = None

HEARS_UPDATES = OccupancyGridUpdate is not None

MAP_TYPE = "nav_msgs/msg/OccupancyGrid"
UPDATE_TYPE = "map_msgs/msg/OccupancyGridUpdate"

MessageInfo = Mapping[str, Any]
"""What rclpy says of a message."""

_MAPS_KEPT = 1
_UPDATES_KEPT = 64
# Of all programs that diagnose themselves. Best effort takes what anybody offers; who tells an age tells it again.
_DIAGNOSES = QoSProfile(
    history=HistoryPolicy.KEEP_LAST,
    depth=64,
    reliability=ReliabilityPolicy.BEST_EFFORT,
    durability=DurabilityPolicy.VOLATILE,
)


def matching_qos(publishers: Sequence[TopicEndpointInfo], depth: int) -> QoSProfile:
    """The most that every one of the publishers offers: a subscription that asks for more is not served."""
    profiles = [one.qos_profile for one in publishers]
    reliable = all(one.reliability == ReliabilityPolicy.RELIABLE for one in profiles)
    latched = all(one.durability == DurabilityPolicy.TRANSIENT_LOCAL for one in profiles)
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=depth,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
    )


class MapSubscriptions:
    """Discovers robots, and hears their maps.

    Args:
        node: subscribes.
        selection: which topics are robots' maps.
        robots: are given what is heard.
        known_pose: what the parameters say of where a robot's map lies.
    """

    def __init__(
        self,
        node: Node,
        selection: Selection,
        robots: Robots,
        known_pose: Callable[[str], KnownPose | str | None],
    ) -> None:
        self._node = node
        self._selection = selection
        self._robots = robots
        self._known_pose = known_pose
        self._subscriptions: dict[str, tuple[QoSProfile, Subscription]] = {}
        self._diagnoses = node.create_subscription(
            DiagnosticArray, "/diagnostics", self._hear_diagnoses, _DIAGNOSES, raw=True
        )

    def discover(self) -> None:
        """Subscribes to what is new, as its publishers send it."""
        for topic, types in sorted(self._node.get_topic_names_and_types()):
            name = self._selection.robot_of(topic) if MAP_TYPE in types else None
            if name is None:
                continue
            publishers = self._publishers_of(topic, MAP_TYPE)
            is_new = name not in self._robots
            if is_new and not (publishers and self._robots.add(name, topic, self._known_pose(name))):
                continue
            self._follow(topic, OccupancyGrid, publishers, _MAPS_KEPT, partial(self._hear_map, name, topic))
            if OccupancyGridUpdate is not None:
                updates = self._selection.updates_of(topic)
                senders = self._publishers_of(updates, UPDATE_TYPE)
                self._follow(
                    updates, OccupancyGridUpdate, senders, _UPDATES_KEPT, partial(self._hear_update, name)
                )
        # Topics that nobody publishes any more are not listed at all.
        for name, robot in self._robots.all.items():
            self._robots.set_publishers(name, self._numbers_of(robot.topic))

    def close(self) -> None:
        """Hears no more."""
        for _, subscription in self._subscriptions.values():
            self._node.destroy_subscription(subscription)
        self._subscriptions.clear()
        self._node.destroy_subscription(self._diagnoses)

    def _follow(
        self,
        topic: str,
        kind: Any,
        publishers: Sequence[TopicEndpointInfo],
        depth: int,
        callback: Callable[[bytes, MessageInfo], None],
    ) -> None:
        if not publishers:
            return
        qos = matching_qos(publishers, depth)
        before = self._subscriptions.get(topic)
        if before is not None:
            if before[0] == qos:
                return
            self._node.destroy_subscription(before[1])
        # Bytes, since rclpy ends the whole program at a message that it cannot decode.
        subscription = self._node.create_subscription(kind, topic, callback, qos, raw=True)
        self._subscriptions[topic] = (qos, subscription)

    def _publishers_of(self, topic: str, kind: str) -> list[TopicEndpointInfo]:
        own = (self._node.get_name(), self._node.get_namespace())
        return [
            one
            for one in self._node.get_publishers_info_by_topic(topic)
            if one.topic_type == kind and (one.node_name, one.node_namespace) != own
        ]

    def _numbers_of(self, topic: str) -> list[Publisher]:
        return [tuple(one.endpoint_gid) for one in self._publishers_of(topic, MAP_TYPE)]

    def _hear_diagnoses(self, data: bytes) -> None:
        try:
            ages = read_ages(deserialize_message(data, DiagnosticArray))
        except Exception:  # likewise; whose message it was nobody knows
            return
        for age in ages:
            self._robots.hear_age(age)

    def _hear_map(self, name: str, topic: str, data: bytes, info: MessageInfo) -> None:
        message = self._decode(name, data, OccupancyGrid)
        if message is not None:
            self._robots.hear_map(name, message, self._numbers_of(topic), info["source_timestamp"])

    def _hear_update(self, name: str, data: bytes, info: MessageInfo) -> None:
        message = self._decode(name, data, OccupancyGridUpdate)
        if message is not None:
            self._robots.hear_update(name, message, info["source_timestamp"])

    def _decode(self, name: str, data: bytes, kind: Any) -> Any:
        try:
            return deserialize_message(data, kind)
        except Exception as error:  # of rmw, of Unicode, of memory: bytes may be anything
            self._robots.refuse(
                name, f"{len(data)} bytes that are no {kind.__name__}: {type(error).__name__}"
            )
            return None
