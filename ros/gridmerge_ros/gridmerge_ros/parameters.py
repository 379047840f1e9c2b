# SPDX-License-Identifier: Apache-2.0
"""The node's parameters: their names, defaults and meaning, and what they are checked for."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from gridmerge_ros.messages import read_frame
from gridmerge_ros.names import by_topic, check_name, check_topic

Value = bool | int | float | str | tuple[str, ...]

TRANSFORMS = ("static", "dynamic", "none")
RATES = ("merging_rate", "discovery_rate", "transform_rate")


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter of the node."""

    name: str
    default: Value
    """Its type is that of the parameter."""
    text: str
    """What it means, in a sentence for `ros2 param describe`."""


PARAMETERS = (
    Parameter("autostart", True, "Configure and activate at the start, without a lifecycle manager."),
    Parameter("robot_map_topic", "map", "The topic of a robot's map, in the robot's namespace."),
    Parameter(
        "robot_map_updates_topic",
        "",
        "The topic of updates of a robot's map, in the robot's namespace; empty: that of the map with _updates.",
    ),
    Parameter("robot_namespace", "", "Only robots whose namespace has this text in it are heard."),
    Parameter(
        "robots",
        (),
        "Only these robots are heard, each as NAME or NAME=TOPIC; empty: all that are discovered.",
    ),
    Parameter(
        "merged_map_topic", "merged_map", "The topic of the merged map; further ones have it with _2, _3, ..."
    ),
    Parameter("world_frame", "world", "The frame of the merged map; further ones have it with _2, _3, ..."),
    Parameter(
        "robot_map_frame",
        "",
        "The frame of each robot's map in TF, with <robot> for its name; empty: the frame that its maps name.",
    ),
    Parameter(
        "transforms", "static", "Where transforms are published: static (/tf_static), dynamic (/tf) or none."
    ),
    Parameter("transform_rate", 10.0, "How often dynamic transforms are published [Hz]."),
    Parameter(
        "merging_rate", 4.0, "How often the merged map is published at most, when it has changed [Hz]."
    ),
    Parameter("discovery_rate", 1.0, "How often new robots are looked for [Hz]."),
    Parameter(
        "known_init_poses", True, "Initial poses that are given are exact: the maps stay where they say."
    ),
    Parameter(
        "init_pose_sd", 1.0, "Standard deviation of initial positions where known_init_poses is false [m]."
    ),
    Parameter(
        "init_pose_sd_theta", 0.1, "Standard deviation of initial yaws where known_init_poses is false [rad]."
    ),
    Parameter(
        "fixed_robots", (), "Robots whose maps stay where their initial pose says, or at 0 without one."
    ),
    Parameter("accept", 0.95, "Probability from which on two maps are joined."),
    Parameter("max_false_joins", 0.05, "How many joins of the whole team may be expected to be false."),
    Parameter(
        "output_resolution", 0.0, "Metres per cell of the merged map; 0: those of the finest map, or more."
    ),
    Parameter("search_again", 0.1, "A map is searched anew when this share of its known cells has changed."),
    Parameter("confirmations", 3, "A placed robot moves when so many answers in a row say so."),
    Parameter("quiet", 3.0, "With no newer map for so long, what the maps say is taken at once [s]."),
    Parameter("max_robots", 256, "More robots than these are not heard."),
    Parameter("threads", 0, "Threads that merge; 0: one per core."),
)


@dataclass(frozen=True, slots=True)
class Settings:
    """The parameters' values, checked: PARAMETERS says what each is by itself."""

    autostart: bool
    robot_map_topic: str
    robot_map_updates_topic: str
    """Never empty."""
    robot_namespace: str
    robots: tuple[tuple[str, str], ...]
    """Names and topics."""
    merged_map_topic: str
    world_frame: str
    robot_map_frame: str
    transforms: str
    transform_rate: float
    merging_rate: float
    discovery_rate: float
    known_init_poses: bool
    init_pose_sd: float
    init_pose_sd_theta: float
    fixed_robots: tuple[str, ...]
    accept: float
    max_false_joins: float
    output_resolution: float
    search_again: float
    confirmations: int
    quiet: float
    max_robots: int
    threads: int


def read_settings(values: Mapping[str, object]) -> Settings:
    """Raises ValueError, naming the parameter, for a value that cannot be.

    What Team refuses is left to it.
    """
    read: dict[str, object] = {}
    for parameter in PARAMETERS:
        read[parameter.name] = _read(parameter, values.get(parameter.name, parameter.default))
    for name in RATES:
        if not 0.001 <= _number(read[name]) <= 1000.0:
            raise ValueError(f"{name}: is a rate between 0.001 and 1000 Hz, not {read[name]}")
    for name in ("init_pose_sd", "init_pose_sd_theta"):
        if not _number(read[name]) > 0.0:
            raise ValueError(f"{name}: is above 0, not {read[name]}")
    if read["transforms"] not in TRANSFORMS:
        raise ValueError(f"transforms: is one of {', '.join(TRANSFORMS)}, not {read['transforms']!r}")

    map_topic = _levels("robot_map_topic", str(read["robot_map_topic"]).strip("/"))
    read["robot_map_topic"] = map_topic
    updates = read["robot_map_updates_topic"]
    read["robot_map_updates_topic"] = (
        _levels("robot_map_updates_topic", str(updates).strip("/")) if updates else f"{map_topic}_updates"
    )
    if read["robot_map_updates_topic"] == map_topic:
        raise ValueError(f"robot_map_updates_topic: is {map_topic!r}, which is that of the maps")
    read["world_frame"] = _frame("world_frame", str(read["world_frame"]))
    # Relative, absolute or private, as ROS resolves it.
    _levels("merged_map_topic", str(read["merged_map_topic"]).removeprefix("~/").removeprefix("/"))
    frame = str(read["robot_map_frame"])
    if frame and "<robot>" not in frame:
        raise ValueError(f"robot_map_frame: must have <robot> in it, so that frames differ, is {frame!r}")
    read["robot_map_frame"] = _frame("robot_map_frame", frame) if frame else ""
    read["robots"] = _robots(_texts(read["robots"]), map_topic)
    read["fixed_robots"] = tuple(_robot_name("fixed_robots", robot) for robot in _texts(read["fixed_robots"]))
    return Settings(**read)  # type: ignore[arg-type]


def _read(parameter: Parameter, value: object) -> object:
    name, default = parameter.name, parameter.default
    if isinstance(default, bool):
        if not isinstance(value, bool):
            raise ValueError(f"{name}: is true or false, not {value!r}")
    elif isinstance(default, int):
        if isinstance(value, bool) or not isinstance(value, int):
            raise ValueError(f"{name}: is a whole number, not {value!r}")
    elif isinstance(default, float):
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
            raise ValueError(f"{name}: is a number, not {value!r}")
        return float(value)
    elif isinstance(default, str):
        if not isinstance(value, str):
            raise ValueError(f"{name}: is a text, not {value!r}")
    else:
        if isinstance(value, str) or not isinstance(value, (list, tuple)):
            raise ValueError(f"{name}: is a list of texts, not {value!r}")
        if not all(isinstance(one, str) for one in value):
            raise ValueError(f"{name}: is a list of texts, not {list(value)!r}")
        # ROS has no empty list in a file of parameters; a list of one empty text stands for it.
        return tuple(one for one in value if one)
    return value


def _number(value: object) -> float:
    assert isinstance(value, float)
    return value


def _texts(value: object) -> tuple[str, ...]:
    assert isinstance(value, tuple)
    return value


def _levels(parameter: str, topic: str) -> str:
    try:
        check_topic(f"/{topic}")
    except ValueError as error:
        raise ValueError(f"{parameter}: {error}") from None
    return topic


def _frame(parameter: str, frame: str) -> str:
    try:
        return read_frame(frame)
    except ValueError as error:
        raise ValueError(f"{parameter}: {frame!r} {error}") from None


def _robot_name(parameter: str, robot: str) -> str:
    name = robot.strip("/")
    try:
        check_name(name)
    except ValueError as error:
        raise ValueError(f"{parameter}: {error}") from None
    return name


def _robots(entries: tuple[str, ...], map_topic: str) -> tuple[tuple[str, str], ...]:
    robots: dict[str, str] = {}
    for entry in entries:
        written, equals, topic = entry.partition("=")
        name = _robot_name("robots", written)
        topic = topic if equals else f"/{name}/{map_topic}"
        try:
            check_topic(topic if topic.startswith("/") else f"/{topic}")
        except ValueError as error:
            raise ValueError(f"robots: {error}") from None
        if name in robots:
            raise ValueError(f"robots: names {name!r} twice")
        robots[name] = topic
    by_topic(robots)
    return tuple(robots.items())
