# SPDX-License-Identifier: Apache-2.0
"""A client of one coupler, made from its map, on top of pymodbus 3.

The last class of this file has an attribute for each point of the map. Here it is called PressClient:

    with PressClient("192.168.1.17") as press:
        press.speed.write(80)                    # returns when the device has taken the value
        print(press.pressure.read())             # asks the device
        print(press.read_all())                  # every point, in as few requests as possible
        for change in press.changes(press.door):  # at first its value, then each new one
            print(change.value, change.time)

connect() compares the maps. When the connection breaks, the call in progress raises an error, and the next one connects
again. Nothing is read or written by itself. All may be called from any thread. Every error is a CouplerError.
"""
from __future__ import annotations

import collections
import contextlib
import copy
import dataclasses
import enum
import errno
import functools
import hashlib
import importlib
import inspect
import logging
import math
import operator
import re
import socket
import ssl
import struct
import threading
import time
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import Any, Generic, NamedTuple, NoReturn, TypeVar

try:
    # Not by `import`: some releases have types that a type checker reads, and others have none, which it complains of.
    _ModbusTcpClient: Any = importlib.import_module("pymodbus.client").ModbusTcpClient
except ImportError as missing:
    raise ImportError("pymodbus 3 or newer is needed; install it with `apt install python3-pymodbus` or `pip install "
                      "'pymodbus>=3'`") from missing

T = TypeVar("T")                     # the type of a point's value
C = TypeVar("C", bound="Client")
_IntEnum = enum.IntEnum
_log = logging.getLogger(__name__)

# Exception codes of the MODBUS Application Protocol, 7.
_EXCEPTIONS = {
    1: "illegal function", 2: "illegal data address", 3: "illegal data value", 4: "server device failure", 5: "acknowledge",
    6: "server device busy", 8: "memory parity error", 10: "gateway path unavailable",
    11: "gateway target failed to respond"}
_REJECTED = (2, 3)       # of a range that the device does not have, or that is too long for it
_UNIT_AWAY = (10, 11)
_IDENTITY = 0xFF00       # input registers of a node of OpenCoupler: docs/identity.md
_FUNCTIONS = 0xFF52      # which function codes of its own a node answers
_MAGIC = [0x4F43, 0x504C, 1]

_READS = {  # of a table: the call of pymodbus, its function code, where the answer has the values
    "coils": ("read_coils", 1, "bits"), "discrete_inputs": ("read_discrete_inputs", 2, "bits"),
    "holding_registers": ("read_holding_registers", 3, "registers"),
    "input_registers": ("read_input_registers", 4, "registers")}
_LETTERS = {  # of struct; CHAR is its code
    "BYTE": "B", "WORD": "H", "DWORD": "I", "LWORD": "Q", "SINT": "b", "INT": "h", "DINT": "i", "LINT": "q",
    "USINT": "B", "UINT": "H", "UDINT": "I", "ULINT": "Q", "REAL": "f", "LREAL": "d", "CHAR": "B"}
_BITS_ONLY = ("BYTE", "WORD", "DWORD", "LWORD", "CHAR")  # which bounds do not concern
_MOST_EXPONENT = 30  # of a scale
_MOST = {"f": struct.unpack(">f", b"\x7f\x7f\xff\xff")[0], "d": struct.unpack(">d", b"\x7f\xef" + 6 * b"\xff")[0]}


class CouplerError(Exception):
    """What can go wrong with a coupler."""


class NotConnected(CouplerError, ConnectionError):
    """There is no connection, and nothing was sent. `errno` has the number of the reason, as in any OSError, or None."""

    def __init__(self, why: str, number: int | None = None) -> None:
        super().__init__(why)
        given: Any = number  # type checkers may believe that `errno` is never None
        self.errno = given

    def __reduce__(self) -> Any:  # for pickle, which leaves out `errno` otherwise
        return type(self), (self.args[0], self.errno)


class OtherMap(NotConnected):
    """The device has another map than this file."""


class Lost(CouplerError):
    """No valid answer came. A write may have been carried out or not."""


class ExceptionReply(CouplerError):
    """The device answered with an exception."""

    def __init__(self, code: int, what: str = "") -> None:
        self.code, self._what = code, what
        super().__init__(f"{what}exception {code:02X} ({_EXCEPTIONS.get(code, 'unknown exception')})")

    def __reduce__(self) -> Any:  # for pickle, which else makes it of its text
        return type(self), (self.code, self._what)


class NotTaken(CouplerError):
    """The device acknowledged a write, but something else reads back."""


class NoValue(CouplerError):
    """The device gives what the map calls invalid or a fault, or no exponent for the scale."""


class Refused(CouplerError, ValueError):
    """Not a value of the point; nothing was sent."""


class Verify(enum.Enum):
    """What to do if the device has another map."""

    REQUIRE = "require"  # do not talk to it
    WARN = "warn"        # log it and go on
    OFF = "off"          # do not ask

    @classmethod
    def _missing_(cls, value: object) -> NoReturn:
        raise ValueError(f"verify={value!r}: give 'require', 'warn' or 'off'")
