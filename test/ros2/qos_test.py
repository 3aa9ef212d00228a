# SPDX-License-Identifier: Apache-2.0
"""Two ends whose policies do not fit are silent in ROS 2: the driver says so, once for a topic, with what to do."""
from diagnostic_msgs.msg import DiagnosticArray
from rcl_interfaces.msg import Log, ParameterEvent
from std_msgs.msg import Bool, UInt16

from support import process, testing
from support.peer import Peer
from support.topics import Publisher, Subscription, Topic, qos, wait_until

WARN = 30  # of rcl_interfaces/msg/Log, whose constants are of another type than its field

MAP = """
name: fits
address: 127.0.0.1
rate: 20
timeout: 60
mapping:
  coils: {lamp: 3, horn: 4}
  input_registers:
    level: {address: 0, type: UINT}
    other: {address: 1, type: UINT}
"""


class Qos(testing.RosTest):
    def setUp(self):
        self.peer = Peer().start()
        self.addCleanup(self.peer.stop)
        self.rosout = Subscription("/rosout", Log, qos(1000, latched=True))
        self.addCleanup(self.rosout.close)
        self.told = []
        self.program = self.driver("--map", process.write_map(MAP), "--port", self.peer.port)
        self.program.wait_for("connected")

    def subscriber(self, name, kind, **options):
        topic = Topic(name, kind, profile=qos(10, **options))
        self.addCleanup(topic.close)
        return topic

    def writer(self, name, **options):
        publisher = Publisher(name, Bool, qos(10, **options))
        self.addCleanup(publisher.unregister)
        return publisher

    def warning(self, *words):
        """The line that has all of these words, which is one in the terminal and one on /rosout."""
        def lines():
            self.told += self.rosout.take()
            in_terminal = [line for line in self.program.output.splitlines() if all(word in line for word in words)]
            return in_terminal, [log for log in self.told if all(word in log.msg for word in words)]

        wait_until(lambda: all(lines()), f"a warning with {words} in both")
        in_terminal, on_rosout = lines()
        self.assertEqual((len(in_terminal), len(on_rosout)), (1, 1), in_terminal)
        self.assertIn("WARN", in_terminal[0])
        self.assertEqual((on_rosout[0].level, on_rosout[0].name), (WARN, "fits_driver"))

    def test_a_transient_local_subscriber_of_a_volatile_topic_is_told_of_durability_and_latch(self):
        level = self.subscriber("/fits/level", UInt16, latched=True)
        self.warning("fits/level", "durability", "volatile", "latch: true")
        self.subscriber("/fits/level", UInt16, latched=True)
        self.subscriber("/fits/other", UInt16, latched=True)
        self.warning("fits/other", "durability")
        self.warning("fits/level", "durability")
        self.assertEqual(level.values, [])
        self.assertEqual(self.subscriber("/fits/level", UInt16).next(), 0, "others are served")

    def test_a_transient_local_subscriber_of_what_every_node_publishes_is_told_of_durability(self):
        for name, kind in (("/diagnostics", DiagnosticArray), ("/parameter_events", ParameterEvent)):
            self.subscriber(name, kind, latched=True)
            self.warning(name, "durability", "volatile")

    def test_a_best_effort_publisher_of_writes_is_told_of_reliability(self):
        unreliable = self.writer("/fits/lamp/write", best_effort=True)
        self.warning("fits/lamp/write", "reliability", "reliable")
        self.writer("/fits/lamp/write", best_effort=True)
        self.writer("/fits/horn/write", best_effort=True)
        self.warning("fits/horn/write", "reliability")
        self.warning("fits/lamp/write", "reliability")
        unreliable.publish(True)
        self.publisher("/fits/lamp/write", Bool).publish(True)
        wait_until(lambda: self.peer.get("coils", 3)[0], "what a reliable publisher writes")

    def test_what_fits_is_not_told(self):
        for topic in (self.subscriber("/fits/level", UInt16), self.subscriber("/fits/level", UInt16, best_effort=True),
                      self.subscriber("/fits/online", Bool, latched=True), self.subscriber("/fits/online", Bool)):
            wait_until(lambda one=topic: one.publishers == 1, f"the publisher of {topic.name}")
        writer = self.writer("/fits/lamp/write", latched=True)
        wait_until(lambda: writer.subscribers == 1, "the driver")
        self.subscriber("/fits/other", UInt16, latched=True)
        self.warning("fits/other")
        self.assertEqual(self.program.output.count("WARN"), 1, self.program.output)


if __name__ == "__main__":
    testing.main()
