# SPDX-License-Identifier: Apache-2.0
"""HOST:PORT in place of a map: COUPLER asks NODE, a program that serves a map, and devices that serve none."""
import json
import os
import socket
import subprocess
import sys
import tempfile
import threading
import unittest
import zlib
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
import served  # noqa: E402

MAP = """\
name: cell
unit: 7
mapping:
  coils: {lamp: 0}
  input_registers: {level: {address: 3, type: REAL}}
"""
SECURITY = "security: {roles: {viewer: {read: all}}, plain: viewer}\n"
TLS = "tls: {certificate: cell1.pem, key: cell1.key, ca: authority.pem}\n"


class Foreign:
    """Answers every request with one PDU; None: closes the connection."""

    def __init__(self, pdu):
        self._pdu = pdu
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = self._listener.getsockname()[1]
        threading.Thread(target=self._serve, daemon=True).start()

    def _serve(self):
        with self._listener:
            connection, _ = self._listener.accept()
            with connection:
                while request := connection.recv(260):
                    if self._pdu is None:
                        return
                    head = request[:4] + (len(self._pdu) + 1).to_bytes(2, "big") + request[6:7]
                    connection.sendall(head + self._pdu)


class Relay:
    """Stands before a node on `port`, and replaces the first by the second of each pair in what it says."""

    def __init__(self, port, pairs):
        self._node, self._pairs = port, pairs
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = self._listener.getsockname()[1]
        threading.Thread(target=self._serve, daemon=True).start()

    def _serve(self):
        with self._listener:
            client, _ = self._listener.accept()
            with client, socket.create_connection(("127.0.0.1", self._node)) as node:
                while request := client.recv(260):
                    node.sendall(request)
                    reply = node.recv(260)
                    for old, new in self._pairs:
                        reply = reply.replace(old, new)
                    client.sendall(reply)


def crc(data):
    return zlib.crc32(data).to_bytes(4, "big")


class Live(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        (self.folder / "cell.yaml").write_text(MAP, encoding="utf-8")

    def coupler(self, *arguments):
        return subprocess.run([os.environ["COUPLER"], *arguments], cwd=self.folder, capture_output=True,
                              text=True, encoding="utf-8", check=False)

    def node(self, text=None):
        """Serves cell.yaml, with `text` in it if that is given."""
        if text is not None:
            (self.folder / "cell.yaml").write_text(text, encoding="utf-8")
        node = served.Served([os.environ["NODE"], str(self.folder / "cell.yaml"), "--sim", "--port", "0"])
        self.addCleanup(node.stop)
        return f"tcp://127.0.0.1:{node.port}/7"

    def refused(self, status, argument):
        done = self.coupler("check", argument)
        self.assertEqual((done.returncode, done.stdout), (status, ""))
        self.assertTrue(done.stderr.startswith(f"{argument}: error: "), done.stderr)
        return done.stderr


class ANode(Live):
    def test_is_checked_like_its_file(self):
        node = self.node()
        of_file = json.loads(self.coupler("check", "--json", "cell.yaml").stdout)
        done = self.coupler("check", "--json", node)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(json.loads(done.stdout), {**of_file, "file": node})

    def test_that_is_newer_asks_for_an_update_of_this_side(self):
        known = MAP.replace("lamp: 0", "door: {address: 1, access: read}")
        newer = known.replace("access: read", "access: rest")
        port = int(self.node(known).split(":")[2].split("/")[0])
        pairs = [[of(text.encode()) for text in (known, newer)] for of in (bytes, crc)]
        said = self.refused(1, f"tcp://127.0.0.1:{Relay(port, pairs).port}/7")
        self.assertRegex(said, r"it does not load in coupler \d+\.\d+\.\d+; if the node has a newer one, update this one\n"
                         r".*'access' must be one of read, write, read_write, not 'rest'\n")

    def test_is_planned(self):
        done = self.coupler("plan", "--json", self.node())
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout)["name"], "cell")

    def test_generates_the_same_table_with_the_connection_that_was_given(self):
        node = self.node()
        self.assertEqual(self.coupler("generate", "--quiet", "cell.yaml", "--out", "of_file").returncode, 0)
        done = self.coupler("generate", "--quiet", node, "--out", "of_node")
        self.assertEqual(done.returncode, 0, done.stderr)
        table = (self.folder / "of_node/cell_map.cpp").read_text(encoding="utf-8")
        self.assertIn('"127.0.0.1"', table)
        self.assertIn('"level"', table)

    def test_is_documented_without_links_to_a_file(self):
        done = self.coupler("generate", "--docs", self.node(), "--out", "pages")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("](", (self.folder / "pages/cell.md").read_text(encoding="utf-8"))

    def test_with_roles_makes_nothing_that_would_lack_them(self):
        node = self.node(SECURITY + MAP)
        for out in (["--out", "made"], ["--docs", "--out", "made"]):
            done = self.coupler("generate", node, *out)
            self.assertEqual((done.returncode, done.stdout), (1, ""))
            self.assertIn("the node's map has 'security', and what is made from a node would be without it; "
                          "give the file of its map", done.stderr)
            self.assertFalse((self.folder / "made").exists())

    def test_with_roles_makes_what_has_none(self):
        node = self.node(SECURITY + MAP)
        for what, made in (("--python", "cell_client.py"), ("--vectors", "cell_vectors.json")):
            done = self.coupler("generate", node, what)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertTrue((self.folder / made).exists())

    def test_that_is_to_be_reached_by_TLS_makes_no_client_without_it(self):
        done = self.coupler("generate", self.node(TLS + MAP), "--out", "made")
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("the node's map has 'tls', ", done.stderr)

    def test_is_compared_with_its_file(self):
        for more in ("", "verify: warn\n", SECURITY, TLS):
            with self.subTest(more):
                node = self.node(more + MAP)
                for versions in (["cell.yaml", node], [node, "cell.yaml"]):
                    done = self.coupler("diff", *versions, "--fail-on", "documentation")
                    self.assertEqual((done.returncode, done.stderr), (0, ""), done.stdout)
                    self.assertIn("no difference", done.stdout)

    def test_that_differs_from_its_file_is_told(self):
        node = self.node("verify: warn\n" + MAP)
        (self.folder / "cell.yaml").write_text("verify: off\nrate: 3\n" + MAP.replace("lamp: 0", "lamp: 1"),
                                               encoding="utf-8")
        done = self.coupler("diff", "cell.yaml", node)
        self.assertEqual(done.returncode, 1)
        self.assertIn("address-moved", done.stdout)
        self.assertIn("map-rate-changed", done.stdout)
        self.assertNotIn("verify-changed", done.stdout)

    def test_is_the_same_however_its_place_is_written(self):
        url = self.node()
        bare = url.removeprefix("tcp://")
        for place in (bare, bare.replace("127.0.0.1", "localhost")):
            for command in (["check"], ["plan"], ["diff", "cell.yaml"], ["export", "--to", "csv"],
                            ["generate", "--vectors", "--out", "-"]):
                with self.subTest(place=place, command=command):
                    by_url, by_host = (self.coupler(*command, node) for node in (url, place))
                    self.assertEqual((by_host.returncode, by_host.stderr.replace(place, url)), (0, by_url.stderr))
                    self.assertEqual(by_host.stdout.replace(place, url), by_url.stdout)

    def test_gives_way_to_a_file_of_that_name(self):
        place = self.node(MAP.replace("cell", "served")).removeprefix("tcp://127.0.0.1:").removesuffix("/7")
        (self.folder / place).write_text(MAP, encoding="utf-8")
        self.assertIn("ok: cell, ", self.coupler("check", place).stdout)

    def test_exports_its_own_address(self):
        node = self.node()
        done = self.coupler("export", node, "--to", "telegraf")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(node.removesuffix("/7"), done.stdout)


class At(Live):
    def test_without_TLS_has_the_port_without_TLS(self):
        port = self.node().split(":")[2].removesuffix("/7")
        (self.folder / "there.yaml").write_text(f"port: {port}\n" + TLS.replace("{", "{port: 1, ") + MAP, encoding="utf-8")
        done = self.coupler("dump", "there.yaml", "--at", "tcp://127.0.0.1")
        self.assertEqual(done.returncode, 0, done.stderr)


class Fetch(Live):
    def test_saves_the_map_byte_for_byte(self):
        text = "# Größe\r\n" + SECURITY + MAP + "\n\n"
        node = self.node(text)
        served = (self.folder / "cell.yaml").read_bytes()
        for place, option in ((node, "-o"), (node.removeprefix("tcp://"), "--out")):
            done = self.coupler("fetch", place, option, "saved.yaml", "--force")
            self.assertEqual((done.returncode, done.stdout), (0, ""), done.stderr)
            self.assertEqual((self.folder / "saved.yaml").read_bytes(), served)
        said = done.stderr.splitlines()
        fingerprint = json.loads(self.coupler("check", "--json", node).stdout)["fingerprint"]
        self.assertEqual(said[0], f"saved.yaml: ok: cell, 2 points (1 coil, 1 input register), fingerprint {fingerprint}")
        place = node.removeprefix("tcp://")
        self.assertEqual(said[1], f"Next: `coupler dump saved.yaml --at {place}` shows its values; after a change "
                                  f"`coupler diff {place} saved.yaml` says what it means")

    def test_of_a_map_with_TLS_says_how_to_ask_without(self):
        node = self.node(MAP + TLS)
        said = self.coupler("fetch", node.removeprefix("tcp://"), "-o", "saved.yaml").stderr.splitlines()
        self.assertIn(f"`coupler dump saved.yaml --at {node}` shows", said[1])
        done = self.coupler("dump", "saved.yaml", "--at", node)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_writes_to_standard_output(self):
        node = self.node()
        for out in ([], ["-o", "-"]):
            done = self.coupler("fetch", node, *out)
            self.assertEqual((done.returncode, done.stdout), (0, MAP))
            self.assertEqual(len(done.stderr.splitlines()), 1)

    def test_replaces_no_file(self):
        done = self.coupler("fetch", "tcp://127.0.0.1:1", "-o", "cell.yaml")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("cell.yaml already exists; name another file with --out, or replace it with --force", done.stderr)
        self.assertIn("nowhere is not a folder", self.coupler("fetch", "tcp://127.0.0.1:1", "-o", "nowhere/a.yaml").stderr)

    def test_saves_nothing_of_a_damaged_map(self):
        port = int(self.node().split(":")[2].split("/")[0])
        relay = Relay(port, [(b"lamp", b"limp")])
        done = self.coupler("fetch", f"127.0.0.1:{relay.port}/7", "-o", "saved.yaml")
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("the node's map cannot be used: checksum ", done.stderr)
        self.assertFalse((self.folder / "saved.yaml").exists())

    def test_of_another_device_says_how_to_get_a_map(self):
        done = self.coupler("fetch", f"127.0.0.1:{Foreign(bytes([0x84, 2])).port}")
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertRegex(done.stderr, r"^coupler fetch: error: tcp://127.0.0.1:\d+/1: a foreign coupler, which serves no map; "
                                      r"`coupler probe 127.0.0.1:\d+/1 --out FILE` drafts one")

    def test_of_a_map_is_a_wrong_call(self):
        for command in ("fetch", "probe", "status"):
            done = self.coupler(command, "cell.yaml")
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn("'cell.yaml' is a map, and this asks a device; give HOST[:PORT][/UNIT]", done.stderr)


class NoNode(Live):
    def test_a_closed_port_is_a_failed_network(self):
        with socket.socket() as unused:
            unused.bind(("127.0.0.1", 0))  # not listening
            said = self.refused(3, f"tcp://127.0.0.1:{unused.getsockname()[1]}")
        self.assertIn("no answer from a node", said)

    def test_a_foreign_coupler_has_no_map(self):
        said = self.refused(1, f"tcp://127.0.0.1:{Foreign(bytes([0x84, 2])).port}")
        self.assertRegex(said, r"foreign coupler, which serves no map; `coupler probe 127.0.0.1:\d+/1 --out FILE` drafts one")

    def test_a_device_that_does_not_like_the_question_may_be_anything(self):
        self.assertRegex(self.refused(3, f"tcp://127.0.0.1:{Foreign(None).port}"),
                         r"; if it is none, `coupler probe 127.0.0.1:\d+/1` says what it answers to\n")

    def test_a_device_that_hangs_up_is_a_failed_network(self):
        self.refused(3, f"tcp://127.0.0.1:{Foreign(None).port}")

    def test_a_gateway_without_the_unit_is_a_failed_network(self):
        said = self.refused(3, f"tcp://127.0.0.1:{Foreign(bytes([0x84, 0x0B])).port}/9")
        self.assertIn("0B", said)

    def test_an_argument_that_names_no_node_is_a_wrong_call(self):
        said = self.refused(2, "tcp://127.0.0.1:0")
        self.assertIn("the port '0' is not 1 to 65535; write tcp://HOST[:PORT][/UNIT]", said)


if __name__ == "__main__":
    unittest.main()
