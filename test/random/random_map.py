# SPDX-License-Identifier: Apache-2.0
"""For tests with random maps: the points of one, with the registers or bits of their values as `coupler generate --vectors`
tells them, and pymodbus, which reads and writes them."""
import json
import pathlib
import re
import subprocess
import tempfile

from peer import pymodbus_client


class PymodbusClient:
    """pymodbus; registers as the vectors have them."""

    def __init__(self, port):
        self.client = pymodbus_client(port)
        if not self.client.connect():
            raise SystemExit("FAILED: pymodbus does not connect")

    def get(self, point):
        table, at, size = point["table"], point["address"], len(point["cases"][0]["raw"])
        answer = getattr(self.client, "read_" + table)(at, size, 1)
        if answer.isError():
            return str(answer)
        return [int(bit) for bit in answer.bits[:size]] if "bits" in point else answer.registers

    def put(self, point, raw):
        if "mask" in point:
            raw = [self.get(point)[0] & ~int(point["mask"], 16) | raw[0]]
        if "bits" in point:
            return not self.client.write_coils(point["address"], [bool(bit) for bit in raw], 1).isError()
        return not self.client.write_registers(point["address"], raw, 1).isError()


class Map:
    def __init__(self, coupler, path):
        self.path, self.name = path, path.stem
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([coupler, "generate", path, "--vectors", "--name", self.name, "--out", folder, "--quiet"],
                           check=True, stdout=subprocess.DEVNULL)
            self.points = json.loads((pathlib.Path(folder) / f"{self.name}_vectors.json").read_text())["points"]
        text = path.read_text()
        self.latched = {name for name in re.findall(r"^ +(\S+): \{.*latched:", text, re.M)}
        self.counters = {name for name in re.findall(r"^ +(\S+): \{.*counter:", text, re.M)}
        self.simulated = set(re.findall(r"^ +(\S+): \{.*line:", text, re.M)) | set(re.findall(r"\bto: (\w+)", text))
        self.options = ["--listen", "127.0.0.1", "--port", "0"] + (["--sim"] if "line:" in text else [])

    def case(self, index, number):
        cases = self.points[index]["cases"]
        return cases[(number + index) % len(cases)]

    def raw(self, index, number):
        """None: the case is only read, so nobody writes it."""
        case = self.case(index, number)
        if case.get("only"):
            return None
        return case["raw"] if "bits" in self.points[index] else [int(word, 16) for word in case["raw"]]

    def settable(self):
        return [(i, point) for i, point in enumerate(self.points)
                if point["access"] != "read" and point["name"] not in self.latched]

    def readable(self):
        return [(i, point) for i, point in self.settable() if point["access"] == "read_write"]


def masked(point, raw):
    return [word & int(point["mask"], 16) for word in raw] if "mask" in point and isinstance(raw, list) else raw
