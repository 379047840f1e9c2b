# SPDX-License-Identifier: Apache-2.0
"""A node of ROS 2 that is a team's robots, and whoever listens to the node under test."""

from __future__ import annotations

import array
import math
import os
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from typing import Any

import gridmerge
import pytest
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from lifecycle_msgs.srv import ChangeState, GetState
from nav_msgs.msg import OccupancyGrid
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
VOLATILE = QoSProfile(depth=1)
UNRELIABLE = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
# What ends a test that would never end.
LONGEST_WAIT = 180.0


def map_message(
    grid: gridmerge.OccupancyGrid, frame: str, second: int = 100, message_class: Any = OccupancyGrid
) -> Any:
    message = grid.to_msg(message_class, frame_id=frame, probabilities=False)
    message.header.stamp.sec = second
    return message


def at_step(explored: gridmerge.Simulation, robot: int, step: int) -> gridmerge.OccupancyGrid:
    one = explored.maps[robot]
    return (*one.earlier, one.grid)[step]


def truth(explored: gridmerge.Simulation, world: int, robot: int) -> gridmerge.Transform:
    """From the robot's map frame to that of the robot whose frame is the world's."""
    return explored.maps[world].transform.inverse() @ explored.maps[robot].transform


def yaw(rotation: Any) -> float:
    return 2.0 * math.atan2(rotation.z, rotation.w)


class Program:
    """The node under test, running."""

    def __init__(self, domain: int, command: Sequence[str], environment: dict[str, str]) -> None:
        self._process = subprocess.Popen(
            command,
            env={**os.environ, "ROS_DOMAIN_ID": str(domain), **environment},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )

    @property
    def is_running(self) -> bool:
        return self._process.poll() is None

    def end(self, with_signal: int | None = None) -> tuple[int, str]:
        """Its exit code, and what it wrote."""
        if with_signal is not None:
            self._process.send_signal(with_signal)
        text, _ = self._process.communicate(timeout=LONGEST_WAIT)
        return self._process.returncode, text

    def kill(self) -> str:
        """What it wrote, unless end() has told it."""
        if self._process.stdout is None or self._process.stdout.closed:
            return ""
        if self.is_running:
            self._process.kill()
        return self._process.communicate()[0]


class Peer:
    def __init__(self, domain: int) -> None:
        self._domain = domain
        self._context = Context()
        rclpy.init(context=self._context, domain_id=domain)
        self.node = rclpy.create_node("peer", context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        self._diagnoses: dict[str, dict[str, str]] = {}
        self._levels: dict[str, int] = {}
        self.names: set[str] = set()
        """Of all diagnoses: nodes', and nodes' with their robots'."""
        self._programs: list[Program] = []
        self.environment: dict[str, str] = {}
        self.node.create_subscription(DiagnosticArray, "/diagnostics", self._on_diagnostics, 10)

    def close(self) -> None:
        for program in self._programs:
            program.kill()
        self._executor.shutdown()
        self.node.destroy_node()
        rclpy.shutdown(context=self._context)

    def start(self, *arguments: str, **parameters: object) -> Program:
        """The node under test, with arguments of ROS and parameters. A short `quiet`, unless told."""
        written = {"quiet": 0.5, "discovery_rate": 5.0, **parameters}
        values = [part for name, value in written.items() for part in ("-p", f"{name}:={_written(value)}")]
        command = [
            sys.executable,
            "-W",
            "ignore",
            "-m",
            "gridmerge_ros.main",
            "--ros-args",
            *values,
            *arguments,
        ]
        return self._run(command)

    def start_program(self, *arguments: str) -> Program:
        """`gridmerge node` beside the node under test."""
        program = os.environ.get("GRIDMERGE", "")
        if not program:
            pytest.skip("GRIDMERGE does not name the program: './dev test --ros' does")
        return self._run([program, "node", *arguments])

    def _run(self, command: Sequence[str]) -> Program:
        program = Program(self._domain, command, self.environment)
        self._programs.append(program)
        return program

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        for status in message.status:
            _, _, robot = status.name.partition(": ")
            name = robot or "gridmerge"
            self.names.add(status.name)
            self._levels[name] = status.level[0]
            self._diagnoses[name] = {entry.key: entry.value for entry in status.values}
            self._diagnoses[name]["message"] = status.message

    def value(self, robot: str, key: str) -> str | None:
        return self._diagnoses.get(robot, {}).get(key)

    def level(self, name: str) -> int:
        return self._levels[name]

    @property
    def robots(self) -> set[str]:
        """That the node under test knows."""
        return set(self._diagnoses) - {"gridmerge"}

    @property
    def node_names(self) -> set[str]:
        """Of nodes that have told diagnoses."""
        return {name.partition(": ")[0] for name in self.names}

    def forget_diagnoses(self) -> None:
        self._diagnoses.clear()

    def wait_until(self, holds: Callable[[], bool], what: str) -> None:
        end = time.monotonic() + LONGEST_WAIT
        while not holds():
            if time.monotonic() > end:
                written = "".join(program.kill() for program in self._programs)
                pytest.fail(f"never: {what}; the node says {self._diagnoses} and wrote:\n{written}")
            self._executor.spin_once(timeout_sec=0.1)

    def wait_for(self, robot: str, key: str, value: str) -> None:
        self.wait_until(lambda: self.value(robot, key) == value, f"{robot}: {key} is {value}")

    def spin(self, seconds: float) -> None:
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self._executor.spin_once(timeout_sec=0.1)

    def collect(self, kind: Any, topic: str, qos: Any = LATCHED) -> list[Any]:
        received: list[Any] = []
        self.node.create_subscription(kind, topic, received.append, qos)
        return received

    def publisher(self, robot: str, qos: Any = LATCHED, kind: Any = OccupancyGrid, topic: str = "map") -> Any:
        return self.node.create_publisher(kind, f"/{robot}/{topic}", qos)

    def publish_all(self, explored: gridmerge.Simulation) -> list[Any]:
        """The whole maps of tb0, tb1 and so on, which are heard in this order; the publishers."""
        publishers = []
        for robot in range(len(explored.maps)):
            publishers.append(self.publisher(f"tb{robot}"))
            publishers[-1].publish(map_message(at_step(explored, robot, -1), f"tb{robot}/map"))
            self.wait_for(f"tb{robot}", "maps", "1")
        return publishers

    def wait_until_placed(self, *robots: str) -> None:
        for robot in robots:
            self.wait_for(robot, "state", "placed")

    def call(self, kind: Any, service: str, request: Any) -> Any:
        """The answer of a service of the node under test."""
        client = self.node.create_client(kind, service)
        self.wait_until(client.service_is_ready, f"the service {service}")
        answer = client.call_async(request)
        self.wait_until(answer.done, f"an answer of {service}")
        self.node.destroy_client(client)
        return answer.result()

    def change_state(self, transition: int) -> bool:
        request = ChangeState.Request()
        request.transition.id = transition
        return bool(self.call(ChangeState, "/gridmerge/change_state", request).success)

    def ask_for_state(self, transition: int) -> None:
        """A request that may never be answered."""
        client = self.node.create_client(ChangeState, "/gridmerge/change_state")
        self.wait_until(client.service_is_ready, "the service change_state")
        request = ChangeState.Request()
        request.transition.id = transition
        client.call_async(request)
        self.spin(1.0)
        self.node.destroy_client(client)

    def state(self) -> str:
        return str(self.call(GetState, "/gridmerge/get_state", GetState.Request()).current_state.label)

    def set_parameter(self, name: str, value: float, node: str = "/gridmerge") -> Any:
        written = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=value)
        request = SetParameters.Request(parameters=[Parameter(name=name, value=written)])
        (result,) = self.call(SetParameters, f"{node}/set_parameters", request).results
        return result


def _written(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list):
        return "[" + ", ".join(f'"{one}"' for one in value) + "]"
    return str(value)


def update_message(kind: Any, frame: str, second: int, values: Sequence[int]) -> Any:
    """A row of cells at (1, 1)."""
    update = kind(x=1, y=1, width=len(values), height=1, data=array.array("b", values))
    update.header.frame_id = frame
    update.header.stamp.sec = second
    return update
