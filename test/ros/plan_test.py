# SPDX-License-Identifier: Apache-2.0
"""The driver asks a foreign device for exactly what `coupler plan` shows."""
import json
import subprocess
import time

from support import process, testing
from support.patience import NO_TIMEOUT, PATIENCE
from support.peer import READ, Peer
from support.topics import wait_until

MAP = """
name: {name}
address: localhost
rate: 20
timeout: {timeout}s
discrete_read_continuous: true
registers_read_continuous: true
limits: {read_registers: 20}
mapping:
  coils: {lamp: 3, horn: 60, far: 500}
  discrete_inputs: {door: 0, light: 1}
  input_registers:
    flow: {address: 10, type: LREAL}
    level: {address: 20, type: REAL}
  holding_registers:
    speed: {address: 0, type: INT}
    text: {address: 5, type: STRING, length: 30}
    limit: {address: 20, type: INT}
    far_away: {address: 65535, type: UINT}
"""
RATES = """
name: {name}
address: localhost
rate: 10
timeout: {timeout}s
registers_read_continuous: true
unreadable: [{table: holding_registers, from: 24, to: 27}]
mapping:
  coils: {lamp: {address: 3, read_address: 515}, horn: 514}
  holding_registers:
    speed: {address: 0, type: REAL, rate: 100}
    setpoint: {address: 2, type: REAL}
    position: {address: 4, type: DINT, rate: 100}
    profile: {address: 8, type: REAL, count: 6, rate: 2}
    before: {address: 22, type: UINT}
    behind: {address: 29, type: UINT}
    command: {address: 30, type: UINT, access: write}
    last: {address: 31, type: UINT}
"""
IDENTITY = ("input_registers", 0xFF00, 0xFF0C)
TABLES = {number: table for table, number in READ.items()}


def plan_of(path):
    """(table, first, last) of each request of a cycle, the fastest rate first."""
    done = subprocess.run([str(process.BUILD / "bin" / "coupler"), "plan", path, "--json"], capture_output=True,
                          text=True, timeout=PATIENCE, check=True)
    return [[(span["table"], span["from"], span["to"]) for span in group["spans"]]
            for group in json.loads(done.stdout)["groups"]]


class Asked:
    """What a peer is asked for; addresses in `missing` it does not have."""

    def __init__(self, peer, missing=()):
        self.requests = []
        self.times = []
        self._missing = set(missing)
        self._validate = peer.store.validate
        peer.store.validate = self._note

    def _note(self, function, address, count=1):
        table = TABLES[function]
        self.times.append(time.monotonic())
        self.requests.append((table, address, address + count - 1))
        if self._missing.intersection((table, number) for number in range(address, address + count)):
            return False
        return self._validate(function, address, count)

    def cycles(self, size, count):
        """The first `count` cycles of `size` requests each, after the identity."""
        wait_until(lambda: len(self.requests) > size * count, f"{count} cycles")
        identity, *reads = self.requests
        assert identity == IDENTITY, identity
        return [reads[i * size:(i + 1) * size] for i in range(count)]


class Plan(testing.RosTest):
    at_once = True

    def start(self, text, missing=()):
        path = process.write_map(text.replace("{timeout}", str(NO_TIMEOUT)).replace("{name}", self.name))
        peer = Peer()
        asked = Asked(peer, missing)
        peer.start()
        self.addCleanup(peer.stop)
        return plan_of(path), asked, self.driver(f"_map:={path}", f"_port:={peer.port}")

    def test_every_cycle_is_what_the_plan_says(self):
        (plan,), asked, _ = self.start(MAP)
        self.assertEqual(len(plan), 7)
        self.assertEqual(asked.cycles(len(plan), 3), [plan] * 3)

    def test_each_rate_has_requests_and_deadlines_of_its_own(self):
        plan, asked, _ = self.start(RATES)
        fast, middle, slow = plan
        self.assertEqual((len(fast), len(middle), len(slow)), (1, 5, 1))
        self.assertIn(("coils", 514, 515), middle, "where the lamp reads back")
        wait_until(lambda: asked.requests.count(slow[0]) >= 5, "two seconds of the slowest rate")
        fifth = [i for i, request in enumerate(list(asked.requests)) if request == slow[0]][4]
        reads = asked.requests[1:fifth + 1]
        seconds = asked.times[fifth] - asked.times[1]
        self.assertEqual(set(reads), {request for group in plan for request in group})
        for request, rate in ((middle[0], 10), (fast[0], 100)):
            self.assertLessEqual(reads.count(request), seconds * rate + 3, "what was left out is not made up for")
        # On a machine that does other things, too, cycles are left out; the faster rate still comes first.
        self.assertGreater(reads.count(fast[0]), 4 * reads.count(middle[0]))
        self.assertGreater(sum(request in middle for request in reads), reads.count(slow[0]))
        for request in middle:
            self.assertAlmostEqual(reads.count(request), reads.count(middle[0]), delta=1)

    def test_a_refused_hole_is_found_told_and_left_out(self):
        _, asked, driver = self.start(MAP, missing=[("holding_registers", 2), ("coils", 499)])
        driver.wait_for("unreadable: [{table: holding_registers, from: 1, to: 4}]")
        self.assertNotIn("unreadable: [{table: coils", driver.output, "nothing asks for coil 499")
        start = len(asked.requests)
        wait_until(lambda: len(asked.requests) > start + 40, "several cycles more")
        later = {request[1:] for request in asked.requests[start + 20:] if request[0] == "holding_registers"}
        self.assertEqual(later, {(0, 0), (5, 20), (65535, 65535)}, "what is not refused is one request again")
        self.assertEqual(driver.output.count("unreadable: [{"), 1)


if __name__ == "__main__":
    testing.main()
