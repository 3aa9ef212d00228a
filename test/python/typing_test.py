# SPDX-License-Identifier: Apache-2.0
"""The client in Python and a program that uses it, as a type checker sees them: `mypy --strict`."""
import importlib.util
import os
import re
import subprocess
import sys
import unittest

import made
from press import PRESS

if importlib.util.find_spec("mypy") is None:
    print("skipped: mypy is missing; run scripts/install-packages test")
    sys.exit(77)

MODES = PRESS + "    mode: {address: 20, type: UINT, values: {0: \"off\", 1: idle}}\n"
PROGRAM = """\
import errno

from cell_client import CellClient, ExceptionReply, NotConnected, Refused, values


def main() -> None:
    try:
        with CellClient("127.0.0.1", 1502, timeout=1) as cell:
            reveal_type(cell)
            reveal_type(cell.valve.read())
            reveal_type(cell.lamps.read())
            reveal_type(cell.flow.read())
            reveal_type(cell.speed.read())
            reveal_type(cell.total.read())
            reveal_type(cell.label.read())
            mode = cell.mode.read()
            reveal_type(mode)
            if isinstance(mode, values.mode):
                reveal_type(mode.name)
            for change in cell.changes(cell.valve, cell.flow, period=0.5):
                reveal_type(change.time)
            cell.mode.write(values.mode.idle)
            cell.speed.write(80)
            cell.lamps.write([True, False, True])
    except NotConnected as error:
        if error.errno == errno.ECONNREFUSED:
            raise
    except Refused as error:
        print(error)
    except ExceptionReply as error:
        reveal_type(error.code)


main()
"""
TYPES = ["cell_client.CellClient", "bool", "list[bool]", "float", "float", "int", "str", "int", "str", "float", "int"]
WRONG = """\
from cell_client import CellClient

cell = CellClient("127.0.0.1")
cell.speed.write("80")
cell.door.write(True)
cell.horn.read()
cell.nobody.read()
"""


class Typing(made.Made):
    def mypy(self, program):
        """What mypy says of each line of the program, and whether it is content."""
        (self.folder / "program.py").write_text(program, encoding="utf-8")
        done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "program.py"], cwd=self.folder,
                              env={**os.environ, "MYPY_CACHE_DIR": str(self.folder / "cache")},
                              capture_output=True, text=True, check=False)
        return done.stdout, done.returncode == 0

    def test_a_program_knows_the_types_of_values_and_errors(self):
        self.generate(MODES, "--python")
        said, good = self.mypy(PROGRAM)
        self.assertTrue(good, said)
        said = said.replace("builtins.", "").replace("Union[cell_client.values.mode, int]", "int")  # the same
        self.assertEqual(re.findall(r'Revealed type is "(.*)"', said), TYPES)

    def test_what_a_point_cannot_do_is_found(self):
        self.generate(MODES, "--python")
        said, good = self.mypy(WRONG)
        self.assertFalse(good)
        self.assertEqual(re.findall(r"^program\.py:(\d+): error", said, re.M), ["4", "5", "6", "7"], said)

    def test_the_client_of_every_kind_of_map_and_of_line_is_typed(self):
        maps = {path.stem.replace("-", "_"): path.read_text(encoding="utf-8") for path in
                (made.SOURCE / "test/maps/every-type.yaml", made.SOURCE / "test/generate/manners.yaml",
                 made.SOURCE / "test/common/test_vectors/vectors.yaml")}
        maps["over_tcp"] = MODES.replace("unit: 7", "unit: 7\nframing: rtu")
        maps["on_a_line"] = MODES.replace("unit: 7", "unit: 7\nserial: {device: /dev/ttyUSB0, baud: 9600}")
        for name, text in maps.items():
            self.generate(text, "--python", name=name)
        said, good = self.mypy("".join(f"import {name}_client\n" for name in maps))
        self.assertTrue(good, said)


if __name__ == "__main__":
    unittest.main(warnings="ignore")
