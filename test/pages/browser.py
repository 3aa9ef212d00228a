# SPDX-License-Identifier: Apache-2.0
"""A page in Chromium without a screen: what it shows, what it asks of the network, what it complains about."""
import base64
import json
import pathlib
import re
import subprocess
import tempfile
import unittest

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chromium.remote_connection import ChromiumRemoteConnection
from selenium.webdriver.support.wait import WebDriverWait

PATIENCE = 120  # seconds: tells hanging from working, on any machine
DESKTOP = (1440, 1000)
PHONE = (390, 844)

# The visible points, top to bottom.
SHOWN = """return Array.from(document.querySelectorAll("#points tbody tr"))
  .filter(row => row.offsetParent !== null || row.getClientRects().length)
  .map(row => row.id.replace("point-", ""))"""


class Browser:
    def __init__(self):
        options = Options()
        # A container has neither the sandbox's privileges nor a large /dev/shm.
        for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        # It takes a port itself: Selenium would choose one that somebody else may take meanwhile.
        self._server = subprocess.Popen(["/usr/bin/chromedriver", "--port=0"], stdout=subprocess.PIPE, text=True)
        try:
            said = iter(self._server.stdout.readline, "")
            port = next(found[1] for line in said if (found := re.search(r"started successfully on port (\d+)", line)))
            there = ChromiumRemoteConnection(f"http://127.0.0.1:{port}", "goog", "chrome")
            self.driver = webdriver.Remote(there, options=options)
        except BaseException:
            self._server.terminate()
            raise
        self.driver.set_page_load_timeout(PATIENCE)
        self.driver.set_script_timeout(PATIENCE)

    def close(self):
        self.driver.quit()
        self._server.terminate()
        self._server.communicate()

    def await_true(self, condition):
        """Until the function, or the script, says so."""
        WebDriverWait(self, PATIENCE, 0.02).until(lambda _: self.run(condition) if isinstance(condition, str) else condition())

    def command(self, name, **parameters):
        return self.driver.execute("executeCdpCommand", {"cmd": name, "params": parameters})["value"]

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def open(self, path, size=DESKTOP, dark=False, scripts=True):
        """`path`: of a file, or a URL."""
        self.command("Emulation.setDeviceMetricsOverride", width=size[0], height=size[1], deviceScaleFactor=1,
                     mobile=size == PHONE)
        self.command("Emulation.setEmulatedMedia", media="",
                     features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        self.command("Emulation.setScriptExecutionDisabled", value=not scripts)
        self.driver.get("about:blank")  # otherwise another #hash would not load the page again
        self.complaints()
        self.requests()
        self.driver.get(path if "://" in str(path) else pathlib.Path(path).absolute().as_uri())

    def complaints(self):
        """What is in the console since the last call."""
        return [entry["message"] for entry in self.driver.get_log("browser")]

    def requests(self):
        """The URLs asked for since the last call."""
        messages = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        return [message["params"]["request"]["url"] for message in messages
                if message["method"] == "Network.requestWillBeSent"]

    def shown(self):
        return self.run(SHOWN)

    def screenshot(self, path):
        picture = self.command("Page.captureScreenshot", format="png")
        pathlib.Path(path).write_bytes(base64.b64decode(picture["data"]))


class BrowserCase(unittest.TestCase):
    """One browser and one folder for all tests of a class."""

    @classmethod
    def setUpClass(cls):
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
