# SPDX-License-Identifier: Apache-2.0
"""Writes at a time: by the node's timer where a node can, otherwise by the driver's. Nothing here says how late they may be,
but none is early."""
import time
import unittest

from coupler_driver.msg import Scheduled
from coupler_driver.srv import CancelScheduled, ListScheduled, Schedule, Write
from std_msgs.msg import Bool

from support import process, testing
from support.device import FAILURE, Device, Refuse
from support.patience import NO_TIMEOUT, wait_until
from support.peer import Peer
from support.ports import free_port
from support.times import ROUNDING, ros_duration, ros_time, seconds

MAP = """
name: {name}
address: 127.0.0.1
rate: 50
timeout: {timeout}s
mapping:
  coils: {{lamp: 4, horn: {{address: 5, access: write}}}}
  input_registers: {{pressure: {{address: 40, type: INT}}}}
  holding_registers:
    speed: {{address: 2, type: UINT, max: 1000}}
    part: {{address: 9, type: BOOL, bit: 3}}
"""
SOON, LATER, NEVER = 0.3, 0.6, 3000  # seconds
BY_DRIVER, BY_NODE = "accepted: the driver does it", "accepted: the device does it"


class ScheduleTest(testing.RosTest):
    at_once = True

    def write_map(self, head=""):
        return process.write_map(head + MAP.format(name=self.name, timeout=NO_TIMEOUT))

    def start(self, port, path, by=BY_DRIVER):
        self.program = self.driver(f"_map:={path}", f"_port:={port}")
        self.program.wait_for("connected")
        self.scheduled = self.topic(f"/{self.name}/scheduled", Scheduled)
        self.call = self.service(f"/{self.name}/schedule", Schedule)
        self.write = self.service(f"/{self.name}/write", Write)
        self.settles(by)

    def settles(self, by):
        """Until it is known who does it, and what is published is heard."""
        def is_known():
            answer = self.schedule("horn", "false", NEVER)
            self.write("horn", "false")
            return answer.message == by and self.scheduled.values

        wait_until(is_known, f"'{by}'")

    def schedule(self, point, value, in_seconds=SOON, how_long=0):
        self.at = ros_time(time.time() + in_seconds)
        return self.call(point, value, self.at, ros_duration(how_long))

    def accepted(self, by, point, value, in_seconds=SOON, how_long=0):
        """Its number. On a busy machine the call may come after the time."""
        answer = self.schedule(point, value, in_seconds, how_long)
        while " s past" in answer.message or "exception 03" in answer.message:
            in_seconds *= 2
            answer = self.schedule(point, value, in_seconds, how_long)
        self.assertEqual((answer.success, answer.message), (True, by))
        return answer.number

    def same_time_in_order(self, by):
        """What is asked for at the same time is done in the order in which it was asked for, each time."""
        pairs = []
        for _ in range(10):
            first = self.accepted(by, "lamp", "true", LATER)
            answer = self.call("lamp", "false", self.at, ros_duration(0))
            if answer.success:  # not too late on a busy machine
                pairs.append((first, answer.number))
        for first, second in pairs:
            self.done(second)
            told = [message.number for message in self.scheduled.values]
            self.assertLess(told.index(first), told.index(second))

    def listed_and_cancelled(self, by):
        listed = self.service(f"/{self.name}/list_scheduled", ListScheduled)
        cancel = self.service(f"/{self.name}/cancel_scheduled", CancelScheduled)
        speed = self.accepted(by, "speed", "40", NEVER)
        lamp = self.accepted(by, "lamp", "true", NEVER / 2)
        due = seconds(self.at)
        writes = [write for write in listed().writes if write.point != "horn"]
        self.assertEqual([(write.number, write.point, write.value) for write in writes],
                         [(lamp, "lamp", "true"), (speed, "speed", "40")])
        self.assertEqual((seconds(writes[0].due), {write.by_device for write in writes}), (due, {by == BY_NODE}))
        answer = cancel(lamp)
        self.assertEqual((answer.success, answer.message), (True, "cancelled"))
        self.cancelled(lamp, "its client cancelled it")
        self.assertEqual([write.number for write in listed().writes if write.point != "horn"], [speed])
        again = cancel(lamp)
        self.assertFalse(again.success)
        self.assertIn(f"no write {lamp} waits", again.message)
        self.assertTrue(self.write("lamp", "true").success)
        self.assertTrue(cancel(speed).success)
        self.assertEqual(list(listed().writes), [])

    def outcome(self, number):
        return self.scheduled.wait_for(lambda message: message.number == number)

    def done(self, number):
        outcome = self.outcome(number)
        self.assertEqual((outcome.result, outcome.reason), (Scheduled.DONE, ""))
        return outcome

    def cancelled(self, number, reason):
        outcome = self.outcome(number)
        self.assertEqual((outcome.result, outcome.reason), (Scheduled.CANCELLED, reason))

    def refused(self, text, point, value, in_seconds=NEVER, how_long=0):
        """For what the text says, and not since the call came after the time."""
        answer = self.schedule(point, value, in_seconds, how_long)
        self.assertEqual((answer.success, answer.number), (False, 0))
        self.assertIn(text, answer.message)


class ByTheDriver(ScheduleTest):
    """A foreign coupler."""

    def setUp(self):
        self.peer = Peer().start()
        self.addCleanup(self.peer.stop)
        self.start(self.peer.port, self.write_map())

    def get(self, table, address):
        return int(self.peer.get(table, address)[0])

    def test_it_is_never_early(self):
        for point, value in (("lamp", "true"), ("speed", "7"), ("part", "true"), ("horn", "true")):
            outcome = self.done(self.accepted(BY_DRIVER, point, value))
            self.assertEqual(outcome.point, point)
            self.assertGreaterEqual(outcome.lateness, 0)
            self.assertGreaterEqual(seconds(outcome.header.stamp), seconds(outcome.due) - outcome.uncertainty - ROUNDING)
        self.assertEqual((self.get("coils", 4), self.get("holding_registers", 2), self.get("holding_registers", 9)), (1, 7, 8))

    def test_the_same_time_is_in_the_order_of_the_calls(self):
        self.same_time_in_order(BY_DRIVER)

    def test_those_that_wait_are_listed_and_one_is_cancelled(self):
        self.listed_and_cancelled(BY_DRIVER)

    def test_the_due_time_is_told_as_it_was_asked_for(self):
        number = self.accepted(BY_DRIVER, "lamp", "true")
        self.assertEqual(seconds(self.done(number).due), seconds(self.at))

    def test_another_write_cancels_it(self):
        number = self.accepted(BY_DRIVER, "speed", "40", NEVER)
        self.assertTrue(self.write("lamp", "true").success)
        self.assertTrue(self.write("speed", "41").success)
        self.cancelled(number, "another write to the same point")
        self.assertEqual(self.get("holding_registers", 2), 41)

    def test_the_end_of_the_connection_cancels_it(self):
        number = self.accepted(BY_DRIVER, "lamp", "true", NEVER)
        self.peer.stop()
        self.cancelled(number, "the connection ended")
        self.refused("ask again when the device is back", "lamp", "true")

    def test_what_is_not_possible_is_refused_with_what_is(self):
        self.refused("there is no point 'nothing'", "nothing", "1")
        self.refused("pressure cannot be written", "pressure", "1")
        self.refused("at most 1000", "speed", "70000")
        self.refused("at most 1000", "speed", "1001")
        self.refused("s in the past; send a future time", "speed", "1", -NEVER)
        self.refused("an hour (3600 s) is the most", "speed", "1", 3 * NEVER)
        self.refused("up to an hour (3600 s)", "speed", "1", how_long=3 * NEVER)
        self.refused("Schedule a second write of horn", "horn", "true", how_long=SOON)

    def test_there_are_64_at_most(self):
        numbers = {self.accepted(BY_DRIVER, "speed", "1", NEVER) for _ in range(64)}
        self.assertEqual(len(numbers), 64)
        self.refused("64 scheduled writes wait", "speed", "1", NEVER)


class Failures(ScheduleTest):
    def setUp(self):
        self.device = Device().start()
        self.addCleanup(self.device.stop)

    def test_an_exception_is_a_failure(self):
        def answer(request):
            if request.function == 5:
                raise Refuse(FAILURE)
            return self.device.serve(request)

        self.start(self.device.port, self.write_map())
        self.device.answer = answer
        outcome = self.outcome(self.accepted(BY_DRIVER, "lamp", "true"))
        self.assertEqual(outcome.result, Scheduled.FAILED)
        self.assertIn("exception 04", outcome.reason)

    def test_what_the_device_did_not_answer_is_unknown(self):
        def answer(request):
            if request.function == 5:
                request.connection.close()
                raise OSError
            return self.device.serve(request)

        self.start(self.device.port, self.write_map())
        self.device.answer = answer
        outcome = self.outcome(self.accepted(BY_DRIVER, "lamp", "true"))
        self.assertEqual(outcome.result, Scheduled.UNKNOWN)
        self.assertIn("lost: ", outcome.reason)


@unittest.skipUnless(process.has_node(), "coupler-node was not built")
class ByTheNode(ScheduleTest):
    def begin(self, by=BY_NODE, head=""):
        path = self.write_map(head)
        self.node = process.Node(path, port=free_port())
        self.addCleanup(lambda: self.node.end())  # pylint: disable=unnecessary-lambda
        self.start(self.node.port, path, by)
        self.lamp = self.topic(f"/{self.name}/lamp", Bool)
        self.lamp.becomes(False)

    def test_those_that_wait_are_listed_and_one_is_cancelled(self):
        self.begin()
        self.listed_and_cancelled(BY_NODE)

    def test_it_is_driven_and_told(self):
        self.begin()
        numbers = self.accepted(BY_NODE, "speed", "7", LATER), self.accepted(BY_NODE, "lamp", "true", 2 * LATER)
        self.assertEqual([self.done(number).point for number in numbers], ["speed", "lamp"])
        self.lamp.becomes(True)
        told = [message for message in self.scheduled.values if message.number in numbers]
        self.assertEqual(told, sorted(told, key=lambda message: seconds(message.due)))

    def test_the_same_time_is_in_the_order_of_the_calls(self):
        self.begin()
        self.same_time_in_order(BY_NODE)

    def test_after_a_duration_the_value_from_before_is_there_again(self):
        self.begin()
        self.done(self.accepted(BY_NODE, "lamp", "true", how_long=LATER))
        self.lamp.wait_for(lambda on: on)
        self.lamp.becomes(False)

    def test_a_part_of_a_register_is_the_drivers(self):
        self.begin()
        self.done(self.accepted(BY_DRIVER, "part", "true"))

    def test_with_changes_off_it_is_the_drivers(self):
        self.begin(BY_DRIVER, "changes: off\n")
        self.done(self.accepted(BY_DRIVER, "lamp", "true"))
        self.lamp.becomes(True)

    def test_another_write_cancels_it(self):
        self.begin()
        number = self.accepted(BY_NODE, "lamp", "true", NEVER)
        self.assertTrue(self.write("lamp", "false").success)
        self.cancelled(number, "another write to the same point")

    def test_a_new_map_cancels_it(self):
        self.begin()
        number = self.accepted(BY_NODE, "lamp", "true", NEVER)
        self.node.reload()
        self.cancelled(number, "the device read a new map, lost or found a chip, or ended")
        self.settles(BY_NODE)
        self.done(self.accepted(BY_NODE, "lamp", "true"))

    def test_the_end_of_the_node_is_an_outcome(self):
        """Heard of in its last answer, unless a request comes too late for that."""
        self.begin()
        number = self.accepted(BY_NODE, "lamp", "true", NEVER)
        self.node.end()
        outcome = self.outcome(number)
        self.assertIn((outcome.result, outcome.reason),
                      ((Scheduled.CANCELLED, "the device read a new map, lost or found a chip, or ended"),
                       (Scheduled.UNKNOWN, "the connection ended before the outcome was reported")))


if __name__ == "__main__":
    testing.main()
