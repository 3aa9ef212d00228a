# SPDX-License-Identifier: Apache-2.0
"""Devices of one register each, to have several of them."""
from support import process, testing
from support.patience import NO_TIMEOUT
from support.peer import Peer

MAP = """
name: {name}
address: 127.0.0.1
port: {port}
rate: 20
timeout: {timeout}s
mapping:
  holding_registers: {{level: {{address: 4, type: INT}}}}
"""


def write_map(name, port):
    return process.write_map(MAP.format(name=name, port=port, timeout=NO_TIMEOUT))


class LevelsTest(testing.RosTest):
    def peer(self, level):
        peer = Peer().start()
        self.addCleanup(peer.stop)
        peer.set("holding_registers", 4, [level])
        return peer
