"""Values of responses from elsewhere, as they are kept beside the results of a study: by run, and those of nothing that it has now."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pandas

from plateau.errors import InputError
from plateau.study.data import Factor, Response, Study
from plateau.study.text_tables import TextTable, read_text_table, written_table
from plateau.units import in_si, with_unit

REPLICATE = "replicate"
# Numbers of a table and of the design are the same if they differ by less than this part of the largest one of the factor.
ROUNDED = 1e-6


def imported_values(study: Study) -> pandas.DataFrame:
    """The values of imported responses that a study has."""
    return KeptValues(study).values


def file_of(study: Study) -> Path:
    """The table in which they are kept."""
    return study.directory / "imported.csv"


def _factors(table: TextTable, study: Study) -> list[int]:
    found = [table.column([factor.name, *factor.keys.split(", ")] if factor.keys else [factor.name]) for factor in study.factors]
    if None in found:
        raise table.missing(f'of the factor "{study.factors[found.index(None)].name}"')
    return [column for column in found if column is not None]


def imported_columns(table: TextTable, study: Study, *, strict: bool) -> list[tuple[int, int]]:
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
            wanted = with_unit(study.responses[at].name, study.responses[at].unit)
            raise InputError(f'{table.path}: column "{head}": expected "{wanted}", or another unit that measures the same') from None
        found.append((column, at))
    if strict and not found:
        raise table.missing("of a response with imported = true")
    return found


def _unit(table: TextTable, column: int, response: Response) -> str:
    return table.named(column)[1] if table.heads[column] != response.name and table.named(column)[1] else "1"


def factor_value(table: TextTable, row: int, column: int, factor: Factor) -> Any:
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


class KeptValues:
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
        if self.names and file_of(study).exists():
            self._read(read_text_table(file_of(study)))

    def _read(self, table: TextTable) -> None:
        factors, columns = _factors(table, self.study), imported_columns(table, self.study, strict=False)
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
        factors, columns, taken, new, changed = _factors(table, self.study), imported_columns(table, self.study, strict=True), set[int](), 0, 0
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
                value = factor_value(table, row, column, factor)
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
        heads = [with_unit(factor.name, factor.unit) for factor in study.factors] + [REPLICATE]
        rows = [
            [*heads, *(with_unit(response.name, response.unit) for response in study.responses if response.name in self.names), *self.others]
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
        heads = [with_unit(factor.name, factor.unit) for factor in self.study.factors]
        lines = [f"line of {', '.join(f'{head} = {cell}' for head, cell in zip(heads, line, strict=False))}" for line in self.idle_rows]
        filled = [head for at, head in enumerate(self.others) if any(cells[at] for cells in self.other_cells.values())]
        return [*lines, *(f'column "{head}"' for head in filled)]


def _written(value: Any) -> str:
    return value if isinstance(value, str) else repr(float(value))
