# SPDX-License-Identifier: Apache-2.0
"""The cable between driver and device is pulled and put back: two network namespaces and a link between them."""
import time

from support import testing
from support.device import Device
from support.network import DEVICE, Network
from support.truth import Truth

TIMEOUT = 0.5


class FaultLink(testing.RosTest):
    def setUp(self):
        self.network = self.enterContext(Network())
        self.device = Device(address=DEVICE)
        with self.network.at_the_far_end():
            self.device.start()
        self.addCleanup(self.device.stop)
        self.set(1)
        self.truth = Truth(self, self.device.port, address=DEVICE)
        self.truth.is_good(1)

    def set(self, value):
        self.device.tables["holding_registers"][4] = value

    def test_a_pulled_cable_is_told_and_the_driver_comes_back_by_itself(self):
        for value in (2, 3):
            self.network.pull()
            self.truth.is_offline()
            self.set(value)
            self.network.plug()
            self.truth.is_good(value)

    def test_an_interface_that_goes_down_is_told_and_the_driver_comes_back_by_itself(self):
        self.network.take_down()
        self.truth.is_offline()
        self.set(2)
        self.network.bring_up()
        self.truth.is_good(2)

    def test_a_cable_that_is_back_before_the_timeout_costs_no_connection(self):
        self.network.pull()
        time.sleep(TIMEOUT / 10)
        self.network.plug()
        self.set(2)
        self.truth.is_good(2)

    def test_a_driver_that_starts_without_a_cable_waits_for_it(self):
        self.truth.driver.end()
        self.network.pull()
        self.truth = Truth(self, self.device.port, address=DEVICE)
        self.truth.is_offline()
        self.network.plug()
        self.truth.is_good(1)


if __name__ == "__main__":
    testing.main()
