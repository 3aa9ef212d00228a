# SPDX-License-Identifier: Apache-2.0
from support import case, ros
from support.patience import wait_until
from support.process import Driver, Process
from support.topics import Topic


class RosTest(case.Case):
    def topic(self, name, kind, latched=False, profile=None):
        topic = Topic(name, kind, latched, profile)
        self.addCleanup(topic.close)
        return topic

    def assert_ends(self, code, text, *arguments):
        """The driver does so by itself, and says that; arguments as they stand."""
        driver = Process("coupler_driver", *arguments)
        self.assertEqual(driver.wait(), code, driver.output)
        self.assertIn(text, driver.output)


def _await_graph(running):
    """A driver that has ended is in the graph for a moment more: a message for the next one would have it as its only
    subscriber, and be lost."""
    wait_until(lambda: len(ros.other_nodes()) <= running and (running or not ros.has_other_subscriptions()),
               "the graph to forget drivers that ended")


Driver.await_graph = staticmethod(_await_graph)


def main():
    """Runs the tests of the calling file."""
    case.run(ros.shut_down)
