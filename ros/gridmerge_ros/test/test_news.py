# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

from typing import Literal

from gridmerge import RobotStatus, TeamAnswer, TeamEvent, Transform
from gridmerge_ros.news import news_between


def lies(name: str, x: float, theta: float = 0.0, component: int | None = 0) -> RobotStatus:
    state: Literal["placed", "left_out"] = "left_out" if component is None else "placed"
    return RobotStatus(name, state, None, "for a reason", component, Transform(x, 0.0, theta), 0.9, 1, 0.0)


def answer(number: int, *robots: RobotStatus, events: tuple[TeamEvent, ...] = ()) -> TeamAnswer:
    return TeamAnswer(number, (), robots, events, 0.1, True)


def test_the_team_tells_what_happened_since_the_answer_before() -> None:
    event = TeamEvent("joined", "tb1", "tb1 joined tb0")
    before = answer(3, lies("tb0", 0.0), lies("tb1", 0.0, component=None))
    assert news_between(before, answer(4, lies("tb0", 0.0), lies("tb1", 9.0), events=(event,))) == [
        "tb1 joined tb0"
    ]
    # What the team does not call an event is none.
    assert news_between(before, answer(4, lies("tb0", 0.0), lies("tb1", 9.0))) == []


def test_answers_that_were_missed() -> None:
    before = answer(3, lies("tb0", 0.0), lies("tb1", 5.0), lies("tb2", 0.0, component=None), lies("tb4", 1.0))
    event = TeamEvent("left", "tb4", "tb4 left")
    after = answer(5, lies("tb0", 1.0), lies("tb1", 0.0, component=None), lies("tb2", 1.0), events=(event,))
    assert news_between(before, after) == [
        "tb4 left",
        "tb1 is placed no longer: for a reason",
        "tb2 is placed: for a reason",
    ]
    assert news_between(answer(1, lies("tb0", 0.0)), answer(3)) == ["tb0 is placed no longer: it is gone"]


def test_who_moved() -> None:
    before = answer(3, lies("tb0", 0.0), lies("tb1", 5.0), lies("tb2", 9.0))
    # All moved together: another robot's frame is the world's now.
    assert news_between(before, answer(6, lies("tb0", 50.0), lies("tb1", 55.0), lies("tb2", 59.3))) == []
    moved = answer(6, lies("tb0", 0.0), lies("tb1", 8.0), lies("tb2", 9.0))
    assert news_between(before, moved) == ["tb1 moved by 3.0 m and 0.00 rad"]
    turned = answer(6, lies("tb0", 0.0), lies("tb1", 5.0, 1.0), lies("tb2", 9.0))
    assert news_between(before, turned) == ["tb1 moved by 0.0 m and 1.00 rad"]
    # To robots of other components it lies nowhere.
    apart = answer(6, lies("tb0", 0.0), lies("tb1", 8.0, component=1), lies("tb2", 9.0))
    assert news_between(before, apart) == []
