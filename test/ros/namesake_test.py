# SPDX-License-Identifier: Apache-2.0
"""Two drivers of one name: the ROS master would end the older one, and launches that start theirs again would have the two end
each other for ever."""
import signal
import threading
import xmlrpc.server

import rosgraph
import rospy

from support import process, testing
from support.device import Device
from support.topics import wait_until

MAP = """
name: {name}
address: 127.0.0.1
port: {port}
rate: 20
on_shutdown: safe
mapping:
  coils: {{lamp: {{address: 3, safe: false}}}}
"""


class Namesake(testing.RosTest):
    at_once = True

    def setUp(self):
        self.device = Device().start()
        self.addCleanup(self.device.stop)
        self.map = process.write_map(MAP.format(name=self.name, port=self.device.port))
        self.node = f"/{self.name}_driver"
        self.master = rosgraph.Master(rospy.get_name())

    def started(self):
        driver = self.driver(f"_map:={self.map}")
        driver.wait_for("connected")
        return driver

    def is_polled(self):
        """By a driver that is there."""
        before = len(self.device.requests)
        wait_until(lambda: len(self.device.requests) > before + 5, "polls")

    def test_a_second_one_does_not_start_and_the_first_one_goes_on(self):
        first = self.started()
        uri = self.master.lookupNode(self.node)
        clients = self.device.accepted
        for arguments in ((), (f"__name:={self.node[1:]}",)):
            second = process.Driver(f"_map:={self.map}", *arguments)
            self.assertEqual(second.wait(), 1, second.output)
            self.assertIn(f"a node {self.node} runs already (process {first._child.pid}, {uri})", second.output)  # pylint: disable=protected-access
            self.assertIn("Stop that one, or give this one another name: --name NAME", second.output)
        self.is_polled()
        self.assertTrue(first.running)
        self.assertEqual(self.master.lookupNode(self.node), uri)
        self.assertEqual(self.device.accepted, clients)

    def test_one_that_was_killed_is_no_hindrance(self):
        first = self.started()
        first.signal(signal.SIGKILL)
        first.wait()
        self.assertTrue(self.master.lookupNode(self.node))  # the master does not know
        self.started()

    def test_another_node_at_the_port_of_one_that_was_killed_is_no_hindrance(self):
        with xmlrpc.server.SimpleXMLRPCServer(("localhost", 0), logRequests=False) as server:
            server.register_function(lambda _: [1, "", 1234], "getPid")
            server.register_function(lambda _: [1, "", [["/rosout", "rosgraph_msgs/Log"]]], "getPublications")
            server.register_function(lambda *_: [1, "", 0], "shutdown")  # the master takes it for the one before
            threading.Thread(target=server.serve_forever, daemon=True).start()
            self.addCleanup(server.shutdown)
            uri = f"http://localhost:{server.server_address[1]}/"
            for node in (self.node, f"/{self.name}_other"):
                for topic in ("/rosout", f"{node}/status"):
                    rosgraph.Master(node).registerPublisher(topic, "std_msgs/Empty", uri)
            self.assertEqual(self.master.lookupNode(self.node), uri)
            self.started()

    def test_one_that_hangs_is_no_hindrance_and_is_told_why_it_ends(self):
        first = self.started()
        with first.frozen():
            self.started()
        first.wait_for(f"another node has started with the name {self.node}, and so the ROS master ends this one")
        self.assertEqual(first.wait(), 0)


if __name__ == "__main__":
    testing.main()
