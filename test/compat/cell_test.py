# SPDX-License-Identifier: Apache-2.0
"""One cell, driver and node of different ages: what is written arrives, and what changes is told."""
from std_msgs.msg import Bool, Float32, Int16, String

from support import process, testing
from support.ports import free_port

MAP = """
name: cell
address: 127.0.0.1
rate: 50
timeout: 60
watchdog: {timeout: 30s}
defaults: {publish: on_change, latch: true}
mapping:
  coils: {lamp: 4}
  discrete_inputs: {lit: 7}
  holding_registers:
    speed: {address: 0, type: INT}
    level: {address: 1, type: REAL}
    label: {address: 3, type: STRING, length: 8}
sim:
  - {from: lamp, to: lit}
"""


class Cell(testing.RosTest):
    def begin(self, *arguments):
        self.map = process.write_map(MAP)
        self.port = free_port()
        self.node = process.Node(self.map, port=self.port)
        self.addCleanup(lambda: self.node.end())  # pylint: disable=unnecessary-lambda
        self.assertEqual(self.node.port, self.port)
        self.driver(*arguments, f"_port:={self.port}").wait_for("connected")
        self.lamp, self.lit = self.topic("/cell/lamp", Bool, latched=True), self.topic("/cell/lit", Bool, latched=True)
        self.lamp.becomes(False)

    def switch(self, level):
        self.publisher("/cell/lamp/write", Bool).publish(level)
        self.lamp.becomes(level)
        self.lit.becomes(level)

    def test_bits_are_written_and_an_input_follows(self):
        self.begin(f"_map:={process.write_map(MAP)}")
        for level in (True, False, True):
            self.switch(level)

    def test_numbers_and_texts_come_back_as_they_were_written(self):
        self.begin(f"_map:={process.write_map(MAP)}")
        for name, kind, value in (("speed", Int16, -1234), ("level", Float32, 0.5), ("label", String, "north")):
            self.publisher(f"/cell/{name}/write", kind).publish(value)
            self.topic(f"/cell/{name}", kind, latched=True).becomes(value)

    def test_the_driver_gets_the_nodes_map(self):
        self.begin("_address:=127.0.0.1")
        self.switch(True)

    def test_a_node_that_was_started_anew_is_driven_again(self):
        self.begin(f"_map:={process.write_map(MAP)}")
        self.switch(True)
        online = self.topic("/cell/online", Bool, latched=True)
        self.node.end()
        online.becomes(False)
        self.node = process.Node(self.map, port=self.port)
        online.becomes(True)
        self.lamp.becomes(False)
        self.switch(True)


testing.main()
