# SPDX-License-Identifier: Apache-2.0
"""The node alone, for robots that run already."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description() -> LaunchDescription:
    share = Path(get_package_share_directory("gridmerge_ros"))
    use_sim_time = ParameterValue(LaunchConfiguration("use_sim_time"), value_type=bool)
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "params_file",
                default_value=str(share / "config" / "gridmerge.yaml"),
                description="Parameters of gridmerge_node",
            ),
            DeclareLaunchArgument(
                "use_sim_time", default_value="false", description="Take the time of /clock"
            ),
            DeclareLaunchArgument("rviz", default_value="false", description="Show the merged map"),
            Node(
                package="gridmerge_ros",
                executable="gridmerge_node",
                name="gridmerge",
                parameters=[LaunchConfiguration("params_file"), {"use_sim_time": use_sim_time}],
                output="screen",
            ),
            Node(
                package="rviz2",
                executable="rviz2",
                arguments=["-d", str(share / "rviz" / "gridmerge.rviz")],
                parameters=[{"use_sim_time": use_sim_time}],
                condition=IfCondition(LaunchConfiguration("rviz")),
            ),
        ]
    )
