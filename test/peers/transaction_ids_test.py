#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Devices that do not repeat the transaction id of a request: `coupler dump` says what to set, and reads them with it.

    transaction_ids_test.py COUPLER
"""
import contextlib
import pathlib
import socket
import struct
import subprocess
import sys
import tempfile
import threading

import peer

MAP = "name: dev\ntimeout: 1\nverify: off\nmapping: {holding_registers: {a: {address: 0, type: UINT}, b: {address: 10, type: UINT}}}\n"
KEY = "limits: {transaction_ids: false}\n"
VALUES = {0: 100, 10: 200}
# The id of the reply by that of the request; None: there is no reply.
DEVICES = {"zero": lambda asked: 0, "of its own": lambda asked: asked ^ 0x0101,
           "counts by itself": lambda asked: (asked + 1) & 0xFFFF, "answers 0 only": lambda asked: None if asked else 0}


def serve(connection, reply_id):
    """Answers reads of holding registers (FC 3) until the other side hangs up."""
    with connection, contextlib.suppress(OSError):
        while len(request := connection.recv(12, socket.MSG_WAITALL)) == 12:
            asked, _, _, unit, function, first, count = struct.unpack(">HHHBBHH", request)
            reply = reply_id(asked)
            if reply is not None:
                words = b"".join(struct.pack(">H", VALUES.get(at, 0)) for at in range(first, first + count))
                pdu = bytes([function, len(words)]) + words
                connection.sendall(struct.pack(">HHHB", reply, 0, len(pdu) + 1, unit) + pdu)


@contextlib.contextmanager
def device(reply_id):
    with socket.create_server(("127.0.0.1", 0)) as listener:
        def accept():
            with contextlib.suppress(OSError):
                while True:
                    threading.Thread(target=serve, args=(listener.accept()[0], reply_id), daemon=True).start()
        threading.Thread(target=accept, daemon=True).start()
        yield listener.getsockname()[1]
        listener.shutdown(socket.SHUT_RDWR)


def dump(coupler, text, port):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "dev.yaml")
        path.write_text(text, encoding="utf-8")
        return subprocess.run([coupler, "dump", path, "--at", f"127.0.0.1:{port}"], capture_output=True, text=True,
                              encoding="utf-8", timeout=peer.PATIENCE, check=False)


def main():
    coupler = sys.argv[1]
    checks = peer.Checks()
    for kind, reply_id in DEVICES.items():
        with device(reply_id) as port:
            # An id shortly before that of the request may be of a late reply, so one of several connections has to do.
            looks = [dump(coupler, MAP, port) for _ in range(1 if kind == "answers 0 only" else 3)]
            checks.equal(f"{kind}: status", {done.returncode for done in looks}, {3})
            if kind != "answers 0 only":
                told = [done.stderr for done in looks if "`limits: {transaction_ids: false}`" in done.stderr]
                checks.equal(f"{kind}: what to set", told != [], True)
                checks.equal(f"{kind}: no other advice", "check that a device serves there" in told[0], False)
            done = dump(coupler, MAP + KEY, port)
            checks.equal(f"{kind}: status with the key", done.returncode, 0)
            checks.equal(f"{kind}: values", [f" {value} " in done.stdout for value in VALUES.values()], [True, True])
    checks.done("devices that do not repeat transaction ids are read")


main()
