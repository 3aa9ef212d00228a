# SPDX-License-Identifier: Apache-2.0
"""test/support/ros2, which stands in for ROS 2's command line, takes its options where that does, and says what it has not."""
import pathlib
import subprocess
import sys

from support import process, testing
from support.patience import PATIENCE
from support.peer import Peer
from support.topics import wait_until

ROS2 = str(pathlib.Path(__file__).resolve().parent.parent / "support" / "ros2")
MAP = """
name: {name}
address: 127.0.0.1
port: {port}
rate: 20
mapping:
  coils: {{lamp: 3}}
  holding_registers: {{level: {{address: 4, type: INT}}}}
"""


class StandIn(testing.RosTest):
    def setUp(self):
        self.peer = Peer().start()
        self.addCleanup(self.peer.stop)
        self.peer.set("holding_registers", 4, [33])

    def ros2(self, *words, code=0):
        done = subprocess.run([sys.executable, ROS2, *words], capture_output=True, text=True, timeout=PATIENCE, check=False)
        self.assertEqual(done.returncode, code, (words, done.stdout, done.stderr))
        return done.stdout if code == 0 else done.stderr

    def shows(self, text, *words):
        """A node that has just begun does not know the others yet."""
        wait_until(lambda: text in self.ros2(*words), f"{text} in {words}")

    def test_options_stand_before_and_behind_what_they_belong_to(self):
        driver = self.driver("--map", process.write_map(MAP.format(name="shown", port=self.peer.port)))
        driver.wait_for("connected")
        for words in (["--once", "/shown/level"], ["/shown/level", "--once"], ["-1", "/shown/level"],
                      ["/shown/level", "std_msgs/msg/Int16", "--once"]):
            self.assertEqual(self.ros2("topic", "echo", *words), "data: 33\n---\n", words)
        self.assertEqual(self.ros2("topic", "echo", "--once", "--field", "data", "/shown/level"), "33\n---\n")
        to, kind = "/shown/lamp/write", "std_msgs/msg/Bool"
        for on, words in enumerate((["--once", to, kind, "data: true"], ["-1", to, kind, "{data: false}"],
                                    [to, kind, "data: true", "--once"], [to, "--once", kind, "data: false"],
                                    ["-t", "1", "-w", "1", to, kind, "data: true"])):
            self.assertEqual(self.ros2("topic", "pub", *words), f"publishing #1: std_msgs.msg.Bool(data={on % 2 == 0})\n")
            wait_until(lambda is_on=on % 2 == 0: self.peer.get("coils", 3) == [is_on], "the coil")

    def test_it_shows_nodes_parameters_and_services(self):
        driver = self.driver("--map", process.write_map(MAP.format(name="shown", port=self.peer.port)))
        driver.wait_for("connected")
        self.shows("/shown_driver\n", "node", "list")
        self.assertEqual(self.ros2("param", "get", "/shown_driver", "rate"), "Double value is: 20.0\n")
        self.assertEqual(self.ros2("param", "get", "shown_driver", "name"), "String value is: shown\n")
        self.assertIn("  timeout\n", self.ros2("param", "list", "/shown_driver"))
        self.shows("/shown_driver:\n  address\n", "param", "list")
        self.assertEqual(self.ros2("param", "get", "/shown_driver", "raet"), "Parameter not set.\n")
        self.shows("/shown/write [coupler_driver/srv/Write]\n", "service", "list", "-t")
        self.assertIn("message='ok'", self.ros2("service", "call", "/shown/write", "coupler_driver/srv/Write",
                                                "{point: lamp, value: 'true'}"))

    def test_what_it_has_not_is_said(self):
        self.assertIn("'bag record' is not in this stand-in for ros2", self.ros2("bag", "record", code=1))
        self.assertIn("the following arguments are required: TOPIC", self.ros2("topic", "echo", code=1))
        self.assertIn("unrecognized arguments: --csv", self.ros2("topic", "echo", "/a", "--csv", code=1))
        for words, said in ((["std_msgs/msg/Boolean"], "there is no type 'std_msgs/msg/Boolean'"),
                            (["std_msgs/msg/Bool", "date: true"], "the fields are {'data': 'boolean'}"),
                            (["std_msgs/msg/Bool", "true"], "write them as in 'data: true'")):
            self.assertIn(said, self.ros2("topic", "pub", "--once", "/a", *words, code=1))


if __name__ == "__main__":
    testing.main()
