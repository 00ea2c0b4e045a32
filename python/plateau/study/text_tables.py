"""Tables in text that people give: decoded, parted into cells, and refused with the place of what is wrong."""

import csv
import io
import itertools
import math
import re
import stat
import unicodedata
import zipfile
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from plateau.errors import InputError, MissingFileError
from plateau.units import NUMBER

# What a workbook has in its archive.
WORKBOOKS = {"xl/": "a workbook (.xlsx)", "content.xml": "a workbook (.ods)"}


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
        """That a column is missing."""
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
    numbered = [(number, line) for number, line in enumerate(_lines(_text(path)), 1)]
    stated = re.fullmatch(r'\s*"?sep=([;,\t])"?\s*', numbered[0][1], re.IGNORECASE) if numbered else None
    filled = [(number, line) for number, line in numbered[bool(stated) :] if line.strip()]
    told = [(number, line) for number, line in filled if not line.lstrip().startswith("#")]
    if len(told) < 2:
        raise InputError(f"{path}: no points, expected a line for each below the names of the columns")
    _refuse_second_table(path, filled, told)
    (_, names), *rest = told
    mark = stated[1] if stated else "\t" if "\t" in names else ";" if names.count(";") > names.count(",") else ","
    rest = [(number, line) for number, line in rest if line.strip() != names.strip()]
    rows = [_cells(path, number, line, mark) for number, line in [told[0], *rest]]
    if all(row[-1][1] == "" and len(row) > 1 for row in rows):
        # A mark ends every line.
        rows = [row[:-1] for row in rows]
    heads = [text for _, text in rows[0]]
    if twice := next((head for at, head in enumerate(heads) if head in heads[:at]), None):
        raise InputError(f'{path}: column "{twice}" is there twice')
    for (number, _), row in zip(rest, rows[1:], strict=True):
        if len(row) != len(heads):
            raise InputError(f"{path}:{number}: {len(row)} cells, expected {len(heads)} as in the first line")
        if odd := next((head for head, (_, text) in zip(heads, row, strict=True) if any(map(_is_odd, text))), None):
            raise InputError(f'{path}:{number}: "{odd}" has a character that is no text; take it out')
    cells = [[text for _, text in row] for row in rows[1:]] if mark == "," else _with_points(path, [n for n, _ in rest], rows[1:])
    return TextTable(path, heads, cells, [number for number, _ in rest])


def written_table(rows: Iterable[Sequence[str]]) -> bytes:
    """A table in CSV; a cell that a spreadsheet would compute gets an apostrophe."""
    file = io.StringIO()
    csv.writer(file, lineterminator="\n").writerows([f"'{cell}" if _is_formula(cell.lstrip("'")) else cell for cell in row] for row in rows)
    return file.getvalue().encode()


def _is_formula(cell: str) -> bool:
    """Whether a spreadsheet would compute a cell: numbers, with units or without, are none."""
    return cell.startswith(("=", "+", "-", "@")) and not re.fullmatch(rf"{NUMBER}\s*[\w/^*%° -]*", cell)


def _is_odd(character: str) -> bool:
    return character == "\N{REPLACEMENT CHARACTER}" or unicodedata.category(character) == "Cc"


def _text(path: Path) -> str:
    """The text of a file: UTF-8 or UTF-16, with byte order mark or without, else Windows-1252."""
    try:
        if stat.S_ISCHR(path.stat().st_mode):
            raise InputError(f"cannot read {path}: this is a device, expected a table in CSV")
        content = path.read_bytes()
    except FileNotFoundError:
        raise MissingFileError(f"{path}: there is no such table") from None
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror}") from error
    what = ""
    if content.startswith(b"PK\x03\x04"):
        try:
            names = zipfile.ZipFile(io.BytesIO(content)).namelist()
        except zipfile.BadZipFile:
            names = []
        book = next((said for name, said in WORKBOOKS.items() if any(entry.startswith(name) for entry in names)), None)
        what = (
            f"{book}, expected text: save its sheet as CSV" if book else "a zip archive, expected text: unpack it, and name the file in it"
        )
    elif content.startswith(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"):
        what = "a workbook (.xls) or another document, expected text: save its sheet as CSV"
    low, high = content[1:4:2] == b"\0\0", content[0:3:2] == b"\0\0"
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        text = content.decode("utf-16", "replace")
    elif low or high:
        text = content.decode("utf-16-le" if low else "utf-16-be", "replace")
    else:
        try:
            text = content.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = content.decode("cp1252", "replace")
    if what or "\0" in text:
        raise InputError(f"cannot read {path}: this is {what or 'no text, expected a table in CSV'}")
    return text


def _lines(text: str) -> list[str]:
    end = "\n" if "\n" in text else "\r"
    return [line.rstrip("\r") for line in text.removesuffix(end).split(end)]


def _refuse_second_table(path: Path, filled: list[tuple[int, str]], told: list[tuple[int, str]]) -> None:
    (first, names), last = told[0], told[-1][0]
    has_rows, before = False, first
    for number, line in filled:
        if number <= first:
            continue
        is_header = line.strip() == names.strip()
        sign = "below a blank line" if number > before + 1 else "with a header" if is_header else ""
        # Below it there are rows.
        if sign and has_rows and any(at >= number and other.strip() != names.strip() for at, other in told) and number <= last:
            raise InputError(
                f"{path}:{number}: another table begins here, {sign}: a table has one line of names and no blank lines between its rows; take "
                "these out, or put what stands below into a file of its own"
            )
        has_rows, before = has_rows or not (is_header or line.lstrip().startswith("#")), number


def _cells(path: Path, number: int, line: str, mark: str) -> list[tuple[int, str]]:
    """Cells of a line, each with its column in the text; quotation marks as RFC 4180 has them."""
    cells = []
    for found in re.finditer(rf'[^\S\t]*("(?:[^"]|"")*"[^\S\t]*|[^{mark}]*)({mark}|$)', line):
        column, text = found.start(1) + 1, found[1].strip()
        if text.startswith('"'):
            if len(text) < 2 or not re.fullmatch(r'"(?:[^"]|"")*"', text):
                raise InputError(
                    f"{path}:{number}:{column}: a quotation mark opens this cell, and none closes it in its line; take it out, or the line break"
                )
            text = text[1:-1].replace('""', '"').strip()
        # The apostrophe that keeps a spreadsheet from computing the cell.
        cells.append((column, text[1:] if text.startswith("'") and _is_formula(text.lstrip("'")) else text))
        if not found[2]:
            break
    return cells


def _with_points(path: Path, lines: list[int], rows: list[list[tuple[int, str]]]) -> list[list[str]]:
    """Cells with decimal points; points and commas in one table are refused."""
    first: dict[str, str] = {}
    for number, (column, text) in itertools.chain.from_iterable(
        ((number, cell) for cell in row) for number, row in zip(lines, rows, strict=True)
    ):
        found = re.fullmatch(r"[-+]?\d*([.,])\d[^.,]*", text)
        if found is None:
            continue
        first.setdefault(found[1], f'"{text}" in line {number}, column {column}')
        if len(first) == 2:
            one, other = first.values()
            raise InputError(
                f"{path}:{number}:{column}: {other} and {one}: a decimal point and a decimal comma in one table; save it with one of them, and "
                "without thousands separators"
            )
    return [[re.sub(r"^([-+]?\d*),(\d[^.,]*)$", r"\1.\2", text) for _, text in row] for row in rows]
