# SPDX-License-Identifier: Apache-2.0
"""The attack list of a node. An attack is a function of the node; its name says what must hold, and it raises
AssertionError when that does not. What holds for every attack (bystander, memory, descriptors) is referee.py's business."""
import dataclasses
import typing

ATTACKS = []


@dataclasses.dataclass
class Attack:
    name: str
    run: typing.Callable
    guarded: bool  # only of a node with a watchdog and a list of allowed clients
    alone: bool  # nobody else may be connected
    waits: bool  # `run` yields where it waits, and all that do take turns
    tls: bool  # only of a node with TLS


def attack(name, guarded=False, alone=False, waits=False, tls=False):
    """Puts a function on the list."""
    def enlist(function):
        ATTACKS.append(Attack(name, function, guarded, alone, waits, tls))
        return function
    return enlist


# What attacks aim at in map.yaml.
TARGET = 1000  # first of 125 holding registers
TARGET_REGISTERS = 125
TARGET_COIL = 100  # first of 16 coils

from attacks import framing, requests, connections, listening, scheduling, waiting, guards, tls  # noqa: E402,F401 in the order in which they run
