#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""tshark captures a node that serves peers.yaml, and its Modbus dissector finds nothing malformed.

    tshark_test.py NODE_COMMAND…
"""
import pathlib
import shutil
import signal
import struct
import subprocess
import sys
import tempfile

import peer

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent.parent)]
from support.raw_client import RawClient, adu  # noqa: E402


def words(function, *fields, rest=b""):
    return struct.pack(f">B{len(fields)}H", function, *fields) + rest


# Every function code of the node, good requests and such that are answered with an exception.
REQUESTS = [
    words(1, 0, 10), words(1, 20, 1), words(2, 0, 4), words(3, 0, 17), words(4, 0, 5), words(4, 0xFF00, 82),
    words(5, 3, 0xFF00), words(5, 3, 0), words(6, 0, 0x1234),
    words(15, 0, 10, rest=b"\x02\xcd\x01"), words(16, 0, 2, rest=b"\x04\x12\x34\x56\x78"),
    b"\x14\x07\x06" + struct.pack(">HHH", 1, 0, 100),
    b"\x14\x0e\x06" + struct.pack(">HHH", 1, 0, 10) + b"\x06" + struct.pack(">HHH", 1, 20, 30),
    words(8, 0, 0xA537), words(8, 1, 0), b"\x2b\x0e\x01\x00", b"\x2b\x0e\x02\x00", b"\x2b\x0e\x04\x05",
    b"\x2b\x0e\x03\x00", b"\x2b\x0e\x03\x80", b"\x2b\x0e\x04\x06", b"\x2b\x0e\x04\x80",
    b"\x2b\x0e\x04\x03", words(22, 0, 0xF2, 0x25), words(23, 0, 3, 1, 1, rest=b"\x02\x00\x07"),
    words(1, 10, 1), words(2, 4, 1), words(3, 17, 1), words(4, 5, 1), words(5, 10, 0), words(6, 17, 0),
    words(15, 9, 2, rest=b"\x01\x03"), words(16, 16, 2, rest=b"\x04\x00\x00\x00\x00"),
    b"\x14\x07\x06" + struct.pack(">HHH", 9, 0, 1), words(22, 17, 0, 0), words(3, 0, 0), words(5, 0, 1),
]


def connected(port):
    return RawClient(("127.0.0.1", port))


def talk(port, first):
    """Each request on its own, then all of them in one segment. Returns the transactions."""
    transactions = range(first, first + 2 * len(REQUESTS))
    with connected(port) as client:
        for transaction, request in zip(transactions, REQUESTS):
            client.ask(request, transaction)
        client.send(*REQUESTS, first=transactions[len(REQUESTS)])
        for transaction in transactions[len(REQUESTS):]:
            client.receive(transaction)
    return list(transactions)


def is_captured(port, file, number):
    """Whether an exchange with this transaction is in the file, and so is all that went before; asks for one if not."""
    pdu = words(8, 0, 0x4D4B)  # the reply is the same bytes
    if file.exists() and file.read_bytes().count(adu(pdu, number)) >= 2:
        return True
    with connected(port) as client:
        client.ask(pdu, number)
    return False


def capture(port, file, traffic, checks):
    """The traffic's result, captured in the file; skips if this user may not capture."""
    tshark = subprocess.Popen(["tshark", "-q", "-i", "lo", "-f", f"tcp port {port}", "-w", str(file)],
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    try:
        # Its start is announced before it is true: it has begun once something is in the file.
        peer.await_true("tshark captures", lambda: is_captured(port, file, 1) or tshark.poll() is not None, checks)
        if tshark.poll() is not None:
            peer.skip(f"tshark cannot capture on lo: {tshark.stderr.read().strip().splitlines()[-1:]}")
        result = traffic()
        peer.await_true("all of it is captured", lambda: is_captured(port, file, 2), checks)
        tshark.send_signal(signal.SIGINT)
        tshark.wait(timeout=peer.PATIENCE)
        return result
    finally:
        if tshark.poll() is None:
            tshark.kill()


def read(file, *options):
    return subprocess.run(["tshark", "-r", str(file), *options],
                          capture_output=True, text=True, encoding="utf-8", check=True)


def with_dissector(port, script):
    """The options for a script of `coupler export --to wireshark` for the map "cell/north"."""
    return "-X", f"lua_script:{script}", "-o", f"coupler_cell_north.port:{port}"


def dissect(port, file, *options):
    return [line for line in read(file, "-o", f"mbtcp.tcp.port:{port}", *options).stdout.splitlines() if line.strip()]


def main():
    if not shutil.which("tshark"):
        peer.skip("tshark is missing; run scripts/install-packages test")
    command = sys.argv[1:]
    checks = peer.Checks()
    with tempfile.TemporaryDirectory() as folder, peer.running_node(command) as port:
        pathlib.Path(folder).chmod(0o755)
        file = pathlib.Path(folder) / "node.pcapng"
        transactions = capture(port, file, lambda: talk(port, 0x4000), checks)
        seen = {"request": [], "reply": []}
        for line in dissect(port, file, "-Y", "modbus", "-T", "fields", "-e", "tcp.srcport", "-e", "mbtcp.trans_id"):
            source, ids = line.split("\t")
            kind = "reply" if int(source) == port else "request"
            seen[kind] += [int(i, 0) for i in ids.split(",") if int(i, 0) >= 0x4000]
        checks.equal("requests that were dissected", sorted(seen["request"]), transactions)
        checks.equal("replies that were dissected", sorted(seen["reply"]), transactions)
        checks.equal("malformed packets", dissect(port, file, "-Y", "_ws.malformed || _ws.expert.severity == error"), [])
        checks.equal("packets that the dissector cannot place",
                     dissect(port, file, "-Y", 'modbus && _ws.expert.message contains "classify"'), [])
    checks.done(f"tshark dissects {2 * len(transactions)} packets of {pathlib.Path(command[0]).name}, none malformed")


if __name__ == "__main__":
    main()
