# SPDX-License-Identifier: Apache-2.0
"""The client in Python: connecting, comparing maps, and devices that do not do their part."""
import errno
import socket
import sys
import threading
import unittest
from unittest import mock

import made
from press import OfADevice

SHORT = 0.2  # seconds, where silence is to be noticed


class Pymodbus(OfADevice):
    def test_without_it_the_message_says_how_to_install_it(self):
        with mock.patch.dict(sys.modules, {"pymodbus.client": None}):
            self.assertRaisesRegex(ImportError, "pip install", self.press)


class Connection(OfADevice):
    def unverified(self, **options):
        """Connected without a request, so that a short timeout is nobody's who must answer."""
        press = self.press(**options)
        press.verify = self.module.Verify.OFF
        press.connect()
        return press

    def test_nothing_is_sent_before_connect(self):
        press = self.press()
        self.assertIn("connect()", self.raises("NotConnected", press.valve.write, True))
        self.assertFalse(press.online)
        self.assertEqual(self.device.connections, 0)

    def test_a_foreign_device_is_accepted(self):
        self.assertTrue(self.connected().online)
        self.device.unmapped = []  # and one that answers with something else
        self.assertTrue(self.connected().online)

    def test_no_device_is_an_error_that_names_the_place_and_has_the_number_of_the_reason(self):
        press = self.press()
        with socket.socket() as nobody_listens:
            nobody_listens.bind(("127.0.0.1", 0))
            press.port = nobody_listens.getsockname()[1]
            with self.assertRaises(ConnectionError) as caught:
                press.connect()
        error = caught.exception
        self.assertIs(type(error), self.module.NotConnected)
        self.assertIn(f"127.0.0.1 port {press.port}: Connection refused; check", str(error))
        self.assertEqual(error.errno, errno.ECONNREFUSED)
        self.assertIsInstance(error.__cause__, ConnectionRefusedError)

    def test_a_device_that_accepts_no_connection_in_time_is_timed_out(self):
        press = self.press()
        with mock.patch("socket.create_connection", side_effect=TimeoutError("timed out")):
            with self.assertRaises(self.module.NotConnected) as caught:
                press.connect()
        self.assertEqual(caught.exception.errno, errno.ETIMEDOUT)

    def test_what_has_no_number_has_its_cause(self):
        press = self.press()
        self.device.spoil = lambda pdu: bytes([pdu[0] | 0x80, 0x0B])
        with self.assertRaises(self.module.NotConnected) as caught:
            press.connect()
        self.assertIsNone(caught.exception.errno)
        self.assertIsInstance(caught.exception.__cause__, self.module.ExceptionReply)

    def test_verify_is_one_of_three_words(self):
        press = self.press(verify="require")
        self.assertIs(press.verify, self.module.Verify.REQUIRE)
        self.device.identify(press.fingerprint ^ 1)
        self.raises("OtherMap", press.connect)
        press.verify = "off"
        self.assertIs(press.verify, self.module.Verify.OFF)
        for wrong in ("REQUIRE", "", None, True, 0):
            with self.assertRaisesRegex(ValueError, "give 'require', 'warn' or 'off'") as caught:
                self.press(verify=wrong)
            self.assertNotIsInstance(caught.exception, self.module.CouplerError)
            with self.assertRaises(ValueError):
                press.verify = wrong
        self.assertEqual(press.verify.value, "off")

    def test_silence_ends_after_the_timeout(self):
        press = self.press(timeout=SHORT)
        self.device.spoil = lambda pdu: None
        text = self.raises("NotConnected", press.connect)
        for part in ("unit 7", "no reply within 200 ms", "verify=Verify.OFF"):
            self.assertIn(part, text)
        press.verify = self.module.Verify.OFF
        press.connect()
        self.assertEqual(self.raises("Lost", press.valve.read), "no reply within 200 ms")

    def test_a_late_answer_is_not_taken_for_the_next_one(self):
        press = self.unverified(timeout=SHORT)
        late, answered = threading.Event(), []

        def spoil(pdu):
            answer = self.device.answer(pdu)
            if not answered:
                answered.append(True)
                late.wait(made.PATIENCE)
            return answer
        self.device.tables["holding_registers"][6:8] = [11, 22]
        self.device.spoil = spoil
        self.raises("Lost", press.sure.read)
        late.set()
        press.timeout = made.PATIENCE
        self.assertEqual(press.batch.read(), 22)
        self.assertEqual(self.device.connections, 2)

    def test_an_answer_to_something_else_ends_the_connection(self):
        for spoiled in (b"\x04\x04\x00\x01\x00\x02", b"\x04\x02\x00\x01", b"\x03\x00", b"\x03\x02\x00", b"\x03",
                        b"\x63\x01\x02"):
            press = self.unverified(timeout=SHORT)
            self.device.spoil = lambda pdu, answer=spoiled: answer
            self.raises("Lost", press.total.read)
            self.assertFalse(press.online, spoiled)
            self.device.spoil = None

    def test_the_maps_are_compared_at_each_connect(self):
        press = self.press()
        self.device.identify(press.fingerprint)
        press.connect()
        self.device.identify(1)

        def close(_):
            raise ConnectionError
        self.device.spoil = close
        self.assertIn("connection lost", self.raises("Lost", press.valve.write, True))
        self.assertFalse(press.online)
        self.device.spoil = None
        self.device.requests.clear()
        self.raises("OtherMap", press.valve.write, True)
        self.assertEqual([request[0] for request in self.device.requests], [4])

    def test_a_unit_behind_a_gateway_that_comes_back_is_compared_again(self):
        press = self.connected()
        self.device.spoil = lambda pdu: bytes([pdu[0] | 0x80, 0x0B])
        self.assertIn("gateway target failed to respond", self.raises("ExceptionReply", press.valve.read))
        self.assertIn("unit 7", self.raises("NotConnected", press.valve.read))
        self.device.spoil = None
        self.device.identify(1)
        self.raises("OtherMap", press.valve.read)


class OfANode(OfADevice):
    TEXT = "name: cell\nmapping:\n  coils: {lamp: 0}\n  holding_registers: {speed: {address: 0, type: INT, max: 10}}\n"

    def at_node(self, text, node, **options):
        client = self.press(text, **options)
        client.port = node.port
        return client

    def test_a_node_of_this_map_is_accepted_and_comes_back(self):
        with self.node(self.TEXT) as node:
            cell = self.at_node(self.TEXT, node)
            with cell:
                cell.speed.write(7)
                self.assertEqual(cell.read_all(), {"lamp": False, "speed": 7})
                node.stop()
                self.raises("Lost", cell.speed.read)
                with self.node(self.TEXT) as another:
                    cell.port = another.port
                    self.assertEqual(cell.speed.read(), 0)
            self.assertFalse(cell.online)

    def test_a_node_of_another_map_is_refused_unless_the_user_accepts_it(self):
        other = self.TEXT.replace("type: INT", "type: UINT")
        with self.node(other) as node:
            cell = self.at_node(self.TEXT, node)
            text = self.raises("OtherMap", cell.connect)
            there = self.client(other)[1].fingerprint
            self.assertIn(f"fingerprint {cell.fingerprint:016x} here, {there:016x} in the device", text)
            self.assertIn("Verify.WARN", text)
            self.raises("OtherMap", cell.speed.write, 1)
            cell.verify = self.module.Verify.WARN
            with self.assertLogs("cell_client", "WARNING") as logged, cell:
                cell.speed.write(1)
            self.assertIn("the map differs", logged.output[0])
            cell.verify = self.module.Verify.OFF
            with self.assertNoLogs("cell_client", "WARNING"), cell:
                self.assertEqual(cell.speed.read(), 1)

    @made.LIVE
    def test_the_command_in_the_message_shows_the_differences(self):
        with self.node(self.TEXT.replace("lamp: 0", "lamp: 1")) as node:
            command = self.raises("OtherMap", self.at_node(self.TEXT, node).connect).split("`")[1]
            self.assertEqual(command.split()[:3], ["coupler", "diff", "MAP"])
            self.assertIn("lamp: 0 -> 1", self.coupler("diff", "cell.yaml", *command.split()[3:]).stdout)

    def test_what_only_the_node_refuses_is_an_exception(self):
        with self.node(self.TEXT) as node, self.at_node(self.TEXT.replace("max: 10", "max: 99"), node) as cell:
            self.assertEqual(self.raises("ExceptionReply", cell.speed.write, 50), "speed: exception 03 (illegal data value)")
            self.assertEqual(cell.speed.read(), 0)

    @made.LIVE
    def test_the_map_may_come_from_the_node(self):
        with self.node(self.TEXT) as node:
            self.assertEqual(self.coupler("generate", f"tcp://127.0.0.1:{node.port}", "--python").returncode, 0)
            self.assertIn(f"port: int = {node.port}", (self.folder / "cell_client.py").read_text(encoding="utf-8"))


if __name__ == "__main__":
    unittest.main(warnings="ignore")
