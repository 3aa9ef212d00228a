#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`coupler panel` by HTTPS, as Python's ssl and OpenSSL's program see it: pages of a whole network may write, and who does not
speak TLS, or stops in the middle of it, stops nobody.

    panel_tls_test.py NODE COUPLER MAP
"""
import contextlib
import http.client
import pathlib
import select
import signal
import socket
import ssl
import subprocess
import sys
import tempfile

import peer

try:
    from panel_client import MOST_PAGES, Page, Panel, answer_to, raw, skip_if_left_out
except ImportError as error:
    peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")
from recording import Node, Program


def trust(authority, version=None):
    context = ssl.create_default_context(cafile=authority)
    if version:
        context.minimum_version = context.maximum_version = version
    return context


def it_shows_and_writes(panel, client, checks):
    checks.equal("the address", panel.url.startswith("https://bench.local:"), True)
    with Page(panel) as page:
        page.await_value("level", -2, checks)
        checks.equal("a write", panel.write(page.token, "lamp", "true"), {"outcome": "ok", "text": "ok"})
        page.await_value("lamp", True, checks)
        own = f"https://127.0.0.1:{panel.port}"
        for origin, wanted in ((own, 200), (own.replace("https", "http"), 403), ("https://evil.example", 403)):
            checks.equal(f"a write from {origin}", panel.status("POST", "/write", '{"point": "lamp", "value": "false"}',
                                                                page.token, Origin=origin), wanted)
        page.await_value("lamp", False, checks)
        status, _, script = panel.ask("GET", "/panel.js")
        checks.equal("a file of several records", (status, len(script) > 1 << 13), (200, True))
        page.await_change("events go on", client, checks)


def each_version_from_1_2_on_is_spoken(panel, authority, checks):
    for version in (ssl.TLSVersion.TLSv1_2, ssl.TLSVersion.TLSv1_3):
        with socket.create_connection((panel.host, panel.port), peer.PATIENCE) as plain, \
                trust(authority, version).wrap_socket(plain, server_hostname="bench.local") as connection:
            checks.equal("version and cipher", (connection.version().replace(".", "_"), connection.cipher()[2] >= 128),
                         (version.name, True))
    done = subprocess.run(["openssl", "s_client", "-connect", f"127.0.0.1:{panel.port}", "-tls1_1", "-cipher",
                           "DEFAULT@SECLEVEL=0"], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    checks.equal("TLS 1.1", (done.returncode != 0, "protocol version" in done.stderr), (True, True))


def who_is_not_believed_is_not_asked(panel, checks):
    with socket.create_connection((panel.host, panel.port), peer.PATIENCE) as plain:
        try:
            ssl.create_default_context().wrap_socket(plain, server_hostname="bench.local")
            verdict = "believed"
        except ssl.SSLCertVerificationError:
            verdict = "not believed"
    checks.equal("without its authority the certificate is", verdict, "not believed")


def what_is_no_tls_stops_nobody(panel, client, checks):
    with Page(panel) as page:
        for what, text in (("nothing of it", bytes(2000)), ("an alert", b"\x15\x03\x01\x00\x02\x02\x28"),
                           ("a record that is too long", b"\x16\x03\x01\xff\xff" + bytes(100))):
            checks.equal(f"{what} is answered with", answer_to(panel, text), None)
        hello = b"\x16\x03\x01\x00\xf8\x01\x00\x00\xf4\x03\x03"  # of a ClientHello whose rest never comes
        with contextlib.ExitStack() as sockets:
            for begin in (b"", hello) * 50:
                sockets.enter_context(raw(panel, begin))
            page.await_change("events go on beside 100 that have begun", client, checks)
            checks.equal("a request is answered", panel.status("GET", "/points.json", token=page.token), 200)


def http_is_told_of_https(panel, page, checks):
    """A browser in which only name and port are typed asks by HTTP; it keeps what stands behind #."""
    host = f"127.0.0.1:{panel.port}"
    plain = http.client.HTTPConnection(host, timeout=peer.PATIENCE)
    plain.request("GET", "/panel.js")
    answer = plain.getresponse()
    checks.equal("HTTP is sent to", (answer.status, answer.headers["Location"]), (302, f"https://{host}/"))
    answer.read()
    plain.close()
    for path, header, wanted in (("/token", f"Host: {host}", 400), ("/write", f"Host: {host}", 400),
                                 ("/write", "Host: evil.example", 403)):
        text = f"POST {path} HTTP/1.1\r\n{header}\r\nAuthorization: Bearer {page.token}\r\nContent-Length: 2\r\n\r\n{{}}"
        checks.equal(f"{path} by HTTP, {header}", answer_to(panel, text.encode()), wanted)


def what_browsers_object_to_is_told(coupler, map_file, folder, checks):
    cell = folder / "cell"
    for options, certificate, words in (([], "page", None), (["--name", "bench.local"], "page", None),
                                        (["--name", "press.local"], "page", "press.local (it has 127.0.0.1, bench.local)"),
                                        ([], "cell1", "not for a server")):
        with Panel(coupler, map_file, 1, *options, "--page-certificate", cell / certificate / f"{certificate}.pem",
                   "--page-key", cell / certificate / f"{certificate}.key") as panel:
            peer.await_true("it has begun", lambda: "Ctrl-C" in panel.text(), checks)  # pylint: disable=cell-var-from-loop
            said = panel.text()
        checks.equal(f"{options} with {certificate}: {said}", ("warning: the page's certificate: it" in said, (words or "") in said),
                     (words is not None, True))


def the_certificate_is_looked_at_first(coupler, folder, checks):
    """Before a device is asked, which may take minutes."""
    with socket.create_server(("127.0.0.1", 0)) as device:
        done = subprocess.run([coupler, "panel", f"127.0.0.1:{device.getsockname()[1]}", "--page-certificate", folder / "none.pem",
                               "--page-key", folder / "none.key"], capture_output=True, text=True, timeout=peer.PATIENCE, check=False)
        checks.equal(f"without its certificate: {done.stderr}", (done.returncode, "none.pem" in done.stderr), (2, True))
        checks.equal("the device was not asked", select.select([device], [], [], 0)[0], [])


def who_has_left_makes_room(panel, client, checks):
    for _ in range(3):
        with contextlib.ExitStack() as opened:
            pages = []

            def comes_in():
                page = Page(panel)
                if page.status == 200:
                    pages.append(opened.enter_context(page))  # pylint: disable=cell-var-from-loop
                return page.status == 200  # pylint: disable=cell-var-from-loop
            for _ in range(MOST_PAGES):
                peer.await_true("there is room for as many as before", comes_in, checks)
            pages[-1].await_change("the last of so many has events", client, checks)
            with Page(panel) as one_more:
                checks.equal("one more", one_more.status, 503)


def what_cannot_be_is_told(coupler, map_file, folder, checks):
    page = folder / "cell" / "page"
    public = folder / "public.key"
    public.write_bytes((page / "page.key").read_bytes())
    public.chmod(0o644)
    everywhere = ["--write", "--listen", "0.0.0.0"]
    for options, words in ((everywhere, ["--page-certificate", "ssh -L"]),
                           (["--page-certificate", page / "page.pem"], ["--page-key"]),
                           (["--page-key", page / "page.key"], ["--page-certificate"]),
                           (["--page-certificate", "", "--page-key", ""], ["--page-certificate FILE"]),
                           (["--page-certificate", folder / "none.pem", "--page-key", page / "page.key"],
                            ["page's certificate", "none.pem", "cannot be read"]),
                           (["--page-certificate", page / "page.pem", "--page-key", public], ["page's key", "is not secret"]),
                           (["--page-certificate", page / "page.pem", "--page-key", folder / "cell" / "other" / "other.key"],
                            ["the key does not belong to the certificate"]),
                           (["--page-certificate", map_file, "--page-key", page / "page.key"], ["no PEM certificate"])):
        with Program(coupler, "panel", map_file, "--at", "127.0.0.1:1", *options) as program:
            status = program.wait()
            said = program.text()
        checks.equal(f"with {options}: {said}", (status, [word in said for word in words]), (2, [True] * len(words)))


def main():
    node, coupler, map_file = sys.argv[1:]
    skip_if_left_out(coupler)
    checks = peer.Checks()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        made = subprocess.run([coupler, "certificates", folder / "cell", "--node", "page:127.0.0.1,bench.local", "--node", "other",
                               "--client", "cell1:operator"],
                              capture_output=True, text=True, check=False)
        if "OpenSSL" in made.stderr:
            peer.skip("coupler was built without OpenSSL; run scripts/install-packages build")
        page, authority = folder / "cell" / "page", folder / "cell" / "authority" / "authority.pem"
        what_cannot_be_is_told(coupler, map_file, folder, checks)
        what_browsers_object_to_is_told(coupler, map_file, folder, checks)
        the_certificate_is_looked_at_first(coupler, folder, checks)
        with Node(node, map_file) as device, \
                Panel(coupler, map_file, device.port, "--write", "--listen", "0.0.0.0", "--name", "bench.local",
                      "--page-certificate", page / "page.pem", "--page-key", page / "page.key", trust=trust(authority)) as panel:
            client = peer.pymodbus_client(device.port)
            it_shows_and_writes(panel, client, checks)
            each_version_from_1_2_on_is_spoken(panel, authority, checks)
            who_is_not_believed_is_not_asked(panel, checks)
            what_is_no_tls_stops_nobody(panel, client, checks)
            with Page(panel) as opened:
                http_is_told_of_https(panel, opened, checks)
            who_has_left_makes_room(panel, client, checks)
            client.close()
            with Page(panel), raw(panel):
                checks.equal("status after SIGINT beside a page", panel.end(signal.SIGINT), 0)
    checks.done("coupler panel by HTTPS is HTTPS, and who does not speak it stops nobody")


main()
