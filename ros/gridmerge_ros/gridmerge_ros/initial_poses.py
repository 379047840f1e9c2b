# SPDX-License-Identifier: Apache-2.0
"""What the parameters say of where robots' maps lie."""

from __future__ import annotations

import math
from collections.abc import Callable

from gridmerge_ros.parameters import Settings
from gridmerge_ros.robots import KnownPose

AXES = ("x", "y", "z", "yaw")


def parameter_names(robot: str, axis: str) -> tuple[str, str]:
    """As multirobot_map_merge has it, and without the first slash."""
    name = f"{robot}/map_merge/init_pose_{axis}"
    return f"/{name}", name


def is_initial_pose(parameter: str) -> bool:
    """Whether it is one of those names, of any robot."""
    return parameter.rpartition("/")[0].endswith("/map_merge") and parameter.rpartition("_")[2] in AXES


def read_known_pose(
    robot: str, settings: Settings, value_of: Callable[[str], object]
) -> KnownPose | str | None:
    """What is known of the robot's map frame; as a text why what is given cannot be; None where nothing is.

    `value_of` gives a parameter's value, or None.
    """
    given: dict[str, object] = {}
    for axis in AXES:
        for name in parameter_names(robot, axis):
            value = value_of(name)
            if value is not None:
                given[axis] = value
    fixed = robot in settings.fixed_robots
    numbers: dict[str, float] = {}
    for axis, value in given.items():
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
            return f"the initial pose cannot be: init_pose_{axis} is a number, not {value!r}"
        numbers[axis] = float(value)
    if not numbers:
        if not fixed:
            return None
        if len(settings.fixed_robots) > 1:
            return "is one of several fixed_robots: how they lie to each other must stand in init_pose_x, _y and _yaw"
        numbers = {"x": 0.0, "y": 0.0, "yaw": 0.0}
    missing = [f"init_pose_{axis}" for axis in ("x", "y", "yaw") if axis not in numbers]
    if missing:
        return f"the initial pose cannot be: {' and '.join(missing)} is missing"
    if numbers.get("z", 0.0) != 0.0:
        return f"the initial pose cannot be: init_pose_z is {numbers['z']:g}, but maps lie in one plane"
    return KnownPose(
        numbers["x"],
        numbers["y"],
        numbers["yaw"],
        fixed or settings.known_init_poses,
        settings.init_pose_sd,
        settings.init_pose_sd_theta,
    )
