# SPDX-License-Identifier: Apache-2.0
"""The programs of a measurement: a ROS of its own (a master, or a domain of ROS 2), and children that end with it."""
import contextlib
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import tempfile
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2]))

from support.ports import free_port  # noqa: E402


class Child:
    def __init__(self, *command, environment=None, core=None):
        """`core`: where it runs, so that two sides in turn are not told apart by the cores they happened to get."""
        if core is not None and os.cpu_count() > 1:
            command = ("taskset", "-c", core, *command)  # it becomes the command: the pid stays
        self._log = tempfile.NamedTemporaryFile()
        self._child = subprocess.Popen([str(word) for word in command], stdin=subprocess.DEVNULL, stdout=self._log,
                                       stderr=subprocess.STDOUT, env=environment)
        self.pid = self._child.pid

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._child.send_signal(signal.SIGINT)
        try:
            self._child.wait(20)
        except subprocess.TimeoutExpired:
            self._child.kill()
            self._child.wait()

    @property
    def text(self):
        return pathlib.Path(self._log.name).read_text(errors="replace")

    def wait_for(self, pattern, seconds=30):
        end = time.monotonic() + seconds
        while time.monotonic() < end and self._child.poll() is None:
            if found := re.search(pattern, self.text):
                return found
            time.sleep(0.02)
        raise SystemExit(f"'{pattern}' did not appear:\n{self.text}")

    def cpu_seconds(self):
        """What the scheduler counted, in nanoseconds: /proc/PID/stat knows only ticks of 10 ms."""
        threads = pathlib.Path(f"/proc/{self.pid}/task").iterdir()
        return sum(int((thread / "schedstat").read_text().split()[0]) for thread in threads) / 1e9

    def resident_mb(self):
        return int(re.search(r"VmRSS:\s+(\d+)", pathlib.Path(f"/proc/{self.pid}/status").read_text())[1]) / 1000

    def listening_ports(self):
        """TCP ports that the process accepts connections on."""
        inodes = set()
        for link in pathlib.Path(f"/proc/{self.pid}/fd").iterdir():
            with contextlib.suppress(OSError):
                if found := re.match(r"socket:\[(\d+)\]", os.readlink(link)):
                    inodes.add(found[1])
        ports = set()
        for table in ("tcp", "tcp6"):
            for line in pathlib.Path(f"/proc/{self.pid}/net/{table}").read_text().splitlines()[1:]:
                fields = line.split()
                if fields[3] == "0A" and fields[9] in inodes:
                    ports.add(int(fields[1].rsplit(":", 1)[1], 16))
        return ports


@contextlib.contextmanager
def ros_master():
    """The environment that makes a program a node of it."""
    with tempfile.TemporaryDirectory() as home:
        port = free_port()
        environment = dict(os.environ, ROS_MASTER_URI=f"http://localhost:{port}", ROS_HOSTNAME="localhost",
                           ROS_HOME=home, PATH="/usr/bin:" + os.environ["PATH"])
        with Child("roscore", "-p", port, environment=environment) as master:
            master.wait_for("started core service", 60)
            yield environment


@contextlib.contextmanager
def ros2_domain(build):
    """The environment that makes a program a node of a domain that no other has. Whoever calls may set the RMW."""
    text = subprocess.run(["bash", "-c", 'source "$1" && env -0', "-", build / "setup.bash"], check=True,
                          stdout=subprocess.PIPE, text=True).stdout
    environment = dict(line.split("=", 1) for line in text.split("\0") if line)
    bound = {int(line.split()[1].rsplit(":", 1)[1], 16)
             for line in pathlib.Path("/proc/net/udp").read_text().splitlines()[1:]}
    domain = random.choice([d for d in range(102) if 7400 + 250 * d not in bound])
    with tempfile.TemporaryDirectory() as home:
        yield dict(environment, ROS_DOMAIN_ID=str(domain), ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST", ROS_HOME=home)
