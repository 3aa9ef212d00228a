#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`coupler-node --replay` is to pymodbus, and to `coupler record`, the device that was recorded, with its
faults, as fast as wanted, from a moment on, or again and again.

    replay_test.py NODE COUPLER MAP
"""
import concurrent.futures
import pathlib
import random
import subprocess
import sys
import tempfile
import time

import peer

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from support.raw_client import RawClient, wait_for_changes  # noqa: E402  pylint: disable=wrong-import-position

try:
    import foreign_server
except ImportError as error:
    peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")
from recording import TAPE_MAP, Node, Recorder, Tape, outcomes, until_lost, values, whole_lines

OUTPUTS = ["lamp", "valve"]
TOLD = [*OUTPUTS, "lamp_burns", "valve_closed"]  # a node tells changes of bits: none is missed, at any speed
READ = ["setpoint", "gain", "label", "pressure", "curve"]
FAULT = 0.7  # seconds that each lasts
STEP = 0.4   # seconds between a value and the next
WAIT = 0.3   # seconds: what is read ten times a second, and is there for longer by 0.2 s, is seen


def record_a_session(node, coupler, map_file, file, checks, silence):
    """pymodbus writes at random, but nothing so often that reading it ten times a second might miss it."""
    chance = random.Random(94)
    file.unlink(missing_ok=True)
    with Node(node, map_file) as device, Recorder(coupler, map_file, device.port, file) as recorder, \
            peer.waits_noted(silence, device.process, recorder.process):
        recorder.await_value("level", -2, checks)
        time.sleep(1.5)  # who is played it four times as fast reads what was there in the beginning, too
        client = peer.pymodbus_client(device.port)
        for address in chance.sample([0, 1, 3, 8, 9], 5):
            for coil in (0, 1):
                time.sleep(0.25)
                client.write_coil(coil, chance.random() < 0.7, 1)
            client.write_registers(address, [chance.randrange(0x2000, 0x4000) for _ in range(chance.choice([1, 4]))], 1)
        time.sleep(0.5)
        client.write_registers(8, [217, 7], 1)
        recorder.await_value("pressure", -18.3, checks)
        client.close()
        checks.equal("status of the recorder", recorder.end(), 0)
        checks.equal("status of the node", device.end(), 0)
    return whole_lines(file)


def changes(lines, point):
    """(t, what it was then) of each change. The first one is how it was in the beginning."""
    all_of_it = [(line["t"], line["value"], line.get("registers")) for line in lines if line.get("point") == point]
    return [now for before, now in zip([None, *all_of_it], all_of_it) if before is None or now[1:] != before[1:]]


def first_change(lines):
    return min(changes(lines, point)[1][0] for point in TOLD if len(changes(lines, point)) > 1)


def the_session_is_played(node, coupler, map_file, recorded, file, speed, checks):
    again = file.with_name(f"again{speed}.jsonl")

    def play(silence):
        again.unlink(missing_ok=True)
        with Node(node, "--replay", file, "--speed", speed) as device, \
                Recorder(coupler, map_file, device.port, again) as recorder, \
                peer.waits_noted(silence, device.process, recorder.process):
            checks.equal(f"speed {speed}: status of the node", device.wait(), 0)
            checks.equal(f"speed {speed}: it says why it ends", "the recording is over: outputs are" in device.text(), True)
            recorder.await_lines("its end", lambda lines: lines[-1].get("device") == "lost", checks)
            checks.equal(f"speed {speed}: status of the recorder", recorder.end(), 0)
        return until_lost(recorder.lines())

    played = peer.undisturbed(WAIT, play)
    slack = 1 + speed  # a busy machine may be late by a second, with the recording and with what is played
    begins = first_change(recorded), first_change(played)
    for point in [*TOLD, *READ, "level"]:
        then, now = changes(recorded, point), changes(played, point)
        if point in READ and speed > 1:  # some were read, in their order
            rest = iter(then)
            checks.equal(f"speed {speed}: {point}", all(any(a[1:] == b[1:] for a in rest) for b in now), True)
            checks.equal(f"speed {speed}: {point} was read", len(now) > 1 or len(then) == 1, True)
            continue
        if point in OUTPUTS and len(now) > len(then):  # the node has ended, and they are safe
            checks.equal(f"speed {speed}: {point} at the end", now.pop()[1], False)
        checks.equal(f"speed {speed}: {point}", [each[1:] for each in now], [each[1:] for each in then])
        late = [(a[0] - begins[0], (b[0] - begins[1]) * speed) for a, b in zip(then[1:], now[1:])]
        checks.equal(f"speed {speed}: times of {point}", [pair for pair in late if abs(pair[0] - pair[1]) > slack], [])


def tape_with_faults():
    tape = Tape(TAPE_MAP)
    for point, value in (("door", True), ("valve", False), ("speed", 1), ("count", 0), ("quiet", 5)):
        tape.value(0, point, value)
    tape.exception(FAULT, "speed", 6).value(2 * FAULT, "speed", 2)
    tape.add(3 * FAULT, device="lost", why="somebody pulled the plug").add(4 * FAULT, device="online")
    for point, value in (("door", True), ("valve", False), ("speed", 3), ("count", 0), ("quiet", 5)):
        tape.value(4 * FAULT, point, value)
    return tape.add(4, end=True)


def faults_are_played(node, folder, checks):
    file = tape_with_faults().write(folder / "faults.jsonl")

    def play(silence):
        other = peer.Silence()
        with Node(node, "--replay", file) as device, peer.waits_noted(silence, device.process), \
                concurrent.futures.ThreadPoolExecutor() as pool:
            quiet = pool.submit(outcomes, device.port, 9, "closed", other)
            seen = outcomes(device.port, 0, 3, silence), quiet.result(), device.wait()
        silence.note(other.longest)
        return seen

    def play_none(silence):
        with Node(node, "--replay", file, "--no-faults") as device, peer.waits_noted(silence, device.process):
            return outcomes(device.port, 0, 3, silence), device.wait()

    faults, others, status = peer.undisturbed(FAULT, play)
    checks.equal("faults", faults, [1, "exception 6", 2, "closed", 3])
    checks.equal("others are read while a point has an exception", others, [5, "closed"])
    checks.equal("status", status, 0)
    checks.equal("no faults, and its status", peer.undisturbed(FAULT, play_none), ([1, 2, 3], 0))


def a_part_and_the_whole_again_and_again(node, folder, checks):
    tape = Tape(TAPE_MAP).value(0, "valve", False)
    for i in range(4):
        tape.value(STEP * i, "speed", i)
    file = tape.add(4 * STEP, end=True).write(folder / "steps.jsonl")

    def play_a_part(silence):
        with Node(node, "--replay", file, "--from", Tape.utc(2 * STEP + 0.1)) as device, peer.waits_noted(silence, device.process):
            return outcomes(device.port, 0, 3, silence), device.wait()

    def play_again_and_again(silence):
        with Node(node, "--replay", file, "--loop") as device, peer.waits_noted(silence, device.process):
            return outcomes(device.port, 0, 3, silence, times=3), device.end()

    checks.equal("--from: from the first request on, and the status", peer.undisturbed(STEP - 0.1, play_a_part),
                 ([2, 3], 0))
    checks.equal("--loop, and the status of one that was ended", peer.undisturbed(STEP, play_again_and_again),
                 (3 * [0, 1, 2, 3], 0))


def no_pulse_is_too_short(node, coupler, folder, checks):
    tape = Tape(TAPE_MAP).value(0, "valve", False)
    for i in range(10):  # from 10 s on, when the recorder listens even on a busy machine
        tape.value(10 + 0.1 * i, "valve", True).value(10.000001 + 0.1 * i, "valve", False)
    file = tape.add(12, end=True).write(folder / "pulses.jsonl")
    again = folder / "pulses_again.jsonl"
    with Node(node, "--replay", file) as device, Recorder(coupler, f"tcp://127.0.0.1:{device.port}", device.port, again) as recorder:
        checks.equal("status", device.wait(), 0)
        recorder.await_lines("its end", lambda lines: lines[-1].get("device") == "lost", checks)
        recorder.end()
    checks.equal("pulses of a microsecond are told", values(until_lost(recorder.lines()), "valve"), [False] + 10 * [True, False])


FOREIGN = """name: foreign
rate: 20
timeout: 20s
mapping:
  coils: {lamp: {address: 0, read_address: 512}}
  holding_registers: {level: {address: 3, type: INT}}
"""


def a_foreign_coupler_is_played_without_what_nodes_have(node, coupler, folder, checks):
    map_file, file = folder / "foreign.yaml", folder / "foreign.jsonl"
    map_file.write_text(FOREIGN, encoding="utf-8")
    device = foreign_server.Device({"coils": {0: 1, 512: 1}, "holding_registers": {3: 7}})
    with foreign_server.serving(device) as port, Recorder(coupler, map_file, port, file) as recorder:
        recorder.await_value("level", 7, checks)
        device.tables["holding_registers"][3] = 8
        recorder.await_value("level", 8, checks)
        recorder.end()
    checks.equal("what the device was", [line["foreign"] for line in recorder.lines() if "foreign" in line], [True])
    again = folder / "foreign_again.jsonl"
    with Node(node, "--replay", file, "--loop") as played:
        with RawClient(("127.0.0.1", played.port)) as client:
            for what, request in (("its identity", b"\x04\xff\x00\x00\x02"), ("its map", b"\x14\x07\x06\x00\x01\x00\x00\x00\x01"),
                                  ("its name", b"\x2b\x0e\x01\x00"), ("changes", wait_for_changes(0, 0)), ("a schedule", b"\x42")):
                code = 2 if request[0] == 4 else 1
                checks.equal(f"who asks for {what}", client.ask(request), bytes([request[0] | 0x80, code]))
        status = subprocess.run([coupler, "status", "--timeout", "20", f"127.0.0.1:{played.port}"], capture_output=True, text=True, check=False)
        checks.equal("coupler status", (status.returncode, "is a foreign coupler" in status.stderr), (1, True))
        with Recorder(coupler, map_file, played.port, again) as recorder:
            lines = recorder.await_lines("both values", lambda lines: {7, 8} <= {*values(lines, "level")}, checks)
            recorder.end()
        checks.equal("for the recorder, too", [line["foreign"] for line in lines if "foreign" in line][:1], [True])
        checks.equal("who plays says so", "of a foreign coupler" in played.text(), True)
        played.end()


def the_recorded_is_played(node, coupler, map_file, folder, checks):
    file = folder / "session.jsonl"
    recorded = peer.undisturbed(WAIT, lambda silence: record_a_session(node, coupler, map_file, file, checks, silence))
    checks.equal("a session with changes", min(len(values(recorded, "lamp")), len(values(recorded, "curve"))) > 2, True)
    # At the first all that is read is there for half a second at least, and so is seen.
    peer.side_by_side(*((the_session_is_played, node, coupler, map_file, recorded, file, speed, checks) for speed in (0.5, 4)))


def main():
    node, coupler, map_file = sys.argv[1:]
    checks = peer.Checks()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        peer.side_by_side((the_recorded_is_played, node, coupler, map_file, folder, checks),
                          (faults_are_played, node, folder, checks),
                          (no_pulse_is_too_short, node, coupler, folder, checks),
                          (a_foreign_coupler_is_played_without_what_nodes_have, node, coupler, folder, checks),
                          (a_part_and_the_whole_again_and_again, node, folder, checks))
    checks.done("a node that plays a recording is the device that was recorded")


main()
