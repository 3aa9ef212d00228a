# SPDX-License-Identifier: Apache-2.0
"""Thousands of messages at once: DDS and the driver may leave out older values, never the newest, and each one that was taken
has its result."""
import threading

from coupler_driver.msg import PointStatus
from coupler_driver.srv import Write
from std_msgs.msg import Bool, UInt16, UInt32
from std_srvs.srv import Trigger

from support import process, testing
from support.device import Device
from support.latest import LatestDiagnostics, LatestStatus, values
from support.patience import NO_TIMEOUT, PATIENCE
from support.topics import Publisher, qos, wait_until

MAP = f"""
name: burst
address: 127.0.0.1
rate: 20
timeout: {NO_TIMEOUT}s
mapping:
  coils: {{start: 1, stop: {{address: 2, write_queue: every}}}}
  holding_registers:
    level: {{address: 0, type: UINT, access: read}}
    speed: {{address: 10, type: UINT}}
    torque: {{address: 20, type: UINT}}
    count: {{address: 30, type: UDINT, order: ABCD}}
"""
MESSAGES = 10000


class Burst(testing.RosTest):
    def setUp(self):
        self.device = Device().start()
        self.addCleanup(self.device.stop)
        self.program = self.driver("--map", process.write_map(MAP), "--port", self.device.port)
        self.program.wait_for("connected")
        self.status, self.diagnostics = LatestStatus("burst"), LatestDiagnostics("burst")
        for voice in (self.status, self.diagnostics):
            self.addCleanup(voice.close)

    def writers(self, depth=10):
        writers = [Publisher(f"/burst/{name}/write", kind, qos(depth))
                   for name, kind in (("speed", UInt16), ("torque", UInt16), ("count", UInt32))]
        for writer in writers:
            self.addCleanup(writer.unregister)
            wait_until(lambda w=writer: w.subscribers > 0, "the driver")
        return writers

    def register(self, address):
        return self.device.tables["holding_registers"][address]

    def newest_is_there(self, last):
        for what, address in (("speed", 10), ("torque", 20), ("count", 31)):
            wait_until(lambda a=address: self.register(a) == last, f"the newest {what}, not {self.register(address)}")

    def results(self):
        """By outcome, once they change no more."""
        before = None

        def stay():
            nonlocal before
            self.diagnostics.known.pop("writes", None)
            now = values(self.diagnostics.wait_for(lambda known: "writes" in known)["writes"])
            same, before = now == before, now
            return same

        wait_until(stay, "the last result")
        return {name: int(count) for name, count in before.items()}

    def test_after_a_burst_the_newest_value_of_each_number_is_on_the_wire(self):
        writers = self.writers()
        for value in range(1, MESSAGES // 3 + 1):
            for writer in writers:
                writer.publish(value)
        self.newest_is_there(MESSAGES // 3)
        for name in ("speed", "torque", "count"):
            self.status.wait_for(lambda known, n=name: n in known and known[n].write_outcome == PointStatus.WRITE_OK)
        results = self.results()
        self.assertLessEqual(sum(results.values()), MESSAGES)
        self.assertGreaterEqual(results["ok"], 3)
        self.assertEqual({name for name, count in results.items() if count}, {"ok", "superseded"} & set(results))
        self.assertNotIn("WARN", self.program.output)

    def test_with_a_device_that_takes_its_time_too_and_reads_go_on(self):
        free = threading.Event()
        self.addCleanup(free.set)

        def answer(request):
            if request.function in (6, 16):
                free.wait(0.02)
            return self.device.serve(request)

        self.device.answer = answer
        level = self.topic("/burst/level", UInt16)
        level.next()
        writers = self.writers(depth=1000)
        for value in range(1, MESSAGES // 3 + 1):
            for writer in writers:
                writer.publish(value)
        self.newest_is_there(MESSAGES // 3)
        level.next()
        results = self.results()
        self.assertLess(results["ok"], sum(results.values()))
        self.assertGreater(results["superseded"], 0)

    def test_while_messages_pour_in_services_are_answered(self):
        writers = self.writers()
        pouring = threading.Event()
        last = [0]

        def pour():
            while not pouring.is_set():
                last[0] = last[0] % 60000 + 1
                for writer in writers:
                    writer.publish(last[0])

        flood = threading.Thread(target=pour)
        flood.start()
        try:
            wait_until(lambda: self.register(10) > 0, "the first")
            self.assertTrue(self.service("/burst/write", Write)("start", "true").success)
            self.assertTrue(self.service("/burst/safe", Trigger)().success)
        finally:
            pouring.set()
            flood.join(PATIENCE)
        self.newest_is_there(last[0])

    def test_bits_keep_their_order(self):
        stop = Publisher("/burst/stop/write", Bool, qos(1000))
        self.addCleanup(stop.unregister)
        wait_until(lambda: stop.subscribers > 0, "the driver")
        sent = [number % 3 == 0 for number in range(60)]  # fewer than the driver's subscription keeps
        for on in sent:
            stop.publish(on)
        wait_until(lambda: len(self.device.seen(5)) == len(sent), "all of them")
        self.assertEqual([request.data[3] == 0xFF for request in self.device.seen(5)], sent)


if __name__ == "__main__":
    testing.main()
