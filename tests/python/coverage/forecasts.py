"""Coverage of the forecasts' 95 % intervals, by simulation.

Responses are smooth by lot: sums of cosines with random frequencies (A. Rahimi, B. Recht, NIPS 20, 2007), products of powers, sums that come to an
end. Parts of the variance are tried, too, where neither surrogate can be right: functions with a kink, and with a threshold. Each run has noise
besides (a standard deviation of 0.04 of the response's), and its seeds add something everywhere (0.02; nothing where there is one set alone, which
cannot tell it).
"""

import itertools

import made_studies
import numpy as np
import pandas
from scipy import linalg, stats
from scipy.stats import qmc

from plateau.study.process import Process
from plateau.study.surrogate import surrogates
from plateau.study.variance_parts import sensitivity

NOISE, OF_SEEDS, PLACES = 0.04, 0.02, 25
# A face-centred central composite design of two factors.
GRID = np.array(list(itertools.product((-1.0, 0.0, 1.0), repeat=2)))


def function(kind, factors, random):
    """A function by lot, with a standard deviation of about one over the ranges."""
    lengths, slopes = random.uniform(1.0, 5.0, factors), random.standard_normal(factors)
    size = np.linalg.norm(slopes)
    if kind == "product of powers":
        return lambda x: np.exp(0.6 * x @ slopes) / size
    if kind == "comes to an end":
        return lambda x: 2.0 * np.tanh(2.0 * x @ slopes / size + 0.5)
    if kind in ("kink", "threshold"):
        # Along a line through the ranges: where it bends, or goes up within a fiftieth of its length.
        at = random.uniform(-0.4, 0.4)
        along = slopes / np.abs(slopes).sum()
        return lambda x: 4.0 * np.abs(x @ along - at) if kind == "kink" else np.tanh(50.0 * (x @ along - at))
    drawn = random.standard_t(5, (300, factors)) if kind == "smooth" else random.standard_normal((300, factors))
    phase = random.uniform(0.0, 2.0 * np.pi, 300)
    return lambda x: (2.0 / 300.0) ** 0.5 * np.cos(x @ (drawn / lengths).T + phase).sum(-1)


def experiment(kind, factors, points, seeds, random):
    """Places, sets of seeds and values of runs by lot; places that are asked for, with the truth and one more run there."""
    response = function(kind, factors, random)
    place = 2.0 * qmc.LatinHypercube(factors, seed=random).random(points) - 1.0
    x, group = np.repeat(place, seeds, axis=0), np.tile(np.arange(seeds), points)
    y = response(x) + (seeds > 1) * OF_SEEDS * random.standard_normal(seeds)[group] + NOISE * random.standard_normal(len(x))
    asked = random.uniform(-1.0, 1.0, (PLACES, factors))
    truth = response(asked)
    run = truth + OF_SEEDS * random.standard_normal(PLACES) + NOISE * random.standard_normal(PLACES)
    return x, group, y, asked, truth, run


def process_coverage(kind, factors, points, seeds, functions, number=20261124):
    """Shares of intervals of means and of runs that have the truth in them."""
    random, covered = np.random.default_rng(number), []
    for _ in range(functions):
        x, group, y, asked, truth, run = experiment(kind, factors, points, seeds, random)
        _, low, high, run_low, run_high = Process(x, y, group).intervals(asked, 0.95).T
        covered.append([((low <= truth) & (truth <= high)).mean(), ((run_low <= run) & (run <= run_high)).mean()])
    return np.mean(covered, axis=0)


def study_of(place, response, replicate=None, design="latin-hypercube", words=None):
    """A study whose factors x1, x2, ... are coded, with a response y; `words` are the levels of a further factor w, by run."""
    columns = {f"x{at + 1}": column for at, column in enumerate(place.T)} | {"y": np.broadcast_to(response, len(place))}
    factors = [made_studies.span(name) for name in columns if name != "y"]
    if words is not None:
        factors, columns = [*factors, made_studies.word("w", *sorted(set(words)))], columns | {"w": words}
    return made_studies.study_of(factors, columns | ({} if replicate is None else {"replicate": replicate}), design)


def surrogate_coverage(kind, factors, points, seeds, functions, number=20261124):
    """By what was taken (0 the polynomial, 1 the process): shares of intervals that have the truth in them, and how often."""
    random, covered = np.random.default_rng(number), ([], [])
    for _ in range(functions):
        x, group, y, asked, truth, run = experiment(kind, factors, points, seeds, random)
        (found,) = surrogates(study_of(x, y, group))
        told = found.forecast(pandas.DataFrame(asked, columns=[f"x{at + 1}" for at in range(factors)]))
        is_mean, is_run = told["mean_low"].le(truth) & told["mean_high"].ge(truth), told["run_low"].le(run) & told["run_high"].ge(run)
        covered[found.takes_process].append([is_mean.mean(), is_run.mean()])
    return [np.mean(own, axis=0) if own else np.full(2, np.nan) for own in covered], [len(own) for own in covered]


def straight_coverage(freedom, seeds, ratio, count, number=20261124):
    """Shares of intervals of means and of runs that have the truth in them, where main effects and noise are all there is.

    Of eight corners the model leaves so many degrees of freedom; sets of seeds differ by `ratio` times the noise. Places: middle and a corner.
    """
    random, covered, corners = np.random.default_rng(number), [], linalg.hadamard(8)[:, 1 : 8 - freedom].astype(float)
    asked = pandas.DataFrame(np.outer([0.0, 1.0], np.ones(7 - freedom)), columns=[f"x{at + 1}" for at in range(7 - freedom)])
    x, group, truth = np.repeat(corners, seeds, axis=0), np.tile(np.arange(seeds), 8), asked.sum(axis=1)
    for _ in range(count):
        y = x.sum(axis=1) + ratio * random.standard_normal(seeds)[group] + random.standard_normal(len(x))
        told = surrogates(study_of(x, y, group, "csv"), "main")[0].forecast(asked)
        run = truth + np.hypot(ratio, 1.0) * random.standard_normal(2)
        is_mean, is_run = told["mean_low"].le(truth) & told["mean_high"].ge(truth), told["run_low"].le(run) & told["run_high"].ge(run)
        covered.append([is_mean.mean(), is_run.mean()])
    return np.mean(covered, axis=0)


def seeds_coverage(is_hypercube, seeds, ratio, functions, number=20261124):
    """Share of intervals of the first order that have the true index in them, where the effect of one of two factors differs between seeds."""
    random, covered = np.random.default_rng(number), []
    for _ in range(functions):
        points = 2.0 * qmc.LatinHypercube(2, seed=random).random(16) - 1.0 if is_hypercube else GRID
        x, group = np.repeat(points, seeds, axis=0), np.tile(np.arange(seeds), len(points))
        y = (1.0 + ratio * random.standard_normal(seeds)[group]) * x[:, 0] + x[:, 1] + NOISE * random.standard_normal(len(x))
        table = sensitivity(study_of(x, y, group, "latin-hypercube" if is_hypercube else "central-composite")).table.iloc[:2]
        covered.append(((table["first_order_low"] <= 0.503) & (table["first_order_high"] >= 0.497)).mean())
    return np.mean(covered)


def sensitivity_coverage(kind, factors, points, seeds, functions, number=20261124):
    """Shares of intervals of indices of the first order and of total ones that have the true index in them."""
    random, covered = np.random.default_rng(number), []
    for _ in range(functions):
        response = function(kind, factors, random)
        x = np.repeat(2.0 * qmc.LatinHypercube(factors, seed=random).random(points) - 1.0, seeds, axis=0)
        study = study_of(x, response(x) + NOISE * random.standard_normal(len(x)), np.tile(np.arange(seeds), points))
        table = sensitivity(study).table.iloc[:factors]
        both = 2.0 * qmc.Sobol(2 * factors, seed=3).random(8192) - 1.0
        a, b = both[:, :factors], both[:, factors:]
        mixed = np.array([response(np.where(np.arange(factors) == at, b, a)) for at in range(factors)])
        true = stats.sobol_indices(func={"f_A": response(a)[None], "f_B": response(b)[None], "f_AB": mixed[:, None]}, n=len(a))
        truth = {"first_order": true.first_order.ravel(), "total": true.total_order.ravel()}
        # The true index has an error of its sample, too.
        low, high = ({name: table[f"{name}_{end}"] + sign for name in truth} for end, sign in (("low", -0.005), ("high", 0.005)))
        covered.append([((low[name] <= truth[name]) & (truth[name] <= high[name])).mean() for name in truth])
    return np.mean(covered, axis=0)
