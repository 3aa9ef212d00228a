# SPDX-License-Identifier: Apache-2.0
"""Subscriptions that match are what poll: subscribed and publish: on_change go by."""
import time

from std_msgs.msg import Bool, Int16

from support import process, testing
from support.device import Device
from support.patience import NO_TIMEOUT, QUIET
from support.topics import Topic, qos, wait_until

MAP = f"""
name: heard
address: 127.0.0.1
rate: 20
timeout: {NO_TIMEOUT}s
mapping:
  coils: {{lamp: 3}}
  input_registers:
    a: {{address: 0, type: INT}}
    b: {{address: 100, type: INT}}
    news: {{address: 200, type: INT, publish: on_change, max_interval: 600s}}
"""


class SubscribersTest(testing.RosTest):
    def setUp(self):
        self.device = Device().start()
        self.addCleanup(self.device.stop)
        for address, value in ((0, 11), (100, 22), (200, 33)):
            self.device.tables["input_registers"][address] = value

    def start(self, *arguments):
        self.driver("--map", process.write_map(MAP), "--port", self.device.port, *arguments).wait_for("connected")

    def falls_silent(self):
        begin = len(self.device.requests)
        time.sleep(QUIET)
        return len(self.device.requests) == begin


class Subscribed(SubscribersTest):
    def setUp(self):
        super().setUp()
        self.start("--poll", "subscribed")

    def test_the_first_subscriber_begins_the_polling_and_the_last_one_ends_it(self):
        self.assertTrue(self.falls_silent())
        self.assertEqual(self.device.requests, [])
        one = self.topic("/heard/a", Int16)
        self.assertEqual(one.next(), 11)
        two = Topic("/heard/a", Int16, profile=qos(10, best_effort=True))
        self.assertEqual(two.next(), 11)
        one.close()
        self.assertEqual(two.next(), 11)
        two.close()
        wait_until(self.falls_silent, "it to ask for no more")
        self.assertEqual({request.address for request in self.device.requests}, {0})
        self.assertEqual(self.topic("/heard/a", Int16).next(), 11, "and anew")

    def test_a_subscriber_that_does_not_match_is_none(self):
        wrong = Topic("/heard/a", Int16, latched=True)
        self.addCleanup(wrong.close)
        self.assertEqual(self.topic("/heard/b", Int16).next(), 22)
        self.assertEqual({request.address for request in self.device.requests}, {100})

    def test_many_that_come_and_go_leave_nothing_behind(self):
        for _ in range(5):
            topics = [Topic("/heard/a", Int16) for _ in range(5)]
            topics[-1].next()
            for topic in topics:
                topic.close()
        wait_until(self.falls_silent, "it to ask for no more")

    def test_a_write_needs_no_subscriber(self):
        self.publisher("/heard/lamp/write", Bool).publish(True)
        wait_until(lambda: self.device.tables["coils"][3] == 1, "the write")
        self.assertEqual({request.function for request in self.device.requests}, {5})


class OnChange(SubscribersTest):
    def test_a_newcomer_hears_the_value_though_it_is_no_news(self):
        self.start()
        first = self.topic("/heard/news", Int16)
        self.assertEqual(first.wait_for(lambda value: value == 33), 33)
        always = self.topic("/heard/a", Int16)
        wait_until(lambda: len(always.values) > 5, "readings with nothing new")
        first.values.clear()
        newcomer = self.topic("/heard/news", Int16)
        self.assertEqual(newcomer.wait_for(lambda value: value == 33), 33)
        always.values.clear()
        wait_until(lambda: len(always.values) > 10, "readings with nothing new")
        self.assertLessEqual(len(first.values), 1, "once more, whatever it is")
        self.assertEqual(newcomer.values, [33])

    def test_with_both_a_newcomer_is_polled_for_and_hears_it(self):
        self.start("--poll", "subscribed")
        for value in (1, 2, 2):
            self.device.tables["input_registers"][200] = value
            topic = self.topic("/heard/news", Int16)
            topic.wait_for(lambda now, wanted=value: now == wanted)
            topic.close()


if __name__ == "__main__":
    testing.main()
