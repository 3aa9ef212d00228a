# SPDX-License-Identifier: Apache-2.0
"""The node under attack: a server of which memory, descriptors and life are watched from outside."""
import pathlib
import re
import time

import adu as modbus
from client import LATE, Client
from real_time import ask_for_real_time
from support.served import Served

CONNECTIONS = 256  # as many at a time: coupler/device/net/tcp_server.hpp
STATE, TRIPS = 0xFF0B, 0xFF17  # of the watchdog: docs/identity.md


class Node(Served):
    def __init__(self, subject):
        super().__init__(subject.command, preexec_fn=ask_for_real_time)
        self.map_text = subject.map_text
        self.is_simulated = "--sim" in subject.command
        self.certificates = subject.certificates
        at = re.search(r"TLS at \S+:(\d+)", self.log())
        self.tls_port = int(at[1]) if at else None
        self._processes = self.processes()
        self._at_rest = self.descriptors()

    def connect(self, **options):
        return Client(self.port, **options)

    def check_alive(self):
        """Neither it nor a process that it started has ended or been replaced."""
        assert not self.has_ended(), f"the node has ended with status {self.exit_status()}"
        assert self.processes() == self._processes, f"the node restarted a process:\n{self.log()}"

    def descriptors(self):
        return sum(len(list(pathlib.Path(f"/proc/{pid}/fd").iterdir())) for pid in self._processes)

    def surplus(self, clients):
        """Descriptors above those that it began with and those of so many clients."""
        return self.descriptors() - self._at_rest - clients

    def expect_clients(self, number):
        """Connections that ended are closed at this side too."""
        end = time.monotonic() + LATE
        while (surplus := self.surplus(number)) > 0:
            assert time.monotonic() < end, f"{surplus} descriptors too many are open after {LATE:g} s"
            time.sleep(0.01)

    def allocated(self):
        """KiB of each process that are resident and not read from a file. The kernel counts them here; what it keeps in
        /proc/PID/status may lag behind by as much as the limit."""
        return [int(re.search(r"^Anonymous:\s+(\d+)", pathlib.Path(f"/proc/{pid}/smaps_rollup").read_text(), re.M)[1])
                for pid in self.processes()]

    def watchdog_trips(self):
        with self.connect() as client:
            return int.from_bytes(client.ask(modbus.read(4, TRIPS, 2))[2:], "big")
