# SPDX-License-Identifier: Apache-2.0
"""A Moxa ioLogik E1200 as its manual describes it (the sources: config/presets/moxa_e1200.yaml): a watchdog that its web page
switches on and any request feeds, an alarm flag in a coil, "clear" coils that read 0, wide values high word first."""
from support.couplers.coupler import Coupler, is_write
from support.device import ILLEGAL_VALUE, Refuse

ALARM = 4144
CLEAR_COUNT = range(272, 288)  # "1: clear, 0: illegal data value"
COUNTER = 16                   # input registers, two a channel


class MoxaE1200(Coupler):
    def __init__(self, timeout):
        super().__init__()
        self.timeout = timeout  # as set in the web page
        self.count = 0

    def respond(self, request):
        if not self.expired:
            self.feed()
        if request.function == 5 and request.address in CLEAR_COUNT:
            if not request.data[3]:
                raise Refuse(ILLEGAL_VALUE)
            self.count = 0
            return request.data[1:5]
        if request.function == 5 and request.address == ALARM:
            if request.data[3]:
                self.expired = False
                self.tables["coils"][ALARM] = 0
                self.feed()
            return request.data[1:5]
        if self.expired and is_write(request):
            return request.data[1:5]  # acknowledged, and outputs stay safe
        self.tables["input_registers"][COUNTER:COUNTER + 2] = [self.count >> 16, self.count & 0xFFFF]
        return self.serve(request)

    def expire(self):
        super().expire()
        self.tables["coils"][ALARM] = 1
