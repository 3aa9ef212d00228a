# SPDX-License-Identifier: Apache-2.0
"""Ports at which nobody listens yet."""
import socket

_kept = []


def free_port():
    """A port of the kernel's choice. It stays bound, so nobody else gets it while this process runs; it refuses connections
    until a server of the test listens there, which Linux allows as both set SO_REUSEADDR."""
    supervisor = socket.socket()
    supervisor.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    supervisor.bind(("127.0.0.1", 0))
    _kept.append(supervisor)
    return supervisor.getsockname()[1]
