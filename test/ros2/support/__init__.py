# SPDX-License-Identifier: Apache-2.0
"""What test/ros/support and test/support have, with ROS 2 in place of ROS 1 where that is needed: modules here go before those
there."""
import pathlib

_test = pathlib.Path(__file__).resolve().parents[2]
__path__ += [str(_test / "ros" / "support"), str(_test / "support")]
