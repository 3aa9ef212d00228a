# SPDX-License-Identifier: Apache-2.0
"""SIGINT, and every other signal that asks a program to end, ends the driver with 0, soon, whatever it is doing."""
import contextlib
import os
import signal
import socket
import unittest

import rosgraph
import rospy

from support import process, testing
from support.device import FAILURE, Device, Refuse
from support.patience import NO_TIMEOUT, PATIENCE
from support.peer import Peer
from support.ports import free_port
from support.topics import wait_until

MAP = """
name: shutdown
address: 127.0.0.1
timeout: {timeout}s
mapping:
  coils: {lamp: 3}
"""


def silent_server():
    server = socket.create_server(("127.0.0.1", 0))
    server.settimeout(PATIENCE)  # of accept()
    return server


class Shutdown(unittest.TestCase):
    def setUp(self):
        self.map = process.write_map(MAP.replace("{timeout}", str(NO_TIMEOUT)))

    def assert_ends_soon(self, driver, status=0):
        """It is waited for a tenth of what the driver waits for a reply; it needs a tenth of a second."""
        self.assertEqual(driver.interrupt(), status, driver.output)

    def test_while_polling(self):
        with Peer() as peer, process.Driver(f"_map:={self.map}", f"_port:={peer.port}") as driver:
            driver.wait_for("connected")
            self.assert_ends_soon(driver)

    def test_by_each_signal_that_asks_for_it_with_safe_values(self):
        path = process.write_map("name: shutdown\naddress: 127.0.0.1\non_shutdown: safe\nmapping:\n"
                                 "  coils: {valve: {address: 7, safe: on}}\n")
        numbers = {signal.SIGHUP: 0, signal.SIGTERM: 0, signal.SIGUSR1: 0, signal.SIGUSR2: 0,
                   signal.SIGQUIT: -signal.SIGQUIT}  # which asks for a core, too
        with Device() as device:
            def start():
                device.tables["coils"][7] = 0
                return process.Driver(f"_map:={path}", f"_port:={device.port}")

            for number, status in numbers.items():
                with self.subTest(number):
                    driver, code = process.interrupted_in_time(start, lambda _, code, right=status: code == right, number)
                    self.assertEqual(code, status, driver.output)
                    self.assertEqual(device.tables["coils"][7], 1)

    def test_a_signal_that_was_ignored_at_the_start_stays_ignored(self):
        with Peer() as peer, process.Driver(f"_map:={self.map}", f"_port:={peer.port}", under=("nohup",)) as driver:
            driver.wait_for("connected")
            driver.signal(signal.SIGHUP)
            self.assertFalse(driver.ends_within(1), driver.output)
            self.assert_ends_soon(driver)

    def test_while_it_tells_the_master_of_many_topics(self):
        points = "".join(f"    p{i}: {i}\n" for i in range(1000))
        path = process.write_map("name: large\naddress: 127.0.0.1\nmapping:\n  coils:\n" + points)
        for _ in range(5):
            with process.Driver(f"_map:={path}", f"_port:={free_port()}") as driver:
                wait_until(lambda: "/large/p0" in dict(rospy.get_published_topics()), "the first topic")
                self.assert_ends_soon(driver)
            wait_until(lambda: "/large/p0" not in dict(rospy.get_published_topics()), "the good-bye")

    def test_while_a_node_that_hangs_is_asked_for_its_types(self):
        topic = "/shutdown/lamp/write"
        master = rosgraph.Master("/hung")
        with silent_server() as hung, contextlib.ExitStack() as connections:
            uri = f"http://localhost:{hung.getsockname()[1]}/"
            master.registerPublisher(topic, "std_msgs/Bool", uri)
            connections.callback(master.unregisterPublisher, topic, uri)
            with Peer() as peer, process.Driver(f"_map:={self.map}", f"_port:={peer.port}") as driver:
                asked = b""
                while b"getPublications" not in asked:  # first it is asked for the topic
                    connection = connections.enter_context(hung.accept()[0])
                    asked = connection.recv(4096)
                self.assert_ends_soon(driver)

    def test_while_nobody_is_there(self):
        with process.Driver(f"_map:={self.map}", f"_port:={free_port()}") as driver:
            driver.wait_for("Connection refused")
            self.assert_ends_soon(driver)

    def test_while_a_device_that_accepts_does_not_answer(self):
        with silent_server() as silent:
            with process.Driver(f"_map:={self.map}", f"_port:={silent.getsockname()[1]}") as driver:
                connection, _ = silent.accept()
                with connection:
                    connection.recv(12)
                    self.assert_ends_soon(driver)

    def test_while_many_devices_that_do_not_answer_should_get_safe_values(self):
        text = "name: silent{number}\naddress: 127.0.0.1\nport: {port}\ntimeout: {timeout}s\non_shutdown: safe\n" \
               "mapping:\n  coils: {{lamp: 3}}\n"
        with contextlib.ExitStack() as stack:
            silent = [stack.enter_context(silent_server()) for _ in range(20)]
            maps = [process.write_map(text.format(number=i, port=server.getsockname()[1], timeout=NO_TIMEOUT))
                    for i, server in enumerate(silent)]
            driver = stack.enter_context(process.Driver(f"_maps:=[{','.join(maps)}]"))
            for server in silent:
                stack.enter_context(server.accept()[0]).recv(12)
            self.assert_ends_soon(driver, process.NOT_SAFE)

    def test_what_becomes_of_safe_values_is_told_though_ros_has_ended(self):
        path = process.write_map("name: shutdown\naddress: 127.0.0.1\non_shutdown: safe\nmapping:\n"
                                 "  coils: {lamp: 3, valve: {address: 7, safe: on}}\n")

        def answer(request):
            if request.function == 5 and request.address == 3:
                raise Refuse(FAILURE)
            return device.serve(request)

        device = Device().start()
        self.addCleanup(device.stop)
        device.answer = answer
        with contextlib.ExitStack() as stack:
            def start():
                device.tables["coils"][7] = 0
                return stack.enter_context(process.Driver(f"_map:={path}", f"_port:={device.port}"))

            driver, code = process.interrupted_in_time(start, lambda driver, _: "exception 04" in driver.output)
            self.assertEqual(code, process.NOT_SAFE, driver.output)
            self.assertIn("lamp could not be set to its safe value: exception 04", driver.output)
            self.assertEqual(device.tables["coils"][7], 1)
        with process.Driver(f"_map:={path}", f"_port:={free_port()}") as driver:
            driver.wait_for("Connection refused")
            self.assert_ends_soon(driver, process.NOT_SAFE)
            self.assertIn("no output could be set to its safe value: not connected", driver.output)

    def test_while_it_waits_for_a_nodes_map(self):
        with process.Driver("_address:=127.0.0.1", f"_port:={free_port()}") as driver:
            driver.wait_for("waiting for the map of 127.0.0.1")
            self.assert_ends_soon(driver)

    def test_while_a_node_that_was_given_its_name_waits_for_a_nodes_map(self):
        with process.Driver("__name:=io", "_address:=127.0.0.1", f"_port:={free_port()}") as driver:
            driver.wait_for("waiting for the map of 127.0.0.1")
            self.assert_ends_soon(driver)

    def test_while_there_is_no_master(self):
        master = os.environ["ROS_MASTER_URI"]
        os.environ["ROS_MASTER_URI"] = f"http://localhost:{free_port()}"
        try:
            # ROS waits for it where it sets parameters, or where it advertises its log.
            for arguments in ([f"_map:={self.map}"], ["--map", self.map], ["--map", self.map, "__name:=io"]):
                with process.Driver(*arguments) as driver:
                    driver.wait_for("Failed to contact master")
                    self.assert_ends_soon(driver)
        finally:
            os.environ["ROS_MASTER_URI"] = master


if __name__ == "__main__":
    testing.main()
