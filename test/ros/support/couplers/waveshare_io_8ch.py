# SPDX-License-Identifier: Apache-2.0
"""A Waveshare Modbus RTU IO 8CH as its page describes it (the sources: config/presets/waveshare_io_8ch.yaml): outputs that
are written, or switched by the input of the same number. What its page does not have it does not answer here."""
import threading

from pymodbus.exceptions import NoSuchSlaveException
from pymodbus.interfaces import IModbusSlaveContext

UNIT = 1
CHANNELS = range(8)
ALL = 0x00FF  # a coil: all outputs
MODES = range(0x1000, 0x1008)
COMMANDED, FOLLOWS, TOGGLES, CHANGES = range(4)  # an output: by writes; as its input; at each pulse of it; at each change
COILS, INPUTS, REGISTERS = (1, 5, 15), (2,), (3, 6, 16)


class WaveshareIo8ch(IModbusSlaveContext):
    """For an RtuServer."""

    def __init__(self):
        self.outputs, self.inputs, self.modes = ([0] * len(CHANNELS) for _ in range(3))
        self._lock = threading.Lock()

    def set_input(self, channel, on):
        with self._lock:
            before, self.inputs[channel] = self.inputs[channel], int(on)
            mode = self.modes[channel]
            if mode == FOLLOWS:
                self.outputs[channel] = int(on)
            elif mode == CHANGES and on != before or mode == TOGGLES and on and not before:
                self.outputs[channel] ^= 1

    def validate(self, fx, address, count=1):
        places = CHANNELS if fx in COILS + INPUTS else MODES if fx in REGISTERS else ()
        is_all = fx == 5 and address == ALL
        if not is_all and (address not in places or address + count - 1 not in places):
            raise NoSuchSlaveException("no answer")
        return True

    def getValues(self, fx, address, count=1):
        with self._lock:
            if address == ALL:
                return self.outputs[:1]
            table = self.outputs if fx in COILS else self.inputs if fx in INPUTS else self.modes
            first = address - MODES.start if fx in REGISTERS else address
            return table[first:first + count]

    def setValues(self, fx, address, values):
        with self._lock:
            if address == ALL:
                self.outputs = [int(values[0])] * len(CHANNELS)
            elif fx in COILS:
                self.outputs[address:address + len(values)] = map(int, values)
            else:
                first = address - MODES.start
                self.modes[first:first + len(values)] = values
