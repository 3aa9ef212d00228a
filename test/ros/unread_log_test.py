# SPDX-License-Identifier: Apache-2.0
"""Nobody reads the driver's log (a stopped terminal, a full pipe, a log collector that hangs): it polls, writes, connects again
and ends with safe values all the same."""
import contextlib
import os
import pty
import socket
import subprocess

from std_msgs.msg import Bool
from std_srvs.srv import SetBool

from support import process, testing
from support.device import Device
from support.patience import PATIENCE
from support.topics import wait_until

MAP = """
name: {name}
address: 127.0.0.1
rate: 100
on_shutdown: safe
mapping:
  coils: {{valve: 7}}
  discrete_inputs: {{door: 2}}
"""


def fill(file):
    """Writes into it until it takes no more, if somebody could read it."""
    os.set_blocking(file, False)
    with contextlib.suppress(BlockingIOError, BrokenPipeError):
        while True:
            os.write(file, b"x" * 100 + b"\n")
    os.set_blocking(file, True)


def full_pipe():
    return os.pipe()


def full_socket():
    """What sshd gives a command."""
    reader, writer = socket.socketpair()
    return reader.detach(), writer.detach()


class UnreadLog(testing.RosTest):
    at_once = True

    def goes_on(self, make, fill_first=True):
        """`make` returns what could be read, and what the driver writes to."""
        device = Device().start()
        self.addCleanup(device.stop)
        reader, writer = make()
        self.addCleanup(os.close, reader)
        if fill_first:
            fill(writer)
        path = process.write_map(MAP.format(name=self.name))
        command = [str(process.BUILD / "bin" / "coupler_driver"),
                   *process.driver_arguments((f"_map:={path}", f"_port:={device.port}"))]
        driver = subprocess.Popen(command, stdout=writer, stderr=writer)
        self.addCleanup(driver.kill)
        if not fill_first:
            wait_until(lambda: device.requests, "the first request")
            fill(writer)
        os.close(writer)
        door = self.topic(f"/{self.name}/door", Bool)
        for value in (True, False, True):
            device.drop()  # that is told, and that it is connected again
            device.tables["discrete_inputs"][2] = value
            wait_until(lambda value=value: door.next() == value, "the input")
        self.assertTrue(self.service(f"/{self.name}/valve/set", SetBool)(True).success)
        self.assertEqual(device.tables["coils"][7], 1)
        driver.send_signal(2)
        self.assertEqual(driver.wait(PATIENCE), 0)
        self.assertEqual(device.tables["coils"][7], 0)

    def test_a_full_pipe(self):
        self.goes_on(full_pipe)

    def test_a_pipe_that_is_full_later(self):
        self.goes_on(full_pipe, fill_first=False)

    def test_a_full_socket(self):
        self.goes_on(full_socket)

    def test_a_terminal_that_stands_still(self):
        self.goes_on(pty.openpty)

    def test_a_reader_that_has_gone(self):
        def left():
            reader, writer = os.pipe()
            os.close(reader)
            return os.open("/dev/null", os.O_RDONLY), writer
        self.goes_on(left, fill_first=False)


if __name__ == "__main__":
    testing.main()
