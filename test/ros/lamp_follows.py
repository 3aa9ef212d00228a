#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What simulated.test runs: an output is written by its topic, and the input that is wired to it follows."""
import sys
import threading
import unittest

import rospy
import rostest
from std_msgs.msg import Bool

from support.patience import PATIENCE


class LampFollows(unittest.TestCase):
    def test_the_feedback_follows_the_lamp(self):
        changed = threading.Condition()
        seen = []

        def receive(message):
            with changed:
                seen.append(message.data)
                changed.notify_all()

        rospy.Subscriber("feedback", Bool, receive)
        lamp = rospy.Publisher(rospy.resolve_name("lamp") + "/write", Bool, queue_size=1, latch=True)
        for wanted in (False, True):
            with changed:
                seen.clear()
                lamp.publish(wanted)
                self.assertTrue(changed.wait_for(lambda w=wanted: w in seen, PATIENCE), f"the feedback did not become {wanted}")


if __name__ == "__main__":
    rospy.init_node("lamp_follows")
    rostest.rosrun("coupler_driver", "lamp_follows", LampFollows, sys.argv)
