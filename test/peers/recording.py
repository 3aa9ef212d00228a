# SPDX-License-Identifier: Apache-2.0
"""For the tests of recordings: `coupler record` and a node that plays as they run, and what a recording says."""
import datetime
import json
import logging
import pathlib
import re
import signal
import subprocess
import threading
import time

import peer

# A device that ends a connection is no news.
logging.getLogger("pymodbus").setLevel(logging.CRITICAL + 1)

TAPE_MAP = """name: tape
timeout: 20s
mapping:
  coils: {valve: 0}
  discrete_inputs: {door: 0}
  holding_registers: {speed: {address: 0, type: INT}, count: {address: 1, type: INT}, quiet: {address: 9, type: INT}}
"""


class Program:
    """A process of which standard error is read."""

    def __init__(self, *command, **options):
        self.process = subprocess.Popen([*map(str, command)], stderr=subprocess.PIPE, text=True, **options)
        self.said = []
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        for line in self.process.stderr:
            self.said.append(line)

    def text(self):
        return "".join(self.said)

    def wait(self, patience=peer.PATIENCE):
        """Its exit status."""
        try:
            status = self.process.wait(patience)
        except subprocess.TimeoutExpired:
            self.process.kill()
            status = f"none; it said: {self.text()}"
        self._reader.join(peer.PATIENCE)
        return status

    def end(self, number=signal.SIGTERM):
        self.process.send_signal(number)
        return self.wait()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()


class Node(Program):
    """On a free loopback port, or on that one."""

    def __init__(self, *command, port=0):
        super().__init__(*command, "--sim", "--listen", "127.0.0.1", "--port", port)
        peer.await_true("a node serves", lambda: self.port or self.process.poll() is not None, peer.Checks())
        if not self.port:
            raise RuntimeError(f"the node did not start; it said: {self.text()}")

    @property
    def port(self):
        found = re.search(r"serving .* on 127\.0\.0\.1:(\d+)", self.text())
        return int(found.group(1)) if found else None


class Recorder(Program):
    """`coupler record` of what is on that loopback port."""

    def __init__(self, coupler, what, port, file, *options):
        self.file = pathlib.Path(file)
        super().__init__(coupler, "record", what, "--at", f"127.0.0.1:{port}", "-o", file, *options)

    def lines(self):
        return whole_lines(self.file) if self.file.exists() else []

    def await_lines(self, what, are_there, checks):
        """What it has recorded as soon as that is true."""
        peer.await_true(what, lambda: are_there(self.lines()), checks)
        return self.lines()

    def await_value(self, point, value, checks):
        return self.await_lines(f"{point} is {value}", lambda lines: values(lines, point)[-1:] == [value], checks)


def whole_lines(file):
    """Without one that is cut short. Raises if one is no JSON object."""
    lines = [json.loads(line) for line in file.read_text(encoding="utf-8").split("\n")[:-1]]
    assert all(isinstance(line, dict) for line in lines)
    return lines


def values(lines, point):
    return [line["value"] for line in lines if line.get("point") == point]


def until_lost(lines):
    """Those of the first connection."""
    first = next((i for i, line in enumerate(lines) if line.get("device") == "online"), 0)
    last = next((i for i, line in enumerate(lines) if i > first and line.get("device") == "lost"), len(lines))
    return lines[first:last]


def utc(text):
    return datetime.datetime.strptime(text, "%Y-%m-%dT%H:%M:%S.%f%z").timestamp()


class Tape:
    """A recording that nobody recorded. It begins at the beginning of 2026."""

    def __init__(self, map_text, name="tape"):
        self.lines = [{"record": 1, "name": name, "device": "tcp://127.0.0.1:502/1", "fingerprint": "0" * 16,
                       "began": self.utc(0), "t": 0.0, "utc": self.utc(0), "periods": {}, "not_recorded": {},
                       "map": map_text}]
        self.add(0, device="online")

    @staticmethod
    def utc(t):
        return f"2026-01-01T00:00:{t:06.3f}Z"

    def add(self, t, **members):
        self.lines.append({"t": float(t), "utc": self.utc(t), **members})
        return self

    def value(self, t, point, value):
        """A bool, or a number in one register."""
        registers = {} if isinstance(value, bool) else {"registers": [value & 0xFFFF]}
        return self.add(t, point=point, value=value, quality="good", u=0.0, **registers)

    def exception(self, t, point, code):
        return self.add(t, point=point, value=None, quality="exception", exception=code)

    def write(self, file):
        file.write_text("".join(json.dumps(line) + "\n" for line in self.lines), encoding="utf-8")
        return file


def wait_until(moment):
    """By time.monotonic()."""
    time.sleep(max(0, moment - time.monotonic()))


def read(client, address):
    """A register's value, 'exception N', or 'closed'."""
    from pymodbus.exceptions import ModbusException  # who imports this says so if it is missing
    try:
        reply = client.read_holding_registers(address, 1, 1)
    except ModbusException:
        reply = None
    if hasattr(reply, "registers"):
        return reply.registers[0]
    code = getattr(reply, "exception_code", None)
    if code is None:
        client.close()
    return f"exception {code}" if code is not None else "closed"


def outcomes(port, address, last, silence, times=1):
    """What a client sees, without repetitions, until it was so many times `last`. What lasts for longer than the longest
    silence, a peer.Silence's, is seen."""
    client = peer.pymodbus_client(port, retries=0)
    silence.ask(lambda: None)  # from now on, though another client may have begun before
    seen = []
    end = time.monotonic() + peer.PATIENCE
    while seen.count(last) < times and time.monotonic() < end:
        if (now := silence.ask(lambda: read(client, address))) != (seen[-1] if seen else None):
            seen.append(now)
        time.sleep(0.01)
    client.close()
    return seen
