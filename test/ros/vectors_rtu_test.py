# SPDX-License-Identifier: Apache-2.0
"""The test vectors of two maps against the driver, by RTU on a serial line and over TCP."""
import vectors_test
from support import testing
from support.rtu_peer import SerialPeer, TcpPeer


class OnSerialLine(vectors_test.Vectors):
    peer = SerialPeer
    test_random_maps_with_generated_drivers = None


class OverTcp(vectors_test.Vectors):
    peer = TcpPeer
    test_random_maps_with_generated_drivers = None


if __name__ == "__main__":
    testing.main()
