# SPDX-License-Identifier: Apache-2.0
"""Arrays, scaled values, and what is published when, against pymodbus."""
from coupler_driver.msg import BoolArray
from std_msgs.msg import Float64, Float64MultiArray, Int16MultiArray, UInt16, UInt32MultiArray

from support import process, testing
from support.peer import Peer
from support.topics import next_message, wait_until

MAP = """
name: {name}
address: 127.0.0.1
rate: 50
timeout: 60
mapping:
  coils:
    lamps: {address: 8, count: 3}
  input_registers:
    level: {address: 0, type: UINT, publish: on_change, max_interval: 600s}
    raw: {address: 1, type: UINT, publish: on_change, deadband: 5, max_interval: 600s}
    kept: {address: 2, type: UINT, publish: on_change, latch: true}
  holding_registers:
    speeds: {address: 0, type: INT, count: 3}
    wide: {address: 10, type: UDINT, count: 2, order: ABCD}
    flags: {address: 20, type: WORD, count: 2}
    temperature: {address: 30, type: INT, scale: {gain: 0.1, offset: -40}, units: °C}
    profile: {address: 40, type: INT, count: 2, scale: 0.5}
"""


class Shapes(testing.RosTest):
    at_once = True

    def setUp(self):
        self.peer = Peer().start()
        self.addCleanup(self.peer.stop)
        path = process.write_map(MAP.replace("{name}", self.name))
        self.device = self.driver(f"_map:={path}", f"_port:={self.peer.port}")
        self.device.wait_for("connected")

    def holds(self, address, *registers, table="holding_registers"):
        wait_until(lambda: self.peer.get(table, address, len(registers)) == list(registers), "the peer to hold it")

    def reads(self, count):
        """So many are published of a point that is published whenever it is read."""
        every = self.topic(f"/{self.name}/speeds", Int16MultiArray)
        wait_until(lambda: len(every.values) >= count, f"{count} reads")

    def test_an_array_is_one_message_both_ways(self):
        speeds = self.topic(f"/{self.name}/speeds", Int16MultiArray)
        self.peer.set("holding_registers", 0, [1, 2, 0xFFFF])
        speeds.wait_for(lambda data: list(data) == [1, 2, -1])
        self.publisher(f"/{self.name}/speeds/write", Int16MultiArray).publish(data=[7, -8, 9])
        self.holds(0, 7, 0xFFF8, 9)
        self.publisher(f"/{self.name}/wide/write", UInt32MultiArray).publish(data=[0x00010002, 0x00030004])
        self.holds(10, 1, 2, 3, 4)

    def test_its_dimension_is_labelled_with_the_points_name(self):
        message = next_message(f"/{self.name}/speeds", Int16MultiArray)
        self.assertEqual([(d.label, d.size, d.stride) for d in message.layout.dim], [("speeds", 3, 3)])

    def test_arrays_of_bits_follow_each_other(self):
        self.publisher(f"/{self.name}/lamps/write", BoolArray).publish([True, False, True])
        self.holds(8, True, False, True, table="coils")
        self.topic(f"/{self.name}/lamps", BoolArray).wait_for(lambda data: list(data) == [True, False, True])
        self.publisher(f"/{self.name}/flags/write", BoolArray).publish([True] + [False] * 30 + [True])
        self.holds(20, 1, 0x8000)

    def test_a_scaled_point_is_read_and_written_in_its_units(self):
        self.peer.set("holding_registers", 30, [615])
        self.topic(f"/{self.name}/temperature", Float64).wait_for(lambda value: abs(value - 21.5) < 1e-9)
        write = self.publisher(f"/{self.name}/temperature/write", Float64)
        write.publish(-40.0)
        self.holds(30, 0)
        write.publish(float("nan"))
        self.device.wait_for(f"{self.name}/temperature/write: not a number; send -3316.8")
        write.publish(1e6)
        self.device.wait_for("is out of range; send -3316.8")
        self.publisher(f"/{self.name}/profile/write", Float64MultiArray).publish(data=[1.5, -2.0])
        self.holds(40, 3, 0xFFFC)
        self.assertEqual(self.peer.get("holding_registers", 30), [0])

    def test_on_change_says_what_changed_and_a_newcomer_hears_the_last(self):
        level, raw = self.topic(f"/{self.name}/level", UInt16), self.topic(f"/{self.name}/raw", UInt16)
        level.wait_for(lambda value: value == 0)
        raw.wait_for(lambda value: value == 0)
        self.reads(25)  # once more for the newcomers, of whom the driver may have heard after the first value
        level.values.clear()
        raw.values.clear()
        self.peer.set("input_registers", 0, [1, 5])
        level.wait_for(lambda value: value == 1)
        self.peer.set("input_registers", 0, [2, 6])
        raw.wait_for(lambda value: value == 6)
        level.wait_for(lambda value: value == 2)
        self.reads(25)
        self.assertEqual(level.values, [1, 2], "25 reads with nothing new")
        self.assertNotIn(5, raw.values, "within the deadband")
        self.assertEqual(self.topic(f"/{self.name}/kept", UInt16, latched=True).wait_for(lambda _: True), 0)

    def test_after_a_reconnect_the_same_value_is_news(self):
        level = self.topic(f"/{self.name}/level", UInt16)
        level.wait_for(lambda value: value == 0)
        self.reads(10)
        level.values.clear()
        self.peer.stop()
        self.device.wait_for("connection lost")
        self.peer.start()
        self.assertEqual(level.wait_for(lambda value: True), 0)


if __name__ == "__main__":
    testing.main()
