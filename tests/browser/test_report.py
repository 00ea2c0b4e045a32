"""The page of `plateau report` in a browser: light and dark, as wide as a phone, and printed."""

import os
import pathlib
import re
import subprocess
import tempfile
import unittest

from browser import Browser

PROGRAM = os.environ["PLATEAU_PROGRAM"]
SCENES = pathlib.Path(__file__).resolve().parents[2] / "data/scenes"
# A4 within its margins, in pixels of CSS; lines of a cell that is not broken letter by letter.
PAPER, LINES = (680, 1009), 6
# What is wider than its place, and not in a part that scrolls.
TOO_WIDE = """[...document.querySelectorAll("table, figure, pre, p")].filter((one) => !(arguments[0] && one.closest(".wide"))
    && one.getBoundingClientRect().right > document.documentElement.clientWidth + 1).map((one) => one.outerHTML.slice(0, 200))"""
BROKEN = """[...document.querySelectorAll("table.numbers tr")].filter((row) => row.getBoundingClientRect().height
    > arguments[0] * parseFloat(getComputedStyle(row.cells[0]).lineHeight) + 8).map((row) => row.textContent.slice(0, 200))"""


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        for scene in ("quick", "stops"):
            cls.call("run", SCENES / f"{scene}.toml", "-o", f"{scene}.h5")
            cls.call("report", f"{scene}.h5")
        cls.call("report", "quick.h5", "stops.h5", "-o", "two.html")
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.__exit__)

    @classmethod
    def call(cls, *arguments):
        subprocess.run([PROGRAM, *arguments], check=True, capture_output=True, timeout=300, cwd=cls.folder)

    def test_nothing_is_wider_than_the_window(self):
        for name in ("quick", "stops", "two"):
            for width in (360, 1200):
                with self.subTest(name, width=width):
                    self.browser.open(self.folder / f"{name}.html", width)
                    self.assertEqual(self.browser.run(TOO_WIDE, True), [])
                    self.assertEqual(self.browser.console(), [])

    def test_the_colours_of_the_system(self):
        colours = "[getComputedStyle(document.body).color, getComputedStyle(document.body).backgroundColor]"
        found = []
        for dark in (False, True):
            self.browser.open(self.folder / "quick.html", dark=dark)
            found.append([int(re.search(r"\d+", colour)[0]) for colour in self.browser.run(colours)])
        (text, ground), (text_in_dark, ground_in_dark) = found
        self.assertLess(text + 150, ground)
        self.assertGreater(text_in_dark, ground_in_dark + 150)

    def test_print(self):
        for name, most in (("quick", 10), ("stops", 11), ("two", 14)):
            with self.subTest(name):
                self.browser.open(self.folder / f"{name}.html", PAPER[0], "print", dark=True)
                self.assertEqual(self.browser.run(TOO_WIDE, False), [])
                self.assertEqual(self.browser.run(BROKEN, LINES), [])
                self.assertLess(self.browser.run("document.querySelector('.first').getBoundingClientRect().bottom"), PAPER[1])
                self.assertLessEqual(len(re.findall(rb"/Type\s*/Page\b", self.browser.pdf())), most)


if __name__ == "__main__":
    unittest.main()
