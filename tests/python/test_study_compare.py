"""Comparison of scenes: differences paired by seed, runs that are made once."""

import dataclasses
import json
import os
import pathlib
import re
import unittest
import warnings

import numpy as np
import xarray
from checkout import QUICK, Folder
from scipy import stats

# isort: split
import optimum
from made_studies import number, study_of, word

from plateau.errors import InputError
from plateau.study.scene_comparison import _compared, _fixed, _ratio, _seed_keys, _sure, _words, compare, difference, response_of
from plateau.units import unit_of

# Student's sleep data (R: `sleep`): hours of sleep gained with two drugs by the same ten patients.
ONE = [0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0]
TWO = [1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4]


class Differences(unittest.TestCase):
    def test_the_paired_test_of_r(self):
        # R's documentation: t.test(extra ~ group, paired = TRUE) gives p = 0.002833, 95 % interval -2.4598858 -0.7001142.
        found = difference(TWO, ONE)
        self.assertAlmostEqual(found["difference"], -1.58, places=12)
        self.assertAlmostEqual(found["low"], -2.4598858, places=7)
        self.assertAlmostEqual(found["high"], -0.7001142, places=7)
        self.assertAlmostEqual(found["p"], 0.002833, places=6)
        self.assertAlmostEqual(found["sureness"], 1 - 0.002833, places=6)
        self.assertTrue(np.isnan(found["ratio"]))

    def test_several_comparisons_hold_together(self):
        alone, both = difference(ONE, TWO), difference(ONE, TWO, comparisons=2)
        self.assertAlmostEqual(both["p"], 2 * alone["p"])
        half = stats.t.ppf(1 - 0.025 / 2, 9) * np.std(np.subtract(TWO, ONE), ddof=1) / np.sqrt(10)
        self.assertAlmostEqual(both["high"] - both["difference"], half)

    def test_a_ratio_is_that_of_geometric_means(self):
        one, two = np.array([1.0, 2.0, 4.0]), np.array([2.0, 4.0, 9.0])
        found = difference(one, two)
        by_log = stats.ttest_rel(np.log(two), np.log(one)).confidence_interval()
        self.assertAlmostEqual(found["ratio"], (2 * 2 * 2.25) ** (1 / 3))
        self.assertAlmostEqual(found["ratio_low"], np.exp(by_log.low))
        self.assertAlmostEqual(found["ratio_high"], np.exp(by_log.high))

    def test_what_is_printed_does_not_contradict_the_interval(self):
        # Sure at the confidence of the intervals, or not: here by little, with as many digits as tell it.
        for confidence, is_sure in ((0.9971, True), (0.9972, False)):
            found = difference(TWO, ONE, confidence)
            self.assertEqual((_sure(found["sureness"]), found["high"] < 0.0), ("99.7 %", is_sure))
            self.assertEqual("no sure difference" in _words("b: y", unit_of("1", 1.0), found, confidence), not is_sure)
        self.assertEqual([_sure(part) for part in (0.94996, 0.95, 0.9991)], ["94.9 %", "95.0 %", "more than 99.9 %"])
        self.assertIn("sure at 99.7 %", _words("b: y", unit_of("1", 1.0), difference(TWO, ONE), 0.95))
        near = {"ratio": 1.0042, "ratio_low": 1.0003, "ratio_high": 1.0081}
        self.assertEqual(_ratio(near), "1.0042 (1.0003 … 1.0081)")
        self.assertEqual(_ratio({"ratio": 1.2, "ratio_low": 0.02, "ratio_high": 72.0}), "1.2 (0.020 … 70)")
        self.assertEqual(_ratio({"ratio": 1.5, "ratio_low": np.nan, "ratio_high": np.nan}), "1.5")

    def test_few_and_equal_values(self):
        self.assertEqual(difference([1.0], [3.0])["difference"], 2.0)
        self.assertTrue(np.isnan(difference([1.0], [3.0])["low"]))
        self.assertTrue(np.isnan(difference([], [])["difference"]))
        self.assertEqual([difference([1.0, 1.0], two)["p"] for two in ([1.0, 1.0], [2.0, 2.0])], [1.0, 0.0])

    def test_a_scene_without_seeds_stands_beside_all_runs_of_another(self):
        alone = study_of([word("seed", "none")], {"seed": ["none"], "y": [2.0]})
        for seeds in ([1.0], [1.0, 2.0]):
            seeded = study_of([number("seed", *seeds)], {"seed": seeds, "y": [3.0, 5.0][: len(seeds)]})
            found = _compared({"a": seeded, "b": alone}, {"a": "", "b": ""}, 0.95, [], pathlib.Path(), False)
            # Of 3 and 2, and of the mean of 3 and 5 and 2.
            self.assertEqual(found.table[["runs", "difference"]].to_numpy().tolist(), [[len(seeds), -float(len(seeds))]])

    def test_words_have_the_unit_of_the_table(self):
        study = study_of([number("seed", 1.0, 2.0)], {"seed": [1.0, 2.0], "area": [4e-7, 5e-7]}, responses={"area": "m2"})
        found = _compared({"a": study, "b": study}, {"a": "", "b": ""}, 0.95, [], pathlib.Path(), False)
        self.assertEqual(found.table["words"].tolist(), ["b: area: no sure difference, 0.0000 ± 0.0000 mm² (95 %)"])
        self.assertEqual(found.shown()["difference"].tolist(), ["", "0.0000 ± 0.0000 mm²"])

    def test_pulses_that_drift_apart_do_not_hide_a_difference(self):
        time, made = np.linspace(0.0, 1000.0, 501), {}
        for scene, level, phases in (("a", 3e-5, (0.0, 2.0, 4.0)), ("b", 2.6e-5, (1.0, 5.0, 3.0))):
            runs = [level + 1e-5 * np.sin(2 * np.pi * time / 20.0 + phase) for phase in phases]
            areas = xarray.DataArray(runs, {"time": time}, ("run", "time"), attrs={"units": "m2"})
            study = study_of(
                [number("seed", 1.0, 2.0, 3.0)], {"seed": [1.0, 2.0, 3.0], "area": [level] * 3}, responses={"area": "m2"}, title=f"Disc {scene}"
            )
            response = dataclasses.replace(study.responses[0], series="contact_area")
            made[scene] = dataclasses.replace(study, responses=[response], data=xarray.Dataset({"contact_area_mean": areas}))
        found = _compared(made, {"a": "", "b": ""}, 0.95, [], pathlib.Path(), False)
        last = found.curves[found.curves["scene"] == "b"].iloc[-1]
        # Over three pulses.
        self.assertEqual(last["window"], 62.5)
        np.testing.assert_allclose([last["difference"], last["mean"]], [-4e-6, 2.6e-5], atol=3e-7)
        self.assertLess(last["high"], -1e-6)
        self.assertEqual(found.titles, {"a": "Disc a", "b": "Disc b"})
        # A temperature keeps its peaks.
        for study in made.values():
            study.data["contact_area_mean"].attrs["units"] = "K"
        peaks = _compared(made, {"a": "", "b": ""}, 0.95, [], pathlib.Path(), False).curves
        np.testing.assert_allclose(peaks["mean"].to_numpy()[:501], made["a"].data["contact_area_mean"].mean("run"))

    @unittest.skipUnless("PLATEAU_LONG" in os.environ, "a simulation of what the values of R say already")
    def test_intervals_cover_in_95_of_100(self):
        # Five seeds; three scenes hold together.
        covered = optimum.simulated(5, 3, 1500)
        self.assertTrue(0.94 < covered < 0.98, covered)


class Words(unittest.TestCase):
    def test_responses(self):
        self.assertEqual(response_of("", "worn_pin"), {"name": "worn pin", "dataset": "/series/worn_pin", "at": "end"})
        self.assertEqual(response_of("", "/series/contact_area")["mean"], "last tenth")
        # What pulses is a mean, as it is where nothing is asked; totals have none.
        self.assertEqual([response_of("", name)["mean"] for name in ("mean_pressure", "contact_ratio")], ["last tenth"] * 2)
        self.assertEqual([response_of("", name)["at"] for name in ("filled_fraction", "brake_pm10_per_distance", "mean_pressure:end")], ["end"] * 3)
        self.assertEqual(response_of("x", "/event/temperature:mean"), {"name": "x", "dataset": "/event/temperature", "event": "mean"})
        self.assertEqual(response_of("x", "pool:mean 1 s..2 s")["mean"], ["1 s", "2 s"])
        self.assertEqual(response_of("x", "contact_area:reaches .8")["reaches"], 0.8)
        self.assertEqual(response_of("x", "/event/temperature:3"), {"name": "x", "dataset": "/event/temperature", "event": 3})
        with self.assertRaisesRegex(InputError, "expected a fraction"):
            response_of("x", "contact_area:reaches 90 %")

    def test_seeds_of_a_scene(self):
        scene = {"disc": {"surface": {"synthetic": {"seed": 1}}}, "pin": {"base": {"file": "a"}, "surface": {"synthetic": {"seed": 3}}}}
        self.assertEqual(_seed_keys(scene), ["disc.surface.synthetic.seed", "pin.surface.synthetic.seed"])
        self.assertEqual(_fixed(scene), ["pin.base"])
        # Beyond a patch all runs differ.
        extended = {"disc": {"surface": {"file": "a"}, "prepare": {"extend_seed": 2}}, "pin": {"base": {"file": "b", "extend_seed": 1}}}
        self.assertEqual(_fixed(extended), ["the patch of disc.surface", "the patch of pin.base"])
        with self.assertRaisesRegex(InputError, "two scenes or more"):
            compare([QUICK])


class Scenes(Folder):
    def test_runs_are_made_once_and_compared_by_seed(self):
        smooth = self.folder / "smooth.toml"
        smooth.write_text(f'version = 1\nextends = {json.dumps(str(QUICK))}\n[disc.surface]\nsynthetic.rms_height = "1 um"\n')
        options = {"set": {"operation.duration": "2 s"}, "output": self.folder / "out"}
        with warnings.catch_warnings(record=True, action="always") as said:
            found = compare([QUICK, smooth], 3, **options)
        begins = r'(\w+): response "running-in time" has no value'
        self.assertEqual([re.match(begins, str(one.message))[1] for one in said], ["quick", "smooth"])
        with warnings.catch_warnings(action="ignore"):
            journal = {path: path.stat().st_mtime_ns for path in (self.folder / "out").rglob("journal/*")}
            again = compare([QUICK, smooth], 3, **options)
        self.assertTrue(journal)
        self.assertEqual(journal, {path: path.stat().st_mtime_ns for path in (self.folder / "out").rglob("journal/*")})
        self.assertEqual(found.table.to_csv(), again.table.to_csv())
        area = found.runs.pivot(index="seed", columns="scene", values="contact area")
        self.assertEqual(area.shape, (3, 2))
        expected = stats.ttest_rel(area["smooth"], area["quick"])
        row = found.table.set_index("response").loc["contact area"]
        self.assertAlmostEqual(row["p"], expected.pvalue)
        self.assertIn("smooth: contact area is smaller by", row["words"])
        self.assertEqual(list(found.figures()), list(found.curves["series"].unique()))
        self.assertEqual(json.loads(json.dumps(found.document()))["reference"], "quick")
        self.assertTrue(any("running-in time has a value in 0 of 3" in caution for caution in found.cautions))
        self.assertEqual(found.table["cautions"].str.contains("running-in time has a value in 0 of 3").sum(), 1)

    def test_scenes_of_other_cells_and_accelerations_are_not_alike(self):
        with warnings.catch_warnings(action="ignore"):
            coarse = self.folder / "coarse.toml"
            coarse.write_text(f"version = 1\nextends = {json.dumps(str(QUICK))}\n[mesh]\nrows = 10\n[numerics]\ntime_acceleration = 10\n")
            found = compare([QUICK, coarse], 2, set={"operation.duration": "1 s"}, output=self.folder / "out")
            for said in ("rows of different height (quick 50 µm, coarse 100 µm)", "different time accelerations (20.0, 10.0)"):
                self.assertTrue(any(said in caution for caution in found.cautions), found.cautions)
