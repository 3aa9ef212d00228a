#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`coupler dump` shows what a device of pymodbus holds, says what it does not have, and writes nothing to it.

    dump_test.py COUPLER MAP NODE_COMMAND…
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import peer
from dump_device import READS, device_with_values, registers

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


def main():
    coupler, map_file, command = sys.argv[1], sys.argv[2], sys.argv[3:]
    checks = peer.Checks()
    with peer.silent_port() as port, device_with_values(port) as device:
        values_are_those_of_the_device(coupler, map_file, device, checks)
        a_watchdog_of_the_map_is_left_alone(coupler, device, checks)
        checks.equal("functions that the device was asked for", device.store.asked, READS)
    a_node_needs_no_file(coupler, command, checks)
    a_nodes_watchdog_stays_idle(coupler, command[0], checks)
    checks.done("coupler dump shows what pymodbus and a node hold, and writes nothing")


main()
