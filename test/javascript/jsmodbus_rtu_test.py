# SPDX-License-Identifier: Apache-2.0
"""Every type, in every table, in all four byte and word orders, against a server of npm's jsmodbus by RTU over TCP."""
import functools

import every_type_test
from device import RtuOverTcpDevice
from support import testing


class JsmodbusRtu(every_type_test.EveryType):
    peer = functools.partial(RtuOverTcpDevice, "jsmodbus-rtu")


if __name__ == "__main__":
    testing.main()
