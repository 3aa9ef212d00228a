# SPDX-License-Identifier: Apache-2.0
"""A Modbus/TCP device by a package of npm, with what support.peer.Peer has."""
import json
import pathlib
import subprocess

from support.patience import PATIENCE
from support.ports import free_port

SERVER = pathlib.Path(__file__).resolve().with_name("server.js")


class Device:
    """kind: modbus-serial or jsmodbus."""

    def __init__(self, kind):
        self.kind = kind
        self.port = free_port()

    def __enter__(self):
        self._server = subprocess.Popen(["node", SERVER, self.kind, str(self.port)], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, text=True)
        if self._server.stdout.readline() != "ready\n":
            raise RuntimeError(f"{self.kind} did not start")
        return self

    def __exit__(self, *_):
        self._server.stdin.close()
        self._server.wait(PATIENCE)
        self._server.stdout.close()

    def set(self, table, address, values):
        self._ask("set", table, address, list(values))

    def get(self, table, address, count=1):
        return self._ask("get", table, address, count)

    def _ask(self, *command):
        self._server.stdin.write(json.dumps(command) + "\n")
        self._server.stdin.flush()
        return json.loads(self._server.stdout.readline())
