# SPDX-License-Identifier: Apache-2.0
"""A client that schedules outputs (function code 66) and hears of changes, by the bytes of docs/time.md. schedule_test.py
serves it schedule.yaml or watchdog.yaml."""
import contextlib
import pathlib
import struct
import sys
import time

import peer

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent.parent)]
from support.raw_client import Listener  # noqa: E402

MOTOR, BRAKE, LAMP, EJECTOR = 0, 1, 2, 3
OFF, ON, DONE, CANCELLED = 0, 1, 3, 4
BY_CLIENT, OVERWRITTEN, WATCHDOG, RELOAD, CONNECTION = 1, 2, 3, 5, 6
MS = 1_000_000
HOUR = 3600 * 1000 * MS
SOON = 200 * MS
COIL, INPUT = 1, 2  # tables
NO_ADDRESS, NOT_ALLOWED, LOCKED, NO_PLACE = (bytes([0xC2, code]) for code in (2, 3, 4, 6))


class Client(Listener):
    def changes(self, wait=0):
        """(kind, table or reason, address or number, time) of each that is new."""
        told = self.take(self.ask(self.request(wait))).changes
        return [(kind, table, address, at) for table, kind, address, at in told]

    def await_changes(self, count, is_one):
        """At least so many of those for which it is true."""
        found = []
        end = time.monotonic() + peer.PATIENCE
        while len(found) < count and time.monotonic() < end:
            found += [change for change in self.changes(1000) if is_one(change)]
        return found

    def outcomes(self, *numbers):
        """Of these scheduled outputs, in the order in which they are told: (kind, reason, number, time)."""
        return self.await_changes(len(numbers), lambda change: change[0] >= DONE and change[2] in numbers)

    def coil_changes(self, coil, count):
        """The next ones of a coil: (level, time)."""
        return [(kind, at) for kind, *_, at in
                self.await_changes(count, lambda change: change[0] <= ON and change[1:3] == (COIL, coil))]

    def schedule(self, due, coil, bits, duration=0, epoch=None):
        packed = sum(bit << i for i, bit in enumerate(bits)).to_bytes((len(bits) + 7) // 8, "little")
        epoch = self.epoch if epoch is None else epoch
        return self.ask(struct.pack(">BBBIQIBHHB", 66, 1, 1, epoch, due, duration, 1, coil, len(bits), len(packed)) + packed)

    def ahead(self, coil, bits, duration=0, lead=SOON):
        """Soon, but not past when the request arrives, however long the machine pauses: the due time, and the reply."""
        while True:
            due = time.monotonic_ns() + lead
            reply = self.schedule(due, coil, bits, duration)
            if reply != NOT_ALLOWED or lead > HOUR // 2:
                return due, reply
            lead *= 2

    def later(self, coil, bits):
        """Not while a test runs. The reply."""
        return self.schedule(time.monotonic_ns() + HOUR // 2, coil, bits)

    def schedule_register(self, due, address, value):
        return self.ask(struct.pack(">BBBIQIBHHBH", 66, 1, 1, self.epoch, due, 0, 3, address, 1, 2, value))

    def cancel(self, number):
        return self.ask(struct.pack(">BBBIH", 66, 1, 2, self.epoch, number))

    def cancel_from(self, due, coil, count, epoch=None):
        epoch = self.epoch if epoch is None else epoch
        return self.ask(struct.pack(">BBBIQBHH", 66, 1, 3, epoch, due, 1, coil, count))

    def write(self, coil, bit):
        return self.ask(struct.pack(">BHH", 5, coil, 0xFF00 if bit else 0))

    def inputs(self):
        bits = self.ask(struct.pack(">BHH", 2, 0, 3))[2]
        return [bits >> i & 1 for i in range(3)]


def number_of(reply):
    return struct.unpack(">H", reply[2:4])[0] if reply[0] == 66 else None


@contextlib.contextmanager
def clients(port, count=1):
    every = [Client(("127.0.0.1", port)) for _ in range(count)]
    try:
        yield every[0] if count == 1 else every
    finally:
        for client in every:
            client.close()
