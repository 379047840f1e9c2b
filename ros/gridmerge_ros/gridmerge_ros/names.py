# SPDX-License-Identifier: Apache-2.0
"""Which topics are maps of robots, and what the robots are called."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping

_LONGEST_TOPIC = 240
_LEVEL = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")


def check_topic(topic: str) -> None:
    """Raises ValueError where ROS has no whole topic name like this."""
    levels = topic[1:].split("/")
    if not topic.startswith("/") or not all(_LEVEL.match(level) for level in levels):
        raise ValueError(f"no topic is called {topic!r}: a name has letters, digits, '_' and '/'")
    if len(topic) > _LONGEST_TOPIC:
        raise ValueError(
            f"a topic's name has {_LONGEST_TOPIC} characters at most, {topic[:40]!r}... has {len(topic)}"
        )


def check_name(robot: str) -> None:
    """Raises ValueError where no robot can be called so: a name is a namespace without its first slash."""
    if not robot or not all(_LEVEL.match(level) for level in robot.split("/")):
        raise ValueError(f"no robot is called {robot!r}: a name has letters, digits, '_' and '/'")


def numbered(name: str, number: int) -> str:
    """A topic or a frame of the component of this number: `merged_map`, `merged_map_2` and so on."""
    return name if number == 1 else f"{name}_{number}"


def by_topic(robots: Mapping[str, str]) -> dict[str, str]:
    """Robots by their topics. Raises ValueError, naming the parameter, for a topic of two robots."""
    names: dict[str, str] = {}
    for name, topic in robots.items():
        if topic in names:
            raise ValueError(f"robots: {topic} is the map of two robots, {names[topic]!r} and {name!r}")
        names[topic] = name
    return names


class Selection:
    """The topics that are maps of robots.

    Args:
        map_topic, updates_topic: in a robot's namespace, without a first slash.
        namespace: a text that the namespace has to have in it.
        robots: topics by names; where there are any, there are no others.
        merged: the node's own topic of merged maps, which with its numbers is nobody's map.

    Raises ValueError for a topic of two robots.
    """

    def __init__(
        self, map_topic: str, updates_topic: str, namespace: str, robots: Mapping[str, str], merged: str
    ) -> None:
        self._map_topic = map_topic
        self._updates_topic = updates_topic
        self._namespace = namespace
        self._robots = by_topic(robots)
        self._is_own: Callable[[str], object] = re.compile(
            re.escape(merged) + r"(_[2-9]|_[1-9][0-9]+)?\Z"
        ).match

    def robot_of(self, topic: str) -> str | None:
        """The name of the robot whose map is published there; None for another topic."""
        if self._is_own(topic):
            return None
        if self._robots:
            return self._robots.get(topic)
        namespace = self._namespace_of(topic)
        # A map in no namespace may be anybody's, and is most often a merged one.
        if not namespace or self._namespace not in namespace:
            return None
        return namespace[1:]

    def updates_of(self, topic: str) -> str:
        """Where updates of this map are published."""
        namespace = self._namespace_of(topic)
        return f"{topic}_updates" if namespace is None else f"{namespace}/{self._updates_topic}"

    def _namespace_of(self, topic: str) -> str | None:
        suffix = f"/{self._map_topic}"
        return topic.removesuffix(suffix) if topic.endswith(suffix) else None
