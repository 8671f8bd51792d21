"""Draws a servo's physical space and C-space with rerun: into a file, into a running viewer, or both."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("output", default_value="", description="The .rrd file to write; empty: none"),
        DeclareLaunchArgument("viewer", default_value="false", choices=["true", "false"], description="Draw in a running viewer"),
        DeclareLaunchArgument("address", default_value="127.0.0.1:9876", description="HOST:PORT of the viewer"),
        DeclareLaunchArgument("namespace", default_value="", description="Namespace of the servo, such as left"),
        Node(
            package="cspace_haptics",
            executable="haptic_inspect",
            name="haptic_inspect",
            namespace=LaunchConfiguration("namespace"),
            output="screen",
            parameters=[{
                "output": ParameterValue(LaunchConfiguration("output"), value_type=str),
                "viewer": ParameterValue(LaunchConfiguration("viewer"), value_type=bool),
                "address": ParameterValue(LaunchConfiguration("address"), value_type=str),
            }],
        ),
    ])
