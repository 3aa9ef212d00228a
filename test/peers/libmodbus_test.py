#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A node's replies equal those of libmodbus's server.

    libmodbus_test.py ORACLE COUPLER_NODE
"""
import os
import pathlib
import subprocess
import sys
import tempfile

import peer


def main():
    oracle, node = sys.argv[1:]
    if not os.access(oracle, os.X_OK):
        peer.skip("the oracle was not built, libmodbus is missing; run scripts/install-packages build")
    with tempfile.TemporaryDirectory() as folder:
        map_file = pathlib.Path(folder) / "oracle.yaml"
        map_file.write_text(subprocess.run([oracle, "--map"], capture_output=True, text=True, check=True).stdout)
        with peer.running_node([node, str(map_file), "--sim"]) as port:
            done = subprocess.run([oracle, str(port)], timeout=peer.PATIENCE, check=False)
    sys.exit(done.returncode)


main()
