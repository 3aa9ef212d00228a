# SPDX-License-Identifier: Apache-2.0
"""What becomes of messages on the way to a device: merged, verified, restored, replaced when they fall silent."""
import threading
import time

from std_msgs.msg import Bool, UInt16

from support import process, testing
from support.device import ILLEGAL_FUNCTION, Device, Refuse, frame
from support.patience import NO_TIMEOUT, PATIENCE
from support.peer import Peer
from support.topics import wait_until

COUNT = 8
SINGLE, SEVERAL = 6, 16  # function codes of writes


def several(name, extra=""):
    points = "".join(f"    r{i}: {{address: {i}, type: UINT}}\n" for i in range(COUNT))
    return f"name: {name}\naddress: 127.0.0.1\nrate: 10\ntimeout: {NO_TIMEOUT}s\n{extra}mapping:\n  holding_registers:\n{points}"


def one(name, options="", extra=""):
    return (f"name: {name}\naddress: 127.0.0.1\nrate: 20\ntimeout: {NO_TIMEOUT}s\n{extra}"
            f"mapping:\n  holding_registers:\n    speed: {{address: 5, type: UINT{options}}}\n")


def slow(device, seconds):
    def answer(request):
        time.sleep(seconds)
        return device.serve(request)
    return answer


def registers(device, start, count):
    return list(device.tables["holding_registers"][start:start + count])


class Writes(testing.RosTest):
    at_once = True

    def drive(self, text, port):
        driver = self.driver(f"_map:={process.write_map(text)}", f"_port:={port}", "_verify:=off")
        driver.wait_for("connected")
        return driver

    def speed(self):
        return self.publisher(f"/{self.name}/speed/write", UInt16)

    def test_a_burst_while_the_device_is_busy_becomes_one_request(self):
        with Device() as device:
            self.drive(several(self.name), device.port)
            publishers = self.publishers({f"/{self.name}/r{i}/write": UInt16 for i in range(COUNT)})
            asked, free = threading.Event(), threading.Event()
            free.set()

            def answer(request):
                if not free.is_set():
                    asked.set()
                    free.wait(PATIENCE)
                return device.serve(request)

            def burst(first):
                """The writes that it became."""
                before = len(device.seen(SINGLE, SEVERAL))
                asked.clear()
                free.clear()
                self.assertTrue(asked.wait(PATIENCE))
                for value, publisher in enumerate(publishers):
                    publisher.publish(first + value)
                    time.sleep(0.1)  # each topic has a thread and a connection of its own, and only what comes in order is merged
                free.set()
                wait_until(lambda: registers(device, 0, COUNT) == list(range(first, first + COUNT)), "all values")
                return device.seen(SINGLE, SEVERAL)[before:]

            device.answer = answer
            for first in (100, 200, 300):  # a driver that had no time meanwhile shows nothing
                writes = burst(first)
                if len(writes) < COUNT:
                    break
            self.assertLess(len(writes), COUNT, writes)
            self.assertIn(SEVERAL, [write.function for write in writes])

    def test_a_single_write_to_an_idle_device_is_one_register(self):
        with Device() as device:
            self.drive(one(self.name), device.port)
            self.speed().publish(7)
            wait_until(lambda: registers(device, 5, 1) == [7], "the value")
            self.assertEqual([request.function for request in device.requests if request.function != 3], [SINGLE])

    def test_the_old_value_does_not_flicker_back(self):
        with Device() as device:
            self.drive(one(self.name), device.port)
            topic = self.topic(f"/{self.name}/speed", UInt16)
            publisher = self.speed()
            device.answer = slow(device, 0.05)
            for value in range(1, 6):
                publisher.publish(value)
                wait_until(lambda wanted=value: registers(device, 5, 1) == [wanted], "the value at the device")
                read = len(device.seen(3))
                wait_until(lambda before=read: len(device.seen(3)) > before + 2, "reads that began after it")
            self.assertEqual(topic.values, sorted(topic.values), "a value came back after a newer one")

    def test_a_late_answer_with_an_old_transaction_is_never_taken(self):
        with Device() as device:
            driver = self.drive(one(self.name), device.port)
            topic = self.topic(f"/{self.name}/speed", UInt16)
            topic.wait_for(lambda _: True)
            wrong = bytes([3, 2, 999 >> 8, 999 & 0xFF])
            device.answer = lambda request: frame(request, wrong, transaction=request.transaction - 1)
            driver.wait_for("connection lost")
            device.answer = device.serve
            topic.next()
            self.assertNotIn(999, topic.ever)

    def test_a_value_that_does_not_read_back_is_reported_with_both(self):
        with Device() as device:
            driver = self.drive(one(self.name, ", read_address: 105, verify_write: true"), device.port)
            device.tables["holding_registers"][105] = 3
            self.speed().publish(4)
            driver.wait_for("write to speed: not taken: acknowledged, but 0x0004 was written and 0x0003 reads back")

    def test_a_device_that_refuses_the_function_for_several_gets_single_ones(self):
        with Device() as device:
            def answer(request):
                if request.function == SEVERAL:
                    raise Refuse(ILLEGAL_FUNCTION)
                time.sleep(0.1)
                return device.serve(request)

            device.answer = answer
            self.drive(several(self.name), device.port)
            publishers = self.publishers({f"/{self.name}/r{i}/write": UInt16 for i in range(COUNT)})
            for publisher in publishers:
                publisher.publish(5)
            wait_until(lambda: registers(device, 0, COUNT) == [5] * COUNT, "all values")
            self.assertEqual(device.accepted, 1)

    def test_a_command_that_falls_silent_is_replaced(self):
        with Device() as device:
            driver = self.drive(one(self.name, ", deadman: {timeout: 2s, value: 1}"), device.port)
            self.speed().publish(500)
            driver.wait_for("no message for speed in 2000 ms")
            wait_until(lambda: registers(device, 5, 1) == [1], "the deadman's value")
            self.assertEqual([int.from_bytes(write.data[3:5], "big") for write in device.seen(SINGLE)], [500, 1])

    def test_outputs_are_restored_when_the_device_is_back(self):
        peer = Peer().start()
        self.addCleanup(peer.stop)
        driver = self.drive(one(self.name, extra="on_reconnect: restore\n"), peer.port)
        online = self.topic(f"/{self.name}/online", Bool)
        self.speed().publish(77)
        wait_until(lambda: peer.get("holding_registers", 5) == [77], "the command")
        peer.stop()
        online.wait_for(lambda value: not value)
        peer.set("holding_registers", 5, [0])
        peer.start()
        wait_until(lambda: peer.get("holding_registers", 5) == [77], "the command again")
        driver.wait_for("1 outputs were restored")

    def test_outputs_go_to_their_safe_values_at_the_end(self):
        with Peer() as peer:
            text = (f"name: {self.name}\naddress: 127.0.0.1\non_shutdown: safe\nmapping:\n  coils:\n    lamp: 3\n"
                    "    horn: 4\n")

            def start():
                peer.set("coils", 3, [1, 0])
                return self.drive(text, peer.port)

            driver, code = process.interrupted_in_time(start, lambda _, code: code == 0)
            self.assertEqual(code, 0, driver.output)
            self.assertEqual([int(bit) for bit in peer.get("coils", 3, 2)], [0, 0])


if __name__ == "__main__":
    testing.main()
