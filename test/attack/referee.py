# SPDX-License-Identifier: Apache-2.0
"""Judges attacks by their effect on the bystander and on the node."""
import contextlib
import sys
import time

import adu as modbus
from attacks import TARGET, TARGET_REGISTERS
from bystander import Bystander
from node import CONNECTIONS

UNDISTURBED = 2.0  # seconds
SHORTEST = 0.2  # seconds: a shorter attack is repeated, so that the bystander has seen enough of it
SLOW = 0.020
GROWTH = 128  # KiB
LARGEST = 6 * 1024  # KiB of a process, resident


class Referee:
    def __init__(self, node, subject, timed, measured):
        """`timed`: slow answers count; `measured`: memory does."""
        self._node = node
        self._subject = subject
        self._timed, self._measured = timed, measured
        self._attacks = self._failures = self._requests = 0
        self._worst = 0.0
        self._warm_up()
        self._allocated = sum(node.allocated())
        resident = node.resident()
        self._bystander = self._start_bystander()
        time.sleep(UNDISTURBED)
        undisturbed = self._bystander.report()
        if undisturbed.faults:
            raise SystemExit("without any attack: " + "; ".join(undisturbed.faults))
        self._limit = max(SLOW, 3 * undisturbed.worst)
        self._descriptors = node.descriptors()
        self._target = self._read_target()
        print(f"undisturbed: {undisturbed.requests} requests, worst {undisturbed.worst * 1e3:.1f} ms, "
              f"limit {f'{self._limit * 1e3:.0f} ms' if timed else 'none'}; "
              f"{' + '.join(map(str, resident))} KiB resident, {self._descriptors} descriptors", flush=True)
        if measured and max(resident) > LARGEST:
            self.note_failure(f"a process has more than {LARGEST} KiB resident")

    def note_failure(self, text):
        self._failures += 1
        print(f"not ok - {text}", flush=True)

    def judge(self, attack):
        if attack.alone:
            self._bystander.stop()
        else:
            self._bystander.report()
        problems = []
        trips = self._node.watchdog_trips()
        started = time.monotonic()
        for check in (lasting(attack.run), self._check_node):
            try:
                check(self._node)
            except (AssertionError, OSError) as error:
                problems.append(f"{error or repr(error)}")
        seconds = time.monotonic() - started
        if attack.alone:
            self._bystander = self._start_bystander()
        elif not problems and self._node.watchdog_trips() != trips:
            problems.append("the watchdog expired, although the bystander wrote all the time")
        report = self._bystander.report()
        problems += [f"bystander: {fault}" for fault in report.faults]
        if self._timed and report.worst > self._limit:
            problems.append(f"bystander: a request took {report.worst * 1e3:.1f} ms, more than {self._limit * 1e3:.0f}")
        self._attacks += 1
        self._failures += bool(problems)
        self._requests += report.requests
        self._worst = max(self._worst, report.worst)
        seen = "nobody else there" if attack.alone else f"worst {report.worst * 1e3:.1f} ms of {report.requests} requests"
        print(f"{'not ok' if problems else 'ok'} - {attack.name} ({seen}, {seconds:.1f} s)")
        for problem in problems:
            print(f"    {problem}")
        sys.stdout.flush()

    def summary(self):
        """Tells what was seen; the number of failures."""
        print(f"{self._attacks} attacks, {self._failures} failures; the bystander made {self._requests} requests, "
              f"the slowest took {self._worst * 1e3:.1f} ms", flush=True)
        return self._failures

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._bystander.stop()

    def _start_bystander(self):
        return Bystander(self._node.port, self._subject.map_text, self._subject.wired)

    def _check_node(self, node):
        node.check_alive()
        node.expect_descriptors(self._descriptors)
        assert self._read_target() == self._target, "a request that was refused has changed the target"
        growth = sum(node.allocated()) - self._allocated
        assert not self._measured or growth <= GROWTH, f"the node has grown by {growth} KiB"

    def _read_target(self):
        with self._node.connect() as client:
            return client.ask(modbus.read(3, TARGET, TARGET_REGISTERS - 1))

    def _warm_up(self):
        """Every connection is used once: its memory counts as the node's from now on."""
        with contextlib.ExitStack() as stack:
            for client in [stack.enter_context(self._node.connect()) for _ in range(CONNECTIONS)]:
                client.send(modbus.adu(modbus.read(3, TARGET, TARGET_REGISTERS)) * 20)
                for _ in range(20):
                    client.receive_adu()


def lasting(attack):
    def repeated(node):
        end = time.monotonic() + SHORTEST
        attack(node)
        while time.monotonic() < end:
            attack(node)
    return repeated
