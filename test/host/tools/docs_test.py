# SPDX-License-Identifier: Apache-2.0
"""`coupler generate --docs` as a script sees it. COUPLER is the program."""
import html.parser
import unittest

from cli_test import BAD, GOOD, Cli

HOSTILE = """\
name: cell
mapping:
  coils:
    lamp: {address: 0, description: "<script>alert(1)</script> | `x`"}
"""


class Links(html.parser.HTMLParser):
    """The targets of all links of a page, and the names of its elements."""

    def __init__(self, text):
        super().__init__()
        self.targets, self.elements = [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.elements.append(tag)
        if tag == "a":
            self.targets.append(dict(attributes)["href"])


class Docs(Cli):
    def docs(self, *arguments, text=GOOD):
        return self.coupler("generate", self.file("cell.yaml", text), "--docs", *arguments)

    def text(self, path):
        return (self.folder / path).read_text("utf-8")

    def test_makes_a_page_and_a_markdown_file_here_if_no_folder_is_given(self):
        done = self.docs()
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(done.stdout, "cell.html: written\ncell.md: written\n")
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["cell.html", "cell.md", "cell.yaml"])

    def test_does_not_touch_what_would_not_change(self):
        self.docs("--out", "out")
        before = (self.folder / "out/cell.html").stat().st_mtime_ns
        done = self.docs("--out", "out")
        self.assertEqual(done.stdout, "out/cell.html: unchanged\nout/cell.md: unchanged\n")
        self.assertEqual((self.folder / "out/cell.html").stat().st_mtime_ns, before)

    def test_replaces_no_file_that_somebody_wrote(self):
        readme = self.file("README.md", "my own\n")
        text = "name: README\nmapping: {coils: {a: 0}}\n"
        done = self.docs(text=text)
        self.assertEqual(done.returncode, 2)
        self.assertIn("README.md was not made by coupler; name another folder with --out, or replace it with --force", done.stderr)
        self.assertEqual(self.text(readme), "my own\n")
        self.assertEqual(self.docs("--force", text=text).returncode, 0)
        self.assertIn("by coupler", self.text(readme))
        self.assertEqual(self.docs(text=text + "address: localhost\n").returncode, 0, "its own it replaces")

    def test_links_each_point_to_its_line_from_where_the_page_is(self):
        self.docs()
        self.assertIn("cell.yaml#L6", Links(self.text("cell.html")).targets)
        self.assertIn("(<cell.yaml#L6>)", self.text("cell.md"))
        self.docs("--out", "made/here")
        self.assertIn("../../cell.yaml#L6", Links(self.text("made/here/cell.html")).targets)

    def test_links_to_a_forge(self):
        self.docs("--source-url", "https://forge/cell/blob/main")
        self.assertIn("https://forge/cell/blob/main/cell.yaml#L6", Links(self.text("cell.html")).targets)

    def test_refuses_what_is_no_url(self):
        done = self.docs("--source-url", "a b")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("'a b' cannot be part of a URL; ", done.stderr)

    def test_of_standard_input_has_no_links_to_it(self):
        done = self.coupler("generate", "-", "--docs", stdin=GOOD)
        self.assertEqual(done.returncode, 0, done.stderr)
        targets = Links(self.text("cell.html")).targets
        self.assertTrue(all(target.startswith("#") for target in targets), targets)

    def test_takes_the_texts_of_a_map_as_texts(self):
        self.docs(text=HOSTILE)
        self.assertEqual(Links(self.text("cell.html")).elements.count("script"), 2, "the page's own")
        self.assertIn("| &lt;script&gt;alert(1)&lt;/script&gt; \\| \\`x\\` |", self.text("cell.md"))

    def test_may_have_a_map_whose_name_has_parts(self):
        self.assertIn("hall_cell.md", self.docs(text=GOOD.replace("cell", "hall/cell")).stdout)

    def test_of_a_bad_map_writes_nothing(self):
        done = self.docs(text=BAD)
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertEqual([p.name for p in self.folder.iterdir()], ["cell.yaml"])

    def test_is_what_a_source_url_is_for(self):
        done = self.coupler("generate", self.file("cell.yaml", GOOD), "--out", "out", "--source-url", "https://x")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--docs", done.stderr)


if __name__ == "__main__":
    unittest.main()
