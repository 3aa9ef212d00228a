# SPDX-License-Identifier: Apache-2.0
"""The machine that is measured on: a core for the server, another for its clients, both ahead of whatever else runs
there, if that is permitted. Without that, p99 is the time slice of some other program."""
import os
import subprocess


class Machine:
    def __init__(self):
        cores = sorted(os.sched_getaffinity(0))
        self.cores = cores
        self._server_core, self._client_core = cores[0], cores[-1]
        self.permits_priority = subprocess.run(["chrt", "--fifo", "1", "true"], stderr=subprocess.DEVNULL,
                                               check=False).returncode == 0

    def as_server(self, *command, priority=1):
        """The command line that runs the command there; priority 0 is that of other programs."""
        return self._on(self._server_core, command, priority)

    def as_client(self, *command, priority=1):
        return self._on(self._client_core, command, priority)

    def __str__(self):
        cores = (f"server on core {self._server_core}, clients on core {self._client_core}"
                 if self._server_core != self._client_core else "server and clients on one core")
        return f"{cores}; load average {os.getloadavg()[0]:.1f}"

    def order(self):
        return ("ahead of other programs" if self.permits_priority else
                "beside other programs (real-time priority is not permitted: figures are steady on an idle machine only)")

    def _on(self, core, command, priority):
        first = ["chrt", "--fifo", str(priority)] if priority and self.permits_priority else []
        return [*first, "taskset", "--cpu-list", str(core), *map(str, command)]
