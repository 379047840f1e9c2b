# SPDX-License-Identifier: Apache-2.0
"""slam_toolbox for two robots, tb1 and tb2, and the node that merges their maps.

Each robot publishes /<robot>/scan, and <robot>/odom -> <robot>/base_link on /tf, as a robot of several does.
"""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchContext, LaunchDescription
from launch.actions import (
    DeclareLaunchArgument,
    EmitEvent,
    IncludeLaunchDescription,
    OpaqueFunction,
    RegisterEventHandler,
)
from launch.events import matches_action
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import LifecycleNode
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState
from launch_ros.parameter_descriptions import ParameterValue
from lifecycle_msgs.msg import Transition


def mapping_of(robot: str, share: Path) -> list:
    """slam_toolbox in the robot's namespace, configured and activated: it is a lifecycle node since Jazzy."""
    frames = {
        "map_frame": f"{robot}/map",
        "odom_frame": f"{robot}/odom",
        "base_frame": f"{robot}/base_link",
        "use_sim_time": ParameterValue(LaunchConfiguration("use_sim_time"), value_type=bool),
    }
    node = LifecycleNode(
        package="slam_toolbox",
        executable="async_slam_toolbox_node",
        name="slam_toolbox",
        namespace=robot,
        parameters=[str(share / "config" / "slam_toolbox.yaml"), frames],
        # Whatever it calls absolutely is the robot's own, except for /tf, which all share.
        remappings=[("/map", "map"), ("/map_metadata", "map_metadata"), ("/scan", "scan")],
        output="screen",
    )
    is_node = matches_action(node)
    activate = EmitEvent(
        event=ChangeState(lifecycle_node_matcher=is_node, transition_id=Transition.TRANSITION_ACTIVATE)
    )
    configure = EmitEvent(
        event=ChangeState(lifecycle_node_matcher=is_node, transition_id=Transition.TRANSITION_CONFIGURE)
    )
    is_configured = OnStateTransition(
        target_lifecycle_node=node, start_state="configuring", goal_state="inactive", entities=[activate]
    )
    return [node, RegisterEventHandler(is_configured), configure]


def mapping(context: LaunchContext) -> list:
    share = Path(get_package_share_directory("gridmerge_ros"))
    robots = LaunchConfiguration("robots").perform(context).split(",")
    return [action for robot in robots for action in mapping_of(robot.strip(), share)]


def generate_launch_description() -> LaunchDescription:
    share = Path(get_package_share_directory("gridmerge_ros"))
    return LaunchDescription(
        [
            DeclareLaunchArgument("robots", default_value="tb1,tb2", description="Their namespaces"),
            DeclareLaunchArgument(
                "use_sim_time", default_value="false", description="Take the time of /clock"
            ),
            DeclareLaunchArgument("rviz", default_value="false", description="Show the merged map"),
            OpaqueFunction(function=mapping),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(str(share / "launch" / "gridmerge.launch.py")),
                launch_arguments={
                    "use_sim_time": LaunchConfiguration("use_sim_time"),
                    "rviz": LaunchConfiguration("rviz"),
                }.items(),
            ),
        ]
    )
