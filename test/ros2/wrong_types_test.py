# SPDX-License-Identifier: Apache-2.0
"""Topics that others use with a wrong type or a wrong name are silent in ROS: the driver warns of each node at each of them."""
from support import process, testing, wrong_topics
from support.topics import Publisher, Subscription


class WrongTypes(wrong_topics.WrongTopics, testing.RosTest):
    PUBLISHER, SUBSCRIBER = "/test_client", "/test"

    def publish(self, name, kind):
        publisher = Publisher(name, kind)
        self.addCleanup(publisher.unregister)
        return publisher

    def listen(self, name, kind):
        subscription = Subscription(name, kind)
        self.addCleanup(subscription.close)
        return subscription

    @staticmethod
    def end(made):
        made.unregister()

    @staticmethod
    def text(kind):
        return f"{kind.__module__.split('.')[0]}/msg/{kind.__name__}"

    def start(self, path, remappings):
        rules = [word for one in (*remappings, "other_node:a:=b") for word in ("-r", one)]
        driver = process.Process("coupler_driver", "--map", path, "--ros-args", *rules)
        self.addCleanup(driver.end)
        return driver


if __name__ == "__main__":
    testing.main()
