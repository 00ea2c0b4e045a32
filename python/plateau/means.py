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
    """Mean of a quantity over a part of a run. Printed, it has its unit, and as many digits as its error tells.

    Attributes
    ----------
    value : float
        The mean, in the unit of the quantity.
    error : float
        Standard error; NaN if the part is too short (fewer than five samples or revolutions).
    start, end : float
        Start and end of the part, s.
    revolutions : float
        Simulated revolutions of the disc in it; NaN if they are not known.
    unit : str
        Unit of value and error; ``"1"`` for plain numbers.

    Examples
    --------
    >>> print(Mean(5.1234e-07, 2.849e-08, 54.0, 60.0, 85.0, "m2"))
    (5.12 ± 0.28)e-07 m2 from 54 to 60 s
    """

    value: float
    error: float
    start: float
    end: float
    revolutions: float
    unit: str = "1"

    def __str__(self) -> str:
        unit = "" if self.unit == "1" else f" {self.unit}"
        part = f"{unit} from {self.start:g} to {self.end:g} s"
        if not (np.isfinite(self.value) and np.isfinite(self.error) and self.error > 0):
            return f"{self.value:.4g}{part}"
        # Two digits of the error, and the value to the same place.
        place = int(f"{self.error:.1e}".split("e")[1]) - 1
        size = max(int(f"{number:.15e}".split("e")[1]) for number in (self.value, self.error))
        if place <= 0 and -4 <= size < 6:
            return f"{self.value:.{-place}f} ± {self.error:.{-place}f}{part}"
        scale = float(f"1e{size}")
        return f"({self.value / scale:.{size - place}f} ± {self.error / scale:.{size - place}f})e{size:+03d}{part}"


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
    """The last tenth of a run from its times, s: start and end; at least ten simulated revolutions, if the run has that many."""
    first = int(np.searchsorted(time, time[-1] * (1 - LAST_PART) * (1 + ROUNDING), side="right"))
    if revolutions is not None:
        latest = revolutions[-1] - LEAST_REVOLUTIONS * (1 - ROUNDING)
        first = min(first, int(np.searchsorted(revolutions, latest, side="right")))
    return (0.0 if first == 0 else float(time[first - 1])), float(time[-1])


def mean_between(time: Array, integral: Array, revolutions: Array | None, start: float, end: float, known_time: Array | None = None) -> Mean:
    """Mean between two times, from the integral over time: exact if these are times of samples.

    For the error, the part is divided into blocks of equal length: one for each interval between samples, but none shorter than a
    simulated revolution; `standard_error` takes into account that blocks are correlated. Time in which the quantity has no value is
    taken out before.

    Parameters
    ----------
    time : array, shape (samples,)
        Times, s, ascending.
    integral : array, shape (samples,)
        Integral of the quantity from 0 to each of them, its unit times s.
    revolutions : array, shape (samples,), optional
        Simulated revolutions until then.
    start, end : float
        Start and end of the part, s.
    known_time : array, shape (samples,), optional
        Time until each of them in which the quantity has a value, s: the mean is over this time. By default all of it.

    Returns
    -------
    Mean
        NaN if the quantity has no value in the part.
    """
    if not 0 <= start < end <= time[-1] * (1 + ROUNDING):
        raise InputError(f"from {start:g} to {end:g} s: expected times in order, between 0 and {time[-1]:g} s")

    def cumulative(values: Array) -> Array:
        return np.concatenate([[0.0], values])

    first, last = start, end
    if known_time is not None:
        first, last = (float(moment) for moment in np.interp([start, end], cumulative(time), cumulative(known_time)))
        # On the axis of that time, without the samples at which it stands still.
        moves = np.diff(np.maximum.accumulate(cumulative(known_time))) > 0
        time, integral = known_time[moves], integral[moves]
        revolutions = None if revolutions is None else revolutions[moves]
    # What is left of a difference of nothing is no time.
    if not last - first > ROUNDING * (end - start):
        return Mean(float("nan"), float("nan"), start, end, 0.0 if revolutions is not None else float("nan"))

    known, sums = cumulative(time), cumulative(integral)
    blocks, turns = 1 + int(((first < time) & (time < last)).sum()), float("nan")
    if revolutions is not None:
        turned = np.interp([first, last], known, cumulative(revolutions))
        turns = float(turned[1] - turned[0])
        blocks = min(blocks, int(turns * (1 + ROUNDING)))
    error = float("nan")
    if blocks >= LEAST_PARTS:
        error = standard_error(np.diff(np.interp(np.linspace(first, last, blocks + 1), known, sums)) * blocks / (last - first))
    value = np.diff(np.interp([first, last], known, sums))[0] / (last - first)
    return Mean(float(value), error, start, end, turns)
