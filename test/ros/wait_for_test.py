# SPDX-License-Identifier: Apache-2.0
"""The action wait_for, used by the action clients of ROS."""
import time
import unittest

from std_msgs.msg import Bool

from support import process, testing
from support.actions import ABORTED, CANCELED, SUCCEEDED, WaitForClient, topics_below
from support.device import Device
from support.patience import NO_TIMEOUT, wait_until
from support.ports import free_port
from support.times import seconds

MAP = """
name: {name}
address: 127.0.0.1
rate: 50
timeout: {timeout}s
{head}
mapping:
  coils: {{lamp: 4}}
  discrete_inputs: {{lit: 7}}
  input_registers: {{level: {{address: 2, type: INT, scale: {{gain: 0.1}}}}}}
  holding_registers:
    speed: {{address: 2, type: UINT}}
    mode: {{address: 3, type: UINT, values: {{0: idle, 2: running}}}}
    command: {{address: 9, type: UINT, access: write}}
sim:
  - {{from: lamp, to: lit}}
"""


class WaitForTest(testing.RosTest):
    at_once = True

    def start(self, port, head="wait_for: true", timeout=NO_TIMEOUT):
        self.path = process.write_map(MAP.format(name=self.name, head=head, timeout=timeout))
        self.program = self.driver(f"_map:={self.path}", f"_port:={port}")
        self.program.wait_for("connected")

    def client(self):
        return WaitForClient(f"/{self.name}/wait_for")

    def assert_ended(self, sent, how, reason=""):
        ended, result = sent.result()
        self.assertEqual((ended, result.reason), (how, reason))
        self.assertEqual(result.met, how == SUCCEEDED)
        return result


class OfADevice(WaitForTest):
    """A foreign device, which is polled."""

    def start(self, *arguments, **options):
        self.device = Device().start()
        self.addCleanup(self.device.stop)
        self.holding, self.inputs = self.device.tables["holding_registers"], self.device.tables["input_registers"]
        super().start(self.device.port, *arguments, **options)

    def test_a_value_that_comes_is_waited_for(self):
        self.start()
        sent = self.client().send("speed", ">=", "500")
        self.assertFalse(sent.is_over)
        before = time.time()
        self.holding[2] = 700
        result = self.assert_ended(sent, SUCCEEDED)
        self.assertEqual(result.value, "700")
        self.assertGreater(seconds(result.stamp) + result.uncertainty, before)
        self.assertLess(seconds(result.stamp) - result.uncertainty, time.time())

    def test_what_holds_already_is_met_by_the_next_reading(self):
        self.start()
        self.inputs[2] = 217
        self.assertEqual(self.assert_ended(self.client().send("level", "==", "21.7"), SUCCEEDED).value, "21.7")

    def test_a_point_that_nobody_else_reads_is_read_meanwhile(self):
        self.start("wait_for: true\npoll: subscribed")
        self.holding[3] = 2
        self.assertEqual(self.assert_ended(self.client().send("mode", "==", "running"), SUCCEEDED).value, "running")

    def test_many_wait_at_a_time_and_each_gets_its_own_result(self):
        self.start()
        client = self.client()
        sent = [client.send("speed", "==", str(value)) for value in (5, 6, 7)]
        for value, goal in reversed(list(zip((5, 6, 7), sent))):
            self.holding[2] = value
            self.assertEqual(self.assert_ended(goal, SUCCEEDED).value, str(value))

    def test_a_goal_that_is_canceled_ends_so(self):
        self.start()
        client = self.client()
        stays, goes = client.send("speed", "==", "5"), client.send("speed", "==", "5")
        goes.cancel()
        self.assert_ended(goes, CANCELED, "canceled")
        self.holding[2] = 5
        self.assert_ended(stays, SUCCEEDED)

    def test_a_time_that_has_passed_ends_it_with_the_value(self):
        self.start()
        result = self.assert_ended(self.client().send("speed", "==", "5", timeout=0.3), ABORTED, "timed out; speed is 0")
        self.assertEqual(result.value, "0")

    def test_what_cannot_be_waited_for_is_answered_with_the_remedy(self):
        self.start()
        client = self.client()
        for arguments, reason in (
                (("sped", "==", "5"), f"there is no point 'sped' in the map of {self.name}; did you mean 'speed'?"),
                (("speed", "=", "5"), "'=' is no condition; send ==, !=, <, <=, >, >=, rises, falls or changes"),
                (("lit", "<", "1"), "'<' does not go with lit, which is a bit; send ==, !=, rises, falls or changes"),
                (("mode", "==", "runing"), "'runing' is not one of its values; send idle (0) or running (2)"),
                (("command", "==", "1"), "command is never read: it is write-only")):
            self.assert_ended(client.send(*arguments), ABORTED, reason)
        self.assert_ended(client.send("speed", "==", "5", timeout=0), ABORTED,
                          "a timeout of 0 s; send one above 0, and at most a day (86400 s)")
        self.assert_ended(client.send("speed", "==", "5", timeout=1, for_at_least=2), ABORTED,
                          "for_at_least is 2 s; send 0 to 1 s, the timeout")

    def test_a_device_that_goes_offline_ends_it(self):
        self.start(timeout=1)
        sent = self.client().send("speed", "==", "5")
        self.device.stop()
        self.assert_ended(sent, ABORTED, "the device of speed is offline")

    def test_the_end_of_the_driver_ends_it(self):
        self.start()
        sent = self.client().send("speed", "==", "5")
        self.program.interrupt()
        self.assert_ended(sent, ABORTED, "the driver ends")

    def test_without_the_key_there_is_no_action(self):
        self.start(head="")
        wait_until(lambda: topics_below(f"/{self.name}/status"), "the topics of the driver")
        self.assertEqual(topics_below(f"/{self.name}/wait_for"), [])


@unittest.skipUnless(process.has_node(), "coupler-node was not built")
class OfANode(WaitForTest):
    """A node, which announces its changes."""

    def start(self, *arguments, **options):
        path = process.write_map(MAP.format(name=self.name, head="wait_for: true", timeout=NO_TIMEOUT))
        self.node = process.Node(path, port=free_port())
        self.addCleanup(self.node.end)
        super().start(self.node.port, *arguments, **options)
        self.write = self.publisher(f"/{self.name}/lamp/write", Bool)
        self.lit = self.topic(f"/{self.name}/lit", Bool)
        self.lit.becomes(False)

    def test_an_edge_is_waited_for(self):
        self.start()
        client = self.client()
        rises, falls = client.send("lit", "rises"), client.send("lit", "falls")
        self.write.publish(True)
        risen = self.assert_ended(rises, SUCCEEDED)
        self.assertFalse(falls.is_over)
        self.write.publish(False)
        fallen = self.assert_ended(falls, SUCCEEDED)
        self.assertEqual((risen.value, fallen.value), ("true", "false"))
        self.assertGreater(seconds(fallen.stamp), seconds(risen.stamp))

    def test_an_edge_before_the_goal_counts_if_it_was_since_the_time_that_is_asked_for(self):
        self.start()
        client = self.client()
        before = time.time()
        for level in (True, False):
            self.write.publish(level)
            self.lit.becomes(level)
        after = time.time()
        risen = self.assert_ended(client.send("lit", "rises", since=before), SUCCEEDED)
        self.assertTrue(before <= seconds(risen.stamp) + risen.uncertainty <= after + risen.uncertainty)
        self.assert_ended(client.send("lit", "rises", since=after + 0.001, timeout=0.3), ABORTED, "timed out; lit is false")

    def test_a_level_must_hold_for_as_long_as_is_asked_for(self):
        self.start()
        sent = self.client().send("lit", "==", "true", for_at_least=0.3)
        self.write.publish(True)
        self.lit.becomes(True)
        self.write.publish(False)
        self.lit.becomes(False)
        again = time.time()
        self.write.publish(True)
        result = self.assert_ended(sent, SUCCEEDED)
        self.assertGreater(time.time(), again + 0.3)
        self.assertGreater(seconds(result.stamp) + result.uncertainty, again)


if __name__ == "__main__":
    testing.main()
