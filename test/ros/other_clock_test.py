# SPDX-License-Identifier: Apache-2.0
"""Stamps of a node whose clock has an offset, drifts and jumps, behind a network that delays, more one way than the other: the
true time is always within the stamp and its uncertainty. Another client writes at times that the test takes."""
import dataclasses
import random
import time
import unittest

from coupler_driver.msg import BoolStamped, Scheduled
from coupler_driver.srv import Schedule
from pymodbus.client import ModbusTcpClient

from support import process, testing
from support.other_clock import NS, OtherClock
from support.patience import NO_TIMEOUT, PATIENCE, wait_until
from support.ports import free_port
from support.times import ROUNDING, ros_duration, ros_time, seconds

MAP = f"""
name: cell
address: 127.0.0.1
rate: 0.001
timeout: {NO_TIMEOUT}s
defaults: {{publish: on_change, stamped: true}}
mapping:
  coils: {{lamp: 4}}
"""
HOUR = 3600 * NS
DRIFT = 400e-6  # of two clocks that are worse than any board's; what may be is 500
MEASURED = 11  # seconds after which the driver has measured the drift
ASYMMETRIC = 0.03  # seconds


@dataclasses.dataclass
class Edge:
    """Wall time in seconds; it was between `before` and `after`."""
    before: float
    after: float
    stamp: float
    uncertainty: float

    @property
    def error(self):
        """At least so much is the stamp off."""
        return max(self.before - self.stamp, self.stamp - self.after, 0)


@unittest.skipUnless(process.has_node(), "coupler-node was not built")
class OtherClockTest(testing.RosTest):
    def begin(self, **clock):
        self.doCleanups()  # of the clock before
        path = process.write_map(MAP)
        node = process.Node(path, port=free_port())
        self.addCleanup(node.end)
        self.clock = OtherClock(node.port, **clock)
        self.addCleanup(self.clock.stop)
        self.process = self.driver(f"_map:={path}", f"_port:={self.clock.port}")
        self.process.wait_for("connected")
        self.lamp = self.topic("/cell/lamp/stamped", BoolStamped)
        self.lamp.wait_for(lambda message: not message.value)
        self.client = ModbusTcpClient("127.0.0.1", port=node.port, timeout=PATIENCE)
        self.addCleanup(self.client.close)
        self.level = False
        self.edge()  # from here on the driver listens

    def set_lamp(self, level):
        self.assertFalse(self.client.write_coil(4, level).isError())

    def edge(self):
        """Made by another client, behind no clock and no delay."""
        self.level = not self.level
        came = len(self.lamp.values)
        before = time.time()
        self.set_lamp(self.level)
        after = time.time()
        wait_until(lambda: self.lamp.values[came:] and self.lamp.values[-1].value == self.level, "the edge")
        message = self.lamp.values[-1]
        return Edge(before, after, seconds(message.header.stamp), message.uncertainty)

    def edges(self, count, pause=0.0):
        edges = []
        for _ in range(count):
            edges.append(self.edge())
            time.sleep(pause)
        return edges

    def expect_true(self, edges):
        for edge in edges:
            self.assertLessEqual(edge.error, edge.uncertainty + ROUNDING, edge)


class Stamps(OtherClockTest):
    def test_of_a_clock_that_is_ahead_or_has_just_begun(self):
        for offset in (300 * 24 * HOUR, NS - time.monotonic_ns()):
            with self.subTest(offset=offset):
                self.begin(offset=offset)
                self.expect_true(self.edges(10))

    def test_of_a_clock_that_drifts(self):
        for drift in (DRIFT, -DRIFT):
            with self.subTest(drift=drift):
                self.begin(drift=drift)
                begun = time.monotonic()
                while time.monotonic() < begun + MEASURED:
                    self.expect_true(self.edges(1, pause=0.6))
                self.expect_true(self.edges(3, pause=1.2))  # the drift is known, and nothing was exchanged for a while

    def test_of_a_network_that_is_slow_one_way(self):
        for way in ("to_node", "to_driver"):
            with self.subTest(way=way):
                self.begin(**{way: lambda: ASYMMETRIC})
                edges = self.edges(10)
                self.expect_true(edges)
                for edge in edges:
                    self.assertGreaterEqual(edge.uncertainty, ASYMMETRIC / 2, "which way it was slow nobody can know")

    def test_of_a_network_that_is_slow_now_and_then(self):
        chance = random.Random(1)

        def delay():
            return chance.uniform(0.02, 0.1) if chance.random() < 0.3 else chance.uniform(0, 0.001)

        self.begin(offset=7 * HOUR, drift=DRIFT / 2, to_node=delay, to_driver=delay)
        self.expect_true(self.edges(60))

    def test_after_a_jump_they_begin_anew(self):
        self.begin()
        self.expect_true(self.edges(3))
        for jump in (HOUR, -HOUR):
            self.clock.offset += jump
            self.edge()  # this exchange may have begun before the jump
            self.expect_true(self.edges(3))
        self.process.wait_for("clock has jumped")


class Schedules(OtherClockTest):
    """An output at a time, through all of it."""

    def test_the_time_that_is_told_is_when_it_was_driven(self):
        self.begin(offset=7 * HOUR, drift=DRIFT, to_node=lambda: 0.002, to_driver=lambda: 0.01)
        scheduled = self.topic("/cell/scheduled", Scheduled)
        schedule = self.service("/cell/schedule", Schedule)

        def in_seconds(ahead):
            return schedule("lamp", "true", ros_time(time.time() + ahead), ros_duration(0))

        def is_known():
            answer = in_seconds(3000)
            self.set_lamp(False)
            return answer.message == "accepted: the node does it"

        wait_until(is_known, "the node to be known")
        ahead, before = 0.5, time.time()
        while not (answer := in_seconds(ahead)).success:  # on a busy machine the call may come after the time
            ahead, before = 2 * ahead, time.time()
        before, after = self.driven(before)
        outcome = scheduled.wait_for(lambda message: message.number == answer.number)
        self.assertEqual((outcome.result, outcome.reason), (Scheduled.DONE, ""))
        stamp = seconds(outcome.header.stamp)
        self.assertLessEqual(before, stamp + outcome.uncertainty + ROUNDING)
        self.assertGreaterEqual(after, stamp - outcome.uncertainty - ROUNDING)
        self.assertLess(abs(stamp - outcome.lateness - seconds(outcome.due)), ROUNDING)

    def driven(self, before):
        """The last time at which the lamp was seen off, of `before` and those since, and the first at which it was seen on."""
        while True:
            asked = time.time()
            if self.client.read_coils(4, 1).bits[0]:
                return before, time.time()
            before = asked


if __name__ == "__main__":
    testing.main()
