# SPDX-License-Identifier: Apache-2.0
"""A driver that serves a live page of what it reads."""
import http.client
import json
import re
import socket
import unittest

from std_msgs.msg import UInt16

from support import process, testing
from support.patience import PATIENCE
from support.ports import free_port, free_port_with_the_next

MAP = """
name: {name}
address: 127.0.0.1
port: {port}
rate: 20
timeout: 60
mapping:
  holding_registers: {{speed: {{address: 7, type: UINT, units: rpm}}}}
"""


class Page:
    """As a browser has it open."""

    def __init__(self, url):
        self.place, key = re.fullmatch(r"http://(.*)/#([0-9a-f]{32})", url).groups()
        self._authorization = {}
        self._authorization = {"Authorization": "Bearer " + self.ask("POST", "/token", key)[1]}
        self._stream = http.client.HTTPConnection(self.place, timeout=PATIENCE)
        self._stream.request("GET", "/events", headers=self._authorization)
        self._events = self._stream.getresponse()

    def ask(self, method, path, body=None):
        connection = http.client.HTTPConnection(self.place, timeout=PATIENCE)
        connection.request(method, path, body, self._authorization)
        answer = connection.getresponse()
        text = answer.read().decode()
        connection.close()
        return answer.status, text

    def wait_for(self, point, condition):
        """Its first state that is so."""
        while True:
            line = self._events.readline()
            if not line:
                raise AssertionError("the stream ended")
            state = json.loads(line.removeprefix(b"data: ") if line.strip() else "{}").get("points", {}).get(point)
            if state and condition(state):
                return state

    def close(self):
        self._events.close()
        self._stream.close()


@unittest.skipUnless(process.has_node(), "coupler-node was not built")
class PanelOfADriver(testing.RosTest):
    def setUp(self):
        super().setUp()
        self.map, self.node = self.start("press")

    def start(self, name):
        port = free_port()
        map_ = process.write_map(MAP.format(name=name, port=port))
        node = process.Node(map_, port=port)
        self.addCleanup(node.end)
        return map_, node

    def page(self, driver, name):
        driver.wait_for(f"{name}: panel: http://127.0.0.1:")
        page = Page(re.search(rf"{name}: panel: (http://\S+#[0-9a-f]{{32}})", driver.output)[1])
        self.addCleanup(page.close)
        return page

    def drive(self, *arguments):
        return self.driver("--map", self.map, *arguments)

    def test_it_shows_what_the_driver_reads_and_writes_nothing(self):
        page = self.page(self.drive(f"_panel:={free_port()}"), "press")
        page.wait_for("speed", lambda state: (state["quality"], state.get("value")) == ("good", 0))
        self.publisher("/press/speed/write", UInt16).publish(4711)
        page.wait_for("speed", lambda state: state.get("value") == 4711)
        self.assertNotIn('"write"', page.ask("GET", "/points.json")[1])
        self.assertEqual(page.ask("POST", "/write", json.dumps({"point": "speed", "value": "1"}))[0], 403)
        self.node.end()
        page.wait_for("speed", lambda state: state["quality"] == "offline")

    def test_of_several_devices_each_has_the_next_port(self):
        belt, _ = self.start("belt")
        port = free_port_with_the_next()
        driver = self.driver("--maps", f"{self.map},{belt}", f"_panel:={port}")
        for name, its in (("press", port), ("belt", port + 1)):
            page = self.page(driver, name)
            self.assertEqual(page.place, f"127.0.0.1:{its}")
            page.wait_for("speed", lambda state: state.get("value") == 0)

    def test_a_port_that_is_in_use_is_told_and_the_driver_drives(self):
        with socket.create_server(("127.0.0.1", 0)) as taken:
            driver = self.drive(f"_panel:={taken.getsockname()[1]}")
            driver.wait_for("there is no panel")
            self.topic("/press/speed", UInt16).wait_for(lambda value: value == 0)


if __name__ == "__main__":
    testing.main()
