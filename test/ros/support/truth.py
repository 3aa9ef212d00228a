# SPDX-License-Identifier: Apache-2.0
"""All that a driver says of a device at once: a fault is told truly when its four voices agree."""
from coupler_driver.msg import PointStatus
from diagnostic_msgs.msg import DiagnosticStatus
from std_msgs.msg import Bool, Int16

from .latest import LatestDiagnostics, LatestStatus
from .process import write_map

OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR
TIMEOUT = 0.5


class Truth:
    """Of the device `plant` with the point `level` in holding register 4."""

    def __init__(self, test, port, *arguments, address="127.0.0.1", timeout=TIMEOUT):
        path = write_map(f"name: plant\naddress: {address}\nrate: 20\ntimeout: {timeout}s\n"
                         "mapping:\n  holding_registers: {level: {address: 4, type: INT}}\n")
        self.driver = test.driver(f"_map:={path}", f"_port:={port}", *arguments)
        self.level = test.topic("/plant/level", Int16)
        self.online = test.topic("/plant/online", Bool)
        self.status = LatestStatus("plant")
        self.diagnostics = LatestDiagnostics("plant")
        test.addCleanup(self._close)
        self._test = test

    def end(self):
        """The driver, and listening to it."""
        self.driver.end()
        self._close()

    def _close(self):
        for voice in (self.level, self.online, self.status, self.diagnostics):
            voice.close()

    def is_good(self, value, polling=(OK,)):
        self.level.values.clear()
        self.level.wait_for(lambda now: now == value)
        self._expect_online(True)
        self.status.wait_for(lambda known: known.get("online") and known["level"].quality == PointStatus.GOOD)
        self.diagnostics.level("connection", OK)
        self.diagnostics.level("polling", *polling)

    def is_offline(self):
        self._expect_online(False)
        self.status.wait_for(  # with the reason, which there is none of at the very beginning
            lambda known: not known.get("online", True) and known["level"].quality == PointStatus.OFFLINE and
            known["trouble"])
        self.diagnostics.says("offline", "connection", ERROR)
        self._nothing_is_published()

    def has_exception(self, code, quality):
        """The device is there, but refuses the point."""
        point = self.status.wait_for(lambda known: known.get("online") and known["level"].quality == quality)["level"]
        self._test.assertEqual(point.exception, code)
        self.diagnostics.says("level", "polling", WARN, ERROR)
        self._expect_online(True)
        self._nothing_is_published()

    def _expect_online(self, wanted):
        self.online.wait_for(lambda _: self.online.values[-1] == wanted)

    def _nothing_is_published(self):
        """What is old does not come again."""
        self.level.stays_quiet()
