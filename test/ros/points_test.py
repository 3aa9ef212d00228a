# SPDX-License-Identifier: Apache-2.0
"""`<name>/points` says what the map does, so that a program need not read it."""
import math
import os

from coupler_driver.msg import Points
from coupler_driver.srv import Write
from std_msgs.msg import Bool

from support import process, testing
from support.actions import topics_below
from support.device import Device
from support.patience import NO_TIMEOUT
from support.topics import type_of

MAP = """
name: {name}
address: 127.0.0.1
rate: 20
timeout: {timeout}s
mapping:
  coils:
    {lamp}: {address: 3, description: above the door}
  input_registers:
    level: {address: 7, type: INT, scale: {gain: 0.5, offset: -10}, units: mm, rate: 5, stamped: true}
    row: {address: 10, type: REAL, count: 3}
  holding_registers:
    mode: {address: 1, type: USINT, bits: [8, 11], values: {0: idle, 5: running}}
    speed: {address: 2, type: UINT, access: write, max: 1000}
    label: {address: 20, type: STRING, length: 6}
"""
ROS2 = os.environ.get("ROS_VERSION") == "2"


class PointsTest(testing.RosTest):
    def start(self, lamp, *arguments):
        device = self.device = Device().start()
        self.addCleanup(device.stop)
        text = MAP.replace("{timeout}", str(NO_TIMEOUT)).replace("{name}", self.name).replace("{lamp}", lamp)
        self.program = self.driver(f"_map:={process.write_map(text)}", f"_port:={device.port}", *arguments)
        self.program.wait_for("connected")

    def test_each_point_is_described(self):
        self.start("lamp")
        told = self.topic(f"/{self.name}/points", Points, latched=True).wait_for(lambda _: True)
        points = {point.name: point for point in told.points}
        self.assertEqual(set(points), {"lamp", "level", "row", "mode", "speed", "label"})
        lamp, level, row, mode, speed, label = (points[name] for name in ("lamp", "level", "row", "mode", "speed", "label"))
        self.assertEqual((lamp.table, lamp.address, lamp.type, lamp.access, lamp.description, lamp.rate),
                         ("coils", 3, "BOOL", "read_write", "above the door", 20))
        self.assertTrue(math.isnan(lamp.min) and math.isnan(label.max))
        self.assertEqual((level.units, level.rate, level.stamped, level.min, level.max, level.access),
                         ("mm", 5, True, -32768 * 0.5 - 10, 32767 * 0.5 - 10, "read"))
        self.assertEqual((row.count, row.type), (3, "REAL"))
        self.assertEqual((list(mode.values), list(mode.value_names), mode.min, mode.max), ([0, 5], ["idle", "running"], 0, 15))
        self.assertEqual((speed.access, speed.rate, speed.min, speed.max), ("write", 0, 0, 1000))
        package = "std_msgs/msg/" if ROS2 else "std_msgs/"
        self.assertEqual([point.message for point in (lamp, level, row, mode, speed, label)],
                         [package + name for name in ("Bool", "Float64", "Float32MultiArray", "UInt8", "UInt16", "String")])

    def test_only_points_that_are_chosen_have_topics(self):
        self.start("lamp", "_topics:=l*,mdoe")
        self.program.wait_for("'topics' has 'mdoe', and no point has such a name; did you mean 'mode'")
        self.topic(f"/{self.name}/lamp", Bool).wait_for(lambda message: message is False)
        names = {topic.split("/")[2] for topic in topics_below(f"/{self.name}/")}
        self.assertTrue({"lamp", "level", "label"} <= names, names)
        self.assertFalse({"row", "mode", "speed"} & names, names)
        self.assertTrue(self.service(f"/{self.name}/write", Write)("speed", "7").success, "services reach the others, too")
        self.assertEqual(self.device.tables["holding_registers"][2], 7)

    def test_a_point_of_that_name_keeps_its_topic(self):
        self.start("points")
        self.topic(f"/{self.name}/points", Bool).wait_for(lambda message: message is False)
        self.assertIs(type_of(f"/{self.name}/points"), Bool)


if __name__ == "__main__":
    testing.main()
