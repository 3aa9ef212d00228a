#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What a node tells systemd while it serves watchdog.yaml: it is ready, it lives, it stops.

    service_manager_test.py NODE_COMMAND…
"""
import os
import queue
import socket
import sys
import tempfile
import threading

import peer


def main():
    checks = peer.Checks()
    with tempfile.TemporaryDirectory() as folder, socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
        manager.bind(f"{folder}/notify")
        told = queue.Queue()

        def listen():  # at all times: what does not fit into the socket's queue, the node does not tell
            news = b""
            while news != b"STOPPING=1":
                news = manager.recv(1000)
                told.put(news)

        def hear():
            return told.get(timeout=peer.PATIENCE)

        threading.Thread(target=listen, daemon=True).start()
        os.environ.update(NOTIFY_SOCKET=f"{folder}/notify", WATCHDOG_USEC="100000")
        with peer.running_node(sys.argv[1:]) as port:
            ready = hear().decode().split("\n")
            checks.equal("the first word", ready[0], "READY=1")
            checks.equal("its status names map and port",
                         "serving watchdog" in ready[1] and f":{port}" in ready[1], True)
            for _ in range(3):
                checks.equal("a sign of life", hear(), b"WATCHDOG=1")
        news = b"WATCHDOG=1"
        while news == b"WATCHDOG=1":
            news = hear()
        checks.equal("the last word", news, b"STOPPING=1")
    checks.done("systemd hears that the node is ready, lives, and stops")


main()
