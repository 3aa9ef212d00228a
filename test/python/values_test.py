# SPDX-License-Identifier: Apache-2.0
"""The client in Python: which values it refuses, and names that could be in each other's way."""
import ast
import enum
import io
import json
import keyword
import pickle
import struct
import tokenize
import unittest

import made
from press import PRESS, OfADevice


class Values(OfADevice):
    def test_a_value_that_is_none_of_its_point_is_refused_in_words(self):
        press = self.connected(PRESS + """\
    mode:  {address: 20, type: UINT, values: {0: "off", 1: idle, 2: auto}}
    bar:   {address: 21, type: INT, scale: 0.1, units: bar, min: 0, max: 21.7}
    real:  {address: 22, type: REAL, max: 21.7}
    any:   {address: 24, type: REAL, allow_nonfinite: true}
    code:  {address: 26, type: STRING, length: 4, encoding: ascii}
""")
        for point, value, why in (
                (press.speed, 7000, "speed: refused: 7000 % is out of range; send 0 to 6553.5 %"),
                (press.speed, float("nan"), "not a number; send 0 to 6553.5 %"), (press.speed, 10 ** 400, "out of range"),
                (press.speed, "80", "'80' is not a number"), (press.speed, True, "True is not a number"),
                (press.total, -1, "-1 does not fit into UDINT (0 to 4294967295)"),
                (press.total, 1.5, "1.5 is not a whole number, as UDINT needs"), (press.total, float("inf"), "UDINT"),
                (press.part, 256, "256 does not fit into USINT (0 to 255)"),
                (press.valve, 2, "2 is neither True nor False"), (press.valve, "on", "neither"), (press.flag, None, "neither"),
                (press.lamps, [True], "give 3"), (press.lamps, True, "give 3"), (press.lamps, "101", "give 3"),
                (press.lamps, [True, False, 2], "neither"),
                (press.label, "seven..", "'seven..' is too long; give at most 6 bytes of utf-8"),
                (press.label, "€€€", "too long"),
                (press.label, "a\0b", "leave the character out"), (press.label, b"abc", "not text"),
                (press.label, "\ud800", "cannot be written in utf-8"), (press.code, "é", "cannot be written in ascii"),
                (press.bar, 21.8, "21.8 bar is above the maximum; send 0 to 21.7 bar"),
                (press.bar, -0.1, "-0.1 bar is below the minimum; send 0 to 21.7 bar"),
                (press.bar, float("nan"), "not a number; send 0 to 21.7 bar"),
                (press.bar, 99999, "99999 bar is out of range; send 0 to 21.7 bar"),
                (press.mode, -1, "-1 is not allowed; send off (0), idle (1) or auto (2)"),
                (press.mode, 3, "3 is not one of its values; send off (0), idle (1) or auto (2)"),
                (press.real, 21.8, "21.8 is above the maximum; send at most 21.7"),
                (press.real, float("nan"), "not finite"), (press.any, 1e39, "1e+39 does not fit into REAL")):
            self.assertIn(why, self.raises("Refused", point.write, value))
        self.assertEqual(self.device.requests, [])
        with self.assertRaises(ValueError):
            press.speed.write(7000)
        for point, value in ((press.bar, 21.7), (press.real, 21.7), (press.any, float("inf")), (press.speed, 6553.54),
                             (press.total, 7.0), (press.valve, 1), (press.lamps, (True, False, True))):
            point.write(value)
        press.mode.write(self.module.values.mode.auto)
        self.assertIs(press.mode.read(), self.module.values.mode.auto)
        self.device.tables["holding_registers"][20] = 9  # what has no name is a number
        self.assertEqual((press.mode.read(), isinstance(press.mode.read(), enum.Enum)), (9, False))

    def test_what_the_map_calls_invalid_is_no_value(self):
        press = self.connected(PRESS + """\
    temp:    {address: 40, type: INT, scale: 0.1, invalid: 0x8000}
    bit:     {address: 41, type: BOOL, bit: 1, access: read, invalid: 0xFFFF}
    several: {address: 42, type: UDINT, order: CDAB, count: 2, access: read, invalid: [[0xFFFF0000, 0xFFFFFFFF]]}
    half:    {address: 46, type: SINT, offset: high, access: read, invalid: -1}
""")
        registers = self.device.tables["holding_registers"]
        registers[40:47] = [0x8000, 0xFFFF, 0, 0, 1, 0xFFFF, 0xFF01]
        every = press.read_all()
        for point in (press.temp, press.bit, press.several, press.half):
            self.assertIn(f"{point.spec.name} has no value: the device gives 0x", self.raises("NoValue", point.read))
            self.assertIsNone(every[point.spec.name])
        registers[40:47] = [215, 2, 7, 1, 0, 0xFFFE, 0x0201]
        self.assertEqual([point.read() for point in (press.temp, press.bit, press.several, press.half)],
                         [21.5, True, [0x10007, 0xFFFE0000], 2])
        self.assertEqual(self.raises("Refused", press.temp.write, -3276.8),
                         "temp: refused: -3276.8 means 'no value'; send another value")

    def test_a_raw_value_beyond_its_ends_is_a_fault(self):
        press = self.connected(PRESS + """\
    bar: {address: 70, type: UINT, access: read, scale: {raw: [4000, 20000], value: [0, 10]}, fault_below: 3600, fault_above: 21000}
""")
        for raw in (3599, 21001):
            self.device.tables["holding_registers"][70] = raw
            self.assertIn(f"the device gives {raw}, ", self.raises("NoValue", press.bar.read))
        self.device.tables["holding_registers"][70] = 12000
        self.assertEqual(press.bar.read(), 5)

    def test_a_scale_has_its_exponent_from_another_point(self):
        press = self.connected(PRESS + """\
    power:    {address: 50, type: INT, access: read, scale: {gain: 2, offset: 1, exponent_of: power_sf}}
    power_sf: {address: 60, type: INT, access: read, invalid: 0x8000}
""")
        for power, value in ((0, 1235.0), (1, 12341.0), (-2 & 0xFFFF, 13.34)):
            self.device.tables["holding_registers"][50], self.device.tables["holding_registers"][60] = 617, power
            self.assertAlmostEqual(press.power.read(), value)
            self.assertAlmostEqual(press.read_all()["power"], value)
        for power in (0x8000, 31):
            self.device.tables["holding_registers"][60] = power
            self.raises("NoValue", press.power.read)
            self.assertIsNone(press.read_all()["power"])

    def test_an_exponent_may_leave_nothing_of_the_gain(self):
        self.press()
        spec = self.module.Spec("a", "holding_registers", 0, "INT", gain=1e-300, exponent_of="b")
        self.assertEqual(spec.decode([7], -30), 0)

    def test_every_error_comes_back_from_pickle(self):
        self.press()
        module = self.module
        errors = [kind("why") for kind in (module.CouplerError, module.NotConnected, module.OtherMap, module.Lost,
                                           module.NotTaken, module.NoValue, module.Refused)]
        errors += [module.ExceptionReply(2), module.ExceptionReply(4, "speed: "), module.NotConnected("why", 111)]
        named = {kind for kind in vars(module).values() if isinstance(kind, type) and issubclass(kind, module.CouplerError)}
        self.assertEqual({type(error) for error in errors}, named)
        for error in errors:
            for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
                again = pickle.loads(pickle.dumps(error, protocol))
                self.assertIs(type(again), type(error))
                for name in ("code", "errno"):
                    self.assertEqual(getattr(again, name, None), getattr(error, name, None))
                self.assertEqual(str(again), str(error))

    def test_a_scale_is_that_of_python(self):
        """test/golden/make-scale: halves, ends of types, numbers without a double."""
        self.press()
        cases = json.loads((made.SOURCE / "test/golden/scale.json").read_text(encoding="utf-8"))
        cases = [case for case in cases if (float.fromhex(case["gain"]), float.fromhex(case["offset"])) != (1, 0)]
        self.assertGreater(len(cases), 500)
        for case in cases:
            size = {"I": 1, "U": 1, "D": 2, "L": 4, "R": 2}[case["type"].replace("UD", "D").replace("UL", "L")[0]]
            spec = self.module.Spec("a", "holding_registers", 0, case["type"], size=size, order="ABCD" if size > 1 else "AB",
                                    gain=float.fromhex(case["gain"]), offset=float.fromhex(case["offset"]), nonfinite=True)
            if "error" in case:
                self.raises("Refused", spec.encode, float.fromhex(case["value"]))
            else:
                self.assertEqual(spec.encode(float.fromhex(case["value"])), case["registers"], case)
                published = float.fromhex(case["published"])
                decoded = spec.decode(case["registers"])
                self.assertIn(decoded, (published, float(f"{published:.15g}")), case)
                if spec.encode(published) == case["registers"]:
                    self.assertEqual(spec.encode(decoded), case["registers"], case)

    def test_a_value_has_no_digits_that_are_not_its_own(self):
        press = self.connected(PRESS + "    gauge: {address: 20, type: REAL, order: ABCD}\n"
                               "    small: {address: 22, type: ULINT, order: ABCD, scale: {gain: 0.1}}\n")
        registers = self.device.tables["holding_registers"]
        registers[0], registers[20:22] = 726, struct.unpack(">2H", struct.pack(">f", 0.1))
        self.assertEqual([str(point.read()) for point in (press.speed, press.gauge)], ["72.6", "0.1"])
        registers[22:26] = struct.unpack(">4H", (2 ** 53 - 1).to_bytes(8, "big"))  # here the sixteenth digit counts
        self.assertEqual(press.small.read(), (2 ** 53 - 1) * 0.1)

    def test_a_text_with_bytes_that_are_none_of_its_encoding_is_read(self):
        press = self.connected()
        self.device.tables["holding_registers"][8:11] = struct.unpack("<3H", b"a\xffb\0cd")
        self.assertEqual(press.label.read(), r"a\xffb")

    def test_a_point_cannot_be_replaced_by_a_value(self):
        press = self.press()
        with self.assertRaisesRegex(AttributeError, r"speed\.write\(value\)"):
            press.speed = 80


class Names(OfADevice):
    def test_the_class_of_a_map_stands_in_nobodys_place(self):
        """Such a class ends in Client: no other name of the file may, but the one that no map can make."""
        self.press()
        self.assertEqual([name for name in vars(self.module) if name.endswith("Client") and name[0] != "_"],
                         ["Client", "CellClient"])
        self.module, kind = self.client(PRESS, name="modbus_tcp")
        self.assertEqual(kind.__name__, "ModbusTcpClient")
        with kind("127.0.0.1", self.device.port) as press:
            press.speed.write(80)
            self.assertEqual(press.speed.read(), 80)

    def test_the_name_of_a_map_file_is_no_encoding_and_no_code(self):
        (self.folder / "x,coding=raw_unicode_escape,.yaml").write_text(
            'name: press\nmapping:\n  coils:\n    a: {address: 0, description: "\\\\u000araise SystemExit #"}\n', encoding="utf-8")
        done = self.coupler("generate", "x,coding=raw_unicode_escape,.yaml", "--python", "--name", "odd")
        self.assertEqual(done.returncode, 0, done.stderr)
        data = (self.folder / "odd_client.py").read_bytes()
        self.assertIn(b"\\u000araise SystemExit", data)
        self.assertIn(b"coding=raw_unicode_escape", data)
        self.assertEqual(tokenize.detect_encoding(io.BytesIO(data).readline)[0], "utf-8")
        self.assertNotIn("SystemExit", ast.unparse(ast.parse(data)), "it is a comment")

    def test_words_of_python_and_of_the_client_get_an_underscore(self):
        client = self.press()
        own = [name for name in dir(client) if not name.startswith("_") and name not in client.points]
        words = [word for word in keyword.kwlist + own if word != "online"]  # a topic of the driver: no point has that name
        plain = ["read", "write", "self", "values", "Client", "Spec", "Output", "int", "str", "match", "property", "class_"]
        points = "".join(f"    {name}: {i}\n" for i, name in enumerate([*words, *plain, "arm/left", "arm_left"]))
        client = self.connected(f"name: press\nmapping:\n  coils:\n{points}")
        client.read_all()
        for name in {*words} - {"class"}:
            self.assertIs(getattr(client, f"{name}_"), client.points[name])
        for name in {*plain} - {"class_"}:
            self.assertIs(getattr(client, name), client.points[name])
        names = {vars(client)[name].spec.name for name in ("class_", "class__", "arm_left", "arm_left_")}
        self.assertEqual(names, {"class", "class_", "arm/left", "arm_left"})

    def test_names_of_values_may_be_words_of_python_or_of_int(self):
        words = [word for word in {*keyword.kwlist, *dir(int), *dir(enum.IntEnum), "mro", "name", "value", "names"}
                 if word.isidentifier() and not word.startswith("_")]
        values = ", ".join(f'{i}: "{word}"' for i, word in enumerate(words))
        point = f"{{type: INT, values: {{{values}}}"
        press = self.connected(f"name: press\nmapping:\n  holding_registers:\n    enum: {point}, address: 0}}\n"
                               f"    IntEnum: {point}, address: 1}}\n")
        for i, word in enumerate(words):
            member = getattr(self.module.values.IntEnum, word, None)
            member = member if isinstance(member, enum.Enum) else getattr(self.module.values.IntEnum, f"{word}_")
            press.enum.write(member)
            self.assertEqual((int(member), press.enum.read()), (i, i))

    def test_texts_of_the_map_cannot_leave_their_place(self):
        press = self.press('name: press\nmapping:\n  holding_registers:\n    a: {address: 0, type: INT, min: 0, '
                           'units: "\\"\\\\ \\"\\"\\" \\u202e\\n{}", description: "\\"\\"\\" \\\\\\nimport nothing"}\n')
        self.assertEqual(press.a.spec.units, '"\\ """ \u202e\n{}')


if __name__ == "__main__":
    unittest.main(warnings="ignore")
