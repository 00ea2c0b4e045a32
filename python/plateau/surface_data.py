"""Surfaces in the folder of data that ``plateau surface --figure-data`` writes, and what is computed of their heights to be drawn."""

import json
import os
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from plateau.errors import InputError, MissingFileError
from plateau.units import Unit, in_si, unit_for

# Heights farther than this many times the interquartile range outside the quartiles do not widen axes and colours.
FENCE = 5.0
# Points of a spectrum that are drawn, at most.
BANDS = 100
# Heights that are transformed at a time.
AT_A_TIME = 2**22


def told(folder: str | os.PathLike[str], name: str) -> Any:
    """A document (JSON) of a folder of data."""
    path = Path(folder) / name
    if not path.is_file():
        raise MissingFileError(f"{folder} has no {name}: expected a folder of plateau surface --figure-data")
    return json.loads(path.read_text(encoding="utf-8"))


def read(folder: str | os.PathLike[str]) -> "list[Surface]":
    """The surfaces of a folder."""
    found = []
    for one in told(folder, "surfaces.json"):
        heights = np.load(Path(folder) / one["heights"], mmap_mode="r")
        if heights.shape != (one["rows"], one["columns"]):
            expected = f"{one['rows']} rows and {one['columns']} columns"
            raise InputError(f"{folder}/{one['heights']} has the shape {heights.shape}, expected {expected}")
        found.append(Surface(one, heights, np.array(one["material_curve"], float)))
    return found


@dataclass
class Surface:
    """A surface: what the program tells of it, in the units that it names; heights, m, the row 0 has the smallest y; heights at material
    ratios that are equally spaced, m above the mean."""

    told: dict[str, Any]
    heights: Any
    curve: Any

    @cached_property
    def mean(self) -> float:
        """The mean height, m."""
        return float(np.nanmean(self.heights))

    @cached_property
    def pitch(self) -> list[float]:
        """Distances of the points along the axes of the heights, y and x, m; 1 where they are not known."""
        return [in_si(one, self.told["units"]["pitch"], "m") for one in reversed(self.told["pitch"])] if self.told["pitch"] else [1.0, 1.0]

    @property
    def size(self) -> tuple[float, float]:
        """Lengths along x and y, m."""
        return self.heights.shape[1] * self.pitch[1], self.heights.shape[0] * self.pitch[0]

    @property
    def body(self) -> str | None:
        """Body of a scene or a run, ``"disc"`` or ``"pin"``, that this is or whose patch it is; None of other surfaces."""
        return self.told["body"]  # type: ignore[no-any-return]

    def value(self, name: str) -> float:
        """A parameter, m or a plain number; NaN where it has no value."""
        told, unit = self.told.get(name), self.told["units"].get(name, "1")
        return np.nan if told is None else in_si(told, unit, "m" if unit.endswith("m") else "1")

    def text(self, *names: str) -> str:
        """Parameters with three digits."""
        told = []
        for name in names:
            value, unit = self.value(name), self.told["units"].get(name, "1")
            shown = unit_for("m", abs(value) or 1e-6) if unit.endswith("m") else Unit("%", 100.0) if unit == "%" else Unit("", 1.0)
            below = self.told.get(f"{name}_below")
            text = f"{shown.value(value):.3g} {shown.symbol}" if np.isfinite(value) else "–" if below is None else f"< {below:.3g}"
            told.append(f"{name} {text}".strip().replace("-", "−"))
        return "   ".join(told)

    @cached_property
    def spectra(self) -> list[tuple[Any, Any]]:
        """Power spectra along x and y: spatial frequencies, 1/m, and densities, m³."""
        return [power_spectrum(self.heights, self.pitch[axis], axis) for axis in (1, 0)]

    def central(self, part: float) -> list[float]:
        """The least and the greatest height, m above the mean, but for a part of all on either side, and without those far out."""
        low, high, *quartiles = np.interp([1 - part, part, 0.75, 0.25], np.linspace(0, 1, len(self.curve)), self.curve)
        fence = FENCE * (quartiles[1] - quartiles[0])
        # More than half of the heights may be equal.
        return [max(low, quartiles[0] - fence), min(high, quartiles[1] + fence)] if fence > 0 else [low, high]

    @property
    def core(self) -> list[float]:
        """Heights, m above the mean, of ratios 1 and 0 on the least-squares line through the flattest 40 % of the material ratio curve."""
        last = len(self.curve) - 1
        part = max(round(0.4 * last), 1)
        at = int(np.argmin(self.curve[:-part] - self.curve[part:]))
        slope, upper = np.polyfit(np.arange(at, at + part + 1) / last, self.curve[at : at + part + 1], 1)
        return [float(slope + upper), float(upper)]


def power_spectrum(heights: Any, pitch: float, axis: int) -> tuple[Any, Any]:
    """Spatial frequencies, 1/m, and the one-sided mean power spectral density, m³, of profiles along x (axis 1) or y (0), with a Hann window.

    The integral is the mean square of the profiles, each less its mean. Missing points are interpolated; profiles of which less than half
    was measured are left out.
    """
    count = heights.shape[axis]
    window = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(count) / count)
    power, squares, used = np.zeros(count // 2 + 1), 0.0, 0
    for some in _profiles(heights, axis):
        some = some[np.isfinite(some).mean(axis=1) >= 0.5]
        for number in np.flatnonzero(np.isnan(some).any(axis=1)):
            there = np.flatnonzero(np.isfinite(some[number]))
            some[number] = np.interp(np.arange(count), there, some[number][there])
        some = some - some.mean(axis=1, keepdims=True)
        squares, used = squares + float((some**2).mean(axis=1).sum()), used + len(some)
        power += (np.abs(np.fft.rfft(some * window)) ** 2).sum(axis=0)
    # All frequencies but this last one stand for two, with both signs.
    power[-1] *= 0.5 if count % 2 == 0 else 1.0
    step, power = 1.0 / (count * pitch), power[1:]
    total = power.sum() * step * used
    return step * np.arange(1, len(power) + 1), power * (squares / total if total > 0 else 0.0)


def in_bands(frequency: Any, density: Any) -> tuple[Any, Any]:
    """Means of a spectrum in bands of equal width on a logarithmic axis, where there are more frequencies than that: a patch that is
    repeated round the ring has power at multiples of its own frequency alone."""
    if len(frequency) <= BANDS:
        return frequency, density
    band = np.searchsorted(np.geomspace(frequency[0], frequency[-1], BANDS), frequency)
    starts = np.flatnonzero(np.diff(band, prepend=-1))
    counts = np.diff(np.append(starts, len(frequency)))
    return np.add.reduceat(frequency, starts) / counts, np.add.reduceat(density, starts) / counts


def autocorrelation(heights: Any, pitch: float, axis: int) -> tuple[Any, Any]:
    """Lags up to half the extent, m, and the autocorrelation along x or y, as that of Sal: the mean over all pairs of measured points."""
    count = heights.shape[axis]
    lags, length, mean = count // 2 + 1, 2 * count, np.nanmean(heights)
    sums, pairs = np.zeros((2, count + 1))
    for some in _profiles(heights, axis):
        there = np.isfinite(some)
        sums += (np.abs(np.fft.rfft(np.where(there, some - mean, 0.0), length)) ** 2).sum(axis=0)
        pairs += (np.abs(np.fft.rfft(there.astype(float), length)) ** 2).sum(axis=0)
    sums, pairs = (np.fft.irfft(one, length)[:lags] for one in (sums, pairs))
    means = np.divide(sums, pairs, out=np.full(lags, np.nan), where=pairs > 0.5)
    return pitch * np.arange(lags), means / (means[0] or np.nan)


def _profiles(heights: Any, axis: int) -> Iterator[Any]:
    """Profiles along an axis, some at a time, as rows that may be changed."""
    rows = heights if axis == 1 else heights.T
    some = max(AT_A_TIME // rows.shape[1], 1)
    yield from (np.array(rows[begin : begin + some], float) for begin in range(0, len(rows), some))


def thinned(values: Any, most: int) -> Any:
    """Every n-th point, at most so many along a side; means would be lower than the heights where waves are short."""
    steps = [-(-count // most) for count in values.shape]
    return values[tuple(slice(step // 2, None, step) for step in steps)]
