# SPDX-License-Identifier: Apache-2.0
"""With poll: subscribed the device is asked only for what somebody listens to."""
import time

import rospy
from coupler_driver.msg import PointStatus
from coupler_driver.srv import Read
from std_msgs.msg import Int16

from support import process, testing
from support.device import Device
from support.latest import LatestStatus
from support.topics import wait_until

MAP = """
name: quiet
address: 127.0.0.1
rate: 20
timeout: 5
mapping:
  input_registers:
    a: {address: 0, type: INT}
    b: {address: 1, type: INT}
    far: {address: 100, type: INT}
"""


class Subscribed(testing.RosTest):
    def setUp(self):
        self.device = Device().start()
        self.addCleanup(self.device.stop)
        self.device.tables["input_registers"][:2] = [11, 22]
        self.device.tables["input_registers"][100] = 33
        self.driver(f"_map:={process.write_map(MAP)}", f"_port:={self.device.port}",
                    "_poll:=subscribed").wait_for("connected")

    def asked(self, seconds=0.5):
        """The addresses that are asked for."""
        time.sleep(0.5)
        begin = len(self.device.requests)
        time.sleep(seconds)
        return {address for request in self.device.requests[begin:]
                for address in range(request.address, request.address + request.count)}

    def test_without_a_subscriber_there_is_no_request(self):
        self.assertEqual(self.asked(1), set())

    def test_not_even_at_the_start(self):
        time.sleep(0.5)
        points = {0, 1, 100}
        self.assertEqual([r for r in self.device.requests if points & set(range(r.address, r.address + r.count))], [])

    def test_what_is_subscribed_is_read_and_nothing_else(self):
        far = self.topic("/quiet/far", Int16)
        self.assertEqual(far.next(), 33)
        self.assertEqual(self.asked(), {100})
        self.assertEqual(self.topic("/quiet/a", Int16).next(), 11)
        self.assertEqual(self.asked(), {0, 100})
        far.close()
        wait_until(lambda: self.asked() == {0}, "the last one to leave to be noticed")

    def test_status_says_which_points_nobody_wants(self):
        status = LatestStatus("quiet")
        self.addCleanup(status.close)
        status.quality("far", PointStatus.NOT_WANTED)
        far = self.topic("/quiet/far", Int16)
        status.quality("far", PointStatus.GOOD)
        far.close()
        status.quality("far", PointStatus.NOT_WANTED)

    def test_a_read_asks_for_its_point_once(self):
        rospy.wait_for_service("/quiet/read", 20)
        self.assertEqual(rospy.ServiceProxy("/quiet/read", Read)("b").value, "22")
        self.assertEqual(self.asked(), set())


class SaidByTheMap(testing.RosTest):
    def drive(self, *arguments):
        device = Device().start()
        self.addCleanup(device.stop)
        self.driver(f"_map:={process.write_map('poll: subscribed' + MAP)}", f"_port:={device.port}",
                    *arguments).wait_for("connected")
        status = LatestStatus("quiet")
        self.addCleanup(status.close)
        return status

    def test_only_what_is_subscribed_is_read(self):
        self.drive().quality("far", PointStatus.NOT_WANTED)

    def test_the_argument_wins(self):
        self.drive("_poll:=all").quality("far", PointStatus.GOOD)


if __name__ == "__main__":
    testing.main()
