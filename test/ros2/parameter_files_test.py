# SPDX-License-Identifier: Apache-2.0
"""Parameters by --params-file: which section is whose, what overrides what, and what is told of names that mean nothing."""
from std_msgs.msg import Int16

from support import process, testing
from support.parameters import Parameters, write_parameters
from support.peer import Peer
from support.ports import free_port
from support.topics import wait_until

MAP = """
name: {name}
address: 127.0.0.1
port: {port}
timeout: 60
mapping:
  holding_registers: {{level: {{address: 4, type: INT}}}}
"""


class FilesTest(testing.RosTest):
    def setUp(self):
        self.peer = Peer().start()
        self.addCleanup(self.peer.stop)
        self.peer.set("holding_registers", 4, [33])

    def map(self, name="filed", port=None):
        return process.write_map(MAP.format(name=name, port=port or free_port()))

    def start(self, sections, *arguments, more=()):
        return self.driver(*arguments, "--ros-args", "--params-file", write_parameters(sections), *more)

    def assert_drives(self, topic="/filed/level"):
        self.assertEqual(self.topic(topic, Int16).next(), 33)


class Sections(FilesTest):
    def test_a_section_is_the_nodes_by_its_name_by_a_wildcard_or_for_all(self):
        for section, more in (("filed_driver", ()), ("/filed_driver", ()), ("/**", ()),
                              ("/cell/filed_driver", ("-r", "__ns:=/cell")), ("/*/filed_driver", ("-r", "__ns:=/cell")),
                              ("/cell/*", ("-r", "__ns:=/cell")), ("/**/filed_driver", ("-r", "__ns:=/cell/left"))):
            with self.subTest(section):
                program = self.start({f'"{section}"': f"port: {self.peer.port}"}, "--map", self.map(), more=more)
                self.assert_drives(f"{more[1].partition(':=')[2] if more else ''}/filed/level")
                self.assertNotIn("WARN", program.output)
                program.end()

    def test_a_map_in_a_section_for_all_names_the_node(self):
        self.start({"/**": f"map: {self.map(port=self.peer.port)}\nrate: 50"})
        self.assert_drives()
        self.assertEqual(Parameters("/filed_driver").get("rate"), [50.0])

    def test_a_node_that_was_given_its_name_finds_its_map_in_its_section(self):
        self.start({"arm_io": f"map: {self.map(port=self.peer.port)}", "/other_io": "map: /nowhere.yaml"}, more=("-r", "__node:=arm_io"))
        self.assert_drives()

    def test_the_section_of_the_node_may_name_its_device_anew(self):
        self.start({"/arm_io": f"map: {self.map(port=self.peer.port)}\nname: arm"}, more=("-r", "__node:=arm_io"))
        self.assert_drives("/arm/level")

    def test_an_argument_overrides_a_parameter_and_that_the_map(self):
        sections = {"/**": f"port: {self.peer.port}"}
        first = self.start(sections, "--map", self.map())
        self.assert_drives()
        first.end()
        self.start({"/**": f"port: {free_port()}"}, "--map", self.map(), "--port", self.peer.port)
        self.assert_drives()

    def test_the_later_of_two_files_wins(self):
        second = write_parameters({"filed_driver": f"port: {self.peer.port}"})
        self.start({"filed_driver": f"port: {free_port()}"}, "--map", self.map(), more=("--params-file", second))
        self.assert_drives()

    def test_what_is_one_devices_stands_below_its_name_in_either_form(self):
        maps = [self.map("press", self.peer.port), self.map("belt")]
        for text in (f"belt:\n      port: {self.peer.port}", f"belt.port: {self.peer.port}"):
            with self.subTest(text):
                program = self.start({"press_driver": text}, "--maps", ",".join(maps))
                self.assert_drives("/belt/level")
                self.assertNotIn("WARN", program.output)
                program.end()

    def test_a_section_that_fits_no_node_is_told_with_the_name_that_would(self):
        program = self.start({"filed": f"address: 10.0.0.7\nport: {free_port()}"}, "--map", self.map(port=self.peer.port))
        self.assert_drives()
        program.wait_for("WARN")
        self.assertRegex(program.output, r"WARN.*/filed\b.*/filed_driver")

    def test_a_section_for_another_driver_beside_the_nodes_own_is_nobodys_mistake(self):
        program = self.start({"filed_driver": f"port: {self.peer.port}", "press_driver": "map: /nowhere.yaml"}, "--map", self.map())
        self.assert_drives()
        program.wait_for("connected")
        self.assertNotIn("WARN", program.output)


class Names(FilesTest):
    def told(self, sections, *arguments):
        """The warnings of a driver that drives."""
        program = self.start(sections, "--map", self.map(port=self.peer.port), *arguments)
        program.wait_for("connected")
        self.assert_drives()
        program.end()
        return [line for line in program.output.splitlines() if "WARN" in line and "parameter" in line]

    def test_an_unknown_name_is_told_in_the_nodes_own_section(self):
        lines = self.told({"filed_driver": "raet: 20\ncolour: red"})
        self.assertEqual(len(lines), 2, lines)
        self.assertRegex(lines[0] + lines[1], r"raet.* is not a setting.*did you mean 'rate'\?")
        self.assertRegex(lines[0] + lines[1], r"colour.* is not a setting")

    def test_for_all_nodes_only_what_is_nearly_a_setting_is_told(self):
        lines = self.told({"/**": "rte: 20\ncolour: red\nmax_velocity: 2.0\nuse_sim_time: false"})
        self.assertEqual(len(lines), 1, lines)
        self.assertRegex(lines[0], r"rte.*did you mean 'rate'\?")

    def test_what_is_ros_2s_own_is_never_told(self):
        for section in ("filed_driver", "/**"):
            self.assertEqual(self.told({section: "use_sim_time: false\nqos_overrides:\n      /filed/level:\n        publisher:\n"
                                                 "          depth: 5"}), [])

    def test_an_unknown_name_of_a_device_is_told(self):
        maps = [self.map("press", self.peer.port), self.map("belt", self.peer.port)]
        program = self.start({"press_driver": "belt.prot: 5\nbelt.rate: 5"}, "--maps", ",".join(maps))
        program.wait_for("belt.prot")
        self.assertRegex(program.output, r"WARN.*belt\.prot.*did you mean 'port'\?")

    def test_a_file_that_is_not_there_or_no_file_of_parameters_ends_the_call(self):
        for path in ("/nowhere.yaml", process.write_map("just: text\n")):
            driver = process.Driver("--map", self.map(), "--ros-args", "--params-file", path)
            self.assertIn(driver.wait(), (1, 2), driver.output)
            self.assertIn(path, driver.output)


class Given(FilesTest):
    def test_a_parameter_for_one_node_of_the_call_is_its_own(self):
        self.driver("--map", self.map(), "--ros-args", "-p", f"filed_driver:port:={self.peer.port}", "-p", "other:port:=1")
        self.assert_drives()
        wait_until(lambda: Parameters("/filed_driver").get("port") == [self.peer.port], "the port")


if __name__ == "__main__":
    testing.main()
