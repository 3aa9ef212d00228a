# SPDX-License-Identifier: Apache-2.0
"""`coupler generate` as a script sees it. COUPLER is the program."""
import os
import unittest

from cli_test import BAD, GOOD, Cli


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

    def test_refuses_a_client_in_python_for_a_broadcast(self):
        broadcast = "name: all\nunit: 0\nserial: {device: /dev/ttyS0}\nmapping: {coils: {stop: {address: 0, access: write}}}\n"
        done = self.coupler("generate", self.file("all.yaml", broadcast), "--python")
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("unit 0 is a broadcast", done.stderr)

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
