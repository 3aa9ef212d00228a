#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The maps that a newcomer begins with: pymodbus and mbpoll read and write numbers and texts as they read those of others.

    first_map_test.py NODE COUPLER EXAMPLE
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import peer

try:
    from pymodbus.constants import Endian
    from pymodbus.payload import BinaryPayloadBuilder, BinaryPayloadDecoder
except ImportError as error:
    peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")

NODE, COUPLER, EXAMPLE = sys.argv[1:4]
BIG = {"byteorder": Endian.Big, "wordorder": Endian.Big}
FIELD_SIDE = 247


def run(*command):
    return subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=peer.PATIENCE, check=False)


def decoder(answer):
    return BinaryPayloadDecoder.fromRegisters(answer.registers, **BIG)


def mbpoll(port, kind, address):
    """The first value, as mbpoll prints it. -B: the most significant register comes first."""
    done = run("mbpoll", "-m", "tcp", "-p", port, "-0", "-1", "-B", "-o", 10, "-t", kind, "-r", address, "127.0.0.1")
    found = re.search(r"^\[\d+\]:\s*(\S+)", done.stdout, re.M)
    return found.group(1) if found else done.stdout + done.stderr


def values(port, map_file):
    """What the project's own client reads."""
    done = run(COUPLER, "dump", map_file, "--at", f"tcp://127.0.0.1:{port}", "--json")
    return {point["point"]: point.get("value") for point in json.loads(done.stdout)["points"]}


def map_of_init(checks):
    with tempfile.TemporaryDirectory() as folder:
        map_file = pathlib.Path(folder, "cell.yaml")
        checks.equal("coupler init", run(COUPLER, "init", "cell", "--node", "--out", map_file).returncode, 0)
        port = re.search(r"^port: (\d+)\b", map_file.read_text(encoding="utf-8"), re.M)
        checks.equal("its port is one that every user may open", bool(port) and int(port.group(1)) > 1023, True)
        with peer.running_node([NODE, str(map_file), "--sim"]) as port:
            client = peer.pymodbus_client(port)
            checks.equal("connected", client.connect(), True)
            for level in (True, False, True, False):
                client.write_coil(0, level, FIELD_SIDE)
            checks.equal("UDINT by pymodbus", decoder(client.read_input_registers(0, 2, 1)).decode_32bit_uint(), 2)
            checks.equal("UDINT by mbpoll", mbpoll(port, "3:int", 0), "2")

            wanted = BinaryPayloadBuilder(**BIG)
            wanted.add_32bit_float(-2.5)
            wanted.add_string("Apple pie".ljust(16, "\0"))
            checks.equal("a write by pymodbus", client.write_registers(0, wanted.to_registers(), 1).isError(), False)
            got = values(port, map_file)
            checks.equal("REAL and STRING that pymodbus wrote", (got["setpoint"], got["recipe"]), (-2.5, "Apple pie"))
            checks.equal("REAL by mbpoll", mbpoll(port, "4:float", 0), "-2.5")
            done = run("mbpoll", "-m", "tcp", "-p", port, "-0", "-1", "-B", "-t", "4:float", "-r", 0, "127.0.0.1", "0.1")
            checks.equal("a write by mbpoll", "Written" in done.stdout, True)
            checks.equal("REAL that mbpoll wrote", round(values(port, map_file)["setpoint"], 6), 0.1)
            client.close()


def example(checks):
    with peer.running_node([NODE, EXAMPLE, "--sim"]) as port:
        client = peer.pymodbus_client(port)
        checks.equal("connected", client.connect(), True)
        got = decoder(client.read_holding_registers(0, 11, 1))
        checks.equal("INT", got.decode_16bit_int(), 100)
        checks.equal("REAL", got.decode_32bit_float(), 1.5)
        got.skip_bytes(4)
        checks.equal("STRING", got.decode_string(12), b"unnamed".ljust(12, b"\0"))
        checks.equal("UDINT", decoder(client.read_input_registers(1, 2, 1)).decode_32bit_uint(), 20210907)
        checks.equal("REAL by mbpoll", mbpoll(port, "4:float", 1), "1.5")
        checks.equal("UDINT by mbpoll", mbpoll(port, "3:int", 1), "20210907")
        client.close()


def main():
    if not shutil.which("mbpoll"):
        peer.skip("mbpoll is missing; run scripts/install-packages test")
    checks = peer.Checks()
    peer.side_by_side((map_of_init, checks), (example, checks))
    checks.done("pymodbus and mbpoll read and write the first map of a node as they do those of others")


main()
