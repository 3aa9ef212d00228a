#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The dissector that `coupler export --to wireshark` writes, run by tshark on captured traffic of a node, names the
points and their values. What must stand there is packed by Python's struct, not by this project's code.

    dissector_test.py COUPLER MAP NODE_COMMAND…
"""
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile

import peer
import tshark_test


def registers(*values):
    return struct.pack(f">{len(values)}H", *values)


def swap_bytes(data):
    return b"".join(data[i:i + 2][::-1] for i in range(0, len(data), 2))


def swap_words(data):
    return b"".join(data[i:i + 2] for i in reversed(range(0, len(data), 2)))


def write(address, data):
    return struct.pack(">BHHB", 16, address, len(data) // 2, len(data)) + data


def read(function, address, count):
    return struct.pack(">BHH", function, address, count)


LONGS = (struct.pack(">q", -2**63 + 1) + swap_words(struct.pack(">Q", 2**64 - 2)) +
         swap_bytes(struct.pack(">d", 1.0e-300)) + swap_words(swap_bytes(struct.pack(">q", 81985529216486895))))
TEXTS = swap_bytes(b"Anlage\0\0") + b"K\xfchler"
BROKEN = swap_bytes(b"K\xfc\xc3\xa4\xe2\x82\xff\0")  # UTF-8 is the third and the fourth byte only
# As `coupler dump` shows them: an exponent only for the very small and the very large.
DOUBLES = {50.0: "50", -0.0: "-0", 1e-4: "0.0001", 1e-5: "1e-05", 0.1 + 0.2: "0.30000000000000004", -1234.5: "-1234.5",
           1e6: "1000000", -1e15: "-1000000000000000", 1e16: "1e+16", 123456789012345678.0: "1.2345678901234568e+17"}
PAIR = struct.pack(">hhh", 3, -4, 5)

# PDU, lines that the request must show, lines that the reply must show.
TRAFFIC = [
    (b"\x05\x00\x00\xff\x00", ["lamp: true (above the door)"], ["lamp: true (above the door)"]),
    (b"\x05\x00\x01\x00\x00", ["gate: false"], ["gate: false"]),
    (b"\x0f\x00\x08\x00\x0a\x02\xcd\x01", ["row: [true, false, true, true, false, false, true, true, true, false]"], ["row"]),
    (read(1, 0, 2), ["lamp (above the door)", "gate"], ["lamp: true (above the door)", "gate: false"]),
    (read(1, 8, 10), ["row"], ["row: [true, false, true, true, false, false, true, true, true, false]"]),
    (read(2, 0, 2), ["button", "door"], ["button: true", "door: false"]),
    (read(4, 0, 1), ["level"], ["level: 21.5 °C"]),
    (read(4, 10, 8), ["abcd", "cdab", "badc", "dcba"],
     ["abcd: 3.14", "cdab: -50", "badc: -123456789", "dcba: 4000000000"]),
    (b"\x06" + registers(0, 0xFF9C), ["speed: -100 rpm"], ["speed: -100 rpm"]),
    (write(0, registers(1500, 0x3412, 0xFE07, 0x1000, 0xBEEF)),
     ["speed: 1500 rpm", "swapped: 4660", "high: -2", "low: 7", "flag_3: false", "flag_12: true", "mask: 0xBEEF"],
     ["speed", "swapped", "high", "low", "flag_3", "flag_12", "mask"]),
    (b"\x16" + registers(3, 0xFFF7, 0x0008), ["flag_3 [and 0xFFF7, or 0x0008]", "flag_12 [and 0xFFF7, or 0x0008]"],
     ["flag_3", "flag_12"]),
    (read(3, 0, 5), ["speed", "swapped", "high", "low", "flag_3", "flag_12", "mask"],
     ["speed: 1500 rpm", "swapped: 4660", "high: -2", "low: 7", "flag_3: true", "flag_12: true", "mask: 0xBEEF"]),
    (write(10, LONGS),
     ["long_abcd: -9223372036854775807", "long_cdab: 18446744073709551614", "long_badc: 1e-300",
      "long_dcba: 81985529216486895"], ["long_abcd", "long_cdab", "long_badc", "long_dcba"]),
    (read(3, 10, 16), ["long_abcd", "long_cdab", "long_badc", "long_dcba"],
     ["long_abcd: -9223372036854775807", "long_cdab: 18446744073709551614", "long_badc: 1e-300",
      "long_dcba: 81985529216486895"]),
    (write(26, PAIR), ["pair: [1.5, -2, 2.5] bar"], ["pair"]),
    (write(30, TEXTS), ['label: "Anlage"', 'plain: "Kühler"'], ["label", "plain"]),
    (read(3, 30, 7), ["label", "plain"], ['label: "Anlage"', 'plain: "Kühler"']),
    (write(30, BROKEN), [r'label: "K\xfcä\xe2\x82\xff"'], ["label"]),
    *((write(18, swap_bytes(struct.pack(">d", number))), [f"long_badc: {text}"], ["long_badc"])
      for number, text in DOUBLES.items()),
    (b"\x06" + registers(41, 0xAB55), ["across: 0x0055", "field: 11"], ["across: 0x0055", "field: 11"]),
    (b"\x06" + registers(40, 7), ["mode: auto (7)"], ["mode: auto (7)"]),
    (b"\x06" + registers(40, 0xFFFF), ["mode: fault (-1)"], ["mode: fault (-1)"]),
    (b"\x06" + registers(40, 3), ["mode: 3"], ["mode [exception 03]"]),
    # FC 23 writes speed and reads it back with its neighbour.
    (b"\x17" + registers(0, 2, 0, 1) + b"\x02" + registers(25), ["speed: 25 rpm", "speed", "swapped"],
     ["speed: 25 rpm", "swapped: 4660"]),
    # Only half of a wide value: the node answers, the dissector says so.
    (read(3, 11, 2), ["long_abcd"], ["long_abcd [only a part of it is in this message]"]),
    (read(4, 60, 1), ["far"], ["far: 7"]),
    (read(4, 60, 2), ["far"], ["far [exception 02]"]),
]


def talk(port, first):
    """Each request on its own, then all of them in two segments, the first of which ends inside of one."""
    with tshark_test.connected(port) as client:
        for index, (pdu, _, _) in enumerate(TRAFFIC):
            client.ask(pdu, first + index)
        first += len(TRAFFIC)
        everything = b"".join(tshark_test.adu(pdu, first + i) for i, (pdu, _, _) in enumerate(TRAFFIC))
        answered = 8  # of them by the first segment, which ends behind the first byte of the ninth
        cut = sum(len(tshark_test.adu(pdu)) for pdu, _, _ in TRAFFIC[:answered]) + 1
        client.socket.sendall(everything[:cut])
        for i in range(answered):  # so the first segment has arrived alone
            client.receive(first + i)
        client.socket.sendall(everything[cut:])
        for i in range(answered, len(TRAFFIC)):
            client.receive(first + i)


def shown(port, file, script):
    """By transaction id: what the request shows, what the reply shows."""
    done = tshark_test.read(file, *tshark_test.with_dissector(port, script), "-V")
    messages, points = {}, None
    for line in done.stdout.splitlines():
        text = line.strip()
        if text.startswith("Transaction Identifier: "):
            transaction = int(text.split()[-1])
        elif line.startswith("cell/north: "):
            kind = "request" if text.split()[1] in ("reads", "writes") else "reply"
            points = messages.setdefault((transaction, kind), [])
        elif points is not None and line.startswith("    ") and not line.startswith("     "):
            points.append(text)
        elif not line.startswith(" "):
            points = None
    return messages, done.stderr


def main():
    if not shutil.which("tshark"):
        peer.skip("tshark is missing; run scripts/install-packages test")
    coupler, device_map, *command = sys.argv[1:]
    checks = peer.Checks()
    with tempfile.TemporaryDirectory() as folder, peer.running_node(command) as port:
        pathlib.Path(folder).chmod(0o755)
        file, script = pathlib.Path(folder) / "node.pcapng", pathlib.Path(folder) / "cell.lua"
        subprocess.run([coupler, "export", device_map, "--to", "wireshark", "--out", str(script)], check=True,
                       capture_output=True)
        first = 0x4000
        tshark_test.capture(port, file, lambda: talk(port, first), checks)
        messages, errors = shown(port, file, script)
        checks.equal("what tshark says of the script", [line for line in errors.splitlines() if "lua" in line.lower()], [])
        for index, (pdu, asked, answered) in enumerate(TRAFFIC + TRAFFIC):
            transaction = first + index
            checks.equal(f"points of request {index} ({pdu.hex()})", messages.get((transaction, "request")), asked)
            checks.equal(f"points of reply {index} ({pdu.hex()})", messages.get((transaction, "reply")), answered)
    checks.done("tshark with the exported dissector names the points and their values")


if __name__ == "__main__":
    main()
