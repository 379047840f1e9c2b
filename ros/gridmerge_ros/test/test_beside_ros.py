# SPDX-License-Identifier: Apache-2.0
"""The node beside real nodes of ROS 2: teams that map, and what they are told."""

from __future__ import annotations

import math
import signal

import gridmerge
import numpy as np
import pytest

pytest.importorskip("rclpy", reason="tests beside ROS 2: './dev test --ros' runs them")

from map_msgs.msg import OccupancyGridUpdate
from nav_msgs.msg import OccupancyGrid
from ros_peer import LATCHED, UNRELIABLE, VOLATILE, Peer, at_step, map_message, truth, update_message, yaw
from rosgraph_msgs.msg import Clock
from tf2_msgs.msg import TFMessage

STEPS = 4
# Two robots whose maps are enough for each other.
PAIR = (0, 2)


def check_transform(stamped: object, expected: gridmerge.Transform) -> None:
    transform = stamped.transform  # type: ignore[attr-defined]
    distance = math.hypot(transform.translation.x - expected.x, transform.translation.y - expected.y)
    assert distance < 0.1
    assert abs(math.remainder(yaw(transform.rotation) - expected.theta, math.tau)) < 0.02


def test_robots_that_map(peer: Peer, explored: gridmerge.Simulation) -> None:
    # The merged map's topic is one that robots have too: the node must not hear itself.
    program = peer.start(merged_map_topic="merged/map")
    maps = peer.collect(OccupancyGrid, "/merged/map")
    transforms = peer.collect(TFMessage, "/tf_static")
    # Each robot appears a step later than the one before, and each publishes in another way.
    publishers: list[object] = []
    for step in range(STEPS + 2):
        if step < 3:
            publishers.append(peer.publisher(f"tb{step}", (LATCHED, VOLATILE, UNRELIABLE)[step]))
        for robot, publisher in enumerate(publishers):
            grid = at_step(explored, robot, min(step - robot, STEPS - 1))
            message = map_message(grid, f"tb{robot}/map", 100 + step)

            def is_heard(
                robot: int = robot, publisher: object = publisher, message: object = message
            ) -> bool:
                # What is neither latched nor reliable may be lost, as by a robot that maps.
                before = peer.value(f"tb{robot}", "maps") or "0"
                publisher.publish(message)  # type: ignore[attr-defined]
                peer.spin(0.3)
                return int(peer.value(f"tb{robot}", "maps") or "0") > int(before)

            peer.wait_until(is_heard, f"tb{robot} is heard in step {step}")
    whole = [map_message(at_step(explored, robot, -1), f"tb{robot}/map", 200) for robot in range(3)]
    expected = gridmerge.merge(whole).components[0].grid.cells

    def is_merged() -> bool:
        for publisher, message in zip(publishers, whole, strict=True):
            publisher.publish(message)  # type: ignore[attr-defined]
        peer.spin(0.3)
        return bool(maps) and np.array_equal(gridmerge.OccupancyGrid.from_msg(maps[-1]).cells, expected)

    peer.wait_until(is_merged, "the map that merge() makes of these maps")
    peer.wait_until_placed("tb0", "tb1", "tb2")
    peer.wait_for("gridmerge", "settled", "yes")
    peer.wait_until(lambda: bool(transforms) and len(transforms[-1].transforms) == 3, "three transforms")
    by_child = {one.child_frame_id: one for one in transforms[-1].transforms}
    for robot in range(3):
        assert by_child[f"tb{robot}/map"].header.frame_id == "world"
        check_transform(by_child[f"tb{robot}/map"], truth(explored, 0, robot))
    merged = maps[-1]
    assert merged.header.frame_id == "world"
    assert merged.header.stamp.sec > 1_000_000_000
    assert peer.robots == {"tb0", "tb1", "tb2"}
    assert [peer.level(f"tb{robot}") for robot in range(3)] == [0, 0, 0]
    assert peer.level("gridmerge") == 0
    assert peer.value("gridmerge", "message") == "3 of 3 robots placed"
    assert float(peer.value("tb1", "probability") or "0") > 0.95
    assert float(peer.value("gridmerge", "seconds of the last solve") or "-1") >= 0.0
    assert int(peer.value("gridmerge", "events") or "0") >= 3
    assert peer.value("gridmerge", "problem") is None

    # Who comes late gets what was latched.
    late = peer.collect(OccupancyGrid, "/merged/map")
    late_transforms = peer.collect(TFMessage, "/tf_static")
    peer.wait_until(lambda: bool(late) and bool(late_transforms), "latched messages")

    updates = peer.publisher("tb0", LATCHED, OccupancyGridUpdate, "map_updates")
    updates.publish(update_message(OccupancyGridUpdate, "tb0/map", 300, [100, 100]))
    peer.wait_for("tb0", "updates", "1")
    code, text = program.end(signal.SIGINT)
    assert code == 0, text
    assert "Traceback" not in text
    assert "tb1: first map: " in text


def test_a_namespace_a_remapping_and_simulated_time(peer: Peer, explored: gridmerge.Simulation) -> None:
    clock = peer.node.create_publisher(Clock, "/clock", 10)
    time = Clock()
    time.clock.sec = 42
    program = peer.start(
        *("-r", "__ns:=/fleet", "-r", "merged_map:=all/whole", "-r", "/tf:=/fleet/tf"),
        use_sim_time=True,
        transforms="dynamic",
        robot_map_frame="<robot>/drawn",
        robot_namespace="tb",
        world_frame="hall",
        **{
            "/tb2/map_merge/init_pose_x": 10,
            "tb2/map_merge/init_pose_y": -5.0,
            "/tb2/map_merge/init_pose_yaw": 0.5,
        },
    )
    maps = peer.collect(OccupancyGrid, "/fleet/all/whole")
    transforms = peer.collect(TFMessage, "/fleet/tf", 100)
    other = peer.publisher("other")
    other.publish(map_message(at_step(explored, 1, -1), "other/map"))
    for robot in PAIR:
        # The same frame in both, as robots have it that know nothing of each other.
        publisher = peer.publisher(f"tb{robot}")
        publisher.publish(map_message(at_step(explored, robot, -1), "map"))
        peer.wait_for(f"tb{robot}", "maps", "1")
    peer.wait_until_placed("tb0", "tb2")

    def is_timed() -> bool:
        clock.publish(time)
        return bool(transforms) and transforms[-1].transforms[0].header.stamp.sec == 42

    peer.wait_until(is_timed, "stamps of the simulation")
    by_child = {one.child_frame_id: one for one in transforms[-1].transforms}
    assert set(by_child) == {"tb0/drawn", "tb2/drawn"}
    known = gridmerge.Transform(10.0, -5.0, 0.5)
    assert by_child["tb2/drawn"].header.frame_id == "hall"
    check_transform(by_child["tb2/drawn"], known)
    check_transform(by_child["tb0/drawn"], known @ truth(explored, 2, 0))
    peer.wait_until(lambda: bool(maps), "the merged map")
    assert maps[-1].header.frame_id == "hall"
    assert peer.value("tb2", "initial pose") == "fixed"
    assert peer.value("tb0", "initial pose") is None
    assert not peer.set_parameter("/tb2/map_merge/init_pose_x", 3.0, "/fleet/gridmerge").successful
    assert peer.robots == {"tb0", "tb2"}
    assert peer.node_names == {"fleet/gridmerge"}
    assert program.is_running


def test_robots_by_name(peer: Peer, explored: gridmerge.Simulation) -> None:
    peer.start(robots=["tb0", "other=/deep/inside/grid"], transforms="none", fixed_robots=["other"])
    transforms = peer.collect(TFMessage, "/tf_static")
    tb0 = peer.publisher("tb0")
    tb0.publish(map_message(at_step(explored, 0, -1), "map"))
    other = peer.publisher("deep/inside", topic="grid")
    other.publish(map_message(at_step(explored, 2, -1), "map"))
    tb1 = peer.publisher("tb1")
    tb1.publish(map_message(at_step(explored, 1, -1), "map"))
    peer.wait_until_placed("tb0", "other")
    # The fixed robot's frame is the world's, though another one was heard first.
    assert float(peer.value("other", "x") or "1") == 0.0
    assert peer.value("other", "topic") == "/deep/inside/grid"
    assert peer.robots == {"tb0", "other"}
    assert transforms == []


@pytest.mark.parametrize("other", ["node", "program"])
def test_nodes_agree_on_whose_frame_is_the_worlds(
    peer: Peer, explored: gridmerge.Simulation, other: str
) -> None:
    if other == "program":
        peer.start_program("--name", "first", "--world", "first_world", "--output", "/first_map", "--quiet")
    else:
        peer.start("-r", "__node:=first", world_frame="first_world", merged_map_topic="first_map")
    late = peer.publisher("tb2", VOLATILE)
    message = map_message(at_step(explored, 2, -1), "tb2/map")

    def is_heard() -> bool:
        late.publish(message)
        peer.spin(0.3)
        return peer.value("tb2", "heard first") is not None

    peer.wait_until(is_heard, "tb2 is heard")
    early = peer.publisher("tb0")
    early.publish(map_message(at_step(explored, 0, -1), "tb0/map"))
    peer.wait_until_placed("tb0", "tb2")

    # This one hears them the other way round: tb0 is latched, and tb2 sends again when tb0 is known.
    transforms = peer.collect(TFMessage, "/tf_static")
    peer.start("-r", "__node:=second", world_frame="second_world", merged_map_topic="second_map")
    peer.wait_until(lambda: "second: tb0" in peer.names, "tb0 is known")

    def takes_frame_of_tb2() -> bool:
        late.publish(message)
        peer.spin(0.3)
        told = [
            one for array in transforms for one in array.transforms if one.header.frame_id == "second_world"
        ]
        mine = {one.child_frame_id: one.transform.translation for one in told[-2:]}
        return "tb2/map" in mine and (mine["tb2/map"].x, mine["tb2/map"].y) == (0.0, 0.0)

    peer.wait_until(takes_frame_of_tb2, "the frame of tb2 is the second node's world too")


def test_frames_that_robots_share_are_withheld(peer: Peer, explored: gridmerge.Simulation) -> None:
    peer.start()
    transforms = peer.collect(TFMessage, "/tf_static")
    publishers = [peer.publisher(f"tb{robot}") for robot in PAIR]
    for robot, publisher in zip(PAIR, publishers, strict=True):
        publisher.publish(map_message(at_step(explored, robot, -1), "map"))
    peer.wait_until_placed("tb0", "tb2")
    peer.wait_until(
        lambda: "the frame map is that of tb0 and of tb2" in (peer.value("tb2", "message") or ""),
        "the reason",
    )
    assert peer.level("tb2") == 1
    assert transforms == []


def test_a_robot_that_starts_anew(peer: Peer, explored: gridmerge.Simulation) -> None:
    program = peer.start(**{f"/tb1/map_merge/init_pose_{axis}": 0.0 for axis in ("x", "y", "z", "yaw")})
    publishers = peer.publish_all(explored)
    peer.wait_until_placed("tb0", "tb1", "tb2")
    assert peer.value("tb1", "initial pose") == "fixed"
    peer.node.destroy_publisher(publishers[1])
    peer.wait_for("tb1", "publishers", "0")
    assert peer.value("tb1", "state") == "placed"
    # It comes back in another frame of the same name, where its pose is not that of the parameters.
    successor = peer.publisher("tb1")
    grid = at_step(explored, 1, -1)
    moved = gridmerge.OccupancyGrid(grid.to_numpy(probabilities=False), grid.resolution, (30.0, 40.0, 1.0))
    successor.publish(map_message(moved, "tb1/map", 300))
    peer.wait_for("tb1", "maps", "2")
    peer.wait_for("tb1", "state", "placed")
    peer.wait_for("gridmerge", "settled", "yes")
    assert peer.value("tb1", "initial pose") == "holds no longer: the robot started anew"
    code, text = program.end(signal.SIGTERM)
    assert code == 0, text
    assert "tb1: started anew: " in text
    assert "tb1: its publisher is gone; its map is kept" in text
