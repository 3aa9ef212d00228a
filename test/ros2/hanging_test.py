# SPDX-License-Identifier: Apache-2.0
"""A device that accepts and never answers holds up its own values and calls, and nothing else of the node."""
import socket
import threading

from coupler_driver.msg import Status
from coupler_driver.srv import Read, Write
from diagnostic_msgs.msg import DiagnosticArray
from std_msgs.msg import Bool, Int16
from type_description_interfaces.srv import GetTypeDescription

from support import process, testing
from support.device import Device
from support.parameters import BOOL, Parameters, parameter
from support.patience import NO_TIMEOUT, PATIENCE
from support.ros import polled
from support.topics import next_message, types, wait_until

MAP = f"""
name: hung
address: 127.0.0.1
rate: 20
timeout: {NO_TIMEOUT}s
mapping:
  coils: {{lamp: 3}}
  holding_registers: {{level: {{address: 4, type: INT}}}}
"""


class HangingTest(testing.RosTest):
    def node_answers(self, node):
        """All within the driver's one request."""
        parameters = Parameters(node)
        self.assertIn("rate", parameters.list().names)
        self.assertEqual(parameters.get("address"), ["127.0.0.1"])
        self.assertTrue(parameters.describe("port")[0].description)
        self.assertTrue(parameters.set(parameter("use_sim_time", BOOL, False))[0].successful)
        self.assertFalse(self.service(f"{node}/get_type_description", GetTypeDescription)("none/msg/None", "", False).successful)
        wait_until(lambda: polled.get_publishers_info_by_topic("/diagnostics"), "the diagnostics")


class NeverAnswered(HangingTest):
    def setUp(self):
        self.silent = self.enterContext(socket.create_server(("127.0.0.1", 0)))
        self.silent.settimeout(PATIENCE)
        self.port = self.silent.getsockname()[1]

    def asked(self):
        connection = self.enterContext(self.silent.accept()[0])
        self.assertTrue(connection.recv(12))

    def test_from_the_first_request_on_the_node_is_whole(self):
        self.driver("--map", process.write_map(MAP), "--port", self.port)
        self.asked()
        self.node_answers("/hung_driver")
        wait_until(lambda: "/hung/level" in types(), "the topics")
        self.assertFalse(self.topic("/hung/online", Bool).wait_for(lambda _: True))
        self.assertFalse(next_message("/hung/status", Status).online)
        self.assertEqual([entry.name for entry in next_message("/diagnostics", DiagnosticArray).status][0],
                         "hung_driver: hung connection")

    def test_while_its_map_is_awaited_too(self):
        driver = self.driver("--address", "127.0.0.1", "--port", self.port, "--timeout", "3600s")
        self.asked()
        self.node_answers(f"/coupler_127_0_0_1_{self.port}_driver")
        self.assertEqual(driver.interrupt(), 0, driver.output)


class FallenSilent(HangingTest):
    def setUp(self):
        self.device = Device().start()
        self.addCleanup(self.device.stop)
        self.driver("--map", process.write_map(MAP), "--port", self.device.port).wait_for("connected")

    def test_a_call_that_waits_for_the_device_holds_up_no_other_part(self):
        self.topic("/hung/level", Int16).next()
        held, free = threading.Event(), threading.Event()
        self.addCleanup(free.set)

        def answer(request):
            held.set()
            free.wait(PATIENCE)
            return self.device.serve(request)

        self.device.answer = answer
        self.assertTrue(held.wait(PATIENCE))
        answers = []
        calls = [threading.Thread(target=lambda: answers.append(self.service("/hung/write", Write)("level", "7"))),
                 threading.Thread(target=lambda: answers.append(self.service("/hung/read", Read)("level")))]
        for call in calls:
            call.start()
        self.publisher("/hung/lamp/write", Bool).publish(True)
        self.node_answers("/hung_driver")
        self.assertEqual(answers, [])
        free.set()
        for call in calls:
            call.join(PATIENCE)
        self.assertEqual([answer.success for answer in answers], [True, True])
        wait_until(lambda: self.device.tables["coils"][3] == 1, "the message")


if __name__ == "__main__":
    testing.main()
