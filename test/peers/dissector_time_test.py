#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The dissector that `coupler export --to wireshark` writes knows function codes 65 and 66. The replies are scripted
here, so that all that a node may answer is among them; the bytes are packed by Python's struct.

    dissector_time_test.py COUPLER MAP
"""
import pathlib
import re
import shutil
import socket
import struct
import subprocess
import sys
import tempfile
import threading

import peer
import tshark_test

EPOCH, NOW = 0xA1B2C3D4, 1234_567890123
TIME, SOON = "1234.567890123 s", "0.000000005 s"
HEADERS = 66  # of Ethernet, IP and TCP with time stamps
PORTS = 34    # in a packet, that of the sender and the other one
STAMPS = [f"Epoch: 0x{EPOCH:08X}", f"Request arrived: {TIME}", f"Replied: {TIME}"]


def wait(milliseconds, seen):
    return struct.pack(">BBHIQ", 65, 1, milliseconds, EPOCH, seen)


def changes(newest, lost, *each):
    head = struct.pack(">BBIqqQIB", 65, 1, EPOCH, NOW, NOW, newest, lost, len(each))
    return head + b"".join(struct.pack(">BBHq", *change) for change in each)


def schedule(table, address, count, values, duration):
    return struct.pack(">BBBIqIBHHB", 66, 1, 1, EPOCH, NOW, duration, table, address, count, len(values)) + values


def cancel_from(table, address, count):
    return struct.pack(">BBBIqBHH", 66, 1, 3, EPOCH, NOW, table, address, count)


def scheduled(number):
    return struct.pack(">BBHqq", 66, 1, number, NOW, NOW)


# Request, reply, what the request must show, what the reply must show.
TRAFFIC = [
    (wait(1000, 2**63 + 7), changes(2**63 + 7, 0),
     ["waits for changes", "Longest wait: 1000 ms", STAMPS[0], "Changes seen: 9223372036854775815"],
     ["changes", *STAMPS, "Newest change: 9223372036854775815", "Changes lost: 0"]),
    (wait(0, 7), changes(300, 9, (1, 1, 0, NOW), (2, 0, 1, 5), (1, 1, 10, 5), (2, 1, 900, 5)),
     ["waits for changes", "Longest wait: 0 ms", STAMPS[0], "Changes seen: 7"],
     ["changes", *STAMPS, "Newest change: 300", "Changes lost: 9", f"lamp: true [at {TIME}] (above the door)",
      f"door: false [at {SOON}]", f"row: [2] true [at {SOON}]", f"discrete_inputs 900: true [at {SOON}]"]),
    (wait(0, 300), changes(304, 0, (0, 3, 7, 5), (2, 4, 8, 5), (7, 5, 9, 5), (99, 77, 10, 5)),
     ["waits for changes", "Longest wait: 0 ms", STAMPS[0], "Changes seen: 300"],
     ["changes", *STAMPS, "Newest change: 304", "Changes lost: 0", f"Scheduled output 7: driven [at {SOON}]",
      f"Scheduled output 8: cancelled, another write to the same point [at {SOON}]",
      f"Scheduled output 9: not driven, the output could not be driven, or does not take the value [at {SOON}]",
      f"Scheduled output 10: kind 77, reason 99 [at {SOON}]"]),
    (wait(30001, 0), b"\xc1\x03",
     ["waits for changes", "Longest wait: 30001 ms", STAMPS[0], "Changes seen: 0"], ["refused [exception 03]"]),
    (schedule(1, 0, 2, b"\x01", 200), scheduled(513),
     ["schedules", STAMPS[0], f"Due: {TIME}", "Duration: 200 ms", f"lamp: true [at {TIME}] (above the door)",
      f"gate: false [at {TIME}]"],
     ["scheduled as number 513", "Number: 513", *STAMPS[1:]]),
    (schedule(3, 0, 1, struct.pack(">h", -100), 0), b"\xc2\x06",
     ["schedules", STAMPS[0], f"Due: {TIME}", "Duration: for good", f"speed: -100 rpm [at {TIME}]"],
     ["refused", "speed [exception 06]"]),
    (struct.pack(">BBBIH", 66, 1, 2, EPOCH, 513), scheduled(513),
     ["cancels a scheduled output", STAMPS[0], "Number: 513"], ["cancelled as number 513", "Number: 513", *STAMPS[1:]]),
    (cancel_from(1, 0, 2), scheduled(12),
     ["cancels scheduled outputs", STAMPS[0], f"Due: from {TIME}", "Addresses: coils 0, count 2",
      f"lamp [from {TIME}] (above the door)", f"gate [from {TIME}]"], ["cancelled: 12", *STAMPS[1:]]),
    (cancel_from(3, 700, 65535), b"\xc2\x02",
     ["cancels scheduled outputs (no point of the map)", STAMPS[0], f"Due: from {TIME}",
      "Addresses: holding_registers 700, count 65535"], ["refused [exception 02]"]),
    (wait(0, 304), changes(400, 96),
     ["waits for changes", "Longest wait: 0 ms", STAMPS[0], "Changes seen: 304"],
     ["changes", *STAMPS, "Newest change: 400", "Changes lost: 96"]),
    (schedule(1, 77, 1, b"\x01", 5), scheduled(514), ["schedules (no point of the map)", STAMPS[0], f"Due: {TIME}", "Duration: 5 ms"],
     ["scheduled as number 514", "Number: 514", *STAMPS[1:]]),
    # Cut off, another version's, and an action that is not known: the dissector leaves them alone.
    (wait(0, 0)[:9], b"\xc1\x03", None, None),
    (b"\x41\x02" + wait(0, 0)[2:], b"\xc1\x03", None, None),
    (b"\x42\x00" + schedule(1, 0, 2, b"\x01", 200)[2:], b"\xc2\x03", None, None),
    (schedule(1, 0, 2, b"\x01", 200)[:20], b"\xc2\x03", None, None),
    (cancel_from(1, 0, 2)[:19], b"\xc2\x03", None, None),
    (cancel_from(9, 0, 2), b"\xc2\x03", None, None),
    (b"\x42\x01\x09" + schedule(1, 0, 2, b"\x01", 200)[3:], scheduled(7), None, None),
    (wait(0, 0), changes(0, 0)[:20], ["waits for changes", "Longest wait: 0 ms", STAMPS[0], "Changes seen: 0"], None),
]


OUTCOMES = (f"Scheduled output 7: driven [at {SOON}], "
            f"Scheduled output 8: cancelled, another write to the same point [at {SOON}], "
            f"Scheduled output 9: not driven, the output could not be driven, or does not take the value [at {SOON}], "
            f"Scheduled output 10: kind 77, reason 99 [at {SOON}]")
# A filter, and the information columns of what it finds, from the dissector's first words on.
FILTERS = [
    ("longest_wait == 1000", ["waits for changes"]),
    ("newest > 9000000000000000000", ["no changes"]),
    ("lost == 9", [f"9 changes lost, lamp: true [at {TIME}], door: false [at {SOON}], row: [2] true [at {SOON}], …"]),
    ("lost == 96", ["96 changes lost"]),
    ("duration == 5", ["schedules"]),
    ('outcome == "cancelled"', [OUTCOMES]),
    ("number == 9", [OUTCOMES]),
    ("number == 513", ["scheduled as number 513", "cancels a scheduled output: 513", "cancelled as number 513"]),
    ("duration == 200", [f"lamp: true [at {TIME}], gate: false [at {TIME}]"]),
    (f"epoch == {EPOCH} && longest_wait == 30001", ["waits for changes"]),
]


def serve(listener):
    """Answers the requests of one connection after the other, each with its reply."""
    replies = {struct.pack(">H", 0x4000 + i): reply for i, (_, reply, _, _) in enumerate(TRAFFIC)}
    while True:
        try:
            client, _ = listener.accept()
        except OSError:
            return
        with client, client.makefile("rb") as stream:
            while request := stream.read(6):
                body = stream.read(struct.unpack(">H", request[4:])[0])
                pdu = replies.get(request[:2], body[1:])
                client.sendall(request[:4] + struct.pack(">H", len(pdu) + 1) + body[:1] + pdu)


def talk(port):
    with tshark_test.connected(port) as client:
        for index, (pdu, _, _, _) in enumerate(TRAFFIC):
            client.ask(pdu, 0x4000 + index)


def shown(port, file, script):
    """By transaction id: what the request shows, what the reply shows; and what tshark complains of."""
    done = tshark_test.read(file, *tshark_test.with_dissector(port, script), "-V")
    messages, lines, is_request = {}, None, False
    for line in done.stdout.splitlines():
        if line.startswith("Transmission Control Protocol"):
            is_request = f"Dst Port: {port}" in line
        elif line.strip().startswith("Transaction Identifier: "):
            transaction = int(line.split()[-1])
        elif line.startswith("cell/north: "):
            lines = messages.setdefault((transaction, is_request), [])
            lines.append(line.removeprefix("cell/north: "))
        elif lines is not None and line.startswith("    ") and not line.startswith("     "):
            lines.append(line.strip())
        elif not line.startswith(" "):
            lines = None
    return messages, [line for line in (done.stderr + done.stdout).splitlines() if "lua" in line.lower()]


def found(port, file, script, condition):
    """The information columns, behind what Wireshark itself says."""
    done = tshark_test.read(file, *tshark_test.with_dissector(port, script),
                            "-Y", re.sub(r"\b([a-z_]+) (?=[=>])", r"coupler_cell_north.\1 ", condition),
                            "-T", "fields", "-e", "_ws.col.Info")
    return [line.partition(" | ")[2] for line in done.stdout.splitlines()]


def cut_short(port, packets, sizes, to):
    """Writes each packet once for each size, cut to it, as a capture may end it. Each size has clients of its own, since
    what is sent again on one connection is not dissected."""
    clients = {}
    with open(packets, "rb") as whole, open(to, "wb") as cut:
        cut.write(whole.read(24))
        while head := whole.read(16):
            seconds, parts, captured, length = struct.unpack("<IIII", head)
            packet = whole.read(captured)
            ports = struct.unpack(">HH", packet[PORTS:PORTS + 4])
            for size in sizes:
                client = clients.setdefault((size, *{*ports} - {port}), 1024 + len(clients))
                of_its_own = struct.pack(">HH", *(each if each == port else client for each in ports))
                kept = (packet[:PORTS] + of_its_own + packet[PORTS + 4:])[:size]
                cut.write(struct.pack("<IIII", seconds, parts, len(kept), length) + kept)


def main():
    if not shutil.which("tshark"):
        peer.skip("tshark is missing; run scripts/install-packages test")
    coupler, device_map = sys.argv[1:]
    checks = peer.Checks()
    with tempfile.TemporaryDirectory() as folder, socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
        threading.Thread(target=serve, args=(listener,), daemon=True).start()
        pathlib.Path(folder).chmod(0o755)
        file, script = pathlib.Path(folder) / "node.pcapng", pathlib.Path(folder) / "cell.lua"
        subprocess.run([coupler, "export", device_map, "--to", "wireshark", "--out", str(script)], check=True,
                       capture_output=True)
        tshark_test.capture(port, file, lambda: talk(port), checks)
        messages, errors = shown(port, file, script)
        checks.equal("what tshark says of the script", errors, [])
        for index, (pdu, _, asked, answered) in enumerate(TRAFFIC):
            checks.equal(f"request {index} ({pdu.hex()})", messages.get((0x4000 + index, True)), asked)
            checks.equal(f"reply {index} ({pdu.hex()})", messages.get((0x4000 + index, False)), answered)
        for condition, columns in FILTERS:
            checks.equal(f"what the filter {condition} finds", found(port, file, script, condition), columns)
        whole, cut = pathlib.Path(folder) / "whole.pcap", pathlib.Path(folder) / "cut.pcap"
        subprocess.run(["editcap", "-F", "pcap", str(file), str(whole)], check=True)
        cut_short(port, whole, [*range(HEADERS + 6, HEADERS + 24), HEADERS + 45], cut)
        done = subprocess.run(["tshark", "-r", str(cut), *tshark_test.with_dissector(port, script), "-Y", "_ws.lua.error",
                               "-T", "fields", "-e", "frame.cap_len", "-e", "_ws.expert.message"],
                              capture_output=True, text=True, encoding="utf-8", check=False)
        checks.equal(f"tshark's status, of packets that are cut: {done.stderr}", done.returncode, 0)
        checks.equal("errors in the script, of packets that are cut to so many bytes", done.stdout.splitlines(), [])
    checks.done("tshark with the exported dissector shows changes and scheduled outputs")


if __name__ == "__main__":
    main()
