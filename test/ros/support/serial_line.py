# SPDX-License-Identifier: Apache-2.0
"""A serial line without hardware: two pseudo terminals, and what happens to the bytes between them."""
import os
import pathlib
import pty
import select
import tempfile
import threading
import time
import tty


class SerialLine:
    """`port` is for the host, and stays the same name over unplug() and plug_in(); `device` is for a server.

    baud: characters of 10 bits take their time; 0: they take none. to_device, to_port: what a test makes of the bytes of
    one read on the way there. echoes: the port gets what it sends, too.
    """

    def __init__(self, baud=0):
        self.baud = baud
        self.to_device = self.to_port = lambda data: data
        self.echoes = False
        self._folder = tempfile.TemporaryDirectory()
        self.port = str(pathlib.Path(self._folder.name, "port"))
        self._device_end, self._device_held, self.device = self._terminal()
        self._port_end = self._port_held = None
        self._over = False
        self._lock = threading.Lock()
        self.plug_in()
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
        with self._lock:
            self._port_end, self._port_held, name = self._terminal()
            os.symlink(name, self.port)

    def unplug(self):
        with self._lock:
            os.unlink(self.port)
            os.close(self._port_end)
            os.close(self._port_held)
            self._port_end = self._port_held = None

    def end(self):
        self._over = True
        self._thread.join()
        if self._port_end is not None:
            self.unplug()
        os.close(self._device_end)
        os.close(self._device_held)
        self._folder.cleanup()

    def _run(self):
        while not self._over:
            time.sleep(0)  # lets unplug() have the lock
            with self._lock:
                port = self._port_end
                ends = [self._device_end] + ([port] if port is not None else [])
                for end in select.select(ends, [], [], 0.001)[0]:
                    data = os.read(end, 4096)
                    if end == port:
                        self._carry(data if self.echoes else b"", port)
                        self._carry(self.to_device(data), self._device_end)
                    elif port is not None:
                        self._carry(self.to_port(data), port)

    def _carry(self, data, sink):
        begin = time.monotonic()
        for i, byte in enumerate(data):
            if self.baud:
                time.sleep(max(0, begin + (i + 1) * 10 / self.baud - time.monotonic()))
            os.write(sink, bytes([byte]))
