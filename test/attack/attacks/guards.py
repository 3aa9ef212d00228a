# SPDX-License-Identifier: Apache-2.0
"""Ways around the watchdog, and around the list of allowed clients."""
import contextlib
import time

import adu as modbus
from attacks import attack
from attacks.framing import READ, is_answered
from client import LATE
from node import STATE
from subjects import ATTACKER, TIMEOUT

ARMED, EXPIRED = 2, 3
OUTPUTS = 8
MONITORS = 50


def write_outputs(client):
    """When that began."""
    began = time.monotonic()
    client.expect_answer(modbus.pdu(15, 0, OUTPUTS), modbus.write_coils(0, OUTPUTS, b"\xff"))
    return began


def state(client):
    return client.ask(modbus.read(4, STATE, 1))[-1]


def outputs_become_safe(monitor, written, meanwhile):
    """The watchdog expires in time, whatever `meanwhile` does, again and again."""
    # On a busy machine it may have expired before anybody could look.
    assert state(monitor) == ARMED or time.monotonic() > written + TIMEOUT, "the write did not arm the watchdog"
    end = time.monotonic() + TIMEOUT + LATE
    while state(monitor) == ARMED:
        assert time.monotonic() < end, f"outputs are still on {TIMEOUT + LATE:g} s after the client's last request"
        meanwhile()
    assert state(monitor) == EXPIRED
    monitor.expect_answer(modbus.values(1, b"\x00"), modbus.read(1, 0, OUTPUTS))


@attack("fifty monitors that read without a break do not feed the watchdog", guarded=True, alone=True)
def monitors(node):
    with contextlib.ExitStack() as stack:
        crowd = [stack.enter_context(node.connect()) for _ in range(MONITORS)]
        with node.connect() as client:
            written = write_outputs(client)
        outputs_become_safe(crowd[0], written, lambda: [is_answered(client) for client in crowd])


@attack("a client that has connected anew and only reads is a monitor", guarded=True, alone=True)
def reborn_client(node):
    with node.connect() as client:
        written = write_outputs(client)
    with node.connect() as client, node.connect() as monitor:
        outputs_become_safe(monitor, written, lambda: is_answered(client))


@attack("writes that are refused do not feed the watchdog", guarded=True, alone=True)
def refused_writes(node):
    with node.connect() as client:
        written = write_outputs(client)
    wrong = [modbus.pdu(5, OUTPUTS, 0xFF00), modbus.pdu(5, 0, 1), modbus.pdu(6, 123, 1),
             modbus.write_coils(0, OUTPUTS, b"\xff", count=2), modbus.write_coils(0, OUTPUTS + 1, b"\xff\xff")]
    with node.connect() as client, node.connect() as monitor:
        def refused():
            for request in wrong:
                assert client.ask(request)[0] & 0x80, f"{request.hex(' ')} was not refused"
        outputs_become_safe(monitor, written, refused)


@attack("requests for another unit and half a frame do not feed the watchdog, though their sender has written",
        guarded=True, alone=True)
def no_requests(node):
    with node.connect() as client, node.connect() as other, node.connect() as monitor:
        write_outputs(client)
        written = write_outputs(other)
        unsent = list(modbus.adu(modbus.write_coils(0, OUTPUTS, b"\xff")))[:-1]

        def send_what_is_no_request():
            client.send(modbus.adu(READ, unit=7))
            if unsent:
                other.send(bytes([unsent.pop(0)]))
            time.sleep(0.05)
        outputs_become_safe(monitor, written, send_what_is_no_request)


@attack("a storm of connections does not hold the watchdog up", guarded=True, alone=True)
def storm_while_the_watchdog_waits(node):
    with node.connect() as monitor:
        with node.connect() as client:
            written = write_outputs(client)

        def storm():
            for _ in range(50):
                node.connect().reset()
        outputs_become_safe(monitor, written, storm)


@attack("two thousand clients that are not allowed are closed at once and take nobody's place", guarded=True)
def refused_clients(node):
    with node.connect() as resident:
        for number in range(2000):
            client = node.connect(source=ATTACKER)
            client.send(modbus.adu(modbus.pdu(6, 0, 0xBAD)))
            if number % 100 == 0:
                client.expect_closed()
            client.reset()
        is_answered(resident)
