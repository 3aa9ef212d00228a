# SPDX-License-Identifier: Apache-2.0
"""A Modbus/TCP device by pymodbus, in a thread of the test."""
import asyncio
import logging
import threading

from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
from pymodbus.server.async_io import ModbusTcpServer

from support.patience import PATIENCE
from support.ports import free_port

READ = {"coils": 1, "discrete_inputs": 2, "holding_registers": 3, "input_registers": 4}

# Ending a connection on purpose is no news.
logging.getLogger("pymodbus").setLevel(logging.CRITICAL)


class Peer:
    """Four tables of 65536 elements, served on a loopback port. It can be stopped and started again."""

    def __init__(self, port=None):
        self.port = port or free_port()
        # zero_mode: the number in the request is the address.
        tables = {key: ModbusSequentialDataBlock(0, [0] * 65536) for key in ("di", "co", "hr", "ir")}
        self.store = ModbusSlaveContext(zero_mode=True, **tables)
        self._loop = None
        self._thread = None

    @property
    def way(self):
        """The driver's arguments that lead there."""
        return "_address:=127.0.0.1", f"_port:={self.port}"

    def set(self, table, address, values):
        self.store.setValues(READ[table], address, list(values))

    def get(self, table, address, count=1):
        return list(self.store.getValues(READ[table], address, count))

    def start(self):
        ready = threading.Event()
        self._thread = threading.Thread(target=self._run, args=(ready,), daemon=True)
        self._thread.start()
        if not ready.wait(PATIENCE) or not self._thread.is_alive():
            raise RuntimeError("pymodbus did not start")
        return self

    def stop(self):
        """Ends the server and its connections."""
        if self._thread:
            self._loop.call_soon_threadsafe(self._stopping.set)
            self._thread.join(PATIENCE)
            self._thread = None

    def __enter__(self):
        return self.start()

    def __exit__(self, *_):
        self.stop()

    def _run(self, ready):
        self._loop = asyncio.new_event_loop()
        asyncio.set_event_loop(self._loop)
        self._loop.run_until_complete(self._serve(ready))
        self._loop.close()

    async def _serve(self, ready):
        self._stopping = asyncio.Event()
        context = ModbusServerContext(slaves=self.store, single=True)
        server = ModbusTcpServer(context, address=("127.0.0.1", self.port), allow_reuse_address=True)
        task = asyncio.ensure_future(server.serve_forever())
        await asyncio.wait([task, server.serving], return_when=asyncio.FIRST_COMPLETED)
        if task.done():
            task.result()  # raises why it does not serve
        ready.set()
        await self._stopping.wait()
        for connection in list(server.active_connections.values()):
            connection.transport.abort()
        await server.shutdown()
        task.cancel()
        await asyncio.wait([task])
