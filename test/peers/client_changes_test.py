#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A generated client tells a change that another client made, with the time at which it was made.

    client_changes_test.py CLIENT NODE_COMMAND…
"""
import os
import signal
import subprocess
import sys
import threading
import time

import peer

CHANGES = 20
STOPPED = 0.05  # seconds


class Changes:
    """Coil 0, which pymodbus writes and `listener` tells."""

    def __init__(self, client, listener, checks):
        self.client, self.listener, self.checks = client, listener, checks
        self.level = self.next_one()[0]

    def next_one(self):
        return [int(word) for word in self.listener.stdout.readline().split()]

    def make(self, stopped=0.0):
        """Another one, while the listener is stopped: when it hears of it is another time. How exact its time is, in ns."""
        self.level = 1 - self.level
        peer.freeze(self.listener)
        try:
            begun = time.monotonic_ns()
            self.checks.equal("pymodbus writes", self.client.write_coil(0, self.level, 1).isError(), False)
            written = time.monotonic_ns()
            time.sleep(stopped)
        finally:
            self.listener.send_signal(signal.SIGCONT)
        level, at, doubt = self.next_one()
        self.checks.equal("the change", level, self.level)
        self.checks.equal(f"made {at - begun} ns after the write began, +/- {doubt}; it ended after {written - begun}",
                          begun - doubt <= at <= written + doubt, True)
        return doubt


def main():
    client, *node = sys.argv[1:]
    if not os.access(client, os.X_OK):
        peer.skip("the client was not built, libmodbus is missing; run scripts/install-packages build")
    checks = peer.Checks()
    with peer.running_node(node) as port, \
            subprocess.Popen([client, str(port)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as listener:
        deadline = threading.Timer(peer.PATIENCE, listener.kill)
        deadline.start()
        try:
            changes = Changes(peer.pymodbus_client(port), listener, checks)
            # Until it knows the node's clock so well that both times are told apart.
            while changes.make() > STOPPED * 1e9 / 4:
                pass
            for _ in range(CHANGES):
                changes.make(STOPPED)
            changes.client.close()
            listener.stdin.close()
            checks.equal("status", listener.wait(peer.PATIENCE), 0)
        finally:
            deadline.cancel()
            listener.kill()
    checks.done("a generated client tells changes of a node with the time at which they were made")


main()
