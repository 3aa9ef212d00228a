# SPDX-License-Identifier: Apache-2.0
"""A node tells its changes: the driver hears of them, however seldom it polls."""
import time
import unittest

from pymodbus.client import ModbusTcpClient
from std_msgs.msg import Bool

from support import process, testing
from support.device import ILLEGAL_FUNCTION, NO_RESPONSE
from support.gateway import Gateway
from support.patience import PATIENCE, QUIET
from support.ports import free_port

# At this rate it is polled again after the test is over.
SELDOM = 0.001

MAP = """
name: {name}
address: 127.0.0.1
rate: {rate}
timeout: {timeout}
defaults: {{publish: on_change}}
mapping:
  coils: {{lamp: 4}}
  discrete_inputs: {{lit: 7, dark: 8, beat: 9}}
sim:
  - {{from: lamp, to: lit}}
  - {{from: lamp, to: dark, invert: true}}
"""
WAVE = "  - {to: beat, square: 400ms}\n"
IN_ONE_REPLY = 18
REQUESTS = 0xFF00 + 15  # of the node's statistics


@unittest.skipUnless(process.has_node(), "coupler-node was not built")
class Changes(testing.RosTest):
    at_once = True

    def begin(self, rate=SELDOM, timeout=60, wires="", before_node=lambda port: port):
        """`before_node` returns the port of something between the driver and the node."""
        self.map = process.write_map(MAP.format(name=self.name, rate=rate, timeout=timeout) + wires)
        self.node = process.Node(self.map, port=free_port())
        self.addCleanup(lambda: self.node.end())  # pylint: disable=unnecessary-lambda
        self.port = self.node.port
        self.process = self.driver(f"_map:={self.map}", f"_port:={before_node(self.port)}")
        self.process.wait_for("connected")
        self.lamp = self.topic(f"/{self.name}/lamp", Bool)
        self.lamp.becomes(False)

    def another_client(self):
        return ModbusTcpClient("127.0.0.1", port=self.port, timeout=PATIENCE)

    def set_lamp(self, level):
        """By another client."""
        with self.another_client() as client:
            self.assertFalse(client.write_coil(4, level).isError())

    def requests(self):
        with self.another_client() as client:
            high, low = client.read_input_registers(REQUESTS, 2).registers
        return high << 16 | low

    def test_what_another_client_changes_is_heard_of_though_nothing_polls(self):
        self.begin()
        for level in (True, False, True):
            self.set_lamp(level)
            self.lamp.becomes(level)

    def test_inputs_that_change_are_heard_of(self):
        self.begin()
        lit, dark = self.topic(f"/{self.name}/lit", Bool), self.topic(f"/{self.name}/dark", Bool)
        lit.becomes(False)
        dark.becomes(True)
        for level in (True, False, True):
            self.set_lamp(level)
            lit.becomes(level)
            dark.becomes(not level)

    def test_a_wave_is_heard_of_edge_by_edge(self):
        self.begin(wires=WAVE)
        beat = self.topic(f"/{self.name}/beat", Bool)
        beat.wait_for(lambda _: len(beat.values) >= 9)
        seen = beat.values[1:9]  # the first is that of the new subscriber, perhaps with an edge before it
        self.assertEqual(seen, [seen[0], not seen[0]] * 4)

    def test_a_burst_of_changes_comes_whole(self):
        self.begin()
        levels = [number % 2 == 0 for number in range(1 + IN_ONE_REPLY)]  # the first ends the wait, and comes alone
        with self.process.frozen(), self.another_client() as client:
            for level in levels:
                self.assertFalse(client.write_coil(4, level).isError())
        self.lamp.wait_for(lambda _: self.lamp.values[-len(levels):] == levels)

    def begin_behind_gateway(self, refuses_with):
        gateways = []

        def before(port):
            gateways.append(Gateway(port, refuses_with))
            self.addCleanup(gateways[0].stop)
            return gateways[0].port

        self.begin(rate=20, before_node=before)
        self.process.wait_for("polled while this connection lasts")
        return gateways[0]

    def expect_polled(self, gateway):
        accepted, waits = gateway.accepted, gateway.waits
        for level in (True, False, True):
            self.set_lamp(level)
            self.lamp.becomes(level)
        self.publisher(f"/{self.name}/lamp/write", Bool).publish(False)
        self.lamp.becomes(False)
        self.assertEqual((gateway.accepted, gateway.waits), (accepted, waits))

    def test_behind_a_gateway_that_does_not_know_waits_everything_is_polled(self):
        gateway = self.begin_behind_gateway(ILLEGAL_FUNCTION)
        self.expect_polled(gateway)
        self.assertEqual((gateway.accepted, gateway.waits), (1, 1))

    def test_behind_a_gateway_that_does_not_wait_so_long_everything_is_polled(self):
        gateway = self.begin_behind_gateway(NO_RESPONSE)
        self.expect_polled(gateway)
        self.assertEqual((gateway.accepted, gateway.waits), (1, 1))

    def test_behind_a_gateway_that_drops_waits_everything_is_polled_from_the_third_connection_on(self):
        gateway = self.begin_behind_gateway(None)
        self.expect_polled(gateway)
        self.assertEqual((gateway.accepted, gateway.waits), (3, 2))

    def test_an_idle_node_is_hardly_asked(self):
        self.begin(rate=100)
        begun, before = time.monotonic(), self.requests()
        time.sleep(QUIET)
        asked, passed = self.requests() - before, time.monotonic() - begun
        self.assertLess(asked, 5 + 2 * passed)  # a hundred a second, if it was polled

    def test_a_write_is_heard_of(self):
        self.begin()
        self.publisher(f"/{self.name}/lamp/write", Bool).publish(True)
        self.lamp.becomes(True)

    def test_a_node_that_was_started_anew_is_heard_of_again(self):
        self.begin()
        online = self.topic(f"/{self.name}/online", Bool)
        self.node.end()
        online.becomes(False)
        self.node = process.Node(self.map, port=self.port)
        online.becomes(True)
        self.set_lamp(True)
        self.lamp.becomes(True)

    def test_after_a_reload_changes_are_heard_of_and_nothing_is_lost(self):
        self.begin()
        self.node.reload()
        self.set_lamp(True)
        self.lamp.becomes(True)
        self.node.wait_for("read the map again")  # or else both are written before it
        self.set_lamp(False)
        self.lamp.becomes(False)

    def test_a_node_that_hangs_is_offline_until_its_supervisor_has_replaced_what_serves(self):
        self.begin(timeout=1)
        online = self.topic(f"/{self.name}/online", Bool)
        online.becomes(True)
        online.values.clear()
        self.node.hang()
        online.wait_for(lambda is_online: not is_online)  # perhaps not for long
        online.becomes(True)
        self.set_lamp(True)
        self.lamp.becomes(True)

    def test_a_new_subscriber_gets_a_value(self):
        self.begin()
        self.set_lamp(True)
        self.lamp.becomes(True)
        self.lamp.close()
        self.lamp = self.topic(f"/{self.name}/lamp", Bool)
        self.lamp.becomes(True)


if __name__ == "__main__":
    testing.main()
