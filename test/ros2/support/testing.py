# SPDX-License-Identifier: Apache-2.0
from support import case, ros
from support.process import Process
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


def main():
    """Runs the tests of the calling file."""
    case.run(ros.shut_down)
