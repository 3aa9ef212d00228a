# SPDX-License-Identifier: Apache-2.0
"""The launch files, by roslaunch and rostest as a user calls them."""
import pathlib
import shutil
import signal
import subprocess
import tempfile
import unittest

import roslaunch.config
import roslaunch.node_args
import rosnode
import rospy
from std_msgs.msg import Bool, Int16

from support import process, testing
from support.patience import PATIENCE
from support.peer import Peer
from support.ports import free_port

HERE = pathlib.Path(__file__).resolve().parent
SORTER = HERE.parent.parent / "config" / "examples" / "sorter" / "sorter.yaml"
DEVICE = str(HERE.parent.parent / "config" / "launch" / "ros1" / "device.xml")
MAP = """
name: {name}
address: 192.0.2.1
mapping:
  holding_registers: {{level: {{address: 4, type: INT}}}}
"""


@unittest.skipUnless(shutil.which("roslaunch") and shutil.which("rostest"),
                     "no roslaunch or rostest (scripts/install-packages ros test)")
class Launch(testing.RosTest):
    at_once = True

    def launch(self, *arguments):
        log = tempfile.NamedTemporaryFile("w+")
        self.addCleanup(log.close)
        child = subprocess.Popen(["roslaunch", f"--sigint-timeout={PATIENCE}", *arguments], stdin=subprocess.DEVNULL, stdout=log, stderr=log)

        def end():
            child.send_signal(signal.SIGINT)
            child.wait(2 * PATIENCE)
            log.seek(0)
            text = log.read()
            self.assertNotIn("escalating", text, "a program did not end on SIGINT")
            self.assertNotIn("same name", text, "another launch ended this one's node")

        self.addCleanup(end)

    def peer(self, level):
        peer = Peer().start()
        self.addCleanup(peer.stop)
        peer.set("holding_registers", 4, [level])
        return peer

    def test_device_launch_takes_the_map_and_what_differs_from_it(self):
        peer = self.peer(33)
        self.launch("coupler_driver", "device.launch", f"map:={process.write_map(MAP.format(name='launched'))}",
                    f"name:={self.name}", "address:=127.0.0.1", f"port:={peer.port}", "rate:=50", f"node:={self.name}_io")
        self.assertEqual(self.topic(f"/{self.name}/level", Int16).next(), 33)

    def test_an_argument_that_is_empty_may_be_passed_on(self):
        peer = self.peer(33)
        path = process.write_map(f"""<launch>
          <arg name="serial_port" default=""/>
          <node pkg="coupler_driver" type="coupler_driver" name="{self.name}_io" args="_pin:=$(arg serial_port)">
            <param name="map" value="{process.write_map(MAP.format(name=self.name))}"/>
            <param name="address" value="127.0.0.1"/>
            <param name="port" value="{peer.port}"/>
            <param name="serial" value="$(arg serial_port)"/>
            <param name="certificate" value=""/>
          </node>
        </launch>""", suffix=".launch")
        self.launch(path)
        self.assertEqual(self.topic(f"/{self.name}/level", Int16).next(), 33)

    def test_two_devices_are_launched_side_by_side(self):
        levels = {f"{self.name}_press": 11, f"{self.name}_belt": 22}
        for name, level in levels.items():
            path = pathlib.Path(process.write_map(MAP.format(name=name)))
            self.launch("coupler_driver", "device.launch", f"map:={path.rename(path.with_name(f'{name}.yaml'))}",
                        "address:=127.0.0.1", f"port:={self.peer(level).port}")
        topics = {name: self.topic(f"/{name}/level", Int16) for name in levels}
        for _ in range(3):
            for name, level in levels.items():
                self.assertEqual(topics[name].next(), level)
        self.assertLessEqual({f"/{name}_driver" for name in levels}, set(rosnode.get_node_names()))

    def test_the_node_is_named_after_what_tells_devices_apart(self):
        for arguments, node in ((["map:=/cell/press.v2.yaml"], "/press_v2_driver"),
                                (["map:=/cell/24v.json"], "/coupler_24v_driver"),
                                (["map:=/cell/press.yaml", "name:=hall/left"], "/hall_left_driver"),
                                (["map:=tcp://192.168.1.17:5020/3"], "/coupler_192_168_1_17_5020_3_driver"),
                                (["address:=raspberrypi"], "/raspberrypi_driver"),
                                (["address:=10.0.0.1", "port:=5020", "unit:=7"], "/coupler_10_0_0_1_5020_unit7_driver"),
                                (["map:=rtu:/dev/ttyUSB0/17?baud=9600"], "/dev_ttyUSB0_17_driver"),
                                (["map:=rtu+tcp://10.0.0.1:4001/3"], "/coupler_10_0_0_1_4001_3_driver"),
                                (["serial:=/dev/ttyUSB0", "unit:=7"], "/dev_ttyUSB0_unit7_driver"),
                                (["map:=/cell/press.yaml", "node:=mine"], "/mine")):
            # What `roslaunch --nodes` does, without a process for each.
            config = roslaunch.config.load_config_default([(DEVICE, arguments)], None, assign_machines=False)
            self.assertEqual(roslaunch.node_args.get_node_list(config), [node], arguments)

    def test_devices_launch_takes_a_list(self):
        maps = []
        for name, level in ((f"{self.name}_press", 11), (f"{self.name}_belt", 22)):
            text = MAP.format(name=name).replace("192.0.2.1", "127.0.0.1") + f"port: {self.peer(level).port}\n"
            maps.append(process.write_map(text))
        self.launch("coupler_driver", "devices.launch", f"maps:=[{', '.join(maps)}]")
        self.assertEqual(self.topic(f"/{self.name}_press/level", Int16).next(), 11)
        self.assertEqual(self.topic(f"/{self.name}_belt/level", Int16).next(), 22)

    def test_a_launch_takes_nothing_from_the_parameters_of_an_earlier_one(self):
        rospy.set_param("/later_driver/maps", ["/nowhere/earlier.yaml"])
        rospy.set_param("/later_driver/unit", 77)
        peer = self.peer(44)
        self.launch("coupler_driver", "device.launch", f"map:={process.write_map(MAP.format(name='later'))}",
                    "name:=later", "address:=127.0.0.1", f"port:={peer.port}")
        self.assertEqual(self.topic("/later/level", Int16).next(), 44)

    @unittest.skipUnless(process.has_node(), "coupler-node was not built")
    def test_the_example_application_works_in_a_namespace(self):
        node = process.Node(SORTER, port=free_port())
        self.addCleanup(node.end)
        file = process.write_map(f"""<launch>
  <include ns="{self.name}" file="$(find coupler_driver)/launch/sorter.launch">
    <arg name="port" value="{node.port}"/>
    <arg name="device" value="belt"/>
    <arg name="duration" value="0.1"/>
  </include>
</launch>""", ".launch")
        self.launch(file)
        ejector = self.topic(f"/{self.name}/belt/ejector", Bool)
        ejector.wait_for(lambda on: on)
        ejector.becomes(False)

    @unittest.skipUnless(process.has_node(), "coupler-node was not built")
    def test_the_simulated_cell_passes_its_rostest(self):
        with tempfile.NamedTemporaryFile("w+") as log:
            code = subprocess.run(["rostest", "--reuse-master", "--text", str(HERE / "simulated.test"),
                                   f"port:={free_port()}"], stdout=log, stderr=log, timeout=4 * PATIENCE, check=False).returncode
            log.seek(0)
            self.assertEqual(code, 0, log.read())


if __name__ == "__main__":
    testing.main()
