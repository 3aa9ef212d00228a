# SPDX-License-Identifier: Apache-2.0
"""Units of pymodbus on one serial line, and RTU over TCP, as topics."""
from std_msgs.msg import Bool, Int16

from support import process, testing
from support.rtu_server import RtuServer
from support.serial_line import SerialLine
from support.topics import wait_until

MAP = """
name: {name}_{unit}
{place}
unit: {unit}
rate: 50
timeout: {timeout}
mapping:
  coils: {{motor: 3}}
  input_registers: {{weight: {{address: 5, type: INT}}}}
"""


class Serial(testing.RosTest):
    at_once = True

    def line(self, units, **options):
        line = SerialLine(**options)
        self.addCleanup(line.end)
        self.server = RtuServer(units, line.device)
        self.addCleanup(self.server.end)
        return line

    def drive(self, units, place, timeouts=None):
        """timeouts: of units, where it is not 2 s."""
        maps = [process.write_map(MAP.format(name=self.name, unit=unit, place=place, timeout=(timeouts or {}).get(unit, "2s")))
                for unit in units]
        self.online = {unit: self.topic(f"/{self.name}_{unit}/online", Bool) for unit in units}
        self.weight = {unit: self.topic(f"/{self.name}_{unit}/weight", Int16) for unit in units}
        return self.driver(f"_maps:=[{','.join(maps)}]" if len(maps) > 1 else f"_map:={maps[0]}")

    @staticmethod
    def on(line):
        return f"serial: {{device: {line.port}, baud: 115200, parity: none}}"

    def reads_and_writes(self, unit):
        for value in (7, -7):
            self.server.set(unit, 4, 5, [value & 0xFFFF])
            self.weight[unit].becomes(value)
        motor = self.publisher(f"/{self.name}_{unit}/motor/write", Bool)
        for value in (True, False):
            def follows(wanted=value):
                motor.publish(wanted)
                return self.server.get(unit, 1, 3) == wanted

            wait_until(follows, f"the motor to be {value}")

    def test_a_unit_on_a_serial_line_is_read_and_written(self):
        self.drive([17], self.on(self.line([17])))
        self.reads_and_writes(17)

    def test_a_unit_is_read_and_written_by_rtu_over_tcp(self):
        self.server = RtuServer([17])
        self.addCleanup(self.server.end)
        self.drive([17], f"address: 127.0.0.1\nport: {self.server.port}\nframing: rtu")
        self.reads_and_writes(17)

    def units_go_on_beside_dead_ones(self, alive, dead):
        self.drive(alive + dead, self.on(self.line(alive)), {unit: "300ms" for unit in dead})
        for unit in alive:
            self.reads_and_writes(unit)
        for unit in dead:
            self.online[unit].wait_for(lambda online: not online)
            self.assertNotIn(True, self.online[unit].values)
            self.assertEqual(self.weight[unit].values, [])
        for unit in alive:
            self.online[unit].becomes(True)

    def test_a_unit_goes_on_beside_a_dead_one(self):
        self.units_go_on_beside_dead_ones([1], [2])

    def test_two_units_go_on_beside_two_dead_ones(self):
        self.units_go_on_beside_dead_ones([1, 3], [2, 4])

    def test_eight_units_go_on_beside_two_dead_ones_and_one_that_comes_alive_joins_them(self):
        self.units_go_on_beside_dead_ones([1, 2, 4, 5, 6, 8, 9, 10], [3, 7])
        self.server.add(7)
        self.online[7].becomes(True)
        for unit in (7, 1, 10):
            self.reads_and_writes(unit)
        self.assertNotIn(True, self.online[3].values)

    def test_a_broadcast_is_written_to_all_units_and_needs_no_answer(self):
        units = [1, 2]
        line = self.line(units)
        self.driver("_map:=" + process.write_map(
            f"name: all\n{self.on(line)}\nunit: 0\nmapping:\n  coils: {{motor: {{address: 3, access: write}}}}\n"))
        self.topic("/all/online", Bool).becomes(True)
        motor = self.publisher("/all/motor/write", Bool)
        for value in (True, False):
            def follow(wanted=value):
                motor.publish(wanted)
                return all(self.server.get(unit, 1, 3) == wanted for unit in units)

            wait_until(follow, f"both motors to be {value}")

    def test_an_adapter_that_is_plugged_in_again_is_found_by_its_name(self):
        line = self.line([17])
        self.drive([17], self.on(line))
        self.reads_and_writes(17)
        line.unplug()
        self.online[17].becomes(False)
        line.plug_in()
        self.online[17].becomes(True)
        self.reads_and_writes(17)


if __name__ == "__main__":
    testing.main()
