# SPDX-License-Identifier: Apache-2.0
import rospy

from support import case
from support.topics import Topic


class RosTest(case.Case):
    def run(self, result=None):
        """On a parameter server as a new roscore has it: a launch file's parameters outlive its nodes."""
        for name in rospy.get_param_names():
            if name not in ("/rosdistro", "/rosversion", "/run_id") and not name.startswith("/roslaunch/"):
                rospy.delete_param(name)
        return super().run(result)

    def topic(self, name, kind, latched=False):  # pylint: disable=unused-argument
        """ROS 2 must be told that the last value is wanted; in ROS 1 it comes with the topic."""
        topic = Topic(name, kind)
        self.addCleanup(topic.close)
        return topic


def main():
    """Runs the tests of the calling file as a ROS node."""
    rospy.init_node("test", anonymous=True, disable_signals=True)
    case.run()
