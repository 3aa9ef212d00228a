# SPDX-License-Identifier: Apache-2.0
"""The client in Python waits for changes: of a node, which tells them, and of another device, which is polled."""
import threading
import time
import unittest

import made
from press import OfADevice

MAP = """\
name: cell
mapping:
  coils: {lamp: 0, row: {address: 4, count: 3}, bell: {address: 9, pulse: 20ms}}
  holding_registers: {speed: {address: 0, type: UINT, scale: 0.1}, other: {address: 1, type: INT}}
"""
LONG = 3600.0  # seconds: no poll comes in time


class OfANode(OfADevice):
    def setUp(self):
        super().setUp()
        self.running = self.node(MAP)
        self.running.__enter__()
        self.addCleanup(self.running.__exit__, None, None, None)
        self.cell = self.at_the_node()

    def at_the_node(self, text=MAP):
        cell = self.press(text)
        cell.port = self.running.port
        cell.connect()
        return cell

    def test_at_first_each_point_has_its_value(self):
        self.cell.speed.write(72.6)
        changes = self.cell.changes()
        first = {change.point.spec.name: change.value for change in (next(changes) for _ in range(5))}
        self.assertEqual(first, self.cell.read_all())
        self.assertEqual(first["speed"], 72.6)

    def test_a_node_tells_bits_in_their_order_with_their_times(self):
        changes = self.cell.changes(self.cell.lamp, self.cell.row, period=LONG)
        self.assertEqual([next(changes).value, next(changes).value], [False, [False] * 3])
        before = time.time()
        self.cell.lamp.write(True)
        self.cell.lamp.write(False)
        self.cell.row.write([True, False, True])
        after = time.time()
        time.sleep(0.2)  # it is told late, and the times are those of the writes
        asked = time.time()
        told = [next(changes) for _ in range(4)]
        latest = after + time.time() - asked
        self.assertEqual([(change.point, change.value) for change in told],
                         [(self.cell.lamp, True), (self.cell.lamp, False), (self.cell.row, [True, False, False]),
                          (self.cell.row, [True, False, True])])
        for change in told:
            self.assertTrue(before - 0.005 <= change.time <= latest + 0.005, (before, change.time, latest))

    def test_a_pulse_between_two_polls_is_told(self):
        changes = self.cell.changes(self.cell.bell, period=LONG)
        self.assertIs(next(changes).value, False)
        self.cell.bell.write(True)
        while self.cell.bell.read():
            time.sleep(0.001)  # it ends by itself; one answer tells its begin and its end then
        pulse = [next(changes), next(changes)]
        self.assertEqual([change.value for change in pulse], [True, False])
        self.assertGreaterEqual(pulse[1].time - pulse[0].time, 0.019)

    def test_registers_are_polled_meanwhile(self):
        changes = self.cell.changes(self.cell.lamp, self.cell.speed, period=0.02)
        self.assertEqual([next(changes).value, next(changes).value], [False, 0.0])
        self.cell.speed.write(5)
        self.assertEqual(next(changes)[:2], (self.cell.speed, 5.0))
        self.cell.lamp.write(True)
        self.assertEqual(next(changes)[:2], (self.cell.lamp, True))

    def test_other_threads_use_the_client_while_one_waits(self):
        changes = self.cell.changes(self.cell.lamp, period=LONG)
        next(changes)
        found = []
        thread = threading.Thread(target=lambda: found.extend(changes))
        thread.start()
        for level in (True, False, True):
            self.cell.lamp.write(level)
        deadline = time.monotonic() + made.PATIENCE
        while len(found) < 3 and time.monotonic() < deadline:
            time.sleep(0.01)
        changes.close()
        thread.join(made.PATIENCE)
        self.assertFalse(thread.is_alive())
        self.assertEqual([change.value for change in found], [True, False, True])

    def test_after_lost_changes_everything_is_read(self):
        changes = self.cell.changes(period=LONG)
        for _ in range(5):
            next(changes)
        for i in range(1100):  # a node keeps 1024
            self.cell.lamp.write(i % 2 == 0)
        self.cell.other.write(7)
        self.cell.row.write([True] * 3)
        self.assertEqual({(change.point.spec.name, str(change.value)) for change in (next(changes), next(changes))},
                         {("row", str([True] * 3)), ("other", "7")})

    def test_after_an_error_it_goes_on_with_what_is_new(self):
        changes = self.cell.changes(self.cell.lamp, period=LONG)
        next(changes)
        self.running.stop()
        with self.assertRaises(self.module.CouplerError):
            next(changes)
        with self.node(MAP) as another:
            self.cell.port = another.port
            self.cell.disconnect()
            self.cell.connect()
            self.cell.lamp.write(True)
            self.assertEqual(next(changes)[:2], (self.cell.lamp, True))

    def test_a_reply_that_is_none_ends_the_connection(self):
        for reply, kind in ((b"\xc1\x03", "ExceptionReply"), (b"\x41\x01", "Lost"), (b"\x41" + bytes(33) + b"\x01", "Lost")):
            changes = self.cell.changes(self.cell.lamp, period=LONG)
            next(changes)
            changes._exchange = lambda request, wait, reply=reply: reply
            self.raises(kind, next, changes)
            self.assertIsNone(changes._socket)

    def test_a_map_may_forbid_to_wait(self):
        cell = self.at_the_node(MAP.replace("mapping:", "changes: off\nmapping:"))
        changes = cell.changes(cell.lamp, period=0.02)
        next(changes)
        cell.lamp.write(True)
        self.assertEqual(next(changes)[:2], (cell.lamp, True))
        self.assertIsNone(changes._socket)


class OfAnotherDevice(OfADevice):
    def test_everything_is_polled(self):
        press = self.connected()
        changes = press.changes(press.door, press.flag, period=0.02)
        self.assertEqual([next(changes).value, next(changes).value], [False, False])
        self.device.tables["discrete_inputs"][0] = 1
        self.assertEqual(next(changes)[:2], (press.door, True))
        self.assertEqual({function for function, _, _ in self.device.requests}, {2, 3, 4})
        changes.close()
        self.assertEqual(list(changes), [])

    def test_a_point_that_cannot_be_read_has_no_changes(self):
        press = self.connected()
        self.assertEqual(len(press.changes()._points), len(press.points) - 1)
        with self.assertRaisesRegex(ValueError, "horn cannot be read"):
            press.changes(press.horn)


if __name__ == "__main__":
    unittest.main(warnings="ignore")
