# SPDX-License-Identifier: Apache-2.0
"""Every type, in every table, in all four byte and word orders, by RTU on a serial line and over TCP."""
from every_type_test import EveryType, in_each_order
from support import testing
from support.rtu_peer import SerialPeer, TcpPeer


class OnSerialLine(EveryType):
    peer = SerialPeer


class OverTcp(EveryType):
    peer = TcpPeer


for tests in (OnSerialLine, OverTcp):
    globals().update(in_each_order(tests))

if __name__ == "__main__":
    testing.main()
