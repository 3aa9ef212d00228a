# SPDX-License-Identifier: Apache-2.0
"""A driver of a map with tools: a clamp with an input at each end, and a vacuum cup without any."""
from concurrent.futures import ThreadPoolExecutor

from coupler_driver.msg import ToolState
from std_srvs.srv import Trigger

from support import process, testing
from support.device import FAILURE, Device, Refuse
from support.patience import NO_TIMEOUT, PATIENCE, wait_until

MAP = """
name: {name}
address: 127.0.0.1
rate: 50
timeout: {timeout}s
{head}
mapping:
  coils: {{valve_close: 0, valve_open: 1, vacuum: 5, lamp: 7}}
  discrete_inputs: {{sensor_closed: 0, sensor_open: 1, part_present: 2}}
  {mapping}
tools:
  clamp: {{close: valve_close, open: valve_open, closed: sensor_closed, opened: sensor_open, holds: part_present,
           empty: ok, timeout: {patience}s{more}}}
  cup: {{close: vacuum, travel: 100ms}}
"""
CLOSE, OPEN, VACUUM = 0, 1, 5
CLOSED, OPENED, PART = 0, 1, 2


class ToolsTest(testing.RosTest):
    at_once = True

    def map_text(self, head="", timeout=NO_TIMEOUT, patience=PATIENCE, more="", mapping=""):
        return MAP.format(name=self.name, head=head, timeout=timeout, patience=patience, more=more, mapping=mapping)

    def start(self, port, *arguments, **options):
        self.path = process.write_map(self.map_text(*arguments, **options))
        self.program = self.driver(f"_map:={self.path}", f"_port:={port}")
        self.program.wait_for("connected")
        self.calls = ThreadPoolExecutor(4)
        self.addCleanup(self.calls.shutdown)

    def call(self, name):
        """The answer to come of a service of a tool: whether it is a success, and what it says."""
        service = self.service(f"/{self.name}/{name}", Trigger)

        def answer():
            response = service()
            return response.success, response.message
        return self.calls.submit(answer)

    def assert_answers(self, call, success, text):
        succeeded, message = call.result(PATIENCE)
        self.assertRegex(message, f"^{text}$")
        self.assertEqual(succeeded, success)

    def assert_becomes(self, tool, state):
        return self.topic(f"/{self.name}/{tool}/state", ToolState, latched=True).wait_for(
            lambda message: message.state == state)


class DeviceToolsTest(ToolsTest):
    """A foreign device, which is polled, with a cylinder that the test moves."""

    def start(self, *arguments, **options):
        self.device = Device().start()
        self.addCleanup(self.device.stop)
        self.coils, self.inputs = self.device.tables["coils"], self.device.tables["discrete_inputs"]
        self.inputs[OPENED] = 1
        super().start(self.device.port, *arguments, **options)

    def reject_writes_of(self, output):
        def answer(request):
            if request.function == 5 and request.address == output:
                raise Refuse(FAILURE)
            return self.device.serve(request)
        self.device.answer = answer

    def becomes(self, output, level):
        wait_until(lambda: self.coils[output] == level, f"coil {output} to be {level}")
