# SPDX-License-Identifier: Apache-2.0
"""For tests of TLS: a node with it, a client by Python's ssl, and certificates of every kind."""
import pathlib
import re
import shutil
import signal
import socket
import ssl
import struct
import subprocess
import sys
import threading

import peer
from authority import Authority


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
        return next((int(line.split()[0]) for line in listed.stdout.splitlines() if line.split()[1:] == [name]), None)

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
    ca.client("operator_2", "ASN1:UTF8String:operator")
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
    ca.node("future_node", dates=("-startdate", "20900101000000Z", "-enddate", "20910101000000Z"))
    ca.node("endless_node", dates=("-startdate", "20200101000000Z", "-enddate", "99991231235959Z"))
    ca.node("weak_node", key=("rsa:1024",))
    ca.node("small_node", key=("ec", "-pkeyopt", "ec_paramgen_curve:P-224"))
    ca.revoke("revoked")
    other = folder / "other"
    other.mkdir()
    stranger = Authority(other, "other")
    stranger.client("stranger", "ASN1:UTF8String:operator")
    stranger.node("strange_node")
    stranger.list()
    shutil.copy(other / "list.pem", folder / "strange_list.pem")
    small = folder / "small"
    small.mkdir()
    Authority(small, "small_ca", curve="P-224").node("small_ca_node")
    for made in (other / "stranger.pem", other / "strange_node.pem", small / "small_ca.pem", small / "small_ca_node.pem"):
        shutil.copy(made, folder)
        shutil.copy(made.with_suffix(".key"), folder)
    for key in folder.glob("*.key"):
        key.chmod(0o600)
    return ca
