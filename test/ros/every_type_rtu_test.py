# SPDX-License-Identifier: Apache-2.0
"""Every type, in every table, in all four byte and word orders, by RTU on a serial line and over TCP."""
import every_type_test
from support import testing
from support.rtu_peer import SerialPeer, TcpPeer


class OnSerialLine(every_type_test.EveryType):
    peer = SerialPeer


class OverTcp(every_type_test.EveryType):
    peer = TcpPeer


if __name__ == "__main__":
    testing.main()
