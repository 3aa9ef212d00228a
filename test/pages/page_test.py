# SPDX-License-Identifier: Apache-2.0
"""The HTML page of a map as a reader sees it. COUPLER is the program, SOURCE_DIR the repository."""
import os
import pathlib
import subprocess
import time
import unittest

from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from browser import DESKTOP, PHONE, BrowserCase

SOURCE = pathlib.Path(os.environ["SOURCE_DIR"])
MAPS = [SOURCE / "config/example-node.yaml", SOURCE / "config/foreign-coupler.yaml", SOURCE / "test/generate/manners.yaml"]
HOSTILE = """\
name: cell
mapping:
  coils:
    lamp: {address: 0, description: "</title></td><script>document.title = 'broken'</script>|`x`", units: "<img src=x onerror=alert(1)>"}
  holding_registers:
    speed: {address: 99, type: REAL, units: "it's < 5 & > 3"}
"""
BIG = 10000


def big_map():
    """As a plant's: runs of points with holes, all four tables, a few types."""
    lines = ["name: plant", "mapping:"]
    for table, of_type in (("coils", ""), ("discrete_inputs", ""), ("input_registers", ", type: REAL"),
                           ("holding_registers", ", type: INT, units: rpm")):
        lines.append(f"  {table}:")
        for i in range(BIG // 4):
            lines.append(f"    {table[:4]}_{i}: {{address: {i * 3 + i // 50 * 10}{of_type}, description: Point {i} of line {i // 100}}}")
    return "\n".join(lines) + "\n"


class Page(BrowserCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        for path in MAPS:
            cls.document(path)

    @classmethod
    def document(cls, path):
        subprocess.run([os.environ["COUPLER"], "generate", path, "--docs", "--out", cls.folder, "--quiet"], check=True)

    def open(self, name, **how):
        self.browser.open(self.folder / f"{name}.html", **how)

    def element(self, selector):
        return self.browser.driver.find_element(By.CSS_SELECTOR, selector)

    def search(self, text):
        query = self.element("#query")
        query.send_keys(Keys.ESCAPE)  # empties it
        query.send_keys(text)
        return self.browser.shown()

    def screenshot(self, name):
        if "SCREENSHOTS" in os.environ:
            self.browser.screenshot(pathlib.Path(os.environ["SCREENSHOTS"], f"{name}.png"))

    def test_loads_without_a_complaint_and_without_the_network(self):
        for name in ("example", "press"):
            self.open(name)
            self.assertEqual(self.browser.complaints(), [])
            asked = [url for url in self.browser.requests() if not url.startswith("data:")]
            self.assertEqual(asked, [(self.folder / f"{name}.html").as_uri()])
            self.screenshot(f"{name}-desktop")

    def test_forbids_the_network_to_whatever_gets_into_it(self):
        self.open("example")
        outcome = self.browser.driver.execute_async_script(
            "const done = arguments[0]; fetch('http://127.0.0.1:9/').then(() => done('asked'), e => done(e.message));")
        self.assertNotEqual(outcome, "asked")
        complaints = []
        self.browser.await_true(lambda: complaints.extend(self.browser.complaints()) or
                                any("Content Security Policy" in text for text in complaints))

    def test_shows_every_point_in_the_order_of_the_map(self):
        self.open("example")
        self.assertEqual(self.browser.shown()[:5], ["relay", "lamp", "horn", "armed", "button"])
        self.assertEqual(self.element("#found").text, "16 points")

    def test_finds_a_point_by_name_description_units_line_and_type(self):
        self.open("example")
        for text, point in (("limit", "limit_switch"), ("spindle", "relay"), ("mm/s", "speed"), ("gpio22", "horn"),
                            ("string", "label"), ("Float32", "ratio"), ("TRAVEL end", "limit_switch")):
            self.assertEqual(self.search(text), [point], text)
        self.assertEqual(self.element("#found").text, "1 of 16 points")

    def test_finds_a_point_by_either_notation_of_any_of_its_addresses(self):
        self.open("example")
        for text, point in (("40001", "speed"), ("400003", "ratio"), ("40003", "ratio"), ("10", "label"),
                            ("00002", "lamp"), ("10003", "lamp_feedback"), ("300004", "presses")):
            self.assertEqual(self.search(text), [point], text)

    def test_keeps_a_range_of_addresses_in_one_line_and_shows_the_orders_of_the_map(self):
        for size in (DESKTOP, PHONE):
            self.open("press", size=size)
            heights = self.browser.driver.execute_script("""
                const lines = (cell) => { const range = document.createRange(); range.selectNode(cell.firstChild);
                                          return new Set([...range.getClientRects()].map(box => box.top)).size; };
                return [...document.querySelectorAll("td.address, td.modicon")].map(lines);""")
            self.assertEqual(set(heights), {1})
            drawings = self.browser.driver.find_elements(By.CSS_SELECTOR, ".drawing svg")
            self.assertEqual(len(drawings), 5)
            self.assertIn("register 9: C 56 D 78; register 10: A 12 B 34",
                          [each.get_attribute("aria-label") for each in drawings])
            self.assertFalse(self.browser.driver.execute_script(
                "return document.documentElement.scrollWidth > document.documentElement.clientWidth"))
            self.browser.driver.execute_script("document.querySelector('#order').scrollIntoView()")
            self.screenshot(f"order-{size[0]}")

    def test_says_so_when_nothing_is_found(self):
        self.open("example")
        self.assertEqual(self.search("nowhere"), [])
        self.assertEqual(self.element("#found").text, "0 of 16 points")

    def test_filters_by_table(self):
        self.open("example")
        self.element("fieldset label:nth-of-type(3)").click()
        self.assertEqual(self.browser.shown(), ["button", "limit_switch", "lamp_feedback"])
        self.assertEqual(self.search("lamp"), ["lamp_feedback"])

    def test_sorts_by_a_column_and_back(self):
        self.open("example")
        names = sorted(self.browser.shown())
        button = self.element("th.name button")
        button.click()
        self.assertEqual(self.browser.shown(), names)
        self.assertEqual(self.element("th.name").get_attribute("aria-sort"), "ascending")
        button.click()
        self.assertEqual(self.browser.shown(), names[::-1])
        self.element("th.address button").click()
        self.assertEqual(self.browser.shown()[-1], "label", "as numbers: 5 is the last")
        self.assertIsNone(self.element("th.name").get_attribute("aria-sort"))

    def test_puts_what_has_no_value_behind_what_has_one(self):
        self.open("example")
        self.element("th.units button").click()
        self.assertEqual(self.browser.shown()[0], "speed")

    def test_goes_from_the_picture_to_the_row_even_if_that_was_not_found(self):
        self.open("example")
        self.search("relay")
        self.browser.run("document.querySelector('.picture a[href=\"#point-label\"]')"
                         ".dispatchEvent(new MouseEvent('click', {bubbles: true, cancelable: true}))")
        self.browser.await_true("const box = document.getElementById('point-label').getBoundingClientRect();"
                                "return 0 <= box.top && box.top < box.bottom && box.bottom <= innerHeight")
        self.assertIn("label", self.browser.shown())
        self.assertTrue(self.browser.run("return document.getElementById('point-label').matches(':target')"))

    def test_has_a_link_in_the_picture_for_every_point_and_all_four_spaces(self):
        self.open("press")
        broken = self.browser.run("""return Array.from(document.querySelectorAll(".picture a"))
            .filter(a => !document.getElementById(a.getAttribute("href").slice(1))).length""")
        self.assertEqual(broken, 0)
        self.assertEqual(self.browser.run("return document.querySelectorAll('.picture a').length"), 14)
        self.assertEqual(self.browser.run("return document.querySelectorAll('.coupler-plan text.table').length"), 4)

    def test_is_used_by_keyboard(self):
        self.open("example")
        body = self.element("body")
        body.send_keys(Keys.TAB)
        self.assertEqual(self.browser.driver.switch_to.active_element.get_attribute("class"), "skip")
        body.send_keys("/")
        active = self.browser.driver.switch_to.active_element
        self.assertEqual(active.get_attribute("id"), "query")
        active.send_keys("horn")
        self.assertEqual(self.browser.shown(), ["horn"])
        active.send_keys(Keys.ESCAPE)
        self.assertEqual(len(self.browser.shown()), 16)
        active.send_keys(Keys.TAB, Keys.TAB, Keys.ENTER)
        self.assertEqual(self.browser.shown()[0], "armed", "the first header sorted by name")

    def test_keeps_search_and_header_in_sight(self):
        self.open("press", size=(1440, 500))
        self.browser.run("window.scrollTo(0, 500)")
        bar, header = self.browser.run("""return [document.getElementById("search"), document.querySelector("th")]
            .map(element => element.getBoundingClientRect().top)""")
        self.assertEqual(bar, 0)
        self.assertTrue(0 < header < 100, header)
        self.screenshot("press-scrolled")

    def test_fits_the_width_of_a_screen(self):
        for width in (1600, 1440, 1280, 1124, 1000, 768):
            for name in ("example", "press", "manners"):
                with self.subTest(f"{name} at {width}"):
                    self.open(name, size=(width, 900))
                    self.assertEqual(self.browser.run("return document.documentElement.scrollWidth"), width)

    def test_fits_a_phone(self):
        for name in ("example", "press"):
            self.open(name, size=PHONE)
            self.assertEqual(self.browser.run("return document.documentElement.scrollWidth"), PHONE[0])
            self.assertEqual(self.search("40002"), ["ratio" if name == "example" else "speed_set"])
            self.open(name, size=PHONE)
            self.screenshot(f"{name}-phone")

    def test_has_a_dark_side(self):
        self.open("example", dark=True)
        ground = self.browser.run("return getComputedStyle(document.body).backgroundColor")
        self.assertLess(sum(int(part) for part in ground[4:-1].split(",")), 150, ground)
        self.screenshot("example-dark")
        self.browser.run("document.getElementById('spaces').scrollIntoView()")
        self.screenshot("example-dark-below")

    def test_prints_every_point_and_no_controls(self):
        self.open("example")
        self.browser.command("Emulation.setEmulatedMedia", media="print")
        self.assertEqual(len(self.browser.shown()), 16)
        self.assertFalse(self.element("#search").is_displayed())
        self.assertFalse(self.element("nav").is_displayed())

    def test_is_complete_without_scripts(self):
        self.open("example", scripts=False)
        self.browser.command("Emulation.setScriptExecutionDisabled", value=False)  # to ask what is shown
        self.assertEqual(len(self.browser.shown()), 16)
        self.assertFalse(self.element("#search").is_displayed())

    def test_takes_the_texts_of_a_map_as_texts(self):
        (self.folder / "hostile.yaml").write_text(HOSTILE, "utf-8")
        self.document(self.folder / "hostile.yaml")
        self.open("cell")
        self.assertEqual((self.browser.complaints(), self.browser.driver.title), ([], "cell: register map"))
        self.assertEqual(self.element("#point-lamp .name small").text,
                         "</title></td><script>document.title = 'broken'</script>|`x`")
        self.assertEqual(self.element("#point-speed .units").text, "it's < 5 & > 3")
        self.assertEqual(self.browser.run("return document.images.length"), 0)

    def test_of_ten_thousand_points_opens_and_searches(self):
        (self.folder / "plant.yaml").write_text(big_map(), "utf-8")
        start = time.monotonic()
        self.document(self.folder / "plant.yaml")
        made = time.monotonic() - start
        page = self.folder / "plant.html"
        start = time.monotonic()
        self.open("plant", size=DESKTOP)  # the browser's patience tells hanging from working; how long it takes is printed
        opened = time.monotonic() - start
        # From the event to the frame after it.
        searching = """const [text, done] = arguments; const query = document.getElementById("query");
            const start = performance.now(); query.value = text;
            query.dispatchEvent(new Event("input", {bubbles: true}));
            requestAnimationFrame(() => setTimeout(() => done(performance.now() - start)))"""
        times = {text: self.browser.driver.execute_async_script(searching, text)
                 for text in ("hold_1234", "rpm", "41001", "")}
        self.browser.driver.execute_async_script(searching, "hold_1234")
        self.assertEqual(self.browser.shown(), ["hold_1234"])
        print(f"\n{BIG} points: made in {made:.2f} s, {page.stat().st_size / 1e6:.1f} MB, opened in {opened:.2f} s, "
              + ", ".join(f"search {text!r} {ms:.0f} ms" for text, ms in times.items()))
        self.search("")
        self.assertTrue(self.element("#more").is_displayed())
        self.element("#more").click()
        self.assertEqual(len(self.browser.shown()), BIG)


if __name__ == "__main__":
    unittest.main()
