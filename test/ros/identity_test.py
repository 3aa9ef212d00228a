# SPDX-License-Identifier: Apache-2.0
"""The two sides are proven equal at connect: the driver against coupler-node."""
import re
import unittest

from diagnostic_msgs.msg import DiagnosticStatus
from std_msgs.msg import Bool, UInt16

from support import process, testing
from support.latest import LatestDiagnostics
from support.ports import free_port

MAP = """
name: {name}
address: 127.0.0.1
rate: 20
timeout: 60
mapping:
  coils:
    clamp: 4
    lamp: {lamp}
  discrete_inputs: {{closed: 9}}
  holding_registers:
    speed: {{address: 7, type: {speed}}}
"""
FINGERPRINT = re.compile(r"fingerprint ([0-9a-f]{16}) here, ([0-9a-f]{16}) in the device")


def press(name, lamp=5, speed="UINT"):
    return MAP.format(name=name, lamp=lamp, speed=speed)


@unittest.skipUnless(process.has_node(), "coupler-node was not built")
class Identity(testing.RosTest):
    at_once = True

    def start_node(self, text):
        node = process.Node(process.write_map(text))
        self.addCleanup(node.end)
        return node.port

    def assert_works(self, driver):
        driver.wait_for("connected")
        self.topic(f"/{self.name}/speed", UInt16).wait_for(lambda value: value == 0)
        self.publisher(f"/{self.name}/speed/write", UInt16).publish(4711)
        self.topic(f"/{self.name}/speed", UInt16).wait_for(lambda value: value == 4711)

    def test_equal_maps_are_quiet(self):
        port = self.start_node(press(self.name))
        driver = self.driver(f"_map:={process.write_map(press(self.name))}", f"_port:={port}")
        self.assert_works(driver)
        self.assertNotIn("differs", driver.output)
        self.assertNotIn("more points", driver.output)

    def test_a_map_changed_on_one_side_is_refused_with_both_fingerprints_and_the_points_that_differ(self):
        port = self.start_node(press(self.name))
        driver = self.driver(f"_map:={process.write_map(press(self.name, lamp=6, speed='INT'))}", f"_port:={port}")
        clamp = self.topic(f"/{self.name}/clamp", Bool)
        driver.wait_for("Nothing is read or written")
        driver.wait_for("the device has another map")
        fingerprints = FINGERPRINT.search(driver.output)
        self.assertTrue(fingerprints, driver.output)
        self.assertNotEqual(*fingerprints.groups())
        self.assertIn("~ lamp: address 6 -> 5", driver.output)
        self.assertIn("~ speed: type INT -> UINT", driver.output)
        self.assertNotRegex(driver.output, r"[~+-] (clamp|closed):")
        self.publisher(f"/{self.name}/clamp/write", Bool).publish(True)
        driver.wait_for("write to clamp: dropped")
        clamp.stays_quiet()
        self.assertEqual(clamp.ever, [])

    def test_with_warn_the_difference_is_reported_and_the_driver_goes_on(self):
        port = self.start_node(press(self.name))
        driver = self.driver(f"_map:={process.write_map(press(self.name, lamp=6))}", f"_port:={port}", "_verify:=warn")
        self.assert_works(driver)
        self.assertIn("~ lamp: address 6 -> 5", driver.output)

    def test_with_off_the_driver_does_not_ask(self):
        port = self.start_node(press(self.name))
        driver = self.driver(f"_map:={process.write_map(press(self.name, lamp=6))}", f"_port:={port}", "_verify:=off")
        self.assert_works(driver)
        self.assertNotIn("fingerprint", driver.output)

    def test_a_driver_that_knows_an_unchanged_subset_goes_on(self):
        port = self.start_node(press(self.name))
        subset = f"name: {self.name}\naddress: 127.0.0.1\nmapping:\n  holding_registers: {{speed: {{address: 7, type: UINT}}}}\n"
        driver = self.driver(f"_map:={process.write_map(subset)}", f"_port:={port}")
        self.assert_works(driver)
        self.assertIn("the device has more points", driver.output)

    def test_a_driver_without_a_map_gets_the_nodes(self):
        port = self.start_node(press(self.name) + "# " + "long enough for several requests " * 100 + "\n")
        driver = self.driver("_address:=127.0.0.1", f"_port:={port}")
        self.assert_works(driver)

    def test_a_node_may_be_named_in_place_of_a_map(self):
        port = self.start_node(press(self.name))
        driver = self.driver("--map", f"tcp://127.0.0.1:{port}")
        self.assert_works(driver)

    def test_a_driver_without_a_map_waits_for_the_node(self):
        port = free_port()
        driver = self.driver("_address:=127.0.0.1", f"_port:={port}")
        driver.wait_for("waiting for the map of 127.0.0.1")
        node = process.Node(process.write_map(press(self.name)), port=port)
        self.addCleanup(node.end)
        self.assert_works(driver)

    def test_a_driver_with_a_name_says_in_the_diagnostics_which_map_it_waits_for_and_that_it_has_come(self):
        port = free_port()
        node = f"{self.name}_io"
        diagnostics = LatestDiagnostics(f"{node}:")
        self.addCleanup(diagnostics.close)
        driver = self.driver("_address:=127.0.0.1", f"_port:={port}", f"__name:={node}")
        entry = diagnostics.says("Connection refused", "map", DiagnosticStatus.WARN)
        self.assertIn(f"waiting for the map of 127.0.0.1 port {port}", entry.message)
        self.assertEqual(entry.hardware_id, f"127.0.0.1:{port} unit 1")
        self.assertEqual(set(diagnostics.known), {"map"})
        node = process.Node(process.write_map(press(self.name)), port=port)
        self.addCleanup(node.end)
        diagnostics.says(f"read from 127.0.0.1 port {port}", "map", DiagnosticStatus.OK)
        diagnostics.says("online", f"{self.name} connection", DiagnosticStatus.OK)
        self.assert_works(driver)


if __name__ == "__main__":
    testing.main()
