# SPDX-License-Identifier: Apache-2.0
"""The programs under test, as child processes that end with the test."""
import contextlib
import os
import pathlib
import re
import resource
import signal
import subprocess
import tempfile
import threading
import time

from support.patience import PATIENCE

BUILD = pathlib.Path(os.environ["COUPLER_BUILD_DIR"])
NOT_SAFE = 3  # the driver's exit status where an output should have got its safe value and has not
SAFE_WITHIN = 0.7  # seconds: those that the driver has at its end for safe values
SERVING = re.compile(r"serving .* on \S+:(\d+)")
TLS = re.compile(r"TLS at \S+:(\d+)")
NAME = "__name:="  # gives the node its name
# What runs a program that can be kept from starting threads. The kernel does not keep root's from it, so it is nobody's.
LIMITABLE = () if os.geteuid() else (
    "setpriv", "--reuid=54321", "--keep-groups", "--inh-caps=+dac_override", "--ambient-caps=+dac_override")

# `nohup ./check`, and a shell that runs it in the background, leave some ignored: what is started so takes none of them.
for _number in (signal.SIGHUP, signal.SIGINT, signal.SIGQUIT):
    if signal.getsignal(_number) == signal.SIG_IGN:
        signal.signal(_number, signal.SIG_DFL)


def freeze(child):
    """SIGSTOP to a child, until none of its threads runs: on a busy machine some run on for a while."""
    child.send_signal(signal.SIGSTOP)
    os.waitid(os.P_PID, child.pid, os.WSTOPPED | os.WEXITED | os.WNOWAIT)


def limitable_environment():
    """The report of leaks at the end takes a thread."""
    return {**os.environ, "ASAN_OPTIONS": f"{os.environ.get('ASAN_OPTIONS', '')}:detect_leaks=0"}


def limit_threads(pid, number=resource.getrlimit(resource.RLIMIT_NPROC)[0]):
    """Of a program that runs under LIMITABLE: with as many as that, or more, it can start none. Without a number as before."""
    soft = "unlimited" if number == resource.RLIM_INFINITY else number
    subprocess.run([*LIMITABLE, "prlimit", "--pid", str(pid), f"--nproc={soft}:"], check=True)


class Process:
    """A program of the build, and everything it prints."""

    def __init__(self, name, *arguments, environment=None, under=()):
        """`under`: a command that runs it."""
        self._lines = []
        self._ended = False  # there are no more lines
        self._news = threading.Condition()
        self._child = subprocess.Popen(
            [*under, str(BUILD / "bin" / name), *map(str, arguments)],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", env=environment)
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        for line in self._child.stdout:
            with self._news:
                self._lines.append(line)
                self._news.notify_all()
        with self._news:
            self._ended = True
            self._news.notify_all()

    @property
    def output(self):
        return "".join(self._lines)

    @property
    def running(self):
        return self._child.poll() is None

    def waits(self):
        """Of each thread: the seconds for which it has waited for a processor, but for a wait that is not over, and whether it
        wants one now."""
        tasks, threads = [], {}
        with contextlib.suppress(OSError):  # the process has ended
            tasks = list(pathlib.Path(f"/proc/{self._child.pid}/task").iterdir())
        for thread in tasks:
            with contextlib.suppress(OSError):  # it has ended
                waited = int((thread / "schedstat").read_text(encoding="ascii").split()[1]) / 1e9
                state = (thread / "stat").read_text(encoding="utf-8").rpartition(")")[2].split()[0]
                threads[thread.name] = waited, state == "R"
        return threads

    @contextlib.contextmanager
    def frozen(self):
        """Stopped, as a machine that hangs: its connections stay, and it asks nothing."""
        freeze(self._child)
        try:
            yield
        finally:
            self._child.send_signal(signal.SIGCONT)

    def wait_for(self, text, seconds=PATIENCE):
        """Until the program has printed the text."""
        self._wait_until(lambda: text in self.output, f"'{text}'", seconds)

    def _wait_until(self, condition, what, seconds=PATIENCE):
        with self._news:
            self._news.wait_for(lambda: condition() or self._ended, seconds)
            if not condition():
                raise AssertionError(f"{what} was not printed, but:\n{self.output}")

    def ends_within(self, seconds):
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._child.wait(seconds)
        return not self.running

    def wait(self):
        """The exit code, once the program ends by itself."""
        self._reader.join(PATIENCE)  # its output ends with it, which is seen at once; Popen.wait looks now and then
        return self._child.wait(PATIENCE)

    def signal(self, number):
        if self.running:
            self._child.send_signal(number)

    def interrupt(self, *by):
        """The exit code, after these signals (SIGINT), all of them before it does anything about the first."""
        with self.frozen() if by[1:] else contextlib.nullcontext():
            for number in by or [signal.SIGINT]:
                self.signal(number)
        return self.wait()

    def end(self):
        """SIGINT; any exit code but 0 is a failure: a sanitizer's report, too, ends with another one."""
        was_running = self.running
        try:
            code = self.interrupt()
        except subprocess.TimeoutExpired:
            self._child.kill()
            self.wait()
            raise
        if was_running and code != 0:
            raise AssertionError(f"{self._child.args} ended with {code}:\n{self.output}")

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        if kind is not None:
            print(f"---- {self._child.args}\n{self.output}----")
        self.end()


class Driver(Process):
    _started = []

    def __init__(self, *arguments, **options):
        running = Driver._started = [driver for driver in Driver._started if driver.running]
        self.await_graph(len(running))
        super().__init__("coupler_driver", *driver_arguments(arguments), **options)
        running.append(self)

    @staticmethod
    def await_graph(running):
        """ROS 2 waits here until its graph has no driver but those that run."""


class LimitedDriver(Driver):
    """One that can be kept from starting threads."""

    def __init__(self, *arguments):
        super().__init__(*arguments, under=LIMITABLE, environment=limitable_environment())

    def start_no_more_threads(self):
        limit_threads(self._child.pid, 1)


def interrupted_in_time(start, is_right, *by):
    """What `start` returns, a driver, once it was connected and ended as interrupt() does, and its exit code. On a busy machine the
    time for safe values may be over before the driver or the device has had a processor: where the end took that long and
    `is_right(driver, code)` is false, another one is started, twenty at most."""
    for _ in range(20):
        driver = start()
        driver.wait_for("connected")
        begun = time.monotonic()
        code = driver.interrupt(*by)
        if time.monotonic() - begun < SAFE_WITHIN or is_right(driver, code):
            break
    return driver, code


def driver_arguments(arguments):
    """`_key:=value` is ROS 1's spelling of `--key=value`, and `__name:=io` that of a remapping; a driver for ROS 2 takes its
    own only."""
    if os.environ.get("ROS_VERSION") != "2":
        return arguments
    names = [f"__node:={one[len(NAME):]}" for one in map(str, arguments) if one.startswith(NAME)]
    others = [re.sub(r"^_([a-z]+):=", r"--\1=", one) for one in map(str, arguments) if not one.startswith(NAME)]
    return others + [word for name in names for word in ("--ros-args", "-r", name)]


class Node(Process):
    """coupler-node on the simulated chip."""

    def __init__(self, *arguments, port=0):
        """The path of a map, or what plays a recording."""
        super().__init__("coupler-node", *arguments, "--sim", "--listen", "127.0.0.1", "--port", port)

    @property
    def port(self):
        """Where it serves, once it does: it has read the map by then."""
        self._wait_until(lambda: SERVING.search(self.output), "a port")
        return int(SERVING.search(self.output)[1])

    @property
    def tls_port(self):
        self._wait_until(lambda: TLS.search(self.output), "a port for TLS")
        return int(TLS.findall(self.output)[-1])

    def reload(self):
        self._child.send_signal(signal.SIGHUP)

    def hang(self):
        """The process that serves stops and keeps its connections, until the supervisor replaces it."""
        for worker in subprocess.check_output(["pgrep", "--parent", str(self._child.pid)], text=True).split():
            os.kill(int(worker), signal.SIGSTOP)


def has_node():
    return (BUILD / "bin" / "coupler-node").exists()


def write_map(text, suffix=".yaml"):
    """A map file for the time of the test's run; its path."""
    folder = os.environ["ROS_HOME"]
    with tempfile.NamedTemporaryFile("w", suffix=suffix, dir=folder, delete=False) as file:
        file.write(text)
    return file.name
