# SPDX-License-Identifier: Apache-2.0
"""A driver and a node with TLS: roles, certificates that one of them does not believe, a reload."""
import pathlib
import os
import subprocess
import sys
import tempfile
import unittest

from diagnostic_msgs.msg import DiagnosticStatus
from std_msgs.msg import Bool, UInt16

from support import process, testing
from support.latest import LatestDiagnostics, values

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "peers"))
from authority import Authority  # noqa: E402

POINTS = """
mapping:
  coils: {lamp: 0, valve: 1}
  holding_registers:
    speed: {address: 7, type: UINT}
"""
NODE = """
name: {name}
security:
  certificate: press/press.pem
  key: press/press.key
  ca: press/authority.pem
  roles:
    operator: {read: all, write: [lamp, speed]}
    viewer: {read: [lamp]}
"""


@unittest.skipUnless(process.has_node(), "coupler-node was not built")
class Tls(testing.RosTest):
    at_once = True

    def setUp(self):
        super().setUp()
        self.folder = pathlib.Path(tempfile.mkdtemp(dir=os.environ["ROS_HOME"]))
        self.certificates(self.folder)
        self.node_map = self.folder / "node.yaml"
        self.node_map.write_text(self.node_text())
        self.node = process.Node(str(self.node_map), "--tls-port", 0)
        self.addCleanup(self.node.end)

    def node_text(self):
        return NODE.replace("{name}", self.name) + POINTS

    @staticmethod
    def certificates(folder):
        done = subprocess.run(
            [process.BUILD / "bin" / "coupler", "certificates", folder, "--node", "press:127.0.0.1", "--client",
             "cell1:operator", "--client", "screen:viewer"], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr

    def start(self, client="cell1", more="", *arguments):
        """A driver whose map has the files of that client."""
        path = self.folder / f"{client}.yaml"
        path.write_text(f"name: {self.name}\naddress: 127.0.0.1\nrate: 20\ntimeout: 60\ntls: {{certificate: {client}/{client}.pem, "
                        f"key: {client}/{client}.key, ca: {client}/authority.pem{more}}}\n" + POINTS)
        return self.driver(f"_map:={path}", f"_port:={self.node.tls_port}", *arguments)

    def test_a_role_that_may_read_and_write_does(self):
        driver = self.start()
        driver.wait_for("connected")
        self.topic(f"/{self.name}/speed", UInt16).wait_for(lambda value: value == 0)
        self.publisher(f"/{self.name}/speed/write", UInt16).publish(4711)
        self.topic(f"/{self.name}/speed", UInt16).wait_for(lambda value: value == 4711)
        self.publisher(f"/{self.name}/valve/write", Bool).publish(True)
        driver.wait_for("write to valve: exception 01 (illegal function): this client has no right to write it")

    def test_a_role_that_may_read_some_points_gets_those(self):
        driver = self.start("screen")
        lamp = self.topic(f"/{self.name}/lamp", Bool)
        lamp.wait_for(lambda value: value is False)
        driver.wait_for("speed")  # it is said once that it is rejected
        self.assertEqual(self.topic(f"/{self.name}/speed", UInt16).ever, [])

    def test_without_a_map_it_gets_the_nodes(self):
        own = self.folder / "cell1"
        driver = self.driver("--map", f"tls://127.0.0.1:{self.node.tls_port}", f"_certificate:={own}/cell1.pem",
                             f"_key:={own}/cell1.key", f"_ca:={own}/authority.pem")
        driver.wait_for("connected")
        self.topic(f"/{self.name}/speed", UInt16).wait_for(lambda value: value == 0)

    def test_a_certificate_of_another_authority_is_refused_and_the_alert_is_named(self):
        stranger = self.folder / "stranger"
        stranger.mkdir()
        self.certificates(stranger)
        for kind in ("pem", "key"):
            (self.folder / "cell1" / f"cell1.{kind}").write_bytes((stranger / "cell1" / f"cell1.{kind}").read_bytes())
        driver = self.start()
        driver.wait_for("unknown_ca")

    def test_a_node_with_another_name_is_not_believed(self):
        driver = self.start("cell1", ", name: lathe")
        driver.wait_for("its certificate is for another name or address")

    def test_a_certificate_that_soon_ends_is_a_warning_in_the_log_and_in_the_diagnostics(self):
        diagnostics = LatestDiagnostics(self.name)
        self.addCleanup(diagnostics.close)
        first = self.start()
        diagnostics.says("good until", "certificates", DiagnosticStatus.OK)
        first.end()
        other = self.folder / "other"
        other.mkdir()
        authority = Authority(other, "authority")
        authority.client("other", "ASN1:UTF8String:operator", dates=("-startdate", "20200101000000Z", "-days", "7"))
        with open(self.folder / "press" / "authority.pem", "a", encoding="ascii") as believed:
            believed.write((other / "authority.pem").read_text())
        (other / "authority.pem").write_bytes((self.folder / "cell1" / "authority.pem").read_bytes())
        self.node.reload()
        self.node.wait_for("read the map again")
        driver = self.start("other")
        driver.wait_for("this machine's certificate expires on")
        entry = diagnostics.says("this machine's certificate expires on", "certificates", DiagnosticStatus.WARN)
        self.assertEqual([values(entry)[key] for key in ("this machine", "role", "the device")], ["other", "operator", "press"])

    def test_rights_that_a_reload_takes_away_are_gone_on_the_same_connection(self):
        driver = self.start()
        speed = self.topic(f"/{self.name}/speed", UInt16)
        speed.wait_for(lambda value: value == 0)
        self.node_map.write_text(self.node_text().replace("write: [lamp, speed]", "write: [lamp]"))
        self.node.reload()
        self.node.wait_for("read the map again")
        self.publisher(f"/{self.name}/speed/write", UInt16).publish(7)
        driver.wait_for("write to speed: exception 01")
        self.assertEqual(driver.output.count("connected"), 1, driver.output)


if __name__ == "__main__":
    testing.main()
