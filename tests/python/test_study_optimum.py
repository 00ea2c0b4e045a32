"""Optimum of responses: desirability, search, canonical analysis, expected improvement, runs at points of a study."""

import dataclasses
import inspect
import itertools
import json
import math
import unittest
import warnings
from unittest import mock

import numpy as np
import pandas
from checkout import QUICK, Folder
from made_studies import number, span, study_of, word
from matplotlib.colors import to_rgba
from scipy import stats

from plateau.errors import InputError, RunFailed
from plateau.study.data import Response
from plateau.study.goals import Goal, Limit, Problem, beyond_runs, expected_improvement, improved, overall
from plateau.study.optimum import canonical, optimize
from plateau.study.prediction import predict
from plateau.study.results import analysed
from plateau.study.runs import made_study, written
from plateau.style import APART
from plateau.units import quantity, unit_for

# A central composite design with three responses, and what the program before this package answered about it.
LIMITS_MEET = {
    "A": [0, 0, 0, -1, 1, -1, 0, 1, 1, -1],
    "B": [-1, 1, 0, -1, -1, 0, 0, 0, 1, 1],
    "gain": [3.9714657, 6.0253453, 5.0314383, 2.922013, 5.0164651, 3.9980913, 5.073694, 5.9844835, 7.0189114, 5.0544441],
    "cost": [2.8875415, 3.2536537, 3.0716994, 1.7554306, 3.7623278, 1.9931305, 2.9403494, 3.9839142, 4.1892893, 2.2493497],
    "risk": [1.0490076, 2.9217853, 2.0694868, 0.92275792, 1.1620449, 1.8782182, 2.076149, 2.084241, 3.0616457, 2.8808013],
}
RESPONSES = {"gain": "m3", "cost": "1", "risk": "1"}


class Known:
    """A surrogate that is a function of points."""

    def __init__(self, function, deviation=0.0):
        self.function, self.spread = function, deviation
        self.response = Response("y", "1", "y", "none", -math.inf, math.inf, {})

    def mean(self, points):
        return self.function(*(points[name.upper()].to_numpy() for name in inspect.signature(self.function).parameters))

    def deviation(self, points):
        return np.full(len(points), self.spread)


def problem(functions, goals, limits=(), axes=(None, None)):
    factors = [span(name) for name in "AB"[: len(axes)]]
    return Problem(study_of(factors, {"A": [0.0], "B": [0.0], "y": [0.0]}), functions, list(goals), list(limits), list(axes), 0.95)


class Desirability(unittest.TestCase):
    def test_by_hand(self):
        most, least, target = Goal("y", "maximize", (120, 170)), Goal("y", "minimize", (3, 1)), Goal("y", "target", (400, 500, 700))
        self.assertEqual(most.desirability([100, 120, 145, 170, 200]).tolist(), [0, 0, 0.5, 1, 1])
        self.assertEqual(least.desirability([0, 1, 2, 3]).tolist(), [1, 1, 0.5, 0])
        self.assertEqual(target.desirability([399, 425, 500, 550, 700, math.nan]).tolist(), [0, 0.25, 1, 0.75, 0, 0])
        goals = [Goal("a", "maximize", (0, 1), 1.0), Goal("b", "maximize", (0, 1), 3.0)]
        # (0.0625 * 0.5^3)^(1/4) = 2^(-7/4)
        self.assertAlmostEqual(float(overall(goals, [0.0625, 0.5])), 2**-1.75, places=15)
        self.assertEqual(float(overall(goals, [0.0, 1.0])), 0.0)

    def test_units_of_people(self):
        self.assertEqual([quantity(text, "m3", needs_unit=False) for text in ("1.5 mm3", "1.5 mm^3", "1.5 mm³")], [1.5e-9] * 3)
        self.assertEqual([quantity(text, si, needs_unit=False) for text, si in (("40 %", "1"), ("0.4", "1"), ("20 °C", "K"))], [0.4, 0.4, 293.15])
        self.assertEqual(unit_for("m2", 2e-6).text(2.0812e-6, 0.0996e-6), "2.08 ± 0.10 mm²")
        for text in ("1 mm", "one", "1 %"):
            with self.assertRaises(InputError):
                quantity(text, "m2", needs_unit=False)


class Search(unittest.TestCase):
    def test_a_bent_ridge_and_a_rim(self):
        goal = Goal("y", "maximize", (-10.0, 10.0))
        # Rosenbrock's function in the box: highest at (0.5, 0.25).
        best = problem({"y": Known(lambda a, b: -((a - 0.5) ** 2) - 100 * (b - a * a) ** 2)}, [goal]).best()
        np.testing.assert_allclose(best.to_numpy(), [[0.5, 0.25]], atol=1e-5)
        # Beyond the rim a = 1, there at b = -1.
        best = problem({"y": Known(lambda a, b: -((a - 2) ** 2) - (b + a) ** 2)}, [goal]).best()
        np.testing.assert_allclose(best.to_numpy(), [[1.0, -1.0]], atol=1e-6)

    def test_a_limit_is_met_where_a_lagrange_multiplier_says(self):
        # a + 2 b is largest on the circle a² + b² = 0.45 at (0.3, 0.6).
        functions = {"y": Known(lambda a, b: a + 2 * b), "z": Known(lambda a, b: a * a + b * b)}
        found = problem(functions, [Goal("y", "maximize", (-3.0, 3.0))], [Limit("z", False, 0.45, "mean", 1.0)]).best()
        np.testing.assert_allclose(found.to_numpy(), [[0.3, 0.6]], atol=2e-5)
        # It cannot be kept: the least that is missed.
        found = problem(functions, [Goal("y", "maximize", (-3.0, 3.0))], [Limit("z", False, -1.0, "mean", 1.0)]).best()
        np.testing.assert_allclose(found.to_numpy(), [[0.0, 0.0]], atol=1e-3)

    def test_levels_are_tried_one_by_one(self):
        asked = problem({"y": Known(lambda a, b: a * b)}, [Goal("y", "maximize", (-1.0, 1.0))], axes=([-1.0, 0.5], None))
        self.assertEqual(asked.best().to_numpy().tolist(), [[-1.0, -1.0]])

    def test_the_answers_of_the_program_before(self):
        given = study_of([span("A"), span("B")], LIMITS_MEET, "central-composite", responses=RESPONSES)
        given.runs["gain"] *= 1e-9
        limits = {"limit": ["cost<=3.1", "risk<=2.2"]}
        wide = {"minimize": ["cost", "risk"], "importance": "gain=2"}
        for goal, options, place, desirability in [
            ("gain", limits, [0.04053128181175647, 0.1633281024590958], 0.566368089556722),
            ("gain=4 mm3..6 mm3", wide, [0.3701921521886353, 0.10798442362379701], 0.5249308802607406),
            ("gain", {"hold": ["A=0.2", "B=-0.1"]}, [0.2, -0.1], 0.5393462077544413),
        ]:
            with self.subTest(goal):
                found = optimize(given, maximize=goal, **options)
                np.testing.assert_allclose(found.settings["value"].to_numpy(float), place, atol=2e-6)
                self.assertAlmostEqual(found.desirability, desirability, delta=1e-8)
                self.assertEqual([limit["holds_back"] for limit in found.document()["limits"]], [True] * len(options.get("limit", [])))
        self.assertNotIn("nothing new", found.text())
        process = dataclasses.replace(found.problem.surrogates["gain"], takes_process=True)
        asked = dataclasses.replace(found.problem, surrogates={"gain": process})
        said = dataclasses.replace(found, looked_for=4, problem=asked).text()
        self.assertRegex(said, "gain: a Gaussian process told where .*\n  nothing new was run")
        rounds = pandas.DataFrame({"expected_improvement": [0.25]})
        said = dataclasses.replace(found, looked_for=4, rounds=rounds, problem=asked).text()
        self.assertIn("1 point was run on the way, the last one expected to gain 0.25", said)
        found = optimize(given, maximize=["gain"], limit=["cost<=2", "risk>=3"], limit_on="means")
        self.assertEqual((found.keeps_limits, found.desirability), (False, 0.0))
        self.assertIn("they are missed least at", found.text())

    def test_optimum_and_prediction_have_one_region(self):
        # A rotatable design, with axial runs at √2: what is best lies on the circle of its runs, and there a prediction is made.
        far = math.sqrt(2.0)
        a, b = np.array([-1, 1, -1, 1, -far, far, 0, 0, 0]), np.array([-1, -1, 1, 1, 0, 0, -far, far, 0])
        for response, best in ((a, [far, 0.0]), (a + b, [1.0, 1.0]), (-((a - 0.5) ** 2) - (b + 0.2) ** 2, [0.5, -0.2])):
            given = study_of([span("A"), span("B")], {"A": a, "B": b, "y": response + 0.01 * np.cos(9 * a + b)}, "central-composite")
            found = optimize(given, maximize=["y"])
            np.testing.assert_allclose(found.settings["value"].to_numpy(float), best, atol=0.1)
            self.assertLessEqual(np.hypot(*found.settings["value"]), far + 1e-9)
            at = found.settings.set_index("factor")["value"].to_dict()
            self.assertAlmostEqual(predict(given, at).table["value"].iloc[0], found.table["value"].iloc[0], places=12)
            self.assertIn("A −1.414 … 1.414", found.text())
            self.assertEqual(found.document()["region"], predict(given, at).document()["region"])
        with self.assertRaisesRegex(InputError, "A and B are together farther from the middle than all runs"):
            predict(given, {"A": 1.3, "B": 1.3})


class Canonical(unittest.TestCase):
    def test_the_yield_of_montgomery(self):
        # D. C. Montgomery, Design and Analysis of Experiments, section 11-2: stationary point (0.389, 0.306), 80.21; -0.9635, -1.4143.
        def yields(x):
            a, b = x.T
            return 79.94 + 0.995 * a + 0.515 * b - 1.376 * a**2 - 1.001 * b**2 + 0.25 * a * b

        found = canonical(yields, 2)
        np.testing.assert_allclose(found["stationary"], [0.389, 0.306], atol=6e-4)
        np.testing.assert_allclose(found["eigenvalues"], [-1.4143, -0.9635], atol=5e-4)
        self.assertAlmostEqual(found["value"], 80.21, places=2)
        self.assertEqual(found["nature"], "maximum")

    def test_saddles_and_ridges(self):
        self.assertEqual(canonical(lambda x: x[:, 0] * x[:, 1], 2)["nature"], "saddle")
        self.assertEqual(canonical(lambda x: x[:, 0] ** 2 + x[:, 1], 2)["nature"], "ridge")
        self.assertEqual(canonical(lambda x: (x**2).sum(axis=1), 3)["nature"], "minimum")


class Improvement(unittest.TestCase):
    def test_the_closed_form(self):
        # The run at 0 has the mean 0 and, being known, no variance; elsewhere means are 0.3 a and deviations 0.5.
        class Half(Known):
            def deviation(self, points):
                return np.where(points["A"] == 0.0, 0.0, 0.5)

        asked = problem({"y": Half(lambda a: 0.3 * a)}, [Goal("y", "maximize", (0.0, 1.0))], axes=(None,))
        a = np.array([-1.0, 0.5, 1.0])
        z = 0.3 * a / 0.5
        expected = 0.5 * (z * stats.norm.cdf(z) + stats.norm.pdf(z))
        found = expected_improvement(asked, pandas.DataFrame({"A": a}))
        np.testing.assert_allclose(found, expected, rtol=0.01)
        # Only half of all responses keep a limit on the mean.
        asked = problem({"y": Half(lambda a: 0 * a), "z": Half(lambda a: 0 * a)}, asked.goals, [Limit("z", False, 0.0, "mean", 1.0)], (None,))
        self.assertAlmostEqual(expected_improvement(asked, pandas.DataFrame({"A": [1.0]}))[0], 0.25 * stats.norm.pdf(0.0), delta=0.01)

    def test_a_noisy_peak_is_found_in_few_runs(self):
        random, places = np.random.default_rng(4), np.linspace(-1.0, 1.0, 5)

        def values(a):
            return np.exp(-20 * (a - 0.35) ** 2) + 0.02 * random.standard_normal(len(a))

        a = np.repeat(places, 2)
        given = study_of([span("A")], {"A": a, "replicate": np.tile([1, 2], len(a) // 2), "y": values(a)}, "sobol")
        made = []

        def make(points):
            made.append(len(points))
            a = np.repeat(points["A"].to_numpy(), 2)
            return study_of([span("A")], {"A": a, "replicate": np.tile([1, 2], len(a) // 2), "y": values(a)}).runs

        goal = Goal("y", "maximize", (given.runs["y"].min(), given.runs["y"].max()), is_of_runs=True)
        found, rounds = improved(Problem(given, {}, [goal], [], [None], 0.95), 13, make, 2)
        self.assertLessEqual(sum(made), 6)
        self.assertEqual(len(rounds), sum(made))
        self.assertEqual(len(found.study.runs), 10 + 2 * sum(made))
        self.assertAlmostEqual(beyond_runs(found).best()["A"].iloc[0], 0.35, delta=0.06)
        with self.assertRaisesRegex(InputError, "one for each set of seeds"):
            improved(found, 1, make)

    def test_runs_are_made_between_levels_and_where_factors_are_held(self):
        # The peak lies at 9 between levels of 4, 8 and 12, and of the other factor at b.
        factors = [number("load", 4.0, 8.0, 12.0), word("pad", "a", "b")]

        def results(points):
            y = np.exp(-(((points["load"] - 9.0) / 4.0) ** 2)) - 0.5 * (points["pad"] == "a")
            return study_of(factors, points[["load", "pad"]].assign(y=y, z=y**2), responses={"y": "1", "z": "1"})

        given = results(pandas.DataFrame(itertools.product([4.0, 8.0, 12.0], "ab"), columns=["load", "pad"]))
        made = mock.patch("plateau.study.optimum.made_study", lambda study, points, **_: results(points))
        for hold, best in ([], [9.0, "b"]), (["pad=a"], [9.0, "a"]), (["load=6"], [6.0, "b"]):
            with self.subTest(hold), made:
                found = optimize(given, maximize=["y"], hold=hold, runs=4)
            load, pad = found.settings["value"]
            self.assertAlmostEqual(load, best[0], delta=0.0 if hold == ["load=6"] else 0.3)
            self.assertEqual(pad, best[1])
            self.assertGreater(len(found.rounds), 0)
            self.assertTrue(np.isfinite(found.table["confirmed"]).all())
            # The answer is drawn and told with all its responses.
            self.assertIn("z", found.text())
            self.assertIn("profiler", found.figures())


class Wishes(unittest.TestCase):
    def test_what_may_be_chance_is_said(self):
        random = np.random.default_rng(4)
        runs = pandas.DataFrame(np.repeat(list(itertools.product((-1.0, 0.0, 1.0), repeat=2)), 2, axis=0), columns=["A", "B"])
        # What sets of seeds add everywhere is no effect of a factor.
        for seeds in (0.0, 9.0):
            y = random.normal(size=18) + np.tile([0.0, seeds], 9)
            study = study_of([span("A"), span("B")], runs.assign(y=y, **({"replicate": np.tile([1, 2], 9)} if seeds else {})), "csv")
            self.assertTrue(any("may be chance" in said for said in optimize(study, maximize=["y"]).cautions))
        sure = study_of([span("A"), span("B")], runs.assign(y=5.0 * runs["A"] + random.normal(size=18)), "csv")
        self.assertFalse(any("may be chance" in said for said in optimize(sure, maximize=["y"]).cautions))

    def test_where_limits_leave_one_place_the_profiler_shows_it(self):
        # y <= 0.31 and z >= 0.31, which both are A: nothing else on the line keeps both, and no place of an even grid does.
        runs = pandas.DataFrame({"A": np.linspace(-1.0, 1.0, 9)}).assign(y=lambda runs: runs["A"], z=lambda runs: runs["A"])
        found = optimize(study_of([span("A")], runs, "csv", responses={"y": "1", "z": "1"}), maximize=["y=-1..1"], limit=["y<=0.31", "z>=0.31"])
        self.assertTrue(found.keeps_limits)
        whole, kept, best = found.figures()["profiler"].axes[-1].lines[:3]
        self.assertEqual(np.isfinite(kept.get_ydata()).sum(), 1)
        self.assertEqual((best.get_xdata()[0], best.get_ydata()[0]), (found.settings["value"][0], np.nanmax(kept.get_ydata())))
        np.testing.assert_allclose(whole.get_ydata(), (1.0 + np.asarray(whole.get_xdata())) / 2.0, atol=1e-9)

    def test_the_star_is_where_limits_are_kept(self):
        # A + B is largest where B = 0.33 - A² has a slope of -1; that limit is between places of an even grid.
        places = pandas.DataFrame(list(itertools.product((-1.0, 0.0, 1.0), repeat=2)), columns=["A", "B"])
        runs = places.assign(y=places["A"] + places["B"], z=places["A"] ** 2 + places["B"])
        found = optimize(study_of([span("A"), span("B")], runs, "csv", responses={"y": "1", "z": "1"}), maximize=["y"], limit=["z<=0.33"])
        np.testing.assert_allclose(found.settings["value"].astype(float), [0.5, 0.08], atol=1e-6)
        areas = [one for one in found.figures()["contour"].axes[0].collections if one.filled]
        missed, shown = ([one for one in areas if (one.get_facecolor()[0] == to_rgba(APART)).all() == is_grey] for is_grey in (True, False))
        for a in np.linspace(-0.9, 0.9, 37):
            inside, outside = ((a, 0.33 - a**2 + away) for away in (-1e-3, 1e-3))
            self.assertTrue(any(path.contains_point(inside) for one in shown for path in one.get_paths()), a)
            self.assertEqual(
                [any(path.contains_point(at) for one in missed for path in one.get_paths()) for at in (inside, outside)], [False, True], a
            )

    def test_goals_that_exclude_each_other_are_in_the_table(self):
        runs = pandas.DataFrame({"A": np.linspace(-1.0, 1.0, 9)}).assign(y=lambda runs: runs["A"], z=lambda runs: runs["A"])
        found = optimize(study_of([span("A")], runs, "csv", responses={"y": "1", "z": "1"}), maximize=["y=0.5..1"], minimize=["z=-1..0"])
        self.assertIn("a goal is worth nothing wherever the others are worth something: give wider values", found.text())
        self.assertTrue(found.table["cautions"].str.startswith("a goal is worth nothing wherever").all())

    def test_what_cannot_be_wanted(self):
        given = study_of([span("A"), span("B", unit="N", study_unit="N")], LIMITS_MEET, "central-composite", responses=RESPONSES)
        for options, message in [
            ({}, "no goal"),
            ({"maximize": ["gain"], "minimize": ["gain"]}, "two goals"),
            ({"maximize": ["pain"]}, "there is none of this name, expected one of 'gain'"),
            ({"maximize": ["gain=2 mm3..1 mm3"]}, "ascend"),
            ({"target": ["cost"]}, "NAME=VALUE"),
            ({"target": ["cost=9"]}, "LOW..VALUE..HIGH"),
            ({"maximize": ["gain"], "limit": ["cost=2"]}, "<="),
            ({"maximize": ["gain"], "limit": ["gain<=5"]}, 'limit "gain<=5": "5", expected text with a unit, such as "1 m3"'),
            ({"maximize": ["cost=inf..3"]}, 'maximize "cost=inf..3": "inf", expected a number'),
            ({"maximize": ["gain"], "importance": ["gain=0"]}, "between 0.01 and 100"),
            ({"maximize": ["gain"], "importance": ["cost=1"]}, "'gain'"),
            ({"maximize": ["gain"], "hold": ["A=2"]}, "beyond"),
            ({"maximize": ["gain"], "hold": ["B=1 m"]}, "N"),
        ]:
            with self.subTest(options), self.assertRaisesRegex(InputError, message):
                optimize(given, **options)


class Runs(Folder):
    STUDY = """
version = 1
base = {base}
set = ["operation.duration = '2 s'", "output.sample_every = '0.5 s'", "plateaus.debris = 'contact'", "plateaus.captured_fraction = 0.06"]
design = "full-factorial"
replicates = {{ keys = ["disc.surface.synthetic.seed"], seeds = [1, 2] }}
[[factor]]
name = "speed"
key = "operation.rotational_speed"
range = ["425 rpm", "850 rpm"]
[[factor]]
name = "debris"
key = "plateaus.debris"
levels = ["contact", "track"]
[[response]]
name = "area"
dataset = "/series/contact_area_mean"
at = "end"
[[response]]
name = "elsewhere"
imported = true
"""

    def setUp(self):
        super().setUp()
        self.path = self.folder / "study.toml"
        self.path.write_text(self.STUDY.format(base=json.dumps(str(QUICK))))

    def test_runs_are_made_once_and_are_those_of_the_study(self):
        with warnings.catch_warnings(action="ignore"):
            given = analysed(self.path)
            points = pandas.DataFrame({"speed": [50.0, given.runs["speed"].iloc[0]], "debris": ["track", "contact"]})
            made = made_study(given, points, jobs=2).runs
            times = {file: file.stat().st_mtime_ns for file in (self.path.parent / "study" / "journal").iterdir()}
            again = made_study(given, points).runs
            self.assertEqual(times, {file: file.stat().st_mtime_ns for file in (self.path.parent / "study" / "journal").iterdir()})
            now = analysed(self.path)
        self.assertEqual(made.to_csv(), again.to_csv())
        self.assertEqual(made["point"].tolist(), [1, 1, 2, 2])
        self.assertEqual(made["speed"].tolist()[:2], [50.0] * 2)
        self.assertTrue(np.isfinite(made["area"]).all() and made["elsewhere"].isna().all())
        # The runs of the second point are runs of the study.
        same = (now.runs["speed"] == points["speed"][1]) & (now.runs["debris"] == "contact")
        self.assertEqual(now.runs.loc[same, "area"].tolist(), made["area"].tolist()[2:])
        self.assertEqual(now.runs["state"].value_counts()["finished"], 2)

    def test_what_cannot_be_run(self):
        with warnings.catch_warnings(action="ignore"):
            given = analysed(self.path)
        for points, message in [
            (pandas.DataFrame({"speed": [-1.0], "debris": ["contact"]}), "study.toml: .* cannot be made"),
            (pandas.DataFrame({"speed": [50.0]}), "debris"),
            (pandas.DataFrame({"speed": [], "debris": []}), "points"),
        ]:
            with self.subTest(message), self.assertRaisesRegex((InputError, RunFailed), message):
                made_study(given, points)
        with self.assertRaisesRegex(InputError, "without its study file"):
            made_study(study_of([span("A")], LIMITS_MEET, responses={}), pandas.DataFrame({"A": [0.0]}))

    def test_values_are_written_with_the_digits_that_give_them(self):
        speed = span("speed", unit="rad/s", one=2 * math.pi / 60, study_unit="rpm")
        self.assertEqual(written(speed, 425 * (2 * math.pi / 60)), "425 rpm")
        for value in (50.0, 1 / 3, 44.50589592585541):
            self.assertEqual(float(written(speed, value).split()[0]) * (2 * math.pi / 60), value)
        self.assertEqual([written(span("n", whole=True), 20.0), written(speed, "none")], ["20", "none"])

    def test_an_optimum_is_confirmed_by_its_runs(self):
        with warnings.catch_warnings(action="ignore"):
            made_study(analysed(self.path), analysed(self.path).runs.drop_duplicates("point"))
            found = optimize(self.path, maximize=["area"], hold=["speed=600 rpm"], confirm=True)
        row = found.table.set_index("response").loc["area"]
        self.assertEqual(row["confirmed_runs"], 2)
        document = json.loads(json.dumps(found.document()))
        self.assertEqual(document["confirmed"][0]["runs"], 2)
        self.assertAlmostEqual(document["settings"][0]["number"], 600 * 2 * math.pi / 60)
        self.assertIn("speed = 600 rpm", found.text())
