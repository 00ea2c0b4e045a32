"""Gaussian process: a smooth response of noisy runs, with lengths and noise that are not taken for certain.

A constant plus Matérn's correlations (ν = 5/2). Constant and variance are integrated out (prior 1/σ²), lengths and noise by weighted draws about
the likeliest places and from what is known beforehand (M. S. Handcock, M. L. Stein, Technometrics 35, 403-410 (1993)).
"""

from functools import partial

import numpy as np
import numpy.typing as npt
import pandas
from scipy import optimize, special, stats

from plateau.study.data import Numbers

# Logarithms of lengths (a range is 2 long) and of noise over the variance: median and deviation beforehand, and ends.
LENGTH, NOISE = np.log([2.0, np.e, 0.05, 40.0]), np.log([1e-3, np.exp(3.0), 1e-8, 1e2])
# Points of a process at least, those that they are found from at most, and sets of them that are kept.
LEAST, MOST, KEPT = 3, 300, 48


class Equations:
    """Equations of kriging, solved for many sets (rows) of logarithms of lengths and noise at once."""

    def __init__(self, x: Numbers, y: Numbers, share: Numbers, replicates: tuple[float, int], logs: Numbers, axes: Numbers) -> None:
        self.x, self.share, self.axes, self.replicates = x, share, axes, replicates
        self.lengths, self.noise = np.exp(np.atleast_2d(logs)[:, axes]), np.exp(np.atleast_2d(logs)[:, -1])
        self.known = self.correlation(x)
        root = np.linalg.inv(np.linalg.cholesky(self.known + self.noise[:, None, None] * np.diag(share)))
        ones, values = root.sum(-1), root @ y
        self.information = (ones**2).sum(-1)
        left = values - ones * ((ones * values).sum(-1) / self.information)[:, None]
        self.weights, of_one = ((root.transpose(0, 2, 1) @ each[..., None])[..., 0] for each in (left, ones))
        self.of_constant = of_one / self.information[:, None]
        self.inverse = root.transpose(0, 2, 1) @ root - of_one[:, :, None] * self.of_constant[:, None]
        self.square, self.freedom = (left**2).sum(-1) + replicates[0] / self.noise, len(y) - 1 + replicates[1]
        self.log_determinant = replicates[1] * np.log(self.noise) - 2.0 * np.log(np.diagonal(root, axis1=1, axis2=2)).sum(-1)
        self.log_density = -0.5 * (self.freedom * np.log(self.square) + self.log_determinant + np.log(self.information))

    def apart(self, x: Numbers) -> list[Numbers]:
        """Distances of places and points over the lengths, times √5, by axis."""
        return [np.abs(x[:, at, None] - self.x[:, at]) * (5.0**0.5 / self.lengths[:, at, None, None]) for at in range(x.shape[1])]

    def correlation(self, x: Numbers) -> Numbers:
        """Correlations of the process at places with those at the points (set, place, point)."""
        apart = self.apart(x)
        return np.asarray(np.prod([1.0 + a + a * a / 3.0 for a in apart], axis=0) * np.exp(-np.sum(apart, axis=0)))

    def gradient(self) -> Numbers:
        """Derivatives of `log_density` by the logarithms."""
        pull = self.freedom / self.square[:, None, None] * self.weights[:, :, None] * self.weights[:, None] - self.inverse
        of_axes = [(pull * self.known * (a * a * (1.0 + a) / (3.0 + 3.0 * a + a * a))).sum((1, 2)) for a in self.apart(self.x)]
        of_noise = self.noise * (np.diagonal(pull, axis1=1, axis2=2) @ self.share) + self.freedom * self.replicates[0] / self.noise / self.square
        return 0.5 * np.column_stack([np.transpose(of_axes) @ np.eye(self.axes.max() + 1)[self.axes], of_noise - self.replicates[1]])

    def forecast(self, x: Numbers) -> tuple[Numbers, Numbers]:
        """Weights of the points' values in means at places (set, place, point), and variances over σ² (set, place)."""
        known = self.correlation(x)
        weights, of_constant = known @ self.inverse + self.of_constant[:, None], (known @ self.of_constant[..., None])[..., 0]
        return weights, np.maximum(1.0 - (known * weights).sum(-1) - of_constant + 1.0 / self.information[:, None], 0.0)

    def left_out(self) -> tuple[Numbers, Numbers, Numbers]:
        """Errors of points that are left out, squared scale, log density of Student's t (O. Dubrule, Math. Geol. 15, 687-699 (1983)); set, point."""
        diagonal, freedom, whole = np.diagonal(self.inverse, axis1=1, axis2=2), max(self.freedom - 1, 1), self.square[:, None]
        error, square = self.weights / diagonal, np.maximum(whole - self.weights**2 / diagonal, 1e-12 * whole) / freedom / diagonal
        return error, square, stats.t.logpdf(error / np.sqrt(square), freedom) - 0.5 * np.log(square)


class Process:
    """Gaussian process of a response: columns of `x` are coded numbers and indicators of words, equal rows replicates, `groups` sets of seeds.

    `axes` number the length of each column; `loo` has errors of `means` at `points` (observed less expected) and their expected deviations.
    """

    def __init__(self, x: npt.ArrayLike, y: npt.ArrayLike, groups: npt.ArrayLike | None = None, axes: npt.ArrayLike | None = None) -> None:
        table = pandas.DataFrame(np.asarray(x, float)).assign(y=y, seed=0 if groups is None else np.asarray(groups)).dropna(subset="y")
        places, values = table.drop(columns=["y", "seed"]), table["y"].to_numpy(float)
        point = places.round(9).groupby(list(places), sort=False).ngroup().to_numpy()
        self.points, runs = places.to_numpy()[np.unique(point, return_index=True)[1]], np.bincount(point)
        if len(runs) < LEAST or np.ptp(values) <= 16.0 * np.finfo(float).eps * np.abs(values).max():
            raise ValueError(f"{len(runs)} points have a response: a Gaussian process needs {LEAST} of which not all are equal")
        # A run is the mean of its point, what its seeds add everywhere, and noise.
        seeds, of_point = pandas.get_dummies(table["seed"]).to_numpy(float), np.equal.outer(np.arange(len(runs)), point) / runs[:, None]
        self.offset, self.seeds = values.mean(), seeds.shape[1]
        added = np.linalg.lstsq(seeds - (of_point @ seeds)[point], values - (of_point @ values)[point], rcond=None)[0]
        added -= added.mean()
        means = of_point @ (values - seeds @ added) - self.offset
        rest, freedom = values - self.offset - means[point] - seeds @ added, max(len(values) + 1 - len(runs) - self.seeds, 0)
        # What each set of seeds adds at each point; where it has no run, what it adds everywhere.
        self.added = added + of_point @ (seeds * rest[:, None]) / np.maximum(of_point @ seeds, 1e-300)
        self.means, self.runs, of_column = means + self.offset, runs, np.asarray(range(places.shape[1]) if axes is None else axes, int)
        replicates, some = (float(rest @ rest) if freedom else 0.0, freedom), np.sort(np.random.default_rng(0).permutation(len(runs))[:MOST])
        self.solved = partial(Equations, self.points, means, 1.0 / runs, replicates, axes=of_column)
        of_some = partial(Equations, self.points[some], means[some], 1.0 / runs[some], replicates, axes=of_column)
        middle, spread, low, high = np.array([LENGTH] * (of_column.max() + 1) + [NOISE]).T

        def density(logs: Numbers) -> tuple[Numbers, Numbers]:
            solved, away = of_some(logs=logs), (logs - middle) / spread
            return 0.5 * (away**2).sum(-1) - solved.log_density, away / spread - solved.gradient()

        def evenly(count: int) -> Numbers:
            return np.asarray(special.ndtri(stats.qmc.Sobol(len(middle), scramble=False).random(count) + 0.5 / count))

        # A smooth response with noise and a rough one without may both be likely.
        begin = sorted(np.clip(middle + 1.2 * spread * evenly(64), low, high), key=lambda logs: float(density(logs)[0][0]))
        four = [start for is_noisy in (True, False) for start in [one for one in begin if (one[-1] > np.log(1e-2)) == is_noisy][:2]]
        box, sources, step = optimize.Bounds(low, high), [(middle, np.diag(spread), 4)], 1e-3 * np.eye(len(middle))
        tops = [optimize.minimize(lambda logs: [each[0] for each in density(logs)], start, jac=True, bounds=box) for start in four]
        for top in [top.x for top in tops if top.fun < min(other.fun for other in tops) + 5.0]:
            curved = spread[:, None] * (density(top + step)[1] - density(top - step)[1]) * spread / 2e-3
            value, vector = np.linalg.eigh((curved + curved.T) / 2.0)
            # Nothing is known less well than beforehand; draws are 1.25 times as wide as the curvature says.
            sources.append((top, 1.25 * spread[:, None] * vector / np.sqrt(np.maximum(value, 1.25**2)), 1))
        drawn = np.vstack([at + evenly(part << int(np.clip(np.log2(2e8 / len(some) ** 3), 6, 9) - 3)) @ root.T for at, root, part in sources])
        drawn = drawn[((drawn >= low) & (drawn <= high)).all(-1)]
        by = [np.log(part) + stats.multivariate_normal(at, root @ root.T).logpdf(drawn) for at, root, part in sources]
        solved = of_some(logs=drawn)
        log = solved.log_density - 0.5 * (((drawn - middle) / spread) ** 2).sum(-1) - special.logsumexp(by, axis=0)
        if len(self.points) > MOST:
            drawn, log = drawn[np.argsort(-log)[:8]], np.sort(log)[::-1][:8]
            solved = self.solved(logs=drawn)
        error, square, density_left_out = solved.left_out()
        # Weights that know nothing of the point that is left out.
        without = special.softmax(log[:, None] - density_left_out, axis=0)
        missed = (without * error).sum(0)
        self.loo = missed, np.sqrt((without * (square + (error - missed) ** 2)).sum(0))
        # Points that are missed by more than expected widen all intervals; the mean square of Student's t is more than 1 by its degrees of freedom.
        self.calibration = max(1.0, float(((missed / self.loo[1]) ** 2).mean() * (1.0 - 2.0 / max(solved.freedom - 1, 3))))
        chosen, times = np.unique(np.searchsorted(np.cumsum(special.softmax(log))[:-1], (np.arange(KEPT) + 0.5) / KEPT), return_counts=True)
        self.logs, self.probabilities, self.sets = drawn[chosen], times / KEPT, self.solved(logs=drawn[chosen])
        self.freedom, self.run_variance = solved.freedom, float(self.probabilities @ (self.sets.noise * self.sets.square)) / solved.freedom

    def moments(self, x: npt.ArrayLike) -> Numbers:
        """Means, variances of their own, and of what another set of seeds adds, at places: three rows."""
        places, found = np.atleast_2d(np.asarray(x, float)), []
        for part in np.array_split(places, 1 + len(places) * len(self.points) * len(self.logs) // 10**6):
            each, shares = self.sets.forecast(part)
            means, weights = each @ (self.means - self.offset), np.tensordot(self.probabilities, each, 1)
            own = self.probabilities @ (self.sets.square[:, None] / self.freedom * shares + (means - self.probabilities @ means) ** 2)
            seeds = ((weights @ self.added) ** 2).sum(-1) / max(self.seeds - 1, 1) - self.run_variance * (weights**2).sum(-1)
            found.append([self.offset + self.probabilities @ means, self.calibration * own, np.maximum(seeds, 0.0)])
        return np.concatenate(found, axis=1)

    def intervals(self, x: npt.ArrayLike, confidence: float) -> Numbers:
        """Means, ends of their intervals, and ends of those of runs: five columns. Degrees of freedom are Satterthwaite's."""
        mean, own, seeds = self.moments(x)
        own, seeds = np.array([own, own + self.run_variance]), np.outer([1.0 / self.seeds, 1.0 + 1.0 / self.seeds], seeds)
        freedom = (own + seeds) ** 2 / (own**2 / self.freedom + seeds**2 / max(self.seeds - 1, 1))
        reach = stats.t.ppf(0.5 + confidence / 2.0, freedom) * np.sqrt(own + seeds)
        return np.column_stack([mean, mean - reach[0], mean + reach[0], mean - reach[1], mean + reach[1]])
