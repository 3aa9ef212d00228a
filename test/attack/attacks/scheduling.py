# SPDX-License-Identifier: Apache-2.0
"""Clients that schedule outputs (function code 66) as often as the node lets them."""
import contextlib
import struct
import time

import adu as modbus
from attacks import TARGET_COIL, attack
from attacks.listening import Listener
from client import LATE

PLACES = 64
HALF_AN_HOUR = 1800 * 10**9
SOON = 20 * 10**6
DRIVEN, CANCELLED = 3, 4
WATCHDOG = 3  # a reason


def epoch_of(client):
    return struct.unpack(">I", client.ask(struct.pack(">BBHIQ", 65, 1, 0, 0, 0))[2:6])[0]


def schedule(client, epoch, due, duration=0):
    """The number; None: there is no place; 0: the request came too late."""
    reply = client.ask(struct.pack(">BBBIQIBHHBB", 66, 1, 1, epoch, due, duration, 1, TARGET_COIL, 1, 1, 1))
    if reply == modbus.exception(66, 6):
        return None
    if reply == modbus.exception(66, 3):
        return 0
    assert len(reply) == 20 and reply[:2] == b"\x42\x01", f"a scheduled output was answered {reply.hex(' ')}"
    return struct.unpack(">H", reply[2:4])[0]


def fill(node, clients):
    """All places, or those that clients before have left by now; the numbers are different."""
    epoch = epoch_of(clients[0])
    numbers = set()
    for i in range(PLACES + len(clients)):
        number = schedule(clients[i % len(clients)], epoch, time.monotonic_ns() + HALF_AN_HOUR)
        if number is not None:
            assert number != 0 and number not in numbers, f"number {number} was given twice"
            numbers.add(number)
    assert len(numbers) <= PLACES, f"{len(numbers)} outputs were accepted"
    return numbers


@attack("eight clients schedule outputs until there is no place, and leave: all places are free again")
def schedule_to_the_limit(node):
    for _ in range(50):
        with contextlib.ExitStack() as stack:
            fill(node, [stack.enter_context(node.connect()) for _ in range(8)])
    with node.connect() as last:
        epoch, mine, end = epoch_of(last), [], time.monotonic() + LATE
        while len(mine) < PLACES and time.monotonic() < end:
            number = schedule(last, epoch, time.monotonic_ns() + HALF_AN_HOUR)
            mine += [] if number is None else [number]
        assert len(mine) == PLACES, f"only {len(mine)} places were free"
        for number in mine:
            last.expect_exception(2, struct.pack(">BBBIH", 66, 1, 2, epoch, number ^ 0x8000))


class Outcomes(Listener):
    """`awaited`: numbers of outputs of which nothing is known yet. Of changes that are lost, each may be the outcome of one."""

    def __init__(self, client):
        super().__init__(client)
        self.awaited = set()
        self.lost = 0

    def take(self):
        """Everything that is to be told by now."""
        newest = None
        while newest is None or self.seen < newest:
            self.ask(0)
            reply = self.hear()
            newest = newest or reply.newest
            self.lost += reply.lost
            for reason, kind, number, _ in reply.changes:
                if kind == DRIVEN or (kind, reason) == (CANCELLED, WATCHDOG):
                    assert number in self.awaited, f"output {number} was told twice, or is not known"
                    self.awaited.remove(number)


@attack("ten thousand outputs are scheduled for 20 ms later, half of them for a millisecond: each is driven")
def schedule_for_soon(node):
    with node.connect() as client:
        outcomes, ahead = Outcomes(client), SOON
        for i in range(10_000):
            end = time.monotonic() + LATE
            while not (number := schedule(client, outcomes.epoch, (due := time.monotonic_ns() + ahead), i % 2)):
                assert time.monotonic() < end, f"no output was accepted for {LATE:g} s"
                ahead *= 1 if number is None else 2  # it came too late: a slow machine
                outcomes.take()
            outcomes.awaited.add(number)
            if i % 10 == 0:
                outcomes.take()
        while time.monotonic_ns() <= due:
            time.sleep(0.001)
        outcomes.take()  # what is due is driven before a request that comes later
        assert len(outcomes.awaited) <= outcomes.lost, (
            f"{len(outcomes.awaited)} outputs have no outcome, though only {outcomes.lost} changes were lost")
        client.expect_answer(modbus.pdu(5, TARGET_COIL, 0), modbus.pdu(5, TARGET_COIL, 0))
