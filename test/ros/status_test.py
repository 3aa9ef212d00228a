# SPDX-License-Identifier: Apache-2.0
"""status and /diagnostics say the truth about a device, soon after it changes."""
import threading
import time

import rospy
from coupler_driver.msg import PointStatus, Status
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from std_msgs.msg import Int16

from support import process, testing
from support.device import FAILURE, ILLEGAL_ADDRESS, Device, Refuse

MAP = """
name: plant
address: 127.0.0.1
rate: 20
timeout: 0.5
mapping:
  holding_registers:
    level: {address: 4, type: INT}
    broken: {address: 100, type: INT}
    order: {address: 200, type: INT, access: write}
"""


class Latest:
    """The last message of a topic, and a wait for one that fits."""

    def __init__(self, name, kind, merge):
        self._changed = threading.Condition()
        self._merge = merge
        self.known = {}
        self._subscriber = rospy.Subscriber(name, kind, self._receive, queue_size=100)

    def _receive(self, message):
        with self._changed:
            self._merge(self.known, message)
            self._changed.notify_all()

    def wait_for(self, condition, seconds=20):
        with self._changed:
            if not self._changed.wait_for(lambda: condition(self.known), seconds):
                raise AssertionError(f"waited {seconds} s; last: {self.known}")
            return dict(self.known)

    def close(self):
        self._subscriber.unregister()


def merge_status(known, message):
    known["online"], known["identity"], known["trouble"] = message.online, message.identity, message.trouble
    known.update({point.name: point for point in message.points})


def merge_diagnostics(known, message):
    for status in message.status:
        known[status.name.split("plant ")[-1]] = status


def values(status):
    return {pair.key: pair.value for pair in status.values}


class StatusAndDiagnostics(testing.RosTest):
    def setUp(self):
        self.device = Device().start()
        self.addCleanup(self.device.stop)
        self.driver(f"_map:={process.write_map(MAP)}", f"_port:={self.device.port}").wait_for("connected")
        self.status = Latest("/plant/status", Status, merge_status)
        self.diagnostics = Latest("/diagnostics", DiagnosticArray, merge_diagnostics)
        self.addCleanup(self.status.close)
        self.addCleanup(self.diagnostics.close)

    def quality(self, name, wanted):
        return self.status.wait_for(lambda known: name in known and known[name].quality == wanted)[name]

    def level(self, name, wanted):
        return self.diagnostics.wait_for(lambda known: name in known and known[name].level == wanted)[name]

    def refuse(self, code):
        def answer(request):
            if request.function == 3 and request.address == 100:
                raise Refuse(code)
            return self.device.serve(request)
        self.device.answer = answer

    def test_all_is_well(self):
        level = self.quality("level", PointStatus.GOOD)
        self.assertTrue(0 <= level.age < 5)
        self.assertEqual(level.exception, 0)
        known = self.status.wait_for(lambda known: known.get("online"))
        self.assertEqual(known["identity"], "foreign")
        self.assertEqual(known["order"].quality, PointStatus.NEVER_READ)
        for name in ("connection", "polling", "writes"):
            self.assertIn("plant", self.level(name, DiagnosticStatus.OK).hardware_id)

    def test_a_point_that_fails_is_named_with_its_exception(self):
        self.quality("broken", PointStatus.GOOD)
        self.refuse(FAILURE)
        broken = self.quality("broken", PointStatus.EXCEPTION)
        self.assertEqual(broken.exception, 4)
        self.assertEqual(self.status.known["level"].quality, PointStatus.GOOD)
        polling = self.level("polling", DiagnosticStatus.WARN)
        self.assertIn("broken", polling.message)
        self.assertTrue(any(key.startswith("exception 04") for key in values(polling)))
        self.device.answer = self.device.serve
        self.quality("broken", PointStatus.GOOD)
        self.level("polling", DiagnosticStatus.OK)

    def test_a_point_that_the_device_has_not_is_rejected(self):
        self.refuse(ILLEGAL_ADDRESS)
        self.assertEqual(self.quality("broken", PointStatus.REJECTED).exception, 2)
        self.level("polling", DiagnosticStatus.WARN)

    def test_a_silent_device_is_offline_with_the_reason_and_comes_back(self):
        self.quality("level", PointStatus.GOOD)
        self.device.silent = True
        self.quality("level", PointStatus.OFFLINE)
        self.assertFalse(self.status.known["online"])
        self.assertTrue(self.status.known["trouble"])
        self.assertIn("offline", self.level("connection", DiagnosticStatus.ERROR).message)
        self.device.silent = False
        self.quality("level", PointStatus.GOOD)
        self.assertGreaterEqual(int(values(self.level("connection", DiagnosticStatus.OK))["timeouts"]), 1)

    def test_the_distribution_of_latencies_is_told(self):
        def answer(request):
            time.sleep(0.01)
            return self.device.serve(request)

        self.device.answer = answer
        known = self.diagnostics.wait_for(
            lambda known: "polling" in known and float(values(known["polling"])["request latency p50 ms"]) >= 10)
        told = values(known["polling"])
        for name in ("request latency", "cycle"):
            distribution = [float(told[f"{name} {part} ms"]) for part in ("p50", "p95", "p99", "max")]
            self.assertEqual(distribution, sorted(distribution))

    def test_writes_are_counted_by_result(self):
        def answer(request):
            if request.function == 6 and request.data[4] == 2:
                raise Refuse(ILLEGAL_ADDRESS)
            return self.device.serve(request)

        self.device.answer = answer
        order = self.publisher("/plant/order/write", Int16)
        order.publish(1)
        self.diagnostics.wait_for(lambda known: "writes" in known and values(known["writes"])["ok"] == "1")
        order.publish(2)
        writes = self.level("writes", DiagnosticStatus.WARN)
        self.assertEqual(values(writes)["exception"], "1")
        self.assertEqual(self.quality("level", PointStatus.GOOD).exception, 0)


if __name__ == "__main__":
    testing.main()
