# SPDX-License-Identifier: Apache-2.0
"""The machine that is measured on: a core for the server, another for its clients, both ahead of whatever else runs
there, if that is permitted. Without that, p99 is the time slice of some other program."""
import os
import subprocess


class Machine:
    def __init__(self):
        cores = sorted(os.sched_getaffinity(0))
        self._server_core, self._client_core = cores[0], cores[-1]
        self._goes_first = subprocess.run(["chrt", "--fifo", "1", "true"], stderr=subprocess.DEVNULL,
                                          check=False).returncode == 0

    def as_server(self, *command):
        """The command line that runs the command there."""
        return self._on(self._server_core, command)

    def as_client(self, *command):
        return self._on(self._client_core, command)

    def __str__(self):
        cores = (f"server on core {self._server_core}, clients on core {self._client_core}"
                 if self._server_core != self._client_core else "server and clients on one core")
        others = ("ahead of other programs" if self._goes_first else
                  "beside other programs (real-time priority is not permitted: figures are steady on an idle machine only)")
        return f"{cores}, {others}; load average {os.getloadavg()[0]:.1f}"

    def _on(self, core, command):
        first = ["chrt", "--fifo", "1"] if self._goes_first else []
        return [*first, "taskset", "--cpu-list", str(core), *map(str, command)]
