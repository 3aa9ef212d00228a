# SPDX-License-Identifier: Apache-2.0
"""What the machine adds to the node's delays: a hypervisor that takes a processor away, a program with a higher priority.

On each processor somebody who has nothing to do with the node sleeps for a millisecond, again and again, and goes before
node and bystander. Where he wakes up late nobody could have run, so that time is not the node's. A node that computes,
sleeps or waits for the wrong client holds nobody else up, and is not excused by it."""
import gc
import multiprocessing
import os
import time

from real_time import ask_for_real_time

NAP = 0.001  # seconds
# Seconds: who is less late was not held up. Without the right to go before the others he may have waited for his turn.
STALL, STALL_AMONG_OTHERS = 0.001, 0.005


def stay_on_two_processors():
    """This process and its children: few sleepers see all of it, and large machines are like small ones."""
    processors = sorted(os.sched_getaffinity(0))
    os.sched_setaffinity(0, {processors[0], processors[-1]})


class Machine:
    def __init__(self):
        context = multiprocessing.get_context("fork")
        self._sleepers = []
        for processor in os.sched_getaffinity(0):
            pipe, other = context.Pipe()
            process = context.Process(target=_sleep, args=(processor, other), daemon=True)
            process.start()
            other.close()
            self._sleepers.append((process, pipe))

    def stalls(self):
        """When they began and ended, since the last call."""
        for _, pipe in self._sleepers:
            pipe.send("report")
        return sorted(stall for _, pipe in self._sleepers for stall in pipe.recv())

    def stop(self):
        for process, _ in self._sleepers:
            process.terminate()
            process.join()


def without(stalls, began, ended):
    """Seconds from `began` to `ended` in which no processor stalled."""
    left, seen = ended - began, began
    for start, end in stalls:
        start, end = max(start, seen), min(end, ended)
        if end > start:
            left -= end - start
            seen = end
    return left


def _sleep(processor, pipe):
    os.sched_setaffinity(0, {processor})
    stall = STALL if ask_for_real_time(ahead=1) else STALL_AMONG_OTHERS
    gc.disable()
    stalls, now = [], time.perf_counter()
    while True:
        due = now + NAP  # from the last look on: he may also be kept from running while he is awake
        time.sleep(NAP)
        now = time.perf_counter()
        if now - due > stall:
            stalls.append((due, now))
        if pipe.poll():
            pipe.recv()
            pipe.send(stalls)
            stalls = []
