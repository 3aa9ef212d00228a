# SPDX-License-Identifier: Apache-2.0
"""YAML makes numbers, truth values and lists of words that a user meant as they stand: they are understood, or refused with
the spelling that is."""
import socket

from std_msgs.msg import Int16

from support import process, testing
from support.parameters import Parameters, write_parameters
from support.patience import PATIENCE
from support.peer import Peer
from support.ports import free_port

MAP = """
name: spelt
address: {address}
port: {port}
timeout: 60
mapping:
  holding_registers: {{level: {{address: 4, type: INT}}}}
"""


class Spellings(testing.RosTest):
    def setUp(self):
        self.peer = Peer().start()
        self.addCleanup(self.peer.stop)
        self.peer.set("holding_registers", 4, [33])
        self.map = process.write_map(MAP.format(address="127.0.0.1", port=self.peer.port))

    def ways(self, name, value):
        """Of saying it: by -p and in a file."""
        yield "-p", f"{name}:={value}"
        yield "--params-file", write_parameters({"/**": f"{name}: {value}"})

    def assert_taken(self, name, value, expected):
        for way in self.ways(name, value):
            with self.subTest(f"{name}: {value}", by=way[0]):
                driver = self.driver("--map", self.map, "--ros-args", *way)
                driver.wait_for("connected")
                self.assertEqual(Parameters("/spelt_driver").get(name), [expected])
                self.assertEqual(self.topic("/spelt/level", Int16).next(), 33)
                driver.end()

    def assert_refused(self, name, value, *texts):
        for way in self.ways(name, value):
            with self.subTest(f"{name}: {value}", by=way[0]):
                driver = process.Driver("--map", self.map, "--ros-args", *way)
                self.assertIn(driver.wait(), (1, 2), driver.output)
                for text in texts:
                    self.assertIn(text, driver.output)

    def test_off_is_a_word_of_verify(self):
        self.assert_taken("verify", "off", "off")

    def test_a_whole_number_is_a_number(self):
        self.assert_taken("rate", "50", 50.0)
        self.assert_taken("timeout", "2", 2.0)

    def test_a_number_in_quotes_is_a_number(self):
        self.assert_taken("rate", "'50'", 50.0)
        self.assert_taken("port", f"'{self.peer.port}'", self.peer.port)

    def test_a_truth_value_in_quotes_is_that_value(self):
        self.assert_taken("use_sim_time", "'false'", False)
        self.assert_refused("use_sim_time", "1", "use_sim_time: '1' is not true or false")

    def test_a_word_in_quotes_is_the_word(self):
        self.assert_taken("verify", "'warn'", "warn")
        self.assert_taken("poll", '"all"', "all")

    def test_an_empty_text_says_nothing(self):
        self.assert_taken("name", "''", "spelt")

    def test_an_ipv6_address_may_stand_in_brackets(self):
        # In quotes: without them it is a list to YAML, and of no element that ROS 2's reader takes.
        for way in (*self.ways("address", "'[::1]'"), *self.ways("address", "'::1'"), *self.ways("address", "['::1']")):
            with self.subTest(way), socket.create_server(("::1", 0), family=socket.AF_INET6) as server:
                server.settimeout(PATIENCE)
                driver = self.driver("--map", self.map, "--port", server.getsockname()[1], "--ros-args", *way)
                server.accept()[0].close()
                driver.end()

    def test_what_is_no_yaml_is_refused_with_the_quoted_spelling(self):
        self.assert_refused("address", "[::1]", "quotes", "'")

    def test_a_list_of_maps_is_a_list_or_a_text(self):
        other = process.write_map(MAP.format(address="127.0.0.1", port=self.peer.port).replace("spelt", "other"))
        for value in (f"[{self.map}, {other}]", f"'{self.map},{other}'", f"[spelt={self.map}, other={other}]"):
            for way in self.ways("maps", value):
                with self.subTest(value, by=way[0]):
                    driver = self.driver("--ros-args", *way)
                    driver.wait_for("other: connected")
                    self.assertEqual(len(Parameters("/spelt_driver").get("maps")[0]), 2)
                    driver.end()

    def test_a_number_as_a_name_is_that_name(self):
        # ROS 2 takes no topic that begins with a digit: that it is refused by this name shows that it was understood.
        for way in self.ways("name", "42"):
            driver = process.Driver("--map", self.map, "--ros-args", *way)
            self.assertEqual(driver.wait(), 1, driver.output)
            self.assertIn("42", driver.output)

    def test_what_is_no_text_any_more_is_refused_with_the_quoted_spelling(self):
        self.assert_refused("name", "on", "name", "quotes", "'")
        self.assert_refused("name", "1e3", "name", "quotes", "'")
        self.assert_refused("address", "1.5", "address", "quotes")
        self.assert_refused("poll", "on", "poll")

    def test_a_wrong_value_is_refused_with_what_it_should_have_been(self):
        self.assert_refused("rate", "fast", "rate: 'fast' is not a number from 0.001 to 10000")
        self.assert_refused("port", "70000", "port: '70000' is not a whole number from 1 to 65535")
        self.assert_refused("port", "1.5", "port: '1.5' is not a whole number from 1 to 65535")
        self.assert_refused("unit", "-1", "unit: '-1' is not a whole number from 0 to 255")
        self.assert_refused("verify", "maybe", "verify: 'maybe' is not require, warn or off")
        self.assert_refused("verify", "on", "verify")
        self.assert_refused("poll", "some", "poll: 'some' is not all or subscribed")
        self.assert_refused("address", "10.0.0.7:502", "address: '10.0.0.7:502' has a port; write 'port: 502' beside it")

    def test_a_setting_of_one_device_is_spelt_alike(self):
        other = process.write_map(MAP.format(address="127.0.0.1", port=free_port()).replace("spelt", "other"))
        maps = f"{self.map},{other}"
        driver = self.driver("--maps", maps, "--ros-args", "-p", f"other.port:='{self.peer.port}'", "-p", "other.verify:=off",
                             "-p", "other.rate:=30")
        driver.wait_for("other: connected")
        self.assertEqual(Parameters("/spelt_driver").get("other.rate", "other.verify"), [30.0, "off"])
        refused = process.Driver("--maps", maps, "--ros-args", "-p", "other.port:=0")
        self.assertIn(refused.wait(), (1, 2), refused.output)
        self.assertIn("other.port", refused.output)


if __name__ == "__main__":
    testing.main()
