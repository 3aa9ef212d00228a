# SPDX-License-Identifier: Apache-2.0
"""A network with one cable: the device is at its far end, in a network namespace of its own."""
import contextlib
import ctypes
import ipaddress
import pathlib
import socket
import struct
import subprocess
import unittest

ADDRESSES = ipaddress.ip_network("198.18.0.0/15")  # for tests of networks (RFC 2544): nobody's
CLONE_NEWNET = 0x40000000


def ip(*words):
    subprocess.run(["ip", *words], check=True, capture_output=True, text=True)


class Network:
    """Its number is the first whose namespace nobody has: several runs at once have addresses of their own."""

    def __enter__(self):
        try:
            self._take_a_number()
            with contextlib.ExitStack() as undo:
                undo.push(self)
                ip("link", "add", self._near, "type", "veth", "peer", "name", self._far, "netns", self._name)
                ip("address", "add", f"{self._host}/30", "dev", self._near)
                ip("-n", self._name, "address", "add", f"{self.device}/30", "dev", self._far)
                ip("link", "set", self._near, "up")
                ip("-n", self._name, "link", "set", self._far, "up")
                undo.pop_all()
        except (OSError, subprocess.CalledProcessError) as error:
            why = getattr(error, "stderr", "").strip() or error
            raise unittest.SkipTest(f"no network namespaces here (needs root and iproute2): {why}") from error
        return self

    def _take_a_number(self):
        for number, subnet in enumerate(ADDRESSES.subnets(new_prefix=30)):
            self._name, self._near, self._far = (f"{what}{number}" for what in ("coupler", "cn", "cf"))
            self._host, self.device = map(str, subnet.hosts())
            try:
                return ip("netns", "add", self._name)
            except subprocess.CalledProcessError as error:
                if "File exists" not in error.stderr:
                    raise

    def __exit__(self, *_):
        for words in (("link", "del", self._near),  # a namespace takes its links with it, but later
                      ("netns", "del", self._name)):
            with contextlib.suppress(OSError, subprocess.CalledProcessError):
                ip(*words)

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

    def loses_a_request(self, port):
        """True when a connection to the device's port has sent what is not acknowledged: with the cable pulled, for as long as
        it is out. An answer that was under way has come before."""
        number, = struct.unpack("=I", socket.inet_aton(self.device))  # proc(5): the address as the machine holds it
        peer, established = f"{number:08X}:{port:04X}", "01"
        for line in pathlib.Path("/proc/net/tcp").read_text().splitlines()[1:]:
            _, _, remote, state, queues = line.split()[:5]
            if (remote, state) == (peer, established) and int(queues.split(":")[0], 16):
                return True
        return False

    def plug(self):
        ip("-n", self._name, "link", "set", self._far, "up")

    def take_down(self):
        """The driver's own interface."""
        ip("link", "set", self._near, "down")

    def bring_up(self):
        ip("link", "set", self._near, "up")
