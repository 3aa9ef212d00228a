# SPDX-License-Identifier: Apache-2.0
"""Several devices in one process: each with its topics, and none waits for another."""
import socket

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from std_msgs.msg import Bool, Int16

from support import levels, process, testing
from support.levels import write_map
from support.ports import free_port
from support.topics import wait_until


class SeveralDevices(levels.LevelsTest):
    at_once = True

    def setUp(self):
        self.press, self.belt = (f"{self.name}_{device}" for device in ("press", "belt"))

    def test_each_spelling_of_the_list_drives_them_all(self):
        press, belt = self.peer(11), self.peer(22)
        maps = [write_map(self.press, press.port), write_map(self.belt, belt.port)]
        rospy.set_param("/cell_io", {"maps": maps})
        self.addCleanup(rospy.delete_param, "/cell_io")
        for arguments in ([f"_maps:=[{maps[0]},{maps[1]}]"], ["--maps", ",".join(maps)], ["__name:=cell_io"]):
            with self.subTest(arguments), process.Driver(*arguments) as driver:
                driver.wait_for(f"{self.press}: connected")
                driver.wait_for(f"{self.belt}: connected")
                self.assertEqual(self.topic(f"/{self.press}/level", Int16).next(), 11)
                self.assertEqual(self.topic(f"/{self.belt}/level", Int16).next(), 22)

    def test_a_dead_device_slows_no_other(self):
        with socket.create_server(("127.0.0.1", 0)) as silent:
            maps = [write_map(f"{self.name}_dead", silent.getsockname()[1]), write_map(f"{self.name}_away", free_port()),
                    write_map(self.belt, self.peer(22).port)]
            self.driver(f"_maps:=[{','.join(maps)}]").wait_for(f"{self.belt}: connected")
            level = self.topic(f"/{self.belt}/level", Int16)
            # The dead one's first request is waited for longer than this is.
            wait_until(lambda: len(level.values) > 40, "two seconds of values")
            self.topic(f"/{self.name}_dead/online", Bool).wait_for(lambda online: not online)
            self.topic(f"/{self.name}_away/online", Bool).wait_for(lambda online: not online)

    def test_each_is_in_the_diagnostics_each_second(self):
        maps = [write_map(f"{self.name}_{i}", self.peer(i).port if i else free_port()) for i in range(5)]
        self.driver(f"_maps:=[{','.join(maps)}]").wait_for(f"{self.name}_4: connected")
        wanted = {f"{self.name}_{i} connection": f"{self.name}_{i} 127.0.0.1:" for i in range(5)}
        diagnostics = self.topic("/diagnostics", DiagnosticArray)

        def own():
            """What each message of this driver has: others tell of theirs on the same topic."""
            messages = [{status.name.partition(": ")[2]: status.hardware_id for status in message.status}
                        for message in list(diagnostics.values)]
            return [told for told in messages if any(self.name in hardware_id for hardware_id in told.values())]

        wait_until(lambda: len(own()) >= 3, "three messages")
        for told in own():
            for name, hardware_id in wanted.items():
                self.assertIn(hardware_id, told[name])

    def test_what_differs_from_a_map_is_a_parameter_below_its_name(self):
        belt = self.peer(22)
        rospy.set_param(f"/{self.press}_driver", {self.belt: {"port": belt.port}})
        self.addCleanup(rospy.delete_param, f"/{self.press}_driver")
        maps = [write_map(self.press, self.peer(11).port), write_map(self.belt, free_port())]
        self.driver(f"_maps:=[{','.join(maps)}]")
        self.assertEqual(self.topic(f"/{self.belt}/level", Int16).next(), 22)
        self.assertEqual(self.topic(f"/{self.press}/level", Int16).next(), 11)

    def test_or_an_argument_of_its_own(self):
        press, belt = self.peer(11), self.peer(22)
        maps = [write_map(self.press, free_port()), write_map(self.belt, free_port())]
        rospy.set_param(f"/{self.press}_driver", {self.belt: {"port": free_port()}})  # weaker than the argument
        self.addCleanup(rospy.delete_param, f"/{self.press}_driver")
        self.driver(f"_maps:=[{','.join(maps)}]", f"_{self.press}/port:={press.port}", f"_{self.belt}/port:={belt.port}")
        self.assertEqual(self.topic(f"/{self.belt}/level", Int16).next(), 22)
        self.assertEqual(self.topic(f"/{self.press}/level", Int16).next(), 11)

    def test_what_is_said_of_all_is_weaker_than_what_is_said_of_one(self):
        rospy.set_param(f"/{self.press}_driver", {self.belt: {"rate": 50}})
        self.addCleanup(rospy.delete_param, f"/{self.press}_driver")
        maps = [write_map(self.press, self.peer(11).port), write_map(self.belt, self.peer(22).port)]
        self.driver(f"_maps:=[{','.join(maps)}]", "--rate", "0.001")
        level = self.topic(f"/{self.belt}/level", Int16)
        wait_until(lambda: len(level.values) > 10, "values at the device's own rate")

    def test_devices_of_one_kind_share_a_map(self):
        left, right = self.peer(11), self.peer(22)
        path = write_map("io", free_port())
        self.driver(f"_maps:=[left={path},right={path}]", f"_left/port:={left.port}", f"_right/port:={right.port}")
        self.assertEqual(self.topic("/left/level", Int16).next(), 11)
        self.assertEqual(self.topic("/right/level", Int16).next(), 22)


class Refused(levels.LevelsTest):
    def assert_ends(self, code, text, *arguments):
        driver = process.Driver(*arguments)
        self.assertEqual(driver.wait(), code, driver.output)
        self.assertIn(text, driver.output)

    def test_what_cannot_be_is_refused_with_a_remedy(self):
        path = write_map("press", 502)
        self.assert_ends(1, "two devices have the name press", f"_maps:=[{path},{write_map('press', 503)}]")
        self.assert_ends(2, "both map and maps are given", f"_maps:=[{path}]", f"_map:={path}")
        self.assert_ends(2, "or give them for each device as in _NAME/address:=HOST", f"_maps:=[{path}]", "_port:=503")
        self.assert_ends(2, "arguments for the device 'belt', but the maps have the names press", f"_map:={path}", "_belt/port:=503")
        self.assert_ends(2, "begins with '_', as in _press/address:=HOST", f"_map:={path}", "press/address:=127.0.0.1")
        self.assertFalse(rospy.has_param("/press_driver/belt"), "a refused argument is not kept as a parameter")
        self.assert_ends(1, "/nowhere.yaml", f"_maps:=[{path},/nowhere.yaml]")


if __name__ == "__main__":
    testing.main()
