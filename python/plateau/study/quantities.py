"""Quantities that people write with any unit of the same kind, such as ``"1.3 mm^2"``, in SI units."""

import json
import math
import re
from fractions import Fraction

from plateau.errors import InputError
from plateau.study.units import ICE, NUMBER, plain

# Powers of m, kg, s, rad and K, and how many SI units it is; these take a prefix.
PREFIXED: dict[str, tuple[tuple[int, ...], int | Fraction]] = {
    "m": ((1, 0, 0, 0, 0), 1),
    "s": ((0, 0, 1, 0, 0), 1),
    "N": ((1, 1, -2, 0, 0), 1),
    "Pa": ((-1, 1, -2, 0, 0), 1),
    "g": ((0, 1, 0, 0, 0), Fraction(1, 1000)),
    "Hz": ((0, 0, -1, 0, 0), 1),
    "J": ((2, 1, -2, 0, 0), 1),
    "W": ((2, 1, -3, 0, 0), 1),
    "K": ((0, 0, 0, 0, 1), 1),
}
TURN = Fraction(math.tau)
ALONE: dict[str, tuple[tuple[int, ...], int | Fraction]] = {
    "1": ((0, 0, 0, 0, 0), 1),
    "%": ((0, 0, 0, 0, 0), Fraction(1, 100)),
    "min": ((0, 0, 1, 0, 0), 60),
    "h": ((0, 0, 1, 0, 0), 3600),
    "d": ((0, 0, 1, 0, 0), 86400),
    "bar": ((-1, 1, -2, 0, 0), 100000),
    "rad": ((0, 0, 0, 1, 0), 1),
    "deg": ((0, 0, 0, 1, 0), TURN / 360),
    "rev": ((0, 0, 0, 1, 0), TURN),
    "rpm": ((0, 0, -1, 1, 0), TURN / 60),
    "RPM": ((0, 0, -1, 1, 0), TURN / 60),
    "Nm": ((2, 1, -2, 0, 0), 1),
}
PREFIXES = {"p": -12, "n": -9, "u": -6, "m": -3, "c": -2, "k": 3, "M": 6, "G": 9, "T": 12}
UNITS: dict[str, tuple[tuple[int, ...], int | Fraction]] = {
    **{
        prefix + name: (powers, one * Fraction(f"1e{tens}"))
        for prefix, tens in PREFIXES.items()
        for name, (powers, one) in PREFIXED.items()
    },
    **PREFIXED,
    **ALONE,
}
TOKEN = re.compile(r"\s*(?:([()/*·⋅])|([A-Za-z]+|[1%])(-?[1-9])?)\s*")


def scale_of(unit: str) -> tuple[tuple[int, ...], Fraction]:
    """Powers of m, kg, s, rad and K of a unit, and how many SI units it is.

    Parameters
    ----------
    unit : str
        Such as ``"mm^3/(N m)"``.

    Returns
    -------
    tuple
    """
    text, at, powers, factor = plain(unit), 0, [0] * 5, Fraction(1)
    # Only products and quotients: each symbol has the sign of all groups that it is in.
    groups, sign = [1], 1
    while at < len(text):
        found = TOKEN.match(text, at)
        if found is None or found[2] and found[2] not in UNITS or found[1] == ")" and len(groups) < 2:
            raise InputError(f'unknown unit "{unit}"')
        at = found.end()
        if found[1] == "(":
            groups.append(groups[-1] * sign)
        elif found[1] == ")":
            groups.pop()
        elif found[2]:
            of, one = UNITS[found[2]]
            power = groups[-1] * sign * int(found[3] or 1)
            powers, factor = [own + power * each for own, each in zip(powers, of, strict=True)], factor * Fraction(one) ** power
        sign = -1 if found[1] == "/" else 1
    if len(groups) > 1:
        raise InputError(f'"{unit}": a parenthesis is not closed')
    return tuple(powers), factor


def in_si(number: str | float, unit: str, si: str, *, is_difference: bool = False) -> float:
    """A number with a unit in the SI unit of the same kind, correctly rounded.

    Parameters
    ----------
    number : str or float
        A finite number.
    unit, si : str
    is_difference : bool
        Whether it is a difference, of which 5 °C are 5 K.

    Returns
    -------
    float

    Raises
    ------
    InputError
        If the unit measures something else, or the number is too large.
    """
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


def quantity(said: object, si: str, *, is_difference: bool = False) -> float:
    """A number in SI units, or text with a unit, as study files have them.

    Parameters
    ----------
    said : int, float or str
    si : str
    is_difference : bool

    Returns
    -------
    float

    Raises
    ------
    InputError
        If it is neither.
    """
    expected = "expected a number, or one with %" if si == "1" else f"expected a number in {si}, or one with a unit"
    if isinstance(said, int | float) and not isinstance(said, bool) and math.isfinite(said):
        return float(said)
    found = re.fullmatch(rf"({NUMBER})\s*(\D.*)", str(said).strip().replace("\N{MINUS SIGN}", "-")) if isinstance(said, str) else None
    if found is None or not math.isfinite(float(found[1])) or si == "1" and found[2].strip() != "%":
        raise InputError(f"{json.dumps(said, default=str, ensure_ascii=False)}, {expected}")
    try:
        return in_si(found[1], found[2].strip(), si, is_difference=is_difference)
    except InputError as error:
        raise InputError(f'"{said}": {error}, {expected}') from None
