#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A node with TLS against Python's ssl and OpenSSL's s_client: whom it lets in, what each may do, and what becomes of
them when it reads its map again, and when one of its processes dies. The tools against OpenSSL's s_server: which they
believe. Certificates are made by OpenSSL's own program.

    tls_test.py NODE GENERATED_NODE COUPLER MAP
"""
import contextlib
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import ssl
import struct
import subprocess
import sys
import tempfile
import threading

import peer
from authority import Authority

NODE, GENERATED, COUPLER, MAP = sys.argv[1:5]
if shutil.which("openssl") is None:
    peer.skip("the program openssl is missing; apt install openssl")


def adu(*pdu):
    return struct.pack(">HHHB", 7, 0, len(pdu) + 1, 1) + bytes(pdu)


READ_LAMP = adu(1, 0, 0, 0, 1)
READ_SPEED = adu(3, 0, 0, 0, 1)
READ_IDENTITY = adu(4, 0xFF, 0, 0, 13)
READ_STATISTICS = adu(4, 0xFF, 0x0D, 0, 1)
READ_MAP = adu(20, 7, 6, 0, 1, 0, 0, 0, 1)
LAMP_ON = adu(5, 0, 0, 0xFF, 0)
SPEED_7 = adu(6, 0, 0, 0, 7)
ECHO = adu(8, 0, 0, 0x12, 0x34)


class Node:
    def __init__(self, folder, *command):
        self.folder = pathlib.Path(folder)
        self.said = []
        self.process = subprocess.Popen(
            [*command, "--sim", "--listen", "127.0.0.1", "--port", "0", "--tls-port", "0"], cwd=folder,
            stderr=subprocess.PIPE, text=True)
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()
        self.await_line("serving")
        found = re.search(r"on 127\.0\.0\.1:(\d+), TLS at 127\.0\.0\.1:(\d+)", self.text())
        self.port, self.tls_port = (int(found.group(i)) for i in (1, 2))

    def _read(self):
        for line in self.process.stderr:
            self.said.append(line)

    def text(self):
        return "".join(self.said)

    def await_line(self, part, count=1):
        checks = peer.Checks()
        peer.await_true(part, lambda: sum(part in line for line in self.said) >= count or self.process.poll() is not None,
                        checks)
        if sum(part in line for line in self.said) < count:
            print(f"FAILED: the node did not say '{part}'; it said:\n{self.text()}")
            self.end()
            sys.exit(1)

    def reload(self, map_text, says="read the map again"):
        count = sum(says in line for line in self.said) + 1
        (self.folder / "cell.yaml").write_text(map_text)
        self.process.send_signal(signal.SIGHUP)
        self.await_line(says, count)

    def child(self, name):
        """The process of that name below the node."""
        listed = subprocess.run(["ps", "-o", "pid=,comm=", "--ppid", str(self.process.pid)], capture_output=True, text=True)
        return next((int(line.split()[0]) for line in listed.stdout.splitlines() if line.split()[1] == name), None)

    def end(self):
        self.process.terminate()
        self.process.wait(timeout=peer.PATIENCE)
        self._reader.join(timeout=peer.PATIENCE)


class Client:
    """A connection by Python's ssl; `problem` says why there is none."""

    def __init__(self, node, name, version=None):
        folder = node.folder
        context = ssl.create_default_context(ssl.Purpose.SERVER_AUTH, cafile=folder / "ca.pem")
        if name:
            context.load_cert_chain(folder / f"{name}.pem", folder / f"{name}.key")
        if version:
            context.minimum_version = context.maximum_version = version
        self.problem = ""
        self.socket = None
        self._come = b""
        plain = socket.create_connection(("127.0.0.1", node.tls_port), peer.PATIENCE)
        try:
            self.socket = context.wrap_socket(plain, server_hostname="127.0.0.1")
            # With TLS 1.3 a refusal comes after the handshake of this side.
            self.problem = self.ask(ECHO) and ""
        except OSError as error:
            self.problem = str(error)

    def ask(self, request):
        """The PDU of the answer; nothing at the end of the connection."""
        self.socket.settimeout(peer.PATIENCE)
        self.socket.sendall(request)
        return self.receive()

    def receive(self):
        while (size := self._size()) is None or len(self._come) < size:
            part = self.socket.recv(300)
            if not part:
                return b""
            self._come += part
        pdu, self._come = self._come[7:size], self._come[size:]
        return pdu

    def _size(self):
        return 6 + struct.unpack(">H", self._come[4:6])[0] if len(self._come) >= 6 else None

    def code(self, request):
        """What came of a request: its function code, or 'exception N', or 'closed'."""
        try:
            pdu = self.ask(request)
        except OSError:
            return "closed"
        if not pdu:
            return "closed"
        return f"exception {pdu[1]:02}" if pdu[0] & 0x80 else pdu[0]

    def close(self):
        if self.socket:
            self.socket.close()


def make_certificates(folder):
    ca = Authority(folder)
    ca.node("node")
    ca.client("operator", "ASN1:UTF8String:operator")
    ca.client("operator_critical", "critical,ASN1:UTF8String:operator")
    ca.client("viewer", "ASN1:UTF8String:viewer")
    ca.client("no_role")
    ca.client("unknown_role", "ASN1:UTF8String:operater")
    ca.client("printable_role", "ASN1:PRINTABLESTRING:operator")
    ca.client("sequence_role", "DER:300a0c086f70657261746f72")
    ca.client("long_role", "ASN1:UTF8String:" + "x" * 65)
    ca.client("trailing_role", "DER:0c016100")
    ca.client("empty_role", "DER:0c00")
    ca.client("control_role", "DER:0c03610a62")
    ca.client("expired", "ASN1:UTF8String:operator",
              dates=("-startdate", "20200101000000Z", "-enddate", "20200201000000Z"))
    ca.client("not_yet_valid", "ASN1:UTF8String:operator",
              dates=("-startdate", "20900101000000Z", "-enddate", "20910101000000Z"))
    ca.client("weak_key", "ASN1:UTF8String:operator", key=("rsa:1024",))
    ca.client("revoked", "ASN1:UTF8String:operator")
    ca.client("revoked_later", "ASN1:UTF8String:operator")
    ca.node("node_as_client")
    ca.node("other_name", "IP:192.0.2.1,DNS:press")
    ca.node("expired_node", dates=("-startdate", "20200101000000Z", "-enddate", "20200201000000Z"))
    ca.node("weak_node", key=("rsa:1024",))
    ca.revoke("revoked")
    other = folder / "other"
    other.mkdir()
    stranger = Authority(other, "other")
    stranger.client("stranger", "ASN1:UTF8String:operator")
    stranger.node("strange_node")
    for name in ("stranger", "strange_node"):
        for ending in ("pem", "key"):
            shutil.copy(other / f"{name}.{ending}", folder)
    for key in folder.glob("*.key"):
        key.chmod(0o600)
    return ca


def who_is_let_in(node, checks):
    for name in ("operator", "operator_critical", "viewer", "no_role", "unknown_role"):
        for version in (ssl.TLSVersion.TLSv1_2, ssl.TLSVersion.TLSv1_3):
            client = Client(node, name, version)
            checks.equal(f"{name} by {version.name}", client.problem, "")
            client.close()
    for name, alert in (("printable_role", "BAD_CERTIFICATE"), ("sequence_role", "BAD_CERTIFICATE"),
                        ("long_role", "BAD_CERTIFICATE"), ("trailing_role", "BAD_CERTIFICATE"),
                        ("empty_role", "BAD_CERTIFICATE"), ("control_role", "BAD_CERTIFICATE"),
                        ("expired", "CERTIFICATE_EXPIRED"), ("not_yet_valid", "BAD_CERTIFICATE"),
                        ("revoked", "CERTIFICATE_REVOKED"), ("stranger", "UNKNOWN_CA"),
                        ("node_as_client", "UNSUPPORTED_CERTIFICATE"), (None, "CERTIFICATE_REQUIRED")):
        client = Client(node, name)
        checks.equal(f"{name} is refused by {alert}: {client.problem}", alert in client.problem.upper().replace(" ", "_"),
                     True)
        client.close()
    # The reasons that an alert does not have are in the log.
    for reason in ("not an ASN.1 UTF8String", "shows no certificate", "has expired on 2020-02-01", "is revoked",
                   "another authority", "another purpose"):
        node.await_line(reason)


def a_weak_key_and_old_versions(node, checks):
    """OpenSSL as Debian builds it would not even send them; s_client is told to."""
    def s_client(*options):
        return subprocess.run(["openssl", "s_client", "-connect", f"127.0.0.1:{node.tls_port}", *options],
                              cwd=node.folder, input="", capture_output=True, text=True, timeout=peer.PATIENCE)

    weak = s_client("-cert", "weak_key.pem", "-key", "weak_key.key", "-cipher", "DEFAULT@SECLEVEL=0", "-tls1_2")
    checks.equal("a weak key is refused", "alert" in weak.stderr, True)
    for old in ("-tls1", "-tls1_1"):
        said = s_client(old, "-cipher", "DEFAULT@SECLEVEL=0")
        checks.equal(f"{old} is refused", "alert protocol version" in said.stderr, True)
    renegotiating = subprocess.run(
        ["openssl", "s_client", "-connect", f"127.0.0.1:{node.tls_port}", "-tls1_2", "-cert", "operator.pem", "-key",
         "operator.key"], cwd=node.folder, input="R\n", capture_output=True, text=True, timeout=peer.PATIENCE)
    checks.equal("renegotiation is refused", "no renegotiation" in renegotiating.stderr, True)


def what_each_may_do(node, checks):
    wanted = {
        "operator": {"lamp": 1, "speed": 3, "identity": 4, "statistics": 4, "map": 20, "lamp on": 5,
                     "speed 7": "exception 01", "echo": 8},
        "viewer": {"lamp": 1, "speed": "exception 01", "identity": 4, "statistics": "exception 01",
                   "map": "exception 01", "lamp on": "exception 01", "speed 7": "exception 01", "echo": 8},
    }
    wanted["no_role"] = wanted["unknown_role"] = {**wanted["viewer"], "lamp": "exception 01"}
    requests = {"lamp": READ_LAMP, "speed": READ_SPEED, "identity": READ_IDENTITY, "statistics": READ_STATISTICS,
                "map": READ_MAP, "lamp on": LAMP_ON, "speed 7": SPEED_7, "echo": ECHO}
    for name, answers in wanted.items():
        client = Client(node, name)
        for what, answer in answers.items():
            checks.equal(f"{name}: {what}", client.code(requests[what]), answer)
        client.close()
    with socket.create_connection(("127.0.0.1", node.port), peer.PATIENCE) as plain:
        plain.sendall(READ_LAMP)
        checks.equal("without TLS", plain.recv(300)[7:], b"\x81\x01")


def records_and_frames(node, checks):
    client = Client(node, "operator")
    client.socket.sendall(READ_LAMP + ECHO + READ_SPEED)
    checks.equal("three frames in a record", [client.receive()[0] for _ in range(3)], [1, 8, 3])
    for byte in READ_LAMP:
        client.socket.sendall(bytes([byte]))
    checks.equal("a frame in twelve records", client.receive()[0], 1)
    client.close()


def a_reload(node, ca, checks):
    text = (node.folder / "cell.yaml").read_text()
    operator, viewer, doomed = (Client(node, name) for name in ("operator", "viewer", "revoked_later"))
    node.reload(text)
    checks.equal("the same map: all stay", [c.code(READ_LAMP) for c in (operator, viewer, doomed)], [1, 1, 1])
    node.reload(text.replace("viewer: {read: [door, lamp]}", "viewer: {read: all}"))
    checks.equal("other rights: all stay, and have them", [c.code(READ_SPEED) for c in (operator, viewer)], [3, 3])
    ca.revoke("revoked_later")
    node.reload(text)
    checks.equal("who is revoked is closed", [c.code(READ_LAMP) for c in (operator, doomed)], [1, "closed"])
    without_viewer = "".join(line for line in text.splitlines(True) if "viewer" not in line)
    node.reload(without_viewer)
    checks.equal("whose role is gone is closed", [c.code(READ_LAMP) for c in (operator, viewer)], [1, "closed"])
    node.reload(without_viewer.replace("node.key", "operator.key"), "the new map is refused")
    node.await_line("the key does not belong to the certificate")
    checks.equal("a key that does not belong to its certificate changes nothing", operator.code(READ_LAMP), 1)
    (node.folder / "node.key").chmod(0o644)
    node.reload(text, "the new map is refused")
    node.await_line("everybody may read it")
    (node.folder / "node.key").chmod(0o600)
    checks.equal("nor does one that everybody may read", operator.code(READ_LAMP), 1)
    no_tls = "".join(line for line in text.splitlines(True) if not re.search(r"^  (certificate|key|ca|revoked):", line))
    node.reload(no_tls)
    checks.equal("a map without TLS ends it", operator.code(READ_LAMP), "closed")
    node.reload(text)
    found = re.findall(r"TLS at 127\.0\.0\.1:(\d+)", node.text())
    node.tls_port = int(found[-1])
    again = Client(node, "operator")
    checks.equal("and one that has it begins it again", again.code(READ_LAMP), 1)
    again.close()
    for client in (operator, viewer, doomed):
        client.close()


def processes_that_die(node, checks):
    client = Client(node, "operator")
    tls = node.child("coupler-tls")
    os.kill(tls, signal.SIGKILL)
    node.await_line("the TLS process was killed by signal 9")
    checks.equal("its clients lose their connections", client.code(READ_LAMP), "closed")
    with socket.create_connection(("127.0.0.1", node.port), peer.PATIENCE) as plain:
        plain.sendall(ECHO)
        checks.equal("those without TLS are answered", plain.recv(300)[7], 8)
    again = Client(node, "operator")
    checks.equal("another one lets in", again.code(READ_LAMP), 1)
    os.kill(node.child("coupler-node-io"), signal.SIGKILL)
    node.await_line("the worker process was killed by signal 9")
    checks.equal("as with plain clients, the process that answers takes its connections with it",
                 again.code(READ_LAMP), "closed")
    last = Client(node, "operator")
    checks.equal("and another one goes on", last.code(READ_LAMP), 1)
    for each in (client, again, last):
        each.close()


def the_tools(node, checks):
    def coupler(*arguments, name="operator"):
        options = ["--certificate", f"{name}.pem", "--key", f"{name}.key"]
        return subprocess.run([COUPLER, *arguments, *options], cwd=node.folder, capture_output=True, text=True,
                              timeout=peer.PATIENCE)

    place = f"tls://127.0.0.1:{node.tls_port}"
    told = coupler("dump", place, "--ca", "ca.pem")
    checks.equal(f"dump with a role that reads all: {told.stderr}", told.returncode, 0)
    told = coupler("status", place, "--ca", "ca.pem").stdout
    checks.equal(f"status names both certificates: {told}",
                 [bool(re.search(each, told)) for each in (r"this side +'operator', until \d{4}-.*, role operator",
                                                           r"the node +'node', until \d{4}-")], [True, True])
    shown = json.loads(coupler("status", place, "--ca", "ca.pem", "--json", name="no_role").stdout)["certificates"]
    checks.equal("and as JSON", [shown["own"]["name"], shown["own"]["role"], shown["device"]["name"]], ["no_role", None, "node"])
    told = coupler("dump", "cell.yaml", "--at", place, "--ca", "ca.pem", name="viewer")
    checks.equal("dump with another shows what it may", (told.returncode, "this client has no right to read it" in told.stdout),
                 (3, True))
    told = coupler("dump", "cell.yaml", "--at", place, "--ca", "ca.pem", name="expired")
    checks.equal(f"the alert is named: {told.stderr}", "certificate_expired" in told.stderr, True)
    told = coupler("dump", "cell.yaml", "--at", place, "--ca", "ca.pem", "--tls-name", "press")
    checks.equal("and so is a wrong name", "another name or address" in told.stderr, True)
    pins = [subprocess.run([COUPLER, "pin", where], cwd=node.folder, capture_output=True, text=True).stdout
            for where in (place, "node.pem", "ca.pem")]
    checks.equal("a pin is the same from the node and from the file", (pins[0], pins[0] != pins[2]), (pins[1], True))
    told = coupler("dump", "cell.yaml", "--at", place, "--pin", pins[0].strip())
    checks.equal("it stands for the authority", told.returncode, 0)
    told = coupler("dump", "cell.yaml", "--at", place, "--pin", pins[2].strip())
    checks.equal("another one does not", "has the pin" in told.stderr, True)
    told = coupler("dump", "cell.yaml", "--at", f"tls://127.0.0.1:{node.port}", "--ca", "ca.pem")
    checks.equal("TLS at the port without", told.returncode, 3)
    told = subprocess.run([COUPLER, "dump", "cell.yaml", "--at", f"tcp://127.0.0.1:{node.tls_port}"], cwd=node.folder,
                          capture_output=True, text=True, timeout=peer.PATIENCE)
    checks.equal(f"and plain Modbus at the port with it: {told.stderr}", "speaks TLS at this port" in told.stderr, True)


@contextlib.contextmanager
def s_server(folder, name, *options):
    """Its port; it asks clients for a certificate."""
    with subprocess.Popen(["openssl", "s_server", "-accept", "127.0.0.1:0", "-cert", f"{name}.pem", "-key", f"{name}.key",
                           "-CAfile", "ca.pem", "-Verify", "1", "-verify_return_error", *options], cwd=folder, text=True,
                          stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as server:
        try:
            for line in server.stdout:
                if line.startswith("ACCEPT"):
                    yield int(line.split(":")[-1])
                    break
        finally:
            server.kill()


def which_servers_are_believed(folder, checks):
    def dump(port):
        return subprocess.run([COUPLER, "dump", "cell.yaml", "--at", f"tls://127.0.0.1:{port}", "--certificate", "operator.pem",
                               "--key", "operator.key", "--ca", "ca.pem"], cwd=folder, capture_output=True, text=True,
                              timeout=peer.PATIENCE).stderr

    old = "-cipher", "DEFAULT@SECLEVEL=0"
    for name, options, says in (
            ("other_name", (), "another name or address"), ("expired_node", (), "its certificate has expired on 2020-02-01"),
            ("strange_node", (), "from another authority"), ("operator", (), "for another purpose"),
            ("weak_node", old, "weak key"), ("node", ("-tls1_1", *old), "protocol_version"),
            ("node", (), "no reply within"), ("node", ("-tls1_2",), "no reply within")):
        with s_server(folder, name, *options) as port:
            told = dump(port)
            checks.equal(f"a server with {name} {' '.join(options)}: {told}", says in told, True)
    with s_server(folder, "node") as port:
        pin = subprocess.run([COUPLER, "pin", f"tls://127.0.0.1:{port}"], cwd=folder, capture_output=True, text=True).stdout
        own = subprocess.run(["openssl", "x509", "-in", "node.pem", "-noout", "-fingerprint", "-sha256"], cwd=folder,
                             capture_output=True, text=True).stdout
        checks.equal("its pin is OpenSSL's fingerprint", pin.strip(),
                     "sha256:" + own.strip().split("=")[-1].replace(":", "").lower())


def a_generated_node(folder, checks):
    """Its map is built in, and its certificates are files all the same."""
    node = Node(folder, GENERATED)
    try:
        who_is_let_in(node, checks)
        what_each_may_do(node, checks)
        client = Client(node, "operator")
        node.process.send_signal(signal.SIGHUP)
        node.await_line("read the certificates again")
        checks.equal("generated: a client stays when the certificates are read again", client.code(READ_LAMP), 1)
        client.close()
    finally:
        node.end()
    checks.equal("generated: the node ends well", node.process.returncode, 0)


def main():
    checks = peer.Checks()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        ca = make_certificates(folder)
        shutil.copy(MAP, folder / "cell.yaml")
        node = Node(folder, NODE, "cell.yaml")
        try:
            who_is_let_in(node, checks)
            a_weak_key_and_old_versions(node, checks)
            what_each_may_do(node, checks)
            records_and_frames(node, checks)
            the_tools(node, checks)
            which_servers_are_believed(folder, checks)
            processes_that_die(node, checks)
            a_reload(node, ca, checks)
        finally:
            node.end()
        checks.equal("the node ends well", node.process.returncode, 0)
        a_generated_node(folder, checks)
        if checks.failed:
            print(node.text())
    checks.done("a node with TLS against Python's ssl and OpenSSL: who is let in, what each may do, reloads, deaths")


main()
