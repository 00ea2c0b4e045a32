"""The parameters of ISO 25178-2 and ISO 21920-2 of heights on a grid, and their sampling errors.

docs/surface.md has every definition. Heights are m, shape (rows, columns), x along the second axis; NaN, which takes no part, where there is
none. SurfaceTopography and surfalize have no such parameters of surfaces with missing points.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np

# Heights that are worked on at a time.
AT_A_TIME = 2**20
# Classes of the Abbott-Firestone curve: 0, 0.1, ..., 100 %.
CLASSES = 1000
# Heights that differ by this part of all they span are equal but for rounding.
ROUNDING = 1e-12
# Value to which the autocorrelation decays, Str below which there is a lay, directions that are compared for it, at least.
DECAYED, LAY, FEWEST_DIRECTIONS = 0.2, 0.5, 720
# Blocks into which a surface is divided, about, and the parameters of which they tell nothing: those that are set by single points (Miller
# 1974, doi:10.1093/biomet/61.1.1), and a direction, which has no mean.
BLOCKS, WITHOUT = 25, ("Sp", "Sv", "Sz", "Std")
HEIGHT, CORE, VOLUME, SLOPE, SPATIAL, PROFILE = "height", "Abbott-Firestone curve", "volume", "slope", "autocorrelation", "profiles"
# By symbol, in the order in which they are told: group, unit, factor from SI, name.
PARAMETERS: dict[str, tuple[str, str, float, str]] = {
    "Sa": (HEIGHT, "um", 1e6, "arithmetical mean height"),
    "Sq": (HEIGHT, "um", 1e6, "root-mean-square height"),
    "Ssk": (HEIGHT, "1", 1.0, "skewness"),
    "Sku": (HEIGHT, "1", 1.0, "kurtosis"),
    "Sp": (HEIGHT, "um", 1e6, "maximum peak height"),
    "Sv": (HEIGHT, "um", 1e6, "maximum pit depth"),
    "Sz": (HEIGHT, "um", 1e6, "maximum height"),
    "Sk": (CORE, "um", 1e6, "core height"),
    "Spk": (CORE, "um", 1e6, "reduced peak height"),
    "Svk": (CORE, "um", 1e6, "reduced dale depth"),
    "Smr1": (CORE, "%", 100.0, "material ratio of the peaks"),
    "Smr2": (CORE, "%", 100.0, "material ratio of peaks and core"),
    "Sxp": (CORE, "um", 1e6, "extreme peak height, from 2.5 % to 50 %"),
    "Vmp": (VOLUME, "um", 1e6, "peak material volume per area, to 10 %"),
    "Vmc": (VOLUME, "um", 1e6, "core material volume per area, 10 to 80 %"),
    "Vvc": (VOLUME, "um", 1e6, "core void volume per area, 10 to 80 %"),
    "Vvv": (VOLUME, "um", 1e6, "dale void volume per area, from 80 %"),
    "Vm": (VOLUME, "um", 1e6, "material volume per area, to 80 %"),
    "Vv": (VOLUME, "um", 1e6, "void volume per area, from 10 %"),
    "Sdq": (SLOPE, "1", 1.0, "root-mean-square slope"),
    "Sdr": (SLOPE, "%", 100.0, "developed area over that of the grid, less 1"),
    "Sal": (SPATIAL, "um", 1e6, "autocorrelation length"),
    "Str": (SPATIAL, "1", 1.0, "texture aspect ratio"),
    "Std": (SPATIAL, "deg", 180.0 / np.pi, "texture direction: lay from x towards y"),
}
OF_PROFILES = {"Ra": ("um", 1e6, "arithmetical mean height"), "Rq": ("um", 1e6, "root-mean-square height")}
OF_PROFILES |= {"Rsk": ("1", 1.0, "skewness"), "Rku": ("1", 1.0, "kurtosis")}
PARAMETERS |= {
    f"{name}_{axis}": (PROFILE, unit, factor, f"{about}, {way}")
    for axis, way in (("x", "along"), ("y", "across"))
    for name, (unit, factor, about) in OF_PROFILES.items()
}


def parameters(heights: Any, pitch: tuple[float, float] | None) -> dict[str, Any]:
    """Every parameter by its symbol, SI units, NaN where the heights do not determine it; those that need the pitch, along x and y, m, only
    with one. Besides, ``Str_below``, what Str is less than where a direction has no end, ``below_pitch``, whether Sal ends before the next
    point, and ``curve``, the heights above the mean at the material ratios 0, 0.1, ..., 100 %, m."""
    with np.errstate(all="ignore"):
        known = heights[np.isfinite(heights)]
        if not known.size:
            return {}
        first = known.mean()
        # What rounding left of a large offset is in the mean of the differences.
        mean = first + (known - first).mean()
        curve = _Curve(np.sort(known) - mean)
        found = _moments(curve.z) | _core(curve) | _volumes(curve) | {"curve": curve.at(np.arange(CLASSES + 1) / CLASSES)}
        del known, curve
        if pitch is not None:
            found |= _slopes(heights, pitch) | _spatial(heights, mean, pitch)
        for axis, name in ((1, "x"), (0, "y")):
            found |= {f"{symbol}_{name}": value for symbol, value in _of_profiles(heights, axis).items()}
    return found


def _moments(z: Any) -> dict[str, float]:
    z = z - z.mean()
    square = z * z
    rms = np.sqrt(square.mean())
    skewness, kurtosis = ((square * z).mean() / rms**3, (square * square).mean() / rms**4) if z[-1] > z[0] else (np.nan, np.nan)
    return {"Sa": np.abs(z).mean(), "Sq": rms, "Ssk": skewness, "Sku": kurtosis, "Sp": z[-1], "Sv": -z[0], "Sz": z[-1] - z[0]}


class _Curve:
    """The Abbott-Firestone curve of heights above their mean, the least first: a step for each of them."""

    def __init__(self, z: Any) -> None:
        self.z, self.count = z, len(z)

    def reaching(self, height: float) -> int:
        """Points that are not below a height."""
        return self.count - int(np.searchsorted(self.z, height))

    def material(self, height: float) -> float:
        """Volume of material above a height, per area."""
        return float((self.z[self.count - self.reaching(height) :] - height).sum()) / self.count

    def void(self, height: float) -> float:
        """Volume of void below a height, per area."""
        return float((height - self.z[: self.count - self.reaching(height)]).sum()) / self.count

    def at(self, ratio: Any) -> Any:
        """The largest heights that these fractions of the points reach."""
        # What rounding adds to a ratio of whole points is no further point.
        return self.z[self.count - np.clip(np.ceil(np.asarray(ratio) * self.count - 1e-6).astype(int), 1, self.count)]


def _core(curve: _Curve) -> dict[str, float]:
    """The secant over 40 % of the points with the least slope, the first such from the top, and the line through its points, which ends where
    the core does; peaks and dales beyond are triangles of the same areas."""
    z, count, width = curve.z, curve.count, int(0.4 * curve.count)
    if width < 2:
        return dict.fromkeys(("Sk", "Spk", "Svk", "Smr1", "Smr2"), np.nan)
    falls = (z[width:] - z[: count - width])[::-1]
    begin = int(np.argmax(falls <= falls.min() + ROUNDING * (z[-1] - z[0])))
    central, step = z[::-1][begin : begin + width + 1], np.arange(width + 1) - 0.5 * width
    middle = central.mean()
    slope = step @ (central - middle) / (step @ step)
    # A point covers the ratios from its index to the next: in indices, 0 % is at -1/2.
    upper, lower = (float(middle + slope * (end - begin - 0.5 * width)) for end in (-0.5, count - 0.5))
    peaks, dales = (curve.reaching(end) / count if z[-1] > z[0] else np.nan for end in (upper, lower))
    heights = (2.0 * area / base if base > 0.0 else 0.0 for area, base in ((curve.material(upper), peaks), (curve.void(lower), 1.0 - dales)))
    return dict(zip(("Sk", "Spk", "Svk", "Smr1", "Smr2"), (upper - lower, *heights, peaks, dales), strict=True))


def _volumes(curve: _Curve) -> dict[str, float]:
    peak, dale, high, median = curve.at([0.1, 0.8, 0.025, 0.5])
    found = {"Sxp": high - median, "Vmp": curve.material(peak), "Vmc": curve.material(dale) - curve.material(peak)}
    return found | {"Vvc": curve.void(peak) - curve.void(dale), "Vvv": curve.void(dale), "Vm": curve.material(dale), "Vv": curve.void(peak)}


def _slopes(heights: Any, pitch: tuple[float, float]) -> dict[str, float]:
    """Sdq from each difference of neighbours once. Sdr from the triangles between neighbours: a cell of four points is divided along either
    diagonal, and the mean of the two is taken, so that no direction is preferred."""
    sums, counts = np.zeros(3), np.zeros(3)

    def add(place: int, values: Any) -> None:
        sums[place] += np.nansum(values)
        counts[place] += np.count_nonzero(np.isfinite(values))

    for some in _blocks(heights.shape):
        z = np.asarray(heights[some.start : some.stop + 1])
        along, across = (np.diff(z, axis=1) / pitch[0]) ** 2, (np.diff(z, axis=0) / pitch[1]) ** 2
        add(0, along[: some.stop - some.start])
        add(1, across)
        squares = (one + other for one in (along[:-1], along[1:]) for other in (across[:, :-1], across[:, 1:]))
        # The root of 1 + s, less 1, without the loss of digits where s is small.
        add(2, 0.25 * sum(one / (1.0 + np.sqrt(1.0 + one)) for one in squares))
    x, y, excess = sums / counts
    return {"Sdq": np.sqrt(x + y), "Sdr": excess}


def _of_profiles(heights: Any, axis: int) -> dict[str, float]:
    """Means over the profiles along an axis, each from its own mean, of which at least half of the points, and two, have a height; for
    skewness and kurtosis they must not be flat."""
    lines, found = heights if axis == 1 else heights.T, []
    for some in _blocks(lines.shape):
        z = np.array(lines[some])
        count = np.isfinite(z).sum(axis=1)
        z = z[(count >= 2) & (2 * count >= z.shape[1])]
        if not len(z):
            continue
        z -= np.nanmean(z, axis=1, keepdims=True)
        absolute, square, cube, fourth = (np.nanmean(one, axis=1) for one in (np.abs(z), z * z, z * z * z, z * z * z * z))
        shaped = np.where(np.nanmax(z, axis=1) > np.nanmin(z, axis=1), 1.0, np.nan)
        found.append([absolute, np.sqrt(square), shaped * cube / (square * np.sqrt(square)), shaped * fourth / (square * square)])
    every = np.concatenate(found, axis=1) if found else np.full((4, 1), np.nan)
    return dict(zip(("Ra", "Rq", "Rsk", "Rku"), np.nansum(every, axis=1) / np.isfinite(every).sum(axis=1), strict=True))


def _spatial(heights: Any, mean: float, pitch: tuple[float, float]) -> dict[str, Any]:
    """Sal, Str and Std from the autocorrelation, the mean over all pairs of measured points that are so far apart over its value at no lag,
    for lags up to half the extent: nothing is said of what lies beyond the edges.

    The distance in a direction is that at which it first falls to 0.2 along the straight line to a lag on the edge.
    """
    found: dict[str, Any] = dict.fromkeys(("Sal", "Str", "Std", "Str_below"), np.nan) | {"below_pitch": False}
    rows, columns = heights.shape
    y, x = rows // 2, columns // 2
    if not x or not y:
        return found
    known = np.isfinite(heights)
    if known.all():
        pairs = np.outer(rows - np.abs(np.arange(-y, y + 1)), columns - np.arange(x + 1)).astype(float)
    else:
        pairs = np.rint(_correlated(known, x, y))
        pairs[pairs == 0] = np.nan
    field = _correlated(np.where(known, heights - mean, 0.0), x, y)
    field /= pairs * (field[y, 0] / pairs[y, 0])
    del pairs, known
    ends = [(s, t) for s in range(x) for t in (-y, y)] + [(x, t) for t in range(-y, y + 1)]
    distances, beyond = _followed(field, np.array(ends, float), pitch)
    if not distances.size:
        return found
    (shortest, step), (longest, last) = distances[:, distances[0].argmin()], distances[:, distances[0].argmax()]
    if step == 1:
        return found | {"below_pitch": True}
    found["Sal"] = shortest
    if beyond > 0:
        found["Str_below"] = shortest / max(beyond, longest)
    elif last > 1:
        found["Str"] = shortest / longest
    if np.fmin(found["Str"], found["Str_below"]) < LAY:
        found["Std"] = _direction(field, pitch)
    return found


def _correlated(values: Any, x: int, y: int) -> Any:
    """Sums of the products of all pairs of values for the lags 0 to x along x, -y to y along y. Zeros round the grid keep the transforms from
    closing it on itself (Wiener and Khinchin)."""
    rows, columns = values.shape
    # Multiples of 64, for the transform takes long where there are large prime factors.
    width, height = (-(-length // 64) * 64 for length in (columns + x, rows + y))
    harmonics = np.empty((max(rows, 2 * y + 1), width // 2 + 1), complex)
    for some in _blocks(values.shape):
        harmonics[some] = np.fft.rfft(values[some], width, axis=1)
    for some in _blocks(harmonics.shape[::-1]):
        power = np.fft.fft(harmonics[:rows, some], height, axis=0)
        power = np.fft.ifft(power.real**2 + power.imag**2, axis=0)
        harmonics[: 2 * y + 1, some] = np.concatenate([power[height - y :], power[: y + 1]])
    sums = np.empty((2 * y + 1, x + 1))
    for some in _blocks((2 * y + 1, width)):
        sums[some] = np.fft.irfft(harmonics[some], width, axis=1)[:, : x + 1]
    return sums


def _between(field: Any, x: Any, y: Any) -> Any:
    """The autocorrelation, linear between the four lags about a place, in pitches."""
    left, below = np.floor(x), np.floor(y)

    def at(x: Any, y: Any) -> Any:
        return field[np.clip(y + field.shape[0] // 2, 0, field.shape[0] - 1).astype(int), np.clip(x, 0, field.shape[1] - 1).astype(int)]

    def linear(first: Any, second: Any, part: Any) -> Any:
        return np.where(part == 0, first, first + part * (second - first))

    first, second = (linear(at(one, below), at(one, below + 1), y - below) for one in (left, left + 1))
    return linear(first, second, x - left)


def _followed(field: Any, ends: Any, pitch: tuple[float, float]) -> tuple[Any, float]:
    """Distances at which the autocorrelation falls to 0.2 on the way to each of these lags, m, with the step from one line of the grid of lags
    to the next in which it does; and the longest way, m, on which it does not."""
    steps, lengths = np.abs(ends).max(axis=1), np.hypot(*(ends * pitch).T)
    before, found, beyond = np.ones(len(ends)), [np.empty((2, 0))], 0.0
    step = 0
    while len(ends):
        step += 1
        value = _between(field, *(step * ends.T / steps))
        falls, ended = value <= DECAYED, np.isnan(value)
        part = (before - DECAYED) / (before - value)
        found.append(np.stack([lengths * (step - 1 + part) / steps, np.full(len(ends), step)])[:, falls])
        beyond = max(beyond, (lengths * (step - 1) / steps)[ended].max(initial=0.0), lengths[~falls & ~ended & (steps == step)].max(initial=0.0))
        on = ~falls & ~ended & (steps > step)
        ends, steps, lengths, before = ends[on], steps[on], lengths[on], value[on]
    return np.concatenate(found, axis=1), beyond


def _direction(field: Any, pitch: tuple[float, float]) -> float:
    """The direction along which the autocorrelation is largest in the mean, from the next lag to the nearer edge, rad, above -π/2 and up to π/2.

    This mean is the power of the waves whose crests run along it. Where the surface has one lay it is the direction across the maximum of the
    angular spectrum (ISO 25178-2:2021, 4.3.4), without the leakage of a transform that closes the field.
    """
    step = min(pitch)
    steps = max(int(min((field.shape[1] - 1) * pitch[0], field.shape[0] // 2 * pitch[1]) / step), 1)
    # Two waves of the shortest length that points can show differ by 1/steps rad over the reach.
    count = max(FEWEST_DIRECTIONS, 4 * steps)
    distances, angles = step * np.arange(1, steps + 1), np.pi * (np.arange(count) / count - 0.5)
    means = np.empty(count)
    for some in _blocks((count, steps)):
        angle = angles[some, None]
        means[some] = _mean(_between(field, distances * np.cos(angle) / pitch[0], distances * np.sin(angle) / pitch[1]))
    if np.isnan(means).all():
        return np.nan
    best = int(np.nanargmax(means))
    before, top, after = means[[best - 1, best, (best + 1) % count]]
    # The summit of the parabola through the largest mean and its neighbours.
    shift = 0.5 * (before - after) / (before - 2.0 * top + after)
    place = best + (shift if np.isfinite(shift) else 0.0)
    return float(np.pi * ((place + count if place <= 0 else place) / count - 0.5))


def _mean(values: Any) -> Any:
    return np.nansum(values, axis=1) / np.isfinite(values).sum(axis=1)


def _blocks(shape: tuple[int, ...]) -> Iterator[slice]:
    """Lines of a grid of this shape, some at a time."""
    some = max(AT_A_TIME // max(shape[1], 1), 1)
    yield from (slice(begin, min(begin + some, shape[0])) for begin in range(0, shape[0], some))


def sampling_errors(heights: Any, pitch: tuple[float, float]) -> dict[str, float]:
    """The standard error of every parameter, SI units: what it varies by from one part of this size of a larger surface to another. NaN where it
    is not determined, for extremes and the direction, and with less than four blocks.

    The surface is divided into some 25 blocks, as square as may be. Of the parameters without one block each, θ_i of B, the variance is (B − 1)/B
    Σ (θ_i − θ̄)²: the jackknife over blocks (Künsch 1989, doi:10.1214/aos/1176347265). Blocks have to be larger than the distance over which
    heights are related; of a surface with few such lengths the error is larger than told.
    """
    rows, columns = heights.shape
    along = min(np.clip(np.floor(np.sqrt(BLOCKS * columns * pitch[0] / (rows * pitch[1])) + 0.5), 1, BLOCKS), columns)
    across = np.clip(np.floor(BLOCKS / along + 0.5), 1, rows)
    along, across = int(along), int(across)
    if along * across < 4:
        return dict.fromkeys(PARAMETERS, np.nan)
    without = []
    for block in range(along * across):
        column, row = divmod(block, across)
        left = np.array(heights)
        left[row * rows // across : (row + 1) * rows // across, column * columns // along : (column + 1) * columns // along] = np.nan
        found = parameters(left, pitch)
        without.append([found.get(symbol, np.nan) for symbol in PARAMETERS])
    each = np.array(without)
    errors = np.sqrt(((each - each.mean(axis=0)) ** 2).sum(axis=0) * (len(each) - 1) / len(each))
    return {symbol: np.nan if symbol in WITHOUT else float(error) for symbol, error in zip(PARAMETERS, errors, strict=True)}
