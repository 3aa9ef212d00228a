# SPDX-License-Identifier: Apache-2.0
"""Stamps of nodes whose clocks drift, until the driver has measured it and for a while more."""
import time

from other_clock_test import DRIFT, Cell, OtherClockTest
from support import testing

MEASURED = 11  # seconds after which the driver has measured the drift


class ClockDrift(OtherClockTest):
    def test_of_two_clocks_that_drift_apart(self):
        cells = [Cell(self, f"{self.name}_{number}", drift=drift) for number, drift in enumerate((DRIFT, -DRIFT))]

        def expect_each_true(pause):
            for cell in cells:
                with self.subTest(drift=cell.clock.drift):
                    self.expect_true(cell.edges(1))
            time.sleep(pause)

        begun = time.monotonic()
        while time.monotonic() < begun + MEASURED:
            expect_each_true(pause=0.6)
        for _ in range(3):
            expect_each_true(pause=1.2)  # the drift is known, and nothing was exchanged for a while


if __name__ == "__main__":
    testing.main()
