# SPDX-License-Identifier: Apache-2.0
"""What a driver says of its device, as it stands: the newest of status and of /diagnostics."""
import threading

import rospy
from coupler_driver.msg import Status
from diagnostic_msgs.msg import DiagnosticArray

from support.patience import PATIENCE


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


class LatestStatus(Latest):
    """`known`: online, identity, trouble; and each point by its name."""

    def __init__(self, device):
        super().__init__(f"/{device}/status", Status, self._merge_status)

    @staticmethod
    def _merge_status(known, message):
        known["online"], known["identity"], known["trouble"] = message.online, message.identity, message.trouble
        known.update({point.name: point for point in message.points})

    def quality(self, point, wanted):
        return self.wait_for(lambda known: point in known and known[point].quality == wanted)[point]


class LatestDiagnostics(Latest):
    """`known`: connection, polling, writes."""

    def __init__(self, device):
        super().__init__("/diagnostics", DiagnosticArray,
                         lambda known, message: known.update(
                             {status.name.split(f"{device} ")[-1]: status for status in message.status}))

    def level(self, name, *wanted):
        return self.says("", name, *wanted)

    def says(self, text, name, *wanted):
        """An entry of such a level that has the text in its message: there may be other reasons for the level before."""
        return self.wait_for(lambda known: name in known and known[name].level in wanted and text in known[name].message)[name]


def values(status):
    """Of one entry of /diagnostics: {key: value}."""
    return {pair.key: pair.value for pair in status.values}
