# SPDX-License-Identifier: Apache-2.0
"""SIGINT, SIGTERM and their kind end the driver with 0, soon, whatever it is doing; with 3 if an output did not get its safe value."""
import contextlib
import signal
import socket

from coupler_driver.msg import Status
from std_msgs.msg import Bool

from support import process, testing
from support.device import FAILURE, Device, Refuse
from support.patience import NO_TIMEOUT, PATIENCE
from support.peer import Peer
from support.ports import free_port
from support.topics import types, wait_until

MAP = f"""
name: shutdown
address: 127.0.0.1
timeout: {NO_TIMEOUT}s
mapping:
  coils: {{lamp: 3}}
"""
SAFE = "name: shutdown\naddress: 127.0.0.1\non_shutdown: safe\nmapping:\n  coils: {lamp: 3, valve: {address: 7, safe: on}}\n"
SIGNALS = (signal.SIGINT, signal.SIGTERM)


def silent_server():
    server = socket.create_server(("127.0.0.1", 0))
    server.settimeout(PATIENCE)  # of accept()
    return server


class Shutdown(testing.RosTest):
    def assert_ends_soon(self, driver, status=0, by=signal.SIGINT):
        """It is waited for a tenth of what the driver waits for a reply; it needs a tenth of a second."""
        self.assertEqual(driver.interrupt(by), status, driver.output)

    def test_while_polling(self):
        for by in (*SIGNALS, signal.SIGHUP, signal.SIGUSR1, signal.SIGUSR2, signal.SIGQUIT):
            with self.subTest(by.name), Peer() as peer:
                driver = self.driver("--map", process.write_map(MAP), "--port", peer.port)
                driver.wait_for("connected")
                self.topic("/shutdown/lamp", Bool).next()
                self.assert_ends_soon(driver, -by if by == signal.SIGQUIT else 0, by)  # with its core
                wait_until(lambda: "/shutdown/online" not in types(), "the good-bye")

    def test_while_it_offers_many_topics(self):
        points = "".join(f"    p{i}: {i}\n" for i in range(300))
        path = process.write_map("name: large\naddress: 127.0.0.1\nmapping:\n  coils:\n" + points)
        for by in SIGNALS:
            driver = self.driver("--map", path, "--port", free_port())
            wait_until(lambda: "/large/p0" in types(), "the first topic")
            self.assert_ends_soon(driver, by=by)
            wait_until(lambda: "/large/p0" not in types(), "the good-bye")

    def test_while_nobody_is_there(self):
        driver = self.driver("--map", process.write_map(MAP), "--port", free_port())
        driver.wait_for("Connection refused")
        self.assert_ends_soon(driver)

    def test_while_a_device_that_accepts_does_not_answer(self):
        with silent_server() as silent:
            driver = self.driver("--map", process.write_map(MAP), "--port", silent.getsockname()[1])
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
            driver = self.driver("--maps", ",".join(maps))
            for server in silent:
                stack.enter_context(server.accept()[0]).recv(12)
            self.assert_ends_soon(driver, process.NOT_SAFE)

    def test_while_it_waits_for_a_nodes_map(self):
        for by in SIGNALS:
            driver = self.driver("--address", "127.0.0.1", "--port", free_port())
            driver.wait_for("waiting for the map of 127.0.0.1")
            self.assert_ends_soon(driver, by=by)


class Safe(testing.RosTest):
    def setUp(self):
        self.device = Device().start()
        self.addCleanup(self.device.stop)
        self.path = process.write_map(SAFE)

    def start(self, port=None):
        return self.driver("--map", self.path, "--port", port or self.device.port)

    def start_unsafe(self):
        """At a device whose outputs have other values than their safe ones."""
        self.device.tables["coils"][3], self.device.tables["coils"][7] = 1, 0
        return self.start()

    def start_whole(self):
        """Until everything has been started, a second signal ends a driver that has written nothing at once."""
        driver = self.start_unsafe()
        self.topic("/shutdown/status", Status).next()
        return driver

    def test_outputs_get_their_safe_values_by_either_signal_and_by_both(self):
        for by in (*((one,) for one in SIGNALS), SIGNALS):
            with self.subTest([one.name for one in by]):
                driver, code = process.interrupted_in_time(self.start_whole, lambda _, code: code == 0, *by)
                self.assertEqual(code, 0, driver.output)
                self.assertEqual((self.device.tables["coils"][3], self.device.tables["coils"][7]), (0, 1))

    def test_an_output_that_refuses_is_told_though_ros_ends(self):
        def answer(request):
            if request.function == 5 and request.address == 3:
                raise Refuse(FAILURE)
            return self.device.serve(request)

        self.device.answer = answer
        driver, code = process.interrupted_in_time(self.start_unsafe, lambda driver, _: "exception 04" in driver.output)
        self.assertEqual(code, process.NOT_SAFE, driver.output)
        self.assertIn("lamp could not be set to its safe value: exception 04", driver.output)
        self.assertEqual(self.device.tables["coils"][7], 1)

    def test_a_device_that_is_away_is_told(self):
        driver = self.start(free_port())
        driver.wait_for("Connection refused")
        self.assertEqual(driver.interrupt(), process.NOT_SAFE, driver.output)
        self.assertIn("no output could be set to its safe value: not connected", driver.output)


if __name__ == "__main__":
    testing.main()
