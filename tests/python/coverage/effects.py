"""How often the intervals of effects hold the mean over all seeds.

Simulates 2^3 designs with two to five sets of seeds, in which the effect of one factor differs between sets of seeds by 0, 0.5, 1 and 2
of the noise: all runs there, and with a tenth of them missing. Beside it stands how often the test of lack of fit rejects a model that
lacks nothing, where the product of all three factors differs so, zero in the mean. Of 240 real runs with 30 sets of seeds
(data/studies/seeds.toml), it takes subsets of two to five and compares with the mean of all sets; subsets of 30 normal numbers are held in
91 to 98 %. The intervals from the residual, as they were before, stand beside.
"""

import itertools
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas
from checkout import ROOT
from made_studies import number, study_of, word
from scipy import stats

from plateau.study.data import Study
from plateau.study.level_differences import levels
from plateau.study.model import Fitted
from plateau.study.model_choice import fitted
from plateau.study.results import analysed

RATIOS = (0.0, 0.5, 1.0, 2.0)
# Results of data/studies/seeds.toml.
SEEDS_STUDY = ROOT / "tests/python/data/seeds"


def cube(seeds: int, numbers: int = 3) -> pandas.DataFrame:
    """All corners, with each set of seeds."""
    names = "ABCDEF"[:numbers]
    corners = pandas.DataFrame(list(itertools.product((-1.0, 1.0), repeat=numbers)), columns=list(names))
    return corners.merge(pandas.DataFrame({"replicate": range(1, seeds + 1)}), how="cross")


def covers(fit: Fitted, effects: dict[str, float]) -> list[list[bool]]:
    """Whether the intervals of these terms hold their effects: those over all seeds, and those from the residual."""
    found = []
    for label, effect in effects.items():
        at = next(at for at, term in enumerate(fit.terms) if fit.label(term) == label)
        row = np.zeros((1, fit.design.shape[1]))
        row[0, fit.columns[at + 2].start] = 2.0
        one = fit.combined(row).iloc[0]
        reach = stats.t.ppf(0.975, one["freedom"]) * one["standard_error"]
        residual = np.sqrt(fit.error * (row[:, fit.fit.kept] @ fit.fit.root @ fit.fit.basis.T).__pow__(2).sum())
        old = stats.t.ppf(0.975, fit.residual_freedom) * residual
        found.append([abs(one["value"] - effect) <= reach, abs(one["value"] - effect) <= old])
    return found


def simulated(seeds: int, ratio: float, count: int, missing: float = 0.0, terms: tuple[str, ...] = ("A", "B", "A × B")) -> Any:
    """Shares of simulations in which intervals hold the effect: a row for each term, columns over all seeds and from the residual."""
    random = np.random.default_rng([seeds, round(10 * ratio), round(100 * missing)])
    factors, found = [number(name, -1.0, 1.0) for name in "ABC"], []
    for _ in range(count):
        runs = cube(seeds)
        of_set, slope = random.normal(size=seeds), ratio * random.normal(size=seeds)
        place = runs["replicate"].to_numpy() - 1
        runs["y"] = of_set[place] + (1.0 + slope[place]) * runs["A"] + random.normal(size=len(runs))
        runs.loc[random.permutation(len(runs))[: round(missing * len(runs))], "y"] = np.nan
        study = study_of(factors, runs)
        fit = fitted(study, study.responses[0], "interactions")
        found.append(covers(fit, {label: 2.0 if label == "A" else 0.0 for label in terms}))
    return np.mean(found, axis=0)


def lacks(seeds: int, ratio: float, count: int) -> float:
    """Share of simulations in which the test finds a lack of fit although the mean of the product of three factors is 0."""
    random, found = np.random.default_rng([seeds, round(10 * ratio)]), []
    for _ in range(count):
        runs = cube(seeds)
        product = ratio * random.normal(size=seeds)[runs["replicate"] - 1] * runs["A"] * runs["B"] * runs["C"]
        runs["y"] = product + runs["A"] + random.normal(size=len(runs))
        study = study_of([number(name, -1.0, 1.0) for name in "ABC"], runs)
        found.append(fitted(study, study.responses[0], "interactions").lack_of_fit[-1] < 0.05)
    return float(np.mean(found))


def levels_simulated(seeds: int, ratio: float, count: int, control: str | None = None, others: float = 1.0) -> float:
    """Share of simulations in which the intervals of all differences of three levels hold together (Tukey, or Dunnett).

    Between sets of seeds the last level differs by `ratio` times the noise, and the `others` by this many times as much.
    """
    random, factors, found = np.random.default_rng([seeds, round(10 * ratio)]), [word("pad", "a", "b", "c"), number("B", -1.0, 1.0)], []
    for _ in range(count):
        runs = pandas.DataFrame(list(itertools.product("abc", (-1.0, 1.0), range(1, seeds + 1))), columns=["pad", "B", "replicate"])
        of_level = ratio * random.normal(size=(seeds, 3)) * [others, others, 1.0]
        runs["y"] = of_level[runs["replicate"] - 1, runs["pad"].map({"a": 0, "b": 1, "c": 2})] + random.normal(size=len(runs))
        table = levels(study_of(factors, runs), control).table
        found.append(((table["low"] <= 0.0) & (table["high"] >= 0.0)).all())
    return float(np.mean(found))


def of_runs(path: Path, sets: Sequence[int], count: int) -> pandas.DataFrame:
    """Shares of subsets of the sets of seeds whose intervals hold the mean of all sets."""
    study, rows = analysed(path), []
    random = np.random.default_rng(1)
    for response in study.responses:
        whole = fitted(study, response, "interactions")
        places = [columns.start for columns in whole.columns[2:]]
        wanted = {whole.label(term): 2.0 * whole.coefficients[at] for term, at in zip(whole.terms, places, strict=True)}
        for seeds in sets:
            subsets = list(itertools.combinations(range(1, study.seeds + 1), 2))
            if seeds > 2 or len(subsets) > count:
                subsets = [tuple(random.permutation(study.seeds)[:seeds] + 1) for _ in range(count)]
            found = []
            for subset in subsets:
                runs = study.runs[study.runs["replicate"].isin(subset)]
                part = Study(**{**vars(study), "runs": runs})
                found.append(covers(fitted(part, response, "interactions"), wanted))
            shares = np.mean(found, axis=0)
            for label, (own, old) in zip(wanted, shares, strict=True):
                rows.append({"response": response.name, "term": label, "seeds": seeds, "over all seeds": own, "from the residual": old})
    return pandas.DataFrame(rows)
