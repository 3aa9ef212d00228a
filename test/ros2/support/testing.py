# SPDX-License-Identifier: Apache-2.0
import sys
import unittest

from support import ros
from support.process import Driver, Process
from support.topics import Topic, connected_publishers, service


class RosTest(unittest.TestCase):
    """What a test starts, listens to or publishes ends with it."""

    def topic(self, name, kind, latched=False, profile=None):
        topic = Topic(name, kind, latched, profile)
        self.addCleanup(topic.close)
        return topic

    def publisher(self, name, kind):
        return self.publishers({name: kind})[0]

    def publishers(self, kinds):
        publishers = connected_publishers(kinds)
        for publisher in publishers:
            self.addCleanup(publisher.unregister)
        return publishers

    @staticmethod
    def service(name, kind, **options):
        return service(name, kind, **options)

    def driver(self, *arguments):
        driver = Driver(*arguments)
        self.addCleanup(driver.end)
        return driver

    def assert_ends(self, code, text, *arguments):
        """The driver does so by itself, and says that; arguments as they stand."""
        driver = Process("coupler_driver", *arguments)
        self.assertEqual(driver.wait(), code, driver.output)
        self.assertIn(text, driver.output)


def main():
    """Runs the tests of the calling file. Exit code 77: all of them were skipped."""
    result = unittest.main(exit=False, verbosity=2, warnings="ignore").result
    ros.shut_down()
    if not result.wasSuccessful():
        sys.exit(1)
    if result.testsRun and len(result.skipped) == result.testsRun:
        print(f"skipped: {result.skipped[0][1]}")
        sys.exit(77)
