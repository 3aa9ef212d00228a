# SPDX-License-Identifier: Apache-2.0
"""What a PLC has of a map with `coupler export --to st`: blark parses it as TwinCAT 3 does, and interpreter.py runs it on the
values of `coupler generate --vectors`, which test/common/test_vectors holds against Python's struct.
COUPLER is the program, SOURCE_DIR the tree."""
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from interpreter import FLOATS, Program, rounded

ROOT = Path(os.environ["SOURCE_DIR"])
# blark takes some seconds for each.
MAPS = [ROOT / "test/common/test_vectors/vectors.yaml", ROOT / "test/generate/manners.yaml", ROOT / "test/peers/dissector.yaml",
        ROOT / "config/example-node.yaml"]
NAMED = {"mode": (-1, 0, 7)}  # of dissector.yaml: other values are not written
READ = {1: "coils", 2: "discrete_inputs", 3: "holding_registers", 4: "input_registers"}
WRITTEN = {5: "coils", 6: "holding_registers", 15: "coils", 16: "holding_registers"}


def coupler(*arguments):
    return subprocess.run([os.environ["COUPLER"], *map(str, arguments)], capture_output=True, text=True, encoding="utf-8",
                          check=True)


def exported(file):
    return Program(coupler("export", file, "--to", "st").stdout)


def vectors_of(file):
    with tempfile.TemporaryDirectory() as folder:
        coupler("generate", file, "--vectors", "--out", folder, "--name", "map", "--quiet")
        return json.loads((Path(folder) / "map_vectors.json").read_text(encoding="utf-8"))["points"]


class Side:
    """What is read, or what is written: variables, the image, and which request each part of it is."""

    def __init__(self, program, verb, values, block, tables):
        self.program = program
        self.block, = [name for name in program.blocks if name.endswith(block)]
        prefix = self.block.removesuffix(block)
        self.values, self.image = program.variables[prefix + values], program.variables[f"{prefix}_{verb}_image"]
        self.parts = []
        for name, cells in self.image.items():
            function, address, quantity = (program.constants[f"{prefix}_{verb}_{name}_{key}"].value
                                           for key in ("function", "address", "quantity"))
            self.parts.append((tables[function], address, quantity, cells))

    def run(self):
        return self.program.call(self.block, image=self.image, values=self.values)

    def part(self, table, address, count):
        """The cells that hold these addresses, which one request has, and where they begin there."""
        found = [(cells, address - first) for at, first, quantity, cells in self.parts
                 if at == table and first <= address and address + count <= first + quantity]
        return found[0]

    def put(self, table, address, raw, mask=0xFFFF):
        cells, at = self.part(table, address, len(raw))
        for i, value in enumerate(raw, at):
            if isinstance(value, int):
                cells[i // 8].value = cells[i // 8].value & ~(1 << i % 8) | value << i % 8
            else:
                cells[i].value = cells[i].value & ~mask | int(value, 16) & mask

    def get(self, table, address, raw):
        """As many as `raw` has, in its form."""
        cells, at = self.part(table, address, len(raw))
        return [cells[i // 8].value >> i % 8 & 1 if isinstance(value, int) else f"{cells[i].value:04X}"
                for i, value in enumerate(raw, at)]

    def fill(self, ones):
        for cells in self.image.values():
            for cell in cells:
                cell.value = 2**(8 if cell.kind == "BYTE" else 16) - 1 if ones else 0


def numbers(point, value):
    """A value of a vector as the elements of its variable."""
    if point["type"] == "STRING":
        data = value.encode(point["encoding"])
        return [*data, *bytes(point["length"] + 1 - len(data))]
    values = value if isinstance(value, list) else [value]
    if point["type"] in FLOATS or "scale" in point:
        return [rounded("LREAL" if "scale" in point else point["type"], float(each)) for each in values]
    return [int(each) for each in values]


def slots(variable):
    return variable if isinstance(variable, list) else [variable]


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
                    self.assertEqual(side.get(point["table"], point["address"], before), before)
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
