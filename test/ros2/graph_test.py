# SPDX-License-Identifier: Apache-2.0
"""What `ros2 node`, `ros2 topic` and `ros2 service` show of a driver, from the moment it starts."""
import unittest

from rcl_interfaces.msg import Log
from std_msgs.msg import Int16

from support import process, testing
from support.parameters import Parameters
from support.patience import NO_TIMEOUT, PATIENCE, once_more
from support.peer import Peer
from support.ports import free_port
from support.ros import polled, wait_for_graph
from support.topics import Subscription, qos, types, wait_until

MAP = """
name: {name}
address: 127.0.0.1
port: {port}
rate: 20
timeout: {timeout}s
mapping:
  coils: {{lamp: 3, lamps: {{address: 10, count: 3}}}}
  holding_registers:
    level: {{address: 4, type: INT, stamped: true}}
    flags: {{address: 5, type: WORD}}
    trim: {{address: 6, type: INT, scale: 0.5, access: read}}
    order: {{address: 7, type: STRING, length: 4, access: write}}
"""
TOPICS = {
    "lamp": "std_msgs/msg/Bool", "lamp/write": "std_msgs/msg/Bool",
    "lamps": "coupler_driver/msg/BoolArray", "lamps/write": "coupler_driver/msg/BoolArray",
    "level": "std_msgs/msg/Int16", "level/write": "std_msgs/msg/Int16",
    "level/sample": "coupler_driver/msg/Int64Sample", "level/stamped": "coupler_driver/msg/Int64Stamped",
    "points": "coupler_driver/msg/Points",
    "flags": "coupler_driver/msg/BoolArray", "flags/write": "coupler_driver/msg/BoolArray",
    "trim": "std_msgs/msg/Float64", "order/write": "std_msgs/msg/String",
    "online": "std_msgs/msg/Bool", "scheduled": "coupler_driver/msg/Scheduled", "status": "coupler_driver/msg/Status",
}
SERVICES = {"write": "coupler_driver/srv/Write", "read": "coupler_driver/srv/Read", "safe": "std_srvs/srv/Trigger",
            "schedule": "coupler_driver/srv/Schedule", "cancel_scheduled": "coupler_driver/srv/CancelScheduled",
    "list_scheduled": "coupler_driver/srv/ListScheduled", "lamp/set": "std_srvs/srv/SetBool"}


class GraphTest(testing.RosTest):
    def map(self, name="shown", port=None):
        return process.write_map(MAP.format(name=name, port=port or free_port(), timeout=NO_TIMEOUT))

    @staticmethod
    def appears(node):
        space, name = node.rsplit("/", 1)
        wait_for_graph(lambda asked: (name, space or "/") in asked.get_node_names_and_namespaces(), node)


class Names(GraphTest):
    def test_topics_and_services_are_those_of_the_map_with_their_types(self):
        self.driver("--map", self.map(), "--ros-args", "-r", "__ns:=/cell")
        wanted = {f"/cell/shown/{name}": [kind] for name, kind in TOPICS.items()}
        wait_until(lambda: set(wanted) <= set(types()), "the topics")
        self.assertEqual({name: kinds for name, kinds in types().items() if name.startswith("/cell/")}, wanted)
        self.assertEqual(types()["/diagnostics"], ["diagnostic_msgs/msg/DiagnosticArray"])
        wanted = {f"/cell/shown/{name}": [kind] for name, kind in SERVICES.items()}

        def services():
            return {name: kinds for name, kinds in polled.get_service_names_and_types() if name.startswith("/cell/shown/")}

        wait_until(lambda: services() == wanted, "the services")

    def test_the_node_has_the_name_of_its_device(self):
        # Each a name of its own: a peer may go on seeing a node that ended at once, if rmw_fastrtps hears of it late.
        for arguments, node in (
                (("--map", self.map("lathe")), "/lathe_driver"),
                (("--ros-args", "-p", f"map:={self.map('valve')}"), "/valve_driver"),
                (("--map", self.map(), "--name", "called"), "/called_driver"),
                (("--map", self.map(), "--ros-args", "-p", "name:=other"), "/other_driver"),
                (("--map", self.map(), "--name", "cell/press"), "/cell_press_driver"),
                (("--map", self.map("cell/belt")), "/cell_belt_driver"),
                (("--maps", f"{self.map()},{self.map('belt')}"), "/shown_driver"),
                (("--maps", f"left={self.map()},right={self.map()}"), "/left_driver"),
                (("--map", self.map(), "--ros-args", "-r", "__node:=io", "-r", "__ns:=/cell"), "/cell/io")):
            with self.subTest(arguments):
                driver = self.driver(*arguments)
                self.appears(node)
                driver.end()

    def test_with_an_address_alone_the_node_is_named_after_it_before_the_device_is_there(self):
        port, other, third = free_port(), free_port(), free_port()
        for arguments, node in (
                (("--address", "127.0.0.1", "--port", port), f"/coupler_127_0_0_1_{port}_driver"),
                (("--address", "localhost", "--port", port, "--unit", 3), f"/localhost_{port}_unit3_driver"),
                (("--map", f"tcp://127.0.0.1:{other}"), f"/coupler_127_0_0_1_{other}_driver"),
                (("--ros-args", "-p", "address:=127.0.0.1", "-p", f"port:={third}"), f"/coupler_127_0_0_1_{third}_driver"),
                (("--address", "127.0.0.1", "--port", port, "--name", "press"), "/press_driver"),
                (("--address", "127.0.0.1", "--port", port, "--ros-args", "-r", "__node:=io"), "/io")):
            with self.subTest(arguments):
                driver = self.driver(*arguments)
                self.appears(node)
                driver.end()


class Waiting(GraphTest):
    def test_while_the_device_is_awaited_the_node_answers_and_ends_when_it_is_asked_to(self):
        rosout = Subscription("/rosout", Log, qos(1000, latched=True))
        self.addCleanup(rosout.close)
        port = free_port()
        driver = self.driver("--address", "127.0.0.1", "--port", port)
        node = f"/coupler_127_0_0_1_{port}_driver"
        self.appears(node)
        line = rosout.wait_for(lambda log: f"waiting for the map of 127.0.0.1 port {port}" in log.msg)
        self.assertEqual(line.name, node[1:])
        parameters = Parameters(node)
        self.assertEqual(parameters.get("address", "port"), ["127.0.0.1", port])
        self.assertIn("rate", parameters.list().names)
        wait_until(lambda: polled.get_publishers_info_by_topic("/diagnostics"), "the diagnostics")
        self.assertEqual(driver.interrupt(), 0, driver.output)

    @unittest.skipUnless(process.has_node(), "coupler-node was not built")
    def test_when_the_device_comes_its_points_appear_in_the_same_node(self):
        port = free_port()
        driver = self.driver("--address", "127.0.0.1", "--port", port)
        node = f"coupler_127_0_0_1_{port}_driver"
        driver.wait_for("waiting for the map of 127.0.0.1")
        served = process.Node(process.write_map("name: press\nmapping:\n  holding_registers: {speed: {address: 7, type: INT}}\n"), port=port)
        self.addCleanup(served.end)
        self.topic("/press/speed", Int16).wait_for(lambda value: value == 0)
        wait_for_graph(lambda asked: [info.node_name for info in asked.get_publishers_info_by_topic("/press/speed")] == [node],
                       "its node")
        self.assertEqual(Parameters(f"/{node}").get("name", "port"), ["press", port])


class Rivals(GraphTest):
    def test_two_drivers_of_one_device_notice_each_other(self):
        peer = Peer().start()
        self.addCleanup(peer.stop)
        one = self.driver("--map", self.map(port=peer.port))
        one.wait_for("connected")
        notice = "also publishes /shown/online: two drivers write to the same device"
        others = []

        def start_other():
            for other in others:
                other.end()
            others.append(self.driver("--map", self.map(port=peer.port), "--ros-args", "-r", "__node:=other"))
            others[-1].wait_for(f"/shown_driver {notice}", PATIENCE / 2)

        once_more(start_other)  # Fast DDS may give a participant no names of others (wait_for_graph)
        one.wait_for(f"/other {notice}")
        self.appears("/other")
        self.assertLessEqual(one.output.count("/other also publishes /shown/online"), len(others))

    def test_two_drivers_of_one_name_notice_each_other(self):
        peer = Peer().start()
        self.addCleanup(peer.stop)
        for driver in [self.driver("--map", self.map(port=peer.port)) for _ in range(2)]:
            driver.wait_for("also publishes /shown/online: two drivers write to the same device")

    def test_drivers_of_other_names_do_not(self):
        drivers = [self.driver("--map", self.map(name)) for name in ("left", "right", "rival")]
        self.driver("--map", self.map("rival"), "--ros-args", "-r", "__node:=second").wait_for("also publishes /rival/online")
        for driver in drivers[:2]:
            self.assertNotIn("publishes", driver.output)


if __name__ == "__main__":
    testing.main()
