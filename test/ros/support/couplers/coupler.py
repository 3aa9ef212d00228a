# SPDX-License-Identifier: Apache-2.0
"""What the simulated couplers have in common: a device whose outputs go off when its watchdog has expired."""
import threading
import time

from support.device import READS, WRITES, Device


class Coupler(Device):
    """A thread looks after the watchdog, as the real one does without being asked. `outputs` are the coils that it
    switches off."""

    outputs = range(0, 8)

    def __init__(self, connections=None):
        super().__init__(connections=connections)
        self.answer = self._locked
        self.timeout = 0     # seconds; 0: off
        self.fed_at = None   # by the clock of its own; None: it does not run
        self.driver = None   # a process: how long it waits for a processor is no fault of its
        self.expired = False
        self.expiries = 0
        self._state = threading.RLock()
        self._ended = threading.Event()
        self._clock = 0
        self._waits = {}

    def start(self):
        super().start()
        threading.Thread(target=self._watch, daemon=True).start()
        return self

    def stop(self):
        self._ended.set()
        super().stop()

    def feed(self):
        self.fed_at, self._waits = self._clock, self._driver_waits()

    def _driver_waits(self):
        return self.driver.waits() if self.driver and self.driver.running else {}

    def _is_late(self):
        if self.fed_at is None or not self.timeout or self._clock - self.fed_at <= self.timeout:
            return False
        waits = self._driver_waits()
        if any(wants_one for _, wants_one in waits.values()):
            return False  # it is told when the driver sleeps
        waited = max((now - self._waits.get(thread, (0, False))[0] for thread, (now, _) in waits.items()), default=0)
        return self._clock - self.fed_at - waited > self.timeout

    def coil(self, address):
        return self.tables["coils"][address]

    def register(self, address):
        return self.tables["holding_registers"][address]

    def written(self, address, function=6):
        """The values written to a register (or, FC 5, a coil), in order."""
        return [int.from_bytes(request.data[3:5], "big") for request in self.seen(function)
                if request.address == address]

    def _watch(self):
        ticked = time.monotonic()
        while not self._ended.wait(0.01):
            with self._state:
                # Where this process had no time, the request that feeds may wait unread: that is not the driver's fault.
                now = time.monotonic()
                self._clock += min(now - ticked, 0.05)
                ticked = now
                if not self.expired and self._is_late():
                    self.fed_at = None
                    self.expiries += 1
                    self.expire()
                    self.expired = True  # what a test waits for

    def expire(self):
        for address in self.outputs:
            self.tables["coils"][address] = 0

    def _locked(self, request):
        with self._state:
            return self.respond(request)

    def respond(self, request):
        return self.serve(request)


def is_write(request):
    return request.function in WRITES


def is_register(request):
    return (READS.get(request.function) or WRITES.get(request.function)) == "holding_registers"
