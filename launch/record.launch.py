"""Records a servo's topics into a rosbag2 MCAP folder that survives a kill."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("output", description="Folder of the bag; must not exist yet"),
        DeclareLaunchArgument("namespace", default_value="", description="Namespace of the servo, such as left"),
        DeclareLaunchArgument("compression", default_value="zstd", choices=["zstd", "none"], description="Compression of chunks"),
        DeclareLaunchArgument("split_duration", default_value="600.0", description="A new file after so many seconds; 0.0: never"),
        DeclareLaunchArgument("all", default_value="false", choices=["true", "false"], description="Record every topic there is"),
        Node(
            package="cspace_haptics",
            executable="haptic_recorder",
            name="haptic_recorder",
            namespace=LaunchConfiguration("namespace"),
            output="screen",
            parameters=[{
                "output": ParameterValue(LaunchConfiguration("output"), value_type=str),
                "compression": ParameterValue(LaunchConfiguration("compression"), value_type=str),
                "split_duration": ParameterValue(LaunchConfiguration("split_duration"), value_type=float),
                "all": ParameterValue(LaunchConfiguration("all"), value_type=bool),
            }],
        ),
    ])
