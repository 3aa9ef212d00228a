# SPDX-License-Identifier: Apache-2.0
"""A value that cannot be written is dropped with a warning that names the topic and what to do; the next one works."""
from coupler_driver.msg import BoolArray
from coupler_driver.srv import Read, Write
from std_msgs.msg import Float32, Float64, String, UInt16

from support import process, testing
from support.peer import Peer
from support.topics import wait_until

MAP = """
name: {name}
address: 127.0.0.1
timeout: 60
mapping:
  holding_registers:
    flags: {address: 0, type: WORD}
    label: {address: 1, type: STRING, length: 4}
    code: {address: 3, type: STRING, length: 4, encoding: ascii}
    pressure: {address: 5, type: INT, scale: 0.1, min: 0, max: 21.7, units: bar}
    mode: {address: 6, type: UINT, values: {0: "off", 1: idle, 7: auto}}
    gain: {address: 7, type: REAL, order: ABCD, allow_nonfinite: true}
"""


class RefusedValues(testing.RosTest):
    at_once = True

    def setUp(self):
        self.peer = Peer().start()
        self.addCleanup(self.peer.stop)
        path = process.write_map(MAP.replace("{name}", self.name))
        self.device = self.driver(f"_map:={path}", f"_port:={self.peer.port}")
        self.device.wait_for("connected")

    def test_a_bool_array_of_the_wrong_length(self):
        publisher = self.publisher(f"/{self.name}/flags/write", BoolArray)
        publisher.publish([True] * 8)
        self.device.wait_for(f"refused a write to {self.name}/flags/write: 8 elements; send 16, element i is bit i")
        publisher.publish([True] + [False] * 15)
        wait_until(lambda: self.peer.get("holding_registers", 0) == [1], "bit 0 at the peer")

    def test_a_text_that_is_too_long_or_not_in_the_encoding(self):
        label, code = (self.publisher(f"/{self.name}/{name}/write", String) for name in ("label", "code"))
        label.publish("lange")
        self.device.wait_for(f"refused a write to {self.name}/label/write: 'lange' is too long; give at most 4 bytes of utf-8")
        code.publish("für")
        # How the log shows the letter is the locale's affair.
        self.device.wait_for(f"refused a write to {self.name}/code/write: 'f")
        self.device.wait_for("cannot be written in ascii; leave out what it does not have")
        code.publish("fur")
        wait_until(lambda: self.peer.get("holding_registers", 3) == [0x7566], "'fu' at the peer")
        self.assertEqual(self.peer.get("holding_registers", 1, 2), [0, 0])

    def test_a_number_that_the_map_does_not_allow(self):
        pressure, mode = self.publisher(f"/{self.name}/pressure/write", Float64), self.publisher(f"/{self.name}/mode/write", UInt16)
        pressure.publish(21.8)
        self.device.wait_for("write to pressure: refused: 21.8 bar is above the maximum; send 0 to 21.7 bar")
        pressure.publish(21.7)
        wait_until(lambda: self.peer.get("holding_registers", 5) == [217], "21.7 bar at the peer")
        mode.publish(2)
        self.device.wait_for("write to mode: refused: 2 is not one of its values; send off (0), idle (1) or auto (7)")
        self.assertEqual(self.peer.get("holding_registers", 6), [0])

    def test_a_service_takes_and_gives_the_names_of_values(self):
        write = self.service(f"/{self.name}/write", Write)
        self.assertTrue(write("mode", "auto").success)
        self.assertEqual(self.peer.get("holding_registers", 6), [7])
        wrong = write("mode", "automatic")
        self.assertFalse(wrong.success)
        self.assertIn("'automatic' is not one of its values; send off (0), idle (1) or auto (7)", wrong.message)
        self.assertEqual(self.service(f"/{self.name}/read", Read)("mode").value, "auto")

    def test_nan_where_the_map_allows_it(self):
        self.publisher(f"/{self.name}/gain/write", Float32).publish(float("nan"))
        wait_until(lambda: self.peer.get("holding_registers", 7, 2) == [0x7FC0, 0], "NaN at the peer")


if __name__ == "__main__":
    testing.main()
