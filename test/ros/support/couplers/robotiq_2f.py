# SPDX-License-Identifier: Apache-2.0
"""A Robotiq 2F-85 as its manual describes it (the sources: config/presets/robotiq_2f.yaml): it is activated, moves, and stops
at what it grips. It has no exceptions: what it does not know it does not answer."""
import threading

from pymodbus.exceptions import NoSuchSlaveException
from pymodbus.interfaces import IModbusSlaveContext

UNIT = 9
COMMAND = range(0x03E8, 0x03EB)
STATUS = range(0x07D0, 0x07D3)
KNOWN = {4: STATUS, 16: COMMAND}  # FC 23 is left out: the driver has none
ACTIVATE, MOVE = 0x01, 0x08  # of the action request
CLOSING, ARRIVED = 2, 3  # stopped by something while closing, or at the target
NOT_YET_ACTIVATED, TO_BE_ACTIVATED = 5, 7  # faults


class Robotiq2f(IModbusSlaveContext):
    """For an RtuServer. `part`: the position in which closing fingers meet something. It activates and moves until the
    test lets it finish(). `functions` are the function codes that it was sent."""

    def __init__(self, part=None):
        self.part = part
        self.functions = set()
        self.position = 0
        self._command = [0] * len(COMMAND)
        self._activated = self._arrived = False
        self._object = ARRIVED
        self._lock = threading.Lock()

    @property
    def action(self):
        return self._command[0] >> 8

    @property
    def target(self):
        return self._command[1] & 0xFF

    def finish(self):
        with self._lock:
            if not self.action & ACTIVATE:
                return
            if not self._activated:
                self._activated, self.position = True, 0
            elif self.action & MOVE:
                stopped = self.part is not None and self.position < self.part < self.target
                self.position = self.part if stopped else self.target
                self._arrived, self._object = True, CLOSING if stopped else ARRIVED

    def validate(self, fx, address, count=1):
        self.functions.add(fx)
        known = KNOWN.get(fx, ())
        if address not in known or address + count - 1 not in known:
            raise NoSuchSlaveException("no answer")
        return True

    def getValues(self, fx, address, count=1):
        with self._lock:
            status = [self._status() << 8, self._fault() << 8 | self.target, self.position << 8]
        return status[address - STATUS.start:][:count]

    def setValues(self, fx, address, values):
        with self._lock:
            before = self.action, self.target
            for at, value in enumerate(values, address - COMMAND.start):
                self._command[at] = value
            self._activated = self._activated and bool(self.action & ACTIVATE)
            self._arrived = self._arrived and (self.action, self.target) == before

    def _status(self):
        if not self.action & ACTIVATE:
            return 0
        if not self._activated:
            return ACTIVATE | 1 << 4
        moves = self.action & MOVE
        return ACTIVATE | moves | 3 << 4 | (self._object << 6 if moves and self._arrived else 0)

    def _fault(self):
        if not self.action & MOVE or self._activated:
            return 0
        return NOT_YET_ACTIVATED if self.action & ACTIVATE else TO_BE_ACTIVATED
