# SPDX-License-Identifier: Apache-2.0
"""What an editor shows of a map through yaml-language-server: nothing of a good one, mistakes at their line, keys to
complete, and what they mean.   yaml_language_server_test.py COUPLER SERVER_COMMAND…"""
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from language_server import LanguageServer

COUPLER, SERVER = sys.argv[1], sys.argv[2:]
MAPS = Path(__file__).resolve().parents[2] / "config"
MODELINE = "# yaml-language-server: $schema=map.schema.json\n"


class AnEditor(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        subprocess.run([COUPLER, "schema", "--out", self.folder / "map.schema.json"], check=True)
        self.server = LanguageServer(SERVER)
        self.addCleanup(self.server.close)

    def open(self, text):
        """The file, and its diagnostics as (line from 1, message)."""
        path = self.folder / "map.yaml"
        path.write_text(MODELINE + text, encoding="utf-8")
        found = self.server.open(path)
        return path, sorted((d["range"]["start"]["line"] + 1, d["message"]) for d in found)

    def test_says_nothing_of_good_maps(self):
        for name in ("example-node.yaml", "foreign-coupler.yaml"):
            self.assertEqual(self.open((MAPS / name).read_text(encoding="utf-8"))[1], [], name)

    def test_shows_each_mistake_at_its_line(self):
        found = self.open("name: cell\nprot: 502\ntimeout: fast\nmapping:\n  coils:\n"
                          "    lamp: {address: 0, safe: offf}\n  input_registers:\n"
                          "    label: {address: 0, type: STRING}\n    level: {address: 70000, type: int}\n")[1]
        self.assertEqual([line for line, _ in found], [3, 4, 7, 9, 10])
        for (_, message), part in zip(found, ("prot", "with its unit", '"hold"', '"length"', "65535")):
            self.assertIn(part, message)

    def test_completes_keys_and_words(self):
        path, _ = self.open("name: cell\nmapping:\n  coils:\n    lamp:\n      address: 0\n      \n"
                            "  holding_registers:\n    speed:\n      address: 0\n      type: \n")
        keys = self.labels(path, 6, 6)
        self.assertLessEqual({"line", "safe", "drive", "description"}, set(keys))
        self.assertNotIn("debounce", keys)
        self.assertEqual(len(keys), len(set(keys)), keys)
        self.assertIn("UDINT", self.labels(path, 10, 12))

    def labels(self, path, line, character):
        return [item["label"] for item in self.server.ask("completion", path, line, character)["items"]]

    def test_explains_keys(self):
        path, _ = self.open("name: cell\nmapping:\n  coils:\n    lamp: {address: 0, line: X, safe: hold}\n")
        text = self.server.ask("hover", path, 4, 34)["contents"]["value"]
        schema = json.loads((self.folder / "map.schema.json").read_text(encoding="utf-8"))
        coil = schema["properties"]["mapping"]["properties"]["coils"]["additionalProperties"]["anyOf"][1]
        summary = coil["properties"]["safe"]["description"].split(";")[0]
        self.assertGreater(len(summary), 10)
        self.assertIn(summary, text)
        self.assertIn("if not given: off", text)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
