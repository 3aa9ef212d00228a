# SPDX-License-Identifier: Apache-2.0
"""A gateway in front of a node: it hands on one request at a time, but no wait for changes."""
import struct

from support.relay import Relay, next_frame

WAIT_FOR_CHANGES = 65


class Gateway(Relay):
    """`refuses_with`: the exception code that answers a wait; None: nothing does."""

    def __init__(self, node_port, refuses_with):
        self._refuses_with = refuses_with
        self.waits = 0  # that came
        super().__init__(node_port)

    def serve(self, client, node):
        requests, replies = client.makefile("rb"), node.makefile("rb")
        while request := next_frame(requests):
            if request[7] == WAIT_FOR_CHANGES:
                self._refuse(client, request)
                continue
            node.sendall(request)
            client.sendall(next_frame(replies))

    def _refuse(self, client, request):
        self.waits += 1
        if self._refuses_with is not None:
            client.sendall(request[:4] + struct.pack(">HBBB", 3, request[6], request[7] | 0x80, self._refuses_with))
