# SPDX-License-Identifier: Apache-2.0
"""Stamps of a node whose clock has an offset and jumps (one that drifts: clock_drift_test.py), behind a network that delays,
more one way than the other: the true time is always within the stamp and its uncertainty. Another client writes at times
that the test takes."""
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

MAP = """
name: {name}
address: 127.0.0.1
rate: 0.001
timeout: {timeout}s
defaults: {{publish: on_change, stamped: true}}
mapping:
  coils: {{lamp: 4}}
"""
HOUR = 3600 * NS
DRIFT = 400e-6  # of two clocks that are worse than any board's; what may be is 500
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


class Cell:
    """A node whose clock goes otherwise, and its driver."""

    def __init__(self, test, name, **clock):
        self._test = test
        path = process.write_map(MAP.format(name=name, timeout=NO_TIMEOUT))
        node = process.Node(path, port=free_port())
        test.addCleanup(node.end)
        self.clock = OtherClock(node.port, **clock)
        test.addCleanup(self.clock.stop)
        self.driver = test.driver(f"_map:={path}", f"_port:={self.clock.port}")
        self.driver.wait_for("connected")
        self.lamp = test.topic(f"/{name}/lamp/stamped", BoolStamped)
        self.lamp.wait_for(lambda message: not message.value)
        self.client = ModbusTcpClient("127.0.0.1", port=node.port, timeout=PATIENCE)
        test.addCleanup(self.client.close)
        self.level = False
        self.edge()  # from here on the driver listens

    def set_lamp(self, level):
        self._test.assertFalse(self.client.write_coil(4, level).isError())

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


@unittest.skipUnless(process.has_node(), "coupler-node was not built")
class OtherClockTest(testing.RosTest):
    at_once = True

    def begin(self, **clock):
        """A cell in place of the one before, for who has one at a time (test/bench/time/stamps)."""
        self.doCleanups()
        cell = Cell(self, self.name, **clock)
        self.clock, self.edges = cell.clock, cell.edges

    def expect_true(self, edges):
        for edge in edges:
            self.assertLessEqual(edge.error, edge.uncertainty + ROUNDING, edge)


class Stamps(OtherClockTest):
    def test_of_a_clock_that_is_ahead_or_has_just_begun(self):
        for number, offset in enumerate((300 * 24 * HOUR, NS - time.monotonic_ns())):
            with self.subTest(offset=offset):
                self.expect_true(Cell(self, f"{self.name}_{number}", offset=offset).edges(10))

    def test_of_a_network_that_is_slow_one_way(self):
        for way in ("to_node", "to_driver"):
            with self.subTest(way=way):
                edges = Cell(self, f"{self.name}_{way}", **{way: lambda: ASYMMETRIC}).edges(10)
                self.expect_true(edges)
                for edge in edges:
                    self.assertGreaterEqual(edge.uncertainty, ASYMMETRIC / 2, "which way it was slow nobody can know")

    def test_of_a_network_that_is_slow_now_and_then(self):
        chance = random.Random(1)

        def delay():
            return chance.uniform(0.02, 0.1) if chance.random() < 0.3 else chance.uniform(0, 0.001)

        cell = Cell(self, self.name, offset=7 * HOUR, drift=DRIFT / 2, to_node=delay, to_driver=delay)
        self.expect_true(cell.edges(60))

    def test_after_a_jump_they_begin_anew(self):
        cell = Cell(self, self.name)
        self.expect_true(cell.edges(3))
        for jump in (HOUR, -HOUR):
            cell.clock.offset += jump
            cell.edge()  # this exchange may have begun before the jump
            self.expect_true(cell.edges(3))
        cell.driver.wait_for("clock or this machine's has jumped")


class Schedules(OtherClockTest):
    """An output at a time, through all of it."""

    def test_the_time_that_is_told_is_when_it_was_driven(self):
        cell = Cell(self, self.name, offset=7 * HOUR, drift=DRIFT, to_node=lambda: 0.002, to_driver=lambda: 0.01)
        scheduled = self.topic(f"/{self.name}/scheduled", Scheduled)
        schedule = self.service(f"/{self.name}/schedule", Schedule)

        def in_seconds(ahead):
            return schedule("lamp", "true", ros_time(time.time() + ahead), ros_duration(0))

        def is_known():
            answer = in_seconds(3000)
            cell.set_lamp(False)
            return answer.message == "accepted: the device does it"

        wait_until(is_known, "the node to be known")
        ahead, before = 0.5, time.time()
        while not (answer := in_seconds(ahead)).success:  # on a busy machine the call may come after the time
            ahead, before = 2 * ahead, time.time()
        before, after = self.driven(cell, before)
        outcome = scheduled.wait_for(lambda message: message.number == answer.number)
        self.assertEqual((outcome.result, outcome.reason), (Scheduled.DONE, ""))
        stamp = seconds(outcome.header.stamp)
        self.assertLessEqual(before, stamp + outcome.uncertainty + ROUNDING)
        self.assertGreaterEqual(after, stamp - outcome.uncertainty - ROUNDING)
        self.assertLess(abs(stamp - outcome.lateness - seconds(outcome.due)), ROUNDING)

    @staticmethod
    def driven(cell, before):
        """The last time at which the lamp was seen off, of `before` and those since, and the first at which it was seen on."""
        while True:
            asked = time.time()
            if cell.client.read_coils(4, 1).bits[0]:
                return before, time.time()
            before = asked


if __name__ == "__main__":
    testing.main()
