# SPDX-License-Identifier: Apache-2.0
"""Topics that others use with a wrong type or a wrong name are silent in ROS: the driver warns of each node at each of them."""
import os
import shutil
import signal

import rospy
from std_msgs.msg import Int32

from support import process, testing, wrong_topics


class WrongTypes(wrong_topics.WrongTopics, testing.RosTest):
    at_once = True

    def setUp(self):
        super().setUp()
        self.PUBLISHER = self.SUBSCRIBER = rospy.get_name()  # pylint: disable=invalid-name

    def publish(self, name, kind):
        return self._until_the_end(rospy.Publisher(name, kind, queue_size=1))

    def listen(self, name, kind):
        return self._until_the_end(rospy.Subscriber(name, kind))

    def _until_the_end(self, made):
        self.addCleanup(made.unregister)
        return made

    @staticmethod
    def end(made):
        made.unregister()

    @staticmethod
    def text(kind):
        return kind._type  # pylint: disable=protected-access

    def start(self, path, remappings):
        driver = process.Driver(f"_map:={path}", *remappings)
        self.addCleanup(driver.end)
        return driver

    def test_a_node_that_hangs_does_not_keep_others_from_being_told(self):
        self.begin()
        hung = process.Process(shutil.which("rostopic"), "pub", f"/{self.name}/setpoint/write", "std_msgs/Int32", "1",
                               environment=os.environ | {"PYTHONUNBUFFERED": "1"})
        self.addCleanup(hung.end)
        self.addCleanup(hung.signal, signal.SIGCONT)
        hung.wait_for("publishing and latching")
        hung.signal(signal.SIGSTOP)
        self.publish(f"/{self.name}/setpoint/write", Int32)
        self.warned("setpoint/write", f"node {self.PUBLISHER} publishes std_msgs/Int32")


if __name__ == "__main__":
    testing.main()
