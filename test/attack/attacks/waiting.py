# SPDX-License-Identifier: Apache-2.0
"""Clients that make the node wait, until its patience with them ends. Each yields where it waits, so all of them wait at
the same time."""
import contextlib
import os
import signal
import socket
import time

import adu as modbus
from attacks import TARGET, TARGET_REGISTERS, attack
from attacks.connections import BURST
from attacks.framing import READ, is_answered
from client import LATE, PATIENCE


def until(condition, otherwise):
    """Yields until it holds: in time, give or take what a busy machine adds."""
    end = time.monotonic() + PATIENCE + LATE
    while not condition():
        assert time.monotonic() < end, f"{otherwise} after {PATIENCE + LATE:g} s"
        yield


def dropped(node):
    """Yields until the node has no client but the bystander."""
    with node.connect() as newcomer:
        is_answered(newcomer)  # so it has come across all who came before
    yield from until(lambda: node.surplus(1) <= 0, "a client is still connected")


@attack("ten thousand pipelined requests and nobody reads: the client is dropped in time", waits=True)
def never_reads(node):
    request = modbus.adu(modbus.read(3, TARGET, TARGET_REGISTERS))
    with node.connect(receive_buffer=4096) as client:
        client.socket.setblocking(False)
        data = request * BURST
        with contextlib.suppress(BlockingIOError):
            while data:
                data = data[client.socket.send(data):]
        yield from dropped(node)


@attack("one byte every 300 ms: the frame has one deadline, and bytes do not extend it", waits=True)
def trickle(node):
    request = iter(modbus.adu(modbus.write_registers(TARGET, 50, b"\xBA" * 100)))  # as many as would last for half a minute
    with node.connect() as client:
        def closed():
            client.send(bytes([next(request)]))
            return client.is_closed()
        yield from until(closed, "a frame is still not complete, and its client connected")


@attack("a header and then silence: the connection ends in time", waits=True)
def header_only(node):
    with node.connect() as client, node.connect() as other:
        client.send(modbus.adu(READ)[:7])
        other.send(b"\x00")
        yield from until(lambda: client.is_closed() and other.is_closed(), "half a frame has an answer, or a connection")


@attack("a client stopped in mid-frame is dropped while it sleeps", waits=True)
def stopped_client(node):
    child = os.fork()
    if child == 0:
        with socket.create_connection(("127.0.0.1", node.port)) as client:
            client.sendall(modbus.adu(READ)[:9])
            os.kill(os.getpid(), signal.SIGSTOP)
        os._exit(0)
    try:
        os.waitpid(child, os.WUNTRACED)
        yield from dropped(node)
    finally:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
