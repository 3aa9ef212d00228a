# SPDX-License-Identifier: Apache-2.0
"""Devices that refuse an address by silence or by nonsense, that acknowledge a write with nonsense, or that send bytes which
nobody asked for: it costs what they refuse, and nothing else."""
import socket
import struct

from coupler_driver.msg import PointStatus, Status
from coupler_driver.srv import Write
from std_msgs.msg import Bool, UInt16

from support import process, testing
from support.device import Device, Raw, frame
from support.patience import wait_until

MISSING = 20
TIMEOUT = 0.5

MAP = """
name: {name}
address: 127.0.0.1
timeout: {timeout}
rate: 50
verify: off
on_reconnect: {on_reconnect}
mapping:
  coils: {{lamp: 0}}
  holding_registers:
    a: {{address: 0, type: UINT}}
    w: {{address: 5, type: UINT}}
    c: {{address: 19, type: UINT}}   # touches the one that is missing
    d: {{address: 20, type: UINT}}
    e: {{address: 30, type: UINT}}   # behind it
"""


def adu(request, pdu, length):
    return Raw(struct.pack(">HHHB", request.transaction, 0, length, request.unit) + pdu)


REFUSALS = {
    "silence": lambda request: None,
    "the end of the connection": lambda request: request.connection.shutdown(socket.SHUT_RDWR),
    "an exception whose header says one byte more": lambda request: adu(request, b"\x83\x02", 4),
    "a byte behind the exception": lambda request: adu(request, b"\x83\x02\x00", 3),
    "a byte behind the exception that is counted": lambda request: adu(request, b"\x83\x02\x00", 4),
    "an exception without the high bit": lambda request: adu(request, b"\x03\x02", 3),
    "a byte count that is nonsense": lambda request: adu(request, b"\x03\xFF\x00\x00", 5),
    "a register of twelve bytes": lambda request: frame(request, b"\x03\x0C" + bytes(12)),
}

ACKNOWLEDGEMENTS = {
    "a byte too many": lambda request: frame(request, request.data + b"\x06"),
    "another function": lambda request: frame(request, b"\x01" + request.data[1:]),
    "one byte": lambda request: frame(request, b"\x06"),
    "another address": lambda request: frame(request, request.data[:1] + b"\x00\x63" + request.data[3:]),
    "nothing": lambda request: None,
}


class OddDevices(testing.RosTest):
    at_once = True

    def start(self, on_reconnect="drop"):
        device = Device()
        for address in (0, 5, 19, 30):
            device.tables["holding_registers"][address] = 100 + address
        device.start()
        self.addCleanup(device.stop)
        path = process.write_map(MAP.format(name=self.name, timeout=TIMEOUT, on_reconnect=on_reconnect))
        return device, path

    def quality(self, status, name):
        return next(point.quality for point in status.points if point.name == name)

    def costs_only_what_is_refused(self, refusal):
        device, path = self.start()

        def answer(request):
            if request.function == 3 and request.address <= MISSING < request.address + request.count:
                return refusal(request)
            return device.serve(request)

        device.answer = answer
        driver = self.driver(f"_map:={path}", f"_port:={device.port}")
        values = [self.topic(f"/{self.name}/{point}", UInt16) for point in "ace"]
        status = self.topic(f"/{self.name}/status", Status)
        for topic, value in zip(values, (100, 119, 130)):
            wait_until(lambda topic=topic, value=value: topic.next() == value, topic.name)
        status.wait_for(lambda known: self.quality(known, "d") == PointStatus.REJECTED)
        online = self.topic(f"/{self.name}/online", Bool, latched=True)
        accepted = device.accepted
        for value in (7, 8, 9):
            device.tables["holding_registers"][30] = value
            wait_until(lambda value=value: values[2].next() == value, "a new value behind it")
        self.assertLessEqual(device.accepted, accepted + 1)  # it may be tried again meanwhile
        self.assertNotIn(False, online.values)
        self.assertIn("d ", driver.output)
        self.assertLessEqual(driver.output.count("connection lost"), 2, driver.output)

    def an_acknowledgement_that_is_none_costs_its_write(self, acknowledgement):
        device, path = self.start("restore")
        device.answer = lambda request: acknowledgement(request) if request.function == 6 and request.address == 5 \
            and device.serve(request) else device.serve(request)
        driver = self.driver(f"_map:={path}", f"_port:={device.port}")
        other = self.topic(f"/{self.name}/a", UInt16)
        self.assertEqual(other.next(), 100)
        answer = self.service(f"/{self.name}/write", Write)("w", "77")
        self.assertFalse(answer.success, answer)
        self.assertTrue(answer.message.startswith("lost: "), answer)
        driver.wait_for("w is not restored")
        written = len(device.seen(6))
        self.assertLessEqual(written, 3)
        for value in (1, 2, 3):
            device.tables["holding_registers"][0] = value
            wait_until(lambda value=value: other.next() == value, "a new value")
        self.assertEqual(len(device.seen(6)), written)
        self.assertTrue(self.service(f"/{self.name}/write", Write)("lamp", "true").success)
        self.assertEqual(device.tables["coils"][0], 1)


    def test_an_acknowledgement_that_contradicts_the_write_is_not_ok(self):
        device, path = self.start()
        device.answer = lambda request: b"\x00\x05\x00\x09" if request.function == 6 else \
            b"\x00\x00\x00\x00" if request.function == 5 else device.serve(request)
        self.driver(f"_map:={path}", f"_port:={device.port}")
        self.assertEqual(self.topic(f"/{self.name}/a", UInt16).next(), 100)
        write = self.service(f"/{self.name}/write", Write)
        for point, value, said in (("w", "77", "0x0009"), ("lamp", "true", "0x0000")):
            answer = write(point, value)
            self.assertFalse(answer.success, answer)
            self.assertTrue(answer.message.startswith("not taken: ") and said in answer.message, answer)
        self.assertEqual(device.accepted, 1)

    def test_one_that_ends_each_connection_after_some_replies_refuses_no_address(self):
        device, path = self.start()
        device.answers_per_connection = 3
        driver = self.driver(f"_map:={path}", f"_port:={device.port}")
        wait_until(lambda: device.accepted > 8, "some connections")
        self.assertNotIn("cannot be read", driver.output)


def _add(kind, table, call):
    for number, (name, answer) in enumerate(table.items(), 1):
        def test(self, answer=answer):
            call(self, answer)
        test.__doc__ = name
        setattr(OddDevices, f"test_{kind}_{number}_{name.replace(' ', '_')}", test)


_add("refusal", REFUSALS, OddDevices.costs_only_what_is_refused)
_add("acknowledgement", ACKNOWLEDGEMENTS, OddDevices.an_acknowledgement_that_is_none_costs_its_write)


class Greetings(testing.RosTest):
    """Bytes that come before any request was sent."""
    at_once = True

    def is_read_behind(self, greeting):
        device = Device()
        device.tables["holding_registers"][0] = 100
        device.greeting = greeting
        device.start()
        self.addCleanup(device.stop)
        path = process.write_map(f"name: {self.name}\naddress: 127.0.0.1\nrate: 50\nmapping:\n"
                                 "  holding_registers: {a: {address: 0, type: UINT}}\n")
        self.driver(f"_map:={path}", f"_port:={device.port}")
        topic = self.topic(f"/{self.name}/a", UInt16)
        self.assertEqual(topic.next(), 100)
        for value in (1, 2, 3):
            device.tables["holding_registers"][0] = value
            wait_until(lambda value=value: topic.next() == value, "a new value")
            device.say(greeting)
        self.assertEqual(device.accepted, 1)

    def test_a_newline(self):
        self.is_read_behind(b"\r\n")

    def test_a_zero_byte(self):
        self.is_read_behind(b"\0")

    def test_a_request_of_another_client(self):
        self.is_read_behind(b"\x00\x00\x00\x00\x00\x06\x01\x03\x00\x64\x00\x01")


if __name__ == "__main__":
    testing.main()
