#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A node that is started with stdin, stdout and stderr closed, all or some of them: no client gets such a number, so no
client gets a line of the log.

    closed_files_test.py NODE_COMMAND…
"""
import contextlib
import itertools
import os
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


def serves(pid, port):
    """Waits until it does; false if it ends before."""
    end = time.monotonic() + peer.PATIENCE
    while time.monotonic() < end and os.waitpid(pid, os.WNOHANG) == (0, 0):
        with contextlib.suppress(ConnectionRefusedError), socket.create_connection(("127.0.0.1", port), peer.PATIENCE):
            return True
        time.sleep(0.02)
    return False


def answer(port):
    with socket.create_connection(("127.0.0.1", port), peer.PATIENCE) as client:
        client.sendall(READ)
        return client.recv(300)


def nobody_gets_their_numbers(command, closed, port, checks):
    right = b"\x00\x01\x00\x00\x00\x04\x01\x01\x01"  # and the two coils
    pid = start([*command, "--listen", "127.0.0.1", "--port", str(port)], closed)
    is_there = serves(pid, port)
    checks.equal(f"without {closed} it serves", is_there, True)
    if not is_there:
        return
    checks.equal(f"without {closed}, files 0 to 2", files(pid), 3 * [CLOSED])
    with socket.create_connection(("127.0.0.1", port), peer.PATIENCE) as first:
        checks.equal(f"without {closed}, an answer", answer(port)[:9], right)
        os.kill(pid, 1)  # SIGHUP: the log tells that the map was read, or cannot be read again
        for _ in range(3):
            checks.equal(f"without {closed}, an answer after SIGHUP", answer(port)[:9], right)
        os.kill(pid, 15)
        checks.equal(f"without {closed}, the exit status", os.waitpid(pid, 0)[1], 0)
        checks.equal(f"without {closed}, what a client that asks nothing is told until the end", first.recv(100), b"")


def main():
    checks = peer.Checks()
    for closed in itertools.chain(*(itertools.combinations(range(3), count) for count in (1, 2, 3))):
        with peer.silent_port() as port:
            nobody_gets_their_numbers(sys.argv[1:], closed, port, checks)
    checks.done("a node that is started without stdin, stdout or stderr gives their numbers to nobody")


main()
