# SPDX-License-Identifier: Apache-2.0
"""A node, `coupler panel` in front of it, and its page in a browser. COUPLER and NODE are the programs."""
import contextlib
import os
import pathlib
import struct
import subprocess
import sys
import tempfile

from selenium.webdriver.common.by import By

from browser import PATIENCE, BrowserCase

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "support"))
from raw_client import RawClient  # noqa: E402
from served import Served  # noqa: E402

MAP = """\
name: press
rate: 20
timeout: 20s
mapping:
  coils:
    lamp: {address: 0, description: "</td><script>document.title = 'broken'</script>"}
    valves: {address: 1, count: 3}
  discrete_inputs: {door: 0}
  input_registers: {level: {address: 0, type: INT, initial: -2, units: mm}}
  holding_registers:
    setpoint: {address: 0, type: INT, min: -100, max: 100, units: "°C"}
    word: {address: 1, type: WORD}
    mode: {address: 2, type: UINT, values: {0: stopped, 3: running}}
    label: {address: 3, type: STRING, length: 8}
sim: [{from: lamp, to: door}]
"""
POINTS = ["lamp", "valves", "door", "level", "setpoint", "word", "mode", "label"]
SHOWN = """return Array.from(document.querySelectorAll("#points tr"))
  .filter(row => row.getClientRects().length).map(row => row.dataset.point)"""


class Program:
    """`coupler panel`, which prints its address."""

    def __init__(self, map_file, port, *options):
        self.said = tempfile.TemporaryFile("w+")
        self.process = subprocess.Popen([os.environ["COUPLER"], "panel", map_file, "--at", f"127.0.0.1:{port}", *options],
                                        stdout=subprocess.PIPE, stderr=self.said, text=True)
        self.url = self.process.stdout.readline().strip()
        self.origin = self.url.partition("/#")[0]

    def stop(self):
        self.process.terminate()
        return self.process.wait(PATIENCE)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        self.process.stdout.close()
        self.said.close()


class PanelCase(BrowserCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.map_file = cls.folder / "press.yaml"
        cls.map_file.write_text(MAP, "utf-8")

    def setUp(self):
        # Its pages would be pages of the next test's panel, which try again for ever.
        self.addCleanup(self.browser.driver.get, "about:blank")
        self.things = self.enterContext(contextlib.ExitStack())
        self.node = None

    def serve(self, *options, map_file=None, **how):
        """A node, a panel of it, and its page."""
        map_file = map_file or self.map_file
        self.node = self.start_node(map_file, 0)
        panel = self.things.enter_context(Program(map_file, self.node.port, *options))
        self.browser.open(panel.url, **how)
        self.await_state("online")
        return panel

    def start_node(self, map_file, port):
        return self.things.enter_context(Served([os.environ["NODE"], map_file, "--sim", "--listen", "127.0.0.1", "--port",
                                                 str(port)]))

    def element(self, selector):
        return self.browser.driver.find_element(By.CSS_SELECTOR, selector)

    def row(self, point, selector=""):
        return f'tr[data-point="{point}"] {selector}'

    def text(self, selector):
        return self.browser.run("const found = document.querySelector(arguments[0]);"
                                "return found && found.firstChild ? found.firstChild.textContent : ''", selector)

    def await_state(self, state):
        self.browser.await_true(f"return document.getElementById('device').dataset.state === '{state}'")

    def await_value(self, point, value):
        self.browser.await_true(lambda: self.text(self.row(point, "td.value")) == value)

    def await_outcome(self, point, text):
        self.browser.await_true(lambda: self.text(self.row(point, "output.outcome")) == text)

    def write(self, pdu):
        with RawClient(("127.0.0.1", self.node.port)) as client:
            self.assertEqual(client.ask(pdu)[0], pdu[0])

    def set_coil(self, address, value):
        self.write(struct.pack(">BHH", 5, address, 0xFF00 if value else 0))

    def set_register(self, address, value):
        self.write(struct.pack(">BHH", 6, address, value & 0xFFFF))

    def register(self, address):
        with RawClient(("127.0.0.1", self.node.port)) as client:
            return struct.unpack(">BBh", client.ask(struct.pack(">BHH", 3, address, 1)))[2]

    def coil(self, address):
        with RawClient(("127.0.0.1", self.node.port)) as client:
            return client.ask(struct.pack(">BHH", 1, address, 1))[2] == 1

    def screenshot(self, name):
        if "SCREENSHOTS" in os.environ:
            self.browser.screenshot(pathlib.Path(os.environ["SCREENSHOTS"], f"{name}.png"))
