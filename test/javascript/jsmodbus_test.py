# SPDX-License-Identifier: Apache-2.0
"""Every type, in every table, in all four byte and word orders, against a server of npm's jsmodbus."""
import functools

import every_type_test
from device import Device
from support import testing


class Jsmodbus(every_type_test.EveryType):
    peer = functools.partial(Device, "jsmodbus")


if __name__ == "__main__":
    testing.main()
