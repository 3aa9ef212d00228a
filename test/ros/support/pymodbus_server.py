# SPDX-License-Identifier: Apache-2.0
"""A pymodbus server as a process of its own, which can be frozen and killed.  python3 -m support.pymodbus_server PORT"""
import signal
import socket
import subprocess
import sys
import time

from support.patience import PATIENCE
from support.process import freeze

LEVEL = 41  # in holding register 4


class Server:
    def __init__(self, port):
        self.port = port
        self._child = None

    def start(self):
        self._child = subprocess.Popen([sys.executable, "-m", "support.pymodbus_server", str(self.port)])
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            with socket.socket() as probe:
                if probe.connect_ex(("127.0.0.1", self.port)) == 0:
                    return self
            time.sleep(0.05)
        raise AssertionError("pymodbus did not start")

    def freeze(self):
        freeze(self._child)

    def thaw(self):
        self._child.send_signal(signal.SIGCONT)

    def kill(self):
        if self._child:
            self._child.kill()
            self._child.wait(PATIENCE)
            self._child = None


if __name__ == "__main__":
    from support.peer import Peer

    peer = Peer(int(sys.argv[1]))
    peer.set("holding_registers", 4, [LEVEL])
    with peer:
        signal.pause()
