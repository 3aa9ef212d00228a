#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`coupler record` writes what pymodbus does to a node, and what a server of pymodbus holds: each change, as JSON or
CSV, also when the device goes and when it answers with exceptions. It writes nothing to it.

    record_test.py NODE COUPLER MAP
"""
import csv
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

import peer

try:
    from pymodbus.constants import Endian
    from pymodbus.payload import BinaryPayloadBuilder
    import foreign_server
except ImportError as error:
    peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")
from recording import Node, Program, Recorder, utc, values, whole_lines

READS = {1, 2, 3, 4}
STEPS = [  # lamp, valve, setpoint, gain, label, raw pressure
    (True, False, 5, 0.1, "one", 217),
    (False, True, -32768, -1.5e30, "", -1),
    (True, True, 32767, 1.0, 'q"\\ , ;', 400),
]


def write_step(client, step, checks):
    lamp, valve, setpoint, gain, label, pressure = step
    registers = BinaryPayloadBuilder(byteorder=Endian.Big, wordorder=Endian.Big)
    registers.add_16bit_int(setpoint)
    registers.add_32bit_float(gain)
    registers.add_string(label.ljust(10, "\0"))
    registers.add_16bit_int(pressure)
    checks.equal("pymodbus writes coils", client.write_coils(0, [lamp, valve], 1).isError(), False)
    checks.equal("pymodbus writes registers", client.write_registers(0, registers.to_registers(), 1).isError(), False)


def changes_are_recorded_in_order(node, coupler, map_file, folder, checks):
    began = time.time()
    with Node(node, map_file) as device, Recorder(coupler, map_file, device.port, folder / "order.jsonl") as recorder:
        client = peer.pymodbus_client(device.port)
        recorder.await_value("setpoint", 0, checks)
        for step in STEPS:
            write_step(client, step, checks)
            recorder.await_value("setpoint", step[2], checks)
        for level in (False, True, False):  # faster than it is read: the node tells them
            client.write_coil(0, level, 1)
        recorder.await_lines("the last of them",
                             lambda lines: values(lines, "lamp_burns")[-3:] == [False, True, False], checks)
        client.close()
        checks.equal("status after SIGTERM", recorder.end(signal.SIGTERM), 0)
        checks.equal("status of the node", device.end(), 0)
    head, *lines = whole_lines(folder / "order.jsonl")
    setpoints, gains, pressures = ([step[i] for step in STEPS] for i in (2, 3, 5))
    lamps, valves = [False, True, False, True, False, True, False], [False, True]
    for point, wanted in (("lamp", lamps), ("lamp_burns", lamps), ("valve", valves), ("valve_closed", [True, False]),
                          ("level", [-2]), ("setpoint", [0, *setpoints]), ("gain", [0.0, *gains]),
                          ("label", ["", "one", "", 'q"\\ , ;']),
                          ("pressure", [-40.0] + [round(raw * 0.1 - 40, 1) for raw in pressures]),
                          ("curve", [[0] * 100]), ("secret", [])):
        checks.equal(f"values of {point}", values(lines, point), wanted)
        times = [line["t"] for line in lines if line.get("point") == point]
        checks.equal(f"t of {point} never decreases", times, sorted(times))
    registers = [line["registers"] for line in lines if line.get("point") == "pressure"]
    checks.equal("registers of pressures", registers, [[0], *([raw & 0xFFFF] for raw in pressures)])
    checks.equal("utc is the time of this test",
                 [line for line in [head, *lines] if not began - 2 <= utc(line["utc"]) <= time.time() + 2], [])
    states = [line["device"] for line in lines if "device" in line]
    checks.equal("the node was not lost since it was there", states[-2:] in (["lost", "online"], ["online"]), True)
    checks.equal("the last line", "end" in lines[-1], True)
    checks.equal("the map is in it, without 'security'",
                 ["curve: {address: 9" in head["map"], "security" in head["map"], "operator" in head["map"]],
                 [True, False, False])
    checked = subprocess.run([coupler, "check", map_file], capture_output=True, text=True, check=True).stdout
    checks.equal("the fingerprint is that of `coupler check`", head["fingerprint"] in checked, True)
    checks.equal("periods", {*head["periods"].values()}, {0.1})
    checks.equal("what is not recorded is said", head["not_recorded"], {"secret": "write-only"})


def a_device_goes_and_comes_back(node, coupler, map_file, folder, checks):
    with peer.silent_port() as port:
        with Node(node, map_file, port=port) as device:
            recorder = Recorder(coupler, map_file, port, folder / "back.jsonl")
            recorder.await_value("pressure", -40.0, checks)
            device.end()
        lines = recorder.await_lines("the loss", lambda lines: lines[-1].get("device") == "lost", checks)
        known = len(lines)
        with Node(node, map_file, port=port):
            recorder.await_lines("all values again", lambda lines: values(lines[known:], "curve"), checks)
            checks.equal("status after SIGINT", recorder.end(signal.SIGINT), 0)
            lines = recorder.lines()
    rest = [line for line in lines[known:] if line.get("device") != "lost"]  # it may tell of more than one attempt
    checks.equal("first it is online", rest[0].get("device"), "online")
    checks.equal("then there is each point", sorted(line["point"] for line in rest[1:] if "point" in line),
                 sorted(lines[0]["periods"]))
    checks.equal("a loss has its reason", all(line["why"] for line in lines if line.get("device") == "lost"), True)


FOREIGN = """name: foreign
rate: 20
timeout: 20s
mapping:
  coils: {c0: 0}
  holding_registers: {good: {address: 0, type: INT}, moody: {address: 50, type: INT}}
"""


class Moody(foreign_server.Device):
    """Something is broken behind address 50, now and then."""

    is_broken = False

    def getValues(self, fc_as_hex, address, count=1):
        if self.is_broken and address <= 50 < address + count:
            raise RuntimeError("pymodbus answers with exception 04")
        return super().getValues(fc_as_hex, address, count)


def an_exception_is_a_line(coupler, folder, checks):
    map_file = folder / "foreign.yaml"
    map_file.write_text(FOREIGN, encoding="utf-8")
    device = Moody({"coils": {0: 1}, "holding_registers": {0: 7, 50: 1}})
    with foreign_server.serving(device) as port, \
            Recorder(coupler, map_file, port, folder / "foreign.jsonl") as recorder:
        recorder.await_value("moody", 1, checks)
        device.is_broken = True
        recorder.await_value("moody", None, checks)
        device.tables["holding_registers"][50] = 2
        device.is_broken = False
        lines = recorder.await_value("moody", 2, checks)
        checks.equal("status", recorder.end(), 0)
    checks.equal("the exception", [(line["value"], line["quality"], line.get("exception"))
                                   for line in lines if line.get("point") == "moody"],
                 [(1, "good", None), (None, "exception", 4), (2, "good", None)])
    checks.equal("others", [values(lines, "c0"), values(lines, "good")], [[True], [7]])
    checks.equal("functions that pymodbus was asked for", {*device.functions} - READS, set())


def other_outputs(coupler, map_file, port, folder, checks):
    with Recorder(coupler, map_file, port, folder / "table.csv", "--csv") as recorder:
        peer.await_true("the values", lambda: recorder.file.exists() and ",curve," in recorder.file.read_text(), checks)
        checks.equal("status with --csv", recorder.end(signal.SIGINT), 0)
    with open(folder / "table.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    checks.equal("columns", {tuple(row) for row in rows}, {("t", "utc", "point", "value", "quality", "u")})
    checks.equal("a value", [row["value"] for row in rows if row["point"] == "level"], ["-2"])
    checks.equal("the last row", rows[-1]["quality"], "end")
    with Program(coupler, "record", map_file, "--at", f"127.0.0.1:{port}", "-o", "-",
                 stdout=subprocess.PIPE) as program:
        lines = iter(program.process.stdout.readline, "")
        checks.equal("standard output", any('"point":"level"' in line for line in lines), True)
        program.process.send_signal(signal.SIGTERM)
        checks.equal("its last line", list(lines)[-1].endswith('"end":true}\n'), True)
        checks.equal("status with -o -", program.wait(), 0)
    text = folder / "foreign.txt"
    text.write_text("dear diary\n", encoding="utf-8")
    with Recorder(coupler, map_file, port, text) as recorder:
        checks.equal("status with a file that is no recording", recorder.wait(), 2)
        checks.equal("which is named", "foreign.txt" in recorder.text(), True)
    checks.equal("and left alone", text.read_text(encoding="utf-8"), "dear diary\n")
    with peer.silent_port() as silent, Recorder(coupler, map_file, silent, folder / "never.jsonl") as recorder:
        recorder.await_lines("why", lambda lines: "refused" in (lines or [{}])[-1].get("why", ""), checks)
        checks.equal("status if the device was never reached", recorder.end(), 3)


def main():
    node, coupler, map_file = sys.argv[1:]
    checks = peer.Checks()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        with Node(node, map_file) as device:
            peer.side_by_side((changes_are_recorded_in_order, node, coupler, map_file, folder, checks),
                              (a_device_goes_and_comes_back, node, coupler, map_file, folder, checks),
                              (an_exception_is_a_line, coupler, folder, checks),
                              (other_outputs, coupler, map_file, device.port, folder, checks))
    checks.done("coupler record has each change of a node and of pymodbus, and writes nothing to it")


main()
