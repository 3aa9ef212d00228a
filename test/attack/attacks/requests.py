# SPDX-License-Identifier: Apache-2.0
"""Requests in right frames that ask for what must not be, and the exception that each deserves (MODBUS Application Protocol, 6 and 7)."""
import struct

import adu as modbus
from attacks import TARGET, TARGET_COIL, attack

ILLEGAL_FUNCTION, ILLEGAL_ADDRESS, ILLEGAL_VALUE = 1, 2, 3
DATA = bytes(246)

# One right request of each function that writes or reads the target.
RIGHT = [
    modbus.read(1, TARGET_COIL, 1), modbus.read(2, 0, 1), modbus.read(3, TARGET, 1), modbus.read(4, 0, 1),
    modbus.pdu(5, TARGET_COIL, 0), modbus.pdu(6, TARGET + 124, 0), modbus.write_coils(TARGET_COIL, 1, b"\x00"),
    modbus.write_registers(TARGET + 124, 1, b"\x00\x00"), modbus.read_file(0, 1), modbus.pdu(22, TARGET + 124, 0, 0),
    modbus.read_write(TARGET, 1, TARGET + 124, 1, b"\x00\x00"), modbus.pdu(8, 0, 0), bytes([43, 14, 1, 0]),
    struct.pack(">BBHIQ", 65, 1, 0, 0, 0), struct.pack(">BBBIH", 66, 1, 2, 0, 1),
]
OFFERED = [request[0] for request in RIGHT]


def are_refused(node, code, requests):
    """On one connection, so that a request that upsets the stream is seen at the next one."""
    with node.connect() as client:
        for request in requests:
            client.expect_exception(code, request)


@attack("a quantity of 0, one above the limit, or 65535 is a bad value")
def quantities(node):
    are_refused(node, ILLEGAL_VALUE, [
        request
        for wrong in (0, "limit", 0xFFFF)
        for request in (
            modbus.read(1, TARGET_COIL, 2001 if wrong == "limit" else wrong),
            modbus.read(2, 0, 2001 if wrong == "limit" else wrong),
            modbus.read(3, TARGET, 126 if wrong == "limit" else wrong),
            modbus.read(4, 0, 126 if wrong == "limit" else wrong),
            modbus.write_coils(TARGET_COIL, 1969 if wrong == "limit" else wrong, DATA),
            modbus.write_registers(TARGET, 124 if wrong == "limit" else wrong, DATA),
            modbus.read_write(TARGET, 126 if wrong == "limit" else wrong, TARGET, 1, b"\x00\x00"),
            modbus.read_write(TARGET, 1, TARGET, 122 if wrong == "limit" else wrong, DATA[:242]),
            modbus.read_file(0, 125 if wrong == "limit" else wrong if wrong == 0 else 200),
        )])


@attack("an address plus a quantity past 65535 is a bad address")
def wrapping(node):
    are_refused(node, ILLEGAL_ADDRESS, [
        *(modbus.read(function, 0xFFFF, 2) for function in (1, 2, 3, 4)),
        *(modbus.read(function, 0xFFFF, limit) for function, limit in ((1, 2000), (2, 2000), (3, 125), (4, 125))),
        modbus.write_coils(0xFFFF, 2, b"\x03"),
        modbus.write_registers(0xFFFF, 2, bytes(4)),
        modbus.read_write(0xFFFF, 2, TARGET, 1, b"\x00\x00"),
        modbus.read_write(TARGET, 1, 0xFFFF, 2, bytes(4)),
        modbus.read_file(9999, 2),
    ])


@attack("an address that the map does not have is a bad address, alone or behind one that it has")
def holes(node):
    last = (len(node.map_text) - 1) // 2  # register of the map's text
    are_refused(node, ILLEGAL_ADDRESS, [
        modbus.read(1, TARGET_COIL + 15, 2), modbus.read(2, 8, 1), modbus.read(3, TARGET + 1, 125),
        modbus.read(3, 123, 1), modbus.read(4, 1, 2), modbus.pdu(5, 8, 0xFF00), modbus.pdu(6, 123, 1),
        modbus.write_coils(TARGET_COIL + 15, 2, b"\x03"), modbus.write_registers(TARGET + 123, 3, b"\xBA" * 6),
        modbus.pdu(22, 123, 0, 0xBAD), modbus.read_write(TARGET, 1, TARGET + 124, 2, b"\xBA" * 4),
        modbus.read_write(123, 1, TARGET, 1, b"\xBA" * 2),  # the write must not be done for a read that cannot be
        modbus.read_file(last, 2), modbus.read_file(last + 1, 1), modbus.read_file(9999, 1),
        modbus.read_file(0, 1, file=0), modbus.read_file(0, 1, file=2), modbus.read_file(0, 1, file=0xFFFF),
        modbus.read_file(0, 1, reference_type=7),
    ])


@attack("a byte count that does not match quantity or data is a bad value")
def byte_counts(node):
    count = range(0, 256)
    are_refused(node, ILLEGAL_VALUE, [
        *(modbus.write_coils(TARGET_COIL, 9, b"\x00\x00", count=n) for n in count if n != 2),
        *(modbus.write_registers(TARGET, 2, bytes(4), count=n) for n in count if n != 4),
        *(modbus.read_write(TARGET, 1, TARGET, 2, bytes(4), count=n) for n in count if n != 4),
        *(modbus.write_coils(TARGET_COIL, 9, bytes(size)) for size in (0, 1, 3, 246)),
        *(modbus.write_registers(TARGET, 2, bytes(size)) for size in (0, 2, 3, 5, 6, 246)),
        *(modbus.read_write(TARGET, 1, TARGET, 2, bytes(size)) for size in (0, 2, 3, 5, 6, 242)),
        *(modbus.read_file(0, 1, count=n) for n in count if n != 7),
    ])


@attack("a request cut short or with bytes behind it is a bad value")
def wrong_sizes(node):
    are_refused(node, ILLEGAL_VALUE, [request[:size] for request in RIGHT for size in range(1, len(request))])
    are_refused(node, ILLEGAL_VALUE, [request + extra for request in RIGHT for extra in (b"\x00", bytes(7))])


@attack("function codes that are not offered are refused as such, with and without data")
def unknown_functions(node):
    unknown = [code for code in range(128) if code not in OFFERED]
    for data in (b"", bytes(4), bytes(252)):
        are_refused(node, ILLEGAL_FUNCTION, [bytes([code]) + data for code in unknown])
    are_refused(node, ILLEGAL_FUNCTION, [*(modbus.pdu(8, sub, 0) for sub in (1, 2, 4, 10, 0x00FF, 0xFFFF)),
                                         *(bytes([43, interface, 1, 0]) for interface in range(256) if interface != 14)])
    are_refused(node, ILLEGAL_VALUE, [bytes([43, 14, access, 0]) for access in (0, *range(5, 256))])
    there = (0, 1, 2, 4, 5, 6, 0x80)  # docs/node.md; the last two if the machine has them
    are_refused(node, ILLEGAL_ADDRESS, [bytes([43, 14, 4, number]) for number in range(256) if number not in there])


@attack("function codes of 128 and above are no functions")
def codes_of_exceptions(node):
    with node.connect() as client:
        for code in range(128, 256):
            client.expect_answer(bytes([code, ILLEGAL_FUNCTION]), bytes([code]))
            client.expect_answer(bytes([code, ILLEGAL_FUNCTION]), modbus.pdu(code, TARGET, 1))


@attack("a function code with no data is refused at once")
def bare_functions(node):
    are_refused(node, ILLEGAL_VALUE, [bytes([code]) for code in OFFERED])


@attack("a coil value other than 0x0000 and 0xFF00 is a bad value")
def coil_values(node):
    are_refused(node, ILLEGAL_VALUE,
                [modbus.pdu(5, TARGET_COIL, value) for value in (1, 0x00FF, 0x0100, 0xFE00, 0xFF01, 0xFFFF)])
