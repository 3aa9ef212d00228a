# SPDX-License-Identifier: Apache-2.0
"""The client in Python: which requests it makes, and what it does with the answers."""
import json
import struct
import threading
import unittest

import made
from press import PRESS, OfADevice


class Requests(OfADevice):
    def requests_of(self, call, *arguments):
        self.device.requests.clear()
        call(*arguments)
        return self.device.requests[:]

    def test_a_write_has_the_function_code_that_the_map_asks_for(self):
        press = self.connected()
        for point, value, requests in (
                (press.valve, True, [(5, 0, 1)]), (press.lamps, [True, False, True], [(15, 2, 3)]),
                (press.horn, True, [(15, 5, 1)]),
                (press.speed, 80, [(6, 0, 1)]), (press.total, 1, [(16, 1, 2)]), (press.flag, True, [(3, 3, 1), (6, 3, 1)]),
                (press.part, 1, [(3, 4, 1), (16, 4, 1)]), (press.level, 1, [(6, 5, 1)]),
                (press.sure, 1, [(6, 6, 1), (3, 6, 1)]), (press.batch, 1, [(16, 7, 1)]), (press.label, "a", [(16, 8, 3)])):
            self.assertEqual(self.requests_of(point.write, value), requests, point.spec.name)
        self.assertEqual(self.device.units, {7})

    def test_a_device_with_mask_write_gets_it_for_parts_of_registers(self):
        press = self.connected(PRESS.replace("unit: 7", "unit: 7\nlimits: {mask_write: true}"))
        self.device.tables["holding_registers"][3:5] = [0x8001, 0xAB00]
        self.assertEqual(self.requests_of(press.flag.write, True), [(22, 3, 1)])
        self.assertEqual(self.requests_of(press.part.write, 0xCD), [(22, 4, 1)])
        self.assertEqual(self.device.tables["holding_registers"][3:5], [0x8201, 0xABCD])
        self.assertEqual(self.device.units, {7})

    def test_a_point_is_read_where_it_reads_back(self):
        press = self.connected()
        self.device.tables["holding_registers"][105] = 42
        self.assertEqual(self.requests_of(press.level.read), [(3, 105, 1)])
        self.assertEqual(press.level.read(), 42)

    def test_everything_is_read_by_the_requests_of_the_plan(self):
        joined = PRESS.replace("unit: 7", "discrete_read_continuous: true\nlimits: {read_registers: 5}")
        for text in (PRESS, joined, joined + "unreadable: [{table: coils, from: 1, to: 1}]\n"):
            press = self.connected(text)
            found = self.requests_of(press.read_all)
            plan = json.loads(self.coupler("plan", "cell.yaml", "--json").stdout)["groups"][0]["spans"]
            codes = {"coils": 1, "discrete_inputs": 2, "holding_registers": 3, "input_registers": 4}
            self.assertGreaterEqual(len(found), 5)
            self.assertEqual(found, [(codes[span["table"]], span["from"], span["to"] - span["from"] + 1) for span in plan])

    def test_rates_do_not_part_requests(self):
        at_one_rate = self.requests_of(self.connected().read_all)
        press = self.connected(PRESS.replace("type: UDINT", "type: UDINT, rate: 1"))
        self.assertEqual(self.requests_of(press.read_all), at_one_rate)

    def test_a_request_for_several_points_that_is_rejected_is_made_for_each(self):
        self.device.tables["coils"][0] = 1
        together, asked = self.device.answer, []

        def no_more_than_three(pdu):  # coils 0 to 4 in one request
            asked.append(struct.unpack(">BHH", pdu))
            return b"\x81\x03" if pdu[0] == 1 and pdu[4] > 3 else together(pdu)
        self.device.spoil = no_more_than_three
        joined = PRESS.replace("unit: 7", "unit: 7\ndiscrete_read_continuous: true")
        press = self.connected(joined)
        self.assertIs(press.read_all()["valve"], True)
        asked.clear()
        press.read_all()
        self.assertEqual([request for request in asked if request[0] == 1], [(1, 0, 1), (1, 2, 3)], "it is remembered")

    def test_a_point_that_the_device_does_not_have_is_named(self):
        press = self.connected()
        self.device.unmapped.append(("input_registers", range(0, 2)))
        for call in (press.flow.read, press.read_all):
            self.assertEqual(self.raises("ExceptionReply", call), "flow: exception 02 (illegal data address)")

    def test_an_exception_has_its_code(self):
        press = self.connected()
        self.device.spoil = lambda pdu: bytes([pdu[0] | 0x80, 4])
        with self.assertRaises(self.module.ExceptionReply) as caught:
            press.valve.write(True)
        self.assertEqual((caught.exception.code, str(caught.exception)), (4, "valve: exception 04 (server device failure)"))
        self.assertTrue(press.online)

    def test_a_value_that_does_not_read_back_is_an_error(self):
        press = self.connected()
        self.device.spoil = lambda pdu: pdu if pdu[0] == 6 else self.device.answer(pdu)
        self.assertEqual(self.raises("NotTaken", press.sure.write, 5),
                         "sure: 5 was written and acknowledged, but 0 reads back")

    def test_threads_share_a_client_and_a_register(self):
        press = self.connected(PRESS.replace("    part:", "    side:  {address: 3, type: BOOL, bit: 2}\n    part:"))
        wrong = []

        def toggle(point):
            for i in range(50):
                point.write(i % 2 == 0)
                if point.read() != (i % 2 == 0):
                    wrong.append((point.spec.name, i))
        threads = [threading.Thread(target=toggle, args=(point,)) for point in (press.flag, press.side)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(made.PATIENCE)
        self.assertEqual(wrong, [])
        self.assertEqual(len([1 for request in self.device.requests if request[0] == 6]), 100)
        self.assertEqual(self.device.connections, 1)


if __name__ == "__main__":
    unittest.main(warnings="ignore")
