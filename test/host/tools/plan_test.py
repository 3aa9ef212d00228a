# SPDX-License-Identifier: Apache-2.0
"""`coupler plan` as a script sees it. COUPLER is the program, SOURCE_DIR the repository."""
import json
import os
import pathlib
import unittest
import xml.etree.ElementTree as ElementTree

from cli_test import BAD, Cli

SPREAD = """\
name: cell
rate: 100
mapping:
  coils: {lamp: 0, horn: 5}
  holding_registers:
    level: {address: 0, type: REAL}
    speed: {address: 9, type: INT}
"""


class Plan(Cli):
    def plan(self, *arguments, text=SPREAD):
        return self.coupler("plan", self.file("cell.yaml", text), *arguments)

    def json(self, *arguments, **keywords):
        return json.loads(self.plan("--json", *arguments, **keywords).stdout)

    def test_shows_every_request_and_why_it_ends(self):
        done = self.plan()
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("cell.yaml: cell, 4 points in 4 requests, round trip 1 ms\n", done.stdout)
        self.assertRegex(done.stdout, r"coils +0 to 0 +00001-00001 +1 +4 unmapped addresses before horn")
        self.assertRegex(done.stdout, r"holding_registers +9 to 9 +40010-40010 +1 +nothing more to read")

    def test_tells_which_keys_make_the_requests_fewer(self):
        self.assertRegex(self.plan().stdout,
                         r"read where quicker +2 requests .*discrete_read_continuous: true.*registers_read_separation_gap: 8")

    def test_is_told_the_round_trip(self):
        self.assertIn("4 requests, 3 registers and 2 bits, 92 bytes; 2.001 ms of 10 ms (20 %)", self.plan("--rtt", "0.5").stdout)

    def test_warns_when_the_reads_do_not_fit_into_their_time(self):
        done = self.plan("--rtt", "5")
        self.assertEqual(done.returncode, 0)
        self.assertIn("cell.yaml: warning: the reads need 200 % of the time", done.stderr)
        self.assertIn("cell.yaml: warning: the reads need 2000 % of the time", self.plan("--rtt", "50").stderr)

    def test_in_json_has_every_request(self):
        plan = self.json()
        self.assertEqual((plan["name"], plan["fits"], plan["not_read"]), ("cell", True, []))
        group, = plan["groups"]
        self.assertEqual((group["rate_hz"], group["requests"], group["registers"], group["bits"]), (100, 4, 3, 2))
        first = group["spans"][0]
        self.assertEqual({key: first[key] for key in ("table", "from", "to", "modicon", "points", "holes")},
                         {"table": "coils", "from": 0, "to": 0, "modicon": "00001", "points": ["lamp"], "holes": []})
        self.assertEqual({key: first["end"][key] for key in ("reason", "next", "between", "key")},
                         {"reason": "unmapped", "next": "horn", "between": 4, "key": "discrete_read_continuous"})
        self.assertEqual([s["name"] for s in plan["strategies"]], ["never", "map", "pays"])
        self.assertEqual([s["requests"] for s in plan["strategies"]], [4, 4, 2])

    def test_names_the_holes_that_it_reads(self):
        plan = self.json(text="registers_read_continuous: true\n" + SPREAD)
        self.assertEqual(plan["groups"][0]["spans"][2]["holes"], [{"from": 2, "to": 8}])

    def test_has_a_group_for_each_rate_the_fastest_first(self):
        groups = self.json(text=SPREAD.replace("INT}", "INT, rate: 200}"))["groups"]
        self.assertEqual([group["rate_hz"] for group in groups], [200, 100])
        self.assertEqual([span["points"] for span in groups[0]["spans"]], [["speed"]])

    def test_lists_what_is_not_read(self):
        text = SPREAD.replace("INT}", "INT, access: write}")
        self.assertEqual(self.json(text=text)["not_read"], [{"point": "speed", "reason": "write_only"}])
        self.assertIn("Not read, write-only: speed\n", self.plan(text=text).stdout)

    def test_shows_the_tools(self):
        text = SPREAD.replace("mapping:", "tools: {lift: {close: lamp, open: horn, travel: 300ms, hold: false}}\nmapping:")
        self.assertIn("\nTools:\n"
                      "  tool  closes by  opens by  closed        open          stuck      outputs\n"
                      "  lift  lamp on    horn on   after 300 ms  after 300 ms  after 2 s  off at the end\n", self.plan(text=text).stdout)
        self.assertEqual(self.json(text=text)["tools"], [{
            "name": "lift", "close": "lamp", "open": "horn", "closed": None, "opened": None, "holds": None, "travel_ms": 300,
            "timeout_ms": 2000, "settle_ms": 0, "hold": False, "empty": "abort", "direct": False,
            "joint": "cell/lift", "positions": {"open": 1, "closed": 0}, "on_cancel": "stay"}])
        joint = text.replace("hold: false", "joint: z, positions: {open: 0.4}, on_cancel: open")
        self.assertIn("\n  lift  lamp on    horn on   after 300 ms  after 300 ms  after 2 s  opens      z: open 0.4, closed 0\n",
                      self.plan(text=joint).stdout)
        self.assertEqual(self.json(text=joint)["tools"][0]["joint"], "z")
        self.assertNotIn("Tools", self.plan().stdout)
        self.assertEqual(self.json()["tools"], [])

    def test_shows_the_axes(self):
        text = SPREAD.replace("mapping:", "axes: {glue: {point: lamp, joint: z, positions: {off: 0, on: -0.5}}, belt: {point: horn}}\nmapping:")
        self.assertIn("\nAxes:\n"
                      "  axis  point  joint      positions\n"
                      "  glue  lamp   z          on at -0.5, off at 0\n"
                      "  belt  horn   cell/belt  off at 0, on at 1\n", self.plan(text=text).stdout)
        self.assertEqual(self.json(text=text)["axes"][0], {
            "name": "glue", "point": "lamp", "joint": "z",
            "positions": [{"value": 1, "position": -0.5}, {"value": 0, "position": 0}]})
        self.assertNotIn("Axes", self.plan().stdout)
        self.assertEqual(self.json()["axes"], [])

    def test_does_not_cross_what_is_unreadable(self):
        text = SPREAD.replace("mapping:", "registers_read_continuous: true\n"
                              "unreadable: [{table: holding_registers, from: 4, to: 5}]\nmapping:")
        spans = self.json(text=text)["groups"][0]["spans"]
        self.assertEqual([(span["from"], span["to"], span["end"]["reason"]) for span in spans[2:]],
                         [(0, 1, "unreadable"), (9, 9, "end_of_table")])

    def test_draws_a_picture_that_is_well_formed(self):
        self.assertEqual(self.plan("--svg", "cell.svg").returncode, 0)
        root = ElementTree.parse(self.folder / "cell.svg").getroot()
        self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")
        titles = [title.text for title in root.iter("{http://www.w3.org/2000/svg}title")]
        self.assertIn("level: REAL, 0 to 1, 100 Hz", titles)

    def test_draws_the_picture_that_the_documentation_shows(self):
        source = pathlib.Path(os.environ["SOURCE_DIR"])
        drawn = self.coupler("plan", str(source / "config/foreign-coupler.yaml"), "--svg", "plan.svg")
        self.assertEqual(drawn.returncode, 0, drawn.stderr)
        self.assertEqual((self.folder / "plan.svg").read_text("utf-8"), (source / "docs/plan.svg").read_text("utf-8"),
                         "coupler plan config/foreign-coupler.yaml --svg docs/plan.svg makes it anew")

    def test_of_a_picture_that_cannot_be_written_says_so(self):
        done = self.plan("--svg", "no/such/folder.svg")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("cannot write no/such/folder.svg: No such file or directory; give a file that you may write with --svg",
                      done.stderr)

    def test_draws_no_picture_over_its_map(self):
        for name in ("cell.yaml", "./cell.yaml"):
            done = self.plan("--svg", name)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn(f"{name} is the map itself; name another file with --svg", done.stderr)
            self.assertEqual((self.folder / "cell.yaml").read_text("utf-8"), SPREAD)

    def test_replaces_a_picture_in_one_step(self):
        (self.folder / "old.svg").write_text("old", "utf-8")
        (self.folder / "kept.svg").hardlink_to(self.folder / "old.svg")
        self.assertEqual(self.plan("--svg", "old.svg").returncode, 0)
        self.assertEqual((self.folder / "kept.svg").read_text("utf-8"), "old")
        self.assertTrue((self.folder / "old.svg").read_text("utf-8").startswith("<svg"))

    def test_of_a_bad_map_says_what_is_wrong(self):
        done = self.plan(text=BAD)
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("cell.yaml:6:", done.stderr)

    def test_wants_a_round_trip_above_0(self):
        self.assertEqual(self.plan("--rtt", "0").returncode, 2)
        self.assertEqual(self.plan("--rtt", "soon").returncode, 2)

    def test_of_every_map_of_the_project_is_made(self):
        maps = sorted(pathlib.Path(os.environ["SOURCE_DIR"], "config").glob("*.yaml"))
        self.assertGreater(len(maps), 1)
        for path in maps:
            with self.subTest(path.name):
                done = self.coupler("plan", str(path), "--json")
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertTrue(json.loads(done.stdout)["groups"])


if __name__ == "__main__":
    unittest.main()
