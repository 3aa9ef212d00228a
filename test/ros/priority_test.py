# SPDX-License-Identifier: Apache-2.0
"""`priority: high` at a server by pymodbus that takes its time: what was published last is on the wire first."""
import threading
import time

from coupler_driver.srv import Write
from pymodbus.datastore import ModbusSequentialDataBlock, ModbusSlaveContext
from std_msgs.msg import Bool, UInt16

from support import in_order, process, testing
from support.patience import NO_TIMEOUT, PATIENCE
from support.peer import READ, Peer
from support.topics import wait_until

LAMP, STOP, SPEED, BRAKE = 0, 10, 0, 10  # two coils, two registers
MAP = f"""
name: slow
address: 127.0.0.1
rate: 20
timeout: {NO_TIMEOUT}s
mapping:
  coils: {{lamp: {LAMP}, stop: {{address: {STOP}, priority: high}}}}
  holding_registers:
    speed: {{address: {SPEED}, type: UINT}}
    brake: {{address: {BRAKE}, type: UINT, priority: high}}
"""


class SlowStore(ModbusSlaveContext):
    """Takes its time for each write; a read can be held back, and all requests with it."""

    def __init__(self):
        super().__init__(zero_mode=True, **{key: ModbusSequentialDataBlock(0, [0] * 65536) for key in ("di", "co", "hr", "ir")})
        self.written = []  # (function, address, value)
        self.seconds = 0
        self.may_go_on = threading.Event()
        self.may_go_on.set()
        self.holds = threading.Event()

    def getValues(self, fc_as_hex, address, count=1):  # pylint: disable=invalid-name
        if fc_as_hex in READ.values() and not self.may_go_on.is_set():
            self.holds.set()
            self.may_go_on.wait(PATIENCE)
        return super().getValues(fc_as_hex, address, count)

    def setValues(self, fc_as_hex, address, values):  # pylint: disable=invalid-name
        time.sleep(self.seconds)
        self.written += [(fc_as_hex, address, int(value)) for value in values]
        super().setValues(fc_as_hex, address, values)


class Priority(testing.RosTest):
    def setUp(self):
        self.peer = Peer()
        self.store = self.peer.store = SlowStore()
        self.peer.start()
        self.addCleanup(self.peer.stop)
        self.addCleanup(self.store.may_go_on.set)
        self.driver(f"_map:={process.write_map(MAP)}", f"_port:={self.peer.port}").wait_for("connected")

    def senders(self, *names):
        kinds = {"lamp": Bool, "stop": Bool, "speed": UInt16, "brake": UInt16}
        return in_order.senders(self, {f"/slow/{name}/write": kinds[name] for name in names})

    def test_its_messages_go_before_all_others_that_wait_and_keep_their_order(self):
        lamp, speed, stop, brake = self.senders("lamp", "speed", "stop", "brake")
        self.store.may_go_on.clear()
        self.assertTrue(self.store.holds.wait(PATIENCE), "a read is in flight")
        for topic, value in ((lamp, True), (lamp, False), (speed, 7), (stop, True), (brake, 3), (stop, False), (brake, 4)):
            in_order.publish(topic, value)
        self.store.may_go_on.set()
        wait_until(lambda: (6, SPEED, 7) in self.store.written, "the last one")
        self.assertEqual(self.store.written, [(5, STOP, 1), (5, STOP, 0), (6, BRAKE, 4),
                                              (5, LAMP, 1), (5, LAMP, 0), (6, SPEED, 7)])

    def test_a_service_that_writes_it_does_not_wait_for_the_others(self):
        lamp, = self.senders("lamp")
        write = self.service("/slow/write", Write)
        self.store.seconds = 0.02
        for i in range(400):
            lamp.publish(i % 2 == 0)
        wait_until(lambda: len(self.store.written) > 3, "the first of them")
        self.assertTrue(write("brake", "3").success)
        self.assertLess(self.store.written.index((6, BRAKE, 3)), 200)


if __name__ == "__main__":
    testing.main()
