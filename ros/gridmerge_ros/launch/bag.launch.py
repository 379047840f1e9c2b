# SPDX-License-Identifier: Apache-2.0
"""A saved bag with the maps of robots, and the node: ros2 launch gridmerge_ros bag.launch.py bag:=FOLDER"""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration


def generate_launch_description() -> LaunchDescription:
    share = Path(get_package_share_directory("gridmerge_ros"))
    # The bag's publishers are there some seconds before they send, so that nothing is sent to nobody.
    play = ["ros2", "bag", "play", LaunchConfiguration("bag"), "--clock", "--delay", "5"]
    play += ["--rate", LaunchConfiguration("rate")]
    return LaunchDescription(
        [
            DeclareLaunchArgument("bag", description="Folder or file that `ros2 bag play` takes"),
            DeclareLaunchArgument(
                "rate", default_value="1.0", description="How many times faster it is played"
            ),
            DeclareLaunchArgument(
                "params_file",
                default_value=str(share / "config" / "gridmerge.yaml"),
                description="Parameters of gridmerge_node",
            ),
            DeclareLaunchArgument("rviz", default_value="false", description="Show the merged map"),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(str(share / "launch" / "gridmerge.launch.py")),
                launch_arguments={
                    "params_file": LaunchConfiguration("params_file"),
                    "use_sim_time": "true",
                    "rviz": LaunchConfiguration("rviz"),
                }.items(),
            ),
            ExecuteProcess(cmd=play, output="screen"),
        ]
    )
