# SPDX-License-Identifier: Apache-2.0
"""status and /diagnostics say the truth about a device, soon after it changes."""
import time

from coupler_driver.msg import PointStatus
from diagnostic_msgs.msg import DiagnosticStatus
from std_msgs.msg import Int16

from support import process, testing
from support.device import FAILURE, ILLEGAL_ADDRESS, Device, Refuse
from support.latest import LatestDiagnostics, LatestStatus, values
from support.patience import NO_TIMEOUT

MAP = """
name: {name}
address: 127.0.0.1
rate: 20
timeout: {timeout}s
mapping:
  holding_registers:
    level: {address: 4, type: INT}
    broken: {address: 100, type: INT}
    order: {address: 200, type: INT, access: write}
"""


class StatusTest(testing.RosTest):
    at_once = True
    timeout = NO_TIMEOUT

    def setUp(self):
        self.began = time.monotonic()
        self.device = Device().start()
        self.addCleanup(self.device.stop)
        path = process.write_map(MAP.replace("{timeout}", str(self.timeout)).replace("{name}", self.name))
        self.driver(f"_map:={path}", f"_port:={self.device.port}").wait_for("connected")
        self.status = LatestStatus(self.name)
        self.diagnostics = LatestDiagnostics(self.name)
        self.addCleanup(self.status.close)
        self.addCleanup(self.diagnostics.close)


class StatusAndDiagnostics(StatusTest):
    def refuse(self, code):
        def answer(request):
            if request.function == 3 and request.address == 100:
                raise Refuse(code)
            return self.device.serve(request)
        self.device.answer = answer

    def test_all_is_well(self):
        level = self.status.quality("level", PointStatus.GOOD)
        self.assertTrue(0 <= level.age < time.monotonic() - self.began)
        self.assertEqual(level.exception, 0)
        known = self.status.wait_for(lambda known: known.get("online"))
        self.assertEqual(known["identity"], "foreign")
        self.assertEqual(known["order"].quality, PointStatus.NEVER_READ)
        for name in ("connection", "polling", "writes"):
            self.assertIn(self.name, self.diagnostics.level(name, DiagnosticStatus.OK).hardware_id)

    def test_a_point_that_fails_is_named_with_its_exception(self):
        self.status.quality("broken", PointStatus.GOOD)
        self.refuse(FAILURE)
        broken = self.status.quality("broken", PointStatus.EXCEPTION)
        self.assertEqual(broken.exception, 4)
        self.assertEqual(self.status.known["level"].quality, PointStatus.GOOD)
        polling = self.diagnostics.says("broken", "polling", DiagnosticStatus.WARN)
        self.assertTrue(any(key.startswith("exception 04") for key in values(polling)))
        self.device.answer = self.device.serve
        self.status.quality("broken", PointStatus.GOOD)
        self.diagnostics.level("polling", DiagnosticStatus.OK)

    def test_that_a_foreign_device_refuses_the_question_for_the_identity_is_no_exception(self):
        self.assertEqual(self.status.wait_for(lambda known: known.get("online"))["identity"], "foreign")
        self.status.quality("broken", PointStatus.GOOD)
        polling = self.diagnostics.level("polling", DiagnosticStatus.OK)
        self.assertEqual([key for key in values(polling) if key.startswith("exception")], [])

    def test_a_point_that_the_device_has_not_is_rejected(self):
        self.refuse(ILLEGAL_ADDRESS)
        self.assertEqual(self.status.quality("broken", PointStatus.REJECTED).exception, 2)
        self.diagnostics.level("polling", DiagnosticStatus.WARN)

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
        order = self.publisher(f"/{self.name}/order/write", Int16)
        order.publish(1)
        self.diagnostics.wait_for(lambda known: "writes" in known and values(known["writes"])["ok"] == "1")
        order.publish(2)
        self.diagnostics.wait_for(lambda known: values(known["writes"])["exception"] == "1")
        self.assertIn(("writes", DiagnosticStatus.WARN), self.diagnostics.told)
        self.assertEqual(self.status.quality("level", PointStatus.GOOD).exception, 0)


class StatusOfASilentDevice(StatusTest):
    timeout = 0.5

    def test_a_silent_device_is_offline_with_the_reason_and_comes_back(self):
        self.status.quality("level", PointStatus.GOOD)
        self.device.silent = True
        self.status.quality("level", PointStatus.OFFLINE)
        self.assertFalse(self.status.known["online"])
        self.assertTrue(self.status.known["trouble"])
        self.diagnostics.says("offline", "connection", DiagnosticStatus.ERROR)
        self.device.silent = False
        self.status.quality("level", PointStatus.GOOD)
        self.assertGreaterEqual(int(values(self.diagnostics.level("connection", DiagnosticStatus.OK))["timeouts"]), 1)


if __name__ == "__main__":
    testing.main()
