# SPDX-License-Identifier: Apache-2.0
"""`gridmerge node` beside real nodes of ROS 2: rclpy with Fast DDS, all on this machine.

    VENV/bin/python ros_peers_test.py --gridmerge PROGRAM --maps FOLDER [TEST...]

VENV has rclpy and what make_messages.py made; FOLDER is examples/three_robots.
"""

from __future__ import annotations

import argparse
import array
import fcntl
import math
import os
import re
import signal
import subprocess
import sys
import time
import unittest
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from map_msgs.msg import OccupancyGridUpdate
from nav_msgs.msg import OccupancyGrid
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.serialization import serialize_message
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
# The types' hashes, by which ROS's tools know that a definition is theirs.
HASHES = {
    "/merged_map": "RIHS01_8d348150c12913a31ee0ec170fbf25089e4745d17035792a1ba94d6f0bc0cfc7",
    "/tf_static": "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087",
    "/diagnostics": "RIHS01_5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e",
}
# What ends a test that would never end.
LONGEST_WAIT = 60.0
# How the second robot's map is turned in the first one's frame (examples/three_robots/README.md).
THETA_1_2 = 1.44

options = argparse.Namespace()


def read_map(robot: int) -> OccupancyGrid:
    """The map of a robot of the example, as its message."""
    content = Path(options.maps, f"robot_{robot}.pgm").read_bytes()
    head = re.match(rb"P5\s+(?:#.*\n)?(\d+)\s+(\d+)\s+255\s", content)
    assert head is not None
    width, height = int(head[1]), int(head[2])
    pixels = np.frombuffer(content, np.uint8, width * height, head.end()).reshape(height, width)[::-1]
    values = np.full(pixels.shape, -1, np.int8)
    values[pixels == 254] = 0
    values[pixels == 0] = 100
    yaml = Path(options.maps, f"robot_{robot}.yaml").read_text(encoding="utf-8")
    origin = re.search(r"origin: \[(\S+), (\S+), ", yaml)
    assert origin is not None
    message = OccupancyGrid()
    message.header.frame_id = f"tb{robot}/map"
    message.header.stamp.sec = 100
    message.info.resolution = 0.05
    message.info.width, message.info.height = width, height
    message.info.origin.position.x, message.info.origin.position.y = float(origin[1]), float(origin[2])
    message.data = array.array("b", values.tobytes())
    return message


def free_domain() -> tuple[int, int]:
    """A domain that no other test on this machine has, and the open file whose lock holds it."""
    for i in range(100):
        domain = 1 + (os.getpid() + i) % 100
        file = os.open(f"/tmp/gridmerge-test-domain-{domain}", os.O_RDWR | os.O_CREAT, 0o666)
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            os.close(file)
        else:
            return domain, file
    raise RuntimeError("all domains are taken")


class Program:
    """`gridmerge node`, running."""

    def __init__(self, domain: int, *arguments: str) -> None:
        environment = dict(os.environ, ROS_DOMAIN_ID=str(domain))
        self.process = subprocess.Popen(
            [options.gridmerge, "node", *arguments],
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def end(self, with_signal: int | None = None) -> tuple[int, str, str]:
        """Its exit code and what it wrote."""
        if with_signal is not None:
            self.process.send_signal(with_signal)
        out, err = self.process.communicate(timeout=LONGEST_WAIT)
        return self.process.returncode, out, err


class RosPeers(unittest.TestCase):
    def setUp(self) -> None:
        self.domain, lock = free_domain()
        self.addCleanup(os.close, lock)
        self.context = Context()
        rclpy.init(context=self.context, domain_id=self.domain)
        self.node = rclpy.create_node("peer", context=self.context)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)
        self.diagnoses: dict[str, dict[str, str]] = {}
        self.levels: dict[str, int] = {}
        self.node.create_subscription(DiagnosticArray, "/diagnostics", self.on_diagnostics, 10)
        self.program: Program | None = None

    def tearDown(self) -> None:
        if self.program is not None and self.program.process.poll() is None:
            self.program.process.kill()
            self.program.process.communicate()
        self.executor.shutdown()
        self.node.destroy_node()
        rclpy.shutdown(context=self.context)

    def start(self, *arguments: str) -> Program:
        self.program = Program(self.domain, *arguments)
        return self.program

    def on_diagnostics(self, message: DiagnosticArray) -> None:
        for status in message.status:
            name = status.name.removeprefix("gridmerge: ")
            self.levels[name] = int.from_bytes(status.level, "little")
            self.diagnoses[name] = {entry.key: entry.value for entry in status.values}
            self.diagnoses[name]["message"] = status.message

    def wait_until(self, holds: Callable[[], bool], what: str) -> None:
        end = time.monotonic() + LONGEST_WAIT
        while not holds():
            self.assertLess(time.monotonic(), end, f"never: {what}; the node says {self.diagnoses}")
            self.executor.spin_once(timeout_sec=0.1)

    def value(self, robot: str, key: str) -> str | None:
        return self.diagnoses.get(robot, {}).get(key)

    def wait_for(self, robot: str, key: str, value: str) -> None:
        self.wait_until(lambda: self.value(robot, key) == value, f"{robot}: {key} is {value}")

    def collect(self, message_type: Any, topic: str, qos: Any = LATCHED) -> list[Any]:
        received: list[Any] = []
        self.node.create_subscription(message_type, topic, received.append, qos)
        return received

    def publish(self, robot: int, qos: Any = LATCHED) -> Any:
        publisher = self.node.create_publisher(OccupancyGrid, f"/tb{robot}/map", qos)
        publisher.publish(read_map(robot))
        return publisher

    def publish_all(self) -> None:
        for robot in (1, 2, 3):
            self.publish(robot)
            self.wait_until(
                lambda robot=robot: self.value(f"tb{robot}", "maps") == "1", f"tb{robot} is heard"
            )
        for robot in (1, 2, 3):
            self.wait_for(f"tb{robot}", "state", "placed")

    def test_maps_become_one(self) -> None:
        program = self.start()
        maps = self.collect(OccupancyGrid, "/merged_map")
        transforms = self.collect(TFMessage, "/tf_static")
        self.publish_all()
        self.wait_until(lambda: bool(transforms) and len(transforms[-1].transforms) == 3, "three transforms")
        self.wait_until(
            lambda: bool(maps) and maps[-1].info.width * maps[-1].info.height > 600 * 800, "a merged map"
        )
        merged = maps[-1]
        self.assertEqual(merged.header.frame_id, "world")
        self.assertEqual(merged.header.stamp.sec, 100)
        self.assertEqual(len(merged.data), merged.info.width * merged.info.height)
        self.assertEqual(set(merged.data), {-1, 0, 100})
        by_child = {one.child_frame_id: one for one in transforms[-1].transforms}
        self.assertEqual({one.header.frame_id for one in by_child.values()}, {"world"})
        second = by_child["tb2/map"].transform
        self.assertEqual(by_child["tb1/map"].transform.translation.x, 0.0)
        theta = 2 * math.atan2(second.rotation.z, second.rotation.w)
        self.assertAlmostEqual(theta, THETA_1_2, delta=0.01)
        self.assertEqual(self.levels["tb1"], 0)
        self.assertEqual(self.diagnoses["gridmerge"]["message"], "3 of 3 robots placed")

        with self.subTest("who comes late gets the map and the transforms"):
            late = self.collect(OccupancyGrid, "/merged_map")
            late_transforms = self.collect(TFMessage, "/tf_static")
            self.wait_until(lambda: bool(late) and bool(late_transforms), "latched messages")
        with self.subTest("ROS's tools see a node with known types"):
            self.wait_until(lambda: "gridmerge" in self.node.get_node_names(), "the node's name")
            for topic, expected in HASHES.items():
                (info,) = self.node.get_publishers_info_by_topic(topic)
                self.assertEqual(str(info.topic_type_hash), expected, topic)
            published = dict(self.node.get_publisher_names_and_types_by_node("gridmerge", "/"))
            self.assertEqual(set(published), set(HASHES))
            subscribed = dict(self.node.get_subscriber_names_and_types_by_node("gridmerge", "/"))
            self.assertEqual(set(subscribed), {"/tb1/map", "/tb2/map", "/tb3/map", "/diagnostics"})
        with self.subTest("updates are part of a map"):
            update = OccupancyGridUpdate(x=1, y=1, width=2, height=1, data=array.array("b", [100, 100]))
            update.header.frame_id = "tb3/map"
            update.header.stamp.sec = 101
            updates = self.node.create_publisher(OccupancyGridUpdate, "/tb3/map_updates", LATCHED)
            updates.publish(update)
            self.wait_for("tb3", "updates", "1")
        with self.subTest("a signal ends it"):
            code, out, err = program.end(signal.SIGINT)
            self.assertEqual((code, err), (0, ""), out)

    def test_unreliable_and_volatile_publishers_are_heard(self) -> None:
        self.start()
        unreliable = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        publishers = [self.publish(1, unreliable), self.publish(2, QoSProfile(depth=1))]
        messages = [read_map(1), read_map(2)]

        def publish_again() -> bool:
            for publisher, message in zip(publishers, messages, strict=True):
                publisher.publish(message)
            return self.value("tb1", "state") == self.value("tb2", "state") == "placed"

        self.wait_until(publish_again, "both are placed")

    def test_wrong_messages_are_refused(self) -> None:
        program = self.start()
        self.publish_all()
        publisher = self.node.create_publisher(String, "/tb4/map", LATCHED)  # another type
        publisher.publish(String(data="no map"))
        hostile = self.node.create_publisher(OccupancyGrid, "/tb5/map", QoSProfile(depth=100))
        self.wait_for("tb5", "publishers", "1")

        def refused(message: OccupancyGrid, why: str, count: int) -> None:
            hostile.publish(message)
            self.wait_for("tb5", "refused", str(count))
            self.assertIn(why, self.value("tb5", "last refusal") or "")

        message = read_map(1)
        message.data = message.data[:-1]
        refused(message, "values for", 1)
        message = read_map(1)
        message.info.width = message.info.height = 2**31
        refused(message, "above 2^28", 2)
        message = read_map(1)
        message.info.resolution = float("nan")
        refused(message, "a resolution of nan", 3)
        message = read_map(1)
        message.info.origin.orientation.w = 2.0
        refused(message, "quaternion", 4)
        # Bytes that are no message: cut off, and a length of four thousand million cells.
        whole = serialize_message(read_map(1))
        hostile.publish(whole[:200])
        self.wait_for("gridmerge", "messages that could not be decoded", "1")
        at = whole.index(b"tb1/map\0") + 8
        cells = whole.index((543 * 615).to_bytes(4, "little"), at)
        hostile.publish(whole[:cells] + b"\xff\xff\xff\xff" + whole[cells + 4 :])
        self.wait_for("gridmerge", "messages that could not be decoded", "2")
        self.assertEqual(self.levels["tb5"], 1)
        self.assertEqual(self.value("tb1", "state"), "placed")
        code, out, err = program.end(signal.SIGTERM)
        self.assertEqual(code, 0, out + err)
        self.assertIn("/tb5/map: a message is refused: ", err)

    def test_a_killed_publisher_and_its_successor(self) -> None:
        program = self.start()
        self.publish(1)
        self.wait_for("tb1", "maps", "1")
        environment = dict(os.environ, ROS_DOMAIN_ID=str(self.domain))
        command = [sys.executable, __file__, "--maps", options.maps, "--publish", "2"]
        first = subprocess.Popen(command, env=environment, stderr=subprocess.DEVNULL)
        try:
            self.wait_for("tb2", "state", "placed")
            first.kill()
            self.wait_for("tb2", "publishers", "0")
            self.assertEqual(self.value("tb2", "state"), "placed")
        finally:
            first.kill()
            first.wait()
        second = subprocess.Popen(command, env=environment, stderr=subprocess.DEVNULL)
        try:
            self.wait_for("tb2", "maps", "2")
            self.wait_for("tb2", "state", "placed")
        finally:
            second.kill()
            second.wait()
        code, out, err = program.end(signal.SIGTERM)
        self.assertEqual((code, err), (0, ""), out)
        self.assertIn("tb2: its publisher is gone; its map is kept", out)
        self.assertIn("tb2: started anew", out)

    def test_once(self) -> None:
        publishers = [self.publish(robot) for robot in (1, 2)]
        program = self.start("--once", "--wait", "40")
        maps = self.collect(OccupancyGrid, "/merged_map")
        self.wait_until(lambda: program.process.poll() is not None, "its end")
        code, out, err = program.end()
        self.assertEqual((code, err), (0, ""), out)
        self.assertIn("tb2: placed at ", out)
        self.wait_until(lambda: bool(maps), "the merged map")
        self.assertEqual(len(publishers), 2)


def publish_for_ever(robot: int) -> None:
    rclpy.init()
    node = rclpy.create_node(f"robot_{robot}")
    publisher = node.create_publisher(OccupancyGrid, f"/tb{robot}/map", LATCHED)
    publisher.publish(read_map(robot))
    rclpy.spin(node)


def keep_to_this_machine() -> None:
    os.environ["ROS_LOCALHOST_ONLY"] = "1"
    for variable in (
        "ROS_AUTOMATIC_DISCOVERY_RANGE",
        "ROS_STATIC_PEERS",
        "CYCLONEDDS_URI",
        "RMW_IMPLEMENTATION",
    ):
        os.environ.pop(variable, None)


def main() -> None:
    keep_to_this_machine()
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--gridmerge", help="the program")
    parser.add_argument("--maps", required=True, help="examples/three_robots")
    parser.add_argument("--publish", type=int, help="be a robot instead, until killed")
    parser.add_argument("tests", nargs="*")
    parser.parse_args(namespace=options)
    if options.publish:
        publish_for_ever(options.publish)
    tests = [f"RosPeers.{test}" for test in options.tests]
    unittest.main(argv=[sys.argv[0], *tests], verbosity=2)


if __name__ == "__main__":
    main()
