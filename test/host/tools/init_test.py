# SPDX-License-Identifier: Apache-2.0
"""`coupler init`: a first map. COUPLER is the program."""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

PRESETS = ("wago_750", "beckhoff_bk9000", "moxa_e1200", "plc", "robotiq_2f", "waveshare_io_8ch")
KINDS = ((), ("--node",), *(("--preset", name) for name in PRESETS))


class Init(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def coupler(self, *arguments):
        return subprocess.run([os.environ["COUPLER"], *arguments], cwd=self.folder, capture_output=True,
                              text=True, encoding="utf-8", check=False)

    def test_writes_a_map_that_check_takes_without_a_word(self):
        for kind in KINDS:
            with self.subTest(kind):
                done = self.coupler("init", "press", "--force", *kind)
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                checked = self.coupler("check", "press.yaml")
                self.assertEqual((checked.returncode, checked.stderr), (0, ""))
                self.assertRegex(checked.stdout, "press.yaml: ok: press, [3-6] points")

    def test_names_the_schema_that_it_writes_beside_it(self):
        self.coupler("init", "press")
        first = (self.folder / "press.yaml").read_text(encoding="utf-8").splitlines()[0]
        self.assertEqual(first, "# yaml-language-server: $schema=map.schema.json")
        self.assertEqual((self.folder / "map.schema.json").read_text(encoding="utf-8"), self.coupler("schema").stdout)

    def test_says_what_the_map_is_told_of_the_device(self):
        self.coupler("init", "press", "--preset", "plc", "--address", "plc-7.local")
        text = (self.folder / "press.yaml").read_text(encoding="utf-8")
        for line in ("name: press", "address: plc-7.local", "preset: plc"):
            self.assertIn(line, text)

    def test_a_preset_is_found_by_the_makers_name(self):
        for model, preset in (("750-352", "wago_750"), ("WAGO 750-8212", "wago_750"), ("BK9050", "beckhoff_bk9000"),
                              ("ioLogik E1212", "moxa_e1200"), ("2F-85", "robotiq_2f"), ("Hand-E", "robotiq_2f"),
                              ("Modbus RTU IO 8CH", "waveshare_io_8ch"), ("plc", "plc")):
            self.assertEqual(self.coupler("init", "press", "--force", "--preset", model).returncode, 0)
            self.assertIn(f"preset: {preset} ", (self.folder / "press.yaml").read_text(encoding="utf-8"))
        (self.folder / "other.yaml").write_text("name: other\npreset: 750-352\nmapping: {coils: {a: 0}}\n")
        self.assertIn("write 'wago_750', which covers this model", self.coupler("check", "other.yaml").stderr)

    def test_addresses_may_be_the_numbers_of_manuals(self):
        for kind in KINDS:
            with self.subTest(kind):
                prints = []
                for addressing in ("zero_based", "modicon"):
                    self.coupler("init", "press", "--force", "--addressing", addressing, *kind)
                    prints.append(self.coupler("check", "press.yaml").stdout)
                self.assertRegex(prints[0], "fingerprint [0-9a-f]{16}")
                self.assertEqual(*prints)
        self.coupler("init", "press", "--force", "--addressing", "modicon")
        text = (self.folder / "press.yaml").read_text(encoding="utf-8")
        for part in ("addressing: modicon", "valve: {address: 00001,", "door: 10001 ", "pressure: {address: 30001,",
                     "speed: {address: 40001,"):
            self.assertIn(part, text)

    def test_a_coupler_on_a_serial_line_has_a_port_unless_an_address_is_given(self):
        for kind, line in ((), "serial: {device: /dev/ttyUSB0}"), (("--address", "gateway"), "address: gateway"):
            self.coupler("init", "grip", "--force", "--preset", "robotiq_2f", *kind)
            text = (self.folder / "grip.yaml").read_text(encoding="utf-8")
            self.assertIn(line, text)
            self.assertNotIn("serial:" if kind else "address: 1", text)

    def test_replaces_a_map_only_if_told_to(self):
        (self.folder / "press.yaml").write_text("mine")
        done = self.coupler("init", "press")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--force", done.stderr)
        self.assertEqual((self.folder / "press.yaml").read_text(), "mine")
        self.assertEqual(self.coupler("init", "press", "--force").returncode, 0)

    def test_refuses_what_no_map_can_say_and_writes_nothing(self):
        for arguments, word in ((("2nd one",), "name"), (("press", "--preset", "wago"), "write one of beckhoff_bk9000")):
            done = self.coupler("init", *arguments)
            self.assertEqual(done.returncode, 1)
            self.assertIn(word, done.stderr)
        self.assertEqual(self.coupler("init", "cell", "--node", "--preset", "plc").returncode, 2)
        self.assertEqual(self.coupler("init", "press", "--out", "no/such/press.yaml").returncode, 2)
        self.assertEqual(list(self.folder.iterdir()), [])


if __name__ == "__main__":
    unittest.main()
