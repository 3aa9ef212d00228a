# SPDX-License-Identifier: Apache-2.0
"""Ten units behind a gateway that takes its time: they share one connection."""
import statistics
import time

import rospy
from coupler_driver.srv import Write
from std_msgs.msg import Bool, Int16

from support import process, testing
from support.device import Device

MAP = """
name: k{unit}
address: 127.0.0.1
port: {port}
unit: {unit}
rate: 20
timeout: {timeout}
mapping:
  holding_registers: {{level: {{address: 4, type: INT}}, goal: {{address: 5, type: INT, access: write}}}}
"""
UNITS = range(1, 11)
DELAY = 0.05  # of each answer
TIMEOUT = 1


class Gateway(testing.RosTest):
    def setUp(self):
        self.device = Device().start()
        self.addCleanup(self.device.stop)
        maps = [process.write_map(MAP.format(unit=unit, port=self.device.port, timeout=TIMEOUT)) for unit in UNITS]
        self.online = {unit: self.topic(f"/k{unit}/online", Bool) for unit in UNITS}
        self.driver(f"_maps:=[{','.join(maps)}]", "_verify:=off")
        for online in self.online.values():
            online.wait_for(lambda now: now)
        self.device.answer = self.answer_late

    def answer_late(self, request):
        time.sleep(DELAY)
        return self.device.serve(request)

    def test_a_write_waits_for_the_request_in_flight_and_not_for_the_reads_of_all(self):
        rospy.wait_for_service("/k1/write", 20)
        write = rospy.ServiceProxy("/k1/write", Write)
        overtaking, seconds = [], []
        for value in range(20):
            begin = time.monotonic()
            self.assertTrue(write("goal", str(value)).success)
            seconds.append(time.monotonic() - begin)
            came = self.device.seen(6)[-1].at
            overtaking.append(sum(begin < read.at < came for read in self.device.seen(3)))
        print(f"a write takes {statistics.median(seconds):.3f} s; reads before it: {sorted(overtaking)}")
        self.assertLess(statistics.median(overtaking), 3, "of ten units")
        level = self.topic("/k2/level", Int16)
        level.next()

    def test_a_gateway_that_falls_silent_is_told_by_each_unit_after_its_own_timeout(self):
        begin = time.monotonic()
        self.device.silent = True
        told = {}
        while len(told) < len(UNITS):
            for unit, online in self.online.items():
                if unit not in told and online.values[-1] is False:
                    told[unit] = time.monotonic() - begin
            self.assertLess(time.monotonic() - begin, 60)
            time.sleep(0.01)
        print("silence was told after", " ".join(f"{seconds:.1f}" for seconds in sorted(told.values())), "s")
        self.assertLess(min(told.values()), 4 * TIMEOUT, "of ten units, whose timeouts follow one another")

    def test_a_silent_unit_takes_no_other_offline(self):
        def all_but_the_third(request):
            return None if request.unit == 3 else self.answer_late(request)

        for online in self.online.values():
            online.values.clear()  # False at first
        self.device.answer = all_but_the_third
        self.online[3].wait_for(lambda now: not now)
        time.sleep(3 * TIMEOUT)
        for unit, online in self.online.items():
            self.assertEqual(False in online.values, unit == 3, unit)


if __name__ == "__main__":
    testing.main()
