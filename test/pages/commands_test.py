# SPDX-License-Identifier: Apache-2.0
"""The mbpoll commands that the Markdown page names read a real node. COUPLER and NODE are the programs."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "support"))
from served import Served  # noqa: E402

MAP = """\
name: cell
address: 127.0.0.1
port: {port}
unit: 7
mapping:
  coils: {{lamp: {{address: 3, initial: on}}}}
  discrete_inputs: {{door: {{address: 9, count: 3, initial: [on, off, on]}}}}
  input_registers: {{level: {{address: 4, type: REAL, order: {order}, initial: 12.5}}}}
  holding_registers: {{speed: {{address: 700, type: {type}, order: {order}, initial: -1234}}}}
"""


class Commands(unittest.TestCase):
    def values(self, **keys):
        """What the commands print, one list a command."""
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "cell.yaml")
            path.write_text(MAP.format(port=1502, **keys), "utf-8")
            with Served([os.environ["NODE"], path, "--sim", "--port", "0"]) as node:
                path.write_text(MAP.format(port=node.port, **keys), "utf-8")
                subprocess.run([os.environ["COUPLER"], "generate", path, "--docs", "--out", folder, "--quiet"],
                               check=True)
                page = pathlib.Path(folder, "cell.md").read_text("utf-8")
                commands = re.findall(r"^mbpoll .*$", page, re.MULTILINE)
                return [self.read(command) for command in commands]

    def read(self, command):
        patient = command.replace("mbpoll ", "mbpoll -o 10 ", 1)  # mbpoll's own second is short on a busy machine
        done = subprocess.run(patient, shell=True, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, command + "\n" + done.stdout + done.stderr)
        return re.findall(r"^\[\d+\]:\s+(\S+)", done.stdout, re.MULTILINE)

    def test_read_the_values_that_the_node_serves(self):
        for order in ("ABCD", "CDAB"):
            with self.subTest(order):
                self.assertEqual(self.values(order=order, type="DINT"), [["1"], ["1", "0", "1"], ["12.5"], ["-1234"]])

    def test_show_the_registers_of_what_mbpoll_does_not_know(self):
        self.assertEqual(self.values(order="BADC", type="DINT")[2:], [["0x4841", "0x0000"], ["0xFFFF", "0x2EFB"]])


if __name__ == "__main__":
    unittest.main()
