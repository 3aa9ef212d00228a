#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A node that is told another port, and then the former one again: it serves there, and has left the other one to others.

    ports_test.py NODE COUPLER
"""
import contextlib
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import threading

import peer

NODE, COUPLER = sys.argv[1:3]
HAS_TLS = pathlib.Path(NODE).with_name("coupler-node-tls").exists()
ECHO = bytes((0, 7, 0, 0, 0, 6, 1, 8, 0, 0, 0x12, 0x34))
SECURITY = """security:
  certificate: press/press.pem
  key: press/press.key
  ca: press/authority.pem
  roles: {viewer: {read: all}}
  plain: viewer
"""


def map_text(port, tls_port):
    return (f"name: press\nport: {port}\nlisten: 127.0.0.1\n" + (f"{SECURITY}  port: {tls_port}\n" if tls_port else "")
            + "mapping: {coils: {lamp: 0}}\n")


def is_served(port):
    with socket.create_connection(("127.0.0.1", port), peer.PATIENCE) as client:
        client.sendall(ECHO)
        return client.recv(300) == ECHO


def is_listened_at(port):
    try:
        socket.create_connection(("127.0.0.1", port), peer.PATIENCE).close()
        return True
    except ConnectionRefusedError:
        return False
    except (TimeoutError, ConnectionResetError):
        return True  # by nobody who accepts, or no longer: it was closed meanwhile


def main():
    checks = peer.Checks()
    with contextlib.ExitStack() as stack:
        folder = pathlib.Path(stack.enter_context(tempfile.TemporaryDirectory()))
        first, second, first_tls, second_tls = (stack.enter_context(peer.silent_port()) for _ in range(4))
        if HAS_TLS:
            subprocess.run([COUPLER, "certificates", folder, "--node", "press:127.0.0.1", "--client", "cell1:viewer"], check=True,
                           capture_output=True)
        path = folder / "press.yaml"
        path.write_text(map_text(first, HAS_TLS and first_tls))
        node = subprocess.Popen([NODE, str(path), "--sim"], stderr=subprocess.PIPE, text=True)
        stack.callback(node.kill)
        said = []
        threading.Thread(target=lambda: said.extend(node.stderr), daemon=True).start()
        text = lambda: "".join(said)  # noqa: E731
        peer.await_true("it serves", lambda: f"on 127.0.0.1:{first}" in text(), checks)
        turns = [(second, second_tls, first, first_tls), (first, None, second, second_tls), (second, first_tls, first, None),
                 (first, second_tls, second, first_tls)]
        for number, (port, tls_port, left, left_tls) in enumerate(turns, 1):
            path.write_text(map_text(port, HAS_TLS and tls_port))
            node.send_signal(signal.SIGHUP)
            peer.await_true(f"the reload {number} is over", lambda: text().count("the map again") + text().count("refused") == number,
                            checks)
            checks.equal(f"reload {number} is taken: {text()}", "refused" in text(), False)
            checks.equal(f"it serves at the port of reload {number}", is_served(port), True)
            peer.await_true(f"it has left port {left}", lambda: not is_listened_at(left), checks)
            if HAS_TLS and tls_port:
                checks.equal(f"it serves TLS at the port of reload {number}", is_listened_at(tls_port), True)
            if HAS_TLS and left_tls:
                peer.await_true(f"it has left port {left_tls}", lambda: not is_listened_at(left_tls), checks)
        node.terminate()
        checks.equal("it ends well", node.wait(peer.PATIENCE), 0)
    checks.done("ports that a node leaves by a reload are free, and it can come back")


main()
