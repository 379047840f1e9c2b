# SPDX-License-Identifier: Apache-2.0
"""The program `gridmerge_node`."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.lifecycle import TransitionCallbackReturn
from rclpy.utilities import remove_ros_args

from gridmerge_ros.node import GridmergeNode
from gridmerge_ros.parameters import PARAMETERS

RCLError = rclpy_implementation.RCLError

_DESCRIPTION = """\
Hears the occupancy grids of robots on <namespace>/map, merges them while they grow, and publishes the merged map, the
transform of each robot's map frame, and /diagnostics."""

_EXAMPLE = """
example:
  ros2 run gridmerge_ros gridmerge_node --ros-args -p robot_namespace:=tb -p transforms:=dynamic
"""


def main(args: Sequence[str] | None = None) -> int:
    """Runs the node until Ctrl-C. 0 at the end, 1 where it cannot start, 2 for wrong usage."""
    arguments = list(sys.argv if args is None else args)
    try:
        _read_usage(remove_ros_args(arguments)[1:])
        rclpy.init(args=arguments)
        node = GridmergeNode()
    except Exception as error:  # of many kinds: what ROS makes of its own arguments
        print(f"gridmerge_node: {error}", file=sys.stderr)
        rclpy.try_shutdown()
        return 1
    try:
        return _run(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        return 0
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


def _run(node: GridmergeNode) -> int:
    try:
        starts_itself = node.starts_itself
    except ValueError as error:
        node.get_logger().error(str(error))
        return 1
    if starts_itself and not (_succeeds(node.trigger_configure()) and _succeeds(node.trigger_activate())):
        return 1
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    while rclpy.ok():
        try:
            executor.spin()
        except RCLError as error:
            # rclpy raises this for what others ask for, such as a transition that the state does not have.
            if not rclpy.ok():
                break
            node.get_logger().warning(f"a request is refused: {error}")
    return 0


def _succeeds(result: TransitionCallbackReturn) -> bool:
    return bool(result == TransitionCallbackReturn.SUCCESS)


def _read_usage(arguments: Sequence[str]) -> None:
    lines = "\n".join(f"  {one.name:<24} {_written(one.default):<11} {one.text}" for one in PARAMETERS)
    parser = argparse.ArgumentParser(
        prog="gridmerge_node",
        description=_DESCRIPTION,
        usage="gridmerge_node [--ros-args [-p PARAMETER:=VALUE] [--params-file FILE] [-r FROM:=TO] ...]",
        epilog=f"parameters, with their defaults:\n{lines}\n{_EXAMPLE}",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.parse_args(arguments)


def _written(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return "[]" if value == () else repr(value) if isinstance(value, str) else str(value)


if __name__ == "__main__":
    sys.exit(main())
