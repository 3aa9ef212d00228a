# SPDX-License-Identifier: Apache-2.0
"""Every type, in every table, in all four byte and word orders, against a server of npm's modbus-serial on a serial line."""
import functools

import every_type_test
from device import SerialDevice
from support import testing


class ModbusSerialRtu(every_type_test.EveryType):
    peer = functools.partial(SerialDevice, "modbus-serial-rtu")


if __name__ == "__main__":
    testing.main()
