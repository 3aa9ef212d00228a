# SPDX-License-Identifier: Apache-2.0
"""Judges attacks by their effect on the bystander and on the node."""
import contextlib
import os
import platform
import signal
import sys
import time

import adu as modbus
from attacks import TARGET, TARGET_REGISTERS, tls
from bystander import LONG_PAUSE, PAUSE, Bystander
from machine import Machine, without
from node import CONNECTIONS
from subjects import TIMEOUT

UNDISTURBED = 1.0  # seconds
SHORTEST = 0.2  # seconds: a shorter attack is repeated, so that the bystander has seen enough of it
TURN = 0.3  # seconds between two turns of attacks that wait
SLOW = 0.020
GROWTH = 128  # KiB
# KiB of a process, resident. Nine tenths of it are pages of files; Debian 13's libraries have 0.4 MiB more than Debian 12's.
LARGEST = 6 * 1024 if platform.freedesktop_os_release().get("VERSION_ID") == "12" else 6 * 1024 + 512
LARGEST_WITH_TLS = 20 * 1024  # of the one that has OpenSSL, after CONNECTIONS sessions


class Referee:
    def __init__(self, node, subject, timed, measured):
        """`timed`: slow answers count; `measured`: memory does."""
        self._node = node
        self._subject = subject
        self._timed, self._measured = timed, measured
        self._attacks = self._failures = self._requests = 0
        self._worst = self._stalled = 0.0
        self._warm_up()
        self._allocated = sum(node.allocated())
        resident = node.resident()
        self._machine = Machine() if timed else None
        self._bystander = self._start_bystander()
        time.sleep(UNDISTURBED)
        undisturbed, worst = self._ask_bystander()
        if undisturbed.faults:
            raise SystemExit("without any attack: " + "; ".join(undisturbed.faults))
        self._limit = max(SLOW, 3 * worst)
        node.expect_clients(1)
        self._target = self._read_target()
        print(f"undisturbed: {undisturbed.requests} requests, worst {worst * 1e3:.1f} ms, "
              f"limit {f'{self._limit * 1e3:.0f} ms' if timed else 'none'}; "
              f"{' + '.join(map(str, resident))} KiB resident, {node.descriptors()} descriptors", flush=True)
        for size, largest in zip(sorted(resident, reverse=True), [LARGEST_WITH_TLS] * bool(node.tls_port) + [LARGEST]):
            if measured and size > largest:
                self.note_failure(f"a process has more than {largest} KiB resident")
        if timed and not self._notices_a_pause():
            self.note_failure("a node that pauses for twice the limit is not noticed")

    def note_failure(self, text):
        self._failures += 1
        print(f"not ok - {text}", flush=True)

    def judge(self, attacks):
        """One attack, or several that wait at the same time."""
        alone = attacks[0].alone
        if alone:
            self._bystander.stop()
        else:
            self._bystander.report()
        trips = self._node.watchdog_trips()
        started = time.monotonic()
        problems = take_turns(attacks, self._node) if attacks[0].waits else [complaint(lasting(attacks[0].run), self._node)]
        of_all = [complaint(lambda node: self._check_node(node, clients=0 if alone else 1), self._node)]
        seconds = time.monotonic() - started
        expired = self._node.watchdog_trips() != trips
        if alone:
            self._bystander = self._start_bystander()
        report, worst = self._ask_bystander()
        # It speaks all the time, unless the machine keeps it from that: then the watchdog is right.
        if not alone and expired and report.silence < TIMEOUT:
            of_all.append(f"the watchdog expired, although the bystander was silent for {report.silence:.1f} s at most")
        of_all += [f"bystander: {fault}" for fault in report.faults]
        if self._timed and worst > self._limit:
            of_all.append(f"bystander: a request took {worst * 1e3:.1f} ms, more than {self._limit * 1e3:.0f}")
        self._requests += report.requests
        self._worst = max(self._worst, worst)
        seen = "nobody else there" if alone else f"worst {worst * 1e3:.1f} ms of {report.requests} requests"
        for attack, problem in zip(attacks, problems):
            self._tell(attack, [text for text in [problem, *of_all] if text], f"{seen}, {seconds:.1f} s")

    def summary(self):
        """Tells what was seen; the number of failures."""
        print(f"{self._attacks} attacks, {self._failures} failures; the bystander made {self._requests} requests, "
              f"the slowest took {self._worst * 1e3:.1f} ms"
              + (f"; the machine stalled for {self._stalled * 1e3:.0f} ms" if self._timed else ""), flush=True)
        return self._failures

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._bystander.stop()
        if self._machine is not None:
            self._machine.stop()

    def _start_bystander(self):
        return Bystander(self._node.port, self._subject.map_text, self._subject.wired, PAUSE if self._timed else LONG_PAUSE)

    def _tell(self, attack, problems, seen):
        self._attacks += 1
        self._failures += bool(problems)
        print(f"{'not ok' if problems else 'ok'} - {attack.name} ({seen})")
        for problem in problems:
            print(f"    {problem}")
        sys.stdout.flush()

    def _ask_bystander(self):
        """Its report, and its longest request without the time for which the machine stalled."""
        report = self._bystander.report()
        stalls = [] if self._machine is None else self._machine.stalls()
        self._stalled += sum(end - began for began, end in stalls)
        return report, max([report.worst, *(without(stalls, began, ended) for began, ended in report.slow)])

    def _notices_a_pause(self):
        """A pause that only the node makes counts. Now and then one of the machine may hide it."""
        for _ in range(10):
            for pid in self._node.processes():
                os.kill(pid, signal.SIGSTOP)
            time.sleep(2 * self._limit)
            for pid in self._node.processes():
                os.kill(pid, signal.SIGCONT)
            if self._ask_bystander()[1] > self._limit:
                return True
        return False

    def _check_node(self, node, clients):
        node.check_alive()
        node.expect_clients(clients)
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
        if self._node.tls_port:
            with contextlib.ExitStack() as stack:
                sessions = [stack.enter_context(tls.connect(self._node)) for _ in range(CONNECTIONS)]
                for session in sessions:
                    tls.ask(session, modbus.read(3, TARGET, TARGET_REGISTERS))


def complaint(check, *arguments):
    """What is wrong, or nothing."""
    try:
        check(*arguments)
    except (AssertionError, OSError) as error:
        return f"{error or repr(error)}"
    return ""


def take_turns(attacks, node):
    """The complaint of each."""
    complaints = [""] * len(attacks)
    running = {number: attack.run(node) for number, attack in enumerate(attacks)}
    while running:
        for number, turns in list(running.items()):
            try:
                next(turns)
                continue
            except StopIteration:
                pass
            except (AssertionError, OSError) as error:
                complaints[number] = f"{error or repr(error)}"
            del running[number]
        time.sleep(TURN)
    return complaints


def lasting(attack):
    def repeated(node):
        end = time.monotonic() + SHORTEST
        attack(node)
        while time.monotonic() < end:
            attack(node)
    return repeated
