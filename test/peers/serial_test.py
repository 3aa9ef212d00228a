#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`coupler dump`, `probe` and `status` read units of pymodbus and libmodbus on a serial line, and over TCP with the same
frames.

    serial_test.py COUPLER
"""
import contextlib
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
from panel_client import Page, Panel, is_left_out  # noqa: E402
from support.libmodbus_server import LibmodbusServer  # noqa: E402
from support.rtu_server import RtuServer  # noqa: E402
from support.serial_line import SerialLine  # noqa: E402

coupler = sys.argv[1]
checks = peer.Checks()
UNIT = 17
IDENTITY, IDENTITY_SIZE = 0xFF00, 85
SETTINGS = "?baud=115200&parity=none"
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
    return subprocess.run([coupler, *map(str, arguments)], capture_output=True, text=True, encoding="utf-8",
                          timeout=peer.PATIENCE, check=False)


def status(*arguments):
    return run("status", "--timeout", "20", *arguments)


@contextlib.contextmanager
def unit_on_a_line(server_class, *arguments, **options):
    """The line and the server."""
    line = SerialLine()
    try:
        server = server_class(*arguments, line.device, **options)
        fill(server)
        try:
            yield line, server
        finally:
            server.end()
    finally:
        line.end()


def dumped(*arguments):
    done = run("dump", *arguments, "--json")
    if not done.stdout:
        return done.stderr
    return {point["point"]: point["value"] for point in json.loads(done.stdout)["points"]}


def libmodbus_is_read(path):
    """It leaves FC 43 unanswered."""
    with contextlib.ExitStack() as stack:
        try:
            line, _ = stack.enter_context(unit_on_a_line(LibmodbusServer, UNIT))
        except OSError as error:
            print(f"not tried here: libmodbus as a server ({error})")
            return
        at = f"rtu:{line.port}/{UNIT}{SETTINGS}"
        checks.equal("libmodbus: dump", dumped(path, "--at", at), VALUES)
        found = run("probe", line.port, "--units", "16-17", "--baud", "115200", "--parity", "none", "--to", "120",
                    "--rate", "1000", "--timeout", "4")
        checks.equal("libmodbus: probe finds the unit", f"units that answer at 115200 8N1: {UNIT}\n" in found.stdout, True)
        checks.equal("libmodbus: and where its tables end", found.stdout.count("readable: 0 … 99\n"), 4)
        said = status(at)
        checks.equal("libmodbus: status", (said.returncode, "is a foreign coupler" in said.stderr), (1, True))


def a_node_says_what_it_is():
    """What the registers of a node say, at a unit of a serial line: as a gateway in front of the node has it."""
    command = [pathlib.Path(coupler).with_name("coupler-node"), pathlib.Path(__file__).with_name("watchdog.yaml"), "--sim"]
    with unit_on_a_line(RtuServer, [UNIT], size=65536) as (line, server):
        with peer.running_node(list(map(str, command))) as port:
            client = peer.pymodbus_client(port)
            server.set(UNIT, 4, IDENTITY, client.read_input_registers(IDENTITY, IDENTITY_SIZE, 1).registers)
            client.close()
            there = json.loads(status(f"127.0.0.1:{port}", "--json").stdout)
        done = status(f"rtu:{line.port}/{UNIT}{SETTINGS}", "--json")
        checks.equal("status of a node: exit status", (done.returncode, done.stderr), (0, ""))
        here = json.loads(done.stdout)
        checks.equal("status of a node: the device", here["device"].startswith(f"rtu:{line.port}/{UNIT}"), True)
        for key in ("node", "trouble", "fingerprint", "hostname", "serial", "functions", "map"):
            checks.equal(f"status of a node: {key}", here[key], there[key])


def a_page_shows_the_line(path, server):
    if is_left_out(coupler):
        print("not tried here: coupler panel, which this build left out")
        return
    panel = Panel(coupler, path, None, "--write")
    with Page(panel) as page:
        for point, value in VALUES.items():
            page.await_value(point, value, checks)
        server.set(UNIT, 4, 5, [7])
        page.await_value("weight", 7, checks)
        checks.equal("a write by a page", panel.write(page.token, "motor", "false"), {"outcome": "ok", "text": "ok"})
        page.await_value("motor", False, checks)
        checks.equal("it has arrived", bool(server.get(UNIT, 1, 3)), False)
    checks.equal("the panel's end", panel.end(), 0)
    fill(server)


def a_damaged_request_is_told(path):
    with unit_on_a_line(RtuServer, [UNIT]) as (line, _):
        line.to_device = lambda data: data[:-1] + bytes([data[-1] ^ 1])
        impatient = path.with_name("impatient.yaml")  # no answer can come too late
        impatient.write_text(path.read_text().replace("timeout: 5", "timeout: 0.3"))
        done = run("dump", impatient, "--at", f"rtu:{line.port}/{UNIT}{SETTINGS}")
        checks.equal("a request that arrives damaged: the exit status", done.returncode, 3)
        checks.equal("it says that nothing answers", "no reply within" in done.stderr, True)


def a_unit_is_found_by_its_port():
    """A line without hardware has one rate; what counts is that units are asked until one answers."""
    with unit_on_a_line(RtuServer, [UNIT]) as (line, _):
        found = run("probe", line.port, "--units", f"{UNIT - 1}-{UNIT + 1}", "--baud", "9600,115200", "--parity", "none",
                    "--to", "20", "--rate", "1000", "--timeout", "4")
        checks.equal("probe by the device's path: the unit", f"units that answer at 9600 8N1: {UNIT}\n" in found.stdout, True)


def a_unit_is_read(folder, path, line, server):
    at = f"rtu:{line.port}/{UNIT}{SETTINGS}"
    checks.equal("the unit of the map", dumped(path), VALUES)
    checks.equal("the same by --at", dumped(path, "--at", at), VALUES)
    said = status(at)
    checks.equal("status of a foreign unit", (said.returncode, "is a foreign coupler" in said.stderr), (1, True))

    line.to_port = lambda data: b"\xff\x00\x03" + data
    checks.equal("noise before each piece of a reply", dumped(path), VALUES)
    line.to_port = lambda data: data
    line.echoes = True
    checks.equal("a line that hands back what is sent", dumped(path), VALUES)
    line.echoes = False

    probed = run("probe", at, "--to", "99", "--rate", "1000", "--timeout", "5", "--out", "-")
    wanted = f'serial: {{device: "{line.port}", baud: 115200, parity: none'
    checks.equal("probe: the draft has the port", wanted in probed.stdout, True)
    checks.equal("probe: the draft has the unit", f"unit: {UNIT}" in probed.stdout, True)

    a_page_shows_the_line(path, server)

    twice = run("probe", f"rtu:{line.port}/{UNIT}", "--units", "15-18")
    checks.equal("units in two places", (twice.returncode, "leave one of them out" in twice.stderr), (2, True))
    nowhere = run("probe", "ttyUSB0")
    checks.equal("a port without its folder", (nowhere.returncode, "rtu:/dev/ttyUSB0" in nowhere.stderr), (2, True))

    over_tcp = RtuServer([UNIT])
    fill(over_tcp)
    checks.equal("RTU over TCP", dumped(path, "--at", f"rtu+tcp://127.0.0.1:{over_tcp.port}/{UNIT}"), VALUES)
    over_tcp.end()

    refused = run("dump", path, "--at", f"rtu:{line.port}/{UNIT}?baud=9601")
    checks.equal("a rate that no port has: the exit status", refused.returncode, 2)
    elsewhere = folder / "elsewhere.yaml"
    elsewhere.write_text(MAP.format(port="/dev/ttyUSB_none", unit=UNIT))
    checks.equal("a port that is not there", "there is no such port" in run("dump", elsewhere).stderr, True)


def main():
    with tempfile.TemporaryDirectory() as name, unit_on_a_line(RtuServer, [UNIT]) as (line, server):
        path = pathlib.Path(name, "belt.yaml")
        path.write_text(MAP.format(port=line.port, unit=UNIT))
        peer.side_by_side((a_unit_is_read, path.parent, path, line, server), (libmodbus_is_read, path),
                          (a_node_says_what_it_is,), (a_damaged_request_is_told, path), (a_unit_is_found_by_its_port,))
    checks.done("dump, probe and status, RTU over a serial line and over TCP")


main()
