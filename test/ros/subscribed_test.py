# SPDX-License-Identifier: Apache-2.0
"""With poll: subscribed the device is asked only for what somebody listens to."""
import time

from coupler_driver.msg import PointStatus
from coupler_driver.srv import Read
from std_msgs.msg import Int16

from support import process, testing
from support.device import Device
from support.latest import LatestStatus
from support.patience import NO_TIMEOUT, QUIET
from support.topics import wait_until

MAP = """
name: {name}
address: 127.0.0.1
rate: 20
timeout: {timeout}s
mapping:
  input_registers:
    a: {address: 0, type: INT}
    b: {address: 1, type: INT}
    far: {address: 100, type: INT}
"""


class SubscribedTest(testing.RosTest):
    at_once = True
    timeout = NO_TIMEOUT  # of silence, after which an idle device is asked whether it is still there

    def map(self, head=""):
        return process.write_map(head + MAP.replace("{timeout}", str(self.timeout)).replace("{name}", self.name))


class Subscribed(SubscribedTest):
    def setUp(self):
        self.device = Device().start()
        self.addCleanup(self.device.stop)
        self.device.tables["input_registers"][:2] = [11, 22]
        self.device.tables["input_registers"][100] = 33
        self.driver(f"_map:={self.map()}", f"_port:={self.device.port}",
                    "_poll:=subscribed").wait_for("connected")

    def asked(self, begin=0):
        """The addresses that are asked for since the request of that number."""
        return {address for request in self.device.requests[begin:]
                for address in range(request.address, request.address + request.count)}

    def asks_only_for(self, addresses):
        """In the next ten requests."""
        begin = len(self.device.requests)
        wait_until(lambda: len(self.device.requests) >= begin + 10, "ten requests")
        return self.asked(begin) == addresses

    def falls_silent(self):
        begin = len(self.device.requests)
        time.sleep(QUIET)
        return len(self.device.requests) == begin

    def test_without_a_subscriber_there_is_no_request_not_even_at_the_start(self):
        time.sleep(QUIET)
        self.assertEqual(self.asked(), set())

    def test_what_is_subscribed_is_read_and_nothing_else(self):
        far = self.topic(f"/{self.name}/far", Int16)
        self.assertEqual(far.next(), 33)
        self.assertTrue(self.asks_only_for({100}))
        self.assertEqual(self.asked(), {100})
        self.assertEqual(self.topic(f"/{self.name}/a", Int16).next(), 11)
        self.assertTrue(self.asks_only_for({0, 100}))
        self.assertEqual(self.asked(), {0, 100})
        far.close()
        wait_until(lambda: self.asks_only_for({0}), "the last one to leave to be noticed")

    def test_a_read_asks_for_its_point_once(self):
        self.assertEqual(self.service(f"/{self.name}/read", Read)("b").value, "22")
        wait_until(self.falls_silent, "it to ask for no more")
        self.assertEqual(self.asked(), {1})


class SaidByTheMap(SubscribedTest):
    timeout = 1  # a value is good for one after the last reading

    def drive(self, *arguments):
        device = Device().start()
        self.addCleanup(device.stop)
        self.driver(f"_map:={self.map('poll: subscribed')}", f"_port:={device.port}",
                    *arguments).wait_for("connected")
        status = LatestStatus(self.name)
        self.addCleanup(status.close)
        return status

    def test_status_says_which_points_nobody_wants(self):
        status = self.drive()
        status.quality("far", PointStatus.NOT_WANTED)
        far = self.topic(f"/{self.name}/far", Int16)
        status.quality("far", PointStatus.GOOD)
        far.close()
        status.quality("far", PointStatus.NOT_WANTED)

    def test_the_argument_wins(self):
        self.drive("_poll:=all").quality("far", PointStatus.GOOD)


if __name__ == "__main__":
    testing.main()
