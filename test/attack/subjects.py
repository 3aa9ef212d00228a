# SPDX-License-Identifier: Apache-2.0
"""What is attacked: nodes that all serve map.yaml, made and set up in different ways."""
import dataclasses
import pathlib
import subprocess

MAP = pathlib.Path(__file__).resolve().parent / "map.yaml"
FLOODER = "127.0.0.2"  # an address that every node lets in
ATTACKER = "127.0.0.66"  # an address that a guarded node refuses
TIMEOUT = 1.0  # seconds of a guarded node's watchdog
SECURITY = """security:
  certificate: node/node.pem
  key: node/node.key
  ca: node/authority.pem
  roles:
    everything: {read: all, write: all}
  plain: everything
"""
GUARDS = "watchdog: {timeout: 1s}\nallow: [127.0.0.1, 127.0.0.2]\n"


@dataclasses.dataclass
class Subject:
    """`guarded`: it has a watchdog and a list of allowed clients. `wired`: inputs 0 to 7 show outputs 0 to 7."""
    command: list
    map_text: bytes
    guarded: bool = False
    wired: bool = True
    certificates: pathlib.Path | None = None  # of a node with TLS; only that is attacked there

    def meets(self, attack):
        return attack.tls == (self.certificates is not None) and (self.guarded or not attack.guarded)


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


def secured(build, folder):
    """with TLS, where all attacks are made by that; the bystander has none"""
    folder = pathlib.Path(folder)
    subprocess.run([build / "bin" / "coupler", "certificates", folder, "--node", "node:127.0.0.1", "--client",
                    "client:everything"], check=(build / "bin" / "coupler-node-tls").exists(), capture_output=True)
    text = MAP.read_text() + SECURITY
    path = folder / "secured.yaml"
    path.write_text(text)
    return Subject([build / "bin" / "coupler-node", path, "--sim", "--port", "0", "--tls-port", "0"], text.encode(),
                   certificates=folder)


SUBJECTS = {make.__name__: make for make in (node, generated, guarded, kept, secured)}
ANYWHERE = ["node", "generated", "guarded", "secured"]


def _guarded_map(folder):
    path = pathlib.Path(folder) / "guarded.yaml"
    path.write_bytes(MAP.read_bytes() + GUARDS.encode())
    return path, path.read_bytes()
