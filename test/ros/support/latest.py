# SPDX-License-Identifier: Apache-2.0
"""What a driver says of its device, as it stands: the newest of status and of /diagnostics."""
from coupler_driver.msg import Status
from diagnostic_msgs.msg import DiagnosticArray

from support.topics import Latest


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
    """`known`: connection, polling, writes. `told`: the levels of all that came, as (name, level)."""

    def __init__(self, device):
        self._device = device
        self.told = []
        super().__init__("/diagnostics", DiagnosticArray, self._merge_diagnostics)

    def _merge_diagnostics(self, known, message):
        for status in message.status:
            _, is_its, name = status.name.rpartition(f"{self._device} ")
            if is_its:
                known[name] = status
                self.told.append((name, status.level))

    def level(self, name, *wanted):
        return self.says("", name, *wanted)

    def says(self, text, name, *wanted):
        """An entry of such a level that has the text in its message: there may be other reasons for the level before."""
        return self.wait_for(lambda known: name in known and known[name].level in wanted and text in known[name].message)[name]


def values(status):
    """Of one entry of /diagnostics: {key: value}."""
    return {pair.key: pair.value for pair in status.values}
