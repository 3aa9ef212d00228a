# SPDX-License-Identifier: Apache-2.0
"""What a device has as text is published as UTF-8, whatever its bytes are, and the log says what they are not."""
import struct

from coupler_driver.msg import StringStamped
from std_msgs.msg import String

from support import process, testing
from support.device import Device
from support.patience import NO_TIMEOUT

MAP = """
name: {name}
address: 127.0.0.1
rate: 20
timeout: {timeout}s
mapping:
  input_registers:
    label: {address: 0, type: STRING, length: 6, order: AB, stamped: true}
    latin: {address: 0, type: STRING, length: 6, order: AB, encoding: latin-1}
    plain: {address: 3, type: STRING, length: 4, order: BA, encoding: ascii}
"""


class Texts(testing.RosTest):
    def test_bytes_that_are_no_utf_8_are_escaped_and_said_once(self):
        device = Device().start()
        self.addCleanup(device.stop)
        device.tables["input_registers"][0:5] = [*struct.unpack(">3H", b"gr\xfcn\0\0"), *struct.unpack("<2H", b"a\xb0C\0")]
        path = process.write_map(MAP.replace("{timeout}", str(NO_TIMEOUT)).replace("{name}", self.name))
        topics = {point: self.topic(f"/{self.name}/{point}", String) for point in ("label", "latin", "plain")}
        stamped = self.topic(f"/{self.name}/label/stamped", StringStamped)
        driver = self.driver(f"_map:={path}", f"_port:={device.port}")
        topics["label"].becomes(r"gr\xfcn")
        topics["latin"].becomes("grün")
        topics["plain"].becomes("a?C")
        stamped.wait_for(lambda message: message.value == r"gr\xfcn")
        driver.wait_for(r"the text of label is not utf-8: its byte 0xFC is published as '\xfc'")
        driver.wait_for("the text of plain is not ascii: its byte 0xB0 is published as '?'")
        device.tables["input_registers"][2] = 0xFFFF
        topics["label"].becomes(r"gr\xfcn\xff\xff")
        self.assertEqual(driver.output.count("the text of label"), 1)


if __name__ == "__main__":
    testing.main()
