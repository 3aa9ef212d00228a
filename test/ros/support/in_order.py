# SPDX-License-Identifier: Apache-2.0
"""Messages of several topics in one order: each topic has a connection of its own, which the driver reads when it likes."""
import socket
import sys

import rospy
from roscpp.srv import GetLoggers

from support.topics import wait_until


def senders(test, kinds):
    """Publishers, by topic and type, that return when the message is sent. They end with the test."""
    publishers = [rospy.Publisher(name, kind) for name, kind in kinds.items()]
    for publisher in publishers:
        test.addCleanup(publisher.unregister)
        wait_until(lambda p=publisher: p.get_num_connections() > 0, f"a subscriber of {publisher.name}")
    return publishers


def publish(publisher, value):
    """Returns when the driver has taken the message."""
    publisher.publish(value)
    connection = publisher.impl.connections[0]
    wait_until(lambda: _receiving_end(connection.socket)[4].endswith(":00000000"), "the driver to read it")
    # The thread that has read it answers this when it has handed it on.
    rospy.ServiceProxy(f"{connection.endpoint_id}/get_loggers", GetLoggers)()


def _receiving_end(connection):
    """The line of /proc/net/tcp of the other end: its address, ours, and what it has not read yet."""
    def hexadecimal(address):
        host, port = address
        return f"{int.from_bytes(socket.inet_aton(host), sys.byteorder):08X}:{port:04X}"

    ends = [hexadecimal(connection.getpeername()), hexadecimal(connection.getsockname())]
    with open("/proc/net/tcp", encoding="ascii") as file:
        return next(fields for fields in map(str.split, file) if fields[1:3] == ends)
