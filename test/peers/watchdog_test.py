#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A client dies, a monitor goes on reading: the outputs of a node that serves watchdog.yaml go to their safe state.

    watchdog_test.py NODE_COMMAND…
"""
import sys
import time

import peer

try:
    import pymodbus.client  # noqa: F401
except ImportError as error:
    peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")

TIMEOUT = 0.5
STATE, RESET = 0xFF0B, 0xFF00
IDLE, ARMED, EXPIRED = 1, 2, 3
DRIVEN, SAFE = [True, False, True], [False, True, True]


def state(client):
    return client.read_input_registers(STATE, 1, 1).registers[0]


def levels(client):
    return client.read_discrete_inputs(0, 3, 1).bits[:3]


def speaking(client, act):
    """What `act(silence)` returns. While a busy machine silences the client, the watchdog is right to expire."""
    return peer.undisturbed(TIMEOUT, act, lambda: client.write_register(RESET, 0xAA55, 1))


def a_client_that_speaks_keeps_its_outputs(client, checks):
    def for_three_timeouts(silence):
        seen = [silence.ask(lambda: client.write_coils(0, DRIVEN, 1).isError())]
        end = time.monotonic() + 3 * TIMEOUT
        while time.monotonic() < end:
            seen.append((silence.ask(lambda: state(client)), silence.ask(lambda: levels(client))))
            time.sleep(TIMEOUT / 10)
        return seen

    checks.equal("nothing happened yet", state(client), IDLE)
    write_failed, *seen = speaking(client, for_three_timeouts)
    checks.equal("the write", write_failed, False)
    checks.equal("the state and the outputs while the client reads", seen, [(ARMED, DRIVEN)] * len(seen))


def a_monitor_does_not(monitor, checks):
    end = time.monotonic() + peer.PATIENCE
    while state(monitor) != EXPIRED and time.monotonic() < end:
        time.sleep(TIMEOUT / 10)
    checks.equal("it expired although somebody reads", state(monitor), EXPIRED)
    checks.equal("the wires are safe", levels(monitor), SAFE)
    checks.equal("the image shows it", monitor.read_coils(0, 3, 1).bits[:3], SAFE)


def outputs_stay_until_the_reset(client, checks):
    checks.equal("a write to an output", client.write_coil(0, True, 1).exception_code, 4)
    checks.equal("a write to a register", client.write_register(0, 7, 1).isError(), False)
    checks.equal("a wrong code", client.write_register(RESET, 1, 1).exception_code, 3)
    checks.equal("the wires are safe", levels(client), SAFE)
    checks.equal("the code", client.write_register(RESET, 0xAA55, 1).isError(), False)
    checks.equal("the register reads", client.read_holding_registers(RESET, 1, 1).registers, [0])
    checks.equal("a write to an output, the wires, the state", speaking(client, lambda silence: [
        silence.ask(lambda: client.write_coil(0, True, 1).isError()), silence.ask(lambda: levels(client)),
        silence.ask(lambda: state(client))]), [False, [True, True, True], ARMED])


def it_expires_also_where_nobody_looks(port, checks):
    """The process that answers stands still; the supervisor ends it, and drives the outputs."""
    client = peer.pymodbus_client(port)
    checks.equal("the code", client.write_register(RESET, 0xAA55, 1).isError(), False)
    checks.equal("a write", client.write_coils(0, DRIVEN, 1).isError(), False)
    peer.freeze_other(peer.the_worker())
    client.close()
    other = peer.pymodbus_client(port)
    checks.equal("the next process knows", state(other), EXPIRED)
    checks.equal("the wires are safe", levels(other), SAFE)
    checks.equal("a write to an output", other.write_coil(0, True, 1).exception_code, 4)
    other.close()


def main():
    checks = peer.Checks()
    with peer.running_node(sys.argv[1:]) as port:
        client = peer.pymodbus_client(port)
        monitor = peer.pymodbus_client(port)
        a_client_that_speaks_keeps_its_outputs(client, checks)
        client.close()
        a_monitor_does_not(monitor, checks)
        outputs_stay_until_the_reset(monitor, checks)
        monitor.close()
        it_expires_also_where_nobody_looks(port, checks)
    checks.done("a dead client's outputs go to their safe state, and stay until the reset")


main()
