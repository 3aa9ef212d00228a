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
        name = self.file("g.csv", 'Name,Table,Address,Type,"Gain, SF",Range\nspeed,HR,1,INT,10,100\n')
        done = self.coupler("import", "csv", name, "--columns", 'scale="Gain, SF",ignore=Range', "--columns", "name=Name")
        self.assertEqual((done.stderr, done.stdout.split("\n", 1)[1]),
                         ("", "name: g\nmapping:\n  holding_registers:\n    speed: {address: 1, type: INT, scale: 10}\n"))
        self.assertIn("is not a list of columns; write it as in", self.coupler("import", "csv", name, "--columns", "x").stderr)
        self.assertIn("are for tables", self.coupler("import", "origin", name, "--columns", "name=x").stderr)

    def test_asks_for_what_a_makers_list_leaves_open_and_takes_the_answer(self):
        units = self.file("units.csv", "name,table,data type,register,unit\nPV1_Voltage,input_registers,ushort,1,0.1V\n"
                                       "Grid_Hz,input_registers,ushort,15,0.01Hz\n")
        done = self.coupler("import", "csv", units, "--name", "m")
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("units.csv:2:38: error: the units '0.1V' have two meanings", done.stderr)
        self.assertIn("(1 more asks the same)", done.stderr)
        done = self.coupler("import", "csv", units, "--name", "m", "--columns", "scaled_units=unit")
        self.assertIn("PV1_Voltage: {type: UINT, address: 1, units: V, scale: 0.1}\n", done.stdout)
        huawei = self.file("huawei.csv", "Signal name,Table,R/W,Type,Unit,Gain,Address,Quantity\nLine voltage,HR,RO,U16,V,10,32066,1\n"
                                         "Active power,HR,RO,I32,kW,1000,32080,2\nSet power,HR,RW,I32,kW,1000,40120,2\n")
        self.assertIn("error: 'Gain' has two meanings", self.coupler("import", "csv", huawei).stderr)
        done = self.coupler("import", "csv", huawei, "--columns", "divisor=Gain")
        self.assertIn("huawei.csv:3:20: error: 'I32' has several registers, and the table does not say", done.stderr)
        done = self.coupler("import", "csv", huawei, "--columns", "divisor=Gain", "--order", "ABCD")
        self.assertRegex(done.stdout, r"Active_power: \{access: read, type: DINT, units: kW, scale: 0\.001, address: 32080, order: ABCD")
        strings = self.file("s.csv", "name,table,address,type\nlabel,hr,1,string[6]\n")
        self.assertIn("s.csv:2:12: error: 'string[6]' has two meanings", self.coupler("import", "csv", strings).stderr)
        self.assertIn("length: 12}", self.coupler("import", "csv", strings, "--strings", "registers").stdout)
        for option in (("--order", "ABCD"), ("--strings", "registers")):
            self.assertIn("are for tables", self.coupler("import", "origin", strings, *option).stderr)

    def test_takes_the_addresses_of_an_opc_server(self):
        name = self.file("oven.csv", "Tag Name,Address,Data Type,Respect Data Type,Client Access,Scaling,Raw Low,Raw High,Scaled Low,Scaled High,Eng Units\n"
                                     '"Temp1","400001",Short,1,RO,Linear,0,1000,0,100,"C"\n"Power","400010",Float,1,R/W,,,,,,\n'
                                     '"Flags","400020",Word,1,RO,,,,,,\n"Alarm","400020.03",Boolean,1,RO,,,,,,\n'
                                     '"Name","400030.20H",String,1,R/W,,,,,,\n"Profile","400060 [8]",Short Array,1,R/W,,,,,,\n'
                                     '"Valve","000005",Boolean,1,R/W,,,,,,\n"Door","100007",Boolean,1,RO,,,,,,\n')
        done = self.coupler("import", "csv", name, "--name", "oven", "--addressing", "modicon", "--order", "CDAB")
        self.assertEqual(done.returncode, 0, done.stderr)
        for line in ("Temp1: {address: 400001, type: INT, access: read, units: C, scale: {raw: [0, 1000], value: [0, 100]}}",
                     "Alarm: {address: 400020, type: BOOL, access: read, bit: 3}", "Door: {address: 100007, access: read}",
                     "Name: {address: 400030, type: STRING, access: read_write, length: 20, order: AB}",
                     "Profile: {address: 400060, type: INT, access: read_write, count: 8}"):
            self.assertIn(line, done.stdout)
        name = self.file("addresses.csv", "name,address,type\na,400020.03,INT\nb,4x00021,INT\nc,%MW20,INT\nd,40001-40003,DINT\ne,,INT\n")
        done = self.coupler("import", "csv", name, "--addressing", "modicon", "--order", "CDAB")
        for told in ("2:3: error: '400020.03' is not a Modicon number; a bit is type: BOOL, bit: 3 at 400020", "4:3: error: '%MW20' is a variable",
                     "5:3: error: '40001-40003' says 3 registers, but the point has 2", "6:3: error: the point has no address"):
            self.assertIn(told, done.stderr)

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

    def test_to_home_assistant_and_back_keeps_a_serial_line_and_rtu_over_tcp(self):
        points = "mapping:\n  coils: {lamp: 0}\n"
        for where in ("serial: {device: /dev/ttyUSB0, baud: 9600, parity: none, stop_bits: 2}\n",
                      "address: 10.0.0.7\nport: 4196\nframing: rtu\n"):
            name = self.file("cell.yaml", f"name: cell\n{where}unit: 17\n{points}")
            self.coupler("export", name, "--to", "home-assistant", "--out", "configuration.yaml")
            done = self.coupler("import", "home-assistant", "configuration.yaml")
            self.assertEqual(done.returncode, 0, done.stderr)
            for line in (*where.splitlines(), "unit: 17", "timeout: 0.5", "    lamp: 0"):
                self.assertIn(f"{line}\n", done.stdout)
            self.assertNotIn("Modbus/TCP", done.stderr)

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

    def test_refuses_a_program_without_tls_where_it_could_read_nothing(self):
        def secured(plain):
            return self.file(f"{plain}.yaml", "name: cell\nsecurity: {roles: {viewer: {read: all}, maker: {write: all}}, plain: " + plain +
                             "}\nmapping: {coils: {lamp: 0}}\n")
        for kind in ("telegraf", "home-assistant", "st"):
            done = self.coupler("export", secured("none"), "--to", kind)
            self.assertEqual((done.returncode, done.stdout), (1, ""))
            self.assertIn(f"'security' lets no client without TLS read anything, and '{kind}' is for a program that has no TLS; "
                          "give such clients a role that may read", done.stderr)
            self.assertEqual(self.coupler("export", secured("viewer"), "--to", kind).returncode, 0)
        for kind in ("csv", "wireshark"):
            self.assertEqual(self.coupler("export", secured("none"), "--to", kind).returncode, 0)

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
