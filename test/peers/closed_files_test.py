#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A node that is started with stdin, stdout and stderr closed, all or some of them: no client gets such a number, so no
client gets a line of the log.

    closed_files_test.py NODE_COMMAND…
"""
import itertools
import os
import pathlib
import socket
import struct
import sys
import time

import peer

CLOSED = "/dev/null"
# Coils 0 and 1.
READ = struct.pack(">HHHBBHH", 1, 0, 6, 1, 1, 0, 2)


def start(command, closed):
    """The process id."""
    child = os.fork()
    if child:
        return child
    null = os.open(CLOSED, os.O_RDWR)
    for file in range(3):
        os.dup2(null, file)
    for file in closed:
        os.close(file)
    os.execv(command[0], command)


def files(pid):
    return [os.readlink(f"/proc/{pid}/fd/{file}") for file in range(3)]


def port_of(pid):
    """Where it listens, once it does; None if it ends before."""
    end = time.monotonic() + peer.PATIENCE
    while time.monotonic() < end and os.waitpid(pid, os.WNOHANG) == (0, 0):
        sockets = set()
        for file in pathlib.Path(f"/proc/{pid}/fd").iterdir():
            try:
                sockets.add(os.readlink(file))
            except FileNotFoundError:  # closed meanwhile
                pass
        for line in pathlib.Path(f"/proc/{pid}/net/tcp").read_text().splitlines()[1:]:
            _, local, _, state, *rest = line.split()
            if state == "0A" and f"socket:[{rest[5]}]" in sockets:
                return int(local.split(":")[1], 16)
        time.sleep(0.02)
    return None


def answer(port):
    with socket.create_connection(("127.0.0.1", port), peer.PATIENCE) as client:
        client.sendall(READ)
        return client.recv(300)


def main():
    checks = peer.Checks()
    command = [*sys.argv[1:], "--listen", "127.0.0.1", "--port", "0"]
    right = b"\x00\x01\x00\x00\x00\x04\x01\x01\x01"  # and the two coils
    for closed in itertools.chain(*(itertools.combinations(range(3), count) for count in (1, 2, 3))):
        pid = start(command, closed)
        port = port_of(pid)
        checks.equal(f"without {closed} it serves", port is not None, True)
        if port is None:
            continue
        checks.equal(f"without {closed}, files 0 to 2", files(pid), 3 * [CLOSED])
        with socket.create_connection(("127.0.0.1", port), peer.PATIENCE) as first:
            checks.equal(f"without {closed}, an answer", answer(port)[:9], right)
            os.kill(pid, 1)  # SIGHUP: the log tells that the map was read, or cannot be read again
            for _ in range(3):
                checks.equal(f"without {closed}, an answer after SIGHUP", answer(port)[:9], right)
            os.kill(pid, 15)
            checks.equal(f"without {closed}, the exit status", os.waitpid(pid, 0)[1], 0)
            checks.equal(f"without {closed}, what a client that asks nothing is told until the end", first.recv(100), b"")
    checks.done("a node that is started without stdin, stdout or stderr gives their numbers to nobody")


main()
