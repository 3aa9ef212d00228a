# SPDX-License-Identifier: Apache-2.0
"""The server goes, freezes, is slow, or has no connection to spare."""
import select
import time

from support import testing
from support.device import Device
from support.patience import PATIENCE
from support.ports import free_port
from support.pymodbus_server import LEVEL, Server
from support.truth import OK, TIMEOUT, WARN, nothing_is_published, start


def is_offline(truth):
    truth.is_offline()
    nothing_is_published([truth])


class FaultProcess(testing.RosTest):
    at_once = True

    def setUp(self):
        self.server = Server(free_port()).start()
        self.addCleanup(self.server.kill)
        self.truth = start(self, self.server.port)
        self.truth.is_good(LEVEL)

    def test_a_killed_server_is_told_and_found_again(self):
        self.server.kill()
        is_offline(self.truth)
        self.server.start()
        self.truth.is_good(LEVEL)

    def test_a_frozen_server_is_told_and_found_again(self):
        self.server.freeze()
        is_offline(self.truth)
        self.server.thaw()
        self.truth.is_good(LEVEL)


class FaultConnection(testing.RosTest):
    at_once = True

    def setUp(self):
        self.device = Device()
        self.device.tables["holding_registers"][4] = 1

    def start(self, *arguments):
        self.device.start()
        self.addCleanup(self.device.stop)
        return start(self, self.device.port, *arguments)

    def test_a_device_that_became_too_slow_is_offline_until_it_is_fast_again(self):
        truth = self.start()
        truth.is_good(1)

        def answer(request):
            select.select([request.connection], [], [], PATIENCE)  # until the driver has given up
            return self.device.serve(request)

        self.device.answer = answer
        is_offline(truth)
        self.device.answer = self.device.serve
        truth.is_good(1)

    def test_a_device_that_is_slow_within_the_timeout_is_well(self):
        truth = self.start()

        def answer(request):
            time.sleep(TIMEOUT / 2)
            return self.device.serve(request)

        self.device.answer = answer
        truth.is_good(1, polling=(OK, WARN))  # cycles are left out

    def test_a_device_whose_one_connection_is_taken_is_had_once_it_is_free(self):
        self.device = Device(connections=0)
        self.device.tables["holding_registers"][4] = 1
        truth = self.start()
        is_offline(truth)
        self.device.allow(1)
        truth.is_good(1)

    def test_a_device_that_hangs_up_after_each_answer_is_still_read(self):
        self.device.answers_per_connection = 1
        truth = self.start("_verify:=off")  # the question for the identity would be all that it answers
        for value in range(1, 4):
            self.device.tables["holding_registers"][4] = value
            truth.level.wait_for(lambda now, wanted=value: now == wanted)


if __name__ == "__main__":
    testing.main()
