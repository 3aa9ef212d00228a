# SPDX-License-Identifier: Apache-2.0
"""What `coupler generate` makes of a map, for the tests of the client in Python. COUPLER and NODE are the programs,
SOURCE_DIR is this tree, LIVE says that COUPLER can ask a device."""
import importlib.util
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
SOURCE = pathlib.Path(os.environ["SOURCE_DIR"])
sys.path.insert(0, str(SOURCE / "test/support"))
from served import PATIENCE, Served  # noqa: E402,F401

try:
    import pymodbus
except ImportError:
    print("skipped: pymodbus is missing; run scripts/install-packages test")
    sys.exit(77)
print(f"pymodbus {pymodbus.__version__}, Python {sys.version.split()[0]}")

LIVE = unittest.skipUnless(os.environ.get("LIVE") in ("1", "ON"), "needs libmodbus")


class Made(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def coupler(self, *arguments):
        return subprocess.run([os.environ["COUPLER"], *arguments], cwd=self.folder, capture_output=True, text=True,
                              check=False)

    def generate(self, text, *options, name="cell"):
        path = self.folder / f"{name}.yaml"
        path.write_text(text, encoding="utf-8")
        done = self.coupler("generate", path.name, *options, "--name", name)
        self.assertEqual(done.returncode, 0, done.stderr)
        return path

    def client(self, text, name="cell"):
        """The module that is made of the map, and the class in it."""
        self.generate(text, "--python", name=name)
        path = self.folder / f"{name}_client.py"
        spec = importlib.util.spec_from_file_location(path.stem, path)
        module = importlib.util.module_from_spec(spec)
        sys.modules[path.stem] = module  # as an import does; dataclasses look there
        spec.loader.exec_module(module)
        kinds = re.findall(r"^class (\w+)\(\w*Client\)", path.read_text(encoding="utf-8"), re.M)
        return module, getattr(module, kinds[-1])

    def vectors(self, text, name="cell"):
        self.generate(text, "--vectors", name=name)
        return json.loads((self.folder / f"{name}_vectors.json").read_text(encoding="utf-8"))["points"]

    def node(self, text):
        path = self.folder / "served.yaml"
        path.write_text(text, encoding="utf-8")
        return Served([os.environ["NODE"], path, "--sim", "--listen", "127.0.0.1", "--port", "0"])
