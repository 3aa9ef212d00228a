#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A Modbus/TCP server of pymodbus that stands in for a commercial coupler, to try config/foreign-coupler.yaml with:

    config/stand-in-coupler.py &
    coupler_driver --map config/foreign-coupler.yaml --address 127.0.0.1 --port 5020
"""
from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
from pymodbus.server import StartTcpServer

inputs = [False] * 16
inputs[0] = inputs[1] = True                    # clamped, door_closed
analogue = [16384, 215, 0x4148, 0x0000] + [0] * 12  # half of full scale, 21.5 °C, 12.5 l/min
analogue[9] = 0x0005                            # module_status

StartTcpServer(
    context=ModbusServerContext(
        ModbusSlaveContext(
            di=ModbusSequentialDataBlock(0, inputs),
            co=ModbusSequentialDataBlock(0, [False] * 16),
            ir=ModbusSequentialDataBlock(0, analogue),
            hr=ModbusSequentialDataBlock(0, [0] * 32),
            zero_mode=True,
        ),
        single=True,
    ),
    address=("127.0.0.1", 5020),
)
