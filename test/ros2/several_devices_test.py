# SPDX-License-Identifier: Apache-2.0
"""Several devices in one process and several drivers at once: each with its topics, and none waits for another."""
import socket

from coupler_driver.srv import Write
from std_msgs.msg import Bool, Int16

from support import levels, testing
from support.levels import write_map
from support.parameters import Parameters, write_parameters
from support.ports import free_port
from support.topics import wait_until


class SeveralTest(levels.LevelsTest):
    def reads(self, **levels):
        for name, level in levels.items():
            self.assertEqual(self.topic(f"/{name}/level", Int16).next(), level)


class OneProcess(SeveralTest):
    def test_each_spelling_of_the_list_drives_them_all(self):
        maps = [write_map("press", self.peer(11).port), write_map("belt", self.peer(22).port)]
        joined = ",".join(maps)
        file = write_parameters({"/**": f"maps: [{joined}]"})
        lines = write_parameters({"/**": "maps:\n" + "\n".join(f"  - {path}" for path in maps)})
        for arguments in (["--maps", joined], [f"--maps=[{joined}]"], ["--ros-args", "-p", f"maps:=[{joined}]"],
                          ["--ros-args", "--params-file", file], ["--ros-args", "--params-file", lines],
                          ["--ros-args", "-r", "__node:=cell_io", "-p", f"maps:=[{joined}]"]):
            with self.subTest(arguments):
                driver = self.driver(*arguments)
                self.reads(press=11, belt=22)
                driver.end()

    def test_a_dead_device_slows_no_other(self):
        silent = self.enterContext(socket.create_server(("127.0.0.1", 0)))
        maps = [write_map("dead", silent.getsockname()[1]), write_map("away", free_port()), write_map("belt", self.peer(22).port)]
        self.driver("--maps", ",".join(maps)).wait_for("belt: connected")
        level = self.topic("/belt/level", Int16)
        # The dead one's first request is waited for longer than this is.
        wait_until(lambda: len(level.values) > 40, "two seconds of values")
        self.topic("/dead/online", Bool).wait_for(lambda online: not online)
        self.topic("/away/online", Bool).wait_for(lambda online: not online)
        self.assertFalse(self.service("/away/write", Write)("level", "1").success)
        self.assertTrue(self.service("/belt/write", Write)("level", "23").success)

    def test_devices_of_one_kind_share_a_map(self):
        path = write_map("io", free_port())
        self.driver("--maps", f"left={path},right={path}", "--ros-args", "-p", f"left.port:={self.peer(11).port}",
                    "-p", f"right.port:={self.peer(22).port}")
        self.reads(left=11, right=22)

    def test_what_is_said_of_all_is_weaker_than_what_is_said_of_one(self):
        maps = [write_map("press", self.peer(11).port), write_map("belt", self.peer(22).port)]
        self.driver("--maps", ",".join(maps), "--rate", 10, "--ros-args", "-p", "belt.rate:=40", "-p", "rate:=30")
        self.reads(press=11, belt=22)
        self.assertEqual(Parameters("/press_driver").get("press.rate", "belt.rate"), [10.0, 40.0])

    def test_what_cannot_be_is_refused_with_a_remedy(self):
        path = write_map("press", 502)
        self.assert_ends(1, "two devices have the name press", "--maps", f"{path},{write_map('press', 503)}")
        self.assert_ends(2, "both map and maps are given", "--maps", path, "--map", path)
        self.assert_ends(2, "--ros-args -p NAME.address:=HOST", "--maps", path, "--port", 503)
        self.assert_ends(1, "/nowhere.yaml", "--maps", f"{path},/nowhere.yaml")


class SeveralProcesses(SeveralTest):
    def test_drivers_of_two_devices_run_side_by_side(self):
        press, belt = self.peer(11), self.peer(22)
        drivers = [self.driver("--map", write_map(name, peer.port)) for name, peer in (("press", press), ("belt", belt))]
        self.reads(press=11, belt=22)
        for name, peer in (("press", press), ("belt", belt)):
            self.publisher(f"/{name}/level/write", Int16).publish(-5)
            wait_until(lambda p=peer: p.get("holding_registers", 4) == [0xFFFB], f"the write to {name}")
        drivers[0].end()
        self.topic("/belt/level", Int16).next()
        self.assertNotIn("publishes", drivers[1].output)

    def test_two_of_one_map_live_in_two_namespaces(self):
        left, right = self.peer(11), self.peer(22)
        path = write_map("io", free_port())
        drivers = [self.driver("--map", path, "--port", peer.port, "--ros-args", "-r", f"__ns:=/{space}")
                   for space, peer in (("left", left), ("right", right))]
        self.reads(**{"left/io": 11, "right/io": 22})
        for driver in drivers:
            self.assertNotIn("publishes", driver.output)


if __name__ == "__main__":
    testing.main()
