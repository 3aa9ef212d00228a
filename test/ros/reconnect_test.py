# SPDX-License-Identifier: Apache-2.0
"""The driver comes back by itself, and says whether the device is there."""
from std_msgs.msg import Bool, Int16

from support import process, testing
from support.peer import Peer
from support.ports import free_port
from support.topics import wait_until

MAP = """
name: {name}
address: localhost
rate: 20
timeout: 60
mapping:
  coils: {lamp: 3}
  holding_registers: {level: {address: 4, type: INT}}
"""


class Reconnect(testing.RosTest):
    at_once = True

    def setUp(self):
        self.map = process.write_map(MAP.replace("{name}", self.name))

    def test_online_follows_the_device_and_values_stop_while_it_is_away(self):
        peer = Peer().start()
        peer.set("holding_registers", 4, [11])
        with process.Driver(f"_map:={self.map}", f"_port:={peer.port}"):
            online = self.topic(f"/{self.name}/online", Bool)
            level = self.topic(f"/{self.name}/level", Int16)
            online.wait_for(bool)
            self.assertEqual(level.next(), 11)

            peer.stop()
            online.wait_for(lambda value: not value and True in online.values)
            level.stays_quiet()

            peer.set("holding_registers", 4, [22])
            online.values.clear()
            peer.start()
            online.wait_for(bool)
            self.assertEqual(level.wait_for(lambda value: value == 22), 22)
        peer.stop()

    def test_a_late_subscriber_learns_whether_the_device_is_there(self):
        with Peer() as peer, process.Driver(f"_map:={self.map}", f"_port:={peer.port}"):
            online = self.topic(f"/{self.name}/online", Bool)
            online.wait_for(bool)
            online.close()
            online = self.topic(f"/{self.name}/online", Bool)
            self.assertTrue(online.wait_for(lambda _: True), "the first value to come is the last one published")

    def test_a_device_that_is_not_there_yet_is_waited_for(self):
        port = free_port()
        with process.Driver(f"_map:={self.map}", f"_port:={port}") as driver:
            online = self.topic(f"/{self.name}/online", Bool)
            self.assertFalse(online.wait_for(lambda _: True))
            driver.wait_for(f"localhost port {port}: Connection refused")
            with Peer(port):
                online.wait_for(bool)

    def test_a_write_while_the_device_is_away_is_dropped_and_reported(self):
        port = free_port()
        with process.Driver(f"_map:={self.map}", f"_port:={port}") as driver:
            driver.wait_for("Connection refused")
            self.publisher(f"/{self.name}/lamp/write", Bool).publish(True)
            driver.wait_for("write to lamp: dropped")
            with Peer(port) as peer:
                driver.wait_for("connected; 1 writes were dropped meanwhile")
                self.assertFalse(peer.get("coils", 3)[0])
                lamp = self.publisher(f"/{self.name}/lamp/write", Bool)
                lamp.publish(True)
                wait_until(lambda: peer.get("coils", 3)[0], "the lamp to be on")


if __name__ == "__main__":
    testing.main()
