"""A study as data: factors, responses and runs."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas
import xarray

from plateau.units import shown_unit, with_minus

Numbers = npt.NDArray[np.float64]

# Scales on which a response can be fitted, and the way back. It never falls, so that ends of intervals stay ends.
TRANSFORMS: dict[str, tuple[Any, Any]] = {
    "none": (lambda y: y, lambda y: y),
    "log": (np.log, np.exp),
    "square root": (np.sqrt, lambda y: np.maximum(y, 0.0) ** 2),
    "logit": (lambda y: np.log(y) - np.log1p(-y), lambda y: 1.0 / (1.0 + np.exp(-y))),
}


@dataclass(frozen=True)
class Factor:
    """A factor of a study.

    Attributes
    ----------
    name : str
        Name in the study, with `` (factor)`` behind it where tables have a column of that name.
    keys : str
        The keys of the scene that it sets; empty if it is set elsewhere.
    unit : str
        SI unit of its numbers; ``"1"`` without a unit, ``""`` for words.
    levels : tuple
        Values that it is set to, in the order of the study: numbers in SI units or words; the two ends of a range.
    is_range : bool
        True if it may have any value between two ends.
    logarithmic : bool
        True if equal steps of the range are equal ratios.
    whole : bool
        True if its numbers are whole.
    study_unit : str
        The unit in which the study states it; empty without one.
    one, zero : float
        Values of one and 0 of that unit in SI units.
    """

    name: str
    keys: str
    unit: str
    levels: tuple[Any, ...]
    is_range: bool
    logarithmic: bool
    whole: bool
    study_unit: str
    one: float
    zero: float

    @property
    def names(self) -> list[str]:
        """Names by which people call it."""
        return [self.name, self.name.removesuffix(" (factor)"), *filter(None, self.keys.split(", "))]

    @property
    def is_number(self) -> bool:
        """True if its values are numbers."""
        return bool(self.levels) and not isinstance(self.levels[0], str)

    @property
    def ends(self) -> tuple[float, float]:
        """The smallest and the largest of its numbers, SI."""
        return (self.levels[0], self.levels[1]) if self.is_range else (min(self.levels), max(self.levels))

    def coded(self, values: Any) -> Numbers:
        """Places of values, SI, between the ends: -1 at the lower one, 1 at the upper one."""
        low, high = self.ends
        place = np.asarray(values, float)
        if self.logarithmic:
            low, high, place = math.log(low), math.log(high), np.log(place)
        return np.asarray((2.0 * place - (low + high)) / (high - low))

    def value(self, coded: Any) -> Numbers:
        """Values in SI units at coded places; the inverse of `coded`."""
        (low, high), share = self.ends, (np.asarray(coded, float) + 1.0) / 2.0
        return np.asarray(low * (high / low) ** share if self.logarithmic else low + (high - low) * share)

    def in_study_unit(self, values: Any) -> Numbers:
        """Numbers, SI, in the unit of the study."""
        return np.asarray((np.asarray(values, float) - self.zero) / self.one)

    def text(self, value: Any) -> str:
        """A value, SI or a word, as it is typed, such as ``"7 N"``."""
        if isinstance(value, str):
            return value
        return f"{float(self.in_study_unit(value)):.6g} {self.study_unit}".strip()

    def shown(self, value: Any, digits: int = 6, *, with_unit: bool = True) -> str:
        """A value as it is shown, such as ``"−5 °C"``; `text` has it as it is typed."""
        if isinstance(value, str):
            return value
        return f"{with_minus(f'{float(self.in_study_unit(value)):.{digits}g}')} {shown_unit(self.study_unit) if with_unit else ''}".strip()


@dataclass(frozen=True)
class Response:
    """A response of a study.

    Attributes
    ----------
    name : str
        Name in the study, with `` (response)`` behind it where tables have a column of that name.
    unit : str
        SI unit; ``"1"`` for plain numbers.
    series : str
        The series of a run that it is taken from; empty for imported values.
    transform : str
        The scale on which it is fitted: ``"none"``, ``"log"``, ``"square root"`` or ``"logit"``.
    low, high : float
        Least and greatest values that it can have, SI; infinite without such a bound.
    asked : dict
        Table in the study file: ``measured``, ``uncertainty``, ``mean``, ...
    """

    name: str
    unit: str
    series: str
    transform: str
    low: float
    high: float
    asked: dict[str, Any]

    @property
    def unit_of_fit(self) -> str:
        """SI unit of what is fitted."""
        return self.unit if self.transform == "none" else "1"

    def scaled(self, values: Any) -> Numbers:
        """Values, SI, on the scale of the fit; not finite where it has no such value."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(TRANSFORMS[self.transform][0](np.asarray(values, float)))

    def back(self, values: Any) -> Numbers:
        """Values of a fit in SI units, no more than can be."""
        return np.asarray(np.clip(TRANSFORMS[self.transform][1](np.asarray(values, float)), self.low, self.high))


class Answer:
    """An answer of a study, which is shown as the text that the command prints."""

    def text(self) -> str:
        """The answer for people."""
        raise NotImplementedError

    def __repr__(self) -> str:
        return self.text().rstrip()


@dataclass(frozen=True, repr=False)
class Study:
    """A study and its results; ``table, data = study`` takes it apart.

    Attributes
    ----------
    title : str
    design : str
        Kind of the design, such as ``"full-factorial"``.
    factors : list of Factor
    responses : list of Response
    runs : pandas.DataFrame
        A row for each run, by its number: ``point``, ``replicate``, ``order``, ``same_as``, ``state``, and by their names all factors and
        responses, in SI units or words; NaN where a run gives no response.
    table : pandas.DataFrame
        Table of the runs for people: quantities in the unit of their column head.
    data : xarray.Dataset
        Factors, responses and series of all runs, with the dimensions ``run`` and ``time`` (``sample`` if the runs have
        different times), SI units.
    document : dict
        The study file.
    path : Path or None
        The study file, if it was opened by it.
    directory : Path
        The folder of its results.
    """

    title: str
    design: str
    factors: list[Factor]
    responses: list[Response]
    runs: pandas.DataFrame
    table: pandas.DataFrame
    data: xarray.Dataset
    document: dict[str, Any]
    path: Path | None
    directory: Path

    def __iter__(self) -> Iterator[Any]:
        return iter((self.table, self.data))

    def __repr__(self) -> str:
        names = ", ".join(factor.name for factor in self.factors), ", ".join(response.name for response in self.responses)
        return f"Study {self.title!r}: {self.design}, {len(self.runs)} runs; factors: {names[0]}; responses: {names[1]}"

    @property
    def seeds(self) -> int:
        """Number of sets of seeds with which each point is run; 1 without replicates."""
        return int(self.runs["replicate"].max()) if len(self.runs) else 1
