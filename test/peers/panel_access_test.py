#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`coupler panel` shows something only to its own page with the key, wherever it listens, and says what cannot be.

    panel_access_test.py NODE COUPLER MAP
"""
import socket
import subprocess
import sys

import peer

try:
    from panel_client import Page, Panel, answer_to, skip_if_left_out
except ImportError as error:
    peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")
from recording import Node

SECRETS = [("GET", "/points.json"), ("GET", "/history.json"), ("GET", "/seen.csv"), ("GET", "/events"),
           ("POST", "/write"), ("POST", "/alive"), ("GET", "/nothing"), ("GET", "/../etc/passwd")]
SHELL = ["/", "/panel.js", "/panel.css"]


def has_headers(what, headers, checks):
    policy = headers.get("Content-Security-Policy", "")
    checks.equal(f"policy of {what}", ("default-src 'none'" in policy, "unsafe-inline" in policy, "unsafe-eval" in policy,
                                       "frame-ancestors 'none'" in policy), (True, False, False, True))
    checks.equal(f"headers of {what}", [headers.get(name) for name in
                                        ("Referrer-Policy", "Cache-Control", "X-Content-Type-Options")],
                 ["no-referrer", "no-store", "nosniff"])


def only_the_key_opens(panel, checks):
    for path in SHELL:
        status, headers, body = panel.ask("GET", path)
        checks.equal(f"{path} without a token", (status, panel.key in body, "lamp" in body), (200, False, False))
        has_headers(path, headers, checks)
    for key in ("", "0" * 32, panel.key[1:], panel.key + "\n", panel.key.upper() + "x"):
        checks.equal(f"a token for {key!r}", panel.status("POST", "/token", key), 401)
    token = panel.token()
    checks.equal("each page has a token of its own", len({token, panel.token(), panel.key}), 3)
    for method, path in SECRETS:
        for shown in ({}, {"Authorization": f"Bearer {panel.key}"}, {"Authorization": "Bearer "},
                      {"Authorization": f"Basic {token}"}, {"Authorization": token}):
            status, headers, body = panel.ask(method, path, "" if method == "POST" else None, **shown)
            checks.equal(f"{method} {path} with {shown}", (status, "lamp" in body), (401, False))
        has_headers(f"{path} without a token", headers, checks)
    for path in ("/points.json", "/history.json", "/seen.csv"):
        status, headers, _ = panel.ask("GET", path, token=token)
        checks.equal(f"{path} with a token", status, 200)
        has_headers(path, headers, checks)
    for method, path, wanted in (("GET", "/nothing", 404), ("POST", "/points.json", 404), ("POST", "/write", 403),
                                 ("PUT", "/write", 404), ("DELETE", "/token", 404), ("OPTIONS", "/write", 404)):
        status, headers, _ = panel.ask(method, path, '{"point": "lamp", "value": "true"}', token)
        checks.equal(f"{method} {path} with a token", status, wanted)
        has_headers(f"{method} {path}", headers, checks)


def only_its_own_page_asks(panel, checks):
    token, port = panel.token(), panel.port
    for host in ("evil.example", f"evil.example:{port}", "127.0.0.1", f"127.0.0.1:{port - 1}", f"localhost:{port + 1}",
                 f"127.0.0.2:{port}", f"127.0.0.1.evil.example:{port}", f"press.local:{port}", ""):
        status, headers, body = panel.ask("GET", "/points.json", token=token, Host=host)
        checks.equal(f"Host: {host}", (status, "lamp" in body), (403, False))
        has_headers(f"Host: {host}", headers, checks)
        checks.equal(f"no token for Host: {host}", panel.status("POST", "/token", panel.key, Host=host), 403)
        checks.equal(f"no shell for Host: {host}", panel.status("GET", "/", Host=host), 403)
    for host in (f"127.0.0.1:{port}", f"localhost:{port}"):
        checks.equal(f"Host: {host}", panel.status("GET", "/points.json", token=token, Host=host), 200)
        checks.equal(f"Host and Origin: {host}",
                     panel.status("POST", "/alive", "", token, Host=host, Origin=f"http://{host}"), 200)
    for origin in ("http://evil.example", f"http://evil.example:{port}", "null", f"https://127.0.0.1:{port}",
                   f"http://127.0.0.1:{port + 1}", "http://127.0.0.1"):
        for method, path in (("POST", "/token"), ("POST", "/write"), ("GET", "/points.json"), ("GET", "/")):
            checks.equal(f"{path} of Origin: {origin}", panel.status(method, path, panel.key, token, Origin=origin), 403)
    get = f"GET /points.json HTTP/1.1\r\nAuthorization: Bearer {token}\r\n"
    checks.equal("no Host", answer_to(panel, f"{get}\r\n".encode()), 403)
    checks.equal("two Hosts, a foreign one first",
                 answer_to(panel, f"{get}Host: evil.example\r\nHost: 127.0.0.1:{port}\r\n\r\n".encode()) in (400, 403), True)


def a_name_and_IPv6(node, coupler, map_file, checks):
    with Node(node, map_file) as device:
        with Panel(coupler, map_file, device.port, "--name", "Press.local") as panel:
            checks.equal("its address", panel.url.lower().startswith(f"http://press.local:{panel.port}/#"), True)
            token = panel.token()
            for host, wanted in ((f"press.local:{panel.port}", 200), (f"127.0.0.1:{panel.port}", 200),
                                 ("press.local", 403), (f"www.press.local:{panel.port}", 403)):
                checks.equal(f"Host: {host}", panel.status("GET", "/points.json", token=token, Host=host), wanted)
        if not has_ipv6():
            return
        with Panel(coupler, map_file, device.port, "--listen", "::1") as panel, Page(panel) as page:
            checks.equal("its address", panel.url.startswith("http://[::1]:"), True)
            page.await_value("level", -2, checks)


def has_ipv6():
    try:
        with socket.socket(socket.AF_INET6) as place:
            place.bind(("::1", 0))
        return True
    except OSError:
        return False


def what_cannot_be(coupler, map_file, checks):
    def run(*options):
        done = subprocess.run([coupler, "panel", map_file, "--at", "127.0.0.1:9", *map(str, options)], check=False,
                              capture_output=True, text=True, timeout=peer.PATIENCE)
        return done.returncode, done.stdout, done.stderr
    with socket.create_server(("127.0.0.1", 0)) as taken:
        status, said, why = run("--port", taken.getsockname()[1])
        checks.equal("a port that a program has", (status, said, "--port" in why), (2, "", True))
    with Panel(coupler, map_file, 9) as panel:
        try:
            status, said, why = run("--port", panel.port)
            checks.equal("a port that another panel has", (status, said, "--port" in why), (2, "", True))
        except subprocess.TimeoutExpired:
            checks.equal("a port that another panel has", "two panels share it", "status 2")
    for options, remedy in ((("--listen", "0.0.0.0", "--write"), "ssh -L"), (("--listen", "::", "--write"), "ssh -L"),
                            (("--listen", "192.0.2.1"), "--listen"), (("--listen", "press.local"), "IP address")):
        status, said, why = run(*options)
        checks.equal(f"{options}", (status, said, remedy in why), (2, "", True))


def a_network_sees_it(node, coupler, map_file, checks):
    with Node(node, map_file) as device, Panel(coupler, map_file, device.port, "--listen", "0.0.0.0") as panel:
        checks.equal("its address can be opened", panel.host != "0.0.0.0", True)
        with Page(panel) as page:
            page.await_value("level", -2, checks)
        panel.host = "127.0.0.1"
        checks.equal("so can that of this machine", panel.status("GET", "/"), 200)


def main():
    node, coupler, map_file = sys.argv[1:]
    skip_if_left_out(coupler)
    checks = peer.Checks()
    with Node(node, map_file) as device, Panel(coupler, map_file, device.port) as panel:
        only_the_key_opens(panel, checks)
        only_its_own_page_asks(panel, checks)
    a_name_and_IPv6(node, coupler, map_file, checks)
    what_cannot_be(coupler, map_file, checks)
    a_network_sees_it(node, coupler, map_file, checks)
    checks.done("coupler panel shows something to its own pages only")


main()
