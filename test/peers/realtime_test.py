#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""--realtime: what the kernel says of each process of the node, and what a user without the right to it is told.

    realtime_test.py NODE_COMMAND…
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

import peer

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from support.served import Served  # noqa: E402

SUPERVISOR, IO_PROCESS = 11, 10
MEMORY = 64 * 1024  # bytes that may be locked: too little for any program
# Root's right to it, taken away. The limits can be lowered by anybody.
ORDINARY = ["prlimit", "--rtprio=0", f"--memlock={MEMORY}"]
if os.geteuid() == 0:
    ORDINARY += ["setpriv", "--bounding-set=-sys_nice,-ipc_lock"]
# The same with the limits that a unit is told to set.
ALLOWED = ["prlimit", f"--rtprio={SUPERVISOR}", "--memlock=unlimited", *ORDINARY[3:]]


def main():
    command = [*sys.argv[1:], "--listen", "127.0.0.1", "--port", "0", "--realtime"]
    checks = peer.Checks()
    refused_with_the_remedy(command, checks)
    rows = []
    if can(["chrt", "--fifo", str(SUPERVISOR), "true"]):
        serves_ahead_of_others(command, checks)
        rows.append("as root")
    if can([*ALLOWED, "chrt", "--fifo", str(SUPERVISOR), "true"]):
        serves_ahead_of_others([*ALLOWED, *command], checks)
        rows.append("with the limits of realtime.conf")
    checks.done("--realtime is had or refused with the remedy; had: " + (" and ".join(rows) or "nowhere here"))


def can(command):
    return shutil.which(command[0]) and subprocess.run(command, stderr=subprocess.DEVNULL, check=False).returncode == 0


def refused_with_the_remedy(command, checks):
    done = subprocess.run([*ORDINARY, *command], stderr=subprocess.PIPE, text=True, timeout=peer.PATIENCE, check=False)
    checks.equal("exit status where it is refused", done.returncode, 3)
    wanted = ["LimitRTPRIO=11 and RestrictRealtime=no", "ulimit -r 11"]
    if not peer.is_sanitized():  # the sanitizers make mlockall() do nothing: they could not map their shadow memory
        wanted += ["LimitMEMLOCK=infinity", "ulimit -l unlimited"]
    for remedy in wanted:
        checks.equal(f"it tells {remedy}", remedy in done.stderr, True)
    checks.equal("it has not served", "serving" in done.stderr, False)


def serves_ahead_of_others(command, checks):
    with Served(command) as node:
        processes = node.processes()
        checks.equal("processes", len(processes), 2)
        for i, pid in enumerate(processes):
            who = "the first process" if i == 0 else f"process {i + 1}"
            checks.equal(f"policy of {who}", os.sched_getscheduler(pid), os.SCHED_FIFO | os.SCHED_RESET_ON_FORK)
            checks.equal(f"priority of {who}", os.sched_getparam(pid).sched_priority, IO_PROCESS if i else SUPERVISOR)
            if not peer.is_sanitized():
                status = pathlib.Path(f"/proc/{pid}/status").read_text()
                checks.equal(f"{who} has locked memory", int(re.search(r"VmLck:\s+(\d+)", status)[1]) > 0, True)
        checks.equal("exit status", node.stop(), 0)


main()
