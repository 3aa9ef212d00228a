# SPDX-License-Identifier: Apache-2.0
"""Ports at which nobody listens yet.
  ports.py COUNT    says so many, a line each, and keeps them until its standard input ends"""
import contextlib
import socket
import sys

_kept = []


def _keep(port):
    everywhere = socket.AF_INET6 if socket.has_dualstack_ipv6() else socket.AF_INET
    kept = socket.socket(everywhere)
    kept.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    if everywhere == socket.AF_INET6:
        kept.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_V6ONLY, 0)
    kept.bind(("", port))
    _kept.append(kept)
    return kept.getsockname()[1]


def free_port():
    """A port of the kernel's choice. It stays bound at every address, so nobody else gets it at any of them while this
    process runs: a server that listens at every address could not have it then. It refuses connections until a server of
    the test listens there, which Linux allows as both set SO_REUSEADDR."""
    return _keep(0)


def free_port_with_the_next():
    """The first of two, one after the other."""
    while True:
        port = free_port()
        with contextlib.suppress(OSError, OverflowError):
            _keep(port + 1)
            return port


if __name__ == "__main__":
    for _ in range(int(sys.argv[1])):
        print(free_port(), flush=True)
    sys.stdin.read()
