#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`coupler status` tells two nodes with one map apart, and shows what a pymodbus client reads there; readers that know
the first registers only notice nothing.

    status_test.py COUPLER NODE
"""
import contextlib
import json
import pathlib
import re
import shlex
import socket
import subprocess
import sys

import peer

try:
    from pymodbus.mei_message import ReadDeviceInformationRequest
    import foreign_server
except ImportError as error:
    peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")

MAP = pathlib.Path(__file__).resolve().parent / "watchdog.yaml"
IDENTITY, FURTHER = 0xFF00, 0xFF2D
OLD_SIZE, SIZE = 45, 85  # registers of the area: of the first nodes, and now

FINGERPRINT = slice(3, 7)
STATISTICS = {  # docs/identity.md: where each stands
    "requests": 15, "exceptions": 17, "connections": 19, "hardware_errors": 21, "watchdog_trips": 23, "events_lost": 25,
    "exceptions_01": 27, "exceptions_02": 29, "exceptions_03": 31, "exceptions_04": 33, "connections_refused": 35,
    "connections_evicted": 37, "foreign_units": 39, "connections_bad_frames": 41, "connections_timed_out": 43}
KEYS = ["device", "time", "trouble", "node", "name", "version", "fingerprint", "map", "hostname", "serial", "watchdog",
        "functions", "uptime_s", "statistics", "certificates", "identification"]


def status(coupler, *arguments):
    return subprocess.run([coupler, "status", "--timeout", "20", *map(str, arguments)], capture_output=True, text=True,
                          encoding="utf-8", timeout=peer.PATIENCE, check=False)


def area(port, start=0, count=SIZE):
    client = peer.pymodbus_client(port)
    reply = client.read_input_registers(IDENTITY + start, count, 1)
    client.close()
    return getattr(reply, "registers", None) or reply.exception_code


def on_machine(hostname, serial, command):
    """The command with another hostname and board: in name spaces of its own, with a device tree in place of the real
    firmware's folder. An empty list: this user may not have such name spaces."""
    script = (f"hostname {hostname} && mount -t tmpfs none /sys/firmware && mkdir -p /sys/firmware/devicetree/base && "
              f"printf '{serial}\\0' >/sys/firmware/devicetree/base/serial-number && exec ")
    wrapped = ["unshare", "--user", "--map-root-user", "--uts", "--mount", "sh", "-c"]
    with contextlib.suppress(FileNotFoundError):
        if subprocess.run([*wrapped, script + "true"], capture_output=True, check=False).returncode == 0:
            # The shell's further arguments: those that the caller appends.
            return [*wrapped, script + shlex.join(command) + ' "$@"', "sh"]
    return []


def everything_is_shown(coupler, node, checks):
    with peer.running_node([node, str(MAP), "--sim"]) as port:
        client = peer.pymodbus_client(port)
        checks.equal("an output is written", client.write_coil(0, True, 1).isError(), False)
        checks.equal("a request is refused", client.read_coils(4711, 1, 1).exception_code, 2)
        seen = area(port)
        done = status(coupler, f"127.0.0.1:{port}", "--json")
        identification = client.execute(ReadDeviceInformationRequest(2, 0, unit=1)).information
        client.close()
        checks.equal("exit status", (done.returncode, done.stderr), (0, ""))
        told = json.loads(done.stdout)
        checks.equal("keys", list(told), KEYS)
        checks.equal("keys of the statistics", sorted(told["statistics"]), sorted(STATISTICS))
        checks.equal("it is a node without trouble", (told["node"], told["trouble"]), (True, None))
        checks.equal("device", told["device"], f"tcp://127.0.0.1:{port}/1")
        checks.equal("fingerprint", told["fingerprint"], "".join(f"{word:04x}" for word in seen[FINGERPRINT]))
        checks.equal("size of the map", told["map"]["bytes"], len(MAP.read_bytes()))
        checks.equal("hostname", told["hostname"], socket.gethostname())
        checks.equal("name and version", [told["name"].encode(), told["version"].encode()],
                     [identification[1], identification[2]])
        checks.equal("objects of FC 43/14", told["identification"]["ModelName"], told["fingerprint"])
        checks.equal("watchdog", told["watchdog"]["state"] in ("armed", "expired"), True)
        checks.equal("its timeout", told["watchdog"]["timeout_ms"], seen[83] << 16 | seen[84])
        checks.equal("function codes of its own", told["functions"],
                     [65 + bit for bit in range(2) if seen[82] >> bit & 1])
        checks.equal("it tells changes", 65 in told["functions"], True)
        # The program's own requests and connection come on top.
        for name, at in STATISTICS.items():
            if name not in ("requests", "connections", "watchdog_trips"):
                checks.equal(name, told["statistics"][name], seen[at] << 16 | seen[at + 1])
        checks.equal("requests", told["statistics"]["requests"], (seen[15] << 16 | seen[16]) + 1)

        text = status(coupler, f"tcp://127.0.0.1:{port}/1")
        checks.equal("exit status", (text.returncode, text.stderr), (0, ""))
        for line in (f"fingerprint +{told['fingerprint']}", f"hostname +{re.escape(socket.gethostname())}",
                     r"watchdog +(armed, \d+ ms left|expired)", r"timeout of the watchdog +\d+ ms",
                     r"function codes of its own +65 \(waiting for changes\).*", r"exception 02 \(illegal data address\) +1",
                     r"requests answered +\d+"):
            checks.equal(f"a line '{line}'", bool(re.search(rf"^  {line}$", text.stdout, re.M)), True)


def two_nodes_with_one_map_are_told_apart(coupler, node, checks):
    command = [node, str(MAP), "--sim"]
    machines = [("cell-1", "10000000c0ffee01"), ("cell-2", "10000000c0ffee02")]
    wrapped = [on_machine(*machine, command) for machine in machines]
    if not all(wrapped):
        print("not tried here: two machines, since this user may not make name spaces")
        return
    with peer.running_node(wrapped[0]) as first, peer.running_node(wrapped[1]) as second:
        told = [json.loads(status(coupler, f"127.0.0.1:{port}", "--json").stdout) for port in (first, second)]
        areas = [area(port) for port in (first, second)]
        objects = []
        for port in (first, second):
            client = peer.pymodbus_client(port)
            objects.append(client.execute(ReadDeviceInformationRequest(3, 0, unit=1)).information)
            client.close()
    checks.equal("one map", told[0]["fingerprint"], told[1]["fingerprint"])
    checks.equal("hostnames", [one["hostname"] for one in told], ["cell-1", "cell-2"])
    # printf 'OpenCoupler serial: 10000000c0ffee01' | sha256sum | cut -c1-16
    checks.equal("serials", [one["serial"] for one in told], ["dce7dfa9209c6b9c", "542b81c679207531"])
    checks.equal("the same in the registers", ["".join(f"{word:04x}" for word in one[46:50]) for one in areas],
                 [one["serial"] for one in told])
    checks.equal("hostnames in FC 43/14", [one[6] for one in objects], [b"cell-1", b"cell-2"])
    checks.equal("serials in FC 43/14", [one[0x80].decode() for one in objects], [one["serial"] for one in told])
    checks.equal("the head of the area is one", areas[0][:11], areas[1][:11])


def what_was_there_before_stays(coupler, node, checks):
    with peer.running_node([node, str(MAP), "--sim"]) as port:
        head = area(port, 0, 13)
        checks.equal("magic and layout version 1", head[:3], [0x4F43, 0x504C, 1])
        old = area(port, 0, OLD_SIZE)
        checks.equal("the first 11 registers, in a longer read", old[:11], head[:11])
        checks.equal("registers of further fields", area(port, OLD_SIZE, 1), [39])
        checks.equal("behind the last one", area(port, SIZE, 1), 2)
        checks.equal("across the end", area(port, OLD_SIZE, SIZE - OLD_SIZE + 1), 2)
    # What a node of the first version has; 0xFF2D is an exception 02 there.
    device = foreign_server.Device({"input_registers": {IDENTITY + i: word for i, word in enumerate(old)}})
    with foreign_server.serving(device) as port:
        done = status(coupler, f"127.0.0.1:{port}", "--json")
        text = status(coupler, f"127.0.0.1:{port}")
    told = json.loads(done.stdout)
    checks.equal("exit status, a node of the first version", (done.returncode, text.returncode), (0, 0))
    checks.equal("what it does not have", (told["hostname"], told["serial"]), (None, None))
    checks.equal("what it cannot do", (told["functions"], told["watchdog"]["timeout_ms"]), ([], None))
    checks.equal("what it has", told["fingerprint"], "".join(f"{word:04x}" for word in old[FINGERPRINT]))
    checks.equal("for people", bool(re.search(r"^  hostname +unknown$", text.stdout, re.M)), True)
    # A node of a later version: more fields than anybody knows here.
    words = old + [43, 0, 0, 0, 7, 0x6162] + [0] * 31 + [0xFFFF] * 7
    device = foreign_server.Device({"input_registers": {IDENTITY + i: word for i, word in enumerate(words)}})
    with foreign_server.serving(device) as port:
        told = json.loads(status(coupler, f"127.0.0.1:{port}", "--json").stdout)
    checks.equal("a node of a later version", (told["hostname"], told["serial"]), ("ab", "0000000000000007"))


def others_are_no_node(coupler, checks):
    names = {"VendorName": "ACME", "ProductCode": "PM-12", "MajorMinorRevision": "2.11"}
    device = foreign_server.Device({"holding_registers": {0: 1}})
    with foreign_server.serving(device, names=names) as port:
        done = status(coupler, f"127.0.0.1:{port}")
        as_json = status(coupler, f"127.0.0.1:{port}", "--json")
    checks.equal("exit status, a foreign coupler", (done.returncode, as_json.returncode), (1, 1))
    checks.equal("it says so", "is a foreign coupler: it has no identity area; " in done.stderr, True)
    checks.equal("its identification", re.findall(r"^  (\w+) +(\S+)$", done.stdout, re.M)[:3],
                 [("VendorName", "ACME"), ("ProductCode", "PM-12"), ("MajorMinorRevision", "2.11")])
    told = json.loads(as_json.stdout)
    checks.equal("keys", list(told), KEYS)
    checks.equal("as JSON", (told["node"], told["trouble"], told["identification"]["VendorName"]), (False, None, "ACME"))
    checks.equal("functions that it was asked for", set(device.functions), {4, 43})
    with peer.silent_port() as port:
        done = status(coupler, f"127.0.0.1:{port}", "--json")
    checks.equal("exit status, nobody", done.returncode, 3)
    checks.equal("what is wrong", "Connection refused" in json.loads(done.stdout)["trouble"], True)
    for wrong in ("tcp://", "fe80::1", "cell:0", "cell:502/256"):
        checks.equal(f"exit status, '{wrong}'", status(coupler, wrong).returncode, 2)


def several_are_shown_in_turn(coupler, node, checks):
    device = foreign_server.Device({"holding_registers": {0: 1}})
    with peer.running_node([node, str(MAP), "--sim"]) as port, foreign_server.serving(device) as foreign, peer.silent_port() as none:
        places = [f"127.0.0.1:{port}" for port in (port, foreign, none)]
        done = status(coupler, *places, "--json")
        told = [json.loads(line) for line in done.stdout.splitlines()]
        checks.equal("several: one object a line", [one["device"] for one in told], [f"tcp://{place}/1" for place in places])
        checks.equal("several: which is a node", [one["node"] for one in told], [True, False, False])
        checks.equal("several: the highest exit status", done.returncode, 3)
        checks.equal("several: without the one that is away", status(coupler, places[1], places[0]).returncode, 1)
        text = status(coupler, places[0], places[0])
        checks.equal("several: as text", (text.returncode, text.stdout.count(f"the node at tcp://{places[0]}/1, ")), (0, 2))
        wrong = status(coupler, places[0], "cell:0")
        checks.equal("several: a wrong call asks nobody", (wrong.returncode, wrong.stdout), (2, ""))


def main():
    coupler, node = sys.argv[1:]
    checks = peer.Checks()
    everything_is_shown(coupler, node, checks)
    two_nodes_with_one_map_are_told_apart(coupler, node, checks)
    what_was_there_before_stays(coupler, node, checks)
    others_are_no_node(coupler, checks)
    several_are_shown_in_turn(coupler, node, checks)
    checks.done("coupler status shows what a node says of itself, and which of two nodes with one map it is")


main()
