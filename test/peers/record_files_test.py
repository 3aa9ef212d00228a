#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What `coupler record` leaves on the disk, while pymodbus changes a node without end: whole lines, whenever it is
killed and when the disk is full, in files that begin with all that is known, of which the oldest are deleted.

    record_files_test.py NODE COUPLER MAP
"""
import errno
import functools
import itertools
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import threading
import time

import peer

try:
    import pymodbus  # noqa: F401
except ImportError as error:
    peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")
from recording import Node, Program, Recorder, values, whole_lines

MIB = 1 << 20


class Busy:
    """pymodbus changes a node as fast as it can, in a thread."""

    def __init__(self, port):
        self.port = port
        self.stopped = threading.Event()
        self.thread = threading.Thread(target=self._run, daemon=True)

    def _run(self):
        client = peer.pymodbus_client(self.port)
        for i in itertools.count():
            if self.stopped.wait(0.002):
                break
            client.write_registers(9, [i * 100 + k & 0xFFFF for k in range(100)], 1)
            client.write_coils(0, [i & 1, i & 2], 1)
        client.close()

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.stopped.set()
        self.thread.join(peer.PATIENCE)


def a_killed_recorder_leaves_whole_lines(coupler, fast_map, port, folder, checks):
    chance = random.Random(4)
    file = folder / "killed.jsonl"
    for _ in range(5):
        with Recorder(coupler, fast_map, port, file) as recorder:
            # The one of the run before has a number as soon as this one writes.
            peer.await_true("it writes", lambda: size_of(file) and "connected" in recorder.text(), checks)
            time.sleep(chance.uniform(0, 0.8))
            recorder.process.kill()
            recorder.process.wait()
        checks.equal("it begins with a head", whole_lines(file)[0]["record"], 1)
    files = sorted(path.name for path in folder.glob("killed*"))
    checks.equal("each run's is kept", files, [f"killed.{i}.jsonl" for i in range(1, 5)] + ["killed.jsonl"])
    for name in files:
        checks.equal(f"{name} has lines, whole ones but perhaps the last", len(whole_lines(folder / name)) > 1, True)


def numbers(folder, name):
    return sorted(int(path.name.split(".")[1]) for path in folder.glob(f"{name}.*.jsonl"))


def size_of(path):
    try:
        return path.stat().st_size
    except FileNotFoundError:
        return 0


def the_oldest_files_are_deleted(coupler, fast_map, port, folder, checks):
    share = MIB // 8
    before = folder / "ring.jsonl"
    before.write_text((folder / "killed.1.jsonl").read_text(encoding="utf-8"), encoding="utf-8")
    kept = before.read_bytes()
    largest = []

    def look():
        """Those with a number but the last, which may have it before an older one is deleted."""
        largest.append(sum(size_of(folder / f"ring.{i}.jsonl") for i in numbers(folder, "ring")[:-1]))

    with Recorder(coupler, fast_map, port, before, "--keep", "1M") as recorder:
        peer.await_true("a first file", lambda: size_of(before) and 1 in numbers(folder, "ring"), checks)
        checks.equal("a recording that was there is kept", (folder / "ring.1.jsonl").read_bytes(), kept)
        peer.await_true("files are deleted", lambda: numbers(folder, "ring")[:1] > [3], checks, look)
        checks.equal("status", recorder.end(), 0)
    left = numbers(folder, "ring")
    checks.equal("those that are left are the last", left, [*range(left[0], left[-1] + 1)])
    checks.equal("1 MiB is not exceeded meanwhile", max(largest, default=0) <= MIB, True)
    sizes = [size_of(folder / f"ring.{i}.jsonl") for i in left]
    checks.equal("nor at the end, with a share for the last one", sum(sizes) + share <= MIB, True)
    checks.equal("each has its share", [size for size in sizes if size < share], [])
    end = 0
    for i in [*left, None]:
        head, *lines = whole_lines(folder / (f"ring.{i}.jsonl" if i else "ring.jsonl"))
        checks.equal("a head", [head["record"], head["name"], "curve" in head["map"]], [1, "recorded", True])
        checks.equal("time goes on", head["t"] > end - 1, True)
        end = lines[-1]["t"]
        checks.equal("all that is known", {*head["periods"]} - {line.get("point") for line in lines[:20]}, set())


def on_a_disk(size, use, checks):
    """`use(folder, checks)`, where the folder is a disk of this size."""
    with tempfile.TemporaryDirectory() as point:
        mounted = Program("unshare", "-m", "sh", "-c", f"mount -t tmpfs -o size={size} full {point} && echo ok; exec cat",
                          stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        with mounted:
            if os.getuid() != 0 or not mounted.process.stdout.readline():
                mounted.process.stdin.close()
                print(f"remark: no full disk, which needs root and a mount namespace: {mounted.text().strip()}")
                return
            use(pathlib.Path(f"/proc/{mounted.process.pid}/root{point}"), checks)
            mounted.process.stdin.close()
            mounted.wait()


def a_small_disk(coupler, fast_map, port, disk, checks):
    """It has less room than --keep."""
    with Recorder(coupler, fast_map, port, disk / "small.jsonl") as recorder:
        peer.await_true("files are deleted", lambda: numbers(disk, "small")[:1] > [2], checks)
        checks.equal("status", recorder.end(), 0)
        checks.equal("nothing is missing", "No space left" in recorder.text(), False)
    checks.equal("the last one has its head", whole_lines(disk / "small.jsonl")[0]["record"], 1)
    checks.equal("others are there", len(numbers(disk, "small")) >= 3, True)


def a_full_disk(coupler, fast_map, port, disk, checks):
    with Recorder(coupler, fast_map, port, disk / "full.jsonl") as recorder:
        recorder.await_lines("a beginning", lambda lines: len(values(lines, "curve")) > 3, checks)
        with open(disk / "other", "wb", buffering=0) as other:
            def fill():
                """Again and again: what the recorder deletes to make room is not to be its room."""
                try:
                    while True:
                        other.write(bytes(4096))
                except OSError as error:
                    if error.errno != errno.ENOSPC:
                        raise

            peer.await_true("it is told", lambda: "No space left" in recorder.text(), checks, fill)
        found = [len(values(whole_lines(file), "curve")) for file in disk.glob("full*") if size_of(file)]
        checks.equal("what there was is still there", max(found) > 3, True)
        (disk / "other").unlink()
        recorder.await_lines("it goes on", lambda lines: len(values(lines, "curve")) > 1, checks)
        checks.equal("status", recorder.end(), 0)
    all_lines = [whole_lines(file) for file in disk.glob("full*.jsonl") if size_of(file)]
    checks.equal("heads", {lines[0]["record"] for lines in all_lines}, {1})
    missing = [line for lines in all_lines for line in lines if "missing_since" in line]
    checks.equal("what is missing is said", len(missing), 1)
    checks.equal("with the reason", ["No space left" in line["why"] and line["missing_since"] < line["t"]
                                     for line in missing], [True])
    for file in disk.glob("full*"):
        checks.equal(f"{file.name} has whole lines", file.read_bytes()[-2:], b"}\n")


def main():
    node, coupler, map_file = sys.argv[1:]
    checks = peer.Checks()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        fast_map = folder / "fast.yaml"
        fast_map.write_text(pathlib.Path(map_file).read_text(encoding="utf-8").replace("rate: 10", "rate: 400"),
                            encoding="utf-8")
        with Node(node, map_file) as device, Busy(device.port):
            a_killed_recorder_leaves_whole_lines(coupler, fast_map, device.port, folder, checks)
            peer.side_by_side(
                (the_oldest_files_are_deleted, coupler, fast_map, device.port, folder, checks),
                (on_a_disk, "2M", functools.partial(a_full_disk, coupler, fast_map, device.port), checks),
                (on_a_disk, "640k", functools.partial(a_small_disk, coupler, fast_map, device.port), checks))
    checks.done("coupler record leaves whole lines, in files that can be used alone, and no more than it may")


main()
