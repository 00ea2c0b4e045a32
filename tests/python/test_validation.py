"""The study of the paper (data/studies/riva2019): its measures have closed forms, and documents agree with its results."""

import json
import re
import subprocess
import sys
import unittest
from pathlib import Path
from unittest import mock

import numpy as np
from checkout import ROOT, program
from package_scenes import InFolder

import plateau

STUDY = ROOT / "data/studies/riva2019"
sys.path.insert(0, str(STUDY))
import discs  # noqa: E402, where the study is
import friction  # noqa: E402, where the study is
import history  # noqa: E402, where the study is
import make_points  # noqa: E402, where the study is
import maps  # noqa: E402, where the study is
import measures  # noqa: E402
import strength  # noqa: E402, where the study is
import strength_tables  # noqa: E402, where the study is
import tables  # noqa: E402, where the study is
import write_docs  # noqa: E402, where the study is

sys.path.append(str(STUDY.parent / "mesh"))
import figure  # noqa: E402, where the study is


class Measures(unittest.TestCase):
    """Rows of radius 1 and 3, so that cells of the outer one have three times the area."""

    radius = np.array([1.0, 3.0])

    def test_filled_volume_and_area(self) -> None:
        initial = np.array([[0.0, -2.0], [-4.0, 0.0]])
        height = np.array([[1.0, -1.0], [-4.0, 5.0]])
        # By hand: open at first 2·3 + 4·1 = 10, later 1·3 + 4·1 = 7; of the low cells' area of 3 + 1, within 1 of the top 3.
        self.assertAlmostEqual(measures.filled_volume(initial, height, self.radius), 0.3)
        self.assertEqual(measures.filled_area(initial, height, self.radius, 0.5), 0.0)
        self.assertAlmostEqual(measures.filled_area(initial, height, self.radius, 1.0), 0.75)
        self.assertEqual(measures.radial_filling(initial, height, self.radius, 2).tolist(), [0.0, 0.5])
        # What is open, 3 in the outer row and 4 in the inner one; deepest is the inner cell of -4.
        self.assertAlmostEqual(measures.open_where_deepest(initial, height, self.radius, 0.25), 4 / 7)

    def test_shares_count_areas(self) -> None:
        self.assertAlmostEqual(measures.share(np.array([[True, False]]), self.radius), 0.25)

    def test_run_in_and_change_point(self) -> None:
        time = np.arange(100.0)
        broken = np.minimum(time, 40.0)
        self.assertEqual(measures.run_in(time, broken, 0.9), 36.0)
        self.assertEqual(measures.change_point(time, broken), 40.0)

    def test_drift_of_a_line(self) -> None:
        time = np.linspace(0.0, 10.0, 21)
        slope, half = measures.drift(time, 2.0 + 0.1 * time)
        self.assertAlmostEqual(slope, 0.1 / 2.5)
        self.assertLess(half, 1e-12)

    def test_an_interval_of_the_drift_has_the_slope_in_it(self) -> None:
        # Noise in which neighbours are alike (first order, 0.7): 95 % of the intervals have the slope; without allowing
        # for that, fewer than 70 % would.
        random, time, hits = np.random.default_rng(1), np.arange(60.0), 0
        for _ in range(400):
            noise = np.zeros(60)
            for step in range(1, 60):
                noise[step] = 0.7 * noise[step - 1] + random.standard_normal()
            slope, half = measures.drift(time, 100.0 + 0.05 * time + noise)
            hits += abs(slope * (100.0 + 0.05 * time + noise).mean() - 0.05) <= half * 101.5
        self.assertGreater(hits, 340)

    def test_plateaus_are_pieces_with_common_edges(self) -> None:
        cells = np.array([[1, 0, 0], [0, 1, 1], [1, 0, 0]], bool)
        self.assertEqual(sorted(measures.plateau_sizes(cells, False).tolist()), [1, 1, 2])
        # Round the ring the first column lies beside the last.
        self.assertEqual(sorted(measures.plateau_sizes(cells, True).tolist()), [2, 2])

    def test_diameters_of_equal_discs(self) -> None:
        areas = np.full(9, np.pi / 4)
        self.assertEqual(set(measures.diameters(areas, [10, 50, 90]).values()), {1.0})

    def test_roughness_and_gini_count_areas(self) -> None:
        # Heights of 0 and 4 with weights of 3 and 1: mean 1, mean square (3·1 + 1·9)/4.
        self.assertAlmostEqual(measures.sq(np.array([0.0, 4.0]), np.array([3.0, 1.0])), 3**0.5)
        # All alike: even. Half of the area carries all but a little, the rest almost nothing: nearly 1/2.
        self.assertAlmostEqual(measures.gini(np.array([[2.0, 2.0], [2.0, 0.0]]), self.radius), 0.0)
        self.assertAlmostEqual(measures.gini(np.array([[1e-9], [1.0]]), np.ones(1)), 0.5)

    def test_wilson_interval_of_a_known_table(self) -> None:
        # Ten of ten: from 1/(1 + z²/10); none of ten is its mirror image.
        low, high = measures.wilson(10, 10)
        self.assertAlmostEqual(low, 1 / (1 + 1.959964**2 / 10), places=6)
        self.assertAlmostEqual(high, 1.0)
        self.assertAlmostEqual(measures.wilson(0, 10)[1], 1 - low)

    def test_interval_of_a_known_table(self) -> None:
        # Student's t for two degrees of freedom and 95 %, 4.302653; standard deviation 1.
        mean, half = measures.interval([1.0, 2.0, 3.0])
        self.assertAlmostEqual(mean, 2.0)
        self.assertAlmostEqual(half, 4.302653 / np.sqrt(3.0), places=5)


class Friction(unittest.TestCase):
    """A contact of 10 mm² in the first half of 100 s and of 20 mm² in the second, under 47 N: by hand 0.75 MPa · 10 mm² / 47 N =
    7.5/47, so the coefficient is 0.33 + 7.5/47 = 0.48957, then 0.33 + 15/47 = 0.64915 without ceiling."""

    series = {
        "time": np.arange(1.0, 101.0),
        "contact_area": np.repeat([10e-6, 20e-6], 50),
        "contact_area_integral": np.cumsum(np.repeat([10e-6, 20e-6], 50)),
    }

    def test_flat_on_flat_has_the_closed_form(self) -> None:
        self.assertAlmostEqual(friction.mean_over(self.series, 0.0, 50.0), 0.33 + 7.5 / 47, places=12)

    def test_the_ceiling_acts_on_steps_and_not_on_their_mean(self) -> None:
        # The mean without it, 0.33 + 11.25/47 = 0.5694, is below the ceiling, and yet half of the steps are cut.
        self.assertAlmostEqual(friction.mean_over(self.series, 0.0, 100.0), (0.33 + 7.5 / 47 + 0.6) / 2, places=12)
        told = friction.ceiling({"1": [self.window(2700.0)]})
        self.assertAlmostEqual(told["1"]["share"], 0.5)
        self.assertAlmostEqual(told["1"]["taken"], (0.33 + 15 / 47 - 0.6) / 2, places=12)
        self.assertAlmostEqual(told["highest"], 0.33 + 15 / 47, places=12)

    def window(self, start: float) -> dict[str, np.ndarray]:
        """The same pattern from a time on, three times as long, with nothing before."""
        area = np.repeat([0.0, 10e-6, 20e-6], [int(start), 150, 150])
        return {"time": np.arange(1.0, len(area) + 1), "contact_area": area, "contact_area_integral": np.cumsum(area)}

    def test_samples_are_moved_to_the_mean_over_every_step(self) -> None:
        # Samples that missed what was between them: they say 10 mm², the integral 12 mm².
        series = self.series | {"contact_area": np.full(100, 10e-6), "contact_area_integral": 12e-6 * self.series["time"]}
        self.assertAlmostEqual(friction.mean_over(series, 0.0, 100.0), 0.33 + 9 / 47, places=12)

    def test_it_falls_with_the_load_and_rises_with_the_area(self) -> None:
        law = friction.CHOSEN
        self.assertAlmostEqual(law.without_ceiling(10e-6, 94.0), 0.33 + 3.75 / 47, places=12)
        # The ceiling begins where 0.75 MPa · A = 0.27 · 47 N.
        self.assertAlmostEqual(law.area_at_ceiling(47.0), 16.92e-6, places=12)

    def test_discs_are_compared_on_the_same_surfaces(self) -> None:
        # Differences of 0.1 and 0.3, mean 0.2; Student's t for one degree of freedom, 12.7062, times 0.1.
        values = {"1": np.array([0.3, 0.4]), "0.1": np.array([0.35, 0.45]), "0.01": np.array([0.4, 0.7])}
        mean, half = friction.between(values)["0.01 less 1"]
        self.assertAlmostEqual(mean, 0.2)
        self.assertAlmostEqual(half, 1.27062, places=4)
        self.assertEqual(friction.order(values)["hits"], 2)


class Strength(unittest.TestCase):
    """A pin of which 2 mm³ are worn per metre in the first 300 s, 1 mm³ later, at 2 m/s and 11.7 N."""

    time = np.arange(10.0, 3001.0, 10.0)
    series = {
        "time": time,
        "sliding_distance": 2 * time,
        "worn_whole_pin": 1e-9 * (2 * time + 2 * np.minimum(time, 300.0)),
        "emitted": 1e-9 * time,
        "contact_area_integral": 10e-6 * time,
        "filled_fraction": time / 3000,
        **dict.fromkeys(("worn_pin", "worn_resin", "worn_disc", "deposited_pin", "deposited_disc"), time),
    }

    def test_wear_at_first_and_at_the_end(self) -> None:
        found = strength.numbers(self.series, 3000.0)
        self.assertAlmostEqual(found["first_wear"] * 11.7 * 1e9, 2.0)
        self.assertAlmostEqual(found["wear"] * 11.7 * 1e9, 1.0)
        self.assertAlmostEqual(found["emitted"], 3e-6)

    def test_wear_from_0_on_counts_the_time_when_fibres_wear_alone(self) -> None:
        # Fibres under the whole load, 5e-14 1/Pa, on the first 20 m; then 2 mm³/m to 600 m: by hand.
        fibres, way = 5e-14 * 11.7, self.series["sliding_distance"]
        worn = fibres * np.minimum(way, 20.0) + 2e-9 * (way - 20.0).clip(0)
        found = strength.numbers(self.series | {"worn_whole_pin": worn}, 3000.0)
        self.assertAlmostEqual(strength_tables.from_the_start(found["first_wear"]) * 11.7 * 1e9 * 600, fibres * 1e9 * 20 + 2.0 * 580)

    def test_levels_are_compared_on_the_same_surfaces(self) -> None:
        areas = {"1": (2.0, 4.0), "0.1": (2.2, 4.4), "0.01": (2.2, 5.2)}
        discs = {heights: [{"contact_area_mean": area} for area in of] for heights, of in areas.items()}
        found = strength.above_the_rough_disc(discs)
        self.assertAlmostEqual(found["0.1"][0], 0.1)
        self.assertAlmostEqual(found["0.1"][1], 0.0)
        # 10 and 30 %; Student's t for one degree of freedom, 12.7062, times 10 %.
        self.assertAlmostEqual(found["0.01"][0], 0.2)
        self.assertAlmostEqual(found["0.01"][1], 1.27062, places=4)

    def test_claims_are_counted_over_sets(self) -> None:
        keys = ("filled", "disc_secondary", "pin_secondary", "pressure_gini", "contact_area_mean", "run_in", "drift", "drift_error")
        keys += ("wear", "first_wear", "emitted")
        # In the first set everything falls from disc to disc, in the second everything is equal.
        discs = {heights: [dict.fromkeys(keys, value), dict.fromkeys(keys, 1.0)] for heights, value in (("1", 3.0), ("0.1", 2.0), ("0.01", 1.0))}
        held = {name: found[0] for name, found in strength.holds(discs).items()}
        falling = ("more even pressure", "more even, the smoother the disc", "longer run-in")
        falling += ("wears more on the rough disc", "emits more on the rough disc")
        self.assertEqual(held, {name: 1 if name in falling else 0 for name in held})


class Mesh(unittest.TestCase):
    def test_every_mesh_has_the_same_surfaces(self) -> None:
        """Columns of each mesh divide those of the finest, on disc and pin alike, and every file of a table is one that is made."""
        lines = [line.split(",") for line in (STUDY.parent / "mesh/length.csv").read_text().splitlines()[1:]]
        self.assertEqual(len(lines), 3 * 3 * (3 * 10 + 3) + 2 * 3 * 3 + 3)
        for file, _, disc, pin, rows, _, _ in lines:
            self.assertEqual((2768 % int(disc), 2768 // int(disc)), (0, 160 // int(pin)))
            self.assertRegex(file, rf"^surfaces/set-([1-9]|10)-columns-{disc}-rows-{rows}\.h5$")

    def test_a_mesh_with_fewer_sets_is_drawn_by_its_change(self) -> None:
        """The sets that the finest mesh has lie far above the others, and fall by a tenth."""
        values = {"25": {"filled": [0.5, 0.01, 10]}, "12.5": {"filled": [0.9, 0.02, 3]}}
        changes = {"25 to 12.5": {"filled": [-0.1, 0.02, 3]}}
        [coarser, finest] = figure.course(values, changes, "filled")
        self.assertEqual(coarser, (25.0, 0.5, 0.01))
        # Errors of the mean and of the change in squares: 0.9 · 0.01 and 0.5 · 0.02.
        np.testing.assert_allclose(finest, (12.5, 0.45, (0.009**2 + 0.01**2) ** 0.5))


class Templates(unittest.TestCase):
    def test_numbers_are_compared_and_searched(self) -> None:
        found = {"one": {"a": [0.3, 9.0], "b, c": [-0.5, 9.0]}, "two": {"a": [0.2, 9.0]}, "three": {"c": [0.4, 9.0]}}
        with mock.patch.object(tables, "RESULTS", found):
            texts = {
                "{{one/a minus two/a|100|.1f}}": "10.0",
                "{{one/a relative to three/c|-100|.0f}}": "25",
                "{{largest */*/0|100|.0f}} {{smallest one/*/0|1|.1f}}": "50 0.3",
            }
            self.assertEqual({text: write_docs.filled_in(text) for text in texts}, texts)

    def test_shares_are_those_of_a_known_table(self) -> None:
        # Newcombe, Statistics in Medicine 17 (1998), 857, table I: 15 of 148 leave 0.0624 to 0.1605, 1 of 29 leave 0.0061 to 0.1718.
        self.assertEqual(write_docs.filled_in("{{wilson 15 148}}, {{wilson 1 29}}"), "6 to 16, 1 to 17")

    def test_runs_are_those_of_the_plan(self) -> None:
        studies = ("../strength", "counterface", "unknowns", "levels", "steady")
        planned = [json.loads(program("sweep", "plan", STUDY / f"{study}.toml", "--json"))["runs"] for study in studies]
        self.assertEqual(write_docs.filled_in(f"{{{{runs of {' '.join(studies)}}}}}"), str(sum(planned)))


class RunFiles(InFolder):
    """What scripts read of a run file agrees with what the program wrote there."""

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        plateau.run("quick.toml", "minute.h5", set={"output.maps_at": ["0 s", "60 s"]})

    def test_maps_agree_with_series(self) -> None:
        with plateau.open_run("minute.h5") as run:
            series, pin, disc, sizes = history.series_of(run), maps.at_the_end(run, 60.0), maps.of_the_disc(run, 60.0), maps.sizes(run, 60.0)
            self.assertEqual(len(series), len(run["series"].data_vars) + 1)
        self.assertAlmostEqual(disc["filled"], series["filled_fraction"][-1], places=12)
        self.assertAlmostEqual(pin["pin_covered"], series["pin_secondary"][-1], places=12)
        self.assertEqual(pin["maps"], 1.0)
        self.assertTrue(all(found["count"] > 0 for found in sizes.values()), sizes)
        # What the disc holds, over the area of the ring, is the mean thickness of its build-up.
        ring = np.pi * (21e-3**2 - 20e-3**2)
        self.assertAlmostEqual(disc["mean_build_up"] * 1e9, series["deposited_disc"][-1] / ring * 1e9, places=6)
        self.assertEqual(history.reached(Path("minute.h5")), series["time"][-1])
        self.assertEqual(history.reached(Path("none.h5")), 0.0)

    def script(self, *arguments: str) -> str:
        """Calls a script as the documents say."""
        command = [sys.executable, "-B", str(ROOT / arguments[0]), *arguments[1:]]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout

    def test_a_reference_has_the_series_of_its_run(self) -> None:
        self.script("data/reference/make.py", "minute.h5", "reference.h5")
        with plateau.open_run("minute.h5") as run, plateau.open_run("reference.h5") as reference:
            self.assertEqual(reference.attrs["scene"], run.attrs["scene"])
            for name, values in reference["series"].data_vars.items():
                np.testing.assert_array_equal(values, run[f"series/{name}"])


class Documents(unittest.TestCase):
    def test_packages_of_the_study_are_those_of_the_checks(self) -> None:
        """One version of each, so that a run file is read alike in both environments."""
        lists = (ROOT / "tests/python/requirements.txt", STUDY / "requirements.txt")
        checks, study = (dict(re.findall(r"^(\S+)==(\S+)", path.read_text(), re.MULTILINE)) for path in lists)
        self.assertLessEqual({"numpy", "h5py", "h5netcdf", "xarray", "pandas"}, study.keys())
        both = checks.keys() & study.keys()
        self.assertEqual({name: study[name] for name in both}, {name: checks[name] for name in both})

    def test_documents_have_the_numbers_of_the_study(self) -> None:
        check = [sys.executable, "-B", str(STUDY / "write_docs.py"), "--check"]
        told = subprocess.run(check, capture_output=True, text=True, check=False)
        self.assertEqual(told.returncode, 0, told.stdout + told.stderr)

    def test_numbers_have_their_time_acceleration_beside_them(self) -> None:
        """A number of m = 100 beside one of m = 1, without either, would make two of one contact area."""
        for name in ("readme.md.in", "validation.md.in"):
            text = (STUDY / name).read_text()
            # Runs are what is spoken of unless it says otherwise, which is said first; all that is varied has a section.
            self.assertIn("{{m runs}}", text[: text.index("{{runs/")], name)
            # Where a piece begins that is read by itself: a paragraph, a list item, a row, a heading.
            for piece in re.split(r"\n(?=\n|- |\d\. |\||#)", text):
                found = re.findall(r"\{\{(\w+)/(\w+)/[^}]*(?:contact|run_in|pressure|pin_|sq_|drift|filled|inner|friction)", piece)
                of_friction = {"local": "sets", "choices": "sets", "pooled": "pooled-sets", "runs": "runs"}
                for rule in re.findall(r"\{\{friction/(\w+)/", piece):
                    if rule in of_friction:
                        self.assertIn(f"{{{{m {of_friction[rule]}}}}}", piece, f"{name}: {piece}")
                for part, rule in found:
                    if part in ("sets", "ratio", "symmetry", "pins"):
                        part = {"symmetry": "symmetry"}.get(part, "pooled-sets" if rule == "pooled" else "sets")
                        self.assertIn(f"{{{{m {part}}}}}", piece, f"{name}: {piece}")
            for section in re.split(r"\n(?=## )", text):
                if re.search(r"\{\{(variants|readings)/means|\{\{table (variants|readings)\}\}", section):
                    self.assertIn("{{m variants}}", section, name)
        expected = {"runs": 1.0, "sets": 100.0, "pooled-sets": 500.0, "variants": 500.0, "symmetry": 100.0}
        self.assertEqual(tables.accelerations(), expected)

    def test_the_first_screen_has_one_number_for_one_thing(self) -> None:
        readme = (ROOT / "README.md").read_text().split(write_docs.MARKS[0])[1].split(write_docs.MARKS[1])[0]
        validation = (ROOT / "docs/evidence/validation.md").read_text()
        for heights in ("1", "0.1", "0.01"):
            area = tables.last_tenth(heights, 3000.0)
            self.assertIn(area, readme)
            self.assertIn(area, validation)
            run_in = tables.value(f"runs/{heights}/history/3000/run_in")
            self.assertIn(f"{run_in:.0f}", readme)
        # What stands in a list of findings without another m is of the model.
        for line in re.findall(r"^\d\. .*", (STUDY / "readme.md.in").read_text(), re.MULTILINE):
            self.assertNotIn("{{sets/", line)

    def test_the_rule_was_checked_against_the_program(self) -> None:
        self.assertGreaterEqual(tables.value("check/steps"), 5000)
        self.assertLess(tables.value("check/worst"), 1e-12)

    def test_points_are_those_of_the_variants(self) -> None:
        lines = [line for line in (STUDY / "points.csv").read_text().splitlines() if not line.startswith("#")]
        self.assertEqual(len(lines), 1 + len(make_points.VARIANTS) * len(discs.SCENES))
        defaults = list(make_points.DEFAULT.values())
        for variant, changes in enumerate(make_points.VARIANTS.values()):
            for disc, heights in enumerate(discs.SCENES):
                cells = lines[1 + variant * len(discs.SCENES) + disc].split(",")
                self.assertEqual(cells[0], heights)
                changed = sum(cell != default for cell, default in zip(cells[1:], defaults, strict=True))
                self.assertEqual(changed, len(changes))
