"""Device on one side, servo and a following robot on the other. Launch it twice, with the namespaces left and right, for
two hands; `side:=device` or `side:=robot` launches one side alone, for two computers."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, PythonExpression
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    share = FindPackageShare("cspace_haptics")
    namespace = LaunchConfiguration("namespace")
    device_side = IfCondition(PythonExpression(["'", LaunchConfiguration("side"), "' != 'robot'"]))
    robot_side = IfCondition(PythonExpression(["'", LaunchConfiguration("side"), "' != 'device'"]))
    return LaunchDescription([
        DeclareLaunchArgument("namespace", default_value="", choices=["", "left", "right"],
                              description="Which hand; empty when there is one"),
        DeclareLaunchArgument("side", default_value="both", choices=["both", "device", "robot"], description="What to start here"),
        DeclareLaunchArgument("device", default_value="simulated", choices=["simulated", "replay", "spacemouse"],
                              description="The device in the hand"),
        DeclareLaunchArgument("scene", default_value="peg_in_hole", description="A scene.yaml, or the name of an installed scene"),
        DeclareLaunchArgument("law", default_value="proxy", choices=["paper", "pstar", "blended", "proxy"], description="Force law"),
        DeclareLaunchArgument("enabled", default_value="false", choices=["true", "false"],
                              description="Whether force is on from the start, without calls of ~/enable of device and servo"),
        DeclareLaunchArgument("params_file", default_value=PathJoinSubstitution([share, "config", "haptic_servo.param.yaml"]),
                              description="Parameters of the servo; the arguments above come on top of them"),
        DeclareLaunchArgument("device_params_file", default_value=PathJoinSubstitution([share, "config", "haptic_device.param.yaml"]),
                              description="Parameters of the device; the arguments above come on top of them"),
        DeclareLaunchArgument("robot_params_file", default_value=PathJoinSubstitution([share, "config", "haptic_follower.param.yaml"]),
                              description="Parameters of the following robot: limits, network, wall"),
        Node(
            package="cspace_haptics",
            executable="haptic_device",
            name="haptic_device",
            namespace=namespace,
            output="screen",
            condition=device_side,
            parameters=[
                LaunchConfiguration("device_params_file"),
                {
                    "scene": ParameterValue(LaunchConfiguration("scene"), value_type=str),
                    "device.driver": ParameterValue(LaunchConfiguration("device"), value_type=str),
                    "enabled": ParameterValue(LaunchConfiguration("enabled"), value_type=bool),
                },
            ],
        ),
        Node(
            package="cspace_haptics",
            executable="haptic_servo",
            name="haptic_servo",
            namespace=namespace,
            output="screen",
            condition=robot_side,
            parameters=[
                LaunchConfiguration("params_file"),
                {
                    "scene": ParameterValue(LaunchConfiguration("scene"), value_type=str),
                    "device.driver": "topic",
                    "law": ParameterValue(LaunchConfiguration("law"), value_type=str),
                    "enabled": ParameterValue(LaunchConfiguration("enabled"), value_type=bool),
                },
            ],
        ),
        Node(
            package="cspace_haptics",
            executable="haptic_follower",
            name="haptic_follower",
            namespace=namespace,
            output="screen",
            condition=robot_side,
            parameters=[LaunchConfiguration("robot_params_file")],
            # What the robot measures is felt by the hand.
            remappings=[("~/wrench", "haptic_servo/remote_wrench")],
        ),
    ])
