# SPDX-License-Identifier: Apache-2.0
"""A client that schedules coil 0 and waits for what becomes of it, which it prints:
  python3 schedule_client.py SECONDS [MS]     how far ahead; for how long, 0 is for ever"""
import pathlib
import struct
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support.raw_client import Listener  # noqa: E402

OUTCOMES = {3: "driven", 4: "cancelled", 5: "failed"}


def main():
    with Listener(("127.0.0.1", 1502)) as node:
        due = time.monotonic_ns() + int(float(sys.argv[1]) * 1e9)
        lasts = int(sys.argv[2]) if len(sys.argv) > 2 else 0
        reply = node.ask(struct.pack(">BBBIQIBHHBB", 66, 1, 1, node.epoch, due, lasts, 1, 0, 1, 1, 1))
        print("scheduled" if reply[0] == 66 else f"exception {reply[1]:02}", flush=True)
        try:
            while reply[0] == 66:
                for table, kind, address, _ in node.take(node.ask(node.request())).changes:
                    if kind in OUTCOMES:
                        print(f"{OUTCOMES[kind]}, reason {table}", flush=True)
                    elif (table, address) == (1, 0):
                        print(f"coil 0 is {kind}", flush=True)
        except (EOFError, ConnectionError):
            print("the connection ended", flush=True)


main()
