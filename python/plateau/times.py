"""Times as numbers in seconds, or as text with a unit as in scenes."""

import re

from plateau.errors import InputError, InputTypeError
from plateau.units import NUMBER

# In s; the units that the program reads.
UNITS = {"us": 1e-6, "µs": 1e-6, "ms": 1e-3, "s": 1.0, "min": 60.0, "h": 3600.0, "d": 86400.0}
NUMBER_AND_UNIT = re.compile(rf"\s*({NUMBER})\s*(\S*)\s*")


def seconds(time: float | str) -> float:
    """A time in seconds.

    Parameters
    ----------
    time : float or str
        s, or text with a unit: s, ms, min, h.

    Returns
    -------
    float
        s

    Raises
    ------
    InputError
        If it is not a time.

    Examples
    --------
    >>> seconds("1.5 min"), seconds(90)
    (90.0, 90.0)
    >>> seconds("30 sec")
    Traceback (most recent call last):
    plateau.errors.InputError: '30 sec' is no time: expected a number of seconds, or text such as "30 s" (s, ms, min, h)
    """
    expected = 'expected a number of seconds, or text such as "30 s" (s, ms, min, h)'
    if isinstance(time, str):
        found = NUMBER_AND_UNIT.fullmatch(time)
        if found is None or found.group(2) not in UNITS:
            raise InputError(f"{time!r} is no time: {expected}")
        return float(found.group(1)) * UNITS[found.group(2)]
    try:
        return float(time)
    except (TypeError, ValueError):
        raise InputTypeError(f"{time!r} is no time: {expected}") from None
