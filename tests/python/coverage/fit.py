"""Coverage of the 95 % intervals of `plateau fit`, by artificial experiments.

Two keys, three responses that are curved by lot, three sets of seeds that add something everywhere and noise in each run. What was measured is
the response at true keys with a normal error. Where runs contradict forecast or measurement there is no interval; the share of these is told.
"""

import itertools

import numpy as np
from scipy import stats
from scipy.stats import qmc

from plateau.study.calibration import calibrated
from plateau.study.data import Response
from plateau.study.likelihood import Runs, Target, best_with
from plateau.study.measured import Measurement

SEEDS, POINTS, NOISE, OF_SEEDS, ERROR = 3, 10, 0.02, 0.03, 0.05
TIMES = np.linspace(0.0, 23.0, 24)


class Experiment:
    """An artificial experiment; `number` decides its lot."""

    def __init__(self, number, *, bias=0.0, sharp=0.0, seeds=SEEDS, series=0.0):
        self.random = np.random.default_rng(number)
        self.truth, self.seeds, self.series = self.random.uniform(-0.8, 0.8, 2), seeds, series
        self.shape, self.sharp = self.random.uniform(0.5, 1.5, 6), sharp
        self.added = OF_SEEDS * self.random.standard_normal((seeds, 3))
        values = self.responses(self.truth[None])[0] * np.array([1.0 + bias, 1.0, 1.0])
        if series:
            # Errors of a series last for so many points.
            correlations = np.exp(-np.abs(np.subtract.outer(TIMES, TIMES)) / series)
            values = self.curves(self.truth[None])[0] + ERROR * np.linalg.cholesky(correlations) @ self.random.standard_normal(len(TIMES))
            self.measured = [values]
        else:
            self.measured = list((values + ERROR * self.random.standard_normal(3))[:, None])

    def responses(self, x):
        a, b, c = x[:, 0], x[:, 1], self.shape
        bump = self.sharp * np.exp(-8.0 * ((a - 0.3) ** 2 + (b + 0.2) ** 2))
        return np.stack(
            [np.exp(0.7 * c[0] * a + 0.3 * b) + bump, 3.0 + c[1] * a + np.tanh(c[2] * b), 2.0 + c[3] * np.sin(c[4] * a) + b + c[5] * b * b / 2.0], -1
        )

    def curves(self, x):
        level, rate, trend = self.responses(x).T[:, :, None]
        return level * (1.0 - np.exp(-TIMES / (2.0 + np.abs(rate)))) + 0.03 * trend * TIMES

    def runs(self, places):
        x, group = np.repeat(places, self.seeds, axis=0), np.tile(np.arange(self.seeds), len(places))
        # The same place gives the same run, as the program does.
        lot = np.random.default_rng(np.frombuffer(np.round(places, 9).tobytes(), np.uint32))
        if self.series:
            return Runs(x, group, [self.curves(x) + self.added[group, :1] + NOISE * lot.standard_normal((len(x), 1))])
        y = self.responses(x) + self.added[group] + NOISE * lot.standard_normal((len(x), 3))
        return Runs(x, group, list(y.T[:, :, None]))

    def fitted(self, most=60, discrepancy=0.0, correlation_time=0.0, points=POINTS):
        times = TIMES if self.series else np.array([])
        response = Response("", "1", "", "none", -np.inf, np.inf, {})
        measured = [Measurement(response, times, values, np.full(len(values), ERROR), correlation_time, "") for values in self.measured]
        first = self.runs(2.0 * qmc.Sobol(2, scramble=False).random(points) - 1.0)
        return calibrated(
            Target(measured, [discrepancy] * len(measured), np.eye(len(measured))), first, self.runs, self.seeds, most, [True] * len(measured)
        )


def inside(outcome, truth):
    """Whether the truth is in the region of both keys, and in the interval of each."""
    likelihood = outcome.likelihood
    rises = [best_with(likelihood, {key: float(truth[key])}, likelihood.best)[1] - likelihood.least for key in (0, 1)]
    return [likelihood.rise(truth)[0] <= stats.chi2.ppf(0.95, 2), *(rise <= stats.chi2.ppf(0.95, 1) for rise in rises)]


def coverage(experiments, first=0, given=None, **made):
    """Shares of experiments whose truth is in the region, in the intervals, and that have no interval."""
    found, failed = [], 0
    for number in range(first, first + experiments):
        experiment = Experiment(number, **made)
        outcome = experiment.fitted(**(given or {}))
        if outcome.why_no_interval:
            failed += 1
        else:
            found.append(inside(outcome, experiment.truth))
    shares = np.mean(found, axis=0)
    return shares[0], shares[1:].mean(), failed / experiments


def budgets(number, budgets=(30, 31, 40, 60), **made):
    """Of fits with these budgets: how many have intervals, how many pairs of intervals exclude each other, and the most likely places."""
    outcomes = [Experiment(number, **made).fitted(most=most, points=12) for most in budgets]
    good = [outcome.likelihood for outcome in outcomes if not outcome.why_no_interval]
    limit, exclusive = stats.chi2.ppf(0.95, 1), 0
    for (one, other), key in itertools.product(itertools.combinations(good, 2), (0, 1)):
        # Intervals exclude each other if no value of the key is in both; first those are tried that lie between.
        between = np.linspace(one.best[key], other.best[key], 5)
        values = [*between[[2, 1, 3, 0, 4]], *(one.best[key] + np.linspace(-0.2, 0.2, 9))]
        rises = (max(best_with(each, {key: value}, each.best)[1] - each.least for each in (one, other)) for value in np.clip(values, -1.0, 1.0))
        exclusive += not any(rise <= limit for rise in rises)
    return len(good), exclusive, [outcome.likelihood.best for outcome in outcomes]
