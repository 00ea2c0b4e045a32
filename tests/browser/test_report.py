"""The page of `plateau report` in headless Chromium: drawn, without errors, and it responds to mouse and keyboard."""

import os
import pathlib
import subprocess
import tempfile
import unittest

from browser import Browser

PROGRAM = os.environ["PLATEAU_PROGRAM"]
QUICK = pathlib.Path(__file__).parents[2] / "data/scenes/quick.toml"
TITLE = "</script><script>alert(1)</script><b>µ"

# Whether anything is drawn on the first canvas of a selector: not all of its pixels are alike.
DRAWN = """(() => { const c = document.querySelector(arguments[0]);
    const p = new Uint32Array(c.getContext('2d').getImageData(0, 0, c.width, c.height).data.buffer);
    return p.some((pixel) => pixel !== p[0]); })()"""
# What is drawn there, as text.
PICTURE = "document.querySelector(arguments[0]).toDataURL()"
# The colour of the upper left corner of the figure that is shown first.
CORNER = """(() => { const image = [...document.querySelectorAll('#figure-list img')].find((image) => image.clientHeight > 0);
    const c = Object.assign(document.createElement('canvas'), { width: 20, height: 20 }).getContext('2d');
    c.drawImage(image, 0, 0);
    return `rgb(${[...c.getImageData(3, 3, 1, 1).data.slice(0, 3)].join(', ')})`; })()"""
TEXT = "document.querySelector(arguments[0]).textContent"
READING = "#map-views .reading"
MAP = "#map-views canvas"
CHART = "#charts .plot"
SLIDER = "#map-controls input[type=range]"


def choose(browser, value, selector="#map-controls select"):
    """Chooses from a list as a user does."""
    browser.run("(() => { const s = document.querySelector(arguments[1]); s.value = arguments[0];"
                " s.dispatchEvent(new Event('change')); })()", value, selector)


class ReportPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        folder = pathlib.Path(cls.folder.name)
        maps = 'output.maps_at=["0 s", "2 s", "4 s"]'
        for file, sets in [("one.h5", []), ("two.h5", ["operation.normal_force=10 N", f'title="{TITLE}"'])]:
            sets = [f"--set={change}" for change in ["operation.duration=6 s", maps, *sets]]
            subprocess.run([PROGRAM, "run", QUICK, "-o", file, *sets], cwd=folder, check=True, capture_output=True)
        for page, files in [("two.html", ["one.h5", "two.h5"]), ("one.html", ["one.h5"])]:
            subprocess.run([PROGRAM, "report", *files, "-o", page], cwd=folder, check=True, capture_output=True)
        cls.one, cls.two = folder / "one.html", folder / "two.html"
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.__exit__)

    def open(self, page, **how):
        self.browser.console()
        self.browser.open(page, **how)

    def tearDown(self):
        self.assertEqual(self.browser.console(), [], "the console is not empty")
        self.assertTrue(self.browser.run("document.getElementById('problem').hidden"))

    def assert_drawn(self):
        charts = self.browser.run("document.querySelectorAll('.plot').length")
        self.assertEqual(charts, 4)
        figures = self.browser.run("[...document.querySelectorAll('#figure-list img')].map((image) => image.clientHeight).filter((height) => height > 0)")
        self.assertEqual(len(figures), self.browser.run("report.pictures.length"))
        self.assertGreater(min(figures), 50)
        for canvas in [*(f"#charts .panel:nth-child({at}) canvas" for at in (1, 2, 3)), "#residual-chart canvas", MAP]:
            self.assertTrue(self.browser.run(DRAWN, canvas), f"{canvas} is blank")

    def assert_no_sideways_scroll(self):
        wide, there = self.browser.run("[document.documentElement.scrollWidth, innerWidth]")
        self.assertLessEqual(wide, there)

    def test_light_dark_and_phone(self):
        for page in (self.one, self.two):
            for how in ({}, {"dark": True}, {"width": 360, "height": 740, "phone": True}):
                with self.subTest(page=page.name, **how):
                    self.open(page, **how)
                    # A phone shows the charts that respond to touch, and figures when they are asked for.
                    self.assertEqual(self.browser.run("document.querySelector('#figure-fold').open"), not how.get("phone"))
                    if how.get("phone"):
                        self.browser.run("document.querySelector('#figure-fold summary').click()")
                    self.assert_drawn()
                    self.assert_no_sideways_scroll()
                    back = self.browser.run("getComputedStyle(document.body).backgroundColor")
                    self.assertEqual(back == "rgb(255, 255, 255)", not how.get("dark"))
                    # The corner of a figure has the colour of the page.
                    self.assertEqual(self.browser.run(CORNER), back)
                    for name in ["pin_height", "pin_status", "pressure", "disc_status"]:
                        choose(self.browser, name)
                        body = "Disc" if name.startswith("disc") else "Pin"
                        self.browser.wait(f"document.querySelector('{MAP}').getAttribute('aria-label').startsWith('{body}')")
                        self.browser.wait(f"({DRAWN.replace('arguments[0]', repr(MAP))})")
                        self.assert_no_sideways_scroll()

    def test_titles_are_text(self):
        self.open(self.two)
        self.assertIn(TITLE, self.browser.run("document.querySelector('#summary th:nth-child(3)').textContent"))
        self.assertIn(TITLE, self.browser.run("document.querySelector('#runs-shown').textContent"))
        self.assertEqual(self.browser.run("document.querySelectorAll('b').length"), 0)

    def test_the_slider_steps_through_the_maps(self):
        self.open(self.one)
        stops = int(self.browser.run("document.querySelector(arguments[0]).max", SLIDER))
        self.assertEqual(stops, 3, "0 s, 2 s, 4 s and the end")
        self.browser.run("document.querySelector(arguments[0]).focus()", SLIDER)
        seen = [(self.browser.run(TEXT, "#map-controls output"), self.browser.run(PICTURE, MAP))]
        for _ in range(stops):
            self.browser.press("left")
            seen.append((self.browser.run(TEXT, "#map-controls output"), self.browser.run(PICTURE, MAP)))
        self.assertEqual(len(set(seen)), 4)
        self.assertEqual(len({picture for _, picture in seen}), 4)
        # A map belongs to the first step that ends then or later.
        for (time, _), expected in zip(seen, [6, 4, 2, 0]):
            self.assertAlmostEqual(float(time.removesuffix(" s")), expected, delta=0.003)

    def test_pointing_at_a_map_reads_it(self):
        self.open(self.one)
        choose(self.browser, "pressure")
        self.browser.wait("document.querySelector('#map-views h3').textContent.includes('pressure')")
        self.browser.hover(MAP, 0.5, 0.3)
        first = self.browser.run(TEXT, READING)
        self.assertRegex(first, r"^[\d.]+ MPa at 6\.00\d* s, arc length [\d.]+ mm, radius 20\.\d+ mm, column \d+, row \d+$")
        self.browser.run("document.querySelector(arguments[0]).focus()", MAP)
        self.browser.press("right", "up")
        second = self.browser.run(TEXT, READING)
        place = [int(word) for word in first.replace(",", "").split() if word.isdigit()][-2:]
        self.assertTrue(second.endswith(f"column {place[0] + 1}, row {place[1] + 1}"), f"{first} -> {second}")

    def test_a_chart_reads_zooms_and_follows_keys(self):
        self.open(self.two)
        at = "#charts .values th"
        end = self.browser.run(TEXT, at)
        self.assertRegex(end, r"^at 6\.00\d* s$")
        self.browser.hover(CHART, 0.5)
        hovered = self.browser.run(TEXT, at)
        self.assertNotEqual(hovered, end)
        self.browser.run("document.querySelector(arguments[0]).focus()", CHART)
        self.browser.press("right", "right")
        self.assertNotEqual(self.browser.run(TEXT, at), hovered)
        shown = "(() => { const { min, max } = Chart.all[0].uplot.scales.x; return max - min; })()"
        whole = self.browser.run(shown)
        self.browser.press("+")
        self.assertAlmostEqual(self.browser.run(shown), whole / 2, delta=0.02 * whole)
        self.browser.press("0")
        self.assertAlmostEqual(self.browser.run(shown), whole)
        self.browser.drag(CHART + " .u-over", 0.25, 0.5)
        self.browser.wait(f"{shown} < {0.3 * whole}")
        self.assertAlmostEqual(self.browser.run(shown), 0.25 * whole, delta=0.03 * whole)

    def test_values_of_the_legend_are_those_of_the_run(self):
        self.open(self.one)
        area = self.browser.run("document.querySelector('#charts .values tbody tr:nth-child(1) td').textContent")
        rows = "[...document.querySelectorAll('#summary tbody tr')]"
        summary = self.browser.run(f"{rows}.find((row) => row.textContent.includes('of the last step')).cells[1].textContent")
        self.assertEqual(area.split()[1], summary.split()[1])
        self.assertAlmostEqual(float(area.split()[0]), float(summary.split()[0]), delta=6e-4 * float(summary.split()[0]))

    def test_runs_and_quantities_are_chosen(self):
        self.open(self.two)
        lines = f"Number(document.querySelector('{CHART}').dataset.lines)"
        self.assertEqual(self.browser.run(lines), 4)
        self.browser.run("document.querySelector('#runs-shown input').click()")
        self.browser.wait(f"{lines} === 2")
        options = self.browser.run("[...document.querySelector('#charts select').options].map((option) => option.text)")
        self.assertIn("displacement of the rigid pin", options)
        choose(self.browser, options.index("displacement of the rigid pin"), "#charts select")
        self.browser.wait(f"{lines} === 1")

    def test_every_control_can_be_reached_with_the_keyboard(self):
        self.open(self.two)
        controls = ("[...document.querySelectorAll('main select, main input:not([type=checkbox]), main summary,"
                    " main canvas[tabindex], main .plot')]")
        reached = set()
        for _ in range(120):
            self.browser.press("tab")
            reached.add(self.browser.run(f"{controls}.indexOf(document.activeElement)"))
        wanted = self.browser.run(f"{controls}.length")
        self.assertGreater(wanted, 8)
        self.assertEqual(len(reached - {-1}), wanted)


if __name__ == "__main__":
    unittest.main()
