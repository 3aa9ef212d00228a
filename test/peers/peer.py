# SPDX-License-Identifier: Apache-2.0
"""What the peer tests share: starting a node, and saying what was proved."""
import concurrent.futures
import contextlib
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import threading
import time

SKIPPED = 77
PATIENCE = 120  # seconds for whatever must come: tells hanging from working, on any machine

# `nohup ./check`, and a shell that runs it in the background, leave some ignored: what is started so takes none of them.
for _number in (signal.SIGHUP, signal.SIGINT, signal.SIGQUIT):
    if signal.getsignal(_number) == signal.SIG_IGN:
        signal.signal(_number, signal.SIG_DFL)


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def is_sanitized():
    """Whether the programs are those of a build with sanitizers, whose memory is another one."""
    cache = pathlib.Path(os.environ.get("COUPLER_BUILD_DIR", ""), "CMakeCache.txt").read_text(encoding="utf-8")
    return re.search(r"^COUPLER_SANITIZE:\w+=.+$", cache, re.M) is not None


def freeze(process):
    """SIGSTOP to a child, until none of its threads runs: on a busy machine some run on for a while."""
    process.send_signal(signal.SIGSTOP)
    os.waitid(os.P_PID, process.pid, os.WSTOPPED | os.WEXITED | os.WNOWAIT)


def freeze_other(process):
    """The same for a process id that is no child's. SIGKILL ends it still."""
    os.kill(process, signal.SIGSTOP)
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        try:
            stats = [(task / "stat").read_text(encoding="utf-8") for task in pathlib.Path(f"/proc/{process}/task").iterdir()]
        except OSError:
            return  # it has been ended meanwhile
        if all(stat.rpartition(")")[2].split()[0] == "T" for stat in stats):
            return
        time.sleep(0.01)
    raise TimeoutError(f"process {process} runs on after SIGSTOP")


class Checks:
    """Collects comparisons, so that one run tells everything."""

    def __init__(self):
        self.failed = 0
        self.passed = 0

    def equal(self, what, got, wanted):
        if got == wanted:
            self.passed += 1
            return
        self.failed += 1
        print(f"FAILED: {what}: got {repr(got)[:500]}, wanted {repr(wanted)[:500]}")

    def done(self, proved):
        if self.failed:
            print(f"FAILED: {self.failed} of {self.failed + self.passed} comparisons: {proved}")
            sys.exit(1)
        if not self.passed:
            print(f"FAILED: nothing was compared: {proved}")
            sys.exit(1)
        print(f"ok: {proved} ({self.passed} comparisons)")


def await_true(what, condition, checks, poll=None):
    """Waits until it is; `poll` is called between two looks. A failed check if it never is."""
    end = time.monotonic() + PATIENCE
    while not (holds := condition()) and time.monotonic() < end:
        if poll:
            poll()
        time.sleep(0.02)
    checks.equal(what, bool(holds), True)


class Silence:
    """The longest time for which a client and its server may have heard nothing of each other: from before a request is
    sent until the next one is answered."""

    def __init__(self):
        self.longest = 0.0
        self._sent = None

    def ask(self, request):
        sent = time.monotonic()
        reply = request()
        if self._sent is not None:
            self.note(time.monotonic() - self._sent)
        self._sent = sent
        return reply

    def note(self, seconds):
        self.longest = max(self.longest, seconds)


def undisturbed(limit, act, again=lambda: None):
    """What `act(silence)` returns of a run in which no silence was as long as `limit`. A busy machine keeps a client from
    what it is to see or to do in time: such a run says nothing, and after `again()` there is another one, twenty at most."""
    return slower_until_undisturbed(limit, lambda silence, _: act(silence), again, factors=[1] * 20)


SLOWER = (1, 2, 4, 8, 16, 32)


def slower_until_undisturbed(limit, act, again=lambda: None, factors=SLOWER):
    """Does the same with `act(silence, factor)`. Its times and the limit are that many times as long."""
    for factor in factors:
        silence = Silence()
        seen = act(silence, factor)
        if silence.longest < limit * factor:
            break
        print(f"tried again: this machine was silent for {silence.longest:.1f} s")
        again()
    return seen


def waited_for_a_processor(process):
    """Seconds, by thread of it and of its children."""
    tasks = [task for one in (process, *children_of(process)) for task in pathlib.Path(f"/proc/{one}/task").iterdir()]
    return {task.name: int((task / "schedstat").read_text(encoding="ascii").split()[1]) / 1e9 for task in tasks}


@contextlib.contextmanager
def waits_noted(silence, *processes):
    """Notes how long each of these subprocess.Popen waits for a processor at a time, and this program."""
    over, turn = threading.Event(), 0.02

    def watch():
        before, last = {}, time.monotonic()
        while not over.wait(turn):
            now = time.monotonic()
            silence.note(now - last - turn)
            last = now
            for process in processes:
                with contextlib.suppress(OSError):  # it has ended
                    for thread, seconds in waited_for_a_processor(process.pid).items():
                        silence.note(seconds - before.get(thread, seconds))
                        before[thread] = seconds

    watcher = threading.Thread(target=watch)
    watcher.start()
    try:
        yield
    finally:
        over.set()
        watcher.join()


def run_hasty(command, *others, again=lambda: None, **options):
    """subprocess.run() of `command(seconds)`, which gives up waiting for an answer of this program, or of these processes,
    after so many. Others never answer, so it begins with one second."""
    def run(silence, seconds):
        called = command(seconds)
        with subprocess.Popen(called, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options) as process, \
                waits_noted(silence, process, *others):
            try:
                out, err = process.communicate(timeout=PATIENCE)
            finally:
                process.kill()
        return subprocess.CompletedProcess(called, process.returncode, out, err)

    return slower_until_undisturbed(0.5, run, again)


def side_by_side(*calls):
    """Each is a function and its arguments. They wait more than they compute: all at once."""
    with concurrent.futures.ThreadPoolExecutor(len(calls)) as pool:
        for call in [pool.submit(*call) for call in calls]:
            call.result()


def pymodbus_client(port, **options):
    from pymodbus.client import ModbusTcpClient  # not every test needs it
    return ModbusTcpClient("127.0.0.1", port=port, **{"timeout": PATIENCE, **options})


@contextlib.contextmanager
def silent_port():
    """A loopback port where nothing listens. It is nobody else's meanwhile: only a server with SO_REUSEADDR that is told
    the number can have it."""
    with socket.socket() as place:
        place.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        place.bind(("127.0.0.1", 0))
        yield place.getsockname()[1]


def children_of(process):
    return [int(child) for task in pathlib.Path(f"/proc/{process}/task").iterdir()
            for child in (task / "children").read_text(encoding="ascii").split()]


_by_port = {}  # the process id of each node


def the_node(port=None):
    """The one that this test has started; of several: at this port."""
    return _by_port[port] if port else next(child for child in children_of(os.getpid())
                if pathlib.Path(f"/proc/{child}/comm").read_text(encoding="ascii") == "coupler-node\n")


def the_worker(port=None):
    """The process that answers for it; None while there is none."""
    for child in children_of(the_node(port)):
        with contextlib.suppress(OSError):
            if pathlib.Path(f"/proc/{child}/comm").read_text(encoding="ascii") == "coupler-node-io\n":
                return child
    return None


@contextlib.contextmanager
def running_node(command, port=0):
    """Runs a node on a free loopback port, or this one; yields the port. It must end well on SIGTERM."""
    node = subprocess.Popen(command + ["--listen", "127.0.0.1", "--port", str(port)], stderr=subprocess.PIPE, text=True)
    try:
        said = []
        port = None
        for line in node.stderr:
            said.append(line)
            found = re.search(r"serving .* on 127\.0\.0\.1:(\d+)", line)
            if found:
                port = int(found.group(1))
                break
        if port is None:
            print(f"FAILED: {' '.join(command)} did not start; it said:\n{''.join(said)}")
            sys.exit(1)
        reader = threading.Thread(target=lambda: said.extend(node.stderr), daemon=True)
        reader.start()
        _by_port[port] = node.pid
        yield port
        node.terminate()
        status = node.wait(timeout=PATIENCE)
        reader.join(timeout=PATIENCE)
        if status != 0:
            print(f"FAILED: {' '.join(command)} ended with status {status}; it said:\n{''.join(said)}")
            sys.exit(1)
    finally:
        if node.poll() is None:
            node.kill()
            node.wait()
