# SPDX-License-Identifier: Apache-2.0
"""What Telegraf and Home Assistant would read with the configurations that `coupler export` writes. Neither is in
Debian, so their rules are followed here as their own sources state them:
  Telegraf        plugins/inputs/modbus: sample_request.conf (keys, types), configuration_request.go (what check()
                  refuses), type_conversions*.go (byte orders); plugins/processors/enum
  Home Assistant  homeassistant/components/modbus: __init__.py (schemas), validators.py (struct_validator), entity.py
                  (swaps, unpacking, scale); docs: source/_integrations/modbus.markdown
COUPLER is the program, SOURCE_DIR the tree."""
import os
import re
import struct
import subprocess
import tempfile
import tomllib
import unittest
from pathlib import Path

import yaml

MAP = Path(os.environ["SOURCE_DIR"]) / "test/peers/dissector.yaml"


def swap_bytes(data):
    return b"".join(data[i:i + 2][::-1] for i in range(0, len(data), 2))


def swap_words(data):
    return b"".join(data[i:i + 2] for i in reversed(range(0, len(data), 2)))


# The registers of a device that serves test/peers/dissector.yaml: first address, bytes.
INPUTS = {0: struct.pack(">h", 615), 10: struct.pack(">f", 3.14), 12: swap_words(struct.pack(">f", -0.1)),
          14: swap_bytes(struct.pack(">i", -123456789)), 16: swap_words(swap_bytes(struct.pack(">I", 4000000000))),
          60: b"\0\7"}
HOLDINGS = {0: struct.pack(">h", -100), 1: b"\x34\x12", 2: b"\xfe\x07", 3: b"\x10\x08", 4: b"\xbe\xef",
            10: struct.pack(">q", -2**63 + 1), 14: swap_words(struct.pack(">Q", 2**64 - 2)),
            18: swap_bytes(struct.pack(">d", 1.25)), 22: swap_words(swap_bytes(struct.pack(">q", 81985529216486895))),
            26: struct.pack(">hhh", 3, -4, 5), 30: swap_bytes(b"Anlage\0\0"), 34: b"Kuhler"}
# What the points are, raw.
RAW = {"level": 615, "badc": -123456789, "dcba": 4000000000, "far": 7, "speed": -100, "mode": 0, "swapped": 0x1234, "high": -2,
       "low": 7, "mask": 0xBEEF, "long_abcd": -2**63 + 1, "long_cdab": 2**64 - 2, "long_dcba": 81985529216486895}


def memory(image):
    registers = bytearray(2 * 65536)
    for address, data in image.items():
        registers[2 * address:2 * address + len(data)] = data
    return registers


def exported(file, to, *options):
    done = subprocess.run([os.environ["COUPLER"], "export", str(file), "--to", to, *options], capture_output=True,
                          text=True, encoding="utf-8", check=True)
    return done.stdout


def all_maps():
    root = Path(os.environ["SOURCE_DIR"])
    return [root / "test/maps/every-type.yaml", root / "test/generate/manners.yaml", root / "config/example-node.yaml",
            root / "config/foreign-coupler.yaml", MAP]


TELEGRAF_TYPES = {"INT8L": ("b", 1), "INT8H": ("b", 1), "UINT8L": ("B", 1), "UINT8H": ("B", 1), "INT16": ("h", 1),
                  "UINT16": ("H", 1), "INT32": ("i", 2), "UINT32": ("I", 2), "INT64": ("q", 4), "UINT64": ("Q", 4),
                  "FLOAT16": ("e", 1), "FLOAT32": ("f", 2), "FLOAT64": ("d", 4), "STRING": (None, None), "BIT": (None, 1)}


class Telegraf(unittest.TestCase):
    def value(self, field, order, registers):
        kind, at = field["type"], 2 * field["address"]
        letter, count = TELEGRAF_TYPES[kind]
        little16 = order in ("DCBA", "BADC")
        if kind == "STRING":
            data = bytes(registers[at:at + 2 * field["length"]])
            return (swap_bytes(data) if little16 else data).split(b"\0")[0].decode()
        data = bytes(registers[at:at + 2 * count])
        if kind == "BIT":
            return int.from_bytes(data, "little" if little16 else "big") >> field.get("bit", 0) & 1
        if "8" in kind:
            self.assertIn(order, ("ABCD", "DCBA"))  # endiannessIndex8() knows no others
            data = data[(kind[-1] == "L") != (order == "DCBA"):][:1]
            return struct.unpack(letter, data)[0] * field.get("scale", 1)
        if little16:
            data = swap_bytes(data)
        if order in ("CDAB", "DCBA"):
            data = swap_words(data)
        return struct.unpack(">" + letter, data)[0] * field.get("scale", 1)

    def test_takes_the_keys_that_the_plugin_has(self):
        for file in all_maps():
            config = tomllib.loads(exported(file, "telegraf"))
            plugins = config["inputs"]["modbus"]
            self.assertEqual(len(plugins), 1)
            plugin = plugins[0]
            self.assertLessEqual(set(plugin), {"name", "controller", "timeout", "interval", "configuration_type", "request", "workarounds"})
            self.assertEqual(plugin["configuration_type"], "request")
            self.assertRegex(plugin["controller"], r"^tcp://[^/]+:\d+$")
            seen = set()
            for request in plugin["request"]:
                self.assertLessEqual(set(request), {"slave_id", "byte_order", "register", "measurement", "optimization",
                                                    "optimization_max_register_fill", "fields"})
                self.assertIn(request["register"], ("coil", "discrete", "holding", "input"))
                self.assertIn(request["byte_order"], ("ABCD", "DCBA", "BADC", "CDAB"))
                self.assertIn(request.get("optimization", "none"), ("none", "max_insert"))
                if "optimization" in request:
                    most = 125 if request["register"] in ("holding", "input") else 2000
                    self.assertTrue(1 <= request["optimization_max_register_fill"] <= most)
                self.assertTrue(request["fields"])
                for field in request["fields"]:
                    self.check_field(field, request)
                    self.assertNotIn((request["register"], field["name"]), seen)
                    seen.add((request["register"], field["name"]))
            self.check_names(config, {name for _, name in seen})

    def check_names(self, config, fields):
        """plugins/processors/enum: README.md, enum.go. A number is looked up by its decimal text."""
        for processor in config.get("processors", {}).get("enum", []):
            self.assertEqual(set(processor), {"namepass", "mapping"})
            for mapping in processor["mapping"]:
                self.assertEqual(set(mapping), {"fields", "dest", "value_mappings"})
                self.assertLessEqual(set(mapping["fields"]), fields)
                self.assertNotIn(mapping["dest"], fields)
                self.assertTrue(all(str(int(value)) == value for value in mapping["value_mappings"]))

    def test_names_values_in_a_second_field(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "m.yaml")
            file.write_text("name: m\nmapping:\n  holding_registers:\n    mode: {address: 0, type: INT, values: {-1: fault, 2: run}}\n"
                            "    modes: {address: 1, type: UINT, count: 2, values: {0: 'off', 1: 'on'}}\n"
                            "    mode_name: {address: 9, type: INT}\n", encoding="utf-8")
            [processor] = tomllib.loads(exported(file, "telegraf"))["processors"]["enum"]
        self.assertEqual(processor, {"namepass": ["m"], "mapping": [
            {"fields": ["mode"], "dest": "mode_name_2", "value_mappings": {"-1": "fault", "2": "run"}},
            {"fields": ["modes_0"], "dest": "modes_0_name", "value_mappings": {"0": "off", "1": "on"}},
            {"fields": ["modes_1"], "dest": "modes_1_name", "value_mappings": {"0": "off", "1": "on"}}]})

    def test_reads_the_nodes_statistics_where_docs_identity_has_them(self):
        table = (Path(os.environ["SOURCE_DIR"]) / "docs/identity.md").read_text(encoding="utf-8")
        config = tomllib.loads(exported(MAP, "telegraf", "--node-statistics"))
        request = config["inputs"]["modbus"][0]["request"][-1]
        self.assertEqual({key: request[key] for key in ("register", "byte_order", "measurement")},
                         {"register": "input", "byte_order": "ABCD", "measurement": "cell/north_node"})
        fields = {field["name"]: (field["address"], field["type"]) for field in request["fields"]}
        rows = dict(re.findall(r"^\| 0x(FF..) \| \d[^|]*\| ([^|]+) \|$", table, re.M))
        for name, start in (("watchdog", "watchdog: 0 not"), ("watchdog_left_ms", "watchdog: time left"), ("uptime_s", "uptime"),
                            ("requests", "requests answered"), ("exceptions", "of these, with"), ("connections", "connections accepted"),
                            ("hardware_errors", "hardware errors"), ("watchdog_trips", "times that"), ("events_lost", "events lost"),
                            ("exceptions_01", "exceptions 01"), ("connections_refused", "connections refused"),
                            ("connections_evicted", "connections closed to make"), ("foreign_units", "requests for another"),
                            ("connections_bad_frames", "connections closed for what they sent"),
                            ("connections_timed_out", "connections closed for what they did not")):
            [place] = [int(at, 16) for at, holds in rows.items() if holds.startswith(start)]
            self.assertEqual(fields.pop(name), (place, "UINT16" if name.startswith("watchdog") and name != "watchdog_trips" else "UINT32"))
        self.assertEqual({name: at for name, (at, _) in fields.items()},
                         {"exceptions_02": 0xFF1D, "exceptions_03": 0xFF1F, "exceptions_04": 0xFF21})
        self.assertEqual(config["processors"]["enum"][-1]["mapping"][0]["value_mappings"],
                         {"0": "not configured", "1": "idle", "2": "armed", "3": "expired"})

    def check_field(self, field, request):
        if request["register"] in ("coil", "discrete"):
            self.assertEqual(set(field), {"address", "name"})
            self.assertLessEqual(field["address"], 65535 - 1)
            return
        self.assertLessEqual(set(field), {"address", "name", "type", "length", "scale", "bit"})
        self.assertIn(field["type"], TELEGRAF_TYPES)
        self.assertEqual("length" in field, field["type"] == "STRING")
        self.assertFalse("bit" in field and field["type"] != "BIT")
        self.assertIsInstance(field.get("scale", 1.0), float)
        count = TELEGRAF_TYPES[field["type"]][1] or field["length"]
        self.assertLessEqual(field["address"], 65535 - count)

    def test_reads_every_type_in_every_order(self):
        values = {}
        for request in tomllib.loads(exported(MAP, "telegraf"))["inputs"]["modbus"][0]["request"]:
            if request["register"] in ("holding", "input"):
                registers = memory(INPUTS if request["register"] == "input" else HOLDINGS)
                values |= {f["name"]: self.value(f, request["byte_order"], registers) for f in request["fields"]}
        self.assertAlmostEqual(values.pop("abcd"), 3.14, 6)
        self.assertAlmostEqual(values.pop("cdab"), -0.1, 6)
        self.assertAlmostEqual(values.pop("level"), 61.5)  # the offset is told as left out
        expected = {name: value for name, value in RAW.items() if name != "level"}
        self.assertEqual(values, expected | {"long_badc": 1.25, "flag_3": 1, "flag_12": 1, "pair_0": 1.5, "pair_1": -2.0,
                                             "pair_2": 2.5, "label": "Anlage", "plain": "Kuhler"})


HA_TYPES = {"int16": ("h", 1), "uint16": ("H", 1), "int32": ("i", 2), "uint32": ("I", 2), "int64": ("q", 4),
            "uint64": ("Q", 4), "float32": ("f", 2), "float64": ("d", 4)}
ENTITY = {"name", "unique_id", "slave", "address", "scan_interval"}


def short(entity, hub):
    """The name without that of the hub, with which it begins."""
    begin, name = entity["name"][:len(hub["name"]) + 1], entity["name"][len(hub["name"]) + 1:]
    assert begin == hub["name"] + " ", entity
    return name


class HomeAssistant(unittest.TestCase):
    def hub(self, file):
        hubs = yaml.safe_load(exported(file, "home-assistant"))["modbus"]
        self.assertEqual(len(hubs), 1)
        return hubs[0]

    def config(self, points):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "m.yaml")
            file.write_text("{name: m, mapping: {holding_registers: {" + points + "}}}", encoding="utf-8")
            return yaml.safe_load(exported(file, "home-assistant"))

    def value(self, sensor, registers):
        kind, at = sensor["data_type"], 2 * sensor["address"]
        count = sensor["count"] if kind in ("custom", "string") else HA_TYPES[kind][1]
        data = bytes(registers[at:at + 2 * count])
        if sensor.get("swap") in ("byte", "word_byte"):
            data = swap_bytes(data)
        if sensor.get("swap") in ("word", "word_byte"):
            data = swap_words(data)
        if kind == "string":
            return data.split(b"\0")[0].decode()
        raw = struct.unpack(sensor["structure"] if kind == "custom" else ">" + HA_TYPES[kind][0], data)
        self.assertEqual(len(raw), 1)
        precision = sensor.get("precision", 0 if kind in HA_TYPES and "float" not in kind else 2)
        scaled = sensor.get("scale", 1) * raw[0] + sensor.get("offset", 0)
        return str(round(scaled)) if precision == 0 else f"{float(scaled):.{precision}f}"

    def check_entity(self, entity, keys):
        self.assertLessEqual(set(entity), ENTITY | keys, entity)
        self.assertIsInstance(entity["name"], str)
        self.assertTrue(0 <= entity["address"] <= 65535)
        self.assertGreaterEqual(entity["scan_interval"], 5)

    def check_sensor(self, sensor):
        self.check_entity(sensor, {"input_type", "data_type", "count", "structure", "swap", "scale", "offset", "precision",
                                   "unit_of_measurement"})
        self.assertIn(sensor["input_type"], ("holding", "input"))
        kind, swap = sensor["data_type"], sensor.get("swap")
        self.assertIn(kind, {*HA_TYPES, "custom", "string"})
        # struct_validator()
        self.assertEqual("count" in sensor, kind in ("custom", "string"))
        self.assertEqual("structure" in sensor, kind == "custom")
        self.assertIn(swap, {"custom": (None,), "string": (None, "byte"), "int16": (None, "byte"), "uint16": (None, "byte")}
                      .get(kind, (None, "byte", "word", "word_byte")))
        if kind == "custom":
            self.assertEqual(struct.calcsize(sensor["structure"]), 2 * sensor["count"])

    def test_takes_the_keys_that_the_schemas_have(self):
        for file in all_maps():
            hub = self.hub(file)
            self.assertLessEqual(set(hub), {"name", "type", "host", "port", "timeout", "delay", "message_wait_milliseconds",
                                            "binary_sensors", "switches", "sensors"})
            self.assertEqual(hub["type"], "tcp")
            self.assertIsInstance(hub["host"], str)
            for entity in hub.get("binary_sensors", []):
                self.check_entity(entity, {"input_type"})
                self.assertIn(entity["input_type"], ("coil", "discrete_input", "holding", "input"))
            for entity in hub.get("switches", []):
                self.check_entity(entity, {"write_type", "verify"})
                self.assertEqual(entity["write_type"], "coil")
                self.assertLessEqual(set(entity.get("verify", {})), {"input_type", "address", "state_on", "state_off"})
            for entity in hub.get("sensors", []):
                self.check_sensor(entity)
            entities = [e for kind in ("binary_sensors", "switches", "sensors") for e in hub.get(kind, [])]
            self.assertEqual(len({e["unique_id"] for e in entities}), len(entities), file)

    def test_reads_every_type_in_every_order(self):
        banks = {"input": memory(INPUTS), "holding": memory(HOLDINGS)}
        hub = self.hub(MAP)
        values = {short(s, hub): self.value(s, banks[s["input_type"]]) for s in hub["sensors"]}
        expected = {name: str(value) for name, value in RAW.items() if name != "level"}
        self.assertEqual(values, expected | {"level": "21.5", "abcd": "3.140000", "cdab": "-0.100000", "long_badc": "1.250000",
                                             "pair 0": "1.5", "pair 1": "-2.0", "pair 2": "2.5", "label": "Anlage",
                                             "plain": "Kuhler"})

    def test_names_values_in_template_sensors(self):
        """docs: source/_integrations/template.markdown; an entity's id is the slug of its name (homeassistant.util.slugify)."""
        config = self.config("Arm/Mode: {address: 0, type: INT, values: {-1: fault, 2: run}}")
        self.assertEqual(config["modbus"][0]["sensors"][0]["name"], "m Arm/Mode")
        [[sensor]] = [part["sensor"] for part in config["template"]]
        self.assertEqual({key: sensor[key] for key in ("name", "unique_id", "availability")},
                         {"name": "m Arm/Mode name", "unique_id": "m_arm_mode_name",
                          "availability": "{{ has_value('sensor.m_arm_mode') }}"})
        expression = re.fullmatch(r"\{\{ (.*) \}\}", sensor["state"])[1]  # Jinja's are Python's here
        for state, shown in (("-1", "fault"), ("2", "run"), ("7", "7")):
            states = {"sensor.m_arm_mode": state}.__getitem__
            self.assertEqual(eval(expression, {"states": states}), shown)  # pylint: disable=eval-used

    def test_a_template_reads_the_register_of_its_own_point(self):
        """helpers/entity_registry.py: of ids that are alike the later ones get _2, _3 ..."""
        names = ["Mode", "mode", "a_b", "a/b", "a_b_2"]
        points = [f"{name}: {{address: {i}, type: INT, values: {{{i}: v{i}}}}}" for i, name in enumerate(names)]
        config = self.config(", ".join(points))
        states = {}
        for sensor in config["modbus"][0]["sensors"]:
            slug = "sensor." + re.sub("[^a-z0-9]+", "_", sensor["name"].lower())
            states[next(each for each in (slug, slug + "_2") if each not in states)] = str(sensor["address"])
        for template in config["template"][0]["sensor"]:
            shown = eval(template["state"][3:-3], {"states": states.__getitem__})  # pylint: disable=eval-used
            self.assertEqual(shown, f"v{names.index(template['name'][len('m '):-len(' name')])}")

    def test_switches_coils_and_reads_them_back(self):
        hub = self.hub(MAP)
        self.assertEqual([short(s, hub) for s in hub["switches"]], ["lamp", "gate"] + [f"row {i}" for i in range(10)])
        self.assertEqual(hub["switches"][3]["verify"], {"input_type": "coil", "address": 9, "state_on": 1, "state_off": 0})
        self.assertEqual([short(s, hub) for s in hub["binary_sensors"]], ["button", "door"])


if __name__ == "__main__":
    unittest.main()
