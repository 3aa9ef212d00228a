# SPDX-License-Identifier: Apache-2.0
"""Clients that wait for changes (function code 65), as many as the node lets in and more. The bystander writes coils that are
wired to inputs, so there are always changes to tell."""
import contextlib
import struct

import adu as modbus
from attacks import TARGET_COIL, attack
from node import CONNECTIONS

LONGEST = 30_000  # ms
OTHERS = 6  # the bystander, the attack's own writer, and room
ROUNDS = 20


def wait(epoch, seen, longest=LONGEST):
    return struct.pack(">BBHIQ", 65, 1, longest, epoch, seen)


def told(client):
    """Epoch, number of the newest change, changes lost, changes that follow."""
    reply = client.receive_adu()[7:]
    assert reply[:2] == b"\x41\x01" and len(reply) == 35 + 12 * reply[34], f"a wait was answered {reply.hex(' ')}"
    epoch, newest, lost, count = struct.unpack(">2xI16xQIB", reply[:35])
    return epoch, newest, lost, count


@attack("250 clients wait for changes and ask again as soon as they are told: each hears of all")
def everybody_listens(node):
    with contextlib.ExitStack() as stack:
        clients = [stack.enter_context(node.connect()) for _ in range(CONNECTIONS - OTHERS)]
        writer = stack.enter_context(node.connect())
        known = {}
        for client in clients:
            client.send(modbus.adu(wait(0, 0)))
            known[client] = told(client)[:2]
        for number in range(ROUNDS):
            for client in clients:
                client.send(modbus.adu(wait(*known[client])))
            level = 0xFF00 if number % 2 == 0 else 0
            writer.expect_answer(modbus.pdu(5, TARGET_COIL, level), modbus.pdu(5, TARGET_COIL, level))
            for client in clients:
                epoch, newest, lost, count = told(client)
                before = known[client][1]
                assert (epoch, lost > 0 or count > 0) == (known[client][0], True), "a wait ended with nothing to tell"
                known[client] = epoch, min(newest, before + lost + count)


@attack("a thousand clients wait for changes and never ask again: the node tells them once and serves newcomers")
def nobody_asks_again(node):
    with contextlib.ExitStack() as stack:
        for number in range(4 * CONNECTIONS):
            client = stack.enter_context(node.connect())
            client.send(modbus.adu(wait(0, 0)) + modbus.adu(wait(0, 0, 0)) * (number % 3))
        with node.connect() as newcomer:
            newcomer.send(modbus.adu(wait(0, 0)))
            told(newcomer)
