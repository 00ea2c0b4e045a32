"""What the likelihood tells of keys: how far it falls where one or two are held, and products that are known where keys are not."""

import itertools
import math

import numpy as np
from scipy import optimize

from plateau.study.data import Numbers
from plateau.study.likelihood import NEAR, Likelihood

# Places of a profile, and along each key of a region: without other keys, and where each place is a search.
PLACES, SIDES = 41, (41, 15)
# Exponents of products below this are none; how many times as well as its leading key a product is known that is told beside the keys.
EXPONENT, BETTER = 0.05, 3.0


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
    values = np.unique(np.clip([*np.linspace(-1.0, 1.0, PLACES), *(best[key] + width * np.linspace(-4.0, 4.0, 17))], -1.0, 1.0))
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
    """Exponents of keys, with 1 for the leading one, of products that are determined where the keys are not, or are known far better.

    `slopes` are those of the responses over their deviations, by logarithms of keys as multiples of `halves`, half their ranges. Each
    product has the factor by which it may be off; the determined ones are None if all keys are.
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
