# SPDX-License-Identifier: Apache-2.0
"""What the registers of a vector mean, by Python's struct and docs/generated.md: no code of this project has a hand in it."""
import math
import struct

LETTERS = {"BYTE": "B", "WORD": "H", "DWORD": "I", "LWORD": "Q", "SINT": "b", "INT": "h", "DINT": "i", "LINT": "q",
           "USINT": "B", "UINT": "H", "UDINT": "I", "ULINT": "Q", "CHAR": "B", "REAL": "f", "LREAL": "d"}
CODECS = {"utf-8": "utf-8", "ascii": "ascii", "latin-1": "latin-1"}


class NoValue(Exception):
    """The point cannot hold it."""


def swap(word):
    return (word & 0xFF) << 8 | word >> 8


def words_of(data, order):
    """Big-endian bytes as registers in that order, and back: each order undoes itself."""
    words = list(struct.unpack(f">{len(data) // 2}H", data))
    if order in ("CDAB", "DCBA"):
        words.reverse()
    return [swap(word) for word in words] if order in ("BA", "BADC", "DCBA") else words


def bytes_of(words, order):
    data = struct.pack(f">{len(words)}H", *words)
    words = words_of(data, order)
    return struct.pack(f">{len(words)}H", *words)


def value_in_json(value):
    return float(value) if value in ("nan", "inf", "-inf") else value


def width(point):
    if "bits" in point:
        return 1
    return point["registers"] // point.get("count", 1)


def decode(point, words):
    """One value; numbers that the file writes as text are numbers here."""
    if "bits" in point:
        return words[0] == 1
    kind, order = point["type"], point["order"]
    if kind == "BOOL":
        return bool((swap(words[0]) if order == "BA" else words[0]) >> point["bit"] & 1)
    if "width" in point:
        number = (swap(words[0]) if order == "BA" else words[0]) >> point["bit"] & (1 << point["width"]) - 1
        return float(number) * point["scale"]["gain"] + point["scale"]["offset"] if "scale" in point else number
    data = bytes_of(words, order)
    if kind == "STRING":
        return data[:point["length"]].split(b"\0")[0].decode(CODECS[point["encoding"]], "replace").replace("\ufffd", "?")
    if LETTERS[kind] in "Bb":
        data = data[:1] if point["offset"] == "high" else data[1:]
    number, = struct.unpack(">" + LETTERS[kind], data)
    return float(number) * point["scale"]["gain"] + point["scale"]["offset"] if "scale" in point else number


def encode(point, value):
    """The registers, with zero where other points stand; NoValue if it is none of the point."""
    if "bits" in point:
        return [int(value)]
    kind, order = point["type"], point["order"]
    if kind == "BOOL":
        word = int(value) << point["bit"]
        return [swap(word) if order == "BA" else word]
    if kind == "STRING":
        return text(point, value)
    if isinstance(value, float) and not math.isfinite(value):
        raise NoValue
    if "width" in point:
        number = raw_number(point, value) if "scale" in point else value
        if not 0 <= number < 1 << point["width"]:
            raise NoValue
        word = number << point["bit"]
        return [swap(word) if order == "BA" else word]
    data = number_bytes(LETTERS[kind], raw_number(point, value) if "scale" in point else value)
    if len(data) == 1:
        data = data + b"\0" if point["offset"] == "high" else b"\0" + data
    return words_of(data, order)


def text(point, value):
    try:
        data = value.encode(CODECS[point["encoding"]])
    except UnicodeError as error:
        raise NoValue from error
    if len(data) > point["length"]:
        raise NoValue
    return words_of(data.ljust(2 * point["registers"] // point.get("count", 1), b"\0"), point["order"])


def raw_number(point, value):
    raw = (value - point["scale"]["offset"]) / point["scale"]["gain"]
    if raw != raw or raw in (float("inf"), float("-inf")):
        raise NoValue
    if LETTERS[point["type"]] in "fd":
        return raw
    return int(raw + (0.5 if raw >= 0 else -0.5))  # half away from zero


def number_bytes(letter, number):
    try:
        return struct.pack(">" + letter, number)
    except (struct.error, OverflowError) as error:
        raise NoValue from error
