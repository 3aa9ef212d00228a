# SPDX-License-Identifier: Apache-2.0
"""What a test of either ROS's driver starts and publishes, and how its file is run."""
import itertools
import pathlib
import sys
import unittest

from support.process import Driver
from support.topics import connected_publishers, service

_FILE = pathlib.Path(sys.argv[0]).stem.removesuffix("_test")


class Case(unittest.TestCase):
    """What a test starts, listens to or publishes ends with it: a publisher that stayed would count a driver that is
    gone as its subscriber.
    at_once: each test of the class names its devices after `name`, which no other test has, so that all of them may run
    at the same time, each in a process of its own. In ROS 1 they do (support/at_once.py)."""
    at_once = False
    _numbers = itertools.count(1)

    def __init__(self, *arguments):
        super().__init__(*arguments)
        # A master keeps the types of topics, so no other file that it sees has the same name.
        self.name = f"{_FILE}{next(Case._numbers)}"

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


def run(at_the_end=lambda: None, suite=unittest.TestSuite):
    """Runs the tests of the program. Exit code 77: all of them were skipped."""
    loader = unittest.TestLoader()
    loader.suiteClass = suite
    result = unittest.main(exit=False, verbosity=2, warnings="ignore", testLoader=loader).result
    at_the_end()
    if not result.wasSuccessful():
        sys.exit(1)
    if result.testsRun and len(result.skipped) == result.testsRun:
        print(f"skipped: {result.skipped[0][1]}")
        sys.exit(77)
