"""Likelihood of what was measured, by Gaussian processes of the responses over the keys: its largest, its fall, and what runs would tell.

M. C. Kennedy, A. O'Hagan, J. R. Stat. Soc. B 63(3), 425-464 (2001), doi:10.1111/1467-9868.00294 (calibration with Gaussian processes and
discrepancy of the model); D. Higdon et al., J. Am. Stat. Assoc. 103(482), 570-583 (2008), doi:10.1198/016214507000000888 (series as principal
components); A. Raue et al., Bioinformatics 25(15), 1923-1929 (2009), doi:10.1093/bioinformatics/btp358 (profile likelihood).
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import linalg, optimize, special, stats

from plateau.study.data import Numbers
from plateau.study.measured import Measurement
from plateau.study.process import Equations, Process

# Variance over the runs, as a part of that of the measurement, below which a component of a series is left out; most components.
LEAST, MOST = 0.02, 10
# Part of a measurement's variance below which that of a process no longer counts.
SETTLED = 0.1
# How far -2 ln L rises in the region that has to be known so well.
REGION = 6.0
# A run is made at the most likely place where none is nearer than this, in coded units; steps between places of runs.
NEAR, STEP = 0.1, 1.0 / 256.0
# Places of a profile over the range and near the most likely one, and along each key of a region: without other keys, and where each place is a
# search.
PLACES, AROUND, SIDES = 41, 17, (41, 15)
# Exponents of products below this are none; how many times as well as its leading key a product is known that is told beside the keys.
EXPONENT, BETTER = 0.05, 3.0


@dataclass(frozen=True)
class Runs:
    """Runs of a fit: ``x`` coded keys by run, ``group`` the set of seeds, ``values`` for each measurement, by run and time."""

    x: Numbers
    group: Numbers
    values: list[Numbers]

    def with_more(self, more: "Runs") -> "Runs":
        """Runs of both, these before the others."""
        values = [np.vstack(pair) for pair in zip(self.values, more.values, strict=True)]
        return Runs(np.vstack([self.x, more.x]), np.concatenate([self.group, more.group]), values)


@dataclass(frozen=True)
class Target:
    """Target of a fit: measurements, the discrepancy of the model for each (relative), correlations of single values."""

    measured: Sequence[Measurement]
    discrepancies: Sequence[float]
    correlations: Numbers

    @cached_property
    def singles(self) -> list[int]:
        """Indices of the measurements that are single values."""
        return [at for at, one in enumerate(self.measured) if not one.is_series]

    @cached_property
    def covariance(self) -> Numbers:
        """Covariance of the single values: of measurement and model."""
        deviation = np.array([self.measured[at].uncertainties[0] for at in self.singles])
        of_model = [self.discrepancies[at] * self.measured[at].values[0] for at in self.singles]
        return np.asarray(self.correlations * np.outer(deviation, deviation) + np.diag(np.square(of_model)))

    def root(self, at: int) -> Numbers:
        """Root of the covariance of a series, which divides its errors into independent ones of deviation 1."""
        one = self.measured[at]
        of_model = self.discrepancies[at] * one.values
        covariance = one.correlations * np.outer(one.uncertainties, one.uncertainties) + np.outer(of_model, of_model)
        return np.asarray(linalg.cholesky(covariance, lower=True))


class Components:
    """Principal components of a series, as far as the measurement can see what runs differ in."""

    def __init__(self, root: Numbers, measured: Numbers, runs: Numbers) -> None:
        self.root = root
        self.measured, white = self.white(measured[None])[0], self.white(runs[np.isfinite(runs).all(axis=1)])
        self.mean = white.mean(axis=0)
        _, sizes, axes = np.linalg.svd(white - self.mean, full_matrices=False)
        variances = sizes**2 / len(white)
        kept = int(np.clip((variances > LEAST).sum(), 1, min(MOST, max(len(white) - 1, 1))))
        self.basis, self.left_out = axes[:kept].T, variances[kept:].sum() / max(len(measured) - kept, 1)
        away = self.measured - self.mean
        # What the components leave of the measurement does not depend on the keys.
        self.rest = max(float(away @ away - np.square(away @ self.basis).sum()), 0.0) / (1.0 + self.left_out)

    def white(self, series: Numbers) -> Numbers:
        """Series, by row, with independent errors of deviation 1."""
        return np.asarray(linalg.solve_triangular(self.root, series.T, lower=True, check_finite=False).T)

    def scores(self, series: Numbers) -> Numbers:
        """Scores of series, by row."""
        return np.asarray((self.white(series) - self.mean) @ self.basis)


@dataclass(frozen=True)
class Term:
    """A response, or a component of a series: its process, what was measured, and which measurement it is of."""

    process: Process
    measured: float
    of: int


class Likelihood:
    """-2 ln of the likelihood over the coded keys, from runs so far, with the most likely place `best` and the `least` value there;
    `Process` says where it cannot be. Its `covariance` is that of measurements and model, by term.
    """

    def __init__(self, target: Target, runs: Runs) -> None:
        self.target, self.runs, self.terms = target, runs, list[Term]()
        self.components: dict[int, Components] = {}
        variances: list[float] = []
        for at, one in enumerate(target.measured):
            if one.is_series:
                self.components[at] = found = Components(target.root(at), one.values, runs.values[at])
                columns, aims = found.scores(runs.values[at]).T, found.scores(one.values[None])[0]
                variances += [1.0 + found.left_out] * len(aims)
            else:
                columns, aims = runs.values[at].T, one.values
            for column, aim in zip(columns, aims, strict=True):
                self.terms.append(Term(Process(runs.x, column, runs.group), float(aim), at))
        single = np.array([not target.measured[term.of].is_series for term in self.terms])
        self.covariance = np.zeros((len(single), len(single)))
        self.covariance[np.ix_(single, single)] = target.covariance
        self.covariance[~single, ~single] = variances
        self.aims, self.keys = np.array([term.measured for term in self.terms]), int(runs.x.shape[1])
        self._search()

    def moments(self, places: Numbers) -> tuple[Numbers, Numbers, Numbers]:
        """Means, variances of the processes, and of the mean over the seeds: arrays of place and term."""
        found = np.array([term.process.moments(places) for term in self.terms])
        seeds = np.array([term.process.seeds for term in self.terms])
        return found[:, 0].T, found[:, 1].T, found[:, 2].T / seeds

    def misfit(self, places: Numbers, *, with_processes: bool) -> Numbers:
        """Sum of squares of forecast less measured over the variances of measurement, model, seeds, and if asked to of the processes."""
        return np.asarray(self._squares(places, with_processes)[0] + sum(each.rest for each in self.components.values()))

    @property
    def freedom(self) -> int:
        """Measurements, each point of a series one of them, less keys."""
        return max(sum(len(one.values) for one in self.target.measured) - self.keys, 0)

    def p(self, *, with_processes: bool = False) -> float:
        """Probability of a larger misfit at the most likely place; with no more measurements than keys, of what the ranges leave."""
        return float(stats.chi2.sf(self.misfit(self.best[None], with_processes=with_processes)[0], max(self.freedom, 1)))

    @property
    def agrees_by_ignorance(self) -> bool:
        """True if what was measured is likely at the most likely place only because little is known there."""
        return (known := self.p()) < 0.01 and self.p(with_processes=True) > 10.0 * known

    def apart(self) -> Numbers:
        """Forecasts less what was measured at the most likely place, by term, over all deviations."""
        means, own, seeds = self.moments(self.best[None])
        return np.asarray((means - self.aims)[0] / np.sqrt(np.diag(self.covariance) + self._added(own, seeds)[0]))

    def _added(self, own: Numbers, seeds: Numbers) -> Numbers:
        """Variances of processes and seeds, larger by what few sets of seeds leave open (quantiles of t, Satterthwaite)."""
        total = np.diag(self.covariance) + own + seeds
        freedom = np.array([(term.process.freedom, max(term.process.seeds - 1, 1)) for term in self.terms]).T
        freedom = total**2 / np.maximum(own**2 / freedom[0] + seeds**2 / freedom[1], 1e-9 * total**2)
        return np.asarray(own + seeds + total * ((special.stdtrit(freedom, 0.975) / special.ndtri(0.975)) ** 2 - 1.0))

    def _squares(self, places: Numbers, with_processes: bool) -> tuple[Numbers, Numbers]:
        """Squares of forecast less measured over all variances, but for what components leave, and the logarithm of their determinant."""
        means, own, seeds = self.moments(places)
        covariance = self.covariance + self._added(own * with_processes, seeds)[:, :, None] * np.eye(len(self.terms))
        away = means - self.aims
        return (away * np.linalg.solve(covariance, away[..., None])[..., 0]).sum(-1), np.linalg.slogdet(covariance)[1]

    def value(self, places: Numbers) -> Numbers:
        """-2 ln L at places, but for a constant."""
        squares, logarithm = self._squares(places, True)
        value = squares + logarithm - np.linalg.slogdet(self.covariance)[1]
        return np.where(np.isfinite(value), value, np.inf)

    def rise(self, places: Numbers) -> Numbers:
        """Rise of -2 ln L above the least."""
        return self.value(np.atleast_2d(places)) - self.least

    def _search(self) -> None:
        """Finds the most likely place, and keeps the places looked at, everywhere and near it."""
        keys = self.keys
        even = 2.0 * stats.qmc.Sobol(keys, scramble=False).random_base2(min(6 + keys, 9))[1:] - 1.0
        places = np.vstack([even, np.unique(self.runs.x, axis=0)])
        values = self.value(places)
        found = [self.climbed(places[at], {}) for at in np.argsort(values)[:4]]
        self.best, self.least = min(found, key=lambda one: one[1])
        axes, deviation = self.shape(self.best)
        spread = stats.norm.ppf(stats.qmc.Sobol(keys, scramble=False).random_base2(7)[1:])
        near = np.clip(self.best + 1.5 * (spread * deviation) @ axes.T, -1.0, 1.0)
        self.places = np.vstack([places, near, self.best])
        self.values = np.concatenate([values, self.value(near), [self.least]])
        if self.values.min() < self.least - 1e-3:
            self.best, self.least = self.climbed(self.places[self.values.argmin()], {})

    def slopes(self, place: Numbers) -> Numbers:
        """Slopes of the responses by coded keys, over the deviations of measurement, model and processes."""
        step = 1e-3
        at = np.clip(place + step * np.vstack([np.eye(self.keys), -np.eye(self.keys)]), -1.0, 1.0)
        means = self.moments(at)[0]
        differences = (means[: self.keys] - means[self.keys :]).T / (at[: self.keys] - at[self.keys :]).sum(axis=1)
        _, own, seeds = self.moments(place[None])
        root = linalg.cholesky(self.covariance + np.diag(self._added(own, seeds)[0]), lower=True)
        return np.asarray(linalg.solve_triangular(root, differences, lower=True))

    def shape(self, place: Numbers) -> tuple[Numbers, Numbers]:
        """Axes and deviations of the normal distribution that the likelihood is near a place; no wider than the ranges."""
        slopes = self.slopes(place)
        values, axes = np.linalg.eigh(slopes.T @ slopes + np.eye(self.keys))
        return axes, values**-0.5

    def climbed(self, start: Numbers, held: dict[int, float]) -> tuple[Numbers, float]:
        """The most likely place from a start, with some keys held."""
        free, place = [key for key in range(self.keys) if key not in held], np.array(start, float)
        place[list(held)] = list(held.values())
        if not free:
            return place, float(self.value(place[None])[0])
        step = 1e-3 * np.vstack([np.zeros(len(free)), np.eye(len(free)), -np.eye(len(free))])

        def both(at: Numbers) -> tuple[float, Numbers]:
            places = np.tile(place, (len(step), 1))
            places[:, free] = at + step
            value = self.value(places)
            return value[0], (value[1 : 1 + len(free)] - value[1 + len(free) :]) / 2e-3

        options = {"gtol": 1e-2, "ftol": 1e-6, "maxls": 6}
        found = optimize.minimize(both, place[free], jac=True, bounds=[(-1.0, 1.0)] * len(free), options=options)
        place[free] = found.x
        return place, float(found.fun)

    def share_by_term(self) -> Numbers:
        """The largest variance of each process over that of measurement, model and seeds, where measurements are not unlikely."""
        likely = self.values <= self.least + REGION
        _, own, seeds = self.moments(self.places[likely])
        return np.asarray((own / (np.diag(self.covariance) + seeds)).max(axis=0))

    def next_places(self, count: int, seeds: int, can_run: Sequence[bool]) -> tuple[Numbers, float]:
        """Places where runs teach most, each as if those before it had been run, and the largest share of variance that is left then."""
        _, own, of_seeds = self.moments(self.places)
        fixed, candidates = np.diag(self.covariance) + of_seeds, self.snapped(self.places)
        misfit = self.misfit(candidates, with_processes=True)
        weight = np.exp(0.25 * (misfit.min() - misfit))
        known, chosen, now = np.unique(self.runs.x, axis=0), list[Numbers](), own.copy()
        asked = [at for at, term in enumerate(self.terms) if can_run[term.of]]
        for _ in range(count):
            value = weight * (now[:, asked] / fixed[:, asked]).sum(axis=1)
            value[(np.abs(candidates[:, None] - known).max(axis=-1) < STEP / 2.0).any(axis=1)] = 0.0
            best = self.snapped(self.best)
            is_far = np.abs(best - known).max(axis=1).min() > NEAR
            if not is_far and value.max() <= 0.0:
                break
            chosen.append(best if is_far else candidates[value.argmax()])
            known = np.vstack([known, chosen[-1]])
            for at in asked:
                now[:, at] = own[:, at] * self._left(self.terms[at].process, np.array(chosen), seeds)
        likely = self.values <= self.least + REGION
        return np.array(chosen).reshape(-1, self.keys), float((now / fixed)[likely].max())

    def _left(self, process: Process, new: Numbers, seeds: int) -> Numbers:
        """Variances of a process with more points, over those of now, with middle lengths and noise."""
        middle = np.average(process.logs, axis=0, weights=process.probabilities)
        now = process.solved(middle)
        x, share = np.vstack([now.x, new]), np.concatenate([now.share, np.full(len(new), 1.0 / seeds)])
        # The values do not matter.
        more = Equations(x, np.linspace(0.0, 1.0, len(x)), share, now.replicates, middle[None], now.axes)
        before, after = (each.forecast(self.places)[1][0] for each in (now, more))
        return np.asarray((after + 1e-12) / (before + 1e-12)).clip(max=1.0)

    def snapped(self, places: Numbers) -> Numbers:
        """The nearest places at which runs are made, so that rounding asks for no other run; finer where the likelihood is narrow."""
        step = min(STEP, 2.0 ** np.floor(np.log2(0.2 * self.shape(self.best)[1].min())))
        return np.asarray(np.clip(np.round(np.asarray(places) / step) * step, -1.0, 1.0))

    def of_runs(self, runs: Runs) -> Numbers:
        """Values that runs give of each term, by run."""
        columns = [self.components[at].scores(values) if at in self.components else values for at, values in enumerate(runs.values)]
        return np.hstack(columns)


def best_with(likelihood: Likelihood, held: dict[int, float], start: Numbers) -> tuple[Numbers, float]:
    """The most likely place with some keys held: from a start, and from the most likely known place nearby."""
    starts = [start]
    is_near = np.all([np.abs(likelihood.places[:, key] - value) <= 1.5 * NEAR for key, value in held.items()], axis=0)
    if is_near.any() and len(held) < likelihood.keys:
        starts.append(likelihood.places[is_near][likelihood.values[is_near].argmin()])
    return min((likelihood.climbed(one, held) for one in starts), key=lambda found: found[1])


def profile(likelihood: Likelihood, key: int, threshold: float) -> tuple[Numbers, Numbers, list[tuple[float, float]]]:
    """Coded values of a key with how far -2 ln L rises there, and the pieces in which it stays below a threshold."""
    best, (axes, deviation) = likelihood.best, likelihood.shape(likelihood.best)
    width = math.sqrt(float(np.square(axes[key] * deviation).sum()))
    values = np.unique(np.clip([*np.linspace(-1.0, 1.0, PLACES), *(best[key] + width * np.linspace(-4.0, 4.0, AROUND))], -1.0, 1.0))
    rises, places = np.empty(len(values)), np.empty((len(values), likelihood.keys))
    middle = int(np.abs(values - best[key]).argmin())
    for steps in (range(middle, len(values)), range(middle - 1, -1, -1)):
        last = best
        for at in steps:
            last, value = best_with(likelihood, {key: float(values[at])}, last)
            rises[at], places[at] = value - likelihood.least, last

    def crossing(at: int) -> float:
        def above(value: float) -> float:
            start = places[at if abs(value - values[at]) < abs(value - values[at + 1]) else at + 1]
            return best_with(likelihood, {key: value}, start)[1] - likelihood.least - threshold

        ends = above(values[at]), above(values[at + 1])
        return float(optimize.brentq(above, values[at], values[at + 1], xtol=1e-4) if ends[0] * ends[1] < 0.0 else values[at])

    inside = rises <= threshold
    ends = [crossing(int(at)) for at in np.flatnonzero(inside[1:] != inside[:-1])]
    ends = [*([-1.0] if inside[0] else []), *ends, *([1.0] if inside[-1] else [])]
    return values, np.maximum(rises, 0.0), list(zip(ends[::2], ends[1::2], strict=True))


def region(likelihood: Likelihood, one: int, other: int) -> tuple[Numbers, Numbers, Numbers]:
    """Coded values of two keys, and how far -2 ln L rises, a row for each value of the second."""
    likely = likelihood.places[likelihood.values <= likelihood.least + 12.0]
    side = SIDES[likelihood.keys > 2]
    axes = [np.linspace(max(likely[:, at].min() - 0.1, -1.0), min(likely[:, at].max() + 0.1, 1.0), side) for at in (one, other)]
    if likelihood.keys == 2:
        return axes[0], axes[1], likelihood.rise(np.stack(np.meshgrid(*axes), -1).reshape(-1, 2)).reshape(side, side)
    rises = [best_with(likelihood, {one: x, other: y}, likelihood.best)[1] for y, x in itertools.product(axes[1], axes[0])]
    return axes[0], axes[1], np.reshape(rises, (side, side)) - likelihood.least


def products(slopes: Numbers, halves: Numbers, threshold: float) -> tuple[list[tuple[Numbers, float]] | None, list[tuple[Numbers, float]]]:
    """Exponents of keys and the factor that it may be off by, of products that are determined (None if all keys are), or known far better.

    `slopes` are those of the responses over their deviations, by logarithms of keys as multiples of `halves`, half their ranges.
    """
    values, axes = np.linalg.eigh(slopes.T @ slopes)
    known, size = values > threshold, halves
    along = axes[:, known]
    covariance = (along / values[known]) @ along.T * np.outer(halves, halves)
    if known.all():
        size = np.sqrt(np.diag(covariance))
        values, axes = np.linalg.eigh(covariance / np.outer(size, size))
        along = axes[:, np.sqrt(np.maximum(values, 0.0)) * BETTER <= np.abs(axes).max(axis=0)]
    rows = (along / size[:, None]).T
    for at in range(len(rows)):
        pivot, others = int(np.abs(rows[at]).argmax()), np.arange(len(rows)) != at
        rows[at] /= rows[at, pivot]
        rows[others] -= np.outer(rows[others, pivot], rows[at])
    rows = np.where(np.abs(rows) < EXPONENT, 0.0, rows)
    found = [(row, math.exp(math.sqrt(threshold * float(row @ covariance @ row)))) for row in rows]
    return (None, [one for one in found if np.count_nonzero(one[0]) > 1]) if known.all() else (found, [])
