# SPDX-License-Identifier: Apache-2.0
"""The client in Python and a node with TLS: whom each believes, and what a role may do."""
import errno
import os
import pathlib
import re
import ssl
import subprocess
import sys
import unittest

import made

if not pathlib.Path(os.environ["NODE"]).with_name("coupler-node-tls").exists():
    print("skipped: this build has no TLS")
    sys.exit(77)

MAP = """\
name: cell
security:
  certificate: node/node.pem
  key: node/node.key
  ca: node/authority.pem
  roles: {operator: {read: all, write: [lamp, "row*"]}}
mapping:
  coils: {lamp: 0, valve: 1}
  holding_registers:
    speed: {address: 0, type: UINT, initial: 4711}
    row_a: {address: 100, type: INT, count: 100}
    row_b: {address: 200, type: INT, count: 100}
"""
OF_A_MAP = "tls: {certificate: cell1/cell1.pem, key: cell1/cell1.key, ca: cell1/authority.pem, name: node.local}\n"


class OverTls(made.Made):
    def setUp(self):
        super().setUp()
        for folder in ("plant", "stranger"):
            done = self.coupler("certificates", folder, "--node", "node:127.0.0.1,node.local", "--client", "cell1:operator")
            self.assertEqual(done.returncode, 0, done.stderr)
        (self.folder / "plant/cell.yaml").write_text(MAP, encoding="utf-8")
        # pylint: disable-next=consider-using-with
        node = subprocess.Popen([os.environ["NODE"], "cell.yaml", "--sim", "--listen", "127.0.0.1", "--port", "0", "--tls-port",
                                 "0"], cwd=self.folder / "plant", stderr=subprocess.PIPE, text=True)
        self.addCleanup(node.stderr.close)
        self.addCleanup(node.wait)
        self.addCleanup(node.terminate)
        self.port = next(int(found[1]) for line in node.stderr if (found := re.search(r"TLS at 127\.0\.0\.1:(\d+)", line)))
        self.module, self.kind = self.client(MAP)

    def tls(self, **changes):
        plant = self.folder / "plant/cell1"
        return self.module.Tls(**{"certificate": str(plant / "cell1.pem"), "key": str(plant / "cell1.key"),
                                  "ca": str(plant / "authority.pem"), **changes})

    def cell(self, tls):
        client = self.kind("127.0.0.1", self.port, timeout=made.PATIENCE, tls=tls)
        self.addCleanup(client.disconnect)
        return client

    def fails(self, tls, kind="NotConnected"):
        with self.assertRaises(getattr(self.module, kind)) as caught:
            with self.cell(tls) as cell:
                cell.speed.read()
        return caught.exception

    def carries_values(self, tls):
        with self.cell(tls) as cell:
            cell.lamp.write(True)
            cell.row_a.write(list(range(100)))
            cell.row_b.write(list(range(100, 200)))
            for _ in range(20):
                self.assertEqual(cell.read_all(), {"lamp": True, "valve": False, "speed": 4711, "row_a": list(range(100)),
                                                   "row_b": list(range(100, 200))})
            with self.assertRaises(self.module.ExceptionReply) as caught:
                cell.valve.write(True)
            self.assertEqual(caught.exception.code, 1)

    def test_a_role_carries_its_values(self):
        self.carries_values(self.tls())

    def test_changes_are_told(self):
        with self.cell(self.tls()) as cell:
            changes = cell.changes(cell.lamp, period=3600)
            self.assertIs(next(changes).value, False)
            cell.lamp.write(True)
            self.assertIs(next(changes).value, True)
            changes.close()

    def test_a_context_of_the_users_own_does_as_well(self):
        context = ssl.create_default_context(cafile=self.folder / "plant/cell1/authority.pem")
        context.load_cert_chain(self.folder / "plant/cell1/cell1.pem", self.folder / "plant/cell1/cell1.key")
        self.carries_values(context)

    def test_the_certificate_must_have_the_name(self):
        self.carries_values(self.tls(name="node.local"))
        error = self.fails(self.tls(name="another.local"))
        self.assertIn("another.local", str(error))
        self.assertIsInstance(error.__cause__, ssl.SSLCertVerificationError)
        self.assertIsNone(error.errno)

    def test_another_authority_is_not_believed_by_either_side(self):
        stranger = self.folder / "stranger/cell1"
        self.assertIn("certificate verify failed", str(self.fails(self.tls(ca=str(stranger / "authority.pem")))))
        refused = self.fails(self.tls(certificate=str(stranger / "cell1.pem"), key=str(stranger / "cell1.key")))
        self.assertIsInstance(refused.__cause__, self.module.Lost)

    def test_a_pin_believes_one_certificate(self):
        shown = [self.coupler("pin", f"{plant}/node/node.pem") for plant in ("plant", "stranger")]
        if "built without libmodbus" in shown[0].stderr:
            self.skipTest("this build has no coupler pin")
        pins = [one.stdout.split()[0] for one in shown]
        self.carries_values(self.tls(ca="", pin=pins[0], name="whoever"))
        self.carries_values(self.tls(ca="", pin=pins[0].upper().replace("SHA", "sha")))
        self.assertIn(f"has the pin {pins[0]}", str(self.fails(self.tls(ca="", pin=pins[1]))))

    def test_a_file_that_cannot_be_used_is_named(self):
        error = self.fails(self.tls(key="nowhere.key"))
        self.assertEqual(str(error), "cannot use nowhere.key: No such file or directory; check the files of tls")
        self.assertEqual(error.errno, errno.ENOENT)
        wrong = str(self.folder / "plant/node/node.key")
        self.assertIn(f"cell1.pem with {wrong}: ", str(self.fails(self.tls(key=wrong))))
        wrong = str(self.folder / "plant/cell.yaml")
        self.assertIn(f"cannot use {wrong}: ", str(self.fails(self.tls(ca=wrong))))

    def test_what_is_no_tls_is_a_value_error(self):
        for changes in ({"certificate": ""}, {"key": ""}, {"ca": ""}, {"pin": "sha256:" + 64 * "0"},
                        {"ca": "", "pin": "sha256:12"}, {"ca": "", "pin": 64 * "0"}):
            with self.assertRaisesRegex(ValueError, "^tls: "):
                self.tls(**changes)

    @made.LIVE
    def test_the_command_for_another_map_reaches_the_node(self):
        self.module, self.kind = self.client(MAP.replace("lamp: 0", "lamp: 7"))
        command = str(self.fails(self.tls(name="node.local"), "OtherMap")).split("`")[1].split()
        self.assertIn("lamp: 7 -> 0", self.coupler("diff", "cell.yaml", *command[3:]).stdout)

    def test_the_map_may_say_it(self):
        self.module, self.kind = self.client(MAP.replace("security:", OF_A_MAP + "security:\n  port: 8802"))
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder / "plant")
        with self.kind("127.0.0.1", self.port, timeout=made.PATIENCE) as cell:
            self.assertEqual(cell.speed.read(), 4711)


if __name__ == "__main__":
    unittest.main(warnings="ignore")
