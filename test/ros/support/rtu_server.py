# SPDX-License-Identifier: Apache-2.0
"""Units on a serial line, or RTU over TCP, served by pymodbus."""
import asyncio
import logging
import threading

from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
from pymodbus.server.async_io import ModbusSerialServer, ModbusTcpServer
from pymodbus.transaction import ModbusRtuFramer

from support.patience import PATIENCE

WRITES = (5, 6, 15, 16)

# Frames that are damaged on purpose are no news.
logging.getLogger("pymodbus").setLevel(logging.CRITICAL)


class Memory(ModbusSlaveContext):
    """`size` elements of each table; `written` is what came over the line: (function, address, values)."""

    def __init__(self, size):
        tables = {key: ModbusSequentialDataBlock(0, [0] * size) for key in ("di", "co", "hr", "ir")}
        super().__init__(zero_mode=True, **tables)
        self.written = []

    def setValues(self, fc_as_hex, address, values):
        if fc_as_hex in WRITES:
            self.written.append((fc_as_hex, address, list(values)))
        super().setValues(fc_as_hex, address, values)


class RtuServer:
    """`units` are the numbers of those that answer; each has `size` of everything. `device`: the end of a line; without it
    a free port on loopback, which is `port` then."""

    def __init__(self, units, device=None, size=100):
        self.units = {unit: Memory(size) for unit in units}
        self.port = None
        self._size = size
        self._device = device
        self._loop = asyncio.new_event_loop()
        self._ready = threading.Event()
        self._thread = threading.Thread(target=self._loop.run_until_complete, args=(self._serve(),), daemon=True)
        self._thread.start()
        if not self._ready.wait(PATIENCE):
            raise RuntimeError("the server has not started")

    async def _serve(self):
        self._stopped = asyncio.Event()
        context = ModbusServerContext(slaves=self.units, single=False)
        options = {"framer": ModbusRtuFramer, "ignore_missing_slaves": True, "broadcast_enable": True}
        if self._device:
            server = ModbusSerialServer(context, port=self._device, baudrate=115200, **options)
            await server.start()
            self._ready.set()
            await self._stopped.wait()
            server.transport.close()
            await self._end_tasks()
            return
        server = ModbusTcpServer(context, address=("127.0.0.1", 0), **options)
        serving = asyncio.ensure_future(server.serve_forever())  # kept: a task that nobody has may be collected
        await server.serving
        self.port = server.server.sockets[0].getsockname()[1]
        self._ready.set()
        await self._stopped.wait()
        await server.server_close()
        await self._end_tasks()

    @staticmethod
    async def _end_tasks():
        tasks = asyncio.all_tasks() - {asyncio.current_task()}
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    def add(self, unit):
        """One that was dead is alive."""
        self.units[unit] = Memory(self._size)

    def set(self, unit, function, address, values):
        ModbusSlaveContext.setValues(self.units[unit], function, address, values)

    def get(self, unit, function, address, count=1):
        values = self.units[unit].getValues(function, address, count)
        return values[0] if count == 1 else values

    def end(self):
        self._loop.call_soon_threadsafe(self._stopped.set)
        self._thread.join(PATIENCE)
        self._loop.close()
