# SPDX-License-Identifier: Apache-2.0
"""A value that cannot be written is dropped with a warning that names the topic and what to do; the next one works."""
from coupler_driver.msg import BoolArray
from std_msgs.msg import String

from support import process, testing
from support.peer import Peer
from support.topics import wait_until

MAP = """
name: refused
address: 127.0.0.1
timeout: 60
mapping:
  holding_registers:
    flags: {address: 0, type: WORD}
    label: {address: 1, type: STRING, length: 4}
    code: {address: 3, type: STRING, length: 4, encoding: ascii}
"""


class RefusedValues(testing.RosTest):
    def setUp(self):
        self.peer = Peer().start()
        self.addCleanup(self.peer.stop)
        self.device = self.driver(f"_map:={process.write_map(MAP)}", f"_port:={self.peer.port}")
        self.device.wait_for("connected")

    def test_a_bool_array_of_the_wrong_length(self):
        publisher = self.publisher("/refused/flags/write", BoolArray)
        publisher.publish([True] * 8)
        self.device.wait_for("refused a write to refused/flags/write: 8 elements; send 16, element i is bit i")
        publisher.publish([True] + [False] * 15)
        wait_until(lambda: self.peer.get("holding_registers", 0) == [1], "bit 0 at the peer")

    def test_a_text_that_is_too_long_or_not_in_the_encoding(self):
        label, code = (self.publisher(f"/refused/{name}/write", String) for name in ("label", "code"))
        label.publish("lange")
        self.device.wait_for("refused a write to refused/label/write: 'lange' is longer than 4 bytes")
        code.publish("für")
        # How the log shows the letter is the locale's affair.
        self.device.wait_for("refused a write to refused/code/write: 'f")
        self.device.wait_for("has a character that ascii has not")
        code.publish("fur")
        wait_until(lambda: self.peer.get("holding_registers", 3) == [0x7566], "'fu' at the peer")
        self.assertEqual(self.peer.get("holding_registers", 1, 2), [0, 0])


if __name__ == "__main__":
    testing.main()
