# SPDX-License-Identifier: Apache-2.0
"""The drivers of ROS 1 and ROS 2 on one node at once: each reads what the other writes, and nobody's values mix. What belongs to
ROS 1 runs in processes with an environment of their own."""
import os
import pathlib
import subprocess
import unittest
import unittest.mock

from coupler_driver.srv import Write
from std_msgs.msg import Bool, UInt16

from support import process, testing
from support.patience import NO_TIMEOUT, PATIENCE
from support.topics import types, wait_until

ROS1 = pathlib.Path(os.environ["COUPLER_ROS1_BUILD"])
MASTER = pathlib.Path(__file__).resolve().parent.parent / "support" / "ros-master"
MAP = f"""
name: shared
address: 127.0.0.1
rate: 20
timeout: {NO_TIMEOUT}s
mapping:
  coils: {{lamp: {{address: 3, line: GPIO17}}}}
  holding_registers:
    speed: {{address: 7, type: UINT}}
    torque: {{address: 8, type: UINT}}
"""


class Ros1:
    """ROS 1's tools, as a shell of their own would have them."""

    def __init__(self, test):
        script = f'set +u; source "{ROS1}/devel/setup.bash"; env -0'
        clean = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "HOME": os.environ.get("HOME", "/"), "ROS_HOSTNAME": "localhost",
                 "ROS_HOME": os.environ["ROS_HOME"], "PYTHONDONTWRITEBYTECODE": "1"}
        listed = subprocess.run(["/bin/bash", "-c", script], env=clean, check=True, capture_output=True, text=True).stdout
        self._environment = dict(pair.split("=", 1) for pair in listed.split("\0") if pair)
        self._environment["PATH"] += f":{ROS1}/bin"
        self._test = test
        master = subprocess.Popen([MASTER], env=self._environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        test.addCleanup(self._end, master)
        self._environment["ROS_MASTER_URI"] = master.stdout.readline().strip()

    @staticmethod
    def _end(child):
        child.terminate()
        child.wait(PATIENCE)
        child.stdout.close()

    def driver(self, *arguments):
        with unittest.mock.patch.object(process, "BUILD", ROS1):
            driver = process.Process("coupler_driver", *arguments, environment=self._environment)
        self._test.addCleanup(driver.end)
        return driver

    def call(self, *words):
        return subprocess.run(words, env=self._environment, check=True, capture_output=True, text=True, timeout=PATIENCE).stdout

    def read(self, point):
        return self.call("rosservice", "call", "/shared/read", point)

    def write(self, point, value):
        return self.call("rosservice", "call", "/shared/write", point, f"'{value}'")

    def echo(self, topic):
        return self.call("rostopic", "echo", "-n", "1", topic)


@unittest.skipUnless(process.has_node(), "coupler-node was not built")
@unittest.skipUnless((ROS1 / "devel" / "setup.bash").exists() and (ROS1 / "bin" / "coupler_driver").exists(),
                     "the driver for ROS 1 was not built")
class Both(testing.RosTest):
    def setUp(self):
        path = process.write_map(MAP)
        node = process.Node(path)
        self.addCleanup(node.end)
        self.port = node.port
        self.ros1 = Ros1(self)
        self.old = self.ros1.driver(f"_map:={path}", f"_port:={self.port}")
        self.new = self.driver("--map", path, "--port", self.port)
        for driver in (self.old, self.new):
            driver.wait_for("shared: connected")

    def test_each_reads_what_the_other_writes(self):
        speed = self.topic("/shared/speed", UInt16)
        for value in (1, 40000):
            self.assertIn("success: True", self.ros1.write("speed", value))
            speed.wait_for(lambda now, wanted=value: now == wanted)
            self.publisher("/shared/torque/write", UInt16).publish(value)
            self.topic("/shared/torque", UInt16).wait_for(lambda now, wanted=value: now == wanted)
            self.assertIn(f'value: "{value}"', self.ros1.read("torque"))
            self.assertIn(f"data: {value}", self.ros1.echo("/shared/torque"))
        self.assertTrue(self.service("/shared/write", Write)("lamp", "true").success)
        self.assertIn("data: True", self.ros1.echo("/shared/lamp"))
        self.ros1.call("rostopic", "pub", "--once", "/shared/lamp/write", "std_msgs/Bool", "false")
        self.topic("/shared/lamp", Bool).wait_for(lambda on: not on)

    def test_types_and_names_are_the_same_in_both(self):
        topics = self.ros1.call("rostopic", "list").split()
        for name in ("speed", "torque", "lamp", "online", "status", "speed/write"):
            self.assertIn(f"/shared/{name}", topics)
            kind = self.ros1.call("rostopic", "type", f"/shared/{name}").strip().replace("/", "/msg/")
            wait_until(lambda n=name, k=kind: types().get(f"/shared/{n}") == [k], f"{name} as {kind}")

    def test_one_that_ends_leaves_the_other(self):
        self.new.end()
        self.assertIn("success: True", self.ros1.write("speed", 5))
        self.assertIn('value: "5"', self.ros1.read("speed"))
        again = self.driver("--address", "127.0.0.1", "--port", self.port)
        again.wait_for("shared: connected")
        self.old.end()
        self.publisher("/shared/speed/write", UInt16).publish(6)
        self.topic("/shared/speed", UInt16).wait_for(lambda value: value == 6)


if __name__ == "__main__":
    testing.main()
