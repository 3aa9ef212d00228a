# SPDX-License-Identifier: Apache-2.0
"""The attack list of a node. An attack is a function of the node; its name says what must hold, and it raises
AssertionError when that does not. What holds for every attack (bystander, memory, descriptors) is run's business."""
import pathlib

ATTACKS = []


def attack(name):
    """Puts a function on the list."""
    def enlist(function):
        ATTACKS.append((name, function))
        return function
    return enlist


# What the node serves, and what attacks aim at in it.
MAP = pathlib.Path(__file__).resolve().parent.parent / "map.yaml"
TARGET = 1000  # first of 125 holding registers
TARGET_REGISTERS = 125
TARGET_COIL = 100  # first of 16 coils

from attacks import framing, requests, connections  # noqa: E402,F401 in the order in which they run
