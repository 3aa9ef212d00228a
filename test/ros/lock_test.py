# SPDX-License-Identifier: Apache-2.0
"""A map without addresses: node and driver read the lock beside it, or the driver the map that the node serves."""
import pathlib
import subprocess
import unittest

from std_msgs.msg import Int8, UInt16

from support import process, testing
from support.patience import PATIENCE

COUPLER = process.BUILD / "bin" / "coupler"
MAP = """
name: {name}
address: 127.0.0.1
timeout: 60
rate: 20
mapping:
  coils:
    clamp:
    lamp: {description: above the door}
  holding_registers:
    label: {type: STRING, length: 3}
    total:
      type: LREAL
    trim: {type: SINT, initial: -3}
    level: {type: SINT}
    speed: {type: UINT}
"""
ADDRESSED = """
name: {name}
address: 127.0.0.1
mapping:
  coils: {clamp: 0, lamp: 1}
  holding_registers:
    label: {address: 0, type: STRING, length: 3}
    total: {address: 4, type: LREAL}
    trim: {address: 2, offset: high, type: SINT}
    level: {address: 2, offset: low, type: SINT}
    speed: {address: 3, type: UINT}
"""


def check(path):
    subprocess.run([COUPLER, "check", path], check=True, timeout=PATIENCE, stdout=subprocess.DEVNULL)


def lock_of(path):
    return pathlib.Path(path + ".lock")


@unittest.skipUnless(process.has_node() and COUPLER.exists(), "coupler-node or coupler was not built")
class Lock(testing.RosTest):
    at_once = True

    def start_node(self, path):
        node = process.Node(path)
        self.addCleanup(node.end)
        return node, node.port

    def text(self, text=MAP):
        return text.replace("{name}", self.name)

    def locked_map(self):
        path = process.write_map(self.text())
        check(path)
        return path

    def assert_works(self, driver):
        driver.wait_for("connected")
        self.topic(f"/{self.name}/trim", Int8).wait_for(lambda value: value == -3)
        self.topic(f"/{self.name}/speed", UInt16).wait_for(lambda value: value == 0)
        self.publisher(f"/{self.name}/speed/write", UInt16).publish(4711)
        self.topic(f"/{self.name}/speed", UInt16).wait_for(lambda value: value == 4711)
        self.assertNotIn("fingerprint", driver.output)

    def test_both_sides_read_the_same_lock_and_are_equal(self):
        path = self.locked_map()
        _, port = self.start_node(path)
        self.assert_works(self.driver(f"_map:={path}", f"_port:={port}"))

    def test_the_map_that_a_node_serves_needs_no_lock(self):
        _, port = self.start_node(self.locked_map())
        self.assert_works(self.driver("_address:=127.0.0.1", f"_port:={port}"))

    def test_the_same_map_with_its_addresses_is_equal(self):
        _, port = self.start_node(self.locked_map())
        self.assert_works(self.driver(f"_map:={process.write_map(self.text(ADDRESSED))}", f"_port:={port}"))

    def test_another_lock_is_another_map(self):
        path = self.locked_map()
        _, port = self.start_node(path)
        lock = lock_of(path).read_text(encoding="utf-8")
        lock_of(path).write_text(lock.replace("holding_registers 3 speed", "holding_registers 9 speed"),
                                 encoding="utf-8")
        driver = self.driver(f"_map:={path}", f"_port:={port}")
        driver.wait_for("Nothing is read or written")
        self.assertIn("~ speed: address 9 -> 3", driver.output)

    def test_without_the_lock_neither_starts_and_both_say_what_to_do(self):
        path = process.write_map(self.text())
        for program in (process.Node(path), self.driver(f"_map:={path}")):
            self.assertEqual(program.wait(), 1)
            self.assertIn(f"there is no {path}.lock; run `coupler check {path}`", program.output)
        self.assertFalse(lock_of(path).exists())

    def test_a_node_reads_the_lock_again_with_the_map(self):
        path = self.locked_map()
        node, port = self.start_node(path)
        pathlib.Path(path).write_text(self.text() + "    later: {type: UINT}\n", encoding="utf-8")
        node.reload()
        node.wait_for("'later' has no address in")
        check(path)
        node.reload()
        node.wait_for("8 points")
        self.assert_works(self.driver(f"_map:={path}", f"_port:={port}"))


if __name__ == "__main__":
    testing.main()
