# SPDX-License-Identifier: Apache-2.0
"""A PLC whose program watches a register: when it does not change for so long, outputs go off until it does."""
from support.couplers.coupler import Coupler, is_register, is_write


class Plc(Coupler):
    def __init__(self, heartbeat, timeout):
        super().__init__()
        self.heartbeat = heartbeat
        self.timeout = timeout

    def respond(self, request):
        before = self.register(self.heartbeat)
        reply = self.serve(request)
        if is_register(request) and is_write(request) and self.register(self.heartbeat) != before:
            self.expired = False
            self.feed()
        return reply
