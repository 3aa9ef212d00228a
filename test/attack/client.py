# SPDX-License-Identifier: Apache-2.0
"""A connection that sends whatever it is told, and says what it expects."""
import select
import socket
import struct
import time

import adu as modbus

# Seconds that tell hanging from working, on any machine. How long answers may take is the bystander's business.
LATE = 10.0
PATIENCE = 5.0  # seconds for the rest of a frame, and for a client to read: coupler/device/net/connection.hpp


class Client:
    """A TCP connection to the node. Every `expect` raises AssertionError when something else happens."""

    def __init__(self, port, receive_buffer=None, source=None):
        """`source`: another address of this machine to come from."""
        self.socket = socket.socket()
        if source is not None:
            self.socket.bind((source, 0))
        if receive_buffer is not None:  # counts only before the connection is made
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        self.socket.settimeout(LATE)
        try:
            self.socket.connect(("127.0.0.1", port))
        except TimeoutError:
            raise AssertionError(f"the node let nobody in for {LATE:g} s") from None
        self.socket.settimeout(LATE)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def send(self, data):
        """All of it, or as much as the node takes before it closes the connection."""
        try:
            self.socket.sendall(data)
        except ConnectionError:
            pass

    def ask(self, pdu, **header):
        """The reply PDU to a request; the reply's header must be the request's."""
        request = modbus.adu(pdu, **header)
        self.send(request)
        reply = self.receive_adu()
        assert reply[:4] + reply[6:7] == request[:4] + request[6:7], f"{request.hex(' ')}: header {reply[:7].hex(' ')}"
        return reply[7:]

    def expect_answer(self, expected, pdu, **header):
        """`expected` is the reply PDU, or a list of those that are right."""
        allowed = expected if isinstance(expected, list) else [expected]
        reply = self.ask(pdu, **header)
        assert reply in allowed, (f"{short(pdu)} was answered {short(reply)}, "
                                  f"not {' or '.join(short(one) for one in allowed)}")

    def expect_exception(self, code, pdu, **header):
        self.expect_answer(modbus.exception(pdu[0], code), pdu, **header)

    def expect_silence(self, seconds=0.1):
        readable, _, _ = select.select([self.socket], [], [], seconds)
        assert not readable, f"silence was expected, but there came {self._describe_input()}"

    def expect_closed(self, seconds=PATIENCE):
        """The node closes the connection and sends nothing before; unless told otherwise sooner than a frame's deadline
        would, which is at once."""
        self.socket.settimeout(seconds)
        try:
            data = self.socket.recv(modbus.LONGEST)
        except ConnectionError:
            return
        except TimeoutError:
            raise AssertionError(f"the connection is still open after {seconds:g} s") from None
        assert data == b"", f"a closed connection was expected, but there came {short(data)}"

    def is_closed(self):
        readable, _, _ = select.select([self.socket], [], [], 0)
        if not readable:
            return False
        try:
            return self.socket.recv(1, socket.MSG_PEEK) == b""
        except ConnectionError:
            return True

    def receive_adu(self):
        header = self._receive(6)
        protocol, length = struct.unpack(">HH", header[2:6])
        assert protocol == 0 and 3 <= length <= 254, f"a reply with the header {header.hex(' ')}"
        return header + self._receive(length)

    def shut_down_sending(self):
        self.socket.shutdown(socket.SHUT_WR)

    def reset(self):
        """Ends the connection with an RST."""
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        self.socket.close()

    def _receive(self, size):
        data = b""
        end = time.monotonic() + LATE
        while len(data) < size:
            self.socket.settimeout(max(0.001, end - time.monotonic()))
            try:
                piece = self.socket.recv(size - len(data))
            except TimeoutError:
                raise AssertionError(f"no answer within {LATE:g} s") from None
            assert piece, "the connection was closed instead of an answer"
            data += piece
        return data

    def _describe_input(self):
        try:
            data = self.socket.recv(modbus.LONGEST)
        except ConnectionError as error:
            return str(error)
        return short(data) if data else "the end of the connection"

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()


def short(data, most=24):
    return data[:most].hex(" ") + (f" … ({len(data)} bytes)" if len(data) > most else "")
