# SPDX-License-Identifier: Apache-2.0
"""Maps of the origin's shape load unchanged and run: each point is read, each output written."""
import json
import pathlib
import re
import unittest

import yaml

from support import iec, process, testing
from support.patience import NO_TIMEOUT
from support.peer import Peer
from support.topics import Topic, connected_publishers, wait_until

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
TREE = ROOT / "test" / "maps" / "origin"
FIXTURES = ROOT.parent / "shared" / "fixtures"  # the origin's own files, where they are at hand


def maps():
    return sorted(path for folder in (TREE, FIXTURES) if folder.is_dir()
                  for path in folder.iterdir() if path.suffix in (".json", ".yaml"))


def plain(node):
    if isinstance(node, dict):
        return {key: plain(value) for key, value in node.items()}
    if node in ("true", "false"):
        return node == "true"
    return int(node, 10) if node.isdigit() else node


def read(path):
    """The map as Python sees it. No text in these files holds a comment's sign."""
    text = path.read_text()
    if path.suffix == ".yaml":
        return plain(yaml.load(text, Loader=yaml.BaseLoader))  # texts: to PyYAML 00010 would be eight
    text = re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.DOTALL)
    return json.loads(re.sub(r",(\s*[}\]])", r"\1", text))


@unittest.skipUnless(maps(), f"no maps in {TREE} or {FIXTURES}")
class OriginMaps(unittest.TestCase):
    def check(self, document, peer):
        name = document["name"]
        for index, point in enumerate(iec.points(document)):
            topic = f"/{name}/{point.name}"
            first, second = (iec.sample(point.kind, index + turn, point.options.get("length", 0)) for turn in (0, 1))
            point.store(peer, first)
            values = Topic(topic, point.message)
            values.wait_for(lambda value, p=point, v=first: iec.same(p.kind, value, v))
            values.close()
            if point.writable:
                publisher = connected_publishers({topic + "/write": point.message})[0]
                publisher.publish(data=second)
                wait_until(lambda p=point, v=second: p.is_stored(peer, v), f"{point.name} at the peer")
                publisher.unregister()

    def test_each_map_runs_unchanged_but_for_where_the_device_is(self):
        for path in maps():
            with self.subTest(path.name), Peer() as peer:
                with process.Driver("--mapping", path, "_address:=127.0.0.1", f"_port:={peer.port}",
                                    f"_timeout:={NO_TIMEOUT}s") as driver:
                    driver.wait_for("connected")
                    self.check(read(path), peer)


if __name__ == "__main__":
    testing.main()
