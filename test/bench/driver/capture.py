# SPDX-License-Identifier: Apache-2.0
"""Packets on loopback with the kernel's time stamps, by tshark, and the times between them."""
import dataclasses
import statistics
import subprocess
import tempfile
import time


@dataclasses.dataclass
class Packet:
    at: float  # µs
    source: int
    target: int
    data: bytes


class Capture:
    """Every TCP packet with data on loopback, from `with` to its end."""

    def __enter__(self):
        self._file = tempfile.NamedTemporaryFile(suffix=".pcap")
        self._child = subprocess.Popen(
            ["tshark", "-q", "-i", "lo", "-s", "128", "-B", "64", "-f", "tcp", "-F", "pcap", "-w", self._file.name],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        for line in self._child.stderr:
            if "Capturing on" in line:
                time.sleep(0.5)
                return self
        raise SystemExit("tshark cannot capture on loopback: run as root, or give dumpcap its capabilities")

    def __exit__(self, *_):
        time.sleep(0.3)
        self._child.terminate()
        self._child.communicate()

    def packets(self):
        fields = ["frame.time_epoch", "tcp.srcport", "tcp.dstport", "tcp.payload"]
        command = ["tshark", "-r", self._file.name, "-o", "tcp.desegment_tcp_streams:FALSE", "-Y", "tcp.len > 0",
                   "-T", "fields", *(word for field in fields for word in ("-e", field))]
        text = subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
        for line in text.splitlines():
            at, source, target, data = line.split("\t")
            yield Packet(float(at) * 1e6, int(source), int(target), bytes.fromhex(data.replace(":", "")))


def with_messages(packets, stamps, port):
    """In the order of time, with messages whose times another program has told, as if they came from `port`."""
    return sorted([*packets, *(Packet(at, port, 0, b"") for at in stamps)], key=lambda packet: packet.at)


def reading(packets, modbus_port, ros_ports, count):
    """(first, between, last) in µs for each response that `count` messages followed: from the response to the first
    message, the mean time from message to message, from the response to the last one."""
    results = []
    response, messages = None, []

    def finish():
        if response is not None and len(messages) == count:
            between = (messages[-1] - messages[0]) / (count - 1) if count > 1 else 0
            results.append((messages[0] - response, between, messages[-1] - response))

    for packet in packets:
        if packet.source == modbus_port:
            finish()
            response, messages = packet.at, []
        elif packet.source in ros_ports:
            messages.append(packet.at)
    finish()
    return results


def writing(packets, modbus_port, ros_ports):
    """From a message of `ros_ports` to the write request that follows it, µs."""
    results = []
    message = None
    for packet in packets:
        if packet.source in ros_ports:
            message = packet.at
        elif packet.target == modbus_port and packet.data[7] in (5, 6, 15, 16) and message is not None:
            results.append(packet.at - message)
            message = None
    return results


def medians(rows):
    return [statistics.median(column) for column in zip(*rows)]
