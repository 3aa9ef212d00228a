# SPDX-License-Identifier: Apache-2.0
"""What `coupler dump` refuses. What it reads is tried on devices, by test/peers/dump_test.py."""
import os
import socket
import subprocess
import tempfile
import unittest
from pathlib import Path

PATIENCE = 120  # seconds; no rule, only reached when something is broken
MAP = """\
name: cell
mapping:
  coils: {lamp: 0}
"""


class Dump(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        (self.folder / "cell.yaml").write_text(MAP, encoding="utf-8")

    def dump(self, *arguments):
        return subprocess.run([os.environ["COUPLER"], "dump", *arguments], cwd=self.folder,
                              capture_output=True, text=True, encoding="utf-8", check=False, timeout=PATIENCE)

    def refused(self, status, what, *arguments):
        done = self.dump(*arguments)
        self.assertEqual(done.returncode, status, done.stderr)
        self.assertIn(what, done.stderr)
        self.assertEqual(done.stdout, "")

    def test_a_map_without_address_needs_at(self):
        self.refused(2, "cell.yaml does not say where the device is; give --at HOST[:PORT][/UNIT]", "cell.yaml")

    def test_what_is_neither_a_file_nor_a_device_is_told_as_both(self):
        with socket.socket() as place:
            place.bind(("127.0.0.1", 0))  # not listening
            port = place.getsockname()[1]
            self.refused(3, f"localhost:{port}: error: no such file, and as a device: localhost port {port}: Connection refused; ",
                         f"localhost:{port}")
            self.refused(3, f"127.0.0.1:{port}: error: 127.0.0.1 port {port}: Connection refused; ", f"127.0.0.1:{port}")
        self.refused(2, "cell:0: error: no such file, and as a device: the port '0' is not 1 to 65535; write tcp://", "cell:0")
        self.refused(2, "a b: error: no such file, and as a device: the host 'a b' is not a host name; ", "a b")
        self.refused(3, "/dev/ttyUSB77: error: /dev/ttyUSB77: ", "/dev/ttyUSB77")

    def test_a_slip_in_the_ending_of_a_map_is_told_with_the_map(self):
        self.refused(2, "; or give the path of a map; did you mean cell.yaml?\n", "cell,yaml")

    def test_what_has_the_name_of_a_file_is_no_device(self):
        missing = "error: the file cannot be read: No such file or directory; give the path of a map"
        for file in ("press.yaml", "press.yml", "press.json", "./press", "maps/press", ""):
            self.refused(1, f"{file}: {missing}\n", file)
        device = "error: it is a device, not a file; give the path of a map, or - for standard input"
        self.refused(1, f"/dev/null: {device}\n", "/dev/null")

    def test_a_wrong_place_is_said(self):
        self.refused(2, "--at: the port '0' is not 1 to 65535; write tcp://HOST", "cell.yaml", "--at", "cell:0")
        self.refused(2, "--at: the unit id '256'", "cell.yaml", "--at", "tcp://cell/256")

    def test_a_pattern_has_to_match_a_point(self):
        self.refused(2, "no point matches 'lmap'; did you mean 'lamp'?",
                     "cell.yaml", "--at", "localhost", "--points", "la*,lmap")
        self.refused(2, "no point matches 'xyz*'; `coupler export cell.yaml --to csv` lists their names",
                     "cell.yaml", "--at", "localhost", "--points", "la*,xyz*")

    def test_a_period_is_a_number_of_seconds(self):
        self.refused(2, "--watch", "cell.yaml", "--at", "localhost", "--watch", "often")
        self.refused(2, "--watch", "cell.yaml", "--at", "localhost", "--watch", "0")

    def test_a_wrong_map_is_no_reason_to_ask_a_device(self):
        (self.folder / "cell.yaml").write_text("name: cell\nmapping: {coils: {lamp: -1}}\n", encoding="utf-8")
        self.refused(1, "cell.yaml:2:", "cell.yaml", "--at", "localhost")

    def test_a_device_that_is_not_there_is_a_failure(self):
        with socket.socket() as place:
            place.bind(("127.0.0.1", 0))
            where = f"127.0.0.1:{place.getsockname()[1]}"
            self.refused(3, f"tcp://{where}/1: ", "cell.yaml", "--at", where)

    def test_a_device_that_hangs_is_told_of_before_all_attempts_are_over(self):
        (self.folder / "cell.yaml").write_text(MAP + "timeout: 500ms\n", encoding="utf-8")
        with socket.create_server(("127.0.0.1", 0)) as server:  # the kernel accepts, and nobody answers
            where = f"127.0.0.1:{server.getsockname()[1]}"
            done = self.dump("cell.yaml", "--at", where)
        self.assertEqual(done.returncode, 3)
        note, error = done.stderr.splitlines()
        self.assertEqual(note, "coupler dump: note: a request had no answer; the device is asked in other ways")
        self.assertIn("the connection was accepted, but unit 1 does not answer; check that the device runs, and that 'unit' is "
                      "its unit id: a node answers to its own", error)

    def test_help_has_an_example(self):
        done = self.dump("--help")
        self.assertEqual(done.returncode, 0)
        self.assertIn("Example:\n  coupler dump raspberrypi\n", done.stdout)


unittest.main()
