"""Coverage of the forecasts' 95 % intervals, by simulation: ``python tests/python/coverage/forecasts.py [functions]``.

Responses are smooth by lot: sums of cosines with random frequencies (A. Rahimi, B. Recht, NIPS 20, 2007), products of powers, sums that
come to an end. Each run has noise besides (a standard deviation of 0.04 of the response's), and its seeds add something everywhere (0.02).
"""

import sys

import numpy as np
from scipy.stats import qmc

from plateau.study.process import Process

NOISE, OF_SEEDS, PLACES = 0.04, 0.02, 25
# Kind of response, factors, points, sets of seeds.
STUDIES = [
    ("very smooth", 1, 6, 3),
    ("very smooth", 2, 10, 2),
    ("very smooth", 4, 20, 2),
    ("very smooth", 4, 40, 2),
    ("smooth", 3, 15, 1),
    ("smooth", 4, 20, 2),
    ("product of powers", 4, 20, 2),
    ("comes to an end", 4, 20, 2),
]


def function(kind, factors, random):
    """A function by lot, with a standard deviation of about one over the ranges."""
    lengths, slopes = random.uniform(1.0, 5.0, factors), random.standard_normal(factors)
    size = np.linalg.norm(slopes)
    if kind == "product of powers":
        return lambda x: np.exp(0.6 * x @ slopes) / size
    if kind == "comes to an end":
        return lambda x: 2.0 * np.tanh(2.0 * x @ slopes / size + 0.5)
    drawn = random.standard_t(5, (300, factors)) if kind == "smooth" else random.standard_normal((300, factors))
    phase = random.uniform(0.0, 2.0 * np.pi, 300)
    return lambda x: (2.0 / 300.0) ** 0.5 * np.cos(x @ (drawn / lengths).T + phase).sum(-1)


def process_coverage(kind, factors, points, seeds, functions, number=20261124):
    """Shares of intervals of means and of runs that have the truth in them."""
    random, covered = np.random.default_rng(number), []
    for _ in range(functions):
        response = function(kind, factors, random)
        place = 2.0 * qmc.LatinHypercube(factors, seed=random).random(points) - 1.0
        x, group = np.repeat(place, seeds, axis=0), np.tile(np.arange(seeds), points)
        y = response(x) + OF_SEEDS * random.standard_normal(seeds)[group] + NOISE * random.standard_normal(len(x))
        asked = random.uniform(-1.0, 1.0, (PLACES, factors))
        truth = response(asked)
        run = truth + OF_SEEDS * random.standard_normal(PLACES) + NOISE * random.standard_normal(PLACES)
        _, low, high, run_low, run_high = Process(x, y, group).intervals(asked, 0.95).T
        covered.append([((low <= truth) & (truth <= high)).mean(), ((run_low <= run) & (run <= run_high)).mean()])
    return np.mean(covered, axis=0)


def main():
    functions = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    print("| response | factors | points | seeds | of means | of runs |\n|---|---|---|---|---|---|", flush=True)
    for kind, factors, points, seeds in STUDIES:
        means, runs = 100.0 * process_coverage(kind, factors, points, seeds, functions)
        print(f"| {kind} | {factors} | {points} | {seeds} | {means:.1f} % | {runs:.1f} % |", flush=True)


if __name__ == "__main__":
    main()
