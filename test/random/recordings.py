# SPDX-License-Identifier: Apache-2.0
"""Random maps whose outputs pymodbus sets at random: `coupler record` has every change, a node plays them, and who records
that node has them once more.

    recordings.py BIN MAPS COUNT
"""
import concurrent.futures
import pathlib
import random
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "peers"))

# pylint: disable=wrong-import-position
import peer  # noqa: E402

try:
    import pymodbus  # noqa: F401
except ImportError:
    peer.skip("pymodbus is not installed; run scripts/install-packages test")
from random_map import Map, PymodbusClient, masked  # noqa: E402
from recording import Node, Recorder, until_lost, whole_lines  # noqa: E402

STEPS = 8
AT_ONCE = 4
SPEEDS = (0.5, 0.1)  # a change is there for half a second at least; what a busy machine misses all the same, for 2.5 s


def raw_of(point, line):
    """A recorded value as the wire has it: bits as 0 and 1, registers without what others have of them."""
    if "registers" in line:
        return masked(point, line["registers"])
    value = line["value"] if isinstance(line["value"], list) else [line["value"]]
    return [int(bit) << (int(point["mask"], 16).bit_length() - 1 if "mask" in point else 0) for bit in value]


def recorded(points, lines):
    """Of each point what it became, one after another."""
    found = {point["name"]: [] for point in points}
    by_name = {point["name"]: point for point in points}
    for line in lines:
        if line.get("quality") != "good":
            continue
        raw, values = raw_of(by_name[line["point"]], line), found[line["point"]]
        if values[-1:] != [raw]:
            values.append(raw)
    return found


def has_all(values, wanted):
    """Whether these are among them in this order."""
    rest = iter(values)
    return all(any(value == each for value in rest) for each in wanted)


def drive(tested, port, recorder, chance, checks):
    """Sets outputs, and waits until what all points then are is recorded. What that was, from the beginning on."""
    points = [point for point in tested.points if point["access"] != "write"]
    client = PymodbusClient(port)
    states = {point["name"]: [] for point in points}

    def is_recorded():
        now.update({point["name"]: masked(point, client.get(point)) for point in points})
        last = {name: values[-1:] for name, values in recorded(points, recorder.lines()).items()}
        return all(last[name] == [value] for name, value in now.items())

    for step in range(STEPS + 1):
        now = {}
        peer.await_true(f"{tested.name}: all is recorded after step {step}", is_recorded, checks)
        for name, value in now.items():
            if states[name][-1:] != [value]:
                states[name].append(value)
        taken = set()
        for i, point in tested.settable():
            raw = tested.raw(i, chance.randrange(100))
            if raw is None or chance.random() < 0.3:
                continue
            places = {(point["table"], point["address"] + k) for k in range(len(raw))}
            if not places & taken:  # twice in a step would be once for who reads between steps
                client.put(point, raw)
                taken |= places
    client.client.close()
    return points, states


def check(bin_, path, folder, checks):
    tested = Map(bin_ / "coupler", path)
    file = folder / f"{tested.name}.jsonl"
    with Node(bin_ / "coupler-node", path) as node, Recorder(bin_ / "coupler", path, node.port, file) as recorder:
        points, states = drive(tested, node.port, recorder, random.Random(tested.name), checks)
        checks.equal(f"{tested.name}: status of the recorder", recorder.end(), 0)
        checks.equal(f"{tested.name}: status of the node", node.end(), 0)
    first = recorded(points, until_lost(whole_lines(file)))
    for name, values in states.items():
        checks.equal(f"{tested.name}: {name} was recorded: {values}: {first[name]}", has_all(first[name], values), True)

    for speed in SPEEDS:
        again = folder / f"{tested.name}_{speed}.jsonl"
        with Node(bin_ / "coupler-node", "--replay", file, "--speed", speed) as node, \
                Recorder(bin_ / "coupler", path, node.port, again) as recorder:
            checks.equal(f"{tested.name}: status of the node that plays", node.wait(peer.PATIENCE / speed), 0)
            recorder.end()
        second = recorded(points, until_lost(whole_lines(again)))
        for point in points:
            name = point["name"]
            if point["table"] == "coils" and len(second[name]) > len(first[name]):  # the node has ended, and is safe
                second[name].pop()
        if second == first:
            break
    for name, values in first.items():
        checks.equal(f"{tested.name}: {name} was played", second[name], values)


def main():
    bin_, maps, count = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), int(sys.argv[3])
    checks = peer.Checks()
    with tempfile.TemporaryDirectory() as name, concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
        parts = [pool.submit(check, bin_, maps / f"random_{i}.yaml", pathlib.Path(name), checks) for i in range(count)]
        for part in parts:
            part.result()
    checks.done(f"{count} random maps, recorded, played, and recorded again")


main()
