# SPDX-License-Identifier: Apache-2.0
"""A Modbus/TCP device in a thread, with everything that a test may want to see or to spoil; and a raw client."""
import socketserver
import struct
import threading

from raw_client import RawClient  # made.py has its folder in the path

BITS = {1: "coils", 2: "discrete_inputs", 5: "coils", 15: "coils"}
REGISTERS = {3: "holding_registers", 4: "input_registers", 6: "holding_registers", 16: "holding_registers",
             22: "holding_registers"}
TABLES = {**BITS, **REGISTERS}
READS = {"coils": 1, "discrete_inputs": 2, "holding_registers": 3, "input_registers": 4}


def receive(connection, size):
    data = b""
    while len(data) < size:
        piece = connection.recv(size - len(data))
        if not piece:
            raise ConnectionError("closed")
        data += piece
    return data


def packed(bits):
    return bytes(sum(bit << i for i, bit in enumerate(bits[at:at + 8])) for at in range(0, len(bits), 8))


class Device:
    """`requests` has what came: (function code, address, count). `spoil(pdu)` may give another answer: the bytes of a PDU,
    None for silence, ConnectionError to close. `frames(frame)` may give other bytes than the answer's frame. `unmapped` are ranges of tables that it answers with exception 02."""

    def __init__(self):
        self.tables = {table: [0] * 65536 for table in READS}
        self.requests, self.units, self.connections = [], set(), 0
        self.unmapped = [("input_registers", range(0xFF00, 0xFF0D))]
        self.spoil = self.frames = None
        device = self

        class Handler(socketserver.BaseRequestHandler):
            def handle(self):
                device.connections += 1
                try:
                    device._serve(self.request)
                except OSError:
                    pass

        class Server(socketserver.ThreadingTCPServer):
            daemon_threads, allow_reuse_address = True, True

        self._server = Server(("127.0.0.1", 0), Handler)
        self.port = self._server.server_address[1]

    def __enter__(self):
        threading.Thread(target=self._server.serve_forever, args=(0.01,), daemon=True).start()
        return self

    def __exit__(self, *_):
        self._server.shutdown()
        self._server.server_close()

    def identify(self, fingerprint):
        """It is a node of OpenCoupler from now on: docs/identity.md."""
        self.unmapped = []
        words = struct.unpack(">4H", fingerprint.to_bytes(8, "big"))
        self.tables["input_registers"][0xFF00:0xFF07] = [0x4F43, 0x504C, 1, *words]

    def _serve(self, connection):
        while True:
            transaction, _, length, unit = struct.unpack(">HHHB", receive(connection, 7))
            pdu = receive(connection, length - 1)
            self.units.add(unit)
            answer = self.spoil(pdu) if self.spoil else self.answer(pdu)
            if answer is not None:
                frame = struct.pack(">HHHB", transaction, 0, 1 + len(answer), unit) + answer
                connection.sendall(self.frames(frame) if self.frames else frame)

    def answer(self, pdu):
        function, address, count = struct.unpack(">BHH", pdu[:5])
        value = count
        if function in (5, 6, 22):
            count = 1
        self.requests.append((function, address, count))
        asked = range(address, address + count)
        for table, area in self.unmapped:
            if TABLES[function] == table and asked.start < area.stop and area.start < asked.stop:
                return bytes([function | 0x80, 2])
        table = self.tables[TABLES[function]]
        values = table[address:address + count]
        if function in (1, 2):
            return bytes([function, (count + 7) // 8]) + packed(values)
        if function in (3, 4):
            return bytes([function, 2 * count]) + struct.pack(f">{count}H", *values)
        if function == 5:
            table[address] = int(value == 0xFF00)
        elif function == 6:
            table[address] = value
        elif function == 15:
            table[address:address + count] = [pdu[6 + i // 8] >> i % 8 & 1 for i in range(count)]
        elif function == 16:
            table[address:address + count] = struct.unpack(f">{count}H", pdu[6:])
        else:  # 22
            table[address] = table[address] & value | struct.unpack(">H", pdu[5:])[0] & ~value & 0xFFFF
        return pdu if function == 22 else pdu[:5]


class Raw(RawClient):
    """What a device has, read by no library."""

    def __init__(self, port):
        super().__init__(("127.0.0.1", port))

    def get(self, table, address, count):
        answer = self.ask(struct.pack(">BHH", READS[table], address, count))
        if table in BITS.values():
            return [answer[2 + i // 8] >> i % 8 & 1 for i in range(count)]
        return list(struct.unpack(f">{count}H", answer[2:]))

    def ask(self, pdu, transaction=1):
        answer = super().ask(pdu, transaction)
        assert answer[0] == pdu[0], f"{pdu.hex()} was answered {answer.hex()}"
        return answer
