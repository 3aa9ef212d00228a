# SPDX-License-Identifier: Apache-2.0
"""A driver that stood still with a read in flight (SIGSTOP; a suspended machine) finds a reply that came long ago: it is late, and
no value of it is published."""
import threading
import time

from std_msgs.msg import UInt16

from support import process, testing
from support.device import Device
from support.patience import PATIENCE, wait_until

TIMEOUT = 0.2
STOP = 1.0


class LateReply(testing.RosTest):
    at_once = True

    def test_what_lay_in_the_socket_is_not_published(self):
        device = Device()
        began = time.monotonic()
        holds_back, asked, frozen = threading.Event(), threading.Event(), threading.Event()

        def milliseconds():
            return int((time.monotonic() - began) * 1000)

        def tell_the_time(request):
            if request.function == 3:
                device.tables["holding_registers"][0] = milliseconds() & 0xFFFF
                if holds_back.is_set():
                    holds_back.clear()
                    asked.set()
                    frozen.wait(PATIENCE)
            return device.serve(request)

        device.answer = tell_the_time
        device.start()
        self.addCleanup(device.stop)
        path = process.write_map(f"name: {self.name}\naddress: 127.0.0.1\nrate: 100\ntimeout: {TIMEOUT}\nverify: off\nmapping:\n"
                                 "  holding_registers: {a: {address: 0, type: UINT}}\n")
        driver = self.driver(f"_map:={path}", f"_port:={device.port}")
        topic = self.topic(f"/{self.name}/a", UInt16)
        topic.next()
        for _ in range(3):
            asked.clear()
            frozen.clear()
            holds_back.set()
            self.assertTrue(asked.wait(PATIENCE))
            with driver.frozen():
                at = milliseconds()
                frozen.set()  # the reply comes to a driver that stands still
                time.sleep(STOP)
                topic.values.clear()  # what was published before
            woken = milliseconds()
            wait_until(lambda: topic.values, "a value after the stop")
            first = topic.values[0]
            self.assertGreater(first, at + 1000 * STOP / 2, f"stopped at {at} ms, woken at {woken} ms, got the value of {first} ms")


if __name__ == "__main__":
    testing.main()
