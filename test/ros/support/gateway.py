# SPDX-License-Identifier: Apache-2.0
"""A gateway in front of a node: it hands on one request at a time, but no wait for changes."""
import socket
import struct
import threading

from support.ports import free_port

WAIT_FOR_CHANGES = 65


class Gateway:
    """`refuses_with`: the exception code that answers a wait; None: nothing does."""

    def __init__(self, node_port, refuses_with):
        self._node_port = node_port
        self._refuses_with = refuses_with
        self.port = free_port()
        self.accepted = 0
        self.waits = 0  # that came
        self._listener = socket.create_server(("127.0.0.1", self.port))
        threading.Thread(target=self._accept, daemon=True).start()

    def stop(self):
        self._listener.shutdown(socket.SHUT_RDWR)
        self._listener.close()

    def _accept(self):
        while True:
            try:
                client, _ = self._listener.accept()
            except OSError:
                return
            self.accepted += 1
            threading.Thread(target=self._serve, args=(client,), daemon=True).start()

    def _serve(self, client):
        try:
            with client, socket.create_connection(("127.0.0.1", self._node_port)) as node:
                client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                node.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                requests, replies = client.makefile("rb"), node.makefile("rb")
                while request := _frame(requests):
                    if request[7] == WAIT_FOR_CHANGES:
                        self._refuse(client, request)
                        continue
                    node.sendall(request)
                    client.sendall(_frame(replies))
        except OSError:
            pass

    def _refuse(self, client, request):
        self.waits += 1
        if self._refuses_with is not None:
            client.sendall(request[:4] + struct.pack(">HBBB", 3, request[6], request[7] | 0x80, self._refuses_with))


def _frame(stream):
    """Empty at the end."""
    header = stream.read(6)
    return header + stream.read(struct.unpack(">H", header[4:])[0]) if len(header) == 6 else b""
