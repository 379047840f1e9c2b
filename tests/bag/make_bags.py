# SPDX-License-Identifier: Apache-2.0
"""Makes the bags of tests/bag/data with other people's writers: rosbags and mcap (PyPI).

    python3 -m venv venv && venv/bin/pip install rosbags==0.11.9 mcap==1.6.0
    venv/bin/python tests/bag/make_bags.py tests/bag/data

A recording has two robots' maps, updates of the first one's, and a topic of texts between them. `values()` and
`recording_test.cpp` say the same of what is in it.
"""

from __future__ import annotations

import math
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from mcap.writer import CompressionType, IndexType
from mcap.writer import Writer as McapWriter
from rosbags.rosbag1 import Writer as Ros1Writer
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.rosbag2 import Writer as Ros2Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

UPDATE = "map_msgs/msg/OccupancyGridUpdate"
UPDATE_TEXT = "std_msgs/Header header\nint32 x\nint32 y\nuint32 width\nuint32 height\nint8[] data\n"
WIDTH, HEIGHT = 7, 5


def values(robot: int, time: int) -> np.ndarray[Any, np.dtype[np.int8]]:
    """Of the map that a robot sends at a time: -1, 0 and 100 of robot 1, of robot 2 percentages too."""
    cell = np.arange(WIDTH * HEIGHT)
    if robot == 1:
        return np.array([-1, 0, 100], np.int8)[(cell + time) % 3]
    return ((cell * 3 + time) % 102 - 1).astype(np.int8)


def stores() -> tuple[Typestore, Typestore]:
    found = []
    for store in (Stores.ROS2_JAZZY, Stores.ROS1_NOETIC):
        types = get_typestore(store)
        types.register(get_types_from_msg(UPDATE_TEXT, UPDATE))
        found.append(types)
    return found[0], found[1]


def messages(types: Typestore, is_ros1: bool) -> Iterator[tuple[str, str, int, Any]]:
    """Topic, type, time [ns] and message."""
    of = types.types

    def header(time: int, frame: str) -> Any:
        sequence = {"seq": time} if is_ros1 else {}
        return of["std_msgs/msg/Header"](
            stamp=of["builtin_interfaces/msg/Time"](sec=time, nanosec=0), frame_id=frame, **sequence
        )

    def grid(robot: int, time: int) -> Any:
        yaw = 0.5 * robot
        return of["nav_msgs/msg/OccupancyGrid"](
            header=header(time, f"tb{robot}/map"),
            info=of["nav_msgs/msg/MapMetaData"](
                map_load_time=of["builtin_interfaces/msg/Time"](sec=time, nanosec=0),
                resolution=0.05,
                width=WIDTH,
                height=HEIGHT,
                origin=of["geometry_msgs/msg/Pose"](
                    position=of["geometry_msgs/msg/Point"](x=-1.25 * robot, y=2.5 + robot, z=0.0),
                    orientation=of["geometry_msgs/msg/Quaternion"](
                        x=0.0, y=0.0, z=math.sin(0.5 * yaw), w=math.cos(0.5 * yaw)
                    ),
                ),
            ),
            data=values(robot, time),
        )

    def update(time: int) -> Any:
        return of[UPDATE](
            header=header(time, "tb1/map"),
            x=2,
            y=1,
            width=3,
            height=2,
            data=np.array([100, 0, 100, 0, -1, 0], np.int8),
        )

    grid_type, text_type = "nav_msgs/msg/OccupancyGrid", "std_msgs/msg/String"
    for time in range(1, 4):
        yield "/tb1/map", grid_type, time * 10**9, grid(1, time)
        yield "/chatter", text_type, time * 10**9 + 1, of[text_type](data=f"at {time}")
        yield "/tb2/map", grid_type, time * 10**9 + 2, grid(2, time)
    yield "/tb1/map_updates", UPDATE, 4 * 10**9, update(4)


def write_rosbag2(
    folder: Path, plugin: StoragePlugin, mode: CompressionMode = CompressionMode.NONE, version: int = 9
) -> None:
    types, _ = stores()
    shutil.rmtree(folder, ignore_errors=True)
    writer = Ros2Writer(folder, version=8 if version == 8 else 9, storage_plugin=plugin)
    writer.set_compression(mode, CompressionFormat.ZSTD)
    connections: dict[str, Any] = {}
    with writer:
        for topic, kind, time, message in messages(types, False):
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=types)
            writer.write(connections[topic], time, types.serialize_cdr(message, kind))


def write_mcap(path: Path, compression: CompressionType, **options: Any) -> None:
    types, _ = stores()
    writer = McapWriter(str(path), compression=compression, **options)
    writer.start(profile="ros2", library="mcap")
    channels: dict[str, int] = {}
    for number, (topic, kind, time, message) in enumerate(messages(types, False)):
        if topic not in channels:
            schema = writer.register_schema(kind, "ros2msg", b"")
            channels[topic] = writer.register_channel(topic, "cdr", schema)
        writer.add_message(
            channels[topic],
            time,
            bytes(types.serialize_cdr(message, kind, little_endian=number % 2 == 0)),
            time,
        )
    writer.finish()


def write_ros1(path: Path) -> None:
    _, types = stores()
    path.unlink(missing_ok=True)
    connections: dict[str, Any] = {}
    with Ros1Writer(path) as writer:
        for topic, kind, time, message in messages(types, True):
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=types)
            writer.write(connections[topic], time, types.serialize_ros1(message, kind))


def main(folder: Path) -> None:
    write_rosbag2(folder / "db3", StoragePlugin.SQLITE3)
    write_rosbag2(folder / "db3_messages", StoragePlugin.SQLITE3, CompressionMode.MESSAGE, version=8)
    write_rosbag2(folder / "db3_file", StoragePlugin.SQLITE3, CompressionMode.FILE)
    write_rosbag2(folder / "mcap_plain", StoragePlugin.MCAP)
    write_rosbag2(folder / "mcap_storage", StoragePlugin.MCAP, CompressionMode.STORAGE)
    write_rosbag2(folder / "mcap_file", StoragePlugin.MCAP, CompressionMode.FILE)
    small = {"chunk_size": 300}
    write_mcap(folder / "lz4.mcap", CompressionType.LZ4, **small)
    write_mcap(folder / "zstd.mcap", CompressionType.ZSTD, **small)
    write_mcap(folder / "none.mcap", CompressionType.NONE, **small)
    write_mcap(folder / "no_chunks.mcap", CompressionType.NONE, use_chunking=False)
    write_mcap(
        folder / "no_index.mcap",
        CompressionType.LZ4,
        index_types=IndexType.NONE,
        use_statistics=False,
        **small,
    )
    write_mcap(
        folder / "no_summary.mcap",
        CompressionType.LZ4,
        index_types=IndexType.NONE,
        use_statistics=False,
        use_summary_offsets=False,
        repeat_channels=False,
        repeat_schemas=False,
        **small,
    )


if __name__ == "__main__":
    main(Path(sys.argv[1]))
