# SPDX-License-Identifier: Apache-2.0
"""A client that waits for the changes of discrete input INPUT, beside whatever else happens. "listening" comes first; once it
is interrupted it prints how many it was told, and how many changes were lost to it.
  python3 heard_changes.py INPUT"""
import pathlib
import signal
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support.raw_client import Listener  # noqa: E402


def main():
    told = lost = 0
    ended = []
    signal.signal(signal.SIGINT, lambda *_: ended.append(True))
    with Listener(("127.0.0.1", 1502)) as node:
        print("listening", flush=True)
        while True:
            reply = node.take(node.ask(node.request(100)))
            told += sum((table, address) == (2, int(sys.argv[1])) for table, _, address, _ in reply.changes)
            lost += reply.lost
            if ended and node.seen == reply.newest:
                break
    print(f"told {told}, lost {lost}", flush=True)


main()
