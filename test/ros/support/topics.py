# SPDX-License-Identifier: Apache-2.0
"""Topics and services as a test wants them: the values that came, the value that comes, a message that surely arrives.
With testing.py all that is ROS 1's here: test/ros2/support has the same for ROS 2, and tests that use no more of ROS than
this and messages are run with both."""
import threading
import time

import rospy
import rosservice
import rostopic
from rospy.impl.registration import get_topic_manager

from support.patience import PATIENCE, stay_quiet, wait_until


def content(message):
    """Its data; of a message without, the message."""
    return getattr(message, "data", message)


class Topic:
    """What was published on a topic: `values` since the subscription or since a test has cleared them, `ever` all of it."""

    def __init__(self, name, kind):
        self._changed = threading.Condition()
        self.name, self._kind = name, kind
        self.ever = []
        self._subscribe()

    def _subscribe(self):
        values = self.values = []

        def receive(message):
            with self._changed:
                values.append(content(message))
                self.ever.append(content(message))
                self._changed.notify_all()

        self._subscriber = rospy.Subscriber(self.name, self._kind, receive, queue_size=1000)

    def wait_for(self, condition, seconds=PATIENCE):
        """The first value, of those that came and those that come, for which condition(value) is true."""
        end = time.monotonic() + seconds
        at = 0
        with self._changed:
            while True:
                for value in self.values[at:]:
                    if condition(value):
                        return value
                at = len(self.values)
                left = end - time.monotonic()
                if left <= 0:
                    raise AssertionError(f"{self.name}: waited {seconds} s; the last values were {self.values[-5:]}")
                self._changed.wait(left)

    def becomes(self, value):
        """Until the last value is this one, whatever came before."""
        self.wait_for(lambda _: self.values[-1] == value)

    def next(self):
        """The next value that comes."""
        with self._changed:
            self.values.clear()
        return self.wait_for(lambda _: True)

    def stays_quiet(self):
        """Nothing is published from now on."""
        stay_quiet([self])

    def subscribe_anew(self):
        """What was published before may still be under way in the old subscription, and two of a process have one connection."""
        self.close()
        assert not get_topic_manager().has_subscription(self.name), f"another subscriber of {self.name} keeps the connection"
        self._subscribe()

    def close(self):
        self._subscriber.unregister()


class Latest:
    """The last message of a topic, and a wait for one that fits."""

    def __init__(self, name, kind, merge):
        self._changed = threading.Condition()
        self._merge = merge
        self.known = {}
        self._subscriber = rospy.Subscriber(name, kind, self._receive, queue_size=100)

    def _receive(self, message):
        with self._changed:
            self._merge(self.known, message)
            self._changed.notify_all()

    def wait_for(self, condition, seconds=PATIENCE):
        with self._changed:
            if not self._changed.wait_for(lambda: condition(self.known), seconds):
                raise AssertionError(f"waited {seconds} s; last: {self.known}")
            return dict(self.known)

    def close(self):
        self._subscriber.unregister()


def next_message(name, kind):
    return rospy.wait_for_message(name, kind, PATIENCE)


def type_of(name):
    """Of a topic; None until somebody publishes or subscribes."""
    return rostopic.get_topic_class(name)[0]


def connected_publishers(kinds):
    """A publisher for each topic of {name: type}, once somebody listens to all of them."""
    publishers = [rospy.Publisher(name, kind, queue_size=100) for name, kind in kinds.items()]
    for publisher in publishers:
        wait_until(lambda p=publisher: p.get_num_connections() > 0, f"a subscriber of {publisher.name}")
    return publishers


class NoService(Exception):
    pass


def service(name, kind, seconds=PATIENCE):
    """A function that calls it, once it is there."""
    end = time.monotonic() + seconds
    while not rosservice.get_service_uri(name) and time.monotonic() < end:
        time.sleep(0.02)  # rospy looks for it three times a second
    try:
        rospy.wait_for_service(name, max(end - time.monotonic(), 0.001))
    except rospy.ROSException as error:
        raise NoService(name) from error
    return rospy.ServiceProxy(name, kind)


def response_of(kind):
    """The message that a service of this type answers with."""
    return kind._response_class  # pylint: disable=protected-access
