"""The page of `plateau.report`: its numbers against the run file, what strangers write, several runs, and the words of runs."""

import html
import os
import pathlib
import re
import shutil
import tempfile
import unittest
import unittest.mock
import xml.etree.ElementTree as xml

import h5py
import numpy as np
from checkout import QUICK, Folder, word
from package_scenes import PULSES, SHORT

import plateau
from plateau import figures, run_report
from plateau.quantities import CELSIUS, MM2, NUMBER, PERCENT
from plateau.run_report import Measure, report_page

HOSTILE = '<script>alert(1)</script> "$x & \u202eback'


def rows(page, heading=""):
    """Rows of all tables below a heading, as lists of texts."""
    below = page[page.index(heading) :]
    found = re.findall(r"<tr>(.*?)</tr>", below, re.DOTALL)
    return [[html.unescape(cell) for cell in re.findall(r"<t[hd]>(.*?)</t[hd]>", row, re.DOTALL)] for row in found]


class Report(Folder):
    @classmethod
    def setUpClass(cls):
        cls.made = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        plateau.run(QUICK, cls.made / "quick.h5", set=SHORT | PULSES)
        plateau.run(QUICK, cls.made / "heavy.h5", set={**SHORT, **PULSES, "operation.normal_force": "10 N"}).close()
        with h5py.File(cls.made / "heavy.h5", "r+") as file:
            file.attrs["title"] = HOSTILE
        plateau.run(QUICK.with_name("stops.toml"), cls.made / "stops.h5")

    def draw_few(self):
        # Figures have tests of their own.
        few = {name: figures.FIGURES[name] for name in ("contact-area", "filled", "friction")}
        self.enterContext(unittest.mock.patch.dict(figures.FIGURES, few, clear=True))

    def page(self, *names):
        self.draw_few()
        return pathlib.Path(plateau.report([self.made / f"{name}.h5" for name in names])).read_text()

    def test_numbers_are_those_of_the_run(self):
        page, run = self.page("quick"), plateau.open_run(self.made / "quick.h5")
        told = {row[0]: row[1] for row in rows(page, "<h2>Numbers") if len(row) == 2}
        area = run.plateau.mean("contact_area")
        answer = html.unescape(re.search('class="answer">(.*?)</p>', page)[1])
        places = f"{area.value * 1e6:.3f} ± {area.error * 1e6:.3f} mm²"
        self.assertEqual(told["Contact area, mean ± standard error"], places)
        self.assertIn(f"The contact area is {places}, ", answer)
        with h5py.File(self.made / "quick.h5") as file:
            series, scene = file["series"], plateau.open_run(self.made / "quick.h5").plateau.scene
            last = {name: values[-1] for name, values in series.items()}
            # What pulses with the contact area is a mean over the same time: of samples, which stand for the time before them.
            over = file["time"][:] > area.start * (1 + 1e-9)
            pressure = np.average(series["mean_pressure"][:][over], weights=np.diff(file["time"][:], prepend=0.0)[over])
            shown, error = told["Mean contact pressure, mean"].removesuffix(" MPa").split(" ± ")
            self.assertAlmostEqual(float(shown), 1e-6 * pressure, delta=0.06 * float(error))
            self.assertEqual(told["Disc filled"], f"{100 * last['filled_fraction']:.5g} %")
            self.assertEqual(told["Worn volume of the simulated pin and the disc"],
                             f"{1e9 * (last['worn_pin'] + last['worn_resin'] + last['worn_disc']):.5g} mm³")  # fmt: skip
            self.assertEqual(told["Largest residual of the load balance"], f"{np.abs(series['load_residual']).max():.5g}".replace("-", "−"))
            # Lost by weight over force and way; a mm³ is 1e-9 m³.
            rate = last["lost_pin"] / (5.0 * last["sliding_distance"])
            names = [f"Specific wear rate of the whole pin, {unit}" for unit in ("1/Pa", "mm³/(N m)")]
            shown = [[float(part.replace("−", "-")) for part in told[name].split(" ")[:1]] for name in names]
            np.testing.assert_allclose(shown, [[rate], [1e9 * rate]], rtol=1e-4)
            self.assertIn(f"the specific wear rate of the whole pin is {rate:.4g} 1/Pa = {1e9 * rate:.4g} mm³/(N m)", answer.replace("−", "-"))
            self.assertEqual(told["Samples and times of maps"], f"{len(file['time'])} and {len(file['map_time'])}")
            pin = last["contact_area"] / last["contact_ratio"]
            five = [scene["operation"]["normal_force"], f"{5e-6 / pin:.3g} MPa", f"{850 / 60 * 2 * np.pi * 20.5e-3:.4g} m/s",
                    f"{file['time'][-1]:.5g} s, {last['sliding_distance']:.4g} m", f"{1e6 * pin:.3g} mm²"]  # fmt: skip
            self.assertEqual(rows(page)[1], five)
            self.assertIn(html.escape(file.attrs["scene"]), page)
            self.assertIn(html.escape(file.attrs["inputs"].split('"sha256":"')[1][:64]), page)

    def test_a_mean_over_less_than_three_pulses_has_no_error(self):
        plateau.run(QUICK, self.made / "slow.h5", set=SHORT).close()
        page = self.page("slow")
        told = {row[0]: row[1] for row in rows(page, "<h2>Numbers") if len(row) == 2}
        self.assertRegex(told["Contact area, mean ± standard error"], r"^[\d.]+ mm²$")
        self.assertIn("The contact area has no standard error: too few samples, revolutions or pulses.", page)

    def test_events_are_in_tables_that_fit(self):
        page = self.page("stops")
        found = rows(page, "<h2>Events")
        heads = [row for row in found if row[0] == "event"]
        self.assertLessEqual(max(map(len, heads)), 9)
        with h5py.File(self.made / "stops.h5") as run:
            shown_as = (("end", 1, "end, s"), ("initial_speed", 30 / np.pi, "initial speed, rpm"), ("distance", 1, "distance, m"))
            for name, scale, head in shown_as:
                table, column = next((number, row.index(head)) for number, row in enumerate(found) if head in row)
                shown = [float(row[column]) for row in found[table + 1 : table + 1 + len(run["event/end"])]]
                np.testing.assert_allclose(shown, run["event"][name][:] * scale, rtol=1e-3)

    def test_what_strangers_write_is_text(self):
        page = self.page("heavy")
        self.assertNotIn("<script", page)
        self.assertNotIn("\u202e", page)
        self.assertIn("<h1>&lt;script&gt;alert(1)&lt;/script&gt; &quot;$x &amp; \ufffdback</h1>", page)
        self.assertEqual(set(re.findall(r"(?:src|href|url)\W+(?!data:)(\w+:)", page)) - {"http:"}, set())
        body = page[page.index("<body>") : page.index("</body>")] + "</body>"
        xml.fromstring(re.sub(r"&(?!amp;|lt;|gt;|quot;|#)\w+;", "", body).replace("<body>", '<body xmlns:xlink="x">'))

    def test_several_runs_are_compared_with_the_first(self):
        page = self.page("quick", "heavy", "stops")
        runs = [plateau.open_run(self.made / f"{name}.h5") for name in ("quick", "heavy", "stops")]
        told = {row[0]: row[1:] for row in rows(page, "<h2>Numbers") if len(row) == 4}
        first, second = (run.plateau.mean("contact_area") for run in runs[:2])
        found = re.fullmatch(r".* mm² \(\+([\d.]+) ± ([\d.]+) mm², \+([\d.]+) %\)", told["Contact area, mean ± standard error"][1])
        self.assertAlmostEqual(float(found[1]), 1e6 * (second.value - first.value), 2)
        self.assertAlmostEqual(float(found[2]), 1e6 * np.hypot(first.error, second.error), 2)
        self.assertAlmostEqual(float(found[3]), 100 * (second.value / first.value - 1), 1)
        answer = html.unescape(re.search('class="answer">(.*?)</p>', page)[1])
        self.assertTrue(all(area in answer for area in told["Contact area, mean ± standard error"]))
        self.assertNotIn("(same)", answer)
        keys = {row[0]: row[1:] for row in rows(page, "<h2>Keys of the scenes that differ")}
        self.assertEqual(keys["operation.normal_force"], ["5 N", "10 N", "5 N"])
        self.assertEqual(keys["numerics.time_acceleration"], ["20.0", "20.0", "2.0"])
        self.assertNotIn("mesh.rows", keys)

    def test_differences(self):
        first = Measure("area", MM2, 4e-6, 3e-8)
        self.assertEqual(Measure("area", MM2, 5e-6, 4e-8).compared(first), "5.000 ± 0.040 mm² (+1.000 ± 0.050 mm², +25.0 %)")
        self.assertEqual(Measure("part", PERCENT, 0.625).compared(Measure("part", PERCENT, 0.5)), "62.5 % (+12.5 points)")
        self.assertEqual(Measure("hot", CELSIUS, 433.15).compared(Measure("hot", CELSIUS, 423.15)), "160 °C (+10 K)")
        self.assertEqual(Measure("n", NUMBER, 2.0).compared(Measure("n", NUMBER, 0.0)), "2 (+2)")
        self.assertEqual(Measure("n", NUMBER, 2.0).compared(Measure("n", NUMBER, 2.0)), "2 (same)")

    def test_parts_of_the_area_have_four_digits_at_most(self):
        for value, error, text in (
            (0.25023862, 3.9e-7, "25.02 %"),
            (0.25023862, 3.9e-4, "25.02 ± 0.04 %"),
            (0.25023862, 3.9e-3, "25.02 ± 0.39 %"),
            (0.0012344, 0.0, "0.1234 %"),
        ):
            self.assertEqual(Measure("part", PERCENT, value, error).text, text)

    def test_an_interrupted_run_is_told(self):
        run = plateau.open_run(self.made / "quick.h5").copy()
        run.attrs["state"] = "interrupted"
        self.draw_few()
        page = report_page([run])
        self.assertIn("The run is not finished: interrupted by its user. It has 200 samples.", page)

    def test_what_is_in_the_way(self):
        shutil.copy(self.made / "quick.h5", "quick.h5")
        with self.assertRaisesRegex(plateau.InputError, "a report is a page in HTML, expected a name such as a.html"):
            plateau.report("quick.h5", "a.pdf")
        with self.assertRaisesRegex(plateau.InputError, "is an input"):
            plateau.report("quick.h5", "quick.h5", force=True)
        with self.assertRaisesRegex(plateau.InputError, "11 runs: expected 1 to 10"):
            plateau.report(["quick.h5"] * 11)
        self.assertEqual(os.listdir(), ["quick.h5"])
        pathlib.Path("page.html").write_text("before")
        pathlib.Path("page.html").chmod(0o640)
        pathlib.Path("link.html").symlink_to("page.html")
        with unittest.mock.patch.object(run_report, "report_page", lambda runs, progress: "after"):
            plateau.report("quick.h5", "link.html", force=True)
        self.assertTrue(os.path.islink("link.html"))
        self.assertEqual((pathlib.Path("page.html").read_text(), os.stat("page.html").st_mode & 0o777), ("after", 0o640))

    def test_a_run_without_samples(self):
        run = plateau.open_run(self.made / "stops.h5").isel(time=slice(0))
        self.enterContext(unittest.mock.patch.dict(figures.FIGURES, {}, clear=True))
        page = report_page([run])
        self.assertIn("There are no samples yet", page)
        self.assertEqual(rows(page)[1], ["at most –", "at most –", "at most –", "0 s, –", "–"])

    def test_the_word_plot(self):
        run = self.made / "quick.h5"
        status, out, err = word("plot", run, "--figure", "contact-area", "--figure", "filled", "--format", "svg", "--at", "1 h")
        self.assertEqual((status, sorted(os.listdir("quick"))), (0, ["contact-area.svg", "filled.svg"]))
        self.assertRegex(out, r"^wrote quick/contact-area.svg: Contact area against time\nwrote quick/filled.svg: .*\n$")
        self.assertIn("3600 s is after the last recorded map, that of 20 s is shown", err)
        pathlib.Path("quick/contact-area-2.svg").touch()
        status, out, err = word("plot", run, "--figure", "contact-area", "--figure", "heights", "--format", "svg")
        self.assertEqual((status, out, sorted(os.listdir("quick"))), (2, "", ["contact-area-2.svg", "contact-area.svg", "filled.svg"]))
        self.assertIn("quick/contact-area.svg exists; give --force to replace it, or -o DIR names another folder", err)
        status, _, err = word("plot", run, "--figure", "contact-area", "--format", "svg", "--force")
        self.assertEqual((status, "quick/contact-area-2.svg is a page of an earlier call" in err), (0, True))
        for wrong in ("--figure=friction", "--width=88", "--width=3 mm", "--at=-1 s", "--figure=x", "--cmap=jet"):
            with self.subTest(wrong):
                self.assertEqual(word("plot", run, "-o", "other", wrong)[0], 2)
        self.assertFalse(os.path.exists("other"))

    def test_the_word_report(self):
        self.draw_few()
        status, out, err = word("report", self.made / "quick.h5", self.made / "quick.h5")
        self.assertEqual((status, "quick.h5 is named more than once" in err), (0, True))
        self.assertRegex(out, r"^wrote report.html \([\d.]+ kB\)\n$")
        status, _, err = word("report", "no.h5")
        self.assertEqual((status, err), (2, "plateau: no.h5: there is no such run file\n"))
