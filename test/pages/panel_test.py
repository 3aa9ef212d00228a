# SPDX-License-Identifier: Apache-2.0
"""The live page of `coupler panel` as people use it, in front of a real node. COUPLER and NODE are the programs."""
import signal
import socket
import unittest

from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from browser import DESKTOP, PHONE
from panel_case import POINTS, SHOWN, PanelCase, Program

BIG = 1000


class Panel(PanelCase):
    def test_a_value_changes_when_the_device_s_does(self):
        self.serve()
        self.await_value("door", "off")
        self.await_value("level", "-2 mm")
        self.set_coil(0, True)
        self.await_value("lamp", "on")
        self.await_value("door", "on")
        self.set_register(0, -40)
        self.await_value("setpoint", "-40 °C")
        self.set_register(2, 3)
        self.browser.await_true(lambda: "running" in self.text(self.row("mode", "td.value")))
        self.set_register(1, 0x8005)
        self.browser.await_true(lambda: "0x8005" in self.text(self.row("word", "td.value")))
        self.assertIn("0, 2, 15", self.element(self.row("word", "td.value small")).text)
        self.browser.await_true(lambda: "off" in self.element(self.row("door", "td.seen")).text
                                and "on" in self.element(self.row("door", "td.seen")).text)
        self.browser.await_true(lambda: self.element(self.row("level", "td.value small")).text.endswith("s ago"))

    def test_every_point_has_its_row_and_its_name_is_a_text(self):
        self.serve()
        self.assertEqual(self.browser.run(SHOWN), POINTS)
        self.assertEqual(self.browser.driver.title, "press: panel")
        self.assertIn("press", self.element("#name").text)
        self.assertIn("</td><script>", self.element(self.row("lamp", "th")).text)

    def test_bits_of_a_word_are_lamps_with_a_history_when_they_are_wanted(self):
        self.serve("--write")
        self.set_register(1, 0x8005)
        self.browser.await_true(lambda: "0x8005" in self.text(self.row("word", "td.value")))
        button = self.element(self.row("word", "th button"))
        self.assertEqual((button.text, button.get_attribute("aria-expanded")), ("show 16 bits", "false"))
        button.click()
        lamps = [f"word.{bit}" for bit in range(16)]
        self.assertEqual(self.browser.run(SHOWN), ["lamp", "valves", "door", "level", "setpoint", "word", *lamps, "mode", "label"])
        self.assertEqual([self.text(self.row(lamp, "td.value")) for lamp in lamps],
                         ["on" if 0x8005 >> bit & 1 else "off" for bit in range(16)])
        self.set_register(1, 0x0006)
        self.await_value("word.0", "off")
        self.assertEqual([self.text(self.row(f"word.{bit}", "td.seen")) for bit in (0, 1, 2, 3)],
                         ["off · on · 2 changes", "off · on · 1 change", "off · on · 1 change", "off"])
        self.browser.await_true("return document.querySelector('tr[data-point=\"word.2\"] path').getAttribute('d').includes('M299')")
        self.assertEqual(self.browser.run("return document.querySelectorAll('tr.bit.on').length"), 2)
        self.screenshot("panel-bits")
        self.element("#filter").send_keys("word")
        self.browser.await_true(lambda: self.browser.run(SHOWN) == ["word", *lamps])
        self.element("#filter").send_keys("x")
        self.browser.await_true(lambda: self.browser.run(SHOWN) == [])
        self.element("#filter").send_keys(Keys.BACKSPACE)
        self.node.stop()
        self.await_state("offline")
        self.browser.await_true("return document.querySelectorAll('tr.bit.away').length === 16")
        button.click()
        self.assertEqual(self.browser.run(SHOWN), ["word"])
        self.assertEqual(self.browser.complaints(), [])

    def test_a_curve_is_drawn(self):
        self.serve()
        for value in (1, 50, -50):
            self.set_register(0, value)
            self.await_value("setpoint", f"{value} °C")
        self.browser.await_true(
            "return /M/.test(document.querySelector('tr[data-point=setpoint] td.curve path').getAttribute('d') || '')")
        self.assertNotRegex(self.element(self.row("setpoint", "td.curve path")).get_attribute("d"), "NaN|Infinity")
        self.assertEqual(self.browser.complaints(), [], "nothing that the drawing does is forbidden")

    def test_loads_without_a_complaint_and_nothing_from_elsewhere(self):
        for options in ((), ("--write",)):
            with self.subTest(options):
                panel = self.serve(*options)
                self.await_value("level", "-2 mm")
                self.browser.await_true("return document.querySelector('td.curve path').hasAttribute('d')")
                asked = self.browser.requests()
                self.assertEqual([url for url in asked if not url.startswith(panel.origin + "/")], [])
                self.assertIn(f"{panel.origin}/points.json", asked)
                self.assertEqual([url for url in asked if url.partition("#")[0].count(panel.url.partition("#")[2])], [],
                                 "the key stands in no address that a server sees")
                self.assertEqual(self.browser.complaints(), [])

    def test_forbids_the_network_to_whatever_gets_into_it(self):
        self.serve()
        outcome = self.browser.driver.execute_async_script(
            "const done = arguments[0]; fetch('http://127.0.0.1:9/').then(() => done('asked'), e => done(e.message));")
        self.assertNotEqual(outcome, "asked")
        self.browser.run("const made = document.createElement('script'); made.textContent = 'document.title = `broken`';"
                         "document.body.append(made)")
        self.assertEqual(self.browser.driver.title, "press: panel")

    def test_without_the_key_nothing_is_shown(self):
        panel = self.serve()
        for address in (panel.origin + "/", f"{panel.origin}/#{'0' * 32}"):
            self.browser.open(address)
            self.await_state("offline")
            self.assertIn("terminal", self.element("#device").text)
            self.assertEqual(self.browser.run(SHOWN), [])

    def test_read_only_has_no_controls(self):
        self.serve()
        self.await_value("level", "-2 mm")
        self.assertEqual(self.browser.run("return document.querySelectorAll('#points .write *').length"), 0)
        status = self.browser.driver.execute_async_script("""const done = arguments[0];
            ask("write", {method: "POST", body: '{"point": "lamp", "value": "true"}'})
              .then(() => done("written"), error => done(error.message))""")
        self.assertIn("--write", status)
        self.assertFalse(self.coil(0))

    def test_a_click_writes_and_the_outcome_stands_beside_it(self):
        self.serve("--write")
        self.await_value("lamp", "off")
        switch = self.element(self.row("lamp", "td.write [role=switch]"))
        switch.click()
        self.await_outcome("lamp", "ok")
        self.assertTrue(self.coil(0))
        self.await_value("lamp", "on")
        self.browser.await_true("return document.querySelector('[role=switch]').getAttribute('aria-checked') === 'true'")
        switch.click()
        self.await_value("door", "off")
        self.assertFalse(self.coil(0))
        self.assertEqual(self.browser.complaints(), [])
        for point in ("door", "level"):
            self.assertEqual(self.browser.run("return document.querySelectorAll(arguments[0]).length",
                                              self.row(point, "td.write *")), 0)
        self.screenshot("panel-write")

    def test_a_field_writes_a_number_and_says_why_it_does_not(self):
        self.serve("--write")
        self.await_value("setpoint", "0 °C")
        field = self.element(self.row("setpoint", "td.write input"))
        field.send_keys("-40", Keys.ENTER)
        self.await_outcome("setpoint", "ok")
        self.await_value("setpoint", "-40 °C")
        self.assertEqual(self.register(0), -40)
        self.assertIn("100", self.element(self.row("setpoint", "td.write")).text + (field.get_attribute("title") or "")
                      + (field.get_attribute("placeholder") or ""))
        field.clear()
        field.send_keys("101", Keys.ENTER)
        self.browser.await_true(lambda: "refused" in self.text(self.row("setpoint", "output.outcome")))
        self.assertIn("100", self.text(self.row("setpoint", "output.outcome")))
        self.assertEqual(self.register(0), -40)
        valves = self.element(self.row("valves", "td.write input"))
        valves.send_keys("[true, false, true]", Keys.ENTER)
        self.await_outcome("valves", "ok")
        self.assertTrue(self.coil(3))
        label = self.element(self.row("label", "td.write input"))
        label.send_keys("<b>ä", Keys.ENTER)
        self.await_outcome("label", "ok")
        self.await_value("label", "<b>ä")

    def test_says_by_the_controls_what_becomes_of_a_watchdog(self):
        self.serve("--write")
        self.assertIn("watchdog", self.element("body").text)
        self.serve()
        self.assertNotIn("watchdog", self.element("body").text)

    def test_a_device_that_is_lost_greys_out_and_comes_back(self):
        self.serve()
        self.await_value("level", "-2 mm")
        port = self.node.port
        self.assertEqual(self.browser.run("return document.querySelectorAll('tr.away').length"), 0)
        self.node.stop()
        self.await_state("offline")
        self.browser.await_true("return document.querySelectorAll('#points tr.away').length === " + str(len(POINTS)))
        self.browser.await_true(lambda: "offline" in self.element(self.row("level", "td.value small")).text)
        self.assertLess(float(self.browser.run("return getComputedStyle(document.querySelector('#points tr')).opacity")), 1)
        self.screenshot("panel-lost")
        self.start_node(self.map_file, port)
        self.await_state("online")
        self.browser.await_true("return document.querySelectorAll('#points tr.away').length === 0")

    def controls(self):
        """Of every point that can be written: whether it can be used, and what is said of it."""
        return self.browser.run("""return Array.from(document.querySelectorAll(
            ".write button, .write input, .write select")).map(control => [!control.disabled, control.title])""")

    def test_nothing_can_be_written_while_the_device_is_offline_and_what_was_typed_stays(self):
        panel = self.serve("--write")
        self.await_value("lamp", "off")
        field = self.element(self.row("setpoint", "td.write input"))
        field.send_keys("-40")
        mode = self.element(self.row("mode", "td.write select"))
        mode.send_keys("running")
        usable = self.controls()
        self.assertEqual({can for can, _ in usable}, {True})
        self.assertIn("100", field.get_attribute("title"))
        port = self.node.port
        self.node.stop()
        self.await_state("offline")
        self.browser.await_true(lambda: {can for can, _ in self.controls()} == {False})
        self.assertEqual([title for _, title in self.controls() if not title.startswith("offline: ")], [])
        self.screenshot("panel-offline-write")
        self.start_node(self.map_file, port)
        self.await_state("online")
        self.browser.await_true(lambda: self.controls() == usable)
        self.assertEqual((field.get_attribute("value"), mode.get_attribute("value")), ("-40", "running"))
        field.send_keys(Keys.ENTER)
        self.await_outcome("setpoint", "ok")
        panel.stop()
        self.browser.await_true(lambda: {can for can, _ in self.controls()} == {False})

    def test_a_panel_that_ends_is_said_and_greys_out(self):
        panel = self.serve()
        self.await_value("level", "-2 mm")
        self.assertEqual(panel.stop(), 0)
        self.await_state("offline")
        self.browser.await_true("return document.querySelectorAll('#points tr.away').length === " + str(len(POINTS)))

    def test_a_device_that_is_not_there_is_grey_from_the_beginning(self):
        with socket.socket() as place:
            place.bind(("127.0.0.1", 0))  # nobody listens
            panel = self.things.enter_context(Program(self.map_file, place.getsockname()[1]))
            self.browser.open(panel.url)
            self.await_state("offline")
            self.browser.await_true("return document.querySelectorAll('#points tr.away').length === " + str(len(POINTS)))

    def test_filters_by_name(self):
        self.serve()
        query = self.element("#filter")
        query.send_keys("LAM")
        self.browser.await_true("return document.querySelectorAll('#points tr[hidden]').length > 0")
        self.assertEqual(self.browser.run(SHOWN), ["lamp"])
        query.send_keys("x")
        self.browser.await_true("return document.querySelectorAll('#points tr:not([hidden])').length === 0")
        self.assertEqual(self.browser.run(SHOWN), [])
        query.send_keys(Keys.BACKSPACE * 4)
        self.browser.await_true("return document.querySelectorAll('#points tr[hidden]').length === 0")
        self.assertEqual(self.browser.run(SHOWN), POINTS)

    def test_saves_the_loop_check(self):
        self.serve()
        self.browser.command("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(self.folder))
        self.await_value("level", "-2 mm")
        self.element("#save").click()
        self.browser.await_true(lambda: (self.folder / "seen.csv").exists())
        lines = (self.folder / "seen.csv").read_text("utf-8").splitlines()
        self.assertEqual((lines[0], len(lines)), ("point,seen_off,seen_on,changes,table,address,modicon,part", 1 + len(POINTS) + 16))
        self.assertIn("word.15,yes,no,0,holding_registers,1,40002,bit 15", lines)

    def test_fits_a_phone_and_a_screen(self):
        for size in (DESKTOP, PHONE):
            for options in ((), ("--write",)):
                with self.subTest(size=size, options=options):
                    self.serve(*options, size=size)
                    self.await_value("level", "-2 mm")
                    self.assertLessEqual(self.browser.run("return document.documentElement.scrollWidth"), size[0])
                    self.assertEqual(self.browser.run(SHOWN), POINTS)
                    self.screenshot(f"panel-{size[0]}{''.join(options)}")
        for control in self.browser.driver.find_elements(By.CSS_SELECTOR, "button, input, select"):
            if control.is_displayed():
                self.assertGreaterEqual(control.size["height"], 30, "a finger hits it")

    def test_says_where_a_point_is_on_a_phone_and_a_screen_in_modicon_numbers_too(self):
        map_file = self.folder / "modicon.yaml"
        map_file.write_text("name: pump\ntimeout: 20s\naddressing: modicon\nmapping:\n"
                            "  holding_registers: {speed: {address: 40008, type: REAL},\n"
                            "                      ready: {address: 40010, type: BOOL, bit: 3}}\n", "utf-8")
        for size in (DESKTOP, PHONE):
            with self.subTest(size=size):
                self.serve(map_file=map_file, size=size)
                places = [self.element(self.row(point, "td.address")).text.split("\n") for point in ("speed", "ready")]
                self.assertEqual([" ".join(place) for place in places],
                                 ["holding registers 7 – 8 40008 – 40009", "holding registers 9, bit 3 40010"])
                self.screenshot(f"panel-modicon-{size[0]}")

    def test_has_a_dark_side(self):
        def lightness(what, selector="body"):
            colour = self.browser.run(f"return getComputedStyle(document.querySelector(arguments[0])).{what}", selector)
            return sum(int(part) for part in colour[colour.index("(") + 1:-1].split(",")[:3])
        self.serve("--write", dark=True)
        self.await_value("level", "-2 mm")
        self.assertGreater(lightness("color"), 500)
        self.assertLess(lightness("backgroundColor", "header"), 200)
        self.screenshot("panel-dark")

    def test_is_used_by_keyboard(self):
        self.serve("--write")
        self.await_value("lamp", "off")
        reached = []
        focused = self.element("body")
        for _ in range(8):
            focused.send_keys(Keys.TAB)
            focused = self.browser.driver.switch_to.active_element
            reached.append(focused.get_attribute("id") or focused.get_attribute("role"))
            if reached[-1] == "switch":
                break
        self.assertEqual((reached[:2], reached[-1]), (["filter", "save"], "switch"))
        self.assertNotEqual(self.browser.run("const style = getComputedStyle(document.activeElement);"
                                             "return style.outlineStyle"), "none", "one sees where one is")
        focused.send_keys(Keys.SPACE)
        self.await_outcome("lamp", "ok")
        self.assertTrue(self.coil(0))

    def test_is_heard_by_a_screen_reader(self):
        self.serve("--write")
        self.await_value("lamp", "off")
        nameless = self.browser.run("""return Array.from(document.querySelectorAll("button, input, select")).filter(
            control => !control.textContent && !control.getAttribute("aria-label") && !control.labels?.length).length""")
        self.assertEqual(nameless, 0)
        self.assertEqual(self.element("#device").get_attribute("role"), "status")
        self.assertEqual(self.element(self.row("lamp", "[role=switch]")).accessible_name, "lamp")

    def test_shows_a_thousand_points(self):
        lines = ["name: plant", "rate: 10", "timeout: 20s", "mapping:", "  holding_registers:"]
        lines += [f"    r{i}: {{address: {i}, type: INT}}" for i in range(BIG)]
        map_file = self.folder / "plant.yaml"
        map_file.write_text("\n".join(lines) + "\n", "utf-8")
        self.serve("--write", map_file=map_file)
        self.browser.await_true("return [...document.querySelectorAll('#points td.value')]"
                                f".filter(cell => cell.firstChild.textContent === '0').length === {BIG}")
        self.set_register(BIG - 1, 4711)
        self.await_value(f"r{BIG - 1}", "4711")
        self.element("#filter").send_keys(f"r{BIG - 1}")
        self.browser.await_true(lambda: self.browser.run(SHOWN) == [f"r{BIG - 1}"])
        self.assertEqual(self.browser.complaints(), [])

    def test_what_can_only_be_written_is_switched_on_and_off(self):
        map_file = self.folder / "horn.yaml"
        map_file.write_text("name: horn\ntimeout: 20s\nmapping:\n  coils: {horn: {address: 5, access: write}}\n"
                            "  discrete_inputs: {sounds: 5}\nsim: [{from: horn, to: sounds}]\n", "utf-8")
        self.serve("--write", map_file=map_file)
        on, off = self.browser.driver.find_elements(By.CSS_SELECTOR, self.row("horn", "td.write button"))
        for button, value in ((on, "on"), (off, "off")):
            button.click()
            self.await_value("sounds", value)
        self.assertIn("only be written", self.element(self.row("horn", "td.value")).text)

    def test_the_address_of_another_start_may_be_put_into_the_same_page(self):
        panel = self.serve()
        self.browser.open(f"{panel.origin}/#{'0' * 32}")
        self.await_state("offline")
        self.browser.run("location.hash = arguments[0]", panel.url.partition("#")[2])
        self.await_state("online")

    def test_a_panel_that_says_nothing_any_more_is_noticed(self):
        panel = self.serve()
        self.await_value("lamp", "off")
        panel.process.send_signal(signal.SIGSTOP)
        self.addCleanup(panel.process.send_signal, signal.SIGCONT)
        self.await_state("offline")
        panel.process.send_signal(signal.SIGCONT)
        self.await_state("online")

    def open_another(self, panel):
        """A page in a window of its own; the windows before and of it."""
        driver = self.browser.driver
        before = driver.current_window_handle
        driver.switch_to.new_window("window")
        own = driver.current_window_handle
        self.addCleanup(lambda: (driver.switch_to.window(own), driver.close(), driver.switch_to.window(before)))
        self.browser.open(panel.url)
        return before, own

    def test_two_pages_show_the_same(self):
        panel = self.serve("--write")
        driver = self.browser.driver
        first, _ = self.open_another(panel)
        self.await_state("online")
        self.await_value("lamp", "off")
        self.element(self.row("lamp", "[role=switch]")).click()
        self.await_outcome("lamp", "ok")
        self.await_value("door", "on")
        driver.switch_to.window(first)
        self.await_value("lamp", "on")
        self.assertEqual(self.text(self.row("lamp", "output.outcome")), "", "the outcome is the other page's")

    def test_a_browser_s_fifth_page_waits_so_that_the_others_can_write(self):
        panel = self.serve("--write")
        first = self.browser.driver.current_window_handle
        for _ in range(3):
            self.open_another(panel)
            self.await_state("online")
        _, fifth = self.open_another(panel)
        self.browser.await_true(lambda: "close one of them" in self.element("#device").text)
        self.browser.driver.switch_to.window(first)
        self.element(self.row("lamp", "[role=switch]")).click()
        self.await_outcome("lamp", "ok")
        self.browser.open("about:blank")
        self.browser.driver.switch_to.window(fifth)
        self.await_state("online")
        self.await_value("lamp", "on")


if __name__ == "__main__":
    unittest.main()
