"""Tables in text: those that people give, refused with the place of what is wrong, and those that they read."""

import csv
import io
import itertools
import math
import re
import stat
import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from plateau.errors import InputError, MissingFileError
from plateau.text_files import decoded
from plateau.units import NUMBER

# How files begin that spreadsheets save unless asked for CSV.
WORKBOOKS = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1")


@dataclass(frozen=True)
class TextTable:
    """A table whose first line names its columns; rows have decimal points, and the numbers of their lines in the file, from 1."""

    path: Path
    heads: list[str]
    rows: list[list[str]]
    lines: list[int]

    def place(self, row: int) -> str:
        """File and line of a row."""
        return f"{self.path}:{self.lines[row]}"

    def named(self, column: int) -> tuple[str, str]:
        """Name and unit of a column: ``load [N]`` is ``load`` in ``N``."""
        found = re.fullmatch(r"(.*\S)\s+\[(.*)\]", self.heads[column])
        return (found[1], found[2].strip()) if found else (self.heads[column], "")

    def column(self, names: Iterable[str]) -> int | None:
        """The one column of these names, with or without a unit; None where there is none."""
        wanted = set(names)
        found = [at for at, head in enumerate(self.heads) if head in wanted or self.named(at)[0] in wanted]
        if len(found) > 1:
            one, other = (self.heads[at] for at in found[:2])
            raise InputError(f'{self.path}: columns "{one}" and "{other}" are the same thing; keep one')
        return found[0] if found else None

    def missing(self, what: str) -> InputError:
        """Error about a column that is missing, with the columns that there are."""
        return InputError(f"{self.path}: no column {what}; it has {', '.join(self.heads[:12])}{', …' if len(self.heads) > 12 else ''}")

    def number(self, row: int, column: int) -> float:
        """A number; NaN of an empty cell."""
        cell = self.rows[row][column]
        if not cell:
            return math.nan
        if not re.fullmatch(NUMBER, cell) or not math.isfinite(float(cell)):
            raise InputError(f'{self.place(row)}: "{self.heads[column]}" is "{cell}", expected a number such as 0.35')
        return float(cell)


def read_text_table(path: Path) -> TextTable:
    """Reads a table in CSV, as programs and spreadsheets write it, in any usual encoding; lines that begin with # are left out."""
    numbered = list(enumerate(re.split("\r\n|\n|\r", _text(path)), 1))
    stated = re.fullmatch(r'\s*"?sep=([;,\t])"?\s*', numbered[0][1], re.IGNORECASE)
    told = [(number, line) for number, line in numbered[bool(stated) :] if line.strip() and not line.lstrip().startswith("#")]
    if len(told) < 2:
        raise InputError(f"{path}: no points, expected a line for each below the names of the columns")
    names, numbers = told[0][1], [number for number, _ in told]
    for before, (number, line) in zip(numbers[1:], told[2:], strict=False):
        if line.strip() == names.strip() or any(not between.strip() for _, between in numbered[before : number - 1]):
            said = (
                "a table has one line of names and no blank lines between its rows; take these out, or put what stands below into a file of its own"
            )
            raise InputError(f"{path}:{number}: another table begins here: {said}")
    mark = stated[1] if stated else "\t" if "\t" in names else ";" if names.count(";") > names.count(",") else ","
    heads, *rows = (_cells(path, number, line, mark) for number, line in told)
    if all(row[-1] == "" and len(row) > 1 for row in (heads, *rows)):
        # A mark ends every line.
        heads, rows = heads[:-1], [row[:-1] for row in rows]
    if twice := next((head for at, head in enumerate(heads) if head in heads[:at]), None):
        raise InputError(f'{path}: column "{twice}" is there twice')
    if odd := next((at for at, row in enumerate(rows, 1) if len(row) != len(heads)), None):
        raise InputError(f"{path}:{numbers[odd]}: {len(rows[odd - 1])} cells, expected {len(heads)} as in the first line")
    return TextTable(path, heads, rows if mark == "," else _with_points(path, numbers[1:], rows), numbers[1:])


def written_table(rows: Iterable[Sequence[str]]) -> bytes:
    """A table in CSV; a cell that a spreadsheet would compute gets an apostrophe."""
    file = io.StringIO()
    csv.writer(file, lineterminator="\n").writerows([f"'{cell}" if _is_formula(cell.lstrip("'")) else cell for cell in row] for row in rows)
    return file.getvalue().encode()


def listed(cells: Sequence[Mapping[str, str]]) -> list[str]:
    """Lines of a table for people, of rows with cells by the heads of their columns."""
    return aligned([*map(list, cells[:1]), *(list(row.values()) for row in cells)])


def aligned(rows: Sequence[Sequence[str]], indent: str = "  ", names: int = 1) -> list[str]:
    """Lines of a table for people: columns of names to the left, the others to the right; an empty row is an empty line."""
    widths = [max(map(len, column)) for column in itertools.zip_longest(*rows, fillvalue="")]
    cells = [[*map(str.ljust, row[:names], widths), *map(str.rjust, row[names:], widths[names:])] for row in rows]
    return [indent + "  ".join(line).rstrip() for line in cells]


def _is_formula(cell: str) -> bool:
    """Tells whether a spreadsheet would compute a cell; numbers, with units or without, are no formulas."""
    return cell.startswith(("=", "+", "-", "@")) and not re.fullmatch(rf"{NUMBER}\s*[\w/^*%° -]*", cell)


def _text(path: Path) -> str:
    """The text of a file, in any encoding that `decoded` knows."""
    try:
        if stat.S_ISCHR(path.stat().st_mode):
            raise InputError(f"cannot read {path}: this is a device, expected a table in CSV")
        content = path.read_bytes()
    except FileNotFoundError:
        raise MissingFileError(f"{path}: there is no such table") from None
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror}") from error
    text = decoded(content)
    if content.startswith(WORKBOOKS):
        raise InputError(f"cannot read {path}: this is a workbook or an archive, expected text: save its sheet as CSV")
    if "\0" in text:
        raise InputError(f"cannot read {path}: this is no text, expected a table in CSV")
    return text


def _cells(path: Path, number: int, line: str, mark: str) -> list[str]:
    """Cells of a line; quotation marks as RFC 4180 has them."""
    try:
        (cells,) = csv.reader([line.strip(" ")], delimiter=mark, skipinitialspace=True, strict=True)
    except csv.Error:
        raise InputError(f"{path}:{number}: a quotation mark opens a cell, and none closes it there; take it out, or the line break") from None
    cells = [cell.strip() for cell in cells]
    if odd := next((cell for cell in cells if any(unicodedata.category(one) == "Cc" or one == "\N{REPLACEMENT CHARACTER}" for one in cell)), None):
        raise InputError(f"{path}:{number}: {odd!r} has a character that is no text; take it out")
    # The apostrophe that keeps a spreadsheet from computing the cell.
    return [cell[1:] if cell.startswith("'") and _is_formula(cell.lstrip("'")) else cell for cell in cells]


def _with_points(path: Path, numbers: list[int], rows: list[list[str]]) -> list[list[str]]:
    """Cells with decimal points; points and commas in one table are refused."""
    first: dict[str, str] = {}
    for number, cell in ((number, cell) for number, row in zip(numbers, rows, strict=True) for cell in row):
        if found := re.fullmatch(r"[-+]?\d*([.,])\d[^.,]*", cell):
            first.setdefault(found[1], f'"{cell}" in line {number}')
        if len(first) == 2:
            said = "a decimal point and a decimal comma in one table; save it with one of them, and without thousands separators"
            raise InputError(f"{path}:{number}: {' and '.join(reversed(first.values()))}: {said}")
    return [[re.sub(r"^([-+]?\d*),(\d[^.,]*)$", r"\1.\2", cell) for cell in row] for row in rows]
