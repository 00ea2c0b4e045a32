"""The tables of coverage in docs/study.md, as that page prints them: ``python tests/python/coverage`` (half an hour on one core).

Counts and cases of all tables are here; what is drawn by lot is the same in each call.
"""

import itertools
import os
import sys
import warnings
from pathlib import Path

# Sums are in the same order on any number of cores.
os.environ["OPENBLAS_NUM_THREADS"] = "1"
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import checkout  # noqa: F401, for the folder of the package
import effects
import fit
import forecasts
import numpy as np
import optimum

SETS = (2, 3, 4, 5)
SIMULATIONS, OF_LEVELS, OF_UNLIKE, SUBSETS = 1000, 800, 400, 400
FUNCTIONS, OF_STRAIGHT, OF_SENSITIVITY, OF_SLOPES, FEW = 200, 1000, 20, 40, 20
OF_COMPARISONS, REAL_SUBSETS, SEARCHES = 2000, 100, 12
EXPERIMENTS, OF_BUDGETS = 80, 15
# Kind of response, factors, points, sets of seeds.
RESPONSES = [
    ("very smooth", 1, 6, 3),
    ("very smooth", 2, 10, 2),
    ("very smooth", 4, 20, 2),
    ("very smooth", 4, 40, 2),
    ("smooth", 3, 15, 1),
    ("smooth", 4, 20, 2),
    ("product of powers", 4, 20, 2),
    ("comes to an end", 4, 20, 2),
    ("product of powers", 2, 12, 3),
    ("comes to an end", 2, 12, 3),
]
# Degrees of freedom, sets of seeds, and by how much these differ.
STRAIGHT = {
    "One set of seeds, 1, 2 and 3 degrees of freedom": [(1, 1, 0.0), (2, 1, 0.0), (3, 1, 0.0)],
    "2, 3 and 5 sets that differ by 3 times the noise": [(1, 2, 3.0), (1, 3, 3.0), (1, 5, 3.0)],
}
ROUGH = {"kink": [(2, 10, 2), (4, 20, 2)], "threshold": [(2, 10, 2), (4, 20, 2), (4, 40, 2)]}
FITS = [
    ("as it should be", {}, {}),
    ("one response 10 % off, not stated", {"bias": 0.1}, {}),
    ("the same, `discrepancy = 0.1`", {"bias": 0.1}, {"discrepancy": 0.1}),
    ("no response off, `discrepancy = 0.1`", {}, {"discrepancy": 0.1}),
    ("a sharp response, two seeds, 30 runs", {"sharp": 1.5, "seeds": 2}, {"most": 30}),
    ("the same, 60 runs", {"sharp": 1.5, "seeds": 2}, {"most": 60}),
    ("a series whose errors are alike for three points, stated", {"series": 3.0}, {"correlation_time": 3.0}),
    ("the same, taken for independent", {"series": 3.0}, {}),
]


def table(heads, rows):
    """Prints a table, each row as soon as it is known."""
    print(f"| {' | '.join(heads)} |\n|{'---|' * len(heads)}", flush=True)
    for row in rows:
        print(f"| {' | '.join(row)} |", flush=True)
    print()


def percent(parts, unit=" %"):
    """Parts in percent, with a comma between them."""
    return ", ".join(f"{100.0 * part:.1f}" for part in np.ravel(parts)) + unit


def span(parts):
    """The least and the largest part."""
    return f"{100.0 * np.min(parts):.1f} to {100.0 * np.max(parts):.1f} %"


def of_effects():
    """Intervals of effects in simulations and real runs, and of differences of levels."""
    print(f"Effects: {SIMULATIONS} simulations each\n")

    def row(sets):
        shares = (100.0 * effects.simulated(sets, ratio, SIMULATIONS, terms=("A",))[0] for ratio in effects.RATIOS)
        return [str(sets), *(f"{own:.1f} ({old:.1f})" for own, old in shares)]

    table(["sets of seeds", *(f"{ratio:g}" for ratio in effects.RATIOS)], map(row, SETS))
    cases = list(itertools.product(SETS, effects.RATIOS))
    missing = [effects.simulated(sets, ratio, SIMULATIONS, 0.1, ("A",))[0, 0] for sets, ratio in cases]
    print(f"With a tenth of the runs missing: {span(missing)}.", flush=True)
    lacks = [effects.lacks(sets, ratio, SIMULATIONS) for sets, ratio in cases]
    print(f"A lack of fit is found in {span(lacks)} where there is none.", flush=True)
    real = effects.of_runs(effects.SEEDS_STUDY, SETS, SUBSETS).groupby("seeds")["over all seeds"]
    print(f"Real runs, {SUBSETS} subsets: in the mean {span(real.mean())}; the lowest {span(real.min())}.", flush=True)
    each = OF_LEVELS // len(cases)
    levels = [np.mean([effects.levels_simulated(*case, each, control) for case in cases]) for control in (None, "a")]
    print(f"Tukey and Dunnett intervals, {OF_LEVELS} simulations: {percent(levels)}.", flush=True)
    unlike = [effects.levels_simulated(sets, 20.0, OF_UNLIKE, control, 0.05) for sets in (3, 5) for control in (None, "c")]
    print(f"Where the last of three levels scatters 20 times as much, with 3 and 5 sets: {percent(unlike)}.\n", flush=True)


def of_forecasts():
    """Intervals of forecasts, of process and polynomial, and of sensitivities."""
    print(f"Prediction: {FUNCTIONS} functions of each kind\n")

    def row(case):
        kind, *sizes = case
        alone = forecasts.process_coverage(*case, FUNCTIONS)
        shares, counts = forecasts.surrogate_coverage(*case, FUNCTIONS)
        chosen = ((percent(own, "") if count else "–") + f" ({count} functions)" * (count < FEW) for own, count in zip(shares, counts, strict=True))
        return [f"{kind} {'/'.join(map(str, sizes))}", percent(alone, ""), *chosen]

    table(["response", "process alone", "polynomial where it wins", "process where it wins"], map(row, RESPONSES))
    print(f"Straight responses: {OF_STRAIGHT} simulations each\n")
    for said, cases in STRAIGHT.items():
        means, runs = np.transpose([forecasts.straight_coverage(*case, OF_STRAIGHT) for case in cases])
        print(f"{said}: means {span(means)}, runs {span(runs)}.", flush=True)
    print()
    print(f"Sensitivity: {OF_SENSITIVITY} functions each\n")
    sizes = ROUGH["threshold"]

    def shares(kind):
        told = (percent(forecasts.sensitivity_coverage(kind, *size, OF_SENSITIVITY)) if size in ROUGH[kind] else "" for size in sizes)
        return [f"a {kind}", *told]

    table(["response", *(f"{factors} factors, {points} points" for factors, points, _ in sizes)], map(shares, ROUGH))
    unlike = [forecasts.seeds_coverage(kind, sets, 0.3, OF_SLOPES) for kind in (False, True) for sets in (3, 5)]
    print(f"Where an effect differs by 0.3 of it between 3 and 5 sets, polynomial and spread points: {percent(unlike)}.\n", flush=True)


def of_optimum():
    """Intervals of comparisons, and how near to the best place runs of expected improvement come."""
    found = [optimum.simulated(seeds, scenes, OF_COMPARISONS) for seeds, scenes in itertools.product((2, 3, 5), (2, 3, 4))]
    real = [part for seeds in (2, 3, 5) for part in optimum.real(effects.SEEDS_STUDY, seeds, REAL_SUBSETS)]
    print(f"Comparison: {span(found)} in simulations, {span(real)} in the 240 real runs.", flush=True)
    improved, spread = np.median([optimum.regrets(number, 0.5) for number in range(SEARCHES)], axis=0)
    print(f"Branin's function, {SEARCHES} searches: {improved:.1f} below the peak in the median, {spread:.1f} if runs are spread.\n", flush=True)


def of_fit():
    """Regions and intervals of fits, and whether those of unlike budgets exclude each other."""
    print(f"Fit: {EXPERIMENTS} experiments each\n")

    def row(case):
        name, made, given = case
        return [name, *map(percent, fit.coverage(EXPERIMENTS, given=given, **made))]

    table(["experiments", "region", "intervals", "no interval"], map(row, FITS))
    good, exclusive = np.sum([fit.budgets(number, sharp=1.5, seeds=2)[:2] for number in range(OF_BUDGETS)], axis=0)
    print(f"Budgets of 30, 31, 40 and 60 runs, {OF_BUDGETS} experiments: {good} fits have intervals, {exclusive} pairs exclude each other.")


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    for part in (of_effects, of_forecasts, of_optimum, of_fit):
        part()
