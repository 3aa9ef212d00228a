#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""`coupler generate --vectors` against Python's struct: what the vectors say, and that nothing telling is missing."""
import json
import os
import pathlib
import struct
import subprocess
import tempfile
import unittest

import reading

COUPLER = os.environ["COUPLER"]
SOURCE = pathlib.Path(os.environ["SOURCE_DIR"])
EVERY_TYPE = (SOURCE / "test/maps/every-type.yaml").read_text()
HERE = pathlib.Path(__file__).resolve().parent
PATTERN = bytes.fromhex("0123456789ABCDEF")


def vectors_of(text, folder, name="map.yaml"):
    path = pathlib.Path(folder) / name
    path.write_text(text)
    subprocess.run([COUPLER, "generate", path, "--vectors", "--out", folder, "--quiet"], check=True)
    file, = pathlib.Path(folder).glob("*_vectors.json")
    return file.read_bytes()


def all_points():
    """(which map, whether its bytes and words are reversed, point)"""
    maps = [(f"every type, {byte}, {word}",
             EVERY_TYPE.replace("byteorder_reverse: false", f"byteorder_reverse: {byte}")
             .replace("wordorder_reverse: false", f"wordorder_reverse: {word}"))
            for byte in ("false", "true") for word in ("false", "true")]
    maps.append(("vectors.yaml", (HERE / "vectors.yaml").read_text()))
    maps.append(("pump.yaml", (SOURCE / "config/examples/pump/pump.yaml").read_text()))
    for name, text in maps:
        with tempfile.TemporaryDirectory() as folder:
            for point in json.loads(vectors_of(text, folder))["points"]:
                yield name, point


POINTS = list(all_points())


def words(point, case):
    return case["raw"] if "bits" in point else [int(word, 16) for word in case["raw"]]


def values(point, value):
    """The elements of a case's value, as numbers and texts."""
    wide = point["type"] in ("LWORD", "LINT", "ULINT") and "scale" not in point
    elements = value if "count" in point else [value]
    if point["type"] == "STRING":
        return elements
    return [int(one) if wide else reading.value_in_json(one) for one in elements]


def bits_of(point, value):
    """Equal exactly when the values are, bit for bit."""
    if "scale" in point or point["type"] == "LREAL":
        return struct.pack(">d", value)
    return struct.pack(">f", value) if point["type"] == "REAL" else value


def elements(point, case):
    width, raw = reading.width(point), words(point, case)
    return [raw[i:i + width] for i in range(0, len(raw), width)]


class Vectors(unittest.TestCase):
    def for_each_case(self, check):
        for name, point in POINTS:
            for case in point["cases"]:
                with self.subTest(map=name, point=point["name"], case=case):
                    check(point, case)

    def test_registers_mean_the_value(self):
        def check(point, case):
            read = [bits_of(point, reading.decode(point, raw)) for raw in elements(point, case)]
            self.assertEqual(read, [bits_of(point, value) for value in values(point, case["value"])])
            self.assertEqual(len(read), point.get("count", 1))
        self.for_each_case(check)

    def test_the_value_written_gives_the_registers_unless_it_is_only_read(self):
        def check(point, case):
            try:
                written = [word for value in values(point, case["value"]) for word in reading.encode(point, value)]
            except reading.NoValue:
                written = None
            if case.get("only") == "read":
                self.assertNotEqual(written, words(point, case))
            else:
                self.assertEqual(written, words(point, case))
        self.for_each_case(check)

    def test_registers_have_nothing_outside_the_mask(self):
        shared = [(point, int(point["mask"], 16)) for _, point in POINTS if "mask" in point]
        for point, mask in shared:
            self.assertEqual(bin(mask).count("1"), point.get("width", 1 if point["type"] == "BOOL" else 8))
            self.assertEqual([words(point, case)[0] & ~mask for case in point["cases"]], [0] * len(point["cases"]))

    def test_what_is_refused_is_none_of_the_point(self):
        for name, point in POINTS:
            for value in values({**point, "count": 2}, point.get("refused", [])):
                with self.subTest(map=name, point=point["name"], value=value):
                    self.assertNotEqual(point["access"], "read")
                    with self.assertRaises(reading.NoValue):
                        reading.encode(point, value)

    def test_what_is_telling_is_there(self):
        for name, point in POINTS:
            with self.subTest(map=name, point=point["name"]):
                seen = {bits_of(point, reading.decode(point, raw)) for case in point["cases"]
                        for raw in elements(point, case)}
                self.assertLessEqual({bits_of(point, value) for value in telling(point)}, seen)

    def test_elements_of_an_array_differ(self):
        for name, point in POINTS:
            if "count" in point:
                with self.subTest(map=name, point=point["name"]):
                    self.assertTrue(any(len({tuple(raw) for raw in elements(point, case)}) > 1 for case in point["cases"]))

    def test_orders_are_those_of_the_map(self):
        """Least significant register first, most significant byte first, unless the map says otherwise."""
        for name, point in POINTS:
            if not name.startswith("every type") or "order" not in point:
                continue
            byte, word = (said == "true" for said in name.split(", ")[1:])
            with self.subTest(map=name, point=point["name"]):
                if point["type"] == "STRING":
                    expected = "AB" if point["name"].endswith("wire") else "BA"
                elif point["registers"] == 1:
                    expected = "BA" if byte else "AB"
                else:
                    expected = {(False, False): "CDAB", (False, True): "ABCD", (True, False): "DCBA",
                                (True, True): "BADC"}[byte, word]
                self.assertEqual(point["order"], expected)

    def test_the_same_map_gives_the_same_bytes(self):
        text = (HERE / "vectors.yaml").read_text()
        with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as other:
            first, second = vectors_of(text, one), vectors_of(text, other)
        self.assertEqual(first, second)
        self.assertTrue(first.endswith(b"}\n"))

    def test_docs_and_vectors_are_two_calls(self):
        done = subprocess.run([COUPLER, "generate", HERE / "vectors.yaml", "--docs", "--vectors"], capture_output=True,
                              text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("--docs", done.stderr)


def telling(point):
    """Values that must be among the cases, as they are published."""
    if "bits" in point or point["type"] == "BOOL":
        return [False, True]
    if point["type"] == "STRING":
        return texts(point)
    letter = reading.LETTERS[point["type"]]
    size = struct.calcsize(letter)
    if "width" in point:
        numbers = [0, 1, (1 << point["width"]) - 1]
        scale = point.get("scale", {"gain": 1, "offset": 0})
        return [float(number) * scale["gain"] + scale["offset"] if "scale" in point else number for number in numbers]
    numbers = [0, 1, struct.unpack(">" + letter, PATTERN[:size])[0] if size > 1 else 0x5A]
    if letter == "f":
        numbers += [-1.5, 2.0 ** -149, 2.0 ** -126, -(2 - 2.0 ** -23) * 2.0 ** 127]
    elif letter == "d":
        numbers += [-1.5, 2.0 ** -1074, 2.0 ** -1022, -1.7976931348623157e308]
    else:
        bits = 8 * size - letter.islower()
        numbers += [2 ** bits - 1] + ([-1, -2 ** bits] if letter.islower() else [])
    if letter in "fd":
        numbers += [float("inf"), float("-inf"), float("nan"), -0.0]
    if "scale" in point:
        gain, offset = point["scale"]["gain"], point["scale"]["offset"]
        return [float(number) * gain + offset for number in numbers]
    return numbers


def texts(point):
    foreign = {"utf-8": "ü" * (point["length"] // 2) + "A" * (point["length"] % 2),
               "latin-1": "ÿ" * point["length"], "ascii": "~" * point["length"]}
    return ["", "A", foreign[point["encoding"]]]


unittest.main()
