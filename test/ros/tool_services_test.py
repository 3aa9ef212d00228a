# SPDX-License-Identifier: Apache-2.0
"""Tools: the services open and close, their state, and who may write their outputs."""
import unittest

from coupler_driver.msg import ToolState
from coupler_driver.srv import Schedule, Write
from std_msgs.msg import Bool
from std_srvs.srv import SetBool, Trigger

from support import process, testing
from support.ports import free_port
from support.times import ros_time
from support.tools import CLOSE, CLOSED, OPEN, OPENED, PART, VACUUM, DeviceToolsTest, ToolsTest


class OfADevice(DeviceToolsTest):
    def test_close_answers_when_the_tool_is_closed(self):
        self.start()
        self.coils[OPEN] = 1
        call = self.call("clamp/close")
        self.becomes(CLOSE, 1)
        self.assertEqual(self.coils[OPEN], 0)
        self.assert_becomes("clamp", ToolState.CLOSING)
        self.inputs[OPENED] = 0
        self.assertFalse(call.done())
        self.inputs[CLOSED] = 1
        self.assert_answers(call, True, "closed after [0-9]+ ms")
        self.assertRegex(self.assert_becomes("clamp", ToolState.CLOSED).reason, "closed after [0-9]+ ms")

    def test_the_other_output_is_off_before_one_goes_on(self):
        self.start()
        self.call("clamp/close")
        self.becomes(CLOSE, 1)
        self.call("clamp/open")
        self.becomes(OPEN, 1)
        written = [(request.address, request.data[3] != 0) for request in self.device.seen(5)]
        self.assertEqual(written, [(OPEN, False), (CLOSE, True), (CLOSE, False), (OPEN, True)])

    def test_a_part_that_is_held_is_told(self):
        self.start()
        call = self.call("clamp/close")
        self.becomes(CLOSE, 1)
        self.inputs[OPENED], self.inputs[PART] = 0, 1
        self.assert_answers(call, True, "holds a part after [0-9]+ ms")
        self.assert_becomes("clamp", ToolState.HOLDING)

    def test_what_does_not_move_is_stuck(self):
        self.start(patience=0.2)
        self.assert_answers(self.call("clamp/close"), False,
                            r"stuck: sensor_open is still on after [0-9]+ ms \(valve_close is on\)")
        self.assert_becomes("clamp", ToolState.STUCK)

    def test_a_newer_call_ends_the_one_before(self):
        self.start()
        close = self.call("clamp/close")
        self.becomes(CLOSE, 1)
        opened = self.call("clamp/open")
        self.assert_answers(close, False, "replaced by a newer goal after [0-9]+ ms")
        self.assert_answers(opened, True, "open after [0-9]+ ms")

    def test_a_newer_call_of_the_same_service_ends_the_one_before(self):
        self.start()
        first = self.call("clamp/close")
        self.becomes(CLOSE, 1)
        second = self.call("clamp/close")
        self.assert_answers(first, False, "replaced by a newer goal after [0-9]+ ms")
        opened = self.call("clamp/open")
        self.assert_answers(second, False, "replaced by a newer goal after [0-9]+ ms")
        self.assert_answers(opened, True, "open after [0-9]+ ms")

    def test_a_tool_without_inputs_is_there_after_its_travel_time(self):
        self.start()
        self.assert_becomes("cup", ToolState.UNKNOWN)
        self.assert_answers(self.call("cup/close"), True, "closed after [0-9]+ ms, its travel time")
        self.assertEqual(self.coils[VACUUM], 1)
        self.assert_answers(self.call("cup/open"), True, "open after [0-9]+ ms, its travel time")
        self.assertEqual(self.coils[VACUUM], 0)

    def test_an_output_that_the_device_rejects_ends_the_call(self):
        self.start()
        self.reject_writes_of(OPEN)
        self.assert_answers(self.call("clamp/close"), False, "valve_open could not be switched off: exception 04 .*")
        self.assertEqual(self.coils[CLOSE], 0)

    def test_a_write_by_another_client_ends_the_call(self):
        self.start()
        call = self.call("clamp/close")
        self.becomes(CLOSE, 1)
        self.coils[CLOSE] = 0
        self.assert_answers(call, False, "valve_close was switched off by something else after [0-9]+ ms")

    def test_a_lost_connection_ends_the_call_and_nothing_is_restored(self):
        self.start("on_reconnect: restore", timeout=1)
        call = self.call("clamp/close")
        self.becomes(CLOSE, 1)
        self.device.stop()
        self.assert_answers(call, False, "the connection to the device was lost after [0-9]+ ms")
        self.assert_becomes("clamp", ToolState.UNKNOWN)
        self.assert_answers(self.call("clamp/close"), False, "valve_open could not be switched off: dropped: not connected")
        self.coils[CLOSE] = 0
        self.device.start()
        self.assert_becomes("clamp", ToolState.OPEN)
        self.assertTrue(self.service(f"/{self.name}/write", Write)("lamp", "true").success)
        self.assertEqual(self.coils[CLOSE], 0)

    def test_safe_values_end_the_call(self):
        self.start()
        call = self.call("clamp/close")
        self.becomes(CLOSE, 1)
        self.assertTrue(self.service(f"/{self.name}/safe", Trigger)().success)
        self.assert_answers(call, False, "safe values were requested")
        self.assertEqual(self.coils[CLOSE], 0)

    def test_the_end_of_the_driver_ends_the_call(self):
        self.start()
        call = self.call("clamp/close")
        self.becomes(CLOSE, 1)
        self.program.interrupt()
        self.assert_answers(call, False, "the driver ends")

    def test_outputs_of_a_tool_are_not_written_by_themselves(self):
        self.start()
        why = (f"refused: it belongs to the tool clamp; call {self.name}/clamp/open or {self.name}/clamp/close, or set "
               "'direct: true' for the tool")
        self.assertEqual(self.service(f"/{self.name}/write", Write)("valve_close", "true").message, why)
        self.assertEqual(self.service(f"/{self.name}/valve_close/set", SetBool)(True).message, why)
        self.assertEqual(self.service(f"/{self.name}/schedule", Schedule)("valve_close", "true", ros_time(0), ros_time(0)).message,
                         why)
        self.publisher(f"/{self.name}/valve_close/write", Bool).publish(True)
        self.program.wait_for("refused a write to valve_close: it belongs to the tool clamp")
        self.assertEqual(self.coils[CLOSE], 0)

    def test_outputs_may_be_written_where_the_map_says_so(self):
        self.start(more=", direct: true")
        call = self.call("clamp/close")
        self.becomes(CLOSE, 1)
        self.assertTrue(self.service(f"/{self.name}/write", Write)("valve_open", "true").success)
        self.assert_answers(call, False, "valve_open was written directly")


@unittest.skipUnless(process.has_node(), "coupler-node was not built")
class OfANode(ToolsTest):
    """A node, which announces its changes."""

    SIM = "sim: [{from: valve_close, to: sensor_closed}, {from: valve_close, to: sensor_open, invert: true}]"

    def start(self, *arguments, **options):
        path = process.write_map(self.map_text(self.SIM))
        self.node = process.Node(path, port=free_port())
        self.addCleanup(self.node.end)
        super().start(self.node.port, self.SIM, *arguments, **options)

    def test_it_opens_and_closes(self):
        self.start()
        for _ in range(3):
            self.assert_answers(self.call("clamp/close"), True, "closed after [0-9]+ ms")
            self.assert_answers(self.call("clamp/open"), True, "open after [0-9]+ ms")
            self.assert_answers(self.call("clamp/open"), True, "open after [0-9]+ ms")

    def test_inputs_are_read_though_nobody_else_reads_them(self):
        self.start(more=", settle: 50ms")
        self.assert_answers(self.call("clamp/close"), True, "closed after [0-9]+ ms")


if __name__ == "__main__":
    testing.main()
