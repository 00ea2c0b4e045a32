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
from plateau.study.output_folder import put
from plateau.study.quantities import in_si, quantity
from plateau.study.results import Factor, Numbers, Response, Study, analysed
from plateau.study.text_tables import TextTable, read_text_table, written_table
from plateau.study.units import NUMBER

REPLICATE = "replicate"
# Numbers of a table and of the design are the same if they differ by less than this part of the largest one of the factor.
ROUNDED = 1e-6


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
    file, given = _file(opened), read_text_table(Path(table))
    names = [response.name for response in opened.responses if response.asked.get("imported")]
    _responses(given, opened, strict=True)
    inputs = [Path(study), Path(table), *([Path(study).parent / opened.document["file"]] if "file" in opened.document else [])]
    if file.exists() and any(one.exists() and file.samefile(one) for one in inputs):
        raise InputError(f"{file}: it is an input, and imported values would be kept in its place; give the study another directory")
    # A table with a mistake in it leaves no folder.
    _Kept(opened).take(given, force)
    with _alone(file):
        kept = _Kept(opened)
        new, changed = kept.take(given, force)
        put(file, kept.written())
    columns = [opened.responses[at].name for _, at in _responses(given, opened, strict=True)]
    complete = int(kept.values[names].notna().all(axis=1).sum())
    return Imported(opened.title, len(given.rows), columns, new, changed, len(opened.runs), complete, kept.idle(), file)


def imported_values(study: Study) -> pandas.DataFrame:
    """The values of imported responses that a study has."""
    return _Kept(study).values


def read_points(path: str | os.PathLike[str], study: Study) -> pandas.DataFrame:
    """Points of a table in CSV with a column for each factor; other columns are left aside.

    Parameters
    ----------
    path : path
    study : Study

    Returns
    -------
    pandas.DataFrame
        Factors by name, numbers in SI units; a row for each line.

    Raises
    ------
    InputError
        With file and line.
    """
    table = read_text_table(Path(path))
    columns = zip(study.factors, _factors(table, study), strict=True)
    return pandas.DataFrame(
        {factor.name: [_factor_value(table, row, column, factor) for row in range(len(table.rows))] for factor, column in columns}
    )


def _file(study: Study) -> Path:
    return study.directory / "imported.csv"


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


def _head(name: str, unit: str) -> str:
    return name if unit in ("", "1") else f"{name} [{unit}]"


def _factors(table: TextTable, study: Study) -> list[int]:
    found = [table.column([factor.name, *factor.keys.split(", ")] if factor.keys else [factor.name]) for factor in study.factors]
    if None in found:
        raise table.missing(f'of the factor "{study.factors[found.index(None)].name}"')
    return [column for column in found if column is not None]


def _responses(table: TextTable, study: Study, *, strict: bool) -> list[tuple[int, int]]:
    """Columns of imported responses, with their place in the study."""
    names = {response.name: at for at, response in enumerate(study.responses) if response.asked.get("imported")}
    factors, found = _factors(table, study), []
    for column, head in enumerate(table.heads):
        name, unit = table.named(column)
        at = names.get(head, names.get(name))
        if column in factors or (name, unit) == (REPLICATE, "") or name == "run" or at is None and not strict:
            continue
        if at is None:
            raise InputError(
                f'{table.path}: column "{head}" is neither a factor nor a response with imported = true; '
                f"of these the study has {', '.join(names) or 'none'}"
            )
        try:
            in_si(1.0, _unit(table, column, study.responses[at]), study.responses[at].unit)
        except InputError:
            wanted = _head(study.responses[at].name, study.responses[at].unit)
            raise InputError(f'{table.path}: column "{head}": expected "{wanted}", or another unit that measures the same') from None
        found.append((column, at))
    if strict and not found:
        raise table.missing("of a response with imported = true")
    return found


def _unit(table: TextTable, column: int, response: Response) -> str:
    return table.named(column)[1] if table.heads[column] != response.name and table.named(column)[1] else "1"


def _factor_value(table: TextTable, row: int, column: int, factor: Factor) -> Any:
    """What a factor is in a line: a number in SI units, or a word."""
    cell, unit = table.rows[row][column].replace("\N{MINUS SIGN}", "-"), table.named(column)[1]
    if not cell:
        raise InputError(f'{table.place(row)}: "{factor.name}" is empty')
    if not factor.is_number:
        return table.rows[row][column].strip('"') if factor.keys else table.rows[row][column]
    number, _, own = cell.replace("%", " %").partition(" ")
    unit = own.strip() or unit
    try:
        if factor.keys:
            return in_si(_finite(number), unit or "1", factor.unit or "1")
        if unit not in ("", factor.study_unit):
            raise InputError(f'the study has it in "{factor.study_unit}"')
        return _finite(number) * factor.one + factor.zero
    except (InputError, ValueError) as error:
        why = f": {error}" if isinstance(error, InputError) else ""
        raise InputError(
            f'{table.place(row)}: "{table.heads[column]}" is "{cell}", expected a number such as "{factor.text(factor.levels[0])}"{why}'
        ) from None


def _finite(text: str) -> float:
    number = float(text)
    if not math.isfinite(number) or "_" in text:
        raise ValueError(text)
    return number


class _Kept:
    """Values of imported responses by run, and what was measured of nothing that the study has now."""

    def __init__(self, study: Study) -> None:
        self.study, self.names = study, [response.name for response in study.responses if response.asked.get("imported")]
        self.values = pandas.DataFrame(math.nan, index=study.runs.index, columns=self.names)
        self.others: list[str] = []
        self.other_cells: dict[int, list[str]] = {}
        self.idle_rows: list[list[str]] = []
        # Different values of each factor, and runs of each point.
        self.levels = [np.unique(study.runs[factor.name].to_numpy()) for factor in study.factors]
        self.replicates: dict[int, int] = dict(zip(study.runs.index.tolist(), study.runs[REPLICATE].tolist(), strict=True))
        self.points: dict[tuple[Any, ...], list[int]] = {}
        for run, *point in zip(self.replicates, *(study.runs[factor.name] for factor in study.factors), strict=True):
            self.points.setdefault(tuple(point), []).append(run)
        if self.names and _file(study).exists():
            self._read(read_text_table(_file(study)))

    def _read(self, table: TextTable) -> None:
        factors, columns = _factors(table, self.study), _responses(table, self.study, strict=False)
        replicate = table.column([REPLICATE])
        others = sorted(set(range(len(table.heads))) - set(factors) - {replicate} - {column for column, _ in columns})
        self.others, taken = [table.heads[column] for column in others], set[int]()
        for row, cells in enumerate(table.rows):
            run = self._run(table, row, factors, replicate, taken, is_kept=True)
            if run is not None:
                self._put(table, row, columns, run)
                self.other_cells[run] = [cells[column] for column in others]
                continue
            line = []
            for factor, column in zip(self.study.factors, factors, strict=True):
                unit, cell = table.named(column)[1], cells[column]
                line.append(f"{cell} {unit}" if unit and cell and " " not in cell and unit != factor.unit else cell)
            numbers = {at: self._number(table, row, column, at) for column, at in columns}
            by_name = {self.study.responses[at].name: "" if math.isnan(number) else repr(number) for at, number in numbers.items()}
            line += [cells[replicate] if replicate is not None else "", *(by_name.get(name, "") for name in self.names)]
            self.idle_rows.append([*line, *(cells[column] for column in others)])

    def take(self, table: TextTable, force: bool) -> tuple[int, int]:
        """Takes in a table: how many values are new, and how many have changed."""
        factors, columns, taken, new, changed = _factors(table, self.study), _responses(table, self.study, strict=True), set[int](), 0, 0
        replicate = table.column([REPLICATE])
        for row in range(len(table.rows)):
            run = self._run(table, row, factors, replicate, taken, is_kept=False)
            before = self.values.loc[run].to_numpy(copy=True)
            self._put(table, row, columns, run)
            now = self.values.loc[run].to_numpy()
            new += int((np.isnan(before) & ~np.isnan(now)).sum())
            differs = ~np.isnan(before) & (before != now)
            changed += int(differs.sum())
            if differs.any() and not force:
                raise InputError(
                    f"{table.place(row)}: {before[differs][0]} was imported before and {now[differs][0]} differs; --force replaces it"
                )
        return new, changed

    def _run(self, table: TextTable, row: int, factors: list[int], replicate: int | None, taken: set[int], *, is_kept: bool) -> int | None:
        """The run that a line is of: the first of its point that no line before is of. Of a line that is kept there may be none."""
        point: list[Any] = []
        try:
            for factor, column, levels in zip(self.study.factors, factors, self.levels, strict=True):
                value = _factor_value(table, row, column, factor)
                if factor.is_number:
                    nearest = levels[np.abs(levels - value).argmin()]
                    value = nearest if abs(nearest - value) <= ROUNDED * np.abs(levels).max() else None
                elif value not in levels:
                    value = None
                if value is None:
                    has = ", ".join(factor.text(level) for level in levels[:12].tolist()) + (", …" if len(levels) > 12 else "")
                    raise InputError(
                        f"{table.place(row)}: {factor.name} = {table.rows[row][column]} is in no point of the design, which has {has}"
                    )
                point.append(value)
            runs = self.points.get(tuple(point))
            if runs is None:
                raise InputError(
                    f"{table.place(row)}: no point of the design has these levels together; `plateau sweep plan --csv` writes all points"
                )
            number = math.nan if replicate is None else table.number(row, replicate)
            if not math.isnan(number) and number not in range(1, self.study.seeds + 1):
                raise InputError(f"{table.place(row)}: replicate {number:g}, expected a number from 1 to {self.study.seeds}")
            free = [run for run in runs if run not in taken and (math.isnan(number) or self.replicates[run] == number)]
            if not free:
                times = "once" if len(runs) == 1 else f"{len(runs)} times"
                raise InputError(
                    f"{table.place(row)}: the design has this point {times}, and lines before have it as often; several specimens of a point: "
                    'design = "csv" with this table as its file'
                )
        except InputError:
            if is_kept:
                return None
            raise
        taken.add(free[0])
        return free[0]

    def _number(self, table: TextTable, row: int, column: int, at: int) -> float:
        """A response in a line, SI."""
        number, response = table.number(row, column), self.study.responses[at]
        unit = _unit(table, column, response)
        return number if math.isnan(number) or unit == response.unit else in_si(table.rows[row][column], unit, response.unit)

    def _put(self, table: TextTable, row: int, columns: list[tuple[int, int]], run: int | None) -> None:
        for column, at in columns:
            number = self._number(table, row, column, at)
            if not math.isnan(number):
                self.values.loc[run, self.study.responses[at].name] = number

    def written(self) -> bytes:
        """The table as it is kept."""
        study = self.study
        heads = [_head(factor.name, factor.unit) for factor in study.factors] + [REPLICATE]
        rows = [
            [*heads, *(_head(response.name, response.unit) for response in study.responses if response.name in self.names), *self.others]
        ]
        for run, values in zip(self.replicates, self.values.to_numpy(), strict=True):
            others = self.other_cells.get(run, [""] * len(self.others))
            if not np.isnan(values).all() or any(others):
                levels = [_written(study.runs.loc[run, factor.name]) for factor in study.factors]
                rows.append(
                    [*levels, str(self.replicates[run]), *("" if math.isnan(value) else repr(float(value)) for value in values), *others]
                )
        return written_table([*rows, *self.idle_rows])

    def idle(self) -> list[str]:
        """What is kept of nothing that the study has now, in words."""
        heads = [_head(factor.name, factor.unit) for factor in self.study.factors]
        lines = [f"line of {', '.join(f'{head} = {cell}' for head, cell in zip(heads, line, strict=False))}" for line in self.idle_rows]
        filled = [head for at, head in enumerate(self.others) if any(cells[at] for cells in self.other_cells.values())]
        return [*lines, *(f'column "{head}"' for head in filled)]


def _written(value: Any) -> str:
    return value if isinstance(value, str) else repr(float(value))


@dataclass(frozen=True)
class Measurement:
    """What was measured of a response, SI units.

    Attributes
    ----------
    response : Response
    times : numpy.ndarray
        Times of a series; empty for a single value.
    values, uncertainties : numpy.ndarray
        Standard uncertainties.
    correlation_time : float
        For how long errors of a series are alike; 0 if they are independent.
    place : str
        Where they stand.
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
    """What was measured of the responses of a study.

    Parameters
    ----------
    study : Study

    Returns
    -------
    list of Measurement
        Of all responses with ``measured`` or ``measured_file``.

    Raises
    ------
    InputError
        If a value is wrong; with the response and its key, or file and line.
    """
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
