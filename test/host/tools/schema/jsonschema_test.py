# SPDX-License-Identifier: Apache-2.0
"""The schema of maps as python3-jsonschema understands it: good maps pass, bad ones fail if a schema can see why.
COUPLER is the program, SOURCE_DIR the tree. Exit status 77: a package is missing."""
import itertools
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import jsonschema
    import yaml
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed (scripts/install-packages test)")
    sys.exit(77)
import yaml12

SOURCE = Path(os.environ["SOURCE_DIR"])
BAD = SOURCE / "test/maps/bad"
SCHEMA = json.loads(subprocess.run([os.environ["COUPLER"], "schema"], check=True, capture_output=True).stdout)
VALIDATOR = jsonschema.Draft7Validator(SCHEMA)

# What the schema does not see, by the reason. Maps of test/maps/bad.
UNSEEN = {name + ".yaml" for name in (
    # between keys
    "tls_with_rtu security_at_the_plain_port serial_and_address unit_of_a_serial_line broadcast_that_is_read broadcast_with_a_watchdog "
    "broadcast_with_tools broadcast_with_axes tool_times "
    # between points, or between a point and a limit
    "overlap overlap_of_a_word_and_its_bits overlap_of_parts overlap_of_access overlap_of_inputs overlap_of_a_wired_input point_name_is_taken "
    "names_of_later_topics tool_names_of_points tool_outputs tool_output_of_defaults tool_output_of_two tool_sensors tool_joint_of_two tool_positions "
    "tool_point_is_used_twice tool_outputs_are_both_on axis_points axis_point_of_two axis_joint_of_two axis_is_not_read axis_names_of_points "
    "axis_positions_twice axis_positions_not_allowed axis_positions_of_a_measure "
    "line_in_two_points point_exceeds_the_limits unreadable_before_a_write string_is_too_long_to_write preset_area "
    # between roles and what they name
    "security_plain_is_no_role security_role_is_called_none security_of_no_point "
    # in the digits of an address: JSON has numbers
    "modicon_past_65536 modicon_numbers_read_from_zero "
    # between entries of a list
    "allow_is_half allow_is_the_other_half "
    # between the watchdog and the preset
    "coupler_watchdog_fed_by coupler_watchdog_heartbeat coupler_watchdog_heartbeat_place coupler_watchdog_of_a_plc "
    "coupler_watchdog_of_none "
    "coupler_watchdog_place_is_taken coupler_watchdog_recovery coupler_watchdog_steps coupler_watchdog_too_long "
    "heartbeat_of_a_node "
    # in a name that is right, but for ROS 1 only
    "name_in_ros1_only "
    # in the lock, or for want of one
    "address_is_missing indented_too_little lock_does_not_know_it lock_of_a_merge lock_is_outgrown "
    # in the text: gone when it is read as YAML
    "anchor tag tag_of_a_map tag_of_quoted_text key_is_null duplicate_key duplicate_table tool_name_is_taken axis_name_is_taken").split()} | {"json_surrogate_escape.json"}

# Of test/maps/mistakes.
UNSEEN_MISTAKES = {
    "in the lock, or for want of one": ["holding_registers: {type: INT}"],
    "between the tables: one that is empty is good beside another": [
        r"file: name: press\nmapping: {}\n", r"file: name: press\nmapping:\n  coils:\n"],
    "between points": [r"holding_registers: {address: 0, type: float}\n    q: {address: 1, type: int16}"],
    "in the text: a key that is there twice is gone when it is read as YAML": ["top: name: belt"],
}

# A point of each type with each of these keys, and of some types beside each of CONTEXTS: the schema refuses what the
# loader refuses, and nothing else.
TYPES = {"BOOL": "bit: 3", "BYTE": "offset: low", "SINT": "offset: low", "USINT": "offset: high", "CHAR": "offset: high",
         "STRING": "length: 6", **{name: "" for name in "WORD DWORD LWORD INT DINT LINT UINT UDINT ULINT REAL LREAL".split()}}
BITS_OF_A_WORD = f"[{', '.join(['on'] * 16)}]"
KEYS = """bit: 3|bits: [8, 11]|bits: [0, 14]|bits: [3, 3]|bits: [0, 15]|bits: [8, 16]|offset: low|length: 6|encoding: ascii|ignore_byteorder: true|order: AB|order: BA|order: CDAB|scale: 0|scale: 0.1|scale: 1|scale: {gain: 1}|
    scale: {gain: 0}|scale: {gain: 2, offset: -1}|scale: {offset: 5}|min: 1|min: 0.5|min: 40000|min: -1|max: 1e39|
    values: {0: idle, 1: run}|initial: 1|initial: 0.5|initial: -1|initial: 300|initial: 70000|initial: 5e9|
    initial: on|initial: true|initial: "on"|initial: "1"|initial: idle|initial: [1, 0]|initial: [on, off]|
    initial: %s|initial: [%s, %s]|initial: {}|count: 1|count: 2|count: 0|access: read|access: write|access: read_write|
    iio: {device: a, channel: b}|pwm: {chip: a, channel: 0, period: 1ms}|pwm: {chip: a, channel: 0, period: 11s}|
    iio: {device: "", channel: b}|counter: {of: q}|latched: {of: q}|deadband: 1|deadband: -1|publish: always|
    max_interval: 1s|rate: 2|latch: on|stamped: on|stamped: no|queue_size: 3|write_function: single|write_function: multiple|
    write_queue: every|priority: high|verify_write: yes|verify_write: no|deadman: {timeout: 1s, value: 1}|
    deadman: {timeout: 1s, value: on}|deadman: {timeout: 1s, value: 0.5}|deadman: {timeout: 500us, value: 1}|
    deadman: {timeout: 61min, value: 1}|deadman: {timeout: 1s}|read_address: 7|allow_nonfinite: true|safe: on|
    safe: hold|safe: 1|safe: [on, off]|safe: 70000|line: GPIO1|line: 5|line: ""|line: {chip: a, offset: 1}|
    line: {chip: a}|line: {name: b, offset: 2}|line: {name: b}|line: {}|line: {name: b, active_low: true}|
    active_low: true|bias: pull_up|drive: open_drain|pulse: 200ms|pulse: 2h|debounce: 5ms|debounce: 2min|debounce: 0|units: mm|
    units: true|description: 5|invalid: 255|invalid: [0x7F, [3, 9]]|invalid: []|invalid: [[1, 2, 3]]|fault_below: 5|
    fault_above: on|scale: {raw: [0, 5], value: [0, 1]}|scale: {raw: [0, 5]}|scale: {raw: [0, 5], value: [0, 1], gain: 2}|
    scale: {raw: [5, 5], value: [0, 1]}|scale: {raw: 5, value: [0, 1]}""" % ((BITS_OF_A_WORD,) * 3)
CONTEXTS = ["count: 2", "ignore_byteorder: yes", "ignore_byteorder: off", "access: read", "access: write", "scale: 0.5", "values: {0: idle, 100: run}", "publish: on_change",
            "line: GPIO7", "pulse: 1s", "iio: {device: d, channel: c}"]
DIFFERENT_TYPES = {"BOOL", "SINT", "WORD", "INT", "REAL", "STRING"}
# What no schema can say: it compares no numbers, adds none, and counts no list or text by another key's number.
BETWEEN_KEYS = re.compile("is published from|is set to 0|is not one of its values|below 'min'|lists 16 values, the array has 2|"
                          "function codes 5 and 6 write one")
NO_NAME_OF_A_VALUE = "must be a number, not"  # beside `values`


def points_to_compare():
    """(table, the point's keys)"""
    for name in ("USINT", "UINT"):
        for first, last in itertools.product(range(17), repeat=2):
            yield "holding_registers", f"address: 0, type: {name}, bits: [{first}, {last}]"
    for table in ("coils", "discrete_inputs", "input_registers", "holding_registers"):
        types = {f"type: {name}, {own}": name for name, own in TYPES.items()} if "registers" in table else {"": ""}
        for head, name in types.items():
            for key in re.split(r"\|\s*", KEYS):
                for other in ["", *(CONTEXTS if table != "input_registers" and name in DIFFERENT_TYPES | {""} else [])]:
                    texts = [text for text in ("address: 0", *head.split(", "), key, other) if text]
                    if len({text.split(":")[0] for text in texts}) == len(texts):
                        yield table, ", ".join(texts)


def is_map(path):
    return re.search(r"^\s*[\"']?mapping", path.read_text(encoding="utf-8"), re.M) is not None


def good_maps():
    """Every map of the tree that `coupler check` takes without a warning of an unknown key."""
    found = [path for folder in ("config", "test") for path in sorted((SOURCE / folder).rglob("*"))
             if path.suffix in (".yaml", ".json") and BAD not in path.parents and is_map(path)]
    return [path for path in found if subprocess.run([os.environ["COUPLER"], "check", path],
                                                     capture_output=True, check=False).returncode == 0]


def content(path):
    """Its value, or None: it is neither YAML nor JSON as everybody knows it."""
    text = path.read_text(encoding="utf-8", errors="surrogateescape")
    if path.suffix == ".json":  # the loader allows comments
        text = re.sub(r"/\*.*?\*/|//[^\n\"]*$", "", text, flags=re.S | re.M)
    return parsed(text)


def parsed(text):
    try:
        return yaml12.load(text)
    except (yaml.YAMLError, ValueError):
        return None


def mistakes():
    """What is typed -> the map that it makes and what the loader says of it. The format is in README.md there."""
    found = {}
    for path in sorted((SOURCE / "test/maps/mistakes").glob("*.txt")):
        for line in path.read_text(encoding="utf-8").splitlines():
            if line.startswith("  > "):
                found[typed][1].append(line[4:])
            elif line and line[0] not in "# ":
                typed = line
                where, text = line.split(": ", 1)
                text = text.replace("\\n", "\n").replace("\\t", "\t")
                before = {"file": "", "top": "name: press\n", "mapping": "name: press\nmapping:\n  "}.get(
                    where, f"name: press\nmapping:\n  {where}:\n    p: ")
                found[typed] = (before + text + ("\nmapping: {coils: {valve: 0}}\n" if where == "top" else "\n"), [])
    return found


def loaded(maps):
    """The errors of the loader, for each of the maps."""
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder, f"{at}.yaml") for at in range(len(maps))]
        for path, text in zip(paths, maps):
            path.write_text(text, encoding="utf-8")
        done = subprocess.run([os.environ["COUPLER"], "check", "--json", *paths], capture_output=True, check=False)
    return [[each["what"] for each in json.loads(line)["diagnostics"] if each["severity"] == "error"]
            for line in done.stdout.splitlines()]


def problems(value):
    return [f"{'/'.join(map(str, e.absolute_path))}: {e.message}" for e in VALIDATOR.iter_errors(value)]


class TheSchema(unittest.TestCase):
    def test_is_a_schema(self):
        jsonschema.Draft7Validator.check_schema(SCHEMA)

    def test_accepts_every_good_map(self):
        maps = good_maps()
        self.assertGreater(len(maps), 15)
        for path in maps:
            with self.subTest(path.relative_to(SOURCE)):
                self.assertEqual(problems(content(path)), [])

    def test_refuses_every_bad_map_whose_fault_it_can_see(self):
        accepted = set()
        for path in sorted([*BAD.glob("*.yaml"), *BAD.glob("*.json")]):
            value = content(path)
            if value is not None and not problems(value):
                accepted.add(path.name)
        self.assertEqual(accepted, UNSEEN)

    def test_refuses_every_mistake_that_it_can_see(self):
        accepted = set()
        table = mistakes()
        self.assertGreater(len(table), 100)
        for typed, (text, said) in table.items():
            value = parsed(text)
            if value is not None and any(line.startswith("error: ") for line in said) and not problems(value):
                accepted.add(typed)
        self.assertEqual(accepted, {typed for why in UNSEEN_MISTAKES.values() for typed in why})

    def test_agrees_with_the_loader_about_a_key_of_a_point_beside_another(self):
        points = list(points_to_compare())
        self.assertGreater(len(points), 5000)
        maps = [f"name: press\nsim: [{{square: 1s, to: q}}]\nmapping:\n  {table}:\n    p: {{{point}}}\n" +
                ("    q: 9\n" if table == "discrete_inputs" else "  discrete_inputs: {q: 9}\n") for table, point in points]
        for (table, point), text, said in zip(points, maps, loaded(maps)):
            if any(BETWEEN_KEYS.search(each) or ("values:" in point and NO_NAME_OF_A_VALUE in each) for each in said):
                continue
            with self.subTest(f"{table}: {{{point}}}"):
                self.assertEqual(VALIDATOR.is_valid(parsed(text)), not said, said)

    def test_explains_and_gives_the_default_of_keys(self):
        port = SCHEMA["properties"]["port"]
        self.assertEqual((port["default"], port["minimum"], port["maximum"]), (502, 1, 65535))
        self.assertIn("TCP port", port["description"])

    def test_takes_modicon_numbers_only_where_the_map_counts_so(self):
        def map_with(address, **top):
            return {"name": "a", "mapping": {"coils": {"b": address}}, **top}
        self.assertEqual(problems(map_with(65535)), [])
        self.assertNotEqual(problems(map_with(65536)), [])
        self.assertEqual(problems(map_with(65536, addressing="modicon")), [])
        self.assertNotEqual(problems(map_with(0, addressing="modicon")), [])

    def test_takes_a_list_for_what_is_safe_for_coils(self):
        def map_with(safe):
            return {"name": "a", "on_shutdown": "safe", "mapping": {"coils": {"b": {"address": 0, "count": 2, "safe": safe}}}}
        for safe in ("on", "hold", ["on", "off"], [True, False]):
            self.assertEqual(problems(map_with(safe)), [], safe)
        for safe in ("onn", [], ["on", "hold"], [1, 0]):
            self.assertNotEqual(problems(map_with(safe)), [], safe)


if __name__ == "__main__":
    unittest.main(verbosity=1)
