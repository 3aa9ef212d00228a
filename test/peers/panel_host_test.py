#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`coupler panel HOST`, `record HOST` and `dump HOST` need no map: a node gives its own, a WAGO coupler is recognised by its
registers, of anything else there is a draft. Nothing is written to any of them.

    panel_host_test.py NODE COUPLER MAP
"""
import concurrent.futures
import json
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import urllib.request

import peer

sys.path.append(str(pathlib.Path(__file__).parents[1] / "ros"))
try:
    import foreign_server
except ImportError as error:
    peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")
from recording import Node, Program, values, whole_lines
from support.couplers.wago_750 import Wago750

COUPLER = sys.argv[2]
READING = {1, 2, 3, 4, 43}


class Panel(Program):
    """`coupler panel` and a page of it."""

    def __init__(self, *arguments):
        super().__init__(COUPLER, "panel", *arguments, stdout=subprocess.PIPE)
        self.url, key = re.match(r"(http://.*/)#(.*)\n|", self.process.stdout.readline()).groups()
        self.token = self.url and self._ask("token", key.encode()).read().decode()

    def _ask(self, what, data=None, **headers):
        return urllib.request.urlopen(urllib.request.Request(self.url + what, data, headers), timeout=peer.PATIENCE)

    def get(self, what):
        return self._ask(what, Authorization=f"Bearer {self.token}")

    def points(self):
        return {point["name"]: point for point in json.load(self.get("points.json"))["points"]}

    def await_value(self, point, text, checks):
        """Until a page is told a value that begins so."""
        with self.get("events") as events:
            for line in events:
                told = json.loads(line[5:]).get("points", {}) if line.startswith(b"data:") else {}
                if told.get(point, {}).get("text", "").startswith(text):
                    return checks.equal(f"{point} is {text}", True, True)
        return checks.equal(f"{point} is {text}", False, True)


def a_wago(inputs=16, outputs=8):
    """One client at a time, as a panel that leaves no connection behind can do with."""
    device = Wago750(connections=1)
    device.tables["holding_registers"][0x1022:0x1026] = [2 * 16, 4 * 16, outputs, inputs]
    device.tables["holding_registers"][0x2000:0x2004] = [0, 0xFFFF, 0x1234, 0xAAAA]
    device.tables["holding_registers"][0x2010:0x2013] = [5, 750, 352]
    return device


def a_wago_is_recognised(checks):
    with a_wago() as device, Panel(f"127.0.0.1:{device.port}") as panel:
        points = panel.points()
        checks.equal("WAGO: points", [*points],
                     [f"output_{n}" for n in range(1, 9)] + [f"input_{n}" for n in range(1, 17)] +
                     [f"analogue_input_{n}" for n in range(1, 5)] + [f"analogue_output_{n}" for n in range(1, 3)])
        checks.equal("WAGO: type", points["input_3"]["type"], "BOOL")
        panel.await_value("input_3", "false", checks)
        device.tables["discrete_inputs"][2] = 1
        panel.await_value("input_3", "true", checks)
        device.tables["coils"][512 + 7] = 1  # as it is read back
        panel.await_value("output_8", "true", checks)
        device.tables["input_registers"][3] = 4711
        panel.await_value("analogue_input_4", "4711", checks)
        checks.equal("WAGO: exit status", panel.end(signal.SIGINT), 0)
        checks.equal("WAGO: it says what it is",
                     re.findall(r"is a (.*), by its own registers: (.*); .*(coupler probe .*)", panel.text()),
                     [("WAGO 750-352", "16 inputs, 8 outputs, 4 analogue inputs, 2 analogue outputs",
                       f"coupler probe 127.0.0.1:{device.port} --out FILE")])
        checks.equal("WAGO: nothing is written", {request.function for request in device.requests} - READING, set())


def a_wago_has_a_draft(folder, checks):
    draft = folder / "wago.yaml"
    with a_wago() as device:
        found = subprocess.run([COUPLER, "probe", f"127.0.0.1:{device.port}", "--to", "99", "--rate", "1000", "--timeout",
                                "20", "--out", draft], capture_output=True, text=True, timeout=peer.PATIENCE)
    checks.equal("WAGO: probe", (found.returncode, "a WAGO 750-352, by its own registers" in found.stdout), (0, True))
    checks.equal("WAGO: its draft", ["preset: wago_750" in draft.read_text(), "input_16: {address: 15}" in
                                     draft.read_text()], [True, True])
    checked = subprocess.run([COUPLER, "check", draft], capture_output=True, text=True, timeout=peer.PATIENCE)
    checks.equal("WAGO: coupler check", (checked.returncode, checked.stderr), (0, ""))


def a_wago_is_recorded(folder, checks):
    file = folder / "wago.jsonl"
    with a_wago() as device, Program(COUPLER, "record", f"tcp://127.0.0.1:{device.port}/1", "-o", file) as recorder:
        device.tables["discrete_inputs"][0] = 1
        peer.await_true("record: a value",
                        lambda: file.exists() and values(whole_lines(file), "input_1")[-1:] == [True], checks)
        checks.equal("record: exit status", recorder.end(), 0)


def a_wago_is_dumped(checks):
    with a_wago() as device:
        done = subprocess.run([COUPLER, "dump", f"127.0.0.1:{device.port}", "--points", "output_*", "--json"],
                              capture_output=True, text=True, timeout=peer.PATIENCE)
    checks.equal("dump: exit status", done.returncode, 0)
    checks.equal("dump: it says what it is", " is a WAGO " in done.stderr, True)
    checks.equal("dump: points", [point["point"] for point in json.loads(done.stdout)["points"]],
                 [f"output_{n}" for n in range(1, 9)])


def anything_else_has_a_draft(checks):
    """It has all that is looked at, which costs few requests."""
    device = foreign_server.Device({table: {at: 0 for at in range(10000)} for table in
                                    ("coils", "discrete_inputs", "holding_registers", "input_registers")})
    with foreign_server.serving(device) as port, Panel(f"127.0.0.1:{port}/1") as panel:
        points = panel.points()
        checks.equal("draft: points", [name for name in points if name.endswith(("_0_1999", "_0_124"))],
                     ["coils_0_1999", "discrete_inputs_0_1999", "input_registers_0_124", "holding_registers_0_124"])
        panel.await_value("input_registers_0_124", "[0, 0, 0", checks)
        device.tables["input_registers"][1] = 4711
        panel.await_value("input_registers_0_124", "[0, 4711, 0", checks)
        checks.equal("draft: exit status", panel.end(), 0)
        checks.equal("draft: it says so", "is unknown: its points are what can be read there" in panel.text(), True)
    checks.equal("draft: nothing is written", {*device.functions} - READING, set())


def a_node_gives_its_map(node, map_file, checks):
    with Node(node, map_file) as device:
        for host in (f"127.0.0.1:{device.port}", f"tcp://127.0.0.1:{device.port}"):
            with Panel(host) as panel:
                checks.equal("node: a point of its map", "setpoint" in panel.points(), True)
                checks.equal("node: exit status", panel.end(), 0)
                checks.equal("node: it says so", "is a node that serves its map" in panel.text(), True)


def who_is_not_there_is_told(checks):
    with peer.silent_port() as port, Panel(f"127.0.0.1:{port}") as panel:
        checks.equal("nobody there", (panel.wait(), panel.url), (3, None))
        checks.equal("nobody there: why, and what to do",
                     ["refused" in panel.text(), "check that the device is on" in panel.text()], [True, True])
    for place, status, why in (("press.invalid", 3, "no such file, and as a device: (unknown host|the name) 'press.invalid'"),
                               ("10.0.0.7:99999", 2, "the port '99999' is not 1 to 65535"),
                               ("10.0.0.7", 2, "certificates are for a place with TLS")):
        with Panel(place, *(["--pin", "x"] if status == 2 else [])) as panel:
            checks.equal(f"{place}: exit status", panel.wait(), status)
            checks.equal(f"{place}: why", bool(re.search(why, panel.text())), True)


def ctrl_c_ends_the_search_and_shows_what_was_found(checks):
    """Of a device that gives no block with a hole in it, all the rest would take minutes."""
    device = foreign_server.Device({"coils": {0: True}, "input_registers": {0: 1, 4: 2}})
    with foreign_server.serving(device) as port:
        with Program(COUPLER, "panel", f"127.0.0.1:{port}/1", stdout=subprocess.PIPE) as panel:
            peer.await_true("strict: it says how far it is", lambda: "looking at discrete_inputs" in panel.text(), checks)
            panel.process.send_signal(signal.SIGINT)
            checks.equal("strict: a page", panel.process.stdout.readline().startswith("http://"), True)
            peer.await_true("strict: it says so",  # on stderr, which may be read after the page's place
                            lambda: re.search("not all was looked at: .* so far; to look again and keep it: "
                                              f"coupler probe 127.0.0.1:{port}/1 --out FILE", panel.text()), checks)
            checks.equal("strict: exit status", panel.end(signal.SIGINT), 0)
        with Program(COUPLER, "panel", f"127.0.0.1:{port}/1", stdout=subprocess.PIPE) as panel:
            peer.await_true("SIGTERM: it looks", lambda: "looking at discrete_inputs" in panel.text(), checks)
            checks.equal("SIGTERM: exit status", panel.end(signal.SIGTERM), 3)


def ctrl_c_ends_a_search_that_has_found_nothing(checks):
    device = foreign_server.Device({"holding_registers": {9000: 1}})
    with foreign_server.serving(device) as port:
        with Program(COUPLER, "panel", f"127.0.0.1:{port}/1", stdout=subprocess.PIPE) as panel:
            peer.await_true("Ctrl-C: it looks", lambda: len(device.functions) >= 20, checks)
            checks.equal("Ctrl-C: exit status", panel.end(signal.SIGINT), 3)
            checks.equal("Ctrl-C: no page", panel.process.stdout.read(), "")
            checks.equal("Ctrl-C: it says so", "ended before there was a map" in panel.text(), True)


def a_file_is_a_file(folder, map_file, checks):
    for name in ("pres.yaml", "./press", "config/press", str(folder / "press")):
        with Panel(name) as panel:
            checks.equal(f"{name} is missing", (panel.wait(), panel.url), (1, None))
            checks.equal(f"{name}: it says so", "the file cannot be read: No such file" in panel.text(), True)
    (folder / "press").write_text(pathlib.Path(map_file).read_text(encoding="utf-8"), encoding="utf-8")
    with Panel(folder / "press", "--at", "127.0.0.1:1") as panel:
        checks.equal("a file without an ending is a map", "setpoint" in panel.points(), True)


def main():
    node, _, map_file = sys.argv[1:]
    said = subprocess.run([COUPLER, "panel", "--help"], capture_output=True, text=True, check=True).stdout
    if "not in this build" in said:
        peer.skip("this build has no `coupler panel`: libcpp-httplib-dev or libmodbus-dev is missing")
    checks = peer.Checks()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        # They wait more than they compute: all at once.
        with concurrent.futures.ThreadPoolExecutor(max_workers=10) as pool:
            for part in [
                    pool.submit(anything_else_has_a_draft, checks),
                    pool.submit(a_wago_is_recognised, checks),
                    pool.submit(a_wago_has_a_draft, folder, checks),
                    pool.submit(a_wago_is_recorded, folder, checks),
                    pool.submit(a_wago_is_dumped, checks),
                    pool.submit(a_node_gives_its_map, node, map_file, checks),
                    pool.submit(who_is_not_there_is_told, checks),
                    pool.submit(ctrl_c_ends_the_search_and_shows_what_was_found, checks),
                    pool.submit(ctrl_c_ends_a_search_that_has_found_nothing, checks),
                    pool.submit(a_file_is_a_file, folder, map_file, checks)]:
                part.result()
    checks.done("coupler panel and record find out the map of a node, a WAGO and a stranger, and write nothing")


main()
