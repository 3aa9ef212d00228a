# SPDX-License-Identifier: Apache-2.0
"""`stamped: true`: when a value was true, told by a foreign coupler that knows nothing of it. pymodbus notes the time at which
it reads a value, and takes its time before and after."""
import struct
import time

from coupler_driver.msg import (BoolSample, BoolStamped, Float64Sample, Float64Stamped, Int64Sample, Int64Stamped, StringSample,
                                StringStamped, UInt64Sample, UInt64Stamped)
from pymodbus.datastore import ModbusSequentialDataBlock
from std_msgs.msg import Bool, UInt16

from support import process, testing
from support.patience import NO_TIMEOUT
from support.peer import Peer
from support.times import ROUNDING, seconds
from support.topics import type_of, wait_until

MAP = """
name: {name}
address: 127.0.0.1
rate: 50
timeout: {timeout}s
"""
TYPES = """
defaults: {stamped: true}
wordorder_reverse: true
mapping:
  coils:
    lamp: 3
    horn: {address: 4, access: write}
    row: {address: 8, count: 3}
  discrete_inputs:
    door: 7
    gate: {address: 8, stamped: false}
  input_registers:
    bit: {address: 0, type: BOOL, bit: 4}
    byte: {address: 1, type: BYTE, offset: low}
    word: {address: 2, type: WORD}
    lword: {address: 4, type: LWORD}
    letter: {address: 8, type: CHAR, offset: low}
    int: {address: 9, type: INT}
    lint: {address: 10, type: LINT}
    ulint: {address: 14, type: ULINT}
    small: {address: 18, type: USINT, offset: high}
    real: {address: 20, type: REAL}
    lreal: {address: 22, type: LREAL}
    level: {address: 26, type: INT, scale: {gain: 0.5, offset: -10}}
    text: {address: 30, type: STRING, length: 6, ignore_byteorder: true}
"""
WANTED = {
    "lamp": (BoolStamped, True), "door": (BoolStamped, True), "bit": (BoolStamped, True),
    "byte": (UInt64Stamped, 0x81), "word": (UInt64Stamped, 0x8001), "lword": (UInt64Stamped, 0x8000000000000001),
    "letter": (UInt64Stamped, 65), "int": (Int64Stamped, -2), "lint": (Int64Stamped, -2**63),
    "ulint": (UInt64Stamped, 2**64 - 1), "small": (UInt64Stamped, 200), "real": (Float64Stamped, 1.5),
    "lreal": (Float64Stamped, -0.1), "level": (Float64Stamped, 10.5), "text": (StringStamped, "grüß"),
}


SAMPLES = {BoolStamped: BoolSample, Float64Stamped: Float64Sample, Int64Stamped: Int64Sample, StringStamped: StringSample,
           UInt64Stamped: UInt64Sample}


class Slow(ModbusSequentialDataBlock):
    """Counts how often it is read. A number was true at the moment of its reading only."""

    def __init__(self, before, after):
        super().__init__(0, [0] * 16)
        self._before, self._after = before, after
        self.read_at = {}

    def getValues(self, address, count=1):
        time.sleep(self._before)
        number = len(self.read_at) + 1
        self.read_at[number] = time.time()
        time.sleep(self._after)
        return [number] * count


class StampedTest(testing.RosTest):
    at_once = True

    def setUp(self):
        self.peer = Peer().start()
        self.addCleanup(self.peer.stop)

    def start(self, text):
        self.driver(f"_map:={process.write_map(MAP.format(name=self.name, timeout=NO_TIMEOUT) + text)}", f"_port:={self.peer.port}").wait_for("connected")

    def set(self, address, *registers):
        self.peer.set("input_registers", address, registers)


class WhenItWasTrue(StampedTest):
    def true_within_the_stamp(self, before, after):
        device = self.peer.store.store["i"] = Slow(before, after)
        self.start("mapping: {input_registers: {count: {address: 0, type: UINT, stamped: true}}}\n")
        topic = self.topic(f"/{self.name}/count/stamped", UInt64Stamped)
        wait_until(lambda: len(topic.values) >= 20, "twenty values")
        for message in topic.values[:20]:
            stamp = seconds(message.header.stamp)
            error = abs(stamp - device.read_at[message.value])
            self.assertLessEqual(error, message.uncertainty + ROUNDING)
            self.assertGreaterEqual(message.uncertainty, (before + after) / 2, "half of what the device takes at least")

    def test_of_a_device_that_answers_at_once(self):
        self.true_within_the_stamp(0, 0)

    def test_of_a_device_that_reads_late(self):
        self.true_within_the_stamp(0.03, 0)

    def test_of_a_device_that_answers_late(self):
        self.true_within_the_stamp(0, 0.03)


class Messages(StampedTest):
    def test_each_type_has_its_message_and_arrays_have_none(self):
        self.peer.set("coils", 3, [True])
        self.peer.set("discrete_inputs", 7, [True])
        self.set(0, 0x10, 0x81, 0x8001)
        self.set(4, *struct.unpack(">4H", struct.pack(">Q", 0x8000000000000001)))
        self.set(8, 65, 0xFFFE)
        self.set(10, *struct.unpack(">4H", struct.pack(">q", -2**63)), *[0xFFFF] * 4, 200 << 8)
        self.set(20, *struct.unpack(">6H", struct.pack(">fd", 1.5, -0.1)), 41)
        self.set(30, *struct.unpack(">3H", "grüß".encode()))
        self.start(TYPES)
        for name, (kind, value) in WANTED.items():
            with self.subTest(name):
                message = self.topic(f"/{self.name}/{name}/stamped", kind).wait_for(lambda _: True)
                self.assertEqual(message.value, value)
                self.assertEqual(message.header.frame_id, "")
                self.assertLess(abs(time.time() - seconds(message.header.stamp)), NO_TIMEOUT)
                self.assertGreater(message.uncertainty, 0)
                sample = self.topic(f"/{self.name}/{name}/sample", SAMPLES[kind]).wait_for(lambda _: True)
                self.assertEqual((sample.value, sample.told), (value, False))
                self.assertLessEqual(seconds(sample.since), seconds(sample.header.stamp))
        for name in ("horn", "row", "gate"):
            self.assertIsNone(type_of(f"/{self.name}/{name}/sample"), name)
            self.assertIsNone(type_of(f"/{self.name}/{name}/stamped"), name)

    def test_a_sample_says_since_when_its_value_is_known(self):
        self.set(0, 1)
        self.start("mapping: {input_registers: {count: {address: 0, type: UINT, stamped: true}}}\n")
        topic = self.topic(f"/{self.name}/count/sample", UInt64Sample)
        wait_until(lambda: len(topic.values) >= 3, "three samples")
        first = topic.values[-1]
        self.assertLess(seconds(first.since), seconds(first.header.stamp))
        self.set(0, 2)
        changed = topic.wait_for(lambda message: message.value == 2)
        self.assertEqual(seconds(changed.since), seconds(changed.header.stamp))
        later = topic.wait_for(lambda message: message.sequence == changed.sequence + 3)
        self.assertAlmostEqual(seconds(later.since), seconds(changed.since), delta=later.uncertainty + ROUNDING)

    def test_what_one_request_read_has_one_stamp(self):
        self.start("defaults: {stamped: true, queue_size: 1000}\n"
                   "mapping: {input_registers: {a: {address: 0, type: INT}, b: {address: 1, type: INT}}}\n")
        a, b = (self.topic(f"/{self.name}/{name}/stamped", Int64Stamped) for name in "ab")
        begun = seconds(a.next().header.stamp)  # from here on it is told every reading
        stamps = []

        def has_three():
            stamps[:] = [stamp for message in b.values if (stamp := seconds(message.header.stamp)) > begun]
            return len(stamps) >= 3

        wait_until(has_three, "three later readings of the other")
        wait_until(lambda: seconds(a.values[-1].header.stamp) >= stamps[-1], "the same readings")
        self.assertLessEqual(set(stamps), {seconds(message.header.stamp) for message in a.ever})


class When(StampedTest):
    TEXT = """
mapping:
  input_registers:
    always: {address: 0, type: UINT, stamped: true, queue_size: 1000}
    level: {address: 1, type: UINT, stamped: true, publish: on_change, deadband: 5, max_interval: 600s}
    kept: {address: 2, type: UINT, stamped: true, publish: on_change, latch: true}
"""

    def readings(self, count):
        """So many values were read and published."""
        every = self.topic(f"/{self.name}/always", UInt16)
        wait_until(lambda: len(every.values) >= count, f"{count} readings")

    def test_every_value_has_the_next_number_and_a_later_stamp(self):
        self.start(self.TEXT)
        topic = self.topic(f"/{self.name}/always/stamped", UInt64Stamped)
        wait_until(lambda: len(topic.values) >= 10, "ten values")
        got = topic.values[:10]
        self.assertEqual([message.sequence for message in got], list(range(got[0].sequence, got[0].sequence + 10)))
        stamps = [seconds(message.header.stamp) for message in got]
        self.assertEqual(stamps, sorted(set(stamps)))

    def test_under_on_change_only_what_is_news_is_published_and_counted(self):
        self.start(self.TEXT)
        topic = self.topic(f"/{self.name}/level/stamped", UInt64Stamped)
        topic.wait_for(lambda message: message.value == 0)
        self.readings(5)  # a subscriber that has come makes the value news once more
        for value, is_news in ((5, False), (6, True), (11, False), (12, True)):
            self.set(1, value)
            if is_news:
                topic.wait_for(lambda message, wanted=value: message.value == wanted)
            self.readings(5)
        first = [message for message in topic.values if message.value == 0][-1]
        news = [(message.value, message.sequence - first.sequence) for message in topic.values if message.value != 0]
        self.assertEqual(news, [(6, 1), (12, 2)])

    def test_a_late_subscriber_of_a_latched_point_gets_the_last_value_with_its_old_stamp(self):
        self.set(2, 1)
        self.start(self.TEXT)
        first = self.topic(f"/{self.name}/kept/stamped", UInt64Stamped, latched=True)
        self.set(2, 7)
        first.wait_for(lambda message: message.value == 7)
        self.readings(5)
        told = first.values[-1]
        self.peer.stop()  # or else a newcomer has the value read and told once more, with a new stamp
        self.topic(f"/{self.name}/online", Bool, latched=True).wait_for(lambda online: not online)
        late = self.topic(f"/{self.name}/kept/stamped", UInt64Stamped, latched=True).wait_for(lambda _: True)
        self.assertEqual((late.value, late.sequence, late.header.stamp), (7, told.sequence, told.header.stamp))

    def test_with_poll_subscribed_a_subscriber_of_the_stamps_is_one_of_the_point(self):
        self.set(0, 11)
        self.start("poll: subscribed\n" + self.TEXT)
        message = self.topic(f"/{self.name}/always/stamped", UInt64Stamped).wait_for(lambda _: True)
        self.assertEqual(message.value, 11)
        self.assertEqual(self.topic(f"/{self.name}/always", UInt16).next(), 11)


if __name__ == "__main__":
    testing.main()
