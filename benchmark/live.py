#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""`gridmerge node` beside rclpy, over the loopback interface: robots that explore, an hour of them,
and maps of 4000 x 4000 cells.

usage: benchmark/live.py GRIDMERGE explore [--robots N] [--teams N] [--steps N]
       benchmark/live.py GRIDMERGE hour [--robots N] [--speed N]
       benchmark/live.py GRIDMERGE large [--repeats N]

Runs in an environment that has rclpy and the package gridmerge: ./dev benchmark --live makes it.

explore: teams of robots publish their maps once per second, at N moments of their ways. A line for each team says:
- how long after the first maps that merge() joins were sent the node has joined some;
- how many robots lay wrongly at any time, and how many lost their place after they had 0.98 or more;
- whether the last /merged_map is that of merge(), to the cell.

hour: robots that explore, stand, repeat their maps, and start anew in another frame every ten minutes, once per second
each and --speed times as fast. What the node takes in time and memory must be that of the first ten minutes.

large: two robots' maps of 4000 x 4000 cells, of one building of 170 m. Then the second one changes in a hundredth of
its area, again and again: it is sent whole, and as an update. A line for each says when /merged_map is here, and what
the node takes of CPU.
"""

from __future__ import annotations

import argparse
import array
import fcntl
import functools
import os
import pathlib
import signal
import subprocess
import tempfile
import time
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

# Before anything of ROS starts.
os.environ["ROS_LOCALHOST_ONLY"] = "1"
for _variable in (
    "ROS_AUTOMATIC_DISCOVERY_RANGE",
    "ROS_STATIC_PEERS",
    "CYCLONEDDS_URI",
    "RMW_IMPLEMENTATION",
):
    os.environ.pop(_variable, None)
# Fast DDS loses maps of 16 MB with its usual buffers (docs/node.md).
PROFILE = """<profiles xmlns="http://www.eprosima.com"><transport_descriptors><transport_descriptor>
<transport_id>udp</transport_id><type>UDPv4</type><sendBufferSize>4194304</sendBufferSize>
<receiveBufferSize>4194304</receiveBufferSize></transport_descriptor></transport_descriptors>
<participant profile_name="large" is_default_profile="true"><rtps><userTransports><transport_id>udp</transport_id>
</userTransports><useBuiltinTransports>false</useBuiltinTransports><sendSocketBufferSize>4194304</sendSocketBufferSize>
<listenSocketBufferSize>4194304</listenSocketBufferSize></rtps></participant></profiles>"""
_folder = tempfile.TemporaryDirectory(prefix="gridmerge-live-")
_profile = pathlib.Path(_folder.name, "fastdds.xml")
_profile.write_text(PROFILE)
os.environ["FASTRTPS_DEFAULT_PROFILES_FILE"] = os.environ["FASTDDS_DEFAULT_PROFILES_FILE"] = str(_profile)

import gridmerge  # noqa: E402
import hour  # noqa: E402
import numpy as np  # noqa: E402
import rclpy  # noqa: E402
from diagnostic_msgs.msg import DiagnosticArray  # noqa: E402
from map_msgs.msg import OccupancyGridUpdate  # noqa: E402
from nav_msgs.msg import OccupancyGrid  # noqa: E402
from online import KINDS, SURE, simulate_team, wrong_ones  # noqa: E402
from rclpy.qos import DurabilityPolicy, QoSProfile  # noqa: E402

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
LONGEST_WAIT = 300.0  # s: ends what would never end


def free_domain() -> int:
    """A domain that no test on this machine has: each is held by a locked file, as tests/dds/running_node.hpp does."""
    for i in range(100):
        domain = 1 + (os.getpid() + i) % 100
        file = os.open(f"/tmp/gridmerge-test-domain-{domain}", os.O_RDWR | os.O_CREAT, 0o666)
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)  # until the process ends
        except BlockingIOError:
            os.close(file)
        else:
            return domain
    raise SystemExit("all domains are taken")


class Live:
    """The node, and robots that talk to it."""

    def __init__(self, program: str) -> None:
        domain = free_domain()
        os.environ["ROS_DOMAIN_ID"] = str(domain)
        log = pathlib.Path(_folder.name, "node.log")
        with log.open("w") as file:
            self.program = subprocess.Popen([program, "node"], stdout=file, stderr=subprocess.STDOUT)
        self.log = log.open()
        rclpy.init(domain_id=domain)
        self.node = rclpy.create_node("robots")
        self.diagnoses: dict[str, dict[str, str]] = {}
        self.node.create_subscription(DiagnosticArray, "/diagnostics", self.on_diagnostics, 10)
        self.publishers: dict[str, Any] = {}

    def __enter__(self) -> Live:
        return self

    def __exit__(self, *_: object) -> None:
        self.program.send_signal(signal.SIGTERM)
        print(f"the node ended with exit code {self.program.wait()}")
        rclpy.shutdown()

    def on_diagnostics(self, message: DiagnosticArray) -> None:
        for status in message.status:
            self.diagnoses[status.name.removeprefix("gridmerge: ")] = {
                one.key: one.value for one in status.values
            }

    def value(self, robot: str, key: str) -> str:
        return self.diagnoses.get(robot, {}).get(key, "")

    def answer(self) -> SimpleNamespace:
        """The robots that are placed, and in which components, as of gridmerge.TeamAnswer."""
        robots: list[SimpleNamespace] = []
        components: dict[str, list[str]] = {}
        for name, values in sorted(self.diagnoses.items()):
            if values.get("state") != "placed":
                continue
            transform = gridmerge.Transform(*(float(values[key]) for key in ("x", "y", "theta")))
            probability = float(values["probability"])
            robots.append(SimpleNamespace(name=name, transform=transform, probability=probability))
            components.setdefault(values["component"], []).append(name)
        return SimpleNamespace(
            robots=robots, components=[SimpleNamespace(robots=one) for _, one in sorted(components.items())]
        )

    def new_lines(self) -> list[str]:
        """What the node has said since this was called last."""
        return self.log.readlines()

    def holds_within(self, seconds: float, holds: Callable[[], bool]) -> bool:
        end = time.monotonic() + seconds
        while not holds():
            if time.monotonic() > end:
                return False
            rclpy.spin_once(self.node, timeout_sec=0.005)
        return True

    def wait_until(self, holds: Callable[[], bool], what: str) -> None:
        if not self.holds_within(LONGEST_WAIT, holds):
            raise SystemExit(f"never: {what}; the node says {self.diagnoses}")

    def publish(self, robot: str, grid: gridmerge.OccupancyGrid, frame: str, second: int) -> None:
        if robot not in self.publishers:
            self.publishers[robot] = self.node.create_publisher(OccupancyGrid, f"/{robot}/map", LATCHED)
        message = grid.to_msg(OccupancyGrid, frame_id=frame, probabilities=False)
        message.header.stamp.sec = second
        self.publishers[robot].publish(message)


def run_explore(program: str, arguments: argparse.Namespace) -> None:
    for number in range(arguments.teams):
        simulation = simulate_team(number, arguments.robots, arguments.steps)
        moments = [
            [as_sent((*one.earlier, one.grid)[step]) for one in simulation.maps]
            for step in range(arguments.steps)
        ]
        possible = next(
            (step for step, grids in enumerate(moments) if gridmerge.merge(grids).components), None
        )
        with Live(program) as live:
            explore(live, KINDS[number % len(KINDS)], simulation, moments, possible)


def as_sent(grid: gridmerge.OccupancyGrid) -> gridmerge.OccupancyGrid:
    return gridmerge.OccupancyGrid.from_msg(grid.to_msg(probabilities=False))


def explore(
    live: Live,
    kind: str,
    simulation: gridmerge.Simulation,
    moments: list[list[gridmerge.OccupancyGrid]],
    possible: int | None,
) -> None:
    merged: list[OccupancyGrid] = []
    live.node.create_subscription(
        OccupancyGrid, "/merged_map", lambda message: merged.__setitem__(slice(None), [message]), LATCHED
    )
    names = [f"tb{robot}" for robot in range(len(simulation.maps))]
    joined: float | None = None  # s
    wrong: set[str] = set()
    sure: set[str] = set()
    lost: dict[str, set[str]] = {words: set() for words in ("moved by", "is no longer", "started anew")}
    begin = time.monotonic()

    def look(grids: list[gridmerge.OccupancyGrid]) -> None:
        nonlocal joined
        rclpy.spin_once(live.node, timeout_sec=0.01)
        answer = live.answer()
        if joined is None and answer.robots:
            joined = time.monotonic() - begin
        wrong.update(wrong_ones(simulation, grids, answer))
        for line in live.new_lines():
            for words, robots in lost.items():
                robots.update(name for name in sure if f"{name} {words}" in line)
        sure.update(robot.name for robot in answer.robots if robot.probability >= SURE)

    for step, grids in enumerate(moments):
        for name, grid in zip(names, grids, strict=True):
            live.publish(name, grid, f"{name}/map", step)
        sent, solves = time.monotonic(), live.value("gridmerge", "solves")
        while time.monotonic() < begin + step + 1:
            look(grids)
    # The first map of a robot may be replaced by the next before the node has found it:
    # how many are heard says nothing.
    while (
        live.value("gridmerge", "settled") != "yes"
        or live.value("gridmerge", "solves") == solves
        or time.monotonic() < sent + 2.0
    ):
        if time.monotonic() > sent + LONGEST_WAIT:
            raise SystemExit(f"never settled; the node says {live.diagnoses}")
        look(moments[-1])
    settled = time.monotonic() - sent
    answer = live.answer()
    # In the frame of the robot that the node heard first, which merge() takes the first map's for.
    first = answer.components[0].robots if answer.components else []
    at_origin = {
        robot.name
        for robot in answer.robots
        if robot.transform.x == robot.transform.y == robot.transform.theta == 0.0
    }
    anchor = next((name for name in first if name in at_origin), names[0])
    order = [anchor, *(name for name in names if name != anchor)]
    expected = gridmerge.merge([moments[-1][names.index(name)] for name in order])
    largest = next(
        (one for one in expected.components if any(member.map == 0 for member in one.members)), None
    )
    same = "no" if answer.components or expected.components else "-"
    if largest is not None and answer.components:

        def is_here() -> bool:
            return bool(merged) and np.array_equal(
                gridmerge.OccupancyGrid.from_msg(merged[0]).cells, largest.grid.cells
            )

        same = "yes" if live.holds_within(10.0, is_here) else "no"
    told = "never" if joined is None else f"at {joined:.1f} s"
    if joined is not None and possible is not None:
        told += f", {joined - possible:.1f} s after the maps of moment {possible}, which merge() joins first"
    print(
        f"{kind:10s} first join {told}; settled {settled:.1f} s after the last maps; "
        f"placed {len(answer.robots)} of {len(names)} "
        f"(merge(): {sum(len(one.members) for one in expected.components)}), wrong at any time {len(wrong)}; "
        f"of robots that were sure {len(lost['moved by'])} jumped, {len(lost['is no longer'])} were taken out, "
        f"{len(lost['started anew'])} started anew; "
        f"/merged_map is that of merge(): {same}",
        flush=True,
    )


def run_hour(live: Live, arguments: argparse.Namespace) -> None:
    played = hour.Hour(arguments.robots)

    def send(robot: int, second: int) -> None:
        live.publish(
            f"tb{robot}", played.grid(robot, second), f"tb{robot}/map_{played.lap(robot, second)[0]}", second
        )
        rclpy.spin_once(live.node, timeout_sec=0.0)

    def look(second: int) -> tuple[int, int, int, int]:
        before = live.diagnoses.get("gridmerge")
        live.wait_until(lambda: live.diagnoses.get("gridmerge") is not before, "another diagnosis")
        names = [f"tb{robot}" for robot in played.robots]
        laps = [int(live.value(name, "frame").rpartition("_")[2]) for name in names]
        answer = live.answer()
        maps = sum(int(live.value(name, "maps")) for name in names)
        wrong = wrong_ones(*played.truth(laps, second), answer)
        return maps, int(live.value("gridmerge", "solves")), len(answer.robots), len(wrong)

    print(f"An hour of {arguments.robots} robots, {arguments.speed:g} times as fast:", flush=True)
    hour.play(played, arguments.speed, hour.Cost(live.program.pid), send, look)


def large_maps() -> list[gridmerge.OccupancyGrid]:
    simulation = gridmerge.simulate(
        "office", size=(170.0, 170.0), robots=2, overlap=0.7, drift=0.0, others=0, seed=3
    )
    grids = []
    for one in simulation.maps:
        cells = np.zeros((4000, 4000), np.uint8)
        height, width = np.minimum(one.grid.cells.shape, 4000)
        cells[:height, :width] = one.grid.cells[:height, :width]
        grids.append(gridmerge.OccupancyGrid.from_cells(cells, one.grid.resolution, one.grid.origin))
    return grids


def run_large(live: Live, arguments: argparse.Namespace) -> None:
    first, second = large_maps()
    cost = hour.Cost(live.program.pid)
    merged: list[OccupancyGrid] = []
    live.node.create_subscription(
        OccupancyGrid, "/merged_map", lambda message: merged.__setitem__(slice(None), [message]), LATCHED
    )
    updates = live.node.create_publisher(OccupancyGridUpdate, "/tb2/map_updates", LATCHED)

    def measure(what: str, stamp: int, send: Callable[[], None]) -> None:
        cost.look()
        cpu, begin = cost.cpu, time.monotonic()
        send()
        written = time.monotonic() - begin
        live.wait_until(
            lambda: bool(merged) and merged[0].header.stamp.sec == stamp, f"a merged map of second {stamp}"
        )
        seconds = time.monotonic() - begin
        cost.look()
        until_here, memory = cost.cpu - cpu, cost.resident[-1]
        # What follows once no newer map comes: until the node rests for longer than that takes.
        rest = cost.cpu
        while True:
            time.sleep(4.0)
            cost.look()
            if cost.cpu - rest < 0.2:
                break
            rest = cost.cpu
        info = merged[0].info
        print(
            f"{what:22s} written {written:4.2f} s, /merged_map of {info.width} x {info.height} cells "
            f"after {seconds:4.2f} s and {until_here:4.2f} s of CPU, {memory:4.0f} MB; "
            f"searched thoroughly: {cost.cpu - cpu - until_here:5.2f} s of CPU more, "
            f"{max(cost.resident):4.0f} MB at most",
            flush=True,
        )

    live.publish("tb1", first, "tb1/map", 1)
    live.wait_until(lambda: live.value("tb1", "maps") == "1", "the first map")
    measure("the second map", 2, lambda: live.publish("tb2", second, "tb2/map", 2))
    cells = second.cells.copy()
    corner, side = 1500, 400  # a hundredth of the area
    dice = np.random.default_rng(1)
    stamp = 2
    for _ in range(arguments.repeats):
        for as_update in (False, True):
            stamp += 1
            part = cells[corner : corner + side, corner : corner + side]
            part[dice.random(part.shape) < 0.003] = 1 + stamp % 2
            if as_update:
                values = np.choose(part, (-1, 0, 100)).astype(np.int8)
                update = OccupancyGridUpdate(
                    x=corner, y=corner, width=side, height=side, data=array.array("b", values.tobytes())
                )
                update.header.frame_id = "tb2/map"
                update.header.stamp.sec = stamp
                measure("as an update", stamp, functools.partial(updates.publish, update))
            else:
                grid = gridmerge.OccupancyGrid.from_cells(cells, second.resolution, second.origin)
                send = functools.partial(live.publish, "tb2", grid, "tb2/map", stamp)
                measure("1 % changes, as a whole", stamp, send)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("gridmerge")
    parser.add_argument("what", choices=("explore", "hour", "large"))
    parser.add_argument("--robots", type=int, default=6)
    parser.add_argument("--teams", type=int, default=6)
    parser.add_argument("--steps", type=int, default=12, help="moments of the robots' ways, one per second")
    parser.add_argument("--speed", type=float, default=20.0, help="seconds of the hour per second")
    parser.add_argument("--repeats", type=int, default=5)
    arguments = parser.parse_args()
    if arguments.what == "explore":
        run_explore(arguments.gridmerge, arguments)
        return
    with Live(arguments.gridmerge) as live:
        {"hour": run_hour, "large": run_large}[arguments.what](live, arguments)


if __name__ == "__main__":
    main()
