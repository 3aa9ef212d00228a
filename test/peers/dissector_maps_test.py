#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Several dissectors that `coupler export --to wireshark` wrote, in one tshark: each message is named by the map that it is
about. The capture is packed by Python's struct.

    dissector_maps_test.py COUPLER
"""
import ipaddress
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile

import peer
import tshark_test

CLIENT, CELL, PRESS, OTHER = "10.0.0.1", "10.0.0.7", "fd00::8", "10.0.0.9"
LAMP_ON = b"\x05\x00\x00\xff\x00"
MAPS = {
    "cell": "{name: cell, address: 10.0.0.7, mapping: {coils: {lamp: 0}}}",
    "press": "{name: press, address: 'fd00::8', mapping: {coils: {ram: 0}}}",
    "oven": "{name: oven, address: oven.local, unit: 7, mapping: {coils: {heater: 0}}}",
    "saw": "{name: saw, port: 1502, mapping: {coils: {blade: 0}}}",
    "belt": "{name: belt, address: belt.local, mapping: {coils: {motor: 0}}}",
    "fan": "{name: fan, mapping: {coils: {blower: 0}}}",
}


def segment(source, target, ports, data):
    """A packet of IPv4 or IPv6, without Ethernet."""
    tcp = struct.pack(">HHIIBBHHH", *ports, 1, 1, 0x50, 0x18, 1000, 0, 0) + data
    source, target = ipaddress.ip_address(source), ipaddress.ip_address(target)
    addresses = source.packed + target.packed
    if target.version == 6:
        return struct.pack(">IHBB", 6 << 28, len(tcp), 6, 64) + addresses + tcp
    return struct.pack(">BBHHHBBH", 0x45, 0, 20 + len(tcp), 0, 0, 64, 6, 0) + addresses + tcp


def conversation(client_port, server, port, unit):
    """A request and its reply. Their connection is another one for each client_port."""
    message = tshark_test.adu(LAMP_ON, client_port)
    message = message[:6] + bytes([unit]) + message[7:]
    client = "fd00::1" if ":" in server else CLIENT
    return [segment(client, server, (client_port, port), message), segment(server, client, (port, client_port), message)]


def write_capture(path, packets):
    raw_ip = 101
    with open(path, "wb") as file:
        file.write(struct.pack("<IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, 65535, raw_ip))
        for number, packet in enumerate(packets):
            file.write(struct.pack("<IIII", number, 0, len(packet), len(packet)) + packet)


class Wireshark:
    def __init__(self, coupler, folder):
        self._folder = pathlib.Path(folder)
        for name, text in MAPS.items():
            (self._folder / f"{name}.yaml").write_text(text, encoding="utf-8")
            subprocess.run([coupler, "export", f"{name}.yaml", "--to", "wireshark", "--out", f"{name}.lua"], check=True,
                           capture_output=True, cwd=folder)

    def shown(self, names, server, port=502, unit=1, options=()):
        """What the scripts of these maps add to a request and to its reply."""
        capture = self._folder / "capture.pcap"
        write_capture(capture, conversation(40000, server, port, unit))
        scripts = [word for name in names for word in ("-X", f"lua_script:{self._folder / name}.lua")]
        done = tshark_test.read(capture, *scripts, *(word for option in options for word in ("-o", option)), "-V")
        lines = done.stdout.splitlines()
        return [line.strip() for line in lines if line.startswith(("    lamp", "    ram", "    heater", "    blade", "    motor",
                                                                   "    blower", "several maps"))]


def main():
    if not shutil.which("tshark"):
        peer.skip("tshark is missing; run scripts/install-packages test")
    checks = peer.Checks()
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder).chmod(0o755)
        wireshark = Wireshark(sys.argv[1], folder)

        def twice(what, names, server, wanted, **more):
            for order in (names, names[::-1]):
                checks.equal(f"{what}, loaded as {' '.join(order)}", wireshark.shown(order, server, **more), wanted)

        lamp, ram, heater, blade = (2 * [f"{name}: true"] for name in ("lamp", "ram", "heater", "blade"))
        motor, blower = (2 * [f"{name}: true"] for name in ("motor", "blower"))
        plant = ["cell", "press", "oven", "saw"]
        twice("the address of the map", plant, CELL, lamp)
        twice("an address of IPv6", plant, PRESS, ram)
        twice("a unit that one map has", plant, OTHER, heater, unit=7)
        twice("a port that one map has", plant, OTHER, blade, port=1502)
        twice("an address that no map has", ["cell", "press"], OTHER, [])
        twice("a map without an address", ["cell", "fan"], OTHER, blower)
        twice("an address beside a map without one", ["cell", "fan"], CELL, lamp)
        twice("an address that an option gives", ["belt", "fan"], OTHER, motor, options=[f"coupler_belt.address:{OTHER}"])
        twice("a port that an option gives", ["cell", "saw"], OTHER, lamp, port=1503, options=["coupler_cell.port:1503"])
        twice("the port that another map has left", ["cell", "fan"], OTHER, blower, options=["coupler_cell.port:1503"])
        for port in ("502,1502", "1502"):  # as it was necessary once, and may be in somebody's settings
            checks.equal(f"with mbtcp.tcp.port:{port}",
                         wireshark.shown(["saw"], OTHER, port=1502, options=[f"mbtcp.tcp.port:{port}"]), blade)
            checks.equal(f"another port, with mbtcp.tcp.port:{port}",
                         wireshark.shown(["saw"], OTHER, port=1503, options=["coupler_saw.port:1503", f"mbtcp.tcp.port:{port}"]),
                         blade)
        checks.equal("one map names the messages of any device", wireshark.shown(["cell"], OTHER), lamp)
        hint = ("several maps are loaded for this port: belt, fan. Say where their devices are: "
                "-o coupler_belt.address:ADDRESS -o coupler_fan.address:ADDRESS")
        checks.equal("two maps without an address", wireshark.shown(["belt", "fan"], OTHER), [hint, hint])
    checks.done("tshark names messages by the map that they are about")


if __name__ == "__main__":
    main()
