# SPDX-License-Identifier: Apache-2.0
"""Serves a device of a configuration of pymodbus' simulator, as its program does but without the web page, and says what
the device holds in the simulator's own words: one line of JSON with its port and, for each value, [register, type, writable,
value]. Ends with its standard input.

    serve.py FILE DEVICE
"""
import asyncio
import json
import logging
import sys

from pymodbus.datastore import ModbusServerContext, ModbusSimulatorContext
from pymodbus.server import ModbusTcpServer


def held(context):
    cells = []
    for register, cell in enumerate(context.registers):
        kind = cell.type.name.lower()
        if kind == "next":
            cells[-1][2] = cells[-1][2] and cell.access  # a value is written as a whole
        elif kind != "invalid":
            cells.append([register, kind, cell.access, context.get_text_register(register)[1].value])
    return cells


async def main():
    logging.getLogger("pymodbus").setLevel(logging.ERROR)  # it says that a later one will have another form
    with open(sys.argv[1], encoding="utf-8") as file:
        device = json.load(file)["device_list"][sys.argv[2]]
    context = ModbusSimulatorContext(device, None)
    server = ModbusTcpServer(ModbusServerContext(devices=context, single=True), address=("127.0.0.1", 0))
    await server.serve_forever(background=True)
    port = server.transport.sockets[0].getsockname()[1]
    print(json.dumps({"port": port, "cells": held(context)}), flush=True)
    await asyncio.get_running_loop().run_in_executor(None, sys.stdin.read)
    await server.shutdown()


asyncio.run(main())
