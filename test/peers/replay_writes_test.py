#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`coupler-node --replay` compares what pymodbus writes with what was recorded, plays what another map has of a
recording, and says what it cannot play.

    replay_writes_test.py NODE
"""
import concurrent.futures
import pathlib
import re
import sys
import tempfile
import time

import peer

try:
    import pymodbus  # noqa: F401
except ImportError as error:
    peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")
from recording import TAPE_MAP, Node, Program, Tape, outcomes, read, utc, wait_until

TOLERANCE = 0.5  # seconds of the recording by which a write may be late


def a_client_is_compared(node, folder, checks):
    """The one that was recorded opens a valve at 0.4 s and closes it at 0.8 s, and sets a speed meanwhile."""
    tape = Tape(TAPE_MAP)
    for point, value in (("door", False), ("valve", False), ("speed", 1), ("count", 0), ("quiet", 0)):
        tape.value(0.01, point, value)
    tape.value(0.4, "valve", True).value(0.6, "speed", -7).value(0.8, "valve", False).value(0.9, "count", 1)
    file = tape.add(1, end=True).write(folder / "writes.jsonl")
    as_recorded = [(0, "valve", 0), (0, "speed", 1), (0.4, "valve", 1), (0.6, "speed", -7), (0.8, "valve", 0)]
    wrong = [(t, point, -8 if value == -7 else value) for t, point, value in as_recorded]
    cases = {
        "as recorded": (as_recorded, [], 0, []),
        "a wrong value": (wrong, [], 1, [("0.600", "speed", "nobody wrote the recorded -7"),
                                         ("0.6", "speed", "the recording does not have the written -8")]),
        "one too few": (as_recorded[:-1], [], 1, [("0.800", "valve", "nobody wrote the recorded false")]),
        "one too many": ([*as_recorded, (0.85, "speed", 9)], [], 1,
                         [("0.85", "speed", "the recording does not have the written 9")]),
        "a wrong value that does not count": (wrong, ["--points", "v*"], 0, []),
        "nothing": ([(0, "quiet", 0)], [], 0, []),
        "nothing, where something is to be": ([(0, "quiet", 0)], ["--points", "valve"], 1, []),
    }
    with concurrent.futures.ThreadPoolExecutor(len(cases)) as pool:
        played = {name: pool.submit(play_a_client, node, file, writes, options)
                  for name, (writes, options, _, _) in cases.items()}
    for name, (writes, options, status, differences) in cases.items():
        got, said = played[name].result()
        checks.equal(f"{name}: status", got, status)
        checks.equal(f"{name}: what nobody wrote", "nobody wrote valve" in said, writes == [(0, "quiet", 0)])
        found = re.findall(r"^replay: (\S+Z) \((\d\.\d{3}) s\): (\w+): (.*)$", said, re.M)
        found.sort(key=lambda difference: difference[2:])
        checks.equal(f"{name}: differences", [each[2:] for each in found], [each[1:] for each in differences])
        for (at, t, *_), (wanted, *_) in zip(found, differences):
            checks.equal(f"{name}: {at} is {t} s", abs(utc(at) - utc(Tape.utc(float(t)))) < 0.002, True)
            # When it was recorded is known, when it was written only roughly.
            is_then = t == wanted if len(wanted) == 5 else abs(float(t) - float(wanted)) < 1
            checks.equal(f"{name}: {t} is {wanted}", is_then, True)


def play_a_client(node, file, writes, options):
    def play(silence, slower):
        with Node(node, "--replay", file, "--tolerance", TOLERANCE, "--speed", 1 / slower, *options) as device, \
                peer.waits_noted(silence, device.process):
            client = peer.pymodbus_client(device.port)
            began = time.monotonic()
            for t, point, value in writes:
                wait_until(began + t * slower)
                if point == "valve":
                    client.write_coil(0, bool(value), 1)
                else:
                    client.write_register({"speed": 0, "quiet": 9}[point], value & 0xFFFF, 1)
                silence.note(time.monotonic() - began - t * slower)
            client.close()
            return device.wait(), device.text()

    return peer.slower_until_undisturbed(TOLERANCE / 2, play)


def what_a_client_writes_stays(node, folder, checks):
    def play(silence):
        with Node(node, "--replay", folder / "stays.jsonl") as device, peer.waits_noted(silence, device.process):
            client = peer.pymodbus_client(device.port, retries=0)
            failed = silence.ask(lambda: client.write_register(0, 77, 1).isError())
            others, kept = outcomes(device.port, 1, 2, silence), silence.ask(lambda: read(client, 0))
            client.close()
            return failed, others, kept, device.wait()

    failed, others, kept, status = peer.undisturbed(0.5, play)
    checks.equal("it is written", failed, False)
    checks.equal("others follow the recording", others, [1, 2])
    checks.equal("what is written stays", kept, 77)
    checks.equal("status", status, 1)


def another_map_plays_the_rest(node, folder, checks):
    other = folder / "other.yaml"
    other.write_text(TAPE_MAP.replace("count:", "counter:").replace("quiet: {address: 9, type: INT}",
                                                               "quiet: {address: 9, type: REAL}"), encoding="utf-8")

    def play(silence):
        with Node(node, other, "--replay", folder / "stays.jsonl") as device, peer.waits_noted(silence, device.process):
            played, rest = outcomes(device.port, 0, 2, silence), outcomes(device.port, 1, 0, silence)
            return played, rest, device.wait(), device.text()

    played, rest, status, told = peer.undisturbed(0.5, play)
    checks.equal("the rest is played", played, [1, 2])
    checks.equal("what is not is not", rest, [0])
    checks.equal("status", status, 0)
    for said in ("'count' is not played: the map has no such point",
                 "'quiet' is not played: it has another type in the map"):
        checks.equal(said, said in told, True)


def what_cannot_be_played_is_told(node, folder, checks):
    good = (folder / "stays.jsonl").read_text(encoding="utf-8").splitlines(keepends=True)
    for name, text, line, part in (
            ("empty", "", 1, "no recording"),
            ("garbage", "\0\xff garbage\n", 1, "no recording"),
            ("newer", good[0].replace('"record": 1', '"record": 2'), 1, "version 2"),
            ("broken", "".join([*good[:3], "{]\n", *good[3:]]), 4, "no JSON"),
            ("odd", "".join([*good[:2], '{"t": 0}\n', *good[2:]]), 3, "no 'utc'")):
        file = folder / f"{name}.jsonl"
        file.write_bytes(text.encode("latin-1"))
        with Program(node, "--sim", "--replay", file, "--listen", "127.0.0.1", "--port", 0) as program:
            checks.equal(f"{name}: status", program.wait(), 1)
            checks.equal(f"{name}: place and reason in '{program.text()}'",
                         [f"{file}:{line}: " in program.text(), part in program.text()], [True, True])
    with Program(node, "--replay", folder / "stays.jsonl", "--listen", "127.0.0.1", "--port", 0) as program:
        checks.equal("status without --sim", program.wait(), 2)
        checks.equal("the remedy", "--sim" in program.text(), True)
    cut = folder / "cut.jsonl"
    cut.write_text("".join(good)[:-9], encoding="utf-8")  # as of a recorder that was killed

    def play(silence):
        with Node(node, "--replay", cut) as device, peer.waits_noted(silence, device.process):
            return outcomes(device.port, 1, 2, silence), device.wait()

    checks.equal("one that is cut short is played, and its status", peer.undisturbed(0.5, play), ([1, 2], 0))


def main():
    node = sys.argv[1]
    checks = peer.Checks()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        Tape(TAPE_MAP).value(0, "speed", 1).value(0, "count", 1).value(0.5, "speed", 2).value(0.5, "count", 2) \
            .add(1.5, end=True).write(folder / "stays.jsonl")
        peer.side_by_side(*((part, node, folder, checks) for part in (
            a_client_is_compared, what_a_client_writes_stays, another_map_plays_the_rest, what_cannot_be_played_is_told)))
    checks.done("a node that plays a recording tells what is written otherwise, and what it cannot play")


main()
