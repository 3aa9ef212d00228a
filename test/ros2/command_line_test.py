# SPDX-License-Identifier: Apache-2.0
"""The call as ROS 2 has it, the driver's own arguments beside it, and what is said of ROS 1's."""
import os

from rcl_interfaces.msg import Log
from std_msgs.msg import Bool, Int16

from support import process, testing
from support.peer import Peer
from support.ports import free_port
from support.ros import wait_for_graph
from support.topics import Subscription, qos, types, wait_until

INFO, WARN = 20, 30  # of rcl_interfaces/msg/Log, whose constants are of another type than its field

MAP = """
name: called
address: 127.0.0.1
port: {port}
rate: 20
timeout: 60
mapping:
  coils: {{lamp: 3}}
  holding_registers: {{level: {{address: 4, type: INT}}}}
"""


class CallTest(testing.RosTest):
    def setUp(self):
        self.peer = Peer().start()
        self.addCleanup(self.peer.stop)
        self.peer.set("holding_registers", 4, [33])
        self.map = process.write_map(MAP.format(port=self.peer.port))

    def assert_drives(self, *arguments, topic="/called/level"):
        driver = self.driver(*arguments)
        driver.wait_for("connected")
        self.assertEqual(self.topic(topic, Int16).next(), 33)
        return driver


class Spellings(CallTest):
    def test_each_spelling_of_the_map_is_understood(self):
        for arguments in (["--map", self.map], [f"--map={self.map}"], ["--mapping", self.map], ["--ros-args", "-p", f"map:={self.map}"],
                          ["--ros-args", "--param", f"map:={self.map}"], ["--ros-args", "-p", f"mapping:={self.map}"],
                          ["--ros-args", "-r", "__node:=io", "--", "--map", self.map]):
            with self.subTest(arguments):
                self.assert_drives(*arguments).end()

    def test_an_argument_overrides_a_parameter_and_that_the_map(self):
        path = process.write_map(MAP.format(port=free_port()))
        self.assert_drives("--map", path, "--ros-args", "-p", f"port:={self.peer.port}").end()
        self.assert_drives("--map", path, "--port", self.peer.port, "--ros-args", "-p", f"port:={free_port()}").end()

    def test_a_topic_can_be_remapped_and_all_are_relative(self):
        self.assert_drives("--map", self.map, "--ros-args", "-r", "__ns:=/cell", "-r", "called/level:=height",
                           "-r", "called/lamp/write:=/lamp", topic="/cell/height")
        self.publisher("/lamp", Bool).publish(True)
        wait_until(lambda: self.peer.get("coils", 3)[0], "the remapped write")
        self.assertNotIn("/cell/called/level", types())
        self.assertTrue(self.topic("/cell/called/online", Bool).wait_for(bool))

    def test_the_nodes_name_is_given_as_to_any_node(self):
        self.assert_drives("--map", self.map, "--ros-args", "-r", "__node:=io", "--remap", "__ns:=/cell", topic="/cell/called/level")
        wait_for_graph(lambda node: ("io", "/cell") in node.get_node_names_and_namespaces(), "the node")

    def test_it_may_have_an_enclave(self):
        self.assert_drives("--map", self.map, "--ros-args", "--enclave", "/cell/io")
        wait_for_graph(lambda node: ("called_driver", "/", "/cell/io") in node.get_node_names_and_namespaces_with_enclaves(), "the node")


class Wrong(CallTest):
    def test_ros_1s_spelling_is_told_with_that_of_ros_2(self):
        for given, told in ((f"_map:={self.map}", f"--ros-args -p map:={self.map}"), ("__name:=io", "--ros-args -r __node:=io"),
                            ("__ns:=/cell", "--ros-args -r __ns:=/cell"), ("called/level:=height", "--ros-args -r called/level:=height"),
                            ("_belt/address:=10.0.0.7", "--ros-args -p belt.address:=10.0.0.7")):
            with self.subTest(given):
                self.assert_ends(2, told, "--map", self.map, given)

    def test_what_is_no_argument_of_ros_2_ends_with_2(self):
        self.assert_ends(2, "--foo", "--map", self.map, "--ros-args", "--foo")
        self.assert_ends(2, "--rate", "--map", self.map, "--ros-args", "--rate", 5)
        for arguments in (("-p", "rate"), ("-r", "nonsense"), ("--log-level", "loud"), ("-p", "rate:=[1"), ("--params-file",)):
            with self.subTest(arguments):
                driver = process.Process("coupler_driver", "--map", self.map, "--ros-args", *arguments)
                self.assertIn(driver.wait(), (1, 2), driver.output)
                self.assertTrue(driver.output.strip())

    def test_what_ros_2_refuses_is_told_with_the_remedy_for_that(self):
        other_file = process.write_map("called_driver:\n  rate: 5\n")
        quotes = "put a value that is not valid YAML into quotes"
        for arguments, remedy in ((("-p", "rate=5"), "; write it as -p NAME:=VALUE"), (("-p", "rate:=[1"), f"; {quotes}"),
                                  (("--params-file", "/nowhere.yaml"), "/nowhere.yaml'. Error: Error opening YAML file; give the path"),
                                  (("--params-file", other_file), "; the file is YAML, as in /press_driver: {ros__parameters: "),
                                  (("-r", "__node:=bad-name"), "; write it as -r FROM:=TO"), (("-r", "__ns:=cell"), "or -r __ns:=/cell"),
                                  (("--log-level", "loud"), "; the levels are debug, info, warn, error and fatal")):
            with self.subTest(arguments):
                driver = process.Process("coupler_driver", "--map", self.map, "--ros-args", *arguments)
                self.assertEqual(driver.wait(), 2, driver.output)
                self.assertIn(remedy, driver.output)
                self.assertEqual(quotes in driver.output, quotes in remedy, driver.output)

    def test_a_middleware_that_is_not_there_is_named(self):
        driver = process.Process("coupler_driver", "--map", self.map, environment={**os.environ, "RMW_IMPLEMENTATION": "rmw_nowhere_cpp"})
        self.assertNotEqual(driver.wait(), 0)
        self.assertIn("rmw_nowhere_cpp", driver.output)

    def test_ros_2s_arguments_without_ros_args_are_told_where_they_belong(self):
        for arguments in (("-p", "rate:=5"), ("-r", "__ns:=/cell"), ("--params-file", "x.yaml"), ("--log-level", "debug"), ("--enclave", "/cell"),
                          ("--disable-rosout-logs",)):
            self.assert_ends(2, "--ros-args", "--map", self.map, *arguments)

    def test_a_wrong_call_ends_with_2_and_says_why(self):
        self.assert_ends(2, "no map; give one by --map MAP")
        self.assert_ends(2, "--speed", "--speed", 5)
        self.assert_ends(2, "port: '70000' is not a whole number from 1 to 65535", "--port", 70000)
        self.assert_ends(2, "verify: 'maybe' is not require, warn or off", "--verify", "maybe")
        self.assert_ends(2, "both map and maps are given", "--maps", self.map, "--map", self.map)

    def test_a_wrong_map_ends_with_1_and_says_where(self):
        path = process.write_map("name: broken\nmapping:\n  coils: {a: 70000}\n")
        for arguments in (("--map", path), ("--ros-args", "-p", f"map:={path}"), ("--ros-args", "-r", "__node:=io", "-p", f"map:={path}")):
            self.assert_ends(1, f"{path}:3:", *arguments)
        self.assert_ends(1, "/nowhere.yaml", "--map", "/nowhere.yaml")
        self.assert_ends(1, f"there is no file {os.getcwd()}/nowhere.yaml; a relative path counts", "--map", "nowhere.yaml")
        path = process.write_map("name: homeless\nmapping:\n  coils: {a: 7}\n")
        self.assert_ends(1, "the map has no address; add 'address: HOST' or give --address HOST", "--map", path)

    def test_a_name_that_ros_2_does_not_take_ends_with_1_and_is_told(self):
        path = process.write_map("name: odd\naddress: 127.0.0.1\nmapping:\n  coils: {a/1b: 7}\n")
        self.assert_ends(1, "a/1b", "--map", path)

    def test_an_address_that_serves_no_map_is_a_foreign_coupler(self):
        self.assert_ends(1, "serves no map", "--address", "127.0.0.1", "--port", self.peer.port)

    def test_help_and_version_need_no_ros(self):
        self.assert_ends(0, "--ros-args", "--help")
        self.assert_ends(0, "coupler_driver 0.", "--version")


class Logs(CallTest):
    def rosout(self):
        subscription = Subscription("/rosout", Log, qos(1000, latched=True))
        self.addCleanup(subscription.close)
        return subscription

    def test_each_request_is_shown_at_debug_level(self):
        program = self.assert_drives("--map", self.map, "--ros-args", "--log-level", "debug")
        program.wait_for("called: read coils 3 to 3: ok after ")
        self.publisher("/called/lamp/write", Bool).publish(True)
        program.wait_for("called: write by FC 5 at 3: ff 00: ok after ")

    def test_the_level_may_be_the_nodes_own(self):
        program = self.assert_drives("--map", self.map, "--ros-args", "--log-level", "called_driver:=debug")
        program.wait_for("called: read coils 3 to 3: ok after ")

    def test_without_it_there_is_no_request_and_with_error_nothing_of_success(self):
        quiet = self.assert_drives("--map", self.map)
        self.assertNotIn("read coils", quiet.output)
        quiet.end()
        driver = self.driver("--map", self.map, "--ros-args", "--log-level", "error")
        self.topic("/called/online", Bool).wait_for(bool)
        self.assertNotIn("connected", driver.output)

    def test_a_line_is_on_rosout_with_level_and_name(self):
        rosout = self.rosout()
        self.assert_drives("--map", self.map)
        line = rosout.wait_for(lambda log: log.msg == "called: connected")
        self.assertEqual((line.name, line.level), ("called_driver", INFO))
        self.peer.stop()
        lost = rosout.wait_for(lambda log: "connection lost" in log.msg)
        self.assertEqual(lost.level, WARN)

    def test_rosout_can_be_left_out_and_the_terminal_stays(self):
        self.assert_drives("--map", self.map, "--ros-args", "--disable-rosout-logs")
        wait_for_graph(lambda node: "called_driver" in node.get_node_names(), "the node")
        published = []
        wait_for_graph(lambda node: published.append(dict(node.get_publisher_names_and_types_by_node("called_driver", "/"))) or
                       "/diagnostics" in published[-1], "its topics")
        self.assertNotIn("/rosout", published[-1])

    def test_the_terminal_can_be_left_out_and_rosout_stays(self):
        rosout = self.rosout()
        driver = self.driver("--map", self.map, "--ros-args", "--disable-stdout-logs")
        rosout.wait_for(lambda log: log.msg == "called: connected")
        self.assertNotIn("connected", driver.output)


if __name__ == "__main__":
    testing.main()
