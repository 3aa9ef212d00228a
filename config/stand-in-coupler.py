#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A Modbus/TCP server of pymodbus that stands in for a commercial coupler, to try config/foreign-coupler.yaml with:

    config/stand-in-coupler.py &
    coupler_driver --map config/foreign-coupler.yaml --address 127.0.0.1 --port 5020
"""
import argparse
import logging
import os
import socket
import sys

from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
from pymodbus.server import StartTcpServer

ADDRESS = "127.0.0.1"
arguments = argparse.ArgumentParser(description="A Modbus/TCP server that stands in for a commercial coupler.")
arguments.add_argument("port", metavar="PORT", nargs="?", type=int, default=5020, help="where it listens (default: 5020)")
port = arguments.parse_args().port
if not 0 < port < 65536:
    arguments.error(f"{port} is no port; give one from 1 to 65535")
try:
    socket.create_server((ADDRESS, port)).close()  # pymodbus would wait and say nothing
except OSError as error:
    sys.exit(f"stand-in-coupler: cannot listen on {ADDRESS} port {port}: {os.strerror(error.errno)}; end the program that "
             f"listens there, or give another port: config/stand-in-coupler.py {5021 if port == 5020 else 5020}")

# pymodbus calls these errors, too: a read of what the coupler does not have, and a client that leaves.
USUAL = ("Exception Response(", "has been canceled")
for handler in logging.getLogger().handlers:
    handler.addFilter(lambda record: not any(usual in record.getMessage() for usual in USUAL))

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
    address=(ADDRESS, port),
    allow_reuse_address=True,  # or it would wait for a minute after it was ended while a client was connected
)
