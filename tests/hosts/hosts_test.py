#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A team without a centre: three hosts, each a network namespace with a robot and a node of its own, on one network.
Hosts are killed, cut off, and come back; the network loses messages and is slow. All nodes have to publish the same
answer again, and the one that gridmerge merge gives. Nothing leaves the namespaces.

usage: hosts_test.py --gridmerge BINARY --listener BINARY [--rate R] [SCENARIO...]

It needs root, and ip and tc (Debian: iproute2). Without them it ends with 77. It prints the seconds after
which all nodes agreed.
"""

import argparse
import json
import math
import os
import pathlib
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time

HOSTS = (1, 2, 3)
DOMAIN = 7
STEPS = 6
MOST = 120.0  # s: far more than any scenario takes; it ends a test that would never end
POSE = 0.002  # diagnoses round to millimetres [m, rad]


def run(*command: object) -> None:
    subprocess.run([str(word) for word in command], check=True, stdout=subprocess.DEVNULL)


class Network:
    """Namespaces gm<PID>-1 to -3, joined by a bridge in one more."""

    def __init__(self) -> None:
        self.prefix = f"gm{os.getpid() % 10000}"
        self.bridge = f"{self.prefix}-b"

    def host(self, number: int) -> str:
        return f"{self.prefix}-{number}"

    def __enter__(self) -> "Network":
        try:
            run("ip", "netns", "add", self.bridge)
            inside = ("ip", "-n", self.bridge)
            run(*inside, "link", "add", "br0", "type", "bridge", "mcast_snooping", "0")
            run(*inside, "link", "set", "br0", "up")
            for number in HOSTS:
                host = self.host(number)
                run("ip", "netns", "add", host)
                run(
                    *inside,
                    "link",
                    "add",
                    f"port{number}",
                    "type",
                    "veth",
                    "peer",
                    "name",
                    "eth0",
                    "netns",
                    host,
                )
                run(*inside, "link", "set", f"port{number}", "master", "br0", "up")
                run("ip", "-n", host, "address", "add", f"10.77.0.{number}/24", "dev", "eth0")
                for device in ("lo", "eth0"):
                    run("ip", "-n", host, "link", "set", device, "up")
                run("ip", "-n", host, "route", "add", "224.0.0.0/4", "dev", "eth0")
        except BaseException:
            self.remove()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self.remove()

    def remove(self) -> None:
        for name in (*map(self.host, HOSTS), self.bridge):
            subprocess.run(["ip", "netns", "delete", name], stderr=subprocess.DEVNULL, check=False)

    def connect(self, number: int, connected: bool) -> None:
        run("ip", "-n", self.bridge, "link", "set", f"port{number}", "up" if connected else "down")

    def limit(self, megabits: int) -> None:
        for number in HOSTS:
            run("ip", "netns", "exec", self.host(number), "tc", "qdisc", "add", "dev", "eth0", "root", "tbf",
                "rate", f"{megabits}mbit", "burst", "64kb", "latency", "200ms")  # fmt: skip

    def start(
        self, number: int, command: list[str], loss: float = 0.0, **options: object
    ) -> subprocess.Popen:
        environment = {
            key: value for key, value in os.environ.items() if not key.startswith(("ROS_", "CYCLONEDDS_"))
        }
        environment["ROS_DOMAIN_ID"] = str(DOMAIN)
        if loss > 0.0:
            environment["CYCLONEDDS_URI"] = (
                f"<CycloneDDS><Domain><Internal><Test><XmitLossiness>{round(1000 * loss)}</XmitLossiness>"
                "</Test></Internal></Domain></CycloneDDS>"
            )
        # No shell and no ip process in between: a signal reaches the program itself.
        name = self.host(number)
        return subprocess.Popen(
            ["ip", "netns", "exec", name, *command], env=environment, stderr=subprocess.STDOUT, **options
        )


def read_map(path: pathlib.Path) -> tuple[int, int, bytes, dict[str, object]]:
    """Columns, rows, the message's values, and the description of a map that gridmerge simulate wrote."""
    fields: dict[str, object] = {}
    for line in path.read_text().splitlines():
        key, _, value = line.partition(":")
        fields[key.strip()] = value.strip()
    image = (path.parent / str(fields["image"])).read_bytes()
    magic, columns, rows, _, pixels = image.split(maxsplit=4)
    width, height = int(columns), int(rows)
    pixels = image[-width * height :]
    if magic != b"P5":
        sys.exit(f"{path}: not a binary PGM")
    value_of = {0: 100, 254: 0}
    values = bytes(value_of.get(pixel, 255) for pixel in pixels)  # 255 is -1: unknown
    return (
        width,
        height,
        b"".join(values[row * width : (row + 1) * width] for row in reversed(range(height))),
        fields,
    )


def map_message(path: pathlib.Path, frame: str) -> bytes:
    """nav_msgs/OccupancyGrid in CDR, little-endian."""
    width, height, values, fields = read_map(path)
    x, y, yaw = json.loads(str(fields["origin"]))
    if yaw != 0.0:
        sys.exit(f"{path}: turned maps are not expected here")
    text = frame.encode() + b"\0"
    body = struct.pack("<iII", 0, 0, len(text)) + text
    body += b"\0" * (-len(body) % 4)
    body += struct.pack("<iIfII", 0, 0, float(str(fields["resolution"])), width, height)
    body += b"\0" * (-len(body) % 8)
    body += struct.pack("<7d", x, y, 0.0, 0.0, 0.0, 0.0, 1.0)
    return b"\0\1\0\0" + body + struct.pack("<I", len(values)) + values


def write_mcap(path: pathlib.Path, topic: str, messages: list[bytes]) -> None:
    """One message per second. https://mcap.dev/spec has the format; a summary may be left out."""

    def text(value: str) -> bytes:
        return struct.pack("<I", len(value)) + value.encode()

    def record(kind: int, content: bytes) -> bytes:
        return struct.pack("<BQ", kind, len(content)) + content

    magic = b"\x89MCAP0\r\n"
    content = magic + record(1, text("ros2") + text("gridmerge"))
    content += record(
        3, struct.pack("<H", 1) + text("nav_msgs/msg/OccupancyGrid") + text("ros2msg") + text("")
    )
    content += record(4, struct.pack("<HH", 1, 1) + text(topic) + text("cdr") + struct.pack("<I", 0))
    for second, message in enumerate(messages):
        content += record(5, struct.pack("<HIQQ", 1, second, second * 10**9, second * 10**9) + message)
    content += record(15, struct.pack("<I", 0)) + record(2, struct.pack("<QQI", 0, 0, 0)) + magic
    path.write_bytes(content)


class Listener:
    """What is published, as one of the hosts hears it."""

    def __init__(self, network: Network, binary: str) -> None:
        self.state: dict = {"maps": {}, "diagnoses": {}}
        topics = [f"/n{number}_map" for number in HOSTS]
        self.process = network.start(1, [binary, str(DOMAIN), *topics], stdout=subprocess.PIPE)
        threading.Thread(target=self.read, daemon=True).start()

    def read(self) -> None:
        for line in self.process.stdout:
            self.state = json.loads(line)

    def poses(self, node: int) -> dict[str, tuple[float, float, float]]:
        found = {}
        for name, values in self.state["diagnoses"].items():
            if name.startswith(f"n{node}: ") and values.get("state") == "placed":
                found[name.split(": ")[1]] = tuple(float(values[key]) for key in ("x", "y", "theta"))
        return found


class Team:
    def __init__(
        self, network: Network, arguments: argparse.Namespace, folder: pathlib.Path, loss: float
    ) -> None:
        self.network, self.arguments, self.folder, self.loss = network, arguments, folder, loss
        self.nodes: dict[int, subprocess.Popen] = {}
        self.listener = Listener(network, arguments.listener)

    def __enter__(self) -> "Team":
        return self

    def __exit__(self, *_: object) -> None:
        for process in (*self.nodes.values(), self.listener.process):
            process.kill()
            process.wait()

    def start(self, number: int) -> None:
        log = (self.folder / f"n{number}.log").open("ab")
        self.nodes[number] = self.network.start(
            number,
            [self.arguments.gridmerge, "node", "--name", f"n{number}", "--output", f"/n{number}_map", "--tf", "none",
             "--bag", str(self.folder / f"tb{number}.mcap"), "--rate", str(self.arguments.rate), "--verbose"],
            self.loss, stdout=log)  # fmt: skip

    def kill(self, number: int) -> None:
        self.nodes[number].send_signal(signal.SIGKILL)
        self.nodes[number].wait()

    def wait(self, what: str, holds) -> float:
        begin = time.monotonic()
        while not holds():
            if time.monotonic() - begin > MOST:
                sys.exit(f"{what}: not within {MOST:g} s; heard: {json.dumps(self.listener.state)[:4000]}")
            for number, process in self.nodes.items():
                if process.poll() not in (None, -signal.SIGKILL):
                    sys.exit(f"{what}: node {number} ended by itself with {process.returncode}")
            time.sleep(0.1)
        return time.monotonic() - begin

    def agree(self, robots: int = len(HOSTS), nodes: tuple[int, ...] = HOSTS) -> bool:
        """Whether these nodes place so many robots at the same poses, and publish the same map."""
        poses = [self.listener.poses(node) for node in nodes]
        hashes = [self.listener.state["maps"].get(f"/n{node}_map", {}).get("hash") for node in nodes]
        return (
            all(len(one) == robots for one in poses)
            and all(one == poses[0] for one in poses)
            and None not in hashes
            and len(set(hashes)) == 1
        )

    def is_final(self, nodes: tuple[int, ...] = HOSTS) -> bool:
        """Whether they agree on what gridmerge merge says of the last maps."""
        if not self.agree(nodes=nodes):
            return False
        merged = json.loads((self.folder / "merged" / "transforms.json").read_text())
        truth = {}
        for member in merged["components"][0]["members"]:
            pose = member["transform"]
            truth[pathlib.Path(member["source"]).stem.replace("robot_", "tb")] = (
                pose["x"],
                pose["y"],
                pose["theta"],
            )
        poses = self.listener.poses(nodes[0])
        return all(
            abs(heard - true) < POSE
            for robot in poses
            for heard, true in zip(between(poses, robot), between(truth, robot), strict=True)
        )


def between(poses: dict[str, tuple[float, float, float]], robot: str) -> tuple[float, float, float]:
    """A robot's pose in the frame of the first one."""
    x0, y0, theta0 = poses["tb1"]
    x, y, theta = poses[robot]
    cos, sin = math.cos(theta0), math.sin(theta0)
    dx, dy = x - x0, y - y0
    return cos * dx + sin * dy, cos * dy - sin * dx, math.remainder(theta - theta0, 2 * math.pi)


def together(team: Team) -> list[tuple[str, float]]:
    for number in HOSTS:
        team.start(number)
    return [("all agree on the answer of merge", team.wait("together", team.is_final))]


def killed(team: Team) -> list[tuple[str, float]]:
    together(team)
    team.kill(2)
    # Who is gone keeps its place in the maps of the others.
    stays = team.wait("killed", lambda: team.is_final(nodes=(1, 3)))
    time.sleep(12.0)  # a participant that is killed counts as gone after 10 s
    if not team.is_final(nodes=(1, 3)):
        sys.exit("killed: the others changed their answer when a node was gone")
    team.start(2)
    back = team.wait("back", team.is_final)
    return [("the others, after kill -9 of a node", stays), ("all, after it came back", back)]


def cut_off(team: Team) -> list[tuple[str, float]]:
    for number in HOSTS:
        team.start(number)
    team.wait("cut off: first", lambda: len(team.listener.poses(1)) >= 2)
    team.network.connect(3, False)
    time.sleep(30.0)
    team.wait("cut off: the others", lambda: team.agree(robots=len(team.listener.poses(1)), nodes=(1, 2)))
    team.network.connect(3, True)
    return [("all, after a host was cut off for 30 s", team.wait("cut off", team.is_final))]


def first_one_killed(team: Team) -> list[tuple[str, float]]:
    """The robot whose frame is the world's goes with its host, and comes back."""
    together(team)
    before = team.listener.poses(3)
    first = next(robot for robot, pose in before.items() if pose == (0.0, 0.0, 0.0))
    number = int(first.removeprefix("tb"))
    others = tuple(host for host in HOSTS if host != number)
    team.kill(number)
    time.sleep(12.0)
    if team.listener.poses(others[0]) != before:
        sys.exit("first one killed: poses changed when the first robot was gone")
    team.start(number)
    return [(f"all, after the first robot's host ({first}) came back", team.wait("first one", team.is_final))]


SCENARIOS = {
    "together": (together, {}),
    "loss_5": (together, {"loss": 0.05}),
    "loss_20": (together, {"loss": 0.2}),
    "slow": (together, {"megabits": 10}),
    "killed": (killed, {}),
    "first_killed": (first_one_killed, {}),
    "cut_off": (cut_off, {}),
}


def record(arguments: argparse.Namespace, folder: pathlib.Path) -> None:
    """A team's maps while it maps, as bags, and what merge says of the last ones."""
    run(arguments.gridmerge, "simulate", "--robots", len(HOSTS), "--size", "24x16", "--overlap", "0.7", "--seed", 12,
        "--steps", STEPS, "--others", 0, "--quiet", "-o", folder)  # fmt: skip
    for number in HOSTS:
        steps = [folder / f"robot_{number}_step_{step}.yaml" for step in range(1, STEPS)]
        steps.append(folder / f"robot_{number}.yaml")
        frame = f"tb{number}/map"
        write_mcap(
            folder / f"tb{number}.mcap", f"/tb{number}/map", [map_message(path, frame) for path in steps]
        )
    run(arguments.gridmerge, "merge", *(folder / f"robot_{number}.yaml" for number in HOSTS), "--quiet",
        "-o", folder / "merged")  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--gridmerge", required=True)
    parser.add_argument("--listener", required=True)
    parser.add_argument("--rate", type=float, default=2.0)
    parser.add_argument("scenarios", nargs="*", metavar="SCENARIO", help=", ".join(SCENARIOS))
    arguments = parser.parse_args()
    if unknown := [name for name in arguments.scenarios if name not in SCENARIOS]:
        parser.error(f"no such scenario: {', '.join(unknown)}")
    if os.geteuid() != 0 or not all(map(shutil.which, ("ip", "tc"))):
        print("skipped: network namespaces take root, ip and tc (Debian: iproute2)")
        sys.exit(77)
    rows = []
    with tempfile.TemporaryDirectory(prefix="gridmerge-hosts-") as name:
        folder = pathlib.Path(name)
        record(arguments, folder)
        for scenario in arguments.scenarios or SCENARIOS:
            play, options = SCENARIOS[scenario]
            with Network() as network:
                if "megabits" in options:
                    network.limit(options["megabits"])
                with Team(network, arguments, folder, options.get("loss", 0.0)) as team:
                    for what, seconds in play(team):
                        rows.append((scenario, what, seconds))
                        print(f"{scenario:13} {what:55} {seconds:6.1f} s", flush=True)
    print(f"{len(rows)} answers, each the same on all hosts")


if __name__ == "__main__":
    main()
