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


LEASE = 25  # seconds: after 20 Fast DDS sends nothing any more to a process that ended without a word
_ghosts = set()


def _await_graph(running):
    """A driver that has ended is subscribed for a moment more: a message for the next one would have it as its only
    subscriber, and be lost. Who is there after the lease is so in the graph only, which may keep what came too late."""
    try:
        wait_until(lambda: len(ros.other_subscribers() - _ghosts) <= running, "", LEASE)
    except AssertionError:
        if not running:
            _ghosts.update(ros.other_subscribers())


Driver.await_graph = staticmethod(_await_graph)


def main():
    """Runs the tests of the calling file."""
    case.run(ros.shut_down)
