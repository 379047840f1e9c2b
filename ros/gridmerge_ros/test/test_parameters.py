# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping

import pytest
from gridmerge_ros.initial_poses import AXES, is_initial_pose, parameter_names, read_known_pose
from gridmerge_ros.parameters import PARAMETERS, Settings, read_settings
from gridmerge_ros.robots import KnownPose


def test_defaults() -> None:
    settings = read_settings({})
    assert {one.name for one in dataclasses.fields(Settings)} == {one.name for one in PARAMETERS}
    for parameter in PARAMETERS:
        if parameter.name != "robot_map_updates_topic":
            assert getattr(settings, parameter.name) == parameter.default
    assert settings.robot_map_updates_topic == "map_updates"


def test_values() -> None:
    settings = read_settings(
        {
            "merging_rate": 2,
            "robots": ["tb1", "/big=/x/grid", ""],
            "robot_map_topic": "/slam/map",
            "robot_map_frame": "<robot>/m",
        }
    )
    assert settings.merging_rate == 2.0
    assert isinstance(settings.merging_rate, float)
    assert settings.robots == (("tb1", "/tb1/slam/map"), ("big", "/x/grid"))
    assert settings.robot_map_updates_topic == "slam/map_updates"
    assert read_settings({"robot_map_updates_topic": "changes"}).robot_map_updates_topic == "changes"
    for topic in ("merged", "/all/merged", "~/merged"):
        assert read_settings({"merged_map_topic": topic}).merged_map_topic == topic
    assert read_settings({"fixed_robots": [""]}).fixed_robots == ()
    # TF knows no first slash.
    assert read_settings({"world_frame": "/world"}).world_frame == "world"
    assert read_settings({"robot_map_frame": "/<robot>/map"}).robot_map_frame == "<robot>/map"


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("autostart", 1),
        ("threads", 1.0),
        ("threads", True),
        ("merging_rate", "4"),
        ("merging_rate", True),
        ("merging_rate", 0.0),
        ("merging_rate", -1.0),
        ("merging_rate", math.nan),
        ("discovery_rate", 1e9),
        ("transform_rate", 0),
        ("init_pose_sd", 0.0),
        ("init_pose_sd_theta", -1.0),
        ("transforms", "both"),
        ("transforms", 1),
        ("world_frame", ""),
        ("world_frame", "my world"),
        ("world_frame", "//world"),
        ("world_frame", "w" * 256),
        ("robot_map_frame", "<robot> map"),
        ("robot_map_frame", "//<robot>/map"),
        ("merged_map_topic", ""),
        ("merged_map_topic", "a b"),
        ("merged_map_topic", "/"),
        ("merged_map_topic", "map/"),
        ("robot_map_topic", ""),
        ("robot_map_topic", "a b"),
        ("robot_map_updates_topic", "map"),
        ("robot_map_frame", "map"),
        ("robots", "tb1"),
        ("robots", [1, 2]),
        ("robots", ["tb1", "tb1=/x"]),
        ("robots", ["tb1", "tb2=/tb1/map"]),
        ("robots", ["=x"]),
        ("robots", ["tb1="]),
        ("robots", ["t b"]),
        ("fixed_robots", ["1"]),
    ],
)
def test_wrong_values_are_named(name: str, value: object) -> None:
    with pytest.raises(ValueError, match=f"^{name}: "):
        read_settings({name: value})


def pose_of(robot: str, given: Mapping[str, object], **settings: object) -> KnownPose | str | None:
    return read_known_pose(robot, read_settings(settings), given.get)


def test_poses() -> None:
    assert pose_of("tb1", {}) is None
    given = {
        "/tb1/map_merge/init_pose_x": 1,
        "tb1/map_merge/init_pose_y": 2.5,
        "/tb1/map_merge/init_pose_yaw": 0.5,
    }
    assert pose_of("tb1", given) == KnownPose(1.0, 2.5, 0.5, True, 1.0, 0.1)
    assert pose_of("tb2", given) is None
    start = pose_of("tb1", given, known_init_poses=False, init_pose_sd=2.0)
    assert start == KnownPose(1.0, 2.5, 0.5, False, 2.0, 0.1)
    fixed = pose_of("tb1", given, known_init_poses=False, fixed_robots=["tb1"])
    assert isinstance(fixed, KnownPose) and fixed.fixed
    assert pose_of("tb1", {}, fixed_robots=["tb1"]) == KnownPose(0.0, 0.0, 0.0, True, 1.0, 0.1)
    assert isinstance(pose_of("tb1", given, fixed_robots=["tb1", "tb2"]), KnownPose)


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"x": "far"}, "init_pose_x is a number"),
        ({"yaw": math.nan}, "init_pose_yaw is a number"),
        ({"y": True}, "init_pose_y is a number"),
        ({"y": None}, "init_pose_y is missing"),
        ({"z": 0.5}, "init_pose_z is 0.5"),
    ],
)
def test_wrong_poses(changes: dict[str, object], why: str) -> None:
    given = {"x": 1.0, "y": 2.0, "z": 0.0, "yaw": 0.5, **changes}
    pose = pose_of("tb1", {f"/tb1/map_merge/init_pose_{axis}": value for axis, value in given.items()})
    assert isinstance(pose, str)
    assert why in pose


def test_several_fixed_robots_need_poses() -> None:
    pose = pose_of("tb1", {}, fixed_robots=["tb1", "tb2"])
    assert isinstance(pose, str)


def test_names_of_poses() -> None:
    for axis in AXES:
        for name in parameter_names("fleet/tb1", axis):
            assert is_initial_pose(name)
    for name in ("init_pose_sd", "/tb1/map_merge/init_pose_sd", "x", "/tb1/init_pose_x", "world_frame"):
        assert not is_initial_pose(name)
