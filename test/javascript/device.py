# SPDX-License-Identifier: Apache-2.0
"""A device by a package of npm, with what support.peer.Peer has."""
import json
import pathlib
import subprocess

from support.patience import PATIENCE
from support.ports import free_port
from support.serial_line import SerialLine

SERVER = pathlib.Path(__file__).resolve().with_name("server.js")


class Device:
    """By Modbus/TCP. kind: modbus-serial or jsmodbus."""

    def __init__(self, kind):
        self.kind = kind
        self.place = str(free_port())

    def __enter__(self):
        self._server = subprocess.Popen(["node", SERVER, self.kind, self.place], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, text=True)
        if self._server.stdout.readline() != "ready\n":
            raise RuntimeError(f"{self.kind} did not start")
        return self

    def __exit__(self, *_):
        self._server.stdin.close()
        self._server.wait(PATIENCE)
        self._server.stdout.close()

    @property
    def way(self):
        return "_address:=127.0.0.1", f"_port:={self.place}"

    def set(self, table, address, values):
        self._ask("set", table, address, list(values))

    def get(self, table, address, count=1):
        return self._ask("get", table, address, count)

    def _ask(self, *command):
        self._server.stdin.write(json.dumps(command) + "\n")
        self._server.stdin.flush()
        return json.loads(self._server.stdout.readline())


class RtuOverTcpDevice(Device):
    """kind: jsmodbus-rtu."""

    @property
    def way(self):
        return *super().way, "_framing:=rtu"


class SerialDevice(Device):
    """At the end of a serial line. kind: modbus-serial-rtu."""

    def __enter__(self):
        self._line = SerialLine()
        self.place = self._line.device
        return super().__enter__()

    def __exit__(self, *_):
        super().__exit__()
        self._line.end()

    @property
    def way(self):
        return f"_serial:={self._line.port}", "_baud:=115200", "_parity:=none"
