#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What others send to the port of `coupler panel` neither stops its pages nor fills its memory: too much, too slowly, too
often, or without ever reading.

    panel_attacks_test.py NODE COUPLER MAP
"""
import contextlib
import gzip
import pathlib
import select
import signal
import socket
import sys
import tempfile
import threading

import peer

try:
    from panel_client import MOST_PAGES, Page, Panel, answer_to, raw, skip_if_left_out
except ImportError as error:
    peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")
from recording import Node

BOUND = 32 * 1024  # KiB that a panel may grow by, whatever happens: buffers of 24 workers and some pages


def post(panel, path, length, body, *headers):
    lines = [f"POST {path} HTTP/1.1", f"Host: 127.0.0.1:{panel.port}", *headers]
    lines += [f"Content-Length: {length}"] if length is not None else []
    return "\r\n".join([*lines, "", ""]).encode() + body


def memory_is_bounded(what, panel, known, checks):
    """A sanitizer keeps what was freed, to find who uses it."""
    if not peer.is_sanitized():
        checks.equal(f"{what}, from {known} KiB", panel.resident() - known < BOUND, True)


def too_much_is_refused(panel, page, client, checks):
    token = f"Authorization: Bearer {page.token}"
    known = panel.resident()
    for path, header in (("/token", "A: b"), ("/write", token), ("/alive", token)):
        checks.equal(f"a body of 1 MB to {path}", answer_to(panel, post(panel, path, 1 << 20, b"x" * (1 << 20), header)),
                     413)
    checks.equal("a length of 2^62", answer_to(panel, post(panel, "/token", 1 << 62, b"", "A: b")) in (400, 413), True)
    chunks = b"%x\r\n%s\r\n" % (1 << 16, b"x" * (1 << 16)) * 64 + b"0\r\n\r\n"
    checks.equal("a body in pieces", answer_to(panel, post(panel, "/token", None, chunks, "Transfer-Encoding: chunked")) in
                 (411, None), True)
    get = f"GET /points.json HTTP/1.1\r\nHost: 127.0.0.1:{panel.port}\r\n{token}\r\n".encode()
    for what, text in (("a line of 1 MB", get + b"A: " + b"x" * (1 << 20) + b"\r\n\r\n"),
                       ("an address of 1 MB", b"GET /" + b"x" * (1 << 20) + b" HTTP/1.1\r\n\r\n"),
                       ("no HTTP", b"\x00\xff" * 1000 + b"\r\n\r\n"), ("no end of a line", b"GET / HTTP/1.1"),
                       ("a header without a colon", b"GET / HTTP/1.1\r\nx\r\n\r\n"), ("nothing", b"\r\n\r\n"),
                       ("a number that is none", post(panel, "/token", "x", b"", "A: b"))):
        status = answer_to(panel, text)
        checks.equal(f"{what}: {status}", status is None or 400 <= status < 500, True)
    memory_is_bounded("memory afterwards", panel, known, checks)
    page.await_change("events go on after that", client, checks)


def little_that_becomes_much_is_refused(panel, page, client, checks):
    known = panel.resident()
    packed = gzip.compress(bytes(3 << 20))
    for coding in ("gzip", "br", "deflate"):
        checks.equal(f"a body in {coding}",
                     answer_to(panel, post(panel, "/token", len(packed[:4000]), packed[:4000], f"Content-Encoding: {coding}")), 415)
    ranges = "bytes=" + ",".join(["0-"] * 2000)
    for path in ("/panel.js", "/nowhere"):
        status, _, text = panel.ask("GET", path, Range=ranges)
        checks.equal(f"{path} in 2,000 ranges: {status}, {len(text)} bytes", len(text) < 100_000, True)
    memory_is_bounded("memory afterwards", panel, known, checks)
    page.await_change("events go on after that", client, checks)


def headers_without_end(panel, page, client, checks):
    """Short lines, as many as it takes."""
    known = panel.resident()
    lines = b"".join(b"H%d: %s\r\n" % (i, b"x" * 50) for i in range(10000))
    with raw(panel, f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{panel.port}\r\n".encode()) as connection:
        with contextlib.suppress(OSError):  # closed: good
            for _ in range(150):  # 90 MB
                connection.sendall(lines)
                if panel.resident() - known > BOUND:
                    break
        memory_is_bounded("memory while headers come", panel, known, checks)
    page.await_change("events go on after the headers", client, checks)


def idle_sockets_stop_nobody(panel, page, client, checks):
    with contextlib.ExitStack() as sockets:
        for begin in (b"", b"GET /points.json HTTP/1.1\r\nHost: ") * 50:
            sockets.enter_context(raw(panel, begin))
        page.await_change("events go on beside 100 idle sockets", client, checks)
        checks.equal("a request is answered", panel.status("GET", "/points.json", token=page.token), 200)
        with Page(panel) as another:
            another.await_value("level", -2, checks)
    page.await_change("events go on after 100 idle sockets", client, checks)


@contextlib.contextmanager
def slow_requests(panel, number):
    """They say something now and then, and never end."""
    ended = threading.Event()
    sockets = [socket.create_connection((panel.host, panel.port), timeout=peer.PATIENCE) for _ in range(number)]

    open_ones = list(sockets)

    def say(text):
        for each in open_ones[:]:
            try:
                each.sendall(text)
            except OSError:
                open_ones.remove(each)

    def drip():
        while not ended.wait(0.5):
            say(b"x")
    say(f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{panel.port}\r\nA: ".encode())
    thread = threading.Thread(target=drip)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()
        for each in sockets:
            each.close()


def silence_holds_up_nobody(panel, page, checks):
    """Whoever says nothing is not in the way of those who come after: they are answered before it is given up."""
    def is_answered_first():
        with contextlib.ExitStack() as sockets:
            silent = [sockets.enter_context(raw(panel, begin)) for begin in (b"", b"GET / HTTP/1.1\r\nHost: ") * 100]
            if panel.status("POST", "/alive", token=page.token) != 200:
                return False
            return not select.select(silent, [], [], 0)[0]  # one that is closed would be readable
    peer.await_true("a request is answered before 200 that came earlier", is_answered_first, checks)


def far_too_many_leave_room(panel, page, client, checks):
    """More connections than it waits for: the oldest go, and a request that is there at once is answered."""
    def do_the_oldest_go():
        with contextlib.ExitStack() as sockets:
            silent = [sockets.enter_context(raw(panel)) for _ in range(600)]
            if panel.status("POST", "/alive", token=page.token) != 200:
                return False
            closed = select.select(silent, [], [], 0)[0]
            return [each in closed for each in (*silent[:200], *silent[-200:])] == [True] * 200 + [False] * 200
    peer.await_true("of 600 the oldest go, and one that says something is answered", do_the_oldest_go, checks)
    page.await_change("events go on after that", client, checks)


def slow_requests_stop_nobody(panel, page, client, checks):
    with slow_requests(panel, 60):
        page.await_change("events go on beside 60 slow requests", client, checks)
        answered = threading.Event()

        def ask():
            with contextlib.suppress(OSError):
                if panel.status("GET", "/points.json", token=page.token) == 200:
                    answered.set()
        asking = threading.Thread(target=ask, daemon=True)
        asking.start()
        peer.await_true("a request is answered beside 60 slow ones", answered.is_set, checks)
    asking.join(peer.PATIENCE)


def the_end_waits_for_nobody(coupler, map_file, port, checks):
    with Panel(coupler, map_file, port) as panel, Page(panel), slow_requests(panel, 4), raw(panel):
        checks.equal("status after SIGINT beside slow requests", panel.end(signal.SIGINT), 0)


def nine_pages(panel, client, checks):
    with contextlib.ExitStack() as opened:
        pages = [opened.enter_context(Page(panel)) for _ in range(MOST_PAGES - 1)]  # one is there already
        for page in pages:
            page.await_value("level", -2, checks)
        with Page(panel) as ninth:
            checks.equal("the ninth page", (ninth.status, ninth.headers["Cache-Control"]), (503, "no-store"))
        pages[3].close()

        def comes_in():
            with Page(panel) as next_one:
                return next_one.status == 200
        peer.await_true("when one has left another one may come", comes_in, checks)
        pages[0].await_change("the others go on", client, checks)


def pages_that_do_not_read(node, coupler, folder, checks):
    """A register of 2,000 changes all the time, and each event is told to who does not take it."""
    lines = ["name: plant", "rate: 50", "timeout: 20s", "mapping:", "  input_registers: {level: {address: 0, type: INT, initial: 7}}",
             "  holding_registers:"]
    lines += [f"    r{i}: {{address: {i * 100}, type: INT, count: 100}}" for i in range(20)]
    map_file = folder / "plant.yaml"
    map_file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    with Node(node, map_file) as device, Panel(coupler, map_file, device.port) as panel, Page(panel) as page, \
            contextlib.ExitStack() as sockets:
        page.await_value("level", 7, checks)
        for _ in range(MOST_PAGES - 1):
            stalled = sockets.enter_context(socket.socket())
            stalled.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            stalled.connect((panel.host, panel.port))
            stalled.sendall(f"GET /events HTTP/1.1\r\nHost: 127.0.0.1:{panel.port}\r\n"
                            f"Authorization: Bearer {panel.token()}\r\n\r\n".encode())
        known = panel.resident()
        client = peer.pymodbus_client(device.port)
        for value in range(1, 200):
            for place in range(0, 2000, 100):
                client.write_registers(place, [value] * 100, 1)
        page.await_value("r19", [199] * 100, checks)
        client.close()
        memory_is_bounded("memory beside pages that do not read", panel, known, checks)

        def comes_in():
            with Page(panel) as next_one:
                return next_one.status == 200
        peer.await_true("their places become free", comes_in, checks)
        checks.equal("status", panel.end(), 0)


def whatever_is_sent(coupler, map_file, port, checks):
    client = peer.pymodbus_client(port)
    with Panel(coupler, map_file, port) as panel, Page(panel) as page:
        page.await_value("level", -2, checks)
        for part in (too_much_is_refused, little_that_becomes_much_is_refused, headers_without_end, idle_sockets_stop_nobody):
            part(panel, page, client, checks)
        silence_holds_up_nobody(panel, page, checks)
        far_too_many_leave_room(panel, page, client, checks)
        slow_requests_stop_nobody(panel, page, client, checks)
        nine_pages(panel, client, checks)
        page.await_change("the first page sees events", client, checks)
        checks.equal("status", panel.end(signal.SIGINT), 0)
    client.close()


def main():
    node, coupler, map_file = sys.argv[1:]
    skip_if_left_out(coupler)
    checks = peer.Checks()
    with tempfile.TemporaryDirectory() as name, Node(node, map_file) as device:
        peer.side_by_side((whatever_is_sent, coupler, map_file, device.port, checks),
                          (the_end_waits_for_nobody, coupler, map_file, device.port, checks),
                          (pages_that_do_not_read, node, coupler, pathlib.Path(name), checks))
    checks.done("whatever is sent to it, the pages of coupler panel go on and its memory is bounded")


main()
