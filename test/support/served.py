# SPDX-License-Identifier: Apache-2.0
"""A server as a child process, seen from outside: where it serves, what it says, the memory of it and its children."""
import contextlib
import os
import pathlib
import re
import signal
import subprocess
import time

PATIENCE = 120  # seconds; no rule, only reached when something is broken


class Served:
    """A program that says "serving WHAT on HOST:PORT" once it does."""

    def __init__(self, command, start_seconds=PATIENCE, **popen):
        self._log = open(os.memfd_create("log"), "w+b")  # no disk, which others may keep busy
        self._child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=self._log, stderr=self._log, **popen)
        self.port = self._wait_for_port(start_seconds)

    def has_ended(self):
        return self._child.poll() is not None

    def exit_status(self):
        return self._child.returncode

    def processes(self):
        """Its process id, and those of its children and theirs."""
        parents = {}
        for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
            with contextlib.suppress(OSError):  # it has ended meanwhile
                parents[int(stat.parent.name)] = int(stat.read_text().rpartition(")")[2].split()[1])
        family = [self._child.pid]
        for pid in family:
            family += [child for child, parent in parents.items() if parent == pid]
        return family

    def resident(self):
        """KiB of each process, the programs and libraries in it included."""
        return self._memory("VmRSS")

    def allocated(self):
        """KiB of each process that are resident and not read from a file: heap, stacks, changed data."""
        return self._memory("RssAnon")

    def stop(self, seconds=PATIENCE):
        """SIGTERM; the exit status, None if it did not end."""
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

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()

    def _memory(self, kind):
        return [int(re.search(rf"{kind}:\s+(\d+)", pathlib.Path(f"/proc/{pid}/status").read_text())[1])
                for pid in self.processes()]

    def _wait_for_port(self, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end and not self.has_ended():
            if found := re.search(r"serving .* on \S+:(\d+)", self.log()):
                return int(found[1])
            time.sleep(0.01)
        self.stop()
        raise SystemExit(f"{self._child.args[0]} did not start serving:\n{self.log()}")
