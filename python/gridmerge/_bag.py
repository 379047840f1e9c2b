# SPDX-License-Identifier: Apache-2.0
"""Maps out of recordings: bags of ROS 2, which the engine reads, and of ROS 1, which rosbags reads."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from . import _arguments, _core
from ._repr import count, shortened

if TYPE_CHECKING:
    from ._grid import OccupancyGrid

_GRID = "nav_msgs/msg/OccupancyGrid"
_UPDATE = "map_msgs/msg/OccupancyGridUpdate"
_UPDATE_TEXT = "std_msgs/Header header\nint32 x\nint32 y\nuint32 width\nuint32 height\nint8[] data\n"


@dataclass(frozen=True, slots=True)
class RecordedMap:
    """A map as it was at one moment of a recording."""

    time: int
    """When its message was recorded [ns since 1970, or whatever the clock had]."""
    grid: OccupancyGrid
    """The map, whose frame_id is the one that its message names."""
    is_update: bool
    """Whether an update of a part made it so."""


@dataclass(frozen=True, slots=True)
class BagTopic:
    """A topic of a bag."""

    name: str
    """As ROS has it: /tb1/map."""
    type: str
    """Of its messages, as ROS 2 names it: nav_msgs/msg/OccupancyGrid."""
    messages: int
    """How many there are."""

    def __repr__(self) -> str:
        return f"BagTopic({shortened(self.name, 80)}, {shortened(self.type, 80)}, {count(self.messages, 'message')})"


def bag_topics(path: str | os.PathLike[str]) -> list[BagTopic]:
    """The topics of a bag, in order of their names. Bags are those that load() takes.

    Raises FileError, an OSError, for what is no bag, and ImportError for one of ROS 1 without rosbags.
    """
    name = _arguments.path("path", path)
    if is_ros1(name):
        return _Ros1Bag(name).topics()
    return [BagTopic(*topic) for topic in _core.topics_of(name)]


def recorded_maps(path: str | os.PathLike[str], topic: str | None = None) -> Iterator[RecordedMap]:
    """The maps of a bag of ROS 2 one after another: each whole map, and what each update makes of it.

    Args:
        path: as for load(), which takes the last of these maps; a topic may be part of it.
        topic: the maps' topic; it may be left out where only one has maps.

    Raises FileError, an OSError, for what cannot be read, also in the midst of a recording.
    """
    from ._grid import OccupancyGrid

    file, name = split_name(path, topic)
    if is_ros1(file):
        raise _core.FileError(
            f"{os.fsdecode(file)}: is a bag of ROS 1, of which load() takes the last map; rosbags-convert makes a bag "
            "of ROS 2 of it, whose maps are taken one after another"
        )
    recording = _core.open_recording(file, _arguments.to_bytes(name))

    def maps() -> Iterator[RecordedMap]:
        while (found := recording.next()) is not None:
            core, frame, time, is_update = found
            yield RecordedMap(time, OccupancyGrid._of(core, None, frame or None), is_update)

    return maps()


def split_name(path: str | os.PathLike[str], topic: str | None) -> tuple[bytes, str]:
    """The file, and the topic that either of the two names, or ""."""
    file, named = _core.parse_map_name(_arguments.path("path", path))
    if topic is None:
        return file, named
    wanted = _arguments.text("topic", topic)
    if not wanted:
        raise ValueError("topic: is empty")
    if named and named.lstrip("/") != wanted.lstrip("/"):
        raise ValueError(f"topic: is {wanted!r}, but the path names {named!r}")
    return file, wanted


def file_and_topic_of(source: str) -> tuple[str, str]:
    """The file that a map's source names, and the topic, without its first slash, or ""."""
    file, topic = _core.parse_map_name(os.fsencode(source))
    return os.fsdecode(file), topic.lstrip("/")


def is_ros1(file: bytes) -> bool:
    """Whether it is a bag of ROS 1. A pipe, which gives its bytes once, is not asked."""
    if not os.path.isfile(file):
        return False
    try:
        with open(file, "rb") as opened:
            return opened.read(9) == b"#ROSBAG V"
    except OSError:
        return False  # whoever reads it says why it cannot be read


def load_ros1(file: bytes, topic: str) -> tuple[_core.Grid, str]:
    """The last map of a topic of a bag of ROS 1, and the frame that it names."""
    return _Ros1Bag(file).last_map(topic)


class _Ros1Bag:
    """What rosbags reads becomes messages of ROS 2, so that one parser says what they mean."""

    def __init__(self, file: bytes) -> None:
        try:
            from rosbags.rosbag1 import Reader
            from rosbags.typesys import Stores, get_types_from_msg, get_typestore
        except ImportError as error:
            raise ImportError(
                "a bag of ROS 1 needs rosbags: pip install 'gridmerge[rosbags]' installs it"
            ) from error
        self._file = file
        self._types = get_typestore(Stores.ROS2_JAZZY)
        self._types.register(get_types_from_msg(_UPDATE_TEXT, _UPDATE))
        self._reader = Reader

    def topics(self) -> list[BagTopic]:
        topics: dict[tuple[str, str], int] = {}
        try:
            with self._reader(os.fsdecode(self._file)) as reader:
                for connection in reader.connections:
                    key = (connection.topic, connection.msgtype)
                    topics[key] = topics.get(key, 0) + connection.msgcount
        except Exception as error:
            raise self._error(f"rosbags cannot read it: {error}") from error
        return [BagTopic(*key, messages) for key, messages in sorted(topics.items())]

    def last_map(self, topic: str) -> tuple[_core.Grid, str]:
        name = self._choose(topic)
        messages: list[tuple[bool, bytes]] = []
        try:
            with self._reader(os.fsdecode(self._file)) as reader:
                wanted = [
                    one
                    for one in reader.connections
                    if (one.topic, one.msgtype) in ((name, _GRID), (f"{name}_updates", _UPDATE))
                ]
                for connection, _, message in reader.messages(wanted):
                    is_update = connection.msgtype == _UPDATE
                    if not is_update:
                        messages.clear()
                    messages.append((is_update, bytes(self._types.ros1_to_cdr(message, connection.msgtype))))
        except Exception as error:
            raise self._error(f"rosbags cannot read it: {error}") from error
        return _core.draw_map(self._file, messages)

    def _choose(self, topic: str) -> str:
        maps = [one.name for one in self.topics() if one.type == _GRID and one.messages]
        listed = ", ".join(maps)
        if not maps:
            raise self._error("has no maps (messages of nav_msgs/OccupancyGrid)")
        if not topic:
            if len(maps) == 1:
                return maps[0]
            raise self._error(
                f"has {len(maps)} topics of maps: add #TOPIC to its name to choose one of {listed}"
            )
        for name in maps:
            if name in (topic, f"/{topic}"):
                return name
        raise self._error(f"has no maps on the topic {topic!r}; its topics of maps are {listed}")

    def _error(self, cause: str) -> _core.FileError:
        line = " ".join(cause.split())
        return _core.FileError(f"{os.fsdecode(self._file)}: {line}")
