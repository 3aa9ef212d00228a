# SPDX-License-Identifier: Apache-2.0
"""A serial line without hardware: two pseudo terminals, and what happens to the bytes between them."""
import collections
import math
import os
import pathlib
import pty
import queue
import select
import tempfile
import threading
import time
import tty

BITS = 10  # of a character without parity: start, eight of data, stop
SHORTEST = 0.001  # seconds: characters that take less arrive several at a time
TOO_LATE = 2  # characters; with that in which a piece comes itself it is less than the 3.5 that end a frame


class _Way:
    """One direction: pieces under way, each with the time when its last character is there."""

    def __init__(self, baud, latency=0, punctual=False):
        self._character = BITS / baud if baud else 0
        self._at_once = max(1, math.ceil(SHORTEST / self._character)) if baud else 4096
        self._latency = latency
        self._punctual = punctual
        self._free = 0  # when the line is
        self._pieces = collections.deque()

    def send(self, data, now):
        begin = max(now, self._free)
        for at in range(0, len(data), self._at_once):
            piece = data[at:at + self._at_once]
            self._free = begin + (at + len(piece)) * self._character
            due = math.ceil(self._free / self._latency) * self._latency if self._latency else self._free
            self._pieces.append((due, piece))

    def due(self):
        """When the next piece arrives."""
        return self._pieces[0][0] if self._pieces else math.inf

    def arrived(self, now):
        while self._pieces and self._pieces[0][0] <= now:
            due, piece = self._pieces.popleft()
            if not self._punctual or time.monotonic() - due < TOO_LATE * self._character:
                yield piece

    def lose(self):
        self._pieces.clear()


class SerialLine:
    """`port` is for the host, and stays the same name over unplug() and plug_in(); `device` is for a server.

    baud: characters take their time; 0: they take none. latency: seconds; what comes to the port is handed over once in so
    many, as an FTDI adapter does. punctual: what this process cannot bring to the port in time is lost, so that there is
    no silence between two characters of which one follows the other. to_device, to_port: what a test makes of the bytes of
    one read on the way there, which are a frame as a rule. echoes: the port gets what it sends, too. hold(): nothing more
    arrives at the port until release(). What an end does not take, since nobody reads there, is lost, as on a wire.
    """

    def __init__(self, baud=0, latency=0, punctual=False):
        self.baud = baud
        self.to_device = self.to_port = lambda data: data
        self.echoes = False
        self._folder = tempfile.TemporaryDirectory()
        self.port = str(pathlib.Path(self._folder.name, "port"))
        self._device_end, self._device_held, self.device = self._terminal()
        self._port_end = self._port_held = None
        self._way_to_device, self._way_to_port = _Way(baud), _Way(baud, latency, punctual)
        self._is_held = False
        self._wishes = queue.Queue()
        self._woken, self._wake = os.pipe()
        self._plug_in()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    @staticmethod
    def _terminal():
        """Its end of the line; what keeps it alive while no program has it open; its name."""
        end, held = pty.openpty()
        tty.setraw(held)
        os.set_blocking(end, False)
        return end, held, os.ttyname(held)

    def plug_in(self):
        self._do(self._plug_in)

    def unplug(self):
        self._do(self._unplug)

    def hold(self):
        self._do(lambda: setattr(self, "_is_held", True))

    def release(self):
        self._do(lambda: setattr(self, "_is_held", False))

    def end(self):
        self._do(lambda: None, ends=True)
        self._thread.join()
        if self._port_end is not None:
            self._unplug()
        for end in (self._device_end, self._device_held, self._woken, self._wake):
            os.close(end)
        self._folder.cleanup()

    def _plug_in(self):
        self._port_end, self._port_held, name = self._terminal()
        os.symlink(name, self.port)

    def _unplug(self):
        os.unlink(self.port)
        os.close(self._port_end)
        os.close(self._port_held)
        self._port_end = self._port_held = None
        self._way_to_port.lose()

    def _do(self, wish, ends=False):
        """In the thread that carries: it has the ends to itself."""
        done = threading.Event()
        self._wishes.put((wish, ends, done))
        os.write(self._wake, b"!")
        while not done.wait(1):
            if not self._thread.is_alive():
                raise RuntimeError("nobody carries the bytes any more; what was printed says why")

    def _run(self):
        while True:
            ends = [self._woken, self._device_end] + ([] if self._port_end is None else [self._port_end])
            readable = select.select(ends, [], [], self._seconds_to_next())[0]
            for end in readable:
                if end != self._woken:
                    self._take(end)
            self._deliver()
            if self._woken in readable and self._fulfil():
                return

    def _seconds_to_next(self):
        """None: nothing is under way."""
        due = min(self._way_to_device.due(), math.inf if self._is_held else self._way_to_port.due())
        return None if due == math.inf else max(0, due - time.monotonic())

    def _take(self, end):
        now = time.monotonic()
        data = self._read(end)
        if not data:
            return
        if end == self._device_end:
            self._way_to_port.send(self.to_port(data), now)
            return
        if self.echoes:
            self._way_to_port.send(data, now)
        self._way_to_device.send(self.to_device(data), now)

    def _deliver(self):
        now = time.monotonic()
        for piece in self._way_to_device.arrived(now):
            self._write(self._device_end, piece)
        for piece in () if self._is_held else self._way_to_port.arrived(now):
            if self._port_end is not None:
                self._write(self._port_end, piece)

    def _fulfil(self):
        """Whether that was the last wish."""
        os.read(self._woken, 1)
        wish, ends, done = self._wishes.get()
        wish()
        done.set()
        return ends

    @staticmethod
    def _read(end):
        try:
            return os.read(end, 4096)
        except OSError:  # EIO: the program at the other side is closing it just now
            return b""

    @staticmethod
    def _write(end, data):
        try:
            os.write(end, data)
        except OSError:  # EAGAIN: nobody has read for long; EIO: see above
            pass
