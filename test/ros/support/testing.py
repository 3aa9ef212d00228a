# SPDX-License-Identifier: Apache-2.0
import sys
import unittest

import rospy

from support.process import Driver
from support.topics import Topic, connected_publishers, service


class RosTest(unittest.TestCase):
    """What a test starts, listens to or publishes ends with it: a publisher that stayed would count a driver that is
    gone as its subscriber."""

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

    def publisher(self, name, kind):
        return self.publishers({name: kind})[0]

    def publishers(self, kinds):
        publishers = connected_publishers(kinds)
        for publisher in publishers:
            self.addCleanup(publisher.unregister)
        return publishers

    @staticmethod
    def service(name, kind, **options):
        return service(name, kind, **options)

    def driver(self, *arguments):
        driver = Driver(*arguments)
        self.addCleanup(driver.end)
        return driver


def main():
    """Runs the tests of the calling file as a ROS node. Exit code 77: all of them were skipped."""
    rospy.init_node("test", anonymous=True, disable_signals=True)
    result = unittest.main(exit=False, verbosity=2, warnings="ignore").result
    if not result.wasSuccessful():
        sys.exit(1)
    if result.testsRun and len(result.skipped) == result.testsRun:
        print(f"skipped: {result.skipped[0][1]}")
        sys.exit(77)
