"""Units in which people read and write quantities, and numbers with as many digits as their errors leave."""

import functools
import json
import math
import operator
import re
from dataclasses import dataclass
from fractions import Fraction
from numbers import Real
from typing import Any

import numpy as np

from plateau.errors import InputError, InputTypeError, shown
from plateau.native import native

# By SI unit, from the smallest on: symbol, how many of it are one SI unit, and the size, SI, below which it is taken.
LADDERS: dict[str, list[tuple[str, float, float]]] = {
    "m": [("nm", 1e9, 0.9e-6), ("µm", 1e6, 0.9e-3), ("mm", 1e3, 0.9), ("m", 1.0, math.inf)],
    "m2": [("µm²", 1e12, 1e-9), ("mm²", 1e6, math.inf)],
    "m3": [("µm³", 1e18, 1e-13), ("mm³", 1e9, math.inf)],
    "m2 s": [("mm² s", 1e6, math.inf)],
    "Pa": [("Pa", 1.0, 1e3), ("kPa", 1e-3, 1e5), ("MPa", 1e-6, math.inf)],
    "s": [("ms", 1e3, 0.1), ("s", 1.0, 2e4), ("h", 1 / 3600, math.inf)],
    "1": [("", 1.0, math.inf)],
    "K": [("°C", 1.0, math.inf)],
    "J": [("J", 1.0, 0.9e3), ("kJ", 1e-3, 0.9e6), ("MJ", 1e-6, math.inf)],
    "kg": [("ng", 1e12, 0.9e-9), ("µg", 1e9, 0.9e-6), ("mg", 1e6, 0.9e-3), ("g", 1e3, math.inf)],
    "kg s-1": [("ng/s", 1e12, 0.9e-9), ("µg/s", 1e9, 0.9e-6), ("mg/s", 1e6, math.inf)],
    "kg m-1": [("µg/km", 1e12, 0.09e-9), ("mg/km", 1e9, math.inf)],
    "s-1": [("s⁻¹", 1.0, math.inf)],
    "m-1": [("km⁻¹", 1e3, math.inf)],
}
NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
# To which doubles count exactly.
MOST = 2**53
# 0 °C.
ICE = 273.15


@dataclass(frozen=True)
class Unit:
    """A unit: its symbol, how many of it are one SI unit, and what 0 of the SI unit is in it."""

    symbol: str
    per_si: float
    offset: float = 0.0

    @property
    def of_differences(self) -> str:
        """The symbol of differences: those of temperatures are in K."""
        return "K" if self.offset else self.symbol

    def value(self, value: Any) -> Any:
        """A value, SI, in this unit."""
        return value * self.per_si + self.offset

    def text(self, value: float, error: float = math.nan, *, is_difference: bool = False) -> str:
        """A value, SI, with its unit, and with as many digits as its error leaves: ``"2.08 ± 0.10 mm²"``."""
        if not math.isfinite(value):
            return "–"
        number = value * self.per_si + (0.0 if is_difference else self.offset)
        return f"{with_error(number, error * self.per_si)} {self.of_differences if is_difference else self.symbol}".strip()


def unit_for(si: str, size: float) -> Unit:
    """The unit in which a quantity of this SI unit and size is a number of few digits."""
    symbol, per_si, _ = next((one for one in LADDERS.get(si, []) if size < one[2]), LADDERS.get(si, [(si, 1.0, math.inf)])[-1])
    return Unit(symbol, per_si, -ICE if si == "K" else 0.0)


def unit_of(si: str, values: Any) -> Unit:
    """The unit for the largest of values, SI."""
    sizes = np.abs(np.asarray(values, float))
    return unit_for(si, float(np.max(sizes, initial=0.0, where=~np.isnan(sizes))))


def shown_unit(unit: str) -> str:
    """A unit as it is shown, however it is typed: um, mm^2 and degC are µm, mm² and °C."""

    def shown(found: re.Match[str]) -> str:
        name, power = found[1], found[2] or ""
        try:
            scale_of(name)
        except InputError:
            return found[0]
        return (f"µ{name[1:]}" if name[0] in "uμ" else name) + power.translate(str.maketrans("-123456789", "⁻¹²³⁴⁵⁶⁷⁸⁹"))

    return "°C" if unit.strip() == "degC" else re.sub(r"([A-Za-zµμ]+)\^?(-?[1-9])?", shown, unit.strip())


def with_minus(text: str) -> str:
    """A text with a minus before its numbers and in their powers of ten, as it is shown."""
    return re.sub(r"(?<![\w.)-])-(?=\.?\d)|(?<=\de)-(?=\d)", "\N{MINUS SIGN}", text)


def with_hyphen(text: str) -> str:
    """A text with a hyphen before its numbers, as programs read them."""
    return re.sub("\N{MINUS SIGN}(?=\\.?\\d)", "-", text)


def with_error(number: float, error: float = math.nan) -> str:
    """A number with its error, to two digits of the error; without an error to five digits."""
    if not math.isfinite(error):
        return with_minus(f"{number:.5g}")
    places = min(max(1 - math.floor(math.log10(float(f"{error:.1e}"))), 0), 9) if error > 0 else 4
    return with_minus(f"{number:.{places}f} ± {error:.{places}f}")


def with_digits(value: float, width: float = math.nan) -> str:
    """A number with as many digits as half the width of its interval leaves; four without."""
    if not np.isfinite(value):
        return ""
    if not np.isfinite(width) or width <= 0:
        return with_minus(f"{value:.4g}")
    places, largest = 1 - int(np.floor(np.log10(width))), max(abs(value), width)
    if not 1e-3 <= largest < 1e6:
        return with_minus(f"{value:.{max(int(np.floor(np.log10(largest))) + places, 0)}e}")
    return with_minus(f"{round(value, places):.{max(places, 0)}f}")


def with_unit(name: str, unit: str) -> str:
    """The head of a column: the name, and the unit in brackets if there is one."""
    return name if unit in ("", "1") else f"{name} [{unit}]"


# What people write --------------------------------------------------------------------------------------------------------------------


@functools.cache
def scale_of(unit: str) -> tuple[tuple[int, ...], Fraction]:
    """Powers of m, kg, s, rad and K of a unit, such as ``"mm^3/(N m)"``, and how many SI units it is."""
    # Scenes have no percent, and a hyphen only behind ^.
    powers, tens, times, over = native().scale_of(re.sub(r"\^?[-−]", "^-", unit).replace("%", "(cm/m)"))
    return powers, Fraction(10) ** tens * Fraction(times) / Fraction(over)


def in_si(number: str | float, unit: str, si: str, *, is_difference: bool = False) -> float:
    """A number with a unit in the SI unit of the same kind, correctly rounded; of a difference 5 °C are 5 K."""
    # Exactly 1e-999999999 would be a number of as many digits.
    if not math.isfinite(float(number)):
        raise InputError(f"{number} {unit} is too large a number")
    exact = Fraction(str(number)) if float(number) else Fraction(0)
    try:
        if unit in ("°C", "degC"):
            powers, value = scale_of("K")[0], exact + (0 if is_difference else Fraction(str(ICE)))
        else:
            powers, one = scale_of(unit)
            value = exact * one
        if powers != scale_of(si)[0]:
            raise InputError(f'"{unit}" measures something else than {"a plain number" if si == "1" else si}')
        return float(value)
    except OverflowError:
        raise InputError(f"{number} {unit} is too large a number") from None


def whole(number: Any, what: str, least: int = 0) -> int:
    """A whole number of something, at most as large as doubles count exactly."""
    if isinstance(number, bool) or not hasattr(number, "__index__") or not least <= operator.index(number) <= MOST:
        raise InputError(f"{shown(number)} {what}, expected a whole number from {least} to {MOST}")
    return operator.index(number)


def text_of(number: Any) -> str:
    """The text of a number with a unit, as of pint.

    Raises
    ------
    InputTypeError
        If its unit cannot be written.
    """
    try:
        unit = f"{number.units:~C}"
        return f"{float(number.magnitude)!r} {unit}".replace("**", "^").replace("*", " ")
    except (TypeError, ValueError) as error:
        raise InputTypeError(f"{number!r} is no number with a unit, as of pint: {error}") from None


def quantity(said: object, si: str, *, is_difference: bool = False, needs_unit: bool = True, example: str | None = None) -> float:
    """A number in SI units, or text with a unit.

    Parameters
    ----------
    said : int, float or str, or a number with a unit, as of pint
    si : str
        The SI unit.
    is_difference : bool
        True for a difference, of which 5 °C are 5 K.
    needs_unit : bool
        True if text must have a unit; otherwise text without one is in the SI unit, too.
    example : str, optional
        A text that messages give where a number cannot be given, as on a command line.

    Returns
    -------
    float

    Raises
    ------
    InputError
        If it is neither, not finite, or measures something else; `InputTypeError` of other types.

    Examples
    --------
    >>> quantity("1.5 min", "s"), quantity(90, "s")
    (90.0, 90.0)
    >>> quantity("30 sec", "s")
    Traceback (most recent call last):
    plateau.errors.InputError: "30 sec": unknown unit "sec", expected a number in s, or text with a unit
    """
    expected = "expected a number, or text with %" if si == "1" else f"expected a number in {si}, or text with a unit"
    expected = expected if example is None else f'expected text with a unit, such as "{example}"'
    if hasattr(said, "magnitude") and hasattr(said, "units"):  # of pint
        said = text_of(said)
    is_number = isinstance(said, Real) and not isinstance(said, bool)
    try:
        if is_number and math.isfinite(said):  # type: ignore[arg-type]
            return float(said)  # type: ignore[arg-type]
    except OverflowError:
        raise InputError(f"{shown(said)} is too large a number, {expected}") from None
    if not is_number and not isinstance(said, str):
        raise InputTypeError(f"{shown(said)}, {expected}")
    told = json.dumps(said, default=str, ensure_ascii=False)
    found = re.fullmatch(rf"({NUMBER})\s*(\D.*)?", str(said).strip().replace("\N{MINUS SIGN}", "-"))
    unit = ((found and found[2]) or "").strip() or ("" if needs_unit else si)
    if found is None or not unit or not math.isfinite(float(found[1])) or (si == "1" and unit not in ("%", "1" if not needs_unit else "%")):
        raise InputError(f"{told}, {expected}")
    if re.match(r",\d", unit):
        raise InputError(f"{told}: decimal marks are points, {expected}")
    try:
        return in_si(found[1], unit, si, is_difference=is_difference)
    except InputError as error:
        raise InputError(f"{told}: {error}, {expected}") from None
