# SPDX-License-Identifier: Apache-2.0
"""The node under attack: a server of which memory, descriptors and life are watched from outside."""
import pathlib
import time

import adu as modbus
from client import Client
from real_time import ask_for_real_time
from support.served import Served

PATIENCE = 5.0  # seconds for the rest of a frame, and for a client to read: device/net/connection.hpp
CONNECTIONS = 256  # as many at a time: device/net/tcp_server.hpp
LATE = 2.0  # seconds that a loaded machine may add
STATE, TRIPS = 0xFF0B, 0xFF17  # of the watchdog: docs/identity.md


class Node(Served):
    def __init__(self, subject):
        super().__init__(subject.command, preexec_fn=ask_for_real_time)
        self.map_text = subject.map_text
        self._processes = self.processes()

    def connect(self, **options):
        return Client(self.port, **options)

    def check_alive(self):
        """Neither it nor a process that it started has ended or been replaced."""
        assert not self.has_ended(), f"the node has ended with status {self.exit_status()}"
        assert self.processes() == self._processes, f"the node restarted a process:\n{self.log()}"

    def descriptors(self):
        return sum(len(list(pathlib.Path(f"/proc/{pid}/fd").iterdir())) for pid in self._processes)

    def expect_descriptors(self, at_most, seconds=LATE):
        """Connections that ended are closed at this side too."""
        end = time.monotonic() + seconds
        while (now := self.descriptors()) > at_most:
            assert time.monotonic() < end, f"{now} descriptors are open after {seconds:g} s instead of {at_most}"
            time.sleep(0.01)

    def watchdog_trips(self):
        with self.connect() as client:
            return int.from_bytes(client.ask(modbus.read(4, TRIPS, 2))[2:], "big")
