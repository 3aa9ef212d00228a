# SPDX-License-Identifier: Apache-2.0
"""Five random maps as whole programs against pymodbus: what the generated client sets is in the node's registers, what
pymodbus or the firmware puts there is what the client has.

    programs.py BIN TEST_BIN MAPS
"""
import pathlib
import re
import subprocess
import sys
import threading

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "peers"), str(HERE.parent / "ros")]

# pylint: disable=wrong-import-position
from peer import PATIENCE, Checks, silent_port, skip  # noqa: E402
from random_map import Map, PymodbusClient, masked  # noqa: E402

try:
    from support.peer import Peer
except ImportError:
    skip("pymodbus is not installed")

PROGRAMS = 5
ROUNDS = 14  # as many as a float has cases


class Program:
    """A child that answers a line to each line."""

    def __init__(self, *command):
        self.child = subprocess.Popen([str(part) for part in command], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                      stderr=subprocess.PIPE, text=True)
        self.said = []
        self._serving = threading.Event()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        for line in self.child.stderr:
            self.said.append(line)
            if re.search(r"serving .* on \S+:\d+", line):
                self._serving.set()
        self._serving.set()

    @property
    def port(self):
        self._serving.wait(PATIENCE)
        found = re.search(r"serving .* on \S+:(\d+)", "".join(self.said))
        if not found:
            raise SystemExit(f"FAILED: {self.child.args} does not serve:\n{''.join(self.said)}")
        return int(found[1])

    def ask(self, line):
        try:
            self.child.stdin.write(line + "\n")
            self.child.stdin.flush()
        except BrokenPipeError:
            pass
        return self.child.stdout.readline().strip() or f"ended: {''.join(self.said)}"

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.child.stdin.close()
        if self._serving.is_set() and self.child.poll() is None and "client" not in self.child.args:
            self.child.terminate()
        try:
            self.child.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self.child.kill()
            self.child.wait()
            raise
        self._reader.join(PATIENCE)


def client_of(bin_, tested, port):
    return Program(bin_ / "random_end", "client", tested.name, port)


def node_and_client(tested, node, client, pymodbus, checks):
    """`node` names it in messages."""
    for number in range(ROUNDS):
        checks.equal(f"{node}: the client sets {number}", client.ask(f"set {number}"), "ok")
        for i, point in tested.readable():
            raw = tested.raw(i, number)
            if raw is not None:
                checks.equal(f"{node}: {point['name']} in round {number}", masked(point, pymodbus.get(point)), raw)
    for number in range(ROUNDS):
        for i, point in tested.readable():
            case = tested.case(i, number)
            raw = case["raw"] if "bits" in point else [int(word, 16) for word in case["raw"]]
            checks.equal(f"{node}: pymodbus writes {point['name']}", pymodbus.put(point, raw), True)
        checks.equal(f"{node}: the client has {number}", client.ask(f"get {number} outputs"), "ok")


def firmware_shows(tested, firmware, client, pymodbus, checks):
    for number in range(ROUNDS):
        checks.equal(f"firmware shows {number}", firmware.ask(f"show {number}"), "ok")
        for i, point in enumerate(tested.points):
            raw = tested.raw(i, number)
            others = tested.latched | tested.counters | tested.simulated
            if raw is None or point["access"] != "read" or point["name"] in others:
                continue
            checks.equal(f"firmware: {point['name']} in round {number}", masked(point, pymodbus.get(point)), raw)


def foreign_server(tested, bin_, checks):
    """The client against a server of pymodbus, which holds what it is given."""
    with silent_port() as port, Peer(port) as server, client_of(bin_, tested, server.port) as client:
        def get(point):
            return masked(point, [int(word) for word in
                                  server.get(point["table"], point["address"], len(point["cases"][0]["raw"]))])
        for number in range(ROUNDS):
            checks.equal(f"{tested.name}: the client sets {number}", client.ask(f"set {number}"), "ok")
            for i, point in tested.settable():
                raw = tested.raw(i, number)
                if raw is not None:
                    checks.equal(f"{tested.name}: {point['name']} at pymodbus", get(point), raw)
        for number in range(ROUNDS):
            for i, point in enumerate(tested.points):
                raw = [word if "bits" in point else int(word, 16) for word in tested.case(i, number)["raw"]]
                if "mask" in point:
                    old, = server.get(point["table"], point["address"])
                    raw = [int(old) & ~int(point["mask"], 16) | raw[0]]
                server.set(point["table"], point["address"], raw)
            checks.equal(f"{tested.name}: the client has what pymodbus holds in round {number}",
                         client.ask(f"get {number}"), "ok")


def main():
    coupler_bin, test_bin, folder = (pathlib.Path(argument) for argument in sys.argv[1:])
    checks = Checks()
    for index in range(PROGRAMS):
        tested = Map(coupler_bin / "coupler", folder / f"random_{index}.yaml")
        nodes = {"generated node": [test_bin / f"{tested.name}_node"],
                 "run-time node": [coupler_bin / "coupler-node", tested.path],
                 "firmware": [test_bin / "random_end", "firmware", tested.name]}
        for node, command in nodes.items():
            with Program(*command, *tested.options) as program:
                pymodbus = PymodbusClient(program.port)
                with client_of(test_bin, tested, program.port) as client:
                    node_and_client(tested, f"{tested.name}, {node}", client, pymodbus, checks)
                    if node == "firmware":
                        firmware_shows(tested, program, client, pymodbus, checks)
                pymodbus.client.close()
        foreign_server(tested, test_bin, checks)
    checks.done(f"{PROGRAMS} random maps as programs, against each other and pymodbus")


main()
