# SPDX-License-Identifier: Apache-2.0
"""Matches two maps that came as nav_msgs/OccupancyGrid messages. Needs no ROS: any object with their fields will do.

In a ROS 2 node the messages are what the subscription's callback is given; hand them to gridmerge as they are:

    self.create_subscription(nav_msgs.msg.OccupancyGrid, "/robot_1/map", self.on_map, 1)
"""

from __future__ import annotations

import array
from dataclasses import dataclass, field
from pathlib import Path

import gridmerge


@dataclass
class Point:
    x: float = 0.0
    y: float = 0.0
    z: float = 0.0


@dataclass
class Quaternion:
    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    w: float = 1.0


@dataclass
class Pose:
    position: Point = field(default_factory=Point)
    orientation: Quaternion = field(default_factory=Quaternion)


@dataclass
class MapMetaData:
    resolution: float
    width: int
    height: int
    origin: Pose


@dataclass
class OccupancyGrid:
    """Stands for nav_msgs.msg.OccupancyGrid."""

    info: MapMetaData
    data: array.array[int]


def receive(path: Path) -> OccupancyGrid:
    """A map as a message, as map_server would publish it."""
    grid = gridmerge.load(path)
    origin = Pose(Point(grid.origin.x, grid.origin.y))
    info = MapMetaData(grid.resolution, grid.width, grid.height, origin)
    return OccupancyGrid(info, array.array("b", grid.to_numpy().tobytes()))


def main() -> None:
    maps = Path(__file__).resolve().parents[1] / "three_robots"
    fixed, moving = receive(maps / "robot_1.yaml"), receive(maps / "robot_2.yaml")

    result = gridmerge.match(fixed, moving)
    print(f"{result.verdict}, probability {result.probability:.4f}")
    print("T_fixed_moving:", result.transform)

    merged = gridmerge.merge([fixed, moving], names=["robot 1", "robot 2"])
    # Without a class a message is a dict; in a node it is to_msg(nav_msgs.msg.OccupancyGrid, frame_id=..., stamp=...).
    message = merged.components[0].grid.to_msg(frame_id="world")
    values = message["data"]  # -1, 0 and 100
    print(f"the merged map's data: {len(values)} values, {values.count(100)} occupied")


if __name__ == "__main__":
    main()
