# SPDX-License-Identifier: Apache-2.0
"""The client in Python against the test vectors, at a device of the test and at coupler-node.
RANDOM_MAPS, a folder: the random maps in it, too."""
import enum
import json
import math
import os
import pathlib
import struct
import unittest

import made
from device import Device, Raw

EVERY_TYPE = (made.SOURCE / "test/maps/every-type.yaml").read_text(encoding="utf-8")
SHAPES = (made.SOURCE / "test/common/test_vectors/vectors.yaml").read_text(encoding="utf-8")
# What those have not: bounds, names, values that are not finite.
ALLOWED = """\
name: allowed
mapping:
  holding_registers:
    pressure: {address: 0, type: INT, scale: 0.1, units: bar, min: 0, max: 21.7}
    level:    {address: 1, type: REAL, min: -1.1, max: 21.7}
    mode:     {address: 3, type: UINT, values: {0: "off", 1: idle, 5: auto}}
    raw:      {address: 4, type: LREAL, allow_nonfinite: true, order: DCBA}
    row:      {address: 8, type: DINT, count: 3, max: 1000}
    wide:     {address: 14, type: ULINT, min: 1, max: 1e18}
"""
EXPONENT = """\
name: exponent
mapping:
  holding_registers:
    power: {address: 0, type: INT, access: read, scale: {gain: 0.1, offset: 0.3, exponent_of: sf}}
    long:  {address: 1, type: DINT, order: ABCD, access: read, scale: {gain: 3, exponent_of: sf}}
    sf:    {address: 3, type: INT, access: read}
"""
ROUNDS = 14  # as many as a float has cases


def words(case):
    return [int(word, 16) if isinstance(word, str) else word for word in case["raw"]]


def value_of(point, value):
    """A value of the vectors as one of Python."""
    if isinstance(value, list):
        return [value_of(point, one) for one in value]
    if not isinstance(value, str) or point["type"] == "STRING":
        return value
    return float(value) if value in ("nan", "inf", "-inf") else int(value)


def agrees(point, found, value):
    """The client gives the value of the vectors. Of a scaled one it may leave out the digits behind the fifteenth;
    test_dump_shows_the_same_values says when."""
    if isinstance(value, list):
        return len(found) == len(value) and all(agrees(point, *both) for both in zip(found, value))
    allowed = [value, float(f"{value:.15g}")] if "scale" in point else [value]
    return bits_of(found) in [bits_of(one) for one in allowed]


def bits_of(value):
    """Equal only where each bit is, of floats, too."""
    if isinstance(value, list):
        return [bits_of(one) for one in value]
    return struct.pack(">d", value) if isinstance(value, float) else (type(value) is bool, value)


class Vectors(made.Made):
    def points_of(self, text):
        module, kind = self.client(text)
        return module, kind, self.vectors(text)

    @staticmethod
    def case(point, index, number):
        """Points that share registers have different ones."""
        return point["cases"][(number + index) % len(point["cases"])]

    def fill(self, device, points, number):
        """Gives each point of the device its value of this round."""
        for index, point in enumerate(points):
            place, raw = point.get("read_address", point["address"]), words(self.case(point, index, number))
            table, mask = device.tables[point["table"]], int(point.get("mask", "FFFF"), 16)
            for i, word in enumerate(raw):
                table[place + i] = table[place + i] & ~mask & 0xFFFF | word

    def check_reading(self, text):
        _, kind, points = self.points_of(text)
        with Device() as device, kind("127.0.0.1", device.port, timeout=made.PATIENCE) as client:
            for number in range(ROUNDS):
                self.fill(device, points, number)
                together = client.read_all()
                readable = [(i, point) for i, point in enumerate(points) if point["access"] != "write"]
                self.assertEqual(sorted(together), sorted(point["name"] for _, point in readable))
                for index, point in readable:
                    expected = value_of(point, self.case(point, index, number)["value"])
                    one = client.points[point["name"]].read()
                    for found in (one, together[point["name"]]):
                        self.assertTrue(agrees(point, found, expected), (point["name"], found, expected, number))

    def check_writing(self, text):
        module, kind, points = self.points_of(text)
        with Device() as device, kind("127.0.0.1", device.port, timeout=made.PATIENCE) as client:
            for point in (point for point in points if point["access"] != "read"):
                handle, table = client.points[point["name"]], device.tables[point["table"]]
                here = slice(point["address"], point["address"] + point.get("registers", point.get("bits")))
                mask = int(point.get("mask", "FFFF" if "registers" in point else "0001"), 16)
                for case in point["cases"]:
                    value = value_of(point, case["value"])
                    before = [0xA5C3 & ~mask | ~word & mask if "mask" in point else 0 for word in words(case)]
                    table[here] = before
                    if "only" in case:
                        continue
                    handle.write(value)
                    expected = [old & ~mask & 0xFFFF | word for old, word in zip(before, words(case))]
                    self.assertEqual(table[here], expected, (point["name"], value))
                requests = len(device.requests)
                for refused in point.get("refused", []):
                    value = value_of(point, refused)
                    with self.assertRaises(module.Refused, msg=(point["name"], value)) as caught:
                        handle.write([value] * point["count"] if "count" in point else value)
                    self.assertIn(point["name"], str(caught.exception))
                self.assertEqual(len(device.requests), requests, "what is refused is not sent")

    def check_node(self, text):
        """What can be written; what a node's inputs hold no client can set."""
        _, kind, points = self.points_of(text)
        node = self.node(text)
        with node, Raw(node.port) as raw, kind("127.0.0.1", node.port, timeout=made.PATIENCE) as client:
            for number in range(ROUNDS):
                written = [(p, self.case(p, i, number)) for i, p in enumerate(points) if p["access"] != "read"]
                written = [(point, case) for point, case in written if "only" not in case]
                for point, case in written:
                    client.points[point["name"]].write(value_of(point, case["value"]))
                values = client.read_all()
                for point, case in [(point, case) for point, case in written if point["access"] != "write"]:
                    mask = int(point.get("mask", "FFFF"), 16)
                    found = raw.get(point["table"], point["address"], len(case["raw"]))
                    self.assertEqual([word & mask for word in found], words(case), point["name"])
                    self.assertTrue(agrees(point, values[point["name"]], value_of(point, case["value"])), point["name"])

    def test_every_type_is_read(self):
        self.check_reading(EVERY_TYPE)

    def test_every_type_is_written(self):
        self.check_writing(EVERY_TYPE)

    def test_every_order_of_every_type(self):
        for keys in (("byteorder_reverse",), ("wordorder_reverse",), ("byteorder_reverse", "wordorder_reverse")):
            text = EVERY_TYPE
            for key in keys:
                text = text.replace(f"{key}: false", f"{key}: true")
            self.check_reading(text)
            self.check_writing(text)

    def test_scales_arrays_and_encodings_are_read(self):
        self.check_reading(SHAPES)

    def test_scales_arrays_and_encodings_are_written(self):
        self.check_writing(SHAPES)

    def test_bounds_and_names_are_kept(self):
        self.check_reading(ALLOWED)
        self.check_writing(ALLOWED)

    @made.LIVE
    def test_dump_shows_the_same_values_of_scales_with_an_exponent(self):
        _, kind = self.client(EXPONENT)
        with Device() as device, kind("127.0.0.1", device.port, timeout=made.PATIENCE) as client:
            for power in (*range(-32, 33, 4), -1, 1):
                for raw in (0, 1, 726, 0x7FFF, 0x8001):
                    device.tables["holding_registers"][0:4] = [raw, raw, 7, power & 0xFFFF]
                    values = {name: self.as_json(value) for name, value in client.read_all().items()}
                    self.assertEqual(values, self.dumped(device), (power, raw))

    def dumped(self, device):
        done = self.coupler("dump", "cell.yaml", "--at", f"127.0.0.1:{device.port}", "--json")
        return {point["point"]: self.as_json(point["value"]) for point in json.loads(done.stdout)["points"]}

    @made.LIVE
    def test_dump_shows_the_same_values(self):
        for text in (EVERY_TYPE, SHAPES, ALLOWED):
            _, kind, points = self.points_of(text)
            with Device() as device, kind("127.0.0.1", device.port, timeout=made.PATIENCE) as client:
                for number in range(ROUNDS):
                    self.fill(device, points, number)
                    dumped = self.dumped(device)
                    values = {name: self.as_json(value) for name, value in client.read_all().items()}
                    self.assertEqual(values, {name: dumped[name] for name in values})

    def as_json(self, value):
        """A value as `coupler dump --json` has it, and each number with all its bits."""
        if isinstance(value, list):
            return [self.as_json(one) for one in value]
        if isinstance(value, float):
            return struct.pack(">d", value) if math.isfinite(value) else None
        return int(value) if isinstance(value, enum.IntEnum) else value

    def test_a_node_holds_what_is_written(self):
        last = "{address: 65535, type: INT}"  # the last addresses are a node's own
        for text in (EVERY_TYPE.replace(last, last.replace("65535", "65279")), SHAPES, ALLOWED):
            self.check_node(text)

    @unittest.skipUnless("RANDOM_MAPS" in os.environ, "test/random/run makes them")
    def test_random_maps(self):
        maps = sorted(pathlib.Path(os.environ["RANDOM_MAPS"]).glob("random_*.yaml"))
        self.assertGreaterEqual(len(maps), 10)
        for path in maps:
            with self.subTest(map=path.name):
                (self.folder / "cell.yaml.lock").unlink(missing_ok=True)
                text = path.read_text(encoding="utf-8")
                self.check_reading(text)
                self.check_writing(text)


if __name__ == "__main__":
    unittest.main(warnings="ignore")
