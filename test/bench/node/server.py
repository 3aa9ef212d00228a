# SPDX-License-Identifier: Apache-2.0
"""A server that is measured: a process of which memory is watched from outside."""
import pathlib
import re
import subprocess
import tempfile
import time


class Server:
    def __init__(self, command):
        self._log = tempfile.NamedTemporaryFile()
        self._child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=self._log, stderr=self._log)
        self.port = self._wait_for_port(10)

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self._child.terminate()
        self._child.wait()

    def memory(self):
        """Resident KiB of its largest process."""
        return max(int(re.search(r"VmRSS:\s+(\d+)", pathlib.Path(f"/proc/{pid}/status").read_text())[1])
                   for pid in self._tree())

    def _wait_for_port(self, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end and self._child.poll() is None:
            if found := re.search(r"serving .* on \S+:(\d+)", self._text()):
                return int(found[1])
            time.sleep(0.01)
        self.__exit__()
        raise SystemExit(f"a server did not start:\n{self._text()}")

    def _text(self):
        return pathlib.Path(self._log.name).read_text(errors="replace")

    def _tree(self):
        pids = [self._child.pid]
        for pid in pids:
            for children in pathlib.Path(f"/proc/{pid}/task").glob("*/children"):
                pids += [int(child) for child in children.read_text().split()]
        return pids
