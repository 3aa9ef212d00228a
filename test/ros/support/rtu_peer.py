# SPDX-License-Identifier: Apache-2.0
"""What support.peer.Peer has, by RTU: at the end of a serial line, or over TCP."""
from support.peer import READ
from support.rtu_server import RtuServer
from support.serial_line import SerialLine

UNIT = 17
SIZE = 65536


class _RtuPeer:
    def set(self, table, address, values):
        self._server.set(UNIT, READ[table], address, list(values))

    def get(self, table, address, count=1):
        return self._server.units[UNIT].getValues(READ[table], address, count)

    def __exit__(self, *_):
        self._server.end()


class TcpPeer(_RtuPeer):
    def __enter__(self):
        self._server = RtuServer([UNIT], size=SIZE)
        return self

    @property
    def way(self):
        return "_address:=127.0.0.1", f"_port:={self._server.port}", "_framing:=rtu", f"_unit:={UNIT}"


class SerialPeer(_RtuPeer):
    def __enter__(self):
        self._line = SerialLine()
        self._server = RtuServer([UNIT], self._line.device, SIZE)
        return self

    def __exit__(self, *_):
        super().__exit__()
        self._line.end()

    @property
    def way(self):
        return f"_serial:={self._line.port}", "_baud:=115200", "_parity:=none", f"_unit:={UNIT}"
