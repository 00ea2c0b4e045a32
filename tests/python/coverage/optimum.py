"""How often intervals of comparisons cover, and how near to the best place runs of expected improvement come.

The points of 240 real runs with 30 sets of seeds are taken as scenes, too: intervals of a few seeds should cover the difference of all.
"""

import dataclasses
import itertools
import math

import numpy as np
from made_studies import span, study_of
from scipy.stats import qmc

from plateau.study.goals import Goal, Problem, beyond_runs, improved, with_processes
from plateau.study.results import analysed
from plateau.study.scene_comparison import difference

# Branin's function upside down: three equal peaks of -0.397887.
ENDS, PEAK = ((-5.0, 10.0), (0.0, 15.0)), -0.397887


def branin(x, y):
    return -((y - 5.1 / (4 * math.pi**2) * x**2 + 5 / math.pi * x - 6) ** 2 + 10 * (1 - 1 / (8 * math.pi)) * np.cos(x) + 10)


def study(points, seeds, noise, random):
    """Runs at points, each with so many seeds: what a seed adds everywhere, and noise of the same size."""
    at = np.repeat(points, len(seeds), axis=0)
    z = branin(*at.T) + np.tile(seeds, len(points)) + noise * random.standard_normal(len(at))
    columns = {"x": at[:, 0], "y": at[:, 1], "z": z, "replicate": np.tile(np.arange(len(seeds)) + 1, len(points))}
    return study_of([span(name, *ends) for name, ends in zip("xy", ENDS, strict=True)], columns, "sobol", responses={"z": "1"})


def regrets(number, noise, first=8, more=8, count=2):
    """How far from the peak the chosen place is: by expected improvement, and with as many runs that are spread."""
    random = np.random.default_rng(number)
    seeds = noise * random.standard_normal(count)
    places = qmc.scale(qmc.Sobol(2, rng=number).random(first + more), *np.transpose(ENDS))

    def make(points):
        return study(points[["x", "y"]].to_numpy(), seeds, noise, random).runs

    given, spread = study(places[:first], seeds, noise, random), study(places, seeds, noise, random)
    goal = Goal("z", "maximize", (given.runs["z"].min(), given.runs["z"].max()), is_of_runs=True)
    asked = Problem(given, {}, [goal], [], [None, None], 0.95)
    found, _ = improved(asked, more * count, make)
    points = found.study.runs.drop_duplicates("point")[["x", "y"]]
    best = points.iloc[int(beyond_runs(found).merit(points).argmax())]
    other = beyond_runs(with_processes(dataclasses.replace(asked, study=spread))).best().iloc[0]
    return [PEAK - branin(place["x"], place["y"]) for place in (best, other)]


def simulated(seeds, scenes, trials):
    """Part of the trials in which all intervals cover; the difference scatters between seeds as much as runs do."""
    random, covered = np.random.default_rng(seeds * 10 + scenes), 0
    for _ in range(trials):
        values = random.standard_normal(seeds) + random.standard_normal((scenes, seeds))
        found = [difference(values[0], other, 0.95, scenes - 1) for other in values[1:]]
        covered += all(one["low"] <= 0.0 <= one["high"] for one in found)
    return covered / trials


def real(path, seeds, subsets):
    """Parts of intervals of so many seeds that cover the difference of all, by response."""
    opened, parts = analysed(path), []
    for response in opened.responses:
        table = opened.runs.pivot(index="replicate", columns="point", values=response.name).to_numpy()
        random, inside = np.random.default_rng(seeds), []
        for _ in range(subsets):
            own = table[random.choice(len(table), seeds, replace=False)]
            for a, b in itertools.combinations(range(table.shape[1]), 2):
                found = difference(own[:, a], own[:, b])
                inside.append(found["low"] <= (table[:, b] - table[:, a]).mean() <= found["high"])
        parts.append(np.mean(inside))
    return parts
