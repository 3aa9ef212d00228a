# SPDX-License-Identifier: Apache-2.0
"""serves.py NODE MAP: the node serves the map's simulated lines, and stops when asked."""
import pathlib
import socket
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "support"))
from served import Served  # noqa: E402

with Served([sys.argv[1], sys.argv[2], "--sim", "--port", "0"]) as node:
    with socket.create_connection(("127.0.0.1", node.port), 10) as client:
        client.sendall(bytes.fromhex("000100000006 01 04 ff00 0002"))
        reply = client.recv(64)
    assert reply == bytes.fromhex("000100000007 01 04 04 4f43504c"), f"not the identity area's magic: {reply.hex()}"
    assert node.stop() == 0, node.log()
print("the node serves, and stops when asked")
