# SPDX-License-Identifier: Apache-2.0
"""Clients that misbehave in TLS: before they are let in, and after. Whom a node lets in: test/peers/tls_test.py."""
import concurrent.futures
import contextlib
import random
import socket
import ssl

import adu as modbus
from attacks import TARGET, TARGET_REGISTERS, attack
from attacks.framing import READ
from attacks.waiting import dropped, until
from client import LATE

HANDSHAKES = 5000
SESSIONS = 250
BURST = 10_000
SILENT = 5000  # many more than are let into their handshake at a time


def tcp(node):
    connection = socket.create_connection(("127.0.0.1", node.tls_port), LATE)
    connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return connection


def context(node, certified=True):
    made = ssl.create_default_context(ssl.Purpose.SERVER_AUTH, cafile=node.certificates / "client" / "authority.pem")
    if certified:
        made.load_cert_chain(node.certificates / "client" / "client.pem", node.certificates / "client" / "client.key")
    return made


def connect(node, made=None):
    return (made or context(node)).wrap_socket(tcp(node), server_hostname="127.0.0.1")


def ask(connection, pdu):
    connection.sendall(modbus.adu(pdu))
    return connection.recv(300)[7:]


def is_served(node):
    with connect(node) as newcomer:
        assert ask(newcomer, READ)[0] == READ[0], "a client with a certificate has no answer"


def is_closed(connection):
    """All that comes before the end is read."""
    connection.setblocking(False)
    try:
        while connection.recv(4096):
            pass
    except (BlockingIOError, ssl.SSLWantReadError):
        return False
    except OSError:
        pass
    return True


@attack("five thousand handshakes without a certificate: whoever has one is let in, and the others are answered", tls=True)
def uncertified_flood(node):
    made = context(node, certified=False)

    def refused(_):
        with contextlib.suppress(OSError), connect(node, made) as stranger:
            stranger.sendall(modbus.adu(READ))
            assert stranger.recv(300) == b"", "a client without a certificate has an answer"

    with concurrent.futures.ThreadPoolExecutor(8) as pool:
        for _ in pool.map(refused, range(HANDSHAKES)):
            pass
    is_served(node)


@attack("five thousand connections that say nothing: a client is let in beside them", tls=True)
def silent_handshakes(node):
    with contextlib.ExitStack() as stack:
        for _ in range(SILENT):
            stack.enter_context(tcp(node))
        is_served(node)


@attack("garbage in place of a hello ends its connection", tls=True)
def garbage(node):
    noise = random.Random(1)
    for size in (1, 5, 6, 300, 20_000):
        with tcp(node) as stranger:
            with contextlib.suppress(OSError):
                stranger.sendall(b"\x7F" + noise.randbytes(size))
                if size > 5:
                    stranger.settimeout(LATE)
                    while stranger.recv(4096):
                        pass
    is_served(node)


@attack("a client that leaves in the middle of its handshake is forgotten", tls=True)
def left_handshakes(node):
    made = context(node)
    for cut in range(1, 500, 25):
        incoming, outgoing = ssl.MemoryBIO(), ssl.MemoryBIO()
        half = made.wrap_bio(incoming, outgoing, server_hostname="127.0.0.1")
        with contextlib.suppress(ssl.SSLWantReadError):
            half.do_handshake()
        with tcp(node) as stranger:
            stranger.sendall(outgoing.read()[:cut])
    is_served(node)


@attack("a frame that lies about its length ends the connection, as without TLS", tls=True)
def bad_frame(node):
    with connect(node) as client:
        client.sendall(b"\0\1\0\0\xFF\xFF\1\3")
        client.settimeout(LATE)
        assert client.recv(300) == b"", "a frame of 65535 bytes has an answer"


@attack("250 sessions one after the other leave nothing behind", tls=True)
def many_sessions(node):
    made = context(node)
    for _ in range(SESSIONS):
        with connect(node, made) as client:
            assert ask(client, READ)[0] == READ[0]


@attack("half a hello and silence: the connection ends in time", tls=True, waits=True)
def half_hello(node):
    with tcp(node) as one, tcp(node) as other:
        one.sendall(b"\x16\x03\x01\x02\x00\x01")
        yield from until(lambda: is_closed(one) and is_closed(other), "a handshake that does not go on has not ended")


@attack("ten thousand pipelined requests and nobody reads: the client is dropped in time", tls=True, waits=True)
def never_reads(node):
    request = modbus.adu(modbus.read(3, TARGET, TARGET_REGISTERS))
    with connect(node) as client:
        client.setblocking(False)
        data = memoryview(request * BURST)
        with contextlib.suppress(ssl.SSLWantWriteError, BlockingIOError):
            while data:
                data = data[client.send(data):]
        yield from dropped(node)
