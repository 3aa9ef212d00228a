# SPDX-License-Identifier: Apache-2.0
"""`coupler import` and `coupler export` as a script sees them. COUPLER is the program."""
import unittest

from cli_test import Cli

CSV = "unit,table,name,address,type\n1,coils,lamp,0,\n2,holding_registers,speed,1,INT\n"
ONE = "table,name,address\ncoils,lamp one,0\n"
MAP = "name: cell\nport: 1502\nmapping:\n  coils: {lamp: 0}\n  holding_registers:\n    speed: {address: 0, type: REAL}\n"


class Import(Cli):
    def test_writes_the_map_to_standard_output_and_the_report_to_standard_error(self):
        done = self.coupler("import", "csv", "-", "--name", "press", stdin=ONE)
        self.assertEqual(done.returncode, 0)
        self.assertEqual(done.stdout, "# Imported from <stdin> by `coupler import csv`.\nname: press\nmapping:\n"
                                      "  coils:\n    lamp_one: {address: 0, description: \"lamp one\"}\n")
        self.assertIn("<stdin>:2:7: warning: 'lamp one' is not a valid name of a point", done.stderr)

    def test_writes_a_file_that_check_takes(self):
        done = self.coupler("import", "csv", self.file("a.csv", ONE), "--out", "a.yaml")
        self.assertRegex(done.stdout, r"^a\.yaml: ok: a, 1 point \(1 coil\), fingerprint [0-9a-f]{16}\n$")
        self.assertEqual(self.coupler("check", "a.yaml").returncode, 0)

    def test_gives_every_unit_a_file_or_the_one_that_was_chosen(self):
        name = self.file("bus.csv", CSV)
        done = self.coupler("import", "csv", name)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("bus.csv has several units: 1, 2; choose one with --unit", done.stderr)
        self.assertEqual(self.coupler("import", "csv", name, "--out", "bus.yaml").returncode, 0)
        self.assertEqual(sorted(p.name for p in self.folder.glob("*.yaml")), ["bus_1.yaml", "bus_2.yaml"])
        self.assertIn("name: bus_2\nunit: 2\n", self.coupler("import", "csv", name, "--unit", "2").stdout)

    def test_replaces_no_other_map_unless_it_is_forced(self):
        name = self.file("a.csv", ONE)
        (self.folder / "a.yaml").write_text("name: mine\nmapping: {coils: {a: 0}}\n", encoding="utf-8")
        done = self.coupler("import", "csv", name, "--out", "a.yaml")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("a.yaml is already there; name another file with --out, or replace it with --force", done.stderr)
        self.assertIn("name: mine", (self.folder / "a.yaml").read_text(encoding="utf-8"))
        for arguments in (("--force",), ()):  # what is the same may be written again
            self.assertEqual(self.coupler("import", "csv", name, "--out", "a.yaml", *arguments).returncode, 0)

    def test_takes_the_headings_and_addresses_of_a_manual(self):
        name = self.file("m.csv", "Tag no.,Modbus,Data Type\nspeed,40002,INT\n")
        done = self.coupler("import", "csv", name, "--addressing", "modicon", "--columns", "name=Tag no.,address=Modbus")
        self.assertEqual(done.stdout.split("\n", 1)[1], "name: m\naddressing: modicon\nmapping:\n  holding_registers:\n"
                                                        "    speed: {address: 40002, type: INT}\n")
        self.assertIn("is not a list of columns; write it as in", self.coupler("import", "csv", name, "--columns", "x").stderr)
        self.assertIn("are for tables", self.coupler("import", "origin", name, "--columns", "name=x").stderr)

    def test_takes_one_device_of_a_file_with_several(self):
        name = self.file("configuration.yaml", "modbus:\n" + "".join(
            f"  - {{name: {hub}, type: tcp, host: plc, port: 502, binary_sensors: [{{name: door, address: 1}}]}}\n" for hub in ("a", "b")))
        self.assertIn("the file has several hubs: a, b; give one of them with --device", self.coupler("import", "home-assistant", name).stderr)
        self.assertIn("name: b\n", self.coupler("import", "home-assistant", name, "--device", "b").stdout)
        done = self.coupler("import", "csv", self.file("a.csv", ONE), "--device", "b")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("--device is for files that may have several; leave it out", done.stderr)

    def test_refuses_what_it_cannot_read_and_writes_nothing(self):
        done = self.coupler("import", "unslave", self.file("a.json", "{"), "--out", "a.yaml")
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("a.json:1:1: error: ", done.stderr)
        self.assertFalse((self.folder / "a.yaml").exists())
        for file in ("none.csv", "."):
            done = self.coupler("import", "csv", file)
            self.assertEqual((done.returncode, done.stdout), (1, ""))
            self.assertIn(f"{file}: error: the file cannot be read: ", done.stderr)

    def test_refuses_an_unknown_format_with_those_that_there_are(self):
        done = self.coupler("import", "winmodbus", self.file("a.csv", ONE))
        self.assertEqual(done.returncode, 2)
        self.assertIn("'winmodbus' is not a format that can be read; give one of csv, origin, unslave", done.stderr)
        self.assertIn("FORMAT and FILE are required", self.coupler("import").stderr)

    def test_refuses_a_file_that_is_too_large(self):
        (self.folder / "big.csv").write_bytes(b"x" * (20 << 20))
        done = self.coupler("import", "csv", "big.csv")
        self.assertEqual(done.returncode, 1)
        self.assertIn("big.csv: error: the file has 16777217 bytes, but a map may have at most 16777216", done.stderr)

    def test_lists_its_formats(self):
        done = self.coupler("import", "--list")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("unslave", done.stdout)


class Export(Cli):
    def test_and_import_again_is_the_same_map(self):
        name = self.file("cell.yaml", MAP)
        done = self.coupler("export", name, "--to", "csv", "--out", "cell.csv")
        self.assertEqual((done.returncode, done.stdout), (0, ""))
        self.assertIn("cell.yaml: warning: the table has points only, the device's keys are left out: name, port", done.stderr)
        self.coupler("import", "csv", "cell.csv", "--out", "again.yaml")
        fingerprints = {self.coupler("check", file).stdout.split()[-1] for file in (name, "again.yaml")}
        self.assertEqual(len(fingerprints), 1, fingerprints)

    def test_refuses_a_wrong_map_an_unknown_format_and_a_place_where_it_may_not_write(self):
        self.assertEqual(self.coupler("export", self.file("bad.yaml", "x"), "--to", "csv").returncode, 1)
        name = self.file("cell.yaml", MAP)
        done = self.coupler("export", name, "--to", "excel")
        self.assertEqual(done.returncode, 2)
        self.assertIn("'excel' is not a format that can be written; give one of csv", done.stderr)
        self.assertEqual(self.coupler("export", name, "--to", "csv", "--out", "no/where.csv").returncode, 2)
        done = self.coupler("export", name, "--to", "csv", "--out", f"./{name}")
        self.assertEqual(done.returncode, 2)
        self.assertIn(f"./{name} is the map itself; name another file with --out", done.stderr)
        self.assertIn("MAP and --to FORMAT are required", self.coupler("export", name).stderr)

    def test_adds_a_nodes_statistics_where_the_format_has_a_place_for_them(self):
        name = self.file("cell.yaml", MAP)
        self.assertIn('measurement = "cell_node"', self.coupler("export", name, "--to", "telegraf", "--node-statistics").stdout)
        done = self.coupler("export", name, "--to", "csv", "--node-statistics")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("--node-statistics has no meaning for 'csv'; leave it out", done.stderr)
        name = self.file("foreign.yaml", "name: f\nmapping: {input_registers: {a: {address: 0xFF00, type: INT}}}\n")
        done = self.coupler("export", name, "--to", "telegraf", "--node-statistics")
        self.assertNotIn("f_node", done.stdout)
        self.assertIn("the map has points where a node has its statistics, so those are left out", done.stderr)

    def test_lists_its_formats(self):
        self.assertIn("csv ", self.coupler("export", "--list").stdout)


if __name__ == "__main__":
    unittest.main()
