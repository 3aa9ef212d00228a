# SPDX-License-Identifier: Apache-2.0
"""What others do at a driver's topics that can never work, for the driver of either ROS. A test has, beside what a RosTest has:
publish(name, kind), listen(name, kind), end(what they returned), text(kind), start(map, remappings), and the names PUBLISHER
and SUBSCRIBER of the nodes that do so."""
from coupler_driver.msg import BoolStamped, UInt64Stamped
from std_msgs.msg import Bool, Float32, Int32, String, UInt16

from support import process
from support.peer import Peer

MAP = """
name: {name}
address: 127.0.0.1
port: {port}
rate: 20
mapping:
  coils: {{lamp: 3, valve: {{address: 4, access: write}}}}
  input_registers: {{flow: {{address: 0, type: UINT, stamped: true}}}}
  holding_registers:
    setpoint: {{address: 4, type: UINT}}
    limit: {{address: 5, type: UINT, access: read}}
"""


class WrongTopics:
    def setUp(self):
        self.peer = Peer().start()
        self.addCleanup(self.peer.stop)

    def begin(self, remappings=()):
        self.driver = self.start(process.write_map(MAP.format(name=self.name, port=self.peer.port)), remappings)
        self.driver.wait_for("connected")

    def warned(self, topic, text):
        """Once, as a warning."""
        line = f"/{self.name}/{topic}: {text}"
        self.driver.wait_for(line)
        found = [one for one in self.driver.output.splitlines() if line in one]
        self.assertEqual(len(found), 1, self.driver.output)
        self.assertIn("WARN", found[0])

    def wait_for_another_look(self):
        """All that there is has been looked at: what is made now is told."""
        self.publish(f"/{self.name}/limit/write", UInt16)
        self.driver.wait_for(f"/{self.name}/limit/write: node")

    def count(self, text):
        return self.driver.output.count(text)

    def test_a_publisher_of_another_type_is_told_of_once(self):
        self.begin()
        wrong = self.publish(f"/{self.name}/setpoint/write", Int32)
        self.warned("setpoint/write", f"node {self.PUBLISHER} publishes {self.text(Int32)}, and this topic is "
                    f"{self.text(UInt16)}: its messages do not arrive. Publish {self.text(UInt16)}")
        self.wait_for_another_look()
        self.assertEqual(self.count("setpoint/write: node"), 1)
        self.end(wrong)

    def test_a_subscriber_with_another_type_is_told_of(self):
        self.begin()
        for topic, there, needed in (("setpoint", Float32, UInt16), ("flow/stamped", BoolStamped, UInt64Stamped),
                                     ("online", String, Bool)):
            self.listen(f"/{self.name}/{topic}", there)
            self.warned(topic, f"node {self.SUBSCRIBER} subscribes to {self.text(there)}, and this topic is {self.text(needed)}: "
                        f"it receives nothing. Subscribe to {self.text(needed)}")

    def test_who_was_there_before_the_driver_is_told_of(self):
        self.listen(f"/{self.name}/lamp", UInt16)
        self.begin()
        self.warned("lamp", f"node {self.SUBSCRIBER} subscribes to {self.text(UInt16)}, and this topic is {self.text(Bool)}")

    def test_what_goes_the_other_way_only_is_told_with_the_key_of_the_map(self):
        self.begin()
        self.publish(f"/{self.name}/limit/write", UInt16)
        self.warned("limit/write", f"node {self.PUBLISHER} publishes here, and the point limit is read only: nothing is written. "
                    "If the device lets it be written, give it 'access: read_write' in the map")
        self.publish(f"/{self.name}/flow/write", UInt16)
        self.warned("flow/write", f"node {self.PUBLISHER} publishes here, and the point flow is read only: nothing is written. "
                    "No device lets input_registers be written")
        self.listen(f"/{self.name}/valve", Bool)
        self.warned("valve", f"node {self.SUBSCRIBER} subscribes, and the point valve is write only: it receives nothing. "
                    "If the device lets it be read, give it 'access: read_write' in the map")

    def test_another_publisher_of_the_drivers_own_topic_is_told_of_with_the_one_to_write_to(self):
        self.begin()
        self.publish(f"/{self.name}/lamp", Bool)
        self.warned("lamp", f"node {self.PUBLISHER} publishes here, too: its values are not the device's. If they are to be "
                    f"written, publish at /{self.name}/lamp/write; otherwise remap this topic of {self.PUBLISHER}")
        self.publish(f"/{self.name}/flow", UInt16)
        self.warned("flow", f"node {self.PUBLISHER} publishes here, too: its values are not the device's. Remap this topic of "
                    f"{self.PUBLISHER}")
        self.publish(f"/{self.name}/flow/stamped", UInt64Stamped)
        self.warned("flow/stamped", f"node {self.PUBLISHER} publishes here, too: its values are not the device's. Remap")
        self.wait_for_another_look()
        self.assertEqual(self.count("publishes here, too"), 3)

    def test_a_misspelt_topic_at_whose_other_end_is_nobody_is_told_with_the_nearest_one(self):
        self.begin()
        self.publish(f"/{self.name}/lmap/write", Bool)
        self.warned("lmap/write", f"node {self.PUBLISHER} publishes here, and nobody listens; did you mean /{self.name}/lamp/write?")
        self.publish(f"/{self.name}/lamp/wirte", Bool)
        self.warned("lamp/wirte", f"node {self.PUBLISHER} publishes here, and nobody listens; did you mean /{self.name}/lamp/write?")
        self.listen(f"/{self.name}/setpiont", UInt16)
        self.warned("setpiont", f"node {self.SUBSCRIBER} subscribes, and nobody publishes here; did you mean "
                    f"/{self.name}/setpoint?")

    def test_what_fits_and_what_is_no_business_of_the_driver_is_not_told(self):
        self.begin()
        self.publish(f"/{self.name}/setpoint/write", UInt16)
        self.listen(f"/{self.name}/setpoint", UInt16)
        self.listen(f"/{self.name}/online", Bool)
        # Two others talk to each other below the device's name, and somebody waits for a node that is none of ours. The driver may
        # look after the first of these lines: a publisher alone is told of.
        self.listen(f"/{self.name}/lamb/write", Bool)
        self.publish(f"/{self.name}/lamb/write", Bool)
        self.listen(f"/{self.name}/filtered_pressure", Float32)
        self.publish("/elsewhere/lmap/write", Int32)
        self.wait_for_another_look()
        self.assertEqual(self.count("WARN"), 1, self.driver.output)

    def test_a_remapping_that_leads_nowhere_is_told_at_the_start(self):
        self.begin([f"{self.name}/lmap:=lamp", f"{self.name}/flow:=height", "rosout:=/log", "/tf:=/tf_old", "setpoint:=target",
                    f"{self.name}/lamp/set:=switch"])
        self.wait_for_another_look()
        self.assertIn(f"the remapping {self.name}/lmap:=lamp changes nothing: this driver has no topic or service "
                      f"{self.name}/lmap; did you mean {self.name}/lamp?", self.driver.output)
        self.assertIn(f"the remapping setpoint:=target changes nothing: this driver has no topic or service setpoint; did you mean "
                      f"{self.name}/setpoint?", self.driver.output)
        self.assertEqual(self.count("the remapping"), 2, self.driver.output)
