# SPDX-License-Identifier: Apache-2.0
"""Ports at which nobody listens yet."""
import contextlib
import socket

_kept = []


def _keep(port):
    supervisor = socket.socket()
    supervisor.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    supervisor.bind(("127.0.0.1", port))
    _kept.append(supervisor)
    return supervisor.getsockname()[1]


def free_port():
    """A port of the kernel's choice. It stays bound, so nobody else gets it while this process runs; it refuses connections
    until a server of the test listens there, which Linux allows as both set SO_REUSEADDR."""
    return _keep(0)


def free_port_with_the_next():
    """The first of two, one after the other."""
    while True:
        port = free_port()
        with contextlib.suppress(OSError, OverflowError):
            _keep(port + 1)
            return port
