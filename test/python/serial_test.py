# SPDX-License-Identifier: Apache-2.0
"""The client in Python of couplers that speak RTU, on a serial line and over TCP, against pymodbus' servers."""
import errno
import fcntl
import os
import pathlib
import sys
import time
import types
import unittest
from unittest import mock

import made

try:
    import serial
    import serial_asyncio  # noqa: F401
    from pymodbus.transaction import ModbusRtuFramer  # noqa: F401
except ImportError as error:
    print(f"skipped: {error}; the servers of this test are Debian's python3-pymodbus and python3-serial-asyncio")
    sys.exit(77)
sys.path.insert(0, str(made.SOURCE / "test/ros"))
os.environ.setdefault("COUPLER_BUILD_DIR", str(pathlib.Path(os.environ["COUPLER"]).resolve().parents[1]))
from support.patience import wait_until  # noqa: E402
from support.rtu_server import RtuServer  # noqa: E402
from support.serial_line import SerialLine  # noqa: E402

UNIT = 17
SHORT = 0.3  # seconds, where silence is to be noticed
MAP = f"""\
name: belt
unit: {UNIT}
{{way}}
verify: off
mapping:
  coils: {{{{run: 0, lamps: {{{{address: 2, count: 10}}}}}}}}
  discrete_inputs: {{{{door: 0}}}}
  input_registers: {{{{weight: {{{{address: 0, type: REAL}}}}}}}}
  holding_registers: {{{{speed: {{{{address: 0, type: UINT, scale: 0.1}}}}, total: {{{{address: 1, type: DINT}}}}}}}}
"""


class Rtu(made.Made):
    def belt(self, way, *place, **options):
        self.module, kind = self.client(MAP.format(way=way), name="belt")
        client = kind(*place, **{"timeout": made.PATIENCE, **options})
        self.addCleanup(client.disconnect)
        return client

    def carries_values(self, belt, memory):
        memory.setValues(4, 0, [0, 0x4120])  # not one of WRITES: 10.0, low word first
        memory.setValues(2, 0, [1])
        with belt:
            belt.run.write(True)
            belt.lamps.write([True, False] * 5)
            belt.speed.write(12.5)
            belt.total.write(-70000)
            self.assertEqual(belt.read_all(), {"run": True, "lamps": [True, False] * 5, "door": True, "weight": 10.0,
                                               "speed": 12.5, "total": -70000})
            self.assertEqual(belt.weight.read(), 10.0)
        self.assertEqual([function for function, _, _ in memory.written], [5, 15, 6, 16])


class OverTcp(Rtu):
    def test_values_are_carried(self):
        server = RtuServer([UNIT])
        self.addCleanup(server.end)
        self.carries_values(self.belt("framing: rtu", "127.0.0.1", server.port), server.units[UNIT])


class OnALine(Rtu):
    def setUp(self):
        super().setUp()
        self.line = SerialLine()
        self.addCleanup(self.line.end)
        self.server = RtuServer([UNIT], self.line.device)
        self.addCleanup(self.server.end)
        self.way = f"serial: {{device: {self.line.port}, baud: 115200, parity: none}}"

    def test_values_are_carried(self):
        self.carries_values(self.belt(self.way), self.server.units[UNIT])

    def test_the_port_can_be_given(self):
        belt = self.belt("serial: {device: /dev/none, baud: 9600}", self.line.port, baud=115200, parity="none")
        with belt:
            self.assertIs(belt.door.read(), False)

    def test_a_port_that_is_not_there_or_in_use_is_an_error_that_says_what_to_look_at(self):
        belt = self.belt(self.way, "/dev/none")
        with self.assertRaisesRegex(self.module.NotConnected, "/dev/none.*check that the port is there") as caught:
            belt.connect()
        self.assertEqual(caught.exception.errno, errno.ENOENT)
        belt.device = self.line.port
        with open(self.line.port, "rb", buffering=0) as held:
            fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
            with self.assertRaisesRegex(self.module.NotConnected, "that nobody else uses it") as caught:
                belt.connect()
            self.assertEqual(caught.exception.errno, errno.EAGAIN)
        belt.connect()
        with self.assertRaises(serial.SerialException):
            serial.Serial(self.line.port, exclusive=True)

    def late_answer_comes_in_the_pause(self, belt):
        """However slow this machine is: the pause before the next request ends when the answer is there."""
        later = []

        def pause(seconds):
            if later:
                time.sleep(seconds)
            else:
                later.append(True)
                self.line.release()
                wait_until(lambda: belt._modbus.socket.in_waiting, "the late answer", made.PATIENCE)
        clock = types.SimpleNamespace(monotonic=time.monotonic, sleep=pause)
        patch = mock.patch.object(self.module, "time", clock)
        patch.start()
        self.addCleanup(patch.stop)

    def test_silence_ends_and_a_late_answer_is_not_taken_for_the_next_one(self):
        belt = self.belt(self.way, timeout=SHORT)
        self.server.units[UNIT].setValues(3, 0, [100])
        with belt:
            self.line.hold()
            with self.assertRaisesRegex(self.module.Lost, "no reply within 300 ms"):
                belt.speed.read()
            self.late_answer_comes_in_the_pause(belt)
            belt.timeout = made.PATIENCE
            self.assertEqual(belt.total.read(), 0)
            self.assertEqual(belt.speed.read(), 10.0)

    def test_parity_is_one_of_three_words(self):
        with self.assertRaisesRegex(ValueError, "give 'none', 'even' or 'odd'"):
            self.belt(self.way, parity="N")


if __name__ == "__main__":
    unittest.main(verbosity=2)
