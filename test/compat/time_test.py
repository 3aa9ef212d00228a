# SPDX-License-Identifier: Apache-2.0
"""Today's driver and tools with a node that tells no changes and schedules nothing: what there is of time without it."""
import socket
import struct
import time

from coupler_driver.msg import BoolStamped, Scheduled
from coupler_driver.srv import Schedule, Write
from std_msgs.msg import Bool

from support import process, testing
from support.patience import PATIENCE
from support.ports import free_port
from support.times import ROUNDING, ros_duration, ros_time, seconds

MAP = """
name: cell
address: 127.0.0.1
timeout: 60
rate: 50
mapping:
  coils: {lamp: {address: 4STAMPED}}
"""
NEVER = 3000  # seconds
ILLEGAL_FUNCTION = 1


class Time(testing.RosTest):
    def setUp(self):
        self.node = process.Node(process.write_map(MAP.replace("STAMPED", "")), port=free_port())
        self.addCleanup(self.node.end)
        own_map = process.write_map(MAP.replace("STAMPED", ", stamped: true"))
        self.driver(f"_map:={own_map}", f"_port:={self.node.port}").wait_for("connected")
        self.lamp = self.topic("/cell/lamp", Bool)
        self.lamp.becomes(False)

    def schedule(self, value, in_seconds):
        """Its number. On a busy machine the call may come after the time."""
        call = self.service("/cell/schedule", Schedule)
        while True:
            answer = call("lamp", value, ros_time(time.time() + in_seconds), ros_duration(0))
            if " s past" not in answer.message:
                self.assertEqual((answer.success, answer.message), (True, "accepted: the driver does it"))
                return answer.number
            in_seconds *= 2

    def test_the_node_is_older_than_both_functions(self):
        with socket.create_connection(("127.0.0.1", self.node.port), PATIENCE) as client, client.makefile("rb") as answers:
            for function in (65, 66):
                client.sendall(struct.pack(">HHHBBB", 1, 0, 3, 1, function, 1))
                self.assertEqual(answers.read(9)[7:], bytes([0x80 | function, ILLEGAL_FUNCTION]))

    def test_a_polled_value_has_a_stamp(self):
        stamped = self.topic("/cell/lamp/stamped", BoolStamped)
        stamped.wait_for(lambda message: not message.value)
        before = time.time()
        self.publisher("/cell/lamp/write", Bool).publish(True)
        message = stamped.wait_for(lambda message: message.value)
        self.assertLessEqual(before, seconds(message.header.stamp) + message.uncertainty + ROUNDING)
        self.assertLessEqual(seconds(message.header.stamp) - message.uncertainty - ROUNDING, time.time())

    def test_an_output_is_scheduled_by_the_driver(self):
        scheduled = self.topic("/cell/scheduled", Scheduled)
        number = self.schedule("true", 0.3)
        outcome = scheduled.wait_for(lambda message: message.number == number)
        self.assertEqual((outcome.result, outcome.reason), (Scheduled.DONE, ""))
        self.lamp.becomes(True)

    def test_a_write_cancels_it(self):
        scheduled = self.topic("/cell/scheduled", Scheduled)
        number = self.schedule("true", NEVER)
        self.assertTrue(self.service("/cell/write", Write)("lamp", "false").success)
        outcome = scheduled.wait_for(lambda message: message.number == number)
        self.assertEqual((outcome.result, outcome.reason), (Scheduled.CANCELLED, "another write to the same point"))

    def test_dump_looks_again_and_again(self):
        watch = process.Process("coupler", "dump", f"tcp://127.0.0.1:{self.node.port}", "--watch", "0.1")
        self.addCleanup(watch.interrupt)
        watch.wait_for(" lamp false")
        self.publisher("/cell/lamp/write", Bool).publish(True)
        watch.wait_for(" lamp true")


testing.main()
