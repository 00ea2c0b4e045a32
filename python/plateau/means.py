"""Means over a part of a run and their standard errors, by the formulas of the program (crates/core/src/observe/window_mean.rs)."""

from typing import Any, NamedTuple

import numpy as np

from plateau.errors import InputError

# Floating-point numbers, shape (samples,).
Array = np.ndarray[Any, np.dtype[np.float64]]

LAST_PART = 0.1
LEAST_REVOLUTIONS = 10.0
# Least number of parts of a window for an error.
LEAST_PARTS = 5
ROUNDING = 1e-9


class Mean(NamedTuple):
    """Mean of a quantity over a part of a run.

    Attributes
    ----------
    value : float
        The mean, in the unit of the quantity.
    error : float
        Its standard error; NaN if the part is too short (fewer than five samples or revolutions).
    start, end : float
        The part, s.
    revolutions : float
        Simulated revolutions of the disc in it; NaN if they are not known.
    """

    value: float
    error: float
    start: float
    end: float
    revolutions: float


def standard_error(values: Array) -> float:
    """Standard error of the mean of successive values in time, which may be correlated.

    The autocovariances are summed up to the end of the initial monotone sequence (Geyer, Statistical Science 7 (1992) 473-483), and
    corrected because the mean is calculated from the same values (Straatsma, Berendsen, Stam, Molecular Physics 57 (1986) 89-95).

    Parameters
    ----------
    values : array, shape (n,)

    Returns
    -------
    float
        In the unit of the values; for independent values it is s/√n.

    Examples
    --------
    >>> float(standard_error(np.array([1.0, -1.0, 1.0, -1.0])) ** 2 * 3)
    1.0
    """
    n, rest = len(values), values - values.mean()
    covariance = [float((rest[: n - lag] * rest[lag:]).sum()) / n for lag in range(n // 2 + 1)]
    lags, total, before = 0, -covariance[0], np.inf
    while lags + 2 <= n // 2:
        pair = min(covariance[lags] + covariance[lags + 1], before)
        if pair <= 0:
            break
        lags, total, before = lags + 2, total + 2 * pair, pair
    if total < covariance[0]:
        lags, total = 1, covariance[0]
    return float(np.sqrt(total * n / ((n - lags) * (n - lags + 1))))


def last_tenth(time: Array, revolutions: Array | None) -> tuple[float, float]:
    """The last tenth of a run, from a sample to the last one; at least ten simulated revolutions, if the run has that many.

    Parameters
    ----------
    time : array, shape (samples,)
        Times, s, ascending.
    revolutions : array, shape (samples,), optional
        Simulated revolutions until then.

    Returns
    -------
    tuple of float
        Start and end, s.
    """
    first = int(np.searchsorted(time, time[-1] * (1 - LAST_PART) * (1 + ROUNDING), side="right"))
    if revolutions is not None:
        latest = revolutions[-1] - LEAST_REVOLUTIONS * (1 - ROUNDING)
        first = min(first, int(np.searchsorted(revolutions, latest, side="right")))
    return (0.0 if first == 0 else float(time[first - 1])), float(time[-1])


def mean_between(time: Array, integral: Array, revolutions: Array | None, start: float, end: float) -> Mean:
    """Mean between two times, from the integral over time: exact if these are times of samples.

    For the error, the part is divided into blocks of equal length: one for each interval between samples, but none shorter than a
    simulated revolution; `standard_error` takes into account that blocks are correlated.

    Parameters
    ----------
    time : array, shape (samples,)
        Times, s, ascending.
    integral : array, shape (samples,)
        Integral of the quantity from 0 to each of them, its unit times s.
    revolutions : array, shape (samples,), optional
        Simulated revolutions until then.
    start, end : float
        The part, s.

    Returns
    -------
    Mean
    """
    if not 0 <= start < end <= time[-1] * (1 + ROUNDING):
        raise InputError(f"from {start:g} to {end:g} s: expected times in order, between 0 and {time[-1]:g} s")
    known, sums = np.concatenate([[0.0], time]), np.concatenate([[0.0], integral])
    blocks, turns = 1 + int(((start < time) & (time < end)).sum()), float("nan")
    if revolutions is not None:
        turned = np.interp([start, end], known, np.concatenate([[0.0], revolutions]))
        turns = float(turned[1] - turned[0])
        blocks = min(blocks, int(turns * (1 + ROUNDING)))
    at = np.interp([start, end], known, sums)
    error = float("nan")
    if blocks >= LEAST_PARTS:
        edges = np.interp(np.linspace(start, end, blocks + 1), known, sums)
        error = standard_error(np.diff(edges) * (blocks / (end - start)))
    return Mean(float((at[1] - at[0]) / (end - start)), error, start, end, turns)
