"""Forecasts of studies: the Gaussian process, which surrogate is taken, predictions, and parts of the variance."""

import contextlib
import io
import itertools
import json
import os
import runpy
import tempfile
import unittest
import unittest.mock
import warnings
from pathlib import Path

import checkout  # noqa: F401, for the folders of modules
import forecasts
import numpy as np
import pandas
from effects import cube
from made_studies import number, span, stored, study_of, word
from scipy import stats

from plateau.errors import InputError
from plateau.study import variance_parts
from plateau.study.analysis import effects
from plateau.study.level_differences import levels
from plateau.study.optimum import optimize
from plateau.study.prediction import predict
from plateau.study.process import Equations, Process
from plateau.study.surrogate import surrogates
from plateau.study.variance_parts import sensitivity

HERE = Path(__file__).parent
# Values of scikit-learn's GaussianProcessRegressor and of DiceKriging (R).
REFERENCES = json.loads((HERE / "expected" / "processes.json").read_text(encoding="utf-8"))


class ProcessTest(unittest.TestCase):
    def test_given_lengths_agree_with_scikit_learn_and_dicekriging(self):
        for case in REFERENCES["processes"]:
            x, y = np.array(case["points"]), np.array(case["responses"])
            logs = np.log([*case["lengths"], case["noise"]])[None]
            found = Equations(x, y, np.ones(len(y)), (0.0, 0), logs, np.arange(x.shape[1]))
            variance = found.square / len(y)
            likelihood = -0.5 * (len(y) * (np.log(2.0 * np.pi * variance) + 1.0) + found.log_determinant)
            weights, shares = found.forecast(np.array(case["new"]))
            left_out = np.array(case["left_out"])
            # The equations of the worst case have a condition of 1e7.
            for what, value, expected in (
                ("likelihood", likelihood[0], case["log_likelihood"]),
                ("variance", variance[0], case["variance"]),
                ("means", (weights @ y)[0], case["means"]),
                ("variances", (variance * shares)[0], case["variances"]),
                ("left out", y - found.left_out()[0][0], left_out[:, 0]),
                ("their variances", variance[0] / np.diag(found.inverse[0]), left_out[:, 1]),
            ):
                with self.subTest(case["name"], what=what):
                    np.testing.assert_allclose(value, expected, rtol=1e-8, atol=1e-11 * np.abs(expected).max())

    def test_replicates_are_as_likely_as_all_their_runs(self):
        case = REFERENCES["replicates"]
        y = np.array(case["responses"])
        process = Process(np.repeat(case["points"], y.shape[1], axis=0), y.ravel(), np.tile(np.arange(y.shape[1]), len(y)))
        found = process.solved(logs=np.log([*case["lengths"], case["noise"]]))
        variance = found.square[0] / (found.freedom + 1)
        likelihood = -0.5 * ((found.freedom + 1) * (np.log(2.0 * np.pi * variance) + 1.0) + found.log_determinant[0])
        np.testing.assert_allclose([variance, likelihood], [case["variance"], case["log_likelihood"]], rtol=1e-8)

    def test_slopes_are_differences(self):
        x = np.array(np.meshgrid(np.linspace(-1, 1, 5), np.linspace(-1, 1, 4))).reshape(2, -1).T
        y, at, step = x[:, 0] ** 2 + x[:, 1] + 0.1 * np.sin(9.0 * x[:, 0]), np.log([[0.8, 1.7, 0.02]]), 1e-5 * np.eye(3)

        def solved(logs):
            return Equations(x, y, np.full(20, 1 / 3), (0.1, 38), logs, np.arange(2))

        difference = (solved(at + step).log_density - solved(at - step).log_density) / 2e-5
        np.testing.assert_allclose(solved(at).gradient()[0], difference, rtol=1e-6, atol=1e-6)

    def test_means_and_seeds_by_hand(self):
        # y = m + b exactly, so that the means come out whichever run is missing: 10, 20, 40 and -3, 0, 3.
        point, seed = np.array([0, 0, 1, 1, 2, 2, 2]), np.array([0, 1, 1, 2, 0, 1, 2])
        process = Process(point[:, None] - 1.0, np.array([10.0, 20.0, 40.0])[point] + np.array([-3.0, 0.0, 3.0])[seed], seed)
        np.testing.assert_allclose(process.means, [10.0, 20.0, 40.0], rtol=1e-9)
        # The variance of the seeds is 9.
        np.testing.assert_allclose(process.moments([[0.3]])[2], 9.0, rtol=1e-3)

    def test_pure_chance_is_not_foretold(self):
        foretold = 0
        for seed in range(24):
            random = np.random.default_rng(seed)
            y = random.uniform(-1.0, 1.0, 12)
            error, _ = Process(random.uniform(-1.0, 1.0, (12, 2)), y).loo
            foretold += (error**2).mean() < 0.9 * y.var()
        self.assertLessEqual(foretold, 3)

    def test_words_are_indicators(self):
        random = np.random.default_rng(3)
        word, x = random.integers(0, 3, 40), random.uniform(-1.0, 1.0, 40)
        indicators = np.eye(3)[word]
        y = np.sin(2.0 * x) + np.array([0.0, 1.0, 5.0])[word]
        process = Process(np.column_stack([x, indicators]), y, axes=[0, 1, 1, 1])
        self.assertLess(np.abs(process.moments([[0.2, 0, 0, 1.0], [0.2, 1.0, 0, 0]])[0] - np.sin(0.4) - [5.0, 0.0]).max(), 0.1)

    @unittest.skipUnless("PLATEAU_LONG" in os.environ, "a simulation, of 120 fits")
    def test_intervals_cover_the_truth(self):
        # Places of one function are alike: forty functions leave a standard error of 1 to 1.5 %.
        for study in (("very smooth", 2, 10, 2), ("comes to an end", 4, 20, 2), ("smooth", 3, 15, 1)):
            means, runs = forecasts.process_coverage(*study, 40)
            self.assertTrue(0.915 < means < 0.985 and 0.915 < runs < 0.985, (study, means, runs))


class PredictionTest(unittest.TestCase):
    def test_values_are_those_of_the_program_before(self):
        for case in json.loads((HERE / "expected" / "predictions.json").read_text(encoding="utf-8")):
            study = stored(case)
            for call in case["calls"]:
                with self.subTest(case["name"], arguments=call["arguments"]):
                    found = quietly(predict, study, **options(call["arguments"])).document()
                    self.assertEqual(found["models"], call["models"])
                    for place, expected in zip(found["places"], call["places"], strict=False):
                        numbers = [setting["number"] for setting in place["settings"]]
                        self.assertEqual([number is None for number in numbers], [number is None for number in expected["numbers"]])
                        values = [response["value"] for response in place["responses"]]
                        same = [(a, b) for a, b in zip(numbers + values, expected["numbers"] + expected["values"], strict=True) if b is not None]
                        np.testing.assert_allclose(*zip(*same, strict=True), rtol=1e-8)
                        self.assertEqual(bool(place["beyond"]), bool(expected["beyond"]))

    def test_intervals_of_a_straight_line_by_hand(self):
        # Two replicates at -1, 0 and 1, without sets of seeds: the line is exact but for +-1, so that the error of the mean at 0 is
        # the pure error, 2, over 6, with what points differ from the line beyond that: nothing.
        x = np.repeat([-1.0, 0.0, 1.0], 2)[:, None]
        study = forecasts.study_of(x, 5.0 + 3.0 * x[:, 0] + np.tile([-1.0, 1.0], 3), design="full-factorial")
        (row,) = quietly(predict, study, {"x1": 0.0}, model="main").table.to_dict("records")
        self.assertAlmostEqual(row["value"], 5.0)
        self.assertAlmostEqual(row["mean_high"] - 5.0, stats.t.ppf(0.975, 3) * (2.0 / 6.0) ** 0.5, places=9)
        self.assertAlmostEqual(row["leverage"], 1.0 / 3.0)

    def test_one_degree_of_freedom_is_that_of_student(self):
        # Four corners and a plane: the interval of one more run is that of textbooks, with one set of seeds that of the mean, too, for the
        # residual may be what the plane misses.
        runs = cube(1, 2).assign(y=[1.0, 2.0, 4.0, 7.0])
        (row,) = quietly(predict, study_of([span("A"), span("B")], runs), {"A": 0.5, "B": 0.0}, model="main").table.to_dict("records")
        # The residuals are ±0.5.
        reach = stats.t.ppf(0.975, 1) * (1.0 + 0.25 + 0.25 * 0.5**2) ** 0.5
        self.assertAlmostEqual(row["value"], 3.5 + 0.5 * 2.0, places=9)
        for of in ("mean", "run"):
            self.assertAlmostEqual(row[f"{of}_high"] - row["value"], reach, places=9)
            self.assertAlmostEqual(row["value"] - row[f"{of}_low"], reach, places=9)

    def test_one_more_run_is_as_far_away_as_those_that_tell_of_it(self):
        # Of a mean and one more value: t(n - 1) s sqrt(1 + 1/n), be it of five sets of seeds that differ as a whole, or of runs of one set.
        of_set = np.array([3.0, -1.0, 0.5, 2.0, -4.0])
        runs = cube(5, 2)
        runs["y"] = runs["A"] + of_set[runs["replicate"] - 1] + 1e-4 * np.random.default_rng(1).standard_normal(20)
        expected = stats.t.ppf(0.975, 4) * of_set.std(ddof=1) * 1.2**0.5
        twice = pandas.concat([cube(1, 2)] * 2).assign(y=[1.0, 2.0, 4.0, 7.0, 1.5, 3.0, 2.0, 7.0])
        # Pairs differ by 0.5, 1, 2 and 0.
        scatter = (0.5 * (0.5**2 + 1.0**2 + 2.0**2) / 4.0) ** 0.5
        for columns, reach in ((runs, expected), (twice, stats.t.ppf(0.975, 4) * scatter * (1.0 + 1.0 / 8.0) ** 0.5)):
            (row,) = quietly(predict, study_of([span("A"), span("B")], columns), {"A": 0.0, "B": 0.0}).table.to_dict("records")
            self.assertAlmostEqual((row["run_high"] - row["run_low"]) / 2.0 / reach, 1.0, places=3)

    def test_few_points_and_sets_that_differ_cover_one_more_run(self):
        for case in ((1, 1, 0.0), (2, 1, 0.0), (1, 3, 3.0)):
            means, runs = forecasts.straight_coverage(*case, 200)
            # Two places of a simulation are alike: a standard error of 1.5 %.
            self.assertTrue(means > 0.92 and 0.91 < runs < 0.985, (case, means, runs))

    def test_extrapolation_is_refused_and_cautioned(self):
        random = np.random.default_rng(0)
        x = random.uniform(-1.0, 1.0, (20, 2))
        x = x[np.abs(x.sum(1)) < 1.0]
        study = forecasts.study_of(x, x.sum(1) + 0.1 * random.standard_normal(len(x)))
        with self.assertRaisesRegex(InputError, "x1 is beyond −1 to 1"):
            predict(study, ["x1=1.5"])
        far = predict(study, {"x1": 1.5}, extrapolate=True)
        self.assertEqual(far.table["beyond"].tolist(), ["x1 is beyond −1 to 1"])
        # A corner is in the box, and far from all runs.
        corner = predict(study, {"x1": 1.0, "x2": 1.0}, model="main")
        self.assertIn("extrapolation", corner.table["cautions"][0])
        for said in (corner.text(), json.dumps(corner.document()), corner.wide.to_csv(), corner.table.to_csv()):
            self.assertIn("extrapolation", said)

    def test_tables_words_and_units(self):
        random = np.random.default_rng(1)
        x, words = random.uniform(-1.0, 1.0, (30, 1)), random.choice(["fine", "coarse"], 30)
        study = forecasts.study_of(x, x[:, 0] + (words == "fine") + 0.1 * random.standard_normal(30), words=words)
        by_frame = predict(study, points=pandas.DataFrame({"x1": [0.5, -0.5], "w": ["fine", "coarse"]}))
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "points.csv"
            path.write_text("x1,w\n0.5,fine\n-0.5,coarse\n", encoding="utf-8")
            by_file = predict(study, points=path)
        pandas.testing.assert_frame_equal(by_frame.table, by_file.table)
        self.assertLess(np.abs(by_frame.table["value"] - [1.5, -0.5]).max(), 0.2)
        self.assertEqual(len(predict(study, ["w=fine"], grid=3).places), 3)
        for wrong, message in (
            ({"w": "rough"}, "expected one of coarse, fine"),
            ({"load": 1}, "not a factor"),
            (["x1=a lot"], "expected a plain number"),
        ):
            with self.assertRaisesRegex(InputError, message):
                predict(study, wrong)

    def test_the_better_one_is_taken(self):
        random = np.random.default_rng(2)
        x = random.uniform(-1.0, 1.0, (30, 2))
        noise = 0.05 * random.standard_normal(30)
        for response, is_process in ((x[:, 0] - x[:, 1] ** 2, False), (np.sin(4.0 * x[:, 0]) * np.exp(x[:, 1]), True)):
            (found,) = surrogates(forecasts.study_of(x, response + noise))
            self.assertEqual(found.takes_process, is_process)
            self.assertIn("the smaller one is taken", found.reason)
            points = pandas.DataFrame({"x1": [0.1, 0.9], "x2": [0.2, -0.4]})
            told = found.forecast(points)
            self.assertTrue((told["mean_low"] < told["value"]).all() and (told["run_high"] >= told["mean_high"]).all())
            np.testing.assert_allclose(found.response.back(found.mean(points)), told["value"])

    def test_intervals_cover_where_the_polynomial_cannot_represent_the_function(self):
        (polynomial, _), (count, _) = forecasts.surrogate_coverage("product of powers", 2, 12, 3, 24)
        # Some 250 places of 10 functions: a standard error of 2 to 3 %.
        self.assertGreater(count, 5)
        self.assertGreater(polynomial.min(), 0.89)


class SensitivityTest(unittest.TestCase):
    def setUp(self):
        # Enough for what is told here, in less time.
        fewer = unittest.mock.patch.object(variance_parts, "FUNCTIONS", 30)
        fewer.start()
        self.addCleanup(fewer.stop)

    def test_elementary_effects_agree_with_salib(self):
        case = REFERENCES["morris"]
        study = forecasts.study_of(2.0 * np.array(case["points"]) - 1.0, np.array(case["responses"]), design="morris")
        study.runs["point"] = np.arange(1, len(study.runs) + 1)
        table = sensitivity(study).table
        for name, expected in (("mean_size", "mean_sizes"), ("mean", "means"), ("deviation", "deviations")):
            np.testing.assert_allclose(table[name], case[expected], rtol=1e-8)

    def test_a_straight_line_in_closed_form(self):
        # Parts of the variance of 3 a + b are 9/10 and 1/10; the word adds a quarter of the square of its step to 10/3.
        random = np.random.default_rng(4)
        x, words = random.uniform(-1.0, 1.0, (40, 2)), np.array(["a", "b"] * 20)
        y = 3.0 * x[:, 0] + x[:, 1] + 2.0 * (words == "b") + 0.01 * random.standard_normal(40)
        found = sensitivity(forecasts.study_of(x, y, words=words))
        expected = np.array([3.0, 1.0 / 3.0, 1.0]) / (10.0 / 3.0 + 1.0)
        np.testing.assert_allclose(found.table["total"], expected, atol=0.02)
        self.assertAlmostEqual(found.variances["y"], 10.0 / 3.0 + 1.0, delta=0.1)

    def test_one_factor_without_an_error_has_all_of_the_variance(self):
        table = sensitivity(forecasts.study_of(np.array([[-1.0], [1.0]]), np.array([2.0, 3.0]), design="csv")).table
        np.testing.assert_allclose(table[["first_order", "total"]], [[1.0, 1.0]], atol=1e-6)
        self.assertTrue(table[["total_low", "total_high"]].isna().all().all())

    def test_what_the_runs_do_not_tell_is_wide(self):
        # Pure chance: no factor is ruled out.
        random = np.random.default_rng(5)
        table = sensitivity(forecasts.study_of(random.uniform(-1.0, 1.0, (12, 3)), random.standard_normal(12))).table
        self.assertTrue((table["total_high"] - table["total_low"] > 0.3).all(), table)

    def test_a_threshold_is_cautioned(self):
        # Coverage of totals there is 66 to 88 % (coverage/forecasts.py), for what is drawn is smooth.
        x = np.random.default_rng(7).uniform(-1.0, 1.0, (20, 2))
        found = sensitivity(forecasts.study_of(x, np.sign(x.sum(1) - 0.1)))
        self.assertIn("a threshold or a kink", found.text())
        self.assertIn("a threshold or a kink", " ".join(found.document()["cautions"]))
        self.assertTrue(found.table["cautions"].str.contains("points that were left out are missed by").all())
        smooth = sensitivity(forecasts.study_of(x, x[:, 0] + 0.5 * x[:, 1]))
        self.assertNotIn("threshold", smooth.text())

    def test_what_an_effect_differs_by_between_seeds_is_in_the_interval(self):
        # Without noise: slopes of 0.7, 1 and 1.3 have the mean 1 +- 4.303 * 0.3 / sqrt(3); the index of a slope b beside one of 1 is b^2 / (b^2 + 1).
        x = np.repeat([[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [0.0, 0.0]], 3, axis=0)
        group = np.tile([0, 1, 2], 5)
        study = forecasts.study_of(x, np.array([0.7, 1.0, 1.3])[group] * x[:, 0] + x[:, 1], group, "csv")
        with unittest.mock.patch.object(variance_parts, "FUNCTIONS", 400):
            row = sensitivity(study).table.iloc[0]
        ends = 1.0 + np.array([-1.0, 1.0]) * stats.t.ppf(0.975, 2) * 0.3 / 3**0.5
        expected = ends**2 / (ends**2 + 1.0)
        # The ends are quantiles of 400 functions: of Student's t with two degrees of freedom one is known to 0.7 of its unit, 0.06 of the index.
        self.assertLess(abs(row["first_order_low"] - expected[0]), 0.12)
        self.assertLess(abs(row["first_order_high"] - expected[1]), 0.12)

    def test_seeds_have_a_part(self):
        # The function has a variance of 1/3, chance 0.25: seeds have 0.43 of the variance of a run.
        random = np.random.default_rng(6)
        x = np.repeat(np.linspace(-1.0, 1.0, 12), 4)[:, None]
        found = sensitivity(forecasts.study_of(x, x[:, 0] + 0.5 * random.standard_normal(48), np.tile([1, 2, 3, 4], 12)))
        seeds = found.table[found.table["factor"] == "seeds"].iloc[0]
        self.assertTrue(seeds["total_low"] < 0.4286 < seeds["total_high"] < seeds["total_low"] + 0.5)
        self.assertIn("seeds (of single runs)", found.text())
        self.assertEqual(found.document()["responses"][0]["seeds"]["value"], seeds["total"])

    def test_a_factor_that_never_varied_has_no_part(self):
        runs = cube(3, 2)
        runs["y"] = runs["A"] + 0.05 * np.random.default_rng(8).standard_normal(12)
        runs.loc[runs["B"] > 0, "y"] = np.nan
        study = study_of([span("A"), span("B")], runs)
        found = quietly(sensitivity, study)
        rows = found.table.set_index("factor")
        self.assertTrue(rows.loc["B", ["first_order", "total", "total_low"]].isna().all())
        self.assertAlmostEqual(rows.loc["A", "total"], 1.0, places=6)
        few = "6 of 12 runs have no value of it; as many coefficients as points"
        self.assertEqual(rows["cautions"].tolist(), [f"no curve of A; {few}", f"not told by the runs; {few}", few])
        said = " ".join(found.document()["cautions"])
        self.assertIn("y: no parts of B: the runs have one value of it", said)
        self.assertIn("parts of the others are those at B = −1", said)
        for b, is_told in ((-1.0, True), (0.0, False)):
            table = quietly(predict, study, {"A": 0.0, "B": b})
            self.assertEqual(table.table["mean_low"].notna().all(), is_told)
            self.assertIn("A: the runs have two values of it", table.text())
        # Nothing else is left where both change together.
        runs = pandas.DataFrame({"A": [-1.0, 1.0] * 4, "B": [-1.0, 1.0] * 4, "y": np.random.default_rng(9).standard_normal(8)})
        both = quietly(sensitivity, study_of([span("A"), span("B")], runs))
        self.assertTrue(both.table["total"].isna().all())
        self.assertIn("no parts of A, B", both.text())

    def test_two_values_of_a_range_are_said(self):
        # The part of exp(2 A) beside 2 B is 0.726; that of the line between its ends is sinh(2)²/(sinh(2)² + 4) = 0.767.
        runs = cube(2)
        runs["y"] = np.exp(2.0 * runs["A"]) + 2.0 * runs["B"] + 1e-3 * np.random.default_rng(8).standard_normal(16)
        found = quietly(sensitivity, study_of([span(name) for name in "ABC"], runs))
        self.assertAlmostEqual(found.table["total"][0], 0.767, places=3)
        self.assertIn("no curve of A, B, C: the runs have two values of each", found.text())
        self.assertIn("no curve of A, B, C", found.document()["cautions"][0])
        numbers = quietly(sensitivity, study_of([number(name, -1.0, 1.0) for name in "ABC"], runs))
        self.assertNotIn("no curve of", numbers.text())


class CautionsOfTables(unittest.TestCase):
    def test_every_table_has_what_the_text_warns_of(self):
        runs = cube(2)
        runs["y"] = runs["A"] - runs["B"] + 0.1 * np.random.default_rng(8).standard_normal(16)
        study = study_of([span(name) for name in "ABC"], runs)
        found = [quietly(effects, study), quietly(predict, study, {"A": 0.0, "B": 0.0, "C": 0.0}), quietly(optimize, study, maximize=["y"])]
        for answer in found:
            self.assertIn("few points: 8 for 7 coefficients", answer.text())
            self.assertTrue(answer.table["cautions"].str.contains("few points; two sets of seeds").all(), answer.table["cautions"].tolist())
        self.assertTrue(found[1].table["cautions"].str.startswith("no curve of A, B, C; ").all())
        # Pure chance, whose largest value is nowhere sure, in polynomials and in processes.
        corners = pandas.DataFrame(np.repeat(list(itertools.product((-1.0, 0.0, 1.0), repeat=2)), 3, axis=0), columns=["A", "B"])
        for seed, design in ((6, "central-composite"), (6, "latin-hypercube")):
            given = corners.assign(y=np.random.default_rng(seed).normal(size=27), replicate=np.tile([1, 2, 3], 9))
            chance = study_of([span("A"), span("B")], given, design)
            for answer in (quietly(predict, chance, {"A": 0.3}), quietly(optimize, chance, maximize=["y"])):
                told = "the runs do not show that any factor has an effect"
                self.assertIn(told, answer.text())
                self.assertIn(told, " ".join(answer.cautions))
                self.assertIn(told, " ".join(answer.document()["cautions"]))
                self.assertTrue(answer.table["cautions"].str.contains(told).all(), answer.table["cautions"].tolist())
        words = runs.assign(pad=np.resize(["p", "q", "r"], 16))[["pad", "replicate", "y"]]
        table = quietly(levels, study_of([word("pad", "p", "q", "r")], words)).table
        self.assertTrue(table["cautions"].str.contains("as many coefficients as points").all())


def options(arguments):
    """Options of the command line as arguments of the function."""
    found = {"at": []}
    for name, value in itertools.pairwise([*arguments, ""]):
        if name == "--at":
            found["at"].append(value)
        elif name.startswith("--"):
            value = {"--grid": int, "--confidence": float, "--extrapolate": bool}.get(name, str)(value or True)
            found[name[2:]] = True if name == "--extrapolate" else value
    return found


def quietly(function, *arguments, **options):
    """Calls a function without its warnings."""
    with warnings.catch_warnings(action="ignore"):
        return function(*arguments, **options)


class Coverage(unittest.TestCase):
    def test_the_page_has_the_tables_of_the_command(self):
        # All but the numbers, which take half an hour.
        made, both, said = runpy.run_path(str(HERE / "coverage" / "__main__.py")), np.array([0.95, 0.95]), io.StringIO()
        numbers = {
            "effects": {"simulated": both[None], "levels_simulated": 0.95, "lacks": 0.05},
            "forecasts": {"process_coverage": both, "surrogate_coverage": ([both, both], [100, 100]), "straight_coverage": both},
            "fit": {"coverage": (0.95, 0.95, 0.0), "budgets": (4, 0, [])},
        }
        numbers["forecasts"] |= {"sensitivity_coverage": both, "seeds_coverage": 0.95}
        numbers["effects"]["of_runs"] = pandas.DataFrame({"seeds": [2], "over all seeds": 0.95})
        with contextlib.ExitStack() as patched, contextlib.redirect_stdout(said):
            for module, functions in numbers.items():
                for name, value in functions.items():
                    patched.enter_context(unittest.mock.patch.object(made[module], name, return_value=value))
                made[f"of_{module}"]()
        page = (HERE.parents[1] / "docs" / "study.md").read_text(encoding="utf-8")
        page, command = (
            [line.split(" | ")[0] for line in text.splitlines() if line.startswith("| ")]
            for text in (page[page.index("## How answers are computed") :], said.getvalue())
        )
        self.assertEqual(page, command)
