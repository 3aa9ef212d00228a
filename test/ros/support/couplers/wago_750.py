# SPDX-License-Identifier: Apache-2.0
"""A WAGO 750 as its manual describes it (the sources: config/presets/wago_750.yaml): limits of a request, coils below 512
that read the inputs, and the watchdog in its standard mode."""
from support.couplers.coupler import Coupler, is_register, is_write
from support.device import FAILURE, ILLEGAL_VALUE, Refuse

TIME, MASK, TRIGGER, STATUS, RESTART, STOP = 0x1000, 0x1001, 0x1003, 0x1006, 0x1007, 0x1008
READ_BACK = 512
LIMITS = {1: 2000, 2: 2000, 3: 125, 4: 125, 15: 800, 16: 100}


class Wago750(Coupler):
    outputs = range(READ_BACK, 2 * READ_BACK)

    def respond(self, request):
        if self.expired and not (is_write(request) and request.address in (RESTART, STOP)):
            raise Refuse(FAILURE)
        if request.count > LIMITS.get(request.function, 1):
            raise Refuse(ILLEGAL_VALUE)
        if self.fed_at is not None and self.register(MASK) >> request.function - 1 & 1:
            self.feed()
        if is_register(request) and is_write(request) and TIME <= request.address <= STOP:
            self.watchdog(request.address, int.from_bytes(request.data[3:5], "big"))
        elif is_write(request) and request.address < READ_BACK:
            return self.drive(request)
        return self.serve(request)

    def drive(self, request):
        """Outputs are written at 0 or at 512 and kept at 512; at 0 a read gives the inputs."""
        reply = request.data[1:5]
        request.address += READ_BACK
        self.serve(request)
        request.address -= READ_BACK
        return reply

    def watchdog(self, address, value):
        runs = self.fed_at is not None
        if address in (TIME, MASK):
            if runs:
                raise Refuse(ILLEGAL_VALUE)  # not while it runs
            if address == TIME:
                self.timeout = value / 10
        elif address == TRIGGER and value != self.register(TRIGGER) and self.timeout and (runs or value):
            self.feed()
        elif address == RESTART and value == 1 and self.expired:
            self.expired = False
            self.feed()
        elif address == STOP and value in (0xAA55, 0x55AA):
            self.expired, self.fed_at = False, None
