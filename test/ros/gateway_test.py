# SPDX-License-Identifier: Apache-2.0
"""Ten units behind a gateway that takes its time: they share one connection."""
import statistics
import time

from coupler_driver.srv import Write
from std_msgs.msg import Bool, Int16

from support import process, testing
from support.device import Device
from support.patience import NO_TIMEOUT, PATIENCE
from support.topics import wait_until

MAP = """
name: {name}_{unit}
address: 127.0.0.1
port: {port}
unit: {unit}
rate: 20
timeout: {timeout}s
mapping:
  holding_registers: {{level: {{address: 4, type: INT}}, goal: {{address: 5, type: INT, access: write}}}}
"""
UNITS = range(1, 11)
DELAY = 0.2  # of each answer; a message is on its way to the driver for less, on a busy machine too


class Gateway(testing.RosTest):
    at_once = True

    def setUp(self):
        self.device = Device().start()
        self.addCleanup(self.device.stop)

    def drive(self, timeout):
        maps = [process.write_map(MAP.format(name=self.name, unit=unit, port=self.device.port, timeout=timeout)) for unit in UNITS]
        self.online = {unit: self.topic(f"/{self.name}_{unit}/online", Bool) for unit in UNITS}
        self.driver(f"_maps:=[{','.join(maps)}]", "_verify:=off")
        for online in self.online.values():
            online.wait_for(lambda now: now)
        self.device.answer = self.answer_late

    def answer_late(self, request):
        time.sleep(DELAY)
        return self.device.serve(request)

    def asked(self, unit):
        return sum(request.unit == unit for request in list(self.device.requests))

    def test_a_write_waits_for_the_request_in_flight_and_not_for_the_reads_of_all(self):
        self.drive(NO_TIMEOUT)
        write = self.service(f"/{self.name}_1/write", Write)
        overtaking, seconds = [], []
        for value in range(9):
            begin = time.monotonic()
            self.assertTrue(write("goal", str(value)).success)
            seconds.append(time.monotonic() - begin)
            came = self.device.seen(6)[-1].at
            overtaking.append(sum(begin < read.at < came for read in self.device.seen(3)))
        print(f"a write takes {statistics.median(seconds):.3f} s; reads before it: {sorted(overtaking)}")
        self.assertLess(statistics.median(overtaking), 3, "of ten units")
        level = self.topic(f"/{self.name}_2/level", Int16)
        level.next()

    def test_a_gateway_that_falls_silent_is_told_by_each_unit_after_its_own_timeout(self):
        timeout = 0.5
        self.drive(timeout)
        begin = time.monotonic()
        self.device.silent = True
        told = {}

        def note():
            for unit, online in self.online.items():
                if unit not in told and online.values[-1] is False:
                    told[unit] = time.monotonic() - begin
            return len(told) == len(UNITS)

        wait_until(note, "each unit to tell it", len(UNITS) * timeout + PATIENCE)
        print("silence was told after", " ".join(f"{seconds:.1f}" for seconds in sorted(told.values())), "s")
        # Ten timeouts follow one another; the first unit does not wait for the last.
        self.assertLess(min(told.values()), max(told.values()) / 2)

    def test_a_silent_unit_takes_no_other_offline(self):
        self.drive(timeout=2)  # an answer takes far less, on a busy machine too

        def all_but_the_third(request):
            return None if request.unit == 3 else self.answer_late(request)

        for online in self.online.values():
            online.values.clear()  # False at first
        self.device.answer = all_but_the_third
        self.online[3].wait_for(lambda now: not now)
        attempts = self.asked(3)
        wait_until(lambda: self.asked(3) > attempts, "the next attempt")
        asked = {unit: self.asked(unit) for unit in UNITS}
        wait_until(lambda: all(self.asked(unit) > asked[unit] for unit in UNITS if unit != 3),
                   "the others to be asked after a whole timeout more of its silence")
        for unit, online in self.online.items():
            self.assertEqual(False in online.values, unit == 3, unit)


if __name__ == "__main__":
    testing.main()
