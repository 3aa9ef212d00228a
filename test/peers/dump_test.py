#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`coupler dump` shows what a device of pymodbus holds, says what it does not have, and writes nothing to it.

    dump_test.py COUPLER MAP NODE_COMMAND…
"""
import json
import os
import pathlib
import pty
import re
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

import peer

try:
    from pymodbus.constants import Endian
    from pymodbus.datastore import ModbusSequentialDataBlock, ModbusSlaveContext
    from pymodbus.payload import BinaryPayloadBuilder
except ImportError as error:
    peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")
if not shutil.which("mbpoll"):
    peer.skip("mbpoll is missing; run scripts/install-packages test")

# The device is the one of the driver's tests.
sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "ros"))
from support import peer as foreign  # noqa: E402

READS = {1, 2, 3, 4}


class Store(ModbusSlaveContext):
    """Has holes (exception 02) and what fails (exception 04), and remembers the functions that it was asked for."""

    def __init__(self):
        tables = {key: ModbusSequentialDataBlock(0, [0] * 100) for key in ("di", "co", "hr", "ir")}
        super().__init__(zero_mode=True, **tables)
        self.holes = {(4, 6), (3, 10), (3, 11), (3, 12), (1, 5)}
        self.failing = {(2, 2)}
        self.asked = set()

    def validate(self, fc_as_hex, address, count=1):
        self.asked.add(fc_as_hex)
        if any((fc_as_hex, at) in self.holes for at in range(address, address + count)):
            return False
        return super().validate(fc_as_hex, address, count)

    def getValues(self, fc_as_hex, address, count=1):
        if any((fc_as_hex, at) in self.failing for at in range(address, address + count)):
            raise RuntimeError("behind this one something is broken")
        return super().getValues(fc_as_hex, address, count)


def registers(**values):
    builder = BinaryPayloadBuilder(byteorder=Endian.Big, wordorder=Endian.Big)
    for kind, value in values.items():
        getattr(builder, f"add_{kind}")(value)
    return builder.to_registers()


def device_with_values(port):
    device = foreign.Peer(port)
    device.store = Store()
    device.set("coils", 0, [1, 0, 1])
    device.set("coils", 9, [1])
    device.set("discrete_inputs", 0, [0, 1, 1, 1])
    device.set("input_registers", 0, registers(**{"32bit_float": 0.1}) + registers(**{"64bit_uint": 2**64 - 7}))
    device.set("input_registers", 7, registers(**{"16bit_int": 615}))
    device.set("holding_registers", 0, [7, 0xFFFF, 0x8000])
    device.set("holding_registers", 5, registers(string="pump 1\x1b[2J"))
    device.set("holding_registers", 13, [4711, 0x0008, 0xABCD])
    device.set("holding_registers", 16, registers(**{"32bit_int": -100000}))
    return device


HELD = {"c0": True, "c1": False, "c9": True, "d0": False, "d1": True, "d3": True, "level": 0.1, "total": 2**64 - 7,
        "temperature": 21.5, "curve": [7, -1, -32768], "label": "pump 1\x1b[2J", "mode": 4711, "ready": True,
        "count": 0xCD, "slow": -100000}
NOT_HELD = {"horn": (None, "write-only"), "faulty": (4, "exception 04 (server device failure)"),
            "absent": (2, "exception 02 (illegal data address)")}


def dump(coupler, *arguments):
    return subprocess.run([coupler, "dump", *map(str, arguments)], capture_output=True, text=True, encoding="utf-8",
                          timeout=peer.PATIENCE, check=False)


def values_are_those_of_the_device(coupler, map_file, device, checks):
    done = dump(coupler, map_file, "--at", f"127.0.0.1:{device.port}", "--json")
    checks.equal("status, with points that cannot be read", done.returncode, 3)
    look = json.loads(done.stdout)
    checks.equal("device", look["device"], f"tcp://127.0.0.1:{device.port}/3")
    checks.equal("identity", look["identity"], "foreign")
    points = {point["point"]: point for point in look["points"]}
    checks.equal("points", set(points), set(HELD) | set(NOT_HELD))
    for name, value in HELD.items():
        checks.equal(name, points[name]["value"], value)
        checks.equal(f"type of {name}", type(points[name]["value"]), type(value))
    for name, (code, why) in NOT_HELD.items():
        got = points[name]
        checks.equal(name, (got["value"], got["exception"], got["why"]), (None, code, why))
    checks.equal("what it says of the hole", any("from: 10, to: 12" in note for note in look["notes"]), True)

    table = dump(coupler, map_file, "--at", f"127.0.0.1:{device.port}").stdout
    for line in (r"  temperature  21\.5 °C +INT +input_registers +7 +30008\n",
                 r"  absent       - +UINT +input_registers +6 +30007 +not read: exception 02 \(illegal data address\)\n",
                 r'  label        "pump 1\\x1b\[2J" +STRING +holding_registers +5 – 9 +40006 – 40010\n',
                 r"  ready        true +BOOL +holding_registers +14, bit 3 +40015\n"):
        checks.equal(f"a line '{line}'", bool(re.search(line, table)), True)
    some = dump(coupler, map_file, "--at", f"127.0.0.1:{device.port}", "--points", "c*", "--json")
    checks.equal("only c*", [point["point"] for point in json.loads(some.stdout)["points"]],
                 ["c0", "c1", "c9", "curve", "count"])
    checks.equal("status, all read", some.returncode, 0)


def a_watchdog_of_the_map_is_left_alone(coupler, device, checks):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "bk.yaml")
        path.write_text("name: bk\npreset: beckhoff_bk9000\nwatchdog: {timeout: 500ms}\n"
                        "mapping: {coils: {lamp: 0}, discrete_inputs: {door: 0}}\n", encoding="utf-8")
        done = dump(coupler, path, "--at", f"127.0.0.1:{device.port}")
        checks.equal("status", done.returncode, 0)
        checks.equal("lamp and door", re.findall(r"(lamp|door) +(\w+)", done.stdout),
                     [("lamp", "true"), ("door", "false")])


class Watch:
    """`coupler dump --watch`, and the lines it has said."""

    def __init__(self, coupler, *arguments, every="0.1"):
        self.program = subprocess.Popen([coupler, "dump", *map(str, arguments), "--watch", every], text=True,
                                        encoding="utf-8", stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        self.lines = []
        self._news = threading.Condition()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        for line in self.program.stdout:
            with self._news:
                self.lines.append(line.rstrip("\n"))
                self._news.notify_all()

    def await_line(self, wanted, since=0):
        """The number of the first line from `since` on that is wanted; None: there was none."""
        def found():
            return next((i for i in range(since, len(self.lines)) if wanted(self.lines[i])), None)
        with self._news:
            self._news.wait_for(lambda: found() is not None, peer.PATIENCE)
            return found()

    def end(self):
        self.program.send_signal(signal.SIGINT)
        try:
            return self.program.wait(peer.PATIENCE)
        except subprocess.TimeoutExpired:
            self.program.kill()
            return self.program.wait()


def mbpoll_writes(port, register, value):
    done = subprocess.run(["mbpoll", "-m", "tcp", "-p", str(port), "-a", "3", "-0", "-1", "-o", "10", "-t", "4",
                           "-r", str(register), "127.0.0.1", str(value)], capture_output=True, text=True,
                          timeout=peer.PATIENCE, check=False)
    return "Written" in done.stdout


def changes_are_told_line_by_line(coupler, map_file, device, checks):
    watch = Watch(coupler, map_file, "--at", f"127.0.0.1:{device.port}")

    def await_end(end, since=0):
        at = watch.await_line(lambda line: line.endswith(end), since)
        checks.equal(f"a line '{end}'", at is not None, True)
        return at if at is not None else since

    at = await_end(" slow -100000")
    checks.equal("the change", mbpoll_writes(device.port, 13, 777), True)
    at = await_end(" mode 777", at)
    at = watch.await_line(lambda line: "mode 777" in line, at) or 0
    checks.equal("nothing else was told", watch.lines[at - 1].endswith(" slow -100000"), True)
    device.stop()
    gone = watch.await_line(lambda line: " offline: " in line, at)
    checks.equal("offline is told", gone is not None, True)
    device.set("holding_registers", 13, [42])
    device.start()
    back = await_end(" online again", gone or at)
    checks.equal("no value meanwhile", [line for line in watch.lines[gone + 1:back] if " offline: " not in line], [])
    await_end(" mode 42", back)
    checks.equal("every line has its time", [line for line in watch.lines if not re.match(
        r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z \S", line)], [])
    checks.equal("status after SIGINT", watch.end(), 0)


def changes_are_told_as_json(coupler, map_file, device, checks):
    watch = Watch(coupler, map_file, "--at", f"127.0.0.1:{device.port}", "--json")

    def point(line, name):
        return next(point for point in json.loads(line)["points"] if point["point"] == name)

    at = watch.await_line(lambda line: point(line, "mode")["value"] == 42)
    checks.equal("a first look", at is not None and not point(watch.lines[at], "mode")["changed"], True)
    device.set("holding_registers", 13, [43])
    at = watch.await_line(lambda line: point(line, "mode")["changed"])
    checks.equal("the change", at is not None and point(watch.lines[at], "mode")["value"], 43)
    device.stop()
    at = watch.await_line(lambda line: not json.loads(line)["online"])
    at = watch.await_line(lambda line: not json.loads(line)["online"], (at or 0) + 1)  # the first may have a part
    checks.equal("no value of an offline device is shown",
                 at is not None and {point["value"] for point in json.loads(watch.lines[at])["points"]}, {None})
    device.start()
    at = watch.await_line(lambda line: json.loads(line)["online"], at)
    checks.equal("online again", at is not None and point(watch.lines[at], "mode")["value"], 43)
    checks.equal("status after SIGINT", watch.end(), 0)


def without_a_number_it_looks_once_a_second(coupler, map_file, device, checks):
    began = time.monotonic()
    with subprocess.Popen([coupler, "dump", map_file, "--at", f"127.0.0.1:{device.port}", "--watch", "--json"],
                          stdout=subprocess.PIPE, text=True) as program:
        for _ in range(3):
            program.stdout.readline()
        passed = time.monotonic() - began
        program.terminate()
    checks.equal(f"seconds until the third look, at least 1.9: {passed:.1f}", passed > 1.9, True)


def a_terminal_is_drawn_over(coupler, map_file, device, checks):
    ours, its = pty.openpty()
    program = subprocess.Popen([coupler, "dump", map_file, "--at", f"127.0.0.1:{device.port}", "--watch", "0.1"],
                               stdin=its, stdout=its, stderr=its, env={**os.environ, "TERM": "xterm"})
    os.close(its)
    seen = bytearray()

    def await_text(text):
        end = time.monotonic() + peer.PATIENCE
        while text not in seen and time.monotonic() < end:
            if select.select([ours], [], [], 1)[0]:
                seen.extend(os.read(ours, 65536))
        return text in seen

    checks.equal("a frame at the top of the screen", await_text(b"\x1b[2J\x1b[Hdump at tcp://"), True)
    checks.equal("the value", await_text(b"  mode         43 "), True)
    device.set("holding_registers", 13, [44])
    checks.equal("the change is marked", await_text(b"\x1b[1m* mode         44 "), True)
    device.stop()
    checks.equal("offline", await_text(b": offline: "), True)
    checks.equal("the value goes", await_text(b"  mode         - "), True)
    device.start()
    seen.clear()
    checks.equal("the value comes back", await_text(b"  mode         44 "), True)
    program.send_signal(signal.SIGINT)
    checks.equal("the terminal wraps lines again", await_text(b"\x1b[?7h"), True)
    checks.equal("status after SIGINT", program.wait(peer.PATIENCE), 0)
    os.close(ours)


def a_node_needs_no_file(coupler, command, checks):
    with peer.running_node(command) as port:
        where = f"tcp://127.0.0.1:{port}"
        client = peer.pymodbus_client(port)
        client.write_coils(0, [True, False, True], 1)
        client.write_registers(0, registers(**{"16bit_int": -5}) + registers(**{"32bit_uint": 3000000000}), 1)
        client.close()
        done = dump(coupler, where, "--json")
        checks.equal("status", done.returncode, 0)
        look = json.loads(done.stdout)
        values = {point["point"]: point["value"] for point in look["points"]}
        checks.equal("identity", look["identity"], "equal")
        checks.equal("values", [values[name] for name in ("c0", "c1", "c2", "d0", "setpoint", "limit", "total")],
                     [True, False, True, True, -5, 3000000000, 305419896])
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "other.yaml")
            path.write_text("name: other\nwordorder_reverse: true\nmapping:\n  coils: {c0: 0, c1: 2, gone: 40}\n",
                            encoding="utf-8")
            other = dump(coupler, path, "--at", f"127.0.0.1:{port}")
        checks.equal("status, another map", other.returncode, 3)
        checks.equal("what is the same is read", re.findall(r"^  (c0|c1|gone) +(\w+|-)", other.stdout, re.M),
                     [("c0", "true"), ("c1", "-"), ("gone", "-")])
        checks.equal("what is not the same is told", [text in other.stdout for text in (
            "the map differs from the device's", "not in the device's map",
            "different in the device's map: address 2 -> 1")], [True] * 3)
    with peer.silent_port() as port:
        done = dump(coupler, f"tcp://127.0.0.1:{port}")
    checks.equal("status, no node", done.returncode, 3)


def a_nodes_watchdog_stays_idle(coupler, node, checks):
    here = pathlib.Path(__file__).resolve().parent
    with peer.running_node([node, str(here / "watchdog.yaml"), "--sim"]) as port:
        checks.equal("status", dump(coupler, f"tcp://127.0.0.1:{port}").returncode, 0)
        client = peer.pymodbus_client(port)
        checks.equal("the watchdog is idle", client.read_input_registers(0xFF0B, 1, 1).registers, [1])
        client.close()


def changes_of_a_node_are_told_as_they_come(coupler, node, checks):
    """Between two looks that are an hour apart."""
    here = pathlib.Path(__file__).resolve().parent
    with peer.running_node([node, str(here / "schedule.yaml"), "--sim"]) as port:
        watch = Watch(coupler, f"tcp://127.0.0.1:{port}", "--points", "motor,motor_runs,ejector", every="3600")
        client = peer.pymodbus_client(port)
        checks.equal("a first look", watch.await_line(lambda line: line.endswith(" motor_runs false")) is not None, True)
        for coil, level in ((0, True), (0, False), (3, True)):
            checks.equal("pymodbus writes", client.write_coil(coil, level, 1).isError(), False)
        client.close()
        last = watch.await_line(lambda line: line.endswith(" ejector false"), 3)
        told = [line.split(" ", 1)[1] for line in watch.lines[3:(last or 0) + 1]]
        for point in ("motor", "motor_runs", "ejector"):
            checks.equal(f"{point}: each change, a pulse's end too", [line for line in told if line.startswith(point + " ")],
                         [f"{point} true", f"{point} false"])
        os.kill(peer.the_worker(), signal.SIGKILL)  # another one serves after 100 ms
        gone = watch.await_line(lambda line: " offline: " in line, last or 0)
        back = watch.await_line(lambda line: line.endswith(" online again"), gone or 0)
        checks.equal("the short loss is told, then everything anew", watch.await_line(
            lambda line: line.endswith(" ejector false"), back or len(watch.lines)) is not None, True)
        checks.equal("status after SIGINT", watch.end(), 0)


def a_node_that_is_gone_is_looked_for_soon(coupler, node, checks):
    """However far apart the looks are: what changes between them is not told meanwhile."""
    here = pathlib.Path(__file__).resolve().parent
    command = [node, str(here / "schedule.yaml"), "--sim"]
    with peer.silent_port() as port:
        with peer.running_node(command, port):
            watch = Watch(coupler, f"tcp://127.0.0.1:{port}", "--points", "motor", every="3600")
            checks.equal("a first look", watch.await_line(lambda line: line.endswith(" motor false")) is not None, True)
        gone = watch.await_line(lambda line: line.endswith(" Connection refused"))
        with peer.running_node(command, port):
            back = watch.await_line(lambda line: line.endswith(" online again"), gone or 0)
            checks.equal("it is back, and told", back is not None, True)
            checks.equal("status after SIGINT", watch.end(), 0)


def main():
    coupler, map_file, command = sys.argv[1], sys.argv[2], sys.argv[3:]
    checks = peer.Checks()
    # Stopped and started again, it has the same port.
    with peer.silent_port() as port, device_with_values(port) as device:
        values_are_those_of_the_device(coupler, map_file, device, checks)
        a_watchdog_of_the_map_is_left_alone(coupler, device, checks)
        checks.equal("functions that the device was asked for", device.store.asked, READS)
        changes_are_told_line_by_line(coupler, map_file, device, checks)
        checks.equal("the device would tell of a write: mbpoll's", device.store.asked - READS, {6})
        device.store.asked.clear()
        changes_are_told_as_json(coupler, map_file, device, checks)
        without_a_number_it_looks_once_a_second(coupler, map_file, device, checks)
        a_terminal_is_drawn_over(coupler, map_file, device, checks)
        checks.equal("functions that the device was asked for by --watch", device.store.asked, READS)
    a_node_needs_no_file(coupler, command, checks)
    a_nodes_watchdog_stays_idle(coupler, command[0], checks)
    changes_of_a_node_are_told_as_they_come(coupler, command[0], checks)
    a_node_that_is_gone_is_looked_for_soon(coupler, command[0], checks)
    checks.done("coupler dump shows what pymodbus and a node hold, tells changes, and writes nothing")


main()
