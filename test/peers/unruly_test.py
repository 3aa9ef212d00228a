#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Hooks of lines that hang, throw or crash: outputs are in their safe state soon, and other clients are answered again.

    unruly_test.py FIRMWARE
"""
import contextlib
import sys
import time

import peer

try:
    import pymodbus.client  # noqa: F401
    from pymodbus.exceptions import ModbusException
    from recording import Node
except ImportError as error:
    peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")

FIELD = 247
MOTOR, BRAKE, DOOR = 0, 1, 0
HANGS, THROWS, CRASHES = 1, 2, 3  # in unruly.yaml
RUNNING, SAFE = [True, False], [False, True]
# The supervisor waits for a second, and for as long as the machine gives the worker no processor.
LIMIT = 10.0


def coils(port):
    """What a client that connects now reads; None if it gets no answer."""
    client = peer.pymodbus_client(port, timeout=1)
    with contextlib.suppress(ModbusException, OSError), contextlib.closing(client):
        if client.connect():
            answer = client.read_coils(0, 2, 1)
            return None if answer.isError() else answer.bits[:2]
    return None


def becomes_safe(firmware, manners, trigger, checks):
    """Returns what the node said."""
    with Node(firmware) as node:
        client = peer.pymodbus_client(node.port, timeout=1, retries=0)
        client.connect()
        checks.equal("the motor runs", client.write_coils(0, RUNNING, 1).isError(), False)
        checks.equal("and is seen to run", coils(node.port), RUNNING)
        checks.equal("the firmware is told", client.write_register(0, manners, 1).isError(), False)
        began = time.monotonic()
        with contextlib.suppress(ModbusException, OSError):
            trigger(client)
        peer.await_true(f"another client sees the safe state ({manners})", lambda: coils(node.port) == SAFE, checks)
        checks.equal("soon", time.monotonic() - began < LIMIT, True)
        client.close()
        checks.equal("the node ends well", node.end(), 0)
        return node.text()


def open_door(client):
    client.write_coil(DOOR, True, FIELD)


def release_brake(client):
    client.write_coil(BRAKE, False, 1)


def a_hook_that_throws_at_a_write_refuses(firmware, checks):
    with Node(firmware) as node:
        client = peer.pymodbus_client(node.port)
        client.connect()
        client.write_coils(0, [True, True], 1)
        client.write_register(0, THROWS, 1)
        answer = client.write_coil(BRAKE, False, 1)
        checks.equal("refused", (answer.isError(), getattr(answer, "exception_code", None)), (True, 4))
        checks.equal("its line stays as it was, and so does the other", client.read_coils(0, 2, 1).bits[:2], [True, True])
        client.close()
        checks.equal("the node ends well", node.end(), 0)
        checks.equal("the log says why",
                     "the hook of point 'brake' threw an exception: no plan for this; the write is refused" in node.text(), True)


def main(firmware):
    checks = peer.Checks()
    for manners, trigger, says in (
            (HANGS, open_door, "starting it again"),
            (CRASHES, open_door, "starting it again"),
            (THROWS, open_door, "the hook of point 'door' threw an exception: no plan for this; outputs go to their safe state")):
        checks.equal(says, says in becomes_safe(firmware, manners, trigger, checks), True)
    for manners in (HANGS, CRASHES):
        with Node(firmware) as node:
            client = peer.pymodbus_client(node.port, timeout=1, retries=0)
            client.connect()
            client.write_coils(0, [True, True], 1)
            client.write_register(0, manners, 1)
            with contextlib.suppress(ModbusException, OSError):
                release_brake(client)
            peer.await_true(f"a write whose hook fails ends safe ({manners})", lambda: coils(node.port) == SAFE, checks)
            client.close()
            checks.equal("the node ends well", node.end(), 0)
    a_hook_that_throws_at_a_write_refuses(firmware, checks)
    checks.done("hooks of lines that hang, throw or crash")


if __name__ == "__main__":
    main(*sys.argv[1:])
