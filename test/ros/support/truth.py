# SPDX-License-Identifier: Apache-2.0
"""All that a driver says of a device at once: a fault is told truly when its four voices agree."""
from coupler_driver.msg import PointStatus
from diagnostic_msgs.msg import DiagnosticStatus
from std_msgs.msg import Bool, Int16

from .latest import LatestDiagnostics, LatestStatus
from .process import write_map
from .patience import stay_quiet

OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR
TIMEOUT = 0.5


def start(test, port, *arguments, **options):
    """The truth of one device; the options are those of _map()."""
    path = _map(test.name, port, **options)
    return Truth(test, test.name, test.driver(f"_map:={path}", *arguments))


def start_several(test, ports, **options):
    """That of each of several devices, which have one driver."""
    names = [f"{test.name}_{number}" for number in range(len(ports))]
    maps = [_map(name, port, **options) for name, port in zip(names, ports)]
    driver = test.driver(f"_maps:=[{','.join(maps)}]")
    return [Truth(test, name, driver) for name in names]


def _map(name, port, address="127.0.0.1", timeout=TIMEOUT):
    return write_map(f"name: {name}\naddress: {address}\nport: {port}\nrate: 20\ntimeout: {timeout}s\n"
                     "mapping:\n  holding_registers: {level: {address: 4, type: INT}}\n")


def nothing_is_published(truths):
    """What is old does not come again."""
    stay_quiet([truth.level for truth in truths])


class Truth:
    """Of a device with the point `level` in holding register 4."""

    def __init__(self, test, name, driver):
        self.name, self.driver = name, driver
        self.level = test.topic(f"/{name}/level", Int16)
        self.online = test.topic(f"/{name}/online", Bool)
        self.status = LatestStatus(name)
        self.diagnostics = LatestDiagnostics(name)
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
        """A test looks with nothing_is_published(), too."""
        self._expect_online(False)
        self.status.wait_for(  # with the reason, which there is none of at the very beginning
            lambda known: not known.get("online", True) and known["level"].quality == PointStatus.OFFLINE and
            known["trouble"])
        self.diagnostics.says("offline", "connection", ERROR)

    def has_exception(self, code, quality):
        """The device is there, but refuses the point. A test looks with nothing_is_published(), too."""
        point = self.status.wait_for(lambda known: known.get("online") and known["level"].quality == quality)["level"]
        self._test.assertEqual(point.exception, code)
        self.diagnostics.says("level", "polling", WARN, ERROR)
        self._expect_online(True)

    def _expect_online(self, wanted):
        self.online.wait_for(lambda _: self.online.values[-1] == wanted)
