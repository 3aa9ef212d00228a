# SPDX-License-Identifier: Apache-2.0
"""What a PLC has of a map with `coupler export --to st`: blark parses it as TwinCAT 3 does, and interpreter.py runs it on the
values of `coupler generate --vectors`, which test/common/test_vectors holds against Python's struct.
COUPLER is the program, SOURCE_DIR the tree."""
import json
import math
import os
import re
import sys
import tempfile
import unittest
from pathlib import Path

from interpreter import FLOATS, Program, rounded
from side import READ, WRITTEN, Side, coupler, exported, slots

ROOT = Path(os.environ["SOURCE_DIR"])
# blark takes some seconds for each.
MAPS = [ROOT / "test/common/test_vectors/vectors.yaml", ROOT / "test/generate/manners.yaml", ROOT / "test/peers/dissector.yaml",
        ROOT / "config/example-node.yaml"]
NAMED = {"mode": (-1, 0, 7)}  # of dissector.yaml: other values are not written


def vectors_of(file):
    with tempfile.TemporaryDirectory() as folder:
        coupler("generate", file, "--vectors", "--out", folder, "--name", "map", "--quiet")
        return json.loads((Path(folder) / "map_vectors.json").read_text(encoding="utf-8"))["points"]


def numbers(point, value):
    """A value of a vector as the elements of its variable."""
    if point["type"] == "STRING":
        data = value.encode(point["encoding"])
        return [*data, *bytes(point["length"] + 1 - len(data))]
    values = value if isinstance(value, list) else [value]
    if point["type"] in FLOATS or "scale" in point:
        return [rounded("LREAL" if "scale" in point else point["type"], float(each)) for each in values]
    return [int(each) for each in values]


def mask_of(point):
    return int(point.get("mask", "FFFF"), 16)


def member(point):
    return point["name"].replace("/", "_").lower()


class StructuredText(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.maps = [(exported(file), vectors_of(file)) for file in MAPS]

    @staticmethod
    def rounds(points, cases_of):
        """A case of each point at a time, as long as one of them has another one."""
        cases = [(point, cases_of(point)) for point in points]
        for n in range(max((len(each) for _, each in cases), default=0)):
            yield [(point, each[n % len(each)]) for point, each in cases if each]

    def test_inputs_are_what_the_registers_mean(self):
        tried = 0
        for program, points in self.maps:
            side = Side(program, "read", "_inputs", "_decode", READ)
            readable = [point for point in points if "read" in point["access"]]
            self.assertEqual(list(side.values), [member(point) for point in readable])
            for chosen in self.rounds(readable, self.whole_cases):
                for ones in False, True:  # where no point is
                    before = {member(point): [slot.value for slot in slots(side.values[member(point)])] for point in readable}
                    side.fill(ones)
                    for point, case in chosen:
                        side.put(point["table"], point.get("read_address", point["address"]), case["raw"], mask_of(point))
                    after = side.run()
                    any_kept = False
                    for point, case in chosen:
                        expected = numbers(point, case["value"])
                        for i in (i for i, number in enumerate(expected) if not math.isfinite(number)):
                            expected[i] = before[member(point)][i]
                            any_kept = True
                        got = [slot.value for slot in slots(side.values[member(point)])]
                        self.assertEqual(got, expected, (point["name"], case))
                        tried += 1
                    self.assertEqual("not_finite" in after and after["not_finite"].value, any_kept)
        self.assertGreater(tried, 1000)

    @staticmethod
    def whole_cases(point):
        """Not texts with something behind their end, of which a PLC has all bytes, nor what its scale makes infinite."""
        if point["type"] == "STRING":
            return [case for case in point["cases"] if "only" not in case]
        return [case for case in point["cases"]
                if "scale" not in point or not any(map(math.isinf, numbers(point, case["value"])))]

    def test_outputs_become_their_registers_and_leave_other_bits(self):
        tried = 0
        for program, points in self.maps:
            writable = [point for point in points if "write" in point["access"]]
            if not writable:
                continue
            side = Side(program, "write", "_outputs", "_encode", WRITTEN)
            self.assertEqual(list(side.values), [member(point) for point in writable])
            for chosen in self.rounds(writable, self.writable_cases):
                for ones in False, True:
                    side.fill(ones)
                    for point, case in chosen:
                        for slot, number in zip(slots(side.values[member(point)]), numbers(point, case["value"])):
                            slot.value = number
                    after = side.run()
                    self.assertFalse("refused" in after and after["refused"].value, chosen)
                    for point, case in chosen:
                        got = side.get(point["table"], point["address"], case["raw"])
                        self.assertEqual(self.own(point, got), self.own(point, case["raw"]), (point["name"], case))
                        tried += 1
        self.assertGreater(tried, 500)

    @staticmethod
    def writable_cases(point):
        """Not minus zero, which is written as zero."""
        def is_minus_zero(raw):
            return point["type"] in FLOATS and [word for word in raw if word != "0000"] in (["8000"], ["0080"])
        named = NAMED.get(point["name"])
        return [case for case in point["cases"] if "only" not in case and not is_minus_zero(case["raw"])
                and (named is None or case["value"] in named)]

    @staticmethod
    def own(point, raw):
        """The bits of the point; a text of odd length leaves half a register."""
        if point["type"] == "STRING" and point["length"] % 2:
            mask = "FF00" if point["order"] == "AB" else "00FF"
            return [*raw[:-1], int(raw[-1], 16) & int(mask, 16)]
        return [int(word, 16) & mask_of(point) for word in raw] if "mask" in point else raw

    def test_a_float_that_does_not_fit_is_refused_and_its_registers_stay(self):
        tried = 0
        for program, points in self.maps:
            writable = [point for point in points if "write" in point["access"]]
            for point in (each for each in writable if each["type"] in FLOATS or "scale" in each):
                side = Side(program, "write", "_outputs", "_encode", WRITTEN)
                for value in point.get("refused", []):
                    number = float(value)
                    if point["type"] == "REAL" and "scale" not in point and abs(number) > 3.5e38:
                        number = math.copysign(math.inf, number)  # no REAL has it
                    for slot in slots(side.values[member(point)]):
                        slot.value = number
                    side.fill(True)
                    before = side.get(point["table"], point["address"], point["cases"][0]["raw"])
                    self.assertTrue(side.run()["refused"].value, (point["name"], value))
                    after = side.get(point["table"], point["address"], before)
                    self.assertEqual(self.own(point, after), self.own(point, before))
                    tried += 1
        self.assertGreater(tried, 20)

    def test_bounds_and_named_values_hold_in_the_plc(self):
        program = self.made("holding_registers: {level: {address: 0, type: INT, min: -5, max: 7}, mode: {address: 1, type: UINT, "
                            "values: {0: idle, 9: run}}, flow: {address: 2, type: REAL, max: 21.7}}")
        side = Side(program, "write", "_outputs", "_encode", WRITTEN)
        self.assertEqual(program.constants["m_mode_run"].value, 9)
        flow = 21.700000762939453  # 21.7 as a REAL has it
        for level, mode, value, refused in ((-5, 0, flow, False), (7, 9, -1e30, False), (8, 0, 0.0, True), (-6, 0, 0.0, True),
                                            (0, 1, 0.0, True), (0, 0, 21.75, True)):
            for name, number in zip(("level", "mode", "flow"), (level, mode, value)):
                side.values[name].value = number
            self.assertEqual(side.run()["refused"].value, refused, (level, mode, value))

    def test_a_scaled_value_is_judged_by_the_registers_that_it_becomes(self):
        program = self.made("holding_registers: {up: {address: 0, type: INT, scale: 0.1, min: 0.3, max: 20}, "
                            "down: {address: 1, type: INT, scale: {gain: -0.1, offset: 2}, min: 0.3, max: 1.7}, "
                            "flow: {address: 2, type: REAL, order: ABCD, scale: 0.1, min: 0.3, max: 20}, "
                            "small: {address: 4, type: SINT, offset: low, scale: 0.5}, "
                            "long: {address: 5, type: LINT, order: ABCD, scale: 0.5}}")
        side = Side(program, "write", "_outputs", "_encode", WRITTEN)
        whole, = side.image.values()
        place = {"up": (0, 1), "down": (1, 1), "flow": (2, 2), "small": (4, 1), "long": (5, 4)}
        for name, value, registers in (
                ("up", 0.3, "0003"), ("up", 0.26, "0003"), ("up", 0.24, None), ("up", 20.0, "00C8"),
                ("up", 20.04, "00C8"), ("up", 20.06, None), ("up", math.nan, None),
                ("down", 0.3, "0011"), ("down", 0.26, "0011"), ("down", 0.24, None), ("down", 1.7, "0003"),
                ("down", 1.74, "0003"), ("down", 1.76, None),
                ("flow", 0.3, "40400000"), ("flow", 0.2999999, None), ("flow", 20.0, "43480000"),
                ("flow", 20.00001, None),
                ("small", 63.5, "007F"), ("small", 63.74, "007F"), ("small", 63.75, None), ("small", -64.24, "0080"),
                ("small", -64.25, None),
                ("long", -2.0**62, "8000000000000000"), ("long", 2.0**62 - 512, "7FFFFFFFFFFFFC00"),
                ("long", 2.0**62, None)):
            first, count = place[name]
            cells = whole[first:first + count]
            kept = side.values[name].value
            before = "".join(f"{cell.value:04X}" for cell in cells)
            side.values[name].value = value
            self.assertEqual(side.run()["refused"].value, registers is None, (name, value))
            self.assertEqual("".join(f"{cell.value:04X}" for cell in cells), registers or before, (name, value))
            side.values[name].value = kept

    def test_outputs_and_their_registers_begin_with_allowed_values(self):
        program = self.made("coils: {lamps: {address: 3, count: 9, "
                            "initial: [on, off, on, off, off, off, off, off, on]}, plain: 12}, "
                            "holding_registers: {low: {address: 0, type: USINT, offset: low, min: 5}, "
                            "high: {address: 0, type: USINT, offset: high, initial: 18}, "
                            "mode: {address: 1, type: INT, values: {-2: back, 5: run}}, "
                            "idle: {address: 2, type: INT, min: -5, max: 5}, "
                            "cold: {address: 3, type: INT, count: 2, max: -3}, "
                            "warm: {address: 5, type: INT, scale: {gain: 0.5, offset: 10}, min: 20}, "
                            "shifted: {address: 6, type: INT, scale: {gain: 0.5, offset: 10}}, "
                            "flow: {address: 7, type: REAL, order: ABCD, min: 1.5}}")
        side = Side(program, "write", "_outputs", "_encode", WRITTEN)
        values = {name: [slot.value for slot in slots(side.values[name])] for name in list(side.values)[1:]}
        self.assertEqual(values, {"plain": [False], "low": [5], "high": [18], "mode": [-2], "idle": [0],
                                  "cold": [-3, -3], "warm": [20.0], "shifted": [0.0], "flow": [1.5]})
        expected = {"coils_3": [5, 1],
                    "holding_registers_0": [0x1205, 0xFFFE, 0, 0xFFFD, 0xFFFD, 20, 0xFFEC, 0x3FC0, 0]}
        for _ in range(2):  # before and after the first call
            self.assertEqual({name: [cell.value for cell in cells] for name, cells in side.image.items()}, expected)
            self.assertFalse(side.run()["refused"].value)

    def test_bits_of_points_that_are_only_read_are_written_as_they_were_read(self):
        program = self.made("holding_registers: {first: {address: 2, type: INT, access: read}, "
                            "ready: {address: 3, type: BOOL, bit: 3, access: read}, "
                            "run: {address: 3, type: BOOL, bit: 4}, "
                            "high: {address: 4, type: USINT, offset: high, access: read}, "
                            "low: {address: 4, type: USINT, offset: low}}")
        read = Side(program, "read", "_inputs", "_decode", READ)
        side = Side(program, "write", "_outputs", "_encode", WRITTEN)
        for raw, written in ((["FFFF", "ABCD"], ["0008", "AB07"]), (["0000", "12CD"], ["0000", "1207"])):
            read.put("holding_registers", 3, raw)
            side.values["low"].value = 7
            side.run(read_image=read.image)
            self.assertEqual(side.get("holding_registers", 3, raw), written)

    def test_outputs_begin_with_the_maps_initial_values(self):
        program = self.made("coils: {lamps: {address: 0, count: 3, initial: [on, off, on]}}, "
                            "holding_registers: {level: {address: 0, type: INT, scale: 0.1, initial: 2.5}, "
                            "mask: {address: 1, type: WORD, initial: 0xBEEF}, "
                            "text: {address: 2, type: STRING, length: 3, initial: ab}}")
        values = {name: [slot.value for slot in slots(variable)] for name, variable in program.variables["m_outputs"].items()}
        self.assertEqual(values, {"lamps": [True, False, True], "level": [2.5], "mask": [0xBEEF], "text": [97, 98, 0, 0]})

    def test_nothing_in_a_map_leaves_its_comment_or_takes_the_name_of_a_keyword(self):
        program = self.made(r'coils: {If: {address: 0, units: "(*", '
                            r'description: "a *) END_VAR (* b */ (*) /*) \u202e $ \u0022 \n) *"}, '
                            "lamp: 1, Lamp: 2, a__b_: 3, arm/left: 4, arm_left: 5, M: 6}")
        self.assertEqual(list(program.variables["m_outputs"]),
                         ["if_value", "lamp", "lamp_2", "a_b", "arm_left", "arm_left_2", "m"])

    def made(self, points):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "m.yaml"
            file.write_text(f"{{name: m, mapping: {{{points}}}}}", encoding="utf-8")
            return exported(file)

    def test_what_is_no_structured_text_is_found(self):
        text = coupler("export", MAPS[0], "--to", "st").stdout
        for part in ("END_STRUCT", ":= FALSE;", "END_FUNCTION_BLOCK"):
            self.assertIn(part, text)
            with self.assertRaises(Exception):
                Program(text.replace(part, "", 1))
        wrong = Program(re.sub(r"WORD_TO_INT\((.*?)\);", r"\1;", text, count=1))
        side = Side(wrong, "read", "_inputs", "_decode", READ)
        with self.assertRaises(Exception):
            side.run()


if __name__ == "__main__":
    sys.exit(unittest.main())
