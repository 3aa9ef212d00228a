#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""config/stand-in-coupler.py serves what config/foreign-coupler.yaml describes, and says so if it cannot listen.

    stand_in_test.py COUPLER
"""
import pathlib
import socket
import subprocess
import sys

import peer

CONFIG = pathlib.Path(__file__).parents[2] / "config"


def stand_in(*arguments):
    command = [sys.executable, CONFIG / "stand-in-coupler.py", *map(str, arguments)]
    return subprocess.Popen(command, stderr=subprocess.PIPE, text=True)


def said_by(*arguments):
    """The exit status and what it says of a call that must end."""
    process = stand_in(*arguments)
    try:
        return process.wait(peer.PATIENCE), process.stderr.read()
    except subprocess.TimeoutExpired:
        process.kill()
        return "none", ""


def is_listened_at(port):
    try:
        socket.create_connection(("127.0.0.1", port), peer.PATIENCE).close()
        return True
    except ConnectionRefusedError:
        return False


def serves_once(port, checks):
    process = stand_in(port)
    try:
        peer.await_true("it serves", lambda: is_listened_at(port), checks)
        read = subprocess.run([sys.argv[1], "dump", CONFIG / "foreign-coupler.yaml", "--at", f"127.0.0.1:{port}"],
                              capture_output=True, text=True, timeout=peer.PATIENCE)
        checks.equal("it is read", (read.returncode, "14 points" in read.stdout), (0, True))
        status, said = said_by(port)
        checks.equal("a second one ends", status, 1)
        checks.equal("and says why, and what to do",
                     [f"cannot listen on 127.0.0.1 port {port}: Address already in use" in said,
                      "give another port: config/stand-in-coupler.py 5020" in said], [True, True])
    finally:
        process.kill()
        process.wait()
    checks.equal("it says nothing of reads that it refuses, and of clients that leave", process.stderr.read(), "")


def main():
    checks = peer.Checks()
    try:
        import pymodbus  # noqa: F401 pylint: disable=import-outside-toplevel,unused-import
    except ImportError as error:
        peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")
    with peer.silent_port() as port:
        serves_once(port, checks)
    for wrong, why in (("70000", "70000 is no port"), ("modbus", "invalid int value")):
        status, said = said_by(wrong)
        checks.equal(f"port {wrong}", (status, why in said), (2, True))
    checks.done("the stand-in for a coupler serves, and says why if it cannot")


main()
