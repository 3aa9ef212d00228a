# SPDX-License-Identifier: Apache-2.0
"""More is written than a slow device can take: reads go on, the newest value counts, order stays where it matters, and
safe values go before all that waits."""
import threading
import time

import rospy
from coupler_driver.srv import Write
from std_msgs.msg import Bool, Int16, UInt16
from std_srvs.srv import SetBool, Trigger

from support import in_order, process, testing
from support.device import FAILURE, Device, Refuse
from support.patience import NO_TIMEOUT, PATIENCE
from support.topics import wait_until

MAP = """
name: {name}
address: 127.0.0.1
rate: 20
timeout: {timeout}s
mapping:
  coils: {{start: 1, brake: {{address: 2, safe: on}}, kept: {{address: 3, safe: hold}}}}
  holding_registers:
    level: {{address: 0, type: INT}}
    speed: {{address: 10, type: UINT}}
    torque: {{address: 20, type: UINT, safe: 5}}
"""


class SlowDevice(Device):
    """Takes its time for each request, and one can be held back."""

    def __init__(self, seconds=0.01):
        super().__init__()
        self.answer = self._slowly
        self._seconds = seconds
        self._may_go_on = threading.Event()
        self._may_go_on.set()
        self.holds = threading.Event()

    def _slowly(self, request):
        time.sleep(self._seconds)
        if not self._may_go_on.is_set():
            self.holds.set()
            self._may_go_on.wait(PATIENCE)
        return self.serve(request)

    def hold(self):
        """Until go_on() there is one request in flight."""
        self.holds.clear()
        self._may_go_on.clear()
        if not self.holds.wait(PATIENCE):
            raise AssertionError("no request came")

    def go_on(self):
        self._may_go_on.set()

    def written(self):
        """(address, value) of each write, in order; a request for several is several."""
        for request in self.seen(5, 6, 15, 16):
            if request.function in (5, 6):
                value = int.from_bytes(request.data[3:5], "big")
                yield request.address, value // 0xFF00 if request.function == 5 else value
            for i in range(request.count if request.function == 16 else 0):
                yield request.address + i, int.from_bytes(request.data[6 + 2 * i:8 + 2 * i], "big")
            for i in range(request.count if request.function == 15 else 0):
                yield request.address + i, request.data[6 + i // 8] >> i % 8 & 1


class LoadTest(testing.RosTest):
    at_once = True

    def setUp(self):
        self.device = SlowDevice().start()
        self.addCleanup(self.device.stop)
        self.addCleanup(self.device.go_on)
        self.program = self.driver(f"_map:={process.write_map(MAP.format(name=self.name, timeout=NO_TIMEOUT))}", f"_port:={self.device.port}")
        self.program.wait_for("connected")

    def senders(self, *names):
        return in_order.senders(self, {f"/{self.name}/{name}/write": {"start": Bool}.get(name, UInt16) for name in names})

    def call(self, name, kind, *arguments):
        rospy.wait_for_service(f"/{self.name}/{name}", PATIENCE)
        return rospy.ServiceProxy(f"/{self.name}/{name}", kind)(*arguments)


class Flood(LoadTest):
    @staticmethod
    def flood(topics, until):
        """Publishes rising values on each of them, 200 times a second, until that is true; returns the last one."""
        value = 0

        def publish():
            nonlocal value
            value += 1
            for topic in topics:
                topic.publish(value)
            return until()

        wait_until(publish, "the flood to have done its work")
        return value

    def takes(self, writes):
        """Until the device has taken so many more, with its reads between them."""
        before = len(self.device.seen(6, 16))
        return lambda: len(self.device.seen(6, 16)) >= before + writes

    def test_reads_go_on_while_ros_writes_faster_than_the_device(self):
        level, speed = self.topic(f"/{self.name}/level", Int16), self.topic(f"/{self.name}/speed", UInt16)
        speed.next()
        level.values.clear()
        speed.values.clear()
        has_taken_many = self.takes(100)
        last = self.flood([self.publisher(f"/{self.name}/speed/write", UInt16)],
                          until=lambda: has_taken_many() and len(level.values) > 5 and len(set(speed.values)) > 5)
        self.assertGreater(len(level.values), 5)
        self.assertGreater(len(set(speed.values)), 5, "the one that is written is shown, too")
        speed.wait_for(lambda value: value == last)

    def test_the_newest_value_of_each_topic_is_on_the_wire_after_one_request_for_each(self):
        topics = self.senders("speed", "torque")
        last = self.flood(topics, self.takes(100)) + 1
        self.device.hold()
        for topic in topics:
            in_order.publish(topic, last)
        self.device.go_on()
        for address in (10, 20):
            wait_until(lambda a=address: self.device.tables["holding_registers"][a] == last, "the last value")
        values = list(self.device.written())
        self.assertEqual({values[-1][0], values[-2][0]}, {10, 20}, values[-6:])
        self.assertNotIn("too many writes", self.program.output)

    def test_a_service_is_answered_after_what_waits_and_that_is_little(self):
        topics = self.publishers({f"/{self.name}/speed/write": UInt16, f"/{self.name}/torque/write": UInt16})
        is_answered = threading.Event()
        flood = threading.Thread(target=self.flood, args=(topics, is_answered.is_set))
        self.addCleanup(is_answered.set)
        is_in_full_spate = self.takes(50)
        flood.start()
        wait_until(is_in_full_spate, "the flood to be in full spate")
        before = len(self.device.requests)
        self.assertTrue(self.call("start/set", SetBool, True).success)
        is_answered.set()
        during = self.device.requests[before:]
        at = next(i for i, request in enumerate(during) if request.function == 5)
        flood.join()
        writes = [request for request in during[:at] if request.function in (6, 16)]
        # What is in flight, and two that wait; the call itself takes a while to reach the driver.
        self.assertLess(len(writes), 100)


class Order(LoadTest):
    def test_only_the_order_among_numbers_is_given_up(self):
        speed, torque, start = self.senders("speed", "torque", "start")
        self.device.hold()
        for topic, value in ((speed, 1), (torque, 1), (speed, 2),  # speed keeps its place, before torque
                             (start, True), (torque, 2),           # torque has come after start: it goes behind it
                             (start, True), (start, False), (speed, 3)):
            in_order.publish(topic, value)
        self.device.go_on()
        wait_until(lambda: self.device.tables["holding_registers"][10] == 3, "the last one")
        self.assertEqual(list(self.device.written()), [(1, 1), (20, 2), (1, 0), (10, 3)])


class Safe(LoadTest):
    def ask(self):
        """The answer, once it is there; the driver has the call when this returns."""
        answer = []
        rospy.wait_for_service(f"/{self.name}/safe", PATIENCE)
        calling = threading.Thread(target=lambda: answer.append(self.call("safe", Trigger)))
        calling.start()
        self.program.wait_for(f"{self.name}: safe values were requested")
        return calling, answer

    def test_safe_values_go_after_the_request_in_flight_and_before_what_waits(self):
        speed, torque, start = self.senders("speed", "torque", "start")
        self.device.hold()
        for topic, value in ((speed, 7), (torque, 7), (start, True)):
            in_order.publish(topic, value)
        calling, answer = self.ask()
        self.device.go_on()
        calling.join(PATIENCE)
        self.assertEqual((answer[0].success, answer[0].message), (True, "3 of 3 outputs have their safe values"))
        wait_until(lambda: self.device.tables["holding_registers"][10] == 7, "what waited for another point")
        self.assertEqual(list(self.device.written()), [(1, 0), (2, 1), (20, 5), (10, 7)])
        torque.publish(8)  # it does not latch
        wait_until(lambda: self.device.tables["holding_registers"][20] == 8, "the next message")

    def test_it_waits_for_no_other_service(self):
        reading = threading.Thread(target=lambda: self.call("write", Write, "speed", "1"))
        self.device.hold()
        reading.start()
        calling, answer = self.ask()
        self.device.go_on()
        calling.join(PATIENCE)
        reading.join(PATIENCE)
        self.assertTrue(answer[0].success)
        self.assertEqual(list(self.device.written()), [(1, 0), (2, 1), (20, 5), (10, 1)])

    def test_an_output_that_refuses_makes_it_false(self):
        def answer(request):
            if request.function in (5, 15) and request.address == 1:
                raise Refuse(FAILURE)
            return self.device.serve(request)

        self.device.answer = answer
        told = self.call("safe", Trigger)
        self.assertFalse(told.success)
        self.assertIn("2 of 3 outputs have their safe values; start: exception 04", told.message)
        self.assertEqual(self.device.tables["holding_registers"][20], 5)

    def test_offline_it_fails_at_once(self):
        online = self.topic(f"/{self.name}/online", Bool)
        self.device.stop()
        online.wait_for(lambda now: not now)
        told = self.call("safe", Trigger)
        self.assertFalse(told.success)
        self.assertTrue(told.message)


if __name__ == "__main__":
    testing.main()
