#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`coupler probe` finds what pymodbus servers with holes, limits and moods answer to, and what a node does.

    probe_test.py COUPLER MAP NODE_COMMAND…
"""
import concurrent.futures
import json
import pathlib
import re
import signal
import struct
import subprocess
import sys
import tempfile
import time

import peer

try:
    import foreign_server
except ImportError as error:
    peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")

COUPLER = sys.argv[1]
READS = {"coils": 1, "discrete_inputs": 2, "holding_registers": 3, "input_registers": 4}
READING = {1, 2, 3, 4, 43}
HOLEY = {
    "coils": {at: at % 3 == 0 for at in [*range(0, 40), *range(48, 50), *range(1000, 2500)]},
    "discrete_inputs": {at: at % 2 == 0 for at in range(5, 17)},
    "holding_registers": {at: at * 7 & 0xFFFF for at in [*range(0, 12), *range(14, 200), *range(3001, 3004)]},
    "input_registers": {at: at for at in [*range(100, 400), 402, *range(9984, 10000)]},
}


def probe(*arguments, timeout=20):
    """Fast: the server is ours. Patient: the machine may be busy."""
    return subprocess.run([COUPLER, "probe", *map(str, arguments), "--rate", "1000", "--timeout", str(timeout)],
                          capture_output=True, text=True, timeout=peer.PATIENCE)


def run_coupler(*arguments):
    return subprocess.run([COUPLER, *map(str, arguments)], capture_output=True, text=True, timeout=peer.PATIENCE)


def addresses_in(plan):
    """What the requests of a plan read, by table."""
    read = {table: set() for table in READS}
    for group in plan["groups"]:
        for span in group["spans"]:
            read[span["table"]].update(range(span["from"], span["to"] + 1))
    return read


def the_draft_is_good(draft, device, port, checks, unit=1):
    """It passes `coupler check`; the driver's requests get no exception and read all that the device has."""
    checked = subprocess.run([COUPLER, "check", draft], capture_output=True, text=True, timeout=peer.PATIENCE)
    checks.equal("coupler check", (checked.returncode, checked.stderr), (0, ""))
    plan = json.loads(subprocess.run([COUPLER, "plan", draft, "--json"], capture_output=True, text=True,
                                     timeout=peer.PATIENCE).stdout)
    checks.equal("what the draft reads", addresses_in(plan), {name: set(has) for name, has in device.tables.items()})
    client = peer.pymodbus_client(port)
    client.connect()
    reads = {"coils": client.read_coils, "discrete_inputs": client.read_discrete_inputs,
             "holding_registers": client.read_holding_registers, "input_registers": client.read_input_registers}
    for group in plan["groups"]:
        for span in group["spans"]:
            reply = reads[span["table"]](span["from"], span["to"] - span["from"] + 1, unit)
            checks.equal(f"{span['table']} {span['from']} … {span['to']}", reply.isError(), False)
    client.close()


def nothing_was_written(device, checks):
    checks.equal("functions that the server saw", set(device.functions) - READING, set())
    checks.equal("it saw requests", len(device.functions) > 0, True)


def all_holes_are_found(folder, checks):
    device = foreign_server.Device(HOLEY)
    draft = folder / "holes.yaml"
    names = {"VendorName": "ACME", "ProductCode": "X1", "MajorMinorRevision": "2.11", "ModelName": "Meter"}
    with foreign_server.serving(device, names=names) as port:
        found = probe(f"127.0.0.1:{port}", "--out", draft)
        checks.equal("holes: exit status", (found.returncode, found.stderr.count("error")), (0, 0))
        checks.equal("holes: requests stay few", len(device.functions) < 5000, True)
        nothing_was_written(device, checks)
        the_draft_is_good(draft, device, port, checks)
    ranges = re.findall(r"readable: (.*)", found.stdout)
    checks.equal("the ranges", ranges, ["0 … 39, 48 … 49, 1000 … 2499", "5 … 16", "100 … 399, 402, 9984 … 9999",
                                        "0 … 11, 14 … 199, 3001 … 3003"])
    for name, value in names.items():
        checks.equal(f"FC 43/14 {name}", re.findall(rf"  {name} +(.*)", found.stdout), [value])
    again = probe(f"127.0.0.1:{port}", "--out", draft)
    checks.equal("a file that is there stays", again.returncode, 2)


def the_largest_count_is_found(too_many, folder, checks):
    device = foreign_server.Device(HOLEY, most=32, too_many=too_many)
    draft = folder / f"limit_{too_many}.yaml"
    with foreign_server.serving(device) as port:
        checks.equal("limit: exit status", probe(f"127.0.0.1:{port}", "--out", draft).returncode, 0)
        checks.equal("the limit in the draft", re.findall(r"limits: {(.*)}", draft.read_text()), ["read_registers: 32"])
        the_draft_is_good(draft, device, port, checks)
    nothing_was_written(device, checks)


def a_unit_is_found(folder, checks):
    device = foreign_server.Device({"holding_registers": {at: at for at in range(20)}})
    draft = folder / "unit.yaml"
    with foreign_server.serving(device, unit=17) as port:
        silent = probe(f"127.0.0.1:{port}", timeout=0.2)
        checks.equal("units: none of the default ones", (silent.returncode, silent.stdout), (3, ""))
        # Two silent units cost a timeout each.
        call = [COUPLER, "probe", f"127.0.0.1:{port}", "--units", "16-18", "--to", "99", "--out", draft, "--rate", "1000"]
        found = peer.run_hasty(lambda seconds: [*call, "--timeout", str(seconds)], again=lambda: draft.unlink(missing_ok=True))
        checks.equal("units: exit status", found.returncode, 0)
        checks.equal("units that answer", re.findall(r"units that answer: (.*)", found.stdout), ["17"])
        printed = probe(f"127.0.0.1:{port}/17", "--to", "99", "--out", "-")
        checks.equal("the draft on standard output", (printed.returncode, printed.stdout), (0, draft.read_text()))
        checks.equal("the report beside it", re.findall(r"units that answer: (.*)", printed.stderr), ["17"])
        the_draft_is_good(draft, device, port, checks, unit=17)
    nothing_was_written(device, checks)


def texts_are_found(folder, checks):
    """In either order, with an odd number of characters or an even one, among numbers."""
    registers = {at: at for at in range(60)}
    for start, text, order in ((10, b"WAGO 750-352\0", ">"), (20, b"PM-12 meter\0", "<"), (30, b"Line 3 voltage", "<")):
        text += b"\0" * (len(text) % 2)
        registers.update(enumerate(struct.unpack(f"{order}{len(text) // 2}H", text), start))
    device = foreign_server.Device({"holding_registers": registers})
    draft = folder / "texts.yaml"
    with foreign_server.serving(device) as port:
        found = probe(f"127.0.0.1:{port}/1", "--to", "99", "--out", draft)
        checks.equal("the texts", re.findall(r"  holding_registers +{(.*)} +(\".*)", found.stdout),
                     [("address: 10, type: STRING, length: 12, order: AB", '"WAGO 750-352"'),
                      ("address: 20, type: STRING, length: 11, order: BA", '"PM-12 meter"'),
                      ("address: 30, type: STRING, length: 14, order: BA", '"Line 3 voltage"')])
        the_draft_is_good(draft, device, port, checks)
        read = subprocess.run([COUPLER, "dump", draft, "--json"], capture_output=True, text=True, timeout=peer.PATIENCE)
    values = {point["point"]: point["value"] for point in json.loads(read.stdout)["points"]}
    checks.equal("its points", [values.get(f"holding_registers_text_{at}") for at in (10, 20, 30)],
                 ["WAGO 750-352", "PM-12 meter", "Line 3 voltage"])


def nothing_makes_no_draft(folder, checks):
    """It answers each read with an exception: 02, as most do."""
    device = foreign_server.Device({})
    draft = folder / "nothing.yaml"
    with foreign_server.serving(device) as port:
        found = probe(f"127.0.0.1:{port}/1", "--to", "199", "--out", draft)
        report = found.stdout.splitlines()
        checks.equal("nothing: exit status", found.returncode, 3)
        checks.equal("nothing: no draft", draft.exists(), False)
        checks.equal("nothing: the report ends with the remedy", report[-1],
                     "the device shows nothing: no address from 0 to 199 can be read; try another unit, as --units 1-247; "
                     "all addresses, by --from 0 --to 65535; each address, by --stride 1")
        checks.equal("nothing: the error", re.findall(r"error: (.*?);", found.stderr),
                     [f"{draft} is not written: a map needs a point, and none was found"])
        alone = probe(f"127.0.0.1:{port}/1", "--to", "199", "--stride", "1")
        checks.equal("nothing: the report was asked for", (alone.returncode, alone.stderr.count("error")), (0, 0))
        checks.equal("nothing: each address was tried", "--stride" in alone.stdout.splitlines()[-1], False)
    nothing_was_written(device, checks)


def closed_connections_end_nothing(folder, checks):
    device = foreign_server.Device({"input_registers": {at: at for at in [*range(0, 30), *range(40, 60)]}}, closes=True)
    draft = folder / "closes.yaml"
    with foreign_server.serving(device) as port:
        found = probe(f"127.0.0.1:{port}/1", "--to", "199", "--out", draft)
        checks.equal("closes: exit status", (found.returncode, found.stdout.count("without an answer")), (0, 1))
        the_draft_is_good(draft, device, port, checks)
    nothing_was_written(device, checks)


def in_order(value, order):
    """The registers of a REAL."""
    a, b, c, d = struct.pack(">f", value)
    first, second = {"ABCD": ((a, b), (c, d)), "CDAB": ((c, d), (a, b)),
                     "BADC": ((b, a), (d, c)), "DCBA": ((d, c), (b, a))}[order]
    return [first[0] << 8 | first[1], second[0] << 8 | second[1]]


def a_known_value_is_found_in_each_order(folder, checks):
    for order in ("ABCD", "CDAB", "BADC", "DCBA"):
        registers = {at: at * 40503 + 7 & 0xFFFF for at in range(120)}
        registers[41], registers[42] = in_order(230.4, order)
        registers[60], registers[61] = in_order(50.02, order)
        device = foreign_server.Device({"holding_registers": registers})
        draft = folder / f"{order}.yaml"
        with foreign_server.serving(device) as port:
            found = probe(f"127.0.0.1:{port}/1", "--to", "199", "--known", "voltage=230.4", "--known", "50.02",
                          "--out", draft)
            the_draft_is_good(draft, device, port, checks)
        checks.equal(f"{order}: the first place",
                     re.findall(r"known value voltage.*\n +(\S+) +({.*?})", found.stdout),
                     [("holding_registers", f"{{address: 41, type: REAL, order: {order}}}")])
        text = draft.read_text()
        checks.equal(f"{order}: its point", "voltage: {address: 41, type: REAL, access: read}" in text, True)
        checks.equal(f"{order}: the other one", "value_2: {address: 60, type: REAL, access: read}" in text, True)
        keys = dict(re.findall(r"^(byteorder_reverse|wordorder_reverse): (\w+)", text, re.M))
        checks.equal(f"{order}: of the device", keys,
                     {"byteorder_reverse": str(order in ("BADC", "DCBA")).lower(),
                      "wordorder_reverse": str(order in ("ABCD", "BADC")).lower()})


def ctrl_c_shows_what_was_found(checks):
    device = foreign_server.Device({"coils": {at: True for at in range(2000)}})
    with foreign_server.serving(device) as port:
        running = subprocess.Popen([COUPLER, "probe", f"127.0.0.1:{port}/1", "--rate", "20", "--timeout", "20"], stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        peer.await_true("Ctrl-C: requests", lambda: len(device.functions) >= 30, checks)
        running.send_signal(signal.SIGINT)
        out, _ = running.communicate(timeout=peer.PATIENCE)
    checks.equal("Ctrl-C: exit status", running.returncode, 0)
    checks.equal("Ctrl-C: the coils", "readable: 0 … 1999" in out, True)
    checks.equal("Ctrl-C: it says so", "ended early" in out, True)


def requests_keep_the_rate(checks):
    device = foreign_server.Device({"coils": {}})
    with foreign_server.serving(device) as port:
        began = time.monotonic()
        subprocess.run([COUPLER, "probe", f"127.0.0.1:{port}/1", "--to", "4", "--rate", "20", "--timeout", "20"], capture_output=True,
                       timeout=peer.PATIENCE, check=True)
        took = time.monotonic() - began
    checks.equal("no more than 20 requests a second", len(device.functions) - 1 <= took * 20, True)


def a_node_is_known(folder, map_file, command, checks):
    saved = folder / "saved.yaml"
    name = re.search(r"^name: (\w+)", map_file.read_text(), re.M).group(1)
    with peer.running_node(command) as port:
        place = f"127.0.0.1:{port}"
        before = json.loads(run_coupler("status", place, "--json").stdout)
        found = probe(place)
        after = json.loads(run_coupler("status", place, "--json").stdout)
        checks.equal("node: exit status", (found.returncode, found.stderr.count("error")), (0, 0))
        checks.equal("node: its name and version", re.findall(r"  (?:ProductName|MajorMinorRevision) +(.*)", found.stdout),
                     [before["version"], name])
        checks.equal("node: what it is", re.findall(r"an OpenCoupler node, which serves its map: fingerprint (.*)", found.stdout),
                     [before["fingerprint"]])
        points = json.loads(run_coupler("check", place, "--json").stdout)["points"]
        checks.equal("node: its points", f"{place}/1: ok: {name}, {points} points (" in found.stdout, True)
        checks.equal("node: what to do next", found.stdout.splitlines()[-1],
                     f"Next: `coupler fetch {place}/1 -o FILE` saves its map, `coupler dump {place}/1` shows its values; "
                     "--scan looks at its addresses all the same")
        asked = after["statistics"]["requests"] - before["statistics"]["requests"]
        pieces = before["map"]["bytes"] // 200 + 1  # of its map, when it is read
        checks.equal(f"node: few requests: {asked}", asked < 20 + pieces, True)
        checks.equal("node: its map is saved", (probe(place, "--out", saved).returncode, saved.read_bytes()), (0, map_file.read_bytes()))
        printed = probe(place, "--out", "-")
        checks.equal("node: its map on standard output", (printed.returncode, printed.stdout), (0, map_file.read_text()))
        checks.equal("node: a file that is there stays", probe(place, "--out", saved).returncode, 2)


def a_node_is_scanned(folder, command, checks):
    draft = folder / "node.yaml"
    with peer.running_node(command) as port:
        known = ("--known", "wide=305419896")
        for call in (["--scan"], known, ["--from", "0"], [*known, "--to", "200", "--out", draft]):
            found = probe(f"tcp://127.0.0.1:{port}", *call, "--stride", "1000")
            checks.equal(f"scanned node, {call[0]}: exit status", found.returncode, 0)
            ranges = re.findall(r"readable: (.*)", found.stdout)
            checks.equal(f"scanned node, {call[0]}: its ranges", ranges, ["0 … 9, 20", "0 … 3", "0 … 4", "0 … 16"])
    checks.equal("scanned node: a value of its map", "wide: {address: 1, type: UDINT, access: read}" in draft.read_text(), True)


def who_is_not_there_is_told(checks):
    with peer.silent_port() as port:
        gone = probe(f"127.0.0.1:{port}")
    checks.equal("nobody there", (gone.returncode, gone.stdout, "refused" in gone.stderr), (3, "", True))
    for call in (["127.0.0.1", "--known", "0"], ["127.0.0.1", "--units", "250"], ["127.0.0.1:99999"],
                 ["127.0.0.1", "--from", "9", "--to", "8"], ["127.0.0.1", "--out", "/nowhere/map.yaml"]):
        checks.equal(f"a bad call: {call}", probe(*call).returncode, 2)


def main():
    map_file, command = pathlib.Path(sys.argv[2]), sys.argv[3:]
    checks = peer.Checks()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        # They wait more than they compute: all at once.
        with concurrent.futures.ThreadPoolExecutor(max_workers=10) as pool:
            for part in [
                    pool.submit(all_holes_are_found, folder, checks),
                    pool.submit(the_largest_count_is_found, 3, folder, checks),
                    pool.submit(the_largest_count_is_found, 2, folder, checks),
                    pool.submit(a_unit_is_found, folder, checks),
                    pool.submit(texts_are_found, folder, checks),
                    pool.submit(nothing_makes_no_draft, folder, checks),
                    pool.submit(closed_connections_end_nothing, folder, checks),
                    pool.submit(a_known_value_is_found_in_each_order, folder, checks),
                    pool.submit(ctrl_c_shows_what_was_found, checks),
                    pool.submit(requests_keep_the_rate, checks),
                    pool.submit(a_node_is_known, folder, map_file, command, checks),
                    pool.submit(a_node_is_scanned, folder, command, checks),
                    pool.submit(who_is_not_there_is_told, checks)]:
                part.result()
    checks.done("coupler probe finds what pymodbus servers and a node answer to, and its drafts read them")


main()
