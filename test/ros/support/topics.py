# SPDX-License-Identifier: Apache-2.0
"""Topics as a test wants them: the values that came, the value that comes, a message that surely arrives."""
import threading
import time

import rospy


class Topic:
    """Everything that was published on a topic since the subscription."""

    def __init__(self, name, kind):
        self.values = []
        self._changed = threading.Condition()
        self._subscriber = rospy.Subscriber(name, kind, self._receive, queue_size=1000)
        self.name = name

    def _receive(self, message):
        with self._changed:
            self.values.append(message.data)
            self._changed.notify_all()

    def wait_for(self, condition, seconds=30):
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

    def next(self, seconds=30):
        """The next value that comes."""
        with self._changed:
            self.values.clear()
        return self.wait_for(lambda _: True, seconds)

    def close(self):
        self._subscriber.unregister()


def connected_publishers(kinds, seconds=30):
    """A publisher for each topic of {name: type}, once somebody listens to all of them."""
    publishers = [rospy.Publisher(name, kind, queue_size=100) for name, kind in kinds.items()]
    for publisher in publishers:
        wait_until(lambda p=publisher: p.get_num_connections() > 0, f"a subscriber of {publisher.name}", seconds)
    return publishers


def wait_until(condition, what, seconds=30):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"waited {seconds} s for {what}")
        time.sleep(0.01)
