# SPDX-License-Identifier: Apache-2.0
"""Presets against simulated couplers (support/couplers): the watchdog of each is armed, fed and reset, its limits and
its read-back are kept."""
import socket
import time

import rosservice
from coupler_driver.srv import Schedule, Write
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from std_msgs.msg import Bool, UInt16MultiArray, UInt32
from std_srvs.srv import Trigger

from support import process, testing
from support.couplers import beckhoff_bk9000 as beckhoff
from support.couplers import moxa_e1200 as moxa
from support.couplers import wago_750 as wago
from support.couplers.plc import Plc
from support.latest import values
from support.patience import NO_TIMEOUT, PATIENCE
from support.topics import next_message, wait_until

MS = 900  # of the watchdogs; they are fed three times in it, and the couplers do not count what a busy machine takes
TIMEOUT, LONGER = MS / 1000, 1.5 * MS / 1000  # seconds

MAP = """
name: {name}
address: 127.0.0.1
rate: {rate}
timeout: {timeout}s
preset: {preset}
{top}
mapping:
{mapping}
"""
VALVE = "  coils: {valve: 3}"


def diagnosis(device, wanted):
    """The diagnostic status of the device's watchdog, once its level is the wanted one."""
    end = time.monotonic() + PATIENCE
    while True:
        for status in next_message("/diagnostics", DiagnosticArray).status:
            if status.name.endswith(f"{device} watchdog") and status.level == wanted:
                return status
        if time.monotonic() > end:
            raise AssertionError(f"/diagnostics did not say so in {PATIENCE} s")


class PresetTest(testing.RosTest):
    at_once = True

    def use(self, coupler):
        self.coupler = coupler.start()
        self.addCleanup(coupler.stop)

    def start(self, preset, watchdog=f"timeout: {MS}ms", top="", mapping=VALVE, rate=20):
        if watchdog:
            top += f"\nwatchdog: {{{watchdog}}}"
        path = process.write_map(MAP.format(name=self.name, preset=preset, top=top, mapping=mapping, rate=rate,
                                            timeout=NO_TIMEOUT))
        self.coupler.driver = self.driver(f"_map:={path}", f"_port:={self.coupler.port}")
        return self.coupler.driver

    def write(self, point, value):
        return self.service(f"/{self.name}/write", Write)(point, value)

    def reset(self):
        return self.service(f"/{self.name}/reset_watchdog", Trigger)()

    def switch_on(self):
        self.assertTrue(self.write("valve", "true").success)
        self.assertTrue(self.is_on())

    def is_on(self):
        return any(self.coupler.coil(address) for address in self.coupler.outputs)

    def stays_on(self):
        time.sleep(LONGER)
        self.assertEqual(self.coupler.expiries, 0)
        self.assertTrue(self.is_on())

    def expire(self, driver):
        """The driver hangs until the coupler has switched its outputs off."""
        with driver.frozen():
            wait_until(lambda: self.coupler.expired, "the watchdog of the coupler")
            self.assertFalse(self.is_on())

    def expect_recovery(self, driver):
        """By itself, with the outputs that it had written."""
        self.switch_on()
        self.expire(driver)
        driver.wait_for(f"watchdog has expired: {MS} ms without a request from the driver; its outputs are off")
        driver.wait_for("watchdog is reset and fed")
        wait_until(self.is_on, "the outputs to be restored")
        self.assertFalse(self.coupler.expired)
        self.assertEqual(values(diagnosis(self.name, DiagnosticStatus.OK))["times expired"], "1")
        expiries = self.coupler.expiries
        time.sleep(LONGER)
        self.assertEqual((self.coupler.expiries, self.is_on()), (expiries, True))

    def expect_recovery_by_call(self, driver):
        self.switch_on()
        self.expire(driver)
        driver.wait_for(f"call {self.name}/reset_watchdog")
        time.sleep(LONGER)
        self.assertTrue(self.coupler.expired)
        self.assertFalse(self.is_on())
        self.assertIn(f"{self.name}/reset_watchdog", diagnosis(self.name, DiagnosticStatus.ERROR).message)
        answer = self.reset()
        self.assertTrue(answer.success, answer.message)
        self.assertFalse(self.coupler.expired)
        self.assertFalse(self.is_on())  # nobody has asked for that
        driver.wait_for("outputs stay off until they are written")
        self.switch_on()
        diagnosis(self.name, DiagnosticStatus.OK)


class Wago(PresetTest):
    def setUp(self):
        self.use(wago.Wago750())

    def test_it_is_armed_before_anything_else_is_written_and_fed_by_changes(self):
        self.start("wago_750").wait_for(f"watchdog is fed: outputs go off after {MS} ms")
        self.switch_on()
        writes = [(request.address, int.from_bytes(request.data[3:5], "big")) for request in self.coupler.seen(5, 6)]
        self.assertEqual(writes[:5], [(wago.STOP, 0xAA55), (wago.TIME, MS // 100), (wago.MASK, 0), (wago.TRIGGER, 1),
                                      (wago.TRIGGER, 2)])
        self.assertIn((3, 0xFF00), writes[5:])
        self.stays_on()
        wait_until(lambda: len(self.coupler.written(wago.TRIGGER)) > 2 + 4, "five feeds")
        fed = self.coupler.written(wago.TRIGGER)[2:]
        self.assertEqual(fed, ([1, 2] * len(fed))[:len(fed)])

    def test_it_recovers_by_itself(self):
        self.expect_recovery(self.start("wago_750", top="on_reconnect: restore"))

    def test_it_recovers_by_a_call(self):
        driver = self.start("wago_750", f"timeout: {MS}ms, recovery: manual")
        self.switch_on()
        self.expire(driver)
        driver.wait_for(f"call {self.name}/reset_watchdog")
        refused = self.write("valve", "true")
        self.assertEqual((refused.success, refused.exception), (False, 4))
        self.assertTrue(self.reset().success)
        self.switch_on()

    def test_a_driver_that_is_started_anew_leaves_the_decision_to_the_call_too(self):
        manual = f"timeout: {MS}ms, recovery: manual"
        driver = self.start("wago_750", manual)
        driver.wait_for("watchdog is fed")
        driver.end()
        wait_until(lambda: self.coupler.expired, "the watchdog of the coupler")
        self.start("wago_750", manual).wait_for(f"call {self.name}/reset_watchdog")
        self.assertTrue(self.coupler.expired)
        self.assertTrue(self.reset().success)
        self.assertFalse(self.coupler.expired)

    def test_a_generated_driver_does_the_same(self):
        if not (process.BUILD / "bin" / "wago_driver").exists():
            self.skipTest("wago_driver was not built")
        driver = self.coupler.driver = process.Process("wago_driver", f"_port:={self.coupler.port}")
        self.addCleanup(driver.end)
        driver.wait_for("watchdog is fed: outputs go off after 1200 ms")
        self.publisher("/wago/valve/write", Bool).publish(True)
        wait_until(self.is_on, "the valve")
        self.expire(driver)
        driver.wait_for("call wago/reset_watchdog")
        self.assertTrue(self.service("/wago/reset_watchdog", Trigger)().success)
        self.assertFalse(self.coupler.expired)

    def test_without_watchdog_in_the_map_it_is_left_alone(self):
        self.start("wago_750", watchdog=None)
        self.switch_on()
        self.assertEqual([request for request in self.coupler.seen(6, 16) if request.address >= 0x1000], [])
        self.service(f"/{self.name}/schedule", Schedule)  # which is offered after it
        self.assertNotIn(f"/{self.name}/reset_watchdog", rosservice.get_service_list())

    def test_outputs_are_read_where_they_read_back(self):
        self.coupler.tables["coils"][3] = 1  # an input, as one that reads coil 3 sees it
        self.start("wago_750")
        valve = self.topic(f"/{self.name}/valve", Bool)
        self.assertFalse(valve.next())
        self.switch_on()
        valve.wait_for(lambda on: on)
        self.assertEqual({request.address for request in self.coupler.seen(1)}, {wago.READ_BACK + 3})

    def test_no_request_is_longer_than_it_takes(self):
        self.start("wago_750", top="on_reconnect: restore", mapping="""
  coils: {lamps: {address: 0, count: 500}, others: {address: 500, count: 10}}
  input_registers: {a: {address: 0, type: UINT, count: 120}, b: {address: 120, type: UINT, count: 120}}
  holding_registers: {c: {address: 0, type: UINT, count: 60}, d: {address: 60, type: UINT, count: 60}}""")
        self.coupler.tables["input_registers"][120] = 4711
        self.topic(f"/{self.name}/b", UInt16MultiArray).wait_for(lambda values: values[0] == 4711)
        for point in ("c", "d"):
            self.assertTrue(self.write(point, str([7] * 60)).success)
        self.coupler.drop()  # both are restored, neighbours as they are
        wait_until(lambda: len(self.coupler.seen(16)) >= 4, "the registers to be restored")
        for function, limit in wago.LIMITS.items():
            self.assertLessEqual(max((request.count for request in self.coupler.seen(function)), default=0), limit)


class Beckhoff(PresetTest):
    def setUp(self):
        self.use(beckhoff.BeckhoffBk9000())

    def test_its_time_is_set_before_the_first_write_arms_it(self):
        self.start("beckhoff_bk9000").wait_for("watchdog is fed")
        self.assertEqual([(request.address, int.from_bytes(request.data[3:5], "big"))
                          for request in self.coupler.seen(5, 6)],
                         [(beckhoff.TIME, MS), (beckhoff.TYPE, beckhoff.ANYTHING_FEEDS)])
        self.switch_on()
        self.stays_on()

    def test_while_it_runs_a_new_connection_sets_nothing(self):
        driver = self.start("beckhoff_bk9000")
        self.switch_on()
        connections = self.coupler.accepted
        self.coupler.drop()
        wait_until(lambda: self.coupler.accepted > connections, "the next connection")
        self.stays_on()
        self.assertEqual(self.coupler.written(beckhoff.TIME), [MS])
        self.assertNotIn("cannot be armed", driver.output)

    def test_slow_polling_feeds_it_too(self):
        self.start("beckhoff_bk9000", rate=0.2)
        self.switch_on()
        self.stays_on()

    def test_it_recovers_by_itself(self):
        self.expect_recovery(self.start("beckhoff_bk9000", top="on_reconnect: restore"))
        self.assertEqual(self.coupler.written(beckhoff.RESET), [0xBECF, 0xAFFE])

    def test_it_recovers_by_a_call(self):
        self.expect_recovery_by_call(self.start("beckhoff_bk9000", f"timeout: {MS}ms, recovery: manual"))

    def test_only_the_first_of_three_connections_may_write(self):
        others = [socket.create_connection(("127.0.0.1", self.coupler.port)) for _ in range(3)]
        for other in others:
            self.addCleanup(other.close)
        wait_until(lambda: self.coupler.accepted == 3, "three connections")
        driver = self.start("beckhoff_bk9000")
        driver.wait_for("not connected")
        others.pop().close()
        driver.wait_for(f"cannot be armed: writing {MS} to holding_registers 4384: exception 06 (server device busy); "
                        "another client owns its outputs")
        self.assertIn("another client owns", diagnosis(self.name, DiagnosticStatus.ERROR).message)
        self.assertEqual(self.write("valve", "true").exception, 6)
        for other in others:
            other.close()
        driver.wait_for("watchdog is fed")
        self.switch_on()


class Moxa(PresetTest):
    def setUp(self):
        self.use(moxa.MoxaE1200(TIMEOUT))

    def test_it_recovers_by_itself(self):
        driver = self.start("moxa_e1200", top="on_reconnect: restore")
        self.switch_on()
        self.stays_on()
        self.expect_recovery(driver)
        self.assertEqual(self.coupler.written(moxa.ALARM, function=5), [0xFF00])

    def test_it_recovers_by_a_call(self):
        self.expect_recovery_by_call(self.start("moxa_e1200", f"timeout: {MS}ms, recovery: manual"))

    def test_clear_coils_read_0_and_counters_stand_high_word_first(self):
        self.coupler.count = 70000
        driver = self.start("moxa_e1200", mapping=f"""
  coils: {{clear: {{address: {moxa.CLEAR_COUNT[0]}, access: write}}}}
  input_registers: {{count: {{address: {moxa.COUNTER}, type: UDINT}}}}""")
        count = self.topic(f"/{self.name}/count", UInt32)
        count.wait_for(lambda value: value == 70000)
        result = self.write("clear", "true")
        self.assertTrue(result.success, result.message)
        count.wait_for(lambda value: value == 0)
        self.assertEqual(self.write("clear", "false").exception, 3)
        self.assertEqual([request.address for request in self.coupler.seen(1) if request.address != moxa.ALARM], [])
        self.assertNotIn("is not in the device", driver.output)


class PlcWithHeartbeat(PresetTest):
    def test_its_program_sees_the_driver_come_and_go(self):
        self.use(Plc(heartbeat=100, timeout=TIMEOUT))
        driver = self.start("plc", f"timeout: {MS}ms, heartbeat: 100")
        self.switch_on()
        self.stays_on()
        wait_until(lambda: len(self.coupler.written(100)) > 4, "five beats")
        beats = self.coupler.written(100)
        self.assertEqual(beats, ([1, 2] * len(beats))[:len(beats)])
        self.expire(driver)
        wait_until(lambda: not self.coupler.expired, "the heartbeat")
        self.switch_on()


if __name__ == "__main__":
    testing.main()
