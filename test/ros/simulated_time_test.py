# SPDX-License-Identifier: Apache-2.0
"""Under `use_sim_time` what the driver says of itself follows /clock; values come all the same, and their stamps stay in wall
time, as do the times at which something is to be written. test/ros2/diagnostics_test.py has the same for ROS 2."""
import threading
import time

import rospy
from coupler_driver.msg import Status, UInt64Stamped
from coupler_driver.srv import Schedule
from diagnostic_msgs.msg import DiagnosticArray
from rosgraph_msgs.msg import Clock

from support import process, testing
from support.device import Device
from support.patience import NO_TIMEOUT
from support.times import ROUNDING, ros_duration, ros_time, seconds

MAP = f"""
name: plant
address: 127.0.0.1
rate: 20
timeout: {NO_TIMEOUT}s
mapping:
  holding_registers: {{level: {{address: 4, type: UINT, stamped: true}}}}
"""
LATER = 3000  # seconds


class SimulatedTime(testing.RosTest):
    def setUp(self):
        rospy.set_param("/use_sim_time", True)
        self.addCleanup(rospy.delete_param, "/use_sim_time")
        self.device = Device().start()
        self.addCleanup(self.device.stop)
        self.driver(f"_map:={process.write_map(MAP)}", f"_port:={self.device.port}").wait_for("connected")
        self.level = self.topic("/plant/level/stamped", UInt64Stamped)

    def follow(self, second):
        """/clock stands still at it, and is followed."""
        clock = self.publisher("/clock", Clock)
        ended = threading.Event()

        def publish():
            while not ended.wait(0.02):
                clock.publish(Clock(rospy.Time(second)))

        publishing = threading.Thread(target=publish)
        publishing.start()
        for what in (publishing.join, ended.set):
            self.addCleanup(what)
        for topic, kind in (("/plant/status", Status), ("/diagnostics", DiagnosticArray)):
            self.topic(topic, kind).wait_for(lambda message: message.header.stamp == rospy.Time(second))

    def is_in_wall_time(self, value):
        """A value that the device has from now on."""
        before = time.time()
        self.device.tables["holding_registers"][4] = value
        message = self.level.wait_for(lambda one: one.value == value)
        stamp = seconds(message.header.stamp)
        self.assertGreaterEqual(stamp, before - message.uncertainty - ROUNDING)
        self.assertLessEqual(stamp, time.time() + ROUNDING)

    def is_taken_in_wall_time(self):
        answer = self.service("/plant/schedule", Schedule)("level", "9", ros_time(time.time() + LATER), ros_duration(0))
        self.assertTrue(answer.success, answer.message)

    def test_stamps_and_times_to_write_are_wall_time_before_and_after_the_clock_begins(self):
        self.is_in_wall_time(7)
        self.is_taken_in_wall_time()
        self.follow(5000)
        self.is_in_wall_time(8)
        self.is_taken_in_wall_time()


if __name__ == "__main__":
    testing.main()
