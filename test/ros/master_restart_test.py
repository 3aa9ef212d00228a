# SPDX-License-Identifier: Apache-2.0
"""The ROS master starts again: the driver is found again, and the device notices nothing. It hangs while the driver starts or
ends: what has been driven is made safe."""
import os
import pathlib
import signal
import socket
import subprocess
import threading
import unittest
import xmlrpc.client

from support import at_once, case, process
from support.device import Device
from support.patience import NO_TIMEOUT, PATIENCE
from support.ports import free_port
from support.relay import Relay
from support.topics import wait_until

MASTER = pathlib.Path(__file__).resolve().parents[1] / "support/ros-master"
FIRST = "name: first\naddress: 127.0.0.1\nport: {port}\non_shutdown: safe\nmapping:\n  coils: {lamp: 3}\n"
COUNT = 4000  # topics: the master hears of them for longer than a write takes
MAP = f"""
name: kept
address: 127.0.0.1
rate: 20
timeout: {NO_TIMEOUT}s
mapping:
  input_registers: {{level: {{address: 0, type: INT}}}}
  holding_registers: {{goal: {{address: 4, type: INT, access: write}}}}
"""
NODE = "/kept_driver"


class MasterThatHangs(Relay):
    """It answers no more where `answers` is not set. `asked`: all that was sent to it."""

    def __init__(self, port):
        self.answers = threading.Event()
        self.asked = b""
        super().__init__(port)

    def serve(self, client, node):
        back = threading.Thread(target=self.forward, args=(node, client), daemon=True)
        back.start()
        self.forward(client, node, self.note)
        back.join(PATIENCE)

    def note(self, data):
        self.asked += data

    def forward(self, source, sink, note=lambda _: None):
        try:
            while data := source.recv(65536):
                note(data)
                self.answers.wait()
                sink.sendall(data)
            sink.shutdown(socket.SHUT_WR)
        except OSError:  # one of both has ended
            pass


class MasterRestart(unittest.TestCase):
    """With a master of its own, and no rospy in this process: that belongs to another master."""
    at_once = True

    def start_master(self, port):
        master = subprocess.Popen([MASTER, str(port)], stdout=subprocess.PIPE, text=True)
        self.addCleanup(master.wait)
        self.addCleanup(master.terminate)
        uri = master.stdout.readline().strip()
        self.assertTrue(uri, "the master did not start")
        return master, uri

    def in_ros(self, *command):
        child = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=self.environment)
        self.addCleanup(child.wait)
        self.addCleanup(child.terminate)
        return child

    def of_node(self):
        """Topics and services that the master knows of the driver."""
        state = self.master.getSystemState("/test")[2]
        return [sorted(name for name, nodes in names if NODE in nodes) for names in state]

    def publish_until_written(self, value):
        publisher = self.in_ros("rostopic", "pub", "-r", "5", "/kept/goal/write", "std_msgs/Int16", str(value))
        wait_until(lambda: self.device.tables["holding_registers"][4] == value, "the value at the device")
        publisher.terminate()

    def test_topics_services_and_parameters_come_back_and_polling_goes_on(self):
        self.device = Device().start()
        self.addCleanup(self.device.stop)
        running, uri = self.start_master(free_port())  # which nobody takes while no master is there
        self.master = xmlrpc.client.ServerProxy(uri)
        self.environment = {**os.environ, "ROS_MASTER_URI": uri}
        with process.Process("coupler_driver", f"_map:={process.write_map(MAP)}", f"_port:={self.device.port}",
                             environment=self.environment) as driver:
            driver.wait_for("connected")
            self.publish_until_written(7)
            before = self.of_node()
            self.assertIn("/kept/level", before[0])
            self.assertIn("/kept/goal/write", before[1])
            self.assertIn("/kept/safe", before[2])
            parameters = self.master.getParam("/test", NODE)[2]

            running.terminate()
            driver.wait_for(f"the ROS master at {uri} does not answer; devices are polled")
            polls = len(self.device.requests)
            wait_until(lambda: len(self.device.requests) > polls + 10, "polls without a master")

            _, again = self.start_master(uri.rstrip("/").rsplit(":", 1)[1])
            self.assertEqual(again, uri)
            publisher = self.in_ros("rostopic", "pub", "-r", "5", "/kept/goal/write", "std_msgs/Int16", "8")
            driver.wait_for(f"the ROS master at {uri} has started again; topics, services and parameters are registered")
            self.assertEqual(self.of_node(), before)
            self.assertEqual(self.master.getParam("/test", NODE)[2], parameters)
            wait_until(lambda: self.device.tables["holding_registers"][4] == 8, "a value of one who came before")
            publisher.terminate()
            self.publish_until_written(9)
            echo = self.in_ros("rostopic", "echo", "-n", "1", "/kept/level")
            self.assertIn("data: 0", echo.communicate(timeout=PATIENCE)[0])
            answer = self.in_ros("rosservice", "call", "/kept/safe").communicate(timeout=PATIENCE)[0]
            self.assertIn("success: True", answer)
            self.assertEqual(driver.output.count("has started again"), 1)
            self.assertEqual(self.device.accepted, 1, "the device has noticed nothing")

    def call_until_it_works(self, *service):
        wait_until(lambda: "True" in self.in_ros("rosservice", "call", *service).communicate()[0], f"an answer of {service[0]}")

    def master_that_hangs(self):
        """And the environment of a driver that knows no other one."""
        _, uri = self.start_master(free_port())
        self.master = xmlrpc.client.ServerProxy(uri)
        self.environment = {**os.environ, "ROS_MASTER_URI": uri}
        relay = MasterThatHangs(int(uri.rstrip("/").rsplit(":", 1)[1]))
        self.addCleanup(relay.stop)
        return relay, {**os.environ, "ROS_MASTER_URI": f"http://localhost:{relay.port}/"}

    def test_safe_values_can_be_had_before_anything_can_be_written(self):
        relay, environment = self.master_that_hangs()
        relay.answers.set()
        with Device() as device:
            path = process.write_map(FIRST.replace("{port}", str(device.port)))
            with process.Process("coupler_driver", f"_map:={path}", environment=environment) as driver:
                driver.wait_for("first: connected")
                wait_until(lambda: b"/first/lamp/write" in relay.asked and b"/first/safe" in relay.asked, "both")
        self.assertLess(relay.asked.index(b"/first/safe"), relay.asked.index(b"/first/lamp/write"))

    def starts_and_then_the_master_hangs(self, *others, first=FIRST):
        """A function: it starts a driver, has it write to the first of its devices, and then the master answers no more. `others`:
        maps of further devices, which are still started then."""
        self.device = Device().start()
        self.addCleanup(self.device.stop)
        maps = [process.write_map(text) for text in (first.replace("{port}", str(self.device.port)), *others)]
        relay, environment = self.master_that_hangs()

        def start():
            relay.answers.set()
            driver = process.Process("coupler_driver", f"_maps:=[{','.join(maps)}]", environment=environment)
            self.addCleanup(driver.end)
            driver.wait_for("first: connected")
            if not others:
                wait_until(lambda: "/first/p399/write" in dict(self.master.getSystemState("/test")[2][1]), "the last topic")
            self.call_until_it_works("/first/lamp/set", "true")
            self.assertEqual(self.device.tables["coils"][3], 1)
            relay.answers.clear()
            return driver

        return start

    def test_a_signal_makes_outputs_safe_while_a_master_that_hangs_holds_up_the_start(self):
        points = "".join(f"    p{i}: {i}\n" for i in range(COUNT))
        large = f"name: large\naddress: 127.0.0.1\nport: {free_port()}\nmapping:\n  coils:\n{points}"
        driver, code = process.interrupted_in_time(self.starts_and_then_the_master_hangs(large), lambda _, code: code == 0)
        self.assertEqual(code, 0, driver.output)
        self.assertEqual(self.device.tables["coils"][3], 0)

    def test_where_a_master_that_hangs_holds_up_the_end_a_later_signal_ends_it(self):
        points = "".join(f"    p{i}: {{address: {i}, type: INT}}\n" for i in range(400))  # a signal ends what waits for one of them
        start = self.starts_and_then_the_master_hangs(first=f"{FIRST}  holding_registers:\n{points}")
        for _ in range(20):  # on a busy machine the time for safe values may be over
            driver = start()
            for _ in range(20):
                driver.signal(signal.SIGINT)
                if driver.ends_within(3):
                    break
            code = driver.wait()
            if code != process.NOT_SAFE:
                break
        self.assertEqual(code, 0, driver.output)
        self.assertEqual(self.device.tables["coils"][3], 0)


if __name__ == "__main__":
    case.run(suite=at_once.Suite)
