#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes docs/panel.png: `coupler panel` of a press that works, after the ten minutes that its curves show.

    test/pages/panel_picture.py build/default/bin/coupler docs/panel.png [SECONDS]     fewer, to try it
"""
import base64
import logging
import math
import pathlib
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time

from pymodbus.datastore import ModbusSequentialDataBlock, ModbusServerContext, ModbusSlaveContext
from pymodbus.server import StartTcpServer

from browser import Browser

PORT = 15020
MAP = f"""\
name: press
address: 127.0.0.1
port: {PORT}
rate: 20
mapping:
  coils:
    clamp: {{address: 0, description: "Y1, closes the clamp"}}
    lamp: {{address: 1, description: "H1, above the door"}}
  discrete_inputs:
    part_present: {{address: 0, description: "B1, a part lies in the tool"}}
    clamped: {{address: 1, description: "S1, the clamp is closed"}}
    door_closed: {{address: 2, description: "S2, guard door"}}
  input_registers:
    pressure: {{address: 0, type: REAL, order: ABCD, units: bar, description: "P1, main cylinder"}}
    oil: {{address: 2, type: INT, scale: 0.1, units: °C, description: "T1, in the tank"}}
    step: {{address: 3, type: UINT, values: {{0: waiting, 1: clamping, 2: pressing, 3: opening}}}}
    state: {{address: 4, type: WORD, description: "Bit 0 ready, 1 pressing, 3 oil is warm"}}
    valve_temperature: {{address: 40, type: INT, units: °C, description: "T2, its module is not plugged in"}}
  holding_registers:
    force: {{address: 0, type: UINT, units: kN, min: 10, max: 250, description: "Set point"}}
    good_parts: {{address: 1, type: UDINT, order: ABCD, access: read}}
"""
CYCLE = 24  # seconds a part


def as_registers(form, number):
    packed = struct.pack(form, number)
    return list(struct.unpack(f">{len(packed) // 2}H", packed))


class Press:
    """What the press has in its tables at a time."""

    def __init__(self):
        self.slave = ModbusSlaveContext(
            di=ModbusSequentialDataBlock(0, [False] * 16), co=ModbusSequentialDataBlock(0, [False] * 16),
            ir=ModbusSequentialDataBlock(0, [0] * 16), hr=ModbusSequentialDataBlock(0, [120] + [0] * 15), zero_mode=True)
        threading.Thread(target=StartTcpServer, daemon=True, kwargs={
            "context": ModbusServerContext(self.slave, single=True), "address": ("127.0.0.1", PORT), "allow_reuse_address": True}).start()

    def work(self, began):
        while True:
            self.turn(time.monotonic() - began)
            time.sleep(0.05)

    def turn(self, now):
        parts, into = divmod(now, CYCLE)
        step = 0 if into < 5 else 1 if into < 8 else 2 if into < 18 else 3 if into < 21 else 0
        lifted = max(0.0, min(1.0, (into - 8) / 3)) * max(0.0, min(1.0, (20 - into) / 2))
        force = self.slave.getValues(3, 0, 1)[0]
        pressure = 4.2 + force * 0.9 * lifted + 1.5 * math.sin(now / 1.7)
        oil = 41 + 6 * math.sin(now / 170) + 0.4 * math.sin(now / 3)
        self.slave.setValues(2, 0, [3 < into < 22, 7 < into < 19, now % 150 > 9])
        self.slave.setValues(4, 0, as_registers(">f", round(pressure, 1)) + [int(oil * 10), step, 1 | (step == 2) << 1 | (oil > 44) << 3])
        self.slave.setValues(3, 1, as_registers(">I", 1284 + int(parts)))


def take(url, seconds, picture):
    browser = Browser()
    try:
        browser.command("Emulation.setDeviceMetricsOverride", width=1280, height=1000, deviceScaleFactor=1, mobile=False)
        browser.command("Emulation.setEmulatedMedia", media="", features=[{"name": "prefers-color-scheme", "value": "light"}])
        browser.driver.get(url)
        browser.await_true('return document.querySelector("#device").dataset.state === "online"')
        time.sleep(seconds - seconds % CYCLE + 13)  # in the middle of a stroke
        browser.run("""document.querySelector('tr[data-point="lamp"] .write button').click()""")
        browser.await_true("""return document.querySelector('tr[data-point="lamp"] output').textContent === "ok" """)
        time.sleep(1)
        below = browser.run('return document.querySelector("table").getBoundingClientRect().bottom')
        shot = browser.command("Page.captureScreenshot", format="png",
                               clip={"x": 0, "y": 0, "width": 1280, "height": math.ceil(below) + 12, "scale": 1})
        pathlib.Path(picture).write_bytes(base64.b64decode(shot["data"]))
    finally:
        browser.close()


def main(coupler, picture, seconds="600"):
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # by way of what ends browser and panel
    logging.disable()  # of pymodbus: an address that is not there is meant
    press = Press()
    threading.Thread(target=press.work, args=(time.monotonic(),), daemon=True).start()
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "press.yaml")
        path.write_text(MAP, "utf-8")
        with subprocess.Popen([coupler, "panel", path, "--write"], stdout=subprocess.PIPE, text=True) as panel:
            try:
                take(panel.stdout.readline().strip(), float(seconds), picture)
            finally:
                panel.terminate()


if __name__ == "__main__":
    main(*sys.argv[1:])
