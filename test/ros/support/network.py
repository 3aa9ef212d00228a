# SPDX-License-Identifier: Apache-2.0
"""A network with one cable: the device is at its far end, in a network namespace of its own."""
import contextlib
import ctypes
import os
import subprocess
import unittest

HOST, DEVICE = "198.51.100.1", "198.51.100.2"  # addresses for documentation (RFC 5737): nobody's
CLONE_NEWNET = 0x40000000


def ip(*words):
    subprocess.run(["ip", *words], check=True, capture_output=True, text=True)


class Network:
    def __init__(self):
        self._name = f"coupler{os.getpid()}"
        self._near, self._far = f"cn{os.getpid()}", f"cf{os.getpid()}"

    def __enter__(self):
        try:
            ip("netns", "add", self._name)
            ip("link", "add", self._near, "type", "veth", "peer", "name", self._far, "netns", self._name)
            ip("address", "add", f"{HOST}/30", "dev", self._near)
            ip("-n", self._name, "address", "add", f"{DEVICE}/30", "dev", self._far)
            ip("link", "set", self._near, "up")
            ip("-n", self._name, "link", "set", self._far, "up")
        except (OSError, subprocess.CalledProcessError) as error:
            self.__exit__()
            raise unittest.SkipTest(f"no network namespaces here (needs root and iproute2): {error}") from error
        return self

    def __exit__(self, *_):
        with contextlib.suppress(OSError, subprocess.CalledProcessError):
            ip("netns", "del", self._name)

    @contextlib.contextmanager
    def at_the_far_end(self):
        """Sockets that this thread makes within are the device's."""
        libc = ctypes.CDLL(None, use_errno=True)
        with open("/proc/thread-self/ns/net") as home, open(f"/run/netns/{self._name}") as far:
            if libc.setns(far.fileno(), CLONE_NEWNET):
                raise OSError(ctypes.get_errno(), "setns")
            try:
                yield
            finally:
                libc.setns(home.fileno(), CLONE_NEWNET)

    def pull(self):
        """The cable out of the device: packets vanish, nobody says a word."""
        ip("-n", self._name, "link", "set", self._far, "down")

    def plug(self):
        ip("-n", self._name, "link", "set", self._far, "up")

    def take_down(self):
        """The driver's own interface."""
        ip("link", "set", self._near, "down")

    def bring_up(self):
        ip("link", "set", self._near, "up")
