# SPDX-License-Identifier: Apache-2.0
"""A device of pymodbus that has what dump.yaml says, holes, and what fails."""
import pathlib
import sys

import peer

try:
    from pymodbus.constants import Endian
    from pymodbus.datastore import ModbusSequentialDataBlock, ModbusSlaveContext
    from pymodbus.payload import BinaryPayloadBuilder
except ImportError as error:
    peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")

# The device is the one of the driver's tests.
sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "ros"))
from support import peer as foreign  # noqa: E402

READS = {1, 2, 3, 4}


class Store(ModbusSlaveContext):
    """Has holes (exception 02) and what fails (exception 04), and remembers the functions that it was asked for."""

    def __init__(self):
        tables = {key: ModbusSequentialDataBlock(0, [0] * 100) for key in ("di", "co", "hr", "ir")}
        super().__init__(zero_mode=True, **tables)
        self.holes = {(4, 6), (3, 10), (3, 11), (3, 12), (1, 5)}
        self.failing = {(2, 2)}
        self.asked = set()

    def validate(self, fc_as_hex, address, count=1):
        self.asked.add(fc_as_hex)
        if any((fc_as_hex, at) in self.holes for at in range(address, address + count)):
            return False
        return super().validate(fc_as_hex, address, count)

    def getValues(self, fc_as_hex, address, count=1):
        if any((fc_as_hex, at) in self.failing for at in range(address, address + count)):
            raise RuntimeError("behind this one something is broken")
        return super().getValues(fc_as_hex, address, count)


def registers(**values):
    builder = BinaryPayloadBuilder(byteorder=Endian.Big, wordorder=Endian.Big)
    for kind, value in values.items():
        getattr(builder, f"add_{kind}")(value)
    return builder.to_registers()


def device_with_values(port):
    device = foreign.Peer(port)
    device.store = Store()
    device.set("coils", 0, [1, 0, 1])
    device.set("coils", 9, [1])
    device.set("discrete_inputs", 0, [0, 1, 1, 1])
    device.set("input_registers", 0, registers(**{"32bit_float": 0.1}) + registers(**{"64bit_uint": 2**64 - 7}))
    device.set("input_registers", 7, registers(**{"16bit_int": 615}))
    device.set("holding_registers", 0, [7, 0xFFFF, 0x8000])
    device.set("holding_registers", 5, registers(string="pump 1\x1b[2J"))
    device.set("holding_registers", 13, [4711, 0x0008, 0xABCD])
    device.set("holding_registers", 16, registers(**{"32bit_int": -100000}))
    return device
