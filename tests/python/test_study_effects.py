"""Effects of studies: against the program that did this before, closed forms, statsmodels and textbooks."""

import gzip
import itertools
import json
import math
import unittest
import warnings
from dataclasses import replace

import numpy as np
import pandas
from checkout import ROOT
from effects import SEEDS_STUDY, cube, of_runs, simulated
from made_studies import number, span, stored, study_of, word
from scipy import stats

from plateau.errors import InputError, PlateauWarning
from plateau.study.analysis import effects, together
from plateau.study.data import Response, Study
from plateau.study.level_differences import levels
from plateau.study.model_choice import fitted
from plateau.study.seed_counts import seeds_needed, sets_for


def differences(old: object, new: object, path: str = ""):
    """Paths at which two documents differ."""
    if isinstance(old, dict):
        for key, value in old.items():
            yield from differences(value, new[key], f"{path}/{key}") if isinstance(new, dict) and key in new else [path + "/" + key]
    elif isinstance(old, list):
        if not isinstance(new, list) or len(old) != min(len(new), 40 if path.endswith("/terms") and "equations" in path else len(new)):
            yield path
        else:
            # Of long equations the fixture has the first products.
            for at, (one, other) in enumerate(zip(old, new, strict=False)):
                name = one.get("label", one.get("name", one.get("variables", at))) if isinstance(one, dict) else at
                yield from differences(one, other, f"{path}[{name}]")
    elif isinstance(old, float | int) and isinstance(new, float | int):
        # A maximum is known to half of the digits; what cancels has those of what it is made of.
        tolerance, least = (1e-6, 1e-6) if "box_cox" in path else (1e-8, 1e-12 if "terms" in path or "sum_of_squares" in path else 0.0)
        if abs(old - new) > tolerance * max(abs(old), abs(new)) + least:
            yield path
    elif old != new and not (new is None and isinstance(old, float) and abs(old) < 1e-12):
        yield path


# The only study of the fixture with a factor of two units.
ONE_SEED = "Runs: 3 x 2 without seeds, mean between times"


class OldProgram(unittest.TestCase):
    def test_what_is_not_meant_to_change_is_equal(self) -> None:
        studies = json.loads(gzip.decompress((ROOT / "tests/python/data/effects.json.gz").read_bytes()))["studies"]
        compared = 0
        for said in studies:
            study = stored(said)
            for call in said["calls"]:
                with warnings.catch_warnings(action="ignore", category=PlateauWarning):
                    document = effects(study, **call["options"]).document()
                self.assertEqual(document["repeats"], call["document"]["repeats"])
                for old, new, response in zip(call["document"]["responses"], document["responses"], study.responses, strict=True):
                    with self.subTest(study=said["name"], response=old["name"], **call["options"]):
                        found = [path for path in differences(old, new) if not meant(path, old, new, study, response)]
                        self.assertEqual(found, [])
                        compared += 1
        self.assertGreater(compared, 200)


def meant(path: str, old: dict, new: dict, study: Study, response: Response) -> bool:
    """Whether a difference is meant: see the changes of the release."""
    last = path.rsplit("/", 1)[-1]
    # Centre points have a term of their own, which is in the model.
    if "centre points" in [term["label"] for term in new["terms"]] or path.startswith("/curvature"):
        return True
    # Nothing was fitted.
    if new["error"] is not None and last in ("model", "model_reason"):
        return True
    # A transform is that of the response in SI units.
    of_scale = path in ("/fitted", "/mean", "/middle") or "/equations" in path or response.transform == "square root"
    if response.transform != "none" and of_scale:
        return True
    seeds = study.runs["replicate"].nunique() > 1
    term = next((term for term in new["terms"] if path.startswith(f"/terms[{term['label']}]/")), None)
    tests = ("f", "p", "standard_error", "interval[0]", "interval[1]", "interval")
    if term is not None and last in tests:
        # The error is that over all seeds; and what cannot be estimated has no test.
        return (seeds and term["label"] != "replicate") or (term["f"] is None and bool(term["aliased_with"]))
    # So is that of what the model lacks.
    if seeds and path.startswith(("/lack_of_fit/f", "/lack_of_fit/p", "/misfit")):
        return True
    # One end in rpm and the other in rad/s: the unit of the study is the other one of them.
    if study.title == ONE_SEED and path.startswith("/equations[1]"):
        return True
    # Levels are named in the unit of the study.
    return (last == "error_from" and seeds) or ("equations" in path and last == "variables")


class Seeds(unittest.TestCase):
    def test_error_of_complete_sets_is_that_of_one_effect_for_each(self) -> None:
        random = np.random.default_rng(1)
        runs = cube(4)
        runs["y"] = random.normal(size=len(runs)) + runs["A"] * runs["replicate"] + 0.3 * runs["replicate"]
        with self.assertWarnsRegex(PlateauWarning, r"seeds x factor exceeds the residual.*A \d"):
            found = effects(study_of([number(name, -1.0, 1.0) for name in "ABC"], runs))
        for label in ("A", "B", "A × C"):
            sign = np.prod([runs[name] for name in label.split(" × ")], axis=0)
            each = (2.0 * runs["y"] * sign).groupby(runs["replicate"]).mean()
            row = found.table.set_index("term").loc[label]
            self.assertAlmostEqual(row["effect"], each.mean(), places=12)
            self.assertAlmostEqual(row["standard_error"], each.std() / 2.0, places=12)
            self.assertAlmostEqual(row["error_freedom"], 3.0, places=9)
            interval = stats.ttest_1samp(each, 0.0).confidence_interval(0.95)
            self.assertAlmostEqual(row["low"], interval.low, places=9)
            self.assertAlmostEqual(row["p"], stats.ttest_1samp(each, 0.0).pvalue, places=12)

    def test_three_levels_are_tested_as_repeated_measures(self) -> None:
        from statsmodels.stats import anova

        # In the second the levels differ unlike: degrees of freedom are those of Greenhouse and Geisser, by the covariance of the levels.
        for begin, is_alike in ((1, True), (2, False)):
            random = np.random.default_rng(begin)
            runs = pandas.DataFrame([(level, seed) for level in ("a", "b", "c") for seed in range(1, 6)], columns=["pad", "replicate"])
            runs["y"] = random.normal(size=15) + (runs["pad"] == "b") * 2.0
            row = effects(study_of([word("pad", "a", "b", "c")], runs)).table.set_index("term").loc["pad"]
            expected = anova.AnovaRM(runs, "y", "replicate", within=["pad"]).fit().anova_table.iloc[0]
            middle = np.eye(3) - 1.0 / 3.0
            covariance = middle @ np.cov(runs["y"].to_numpy().reshape(3, 5)) @ middle
            part = 1.0 if is_alike else np.trace(covariance) ** 2 / (2.0 * np.square(covariance).sum())
            self.assertAlmostEqual(row["f"], expected["F Value"], places=9)
            self.assertAlmostEqual(row["error_freedom"], part * expected["Den DF"], places=9)
            self.assertAlmostEqual(row["p"], stats.f.sf(row["f"], 2.0 * part, 8.0 * part), places=9)

    def test_intervals_hold_the_mean_over_all_seeds(self) -> None:
        for missing in (0.0, 0.1):
            shares = simulated(3, 2.0, 300, missing)
            self.assertLess(shares[0, 1], 0.75)  # From the residual: 52 %.
            self.assertTrue((np.abs(shares[:, 0] - 0.95) < 0.045).all(), shares)

    def test_intervals_of_real_runs_hold_the_mean_of_thirty_sets(self) -> None:
        # Effects of three of thirty sets against the mean of all; of 24 intervals in 25 draws.
        found = of_runs(SEEDS_STUDY, [3], 25)
        shares = found[["over all seeds", "from the residual"]].mean()
        self.assertTrue(0.90 < shares["over all seeds"] < 0.99, shares)
        fibres = found[(found["response"] == "secondary on the pin") & (found["term"] == "fibre fraction")]
        self.assertLess(fibres["from the residual"].item(), 0.75)
        self.assertGreater(fibres["over all seeds"].item(), 0.80)

    def test_lack_of_fit_has_the_error_between_seeds(self) -> None:
        random = np.random.default_rng(6)
        runs = cube(4)
        sign = runs["A"] * runs["B"] * runs["C"]
        runs["y"] = random.normal(size=len(runs)) + sign * random.normal(size=4)[runs["replicate"] - 1] + runs["A"]
        found = effects(study_of([number(name, -1.0, 1.0) for name in "ABC"], runs))
        expected = stats.ttest_1samp((2.0 * runs["y"] * sign).groupby(runs["replicate"]).mean(), 0.0)
        row = found.table.set_index("term").loc["lack of fit"]
        self.assertAlmostEqual(row["f"], expected.statistic**2, places=9)
        self.assertAlmostEqual(row["p"], expected.pvalue, places=9)
        self.assertAlmostEqual(row["error_freedom"], 3.0, places=9)

    def test_lack_of_fit_is_corrected_for_unequal_scatter(self) -> None:
        # What interactions leave of two words with three levels each is the test of their interaction with repeated measures.
        random = np.random.default_rng(7)
        runs = pandas.DataFrame([(a, b, seed) for a in "pqr" for b in "stu" for seed in range(1, 7)], columns=["a", "b", "replicate"])
        runs["y"] = random.normal(size=54) + (runs["a"] == "q") * (runs["b"] == "t") * (2.0 + 3.0 * random.normal(size=6)[runs["replicate"] - 1])
        row = effects(study_of([word("a", "p", "q", "r"), word("b", "s", "t", "u")], runs), "main").table.set_index("term").loc["lack of fit"]
        # Greenhouse and Geisser: of the covariance of orthonormal contrasts between the sets.
        cells = runs.pivot(index="replicate", columns=["a", "b"], values="y").to_numpy()
        helmert = np.array([[1.0, -1.0, 0.0], [1.0, 1.0, -2.0]]) / np.sqrt([[2.0], [6.0]])
        each = cells @ np.kron(helmert, helmert).T
        roots = np.linalg.eigvalsh(np.cov(each.T))
        epsilon = roots.sum() ** 2 / (4.0 * np.square(roots).sum())
        f = 6.0 * np.square(each.mean(axis=0)).sum() / roots.sum()
        self.assertAlmostEqual(row["f"], f, places=9)
        self.assertAlmostEqual(row["p"], stats.f.sf(f, 4.0 * epsilon, 20.0 * epsilon), places=9)

    def test_what_one_set_of_seeds_tells_alone_has_no_test(self) -> None:
        runs = cube(2, 2)
        runs["y"] = np.random.default_rng(5).normal(size=8)
        # The second set has one level of A: it tells nothing of its effect.
        runs.loc[(runs["replicate"] == 2) & (runs["A"] > 0), "y"] = np.nan
        table = effects(study_of([number("A", -1.0, 1.0), number("B", -1.0, 1.0)], runs), "main").table.set_index("term")
        self.assertTrue(np.isnan(table.loc["A", "p"]))
        self.assertAlmostEqual(table.loc["B", "error_freedom"], 1.0, places=9)
        self.assertGreater(table.loc["B", "p"], 0.0)

    def test_sets_at_other_points_are_said(self) -> None:
        # The second set stands for all of the upper half of C: neither can be told, and A has one effect for each half of C.
        runs = cube(2)
        runs["y"] = np.random.default_rng(5).normal(size=16)
        runs.loc[(runs["replicate"] == 2) != (runs["C"] > 0), "y"] = np.nan
        found = effects(study_of([number(name, -1.0, 1.0) for name in "ABC"], runs))
        rows = found.table.set_index("term")
        self.assertTrue(rows.loc[["replicate", "C", "A"], ["f", "p"]].isna().all().all())
        self.assertIn("effects without interval: A, B, A × C, B × C;", found.text())
        self.assertIn("replicate 2 has no result at 4 of 8 points, such as A = −1, B = −1, C = −1", found.text())
        self.assertNotIn("intervals are wide", found.text())

    def test_forecasts_of_the_mean_are_those_of_one_fit_for_each_set(self) -> None:
        random = np.random.default_rng(3)
        runs = cube(5, 2)
        runs["y"] = random.normal(size=len(runs)) + runs["replicate"] + runs["A"] * runs["replicate"]
        fit = fitted(study := study_of([number("A", -1.0, 1.0), number("B", -1.0, 1.0)], runs), study.responses[0])
        place = pandas.DataFrame({"A": [0.5], "B": [-0.2]})
        each = []
        for _, own in runs.groupby("replicate"):
            x = np.column_stack([np.ones(4), own["A"], own["B"], own["A"] * own["B"]])
            each.append(np.array([1.0, 0.5, -0.2, -0.1]) @ np.linalg.solve(x, own["y"]))
        interval = stats.ttest_1samp(each, 0.0).confidence_interval(0.95)
        found = fit.forecast(place).iloc[0]
        self.assertAlmostEqual(found["mean_low"], interval.low, places=9)
        self.assertAlmostEqual(found["mean_high"], interval.high, places=9)

    def test_numbers_of_sets(self) -> None:
        # The smallest n with t(0.975, n - 1)/sqrt(n) at most 0.5 is 18; tables of t: 2.110/4.243 = 0.497, and 2.120/4.123 = 0.514.
        self.assertEqual(sets_for(1.0, 0.5), 18)
        self.assertEqual(sets_for(1.0, 100.0), 2)
        self.assertEqual(sets_for(1.0, 0.0), math.inf)

    def test_what_a_number_is_in_is_said(self) -> None:
        runs = cube(2)
        runs["y"] = np.random.default_rng(4).normal(size=len(runs))
        study = study_of([number(name, -1.0, 1.0) for name in "ABC"], runs)
        study = replace(study, responses=[replace(study.responses[0], unit="m2")])
        with self.assertWarnsRegex(PlateauWarning, "y: half_width = 0.5 is taken in m2; give text with a unit"):
            bare = seeds_needed(study, 0.5).table
        self.assertEqual(bare["sets"].tolist(), seeds_needed(study, "500000 mm2").table["sets"].tolist())
        with self.assertRaisesRegex(InputError, 'y: "0.5", expected a number in m2, or text with a unit'):
            seeds_needed(study, "0.5")
        self.assertRegex(seeds_needed(study, "5 mm2").text(), r"A +−?[\de+.]+ mm² +[\de+.]+ mm² +5 mm² ")

    def test_centre_points_of_an_equation_are_explained(self) -> None:
        runs = pandas.concat([cube(2), pandas.DataFrame({"A": 0.0, "B": 0.0, "C": 0.0, "replicate": [1, 2]})], ignore_index=True)
        runs["y"] = np.random.default_rng(4).normal(size=len(runs))
        text = effects(study_of([span(name) for name in "ABC"], runs)).text()
        self.assertIn(" [centre points]", text)
        self.assertIn("[centre points] is 1 at the centre points", text)

    def test_pilots(self) -> None:
        runs = cube(3)
        runs["y"] = np.random.default_rng(4).normal(size=len(runs)) + 3.0 * runs["A"]
        study = study_of([number(name, -1.0, 1.0) for name in "ABC"], runs)
        table = seeds_needed(study, 0.5).table.set_index("term")
        each = (2.0 * runs["y"] * runs["A"]).groupby(runs["replicate"]).mean()
        self.assertAlmostEqual(table.loc["A", "scatter"], each.std(), places=12)
        self.assertGreaterEqual(table.loc["A", "sets_safe"], table.loc["A", "sets"])
        with self.assertRaisesRegex(InputError, "one set of seeds"):
            seeds_needed(study_of([number("A", -1.0, 1.0)], pandas.DataFrame({"A": [-1.0, 1.0, -1.0], "y": [1.0, 2.0, 1.5]})))

    def test_levels_of_a_pilot_have_their_largest_difference(self) -> None:
        runs = pandas.DataFrame(list(itertools.product((4.0, 12.0), "abc", (1, 2, 3))), columns=["load", "pad", "replicate"])
        runs["y"] = np.random.default_rng(2).normal(size=18) + 3.0 * (runs["pad"] == "c")
        study = study_of([number("load", 4.0, 12.0), word("pad", *"abc")], runs)
        for half_width, wanted in ((0.5, 0.5), (None, None)):
            found = seeds_needed(study, half_width)
            self.assertEqual(found.table["term"].tolist(), ["load", "pad: c less a"])
            row, means = found.table.iloc[1], runs.pivot_table("y", "replicate", "pad")
            self.assertTrue((abs((means["c"] - means["a"]).mean()) > (means["c"] - means["b"]).mean()) and row["effect"] > 0.0)
            self.assertAlmostEqual(row["effect"], (means["c"] - means["a"]).mean(), places=12)
            self.assertAlmostEqual(row["scatter"], (means["c"] - means["a"]).std(), places=12)
            self.assertEqual(row["sets"], sets_for(row["scatter"], wanted or row["effect"]))
            self.assertIn("caution: y: no number of sets for load × pad: an interaction with a factor of three levels or more", found.text())
            self.assertTrue(found.table["cautions"].str.contains("no number of sets for load × pad").all())
            self.assertEqual("half of all cases" in found.text(), half_width is None)
        self.assertIn("half width is the size of each effect of y", seeds_needed(study, {"z": 0.5}).cautions[0])
        # At 4 one set alone has values: nothing tells the error of the load.
        few = seeds_needed(study_of(study.factors, runs.assign(y=runs["y"].where((runs["load"] > 5.0) | (runs["replicate"] < 2)))), None)
        self.assertEqual([caution.split(":")[1] for caution in few.cautions if "no error" in caution], [" no number of sets for load"])

    def test_a_half_width_of_the_effect_leaves_out_none_in_half_of_the_cases(self) -> None:
        # Powers of the t test, noncentral t: what the caution says.
        for scatter in (2.0, 5.0):
            for part, low, high in ((1.0, 0.5, 0.55), (0.5, 0.97, 0.98)):
                sets = sets_for(scatter, part)
                limit, shift = stats.t.ppf(0.975, sets - 1), sets**0.5 / scatter
                power = stats.nct.sf(limit, sets - 1, shift) + stats.nct.cdf(-limit, sets - 1, shift)
                self.assertTrue(low < power < high, (scatter, part, power))


class Missing(unittest.TestCase):
    def test_values_that_are_missing_because_of_their_size_are_said(self) -> None:
        runs = cube(3)
        runs["y"] = 10.0 + runs["A"] + np.random.default_rng(1).normal(size=24)
        lacks = runs.index[runs["A"] > 0][:5]
        factors = [number(name, -1.0, 1.0) for name in "ABC"]
        study = study_of(factors, runs.assign(y=runs["y"].where(~runs.index.isin(lacks))))
        with warnings.catch_warnings(action="ignore", category=PlateauWarning):
            found = effects(study)
            self.assertIn(
                "y: 5 of 24 runs have no value of it (5 of the 12 with A = 1): if such runs lack it because of how large it is", found.cautions[0]
            )
            self.assertIn(found.cautions[0].removeprefix("y: "), found.text())
            self.assertEqual(found.cautions[0], found.document()["cautions"][0])
            self.assertTrue(found.table["cautions"].str.startswith("5 of 24 runs have no value of it; ").all())
            said = [
                effects(study_of(factors, runs.assign(y=runs["y"].where(kept))))["y"].cautions[0] for kept in (runs["replicate"] < 3, runs.index != 3)
            ]
            self.assertTrue(said[0].startswith("8 of 24 runs have no value of it: if"), said)
            self.assertTrue(said[1].startswith("1 of 24 runs has no value of it (run 4): if"), said)
        self.assertFalse(any("no value" in one for one in effects(study_of(factors, runs)).cautions))

    def test_many_values_of_a_number_are_halves(self) -> None:
        runs = pandas.DataFrame(stats.qmc.LatinHypercube(2, rng=np.random.default_rng(1)).random(20), columns=["A", "B"])
        runs["y"] = (runs["A"] + runs["B"]).where(runs["B"] < 0.7)
        cautions = effects(study_of([span("A", 0.0, 1.0), span("B", 0.0, 1.0)], runs, "latin-hypercube")).cautions
        self.assertIn("6 of 20 runs have no value of it (6 of the 10 with B above 0.5)", cautions[0])


class Model(unittest.TestCase):
    def test_a_smaller_model_is_named_where_there_is_one(self) -> None:
        corners = pandas.DataFrame(list(itertools.product((-1.0, 1.0), repeat=2)), columns=["A", "B"]).assign(y=[1.0, 2.0, 4.0, 3.0])
        factors = [number(name, -1.0, 1.0) for name in "ABC"]
        of_two = effects(study_of(factors[:2], corners)).text()
        self.assertIn("no interval can be told: give [replicates] of seeds, such as those of the disc, or the smaller --model main", of_two)
        self.assertIn("more points or --model main would", of_two)
        # Half of 2³: three main effects and the mean are as many as runs.
        half = study_of(factors, corners.assign(C=corners["A"] * corners["B"]), "fractional-factorial")
        for model in (None, "main"):
            said = effects(half, model).text()
            self.assertIn("no interval can be told: give [replicates]", said)
            self.assertNotIn("--model main", said)

    def test_centre_points_have_a_term(self) -> None:
        # D. C. Montgomery, Design and Analysis of Experiments, 8th ed., example 6.7: yield of a chemical process.
        corners = [(-1.0, -1.0, 39.3), (1.0, -1.0, 40.9), (-1.0, 1.0, 40.0), (1.0, 1.0, 41.5)]
        runs = pandas.DataFrame(corners + [(0.0, 0.0, y) for y in (40.3, 40.5, 40.7, 40.2, 40.6)], columns=["A", "B", "y"])
        factors = [span("A"), span("B")]
        found = effects(study_of(factors, runs))
        table = found.table.set_index("term")
        self.assertAlmostEqual(table.loc["A", "effect"], 1.55, places=9)
        self.assertAlmostEqual(table.loc["A × B", "effect"], -0.05, places=9)
        self.assertAlmostEqual(table.loc["residual", "mean_square"], 0.043, places=9)
        self.assertAlmostEqual(table.loc["A", "f"], 55.87, places=2)
        self.assertAlmostEqual(table.loc["B", "f"], 9.83, places=2)
        self.assertAlmostEqual(table.loc["centre points", "sum_of_squares"], 0.0027, places=4)
        self.assertAlmostEqual(table.loc["centre points", "effect"], 40.46 - 40.425, places=9)
        self.assertEqual(found.document()["responses"][0]["curvature"]["difference"], table.loc["centre points", "effect"])

    def test_squares_are_of_type_iii(self) -> None:
        import statsmodels.formula.api as formulas
        from statsmodels.stats.anova import anova_lm

        random = np.random.default_rng(5)
        runs = pandas.DataFrame([(a, b) for a in "pqr" for b in "st" for _ in range(3)], columns=["a", "b"]).drop([1, 2, 9])
        runs["y"] = random.normal(size=len(runs)) + (runs["a"] == "q") * (runs["b"] == "t")
        table = effects(study_of([word("a", "p", "q", "r"), word("b", "s", "t")], runs)).table.set_index("term")
        expected = anova_lm(formulas.ols("y ~ C(a, Sum) * C(b, Sum)", runs).fit(), typ=3)
        for label, row in {"a": "C(a, Sum)", "b": "C(b, Sum)", "a × b": "C(a, Sum):C(b, Sum)"}.items():
            self.assertAlmostEqual(table.loc[label, "sum_of_squares"], expected.loc[row, "sum_sq"], places=10)
            self.assertAlmostEqual(table.loc[label, "p"], expected.loc[row, "PR(>F)"], places=10)

    def test_a_term_with_an_empty_cell_has_no_test(self) -> None:
        random = np.random.default_rng(6)
        runs = pandas.DataFrame([(a, b) for a in "pqr" for b in "stu" for _ in range(2)], columns=["a", "b"])
        runs = runs[(runs["a"] != "p") | (runs["b"] != "u")]
        runs["y"] = random.normal(size=len(runs))
        found = effects(study_of([word("a", "p", "q", "r"), word("b", "s", "t", "u")], runs))
        rows = found.table.set_index("term").loc[["a", "b", "a × b"]]
        self.assertTrue(rows[["f", "p", "standard_error"]].isna().all().all())
        self.assertIn("a × b cannot be told from", found.text())
        # Without the interaction they are told.
        self.assertFalse(effects(found.study, "main").table.set_index("term").loc[["a", "b"], "p"].isna().any())

    def test_points_are_left_out_in_closed_form(self) -> None:
        random = np.random.default_rng(7)
        runs = pandas.DataFrame(np.repeat(random.uniform(-1.0, 1.0, (12, 2)), 2, axis=0), columns=["A", "B"])
        runs["y"] = np.exp(runs["A"]) + runs["B"] + random.normal(size=24)
        factors = [span("A"), span("B")]
        fit = fitted(study := study_of(factors, runs, "latin-hypercube"), study.responses[0], "quadratic")
        missed = 0.0
        for point in range(12):
            own = (fit.runs["point"] == point).to_numpy()
            x = fit.matrix(fit.runs)
            without = np.linalg.lstsq(x[~own], fit.values[~own], rcond=None)[0]
            self.assertAlmostEqual(fit.loo[point], fit.values[own].mean() - (x[own] @ without).mean(), places=9)
            missed += np.square(fit.values[own] - x[own] @ without).sum()
        self.assertAlmostEqual(fit.press, missed, places=9)
        # What cancels out of the mean of a point is missed all the same.
        self.assertGreater(fit.press, 2 * np.square(fit.loo).sum())

    def test_forecasts_hold_what_the_model_misses(self) -> None:
        # A smooth function without noise: what is missed is all there is, and the residual alone knows little of it.
        random, held = np.random.default_rng(8), []
        factors = [span("A"), span("B")]
        for _ in range(40):
            slope = random.uniform(0.5, 3.0, 2)
            points = pandas.DataFrame(stats.qmc.LatinHypercube(2, rng=random).random(15) * 2 - 1, columns=["A", "B"])
            places = pandas.DataFrame(random.uniform(-1.0, 1.0, (50, 2)), columns=["A", "B"])
            at_points, true = (np.sin(slope[0] * at["A"] + 1.0) * np.exp(0.5 * slope[1] * at["B"]) for at in (points, places))
            study = study_of(factors, points.assign(y=at_points), "latin-hypercube")
            found = fitted(study, study.responses[0]).forecast(places)
            held.append(((found["mean_low"] <= true) & (true <= found["mean_high"])).mean())
        self.assertGreater(np.mean(held), 0.9)

    def test_what_is_rounding_is_nothing(self) -> None:
        # y = A + B + A B at the corners, each three times: all but these three coefficients is 0.
        points = pandas.DataFrame([(a, b, seed) for a in (-1.0, 1.0) for b in (-1.0, 1.0) for seed in (1, 2, 3)], columns=["A", "B", "replicate"])
        found = effects(study_of([span("A"), span("B")], points.assign(y=points["A"] + points["B"] + points["A"] * points["B"])))
        for equation in found["y"].equations.values():
            self.assertEqual(equation.set_index("variables")["coefficient"].round(12).to_dict(), {"": 0.0, "A": 1.0, "B": 1.0, "A·B": 1.0})
            self.assertEqual(equation["coefficient"][0], 0.0)
        self.assertEqual(found["y"].summary["middle"], 0.0)
        self.assertEqual(repr(found), found.text().rstrip())

    def test_what_seeds_do_not_change_has_no_test(self) -> None:
        # The product of three is not in the model, and the same in all sets but for rounding; that of A differs by 0.6.
        runs = cube(3)
        a, b, c, sets = (runs[name].to_numpy() for name in ("A", "B", "C", "replicate"))
        rounded = np.where(sets == 2, np.nextafter(1.7 * (5.0 + a + 0.5 * b + 0.1 * a * b * c), np.inf), 1.7 * (5.0 + a + 0.5 * b + 0.1 * a * b * c))
        for y, same in ((rounded, ["A", "B", "C", "A × B", "A × C", "B × C"]), (5.0 + a + 0.5 * b + 0.3 * a * (sets - 2), ["B", "C", "A × B"])):
            with warnings.catch_warnings(action="error", category=PlateauWarning):
                found = effects(study := study_of([number(name, -1.0, 1.0) for name in "ABC"], runs.assign(y=y)))
            rows = found.table.set_index("term")
            self.assertTrue(rows.loc[[*same, "lack of fit"], ["f", "p", "t", "low", "high", "seed_ratio"]].isna().all().all(), rows)
            self.assertTrue((rows.loc[same, "standard_error"] == 0.0).all())
            self.assertIn(f"effects that do not differ between sets of seeds have no interval, F and p: {', '.join(same)}", found.text())
            needed = seeds_needed(study).table.set_index("term").loc[same]
            self.assertEqual(needed[["scatter", "sets", "sets_safe"]].drop_duplicates().to_numpy().tolist(), [[0.0, 2.0, 2.0]])
        self.assertAlmostEqual(rows.loc["A", "standard_error"], 0.6 / 3**0.5, places=12)
        self.assertAlmostEqual(rows.loc["A", "f"], 4.0 / 0.12, places=9)
        # Effects of which most are 0 tell no error after Lenth, either.
        self.assertNotIn("Lenth", effects(study_of(study.factors, runs.assign(y=5.0 + 4.3 * a + 3.2 * b + 1.1 * a * b))).text())
        pads = pandas.DataFrame(list(itertools.product("pqr", (-1.0, 1.0), (1, 2, 3))), columns=["pad", "B", "replicate"])
        pads["y"] = pads["pad"].map({"p": 0.0, "q": 1.0, "r": 3.0}) + 0.1 * pads["B"] * (pads["pad"] == "r")
        with self.assertRaisesRegex(InputError, "pad: its levels differ by the same in all sets of seeds"):
            levels(study_of([word("pad", *"pqr"), number("B", -1.0, 1.0)], pads), model="main")


class Levels(unittest.TestCase):
    def test_chance_between_seeds_is_no_warning(self) -> None:
        # Of 28 terms one in twenty has a ratio beyond chance of its own.
        said = 0
        for seed in range(12):
            runs = pandas.DataFrame(list(itertools.product((-1.0, 1.0), repeat=5)), columns=list("ABCDE"))
            runs = runs.loc[runs.index.repeat(3)].assign(replicate=[1, 2, 3] * 32, y=np.random.default_rng(seed).normal(size=96))
            with warnings.catch_warnings(action="ignore", category=PlateauWarning):
                said += any("seeds x factor" in one for one in effects(study_of([number(name, -1.0, 1.0) for name in "ABCDE"], runs)).cautions)
        self.assertLess(said, 3)

    def test_factors_change_together_on_their_own_scale(self) -> None:
        # By their values 0.9999 alike, by logarithms 0.6.
        runs = pandas.DataFrame({"A": [1.0, 10.0, 1e2, 1e6], "B": [1e2, 1.0, 10.0, 1e6], "y": [1.0, 2.0, 4.0, 3.0]})
        factors = [replace(span(name, 1.0, 1e6), logarithmic=True) for name in "AB"]
        self.assertEqual(together(study_of(factors, runs, "csv")), [])
        self.assertEqual(len(together(study_of([span("A", 1.0, 1e6), span("B", 1.0, 1e6)], runs, "csv"))), 1)

    def test_sets_without_results_tell_nothing_of_the_scatter(self) -> None:
        runs = pandas.DataFrame([(a, seed) for a in (-1.0, 1.0) for seed in (1, 2, 3, 4, 5)], columns=["A", "replicate"])
        runs["y"] = [1.0, 2.0, 3.0, np.nan, np.nan, 2.5, 3.1, 5.2, np.nan, np.nan]
        slopes = np.array([1.5, 1.1, 2.2])
        table = seeds_needed(study_of([number("A", -1.0, 1.0)], runs), 0.5).table
        self.assertAlmostEqual(table["scatter"][0], slopes.std(ddof=1), places=12)

    def test_levels_that_scatter_unlike_have_errors_of_their_own(self) -> None:
        # Of Games and Howell: each pair has the error and the degrees of freedom of its differences between sets of seeds.
        random = np.random.default_rng(3)
        y = random.normal(size=(3, 6)) * [[0.1], [0.1], [3.0]]
        runs = pandas.DataFrame([(pad, seed) for pad in "abc" for seed in range(1, 7)], columns=["pad", "replicate"]).assign(y=y.ravel())
        for row in levels(study_of([word("pad", *"abc")], runs)).table.to_dict("records"):
            apart = y["abc".index(row["level"])] - y["abc".index(row["other"])]
            error = apart.std(ddof=1) / 6**0.5
            self.assertAlmostEqual(row["standard_error"], error, places=12)
            self.assertAlmostEqual(row["freedom"], 5.0, places=9)
            self.assertAlmostEqual(row["p"], stats.studentized_range.sf(2**0.5 * abs(apart.mean()) / error, 3, 5), places=5)
            self.assertAlmostEqual(row["high"] - row["difference"], error * stats.studentized_range.isf(0.05, 3, 5) / 2**0.5, places=4)

    def test_tukey_is_that_of_scipy(self) -> None:
        # The example of scipy.stats.tukey_hsd, from the documentation of SAS: minutes until headaches end.
        groups = [[24.5, 23.5, 26.4, 27.1, 29.9], [28.4, 34.2, 29.5, 32.2, 30.1], [26.1, 28.3, 24.3, 26.2, 27.8]]
        runs = pandas.DataFrame([(name, y) for name, group in zip("abc", groups, strict=True) for y in group], columns=["brand", "y"])
        table = levels(study_of([word("brand", "a", "b", "c")], runs)).table.set_index(["level", "other"])
        expected = [(("b", "a"), 0.951, 8.249, 0.014), (("c", "a"), -3.389, 3.909, 0.980), (("c", "b"), -7.989, -0.691, 0.020)]
        for pair, low, high, p in expected:
            row = table.loc[pair]
            self.assertAlmostEqual(row["low"], low, places=3)
            self.assertAlmostEqual(row["high"], high, places=3)
            self.assertAlmostEqual(row["p"], p, places=3)

    def test_dunnett_is_that_of_scipy(self) -> None:
        # The example of scipy.stats.dunnett: blood counts of Dunnett (1955).
        groups = [[7.40, 8.50, 7.20, 8.24, 9.84, 8.32], [9.76, 8.80, 7.68, 9.36], [12.80, 9.68, 12.16, 9.20, 10.55]]
        runs = pandas.DataFrame([(name, y) for name, group in zip("abc", groups, strict=True) for y in group], columns=["drug", "y"])
        table = levels(study_of([word("drug", "a", "b", "c")], runs), control="a").table.set_index("level")
        self.assertAlmostEqual(table.loc["b", "p"], 0.62004941, places=3)
        self.assertAlmostEqual(table.loc["c", "p"], 0.0059035, places=3)
        expected = stats.dunnett(*groups[1:], control=groups[0], rng=np.random.default_rng(1)).confidence_interval()
        self.assertAlmostEqual(table.loc["c", "low"], expected.low[1], places=2)
        self.assertAlmostEqual(table.loc["c", "high"], expected.high[1], places=2)

    def test_dunnett_is_that_of_his_tables(self) -> None:
        # C. W. Dunnett, Biometrics 20, 482-491 (1964): two-sided, by groups beside the control, of each, and confidence.
        published = [(2, 3, 0.95, 2.86), (4, 3, 0.95, 2.89), (4, 5, 0.95, 2.65), (4, 3, 0.99, 3.88), (4, 5, 0.99, 3.40)]
        for others, each, confidence, expected in published:
            names = [f"g{at}" for at in range(1 + others)]
            runs = pandas.DataFrame([(name, at + 0.1 * one) for at, name in enumerate(names) for one in range(each)], columns=["g", "y"])
            table = levels(study_of([word("g", *names)], runs), control="g0", confidence=confidence).table
            self.assertTrue((table["freedom"] == len(names) * (each - 1)).all())
            for reach in (table["high"] - table["low"]) / 2.0 / table["standard_error"]:
                self.assertAlmostEqual(reach, expected, delta=0.006)

    def test_far_out_the_chance_is_that_of_all_directions(self) -> None:
        # Differences of three groups of equal size are components of a point of the plane in directions that are 60° apart; beyond a
        # distance it is as likely as F says.
        for scatter, each in ((1e-1, 3), (1e-3, 3), (1e-2, 15)):
            runs = pandas.DataFrame([(name, at + scatter * (one % 3)) for at, name in enumerate("abc") for one in range(each)], columns=["g", "y"])
            for control, directions in (("a", 2), (None, 3)):
                for row in levels(study_of([word("g", "a", "b", "c")], runs), control=control).table.to_dict("records"):
                    size, freedom = abs(row["difference"]) / row["standard_error"], row["freedom"]
                    angles = np.linspace(0.0, np.pi, 60001)[1:]
                    largest = np.abs(np.cos(angles[:, None] - np.arange(directions) * np.pi / 3.0)).max(axis=1)
                    expected = stats.f.sf((size / largest) ** 2 / 2.0, 2, freedom).mean()
                    self.assertAlmostEqual(row["p"] / expected, 1.0, places=5)
                    self.assertTrue(1.0 <= row["p"] / (2.0 * stats.t.sf(size, freedom)) <= directions)

    def test_what_the_runs_do_not_tell_is_said(self) -> None:
        # No run has r with w: over all levels of the other factor these two are not known with interactions, and are without.
        cells = [(pad, disc) for pad in "pqr" for disc in "uvw" if (pad, disc) != ("r", "w")]
        y = {"p": 0.0, "q": 1.0, "r": 2.0, "u": 0.0, "v": 0.5, "w": 1.0}
        runs = pandas.DataFrame([(pad, disc, y[pad] + y[disc] + 0.1 * (at % 3 - 1)) for pad, disc in cells for at in range(3)])
        study = study_of([word("pad", "p", "q", "r"), word("disc", "u", "v", "w")], runs.set_axis(["pad", "disc", "y"], axis=1))
        for control in (None, "p"):
            found = levels(study, control=control).table
            [row] = found[found["factor"] == "pad"].to_dict("records")
            self.assertEqual((row["level"], row["other"]), ("q", "p"))
            # One difference alone: its interval and p are those of Student's t.
            self.assertAlmostEqual(row["p"] / (2.0 * stats.t.sf(1.0 / row["standard_error"], row["freedom"])), 1.0)
            self.assertAlmostEqual((row["high"] - row["low"]) / 2.0 / row["standard_error"], stats.t.isf(0.025, row["freedom"]), places=4)
        self.assertEqual(len(levels(study, control="p", model="main").table), 2)
        both = study_of(study.factors, runs.set_axis(["pad", "disc", "y"], axis=1).query("pad != 'q' or disc != 'v'"))
        for control in (None, "p"):
            with self.assertRaisesRegex(InputError, r"pad.*: some combinations .* have no run, .* model = \"main\""):
                levels(both, control=control)
        constant = study_of(study.factors, study.runs.assign(y=1.0))
        with self.assertRaisesRegex(InputError, "y: the response is 1.0 in all 24 observations"):
            levels(constant)
