# SPDX-License-Identifier: Apache-2.0
"""A Modbus/TCP device that does as a test tells it: slow, late, or with other answers. It keeps what it was asked."""
import socket
import struct
import threading
import time


class Scripted:
    """Holding registers and coils, all 0 at first. Answers one connection at a time."""

    def __init__(self):
        self.requests = []  # PDUs as they came
        self.delay = 0      # seconds before each answer
        self.script = None  # (transaction, unit, pdu) -> bytes to send, or None for the usual answer
        self.registers = [0] * 200
        self.connections = 0
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = self._listener.getsockname()[1]
        self._ended = False
        self._connection = None
        self._thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._ended = True
        self._listener.shutdown(socket.SHUT_RDWR)
        if self._connection:
            self._connection.close()
        self._thread.join(10)

    def functions(self):
        return [pdu[0] for pdu in self.requests]

    def _run(self):
        while not self._ended:
            try:
                self._connection, _ = self._listener.accept()
            except OSError:
                return
            self.connections += 1
            try:
                while self._answer(self._connection):
                    pass
            except OSError:
                pass
            self._connection.close()

    def _answer(self, connection):
        header = connection.recv(7, socket.MSG_WAITALL)
        if len(header) < 7:
            return False
        transaction, _, length, unit = struct.unpack(">HHHB", header)
        pdu = connection.recv(length - 1, socket.MSG_WAITALL)
        self.requests.append(pdu)
        time.sleep(self.delay)
        scripted = self.script(transaction, unit, pdu) if self.script else None
        connection.sendall(scripted or self.frame(transaction, unit, self.reply(pdu)))
        return True

    @staticmethod
    def frame(transaction, unit, pdu):
        return struct.pack(">HHHB", transaction, 0, len(pdu) + 1, unit) + pdu

    def reply(self, pdu):
        function, address, count = struct.unpack(">BHH", pdu[:5])
        if function == 3:
            words = self.registers[address:address + count]
            return struct.pack(f">BB{count}H", 3, 2 * count, *words)
        if function == 6:
            self.registers[address] = count
            return pdu
        if function == 16:
            self.registers[address:address + count] = struct.unpack(f">{count}H", pdu[6:])
            return pdu[:5]
        return bytes([function | 0x80, 1])
