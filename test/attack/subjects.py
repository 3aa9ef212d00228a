# SPDX-License-Identifier: Apache-2.0
"""What is attacked: nodes that all serve map.yaml, made and set up in different ways."""
import dataclasses
import pathlib

MAP = pathlib.Path(__file__).resolve().parent / "map.yaml"
FLOODER = "127.0.0.2"  # an address that every node lets in
ATTACKER = "127.0.0.66"  # an address that a guarded node refuses
TIMEOUT = 1.0  # seconds of a guarded node's watchdog
GUARDS = "watchdog: {timeout: 1s}\nallow: [127.0.0.1, 127.0.0.2]\n"


@dataclasses.dataclass
class Subject:
    """`guarded`: it has a watchdog and a list of allowed clients. `wired`: inputs 0 to 7 show outputs 0 to 7."""
    command: list
    map_text: bytes
    guarded: bool = False
    wired: bool = True


def node(build, _):
    """coupler-node on a simulated chip"""
    return Subject([build / "bin" / "coupler-node", MAP, "--sim", "--port", "0"], MAP.read_bytes())


def generated(build, _):
    """the node that was generated from the map"""
    return Subject([build / "test" / "bin" / "attacked_node", "--sim", "--port", "0"], MAP.read_bytes())


def guarded(build, folder):
    """with a watchdog and a list of allowed clients"""
    path, text = _guarded_map(folder)
    return Subject([build / "bin" / "coupler-node", path, "--sim", "--port", "0"], text, guarded=True)


def kept(build, folder):
    """the same on a kernel's chip gpiochip0 with 16 lines, and so with a supervisor: for test/kernel/attack.sh"""
    path, text = _guarded_map(folder)
    return Subject([build / "bin" / "coupler-node", path, "--port", "0"], text, guarded=True, wired=False)


SUBJECTS = {make.__name__: make for make in (node, generated, guarded, kept)}
ANYWHERE = ["node", "generated", "guarded"]


def _guarded_map(folder):
    path = pathlib.Path(folder) / "guarded.yaml"
    path.write_bytes(MAP.read_bytes() + GUARDS.encode())
    return path, path.read_bytes()
