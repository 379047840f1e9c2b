# SPDX-License-Identifier: Apache-2.0
"""What was heard of each robot, and what of it reaches the team."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from typing import Any

from gridmerge import InitialPose, Team, TeamAnswer

from gridmerge_ros.ages import RobotAge, publisher_digits
from gridmerge_ros.messages import RefusedMessage, read_map, read_update

MOST_CELLS_TOGETHER = 2**30
"""Of the newest maps of all robots."""

LATEST = 5.0
"""An update that comes so long after a map was not sent before it, whatever the publisher's clock says [s]."""

TOO_OFTEN = 4, 60.0
"""A robot that starts anew so many times in so long [s] is perhaps two robots."""

Publisher = tuple[int, ...]
"""The number that DDS gives it."""


@dataclass(frozen=True, slots=True)
class KnownPose:
    """What the parameters say of where a robot's map lies."""

    x: float
    y: float
    theta: float
    fixed: bool
    sd: float
    sd_theta: float


@dataclass(slots=True)
class HeardRobot:
    """A robot, and what came of it."""

    name: str
    topic: str
    frame: str = ""
    """Of its newest map; empty before that."""
    maps: int = 0
    parts: int = 0
    outdated: int = 0
    """Updates that its map had already."""
    publishers: int = 0
    refused: int = 0
    last_refusal: str = ""
    pose: str = ""
    """What became of the pose that the parameters give for it; empty where they give none."""
    restarts: int = 0
    """How often it started anew."""
    heard_first: float | None = None
    """Since when maps in this frame are heard, by the oldest account of all nodes: seconds since 1970."""
    cells: int = field(default=0, repr=False)
    written: int = field(default=0, repr=False)
    """When its publisher wrote the newest map [ns]; 0 where nobody says."""
    taken: float = field(default=0.0, repr=False)
    """When it was heard here, by monotonic()."""
    followed: Publisher | None = field(default=None, repr=False)
    last_restarts: deque[float] = field(default_factory=lambda: deque(maxlen=TOO_OFTEN[0]), repr=False)
    """By monotonic()."""

    @property
    def publisher(self) -> str:
        """The number of who publishes the map, as diagnoses have it; empty where nobody knows."""
        return "" if self.followed is None else publisher_digits(self.followed)

    @property
    def doubt(self) -> str:
        """Why it may be no one robot; empty where it seems to be."""
        most, seconds = TOO_OFTEN
        times = self.last_restarts
        if len(times) < most or time.monotonic() - times[0] > seconds:
            return ""
        return f"it started anew {most} times in {seconds:.0f} s: do two robots publish on {self.topic}?"


class Robots:
    """Hands the maps of robots to a team, and keeps count of what comes of each robot.

    Args:
        team: what merges.
        most: a robot beyond that many is not heard.
        tell, warn: are given a line for people on what happened, and on what should not have, behind its kind.
    """

    def __init__(
        self, team: Team, most: int, tell: Callable[[str, str], None], warn: Callable[[str, str], None]
    ) -> None:
        self._team = team
        self._most = most
        self._tell = tell
        self._warn = warn
        self._robots: dict[str, HeardRobot] = {}
        self._poses: dict[str, KnownPose] = {}
        self.over_limit: set[str] = set()
        """Topics that are not heard since there are too many robots."""
        self.undecodable = 0
        """Messages of all robots that were none."""

    @property
    def all(self) -> Mapping[str, HeardRobot]:
        """By name."""
        return dict(sorted(self._robots.items()))

    def __contains__(self, name: str) -> bool:
        return name in self._robots

    def add(self, name: str, topic: str, pose: KnownPose | str | None = None) -> bool:
        """A robot that is new. False, and nothing changes, where there are too many.

        `pose`: what the parameters say of it, or why what they say cannot be.
        """
        if len(self._robots) >= self._most:
            if not self.over_limit:
                self._warn(
                    "too many robots",
                    f"{topic} and perhaps others are not heard: there are {self._most} robots",
                )
            self.over_limit.add(topic)
            return False
        robot = self._robots[name] = HeardRobot(name, topic)
        if isinstance(pose, str):
            robot.pose = pose
            self._warn(f"pose {name}", f"{name}: {pose}")
        elif pose is not None:
            self._set_pose(robot, pose)
        return True

    def set_publishers(self, name: str, publishers: Collection[Publisher]) -> None:
        """Who publishes the robot's map now."""
        robot = self._robots[name]
        if robot.publishers > 0 and not publishers:
            self._tell(f"gone {name}", f"{name}: its publisher is gone; its map is kept")
        if robot.publishers <= 1 < len(publishers):
            self._warn(
                f"several {name}",
                f"{robot.topic}: has {len(publishers)} publishers; all are taken for one robot",
            )
        robot.publishers = len(publishers)

    def hear_map(self, name: str, message: Any, publishers: Collection[Publisher], written: int = 0) -> None:
        """A map, who publishes such now, and when it was written. Does not raise for what the message says."""
        robot = self._robots[name]
        if 0 < written == robot.written and not self._is_another(robot, publishers):
            return  # a latched one comes again with a new subscription, and lacks the updates since
        try:
            heard = read_map(message)
            others = sum(other.cells for other in self._robots.values() if other is not robot)
            cells = heard.grid.width * heard.grid.height
            if others + cells > MOST_CELLS_TOGETHER:
                raise RefusedMessage("all maps together have above 2^30 cells")
        except RefusedMessage as error:
            self._refuse(robot, str(error))
            return
        content = f"{heard.grid.width} x {heard.grid.height} cells of {heard.grid.resolution:.4g} m in {heard.frame}"
        if robot.maps == 0:
            self._tell(f"first map {name}", f"{name}: first map: {content}")
        elif heard.frame != robot.frame or self._is_another(robot, publishers):
            self._restart(robot, content)
        now = time.time()
        try:
            self._team.hear(name, heard.grid)
        except ValueError as error:
            self._refuse(robot, str(error))
            return
        if robot.heard_first is None:
            self._set_age(robot, now)
        if robot.followed not in publishers:
            robot.followed = next(iter(sorted(publishers)), robot.followed)
        robot.frame = heard.frame
        robot.written = written
        robot.taken = time.monotonic()
        robot.cells = cells
        robot.maps += 1

    def hear_update(self, name: str, message: Any, written: int = 0) -> None:
        """An update, and when it was written. Does not raise for what the message says.

        The times in messages are the user's: they may be 0, or go back.
        """
        robot = self._robots[name]
        try:
            part = read_update(message)
            if robot.maps == 0:
                raise RefusedMessage("an update without a map before it")
            if part.frame != robot.frame:
                raise RefusedMessage(f"an update in the frame {part.frame}, of a map in {robot.frame}")
            if 0 < written < robot.written and time.monotonic() - robot.taken <= LATEST:
                robot.outdated += 1  # the map has it already
                return
            if not self._team.hear_part(name, part.column, part.row, part.grid):
                raise RefusedMessage("an update that reaches beyond its map")
        except RefusedMessage as error:
            self._refuse(robot, str(error))
            return
        robot.parts += 1

    def hear_age(self, age: RobotAge) -> None:
        """What a node tells, this one too; of robots and frames that are not heard here it means nothing."""
        for robot in self._robots.values():
            if (robot.topic, robot.publisher, robot.frame) != (age.topic, age.publisher, age.frame):
                continue
            if robot.heard_first is not None and age.heard_first < robot.heard_first:
                self._set_age(robot, age.heard_first)

    def count_restart(self, name: str) -> None:
        """The robot started anew, as the team has found out or others have said."""
        robot = self._robots.get(name)
        if robot is None:
            return
        robot.restarts += 1
        robot.last_restarts.append(time.monotonic())
        if robot.doubt:
            self._warn(f"many restarts {name}", f"{name}: {robot.doubt}")

    def follow(self, answer: TeamAnswer) -> None:
        """A known pose that the team has given up holds no longer."""
        for status in answer.robots:
            robot = self._robots.get(status.name)
            if robot is not None and status.name in self._poses and not status.has_known_pose:
                self._lose_pose(robot)

    def refuse(self, name: str, why: str) -> None:
        """A message of the robot that could not be decoded."""
        self.undecodable += 1
        self._refuse(self._robots[name], why)

    @staticmethod
    def _is_another(robot: HeardRobot, publishers: Collection[Publisher]) -> bool:
        return robot.followed is not None and bool(publishers) and robot.followed not in publishers

    def _set_age(self, robot: HeardRobot, heard_first: float) -> None:
        robot.heard_first = heard_first
        self._team.hear_age(robot.name, heard_first)

    def _set_pose(self, robot: HeardRobot, pose: KnownPose) -> None:
        place = (pose.x, pose.y, pose.theta)
        try:
            self._team.set_known_pose(
                robot.name,
                place if pose.fixed else InitialPose(place, pose.sd, pose.sd_theta),
                fixed=pose.fixed,
            )
        except ValueError as error:
            robot.pose = f"the initial pose cannot be: {error}"
            self._warn(f"pose {robot.name}", f"{robot.name}: {robot.pose}")
            return
        self._poses[robot.name] = pose
        robot.pose = "fixed" if pose.fixed else "a start"

    def _restart(self, robot: HeardRobot, content: str) -> None:
        """What was known of the old map's frame says nothing of the new one, whatever its name."""
        self._tell(f"anew {robot.name}", f"{robot.name}: started anew: {content}")
        self.count_restart(robot.name)
        self._team.forget(robot.name)
        robot.heard_first = None
        if robot.name in self._poses:
            self._team.set_known_pose(robot.name, None)
            self._lose_pose(robot)

    def _lose_pose(self, robot: HeardRobot) -> None:
        del self._poses[robot.name]
        robot.pose = "holds no longer: the robot started anew"
        self._warn(f"pose {robot.name}", f"{robot.name}: its initial pose {robot.pose}")

    def _refuse(self, robot: HeardRobot, why: str) -> None:
        if robot.refused == 0:
            self._warn(f"refused {robot.name}", f"{robot.topic}: a message is refused: {why}")
        robot.refused += 1
        robot.last_refusal = why
