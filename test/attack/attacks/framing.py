# SPDX-License-Identifier: Apache-2.0
"""Bytes that are no frames, or not the frames that they seem to be."""
import random

import adu as modbus
from attacks import TARGET, TARGET_REGISTERS, attack

READ = modbus.read(3, TARGET, 1)
VALUE = modbus.values(3, b"nu")  # of "untouched": a STRING's first character is in the low byte
MEGABYTE = 1 << 20
FIELD_SIDE = 247  # of a simulated node


def is_answered(client, transaction=7):
    client.expect_answer(VALUE, READ, transaction=transaction)


@attack("an MBAP length of 0, 1, 255, 256 or 65535 closes the connection unanswered")
def impossible_length(node):
    for length in (0, 1, 255, 256, 0xFFFF):
        with node.connect() as client:
            client.send(modbus.adu(READ, length=length))
            client.expect_closed()


@attack("an MBAP length of 2 is a request of a function code alone")
def shortest_length(node):
    with node.connect() as client:
        client.expect_exception(3, b"\x03")
        is_answered(client)


@attack("a length larger than the PDU waits for the rest, then the whole is refused")
def length_too_large(node):
    with node.connect() as client:
        client.send(modbus.adu(READ, transaction=3, length=8))
        client.expect_silence()
        client.send(b"\x00\x00")
        assert client.receive_adu() == modbus.adu(modbus.exception(3, 3), transaction=3)
        is_answered(client)


@attack("a length smaller than the PDU refuses what it covers; the surplus starts no frame")
def length_too_small(node):
    with node.connect() as client:
        client.send(modbus.adu(READ, transaction=3, length=4))
        assert client.receive_adu() == modbus.adu(modbus.exception(3, 3), transaction=3)
        client.send(modbus.adu(READ, transaction=4))
        client.expect_closed()


@attack("a second request hidden inside an over-long first one is not executed")
def smuggled_request(node):
    hidden = modbus.adu(modbus.pdu(6, TARGET, 0xBAD), transaction=2)
    with node.connect() as client:
        for carrier in (READ, modbus.pdu(6, TARGET + 1, 1), modbus.write_registers(TARGET + 1, 1, b"ab")):
            client.expect_exception(3, carrier + hidden)
            client.expect_silence()
            is_answered(client)


@attack("a protocol id other than 0 closes the connection unanswered")
def foreign_protocol(node):
    for protocol in (1, 0x0100, 0xDEAD, 0xFFFF):
        with node.connect() as client:
            client.send(modbus.adu(READ, protocol=protocol))
            client.expect_closed()


@attack("a request cut at any byte is answered once it is complete")
def pieces(node):
    request = modbus.adu(READ, transaction=9)
    with node.connect() as client:
        for cut in range(1, len(request)):
            client.send(request[:cut])
            client.expect_silence(0.002)
            client.send(request[cut:])
            assert client.receive_adu() == modbus.adu(VALUE, transaction=9)


@attack("requests with the same transaction id are each answered, in order")
def repeated_transactions(node):
    quantities = (1, 2, 3, 2, 1)
    with node.connect() as client:
        client.send(b"".join(modbus.adu(modbus.read(3, TARGET, n), transaction=5) for n in quantities))
        for quantity in quantities:
            reply = client.receive_adu()
            assert reply[:2] == b"\x00\x05" and reply[8] == 2 * quantity, f"out of order: {reply.hex(' ')}"


@attack("units 0 and 255 are answered and echoed; every other foreign unit gets silence")
def units(node):
    with node.connect() as client:
        for unit in (0, 255, 1):
            client.expect_answer(VALUE, READ, unit=unit)
        write = modbus.pdu(6, TARGET, 0xBAD)
        for unit in set(range(2, 255)) - ({FIELD_SIDE} if node.is_simulated else set()):
            client.send(modbus.adu(write, unit=unit))
        client.expect_silence()
        if node.is_simulated:  # there it is an input register, which the map has not
            client.expect_exception(2, write, unit=FIELD_SIDE)
        is_answered(client)


@attack("a megabyte of random bytes breaks nothing")
def random_bytes(node):
    source = random.Random(1)
    sent = 0
    while sent < MEGABYTE:
        with node.connect() as client:
            data = source.randbytes(4096)
            sent += len(data)
            client.send(data)
            client.expect_closed()


@attack("a megabyte of random requests in right frames: each gets an answer of its own")
def random_requests(node):
    source = random.Random(2)
    sent = 0
    transaction = 0
    with node.connect() as client:
        while sent < MEGABYTE:
            transaction = (transaction + 1) % 0x10000
            request = source.randbytes(source.randint(1, 253))
            sent += len(request)
            reply = client.ask(request, transaction=transaction)
            assert reply[0] & 0x7F == request[0] & 0x7F, f"{request[:8].hex(' ')} was answered {reply[:8].hex(' ')}"
            assert len(reply) == 2 if reply[0] & 0x80 else len(reply) > 2, f"a reply of {len(reply)} bytes"


@attack("the longest reply has the length that its header says")
def longest_reply(node):
    with node.connect() as client:
        reply = client.ask(modbus.read(3, TARGET, TARGET_REGISTERS))
        assert len(reply) == 2 + 2 * TARGET_REGISTERS
        client.expect_silence(0.01)
