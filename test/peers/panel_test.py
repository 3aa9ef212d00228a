#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`coupler panel` over real HTTP: pages see what pymodbus does to a node, and what a server of pymodbus holds, as
long as a page looks. Nobody writes.

    panel_test.py NODE COUPLER MAP
"""
import csv
import io
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

import peer

try:
    import foreign_server
    from panel_client import READS, Page, Panel, Writable, skip_if_left_out
except ImportError as error:
    peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")
from recording import Node

sys.path.append(str(pathlib.Path(__file__).parents[1] / "ros"))
from support.process import LIMITABLE, limit_threads, limitable_environment

POINTS = ["lamp", "valves", "door", "level", "setpoint", "pressure", "label", "word", "mode", "gain", "curve"]


def values_come_and_change(node, coupler, map_file, checks):
    with Node(node, map_file) as device, Panel(coupler, map_file, device.port) as panel, Page(panel) as page:
        page.await_online(True, checks)
        for point, value in (("lamp", False), ("valves", [False] * 3), ("door", False), ("level", -2), ("setpoint", 0),
                             ("pressure", -40.0), ("label", ""), ("word", 0), ("mode", 0), ("gain", 0.0),
                             ("curve", [0] * 4)):
            page.await_value(point, value, checks)
        client = peer.pymodbus_client(device.port)
        client.write_coils(0, [True, False, True, False], 1)
        client.write_registers(0, [0xFFFE, 217, 0x6E6F, 0x0065, 0, 0, 0x2F, 3, 0, 0x4148, 1, 0xFFFF, 3, 4], 1)
        for point, value in (("lamp", True), ("valves", [False, True, False]), ("door", True), ("setpoint", -2),
                             ("pressure", -18.3), ("label", "one"), ("word", 0x2F), ("mode", 3), ("gain", 12.5),
                             ("curve", [1, -1, 3, 4])):
            page.await_value(point, value, checks)
        checks.equal("texts", [page.points[point]["text"] for point in ("lamp", "mode", "valves", "word", "curve")],
                     ["true", "RUNNING", "[false, true, false]", "0x002F", "[1, -1, 3, 4]"])
        checks.equal("what can only be written has no value", "value" in page.points.get("secret", {}), False)
        peer.await_true("the device's numbers come", lambda: page.device.get("requests", 0) > 0, checks)
        checks.equal("and are numbers", [page.device["errors"], page.device["round_trip_ms"] >= 0], [0, True])
        client.write_coil(0, False, 1)
        page.await_value("door", False, checks)
        what_else_is_served(panel, page, checks)
        client.close()
        checks.equal("status after SIGINT", panel.end(signal.SIGINT), 0)
        peer.await_true("the page sees the end", lambda: page.is_over, checks)
        checks.equal("status of the node", device.end(), 0)


def what_else_is_served(panel, page, checks):
    told = panel.get("/points.json", page.token)
    checks.equal("its name and where it is", (told["name"], told["place"].startswith("tcp://127.0.0.1:"), told["writes"]),
                 ("press", True, False))
    points = {point["name"]: point for point in told["points"]}
    checks.equal("points in the order of the map, without those that cannot be read", list(points), POINTS)
    checks.equal("no controls", [name for name, point in points.items() if "write" in point], [])
    checks.equal("what is said of points", [points["lamp"]["description"], points["setpoint"]["units"]],
                 ["Lamp above the door", "mm"])
    checks.equal("where it is, as requests count and as Modicon does",
                 [[points[name][key] for key in ("place", "modicon")] for name in ("lamp", "door", "level", "gain")],
                 [["coils 0", "00001"], ["discrete_inputs 0", "10001"], ["input_registers 0", "30001"],
                  ["holding_registers 8 – 9", "40009 – 40010"]])
    checks.equal("names of values", points["mode"]["values"], [[0, "OFF"], [3, "RUNNING"]])
    checks.equal("bits", (points["word"]["bits"], "bits" in points["setpoint"]), (16, False))
    history = panel.get("/history.json", page.token)
    of_each = [name for point in POINTS for name in ([point, "word.bits"] if point == "word" else [point])]
    checks.equal("a history each, and one of a word's bits", list(history),
                 [*of_each, "secret"] if "secret" in history else of_each)
    checks.equal("bits that were on", int(history["word.bits"][-1][0], 16), 0x2F)
    checks.equal("300 steps", {len(steps) for steps in history.values()}, {300})
    checks.equal("of level", history["level"][-1], [-2, -2])
    checks.equal("of pressure, both values it had", [[round(number, 1) for number in step]
                                                     for step in history["pressure"] if step][-1][1], -18.3)
    status, headers, text = panel.ask("GET", "/seen.csv", token=page.token)
    checks.equal("the loop check", (status, headers["Content-Type"].startswith("text/csv"), text.count("\r\n")),
                 (200, True, text.count("\n")))
    rows = {row["point"]: row for row in csv.DictReader(io.StringIO(text))}
    checks.equal("what was seen", [(rows[name]["seen_off"], rows[name]["seen_on"]) for name in ("door", "setpoint", "level")],
                 [("yes", "yes"), ("yes", "yes"), ("no", "yes")])
    checks.equal("and where", [[rows[name][key] for key in ("table", "address", "modicon", "part")] for name in ("door", "gain")],
                 [["discrete_inputs", "0", "10001", ""], ["holding_registers", "8", "40009", ""]])
    checks.equal("of bits of a word, too", [list(rows[f"word.{bit}"].values()) for bit in (0, 4)],
                 [["word.0", "yes", "yes", "1", "holding_registers", "6", "40007", "bit 0"],
                  ["word.4", "yes", "no", "0", "holding_registers", "6", "40007", "bit 4"]])


def a_device_goes_and_comes_back(node, coupler, map_file, checks):
    with peer.silent_port() as port, Panel(coupler, map_file, port) as panel, Page(panel) as page:
        page.await_online(False, checks)
        peer.await_true("a page says why", lambda: "refused" in page.device.get("why", ""), checks)
        with Node(node, map_file, port=port) as device:
            page.await_online(True, checks)
            page.await_value("level", -2, checks)
            device.end()
        page.await_online(False, checks)
        peer.await_true("all points are offline", lambda: {page.quality(point) for point in POINTS} == {"offline"}, checks)
        checks.equal("with the last value", page.value("level"), -2)
        peer.await_true("why", lambda: page.device.get("why"), checks)
        with Page(panel) as late:
            late.await_online(False, checks)
            peer.await_true("a page that comes then sees it, too", lambda: late.quality("level") == "offline", checks)
        with Node(node, map_file, port=port):
            page.await_online(True, checks)
            for point in POINTS:
                peer.await_true(f"{point} is good again", lambda point=point: page.quality(point) == "good", checks)
        checks.equal("status", panel.end(), 0)


class Moody(Writable):
    """Something is broken behind register 1, now and then."""

    is_broken = False

    def getValues(self, fc_as_hex, address, count=1):
        if self.is_broken and fc_as_hex == 3 and address <= 1 < address + count:
            raise RuntimeError("pymodbus answers with exception 04")
        return super().getValues(fc_as_hex, address, count)


def tables():
    return {"coils": dict.fromkeys(range(4), 0), "discrete_inputs": {0: 0}, "input_registers": {0: 7},
            "holding_registers": dict.fromkeys(range(15), 0)}


def nobody_looks_nobody_reads(coupler, map_file, checks):
    device = Moody(tables())
    with foreign_server.serving(device) as port, Panel(coupler, map_file, port) as panel:
        token = panel.token()
        for path in ("/points.json", "/history.json", "/seen.csv"):
            panel.get(path, token)
        checks.equal("requests before there is a page", device.functions, [])
        with Page(panel, token) as page:
            page.await_value("level", 7, checks)
            peer.await_true("the device's numbers come", lambda: page.device.get("requests", 0) > 0, checks)
            checks.equal("that it refuses the question for its identity is no failure", page.device["errors"], 0)
            device.is_broken = True
            peer.await_true("an exception is shown", lambda: page.quality("pressure") == "exception", checks)
            checks.equal("with its code", page.points["pressure"]["exception"], 4)
            device.is_broken = False
            page.await_value("pressure", -40.0, checks)
        await_standstill("without a page, requests end", device.functions, checks)
        known = len(device.functions)
        with Page(panel) as page:
            device.tables["input_registers"][0] = 8
            page.await_value("level", 8, checks)
        checks.equal("requests go on with the next page", len(device.functions) > known, True)
        checks.equal("status", panel.end(), 0)
    checks.equal("functions that pymodbus was asked for", {*device.functions} - READS, set())


def await_standstill(what, grows, checks):
    """For much longer than the second in which a page that has gone is noticed."""
    known, since = -1, 0

    def has_stood_still():
        nonlocal known, since
        if len(grows) != known:
            known, since = len(grows), time.monotonic()
        return time.monotonic() > since + 3
    peer.await_true(what, has_stood_still, checks)


def the_end_writes_nothing(coupler, map_file, options, number, checks):
    device = Writable(tables())
    device.tables["coils"][0] = 1
    with foreign_server.serving(device) as port, Panel(coupler, map_file, port, *options) as panel, Page(panel) as page:
        page.await_value("lamp", True, checks)
        page.await_event("events go on, for longer than a dead man's second", checks)
        checks.equal(f"status after {number.name} with {options}", panel.end(number), 0)
        checks.equal("what was written", device.written, [])
        checks.equal("functions", {*device.functions} - READS, set())


def a_thousand_points(node, coupler, folder, checks):
    lines = ["name: plant", "rate: 10", "timeout: 20s", "mapping:", "  coils:"]
    lines += [f"    c{i}: {i}" for i in range(500)] + ["  holding_registers:"]
    lines += [f"    r{i}: {{address: {i}, type: INT}}" for i in range(500)]
    map_file = folder / "plant.yaml"
    map_file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    with Node(node, map_file) as device, Panel(coupler, map_file, device.port) as panel, Page(panel) as page:
        checks.equal("points", len(panel.get("/points.json", page.token)["points"]), 1000)
        peer.await_true("each has a value", lambda: sum(state["quality"] == "good" for state in
                                                        list(page.points.values())) == 1000, checks)
        client = peer.pymodbus_client(device.port)
        client.write_register(499, 4711, 1)
        client.write_coil(499, True, 1)
        page.await_value("r499", 4711, checks)
        page.await_value("c499", True, checks)
        client.close()
        checks.equal("histories", len(panel.get("/history.json", page.token)), 1000)
        checks.equal("lines of the loop check", panel.get("/seen.csv", page.token).count("\n"), 1001)
        checks.equal("status", panel.end(), 0)


def a_thread_that_cannot_be_had(node, coupler, map_file, checks):
    """The connection's own, which begins with the first page."""
    why = "no thread can be started: Resource temporarily unavailable; look at its limits"
    with Node(node, map_file) as device, \
            Panel(coupler, map_file, device.port, under=LIMITABLE, env=limitable_environment()) as panel:
        token = panel.token()
        limit_threads(panel.process.pid, 1)
        status, _, text = panel.ask("GET", "/events", token=token)
        checks.equal("a page is told why", (status, text[:len(why)]), (503, why))
        limit_threads(panel.process.pid)
        with Page(panel, token) as page:
            page.await_value("level", -2, checks)
        checks.equal("status", panel.end(), 0)
    if not peer.is_sanitized():  # a sanitizer may want a thread of its own
        start = subprocess.run([*LIMITABLE, "prlimit", "--nproc=1", coupler, "panel", map_file, "--at", "127.0.0.1"],
                               capture_output=True, text=True, timeout=peer.PATIENCE, check=False)
        checks.equal("without any there is no panel", (start.returncode, start.stderr[:len(why) + 16]),
                     (3, "coupler: error: " + why))


def main():
    node, coupler, map_file = sys.argv[1:]
    skip_if_left_out(coupler)
    checks = peer.Checks()
    ends = [(the_end_writes_nothing, coupler, map_file, options, number, checks)
            for options in ((), ("--write",)) for number in (signal.SIGINT, signal.SIGTERM)]
    with tempfile.TemporaryDirectory() as name:
        peer.side_by_side((values_come_and_change, node, coupler, map_file, checks),
                          (a_device_goes_and_comes_back, node, coupler, map_file, checks),
                          (nobody_looks_nobody_reads, coupler, map_file, checks),
                          (a_thread_that_cannot_be_had, node, coupler, map_file, checks),
                          (a_thousand_points, node, coupler, pathlib.Path(name), checks), *ends)
    checks.done("coupler panel shows its pages what a device has, and writes nothing to it")


main()
