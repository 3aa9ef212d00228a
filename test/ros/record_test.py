# SPDX-License-Identifier: Apache-2.0
"""A driver that records what it reads, and one that drives a replay of that."""
import json
import os
import pathlib
import tempfile
import unittest

from std_msgs.msg import Bool, UInt16

from support import process, testing
from support.patience import wait_until

MAP = """
name: {name}
rate: 20
timeout: 60
mapping:
  coils: {lamp: 0}
  discrete_inputs: {lamp_is_on: 0}
  holding_registers: {speed: {address: 7, type: UINT}}
sim: [{from: lamp, to: lamp_is_on}]
"""


@unittest.skipUnless(process.has_node(), "coupler-node was not built")
class Record(testing.RosTest):
    at_once = True

    def setUp(self):
        super().setUp()
        self.folder = pathlib.Path(tempfile.mkdtemp(dir=os.environ["ROS_HOME"]))
        self.map = self.folder / "press.yaml"
        self.map.write_text(MAP.replace("{name}", self.name))
        self.file = self.folder / "press.jsonl"

    def lines(self):
        return [json.loads(line) for line in self.file.read_text().splitlines()] if self.file.exists() else []

    def values(self, point):
        return [line["value"] for line in self.lines() if line.get("point") == point]

    def record(self):
        """A session in which the lamp goes on and off and a speed is set."""
        node = process.Node(str(self.map))
        self.addCleanup(node.end)
        driver = self.driver("--map", str(self.map), "_address:=127.0.0.1", f"_port:={node.port}", f"_record:={self.file}")
        driver.wait_for("connected")
        lamp = self.publisher(f"/{self.name}/lamp/write", Bool)
        for on in (True, False):
            lamp.publish(on)
            wait_until(lambda on=on: self.values("lamp_is_on")[-1:] == [on], "the input's change in the file")
        self.publisher(f"/{self.name}/speed/write", UInt16).publish(4711)
        wait_until(lambda: self.values("speed") == [0, 4711], "the speed in the file")
        driver.end()
        node.end()

    def test_a_driver_records_over_its_own_connection(self):
        self.record()
        lines = self.lines()
        self.assertEqual((lines[0]["record"], lines[0]["name"]), (1, self.name))
        self.assertEqual(self.values("lamp"), [False, True, False])
        self.assertEqual(self.values("lamp_is_on"), [False, True, False])
        self.assertTrue(lines[-1]["end"])
        self.assertEqual([line["device"] for line in lines if "t" in line and "utc" in line and "record" not in line
                          and line.get("device") == "online"], ["online"])

    def test_a_replay_drives_the_driver_as_the_device_did(self):
        self.record()
        node = process.Node("--replay", str(self.file), "--loop")  # a driver may need longer than a round to be there
        self.addCleanup(node.end)
        self.driver("--map", str(self.map), "_address:=127.0.0.1", f"_port:={node.port}").wait_for("connected")
        lamp = self.topic(f"/{self.name}/lamp_is_on", Bool)
        speed = self.topic(f"/{self.name}/speed", UInt16)
        for on in (True, False):
            lamp.wait_for(lambda value, on=on: value is on)
        speed.wait_for(lambda value: value == 4711)
        speed.wait_for(lambda value: value == 0)

    def test_a_file_that_is_none_of_its_own_stays_and_the_driver_drives(self):
        self.file.write_text("dear diary\n")
        node = process.Node(str(self.map))
        self.addCleanup(node.end)
        driver = self.driver("--map", str(self.map), "_address:=127.0.0.1", f"_port:={node.port}", f"_record:={self.file}")
        driver.wait_for("is no recording")
        self.topic(f"/{self.name}/speed", UInt16).wait_for(lambda value: value == 0)
        self.assertEqual(self.file.read_text(), "dear diary\n")


if __name__ == "__main__":
    testing.main()
