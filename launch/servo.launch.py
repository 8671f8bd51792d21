"""The servo with its device in the same process: the shortest loop between hand and force.

`device:=topic` takes a vendor's driver instead, for example one that speaks CRTK (Force Dimension, Touch):
`device:=topic pose_topic:=/arm/measured_cp twist_topic:=/arm/measured_cv wrench_topic:=/arm/servo_cf`."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    share = FindPackageShare("cspace_haptics")
    return LaunchDescription([
        DeclareLaunchArgument("namespace", default_value="", description="Namespace of the node, such as left"),
        DeclareLaunchArgument("scene", default_value="peg_in_hole", description="A scene.yaml, or the name of an installed scene"),
        DeclareLaunchArgument("device", default_value="simulated", choices=["simulated", "replay", "spacemouse", "topic"],
                              description="Where the hand's pose comes from"),
        DeclareLaunchArgument("law", default_value="proxy", choices=["paper", "pstar", "blended", "proxy"], description="Force law"),
        DeclareLaunchArgument("enabled", default_value="false", choices=["true", "false"],
                              description="Whether force is on from the start, without a call of ~/enable"),
        DeclareLaunchArgument("params_file", default_value=PathJoinSubstitution([share, "config", "haptic_servo.param.yaml"]),
                              description="Parameters of the servo; the arguments above come on top of them"),
        DeclareLaunchArgument("pose_topic", default_value="haptic_device/pose",
                              description="Device topic: where the driver publishes its PoseStamped"),
        DeclareLaunchArgument("twist_topic", default_value="haptic_device/twist",
                              description="Device topic: where the driver publishes its TwistStamped, if it does"),
        DeclareLaunchArgument("joy_topic", default_value="haptic_device/joy",
                              description="Device topic: where the driver publishes its buttons as Joy, if it does"),
        DeclareLaunchArgument("wrench_topic", default_value="haptic_device/command/wrench",
                              description="Device topic: where the driver takes its WrenchStamped"),
        Node(
            package="cspace_haptics",
            executable="haptic_servo",
            name="haptic_servo",
            namespace=LaunchConfiguration("namespace"),
            output="screen",
            parameters=[
                LaunchConfiguration("params_file"),
                {
                    "scene": ParameterValue(LaunchConfiguration("scene"), value_type=str),
                    "device.driver": ParameterValue(LaunchConfiguration("device"), value_type=str),
                    "law": ParameterValue(LaunchConfiguration("law"), value_type=str),
                    "enabled": ParameterValue(LaunchConfiguration("enabled"), value_type=bool),
                },
            ],
            remappings=[
                ("haptic_device/pose", LaunchConfiguration("pose_topic")),
                ("haptic_device/twist", LaunchConfiguration("twist_topic")),
                ("haptic_device/joy", LaunchConfiguration("joy_topic")),
                ("haptic_device/command/wrench", LaunchConfiguration("wrench_topic")),
            ],
        ),
    ])
