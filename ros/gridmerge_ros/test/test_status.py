# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

from time import monotonic
from typing import Any

import numpy as np
from gridmerge import OccupancyGrid, RobotStatus, TeamAnswer, TeamComponent, Transform
from gridmerge_ros.robots import TOO_OFTEN, HeardRobot
from gridmerge_ros.status import OK, WARNING, NodeHealth, TeamTransforms, diagnose, team_transforms

GRID = OccupancyGrid(np.zeros((2, 2), np.int8), 0.05)
HEALTH = NodeHealth("gridmerge")


def placed(name: str, component: int, x: float) -> RobotStatus:
    return RobotStatus(name, "placed", None, "it fits", component, Transform(x, 0.0, 0.0), 0.99, 1, 0.0)


def left_out(name: str) -> RobotStatus:
    why = "it fits in more than one way"
    return RobotStatus(name, "left_out", "ambiguous", why, None, Transform(0.0, 0.0, 0.0), 0.4, 1, 0.0)


def answer(*robots: RobotStatus, numbers: tuple[int, ...] = (1,), problem: str | None = None) -> TeamAnswer:
    parts = tuple(TeamComponent(number, None, ("a", "b"), GRID) for number in numbers)
    return TeamAnswer(3, parts, robots, (), 0.25, True, problem)


def heard(*frames: str, **changes: Any) -> dict[str, HeardRobot]:
    return {
        f"tb{index}": HeardRobot(f"tb{index}", f"/tb{index}/map", frame, maps=1, **changes)
        for index, frame in enumerate(frames)
    }


def test_transforms() -> None:
    given = answer(placed("tb0", 0, 1.0), placed("tb1", 1, 2.0), left_out("tb2"), numbers=(1, 3))
    found = team_transforms(given, heard("a/map", "b/map", "c/map"), "world", "")
    assert [(one.parent, one.child, one.T_parent_child.x) for one in found.transforms] == [
        ("world", "a/map", 1.0),
        ("world_3", "b/map", 2.0),  # the component's number, not its place
    ]
    assert found.withheld == {}


def test_frames_that_are_not_ones_own() -> None:
    given = answer(placed("tb0", 0, 1.0), placed("tb1", 0, 2.0), placed("tb2", 0, 3.0), placed("tb3", 0, 4.0))
    # One that is not placed shares it as well.
    robots = heard("map", "world", "c/map", "other", "map")
    found = team_transforms(given, robots, "world", "")
    assert [one.child for one in found.transforms] == ["c/map", "other"]
    assert set(found.withheld) == {"tb0", "tb1"}
    assert "tb0 and of tb4" in found.withheld["tb0"]
    named = team_transforms(given, robots, "world", "<robot>/map")
    assert [one.child for one in named.transforms] == ["tb0/map", "tb1/map", "tb2/map", "tb3/map"]


def test_a_robot_that_is_perhaps_two() -> None:
    robots = heard("a/map")
    placed_one = answer(placed("tb0", 0, 1.0))
    assert diagnose(placed_one, robots, TeamTransforms((), {}), HEALTH)[1].level == OK
    robots["tb0"].last_restarts.extend([monotonic()] * TOO_OFTEN[0])
    one = diagnose(placed_one, robots, TeamTransforms((), {}), HEALTH)[1]
    assert one.level == WARNING
    assert "do two robots publish on /tb0/map?" in one.message


def test_a_robot_without_a_frame() -> None:
    assert team_transforms(answer(placed("tb0", 0, 1.0)), heard(""), "world", "<robot>/map").transforms == ()
    assert team_transforms(answer(placed("tb9", 0, 1.0)), heard("a"), "world", "").transforms == ()


def test_diagnoses() -> None:
    robots = heard("a/map", "b/map", "c/map")
    robots["tb1"].refused, robots["tb1"].last_refusal = 2, "a size of 0 x 0 cells"
    robots["tb2"].pose = "fixed"
    robots["tb0"].followed, robots["tb0"].heard_first = (1, 255), 12.5
    given = answer(placed("tb0", 0, 1.0), left_out("tb1"))
    node, first, second, third = diagnose(given, robots, TeamTransforms((), {}), HEALTH)
    assert (node.level, node.name, node.message) == (OK, "gridmerge", "1 of 3 robots placed")
    values = dict(node.values)
    assert values["seconds of the last solve"] == "0.25"
    assert values["settled"] == "yes"
    assert len(values) == len(node.values), "each key once"
    assert values["merged maps"] == "1"
    assert "problem" not in values
    assert (first.level, first.name, first.hardware) == (OK, "gridmerge: tb0", "tb0")
    assert dict(first.values)["x"] == "1"
    assert dict(first.values)["probability"] == "0.99"
    # As other nodes read it.
    assert (dict(first.values)["publisher"], dict(first.values)["heard first"]) == ("01ff", "12.500000000")
    assert "heard first" not in dict(second.values)
    assert (second.level, second.message) == (WARNING, "left out: it fits in more than one way")
    assert dict(second.values)["reason"] == "ambiguous"
    assert dict(second.values)["last refusal"] == "a size of 0 x 0 cells"
    assert "x" not in dict(second.values)
    assert (third.level, third.message) == (WARNING, "waiting: its first map is being looked at")
    assert dict(third.values)["initial pose"] == "fixed"
    for one in (node, first, second, third):
        assert all(isinstance(text, str) for entry in one.values for text in entry)


def test_what_is_withheld_is_told() -> None:
    given = answer(placed("tb0", 0, 1.0))
    _, robot = diagnose(given, heard("map"), TeamTransforms((), {"tb0": "the frame is shared"}), HEALTH)
    assert (robot.level, robot.message) == (WARNING, "placed: it fits; no transform: the frame is shared")


def test_problems_of_the_node() -> None:
    empty = diagnose(answer(numbers=()), {}, TeamTransforms((), {}), HEALTH)
    assert [one.message for one in empty] == ["no robot is known yet"]
    none = TeamTransforms((), {})
    assert diagnose(answer(problem="no memory"), {}, none, HEALTH)[0].level == WARNING
    for health in (
        NodeHealth("n", undecodable=1),
        NodeHealth("n", over_limit=1),
        NodeHealth("n", trouble=("no map_msgs",)),
    ):
        assert diagnose(answer(), {}, none, health)[0].level == WARNING
    told = dict(
        diagnose(answer(), {}, none, NodeHealth("n", events=9, last_events=("tb0: joined",)))[0].values
    )
    assert told["events"] == "9"
    assert told["event 1"] == "tb0: joined"
