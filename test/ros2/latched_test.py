# SPDX-License-Identifier: Apache-2.0
"""What is latched comes to late subscribers, once and by itself; what is not, does not. The policies are those that ROS 2's own
tools expect."""
from coupler_driver.msg import Status
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from std_msgs.msg import Bool, UInt16, UInt16MultiArray

from support import process, testing
from support.peer import Peer
from support.ros import polled
from support.topics import Subscription, Topic, qos, wait_until

MAP = """
name: kept
address: 127.0.0.1
rate: 20
timeout: 60
mapping:
  coils: {lamp: 3}
  input_registers:
    always: {address: 0, type: UINT, stamped: true}
    last: {address: 1, type: UINT, publish: on_change, latch: true, stamped: true}
    array: {address: 2, type: UINT, count: 2, publish: on_change, latch: true, queue_size: 5}
"""


class Latched(testing.RosTest):
    def setUp(self):
        self.peer = Peer().start()
        self.addCleanup(self.peer.stop)
        self.peer.set("input_registers", 0, [10, 11, 12, 13])
        self.program = self.driver("--map", process.write_map(MAP), "--port", self.peer.port)
        self.program.wait_for("connected")

    def late(self, name, kind, **options):
        """All that a subscriber has when the next value of another topic is there."""
        subscription = Subscription(name, kind, qos(10, latched=True, **options))
        self.addCleanup(subscription.close)
        seen = [subscription.wait_for(lambda _: True)]
        always = self.topic("/kept/always", UInt16)
        wait_until(lambda: len(always.values) > 5, "five more readings")
        return seen + subscription.take()

    def test_a_late_subscriber_gets_the_last_value_of_a_latched_point_and_no_older_one(self):
        first = self.topic("/kept/last", UInt16, latched=True)
        for value in (1, 2, 3):
            self.peer.set("input_registers", 1, [value])
            first.wait_for(lambda now, wanted=value: now == wanted)
        self.assertEqual({message.data for message in self.late("/kept/last", UInt16)}, {3})  # and once more, as on_change has it

    def test_an_array_with_a_queue_of_its_own_is_latched_with_one_value(self):
        first = self.topic("/kept/array", UInt16MultiArray, latched=True)
        for value in (1, 2, 3):
            self.peer.set("input_registers", 2, [value, value])
            first.wait_for(lambda now, wanted=value: list(now) == [wanted, wanted])
        self.assertEqual({tuple(message.data) for message in self.late("/kept/array", UInt16MultiArray)}, {(3, 3)})

    def test_online_and_status_are_there_for_who_comes_late(self):
        self.assertEqual([message.data for message in self.late("/kept/online", Bool)], [True])
        status = Subscription("/kept/status", Status, qos(10, latched=True))
        self.addCleanup(status.close)
        first = status.wait_for(lambda _: True)
        self.assertEqual([point.name for point in first.points], ["lamp", "always", "last", "array"])

    def test_a_volatile_subscriber_of_a_latched_topic_waits_for_the_next_value(self):
        volatile = self.topic("/kept/last", UInt16, profile=qos(10))
        wait_until(lambda: volatile.publishers == 1, "the publisher")
        self.peer.set("input_registers", 1, [7])
        volatile.wait_for(lambda value: value == 7)
        self.assertLessEqual(set(volatile.values), {7, 11}, "11: it had come before the first reading")

    def test_the_policies_are_those_of_ros_2(self):
        offered = {f"/kept/{name}": DurabilityPolicy.VOLATILE for name in ("always", "always/stamped", "always/sample", "lamp")}
        offered.update({f"/kept/{name}": DurabilityPolicy.TRANSIENT_LOCAL for name in ("last", "last/stamped", "last/sample", "array", "online", "points", "status")})
        offered["/diagnostics"] = DurabilityPolicy.VOLATILE
        for name, durability in offered.items():
            wait_until(lambda n=name: polled.get_publishers_info_by_topic(n), f"a publisher of {name}")
            profile = polled.get_publishers_info_by_topic(name)[0].qos_profile
            self.assertEqual((profile.reliability, profile.durability), (ReliabilityPolicy.RELIABLE, durability), name)
        wait_until(lambda: polled.get_subscriptions_info_by_topic("/kept/lamp/write"), "the subscriber of writes")
        profile = polled.get_subscriptions_info_by_topic("/kept/lamp/write")[0].qos_profile
        self.assertEqual((profile.reliability, profile.durability), (ReliabilityPolicy.RELIABLE, DurabilityPolicy.VOLATILE))

    def test_a_best_effort_subscriber_gets_values_too(self):
        topic = Topic("/kept/always", UInt16, profile=qos(10, best_effort=True))
        self.addCleanup(topic.close)
        self.assertEqual(topic.next(), 10)
        diagnostics = Subscription("/diagnostics", DiagnosticArray, qos(10, best_effort=True))
        self.addCleanup(diagnostics.close)
        diagnostics.wait_for(lambda message: message.status)


if __name__ == "__main__":
    testing.main()
