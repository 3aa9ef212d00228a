# SPDX-License-Identifier: Apache-2.0
"""/diagnostics as robot monitors read it, and the stamps of what the driver says: of the system's clock, or of /clock where
use_sim_time says so. Values go by neither; their stamps, and the times at which something is to be written, are wall time."""
import socket
import threading
import time

from builtin_interfaces.msg import Time
from coupler_driver.msg import PointStatus, Status, UInt64Stamped
from coupler_driver.srv import Schedule
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Bool, UInt16

from support import process, testing
from support.device import Device
from support.parameters import BOOL, Parameters, parameter
from support.patience import NO_TIMEOUT
from support.ports import free_port
from support.times import ROUNDING, ros_duration, ros_time, seconds
from support.topics import Publisher, Subscription, qos

MAP = """
name: {name}
address: 127.0.0.1
port: {port}
rate: 20
timeout: {timeout}s
mapping:
  holding_registers: {{level: {{address: 4, type: UINT, stamped: true}}}}
"""
LATER = 3000  # seconds
PARTS = ("connection", "polling", "writes")


class DiagnosticsTest(testing.RosTest):
    def setUp(self):
        self.device = Device().start()
        self.addCleanup(self.device.stop)
        self.all = Subscription("/diagnostics", DiagnosticArray, qos(100))
        self.status = Subscription("/plant/status", Status)
        for one in (self.all, self.status):
            self.addCleanup(one.close)

    def start(self, *arguments, names=("plant",)):
        maps = [process.write_map(MAP.format(name=name, port=self.device.port, timeout=NO_TIMEOUT)) for name in names]
        driver = self.driver("--maps", ",".join(maps), *arguments)
        driver.wait_for(f"{names[-1]}: connected")
        return driver


class Diagnostics(DiagnosticsTest):
    def test_entries_are_named_after_the_node_the_device_and_the_part(self):
        self.start(names=("plant", "belt"))
        message = self.all.wait_for(lambda one: one.status)
        self.assertEqual([entry.name for entry in message.status],
                         [f"plant_driver: {name} {part}" for name in ("plant", "belt") for part in PARTS])
        self.assertEqual({entry.hardware_id for entry in message.status},
                         {f"{name} 127.0.0.1:{self.device.port} unit 1" for name in ("plant", "belt")})

    def test_of_a_node_with_a_name_and_a_namespace_the_name_counts(self):
        self.start("--ros-args", "-r", "__node:=io", "-r", "__ns:=/cell")
        message = self.all.wait_for(lambda one: one.status)
        self.assertEqual([entry.name for entry in message.status], [f"io: plant {part}" for part in PARTS])

    def test_all_is_ok_with_figures_until_the_device_goes(self):
        self.start()
        message = self.all.wait_for(lambda one: all(entry.level == DiagnosticStatus.OK for entry in one.status))
        figures = [{pair.key: pair.value for pair in entry.values} for entry in message.status]
        self.assertEqual(figures[0]["online"], "True")
        self.assertGreaterEqual(float(figures[1]["cycle p95 ms"]), 0)
        self.assertEqual(figures[2]["ok"], "0")
        self.device.stop()
        message = self.all.wait_for(lambda one: one.status[0].level == DiagnosticStatus.ERROR)
        self.assertIn("offline", message.status[0].message)

    def test_they_come_again_and_again(self):
        self.start()
        for _ in range(3):
            self.all.wait_for(lambda one: one.status)


class Waiting(DiagnosticsTest):
    def wait_for_warning(self, port):
        [entry] = self.all.wait_for(lambda one: one.status and one.status[0].level == DiagnosticStatus.WARN).status
        self.assertEqual(entry.name, f"coupler_127_0_0_1_{port}_driver: map")
        self.assertEqual(entry.hardware_id, f"127.0.0.1:{port} unit 1")
        self.assertIn(f"waiting for the map of 127.0.0.1 port {port}", entry.message)

    def test_that_the_driver_waits_for_a_map_is_said_again_and_again(self):
        port = free_port()
        self.driver("--address", "127.0.0.1", "--port", port)
        for _ in range(3):
            self.wait_for_warning(port)

    def test_it_is_said_while_a_device_that_accepts_does_not_answer(self):
        with socket.create_server(("127.0.0.1", 0)) as silent:
            port = silent.getsockname()[1]
            self.driver("--address", "127.0.0.1", "--port", port, "--timeout", f"{NO_TIMEOUT}s")
            for _ in range(3):
                self.wait_for_warning(port)


class Stamps(DiagnosticsTest):
    def clock(self):
        """As a simulator that stands still: until it is told another second."""
        clock = Publisher("/clock", Clock, qos(1, best_effort=True))
        now, ended = [None], threading.Event()

        def publish():
            while not ended.wait(0.02):
                if now[0] is not None:
                    clock.publish(Clock(clock=Time(sec=now[0], nanosec=250000000)))

        publishing = threading.Thread(target=publish)
        publishing.start()
        for what in (clock.unregister, publishing.join, ended.set):
            self.addCleanup(what)
        return lambda second: now.__setitem__(0, second)

    def both(self, condition):
        for told in (self.status, self.all):
            told.wait_for(lambda message: condition(message.header.stamp))

    def test_they_are_the_systems_time(self):
        before = int(time.time())
        self.start()
        self.both(lambda stamp: before <= stamp.sec <= time.time())

    def test_with_use_sim_time_they_follow_the_clock_and_values_do_not_stop(self):
        self.start("--ros-args", "-p", "use_sim_time:=true")
        level = self.topic("/plant/level", UInt16)
        level.next()  # while /clock has said nothing
        self.assertTrue(self.topic("/plant/online", Bool).wait_for(bool))
        self.both(lambda stamp: (stamp.sec, stamp.nanosec) == (0, 0))
        tell = self.clock()
        for second in (5000, 6000, 100):  # a simulation may begin anew
            tell(second)
            self.both(lambda stamp, wanted=second: (stamp.sec, stamp.nanosec) == (wanted, 250000000))
        stamped, before = self.topic("/plant/level/stamped", UInt64Stamped), time.time()
        self.device.tables["holding_registers"][4] = 7
        level.wait_for(lambda value: value == 7)
        message = stamped.wait_for(lambda one: one.value == 7)
        self.assertGreaterEqual(seconds(message.header.stamp), before - message.uncertainty - ROUNDING)
        self.assertLessEqual(seconds(message.header.stamp), time.time() + ROUNDING)
        status = self.status.wait_for(lambda one: one.points[0].quality == PointStatus.GOOD)
        self.assertGreaterEqual(status.points[0].age, 0)
        answer = self.service("/plant/schedule", Schedule)("level", "9", ros_time(time.time() + LATER), ros_duration(0))
        self.assertTrue(answer.success, answer.message)

    def test_it_can_be_switched_while_the_driver_runs(self):
        self.start()
        self.both(lambda stamp: stamp.sec > 1000000)
        parameters = Parameters("/plant_driver")
        self.assertTrue(parameters.set(parameter("use_sim_time", BOOL, True))[0].successful)
        self.clock()(5000)
        self.both(lambda stamp: stamp.sec == 5000)
        self.assertTrue(parameters.set(parameter("use_sim_time", BOOL, False))[0].successful)
        self.both(lambda stamp: stamp.sec > 1000000)

    def test_in_a_file_it_is_a_parameter_as_any(self):
        path = process.write_map("/**:\n  ros__parameters:\n    use_sim_time: true\n")
        self.start("--ros-args", "--params-file", path)
        self.clock()(77)
        self.both(lambda stamp: stamp.sec == 77)
        self.assertEqual(Parameters("/plant_driver").get("use_sim_time"), [True])


if __name__ == "__main__":
    testing.main()
