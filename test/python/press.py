# SPDX-License-Identifier: Apache-2.0
"""A client in Python and the device of a test that it talks to."""
import made
from device import Device

PRESS = """\
name: press
unit: 7
mapping:
  coils:
    valve: 0
    lamps: {address: 2, count: 3}
    horn:  {address: 5, access: write, write_function: multiple}
  discrete_inputs: {door: 0}
  input_registers: {flow: {address: 0, type: REAL}}
  holding_registers:
    speed: {address: 0, type: UINT, scale: 0.1, units: "%"}
    total: {address: 1, type: UDINT}
    flag:  {address: 3, type: BOOL, bit: 9}
    part:  {address: 4, type: USINT, offset: low, write_function: multiple}
    level: {address: 5, type: INT, read_address: 105}
    sure:  {address: 6, type: INT, verify_write: true}
    batch: {address: 7, type: INT, write_function: multiple}
    label: {address: 8, type: STRING, length: 6}
"""


class OfADevice(made.Made):
    def setUp(self):
        super().setUp()
        self.device = Device()
        self.device.__enter__()
        self.addCleanup(self.device.__exit__)

    def press(self, text=PRESS, **options):
        self.module, kind = self.client(text)
        client = kind("127.0.0.1", self.device.port, **{"timeout": made.PATIENCE, **options})
        self.addCleanup(client.disconnect)
        return client

    def connected(self, text=PRESS, **options):
        client = self.press(text, **options)
        client.connect()
        self.device.requests.clear()
        return client

    def raises(self, kind, call, *arguments):
        with self.assertRaises(getattr(self.module, kind)) as caught:
            call(*arguments)
        self.assertIsInstance(caught.exception, self.module.CouplerError)
        return str(caught.exception)
