# SPDX-License-Identifier: Apache-2.0
"""The lock that `coupler check` and `coupler generate` write beside a map. COUPLER is the program."""
import json
import os
import unittest

from cli_test import GOOD, OPEN, Cli


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


if __name__ == "__main__":
    unittest.main()
