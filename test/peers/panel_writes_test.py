#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`coupler panel --write`: what pages write arrives at a node and at a server of pymodbus, each outcome is told by its
name, and when nobody is left who has written, the node's watchdog expires.

    panel_writes_test.py NODE COUPLER MAP
"""
import concurrent.futures
import json
import pathlib
import re
import signal
import sys
import tempfile
import threading
import time

import peer

try:
    import foreign_server
    from panel_client import Page, Panel, Writable, raw, skip_if_left_out
except ImportError as error:
    peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")
from recording import Node

WATCHDOG_MAP = pathlib.Path(__file__).resolve().parent / "watchdog.yaml"
STATE, EXPIRED = 0xFF0B, 3
LONGEST_SILENCE = 2  # seconds after which a page that has written counts as gone


def controls(panel, page, checks):
    told = panel.get("/points.json", page.token)
    points = {point["name"]: point.get("write") for point in told["points"]}
    checks.equal("it writes", told["writes"], True)
    checks.equal("controls", {name: write and write["kind"] for name, write in points.items()},
                 {"lamp": "switch", "valves": "text", "door": None, "level": None, "setpoint": "number",
                  "pressure": "number", "label": "text", "word": "text", "mode": "number", "gain": "number",
                  "curve": "text", "secret": "number"})
    checks.equal("a range", [number in points["setpoint"]["range"] for number in ("-100", "100")], [True, True])


def each_kind_is_written(panel, page, client, checks):
    for point, value, shown in (("lamp", "true", True), ("valves", "[true, false, true]", [True, False, True]),
                                ("setpoint", "-100", -100), ("pressure", "-18.3", -18.3), ("label", "ready;", "ready;"),
                                ("word", "0x2F", 0x2F), ("mode", "RUNNING", 3), ("gain", "-1.5", -1.5),
                                ("curve", "[1, -2, 3, 4]", [1, -2, 3, 4]), ("lamp", "false", False)):
        checks.equal(f"{point} = {value}", panel.write(page.token, point, value), {"outcome": "ok", "text": "ok"})
        page.await_value(point, value=shown, checks=checks)
    checks.equal("what can only be written", panel.write(page.token, "secret", "4711")["outcome"], "ok")
    checks.equal("coils as pymodbus reads them", client.read_coils(0, 4, 1).bits[:4], [False, True, False, True])
    checks.equal("registers as pymodbus reads them", client.read_holding_registers(0, 2, 1).registers, [0xFF9C, 217])
    peer.await_true("a write is a line", lambda: len(lines_of(panel, "lamp")) == 2, checks)
    checks.equal("of the page, the point and the outcome",
                 [bool(re.search(r"\bpage 1: lamp\b.*\b(true|false): ok$", line)) for line in lines_of(panel, "lamp")],
                 [True, True])


def lines_of(panel, point):
    return [line for line in panel.text().splitlines() if re.search(rf"page \d+: {point}\b", line)]


def what_is_refused(panel, page, checks):
    for point, value, why in (("setpoint", "101", "100"), ("setpoint", "-101", "-100"), ("setpoint", "1.5", ""),
                              ("setpoint", "", ""), ("setpoint", "fast", ""), ("lamp", "2", ""), ("lamp", "maybe", ""),
                              ("valves", "[true, false]", ""), ("valves", "true", ""), ("curve", "[1, 2, 3, 70000]", ""),
                              ("mode", "1", ""), ("mode", "IDLE", ""), ("label", "longer than 8", ""),
                              ("gain", "nan", ""), ("door", "true", ""), ("level", "3", ""), ("nothing", "1", "nothing")):
        told = panel.write(page.token, point, value)
        checks.equal(f"{point} = {value}: {told}", (told["outcome"], why in told["text"], len(told["text"]) > 10),
                     ("refused", True, True))
    checks.equal("the value stays", page.value("setpoint"), -100)


def what_is_no_write(panel, page, client, checks):
    before = client.read_holding_registers(0, 14, 1).registers
    good = json.dumps({"point": "setpoint", "value": "5"})
    for body in ("", "setpoint=5", "[]", "null", "5", '"setpoint"', '{"point": "setpoint"}', '{"value": "5"}',
                 '{"point": "setpoint", "value": 5}', '{"point": 1, "value": "5"}', '{"point": "setpoint", "value": null}',
                 '{"point": ["setpoint"], "value": "5"}', good[:-1], good + "}", "[" * 4000, '{"a":' * 600,
                 '{"point": "setpoint\xff", "value": "5"'):
        checks.equal(f"{body[:50]!r}", panel.status("POST", "/write", body.encode("latin-1"), page.token), 400)
    checks.equal("no token", panel.status("POST", "/write", good), 401)
    checks.equal("GET", panel.status("GET", "/write", token=page.token), 404)
    checks.equal("a foreign page", panel.status("POST", "/write", good, page.token, Origin="http://evil.example"), 403)
    checks.equal("a foreign name", panel.status("POST", "/write", good, page.token, Host="evil.example"), 403)
    checks.equal("too long", panel.status("POST", "/write", json.dumps({"point": "label", "value": "x" * 5000}),
                                          page.token), 413)
    checks.equal("nothing is written", client.read_holding_registers(0, 14, 1).registers, before)


def a_terminal_obeys_no_page(panel, page, checks):
    """Each write is one line, whatever a page sends."""
    known = panel.text().count("\n")
    for value in ("1\ncoupler panel: page 9: lamp = true: ok", "\x1b]0;title\x07\x1b[2J", "\r\u202e\u2028"):
        for point in ("setpoint", value):
            checks.equal(f"{value!r} is refused", panel.write(page.token, point, value)["outcome"], "refused")
    peer.await_true("each is a line", lambda: panel.text().count("\n") >= known + 6, checks)
    lines = panel.text().split("\n")[known:-1]
    checks.equal("and one only", [line for line in lines if "page 1:" not in line], [])
    checks.equal("of which nothing is obeyed", re.findall(r"[\x00-\x09\x0b-\x1f\x7f\u202e]", panel.text()), [])


class Busy(Writable):
    """Each read takes it a second, each write two."""

    def getValues(self, fc_as_hex, address, count=1):
        time.sleep(1)
        return super().getValues(fc_as_hex, address, count)

    def setValues(self, fc_as_hex, address, values):
        time.sleep(1)
        super().setValues(fc_as_hex, address, values)


def no_click_is_carried_out_late(coupler, folder, checks):
    """Six clicks at once would take it twelve seconds and more."""
    map_file = folder / "busy.yaml"
    map_file.write_text("name: busy\nrate: 1\ntimeout: 20s\nmapping: {holding_registers: {force: {address: 0, type: INT}}}\n",
                        encoding="utf-8")
    device = Busy({"holding_registers": {0: 7}})
    with foreign_server.serving(device) as port, Panel(coupler, map_file, port, "--write") as panel, Page(panel) as page:
        page.await_value("force", 7, checks)
        page.stay_alive()
        with concurrent.futures.ThreadPoolExecutor(6) as pool:
            told = list(pool.map(lambda value: panel.write(page.token, "force", str(value)), range(6)))
    late = [each for each in told if each["outcome"] == "dropped" and "busy" in each["text"]]
    checks.equal(f"some are dropped: {told}", len(late) > 0, True)
    ok, lost = (len([each for each in told if each["outcome"] == outcome]) for outcome in ("ok", "lost"))
    # Lost are those of a page that a busy machine silenced: of these nobody knows.
    checks.equal("what is told to be written is written, and nothing else", ok <= len(device.written) <= ok + lost, True)


def who_has_given_up_writes_nothing(panel, page, client, checks):
    """A request that lay there while the panel did not run, as one that waits for a worker."""
    body = b'{"point": "setpoint", "value": "42"}'
    request = (f"POST /write HTTP/1.1\r\nHost: 127.0.0.1:{panel.port}\r\nAuthorization: Bearer {page.token}\r\n"
               f"Content-Length: {len(body)}\r\n\r\n").encode() + body
    before = client.read_holding_registers(0, 1, 1).registers
    peer.freeze(panel.process)
    with raw(panel, request):
        pass
    panel.process.send_signal(signal.SIGCONT)
    page.await_event("events go on", checks)
    checks.equal("another write is carried out", panel.write(page.token, "lamp", "false")["outcome"], "ok")
    checks.equal("what was given up is not", client.read_holding_registers(0, 1, 1).registers, before)


def outcomes_of_a_device(coupler, map_file, checks):
    device = Writable({"coils": {0: 0, 1: 0, 2: 0, 3: 0}, "discrete_inputs": {0: 0}, "input_registers": {0: 7},
                       "holding_registers": dict.fromkeys(range(14), 0)})  # 14 is missing
    with foreign_server.serving(device) as port, Panel(coupler, map_file, port, "--write") as panel:
        token = panel.token()
        checks.equal("without a page there is no connection", panel.write(token, "lamp", "true")["outcome"], "dropped")
        with Page(panel, token) as page:
            page.await_value("level", 7, checks)
            checks.equal("ok", panel.write(token, "setpoint", "7"), {"outcome": "ok", "text": "ok"})
            told = panel.write(token, "secret", "1")
            checks.equal("an exception", (told["outcome"], "02" in told["text"]), ("exception", True))
            peer.await_true("it is a line", lambda: len(lines_of(panel, "secret")) == 1, checks)
            checks.equal("with the exception", "exception" in lines_of(panel, "secret")[0], True)
            checks.equal("what was written", [(address, values) for _, address, values in device.written], [(0, [7])])
            checks.equal("status", panel.end(), 0)
        checks.equal("the end writes nothing", len(device.written), 1)
    with peer.silent_port() as port, Panel(coupler, map_file, port, "--write") as panel, Page(panel) as page:
        page.await_online(False, checks)
        told = panel.write(page.token, "lamp", "true")
        checks.equal("a device that is not there", told["outcome"] in ("lost", "dropped", "not taken"), True)


def drives(panel, page, client, checks):
    """The page writes, and holds the outputs."""
    def is_on():
        told = panel.write(page.token, "motor", "true")
        return told["outcome"] == "ok" and client.read_discrete_inputs(0, 1, 1).bits[0]
    peer.await_true("the motor runs", is_on, checks)


def is_expired(client):
    return client.read_input_registers(STATE, 1, 1).registers[0] == EXPIRED


def levels(client):
    return client.read_discrete_inputs(0, 3, 1).bits[:3]


def watchdogs(node, coupler, folder, checks):
    map_file = folder / "automatic.yaml"  # the next write drives again: a busy machine may be silent, too
    map_file.write_text(WATCHDOG_MAP.read_text(encoding="utf-8").replace("manual", "automatic"), encoding="utf-8")
    with Node(node, map_file) as device, Panel(coupler, map_file, device.port, "--write") as panel, Page(panel) as looks:
        client = peer.pymodbus_client(device.port)
        for how in ("goes away", "falls silent"):
            writer = Page(panel)
            writer.stay_alive()
            writer.await_online(True, checks)
            drives(panel, writer, client, checks)
            known = panel.text().count("no page that has written")
            (writer.close if how == "goes away" else writer.fall_silent)()
            peer.await_true(f"a page that has written {how}: the outputs are safe",
                            lambda: is_expired(client) and levels(client)[:2] == [False, True], checks)
            peer.await_true("and the terminal says so",
                            lambda known=known: panel.text().count("no page that has written") > known, checks)
            looks.await_value("motor_runs", False, checks)
            looks.await_online(True, checks)
            if how == "falls silent":
                known = writer.events
                peer.await_true("it sees values still", lambda writer=writer, known=known: writer.events > known + 1, checks)
                writer.close()
        checks.equal("pages that only look said nothing", panel.status("POST", "/alive", token=looks.token), 200)
        client.close()
        checks.equal("status", panel.end(), 0)


def one_of_two_writers_goes(node, coupler, map_file, checks):
    """As long as one that has written says that it is there, the connection stays."""
    with Node(node, map_file) as device, Panel(coupler, map_file, device.port, "--write") as panel, \
            Page(panel) as first, Page(panel) as second:
        first.stay_alive()
        second.stay_alive()
        first.await_online(True, checks)
        for page in (first, second):
            checks.equal("it writes", panel.write(page.token, "setpoint", "1")["outcome"], "ok")
        first.close()
        left = time.monotonic()
        peer.await_true("the other one goes on", lambda: time.monotonic() > left + 3 * LONGEST_SILENCE and second.events > 8, checks)
        again = panel.text().count("no page that has written")
        checks.equal("and the connection, unless this machine was silent", again == 0 or second.longest_silence > 1.5, True)
        peer.await_true("it writes", lambda: panel.write(second.token, "setpoint", "2")["outcome"] == "ok", checks)
        again = panel.text().count("no page that has written")
        second.fall_silent()
        peer.await_true("until it is silent, too", lambda: panel.text().count("no page that has written") > again, checks)
        checks.equal("status", panel.end(), 0)


def the_end_waits_for_no_device(node, coupler, folder, checks):
    map_file = folder / "patient.yaml"
    map_file.write_text("name: patient\nrate: 10\ntimeout: 100s\nmapping: {coils: {lamp: 0}}\n", encoding="utf-8")
    with Node(node, map_file) as device, Panel(coupler, map_file, device.port, "--write") as panel, Page(panel) as page:
        page.await_value("lamp", False, checks)
        peer.freeze(device.process)
        told = []
        writing = threading.Thread(target=lambda: told.append(panel.write(page.token, "lamp", "true")), daemon=True)
        writing.start()
        page.await_event("a device is silent, its page is not", checks)
        began = time.monotonic()
        checks.equal("status while a write waits for its answer", panel.end(signal.SIGINT), 0)
        checks.equal("which is not waited for", time.monotonic() - began < 90, True)
        device.process.send_signal(signal.SIGCONT)


def two_pages_write_at_once(panel, page, checks):
    outcomes = []

    def write(values):
        token = panel.token()
        for value in values:
            outcomes.append(panel.write(token, "setpoint", str(value))["outcome"])
    threads = [threading.Thread(target=write, args=(range(start, start + 20),)) for start in (0, 50)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(peer.PATIENCE)
    checks.equal("outcomes of two pages", {*outcomes} - {"ok", "superseded"}, set())
    checks.equal("of each write", len(outcomes), 40)
    peer.await_true("the last value is shown", lambda: page.value("setpoint") in (19, 69), checks)


def what_a_page_writes(node, coupler, map_file, checks):
    with Node(node, map_file) as device, Panel(coupler, map_file, device.port, "--write") as panel, Page(panel) as page:
        client = peer.pymodbus_client(device.port)
        page.await_value("level", -2, checks)
        page.stay_alive()
        controls(panel, page, checks)
        each_kind_is_written(panel, page, client, checks)
        what_is_refused(panel, page, checks)
        what_is_no_write(panel, page, client, checks)
        a_terminal_obeys_no_page(panel, page, checks)
        who_has_given_up_writes_nothing(panel, page, client, checks)
        two_pages_write_at_once(panel, page, checks)
        client.close()
        checks.equal("status", panel.end(), 0)


def main():
    node, coupler, map_file = sys.argv[1:]
    skip_if_left_out(coupler)
    checks = peer.Checks()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        peer.side_by_side((what_a_page_writes, node, coupler, map_file, checks),
                          (outcomes_of_a_device, coupler, map_file, checks), (watchdogs, node, coupler, folder, checks),
                          (the_end_waits_for_no_device, node, coupler, folder, checks),
                          (no_click_is_carried_out_late, coupler, folder, checks),
                          (one_of_two_writers_goes, node, coupler, map_file, checks))
    checks.done("what pages of coupler panel --write write arrives, and they hold no output when they are gone")


main()
