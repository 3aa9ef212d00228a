# SPDX-License-Identifier: Apache-2.0
"""Services answer when the result is known, and say what it was."""
import time

import rospy
from coupler_driver.srv import Read, Write
from std_msgs.msg import Bool
from std_srvs.srv import SetBool

from support import process, testing
from support.device import ILLEGAL_ADDRESS, Device, Refuse
from support.latest import LatestDiagnostics, values
from support.patience import NO_TIMEOUT, PATIENCE

MAP = """
name: served
address: 127.0.0.1
rate: 20
timeout: {timeout}
mapping:
  coils: {lamp: 3, locked: 4}
  input_registers:
    pressure: {address: 0, type: INT, scale: 0.5}
  holding_registers:
    level: {address: 4, type: INT}
    speeds: {address: 10, type: UINT, count: 3}
    label: {address: 20, type: STRING, length: 6}
    seldom: {address: 30, type: INT, rate: 0.001}
"""


class ServicesTest(testing.RosTest):
    timeout = NO_TIMEOUT

    def setUp(self):
        self.device = Device().start()
        self.addCleanup(self.device.stop)
        path = process.write_map(MAP.replace("{timeout}", str(self.timeout)))
        self.program = self.driver(f"_map:={path}", f"_port:={self.device.port}")
        self.program.wait_for("connected")

    def call(self, name, kind, *arguments):
        rospy.wait_for_service(f"/served/{name}", PATIENCE)
        return rospy.ServiceProxy(f"/served/{name}", kind)(*arguments)

    def write(self, point, value):
        return self.call("write", Write, point, value)


class Services(ServicesTest):
    def test_a_write_answers_once_the_device_has_it(self):
        self.assertTrue(self.write("level", "-5").success)
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
        self.assertEqual((result.success, result.exception), (False, 2))
        self.assertIn("illegal data address", result.message)
        result = self.call("locked/set", SetBool, True)
        self.assertFalse(result.success)
        self.assertIn("illegal data address", result.message)

    def test_a_bit_is_set_by_the_usual_service(self):
        for on in (True, False):
            self.assertTrue(self.call("lamp/set", SetBool, on).success)
            self.assertEqual(self.device.tables["coils"][3], on)

    def test_what_cannot_be_written_is_told_with_what_can(self):
        for point, value, expected in (("nothing", "1", "there is no point 'nothing'"),
                                       ("pressure", "1", "pressure cannot be written"),
                                       ("level", "70000", "-32768 … 32767"), ("level", "full", "is not a number"),
                                       ("speeds", "[1]", "give 3")):
            result = self.write(point, value)
            self.assertFalse(result.success)
            self.assertIn(expected, result.message)

    def test_what_is_refused_is_logged_and_counted(self):
        diagnostics = LatestDiagnostics("served")
        self.addCleanup(diagnostics.close)
        self.write("level", "70000")
        self.program.wait_for("served: dropped a write to level by the service served/write: 70000 does not fit")
        self.write("pressure", "1")
        self.program.wait_for("served: dropped a write to pressure by the service served/write: ")
        self.write("nothing", "1")
        self.program.wait_for("served: dropped a write by the service served/write: there is no point 'nothing'")
        self.write("level", "1e3")
        self.assertEqual(self.device.tables["holding_registers"][4], 1000)
        known = diagnostics.wait_for(lambda known: "writes" in known and values(known["writes"])["ok"] == "1")
        self.assertEqual(values(known["writes"])["refused"], "2")

    def test_a_read_brings_the_next_value(self):
        self.device.tables["input_registers"][0] = 43
        self.assertEqual(self.call("read", Read, "pressure").value, "21.5")
        self.device.tables["holding_registers"][10:13] = [7, 8, 9]
        self.assertEqual(self.call("read", Read, "speeds").value, "[7, 8, 9]")


class ServicesOffline(ServicesTest):
    timeout = 2  # an answer takes far less, on a busy machine too

    def test_a_write_that_is_lost_is_told(self):
        self.device.silent = True
        result = self.write("level", "1")
        self.assertFalse(result.success)
        self.assertTrue(result.message)
        online = self.topic("/served/online", Bool)
        online.wait_for(lambda now: not now)
        self.assertIn("not connected", self.write("level", "1").message)

    def test_a_read_is_answered_at_once_while_the_device_is_offline(self):
        online = self.topic("/served/online", Bool)
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
        self.topic("/served/online", Bool).wait_for(bool)
        self.assertTrue(self.call("read", Read, "pressure").success)


if __name__ == "__main__":
    testing.main()
