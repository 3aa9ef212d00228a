#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What `coupler import pymodbus` makes of a configuration of pymodbus' simulator reads what that simulator serves: each of
its registers once, in the right table, with the value that the simulator itself shows, and writable where it may be.

    simulator_test.py COUPLER PYTHON_WITH_PYMODBUS
"""
import contextlib
import json
import pathlib
import struct
import subprocess
import sys
import tempfile

import yaml

HERE = pathlib.Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / "peers"))
import peer  # noqa: E402  pylint: disable=wrong-import-position

REGISTERS = {"bits": 1, "uint16": 1, "uint32": 2, "float32": 2, "float64": 4}
PREFIX = {"coils": "co_", "discrete_inputs": "di_", "input_registers": "ir_", "holding_registers": "hr_"}


@contextlib.contextmanager
def simulator(python, device):
    """Yields its port and what it says it holds."""
    command = [python, str(HERE / "serve.py"), str(HERE / "device.json"), device]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as server:
        try:
            said = server.stdout.readline()
            if not said:
                print(f"FAILED: {' '.join(command)} did not start")
                sys.exit(1)
            yield json.loads(said)
        finally:
            server.stdin.close()
            if server.wait(peer.PATIENCE) != 0:
                print(f"FAILED: {' '.join(command)} ended with status {server.returncode}")
                sys.exit(1)


def setup_of(device):
    return json.loads((HERE / "device.json").read_text(encoding="utf-8"))["device_list"][device]["setup"]


def place_of(register, kind, writable, setup):
    """Table, and the register in it. Without shared blocks: "co", "di", "ir" and "hr" one behind the other."""
    if setup["shared blocks"]:
        if kind != "bits":
            return "holding_registers", register
        return ("coils" if writable else "discrete_inputs"), register
    for table, size in zip(PREFIX, ("co size", "di size", "ir size", "hr size")):
        if register < setup[size]:
            return table, register
        register -= setup[size]
    raise ValueError("past the last register")


def elements(value):
    return value if isinstance(value, list) else [value]


def same(kind, shown, read):
    """The simulator's text of a value, and what coupler dump read: numbers, or the bits of registers."""
    if kind == "string":
        return read == shown
    if kind == "float32":
        return struct.pack(">f", float(shown)) == struct.pack(">f", read)
    if kind == "float64":
        return float(shown) == read
    return int(shown, 0) == read


def compare(device, told, imported, dumped, checks):
    """Every defined register is one point's, or a part of it."""
    setup = setup_of(device)
    points = {}  # by table and register: name, index of the element
    for table, entries in imported["mapping"].items():
        for name, entry in entries.items():
            keys = entry if isinstance(entry, dict) else {"address": entry}
            count = keys.get("count", 1)
            if table in ("coils", "discrete_inputs"):
                for i in range(count // 16):
                    points[table, keys["address"] // 16 + i] = name, i, keys
            else:
                size = {"WORD": 1, "UINT": 1, "UDINT": 2, "REAL": 2, "LREAL": 4, "STRING": 1}[keys["type"]]
                for i in range(count):
                    points[table, keys["address"] + i * size] = name, i, keys
    values = {point["point"]: point for point in dumped["points"]}
    for register, kind, writable, shown in told["cells"]:
        table, at = place_of(register, kind, writable, setup)
        what = f"{device} register {register} ({kind})"
        checks.equal(f"{what} is in the map", (table, at) in points, True)
        if (table, at) not in points:
            continue
        name, index, keys = points.pop((table, at))
        read = elements(values[name]["value"])
        if table in ("coils", "discrete_inputs"):
            read = sum(bit << i for i, bit in enumerate(read[16 * index:16 * index + 16]))
        elif kind == "bits":  # a WORD
            read = sum(bit << i for i, bit in enumerate(read)) if len(read) == 16 else read[index]
        else:
            read = read[index]
        checks.equal(f"{what}: {shown} is {read}", same(kind, shown, read), True)
        if table in ("coils", "holding_registers"):
            checks.equal(f"{what} can be written", "access" not in keys, writable)
    checks.equal(f"{device}: points of nothing", points, {})


def main():
    coupler, python = sys.argv[1:3]
    checks = peer.Checks()
    for device in ("shared", "blocks"):
        with simulator(python, device) as told, tempfile.TemporaryDirectory() as folder:
            map_file = pathlib.Path(folder, "map.yaml")
            subprocess.run([coupler, "import", "pymodbus", HERE / "device.json", "--device", device, "--out", map_file],
                           check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            done = subprocess.run([coupler, "dump", map_file, "--at", f"127.0.0.1:{told['port']}", "--json"], text=True,
                                  capture_output=True, timeout=peer.PATIENCE, check=False)
            checks.equal(f"{device}: every point is read", (done.returncode, done.stderr), (0, ""))
            if done.stdout:
                compare(device, told, yaml.safe_load(map_file.read_text(encoding="utf-8")), json.loads(done.stdout), checks)
    checks.done("a map imported from a configuration of pymodbus' simulator reads what the simulator serves")


main()
