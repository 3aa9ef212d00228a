# SPDX-License-Identifier: Apache-2.0
"""What is written while the driver still starts other devices is made safe, though a second signal ends it."""
import signal

from std_srvs.srv import SetBool

from support import process, testing
from support.device import Device
from support.ports import free_port

FIRST = "name: first\naddress: 127.0.0.1\nport: {port}\non_shutdown: safe\nmapping:\n  coils: {{lamp: 3}}\n"
COUNT = 4000  # topics: they take longer than a write does


class EarlyEnd(testing.RosTest):
    def test_two_signals(self):
        points = "".join(f"    p{i}: {i}\n" for i in range(COUNT))
        large = process.write_map(f"name: large\naddress: 127.0.0.1\nport: {free_port()}\nmapping:\n  coils:\n{points}")
        with Device() as device:
            first = process.write_map(FIRST.format(port=device.port))

            def start():
                for _ in range(20):
                    driver = self.driver(f"_maps:=[{first},{large}]")
                    driver.wait_for("first: connected")
                    self.assertTrue(self.service("/first/lamp/set", SetBool)(True).success)
                    self.assertEqual(device.tables["coils"][3], 1)
                    if "large: " not in driver.output:
                        return driver
                    driver.end()
                self.fail("the other device is always started before the write")

            driver, code = process.interrupted_in_time(start, lambda _, code: code == 0, signal.SIGINT, signal.SIGTERM)
            self.assertEqual(code, 0, driver.output)
            self.assertEqual(device.tables["coils"][3], 0)


if __name__ == "__main__":
    testing.main()
