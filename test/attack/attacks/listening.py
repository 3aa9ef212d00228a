# SPDX-License-Identifier: Apache-2.0
"""Clients that wait for changes (function code 65), as many as the node lets in and more. The bystander writes coils that are
wired to inputs, so there are always changes to tell."""
import contextlib
import struct
import typing

import adu as modbus
from attacks import TARGET_COIL, attack
from node import CONNECTIONS

LONGEST = 30_000  # ms
KEPT, IN_ONE_REPLY = 1024, 18  # changes; no line of map.yaml loses some
OTHERS = 6  # the bystander, the attack's own writer, and room
ROUNDS = 20


class Told(typing.NamedTuple):
    epoch: int
    newest: int  # the number of the newest change
    lost: int
    changes: list  # (table, kind, address, time)


def wait(epoch, seen, longest=LONGEST):
    return struct.pack(">BBHIQ", 65, 1, longest, epoch, seen)


def told(client):
    reply = client.receive_adu()[7:]
    assert reply[:2] == b"\x41\x01" and len(reply) == 35 + 12 * reply[34], f"a wait was answered {reply.hex(' ')}"
    return Told(*struct.unpack(">2xI16xQI", reply[:34]), list(struct.iter_unpack(">BBHQ", reply[35:])))


class Listener:
    """`seen`: the number of the last change that it was told. Those before it were told or lost."""

    def __init__(self, client):
        self._client = client
        client.send(modbus.adu(wait(0, 0)))
        self.epoch, self.seen, *_ = told(client)

    def ask(self, longest=LONGEST):
        self._client.send(modbus.adu(wait(self.epoch, self.seen, longest)))

    def hear(self):
        reply, before = told(self._client), self.seen
        assert reply.epoch == self.epoch, "the epoch is another one"
        self.seen += reply.lost + len(reply.changes)
        overwritten = max(0, reply.newest - before - KEPT)
        assert reply.lost == overwritten and (self.seen == reply.newest or len(reply.changes) == IN_ONE_REPLY), (
            f"after change {before}, {reply.lost} were lost and {len(reply.changes)} told, and {reply.newest} is the newest")
        return reply


class Everybody:
    """Each has to hear the same under the same number."""

    def __init__(self, clients):
        self.listeners = [Listener(client) for client in clients]
        self._changes = {}

    def hear(self, listener):
        reply = listener.hear()
        for number, change in enumerate(reply.changes, listener.seen - len(reply.changes) + 1):
            known = self._changes.setdefault(number, change)
            assert known == change, f"change {number} is {known} for one client and {change} for another"
        return reply


@attack("250 clients wait for changes and ask again as soon as they are told: each hears of all")
def everybody_listens(node):
    with contextlib.ExitStack() as stack:
        everybody = Everybody([stack.enter_context(node.connect()) for _ in range(CONNECTIONS - OTHERS)])
        writer = stack.enter_context(node.connect())
        for number in range(ROUNDS):
            for listener in everybody.listeners:
                listener.ask()
            level = 0xFF00 if number % 2 == 0 else 0
            writer.expect_answer(modbus.pdu(5, TARGET_COIL, level), modbus.pdu(5, TARGET_COIL, level))
            for listener in everybody.listeners:
                reply = everybody.hear(listener)
                assert reply.lost or reply.changes, "a wait ended with nothing to tell"
                newest = reply.newest
        for listener in everybody.listeners[::10]:  # all of them would be too much for a slow machine
            while listener.seen < newest:
                listener.ask(0)
                everybody.hear(listener)


@attack("a thousand clients ask for changes and do nothing more, a quarter of them wait: the node makes room and serves newcomers")
def nobody_asks_again(node):
    with contextlib.ExitStack() as stack:
        for number in range(4 * CONNECTIONS):
            client = stack.enter_context(node.connect())
            client.send(modbus.adu(wait(0, 0)) + modbus.adu(wait(0, 0, 0)) * (number % 3))
            if number % 4 == 0:  # before the next one comes: it may have to make room then
                reply = told(client)
                assert reply.epoch != 0 and not reply.lost and not reply.changes, f"who begins anew was told {reply}"
                client.send(modbus.adu(wait(reply.epoch, reply.newest)))
        with node.connect() as newcomer:
            newcomer.send(modbus.adu(wait(0, 0)))
            told(newcomer)
