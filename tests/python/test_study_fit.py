"""Fits to experiments: intervals against closed forms, runs at the most likely place, coverage in artificial experiments."""

import unittest
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pandas
from checkout import QUICK, Folder
from scipy import stats

# isort: split
import fit as experiments

from plateau.errors import InputError
from plateau.study.calibration import calibrated
from plateau.study.data import Factor, Response
from plateau.study.fit_answer import Fit
from plateau.study.fit_of_study import fit, plan
from plateau.study.imports import import_values
from plateau.study.likelihood import Components, Likelihood, Runs, Target, products, profile
from plateau.study.measured import Measurement
from plateau.study.results import analysed

PLAIN = Response("", "1", "", "none", -np.inf, np.inf, {})


def value(number, uncertainty):
    return Measurement(PLAIN, np.array([]), np.array([number]), np.array([uncertainty]), 0.0, "")


def places(count, keys):
    return 2.0 * stats.qmc.Sobol(keys, scramble=False).random(count) - 1.0


class LikelihoodTest(unittest.TestCase):
    def interval(self, likelihood, key=0):
        ((low, high),) = profile(likelihood, key, stats.chi2.ppf(0.95, 1))[2]
        return (low + high) / 2.0, (high - low) / 2.0

    def test_linear_responses_give_the_intervals_of_least_squares(self):
        # y = J x + (1, 2): the covariance of the keys is (J' C^-1 J)^-1, and the interval 1.96 deviations.
        slopes, uncertainty = np.array([[1.0, 0.5], [-0.3, 0.8], [0.4, 0.4]]), np.array([0.10, 0.05, 0.08])
        x, truth = places(16, 2), np.array([0.2, -0.1])
        runs = Runs(x, np.zeros(16), list((x @ slopes.T).T[:, :, None]))
        for correlation, discrepancy in ((0.0, 0.0), (0.7, 0.0), (0.0, 0.1)):
            correlations = np.eye(3)
            correlations[0, 1] = correlations[1, 0] = correlation
            numbers = slopes @ truth
            covariance = correlations * np.outer(uncertainty, uncertainty) + np.diag((discrepancy * numbers) ** 2)
            likelihood = Likelihood(Target(list(map(value, numbers, uncertainty)), [discrepancy] * 3, correlations), runs)
            expected = np.linalg.inv(slopes.T @ np.linalg.inv(covariance) @ slopes)
            for key in (0, 1):
                middle, half = self.interval(likelihood, key)
                self.assertAlmostEqual(middle, truth[key], delta=0.01)
                self.assertAlmostEqual(half / (1.959964 * expected[key, key] ** 0.5), 1.0, delta=0.02)
            self.assertLess(likelihood.misfit(likelihood.best[None], with_processes=False)[0], 1e-3)

    def test_correlated_points_of_a_series_count_for_fewer(self):
        # A constant with errors of correlation R has the variance u²/(1' R^-1 1), and 1' R^-1 1 = 1 + Σ tanh(step/2τ).
        times, tau, u = np.arange(20.0), 4.0, 0.3
        measured = Measurement(PLAIN, times, np.full(20, 0.1), np.full(20, u), tau, "")
        x = places(8, 1)
        likelihood = Likelihood(Target([measured], [0.0], np.eye(0)), Runs(x, np.zeros(8), [np.tile(x, (1, 20))]))
        expected = 1.959964 * u / np.sqrt(1.0 + 19.0 * np.tanh(0.5 / tau))
        self.assertAlmostEqual(self.interval(likelihood)[1] / expected, 1.0, delta=0.02)
        self.assertEqual(likelihood.freedom, 19)

    def test_curves_of_two_shapes_have_two_components_and_lose_nothing(self):
        times, weights = np.arange(40.0), np.array([[1.0, 0.0], [2.0, 0.05], [1.0, 0.1], [3.0, 0.02], [2.5, 0.07]])
        curves = 3.0 + weights @ np.array([np.exp(-times / 8.0), times])
        measured = 3.0 + 1.5 * np.exp(-times / 8.0) + 0.04 * times
        root = np.linalg.cholesky(0.01 * np.exp(-np.abs(np.subtract.outer(times, times)) / 3.0))
        components = Components(root, measured, curves)
        self.assertEqual(components.basis.shape[1], 2)
        self.assertLess(components.rest, 1e-9)
        # Squares of distances are those of the scores.
        distance = (components.scores(curves[3:4]) - components.scores(measured[None])).ravel()
        away = curves[3] - measured
        self.assertAlmostEqual(distance @ distance / (away @ np.linalg.solve(root @ root.T, away)), 1.0, places=8)

    def test_what_cannot_be_reached_is_a_misfit_and_no_ignorance(self):
        # y is the key, at most 1, and 2 ± 0.1 was measured twice: χ² is 2·10² however little is known between the points.
        x = places(8, 1)
        target = Target([value(2.0, 0.1), value(2.0, 0.1)], [0.0, 0.0], np.eye(2))
        likelihood = Likelihood(target, Runs(x, np.zeros(8), [x, x]))
        self.assertAlmostEqual(likelihood.misfit(likelihood.best[None], with_processes=False)[0] / 200.0, 1.0, delta=0.1)
        # One value alone leaves no degree of freedom: it is missed by ten deviations, or by two, of which P(χ² > 4) is 0.0455.
        for measured, deviations, p in ((2.0, -10.0, 1.5e-23), (1.2, -2.0, 0.0455)):
            likelihood = Likelihood(Target([value(measured, 0.1)], [0.0], np.eye(1)), Runs(x, np.zeros(8), [x]))
            self.assertAlmostEqual(likelihood.apart()[0], deviations, delta=0.05)
            self.assertAlmostEqual(np.log(likelihood.p() / p), 0.0, delta=0.5)


class ProductTest(unittest.TestCase):
    def test_a_product_is_found_where_the_response_is_a_function_of_it(self):
        # ln y = ln a + 0.5 ln b does not see c; halves of the ranges 1, 2, 3. -2 ln L is (50·(u₁ + u₂))².
        ((powers, factor),), better = products(np.array([[50.0, 50.0, 0.0]]), np.array([1.0, 2.0, 3.0]), 3.84)
        np.testing.assert_allclose(powers, [1.0, 0.5, 0.0], atol=1e-12)
        self.assertAlmostEqual(np.log(factor), 3.84**0.5 / 50.0, places=9)
        self.assertEqual(better, [])

    def test_two_responses_leave_one_ridge_of_three_keys(self):
        found, _ = products(np.array([[90.0, 90.0, 0.0], [0.0, 70.0, 70.0]]), np.ones(3), 3.84)
        self.assertEqual(len(found), 2)
        for powers, _ in found:
            self.assertAlmostEqual(float(powers @ [1.0, -1.0, 1.0]), 0.0, places=12)

    def test_along_a_strip_the_product_is_known_better_than_the_keys(self):
        # ln a + ln b and ln a - ln b are measured with deviations s and t, so that of either key is √(s² + t²)/2.
        def rows(s, t):
            return np.array([[2.0 / s, 3.0 / s], [2.0 / t, -3.0 / t]])

        halves = np.array([2.0, 3.0])
        none, ((powers, factor),) = products(rows(0.02, 0.3), halves, 3.84)
        self.assertIsNone(none)
        np.testing.assert_allclose(powers, [1.0, 1.0], atol=1e-9)
        self.assertAlmostEqual(np.log(factor), 0.02 * 3.84**0.5, places=9)
        # Three times as well begins where 2 s = √(s² + t²)/3, at t = 5.92 s.
        self.assertEqual([len(products(rows(0.02, t), halves, 3.84)[1]) for t in (0.117, 0.120)], [0, 1])
        self.assertEqual(products(np.diag([9.0, 9.0]), np.ones(2), 3.84), (None, []))
        self.assertEqual(products(np.array([[0.1, 0.2]]), np.ones(2), 3.84)[0], [])


class OutcomeTest(unittest.TestCase):
    def outcome(self, most, jump, measured=0.3):
        """Of y = x, measured as 0.3, where runs beyond the design jump."""
        x = places(8, 1)

        def make(where):
            return Runs(where, np.zeros(len(where)), [where + jump * (np.abs(where - 0.3) < 0.2)])

        return calibrated(Target([value(measured, 0.02)], [0.0], np.eye(1)), Runs(x, np.zeros(8), [x]), make, 1, most, [True])

    def told(self, outcome, most):
        """What a fit tells of it."""
        key = Factor("load", "operation.normal_force", "N", (1.0, 3.0), True, False, False, "N", 1.0, 0.0)
        study = SimpleNamespace(title="Rig", factors=[key], seeds=1, runs=pandas.DataFrame({"point": range(8)}))
        return Fit(study, outcome.likelihood.target, outcome, 0.95, most, study.runs)

    def test_the_last_runs_are_at_the_most_likely_place(self):
        outcome = self.outcome(12, 0.0)
        self.assertFalse(outcome.has_failed)
        self.assertAlmostEqual(outcome.checks[-1]["place"][0], 0.3, delta=0.02)
        np.testing.assert_array_equal(outcome.likelihood.runs.x[-1], outcome.checks[-1]["place"])

    def test_runs_that_contradict_leave_no_interval_or_move_the_place(self):
        failed = self.outcome(9, 5.0)
        self.assertTrue(failed.has_failed)
        found = self.told(failed, 9)
        (of_key,) = found.document()["keys"]
        self.assertEqual((of_key["most_likely"], of_key["interval"], found.document()["check"]), (None, [], "failed"))
        self.assertIn("Runs at the most likely place contradict the forecast (load = 2.", found.text())
        self.assertIsNone(found.determined)
        self.assertEqual(
            found.keys["cautions"][0].split("; ")[:2], ["runs contradict the forecast", "Runs at the most likely place contradict the forecast"]
        )
        moved = self.outcome(40, 5.0)
        best = moved.likelihood.best[0]
        self.assertTrue(moved.has_failed or abs(best - 0.3) > 0.15, best)

    def test_what_no_values_give_has_no_interval(self):
        # y is the key, at most 1: 2 is missed by 50 deviations, 1.02 by one.
        for measured, said in ((2.0, "no values within the ranges give what was measured"), (1.02, "")):
            found = self.told(self.outcome(12, 0.0, measured), 12)
            (of_key,) = found.document()["keys"]
            self.assertEqual((of_key["interval"] == [], said in found.keys["cautions"][0]), (bool(said), True))
            self.assertEqual(any(outcome in found.keys["cautions"][0] for outcome in ("no values within", "No values within")), bool(said))
            self.assertAlmostEqual(of_key["most_likely"], 3.0, delta=0.05)
        self.assertIn("is 50.0 deviations away", self.told(self.outcome(12, 0.0, 2.0), 12).text())

    def test_without_runs_at_the_most_likely_place_there_is_no_interval(self):
        found = self.told(self.outcome(8, 0.0), 8)
        self.assertEqual(found.document()["keys"][0]["interval"], [])
        self.assertIn("so there is no interval; [fit] runs = 9 allows them", found.text())
        self.assertTrue(self.told(self.outcome(9, 0.0), 9).document()["keys"][0]["interval"])

    def test_runs_that_were_kept_are_told(self):
        # Runs that scatter would end like this.
        told = self.told(replace(self.outcome(12, 0.0), ended="budget"), 12)
        left = 12 - len(told.outcome.likelihood.runs.x)
        self.assertIn(f"the other {left} were kept in case the last had contradicted the forecast", told.text())

    def test_true_keys_are_inside(self):
        shares = experiments.coverage(8)
        self.assertGreaterEqual(shares[0], 6 / 8)
        self.assertGreaterEqual(shares[1], 13 / 16)
        self.assertGreaterEqual(experiments.coverage(4, bias=0.1, given={"discrepancy": 0.1})[0], 3 / 4)

    def test_budgets_do_not_exclude_each_other(self):
        good, exclusive, _ = experiments.budgets(1, sharp=1.5, seeds=2)
        self.assertGreaterEqual(good, 2)
        self.assertEqual(exclusive, 0)


class StudyTest(Folder):
    STUDY = """
version = 1
title = "Rig"
design = "latin-hypercube"
points = 12
[[factor]]
name = "load"
range = ["1 N", "10 N"]
scale = "logarithmic"
[[factor]]
name = "speed"
range = [1.0, 10.0]
scale = "logarithmic"
[[response]]
name = "wear"
imported = true
unit = "m3"
measured = "3 mm^3"
uncertainty = "0.1 mm3"
"""

    def study(self, change=lambda text: text):
        path = self.folder / "s.toml"
        path.write_text(change(self.STUDY))
        return path

    def test_imported_responses_are_fitted_without_runs(self):
        path = self.study()
        runs = analysed(path).runs
        wear = 0.5 * runs["load"] * runs["speed"] ** 0.5
        lines = [f"{load!r},{speed!r},{w!r}" for load, speed, w in zip(runs["load"], runs["speed"], wear, strict=True)]
        table = path.with_suffix(".csv")
        table.write_text("\n".join(["load,speed,wear [mm3]", *lines]))
        import_values(path, table)
        found = fit(path)
        document = found.document(["a.csv"])
        self.assertEqual((document["ended"], document["check"], document["runs"]), ("no runs", "none", 12))
        # Keys of the document of the program before.
        before = "study keys responses confidence misfit degrees_of_freedom p determined notes runs runs_at_most rounds ended surrogate_share files"
        self.assertLessEqual(set(before.split()), set(document))
        self.assertLessEqual({"name", "keys", "unit", "most_likely", "interval", "undetermined"}, set(document["keys"][0]))
        # load × speed^0.5 = 6.
        self.assertRegex(document["determined"], r"^Only load × speed\^0\.[345]\d* = .* is determined by these data")
        self.assertIn("load", found.text())
        self.assertNotIn("threshold", found.text())
        self.assertEqual(set(found.figures()), {"profiles", "region-load-speed"})
        self.assertEqual(set(found.tables), {"keys.csv", "responses.csv", "profiles.csv", "runs.csv"})
        self.assertEqual(plan(path).document()["responses"], ["wear"])

    def test_a_threshold_is_cautioned_in_text_table_and_document(self):
        # Of wear that is 1 below a load and 3 above it 95 % intervals of the load hold it in fewer than 95 % (78 % in 50 studies).
        path = self.study(lambda text: text.replace("points = 12", "points = 12\nreplicates = { seeds = [1, 2] }"))
        runs = analysed(path).runs
        wear = np.where(runs["load"] > 3.0, 3.0, 1.0) + 0.1 * np.log(runs["speed"]) + 0.02 * np.random.default_rng(1).standard_normal(24)
        lines = [
            f"{load!r},{speed!r},{seed},{w!r}" for load, speed, seed, w in zip(runs["load"], runs["speed"], runs["replicate"], wear, strict=True)
        ]
        table = path.with_suffix(".csv")
        table.write_text("\n".join(["load,speed,replicate,wear [mm3]", *lines]))
        import_values(path, table)
        found = fit(path)
        [said] = [caution for caution in found.cautions if "if it has a threshold or a kink" in caution]
        self.assertRegex(said, r"^Points of wear that were left out are missed by \d\d % of the variance: ")
        self.assertIn(said, found.text())
        self.assertIn(said, found.document()["notes"])
        short = found.keys["cautions"].drop_duplicates().item().split("; ")
        self.assertEqual([one for one in short if one.startswith("Points of wear")], [said.split(":")[0]])
        # All of what the text says is to be known stands there.
        for caution in found.cautions:
            self.assertTrue(any(caution.startswith(one) for one in short), caution)

    def test_the_last_point_of_the_budget_is_kept_from_the_design(self):
        # Four points with three seeds: the design has all but one of those that the budget allows, and three at least.
        base = '\n[replicates]\nkeys = ["disc.surface.synthetic.seed"]\nseeds = [1, 2, 3]\n'
        scene = f'version = 1\nbase = "{QUICK}"\nset = ["operation.duration = \'1 s\'"]\n'
        response = 'dataset = "/series/lost_pin"\nat = "end"\nmeasured = "2e-5 mm^3"\nuncertainty = "4e-6 mm3"\n'
        key = '\nname = "load"\nkey = "operation.normal_force"'
        study = f'{scene}design = "sobol"\npoints = 4\n{base}[[factor]]{key}\nrange = ["4 N", "12 N"]\n[[response]]\nname = "lost"\n{response}'
        for most, runs in ((9, 9), (12, 9), (15, 12), (60, 12)):
            path = self.study(lambda _, most=most: f"{study}[fit]\nruns = {most}\n")
            self.assertEqual(plan(path).first_runs, runs)
        path = self.study(lambda _: f"{study}[fit]\nruns = 12\n")
        found = fit(path, progress=False)
        self.assertEqual(found.runs.groupby("point").size().tolist(), [3] * 4)
        self.assertNotEqual(found.outcome.check, "none")

    def test_errors_that_go_together_and_discrepancy_are_checked(self):
        study = analysed(self.study())
        for given, words in (
            ({"discrepancy": -0.1}, "fit.discrepancy = -0.1"),
            ({"discrepancy": {"x": 0.1}}, '"x" is no response that was measured; there are wear'),
            ({"correlations": [["wear", "x", 0.5]]}, "expected two responses with measured and a number"),
            ({"correlations": [["wear", ["x"], 0.5]]}, """fit.correlations: ['wear', ['x'], 0.5], expected two responses"""),
            ({"correlations": [["wear", "wear", "0.6"]]}, """fit.correlations: ['wear', 'wear', '0.6'], expected two responses"""),
            ({"correlations": 3}, "fit.correlations: 3, expected two responses"),
            ({"confidence": 1.0}, "fit.confidence = 1.0"),
            ({"runs": 0}, "fit.runs = 0, expected at least 1"),
        ):
            with self.subTest(given), self.assertRaises(InputError) as raised:
                plan(replace(study, document={**study.document, "fit": given}))
            self.assertIn(words, str(raised.exception))
        stated = plan(replace(study, document={**study.document, "fit": {"discrepancy": {"wear": 0.1}}})).target
        # 0.1² + 0.3² mm⁶.
        self.assertAlmostEqual(stated.covariance[0, 0] / 0.1e-18, 1.0, places=9)

    def test_what_cannot_be_fitted_is_told(self):
        for change, words in (
            (lambda text: text.replace('measured = "3 mm^3"\nuncertainty = "0.1 mm3"\n', ""), "nothing was measured"),
            (
                lambda text: (
                    text.replace('range = [1.0, 10.0]\nscale = "logarithmic"', "levels = [1, 2]")
                    .replace("latin-hypercube", "full-factorial")
                    .replace("points = 12\n", "")
                ),
                "give range = [lower, upper]",
            ),
        ):
            with self.assertRaises(InputError) as raised:
                fit(self.study(change))
            self.assertIn(words, str(raised.exception))
