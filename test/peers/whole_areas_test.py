#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A server of pymodbus that gives some registers in one piece only: `coupler dump` reads them, also a few of its points.

    whole_areas_test.py COUPLER
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import peer

try:
    import foreign_server
except ImportError as error:
    peer.skip(f"python3-pymodbus is missing ({error}); run scripts/install-packages test")

MAP = """name: meter
timeout: 20s
verify: off
registers_read_continuous: true
read_whole:
  - {table: input_registers, from: 10, to: 19}
  - {table: input_registers, from: 30, to: 33}
mapping:
  input_registers:
    before: {address: 9, type: UINT}
    first:  {address: 11, type: UINT}
    second: {address: 15, type: UINT}
    other:  {address: 32, type: UINT, rate: 1}
"""


def values(coupler, map_file, port, checks, *options):
    done = subprocess.run([coupler, "dump", map_file, "--at", f"127.0.0.1:{port}", "--json", *options], capture_output=True,
                          text=True, encoding="utf-8", timeout=peer.PATIENCE, check=False)
    checks.equal(f"status of the dump, and its errors {options}", (done.returncode, done.stderr), (0, ""))
    return {point["point"]: point["value"] for point in json.loads(done.stdout)["points"]}


def main():
    coupler = sys.argv[1]
    checks = peer.Checks()
    has = {at: 100 + at for at in range(5, 34)}
    device = foreign_server.Device({"input_registers": has}, whole=[range(10, 20), range(30, 34)])
    with tempfile.TemporaryDirectory() as name, foreign_server.serving(device) as port:
        map_file = pathlib.Path(name) / "meter.yaml"
        map_file.write_text(MAP, encoding="utf-8")
        for options, names in (((), ["before", "first", "second", "other"]), (("--points", "second"), ["second"]),
                               (("--points", "other,first"), ["first", "other"])):
            expected = {"before": 109, "first": 111, "second": 115, "other": 132}
            checks.equal(f"values {options}", values(coupler, map_file, port, checks, *options),
                         {name: expected[name] for name in names})
        checks.equal("no request was refused", device.refused, [])
        map_file.write_text("".join(line for line in MAP.splitlines(True) if "from:" not in line and "whole" not in line),
                            encoding="utf-8")
        subprocess.run([coupler, "dump", map_file, "--at", f"127.0.0.1:{port}"], capture_output=True, timeout=peer.PATIENCE,
                       check=False)
        checks.equal("without the key it is", device.refused != [], True)
    checks.done("areas that a device gives whole are read whole")


main()
