# SPDX-License-Identifier: Apache-2.0
"""The driver with a map, and the example application (docs/application.md), for ROS 2. sorter.launch.xml is the same in XML.
Untried: read against the sources of launch and launch_ros, which nothing here can run.
    ros2 launch coupler_driver sorter.launch.py
    ros2 launch coupler_driver sorter.launch.py map:=/path/to/press.yaml device:=press input:=part_present output:=ejector
"""
import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

MAP = os.path.join(get_package_share_directory("coupler_driver"), "config", "sorter.yaml")
ARGUMENTS = (
    ("map", MAP, "the device's map"),
    ("address", "", "host name or IP address, instead of the map's"),
    ("port", "", "TCP port, instead of the map's"),
    ("device", "sorter", "namespace of the device's topics, instead of the map's name"),
    ("input", "part_seen", "the point whose rising edges count; stamped in the map"),
    ("output", "ejector", "the point that is switched on"),
    ("delay", "0.15", "seconds from the edge until the output is switched on"),
    ("duration", "0.05", "seconds for which it stays on"),
    ("second_write", "false", "true: the device cannot end the duration by itself, a second write does"),
    ("namespace", "", "of both nodes, within that of the file that includes this one"),
)


def argument(name, kind=str):
    """As a parameter of this type: without one, launch would take the text 1502 for a number."""
    return ParameterValue(LaunchConfiguration(name), value_type=kind)


def generate_launch_description():
    common = {"package": "coupler_driver", "namespace": LaunchConfiguration("namespace"), "output": "screen",
              "respawn": True, "respawn_delay": 2.0}
    return LaunchDescription([
        *(DeclareLaunchArgument(name, default_value=default, description=text) for name, default, text in ARGUMENTS),
        Node(executable="coupler_driver", **common, parameters=[{
            "map": argument("map"), "name": argument("device"), "address": argument("address"), "port": argument("port")}]),
        Node(executable="eject", name="eject", **common, parameters=[{
            "device": argument("device"), "input": argument("input"), "output": argument("output"),
            "delay": argument("delay", float), "duration": argument("duration", float),
            "second_write": argument("second_write", bool)}]),
    ])
