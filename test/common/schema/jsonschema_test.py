# SPDX-License-Identifier: Apache-2.0
"""The schema of maps as python3-jsonschema understands it: good maps pass, bad ones fail if a schema can see why.
COUPLER is the program, SOURCE_DIR the tree. Exit status 77: a package is missing."""
import json
import os
import re
import subprocess
import sys
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

UNSEEN = {name + ".yaml" for name in (
    # between points, or between a point and a limit
    "overlap overlap_of_parts overlap_of_access overlap_of_inputs overlap_of_a_wired_input point_name_is_taken "
    "line_in_two_points point_exceeds_the_limits string_is_too_long_to_write preset_area "
    # between keys of a point
    "line_option_given_twice line_option_without_a_line array_with_hardware array_initial initial_does_not_fit "
    # in the digits of an address
    "modicon_of_another_table modicon_past_65536 modicon_numbers_read_from_zero "
    # between entries of a list
    "allow_is_half allow_is_the_other_half "
    # between the watchdog and the preset
    "coupler_watchdog_fed_by coupler_watchdog_heartbeat coupler_watchdog_heartbeat_place coupler_watchdog_of_a_plc "
    "coupler_watchdog_place_is_taken coupler_watchdog_recovery coupler_watchdog_steps coupler_watchdog_too_long "
    "heartbeat_of_a_node "
    # in a name that is right, but for ROS 1 only
    "name_in_ros1_only "
    # in the lock, or for want of one
    "address_is_missing lock_does_not_know_it lock_of_a_merge lock_is_outgrown "
    # in the text: gone when it is read as YAML
    "anchor tag tag_of_a_map tag_of_quoted_text key_is_null duplicate_key duplicate_table").split()} | {"json_surrogate_escape.json"}


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
    try:
        return yaml12.load(text)
    except (yaml.YAMLError, ValueError):
        return None


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
