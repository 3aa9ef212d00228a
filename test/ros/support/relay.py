# SPDX-License-Identifier: Apache-2.0
"""What stands between a driver and a node: accepts connections, and has one of its own to the node for each."""
import socket
import struct
import threading

from support.ports import free_port


class Relay:
    def __init__(self, node_port):
        self._node_port = node_port
        self.port = free_port()
        self.accepted = 0
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
            threading.Thread(target=self._connect, args=(client,), daemon=True).start()

    def _connect(self, client):
        try:
            with client, socket.create_connection(("127.0.0.1", self._node_port)) as node:
                for end in (client, node):
                    end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                self.serve(client, node)
        except OSError:
            pass

    def serve(self, client, node):
        """Until one of both sockets ends, or fails by an OSError."""
        raise NotImplementedError


def next_frame(stream):
    """Empty at the end."""
    header = stream.read(6)
    return header + stream.read(struct.unpack(">H", header[4:])[0]) if len(header) == 6 else b""
