# SPDX-License-Identifier: Apache-2.0
"""The program `coupler` as a script sees it: exit status, output, files. COUPLER is the program."""
import contextlib
import json
import os
import pty
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


@unittest.skipIf(os.environ["LIVE"] == "1", "built with libmodbus")
class WithoutLibmodbus(Cli):
    def test_commands_that_need_a_device_say_what_to_install(self):
        for command in "dump", "fetch", "pin", "probe", "record", "status":
            with self.subTest(command):
                done = self.coupler(command, "cell.yaml", "--at", "localhost")
                self.assertEqual(done.returncode, 3)
                self.assertRegex(done.stderr, "built without .*libmodbus; install .*libmodbus-dev and build it again\n")

    def test_a_map_of_a_node_cannot_be_fetched(self):
        done = self.coupler("check", "tcp://localhost")
        self.assertEqual(done.returncode, 3)
        self.assertIn("built without libmodbus and cannot ask a device; install libmodbus-dev", done.stderr)


class StandardOutput(Cli):
    def into_a_full_disk(self, *arguments):
        with open("/dev/full", "w", encoding="utf-8") as full:
            done = subprocess.run([os.environ["COUPLER"], *arguments], cwd=self.folder, stdout=full, stderr=subprocess.PIPE,
                                  text=True, check=False)
        self.assertEqual(done.returncode, 2, arguments)
        self.assertIn("cannot write standard output: No space left on device", done.stderr)

    def test_that_takes_nothing_is_an_error(self):
        file = self.file("cell.yaml", GOOD)
        for arguments in (["export", file, "--to", "csv"], ["schema"], ["plan", file], ["plan", file, "--json"], ["check", file],
                          ["check", file, "--json"], ["generate", file, "--python", "--out", "-"],
                          ["generate", file, "--vectors", "--out", "-"], ["diff", file, file], ["export", "--list"], ["--help"]):
            with self.subTest(arguments):
                self.into_a_full_disk(*arguments)

    def test_has_all_of_a_text_with_a_NUL(self):
        file = self.file("nul.yaml", GOOD.replace("{address: 0, type: REAL}", '{address: 0, type: REAL, description: "x\\0y"}\n'
                                                  "    later: {address: 2, type: REAL}"))
        done = self.coupler("export", file, "--to", "csv")
        self.assertIn("x\0y", done.stdout)
        self.assertIn("later", done.stdout)

    def test_on_a_terminal_shows_what_a_terminal_would_obey(self):
        file = self.file("cell.yaml", GOOD.replace("{address: 0, type: REAL}",
                                                   '{address: 0, type: REAL, description: "\\e]0;owned\\a"}'))
        reader, terminal = pty.openpty()
        subprocess.run([os.environ["COUPLER"], "export", file, "--to", "csv"], cwd=self.folder, stdout=terminal, check=True,
                       stderr=subprocess.DEVNULL)
        os.close(terminal)
        shown = b""
        with contextlib.suppress(OSError):  # the other end is closed
            while more := os.read(reader, 1 << 16):
                shown += more
        os.close(reader)
        self.assertNotIn(b"\x1b", shown)
        self.assertIn(b"\\x1b]0;owned\\x07", shown)


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
        said = self.refused("check", "map.yaml", "--nope")
        self.assertIn("--nope", said)
        self.assertRegex(said, r"\(this is coupler \d+\.\d+\.\d+, and a newer one may know it\)")

    def test_with_a_slip_in_a_command_proposes_the_near_one(self):
        self.assertIn("'dmp' is not a command; did you mean 'dump'?", self.refused("dmp", "map.yaml"))

    @unittest.skipUnless(os.environ["LIVE"] == "1", "built without libmodbus")
    def test_with_a_slip_in_an_option_proposes_the_near_one(self):
        self.assertIn("not expected: --wacth 2; did you mean --watch?", self.refused("dump", "map.yaml", "--wacth", "2"))
        self.assertIn("not expected: --wacth=2; did you mean --watch?", self.refused("dump", "map.yaml", "--wacth=2"))
        self.assertIn("not expected: --unit 3; did you mean --at, which has the UNIT?",
                      self.refused("dump", "map.yaml", "--unit", "3"))

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

    def test_it_replaces_another_schema_and_nothing_else(self):
        self.file("s.json", '{"$schema": "http://json-schema.org/draft-07/schema#"}')
        self.assertEqual(self.coupler("schema", "--out", "s.json").returncode, 0)
        self.assertEqual((self.folder / "s.json").read_text(encoding="utf-8"), self.coupler("schema").stdout)
        name = self.file("cell.yaml", GOOD)
        done = self.coupler("schema", "--out", name)
        self.assertEqual(done.returncode, 2)
        self.assertIn(f"{name} is there, and it is no JSON Schema; name another file with --out", done.stderr)
        self.assertEqual((self.folder / name).read_text(encoding="utf-8"), GOOD)

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

    def test_the_margin_that_moveit_needs_is_told(self):
        text = GOOD.replace("mapping:", "tools: {press: {close: lamp, travel: 1s, timeout: 1500ms, joint: ram}}\nmapping:")
        self.assertIn("  for MoveIt: allowed_goal_duration_margin: 6 or more (four times the longest timeout)\n",
                      self.coupler("check", self.file("cell.yaml", text)).stdout)

    def test_tools_are_counted(self):
        text = GOOD.replace("mapping:", "tools: {press: {close: lamp, travel: 1s}}\nmapping:")
        self.assertIn(" 1 input register), 1 tool, fingerprint ", self.coupler("check", self.file("cell.yaml", text)).stdout)

    def test_axes_are_counted(self):
        text = GOOD.replace("mapping:", "axes: {glue: {point: lamp}}\nmapping:")
        self.assertIn(" 1 input register), 1 axis, fingerprint ", self.coupler("check", self.file("cell.yaml", text)).stdout)

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


class OutDash(Cli):
    """`--out -`."""

    def writes(self, *command):
        """The standard output; nothing else is written."""
        before = sorted(self.folder.iterdir())
        done = self.coupler(*command, "--out", "-")
        self.assertEqual((done.returncode, sorted(self.folder.iterdir())), (0, before), done.stderr)
        return done.stdout

    def test_is_where_a_command_writes_without_out_too(self):
        cell, table = self.file("cell.yaml", GOOD), self.file("points.csv", "table,name,address\ncoils,lamp,0\n")
        for command in (("export", cell, "--to", "csv"), ("import", "csv", table), ("schema",)):
            written = self.writes(*command)
            self.assertGreater(len(written), 20)
            self.assertEqual(written, self.coupler(*command).stdout)

    def test_gets_a_first_map(self):
        self.file("press.yaml", "is not replaced")
        self.assertIn("-: ok: press, ", self.coupler("check", "-", stdin=self.writes("init", "press")).stdout)

    def test_gets_what_is_generated_as_one_file(self):
        name = self.file("cell.yaml", GOOD)
        for what, file in (("--python", "cell_client.py"), ("--vectors", "cell_vectors.json")):
            written = self.writes("generate", name, what)
            self.coupler("generate", name, what)
            self.assertEqual(written, (self.folder / file).read_text(encoding="utf-8"))

    def test_gets_nothing_but_the_file(self):
        done = self.coupler("generate", self.file("cell.yaml", OPEN), "--vectors", "--out", "-")
        json.loads(done.stdout)
        self.assertIn("cell.yaml.lock: written", done.stderr)

    def test_does_not_get_several_files(self):
        name = self.file("cell.yaml", OPEN)
        table = self.file("bus.csv", "unit,table,name,address\n1,coils,lamp,0\n2,coils,horn,0\n")
        for command in (("generate", name), ("generate", name, "--docs"), ("import", "csv", table)):
            done = self.coupler(*command, "--out", "-")
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn("several", done.stderr)
            self.assertIn("--out", done.stderr)
        self.assertFalse((self.folder / "cell.yaml.lock").exists())


if __name__ == "__main__":
    unittest.main()
