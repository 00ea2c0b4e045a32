"""Measurements of responses, to which runs are fitted."""

import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from plateau.errors import InputError
from plateau.study.data import Numbers, Response, Study
from plateau.text_tables import read_text_table
from plateau.units import NUMBER, in_si, quantity


@dataclass(frozen=True)
class Measurement:
    """Measurement of a response, SI units, with standard uncertainties and where it stands; `times` is empty for a single value.

    Errors of a series are alike for `correlation_time`, s; they are independent if it is 0.
    """

    response: Response
    times: Numbers
    values: Numbers
    uncertainties: Numbers
    correlation_time: float
    place: str

    @property
    def is_series(self) -> bool:
        """True if it is a series."""
        return bool(len(self.times))

    @property
    def correlations(self) -> Numbers:
        """Correlations of the errors."""
        if not self.correlation_time:
            return np.eye(len(self.values))
        return np.asarray(np.exp(-np.abs(np.subtract.outer(self.times, self.times)) / self.correlation_time))


def measurements(study: Study) -> list[Measurement]:
    """Measurements of the responses of a study with ``measured`` or ``measured_file``."""
    found = []
    for response in study.responses:
        asked = response.asked
        where = f'{study.path or study.title}: response "{response.name}"'
        value, uncertainty = _asked(response, where, "measured"), _asked(response, where, "uncertainty", is_difference=True)
        time = _asked(response, where, "correlation_time", "s")
        if "measured_file" in asked:
            if value is not None:
                raise InputError(f"{where}: measured and measured_file exclude each other; keep one")
            if time is not None and (time < 0.0 or not isinstance(asked["correlation_time"], str)):
                raise InputError(f'{where}: correlation_time = {asked["correlation_time"]}, expected a time such as "2 min"')
            path = (study.path.parent if study.path else Path()) / asked["measured_file"]
            found.append(_series(path, response, uncertainty, time or 0.0))
        elif time is not None:
            raise InputError(f"{where}: correlation_time belongs to measured_file")
        elif (value is None) != (uncertainty is None):
            raise InputError(f"{where}: measured and uncertainty belong together: give both")
        elif value is not None:
            found.append(Measurement(response, np.array([]), np.array([value]), np.array([uncertainty], float), 0.0, where))
    return found


def _asked(response: Response, where: str, key: str, si: str = "", *, is_difference: bool = False) -> float | None:
    """A quantity that a response asks for; None without it."""
    if key not in response.asked:
        return None
    said, measured = response.asked[key], response.asked.get("measured")
    if is_difference and isinstance(said, int | float) and isinstance(measured, str):
        # In the unit of what it belongs to: "1.3 mm^2" and 0.1.
        said = re.sub(rf"^\s*{NUMBER}", repr(said), measured.replace("\N{MINUS SIGN}", "-"))
    try:
        number = quantity(said, si or response.unit, is_difference=is_difference)
    except InputError as error:
        raise InputError(f"{where}: {key} = {error}") from None
    if is_difference and number <= 0.0:
        raise InputError(f"{where}: {key} = {response.asked[key]}, expected more than 0: the standard uncertainty of what was measured")
    return number


def _series(path: Path, response: Response, uncertainty: float | None, correlation_time: float) -> Measurement:
    """A series from a table: time, values, and uncertainties unless one is given."""
    table, names = read_text_table(path), [response.name, response.asked.get("dataset", "").rsplit("/")[-1]]
    time, value = table.column(["time"]), table.column(names)
    if time is None or value is None:
        raise table.missing('"time [s]"' if time is None else f'"{response.name}"')
    deviation = table.column([f"{name} uncertainty" for name in names])
    deviation = table.column(["uncertainty"]) if deviation is None else deviation
    if not table.named(time)[1]:
        raise InputError(f'{path}:1: column "time" has no unit, expected one such as "time [s]"')
    if (deviation is None) == (uncertainty is None):
        what = "no column uncertainty; give one, or uncertainty = ... in the response for all points"
        twice = "a column of uncertainties, and the key uncertainty of the response; keep one"
        raise InputError(f"{path}: {what if deviation is None else twice}")

    def numbers(column: int, si: str, is_difference: bool = False) -> Numbers:
        # Uncertainties without a unit are in that of the values.
        found, head, unit = [], table.heads[column], table.named(column)[1] or (is_difference and table.named(value)[1])
        for row in range(len(table.rows)):
            if math.isnan(table.number(row, column)):
                raise InputError(f'{table.place(row)}: "{head}" is empty, expected a number; leave out lines that were not measured')
            try:
                found.append(in_si(table.rows[row][column], unit or si, si, is_difference=is_difference))
            except InputError as error:
                raise InputError(f'{table.place(row)}: "{head}": {error}') from None
        return np.array(found)

    times, values = numbers(time, "s"), numbers(value, response.unit)
    deviations = np.full(len(times), uncertainty) if deviation is None else numbers(deviation, response.unit, True)
    if len(times) < 2:
        raise InputError(f"{path}: 1 point, expected at least 2; one alone is measured = ...")
    for wrong, column, what in (
        (times < 0.0, time, "is before the run"),
        (np.diff(times, prepend=-np.inf) <= 0.0, time, "is not after the line before; sort the lines by time, each time once"),
        (deviations <= 0.0, deviation or 0, "is not more than 0"),
    ):
        if wrong.any():
            raise InputError(f'{table.place(int(wrong.argmax()))}: "{table.heads[column]}" {what}')
    return Measurement(response, times, values, deviations, correlation_time, table.place(len(times) - 1))
