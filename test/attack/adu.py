# SPDX-License-Identifier: Apache-2.0
"""Requests as bytes, right ones and wrong ones. Fields are unsigned 16-bit numbers unless said otherwise."""
import struct

LONGEST = 260  # an ADU: MBAP header and a PDU of 253 bytes


def adu(pdu, transaction=1, unit=1, protocol=0, length=None):
    """An ADU around the PDU; `length` is the MBAP length that it claims."""
    claimed = 1 + len(pdu) if length is None else length
    return struct.pack(">HHHB", transaction, protocol, claimed, unit) + pdu


def pdu(function, *fields, data=b""):
    """A function code (one byte), fields, and what follows."""
    return struct.pack(f">B{len(fields)}H", function, *fields) + data


def read(function, address, quantity):
    return pdu(function, address, quantity)


def write_coils(address, quantity, data, count=None):
    return pdu(15, address, quantity, data=bytes([len(data) if count is None else count]) + data)


def write_registers(address, quantity, data, count=None):
    return pdu(16, address, quantity, data=bytes([len(data) if count is None else count]) + data)


def read_write(read_address, reads, address, quantity, data, count=None):
    return pdu(23, read_address, reads, address, quantity,
               data=bytes([len(data) if count is None else count]) + data)


def read_file(record, registers, file=1, reference_type=6, count=7):
    return bytes([20, count, reference_type]) + struct.pack(">HHH", file, record, registers)


def values(function, data):
    """The reply to FC 1, 2, 3, 4 and 23."""
    return bytes([function, len(data)]) + data


def exception(function, code):
    return bytes([function | 0x80, code])
