#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Two clients that read a discrete input again and again, each over its one connection: with TLS and without. What it says
is printed when it is another one: "tls 0", "tls exception 4", "plain closed".

    sessions.py PORT TLS_PORT FOLDER ADDRESS     FOLDER: client.pem, client.key, authority.pem
"""
import socket
import ssl
import sys
import time

PORT, TLS_PORT = (int(text) for text in sys.argv[1:3])
FOLDER = sys.argv[3]
REQUEST = bytes((0, 1, 0, 0, 0, 6, 1, 2, 0, int(sys.argv[4]), 0, 1))


def connect(port):
    return socket.create_connection(("127.0.0.1", port), 60)


def outcome(client):
    try:
        client.sendall(REQUEST)
        reply = client.recv(300)
    except OSError:
        reply = b""
    if len(reply) < 9:
        return "closed"
    return f"exception {reply[8]}" if reply[7] & 0x80 else str(reply[9])


context = ssl.create_default_context(ssl.Purpose.SERVER_AUTH, cafile=f"{FOLDER}/authority.pem")
context.load_cert_chain(f"{FOLDER}/client.pem", f"{FOLDER}/client.key")
clients = {"plain": connect(PORT), "tls": context.wrap_socket(connect(TLS_PORT), server_hostname="127.0.0.1")}
said = {}
while True:
    for name, client in clients.items():
        now = outcome(client)
        if said.get(name) != now:
            print(name, now, flush=True)
        said[name] = now
    time.sleep(0.02)
