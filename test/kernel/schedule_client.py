# SPDX-License-Identifier: Apache-2.0
"""A client that schedules coil 0 and waits for what becomes of it, which it prints:
  python3 schedule_client.py SECONDS [MS]     how far ahead; for how long, 0 is for ever"""
import pathlib
import struct
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support.raw_client import Listener  # noqa: E402

MOST_AHEAD = 100  # seconds
OUTCOMES = {3: "driven", 4: "cancelled", 5: "failed"}


def is_past(reply):
    """The moment was over when the request came: this machine kept it waiting."""
    return reply[:2] == bytes((0xC2, 3))


def main():
    with Listener(("127.0.0.1", 1502)) as node:
        ahead = float(sys.argv[1])
        lasts = int(sys.argv[2]) if len(sys.argv) > 2 else 0
        reply = b""
        while not reply or (lasts and is_past(reply) and ahead < MOST_AHEAD):
            due = time.monotonic_ns() + int(ahead * 1e9)
            reply = node.ask(struct.pack(">BBBIQIBHHBB", 66, 1, 1, node.epoch, due, lasts, 1, 0, 1, 1, 1))
            ahead *= 2
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
