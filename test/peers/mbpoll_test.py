#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""mbpoll reads and writes every table of a node that serves peers.yaml.

    mbpoll_test.py NODE_COMMAND…
"""
import pathlib
import re
import shutil
import subprocess
import sys

import peer

COIL, DISCRETE, INPUT, HOLDING = "0", "1", "3", "4"


class Mbpoll:
    def __init__(self, port):
        self.port = port

    def call(self, table, address, *values, count=1, extra=()):
        options = ["mbpoll", "-m", "tcp", "-p", str(self.port), "-a", "1", "-0", "-1", "-o", "10",
                   "-t", table, "-r", str(address)]
        if not values:
            options += ["-c", str(count)]
        return subprocess.run(options + list(extra) + ["127.0.0.1", *map(str, values)],
                              capture_output=True, text=True, timeout=peer.PATIENCE, check=False)

    def read(self, table, address, count=1, extra=()):
        """Values as mbpoll prints them."""
        done = self.call(table, address, count=count, extra=extra)
        return [match.group(1) for match in re.finditer(r"^\[\d+\]:\s*(\S+)", done.stdout, re.M)]

    def write(self, table, address, *values, extra=()):
        return "Written" in self.call(table, address, *values, extra=extra).stdout

    def refusal(self, table, address, *values, count=1):
        done = self.call(table, address, *values, count=count)
        found = re.search(r"Illegal data address|Illegal function|Illegal data value", done.stdout + done.stderr)
        return found.group(0) if found else None


def compare(mbpoll, checks):
    checks.equal("FC 15", mbpoll.write(COIL, 0, 1, 0, 1, 1, 0, 0, 1, 0, 0, 1), True)
    checks.equal("FC 1", mbpoll.read(COIL, 0, 10), list("1011001001"))
    checks.equal("FC 5", mbpoll.write(COIL, 20, 1), True)
    checks.equal("FC 1, one", mbpoll.read(COIL, 20), ["1"])
    checks.equal("FC 2", mbpoll.read(DISCRETE, 0, 4), list("1110"))
    checks.equal("FC 4 hexadecimal", mbpoll.read(INPUT + ":hex", 0, 5),
                 ["0xFFFE", "0x1234", "0x5678", "0x3FC0", "0x0000"])
    checks.equal("FC 4 float", mbpoll.read(INPUT + ":float", 3, extra=["-B"]), ["1.5"])
    checks.equal("FC 6", mbpoll.write(HOLDING, 0, 54321), True)
    checks.equal("FC 3", mbpoll.read(HOLDING + ":hex", 0), [f"0x{54321:04X}"])
    checks.equal("FC 16", mbpoll.write(HOLDING, 0, 1, 2, 3), True)
    checks.equal("FC 3, several", mbpoll.read(HOLDING, 0, 3), ["1", "2", "3"])
    for table, address, count in ((COIL, 10, 1), (DISCRETE, 3, 2), (INPUT, 5, 1), (HOLDING, 16, 2)):
        checks.equal(f"table {table} outside the map", mbpoll.refusal(table, address, count=count),
                     "Illegal data address")
    checks.equal("a write outside the map", mbpoll.refusal(HOLDING, 17, 1), "Illegal data address")


def main():
    if not shutil.which("mbpoll"):
        peer.skip("mbpoll is missing; run scripts/install-packages test")
    command = sys.argv[1:]
    checks = peer.Checks()
    with peer.running_node(command) as port:
        compare(Mbpoll(port), checks)
    checks.done(f"mbpoll reads and writes every table of {pathlib.Path(command[0]).name}")


main()
