# SPDX-License-Identifier: Apache-2.0
"""What an answer of the team means for TF and /diagnostics."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from gridmerge import TeamAnswer, Transform

from gridmerge_ros.ages import FRAME, HEARD_FIRST, PUBLISHER, TOPIC, format_time
from gridmerge_ros.names import numbered
from gridmerge_ros.robots import HeardRobot

OK, WARNING = 0, 1


@dataclass(frozen=True, slots=True)
class NamedTransform:
    """A transform that TF is told."""

    parent: str
    child: str
    T_parent_child: Transform


@dataclass(frozen=True, slots=True)
class TeamTransforms:
    """Transforms of placed robots, by child; and why others have none, by robot."""

    transforms: tuple[NamedTransform, ...]
    withheld: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class Diagnosis:
    """A `diagnostic_msgs/DiagnosticStatus`."""

    level: int
    name: str
    message: str
    hardware: str
    values: tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class NodeHealth:
    """What the node says of itself."""

    name: str
    undecodable: int = 0
    over_limit: int = 0
    events: int = 0
    """All that there were."""
    last_events: Sequence[str] = field(default=())
    trouble: Sequence[str] = field(default=())
    """What does not work, a sentence each."""


def team_transforms(
    answer: TeamAnswer, robots: Mapping[str, HeardRobot], world: str, child_frame: str
) -> TeamTransforms:
    """From the frame of each component to the map frames of its robots.

    A frame that two robots share, or that is a component's own, is withheld: TF knows one pose of each frame, and it
    would be a wrong one. `child_frame` is as the parameter robot_map_frame.
    """
    frames = {
        name: child_frame.replace("<robot>", name) if child_frame else robot.frame
        for name, robot in robots.items()
        if robot.frame
    }
    own = {numbered(world, component.number) for component in answer.components}
    transforms: list[NamedTransform] = []
    withheld: dict[str, str] = {}
    for status in answer.robots:
        frame = frames.get(status.name)
        if status.component is None or frame is None:
            continue
        sharing = sorted(name for name, other in frames.items() if other == frame)
        if len(sharing) > 1:
            withheld[status.name] = f"the frame {frame} is that of {' and of '.join(sharing)}"
        elif frame in own:
            withheld[status.name] = f"the frame {frame} is the merged map's own"
        else:
            number = answer.components[status.component].number
            transforms.append(NamedTransform(numbered(world, number), frame, status.transform))
    return TeamTransforms(tuple(sorted(transforms, key=lambda one: one.child)), withheld)


def diagnose(
    answer: TeamAnswer, robots: Mapping[str, HeardRobot], transforms: TeamTransforms, health: NodeHealth
) -> list[Diagnosis]:
    """One of the node, then one of each robot by name."""
    placed = sum(status.state == "placed" for status in answer.robots)
    values = [
        ("robots", str(len(robots))),
        ("placed", str(placed)),
        ("merged maps", str(len(answer.components))),
        ("solves", str(answer.number)),
        ("seconds of the last solve", _decimal(answer.seconds)),
        ("settled", "yes" if answer.settled else "no"),
        ("messages that could not be decoded", str(health.undecodable)),
        ("robots beyond the limit", str(health.over_limit)),
        ("events", str(health.events)),
    ]
    values += [(f"event {index + 1}", event) for index, event in enumerate(health.last_events)]
    trouble = [*health.trouble, *([answer.problem] if answer.problem else [])]
    if trouble:
        values.append(("problem", "; ".join(trouble)))
    warns = trouble or health.undecodable or health.over_limit
    message = f"{placed} of {len(robots)} robots placed" if robots else "no robot is known yet"
    node = Diagnosis(WARNING if warns else OK, health.name, message, health.name, tuple(values))
    return [
        node,
        *(
            _diagnose_robot(answer, robot, transforms.withheld.get(name), health.name)
            for name, robot in sorted(robots.items())
        ),
    ]


def _diagnose_robot(answer: TeamAnswer, robot: HeardRobot, withheld: str | None, node: str) -> Diagnosis:
    status = next((one for one in answer.robots if one.name == robot.name), None)
    state = "waiting" if status is None else status.state
    if status is not None:
        why = status.why
    else:
        why = "no map was heard yet" if robot.maps == 0 else "its first map is being looked at"
    values = [("state", state), ("why", why), (TOPIC, robot.topic), (FRAME, robot.frame)]
    if status is not None and status.reason is not None:
        values.append(("reason", status.reason))
    if status is not None and status.component is not None:
        values += [
            ("component", str(answer.components[status.component].number)),
            ("x", _decimal(status.transform.x)),
            ("y", _decimal(status.transform.y)),
            ("theta", _decimal(status.transform.theta)),
            ("probability", _decimal(status.probability)),
        ]
    values += [
        ("maps", str(robot.maps)),
        ("updates", str(robot.parts)),
        ("updates older than the map", str(robot.outdated)),
    ]
    if robot.publisher and robot.heard_first is not None:
        values += [(PUBLISHER, robot.publisher), (HEARD_FIRST, format_time(robot.heard_first))]
    values += [
        ("publishers", str(robot.publishers)),
        ("started anew", str(robot.restarts)),
        ("refused", str(robot.refused)),
    ]
    if robot.refused:
        values.append(("last refusal", robot.last_refusal))
    if robot.pose:
        values.append(("initial pose", robot.pose))
    message = f"{state.replace('_', ' ')}: {why}"
    if withheld is not None:
        message += f"; no transform: {withheld}"
    if robot.doubt:
        message += f"; {robot.doubt}"
    level = OK if state == "placed" and withheld is None and not robot.doubt else WARNING
    return Diagnosis(level, f"{node}: {robot.name}", message, robot.name, tuple(values))


def _decimal(value: float) -> str:
    return f"{value:.6g}"
