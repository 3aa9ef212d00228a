# SPDX-License-Identifier: Apache-2.0
"""A well-behaved client that reads and writes without a break, checks every answer and takes its time."""
import dataclasses
import gc
import itertools
import multiprocessing
import time

import adu as modbus
from client import Client
from real_time import ask_for_real_time

# Seconds between an answer and the next request: where answers are timed, and where everybody shares a processor.
PAUSE, LONG_PAUSE = 0.0002, 0.01
SLOW = 0.005  # seconds
OUTPUTS, SCRATCH = 0, 0  # map.yaml: 8 coils wired to 8 inputs, 123 registers of memory
READ_INPUTS = 2  # which show the outputs where they are wired to them
SERIAL = (20210907).to_bytes(4, "big")


@dataclasses.dataclass
class Report:
    """What happened since the last report."""
    requests: int = 0
    worst: float = 0.0  # seconds, of those that are not slow
    slow: list = dataclasses.field(default_factory=list)  # when those that took longer than SLOW began and ended
    silence: float = 0.0  # seconds from before a request was sent until the next one was answered: the longest
    faults: list = dataclasses.field(default_factory=list)


class Bystander:
    """Works in a process of its own, so that its latency is the node's and not an attacker's."""

    def __init__(self, port, map_text, wired, pause):
        context = multiprocessing.get_context("fork")
        self._pipe, other = context.Pipe()
        self._process = context.Process(target=_work, args=(port, map_text, wired, pause, other), daemon=True)
        self._process.start()
        other.close()
        self.report()

    def report(self):
        try:
            self._pipe.send("report")
            return self._pipe.recv()
        except (OSError, EOFError):
            return Report(faults=["it could not connect again"])

    def stop(self):
        self._process.terminate()
        self._process.join()


def _work(port, map_text, wired, pause, pipe):
    ask_for_real_time()
    gc.disable()
    client = Client(port)
    report = Report()
    started = time.perf_counter()
    for number in itertools.count():
        for request, expected in _round(number, map_text):
            if not wired and request[0] == READ_INPUTS:
                continue
            before, started = started, time.perf_counter()
            try:
                client.expect_answer(expected, request, transaction=number % 0x10000)
            except (AssertionError, OSError) as error:
                report.faults.append(str(error))
                try:
                    client = Client(port)
                except (AssertionError, OSError):
                    return
            ended = time.perf_counter()
            report.silence = max(report.silence, ended - before)
            if ended - started > SLOW:
                report.slow.append((started, ended))
            else:
                report.worst = max(report.worst, ended - started)
            report.requests += 1
            if pipe.poll():
                pipe.recv()
                pipe.send(report)
                report = Report()
            time.sleep(pause)


def _round(number, map_text):
    """Requests and the only right answers to them; each round has values of its own."""
    bits = bytes([number % 256])
    registers = bytes((number + i) % 256 for i in range(246))
    one = registers[10:12]
    piece = number % (len(map_text) // 2 - 100)
    return [
        (modbus.write_registers(SCRATCH, 123, registers), modbus.pdu(16, SCRATCH, 123)),
        (modbus.read(3, SCRATCH, 123), modbus.values(3, registers)),
        (modbus.write_coils(OUTPUTS, 8, bits), modbus.pdu(15, OUTPUTS, 8)),
        (modbus.read(2, OUTPUTS, 8), modbus.values(2, bits)),
        (modbus.read(1, OUTPUTS, 8), modbus.values(1, bits)),
        (modbus.pdu(5, OUTPUTS, 0xFF00), modbus.pdu(5, OUTPUTS, 0xFF00)),
        (modbus.read(2, OUTPUTS, 8), modbus.values(2, bytes([bits[0] | 1]))),
        (modbus.pdu(6, SCRATCH, number % 0x10000), modbus.pdu(6, SCRATCH, number % 0x10000)),
        (modbus.read(3, SCRATCH, 2), modbus.values(3, (number % 0x10000).to_bytes(2, "big") + registers[2:4])),
        (modbus.read_write(SCRATCH, 1, SCRATCH, 1, one), modbus.values(23, one)),
        (modbus.read(4, 0, 2), modbus.values(4, SERIAL)),
        (modbus.read_file(piece, 100), bytes([20, 202, 201, 6]) + map_text[2 * piece:2 * piece + 200]),
    ]
