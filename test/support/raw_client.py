# SPDX-License-Identifier: Apache-2.0
"""A Modbus/TCP client of bytes: PDUs go out, PDUs come back. And what function code 65 says in them (docs/time.md)."""
import dataclasses
import socket
import struct

PATIENCE = 120  # seconds; no rule, only reached when something is broken
LONGEST_WAIT = 30000  # ms


def adu(pdu, transaction=1):
    return struct.pack(">HHHB", transaction, 0, len(pdu) + 1, 1) + pdu


class RawClient:
    def __init__(self, address, receive_buffer=None):
        """`receive_buffer`: bytes. A connection that exists already would have its window shrunk, and lose what is under way."""
        self.socket = socket.socket()
        if receive_buffer is not None:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        self.socket.settimeout(PATIENCE)
        self.socket.connect(address)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self.socket.close()

    def send(self, *pdus, first=1):
        """All at once; `first`: the transaction of the first one, from which on they ascend."""
        self.socket.sendall(b"".join(adu(pdu, first + i) for i, pdu in enumerate(pdus)))

    def receive(self, transaction=1):
        """The next reply, which is to this transaction."""
        header = self._bytes(7)
        assert struct.unpack(">HH", header[:4]) == (transaction, 0), header.hex(" ")
        return self._bytes(struct.unpack(">H", header[4:6])[0] - 1)

    def ask(self, pdu, transaction=1):
        self.send(pdu, first=transaction)
        return self.receive(transaction)

    def _bytes(self, size):
        data = b""
        while len(data) < size:
            more = self.socket.recv(size - len(data))
            if not more:
                raise EOFError("the connection was closed")
            data += more
        return data


@dataclasses.dataclass
class Changes:
    """A reply to wait_for_changes()."""
    epoch: int
    arrived: int
    replied: int
    newest: int
    lost: int
    changes: list  # (table, kind, address, time)


def wait_for_changes(epoch, seen, wait=LONGEST_WAIT):
    return struct.pack(">BBHIQ", 65, 1, wait, epoch, seen)


def read_changes(pdu):
    function, version, epoch, arrived, replied, newest, lost, count = struct.unpack(">BBIQQQIB", pdu[:35])
    assert (function, version, len(pdu)) == (65, 1, 35 + 12 * count), pdu.hex(" ")
    return Changes(epoch, arrived, replied, newest, lost, list(struct.iter_unpack(">BBHQ", pdu[35:])))


class Listener(RawClient):
    """Remembers what it has heard of a node's changes."""

    def __init__(self, address):
        super().__init__(address)
        self.epoch, self.seen = 0, 0
        self.take(self.ask(self.request()))  # begins anew

    def request(self, wait=LONGEST_WAIT):
        return wait_for_changes(self.epoch, self.seen, wait)

    def take(self, pdu):
        reply = read_changes(pdu)
        self.seen = reply.newest if reply.epoch != self.epoch else self.seen + reply.lost + len(reply.changes)
        self.epoch = reply.epoch
        return reply

    def requests(self):
        """How many requests the node has counted (docs/identity.md)."""
        return struct.unpack(">I", self.ask(struct.pack(">BHH", 4, 0xFF0F, 2))[2:])[0]


def wait(client, other):
    """The client waits, and the node knows: it counts the request. What two connections bring need not come in the order in
    which it was sent."""
    before = other.requests()
    client.send(client.request())
    own = 1  # each question is a request, too
    while other.requests() - before == own:
        own += 1
