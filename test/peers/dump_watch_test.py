#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`coupler dump --watch` tells changes of a device of pymodbus and of a node, and writes nothing to them.

    dump_watch_test.py COUPLER MAP NODE
"""
import datetime
import json
import os
import pathlib
import pty
import re
import select
import shutil
import signal
import subprocess
import sys
import threading
import time

import peer
from dump_device import READS, device_with_values

if not shutil.which("mbpoll"):
    peer.skip("mbpoll is missing; run scripts/install-packages test")


DOUBT = 0.2  # seconds by which the two clocks may be mapped wrongly


class Watch:
    """`coupler dump --watch`, and the lines it has said."""

    def __init__(self, coupler, *arguments, every="0.1"):
        self.program = subprocess.Popen([coupler, "dump", *map(str, arguments), "--watch", every], text=True,
                                        encoding="utf-8", stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        self.lines = []
        self._news = threading.Condition()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        for line in self.program.stdout:
            with self._news:
                self.lines.append(line.rstrip("\n"))
                self._news.notify_all()

    def await_line(self, wanted, since=0):
        """The number of the first line from `since` on that is wanted; None: there was none."""
        def found():
            return next((i for i in range(since, len(self.lines)) if wanted(self.lines[i])), None)
        with self._news:
            self._news.wait_for(lambda: found() is not None, peer.PATIENCE)
            return found()

    def end(self):
        self.program.send_signal(signal.SIGINT)
        try:
            return self.program.wait(peer.PATIENCE)
        except subprocess.TimeoutExpired:
            self.program.kill()
            return self.program.wait()


def mbpoll_writes(port, register, value):
    done = subprocess.run(["mbpoll", "-m", "tcp", "-p", str(port), "-a", "3", "-0", "-1", "-o", "10", "-t", "4",
                           "-r", str(register), "127.0.0.1", str(value)], capture_output=True, text=True,
                          timeout=peer.PATIENCE, check=False)
    return "Written" in done.stdout


def changes_are_told_line_by_line(coupler, map_file, device, checks):
    watch = Watch(coupler, map_file, "--at", f"127.0.0.1:{device.port}")

    def await_end(end, since=0):
        at = watch.await_line(lambda line: line.endswith(end), since)
        checks.equal(f"a line '{end}'", at is not None, True)
        return at if at is not None else since

    at = await_end(" slow -100000")
    checks.equal("the change", mbpoll_writes(device.port, 13, 777), True)
    at = await_end(" mode 777", at)
    at = watch.await_line(lambda line: "mode 777" in line, at) or 0
    checks.equal("nothing else was told", watch.lines[at - 1].endswith(" slow -100000"), True)
    device.stop()
    gone = watch.await_line(lambda line: " offline: " in line, at)
    checks.equal("offline is told", gone is not None, True)
    device.set("holding_registers", 13, [42])
    device.start()
    back = await_end(" online again", gone or at)
    checks.equal("no value meanwhile", [line for line in watch.lines[gone + 1:back] if " offline: " not in line], [])
    await_end(" mode 42", back)
    checks.equal("every line has its time", [line for line in watch.lines if not re.match(
        r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z \S", line)], [])
    checks.equal("status after SIGINT", watch.end(), 0)


def changes_are_told_as_json(coupler, map_file, device, checks):
    watch = Watch(coupler, map_file, "--at", f"127.0.0.1:{device.port}", "--json")

    def point(line, name):
        return next(point for point in json.loads(line)["points"] if point["point"] == name)

    at = watch.await_line(lambda line: point(line, "mode")["value"] == 42)
    checks.equal("a first look", at is not None and not point(watch.lines[at], "mode")["changed"], True)
    device.set("holding_registers", 13, [43])
    at = watch.await_line(lambda line: point(line, "mode")["changed"])
    checks.equal("the change", at is not None and point(watch.lines[at], "mode")["value"], 43)
    device.stop()
    at = watch.await_line(lambda line: not json.loads(line)["online"])
    at = watch.await_line(lambda line: not json.loads(line)["online"], (at or 0) + 1)  # the first may have a part
    checks.equal("no value of an offline device is shown",
                 at is not None and {point["value"] for point in json.loads(watch.lines[at])["points"]}, {None})
    device.start()
    at = watch.await_line(lambda line: json.loads(line)["online"], at)
    checks.equal("online again", at is not None and point(watch.lines[at], "mode")["value"], 43)
    checks.equal("status after SIGINT", watch.end(), 0)


def without_a_number_it_looks_once_a_second(coupler, map_file, checks):
    with peer.silent_port() as port, device_with_values(port) as device:
        began = time.monotonic()
        with subprocess.Popen([coupler, "dump", map_file, "--at", f"127.0.0.1:{port}", "--watch", "--json"],
                              stdout=subprocess.PIPE, text=True) as program:
            for _ in range(3):
                program.stdout.readline()
            passed = time.monotonic() - began
            program.terminate()
        checks.equal(f"seconds until the third look, at least 1.9: {passed:.1f}", passed > 1.9, True)
        checks.equal("functions that it was asked for", device.store.asked, READS)


def a_terminal_is_drawn_over(coupler, map_file, device, checks):
    ours, its = pty.openpty()
    program = subprocess.Popen([coupler, "dump", map_file, "--at", f"127.0.0.1:{device.port}", "--watch", "0.1"],
                               stdin=its, stdout=its, stderr=its, env={**os.environ, "TERM": "xterm"})
    os.close(its)
    seen = bytearray()

    def await_text(text):
        end = time.monotonic() + peer.PATIENCE
        while text not in seen and time.monotonic() < end:
            if select.select([ours], [], [], 1)[0]:
                seen.extend(os.read(ours, 65536))
        return text in seen

    checks.equal("a frame at the top of the screen", await_text(b"\x1b[2J\x1b[Hdump at tcp://"), True)
    checks.equal("the value", await_text(b"  mode         43 "), True)
    device.set("holding_registers", 13, [44])
    checks.equal("the change is marked", await_text(b"\x1b[1m* mode         44 "), True)
    device.stop()
    checks.equal("offline", await_text(b": offline: "), True)
    checks.equal("the value goes", await_text(b"  mode         - "), True)
    device.start()
    seen.clear()
    checks.equal("the value comes back", await_text(b"  mode         44 "), True)
    program.send_signal(signal.SIGINT)
    checks.equal("the terminal wraps lines again", await_text(b"\x1b[?7h"), True)
    checks.equal("status after SIGINT", program.wait(peer.PATIENCE), 0)
    os.close(ours)


def changes_of_a_node_are_told_as_they_come(coupler, node, checks):
    """Between two looks that are an hour apart."""
    here = pathlib.Path(__file__).resolve().parent
    with peer.running_node([node, str(here / "schedule.yaml"), "--sim"]) as port:
        watch = Watch(coupler, f"tcp://127.0.0.1:{port}", "--points", "motor,motor_runs,ejector", every="3600")
        client = peer.pymodbus_client(port)
        checks.equal("a first look", watch.await_line(lambda line: line.endswith(" motor_runs false")) is not None, True)
        for coil, level in ((0, True), (0, False), (3, True)):
            checks.equal("pymodbus writes", client.write_coil(coil, level, 1).isError(), False)
        client.close()
        last = watch.await_line(lambda line: line.endswith(" ejector false"), 3)
        told = [line.split(" ", 1)[1] for line in watch.lines[3:(last or 0) + 1]]
        for point in ("motor", "motor_runs", "ejector"):
            checks.equal(f"{point}: each change, a pulse's end too", [line for line in told if line.startswith(point + " ")],
                         [f"{point} true", f"{point} false"])
        os.kill(peer.the_worker(port), signal.SIGKILL)  # another one serves after 100 ms
        gone = watch.await_line(lambda line: " offline: " in line, last or 0)
        back = watch.await_line(lambda line: line.endswith(" online again"), gone or 0)
        checks.equal("the short loss is told, then everything anew", watch.await_line(
            lambda line: line.endswith(" ejector false"), back or len(watch.lines)) is not None, True)
        checks.equal("status after SIGINT", watch.end(), 0)


def a_node_that_is_gone_is_looked_for_soon(coupler, node, checks):
    """However far apart the looks are: what changes between them is not told meanwhile."""
    here = pathlib.Path(__file__).resolve().parent
    command = [node, str(here / "schedule.yaml"), "--sim"]
    with peer.silent_port() as port:
        with peer.running_node(command, port):
            watch = Watch(coupler, f"tcp://127.0.0.1:{port}", "--points", "motor", every="3600")
            checks.equal("a first look", watch.await_line(lambda line: line.endswith(" motor false")) is not None, True)
        gone = watch.await_line(lambda line: line.endswith(" Connection refused"))
        with peer.running_node(command, port):
            back = watch.await_line(lambda line: line.endswith(" online again"), gone or 0)
            checks.equal("it is back, and told", back is not None, True)
            checks.equal("status after SIGINT", watch.end(), 0)


def a_change_has_its_own_time(coupler, node, checks):
    """Not that at which it was heard of, nor that of a look."""
    here = pathlib.Path(__file__).resolve().parent
    with peer.running_node([node, str(here / "schedule.yaml"), "--sim"]) as port:
        watch = Watch(coupler, f"tcp://127.0.0.1:{port}", "--points", "motor", every="3600")
        at = watch.await_line(lambda line: line.endswith(" motor false"))
        checks.equal("a first look", at is not None, True)
        client = peer.pymodbus_client(port)
        for i in range(10):  # a few answers, of which the quickest tells the most of the node's clock
            client.write_coil(0, i % 2 == 0, 1)
            at = watch.await_line(lambda line: " motor " in line, (at or 0) + 1)
        peer.freeze(watch.program)
        try:
            time.sleep(2 * DOUBT)  # that look is as far away as the news of the change
            begun = time.time()
            checks.equal("pymodbus writes", client.write_coil(0, True, 1).isError(), False)
            written = time.time()
            time.sleep(2 * DOUBT)
        finally:
            watch.program.send_signal(signal.SIGCONT)
        client.close()
        at = watch.await_line(lambda line: line.endswith(" motor true"), (at or 0) + 1)
        told = datetime.datetime.fromisoformat(watch.lines[at or 0].split("Z ")[0] + "+00:00").timestamp()
        checks.equal("offline is not told", [line for line in watch.lines if " offline: " in line], [])
        checks.equal(f"{told - begun:.3f} s after the write began, it ended after {written - begun:.3f}",
                     begun - DOUBT <= told <= written + DOUBT, True)
        checks.equal("status after SIGINT", watch.end(), 0)


def changes_of_a_device_are_told(coupler, map_file, checks):
    # Stopped and started again, it has the same port.
    with peer.silent_port() as port, device_with_values(port) as device:
        changes_are_told_line_by_line(coupler, map_file, device, checks)
        checks.equal("functions that the device was asked for, and mbpoll's", device.store.asked, READS | {6})
        device.store.asked.clear()
        changes_are_told_as_json(coupler, map_file, device, checks)
        a_terminal_is_drawn_over(coupler, map_file, device, checks)
        checks.equal("functions that the device was asked for", device.store.asked, READS)


def main():
    coupler, map_file, node = sys.argv[1:]
    checks = peer.Checks()
    peer.side_by_side((changes_of_a_device_are_told, coupler, map_file, checks),
                      (without_a_number_it_looks_once_a_second, coupler, map_file, checks),
                      (changes_of_a_node_are_told_as_they_come, coupler, node, checks),
                      (a_node_that_is_gone_is_looked_for_soon, coupler, node, checks),
                      (a_change_has_its_own_time, coupler, node, checks))
    checks.done("coupler dump --watch tells what changes at pymodbus and at a node, and writes nothing")


main()
