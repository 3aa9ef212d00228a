# SPDX-License-Identifier: Apache-2.0
"""Presets against simulated devices on a serial line (support/couplers): their maps need no more than its port."""
from coupler_driver.srv import Write
from std_msgs.msg import Bool, UInt8

from support import process, testing
from support.couplers import robotiq_2f as robotiq
from support.couplers import waveshare_io_8ch as waveshare
from support.patience import NO_TIMEOUT
from support.rtu_server import RtuServer
from support.serial_line import SerialLine

MAP = """
name: {name}
serial: {{device: {port}}}
rate: 20
timeout: {timeout}
preset: {preset}
mapping:
{mapping}
"""
GRIPPER = """
  holding_registers:
    action: {{address: 0x03E8, type: UINT, access: write, values: {{0: reset, 256: activate, 2304: move}}}}
    target: {{address: 0x03E9, type: UINT, access: write, max: 255{of_target}}}
    speed_and_force: {{address: 0x03EA, type: UINT, access: write}}
  input_registers:
    state: {{address: 0x07D0, type: USINT, offset: high}}
    fault: {{address: 0x07D1, type: USINT, offset: high}}
    position: {{address: 0x07D2, type: USINT, offset: high}}"""
MODULE = """
  coils: {valve: 0, all: {address: 255, access: write}}
  discrete_inputs: {door: 0}
  holding_registers: {valve_mode: {address: 0x1000, type: UINT, max: 3}}"""


class OnALine(testing.RosTest):
    at_once = True

    def start(self, preset, unit, device, mapping, timeout=f"{NO_TIMEOUT}s"):
        line = SerialLine()
        self.addCleanup(line.end)
        server = RtuServer([unit], line.device)
        self.addCleanup(server.end)
        server.units[unit] = device
        path = process.write_map(MAP.format(name=self.name, port=line.port, preset=preset, mapping=mapping, timeout=timeout))
        self.driver(f"_map:={path}")
        self.topic(f"/{self.name}/online", Bool).becomes(True)

    def write(self, point, value):
        return self.service(f"/{self.name}/write", Write)(point, value)

    def writes(self, point, value):
        result = self.write(point, value)
        self.assertTrue(result.success, result.message)


class Robotiq(OnALine):
    def use(self, part=None, of_target="", **options):
        self.gripper = robotiq.Robotiq2f(part)
        self.start("robotiq_2f", robotiq.UNIT, self.gripper, GRIPPER.format(of_target=of_target), **options)
        self.state, self.fault, self.position = (
            self.topic(f"/{self.name}/{name}", UInt8) for name in ("state", "fault", "position"))

    def activate(self):
        self.writes("action", "activate")
        self.state.becomes(0x11)
        self.gripper.finish()
        self.state.becomes(0x31)

    def test_it_is_activated_grips_a_part_and_opens(self):
        self.use(part=189)
        self.activate()
        self.writes("speed_and_force", "0xFFFF")
        self.writes("action", "move")
        for target, state, position in (255, 0xB9, 189), (0, 0xF9, 0):
            self.writes("target", str(target))
            self.state.becomes(0x39)
            self.gripper.finish()
            self.state.becomes(state)
            self.position.becomes(position)
        self.assertEqual(self.gripper.functions, {4, 16})

    def test_it_tells_why_it_does_not_move_and_begins_anew_after_a_reset(self):
        self.use()
        self.writes("action", "2304")
        self.state.becomes(0x11)
        self.fault.becomes(robotiq.NOT_YET_ACTIVATED)
        self.writes("action", "reset")
        self.state.becomes(0)
        self.fault.becomes(0)
        self.activate()

    def test_it_does_not_answer_a_write_of_a_single_register(self):
        self.use(of_target=", write_function: single", timeout="2s")
        self.assertFalse(self.write("target", "100").success)
        self.assertIn(6, self.gripper.functions)
        self.assertEqual(self.gripper.target, 0)
        self.state.next()


class Waveshare(OnALine):
    def test_its_outputs_are_written_or_switched_by_its_inputs(self):
        module = waveshare.WaveshareIo8ch()
        self.start("waveshare_io_8ch", waveshare.UNIT, module, MODULE)
        valve, door = (self.topic(f"/{self.name}/{name}", Bool) for name in ("valve", "door"))
        for value in (True, False):
            self.writes("valve", str(value).lower())
            valve.becomes(value)
            self.assertEqual(module.outputs, [int(value)] + [0] * 7)
            module.set_input(0, value)
            door.becomes(value)
        self.writes("valve_mode", str(waveshare.FOLLOWS))
        for value in (True, False):
            module.set_input(0, value)
            valve.becomes(value)
        for value in (True, False):
            self.writes("all", str(value).lower())
            self.assertEqual(module.outputs, [int(value)] * 8)


if __name__ == "__main__":
    testing.main()
