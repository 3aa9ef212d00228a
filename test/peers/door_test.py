#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""config/examples/door: its program reacts to a line and drives another one, refuses clients with a reason, and is made safe
when it hangs.

    door_test.py PROGRAM
"""
import os
import signal
import sys

import peer

try:
    import pymodbus.client  # noqa: F401
    from recording import Node
except ImportError as error:
    peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")

FIELD = 247
MOTOR, ALARM = 0, 1
DOOR, TRIPPED = 0, 1


def main(program):
    checks = peer.Checks()
    node = Node(program)
    client = peer.pymodbus_client(node.port)
    client.connect()

    def coils():
        return client.read_coils(0, 2, 1).bits[:2]

    def inputs():
        return client.read_discrete_inputs(0, 2, 1).bits[:2]

    def door(is_open):
        return client.write_coil(DOOR, is_open, FIELD).isError()

    checks.equal("a client starts the motor", client.write_coil(MOTOR, True, 1).isError(), False)
    checks.equal("it runs", coils(), [True, False])
    checks.equal("the door opens", door(True), False)
    peer.await_true("the motor is off and the alarm on", lambda: coils() == [False, True], checks)
    checks.equal("clients read that it tripped", inputs(), [True, True])
    refused = client.write_coil(MOTOR, True, 1)
    checks.equal("nobody starts it now", (refused.isError(), getattr(refused, "exception_code", None)), (True, 4))
    checks.equal("and it stays off", coils(), [False, True])
    peer.await_true("the log says why", lambda: "a write of point 'motor' is refused: the door is open" in node.text(), checks)
    checks.equal("the door closes", door(False), False)
    peer.await_true("the alarm goes off", lambda: coils() == [False, False], checks)
    checks.equal("then the motor may run", client.write_coil(MOTOR, True, 1).isError(), False)
    checks.equal("and does", coils(), [True, False])

    os.kill(peer.children_of(node.process.pid)[0], signal.SIGSTOP)
    again = peer.pymodbus_client(node.port)
    again.connect()
    peer.await_true("the program that hangs is started again", lambda: "starting it again" in node.text(), checks)
    peer.await_true("another client is answered, and the motor is off",
                    lambda: not (answer := again.read_coils(0, 2, 1)).isError() and not answer.bits[0], checks, again.connect)
    checks.done("the door's program")


if __name__ == "__main__":
    main(*sys.argv[1:])
