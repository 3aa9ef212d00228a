# SPDX-License-Identifier: Apache-2.0
"""The services that a device has beside those of test/ros/services_test.py, what they answer offline, and that a slow one holds
up nothing but its own kind."""
import threading

from coupler_driver.srv import Read, Write
from std_msgs.msg import Bool, UInt16
from std_srvs.srv import SetBool, Trigger

from support import process, testing
from support.couplers import wago_750 as wago
from support.device import FAILURE, Device, Refuse
from support.patience import NO_TIMEOUT, PATIENCE
from support.ros import polled
from support.topics import wait_until

MAP = f"""
name: called
address: 127.0.0.1
rate: 20
timeout: {NO_TIMEOUT}s
mapping:
  coils: {{start: 1, brake: {{address: 2, safe: on}}, kept: {{address: 3, safe: hold}}}}
  holding_registers:
    speed: {{address: 10, type: UINT}}
    torque: {{address: 20, type: UINT, safe: 5}}
    ready: {{address: 30, type: BOOL, bit: 6}}
"""
AT_ONCE = 8  # fewer than ROS 2 keeps of a service's answers until rclpy takes them


class CallsTest(testing.RosTest):
    def setUp(self):
        self.device = Device().start()
        self.addCleanup(self.device.stop)
        self.program = self.driver("--map", process.write_map(MAP), "--port", self.device.port)
        self.program.wait_for("connected")

    def call(self, name, kind, *arguments):
        return self.service(f"/called/{name}", kind)(*arguments)


class Calls(CallsTest):
    def test_a_bit_of_a_register_is_set_and_its_neighbours_stay(self):
        self.device.tables["holding_registers"][30] = 0xA505
        self.assertTrue(self.call("ready/set", SetBool, True).success)
        self.assertEqual(self.device.tables["holding_registers"][30], 0xA545)
        self.assertEqual(self.call("ready/set", SetBool, False).message, "ok")
        self.assertEqual(self.device.tables["holding_registers"][30], 0xA505)

    def test_safe_writes_what_is_safe_and_says_how_many(self):
        self.device.tables["coils"][1:4] = [1, 0, 1]
        told = self.call("safe", Trigger)
        self.assertEqual((told.success, told.message), (True, "3 of 3 outputs have their safe values"))
        self.assertEqual((self.device.tables["coils"][1:4], self.device.tables["holding_registers"][20]), ([0, 1, 1], 5))

    def test_an_output_that_refuses_makes_safe_false(self):
        def answer(request):
            if request.function in (5, 15) and request.address == 1:
                raise Refuse(FAILURE)
            return self.device.serve(request)

        self.device.answer = answer
        told = self.call("safe", Trigger)
        self.assertFalse(told.success)
        self.assertIn("2 of 3 outputs have their safe values; start: exception 04", told.message)

    def test_safe_waits_for_no_other_call_and_goes_before_it(self):
        asked, free = threading.Event(), threading.Event()
        self.addCleanup(free.set)

        def answer(request):
            asked.set()
            free.wait(PATIENCE)
            return self.device.serve(request)

        self.device.answer = answer
        self.assertTrue(asked.wait(PATIENCE))
        answers = {}
        calls = [threading.Thread(target=lambda: answers.update(write=self.call("write", Write, "speed", "7"))),
                 threading.Thread(target=lambda: answers.update(safe=self.call("safe", Trigger)))]
        for call in calls:
            call.start()
        self.program.wait_for("called: safe values were requested")
        free.set()
        for call in calls:
            call.join(PATIENCE)
        self.assertTrue(answers["safe"].success)
        self.assertTrue(answers["write"].success)
        self.assertEqual(self.device.tables["holding_registers"][10], 7)

    def test_many_calls_at_once_are_each_answered(self):
        write = self.service("/called/write", Write)
        answers = []
        calls = [threading.Thread(target=lambda n=number: answers.append(write("speed", str(n)))) for number in range(AT_ONCE)]
        for call in calls:
            call.start()
        for call in calls:
            call.join(PATIENCE)
        self.assertEqual([answer.message for answer in answers], ["ok"] * AT_ONCE)

    def test_offline_each_fails_at_once_with_the_reason(self):
        online = self.topic("/called/online", Bool)
        self.device.stop()
        online.wait_for(lambda now: not now)
        for name, kind, arguments in (("write", Write, ("speed", "1")), ("start/set", SetBool, (True,)), ("safe", Trigger, ())):
            told = self.call(name, kind, *arguments)
            self.assertFalse(told.success, name)
            self.assertRegex(told.message, "not connected|Connection refused", name)  # the last attempt's, until the next step
        self.assertIn("the device is offline", self.call("read", Read, "speed").message)

    def test_only_bits_have_a_service_of_their_own(self):
        self.assertTrue(self.call("kept/set", SetBool, True).success)
        self.assertTrue(self.call("ready/set", SetBool, True).success)
        names = []
        wait_until(lambda: names.append([name for name, _ in polled.get_service_names_and_types()]) or
                   "/called/kept/set" in names[-1], "the services")
        names = names[-1]
        self.assertNotIn("/called/speed/set", names)
        self.assertNotIn("/called/reset_watchdog", names)


class Watchdog(testing.RosTest):
    def test_reset_watchdog_gives_an_expired_coupler_its_outputs_back(self):
        coupler = wago.Wago750().start()
        self.addCleanup(coupler.stop)
        path = process.write_map(f"name: rack\naddress: 127.0.0.1\nrate: 20\ntimeout: {NO_TIMEOUT}s\npreset: wago_750\n"
                                 "watchdog: {timeout: 1500ms, recovery: manual}\nmapping:\n  coils: {valve: 3}\n")
        driver = coupler.driver = self.driver("--map", path, "--port", coupler.port)
        driver.wait_for("watchdog is fed: outputs go off after 1500 ms")
        self.assertTrue(self.service("/rack/write", Write)("valve", "true").success)
        with driver.frozen():
            wait_until(lambda: coupler.expired, "the watchdog of the coupler")
        driver.wait_for("call rack/reset_watchdog")
        refused = self.service("/rack/write", Write)("valve", "true")
        self.assertEqual((refused.success, refused.exception), (False, 4))
        self.assertTrue(self.service("/rack/reset_watchdog", Trigger)().success)
        self.assertFalse(coupler.expired)
        self.assertTrue(self.service("/rack/write", Write)("valve", "true").success)


class Messages(CallsTest):
    def test_the_last_write_of_a_topic_and_of_a_service_follow_each_other(self):
        speed = self.publisher("/called/speed/write", UInt16)
        for value in range(1, 6):
            speed.publish(value)
            wait_until(lambda v=value: self.device.tables["holding_registers"][10] == v, "the message")
            self.assertTrue(self.call("write", Write, "speed", str(100 + value)).success)
            self.assertEqual(self.device.tables["holding_registers"][10], 100 + value)


if __name__ == "__main__":
    testing.main()
