# SPDX-License-Identifier: Apache-2.0
"""The client in Python takes a reply only if it is that to its request, with every pymodbus."""
import struct
import unittest

from press import PRESS, OfADevice

SHORT = 0.2  # seconds; newer releases of pymodbus wait on for the right transaction
OTHER = "malformed reply: the reply to another request"
MASK_WRITE = PRESS.replace("unit: 7", "unit: 7\nlimits: {mask_write: true}")


def other_transaction(frame):
    return struct.pack(">H", struct.unpack(">H", frame[:2])[0] ^ 0x55) + frame[2:]


class Replies(OfADevice):
    def refused(self, pdu, call, *arguments, text=PRESS):
        """The call ends in Lost if the device answers with this PDU."""
        press = self.connected(text)
        point = getattr(press, call[0])
        self.device.spoil = lambda _: pdu
        with self.subTest(pdu=pdu.hex(), call=call):
            self.assertEqual(self.raises("Lost", getattr(point, call[1]), *arguments), OTHER)
            self.assertFalse(press.online)
        self.device.spoil = None

    def impatient(self):
        """Connected without a request, so that the short timeout is nobody's who answers."""
        press = self.press(timeout=SHORT, verify="off")
        press.connect()
        return press

    def test_a_reply_that_comes_twice_is_not_taken_for_the_next_one(self):
        self.device.tables["holding_registers"][0:8] = range(10, 18)
        press = self.connected()
        self.device.frames = lambda frame: 2 * frame
        self.assertEqual(press.batch.read(), 17)
        self.device.frames = None
        try:
            self.assertEqual(press.sure.read(), 16)
        except self.module.Lost:
            self.assertEqual(press.sure.read(), 16)

    def test_a_reply_that_comes_twice_does_not_reach_a_register_by_a_bit(self):
        registers = self.device.tables["holding_registers"]
        registers[3], registers[7] = 0x8001, 0x5555
        press = self.connected()
        self.device.frames = lambda frame: 2 * frame
        self.assertEqual(press.batch.read(), 0x5555)
        self.device.frames = None
        try:
            press.flag.write(True)
        except self.module.Lost:
            self.assertEqual(registers[3], 0x8001)
            press.flag.write(True)
        self.assertEqual(registers[3], 0x8201)

    def test_a_reply_of_another_transaction_is_not_taken(self):
        for call in ("valve", "read"), ("speed", "read"), ("valve", "write", True), ("speed", "write", 1):
            press = self.impatient()
            self.device.frames = other_transaction
            with self.subTest(call=call):
                self.raises("Lost", getattr(getattr(press, call[0]), call[1]), *call[2:])
                self.assertFalse(press.online)
            self.device.frames = None

    def test_an_exception_of_another_transaction_is_not_taken(self):
        press = self.impatient()
        self.device.frames = other_transaction
        self.device.spoil = lambda pdu: bytes([pdu[0] | 0x80, 2])
        self.raises("Lost", press.speed.read)

    def test_an_exception_of_another_function_is_not_taken(self):
        for pdu in (b"\x90\x02", b"\x84\x0b"):
            self.refused(pdu, ("speed", "read"))
            self.refused(pdu, ("speed", "write"), 1)

    def test_a_reply_has_as_many_values_as_were_asked_for(self):
        self.refused(b"\x03\x04\xab\xcd\x00\x01", ("speed", "read"))
        self.refused(b"\x03\x02\x00\x01", ("total", "read"))
        self.refused(b"\x04\x06" + bytes(6), ("flow", "read"))
        self.refused(b"\x01\x02\x01\x01", ("lamps", "read"))
        self.refused(b"\x02\x02\x01\x01", ("door", "read"))

    def test_a_write_is_acknowledged_with_its_address_and_its_value(self):
        for pdu, point, value in (
                (b"\x05\x00\x01\xff\x00", "valve", True), (b"\x05\x00\x00\x00\x00", "valve", True),
                (b"\x05\x00\x00\xff\x00", "valve", False),
                (b"\x06\x00\x01\x00\x0a", "speed", 1), (b"\x06\x00\x00\x00\x0b", "speed", 1),
                (b"\x0f\x00\x03\x00\x03", "lamps", [True] * 3), (b"\x0f\x00\x02\x00\x02", "lamps", [True] * 3),
                (b"\x10\x00\x02\x00\x02", "total", 1), (b"\x10\x00\x01\x00\x01", "total", 1),
                (b"\x06\x00\x01\x00\x02", "total", 1)):
            self.refused(pdu, (point, "write"), value)
        for pdu in (b"\x16\x00\x04\xfd\xff\x02\x00", b"\x16\x00\x03\xfd\xfe\x02\x00",
                    b"\x16\x00\x03\xfd\xff\x00\x00"):
            self.refused(pdu, ("flag", "write"), True, text=MASK_WRITE)

    def test_the_right_reply_is_taken(self):
        press = self.connected(MASK_WRITE)
        for name, value in (("valve", True), ("valve", False), ("lamps", [True, False, True]), ("speed", 6553.5),
                            ("total", 1), ("flag", True), ("flag", False), ("sure", -1), ("label", "abc")):
            point = press.points[name]
            point.write(value)
            self.assertEqual(point.read(), value)
        self.assertEqual(self.device.connections, 1)


if __name__ == "__main__":
    unittest.main(warnings="ignore")
