# SPDX-License-Identifier: Apache-2.0
"""The program `coupler` as a script sees it: exit status, output, files. COUPLER is the program."""
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

GOOD = """\
name: cell
mapping:
  coils: {lamp: 0}
  discrete_inputs: {button: 0, door: 1}
  input_registers:
    level: {address: 0, type: REAL}
"""
BAD = GOOD.replace("REAL", "REEL")
OPEN = "name: cell\nmapping:\n  coils:\n    lamp:\n    horn:\n"  # without addresses
WARNED = GOOD + "nobody_knows_this: 1\n"  # the origin ignores it, so it is a warning in an origin's file


class Cli(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def file(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return name

    def coupler(self, *arguments, stdin=""):
        return subprocess.run([os.environ["COUPLER"], *arguments], cwd=self.folder, input=stdin,
                              capture_output=True, text=True, encoding="utf-8", check=False)


class TheCall(Cli):
    def refused(self, *arguments):
        done = self.coupler(*arguments)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertTrue(done.stderr.startswith("coupler"), done.stderr)
        self.assertIn(" --help`", done.stderr)
        return done.stderr

    def test_without_a_command_is_wrong(self):
        self.refused()

    def test_with_an_unknown_command_names_it(self):
        self.assertIn("'frobnicate' is not a command", self.refused("frobnicate", "a", "b"))

    def test_with_an_unknown_option_names_it(self):
        self.assertIn("--nope", self.refused("check", "map.yaml", "--nope"))

    def test_without_a_map_is_wrong(self):
        self.assertIn("MAP", self.refused("check"))
        self.assertIn("MAP", self.refused("generate", "--out", "out"))

    def test_of_generate_needs_a_folder(self):
        self.assertIn("--out", self.refused("generate", self.file("cell.yaml", GOOD)))

    def test_for_help_shows_an_example(self):
        for command in ([], ["check"], ["export"], ["generate"], ["import"], ["plan"], ["schema"]):
            done = self.coupler(*command, "--help")
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertIn("Example:\n  coupler " + "".join(command), done.stdout)

    def test_for_the_version_prints_it(self):
        done = self.coupler("--version")
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stdout, r"^coupler \d+\.\d+\.\d+\n$")


class Schema(Cli):
    def test_it_is_printed_or_written(self):
        done = self.coupler("schema")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(json.loads(done.stdout)["$schema"], "http://json-schema.org/draft-07/schema#")
        self.assertEqual(self.coupler("schema", "--out", "s.json").returncode, 0)
        self.assertEqual((self.folder / "s.json").read_text(encoding="utf-8"), done.stdout)

    def test_a_file_that_cannot_be_written_is_told(self):
        done = self.coupler("schema", "--out", "nowhere/s.json")
        self.assertEqual(done.returncode, 2)
        self.assertIn("nowhere/s.json", done.stderr)


class Check(Cli):
    def test_a_good_map_is_summed_up(self):
        done = self.coupler("check", self.file("cell.yaml", GOOD))
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertRegex(done.stdout, r"^cell\.yaml: ok: cell, 4 points "
                                      r"\(1 coil, 2 discrete inputs, 1 input register\), fingerprint [0-9a-f]{16}\n$")

    def test_a_bad_map_is_told_with_its_place(self):
        done = self.coupler("check", self.file("cell.yaml", BAD))
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertRegex(done.stderr, r"^cell\.yaml:6:\d+: error: .*REEL.*; .+\n")

    def test_standard_input_is_quoted_with_both_places(self):
        done = self.coupler("check", "-", stdin="name: a\nmapping:\n  coils: {lamp: 0, horn: 0}\n")
        self.assertEqual(done.returncode, 1)
        lines = done.stderr.splitlines()
        self.assertEqual(lines[1:3], ["    3 |   coils: {lamp: 0, horn: 0}", "      |                          ^"])
        self.assertEqual(lines[3], "<stdin>:3:17: note: the other is here")
        self.assertNotIn("\033", done.stderr)

    def test_json_has_the_other_place_too(self):
        done = self.coupler("check", "--json", "-", stdin="name: a\nmapping:\n  coils: {lamp: 0, horn: 0}\n")
        self.assertEqual(json.loads(done.stdout)["diagnostics"][0]["notes"],
                         [{"line": 3, "column": 17, "what": "the other is here"}])

    def test_a_warning_leaves_the_map_good(self):
        done = self.coupler("check", self.file("cell.yaml", WARNED))
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stderr, r"^cell\.yaml:7:1: warning: .*nobody_knows_this.*; .+\n")
        self.assertIn("cell.yaml: ok: ", done.stdout)

    def test_a_missing_file_is_wrong_input(self):
        done = self.coupler("check", "missing.yaml")
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertRegex(done.stderr, r"^missing\.yaml: error: .+; .+\n$")

    def test_one_bad_map_of_several_is_wrong_input(self):
        done = self.coupler("check", self.file("bad.yaml", BAD), self.file("cell.yaml", GOOD))
        self.assertEqual(done.returncode, 1)
        self.assertIn("bad.yaml:6:", done.stderr)
        self.assertIn("cell.yaml: ok: ", done.stdout)

    def test_a_dash_is_standard_input(self):
        self.assertEqual(self.coupler("check", "-", stdin=GOOD).returncode, 0)
        self.assertEqual(self.coupler("check", "-", stdin=BAD).returncode, 1)

    def test_json_of_a_good_map(self):
        done = self.coupler("check", "--json", self.file("cell.yaml", GOOD))
        report = json.loads(done.stdout)
        self.assertRegex(report.pop("fingerprint"), "^[0-9a-f]{16}$")
        self.assertEqual(report, {"file": "cell.yaml", "ok": True, "name": "cell", "points": 4, "lock": None,
                                  "diagnostics": []})
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_json_of_a_bad_map(self):
        done = self.coupler("check", "--json", self.file("cell.yaml", BAD))
        report = json.loads(done.stdout)
        self.assertEqual((done.returncode, done.stderr), (1, ""))
        self.assertEqual((report["ok"], report["name"], report["points"], report["fingerprint"]),
                         (False, None, None, None))
        (found,) = report["diagnostics"]
        self.assertEqual((found["severity"], found["file"], found["line"]), ("error", "cell.yaml", 6))
        self.assertEqual(sorted(found), ["column", "file", "line", "notes", "remedy", "severity", "what"])

    def test_json_of_several_maps_is_one_line_each(self):
        done = self.coupler("check", "--json", self.file("bad.yaml", BAD), self.file("cell.yaml", GOOD))
        self.assertEqual([json.loads(line)["ok"] for line in done.stdout.splitlines()], [False, True])

    def test_json_stays_json_when_the_map_is_not_text(self):
        (self.folder / "cell.yaml").write_bytes(b"name: \xff\xfe\nmapping: {}\n")
        self.assertIn("ok", json.loads(self.coupler("check", "--json", "cell.yaml").stdout))


class Lock(Cli):
    def lock(self):
        """The lines behind the head of cell.yaml's lock."""
        text = (self.folder / "cell.yaml.lock").read_text(encoding="utf-8")
        return text.split("coupler lock 1\n")[1].splitlines()

    def test_check_gives_addresses_and_writes_them_down(self):
        done = self.coupler("check", self.file("cell.yaml", OPEN))
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("cell.yaml.lock: written; new addresses: 'lamp', 'horn'\ncell.yaml: ok: ", done.stdout)
        self.assertEqual(self.lock(), ["coils 0 lamp", "coils 1 horn"])
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["cell.yaml", "cell.yaml.lock"])

    def test_is_written_only_when_it_changes(self):
        self.coupler("check", self.file("cell.yaml", OPEN))
        os.utime(self.folder / "cell.yaml.lock", (1, 1))
        self.assertNotIn("written", self.coupler("check", "cell.yaml").stdout)
        self.assertEqual((self.folder / "cell.yaml.lock").stat().st_mtime, 1)

    def test_that_is_a_symbolic_link_stays_one(self):
        (self.folder / "kept").mkdir()
        (self.folder / "cell.yaml.lock").symlink_to("kept/lock")
        self.assertEqual(self.coupler("check", self.file("cell.yaml", OPEN)).returncode, 0)
        self.coupler("check", self.file("cell.yaml", OPEN + "    bell:\n"))
        self.assertTrue((self.folder / "cell.yaml.lock").is_symlink())
        self.assertEqual(self.lock(), ["coils 0 lamp", "coils 1 horn", "coils 2 bell"])
        self.assertEqual([path.name for path in (self.folder / "kept").iterdir()], ["lock"])

    def test_of_a_map_that_leaves_nothing_out_is_not_there(self):
        self.coupler("check", self.file("cell.yaml", GOOD))
        self.assertFalse((self.folder / "cell.yaml.lock").exists())

    def test_is_not_touched_for_a_bad_map(self):
        self.coupler("check", self.file("cell.yaml", OPEN + "    bell: 70000\n"))
        self.assertFalse((self.folder / "cell.yaml.lock").exists())

    def test_keeps_the_address_of_a_renamed_point_by_hand(self):
        self.coupler("check", self.file("cell.yaml", OPEN))
        self.file("cell.yaml", OPEN.replace("lamp", "light"))
        done = self.coupler("check", "cell.yaml", "--locked")
        self.assertIn("as 'lamp' in line 5\n", done.stderr)
        lock = (self.folder / "cell.yaml.lock").read_text(encoding="utf-8")
        self.file("cell.yaml.lock", lock.replace("lamp", "light"))
        self.assertEqual(self.coupler("check", "cell.yaml", "--locked").returncode, 0)

    def test_says_what_is_retired_and_how_a_renamed_point_keeps_its_address(self):
        self.coupler("check", self.file("cell.yaml", OPEN))
        done = self.coupler("check", self.file("cell.yaml", OPEN.replace("lamp", "light")))
        self.assertIn("written; new addresses: 'light'; retired: 'lamp'\n", done.stdout)
        self.assertIn("only renamed", done.stdout)
        self.assertEqual(self.lock(), ["coils 0 lamp retired", "coils 1 horn", "coils 2 light"])

    def test_locked_writes_nothing_and_names_the_points(self):
        done = self.coupler("check", "--locked", self.file("cell.yaml", OPEN))
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertRegex(done.stderr, r"^cell\.yaml:4:5: error: 'lamp' and 'horn' have no address, and there is no "
                                      r"cell\.yaml\.lock; run `coupler check cell\.yaml`.*\n")
        self.assertFalse((self.folder / "cell.yaml.lock").exists())

    def test_locked_fails_when_the_lock_is_stale(self):
        self.coupler("check", self.file("cell.yaml", OPEN))
        self.assertEqual(self.coupler("check", "--locked", "cell.yaml").returncode, 0)
        before = self.lock()
        done = self.coupler("check", "--locked", self.file("cell.yaml", OPEN.replace("    horn:\n", "")))
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertRegex(done.stderr, r"^cell\.yaml\.lock:6:1: error: .*'horn'.*; .+\n")
        self.assertEqual(self.lock(), before)

    def test_in_json_is_what_was_written(self):
        call = ("check", "--json", self.file("cell.yaml", OPEN))
        report = json.loads(self.coupler(*call).stdout)
        self.assertEqual(report["lock"],
                         {"file": "cell.yaml.lock", "allocated": ["lamp", "horn"], "retired": []})
        self.assertIsNone(json.loads(self.coupler(*call).stdout)["lock"])

    def test_that_is_broken_is_told_with_its_place(self):
        self.file("cell.yaml.lock", "coupler lock 1\ncoils 0 lamp\n=======\ncoils 0 horn\n")
        done = self.coupler("check", self.file("cell.yaml", OPEN))
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertRegex(done.stderr, r"(?m)^cell\.yaml\.lock:3:1: error: '=======' is the marker of a merge conflict")
        self.assertRegex(done.stderr, r"(?m)^cell\.yaml\.lock:4:1: error: .*'horn' overlaps .*'lamp' \(line 2\)")

    def test_that_cannot_be_read_is_told(self):
        (self.folder / "cell.yaml.lock").mkdir()
        done = self.coupler("check", self.file("cell.yaml", OPEN))
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertRegex(done.stderr, r"^cell\.yaml\.lock: error: .+; .+\n$")

    def test_that_cannot_be_written_is_told(self):
        name = "x" * 245 + ".yaml"  # the lock's name is as long as names can be; that of its draft is longer
        done = self.coupler("check", self.file(name, OPEN))
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertRegex(done.stderr, rf"^{name}\.lock: error: cannot write .+; .+\n$")

    def test_is_written_by_generate_unless_it_is_locked(self):
        call = ("generate", self.file("cell.yaml", OPEN), "--out", "out")
        self.assertEqual(self.coupler(*call, "--locked").returncode, 1)
        self.assertFalse((self.folder / "out").exists())
        done = self.coupler(*call)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(self.lock(), ["coils 0 lamp", "coils 1 horn"])
        self.assertEqual(self.coupler(*call, "--locked").returncode, 0)

    def test_is_needed_by_commands_that_only_read_the_map(self):
        done = self.coupler("plan", self.file("cell.yaml", OPEN))
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("run `coupler check cell.yaml`", done.stderr)
        self.coupler("check", "cell.yaml")
        self.assertEqual(self.coupler("plan", "cell.yaml").returncode, 0)


class Generate(Cli):
    def files(self):
        return {path.name: path.read_bytes() for path in (self.folder / "out").iterdir()}

    def test_makes_a_table_a_client_a_core_hooks_and_two_programs(self):
        done = self.coupler("generate", self.file("cell.yaml", GOOD), "--out", "out")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(sorted(self.files()), ["cell_client.cpp", "cell_client.hpp", "cell_core.hpp", "cell_driver.cpp",
                                                "cell_hooks.hpp", "cell_map.cpp", "cell_map.hpp", "cell_node.cpp"])

    def test_gives_the_same_bytes_anywhere(self):
        self.coupler("generate", self.file("cell.yaml", GOOD), "--out", "out")
        first = self.files()
        (self.folder / "elsewhere").mkdir()
        self.coupler("generate", str(self.folder / self.file("elsewhere/cell.yaml", GOOD)), "--out", "out")
        self.assertEqual(self.files(), first)
        for name, content in first.items():
            self.assertNotIn(str(self.folder).encode(), content, name)

    def test_says_what_it_wrote(self):
        call = ("generate", self.file("cell.yaml", GOOD), "--out", "out")
        self.assertEqual([line.split(": ")[1] for line in self.coupler(*call).stdout.splitlines()], ["written"] * 8)
        self.assertEqual([line.split(": ")[1] for line in self.coupler(*call).stdout.splitlines()], ["unchanged"] * 8)
        self.assertEqual(self.coupler(*call, "--quiet").stdout, "")

    def test_leaves_files_alone_that_would_not_change(self):
        self.coupler("generate", self.file("cell.yaml", GOOD), "--out", "out")
        os.utime(self.folder / "out/cell_map.cpp", (1, 1))
        self.coupler("generate", "cell.yaml", "--out", "out")
        self.assertEqual((self.folder / "out/cell_map.cpp").stat().st_mtime, 1)

    def test_calls_it_as_it_is_told(self):
        self.coupler("generate", self.file("cell.yaml", GOOD), "--out", "out", "--name", "press_2")
        self.assertIn(b"namespace coupler::maps::press_2 {", self.files()["press_2_map.hpp"])

    def test_refuses_a_name_that_cannot_be_one(self):
        for name in ("2nd", "a-b", "class"):
            done = self.coupler("generate", self.file("cell.yaml", GOOD), "--out", "out", "--name", name)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn(f"'{name}'", done.stderr)
            self.assertIn("--name", done.stderr)

    def test_asks_for_a_name_when_the_maps_own_cannot_be_one(self):
        done = self.coupler("generate", self.file("cell.yaml", GOOD.replace("cell", "hall/cell")), "--out", "out")
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("'hall/cell'", done.stderr)
        self.assertIn("--name", done.stderr)

    def test_makes_a_client_in_python_where_it_is_called(self):
        done = self.coupler("generate", self.file("cell.yaml", GOOD), "--python")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "cell_client.py: written\n", ""))
        self.assertIn("\nclass CellClient(Client):\n", (self.folder / "cell_client.py").read_text(encoding="utf-8"))

    def test_names_a_client_in_python_after_the_map(self):
        self.coupler("generate", self.file("cell.yaml", GOOD.replace("cell", "hall/cell")), "--python")
        self.assertIn("\nclass HallCellClient(", (self.folder / "hall_cell_client.py").read_text(encoding="utf-8"))
        self.coupler("generate", "cell.yaml", "--python", "--name", "class")  # a word of C++, and none of a file
        self.assertIn("\nclass ClassClient(", (self.folder / "class_client.py").read_text(encoding="utf-8"))
        done = self.coupler("generate", "cell.yaml", "--python", "--name", "2nd-cell")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("'2nd-cell'", done.stderr)
        self.assertIn("--name", done.stderr)

    def test_makes_one_thing_in_place_of_cpp(self):
        for other in ("--docs", "--vectors"):
            done = self.coupler("generate", self.file("cell.yaml", GOOD), "--python", other)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn("--python", done.stderr)

    def test_writes_nothing_for_a_bad_map(self):
        done = self.coupler("generate", self.file("cell.yaml", BAD), "--out", "out")
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("cell.yaml:6:", done.stderr)
        self.assertFalse((self.folder / "out").exists())

    def test_a_folder_that_cannot_be_made_is_a_wrong_call(self):
        self.file("out", "a file is in the way")
        done = self.coupler("generate", self.file("cell.yaml", GOOD), "--out", "out/deeper")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("out/deeper", done.stderr)
        self.assertIn("--out", done.stderr)


if __name__ == "__main__":
    unittest.main()
