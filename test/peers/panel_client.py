# SPDX-License-Identifier: Apache-2.0
"""For the tests of `coupler panel`: the program, and a page as a browser would be one, over real HTTP."""
import contextlib
import http.client
import json
import re
import socket
import subprocess
import threading
import time

import foreign_server
import peer
from recording import Program

MOST_PAGES = 8  # at a time
READS = {1, 2, 3, 4}
WRITES = {5: "coils", 15: "coils", 6: "holding_registers", 16: "holding_registers"}


def is_left_out(coupler):
    return "not in this build" in subprocess.run([coupler, "panel", "--help"], capture_output=True, text=True, check=True).stdout


def skip_if_left_out(coupler):
    if is_left_out(coupler):
        peer.skip("coupler was built without cpp-httplib; run scripts/install-packages build")


class Panel(Program):
    """`coupler panel` of what is on that loopback port; None: where its map says. `trust`: an ssl.SSLContext, for HTTPS.
    `under`: a command that runs it."""

    def __init__(self, coupler, what, device_port, *options, trust=None, under=(), env=None):
        self.trust = trust
        at = ["--at", f"127.0.0.1:{device_port}"] if device_port else []
        super().__init__(*under, coupler, "panel", what, *at, *options, stdout=subprocess.PIPE, env=env)
        self.url = self.process.stdout.readline().strip()
        found = re.fullmatch(r"https?://(\[?[\w.:]+?\]?):(\d+)/#([0-9a-f]{32})", self.url)
        if not found:
            self.process.kill()
            raise RuntimeError(f"the panel did not start; it said: {self.url!r} {self.text()}")
        self.host, self.port, self.key = found[1].strip("[]"), int(found[2]), found[3]
        if "--name" in options:  # no DNS knows it
            self.host = "127.0.0.1"

    def connection(self):
        if self.trust:
            return http.client.HTTPSConnection(self.host, self.port, timeout=peer.PATIENCE, context=self.trust)
        return http.client.HTTPConnection(self.host, self.port, timeout=peer.PATIENCE)

    def ask(self, method, path, body=None, token=None, **headers):
        """(status, headers, body) of a request with a connection of its own; `Header_Name=...` for others."""
        connection = self.connection()
        shown = {"Authorization": f"Bearer {token}"} if token else {}
        shown |= {name.replace("_", "-"): value for name, value in headers.items()}
        try:
            connection.request(method, path, body, shown)
            answer = connection.getresponse()
            return answer.status, answer.headers, answer.read().decode()
        finally:
            connection.close()

    def status(self, method, path, body=None, token=None, **headers):
        return self.ask(method, path, body, token, **headers)[0]

    def token(self):
        status, _, token = self.ask("POST", "/token", self.key)
        if status != 200:
            raise RuntimeError(f"the key was answered with {status}: {token}")
        return token

    def get(self, path, token):
        status, _, body = self.ask("GET", path, token=token)
        if status != 200:
            raise RuntimeError(f"{path} was answered with {status}: {body}")
        return json.loads(body) if path.endswith(".json") else body

    def write(self, token, point, value):
        """The outcome, or the HTTP status if there is none."""
        body = json.dumps({"point": point, "value": value})
        status, _, told = self.ask("POST", "/write", body, token, Content_Type="application/json")
        return json.loads(told) if status == 200 else status

    def resident(self):
        """KiB of memory."""
        with open(f"/proc/{self.process.pid}/status", encoding="ascii") as file:
            return int(re.search(r"VmRSS:\s+(\d+)", file.read())[1])


class Page:
    """One that is open: the events it has heard, and what they say of points and device."""

    def __init__(self, panel, token=None):
        self.panel = panel
        self.token = token or panel.token()
        self.points, self.device, self.events = {}, {}, 0
        self._longest_silence, self._heard = 0.0, time.monotonic()
        self._connection = panel.connection()
        self._connection.request("GET", "/events", headers={"Authorization": f"Bearer {self.token}"})
        self._socket = self._connection.sock
        self._answer = self._connection.getresponse()
        self.status, self.headers = self._answer.status, self._answer.headers
        self.is_over = self.status != 200
        self._alive = threading.Event()
        self._reader = threading.Thread(target=self._read, daemon=True)
        if not self.is_over:
            self._reader.start()

    def _read(self):
        with contextlib.suppress(OSError, ValueError, AttributeError, http.client.HTTPException):
            for line in self._answer:
                if line.startswith(b"data: "):
                    self._take(json.loads(line[len(b"data: "):]))
        self.is_over = True

    def _take(self, news):
        for name, state in news["points"].items():
            self.points[name] = state
        self.device = news.get("device", self.device)
        self.events += 1

    def value(self, point):
        return self.points.get(point, {}).get("value")

    def quality(self, point):
        return self.points.get(point, {}).get("quality")

    def await_value(self, point, value, checks):
        peer.await_true(f"a page shows {point} as {value}",
                        lambda: (self.value(point), self.quality(point)) == (value, "good"), checks)

    def await_online(self, online, checks):
        peer.await_true(f"a page shows the device as {'online' if online else 'offline'}",
                        lambda: self.device.get("online") is online, checks)

    def await_event(self, what, checks):
        known = self.events
        peer.await_true(what, lambda: self.events > known + 1, checks)

    def await_change(self, what, client, checks):
        """Waits until the page shows a setpoint (panel.yaml) that `client`, one of pymodbus, writes now."""
        value = (client.read_holding_registers(0, 1, 1).registers[0] + 1) % 100
        client.write_register(0, value, 1)
        peer.await_true(what, lambda: self.value("setpoint") == value, checks)

    def stay_alive(self):
        """Says twice a second that it is there, as a page does that has written. A busy machine may silence it, too: see
        longest_silence."""
        def say():
            while not self._alive.wait(0.5):
                with contextlib.suppress(OSError, http.client.HTTPException):
                    sent = time.monotonic()
                    self.panel.status("POST", "/alive", token=self.token)
                    self._longest_silence, self._heard = self.longest_silence, sent
        self._heard = time.monotonic()
        threading.Thread(target=say, daemon=True).start()

    @property
    def longest_silence(self):
        """Seconds for which the panel may have heard nothing of it, until now."""
        return max(self._longest_silence, time.monotonic() - self._heard)

    def fall_silent(self):
        """Its connection stays open, as that of a phone that sleeps."""
        self._alive.set()

    def close(self):
        self._alive.set()
        if self._socket:
            with contextlib.suppress(OSError):
                self._socket.shutdown(socket.SHUT_RDWR)
        if self._reader.is_alive():
            self._reader.join(peer.PATIENCE)
        self._connection.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


class Writable(foreign_server.Device):
    """It takes writes to what it has, and remembers them."""

    def __init__(self, tables, **options):
        super().__init__(tables, **options)
        self.written = []  # (function, address, values)

    def validate(self, fc_as_hex, address, count=1):
        if fc_as_hex in WRITES:
            has = self.tables[WRITES[fc_as_hex]]
            return all(at in has for at in range(address, address + count))
        return super().validate(fc_as_hex, address, count)

    def getValues(self, fc_as_hex, address, count=1):
        has = self.tables[WRITES.get(fc_as_hex) or foreign_server.TABLE_OF[fc_as_hex]]
        return [has[at] for at in range(address, address + count)]

    def setValues(self, fc_as_hex, address, values):
        self.written.append((fc_as_hex, address, [int(value) for value in values]))
        self.tables[WRITES[fc_as_hex]].update(enumerate(values, address))


@contextlib.contextmanager
def raw(panel, text=b""):
    """A connection of which only what is given is said."""
    with socket.create_connection((panel.host, panel.port), timeout=peer.PATIENCE) as connection:
        connection.sendall(text)
        yield connection


def answer_to(panel, text):
    """The status of a request given as bytes; None: the connection is closed without an answer."""
    with contextlib.suppress(OSError), raw(panel) as connection:
        with contextlib.suppress(OSError):  # it may answer, and close, before it has heard all
            connection.sendall(text)
        said = connection.makefile("rb").readline()
        if found := re.match(rb"HTTP/1\.\d (\d+)", said):
            return int(found[1])
    return None
