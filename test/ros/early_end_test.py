# SPDX-License-Identifier: Apache-2.0
"""What is written while the driver still starts other devices is made safe, though a second signal or a failure ends it."""
import signal

from std_srvs.srv import SetBool

from support import process, testing
from support.device import Device
from support.patience import PATIENCE
from support.ports import free_port

FIRST = "name: first\naddress: 127.0.0.1\nport: {port}\non_shutdown: safe\nmapping:\n  coils: {{lamp: 3}}\n"
OTHER = "name: {name}\naddress: 127.0.0.1\nport: {port}\nmapping:\n  coils:\n{points}"
COUNT = 4000  # topics: they take longer than a write does


class EarlyEnd(testing.RosTest):
    def driving_before_the_last_begins(self, device, kind=process.Driver, and_then=lambda driver: None):
        """A driver of three devices that has written to the first one, and has not come to the last."""
        points = "".join(f"    p{i}: {i}\n" for i in range(COUNT))
        large = process.write_map(OTHER.format(name="large", port=free_port(), points=points))
        last = process.write_map(OTHER.format(name="last", port=free_port(), points="    p: 0\n"))
        first = process.write_map(FIRST.format(port=device.port))
        for _ in range(20):
            driver = kind(f"_maps:=[{first},{large},{last}]")
            self.addCleanup(driver.end)
            driver.wait_for("first: connected")
            self.assertTrue(self.service("/first/lamp/set", SetBool)(True).success)
            self.assertEqual(device.tables["coils"][3], 1)
            and_then(driver)
            if "last: " not in driver.output:
                return driver
            driver.interrupt()
        self.fail("the last device is always started before the write")

    def test_two_signals(self):
        with Device() as device:
            driver, code = process.interrupted_in_time(lambda: self.driving_before_the_last_begins(device),
                                                       lambda _, code: code == 0, signal.SIGINT, signal.SIGTERM)
            self.assertEqual(code, 0, driver.output)
            self.assertEqual(device.tables["coils"][3], 0)

    def test_a_device_that_cannot_be_started(self):
        with Device() as device:
            for _ in range(20):
                driver = self.driving_before_the_last_begins(device, process.LimitedDriver,
                                                             lambda driver: driver.start_no_more_threads())
                if not driver.ends_within(PATIENCE / 5):
                    driver.interrupt()  # the last one had its threads already
                elif driver.wait() != process.NOT_SAFE:  # on a busy machine the time for safe values may be over
                    break
            self.assertEqual(driver.wait(), 1, driver.output)
            self.assertIn("the driver has to end: no thread can be started: Resource temporarily unavailable", driver.output)
            self.assertEqual(device.tables["coils"][3], 0)


if __name__ == "__main__":
    testing.main()
