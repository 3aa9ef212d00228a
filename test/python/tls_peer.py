# SPDX-License-Identifier: Apache-2.0
"""pymodbus' own client with TLS and a node: what its role may do, and what not. Debian 12's pymodbus leaves out the header
of Modbus/TCP inside TLS; newer ones follow the specification.

    tls_peer.py, with NODE and COUPLER in the environment
"""
import os
import pathlib
import re
import ssl
import subprocess
import sys
import tempfile

import pymodbus
from pymodbus.client import ModbusTlsClient

NODE, COUPLER = os.environ["NODE"], os.environ["COUPLER"]
MAP = """
name: press
security:
  certificate: node/node.pem
  key: node/node.key
  ca: node/authority.pem
  roles: {operator: {read: all, write: [lamp]}}
mapping:
  coils: {lamp: 0, valve: 1}
  holding_registers: {speed: {address: 0, type: UINT, initial: 4711}}
"""


def check(what, got, wanted):
    if got != wanted:
        sys.exit(f"FAILED: {what}: got {got!r}, wanted {wanted!r}")


def context(folder):
    made = ssl.create_default_context(ssl.Purpose.SERVER_AUTH, cafile=folder / "cell" / "authority.pem")
    made.check_hostname = False  # this client gives ssl no name to check
    made.load_cert_chain(folder / "cell" / "cell.pem", folder / "cell" / "cell.key")
    return made


def talk(folder, port):
    client = ModbusTlsClient("127.0.0.1", port=port, sslctx=context(folder), timeout=60)
    check("connected", client.connect(), True)
    check("a register is read", client.read_holding_registers(0, count=1).registers, [4711])
    check("a coil is written", client.write_coil(0, True).isError(), False)
    check("and reads back", client.read_coils(0, count=2).bits[:2], [True, False])
    check("no right to another one", client.write_coil(1, True).exception_code, 1)
    check("nor to a register", client.write_register(0, 1).exception_code, 1)
    client.close()


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([COUPLER, "certificates", folder, "--node", "node:127.0.0.1", "--client", "cell:operator"], check=True,
                       stdout=subprocess.DEVNULL)
        (folder / "press.yaml").write_text(MAP)
        with subprocess.Popen([NODE, "press.yaml", "--sim", "--port", "0", "--tls-port", "0"], cwd=folder, text=True,
                              stderr=subprocess.PIPE) as node:
            try:
                for line in node.stderr:
                    if found := re.search(r"TLS at 127\.0\.0\.1:(\d+)", line):
                        talk(folder, int(found[1]))
                        break
                else:
                    sys.exit("FAILED: the node does not serve by TLS")
            finally:
                node.terminate()
    print(f"ok: the client with TLS of pymodbus {pymodbus.__version__}")


main()
