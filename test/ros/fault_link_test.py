# SPDX-License-Identifier: Apache-2.0
"""The cable between driver and device is pulled and put back: two network namespaces and a link between them."""
from support import testing
from support.device import Device
from support.network import Network
from support.patience import NO_TIMEOUT, wait_until
from support.truth import TIMEOUT, nothing_is_published, start


class FaultLink(testing.RosTest):
    at_once = True

    def setUp(self):
        self.network = self.enterContext(Network())
        self.device = Device(address=self.network.device)
        with self.network.at_the_far_end():
            self.device.start()
        self.addCleanup(self.device.stop)
        self.set(1)
        self.start()
        self.truth.is_good(1)

    def start(self, timeout=TIMEOUT):
        self.truth = start(self, self.device.port, address=self.network.device, timeout=timeout)

    def is_offline(self):
        self.truth.is_offline()
        nothing_is_published([self.truth])

    def set(self, value):
        self.device.tables["holding_registers"][4] = value

    def test_a_pulled_cable_is_told_and_the_driver_comes_back_by_itself(self):
        for value in (2, 3):
            self.network.pull()
            self.is_offline()
            self.set(value)
            self.network.plug()
            self.truth.is_good(value)

    def test_an_interface_that_goes_down_is_told_and_the_driver_comes_back_by_itself(self):
        self.network.take_down()
        self.is_offline()
        self.set(2)
        self.network.bring_up()
        self.truth.is_good(2)

    def test_a_cable_that_is_back_before_the_timeout_costs_no_connection(self):
        self.truth.end()
        self.start(NO_TIMEOUT)
        self.truth.is_good(1)
        accepted = self.device.accepted
        self.network.pull()
        self.set(2)
        wait_until(lambda: self.network.loses_a_request(self.device.port), "the request after the last value")
        self.truth.level.stays_quiet()
        self.network.plug()
        self.truth.is_good(2)
        self.assertEqual(self.device.accepted, accepted)

    def test_a_driver_that_starts_without_a_cable_waits_for_it(self):
        self.truth.end()
        self.network.pull()
        self.start()
        self.is_offline()
        self.network.plug()
        self.truth.is_good(1)


if __name__ == "__main__":
    testing.main()
