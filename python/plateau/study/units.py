"""Units in which people read and write quantities, and numbers with as many digits as their errors leave."""

import math
import re
from dataclasses import dataclass
from typing import Any

import numpy as np

from plateau.errors import InputError

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
    return unit_for(si, float(np.nanmax(np.abs(np.asarray(values, float)), initial=0.0)))


def parsed(si: str, text: str) -> float:
    """A value that is written with or without a unit, such as ``"1.5 mm3"``, in SI units."""
    said = text.strip().replace("\N{MINUS SIGN}", "-")
    found = re.fullmatch(rf"({NUMBER})\s*(.*)", said)
    if found is None:
        raise InputError(f'"{text}" is not a number with a unit')
    number, name = float(found[1]), plain(found[2])
    units = {plain(symbol): (per_si, -ICE if symbol == "°C" else 0.0) for symbol, per_si, _ in LADDERS.get(si, [])} | {
        plain(si): (1.0, 0.0)
    }
    if si == "1":
        units = {"": (1.0, 0.0), "%": (100.0, 0.0)}
    if name not in units:
        raise InputError(f'"{text}": expected a unit of {", ".join(unit or "none" for unit in units)}')
    per_si, offset = units[name]
    return (number - offset) / per_si


def plain(unit: str) -> str:
    """A unit as it is typed: mm², mm^2 and mm2 are the same."""
    return unit.strip().translate(str.maketrans("²³¹⁻−µμ", "231--uu", "^"))


def with_error(number: float, error: float = math.nan) -> str:
    """A number with its error, to two digits of the error; without an error to five digits."""
    if not math.isfinite(error):
        return f"{number:.5g}"
    places = min(max(1 - math.floor(math.log10(float(f"{error:.1e}"))), 0), 9) if error > 0 else 4
    return f"{number:.{places}f} ± {error:.{places}f}"


def with_digits(value: float, width: float = math.nan) -> str:
    """A number with as many digits as half the width of its interval leaves; four without."""
    if not np.isfinite(value):
        return ""
    if not np.isfinite(width) or width <= 0:
        return f"{value:.4g}".replace("-", "−")
    places, largest = 1 - int(np.floor(np.log10(width))), max(abs(value), width)
    if not 1e-3 <= largest < 1e6:
        return f"{value:.{max(int(np.floor(np.log10(largest))) + places, 0)}e}".replace("-", "−")
    return f"{round(value, places):.{max(places, 0)}f}".replace("-", "−")


def with_unit(name: str, unit: str) -> str:
    """The head of a column: the name, and the unit in brackets if there is one."""
    return name if unit in ("", "1") else f"{name} [{unit}]"
