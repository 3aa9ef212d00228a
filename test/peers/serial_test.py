#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`coupler dump` and `coupler probe` read a unit of pymodbus on a serial line, and over TCP with the same frames.

    serial_test.py COUPLER
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import peer

try:
    import serial  # noqa: F401 (pymodbus needs it)
    import serial_asyncio  # noqa: F401
    import pymodbus  # noqa: F401
except ImportError as error:
    peer.skip(f"python3-pymodbus or python3-serial is missing ({error}); run scripts/install-packages test")

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "ros"))
from support.rtu_server import RtuServer  # noqa: E402
from support.serial_line import SerialLine  # noqa: E402

coupler = sys.argv[1]
checks = peer.Checks()
UNIT = 17
MAP = """
name: belt
serial: {{device: {port}, baud: 115200, parity: none}}
unit: {unit}
timeout: 5
mapping:
  coils: {{motor: 3}}
  discrete_inputs: {{barrier: 4}}
  input_registers: {{weight: {{address: 5, type: INT}}}}
  holding_registers: {{speed: {{address: 6, type: REAL}}, many: {{address: 10, type: UINT, count: 60}}}}
"""
VALUES = {"motor": True, "barrier": True, "weight": -5, "speed": 2.5, "many": list(range(1000, 1060))}


def fill(server):
    server.set(UNIT, 1, 3, [1])
    server.set(UNIT, 2, 4, [1])
    server.set(UNIT, 4, 5, [0xFFFB])
    server.set(UNIT, 3, 6, [0x0000, 0x4020])
    server.set(UNIT, 3, 10, VALUES["many"])


def run(*arguments):
    return subprocess.run([coupler, *arguments], capture_output=True, text=True, timeout=peer.PATIENCE)


def dumped(*arguments):
    done = run("dump", *arguments, "--json")
    if not done.stdout:
        return done.stderr
    return {point["name"]: point.get("value") for point in json.loads(done.stdout)["points"]}


line = SerialLine()
server = RtuServer([UNIT], line.device)
fill(server)
with tempfile.TemporaryDirectory() as folder:
    path = pathlib.Path(folder, "belt.yaml")
    path.write_text(MAP.format(port=line.port, unit=UNIT))
    settings = "?baud=115200&parity=none"
    checks.equal("the unit of the map", dumped(path), VALUES)
    checks.equal("the same by --at", dumped(path, "--at", f"rtu:{line.port}/{UNIT}{settings}"), VALUES)

    line.to_port = lambda data: b"\xff\x00\x03" + data
    checks.equal("noise before each piece of a reply", dumped(path), VALUES)
    line.to_port = lambda data: data
    line.echoes = True
    checks.equal("a line that hands back what is sent", dumped(path), VALUES)
    line.echoes = False

    line.to_device = lambda data: data[:-1] + bytes([data[-1] ^ 1])
    done = run("dump", str(path), "--at", f"rtu:{line.port}/{UNIT}{settings}")
    checks.equal("a request that arrives damaged: the exit status", done.returncode, 3)
    checks.equal("it says that nothing answers", "no reply within" in done.stderr, True)
    line.to_device = lambda data: data

    probed = run("probe", f"rtu:{line.port}/{UNIT}{settings}", "--to", "99", "--rate", "1000", "--timeout", "5", "--out", "-")
    wanted = f'serial: {{device: "{line.port}", baud: 115200, parity: none'
    checks.equal("probe: the draft has the port", wanted in probed.stdout, True)
    checks.equal("probe: the draft has the unit", f"unit: {UNIT}" in probed.stdout, True)

    # A line without hardware has one rate; what counts is that units are asked until one answers.
    found = run("probe", line.port, "--units", "15-18", "--baud", "9600,115200", "--parity", "none", "--to", "20",
                "--rate", "1000", "--timeout", "1")
    checks.equal("probe by the device's path: the unit", f"unit {UNIT}" in found.stdout or f"/{UNIT}" in found.stdout, True)

    over_tcp = RtuServer([UNIT])
    fill(over_tcp)
    checks.equal("RTU over TCP", dumped(path, "--at", f"rtu+tcp://127.0.0.1:{over_tcp.port}/{UNIT}"), VALUES)
    over_tcp.end()

    refused = run("dump", str(path), "--at", f"rtu:{line.port}/{UNIT}?baud=9601")
    checks.equal("a rate that no port has: the exit status", refused.returncode, 2)
    path.write_text(MAP.format(port="/dev/ttyUSB_none", unit=UNIT))
    checks.equal("a port that is not there", "there is no such port" in run("dump", str(path)).stderr, True)
server.end()
line.end()
checks.done("dump and probe, RTU over a serial line and over TCP")
