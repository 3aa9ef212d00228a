# SPDX-License-Identifier: Apache-2.0
"""`coupler diff` as a script sees it; with git in a repository of its own. COUPLER is the program."""
import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

OLD = """\
name: cell
mapping:
  coils: {lamp: 0}
  holding_registers:
    speed: {address: 4, type: INT, units: rpm}
"""
BREAKING = OLD.replace("address: 4", "address: 5")
COMPATIBLE = OLD.replace("lamp: 0", "lamp: 0, horn: 1")
MEANING = OLD.replace("rpm", "a|b*")
DOCUMENTED = OLD.replace("units: rpm", "units: rpm, description: of the belt")


class Diff(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        # No repository around the temporary folder, and no configuration of the user, is to be found.
        self.environment = {**os.environ, "GIT_CEILING_DIRECTORIES": str(self.folder.parent), "LC_ALL": "C.UTF-8",
                            "GIT_CONFIG_GLOBAL": "/dev/null", "GIT_CONFIG_NOSYSTEM": "1"}
        for name, text in (("old", OLD), ("breaking", BREAKING), ("compatible", COMPATIBLE), ("meaning", MEANING),
                           ("documented", DOCUMENTED)):
            (self.folder / f"{name}.yaml").write_text(text, encoding="utf-8")

    def run_in_folder(self, *command):
        return subprocess.run(command, cwd=self.folder, env=self.environment, capture_output=True,
                              text=True, encoding="utf-8", check=False)

    def diff(self, *arguments):
        return self.run_in_folder(os.environ["COUPLER"], "diff", *arguments)

    def git(self, *arguments):
        done = self.run_in_folder("git", "-c", "user.name=t", "-c", "user.email=t@t", *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)


class TheStatus(Diff):
    def test_is_0_without_a_difference(self):
        done = self.diff("old.yaml", "old.yaml", "--fail-on", "documentation")
        self.assertEqual((done.returncode, done.stdout), (0, "old.yaml -> old.yaml: no difference\n"))

    def test_is_1_from_the_class_of_fail_on(self):
        classes = ("breaking", "meaning", "compatible", "documentation")  # the worst first
        for worst, new in enumerate(("breaking", "meaning", "compatible", "documented")):
            for at, fail_on in enumerate(classes):
                done = self.diff("old.yaml", f"{new}.yaml", "--fail-on", fail_on)
                self.assertEqual(done.returncode, int(worst <= at), (new, fail_on))

    def test_fails_on_another_meaning_by_default(self):
        self.assertEqual(self.diff("old.yaml", "breaking.yaml").returncode, 1)
        self.assertEqual(self.diff("old.yaml", "meaning.yaml").returncode, 1)
        self.assertEqual(self.diff("old.yaml", "compatible.yaml").returncode, 0)

    def test_is_2_for_a_wrong_call(self):
        for arguments in (["old.yaml"], ["old.yaml", "old.yaml", "--format", "xml"],
                          ["old.yaml", "old.yaml", "--fail-on", "anything"], ["old.yaml", "tcp://x:0"]):
            self.assertEqual(self.diff(*arguments).returncode, 2, arguments)

    def test_is_1_for_a_map_that_is_not_there(self):
        done = self.diff("old.yaml", "none.yaml")
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("none.yaml", done.stderr)


class TheReport(Diff):
    def test_as_text_has_a_line_a_change(self):
        self.assertEqual(self.diff("old.yaml", "breaking.yaml").stdout,
                         "breaking       address-moved            speed: 4 -> 5\n"
                         "old.yaml -> breaking.yaml: 1 breaking, 0 meaning, 0 compatible, 0 documentation\n")

    def test_as_json_names_class_rule_and_point(self):
        report = json.loads(self.diff("old.yaml", "breaking.yaml", "--format", "json").stdout)
        self.assertEqual(report, {"old": "old.yaml", "new": "breaking.yaml", "worst": "breaking",
                                  "changes": [{"class": "breaking", "rule": "address-moved", "point": "speed",
                                               "old": "4", "new": "5"}]})

    def test_as_markdown_is_a_table_that_no_text_breaks(self):
        said = self.diff("old.yaml", "meaning.yaml", "--format", "markdown").stdout
        self.assertIn("| speed | units-changed | rpm | a\\|b\\* |", said)


class ARevision(Diff):
    def test_is_compared(self):
        self.git("init", "-q")
        (self.folder / "map.yaml").write_text(OLD, encoding="utf-8")
        self.git("add", "map.yaml")
        self.git("commit", "-q", "-m", "one")
        (self.folder / "map.yaml").write_text(BREAKING, encoding="utf-8")
        (self.folder / "map").write_text(OLD, encoding="utf-8")
        self.git("add", "map")
        self.git("commit", "-q", "-m", "a name without an ending")
        self.assertEqual(self.diff("HEAD:map", "map").stdout, "HEAD:map -> map: no difference\n")
        done = self.diff("HEAD:map.yaml", "map.yaml")
        self.assertEqual((done.returncode, done.stderr), (1, ""))
        self.assertIn("address-moved", done.stdout)

    def test_brings_its_own_lock(self):
        self.git("init", "-q")
        (self.folder / "map.yaml").write_text("name: cell\nmapping:\n  coils:\n    lamp:\n", encoding="utf-8")
        self.assertEqual(self.run_in_folder(os.environ["COUPLER"], "check", "map.yaml").returncode, 0)
        self.git("add", "map.yaml", "map.yaml.lock")
        self.git("commit", "-q", "-m", "one")
        (self.folder / "map.yaml.lock").unlink()
        (self.folder / "map.yaml").write_text("name: cell\nmapping:\n  coils:\n    lamp: 0\n", encoding="utf-8")
        done = self.diff("HEAD:map.yaml", "map.yaml", "--fail-on", "documentation")
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_that_is_not_there_is_an_error_with_what_git_says(self):
        self.git("init", "-q")
        done = self.diff("nowhere:map.yaml", "old.yaml")
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("nowhere:map.yaml: error: git: ", done.stderr)
        self.assertIn("write REVISION:PATH", done.stderr)

    def test_outside_a_repository_is_an_error(self):
        done = self.diff("HEAD:map.yaml", "old.yaml")
        self.assertEqual(done.returncode, 1)
        self.assertIn("not a git repository", done.stderr)

    def test_is_no_option_of_git(self):
        self.git("init", "-q")
        done = self.diff("--", "--output=stolen:x", "old.yaml")
        self.assertEqual(done.returncode, 1)
        self.assertFalse((self.folder / "stolen:x").exists())


if __name__ == "__main__":
    unittest.main()
