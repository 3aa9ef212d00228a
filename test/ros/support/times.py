# SPDX-License-Identifier: Apache-2.0
"""Times and durations of messages, which have other names in ROS 1 and in ROS 2."""
import os

ROUNDING = 1e-6  # of a time as a double


def seconds(stamp):
    return stamp.secs + stamp.nsecs / 1e9 if hasattr(stamp, "secs") else stamp.sec + stamp.nanosec / 1e9


def _parts(value):
    return int(value), int(value % 1 * 1e9)


# Of a request's types, which ROS 1 has without a message.
# pylint: disable=import-outside-toplevel,import-error
if os.environ.get("ROS_VERSION") == "2":
    from builtin_interfaces.msg import Duration, Time

    def ros_time(at):
        second, rest = _parts(at)
        return Time(sec=second, nanosec=rest)

    def ros_duration(length):
        second, rest = _parts(length)
        return Duration(sec=second, nanosec=rest)
else:
    import rospy

    def ros_time(at):
        return rospy.Time(*_parts(at))

    def ros_duration(length):
        return rospy.Duration(*_parts(length))
