#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Tools that look on until they are ended: each signal that asks for it ends them in order, and whoever does not read what
they say keeps them from nothing.

    ends_test.py NODE COUPLER MAP
"""
import contextlib
import json
import os
import pathlib
import resource
import signal
import socket
import subprocess
import sys
import tempfile
import time

import peer

NODE, COUPLER, MAP = sys.argv[1:4]
ENDED = {signal.SIGINT: 0, signal.SIGTERM: 0, signal.SIGHUP: 0, signal.SIGUSR1: 0, signal.SIGUSR2: 0,
         signal.SIGQUIT: -signal.SIGQUIT}  # which asks for a core, too


def fill(file):
    """Writes into it until it takes no more."""
    os.set_blocking(file, False)
    with contextlib.suppress(BlockingIOError):
        while True:
            os.write(file, b"x" * 100 + b"\n")
    os.set_blocking(file, True)


def lines_of(path):
    text = path.read_bytes() if path.exists() else b""
    return [json.loads(line) for line in text.splitlines(keepends=True) if line.endswith(b"\n")]


def is_recorded(path):
    return any("curve" in line.values() for line in lines_of(path))


def record(port, path, before=(), **options):
    return subprocess.Popen([*before, COUPLER, "record", MAP, "--at", f"127.0.0.1:{port}", "-o", path], **options)


def a_recording_ends_whole(port, folder, number, checks):
    path = folder / f"{number}.jsonl"
    with record(port, path, stderr=subprocess.DEVNULL) as program:
        peer.await_true(f"{number}: something is recorded", lambda: is_recorded(path), checks)
        program.send_signal(number)
        checks.equal(f"{number}: status", program.wait(peer.PATIENCE), ENDED[number])
    checks.equal(f"{number}: the last line is the end", "end" in lines_of(path)[-1], True)


def nohup_is_respected(port, folder, checks):
    path = folder / "nohup.jsonl"
    with record(port, path, before=["nohup"], stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL) as program:
        peer.await_true("nohup: something is recorded", lambda: is_recorded(path), checks)
        program.send_signal(signal.SIGHUP)
        time.sleep(0.5)
        checks.equal("nohup: it goes on after SIGHUP", program.poll(), None)
        program.send_signal(signal.SIGTERM)
        checks.equal("nohup: status", program.wait(peer.PATIENCE), 0)


def a_silent_device_holds_nothing_up(checks):
    with socket.create_server(("127.0.0.1", 0)) as silent:
        with subprocess.Popen([COUPLER, "dump", MAP, "--at", f"127.0.0.1:{silent.getsockname()[1]}", "--watch", "0.1"],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as program:
            silent.accept()[0].recv(12)
            program.send_signal(signal.SIGINT)
            checks.equal("a silent device: status", program.wait(peer.PATIENCE), 0)


def awaits_signals(program):
    """Whether it has blocked SIGINT, for the thread that takes it with sigwait()."""
    status = pathlib.Path(f"/proc/{program.pid}/status").read_text(encoding="ascii")
    blocked = next(line.split()[1] for line in status.splitlines() if line.startswith("SigBlk:"))
    return int(blocked, 16) >> (signal.SIGINT - 1) & 1 == 1


def nobody_reads(what, command, checks, folder=None):
    """Neither its messages nor its output, where that is not a recording in the folder."""
    for kind, make in ("pipe", os.pipe), ("socket", lambda: tuple(end.detach() for end in socket.socketpair())):
        reader, writer = make()
        fill(writer)
        path = folder / f"{kind}.jsonl" if folder else None
        with subprocess.Popen([*command, *(["-o", path] if folder else [])], stdout=writer, stderr=writer) as program:
            os.close(writer)
            if folder:
                peer.await_true(f"{what}: it records", lambda path=path: is_recorded(path), checks)
            else:
                peer.await_true(f"{what}: it awaits signals", lambda program=program: awaits_signals(program), checks)
                time.sleep(0.5)  # so that it is writing to what nobody reads
            program.send_signal(signal.SIGINT)
            try:
                checks.equal(f"{what}: status", program.wait(peer.PATIENCE / 6), 0)
            except subprocess.TimeoutExpired:
                program.kill()
                checks.equal(f"{what}: it ends", False, True)
        os.close(reader)


def a_log_file_that_may_not_grow_ends_no_node(folder, checks):
    log = folder / "node.log"
    with open(log, "w", encoding="utf-8") as file:
        node = subprocess.Popen([NODE, MAP, "--sim", "--listen", "127.0.0.1", "--port", "0"], stderr=file,
                                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (400, 400)))
    peer.await_true("small log: it serves", lambda: "serving" in log.read_text(encoding="utf-8"), checks)
    port = int(log.read_text(encoding="utf-8").split("127.0.0.1:")[1].split()[0].rstrip(","))
    request = b"\0\1\0\0\0\6\1\1\0\0\0\1"
    with socket.create_connection(("127.0.0.1", port), peer.PATIENCE) as client:
        for _ in range(5):
            node.send_signal(signal.SIGHUP)  # which is told
            time.sleep(0.1)
            client.sendall(request)
            checks.equal("small log: it answers", client.recv(300)[:2], request[:2])
    checks.equal("small log: its size", log.stat().st_size <= 400, True)
    node.terminate()
    checks.equal("small log: status", node.wait(peer.PATIENCE), 0)


def main():
    checks = peer.Checks()
    with tempfile.TemporaryDirectory() as name, peer.running_node([NODE, MAP, "--sim"]) as port:
        folder = pathlib.Path(name)
        at = ["--at", f"127.0.0.1:{port}"]
        peer.side_by_side(
            *((a_recording_ends_whole, port, folder, number, checks) for number in ENDED),
            (nohup_is_respected, port, folder, checks),
            (a_silent_device_holds_nothing_up, checks),
            (a_log_file_that_may_not_grow_ends_no_node, folder, checks),
            (nobody_reads, "dump --watch", [COUPLER, "dump", MAP, *at, "--watch", "0.05"], checks),
            (nobody_reads, "dump --watch --json", [COUPLER, "dump", MAP, *at, "--watch", "0.05", "--json"], checks),
            (nobody_reads, "panel", [COUPLER, "panel", MAP, *at, "--port", "0"], checks),
            (nobody_reads, "record", [COUPLER, "record", MAP, *at], checks, folder))
    checks.done("record, dump --watch and panel end in order, and wait for no reader")


main()
