# SPDX-License-Identifier: Apache-2.0
"""What has changed from one answer of the team to a later one."""

from __future__ import annotations

import math

from gridmerge import RobotStatus, TeamAnswer

# What pairs of robots differ by when one of them is said to have moved: more than maps that grow bend.
_MOVED = 1.0  # [m]
_TURNED = 0.2  # [rad]


def news_between(before: TeamAnswer, after: TeamAnswer) -> list[str]:
    """A line for each event.

    The team tells what happened since the answer before. Whoever missed answers in between is told what became of the
    robots since then: who is placed, who is not any more, and who lies elsewhere to the others.
    """
    lines = [event.text for event in after.events]
    if after.number <= before.number + 1:
        return lines
    told = {event.robot for event in after.events}
    lay = {robot.name: robot for robot in before.robots if robot.component is not None}
    lies = {robot.name: robot for robot in after.robots if robot.component is not None}
    for name in sorted((lay.keys() | lies.keys()) - told):
        if name not in lay:
            lines.append(f"{name} is placed: {lies[name].why}")
        elif name not in lies:
            now = [robot for robot in after.robots if robot.name == name]
            lines.append(f"{name} is placed no longer: {now[0].why if now else 'it is gone'}")
        elif moved := _moved(name, lay, lies):
            lines.append(f"{name} moved by {moved}")
    return lines


def _moved(name: str, lay: dict[str, RobotStatus], lies: dict[str, RobotStatus]) -> str:
    """How far, if it lies elsewhere to most of those with which it lay and lies together; else empty."""
    common = 0
    elsewhere: list[tuple[float, float]] = []
    for other in sorted(lay.keys() & lies.keys() - {name}):
        if lay[other].component != lay[name].component or lies[other].component != lies[name].component:
            continue
        common += 1
        was = lay[other].transform.inverse() @ lay[name].transform
        now = lies[other].transform.inverse() @ lies[name].transform
        distance = math.hypot(now.x - was.x, now.y - was.y)
        turn = abs(math.remainder(now.theta - was.theta, math.tau))
        if distance > _MOVED or turn > _TURNED:
            elsewhere.append((distance, turn))
    if 2 * len(elsewhere) <= common:
        return ""
    distance, turn = max(elsewhere)
    return f"{distance:.1f} m and {turn:.2f} rad"
