# SPDX-License-Identifier: Apache-2.0
"""What rqt_logger_level and rqt_console do with a driver."""
import rospy
from roscpp.srv import GetLoggers, SetLoggerLevel
from std_msgs.msg import Bool

from support import process, testing
from support.device import Device
from support.patience import NO_TIMEOUT, PATIENCE

MAP = f"""
name: told
address: 127.0.0.1
rate: 20
timeout: {NO_TIMEOUT}s
mapping:
  coils: {{lamp: 3}}
  input_registers: {{level: {{address: 0, type: INT}}}}
"""


class Logging(testing.RosTest):
    def setUp(self):
        self.device = Device().start()
        self.addCleanup(self.device.stop)
        self.program = self.driver(f"_map:={process.write_map(MAP)}", f"_port:={self.device.port}")
        self.program.wait_for("connected")

    def call(self, name, kind, *arguments):
        rospy.wait_for_service(f"/told_driver/{name}", PATIENCE)
        return rospy.ServiceProxy(f"/told_driver/{name}", kind)(*arguments)

    def levels(self):
        return {logger.name: logger.level for logger in self.call("get_loggers", GetLoggers).loggers}

    def test_asking_for_the_loggers_does_no_harm(self):
        for _ in range(5):
            self.assertEqual(self.levels(), {"ros": "info", "ros.coupler_driver": "info"})
        self.call("set_logger_level", SetLoggerLevel, "ros.coupler_driver", "warn")
        self.assertEqual(self.levels(), {"ros": "info", "ros.coupler_driver": "warn"})
        self.topic("/told/lamp", Bool).next()
        self.assertEqual(self.program.interrupt(), 0, "nor at its end")

    def test_each_request_is_shown_at_debug_level(self):
        self.assertNotIn("read coils", self.program.output)
        self.call("set_logger_level", SetLoggerLevel, "ros.coupler_driver", "debug")
        self.program.wait_for("told: read coils 3 to 3: ok after ")
        self.program.wait_for("told: read input_registers 0 to 0: ok after ")
        self.publisher("/told/lamp/write", Bool).publish(True)
        self.program.wait_for("told: write by FC 5 at 3: ff 00: ok after ")


if __name__ == "__main__":
    testing.main()
