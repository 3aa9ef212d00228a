# SPDX-License-Identifier: Apache-2.0
"""A Modbus/TCP device on a raw socket, for everything that a device should not do: a test tells it how to answer."""
import dataclasses
import socket
import struct
import threading
import time

from support.ports import free_port

ILLEGAL_FUNCTION, ILLEGAL_ADDRESS, ILLEGAL_VALUE, FAILURE, ACKNOWLEDGE, BUSY = 1, 2, 3, 4, 5, 6
PATH_UNAVAILABLE, NO_RESPONSE = 0x0A, 0x0B
READS = {1: "coils", 2: "discrete_inputs", 3: "holding_registers", 4: "input_registers"}
WRITES = {5: "coils", 6: "holding_registers", 15: "coils", 16: "holding_registers"}


@dataclasses.dataclass
class Request:
    at: float  # monotonic seconds
    transaction: int
    unit: int
    function: int
    address: int
    count: int
    data: bytes  # of the PDU
    connection: socket.socket

    @property
    def is_identity(self):
        """The driver's question for the identity of a node."""
        return self.function == 4 and self.address >= 0xFF00


class Refuse(Exception):
    """Raised in an answer: the exception code of the reply."""

    def __init__(self, code):
        super().__init__(code)
        self.code = code


class Device:
    """Serves four tables of 65536 elements. Replace `answer` by what is to happen instead; `requests` are those that
    came, but for the question for the identity, which it refuses as foreign couplers do (that to a unit which is away is
    among them: whatever it is asked, it is an attempt)."""

    def __init__(self, port=None, connections=None, address="127.0.0.1"):
        self.tables = {name: [0] * 65536 for name in READS.values()}
        self.requests = []
        self.accepted = 0
        self.answer = self.serve
        self.silent = False  # as a device that hangs: accepts everything and answers nothing
        self.away = set()  # units that it, as a gateway, cannot reach
        self.answers_per_connection = None  # then it hangs up
        self.greeting = b""  # what it says to each new connection
        self._limit = connections
        self._connections = []
        self._lock = threading.Lock()
        self._listener = None
        self.port = port or free_port()  # kept while it is stopped
        self.address = address

    def start(self):
        self._listener = socket.create_server((self.address, self.port))
        threading.Thread(target=self._accept, args=(self._listener,), daemon=True).start()
        return self

    def stop(self):
        """As a process that is killed: nobody listens, and connections are reset."""
        if self._listener:
            self._listener.shutdown(socket.SHUT_RDWR)
            self._listener.close()
            self._listener = None
        self.drop()

    def drop(self):
        """Resets every connection."""
        with self._lock:
            connections, self._connections = self._connections, []
        for connection in connections:
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            try:
                connection.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass
            connection.close()

    def say(self, text):
        """To every connection, though nobody has asked."""
        with self._lock:
            for connection in self._connections:
                connection.sendall(text)

    def allow(self, connections):
        self._limit = connections

    def __enter__(self):
        return self.start()

    def __exit__(self, *_):
        self.stop()

    def seen(self, *functions):
        """The requests with one of these functions."""
        return [request for request in list(self.requests) if request.function in functions]

    def serve(self, request):
        """The data of a proper reply, behind its function code."""
        if request.function in READS:
            values = self.tables[READS[request.function]][request.address:request.address + request.count]
            if request.function <= 2:
                packed = bytearray((len(values) + 7) // 8)
                for i, value in enumerate(values):
                    packed[i // 8] |= (1 if value else 0) << i % 8
            else:
                packed = struct.pack(f">{len(values)}H", *values)
            return bytes([len(packed)]) + bytes(packed)
        if request.function in WRITES:
            self._store(request)
            return request.data[1:5]
        raise Refuse(ILLEGAL_FUNCTION)

    def _store(self, request):
        table = self.tables[WRITES[request.function]]
        if request.function == 5:
            values = [1 if request.data[3] else 0]
        elif request.function == 6:
            values = [struct.unpack(">H", request.data[3:5])[0]]
        elif request.function == 15:
            values = [request.data[6 + i // 8] >> i % 8 & 1 for i in range(request.count)]
        else:
            values = struct.unpack(f">{request.count}H", request.data[6:])
        table[request.address:request.address + len(values)] = values

    def _accept(self, listener):
        while True:
            try:
                connection, _ = listener.accept()
            except OSError:
                return
            with self._lock:
                if self._listener is not listener:  # stopped meanwhile
                    connection.close()
                    return
                if self._limit is not None and len(self._connections) >= self._limit:
                    connection.close()
                    continue
                self._connections.append(connection)
                self.accepted += 1
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            connection.sendall(self.greeting)
            threading.Thread(target=self._talk, args=(connection,), daemon=True).start()

    def _talk(self, connection):
        try:
            answered = 0
            with connection.makefile("rb") as stream:
                while answered != self.answers_per_connection and self._exchange(connection, stream):
                    answered += 1
        except OSError:
            pass
        with self._lock:
            if connection in self._connections:
                self._connections.remove(connection)
        connection.close()

    def _exchange(self, connection, stream):
        header = stream.read(7)
        if len(header) < 7:
            return False
        transaction, _, length, unit = struct.unpack(">HHHB", header)
        data = stream.read(length - 1)
        address, count = struct.unpack(">HH", data[1:5].ljust(4, b"\0"))
        request = Request(time.monotonic(), transaction, unit, data[0], address,
                          1 if data[0] in (5, 6) else count, data, connection)
        if self.silent:
            return True
        try:
            if request.unit in self.away:
                self.requests.append(request)
                raise Refuse(NO_RESPONSE)
            if request.is_identity:
                raise Refuse(ILLEGAL_ADDRESS)
            self.requests.append(request)
            reply = self.answer(request)
        except Refuse as refusal:
            connection.sendall(frame(request, bytes([request.function | 0x80, refusal.code])))
            return True
        if reply is not None:
            connection.sendall(reply if isinstance(reply, Raw) else frame(request, bytes([request.function]) + reply))
        return True


class Raw(bytes):
    """An answer that is sent as it is."""


def frame(request, pdu, transaction=None):
    transaction = request.transaction if transaction is None else transaction
    return Raw(struct.pack(">HHHB", transaction & 0xFFFF, 0, len(pdu) + 1, request.unit) + pdu)
