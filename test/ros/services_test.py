# SPDX-License-Identifier: Apache-2.0
"""Services answer when the result is known, and say what it was."""
import threading
import time
from concurrent import futures
from concurrent.futures import ThreadPoolExecutor

from coupler_driver.msg import PointStatus
from coupler_driver.srv import Read, Write
from std_msgs.msg import Bool, Float32
from std_srvs.srv import SetBool

from support import process, testing
from support.device import ILLEGAL_ADDRESS, Device, Refuse
from support.latest import LatestDiagnostics, LatestStatus, values
from support.patience import NO_TIMEOUT, PATIENCE, QUIET
from support.topics import response_of, wait_until

MAP = """
name: {name}
address: 127.0.0.1
rate: 20
timeout: {timeout}s
mapping:
  coils: {lamp: 3, locked: 4}
  input_registers:
    pressure: {address: 0, type: INT, scale: 0.5}
  holding_registers:
    level: {address: 4, type: INT}
    speeds: {address: 10, type: UINT, count: 3}
    label: {address: 20, type: STRING, length: 6}
    gain: {address: 40, type: REAL}
    gains: {address: 50, type: REAL, count: 2}
    seldom: {address: 30, type: INT, rate: 0.001}
"""

WriteResponse = response_of(Write)


class ServicesTest(testing.RosTest):
    at_once = True
    timeout = NO_TIMEOUT

    def setUp(self):
        self.device = Device().start()
        self.addCleanup(self.device.stop)
        path = process.write_map(MAP.replace("{timeout}", str(self.timeout)).replace("{name}", self.name))
        self.program = self.driver(f"_map:={path}", f"_port:={self.device.port}")
        self.program.wait_for("connected")
        self.status = LatestStatus(self.name)
        self.addCleanup(self.status.close)

    def call(self, name, kind, *arguments):
        return self.service(f"/{self.name}/{name}", kind)(*arguments)

    def write(self, point, value):
        return self.call("write", Write, point, value)


class Services(ServicesTest):
    def test_a_write_answers_once_the_device_has_it(self):
        result = self.write("level", "-5")
        self.assertEqual((result.success, result.outcome, result.message), (True, WriteResponse.OK, "ok"))
        self.status.wait_for(lambda known: "level" in known and known["level"].write_outcome == PointStatus.WRITE_OK)
        self.assertEqual(self.device.tables["holding_registers"][4], 0xFFFB)
        self.assertTrue(self.write("speeds", "[1, 2, 3]").success)
        self.assertEqual(self.device.tables["holding_registers"][10:13], [1, 2, 3])
        self.assertTrue(self.write("label", "ok").success)
        self.assertTrue(self.write("lamp", "true").success)
        self.assertEqual(self.device.tables["coils"][3], 1)

    def test_an_exception_is_told_with_code_and_text(self):
        def answer(request):
            if request.function == 5 and request.address == 4:
                raise Refuse(ILLEGAL_ADDRESS)
            return self.device.serve(request)

        self.device.answer = answer
        result = self.write("locked", "true")
        self.assertEqual((result.success, result.outcome, result.exception), (False, WriteResponse.EXCEPTION, 2))
        self.assertEqual(result.message, "exception 02 (illegal data address)")
        result = self.call("locked/set", SetBool, True)
        self.assertFalse(result.success)
        self.assertEqual(result.message, "exception 02 (illegal data address)")
        locked = self.status.wait_for(lambda known: "locked" in known and known["locked"].write_outcome == PointStatus.WRITE_EXCEPTION)["locked"]
        self.assertEqual(locked.write_text, "exception 02 (illegal data address)")

    def test_a_bit_is_set_by_the_usual_service(self):
        for on in (True, False):
            self.assertTrue(self.call("lamp/set", SetBool, on).success)
            self.assertEqual(self.device.tables["coils"][3], on)

    def test_what_cannot_be_written_is_told_with_what_can(self):
        for point, value, expected in (("nothing", "1", f"there is no point 'nothing' in the map of {self.name}; the map has their names"),
                                       ("presure", "1", f"there is no point 'presure' in the map of {self.name}; did you mean 'pressure'?"),
                                       ("pressure", "1", "pressure cannot be written: it is an input"),
                                       ("lamp", "TRUE", "'TRUE' is neither true nor false; send true or false (or on, off, 1, 0)"),
                                       ("level", "70000", "-32768 to 32767"), ("level", "full", "is not a number"),
                                       ("speeds", "[1]", "give 3")):
            result = self.write(point, value)
            self.assertEqual((result.success, result.outcome), (False, WriteResponse.REFUSED))
            self.assertTrue(result.message.startswith("refused: "), result.message)
            self.assertIn(expected, result.message)

    def test_what_is_no_number_is_refused_by_service_and_topic(self):
        for value in ("nan", "-inf"):
            result = self.write("gain", value)
            self.assertEqual((result.outcome, self.device.seen(16)), (WriteResponse.REFUSED, []))
            self.assertIn("not finite", result.message)
        self.assertEqual(self.write("gains", "[1, inf]").outcome, WriteResponse.REFUSED)
        self.publisher(f"/{self.name}/gain/write", Float32).publish(float("nan"))
        self.program.wait_for(f"{self.name}: write to gain: refused: a number that is not finite (NaN or infinity)")
        self.assertTrue(self.write("gain", "1.5").success)
        self.assertEqual([request.count for request in self.device.seen(16)], [2])

    def test_a_flood_of_refused_writes_is_one_line_a_second_with_a_count(self):
        began = time.monotonic()
        write = self.service(f"/{self.name}/write", Write)
        for _ in range(300):
            write("level", "70000")
        self.program.wait_for("more of this kind)")
        lines = self.program.output.count(f"{self.name}: refused a write to level")
        self.assertLess(lines, 2 + time.monotonic() - began)

    def test_what_is_refused_is_logged_and_counted(self):
        diagnostics = LatestDiagnostics(self.name)
        self.addCleanup(diagnostics.close)
        self.write("level", "70000")
        self.program.wait_for(f"{self.name}: refused a write to level by the service {self.name}/write: 70000 does not fit")
        self.write("pressure", "1")
        self.program.wait_for(f"{self.name}: refused a write to pressure by the service {self.name}/write: ")
        self.write("nothing", "1")
        self.program.wait_for(f"{self.name}: refused a write to 'nothing' by the service {self.name}/write: there is no point 'nothing'")
        self.write("level", "1e3")
        self.assertEqual(self.device.tables["holding_registers"][4], 1000)
        known = diagnostics.wait_for(lambda known: "writes" in known and values(known["writes"])["ok"] == "1")
        self.assertEqual(values(known["writes"])["refused"], "2")

    def test_a_read_brings_the_next_value(self):
        self.device.tables["input_registers"][0] = 43
        self.assertEqual(self.call("read", Read, "pressure").value, "21.5")
        self.device.tables["holding_registers"][10:13] = [7, 8, 9]
        self.assertEqual(self.call("read", Read, "speeds").value, "[7, 8, 9]")

    def test_a_value_that_is_under_way_when_it_is_called_is_not_the_next_one(self):
        is_under_way, may_come = threading.Event(), threading.Event()

        def answer(request):
            reply = self.device.serve(request)
            if request.function == 4 and not is_under_way.is_set():
                is_under_way.set()
                may_come.wait(PATIENCE)
            return reply

        self.device.answer = answer
        self.assertTrue(is_under_way.wait(PATIENCE))
        self.device.tables["input_registers"][0] = 43
        with ThreadPoolExecutor() as pool:
            read = pool.submit(self.call, "read", Read, "pressure")
            time.sleep(QUIET)  # nothing tells that the driver has the call
            may_come.set()
            self.assertEqual(read.result().value, "21.5")

    def test_a_read_that_waits_holds_up_no_write(self):
        wait_until(lambda: any(request.address == 30 for request in self.device.seen(3)), "the read of seldom at the beginning")
        ended = []

        def call(name, *arguments):
            answer = self.call(name, *arguments)
            ended.append(name)
            return answer

        with ThreadPoolExecutor() as pool:
            read = pool.submit(call, "read", Read, "seldom")  # which is read every 1000 s
            time.sleep(QUIET)  # nothing tells that the driver has the call
            calls = [pool.submit(call, "write", Write, "level", "7"), pool.submit(call, "lamp/set", SetBool, True)]
            futures.wait(calls, PATIENCE)
            self.device.stop()  # this ends it
        self.assertIn("no value of seldom: the device is offline", read.result().message)
        self.assertEqual([done.result().success for done in calls], [True, True])
        self.assertEqual(ended[-1], "read")


class ServicesOffline(ServicesTest):
    timeout = 2  # an answer takes far less, on a busy machine too

    def test_a_write_that_is_lost_is_told(self):
        self.device.silent = True
        result = self.write("level", "1")
        self.assertFalse(result.success)
        self.assertTrue(result.message)
        online = self.topic(f"/{self.name}/online", Bool)
        online.wait_for(lambda now: not now)
        self.assertIn("not connected", self.write("level", "1").message)

    def test_a_read_is_answered_at_once_while_the_device_is_offline(self):
        online = self.topic(f"/{self.name}/online", Bool)
        online.wait_for(bool)
        self.call("read", Read, "pressure")
        self.device.silent = True
        started = time.monotonic()
        for _ in range(5):  # the first while it goes offline
            result = self.call("read", Read, "seldom")
            self.assertFalse(result.success)
            self.assertIn("no value of seldom: the device is offline: ", result.message)
        self.assertLess(time.monotonic() - started, PATIENCE, "seldom is read every 1000 s")
        self.device.silent = False
        self.topic(f"/{self.name}/online", Bool).wait_for(bool)
        self.assertTrue(self.call("read", Read, "pressure").success)


if __name__ == "__main__":
    testing.main()
