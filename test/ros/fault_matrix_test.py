# SPDX-License-Identifier: Apache-2.0
"""What users of Modbus drivers ask for most, row by row (the list and its sources: docs/driver-faults.md, What goes wrong):
each against a device on a raw socket that misbehaves in that way."""
import select
import statistics
import struct
import time

from coupler_driver.msg import PointStatus, Status
from std_msgs.msg import Bool, Int16, Int32, UInt16

from support import process, testing
from support.device import (BUSY, FAILURE, ILLEGAL_ADDRESS, ILLEGAL_FUNCTION, ILLEGAL_VALUE, Device, Raw,
                            Refuse, frame)
from support.patience import NO_TIMEOUT, PATIENCE
from support.topics import connected_publishers, next_message, wait_until

TIMEOUT = 0.5
MAP = """
name: {name}
address: 127.0.0.1
rate: 20
timeout: {timeout}s
"""


class FaultMatrix(testing.RosTest):
    at_once = True

    def setUp(self):
        self.device = Device().start()
        self.addCleanup(self.device.stop)

    def start(self, mapping, *arguments, head="", timeout=NO_TIMEOUT):
        path = process.write_map(f"{MAP.format(name=self.name, timeout=timeout)}{head}mapping:\n{mapping}")
        driver = self.driver(f"_map:={path}", f"_port:={self.device.port}", *arguments)
        self.online = self.topic(f"/{self.name}/online", Bool)
        return driver

    def status_says_offline(self):
        status = next_message(f"/{self.name}/status", Status)
        return (status.online, status.points[0].quality) == (False, PointStatus.OFFLINE)

    LEVEL = "  holding_registers: {level: {address: 4, type: INT}}\n"

    def level_follows(self, topic, value):
        self.device.tables["holding_registers"][4] = value
        topic.wait_for(lambda seen: seen == value)

    # 1. It never reconnects
    def test_01_it_comes_back_after_every_way_to_go(self):
        self.start(self.LEVEL, timeout=TIMEOUT)
        level = self.topic(f"/{self.name}/level", Int16)
        self.level_follows(level, 1)
        ways = {"reset": self.device.drop, "killed": self.device.stop,
                "frozen": lambda: setattr(self.device, "silent", True),
                "gibberish": lambda: setattr(self.device, "answer", lambda request: Raw(b"HTTP/1.0 400 no\r\n\r\n"))}
        for value, (name, go) in enumerate(ways.items(), start=2):
            with self.subTest(name):
                self.online.values.clear()
                go()
                self.online.wait_for(lambda now: not now)
                self.device.answer, self.device.silent = self.device.serve, False
                if name == "killed":
                    self.device.start()
                self.online.becomes(True)
                self.level_follows(level, value)

    # 2. A late reply is taken for the next
    def test_02_a_late_reply_is_never_taken_for_the_next(self):
        late = {"every": 7, "n": 0}

        def answer(request):
            late["n"] += 1
            if late["n"] % late["every"] == 0:
                # The driver has given up: it has closed the connection, or asks the next. The value is a lie by then.
                select.select([request.connection], [], [], PATIENCE)
                return b"\x02" + struct.pack(">h", -1)
            return self.device.serve(request)

        self.device.tables["holding_registers"][4] = 7
        self.start(self.LEVEL, timeout=TIMEOUT)
        level = self.topic(f"/{self.name}/level", Int16)
        level.next()
        self.device.answer = answer
        wait_until(lambda: late["n"] > 25, "several late replies")
        self.assertEqual(set(level.ever), {7}, "a late reply was published")

    def test_02_a_reply_with_an_old_transaction_id_is_never_taken_for_the_answer(self):
        answered = []

        def answer(request):
            answered.append(request)
            stale = frame(request, b"\x03\x02\xFF\xFF", transaction=request.transaction - 1)
            return Raw(stale + frame(request, bytes([request.function]) + self.device.serve(request)))

        self.device.tables["holding_registers"][4] = 7
        self.start(self.LEVEL)
        level = self.topic(f"/{self.name}/level", Int16)
        level.wait_for(lambda value: value == 7)
        self.device.answer = answer
        wait_until(lambda: len(answered) >= 4, "several old replies")
        self.device.answer = self.device.serve
        self.level_follows(level, 8)
        self.assertEqual(set(level.ever), {7, 8}, "an old reply was published")

    # 3. A batched read hits an illegal address and everything fails
    def test_03_a_refused_address_costs_its_own_point_only_and_is_remembered(self):
        def answer(request):
            if request.address <= 9 < request.address + request.count:
                raise Refuse(ILLEGAL_ADDRESS)
            return self.device.serve(request)

        self.device.answer = answer
        points = "".join(f"    p{i}: {{address: {i}, type: INT}}\n" for i in range(20))
        for i in range(20):
            self.device.tables["input_registers"][i] = 100 + i
        driver = self.start("  input_registers:\n" + points)
        driver.wait_for("p9")
        for i in (0, 8, 10, 19):
            self.assertEqual(self.topic(f"/{self.name}/p{i}", Int16).next(), 100 + i)
        asked = len(self.device.requests)
        wait_until(lambda: len(self.device.requests) > asked + 40, "several cycles")
        late = self.device.requests[asked:]
        self.assertFalse([r for r in late if r.address <= 9 < r.address + r.count], "the hole was asked for again")
        self.assertLessEqual(len({(r.address, r.count) for r in late}), 6, "of 19 points")

    # 4. The device takes fewer than 125 registers
    def test_04_a_limit_is_kept_where_the_map_says_it(self):
        points = "".join(f"    p{i}: {{address: {i}, type: INT}}\n" for i in range(100))
        self.start("  input_registers:\n" + points, head="limits: {read_registers: 30}\n")
        self.topic(f"/{self.name}/p99", Int16).next()
        self.assertLessEqual(max(request.count for request in self.device.requests), 30)

    def test_04_a_limit_that_the_map_does_not_say_is_found(self):
        def answer(request):
            if request.count > 30:
                raise Refuse(ILLEGAL_VALUE)
            return self.device.serve(request)

        self.device.answer = answer
        points = "".join(f"    p{i}: {{address: {i}, type: INT}}\n" for i in range(100))
        self.start("  input_registers:\n" + points)
        for i in (0, 50, 99):
            self.topic(f"/{self.name}/p{i}", Int16).next()

    # 5. Too many small reads, and holes that must not be read
    def test_05_points_are_read_together_and_holes_only_where_the_map_allows_it(self):
        points = "".join(f"    p{i}: {{address: {2 * i}, type: INT}}\n" for i in range(50))
        for allowed, requests in ((True, 1), (False, 50)):
            with self.subTest(holes=allowed):
                self.device.stop()
                self.setUp()  # a device that nobody has asked for anything
                driver = self.start("  input_registers:\n" + points,
                                    head=f"registers_read_continuous: {str(allowed).lower()}\n")
                last = self.topic(f"/{self.name}/p49", Int16)
                last.next()
                self.assertEqual(len({(r.address, r.count) for r in self.device.requests}), requests)
                driver.end()
                last.close()  # what is still under way is not the next driver's

    # 6. Stale looks fresh
    def test_06_nothing_old_is_published_while_the_device_is_silent(self):
        self.start(self.LEVEL, timeout=TIMEOUT)
        level = self.topic(f"/{self.name}/level", Int16)
        self.level_follows(level, 5)
        self.device.silent = True
        self.online.becomes(False)
        wait_until(self.status_says_offline, "the status")
        level.stays_quiet()

    # 7. Writes starve behind polls
    def test_07_a_write_waits_for_one_transaction_not_for_a_cycle(self):
        def answer(request):
            if request.function <= 4:
                time.sleep(0.2)
            return self.device.serve(request)

        self.device.answer = answer
        points = "".join(f"    p{i}: {{address: {100 * i}, type: INT}}\n" for i in range(30))
        self.start("  input_registers:\n" + points + "  coils: {lamp: 3}\n")
        lamp = self.publisher(f"/{self.name}/lamp/write", Bool)
        self.online.becomes(True)
        wait_until(lambda: len(self.device.requests) > 3, "polling")
        reads = []
        for number in range(1, 6):
            before = len(self.device.requests)
            lamp.publish(bool(number % 2))
            wait_until(lambda n=number: len(self.device.seen(5, 15)) == n, "the write")
            reads.append(self.device.requests.index(self.device.seen(5, 15)[-1]) - before)
        # Of several: how long a message is under way, and how many requests pass meanwhile, is the machine's affair.
        self.assertLessEqual(statistics.median(reads), 2, f"a cycle has 31 requests: {reads}")

    # 8. After a write the old value flickers back
    def test_08_what_was_read_before_a_write_does_not_come_after_it(self):
        def answer(request):
            reply = self.device.serve(request)
            if request.function == 3:
                time.sleep(0.05)  # the reply tells how it was at the beginning
            return reply

        self.device.answer = answer
        self.start(self.LEVEL, "_rate:=100")
        level = self.topic(f"/{self.name}/level", Int16)
        write = self.publisher(f"/{self.name}/level/write", Int16)
        level.next()
        for value in range(1, 40):
            write.publish(value)
            time.sleep(0.03)
        level.wait_for(lambda value: value == 39)
        read = len(self.device.seen(3))
        wait_until(lambda: len(self.device.seen(3)) > read + 10, "ten more reads")
        self.assertEqual(level.values, sorted(level.values), "an older value came after a newer one")

    # 9. One dead unit blocks the gateway
    def test_09_a_unit_that_is_away_costs_the_others_neither_values_nor_connection(self):
        self.device.away = {2}
        maps = [process.write_map(f"{MAP.format(name=f'unit{unit}', timeout=NO_TIMEOUT)}port: {self.device.port}\nunit: {unit}\n"
                                  f"mapping:\n{self.LEVEL}") for unit in (1, 2, 3)]
        self.driver(f"_maps:=[{','.join(maps)}]")
        levels = {unit: self.topic(f"/unit{unit}/level", Int16) for unit in (1, 3)}
        for unit, level in levels.items():
            self.level_follows(level, 10 + unit)
        away = self.topic("/unit2/online", Bool)
        away.wait_for(lambda online: not online)

        def asked(unit):
            return len([request for request in self.device.requests if request.unit == unit])

        wait_until(lambda: asked(1) >= 40, "two seconds of requests")
        self.assertLess(asked(2), asked(1) / 2, "it is asked less and less often")
        self.device.away = set()
        away.wait_for(lambda online: online)
        self.assertEqual(self.device.accepted, 1, "one connection for all of them")

    # 10. Pauses after connecting and between requests
    def test_10_the_device_has_the_pauses_that_the_map_says(self):
        points = "".join(f"    p{i}: {{address: {100 * i}, type: INT}}\n" for i in range(5))
        self.start("  input_registers:\n" + points, "_verify:=off",
                   head="limits: {request_gap: 30ms, connect_delay: 300ms}\n")
        wait_until(lambda: len(self.device.requests) > 10, "two cycles")
        times = [request.at for request in self.device.requests]
        self.assertGreaterEqual(min(b - a for a, b in zip(times, times[1:])), 0.028)

    # 11. Only one connection is allowed
    def test_11_a_device_with_one_connection_gets_it_back_each_time(self):
        self.device.stop()
        self.device = Device(port=self.device.port, connections=1).start()
        self.addCleanup(self.device.stop)
        self.start(self.LEVEL)
        level = self.topic(f"/{self.name}/level", Int16)
        for value in range(1, 4):
            self.level_follows(level, value)
            self.device.drop()
        self.level_follows(level, 9)

    # 12. Word order
    def test_12_each_point_may_have_its_own_order(self):
        self.device.tables["input_registers"][:2] = [0x1234, 0x5678]
        orders = {"ABCD": 0x12345678, "CDAB": 0x56781234, "BADC": 0x34127856, "DCBA": 0x78563412}
        points = "".join(f"    {order.lower()}: {{address: 0, type: DINT, order: {order}}}\n" for order in orders)
        self.start("  input_registers:\n" + points)
        for order, value in orders.items():
            self.assertEqual(self.topic(f"/{self.name}/{order.lower()}", Int32).next(), value)

    # 13. Address base
    def test_13_the_manuals_numbers_and_the_wires_mean_what_the_map_says(self):
        self.device.tables["holding_registers"][:2] = [11, 22]
        for head, number in (("", 1), ("addressing: modicon\n", 40002), ("addressing: modicon\n", 2)):
            with self.subTest(head, number=number):
                driver = self.start(f"  holding_registers: {{level: {{address: {number}, type: INT}}}}\n", head=head)
                level = self.topic(f"/{self.name}/level", Int16)
                self.assertEqual(level.next(), 22)
                driver.end()
                level.close()

    # 14. FC 06 or FC 16 is refused
    def test_14_a_device_without_fc_6_or_without_fc_16_is_written_as_the_map_says(self):
        for refused, said in ((6, "multiple"), (16, "single")):
            with self.subTest(without=refused):
                def answer(request, refused=refused):
                    if request.function == refused:
                        raise Refuse(ILLEGAL_FUNCTION)
                    return self.device.serve(request)

                self.device.answer = answer
                driver = self.start(f"  holding_registers: {{level: {{address: 4, type: INT, write_function: {said}}}}}\n")
                driver.wait_for("connected")
                write = connected_publishers({f"/{self.name}/level/write": Int16})[0]
                write.publish(100 + refused)
                wait_until(lambda r=refused: self.device.tables["holding_registers"][4] == 100 + r, "the write")
                write.unregister()
                driver.end()

    # 15. Bits in registers
    def test_15_a_bit_of_a_register_is_read_and_written_and_its_neighbours_stay(self):
        self.device.tables["holding_registers"][7] = 0xA5A5
        self.start("  holding_registers: {fault: {address: 7, type: BOOL, bit: 5}, "
                   "ready: {address: 7, type: BOOL, bit: 6}, word: {address: 7, type: UINT, access: read}}\n")
        self.assertTrue(self.topic(f"/{self.name}/fault", Bool).next())
        self.assertFalse(self.topic(f"/{self.name}/ready", Bool).next())
        self.publisher(f"/{self.name}/ready/write", Bool).publish(True)
        self.topic(f"/{self.name}/word", UInt16).wait_for(lambda value: value == 0xA5E5)

    # Every exception code
    def test_every_exception_code_is_said_and_the_link_stays(self):
        codes = (ILLEGAL_FUNCTION, ILLEGAL_ADDRESS, ILLEGAL_VALUE, FAILURE, 5, BUSY, 8, 0x0A, 0x0B)

        def answer(request):
            if request.function == 5:
                raise Refuse(request.unit)  # each unit with its number
            return self.device.serve(request)

        self.device.answer = answer
        names = {code: f"{self.name}_{code}" for code in codes}
        maps = [process.write_map(f"{MAP.format(name=name, timeout=NO_TIMEOUT)}port: {self.device.port}\nunit: {code}\n"
                                  f"mapping:\n{self.LEVEL}  coils: {{lamp: 3}}\n") for code, name in names.items()]
        driver = self.driver(f"_maps:=[{','.join(maps)}]")
        levels = {code: self.topic(f"/{name}/level", Int16) for code, name in names.items()}
        lamps = self.publishers({f"/{name}/lamp/write": Bool for name in names.values()})
        for level in levels.values():
            self.level_follows(level, 1)
        for lamp in lamps:
            lamp.publish(True)
        for code in codes:
            with self.subTest(code=code):
                driver.wait_for(f"exception {code:02X}")
                self.level_follows(levels[code], 100 + code)
        self.assertEqual(self.device.accepted, 1, "an exception is no reason to close the connection")


if __name__ == "__main__":
    testing.main()
