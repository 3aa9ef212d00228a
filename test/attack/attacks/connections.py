# SPDX-License-Identifier: Apache-2.0
"""Clients that take more than their share, or leave without a word."""
import contextlib

import adu as modbus
from attacks import TARGET, TARGET_REGISTERS, attack
from attacks.framing import READ, is_answered
from node import CONNECTIONS
from subjects import FLOODER

MANY = 1000
BURST = 10_000


@contextlib.contextmanager
def crowd(node, size):
    """Connected clients, most of which the node will have closed."""
    with contextlib.ExitStack() as stack:
        yield [stack.enter_context(node.connect()) for _ in range(size)]


@attack("a thousand clients connect and say nothing: a newcomer is served")
def silent_crowd(node):
    with crowd(node, MANY) as clients:
        with node.connect() as newcomer:
            is_answered(newcomer)
        assert sum(not client.is_closed() for client in clients) <= CONNECTIONS


@attack("a thousand clients ask once and stay: the longest idle make room")
def idle_crowd(node):
    with contextlib.ExitStack() as stack:
        clients = [stack.enter_context(node.connect()) for _ in range(10)]
        for _ in range(MANY):
            clients.append(stack.enter_context(node.connect()))
            is_answered(clients[-1])
        assert all(client.is_closed() for client in clients[:10]), "the oldest are still connected"
        is_answered(clients[-CONNECTIONS // 2])


@attack("a thousand clients of one address ask and stay: they displace only each other")
def flood_of_another_address(node):
    with contextlib.ExitStack() as stack:
        # Half of them never ask: they are of the address that has fewer.
        residents = [stack.enter_context(node.connect()) for _ in range(20)]
        for resident in residents[:10]:
            is_answered(resident)
        flood = []
        for _ in range(MANY):
            flood.append(stack.enter_context(node.connect(source=FLOODER)))
            is_answered(flood[-1])
        assert not any(resident.is_closed() for resident in residents), "a flood has displaced another address"
        assert all(client.is_closed() for client in flood[:10]), "the oldest of the flood are still connected"
        for resident in residents:
            is_answered(resident)


@attack("a client that has written an output keeps its place while it is idle, whoever else comes", alone=True)
def flood_while_the_writer_is_idle(node):
    with node.connect() as writer:
        writer.expect_answer(modbus.pdu(5, 0, 0xFF00), modbus.pdu(5, 0, 0xFF00))
        with contextlib.ExitStack() as stack:
            for source in [FLOODER, None]:  # None: its own address
                for _ in range(2 * CONNECTIONS):
                    is_answered(stack.enter_context(node.connect(source=source)))
        is_answered(writer)
    with node.connect() as writer, contextlib.ExitStack() as stack:
        writer.expect_answer(modbus.pdu(5, 0, 0), modbus.pdu(5, 0, 0))
        for _ in range(2 * CONNECTIONS):  # writers, too
            client = stack.enter_context(node.connect(source=FLOODER))
            client.expect_answer(modbus.pdu(5, 0, 0), modbus.pdu(5, 0, 0))
        is_answered(writer)


@attack("two thousand clients connect and close, in order or not")
def storm(node):
    for number in range(2 * MANY):
        client = node.connect()
        if number % 20:
            client.reset()
        else:
            client.socket.close()  # leaves the port in TIME_WAIT: there are not many
    with node.connect() as newcomer:
        is_answered(newcomer)


@attack("a client that has shut down its sending side gets its answers, then the end")
def half_close(node):
    with node.connect() as client:
        client.send(modbus.adu(READ, transaction=1) + modbus.adu(READ, transaction=2))
        client.shut_down_sending()
        assert [client.receive_adu()[1] for _ in range(2)] == [1, 2]
        client.expect_closed()
    with node.connect() as client:
        client.send(modbus.adu(READ)[:-1])
        client.shut_down_sending()
        client.expect_closed()


@attack("a reset in mid-frame, at every byte, leaves nothing behind")
def reset_in_mid_frame(node):
    request = modbus.adu(READ)
    for cut in range(len(request)):
        for _ in range(20):
            client = node.connect()
            client.send(request[:cut])
            client.reset()


@attack("clients that reset while their answers are under way")
def reset_before_the_answer(node):
    burst = modbus.adu(modbus.read(3, TARGET, TARGET_REGISTERS)) * 50
    for _ in range(200):
        client = node.connect()
        client.send(burst)
        client.reset()


@attack("ten thousand pipelined requests are all answered, in order")
def burst(node):
    with node.connect() as client:
        answered = 0
        for first in range(0, BURST, 500):
            client.send(b"".join(modbus.adu(READ, transaction=n) for n in range(first, first + 500)))
            for _ in range(500):
                assert client.receive_adu()[:2] == answered.to_bytes(2, "big"), f"answer {answered} is another one's"
                answered += 1
