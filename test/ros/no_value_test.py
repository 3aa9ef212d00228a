# SPDX-License-Identifier: Apache-2.0
"""What a device gives for no value is not published as one, and a scale has its exponent from a register."""
from coupler_driver.msg import Float64Stamped, PointStatus
from coupler_driver.srv import Read
from diagnostic_msgs.msg import DiagnosticStatus
from std_msgs.msg import Float64, Int16

from support import process, testing
from support.device import Device
from support.latest import LatestDiagnostics, LatestStatus
from support.patience import NO_TIMEOUT
from support.topics import service

INVALID, FAULT = 7, 8  # of PointStatus.quality: docs/driver-faults.md
MAP = """
name: {name}
address: 127.0.0.1
rate: 20
timeout: {timeout}s
mapping:
  input_registers:
    temp: {address: 0, type: INT, scale: 0.1, invalid: 0x8000, publish: on_change, stamped: true}
    level: {address: 1, type: INT}
    power: {address: 2, type: INT, scale: {exponent_of: power_sf}, publish: on_change}
    power_sf: {address: 5, type: INT, invalid: 0x8000}
    bar: {address: 6, type: UINT, scale: {raw: [4000, 20000], value: [0, 10]}, fault_below: 3600, publish: on_change}
"""


class NoValue(testing.RosTest):
    at_once = True

    def setUp(self):
        self.device = Device().start()
        self.addCleanup(self.device.stop)
        self.registers = self.device.tables["input_registers"]
        self.registers[0:7] = [0x8000, 1, 1234, 0, 0, 0x8000, 3500]
        path = process.write_map(MAP.replace("{timeout}", str(NO_TIMEOUT)).replace("{name}", self.name))
        self.temp = self.topic(f"/{self.name}/temp", Float64)
        self.power = self.topic(f"/{self.name}/power", Float64)
        self.driver(f"_map:={path}", f"_port:={self.device.port}").wait_for("connected")
        self.status = LatestStatus(self.name)
        self.diagnostics = LatestDiagnostics(self.name)
        self.addCleanup(self.status.close)
        self.addCleanup(self.diagnostics.close)

    def test_no_value_is_not_published_and_the_value_is_when_it_comes_back(self):
        stamped = self.topic(f"/{self.name}/temp/stamped", Float64Stamped)
        temp = self.status.quality("temp", INVALID)
        self.assertEqual(temp.text, "invalid: the device gives 0x8000, which the map calls invalid")
        self.diagnostics.says("temp (invalid)", "polling", DiagnosticStatus.WARN)
        self.topic(f"/{self.name}/level", Int16).next()
        self.registers[0] = 215
        self.temp.becomes(21.5)
        self.status.quality("temp", PointStatus.GOOD)
        self.registers[0] = 0x8000
        self.status.quality("temp", INVALID)
        self.registers[0] = 215
        stamped.wait_for(lambda _: len(stamped.values) == 2)
        self.temp.wait_for(lambda _: len(self.temp.values) == 2)
        self.assertEqual(self.temp.ever, [21.5, 21.5])
        self.assertEqual([message.value for message in stamped.ever], [21.5, 21.5])

    def test_a_broken_wire_is_a_fault(self):
        bar = self.topic(f"/{self.name}/bar", Float64)
        self.assertIn("the device gives 3500, below fault_below (3600)", self.status.quality("bar", FAULT).text)
        self.diagnostics.says("bar (fault)", "polling", DiagnosticStatus.WARN)
        self.registers[6] = 12000
        bar.becomes(5)
        self.assertEqual(bar.ever, [5])

    def test_a_service_that_reads_says_why_there_is_none(self):
        read = service(f"/{self.name}/read", Read)
        self.registers[0] = 217
        self.status.quality("temp", PointStatus.GOOD)
        self.assertEqual((read("temp").success, read("temp").value), (True, "21.7"))
        self.registers[0] = 0x8000
        self.status.quality("temp", INVALID)
        answer = read("temp")
        self.assertEqual((answer.success, answer.message),
                         (False, "no value of temp: the device gives 0x8000, which the map calls invalid"))

    def test_a_value_has_the_exponent_that_was_read_with_it(self):
        self.assertIn("power_sf, the exponent of its scale, has no value", self.status.quality("power", INVALID).text)
        self.registers[5] = 0x10000 - 2
        self.power.becomes(12.34)
        self.registers[5] = 1
        self.power.becomes(12340)
        self.assertEqual(self.power.ever, [12.34, 12340])


if __name__ == "__main__":
    testing.main()
