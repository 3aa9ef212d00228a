# SPDX-License-Identifier: Apache-2.0
"""IEC values to registers, by Python's struct and from the text of map-format alone: the driver's own code has no part
in what is expected of it."""
import struct

from coupler_driver.msg import BoolArray
from std_msgs.msg import (Bool, Char, Float32, Float64, Int8, Int16, Int32, Int64, String, UInt8, UInt16, UInt32,
                          UInt64)

NUMBERS = {  # by type: struct's letter and the message
    "SINT": ("b", Int8), "INT": ("h", Int16), "DINT": ("i", Int32), "LINT": ("q", Int64),
    "USINT": ("B", UInt8), "UINT": ("H", UInt16), "UDINT": ("I", UInt32), "ULINT": ("Q", UInt64),
    "REAL": ("f", Float32), "LREAL": ("d", Float64), "CHAR": ("B", Char),
}
BITS = {"BYTE": "B", "WORD": "H", "DWORD": "I", "LWORD": "Q"}


def message_type(kind):
    if kind == "BOOL":
        return Bool
    if kind == "STRING":
        return String
    return BoolArray if kind in BITS else NUMBERS[kind][1]


def swap(word):
    return (word & 0xFF) << 8 | word >> 8


class Point:
    """One point of a map under the map's global order keys."""

    def __init__(self, name, table, options, byteorder_reverse, wordorder_reverse):
        self.name = name
        self.table = table
        self.options = options if isinstance(options, dict) else {"address": options, "type": "BOOL"}
        self.kind = self.options["type"].upper()
        self.address = self.options["address"]
        self.byteorder_reverse = byteorder_reverse
        self.wordorder_reverse = wordorder_reverse
        self.message = message_type(self.kind)

    @property
    def is_bit_of_table(self):
        return self.table in ("coils", "discrete_inputs")

    @property
    def writable(self):
        return self.table in ("coils", "holding_registers")

    def registers(self, value):
        """(mask, word) for each register of the point (or the one bit of a bit table)."""
        if self.is_bit_of_table:
            return [(1, int(value))]
        if self.kind == "BOOL":
            bit = 1 << self.options["bit"]
            bit = swap(bit) if self.byteorder_reverse else bit
            return [(bit, bit if value else 0)]
        if self.kind == "STRING":
            return self._text(value)
        data = self._big_endian(value)
        if len(data) == 1:
            high = (self.options["offset"].lower() == "high") != self.byteorder_reverse
            return [(0xFF00, data[0] << 8) if high else (0x00FF, data[0])]
        words = list(struct.unpack(f">{len(data) // 2}H", data))
        if not self.wordorder_reverse:  # the default: least significant register first
            words.reverse()
        if self.byteorder_reverse:
            words = [swap(word) for word in words]
        return [(0xFFFF, word) for word in words]

    def _big_endian(self, value):
        if self.kind in BITS:
            return struct.pack(">" + BITS[self.kind], sum(1 << i for i, bit in enumerate(value) if bit))
        return struct.pack(">" + NUMBERS[self.kind][0], value)

    def _text(self, value):
        length = self.options["length"]
        data = value.encode(self.options.get("encoding", "utf-8"))
        data = data.ljust(length + length % 2, b"\0")
        words = struct.unpack(f">{len(data) // 2}H", data)
        if not self.options.get("ignore_byteorder", False):  # the default: first character in the low byte
            words = [swap(word) for word in words]
        return [(0xFFFF, word) for word in words]

    def store(self, peer, value):
        """Puts the value into the peer and leaves other bits of shared registers alone."""
        parts = self.registers(value)
        old = peer.get(self.table, self.address, len(parts))
        peer.set(self.table, self.address,
                 [(int(before) & ~mask) | word for before, (mask, word) in zip(old, parts)])

    def is_stored(self, peer, value):
        parts = self.registers(value)
        have = peer.get(self.table, self.address, len(parts))
        return all(int(now) & mask == word for now, (mask, word) in zip(have, parts))


def points(document):
    """The points of a map that was read with PyYAML or json."""
    return [Point(name, table, options, document.get("byteorder_reverse", False),
                  document.get("wordorder_reverse", False))
            for table, entries in document["mapping"].items() for name, options in (entries or {}).items()]


def same(kind, received, expected):
    if kind in BITS:
        return [bool(bit) for bit in received] == expected
    if kind == "REAL":
        return received == struct.unpack(">f", struct.pack(">f", expected))[0]
    return received == expected


def sample(kind, variant, width=None):
    """A telling value: no byte is like another, and no two variants are alike."""
    ramp = bytes((0x81 + 0x11 * i + 0x35 * variant) & 0xFF for i in range(8))
    if kind == "BOOL":
        return variant % 2 == 0
    if kind == "STRING":
        return ("Grüß Gott", "coupler 42", "x")[variant % 3][:width]
    if kind in BITS:
        size = struct.calcsize(BITS[kind]) * 8
        return [bool(int.from_bytes(ramp, "big") >> i & 1) for i in range(size)]
    if kind in ("REAL", "LREAL"):
        return (-1234.5625, 3.25e7, 0.0)[variant % 3]
    letter = NUMBERS[kind][0]
    return struct.unpack(">" + letter, ramp[:struct.calcsize(letter)])[0]
