# SPDX-License-Identifier: Apache-2.0
"""Serial lines that are slow, damage what they carry, double it, bring it late or hand it back, with pymodbus at the other
end. Two registers count up, far from one another, and are read by requests that are alike but for the address: the reply
to another request shows by its value, an old one by its place."""
import random

from coupler_driver.srv import Write
from std_msgs.msg import Bool, Int16, UInt16

from support import process, testing
from support.latest import LatestDiagnostics, values
from support.patience import NO_TIMEOUT
from support.rtu_server import RtuServer
from support.serial_line import SerialLine
from support.topics import wait_until

MAP = """
name: {name}
serial: {{device: {port}, baud: {baud}, parity: none}}
unit: {unit}
rate: 10
timeout: {timeout}s
mapping:
  input_registers: {{low: {{address: 5, type: UINT}}, high: {{address: 60, type: UINT}}}}
  holding_registers: {{goal: {{address: 6, type: INT}}}}
"""
LOW, HIGH, GOAL = 1000, 30000, 100  # where they begin to count
INPUTS, HOLDING, WRITE = 4, 3, 6  # function codes
TIMEOUT = 1  # seconds. A machine that is busy for twice as long makes a reply late that nobody held back
SEED = 20


class Unit:
    """One unit of a line, and its topics."""

    def __init__(self, test, name, line, server, number):
        self.test, self.name, self.line, self.server, self.number = test, name, line, server, number
        self.write = None  # a publisher, once there is a driver
        self.counted = 0
        self.goal = GOAL
        self.set()
        self.online = test.topic(f"/{name}/online", Bool)
        self.topics = {LOW: test.topic(f"/{name}/low", UInt16), HIGH: test.topic(f"/{name}/high", UInt16)}

    def map(self, timeout):
        return process.write_map(MAP.format(name=self.name, port=self.line.port, baud=self.line.baud, unit=self.number,
                                            timeout=timeout))

    def set(self):
        for first, address in ((LOW, 5), (HIGH, 60)):
            self.server.set(self.number, INPUTS, address, [first + self.counted])

    def live(self):
        """What it counts goes on, and is written to, each time that the driver has seen the last of it."""
        if not all(topic.values and topic.values[-1] == first + self.counted for first, topic in self.topics.items()):
            return
        self.counted += 1
        self.set()
        if self.server.get(self.number, HOLDING, 6) == self.goal:
            self.goal += 1
        self.write.publish(self.goal)

    def check(self):
        for first, topic in self.topics.items():
            seen = list(topic.ever)
            wrong = [pair for pair in zip(seen, seen[1:]) if pair[0] > pair[1]]
            self.test.assertEqual(wrong, [], f"{topic.name}: a value is not that of this register, or an old one")
            self.test.assertGreaterEqual(seen[0], first, topic.name)
            self.test.assertLessEqual(seen[-1], first + self.counted, topic.name)
        for function, address, values in self.server.units[self.number].written:
            self.test.assertEqual((function, address), (WRITE, 6))
            self.test.assertTrue(GOAL <= values[0] <= self.goal, f"{self.name}: {values} was written")


class Fault:
    """Happens to one of one to six frames, by chance."""

    def __init__(self, happen, seed):
        self.happened = 0
        self._happen = happen
        self._random = random.Random(seed)
        self._pass = self._some()

    def _some(self):
        return self._random.randrange(6)

    def __call__(self, frame):
        if self._pass:
            self._pass -= 1
            return frame
        self._pass = self._some()
        self.happened += 1
        return self._happen(self._random, frame)


# What happens to a reply …
def flip(chance, frame):
    """One to three bits, which a CRC of 16 bits always tells."""
    bits = int.from_bytes(frame, "big")
    for bit in chance.sample(range(8 * len(frame)), chance.randint(1, 3)):
        bits ^= 1 << bit
    return bits.to_bytes(len(frame), "big")


def cut(chance, frame):
    begin = chance.randrange(len(frame))
    return frame[:begin] + frame[chance.randint(begin + 1, len(frame)):]


def add_noise(chance, frame):
    return bytes(chance.randrange(256) for _ in range(chance.randint(1, 4))) + frame


def double(_, frame):
    """Without silence between them."""
    return frame + frame


# … and to a request: never so that pymodbus sees the beginning of a long frame. It would wait for its end whatever the
# silence, and swallow what comes.
def flip_request(chance, frame):
    return frame[:2] + flip(chance, frame[2:])


def cut_request(chance, frame):
    return frame[:chance.randrange(1, len(frame))]


def add_noise_to_request(chance, frame):
    return bytes(chance.choice((0x00, 0xFF)) for _ in range(chance.randint(1, 4))) + frame


def double_write(_, frame):
    """The second reply to a read may come as late as it likes: nothing tells it from that to the next."""
    return frame + frame if frame[1] == WRITE else frame


class SerialFaults(testing.RosTest):
    at_once = True

    def line(self, name, numbers=(17,), baud=115200, **options):
        """A line with its units, the name of the first of which is this."""
        line = SerialLine(baud, **options)
        self.addCleanup(line.end)
        server = RtuServer(numbers, line.device)
        self.addCleanup(server.end)
        for number in numbers:
            unit = Unit(self, name if number == numbers[0] else f"{name}{number}", line, server, number)
            self.units[unit.name] = unit
        return line

    def setUp(self):
        self.units = {}

    def drive(self, timeout=TIMEOUT):
        self.driver(f"_maps:=[{','.join(unit.map(timeout) for unit in self.units.values())}]")
        writes = self.publishers({f"/{name}/goal/write": Int16 for name in self.units})
        for unit, write in zip(self.units.values(), writes):
            unit.write = write

    def live_until(self, condition, what):
        def lived():
            for unit in self.units.values():
                unit.live()
            return condition()

        wait_until(lived, what)

    def all_go_on(self, when):
        """Each is read and written several times more."""
        before = {name: (unit.counted + 5, unit.goal + 3) for name, unit in self.units.items()}
        self.live_until(lambda: all(unit.counted >= before[name][0] and unit.goal >= before[name][1]
                                    for name, unit in self.units.items()), f"values and writes {when}")
        for unit in self.units.values():
            with self.subTest(unit.name):
                unit.check()

    def test_at_each_rate_and_by_bursts_of_an_adapter_values_and_writes_arrive(self):
        for baud in (9600, 19200, 115200):
            self.line(f"at{baud}", baud=baud)
            self.line(f"bursts{baud}", baud=baud, latency=0.016)
        self.drive(NO_TIMEOUT)
        self.all_go_on("at each rate")

    def do_no_harm(self, way, kinds):
        """`kinds` of faults: what happens, the rate, and to how many lines. One that costs a timeout each time happens to three
        side by side, and not three times to one."""
        faults = {(happen, baud): [(Fault(happen, SEED + i), self.line(f"{happen.__name__}{i}_{baud}", baud=baud,
                                                                       punctual=baud == 1200)) for i in range(count)]
                  for happen, baud, count in kinds}
        self.drive()
        self.all_go_on("before")
        for lines in faults.values():
            for fault, line in lines:
                setattr(line, way, fault)
        self.live_until(lambda: all(sum(fault.happened for fault, _ in lines) >= 3 for lines in faults.values()),
                        "faults of each kind")
        for lines in faults.values():
            for _, line in lines:
                setattr(line, way, lambda frame: frame)
        self.all_go_on("when the faults have ended")

    def test_replies_that_are_damaged_or_doubled_do_no_harm(self):
        diagnostics = LatestDiagnostics("flip0_115200")
        self.addCleanup(diagnostics.close)
        self.do_no_harm("to_port", ((flip, 115200, 3), (cut, 115200, 3), (add_noise, 19200, 1), (double, 1200, 1),
                                    (double, 115200, 1)))
        diagnostics.wait_for(lambda known: "connection" in known and int(values(known["connection"])["discarded bytes"]) > 0)

    def test_requests_that_are_damaged_or_doubled_do_no_harm(self):
        self.do_no_harm("to_device", ((flip_request, 115200, 3), (cut_request, 19200, 3), (add_noise_to_request, 115200, 3),
                                      (double_write, 115200, 1)))

    def test_a_reply_that_comes_after_its_timeout_is_not_taken_for_the_next(self):
        line = self.line("late", (17, 18))
        self.drive(2 * TIMEOUT)
        for round_ in range(2):
            self.all_go_on(f"in round {round_}")
            for unit in self.units.values():
                unit.online.becomes(True)
            line.hold()
            self.live_until(lambda: any(unit.online.values[-1] is False for unit in self.units.values()), "a timeout")
            line.release()
        self.all_go_on("at the end")

    def test_an_echo_is_neither_a_value_nor_the_confirmation_of_a_write(self):
        lines = [self.line("echo", baud=19200), self.line("late_echo", latency=0.016)]
        begins = self.line("begins")
        for line in lines:
            line.echoes = True
        self.drive()
        self.all_go_on("with an echo")
        for line, name in zip(lines, self.units):
            unit, write = self.units[name], self.service(f"/{name}/write", Write)
            line.to_device = lambda frame: b"" if frame[1] == WRITE else frame
            self.assertFalse(write("goal", str(unit.goal)).success, f"{name}: a write that the device has not got")
            line.to_device = lambda frame: frame
            wait_until(lambda w=write, u=unit: w("goal", str(u.goal)).success, f"{name} to be written")
        self.all_go_on("after writes that were lost")
        begins.echoes = True
        for line in lines:
            line.echoes = False
        self.all_go_on("when the echoes have ended, and one has begun")


if __name__ == "__main__":
    testing.main()
