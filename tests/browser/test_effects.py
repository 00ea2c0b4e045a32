"""The page of `plateau sweep effects` in headless Chromium: there without scripts, filtered with mouse and keyboard."""

import os
import pathlib
import subprocess
import tempfile
import unittest

from browser import Browser

PROGRAM = os.environ["PLATEAU_PROGRAM"]
QUICK = pathlib.Path(__file__).parents[2] / "data/scenes/quick.toml"
NAME = "</script><script>alert(1)</script><b>load"
STUDY = f"""version = 1
title = {NAME!r}
base = "{QUICK}"
set = ["operation.duration = '2 s'", "output.sample_every = '1 s'", "plateaus.captured_fraction = 0.06"]
design = "full-factorial"
directory = "results"

[replicates]
keys = ["disc.surface.synthetic.seed"]
seeds = [1, 2]

[[factor]]
name = {NAME!r}
key = "operation.normal_force"
levels = ["5 N", "10 N", "20 N"]

[[factor]]
name = "debris"
key = "plateaus.debris"
levels = ["local", "contact"]

[[factor]]
name = "fibre fraction"
key = "pin.base.synthetic.fibre_fraction"
range = [0.2, 0.4]

[[response]]
name = "contact area"
dataset = "/series/contact_area_mean"
at = "end"

[[response]]
name = "nothing"
dataset = "/series/worn_disc"
at = "end"
"""
RUNS = 24

SHOWN = "Number(document.getElementById('parallel').dataset.shown)"
OUT = "document.querySelectorAll('#parallel .lines path.out').length"
AXIS = "#parallel .axis[data-axis=\"{}\"] .hit"


class EffectsPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        folder = pathlib.Path(cls.folder.name)
        (folder / "study.toml").write_text(STUDY)
        for command in ("run", "effects"):
            subprocess.run([PROGRAM, "sweep", command, "study.toml"], cwd=folder, check=True, capture_output=True)
        cls.page = folder / "results/effects/effects.html"
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.__exit__)

    def open(self, **how):
        self.browser.console()
        self.browser.open(self.page, **how)

    def tearDown(self):
        self.assertEqual(self.browser.console(), [], "the console is not empty")
        self.assertTrue(self.browser.run("document.getElementById('problem').hidden"))

    def test_light_dark_and_phone(self):
        for how in ({}, {"dark": True}, {"width": 360, "height": 740, "phone": True}):
            with self.subTest(**how):
                self.open(**how)
                wide, there = self.browser.run("[document.documentElement.scrollWidth, innerWidth]")
                self.assertLessEqual(wide, there)
                back = self.browser.run("getComputedStyle(document.body).backgroundColor")
                self.assertEqual(back == "rgb(255, 255, 255)", not how.get("dark"))
                heights = self.browser.run("[...document.querySelectorAll('figure svg')].map((svg) => svg.clientHeight)")
                self.assertGreaterEqual(len(heights), 3)
                self.assertGreater(min(heights), 50)
                self.assertEqual(self.browser.run(SHOWN), RUNS)

    def test_names_are_text(self):
        self.open()
        self.assertEqual(self.browser.run("document.querySelector('h1').textContent"), NAME)
        self.assertIn(NAME, self.browser.run("document.querySelector('#response-1 table').textContent"))
        self.assertEqual(self.browser.run("document.querySelectorAll('b').length"), 0)
        self.assertEqual(self.browser.run("document.querySelectorAll('script').length"), 2)

    def test_a_response_without_effects_says_why(self):
        self.open()
        text = self.browser.run("document.getElementById('response-2').textContent")
        self.assertIn("no factor has an effect on it", text)
        self.assertEqual(self.browser.run("document.querySelectorAll('#response-2 svg').length"), 0)

    def test_dragging_filters_and_a_button_shows_all_again(self):
        self.open()
        self.browser.drag_down(AXIS.format(0), 0.01, 0.3)  # 20 N alone
        self.assertEqual(self.browser.run(SHOWN), RUNS / 3)
        self.assertEqual(self.browser.run(OUT), RUNS - RUNS / 3)
        self.browser.drag_down(AXIS.format(1), 0.8, 0.9)  # between the levels
        self.assertEqual(self.browser.run(SHOWN), 0)
        self.browser.drag_down(AXIS.format(1), 0.7, 0.99)  # and the lower of two
        self.assertEqual(self.browser.run(SHOWN), RUNS / 6)
        self.browser.run("document.getElementById('parallel-reset').focus()")
        self.browser.press(" ")
        self.assertEqual(self.browser.run(SHOWN), RUNS)
        self.assertEqual(self.browser.run(OUT), 0)

    def test_keys_filter_too(self):
        self.open()
        self.browser.run("document.querySelector('#parallel .axis').focus()")
        self.browser.press("down")  # the upper quarter
        self.assertEqual(self.browser.run(SHOWN), RUNS / 3)
        self.browser.press("escape")
        self.assertEqual(self.browser.run(SHOWN), RUNS)

    def test_colours_can_be_chosen_and_lines_be_read(self):
        self.open()
        classes = "[...document.querySelectorAll('#parallel .lines path')].map((path) => path.getAttribute('class'))"
        before = self.browser.run(classes)
        self.assertGreater(len(set(before)), 3)
        self.browser.run("(() => { const s = document.querySelector('#parallel-controls select'); s.value = 1;"
                         " s.dispatchEvent(new Event('change')); })()")
        self.assertEqual(set(self.browser.run(classes)), {"c0", "c15"})
        self.browser.hover("#parallel")
        place = self.browser.run(
            "(() => { const svg = document.getElementById('parallel').getBoundingClientRect();"
            " const path = document.querySelector('#parallel .lines path'); const at = path.getPointAtLength(20);"
            " return [svg.left + at.x, svg.top + at.y]; })()")
        self.browser.move(*place)
        reading = self.browser.run("document.getElementById('parallel-reading').textContent")
        self.assertRegex(reading, r"^Run \d+: .*load 5 N, debris (local|contact), fibre fraction 0\.[24], contact area [\d.]+ mm²")


if __name__ == "__main__":
    unittest.main()
