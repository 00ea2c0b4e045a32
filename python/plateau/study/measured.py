"""What was measured: values of responses from elsewhere, which become part of a study, and what runs are fitted to."""

import fcntl
import math
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas

from plateau.errors import InputError, RunFailed
from plateau.study.data import Numbers, Response, Study
from plateau.study.kept_values import KeptValues, file_of, imported_columns
from plateau.output_folder import put
from plateau.study.results import analysed
from plateau.study.text_tables import read_text_table
from plateau.units import NUMBER, in_si, quantity


@dataclass(frozen=True)
class Imported:
    """What a table brought.

    Attributes
    ----------
    study : str
        Title.
    lines, new, changed, complete, runs : int
        Lines of the table, values that were not there before and that have changed, runs that have all imported responses, all runs.
    responses : list of str
        Which are in the table.
    idle : list of str
        What is kept of points and responses that the study does not have now.
    file : Path
        Where values are kept.
    """

    study: str
    lines: int
    responses: list[str]
    new: int
    changed: int
    runs: int
    complete: int
    idle: list[str]
    file: Path

    def document(self) -> dict[str, Any]:
        """The JSON of ``plateau sweep import --json``."""
        return {**self.__dict__, "file": str(self.file)}

    def text(self) -> str:
        """What ``plateau sweep import`` prints."""
        lines = [
            self.study,
            f"  read      {self.lines} {'line' if self.lines == 1 else 'lines'} with {', '.join(self.responses)}",
            f"  values    {self.new} new, {self.changed} changed",
            f"  complete  {self.complete} of {self.runs} runs",
            f"  kept in   {self.file}",
        ]
        kept = [f"  {line}" for line in self.idle]
        return "\n".join([*lines, *(["Kept, but of nothing that the study has now"] if kept else []), *kept])


def import_values(study: str | os.PathLike[str], table: str | os.PathLike[str], force: bool = False) -> Imported:
    """Takes values of responses with ``imported = true`` into a study.

    Parameters
    ----------
    study : path
        The study file.
    table : path
        Table in CSV: a column for each factor and for each response in it, and ``replicate`` where needed. Empty cells change nothing.
    force : bool
        Replace values that were imported before and differ.

    Returns
    -------
    Imported

    Raises
    ------
    InputError
        If a line fits no point, or a value is wrong or there already; with its line. Then nothing has changed.
    """
    opened = analysed(study)
    file, given = file_of(opened), read_text_table(Path(table))
    names = [response.name for response in opened.responses if response.asked.get("imported")]
    imported_columns(given, opened, strict=True)
    inputs = [Path(study), Path(table), *([Path(study).parent / opened.document["file"]] if "file" in opened.document else [])]
    if file.exists() and any(one.exists() and file.samefile(one) for one in inputs):
        raise InputError(f"{file}: it is an input, and imported values would be kept in its place; give the study another directory")
    # A table with a mistake in it leaves no folder.
    KeptValues(opened).take(given, force)
    with _alone(file):
        kept = KeptValues(opened)
        new, changed = kept.take(given, force)
        put(file, kept.written())
    columns = [opened.responses[at].name for _, at in imported_columns(given, opened, strict=True)]
    complete = int(kept.values[names].notna().all(axis=1).sum())
    return Imported(opened.title, len(given.rows), columns, new, changed, len(opened.runs), complete, kept.idle(), file)


@contextmanager
def _alone(file: Path) -> Iterator[None]:
    """One import at a time: another one waits."""
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        with (file.parent / f".{file.name}.lock").open("a") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            yield
    except OSError as error:
        raise RunFailed(f"cannot write {file}: {error.strerror}") from error


@dataclass(frozen=True)
class Measurement:
    """What was measured of a response, SI units, with standard uncertainties and where it stands; `times` is empty for a single value.

    Errors of a series are alike for `correlation_time`; they are independent if it is 0.
    """

    response: Response
    times: Numbers
    values: Numbers
    uncertainties: Numbers
    correlation_time: float
    place: str

    @property
    def is_series(self) -> bool:
        """Whether it is a series."""
        return bool(len(self.times))

    @property
    def correlations(self) -> Numbers:
        """Correlations of the errors."""
        if not self.correlation_time:
            return np.eye(len(self.values))
        return np.asarray(np.exp(-np.abs(np.subtract.outer(self.times, self.times)) / self.correlation_time))


def measurements(study: Study) -> list[Measurement]:
    """What was measured of the responses of a study with ``measured`` or ``measured_file``."""
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
        raise InputError(
            f"{path}: {what if deviation is None else 'a column of uncertainties, and the key uncertainty of the response; keep one'}"
        )

    def numbers(column: int, si: str, is_difference: bool = False) -> Numbers:
        # Uncertainties without a unit are in that of the values.
        found, head, unit = [], table.heads[column], table.named(column)[1] or is_difference and table.named(value)[1]
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
