#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A ROS 2 domain that no other test or demo of this machine has, and none of somebody else's programs that were there before.
As a program: runs a command in it, or says its number and holds it until SIGINT or SIGTERM.
  ros2_domain.py [COMMAND…]"""
import os
import signal
import socket
import subprocess
import sys

DOMAINS = 101  # 1 to 101: the ports of those above may be the kernel's choice for somebody else
_locks = []    # held until this process ends


def take():
    for number in range(DOMAINS):
        domain = 1 + (os.getpid() + number) % DOMAINS
        lock, probe = socket.socket(socket.AF_UNIX), socket.socket(type=socket.SOCK_DGRAM)
        try:
            lock.bind(f"\0coupler-ros2-domain-{domain}")
            probe.bind(("", 7410 + 250 * domain))  # of the first participant
        except OSError:
            lock.close()
            continue
        finally:
            probe.close()
        _locks.append(lock)
        return domain
    raise RuntimeError("every ROS 2 domain of this machine is in use")


if __name__ == "__main__":
    if sys.argv[1:]:
        sys.exit(subprocess.run(sys.argv[1:], env={**os.environ, "ROS_DOMAIN_ID": str(take())}, check=False).returncode)
    for end in (signal.SIGINT, signal.SIGTERM):
        signal.signal(end, signal.SIG_DFL)
    print(take(), flush=True)
    while True:
        signal.pause()
