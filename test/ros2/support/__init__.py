# SPDX-License-Identifier: Apache-2.0
"""What test/ros/support has, with ROS 2 in place of ROS 1 where that is needed: modules here go before those there."""
import pathlib

__path__.append(str(pathlib.Path(__file__).resolve().parents[2] / "ros" / "support"))
