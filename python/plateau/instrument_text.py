"""Text exports of instruments that no library reads: Keyence VK and VR (CSV), Zygo MetroPro and Mx (XYZ and ASCII)."""

import csv
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from plateau.errors import InputError
from plateau.text_files import decoded
from plateau.units import in_si

# Heights, m, shape (columns, rows); distances of the points, m; notes.
Read = tuple[Any, tuple[float, float], list[str]]

# Names in the header of Keyence's files in English and German (as the converter matusm/Kcsv2Bcr knows them).
PITCH = ("XY Calibration", "XY-Justierung")
COLUMNS = ("Horizontal", "Horizont.")
ROWS = ("Vertical", "Vertikal")
UNIT = ("Unit", "Einheit")
HEIGHT = ("Height", "Höhe")
# Phases of Zygo from this on were not measured; steps of a wave by the resolution that the header names.
NO_PHASE = 2147483640
STEPS = {0: 4096, 1: 32768, 2: 131072}


def read_text(path: Path, content: bytes) -> Read | None:
    """Heights of a text export, m, of shape (columns, rows), NaN where no point was measured; distances of the points along x and y, m; notes.

    None if it is no such export; `InputError` if it is one, and damaged, or holds something else than heights.
    """
    if b"\0" in content[:4096] and not content.startswith((b"\xff\xfe", b"\xfe\xff")):
        return None
    text = decoded(content)
    head = text[:4096]
    reader: Callable[[list[str]], Read]
    if head.startswith("Zygo XYZ Data File"):
        reader = _zygo_points
    elif head.startswith("Zygo ASCII Data File"):
        reader = _zygo_phases
    elif any(re.search(rf'^"?{name}"?[,;\t]', head, re.MULTILINE) for name in PITCH):
        reader = _keyence
    else:
        return None
    try:
        return reader(text.splitlines())
    except (IndexError, KeyError, ValueError) as error:
        if isinstance(error, InputError):
            raise InputError(f"{path}: {error}") from error
        raise InputError(f"{path}: damaged, or in an unknown version of its format: {error}") from error


def _keyence(lines: list[str]) -> Read:
    """Heights from quoted cells: names and values, a line "Height" alone, a matrix. Points that were not measured are empty cells."""
    separator = next((one for one in ",;\t" if one in lines[0]), ",")
    rows = list(csv.reader(lines, delimiter=separator))
    calibrated = next(at for at, row in enumerate(rows) if row and row[0] in PITCH)
    title = next((at for at, row in enumerate(rows) if at > calibrated and len(row) == 1), None)
    if title is None:
        raise InputError(f'no line below its header names what it holds, such as "{HEIGHT[0]}"')
    if rows[title][0] not in HEIGHT:
        raise InputError(f'line {title + 1}: the file holds "{rows[title][0]}", expected heights: export these')
    facts = {row[0]: row[1:] for row in rows[:title] if row}

    def fact(names: tuple[str, str]) -> list[str]:
        found = next((facts[name] for name in names if name in facts), None)
        if not found:
            raise InputError(f"its header has no line {names[0]}")
        return found

    table = [row for row in rows[title + 1 :] if row]
    if not table:
        raise InputError("there are no heights below the header")
    # The last comma of a line ends it.
    if all(row[-1] == "" for row in table) and len(table[0]) == int(fact(COLUMNS)[0]) + 1:
        table = [row[:-1] for row in table]
    counts = int(fact(COLUMNS)[0]), int(fact(ROWS)[0])
    if len(table) != counts[1] or any(len(row) != counts[0] for row in table):
        widths = sorted({len(row) for row in table})
        raise InputError(f"its header states {counts[0]} x {counts[1]} points, but there are {len(table)} lines of {widths[0]} to {widths[-1]}")
    cells = [cell for row in table for cell in row]
    calibration = fact(PITCH)
    number = _number(cells + calibration[:1])
    values = np.array([[number(cell) for cell in row] for row in table])
    pitch = in_si(number(calibration[0]), _unit(calibration[1]), "m")
    return in_si(1.0, _unit(fact(UNIT)[0]), "m") * values.T, (pitch, pitch), []


def _unit(text: str) -> str:
    return text.strip().replace("µ", "u").replace("μ", "u")


def _number(cells: list[str]) -> Callable[[str], float]:
    """Function that reads a number with the decimal mark of these cells; NaN of an empty one."""
    commas, points = (any(mark in cell for cell in cells) for mark in ",.")
    if commas and points:
        raise InputError("it has decimal points and decimal commas: save it with one of them")
    return lambda cell: np.nan if cell.strip() == "" else float(cell.replace(",", "."))


def _zygo(lines: list[str]) -> tuple[dict[str, Any], list[list[str]]]:
    """Facts of the header, and the blocks below it, which lines of "#" part (MetroPro Reference Guide OMP-0347, section 12)."""
    marks = [at for at, line in enumerate(lines) if line.strip() == "#"]
    if not marks:
        raise InputError("no line of # ends its header")
    x, y, width, height = (int(word) for word in lines[3].split()[:4])
    if width < 1 or height < 1:
        raise InputError(f"line 4: the heights have {width} x {height} points")
    _, factor, wavelength, _, obliquity, _, pixel, *_ = (float(word) for word in lines[7].split())
    blocks = [lines[begin + 1 : end] for begin, end in zip(marks, [*marks[1:], len(lines)], strict=True)]
    facts = {
        "origin": (x, y),
        "size": (width, height),
        "wave": factor * wavelength * obliquity,
        "pixel": pixel,
        "resolution": int(lines[10].split()[0]),
    }
    return facts, blocks


def _zygo_points(lines: list[str]) -> Read:
    """Heights from lines with column and row of a pixel, and a height in um or "No Data"."""
    facts, blocks = _zygo(lines)
    points = [line.split(maxsplit=2) for line in blocks[0] if line.strip()]
    places = np.array([[int(x), int(y)] for x, y, _ in points])
    heights = np.array([np.nan if re.match("no data", z, re.IGNORECASE) else float(z) for *_, z in points])
    size = np.array(facts["size"])
    for origin in (np.array(facts["origin"]), np.zeros(2, int)):
        # Pixels are counted from the origin, or from that of the camera.
        at = places - origin
        if ((at >= 0) & (at < size)).all():
            break
    else:
        raise InputError(f"its points lie outside of the {size[0]} x {size[1]} that its header states")
    values = np.full(size, np.nan)
    if len(np.unique(at, axis=0)) != len(at):
        raise InputError("two of its points are at one place")
    values[tuple(at.T)] = heights * 1e-6
    note = "heights are taken as um, as the format has it; the instrument's program can write other units without saying so"
    return values, (facts["pixel"],) * 2, [note]


def _zygo_phases(lines: list[str]) -> Read:
    """Heights from phases: whole numbers, row by row, below the intensities."""
    facts, blocks = _zygo(lines)
    phases = np.array([int(word) for line in blocks[1] for word in line.split()])
    columns, rows = facts["size"]
    if phases.size != columns * rows:
        raise InputError(f"its header states {columns * rows} phases, but there are {phases.size}")
    heights = np.where(phases >= NO_PHASE, np.nan, phases * (facts["wave"] / STEPS[facts["resolution"]]))
    return heights.reshape(rows, columns).T, (facts["pixel"],) * 2, []
