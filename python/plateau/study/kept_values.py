"""Values of responses from elsewhere, as they are kept beside the results of a study."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pandas

from plateau.errors import InputError
from plateau.study.data import Factor, Response, Study
from plateau.text_tables import TextTable, read_text_table, written_table
from plateau.units import in_si, with_unit

REPLICATE = "replicate"
# Numbers of a table and of the design are the same if they differ by less than this part of the largest one of the factor.
ROUNDED = 1e-6


def file_of(study: Study) -> Path:
    """Path of the table in which imported values are kept."""
    return study.directory / "imported.csv"


def _columns(table: TextTable, study: Study, *, strict: bool) -> tuple[dict[int, Factor], dict[int, tuple[Response, str]]]:
    """Columns of factors, in the order of the study, and of imported responses with units; with `strict` others than these are refused."""
    factors: dict[int, Factor] = {}
    for factor in study.factors:
        if (column := table.column(factor.names)) is None:
            raise table.missing(f'of the factor "{factor.name}"')
        factors[column] = factor
    imported = [response for response in study.responses if response.asked.get("imported")]
    responses, found = {name: one for one in imported for name in (one.asked.get("name", one.name), one.name)}, {}
    for at, head in enumerate(table.heads):
        name, unit = table.named(at)
        response = responses.get(head, responses.get(name))
        if at in factors or (name, unit) == (REPLICATE, "") or name == "run" or (response is None and not strict):
            continue
        if response is None:
            there = f"of these the study has {', '.join(one.name for one in imported) or 'none'}"
            raise InputError(f'{table.path}: column "{head}" is neither a factor nor a response with imported = true; {there}')
        unit = "1" if head == response.name else unit or "1"
        try:
            in_si(1.0, unit, response.unit)
        except InputError:
            wanted = with_unit(response.name, response.unit)
            raise InputError(f'{table.path}: column "{head}": expected "{wanted}", or another unit that measures the same') from None
        found[at] = response, unit
    if strict and not found:
        raise table.missing("of a response with imported = true")
    return factors, found


def _numbers(table: TextTable, row: int, columns: dict[int, tuple[Response, str]]) -> pandas.Series:
    """Values of the responses in a line, SI, by their names."""
    told = {at: one for at, one in columns.items() if not math.isnan(table.number(row, at))}
    return pandas.Series({one.name: in_si(table.rows[row][at], unit, one.unit) for at, (one, unit) in told.items()}, dtype=float)


def factor_value(table: TextTable, row: int, column: int, factor: Factor) -> Any:
    """Value of a factor in a line: a number in SI units, or a word."""
    cell, unit = table.rows[row][column].replace("\N{MINUS SIGN}", "-"), table.named(column)[1]
    if not cell:
        raise InputError(f'{table.place(row)}: "{factor.name}" is empty')
    if not factor.is_number:
        return table.rows[row][column].strip('"') if factor.keys else table.rows[row][column]
    number, _, own = cell.replace("%", " %").partition(" ")
    unit = own.strip() or unit
    try:
        if not math.isfinite(float(number)) or "_" in number:
            raise ValueError(number)
        if factor.keys:
            return in_si(float(number), unit or "1", factor.unit or "1")
        if unit not in ("", factor.study_unit):
            raise InputError(f'the study has it in "{factor.study_unit}"')
        return float(number) * factor.one + factor.zero
    except (InputError, ValueError) as error:
        said = f'"{table.heads[column]}" is "{cell}", expected a number such as "{factor.text(factor.levels[0])}"'
        why = f": {error}" if isinstance(error, InputError) else ""
        raise InputError(f"{table.place(row)}: {said}{why}") from None


class KeptValues:
    """The table: ``values`` of imported responses by run, ``others`` (cells of columns that the study does not have), and ``idle`` lines."""

    def __init__(self, study: Study) -> None:
        responses = [response for response in study.responses if response.asked.get("imported")]
        factors, own = ([with_unit(one.name, one.unit) for one in these] for these in (study.factors, responses))
        self.study, self.heads, self.idle_lines = study, [*factors, REPLICATE, *own], list[dict[str, str]]()
        self.values = pandas.DataFrame(math.nan, index=study.runs.index, columns=[response.name for response in responses])
        self.others = pandas.DataFrame(index=study.runs.index)
        if responses and file_of(study).exists():
            self._read(read_text_table(file_of(study)))

    def _read(self, table: TextTable) -> None:
        (factors, columns), replicate = _columns(table, self.study, strict=False), table.column([REPLICATE])
        known = factors | {at: one for at, (one, _) in columns.items()}
        heads = {at: with_unit(one.name, one.unit) for at, one in known.items()} | ({} if replicate is None else {replicate: REPLICATE})
        others = [at for at in range(len(table.heads)) if at not in heads]
        self.others = self.others.reindex(columns=[table.heads[at] for at in others], fill_value="")
        taken = set[int]()
        for row, cells in enumerate(table.rows):
            numbers = _numbers(table, row, columns)
            try:
                run = self._run(table, row, factors, taken)
            except InputError:
                line = {heads.get(at, table.heads[at]): cell for at, cell in enumerate(cells)}
                self.idle_lines.append(line | {heads[at]: _written(numbers.get(one.name, math.nan)) for at, (one, _) in columns.items()})
            else:
                self.values.loc[run, numbers.index] = numbers
                self.others.loc[run, [*self.others]] = [cells[at] for at in others]

    def take(self, table: TextTable, force: bool) -> tuple[list[str], int, int]:
        """Takes in a table; gives its responses, and the numbers of values that are new and that have changed."""
        (factors, columns), taken, new, changed = _columns(table, self.study, strict=True), set[int](), 0, 0
        for row in range(len(table.rows)):
            run, now = self._run(table, row, factors, taken), _numbers(table, row, columns)
            before = self.values.loc[run, now.index]
            differs = before.notna() & (before != now)
            self.values.loc[run, now.index] = now
            new, changed = new + int(before.isna().sum()), changed + int(differs.sum())
            if differs.any() and not force:
                said = f"{before[differs].iloc[0]} was imported before and {now[differs].iloc[0]} differs; --force replaces it"
                raise InputError(f"{table.place(row)}: {said}")
        return [response.name for response, _ in columns.values()], new, changed

    def _run(self, table: TextTable, row: int, factors: dict[int, Factor], taken: set[int]) -> int:
        """The run that a line is of: the first of its point that no line before is of."""
        runs, place = self.study.runs, table.place(row)
        at_point = pandas.Series(True, index=runs.index)
        for column, factor in factors.items():
            value, levels = factor_value(table, row, column, factor), runs[factor.name]
            same = abs(levels - value) <= ROUNDED * abs(levels).max() if factor.is_number else levels == value
            if not same.any():
                different = np.unique(levels).tolist()
                has = ", ".join(map(factor.text, different[:12])) + (", …" if len(different) > 12 else "")
                raise InputError(f"{place}: {factor.name} = {table.rows[row][column]} is in no point of the design, which has {has}")
            at_point &= same
        if not at_point.any():
            raise InputError(f"{place}: no point of the design has these levels together; `plateau sweep plan --csv` writes all points")
        replicate = table.column([REPLICATE])
        number = math.nan if replicate is None else table.number(row, replicate)
        if not math.isnan(number) and number not in range(1, self.study.seeds + 1):
            raise InputError(f"{place}: replicate {number:g}, expected a number from 1 to {self.study.seeds}")
        is_own = at_point if math.isnan(number) else at_point & (runs[REPLICATE] == number)
        free = runs.index[is_own].difference(list(taken))
        if free.empty:
            times = "once" if at_point.sum() == 1 else f"{at_point.sum()} times"
            advice = 'several specimens of a point: design = "csv" with this table as its file'
            raise InputError(f"{place}: the design has this point {times}, and lines before have it as often; {advice}")
        taken.add(int(free[0]))
        return int(free[0])

    def written(self) -> bytes:
        """The table as it is kept."""
        runs = self.study.runs[[*(factor.name for factor in self.study.factors), REPLICATE]]
        table = pandas.concat([runs, self.values], axis=1).map(_written).set_axis(self.heads, axis=1)
        table = pandas.concat([table, self.others], axis=1)[self.values.notna().any(axis=1) | self.others.ne("").any(axis=1)]
        return written_table([list(table), *table.to_numpy().tolist(), *([line.get(head, "") for head in table] for line in self.idle_lines)])

    def idle(self) -> list[str]:
        """Kept lines and columns that match nothing in the study now, in words."""
        heads = self.heads[: len(self.study.factors)]
        lines = [f"line of {', '.join(f'{head} = {line[head]}' for head in heads)}" for line in self.idle_lines]
        return [*lines, *(f'column "{head}"' for head in self.others if self.others[head].ne("").any())]


def _written(value: Any) -> str:
    """A value with all its digits; nothing of NaN."""
    return value if isinstance(value, str) else "" if value != value else str(value) if isinstance(value, int) else repr(float(value))
