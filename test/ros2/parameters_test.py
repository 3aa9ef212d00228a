# SPDX-License-Identifier: Apache-2.0
"""The settings are parameters as any node has them: listed, described, read, and not changed behind the driver's back."""
from coupler_driver.msg import Status
from rcl_interfaces.msg import ParameterEvent
from type_description_interfaces.srv import GetTypeDescription

from support import process, testing
from support.parameters import (BOOL, REAL, SERVICES, TEXT, TEXTS, UNSET, WHOLE, Parameters, parameter, value_of)
from support.peer import Peer
from support.ports import free_port
from support.ros import polled, wait_for_graph
from support.topics import Subscription, qos, wait_until

MAP = """
name: {name}
address: 127.0.0.1
port: {port}
rate: 25
timeout: 60
mapping:
  holding_registers: {{level: {{address: 4, type: INT}}}}
"""
SETTINGS = {"map": TEXT, "maps": TEXTS, "name": TEXT, "address": TEXT, "port": WHOLE, "unit": WHOLE,
            "framing": TEXT, "serial": TEXT, "baud": WHOLE, "parity": TEXT, "stop_bits": WHOLE, "rs485": TEXT,
            "certificate": TEXT, "key": TEXT, "ca": TEXT, "tls_name": TEXT, "pin": TEXT, "rate": REAL,
            "timeout": REAL, "verify": TEXT, "poll": TEXT, "topics": TEXTS, "record": TEXT, "panel": WHOLE, "use_sim_time": BOOL}
OF_A_DEVICE = [name for name in SETTINGS if name not in ("map", "maps", "use_sim_time")]


class ParametersTest(testing.RosTest):
    def setUp(self):
        self.peer = Peer().start()
        self.addCleanup(self.peer.stop)
        self.parameters = Parameters("/given_driver")

    def start(self, *arguments, port=None):
        self.map = process.write_map(MAP.format(name="given", port=port or self.peer.port))
        program = self.driver("--map", self.map, *arguments)
        program.wait_for("connected")
        wait_for_graph(lambda node: "given_driver" in node.get_node_names(), "the node")
        return program


class Declared(ParametersTest):
    def test_the_services_and_the_topic_of_events_are_those_of_every_node(self):
        self.start()
        wanted = {f"/given_driver/{name}": [f"rcl_interfaces/srv/{kind.__name__}"] for name, kind in SERVICES.items()}
        wanted["/given_driver/get_type_description"] = ["type_description_interfaces/srv/GetTypeDescription"]

        wait_for_graph(lambda node: wanted.items() <= dict(node.get_service_names_and_types_by_node("given_driver", "/")).items(),
                       "the services")
        wanted = {"/parameter_events": ["rcl_interfaces/msg/ParameterEvent"], "/rosout": ["rcl_interfaces/msg/Log"]}
        wait_for_graph(lambda node: wanted.items() <= dict(node.get_publisher_names_and_types_by_node("given_driver", "/")).items(),
                       "the topics")

    def test_each_setting_is_listed_and_described_with_its_own_type(self):
        self.start()
        listed = self.parameters.list()
        self.assertLessEqual(set(SETTINGS), set(listed.names))
        self.assertEqual(list(listed.prefixes), [])
        for name, descriptor in zip(SETTINGS, self.parameters.describe(*SETTINGS)):
            with self.subTest(name):
                self.assertEqual((descriptor.name, descriptor.type), (name, SETTINGS[name]))
                self.assertTrue(descriptor.description)
                self.assertEqual(descriptor.read_only, name != "use_sim_time")
                self.assertFalse(descriptor.dynamic_typing)

    def test_ranges_are_those_that_it_takes(self):
        self.start()
        port, unit, rate, timeout = self.parameters.describe("port", "unit", "rate", "timeout")
        self.assertEqual([(one.integer_range[0].from_value, one.integer_range[0].to_value) for one in (port, unit)],
                         [(1, 65535), (0, 255)])
        for one in (rate, timeout):
            self.assertLess(0, one.floating_point_range[0].from_value)
            self.assertLess(one.floating_point_range[0].from_value, one.floating_point_range[0].to_value)

    def test_values_are_those_that_it_drives_with_wherever_they_come_from(self):
        self.start("--rate", "50", "--ros-args", "-p", "verify:=off", "-p", "timeout:=70s")
        self.assertEqual(self.parameters.get("map", "name", "address", "port", "unit"),
                         [self.map, "given", "127.0.0.1", self.peer.port, 1])
        self.assertEqual(self.parameters.get("rate", "timeout", "verify", "poll", "use_sim_time"),
                         [50.0, 70.0, "off", "all", False])
        self.assertEqual(self.parameters.types("rate", "timeout", "port", "maps", "nothing"), [REAL, REAL, WHOLE, UNSET, UNSET])

    def test_what_nobody_has_declared_is_unset(self):
        self.start()
        self.assertEqual(self.parameters.get("maps", "rate", "nothing"), [None, 25.0, None])
        self.assertEqual(list(self.parameters.describe("rate", "nothing")), [])

    def test_a_setting_of_one_device_of_several_stands_below_its_name(self):
        maps = [process.write_map(MAP.format(name=name, port=port)) for name, port in (("given", self.peer.port), ("belt", free_port()))]
        self.driver("--maps", ",".join(maps), "--topics", "lev*,l?vel", "--ros-args", "-p", f"belt.port:={self.peer.port}").wait_for(
            "belt: connected")
        listed = self.parameters.list()
        wanted = {f"{device}.{name}" for device in ("given", "belt") for name in OF_A_DEVICE}
        self.assertLessEqual(wanted, set(listed.names))
        self.assertEqual(set(listed.prefixes), {"given", "belt"})
        self.assertEqual(set(self.parameters.list("belt").names), {name for name in wanted if name.startswith("belt.")})
        self.assertNotIn("belt.port", self.parameters.list(depth=1).names)
        self.assertEqual(self.parameters.get("belt.port", "given.address", "maps", "belt.topics"),
                         [self.peer.port, "127.0.0.1", maps, ["lev*", "l?vel"]])
        descriptor = self.parameters.describe("belt.port")[0]
        self.assertEqual((descriptor.type, descriptor.read_only, descriptor.integer_range[0].to_value), (WHOLE, True, 65535))

    def test_types_of_messages_are_told(self):
        self.start()
        status = Subscription("/given/status", Status)
        self.addCleanup(status.close)
        status.wait_for(lambda message: message.online)  # the latched one may be from before the connection
        wait_until(lambda: polled.get_publishers_info_by_topic("/given/status"), "its publisher")
        info = polled.get_publishers_info_by_topic("/given/status")[0]
        known = self.service("/given_driver/get_type_description", GetTypeDescription)(
            info.topic_type, str(info.topic_type_hash), True)
        self.assertTrue(known.successful, known.failure_reason)
        self.assertEqual(known.type_description.type_description.type_name, "coupler_driver/msg/Status")


class Changed(ParametersTest):
    def refused(self, results, name):
        for result in results:
            self.assertFalse(result.successful)
            self.assertIn(name, result.reason)

    def test_a_setting_that_is_read_only_stays_and_the_reason_is_told(self):
        self.start()
        self.refused(self.parameters.set(parameter("rate", REAL, 5.0)), "read-only")
        self.refused([self.parameters.set_all(parameter("use_sim_time", BOOL, True), parameter("rate", REAL, 5.0))], "read-only")
        self.refused(self.parameters.set(parameter("nothing", TEXT, "x")), "nothing")
        self.assertEqual(self.parameters.get("rate", "use_sim_time"), [25.0, False])

    def test_of_several_that_are_set_each_has_its_result(self):
        self.start()
        results = self.parameters.set(parameter("rate", REAL, 5.0), parameter("use_sim_time", BOOL, True))
        self.assertEqual([result.successful for result in results], [False, True])
        self.assertEqual(self.parameters.get("use_sim_time"), [True])

    def test_use_sim_time_takes_a_truth_value_only(self):
        self.start()
        self.refused(self.parameters.set(parameter("use_sim_time", WHOLE, 1)), "use_sim_time")
        self.assertTrue(self.parameters.set_all(parameter("use_sim_time", BOOL, True)).successful)
        self.assertEqual(self.parameters.get("use_sim_time"), [True])

    def test_a_change_is_an_event(self):
        self.start()
        events = Subscription("/parameter_events", ParameterEvent, qos(1000))
        self.addCleanup(events.close)
        wait_for_graph(lambda node: any(info.node_name == "given_driver"
                                        for info in node.get_publishers_info_by_topic("/parameter_events")), "the publisher")
        wait_until(lambda: events.publishers >= 1, "the publisher")
        self.parameters.set(parameter("use_sim_time", BOOL, True))
        event = events.wait_for(lambda one: one.node == "/given_driver" and one.changed_parameters)
        self.assertEqual([(one.name, value_of(one.value)) for one in event.changed_parameters], [("use_sim_time", True)])


if __name__ == "__main__":
    testing.main()
