# SPDX-License-Identifier: Apache-2.0
"""Units on a serial line, or RTU over TCP, served by pymodbus."""
import asyncio
import threading

from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
from pymodbus.server.async_io import ModbusSerialServer, ModbusTcpServer
from pymodbus.transaction import ModbusRtuFramer

from support.patience import PATIENCE


class RtuServer:
    """`units` are the numbers of those that answer; each has 100 of everything. `device`: the end of a line; without it
    a free port on loopback, which is `port` then."""

    def __init__(self, units, device=None):
        self.units = {unit: self._memory() for unit in units}
        self.port = None
        self._device = device
        self._loop = asyncio.new_event_loop()
        self._ready = threading.Event()
        self._thread = threading.Thread(target=self._loop.run_until_complete, args=(self._serve(),), daemon=True)
        self._thread.start()
        if not self._ready.wait(PATIENCE):
            raise RuntimeError("the server has not started")

    @staticmethod
    def _memory():
        tables = {key: ModbusSequentialDataBlock(0, [0] * 100) for key in ("di", "co", "hr", "ir")}
        return ModbusSlaveContext(zero_mode=True, **tables)

    async def _serve(self):
        self._stopped = asyncio.Event()
        context = ModbusServerContext(slaves=self.units, single=False)
        options = {"framer": ModbusRtuFramer, "ignore_missing_slaves": True}
        if self._device:
            server = ModbusSerialServer(context, port=self._device, baudrate=115200, **options)
            await server.start()
            self._ready.set()
            await self._stopped.wait()
            server.transport.close()
            return
        server = ModbusTcpServer(context, address=("127.0.0.1", 0), **options)
        task = asyncio.ensure_future(server.serve_forever())
        await server.serving
        self.port = server.server.sockets[0].getsockname()[1]
        self._ready.set()
        await self._stopped.wait()
        await server.server_close()
        task.cancel()

    def set(self, unit, function, address, values):
        self.units[unit].setValues(function, address, values)

    def get(self, unit, function, address):
        return self.units[unit].getValues(function, address, 1)[0]

    def end(self):
        self._loop.call_soon_threadsafe(self._stopped.set)
        self._thread.join(PATIENCE)
