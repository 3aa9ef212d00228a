# SPDX-License-Identifier: Apache-2.0
"""A Beckhoff BK9000 as its manual describes it (the sources: config/presets/beckhoff_bk9000.yaml): a watchdog that is on
from the factory and armed by the first write, three connections, of which the first may write."""
import threading

from support.couplers.coupler import Coupler, is_register, is_write
from support.device import BUSY, FAILURE, ILLEGAL_VALUE, Refuse

LEFT, TIME, RESET, TYPE = 0x1020, 0x1120, 0x1121, 0x1122
WRITES_FEED, ANYTHING_FEEDS = 0, 1


class BeckhoffBk9000(Coupler):
    def __init__(self):
        super().__init__(connections=3)
        self.timeout = 1.0
        self.tables["holding_registers"][TIME] = 1000
        self.tables["holding_registers"][TYPE] = WRITES_FEED
        self.codes = []
        self._own = threading.local()  # each connection has a thread

    def _exchange(self, connection, stream):
        self._own.connection = connection
        return super()._exchange(connection, stream)

    def respond(self, request):
        if is_write(request) and self._own.connection is not self._connections[0]:
            raise Refuse(BUSY)
        special = is_register(request) and request.address >= 0x1000
        if self.expired and not special:
            raise Refuse(FAILURE)
        if special and is_write(request):
            self.watchdog(request.address, int.from_bytes(request.data[3:5], "big"))
        if not self.expired and self.timeout:
            runs = self.fed_at is not None
            if is_write(request) or runs and self.register(TYPE) == ANYTHING_FEEDS:
                self.feed()
        return self.serve(request)

    def watchdog(self, address, value):
        if address == TIME:
            if self.fed_at is not None:
                raise Refuse(ILLEGAL_VALUE)  # only while it is not active
            self.timeout = value / 1000
        elif address == RESET:
            self.codes = (self.codes + [value])[-2:]
            if self.codes == [0xBECF, 0xAFFE]:
                self.expired, self.fed_at = False, None
