# SPDX-License-Identifier: Apache-2.0
"""The node under attack: a process of which memory, descriptors and life are watched from outside."""
import os
import pathlib
import re
import signal
import subprocess
import tempfile
import time

from client import Client
from real_time import ask_for_real_time

PATIENCE = 5.0  # seconds for the rest of a frame, and for a client to read: device/net/connection.hpp
CONNECTIONS = 256  # as many at a time: device/net/tcp_server.hpp
LATE = 2.0  # seconds that a loaded machine may add


class Node:
    def __init__(self, command, start_seconds=10):
        self._log = tempfile.TemporaryFile()
        self._child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=self._log, stderr=self._log,
                                       preexec_fn=ask_for_real_time)
        self.port = self._wait_for_port(start_seconds)
        self._processes = self._tree()

    def connect(self, **options):
        return Client(self.port, **options)

    def has_ended(self):
        return self._child.poll() is not None

    def check_alive(self):
        """Neither it nor a process that it started has ended or been replaced."""
        assert not self.has_ended(), f"the node has ended with status {self._child.returncode}"
        assert self._tree() == self._processes, f"the node restarted a process:\n{self.log()}"

    def memory(self):
        """Resident KiB, of all its processes."""
        return sum(int(re.search(r"VmRSS:\s+(\d+)", pathlib.Path(f"/proc/{pid}/status").read_text())[1])
                   for pid in self._processes)

    def descriptors(self):
        return sum(len(list(pathlib.Path(f"/proc/{pid}/fd").iterdir())) for pid in self._processes)

    def expect_descriptors(self, at_most, seconds=LATE):
        """Connections that ended are closed at this side too."""
        end = time.monotonic() + seconds
        while (now := self.descriptors()) > at_most:
            assert time.monotonic() < end, f"{now} descriptors are open after {seconds:g} s instead of {at_most}"
            time.sleep(0.01)

    def stop(self, seconds=10):
        """SIGTERM; the exit status."""
        if not self.has_ended():
            self._child.send_signal(signal.SIGTERM)
        try:
            return self._child.wait(seconds)
        except subprocess.TimeoutExpired:
            self._child.kill()
            self._child.wait()
            return None

    def log(self):
        # pread leaves the child's write position, which it shares, alone.
        return os.pread(self._log.fileno(), 1 << 20, 0).decode(errors="replace")

    def _wait_for_port(self, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end and not self.has_ended():
            if found := re.search(r"serving .* on \S+:(\d+)", self.log()):
                return int(found[1])
            time.sleep(0.01)
        self.stop()
        raise SystemExit(f"the node did not start serving:\n{self.log()}")

    def _tree(self):
        pids = [self._child.pid]
        for pid in pids:
            for children in pathlib.Path(f"/proc/{pid}/task").glob("*/children"):
                pids += [int(child) for child in children.read_text().split()]
        return pids
