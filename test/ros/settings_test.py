# SPDX-License-Identifier: Apache-2.0
"""Where the driver's settings come from, in the origin's spellings too, and what it says of wrong ones."""
import os
import socket

import rospy
from std_msgs.msg import Int16

from support import process, testing
from support.patience import PATIENCE
from support.peer import Peer
from support.ports import free_port

MAP = """
name: {name}
address: {address}
port: {port}
mapping:
  holding_registers: {{level: {{address: 4, type: INT}}}}
"""


class SettingsTest(testing.RosTest):
    def setUp(self):
        self.peer = Peer().start()
        self.addCleanup(self.peer.stop)
        self.peer.set("holding_registers", 4, [33])

    def map(self, address="127.0.0.1", port=None):
        return process.write_map(MAP.format(name=self.name, address=address, port=port or self.peer.port))

    def assert_drives(self, *arguments, name=None):
        with process.Driver(*arguments) as driver:
            driver.wait_for("connected")
            self.assertEqual(self.topic(f"/{name or self.name}/level", Int16).next(), 33)

    def assert_ends(self, code, text, *arguments):
        driver = process.Driver(*arguments)
        self.assertEqual(driver.wait(), code, driver.output)
        self.assertIn(text, driver.output)


class Settings(SettingsTest):
    at_once = True

    def test_the_map_is_enough(self):
        self.assert_drives(f"_map:={self.map()}")

    def test_each_spelling_of_the_map_is_understood(self):
        for arguments in ([f"_mapping:={self.map()}"], ["--map", self.map()], ["--mapping", self.map()],
                          [f"--map={self.map()}"]):
            with self.subTest(arguments):
                self.assert_drives(*arguments)

    def test_a_parameter_overrides_the_map_and_an_argument_the_parameter(self):
        path = self.map(port=free_port())
        rospy.set_param(f"/{self.name}_driver/port", self.peer.port)
        self.addCleanup(rospy.delete_param, f"/{self.name}_driver/port")
        self.assert_drives(f"_map:={path}")
        rospy.set_param(f"/{self.name}_driver/port", free_port())
        self.assert_drives(f"_map:={path}", "--port", self.peer.port)

    def test_a_node_that_was_given_its_name_finds_its_map_in_its_parameters(self):
        rospy.set_param("/arm_io", {"map": self.map(), "rate": 50})
        self.addCleanup(rospy.delete_param, "/arm_io")
        self.assert_drives("__name:=arm_io")

    def test_the_name_is_the_topics_namespace_and_the_nodes_name(self):
        with process.Driver(f"_map:={self.map()}", "_name:=other") as driver:
            driver.wait_for("connected")
            self.assertEqual(self.topic("/other/level", Int16).next(), 33)
            import rosnode  # pylint: disable=import-outside-toplevel
            self.assertIn("/other_driver", rosnode.get_node_names())

    def test_topics_can_be_remapped_and_are_relative(self):
        with process.Driver(f"_map:={self.map()}", f"{self.name}/level:=height", "__ns:=/cell") as driver:
            driver.wait_for("connected")
            self.assertEqual(self.topic("/cell/height", Int16).next(), 33)

    def test_a_misspelt_parameter_is_told_with_the_nearest_name(self):
        rospy.set_param(f"/{self.name}_driver/raet", 20)
        with process.Driver(f"_map:={self.map()}") as driver:
            driver.wait_for(f"parameter /{self.name}_driver/raet is not a setting and does nothing; did you mean 'rate'?")
            driver.wait_for("connected")
            self.assertEqual(driver.output.count("is not a setting"), 1)

    def test_an_empty_parameter_says_nothing(self):
        path = self.map()
        empty = {name: "" for name in ("mapping", "maps", "name", "address", "port", "unit", "framing", "serial", "baud", "parity",
                                       "stop_bits", "rs485", "certificate", "key", "ca", "tls_name", "pin", "rate", "timeout",
                                       "verify", "poll", "topics", "record", "panel")}
        rospy.set_param("/empty_io", {**empty, "map": path})
        self.addCleanup(rospy.delete_param, "/empty_io")
        self.assert_drives("__name:=empty_io")
        rospy.set_param("/empty_io", {"map": path, "maps": []})
        self.assert_drives("__name:=empty_io")
        rospy.delete_param("/empty_io")
        self.assert_drives("__name:=empty_io", f"_map:={path}", *(f"_{name}:=" for name in empty))
        rospy.set_param("/empty_io", {"map": ""})
        self.assert_ends(2, "no map; give one by --map MAP", "__name:=empty_io")

    def test_a_second_driver_of_the_same_name_is_noticed_by_both(self):
        with process.Driver(f"_map:={self.map()}") as one:
            one.wait_for("connected")
            with process.Driver(f"_map:={self.map()}", "__name:=other") as other:
                one.wait_for(f"/other also publishes /{self.name}/online: two drivers write to the same device")
                other.wait_for(f"/{self.name}_driver also publishes /{self.name}/online: two drivers write to the same device")

    def test_an_ipv6_address_may_stand_in_brackets(self):
        with socket.create_server(("::1", 0), family=socket.AF_INET6) as server:
            server.settimeout(PATIENCE)
            with process.Driver(f"_map:={self.map()}", "_address:=[::1]", f"_port:={server.getsockname()[1]}"):
                server.accept()[0].close()


class WithoutAName(SettingsTest):
    """Drivers that know no name for their node have one, and ROS keeps what they are given as its parameters."""

    def test_a_map_without_a_name_takes_that_of_the_call(self):
        path = process.write_map(MAP.format(name="", address="127.0.0.1", port=self.peer.port).replace("name:", ""))
        self.assert_drives(f"_map:={path}", "_name:=press", name="press")
        rospy.set_param("/cell_io", {"map": path, "name": "belt"})
        self.assert_drives("__name:=cell_io", name="belt")
        driver = process.Driver(f"_map:={path}")
        self.assertEqual(driver.wait(), 1, driver.output)
        self.assertIn("the map has no 'name'", driver.output)

    def test_a_wrong_call_ends_with_2_and_says_why(self):
        self.assert_ends(2, "no map; give one by --map MAP")
        self.assert_ends(2, "_speed:=5: there is no such setting", "_speed:=5")
        self.assert_ends(2, "--speed", "--speed", 5)
        self.assert_ends(2, "rate: 'fast' is not a number from 0.001 to 10000 Hz", f"_map:={self.map()}", "_rate:=fast")
        self.assert_ends(2, "port: '70000' is not a whole number from 1 to 65535", "_port:=70000")
        self.assert_ends(2, "address: '10.0.0.7:502' has a port; write 'port: 502' beside it", "_address:=10.0.0.7:502")
        self.assert_ends(2, "verify: 'maybe' is not require, warn or off", "_verify:=maybe")

    def test_a_setting_that_does_nothing_where_the_device_is_is_told(self):
        self.assert_ends(1, "baud has no meaning at 127.0.0.1 port", f"_map:={self.map()}", "_baud:=9600")
        self.assert_ends(1, "port has no meaning on the serial port /dev/ttyS9", f"_map:={self.map()}",
                         "_serial:=/dev/ttyS9", "_port:=1502")
        # What ROS has kept of those calls does not count beside a place that is given now.
        self.assert_drives(f"_map:={self.map()}", "_address:=127.0.0.1", f"_port:={self.peer.port}")

    def test_a_wrong_map_ends_with_1_and_says_where(self):
        path = process.write_map("name: broken\nmapping:\n  coils: {a: 70000}\n")
        self.assert_ends(1, f"{path}:3:", f"_map:={path}", "_address:=localhost")
        self.assert_ends(1, "/nowhere.yaml", "_map:=/nowhere.yaml")
        self.assert_ends(1, f"there is no file {os.getcwd()}/nowhere.yaml; a relative path counts from the folder where the program starts",
                         "_map:=nowhere.yaml")
        self.assert_ends(1, f"there is no file {os.getcwd()}/nowhere.yaml; roslaunch starts programs in that folder",
                         "_map:=nowhere.yaml", "__log:=/tmp/x.log")
        path = process.write_map("name: homeless\nmapping:\n  coils: {a: 7}\n")
        self.assert_ends(1, "the map has no address; add 'address: HOST' or give --address HOST", f"_map:={path}")

    def test_its_version_needs_no_master(self):
        self.assert_ends(0, "coupler_driver 0.", "--version")

    def test_help_needs_no_master_and_has_examples(self):
        self.assert_ends(0, "coupler_driver _map:=device.yaml", "--help")

    def test_an_address_that_serves_no_map_is_a_foreign_coupler(self):
        self.assert_ends(1, "serves no map", "_address:=127.0.0.1", f"_port:={self.peer.port}")


if __name__ == "__main__":
    testing.main()
