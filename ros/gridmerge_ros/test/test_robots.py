# SPDX-License-Identifier: Apache-2.0
"""What reaches the team: a team that keeps account stands for the real one."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import Any

import pytest
from gridmerge import RobotStatus, TeamAnswer, Transform
from gridmerge_ros import robots as robots_module
from gridmerge_ros.ages import RobotAge
from gridmerge_ros.robots import KnownPose, Robots
from messages_like_ros import map_message, update_message

FIRST, SECOND = (1, 1), (2, 2)
CELLS = [-1, 0, 100, 0, 0, 100]


class Account:
    """A Team's methods, written down."""

    def __init__(self) -> None:
        self.calls: list[tuple[Any, ...]] = []
        self.ages: list[tuple[str, float]] = []
        self.holds_parts = True
        self.is_full = False

    def hear(self, robot: str, grid: Any) -> None:
        if self.is_full:
            raise ValueError("one too many")
        self.calls.append(("hear", robot, grid.shape))

    def hear_part(self, robot: str, column: int, row: int, grid: Any) -> bool:
        self.calls.append(("hear_part", robot, column, row, grid.shape))
        return self.holds_parts

    def hear_age(self, robot: str, heard_first: float) -> None:
        self.ages.append((robot, heard_first))

    def forget(self, robot: str) -> None:
        self.calls.append(("forget", robot))

    def set_known_pose(self, robot: str, pose: Any, *, fixed: bool = False) -> None:
        if pose == (9.0, 9.0, 9.0):
            raise ValueError("too far")
        self.calls.append(("set_known_pose", robot, pose, fixed))


class Heard:
    def __init__(self, most: int = 10) -> None:
        self.account = Account()
        self.lines: list[str] = []
        team: Any = self.account
        self.kinds: list[str] = []
        self.robots = Robots(team, most, self._write, self._write)
        assert self.robots.add("tb1", "/tb1/map")

    def _write(self, kind: str, line: str) -> None:
        self.kinds.append(kind)
        self.lines.append(line)

    @property
    def tb1(self) -> Any:
        return self.robots.all["tb1"]


@pytest.fixture
def heard() -> Heard:
    return Heard()


def test_maps_and_updates(heard: Heard) -> None:
    heard.robots.hear_map("tb1", map_message(CELLS, 3, 2), [FIRST])
    heard.robots.hear_map("tb1", map_message(CELLS, 2, 3), [FIRST])
    heard.robots.hear_update("tb1", update_message([0, 0], 2, 1))
    assert heard.account.calls == [
        ("hear", "tb1", (2, 3)),
        ("hear", "tb1", (3, 2)),
        ("hear_part", "tb1", 0, 0, (1, 2)),
    ]
    assert (heard.tb1.maps, heard.tb1.parts, heard.tb1.refused, heard.tb1.frame) == (2, 1, 0, "tb1/map")


def test_updates_count_in_the_order_in_which_they_were_written(
    heard: Heard, monkeypatch: pytest.MonkeyPatch
) -> None:
    heard.robots.hear_map("tb1", map_message(CELLS, 3, 2, second=5000), [FIRST], 1000)

    def update(second: int, written: int) -> tuple[int, int]:
        heard.robots.hear_update("tb1", update_message([0, 0], 2, 1, second=second), written)
        return heard.tb1.parts, heard.tb1.outdated

    # What the messages say of time may be 0, or go back with a simulation's clock.
    assert update(0, 1001) == (1, 0)
    assert update(3, 1002) == (2, 0)
    # Where nobody says when it was written it is used.
    assert update(0, 0) == (3, 0)
    # The map has it already.
    assert update(5001, 999) == (3, 1)
    # Long after the map it cannot: the publisher's clock was set back.
    later = time.monotonic() + robots_module.LATEST + 1.0
    monkeypatch.setattr(time, "monotonic", lambda: later)
    assert update(4, 998) == (4, 1)
    assert heard.tb1.refused == 0


def test_a_latched_map_that_comes_again_takes_no_updates_back(heard: Heard) -> None:
    for _ in range(2):
        heard.robots.hear_map("tb1", map_message(CELLS, 3, 2), [FIRST], 1000)
        heard.robots.hear_update("tb1", update_message([0, 0], 2, 1), 1001)
    assert [call[0] for call in heard.account.calls] == ["hear", "hear_part", "hear_part"]
    # Another publisher's is another map.
    heard.robots.hear_map("tb1", map_message(CELLS, 3, 2), [SECOND], 1000)
    assert heard.tb1.maps == 2


def test_refusals_are_counted_and_told_once(heard: Heard) -> None:
    for _ in range(3):
        heard.robots.hear_map("tb1", map_message(CELLS, 3, 3), [FIRST])
    heard.robots.hear_update("tb1", update_message([0, 0], 2, 1))
    assert heard.account.calls == []
    assert heard.tb1.refused == 4
    assert heard.tb1.last_refusal == "an update without a map before it"
    assert len(heard.lines) == 1
    heard.robots.refuse("tb1", "no message")
    assert (heard.tb1.refused, heard.robots.undecodable) == (5, 1)


def test_a_team_that_refuses(heard: Heard) -> None:
    heard.account.is_full = True
    heard.robots.hear_map("tb1", map_message(CELLS, 3, 2), [FIRST])
    assert (heard.tb1.maps, heard.tb1.refused, heard.tb1.last_refusal) == (0, 1, "one too many")
    heard.account.is_full = False
    heard.robots.hear_map("tb1", map_message(CELLS, 3, 2), [FIRST])
    assert heard.account.calls == [("hear", "tb1", (2, 3))]


def test_updates_of_another_map(heard: Heard) -> None:
    heard.robots.hear_map("tb1", map_message(CELLS, 3, 2), [FIRST])
    heard.robots.hear_update("tb1", update_message([0, 0], 2, 1, frame="elsewhere"))
    assert "in the frame elsewhere" in heard.tb1.last_refusal
    heard.account.holds_parts = False
    heard.robots.hear_update("tb1", update_message([0, 0], 2, 1))
    assert "beyond its map" in heard.tb1.last_refusal
    assert (heard.tb1.parts, heard.tb1.refused) == (0, 2)


@pytest.mark.parametrize("how", ["publisher", "frame"])
def test_a_robot_that_starts_anew(how: str) -> None:
    heard = Heard()
    heard.robots.add("tb2", "/tb2/map", KnownPose(1.0, 2.0, 0.5, True, 1.0, 0.1))
    assert heard.account.calls == [("set_known_pose", "tb2", (1.0, 2.0, 0.5), True)]
    assert heard.robots.all["tb2"].pose == "fixed"
    heard.robots.hear_map("tb2", map_message(CELLS, 3, 2), [FIRST])
    heard.account.calls.clear()
    frame = "tb2/other" if how == "frame" else "tb1/map"
    heard.robots.hear_map("tb2", map_message(CELLS, 3, 2, frame), [SECOND] if how == "publisher" else [FIRST])
    assert heard.account.calls == [
        ("forget", "tb2"),
        ("set_known_pose", "tb2", None, False),
        ("hear", "tb2", (2, 3)),
    ]
    assert "no longer" in heard.robots.all["tb2"].pose
    # That is over then.
    heard.account.calls.clear()
    heard.robots.hear_map("tb2", map_message(CELLS, 3, 2, frame), [SECOND] if how == "publisher" else [FIRST])
    assert heard.account.calls == [("hear", "tb2", (2, 3))]


def test_two_robots_on_one_topic(heard: Heard, monkeypatch: pytest.MonkeyPatch) -> None:
    for frame in ("a", "b", "a", "b"):
        heard.robots.hear_map("tb1", map_message(CELLS, 3, 2, frame), [FIRST])
    assert heard.tb1.doubt == ""  # that may be
    heard.robots.count_restart("tb1")  # as the team sees by its map
    assert "do two robots publish on /tb1/map?" in heard.tb1.doubt
    assert heard.lines[-1] == f"tb1: {heard.tb1.doubt}"
    assert heard.tb1.restarts == 4
    assert heard.kinds == ["first map tb1", *["anew tb1"] * 3, "many restarts tb1"]
    heard.robots.count_restart("nobody")
    later = time.monotonic() + 61.0
    monkeypatch.setattr(time, "monotonic", lambda: later)
    assert heard.tb1.doubt == ""


def test_a_pose_that_the_team_gives_up() -> None:
    heard = Heard()
    heard.robots.add("tb2", "/tb2/map", KnownPose(1.0, 2.0, 0.5, True, 1.0, 0.1))

    def follow(name: str, has_known_pose: bool) -> None:
        pose = Transform(1.0, 2.0, 0.5)
        status = RobotStatus(name, "waiting", None, "", None, pose, 0.0, 1, 0.0, has_known_pose)
        heard.robots.follow(TeamAnswer(1, (), (status,), (), 0.0, True))

    follow("tb2", True)
    follow("tb1", False)
    follow("nobody", False)
    assert (heard.robots.all["tb2"].pose, heard.lines) == ("fixed", [])
    for _ in range(2):
        follow("tb2", False)
    assert heard.robots.all["tb2"].pose == "holds no longer: the robot started anew"
    assert len(heard.lines) == 1
    assert heard.robots.all["tb1"].pose == ""


def test_a_publisher_more_or_one_that_is_not_known_yet_is_no_new_start(heard: Heard) -> None:
    for publishers in ([], [SECOND], [FIRST, SECOND], [], [SECOND]):
        heard.robots.hear_map("tb1", map_message(CELLS, 3, 2), publishers)
    assert [call[0] for call in heard.account.calls] == ["hear"] * 5


def test_the_oldest_account_of_all_nodes_counts(heard: Heard) -> None:
    before = time.time()
    heard.robots.hear_age(RobotAge("/tb1/map", "", "", 7.0))  # of what is not heard yet
    heard.robots.hear_map("tb1", map_message(CELLS, 3, 2), [FIRST])
    own = heard.tb1.heard_first
    assert before <= own <= time.time()
    assert heard.tb1.publisher == "0101"
    told = RobotAge("/tb1/map", "0101", "tb1/map", own - 5.0)
    for wrong in ({"topic": "/tb2/map"}, {"publisher": "0202"}, {"frame": "map"}, {"heard_first": own + 1.0}):
        heard.robots.hear_age(replace(told, **wrong))
    assert heard.account.ages == [("tb1", own)]
    for _ in range(2):
        heard.robots.hear_age(told)
    heard.robots.hear_age(replace(told, heard_first=own - 1.0))
    assert heard.account.ages == [("tb1", own), ("tb1", own - 5.0)]
    assert heard.tb1.heard_first == own - 5.0
    # What holds for one frame says nothing of the next.
    heard.robots.hear_map("tb1", map_message(CELLS, 3, 2, "tb1/other"), [FIRST])
    assert heard.tb1.heard_first >= own
    heard.robots.hear_age(told)
    assert heard.account.ages[2:] == [("tb1", heard.tb1.heard_first)]


def test_poses_that_cannot_be(heard: Heard) -> None:
    heard.robots.add("tb2", "/tb2/map", "the initial pose cannot be: x is missing")
    heard.robots.add("tb3", "/tb3/map", KnownPose(9.0, 9.0, 9.0, True, 1.0, 0.1))
    assert heard.robots.all["tb2"].pose == "the initial pose cannot be: x is missing"
    assert heard.robots.all["tb3"].pose == "the initial pose cannot be: too far"
    assert heard.account.calls == []


def test_a_robot_too_many() -> None:
    heard = Heard(most=2)
    assert heard.robots.add("tb2", "/tb2/map")
    for _ in range(2):
        assert not heard.robots.add("tb3", "/tb3/map")
    assert heard.robots.over_limit == {"/tb3/map"}
    assert len(heard.lines) == 1


def test_maps_that_are_too_many_cells_together(heard: Heard, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(robots_module, "MOST_CELLS_TOGETHER", 10)
    heard.robots.add("tb2", "/tb2/map")
    for _ in range(3):
        heard.robots.hear_map("tb1", map_message(CELLS, 3, 2), [FIRST])
    heard.robots.hear_map("tb2", map_message(CELLS, 3, 2), [SECOND])
    assert "2^30" in heard.robots.all["tb2"].last_refusal
    assert [call[:2] for call in heard.account.calls] == [("hear", "tb1")] * 3


def test_publishers(heard: Heard) -> None:
    heard.robots.set_publishers("tb1", [FIRST])
    assert heard.lines == []
    heard.robots.set_publishers("tb1", [FIRST, SECOND])
    heard.robots.set_publishers("tb1", [])
    assert [line.split(": ")[0] for line in heard.lines] == ["/tb1/map", "tb1"]
    assert heard.tb1.publishers == 0
