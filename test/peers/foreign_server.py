# SPDX-License-Identifier: Apache-2.0
"""Devices that nobody knows, as pymodbus servers: strict about their addresses, and with moods."""
import asyncio
import contextlib
import logging
import threading

from pymodbus.datastore import ModbusServerContext
from pymodbus.device import ModbusDeviceIdentification
from pymodbus.interfaces import IModbusSlaveContext
from pymodbus.server.async_io import ModbusConnectedRequestHandler, ModbusTcpServer

import peer

logging.getLogger("pymodbus").setLevel(logging.CRITICAL + 1)

TABLE_OF = {1: "coils", 2: "discrete_inputs", 3: "holding_registers", 4: "input_registers"}


class Device(IModbusSlaveContext):
    """Tables of {address: value}; keeps a list of what was asked.

    most: registers in one read; more are refused with `too_many`. closes: in place of an exception.
    whole: ranges of input registers that are given in one piece only.
    """

    def __init__(self, tables, most=125, too_many=3, closes=False, whole=()):
        self.tables = {name: tables.get(name, {}) for name in TABLE_OF.values()}
        self.most = most
        self.too_many = too_many
        self.closes = closes
        self.whole = whole
        self.functions = []  # of all requests
        self.refused = []  # (function, address, count)
        self.was_too_many = False

    def validate(self, fc_as_hex, address, count=1):
        has = self.tables.get(TABLE_OF.get(fc_as_hex), {})
        self.was_too_many = fc_as_hex in (3, 4) and count > self.most
        good = not self.was_too_many and all(at in has for at in range(address, address + count))
        asked = set(range(address, address + count))
        good &= fc_as_hex != 4 or all(asked.isdisjoint(piece) or asked.issuperset(piece) for piece in self.whole)
        if not good:
            self.refused.append((fc_as_hex, address, count))
        return good

    def getValues(self, fc_as_hex, address, count=1):
        has = self.tables[TABLE_OF[fc_as_hex]]
        return [has[at] for at in range(address, address + count)]

    def setValues(self, fc_as_hex, address, values):
        raise AssertionError("nobody may write")


def handler_of(device):
    class Handler(ModbusConnectedRequestHandler):
        def execute(self, request, *addr):
            device.functions.append(request.function_code)
            super().execute(request, *addr)

        def send(self, message, *addr, **kwargs):
            if message.isError() and device.closes:
                self.transport.close()
                return
            if message.isError() and message.exception_code == 2 and device.was_too_many:
                message.exception_code = device.too_many
            super().send(message, *addr, **kwargs)

    return Handler


@contextlib.contextmanager
def serving(device, unit=None, names=None):
    """Serves a device on a free loopback port; yields the port. Without `unit` it answers all of them."""
    context = ModbusServerContext(slaves=device if unit is None else {unit: device}, single=unit is None)
    identity = ModbusDeviceIdentification(info_name=names) if names else None  # all servers of a program have the same
    loop = asyncio.new_event_loop()
    ready = threading.Event()
    port = []

    async def serve():
        server = ModbusTcpServer(context, address=("127.0.0.1", 0), identity=identity, handler=handler_of(device))
        task = asyncio.ensure_future(server.serve_forever())
        await server.serving
        port.append(server.server.sockets[0].getsockname()[1])
        ready.set()
        with contextlib.suppress(asyncio.CancelledError):
            await task

    def run():
        asyncio.set_event_loop(loop)
        loop.run_until_complete(serve())

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    if not ready.wait(peer.PATIENCE):
        raise RuntimeError("the pymodbus server did not start")
    try:
        yield port[0]
    finally:
        for task in asyncio.all_tasks(loop):
            loop.call_soon_threadsafe(task.cancel)
        thread.join(peer.PATIENCE)
