# SPDX-License-Identifier: Apache-2.0
"""The node beside real nodes of ROS 2 that send what is no map, ask for what cannot be, or set it up wrongly."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path

import gridmerge
import pytest

pytest.importorskip("rclpy", reason="tests beside ROS 2: './dev test --ros' runs them")

from lifecycle_msgs.msg import Transition
from map_msgs.msg import OccupancyGridUpdate
from nav_msgs.msg import OccupancyGrid
from rclpy.qos import QoSProfile
from rclpy.serialization import serialize_message
from ros_peer import LATCHED, Peer, at_step, map_message, update_message
from std_msgs.msg import String


def test_messages_that_are_no_maps(peer: Peer, explored: gridmerge.Simulation) -> None:
    program = peer.start(max_robots=4)
    publishers = peer.publish_all(explored)
    peer.wait_until_placed("tb0", "tb1", "tb2")
    text = peer.publisher("tb7", LATCHED, String)
    text.publish(String(data="no map"))
    hostile = peer.publisher("bad", QoSProfile(depth=100))
    peer.wait_for("bad", "publishers", "1")
    # Before that a message would be lost.
    peer.wait_until(lambda: bool(hostile.get_subscription_count() == 1), "a subscription")
    grid = at_step(explored, 0, 0)
    count = 0

    def refused(message: object, why: str) -> None:
        nonlocal count
        count += 1

        def is_counted() -> bool:
            return peer.value("bad", "refused") == str(count)

        hostile.publish(message)
        peer.wait_until(is_counted, f"{why} is refused")
        assert why in (peer.value("bad", "last refusal") or "")

    message = map_message(grid, "bad/map")
    message.data = message.data[:-1]
    refused(message, "values for")
    message = map_message(grid, "bad/map")
    message.info.width = message.info.height = 2**31
    refused(message, "above 2^28")
    message = map_message(grid, "bad/map")
    message.info.width = 0
    refused(message, "a size of 0")
    for resolution in (float("nan"), float("inf"), 0.0, -1.0):
        message = map_message(grid, "bad/map")
        message.info.resolution = resolution
        refused(message, "info.resolution")
    message = map_message(grid, "bad/map")
    message.info.origin.position.x = float("nan")
    refused(message, "info.origin.position")
    for quaternion in (
        (0.0, 0.0, float("nan"), 1.0),
        (1.0, 0.0, 0.0, 0.0),
        (0.0, 0.0, 9.0, 1.0),
    ):
        message = map_message(grid, "bad/map")
        orientation = message.info.origin.orientation
        orientation.x, orientation.y, orientation.z, orientation.w = quaternion
        refused(message, "info.origin.orientation")
    message = map_message(grid, "bad/map")
    message.data[7] = 101
    refused(message, "101")
    refused(map_message(grid, ""), "header.frame_id")
    refused(map_message(grid, "a b"), "header.frame_id")

    # Bytes that are no message: cut off, and a length of four thousand million cells.
    whole = serialize_message(map_message(grid, "bad/map"))
    cells = whole.index((grid.width * grid.height).to_bytes(4, "little"), 60)
    refused(whole[:200], "are no OccupancyGrid")
    refused(whole[:cells] + b"\xff\xff\xff\xff" + whole[cells + 4 :], "are no OccupancyGrid")
    at = whole.index(b"bad/map\0")
    refused(whole[:at] + b"\xff\xfe" + whole[at + 2 :], "")
    assert peer.level("bad") == 1
    assert int(peer.value("gridmerge", "messages that could not be decoded") or "0") >= 2

    # Updates without a map, in another frame, beyond the map.
    updates = peer.publisher("tb0", QoSProfile(depth=100), OccupancyGridUpdate, "map_updates")
    for frame, column, why in (
        ("elsewhere", 1, "in the frame"),
        ("tb0/map", 10**6, "beyond"),
        ("tb0/map", -1, "(-1,"),
    ):
        wrong = update_message(OccupancyGridUpdate, frame, 200, [100, 100])
        wrong.x = column

        def is_refused(wrong: object = wrong, why: str = why) -> bool:
            updates.publish(wrong)
            peer.spin(0.5)
            return why in (peer.value("tb0", "last refusal") or "")

        peer.wait_until(is_refused, why)

    # One robot too many.
    many = peer.publisher("many")
    many.publish(map_message(grid, "many/map"))
    peer.wait_for("gridmerge", "robots beyond the limit", "1")
    assert peer.robots == {"tb0", "tb1", "tb2", "bad"}
    # A stream of the same map, and the node still works.
    for _ in range(50):
        publishers[0].publish(map_message(at_step(explored, 0, -1), "tb0/map"))
    # And what was bad may become a robot.
    hostile.publish(map_message(at_step(explored, 0, -1), "bad/map"))
    peer.wait_until_placed("bad", "tb0", "tb1", "tb2")
    code, output = program.end(signal.SIGTERM)
    assert code == 0, output
    assert "Traceback" not in output
    assert output.count("/bad/map: a message is refused: ") == 1


def test_lifecycle(peer: Peer, explored: gridmerge.Simulation) -> None:
    program = peer.start(autostart=False)
    assert peer.state() == "unconfigured"
    maps = peer.collect(OccupancyGrid, "/merged_map")
    publishers = [peer.publisher(f"tb{robot}") for robot in range(3)]
    for robot, publisher in enumerate(publishers):
        publisher.publish(map_message(at_step(explored, robot, -1), f"tb{robot}/map"))
    # What the state does not have is refused, and ends nothing.
    peer.ask_for_state(Transition.TRANSITION_ACTIVATE)
    assert peer.state() == "unconfigured"

    assert not peer.set_parameter("no_such_parameter", 1.0).successful
    assert peer.set_parameter("merging_rate", 0.0).successful
    assert not peer.change_state(Transition.TRANSITION_CONFIGURE)
    assert peer.state() == "unconfigured"
    assert peer.set_parameter("merging_rate", 10.0).successful
    assert peer.change_state(Transition.TRANSITION_CONFIGURE)
    assert peer.state() == "inactive"
    result = peer.set_parameter("merging_rate", 5.0)
    assert not result.successful
    assert "clean it up first" in result.reason
    peer.spin(2.0)
    assert peer.robots == set()

    assert peer.change_state(Transition.TRANSITION_ACTIVATE)
    peer.wait_until_placed("tb0", "tb1", "tb2")
    peer.wait_for("gridmerge", "settled", "yes")
    peer.wait_until(lambda: bool(maps), "a merged map")
    assert peer.change_state(Transition.TRANSITION_DEACTIVATE)
    peer.spin(0.5)
    peer.forget_diagnoses()
    peer.spin(2.0)
    assert peer.robots == set()
    # Who comes while it rests gets what was latched; the team knows its robots when it goes on.
    late = peer.collect(OccupancyGrid, "/merged_map")
    peer.wait_until(lambda: bool(late), "the latched map")
    assert peer.change_state(Transition.TRANSITION_ACTIVATE)
    peer.wait_until_placed("tb0", "tb1", "tb2")

    assert peer.change_state(Transition.TRANSITION_DEACTIVATE)
    assert peer.change_state(Transition.TRANSITION_CLEANUP)
    assert peer.state() == "unconfigured"
    later = peer.collect(OccupancyGrid, "/merged_map")
    peer.spin(2.0)
    assert later == []
    assert peer.change_state(Transition.TRANSITION_CONFIGURE)
    assert peer.change_state(Transition.TRANSITION_ACTIVATE)
    peer.wait_until_placed("tb0", "tb1", "tb2")
    assert peer.change_state(Transition.TRANSITION_ACTIVE_SHUTDOWN)
    assert peer.state() == "finalized"
    code, text = program.end(signal.SIGINT)
    assert code == 0, text
    assert "Traceback" not in text


@pytest.mark.parametrize(
    ("parameters", "why"),
    [
        ({"merging_rate": 0}, "merging_rate: is a rate"),
        ({"transforms": "both"}, "transforms: is one of static, dynamic, none"),
        ({"accept": 1.5}, "accept"),
        ({"quiet": "soon"}, "quiet: is a number"),
        ({"quiet": 1e9}, "quiet must be at most 31536000 s"),
        ({"autostart": 3}, "autostart: is true or false"),
        ({"merged_map_topic": "a b"}, "merged_map_topic: no topic is called"),
        ({"fixed_robots": ["tb0", "tb1"]}, "tb0: is one of several fixed_robots"),
        (
            {"fixed_robots": ["tb0"], "/tb0/map_merge/init_pose_x": 1.0},
            "init_pose_y and init_pose_yaw is missing",
        ),
    ],
)
def test_wrong_parameters(peer: Peer, parameters: dict[str, object], why: str) -> None:
    code, text = peer.start(**parameters).end()
    assert code == 1, text
    assert why in text
    assert "Traceback" not in text


def test_wrong_usage(peer: Peer) -> None:
    code, text = peer.start("--", "--no-such-option").end()
    assert code == 2, text


def test_without_map_msgs(peer: Peer, explored: gridmerge.Simulation, tmp_path: Path) -> None:
    (tmp_path / "map_msgs.py").write_text("raise ImportError\n", encoding="utf-8")
    path = os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")])
    peer.environment["PYTHONPATH"] = path
    peer.start()
    peer.publish_all(explored)
    peer.wait_until_placed("tb0", "tb1", "tb2")
    assert "map_msgs is not installed" in (peer.value("gridmerge", "problem") or "")
    assert peer.level("gridmerge") == 1


def test_ctrl_c_while_it_works(peer: Peer, explored: gridmerge.Simulation) -> None:
    program = peer.start()
    peer.publish_all(explored)
    time.sleep(0.05)
    code, text = program.end(signal.SIGINT)
    assert code == 0, text
    assert "Traceback" not in text
