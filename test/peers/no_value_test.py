#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A server of pymodbus that has no value, as a SunSpec inverter at night: `coupler dump` and `coupler record` say so, and a
node that plays the recording gives the same registers.

    no_value_test.py NODE COUPLER
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import time

import peer

try:
    import foreign_server
except ImportError as error:
    peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")
from recording import Node, Recorder, values

MAP = """name: inverter
timeout: 20s
rate: 20
verify: off
wordorder_reverse: true
mapping:
  input_registers:
    temp: {address: 10, type: INT, scale: 0.1, units: °C, invalid: 0x8000}
    volt: {address: 11, type: UINT, scale: 0.1, units: V, invalid: 0xFFFF}
    pow:  {address: 12, type: DINT, units: W, invalid: 0x80000000}
    real: {address: 14, type: REAL, invalid: nan}
    also: {address: 16, type: REAL}
    watt: {address: 18, type: INT, units: W, scale: {exponent_of: watt_sf}, invalid: 0x8000}
    watt_sf: {address: 19, type: INT, invalid: 0x8000}
"""
NIGHT = [0x8000, 0xFFFF, 0x8000, 0, 0x7FBF, 0xFF80, 0x7FC0, 0, 1234, 0x8000]  # a signalling NaN, and a quiet one that is meant
DAY = [215, 2304, 0, 4711, 0x3F80, 0, 0, 0, 1234, 0xFFFE]
NONE = ["temp", "volt", "pow", "real", "watt", "watt_sf"]


def registers(words):
    return dict(enumerate(words, 10))


def points(coupler, map_file, port, checks):
    done = subprocess.run([coupler, "dump", map_file, "--at", f"127.0.0.1:{port}", "--json"], capture_output=True, text=True,
                          encoding="utf-8", timeout=peer.PATIENCE, check=False)
    checks.equal("status of the dump", done.returncode, 0)
    return {point["point"]: point for point in json.loads(done.stdout)["points"]}


def is_dumped(coupler, map_file, device, port, checks):
    device.tables["input_registers"] = registers(NIGHT)
    night = points(coupler, map_file, port, checks)
    checks.equal("what has no value", [name for name, point in night.items() if point["invalid"]], NONE)
    checks.equal("no value, and no failure", {(night[name]["value"], night[name]["failed"]) for name in NONE}, {(None, False)})
    checks.equal("why", night["temp"]["why"], "the device gives 0x8000, which the map calls invalid")
    checks.equal("NaN that is meant", (night["also"]["invalid"], night["also"]["text"]), (False, "nan"))
    device.tables["input_registers"] = registers(DAY)
    day = points(coupler, map_file, port, checks)
    checks.equal("by day", [day[name]["value"] for name in NONE], [21.5, 230.4, 4711, 1.0, 12.34, -2])


def is_recorded_and_played(node, coupler, map_file, device, port, folder, checks):
    file = folder / "day.jsonl"
    device.tables["input_registers"] = registers(NIGHT)
    with Recorder(coupler, map_file, port, file) as recorder:
        recorder.await_lines("the night", lambda lines: {line.get("quality") for line in lines if "point" in line} >= {"invalid"},
                             checks)
        device.tables["input_registers"] = registers(DAY)
        recorder.await_value("watt", 12.34, checks)
        time.sleep(0.3)
        device.tables["input_registers"] = registers(NIGHT)
        lines = recorder.await_value("watt", None, checks)
        checks.equal("status of the recorder", recorder.end(), 0)
    checks.equal("temp comes and goes", values(lines, "temp"), [None, 21.5, None])
    checks.equal("registers of no value", [line["registers"] for line in lines if line.get("point") == "real"],
                 [[0x7FBF, 0xFF80], [0x3F80, 0], [0x7FBF, 0xFF80]])
    with Node(node, "--replay", file, "--loop") as played:
        client = peer.pymodbus_client(played.port)
        seen = []

        def sees_both():
            seen.append(client.read_input_registers(10, 10, 1).registers)
            return NIGHT in seen and DAY in seen

        peer.await_true("the same registers", sees_both, checks)
        client.close()


def main():
    node, coupler = sys.argv[1:]
    checks = peer.Checks()
    device = foreign_server.Device({"input_registers": registers(NIGHT)})
    with tempfile.TemporaryDirectory() as name, foreign_server.serving(device) as port:
        folder = pathlib.Path(name)
        map_file = folder / "inverter.yaml"
        map_file.write_text(MAP, encoding="utf-8")
        is_dumped(coupler, map_file, device, port, checks)
        is_recorded_and_played(node, coupler, map_file, device, port, folder, checks)
    checks.done("what a device gives for no value is told as none")


main()
