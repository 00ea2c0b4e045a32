"""Output of ``plateau surface``: the parameters of surfaces that the program has read or prepared, as a table or as JSON."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from plateau.errors import InputError
from plateau.surface_data import told
from plateau.surface_parameters import PARAMETERS, parameters, sampling_errors
from plateau.text_tables import aligned

UNITS = {"pitch": "um", "size": "um", "coverage": "1", "Str_below": "1"} | {symbol: unit for symbol, (_, unit, *_) in PARAMETERS.items()}
# What the heights do not determine, or what needs a pitch.
NONE = "-"


def describe(folder: Path, as_json: bool) -> str:
    """Describes the surfaces of a folder of the program, and adds their parameters to its document, for figures."""
    surfaces, described, patch = told(folder, "surfaces.json"), [], None
    for one in surfaces:
        one |= one.pop("grid")
        found = _parameters(folder, one, one["name"])
        points, pitch = one["columns"] * one["rows"], one["pitch"]
        one |= {"pitch": pitch and [1e6 * length for length in pitch], "points": points, "measured": found["measured"]}
        one |= _in_units(found) | {"units": UNITS, "material_curve": found["curve"].tolist()}
        if one["is_patch"]:
            patch = found
            continue
        size = pitch and [1e6 * count * length for count, length in zip((one["columns"], one["rows"]), pitch, strict=True)]
        document = {name: one[name] for name in ("name", "format", "columns", "rows", "pitch")} | {"size": size, "points": points}
        document |= {"measured": found["measured"], "coverage": found["measured"] / points}
        document |= {name: one[name] for name in ("level", "notes", "warnings")} | _in_units(found)
        rows = _compared(folder, one, patch, found) if patch else {}
        if patch:
            columns = {name: _in_units({symbol: row[at] for symbol, row in rows.items()}) for at, name in enumerate(COMPARED)}
            document["comparison"] = {"cells": one["cells"] and [one["cells"]["columns"], one["cells"]["rows"]], **columns}
        described.append((one, document | {"units": UNITS}, found, rows))
        patch = None
    (folder / "surfaces.json").write_text(json.dumps(surfaces), encoding="utf-8")
    if as_json:
        documents = [document for _, document, *_ in described]
        return json.dumps(documents[0] if len(documents) == 1 else documents, indent=2, allow_nan=False)
    return _text(described)


def _parameters(folder: Path, one: dict[str, Any], name: str) -> dict[str, Any]:
    """Parameters of heights that the program has written."""
    heights, pitch = np.load(folder / one["heights"], mmap_mode="r"), one["pitch"]
    try:
        return parameters(heights, pitch and tuple(pitch)) | {"measured": int(np.count_nonzero(np.isfinite(heights)))}
    except MemoryError as error:
        can = f"{name}: its {one['columns']} x {one['rows']} points can be read"
        raise InputError(f"{can}, but to describe them needs more memory: {error}; give a coarser surface, or a part of it") from error


def _in_units(found: dict[str, Any]) -> dict[str, float | None]:
    """Parameters, SI, in the units in which they are told; None where there is no number."""
    factors = {symbol: factor for symbol, (_, _, factor, _) in PARAMETERS.items()} | {"Str_below": 1.0}
    return {name: float(found[name] * factor) if np.isfinite(found[name]) else None for name, factor in factors.items() if name in found}


# The columns of a comparison.
COMPARED = ("patch", "patch_in_cells", "sampling_error", "difference")


def _compared(folder: Path, one: dict[str, Any], patch: dict[str, Any], body: dict[str, Any]) -> dict[str, list[float]]:
    """Parameters by symbol: of a patch, of its averages over cells, their sampling errors, and differences of the body from these."""
    none = dict.fromkeys(PARAMETERS, np.nan)
    cells, errors = none, none
    if one["cells"]:
        cells = _parameters(folder, one["cells"], one["name"])
        errors = sampling_errors(np.load(folder / one["cells"]["heights"]), tuple(one["cells"]["pitch"]))
    differences = {symbol: body[symbol] - cells.get(symbol, np.nan) for symbol in PARAMETERS}
    if abs(differences["Std"]) > math.pi / 2:
        # A direction and its opposite are the same.
        differences["Std"] -= math.copysign(math.pi, differences["Std"])
    return {symbol: [of.get(symbol, np.nan) for of in (patch, cells, errors, differences)] for symbol in PARAMETERS}


def _text(described: list[Any]) -> str:
    """The table, a line for every parameter and a column for every surface, and what there is to say besides."""
    ones = [one for one, *_ in described]
    lines = [["", "", *_short_names(ones)], ["size", "", *(" x ".join(one["size_in_words"] or [NONE]) for one in ones)]]
    lines.append(["points", "", *(f"{one['columns']} x {one['rows']}" for one in ones)])
    lines.append(["pitch", "", *(_pitch(one) for one in ones)])
    lines.append(["measured", "", *(f"{significant(100 * one['measured'] / one['points'], 5)} %" for one in ones)])
    lines.append(["taken out", "", *(one["level"] for one in ones)])
    group = None
    for symbol, (own, unit, _, name) in PARAMETERS.items():
        lines += [[]] if own != group else []
        lines.append([f"{symbol:5}  {name}", unit, *(_cell(one, symbol) for one in ones)])
        group = own
    text = "\n".join([*aligned(lines, "", names=2), ""])
    return text + "".join(_beside(one, rows) for one, _, _, rows in described if rows) + "".join(_remarks(*each) for each in described)


def _pitch(one: dict[str, Any]) -> str:
    pitch = one["pitch"]
    return " x ".join(one["pitch_in_words"][: 1 if pitch[0] == pitch[1] else 2]) if pitch else "unknown"


def _cell(one: dict[str, Any], symbol: str) -> str:
    value = one.get(symbol)
    if value is None and symbol == "Str" and one.get("Str_below") is not None:
        return less_than(one["Str_below"], 3)
    return NONE if value is None else significant(value, 6)


def _beside(one: dict[str, Any], rows: dict[str, list[float]]) -> str:
    """A body beside the patch that it was made of."""
    cells, name = one["cells"], one["name"]
    said = "in which no whole cell lies"
    if cells:
        size = f"{cells['columns']} x {cells['rows']} cells of {' x '.join(cells['pitch_in_words'])}"
        said = f"the same averaged over {size} with its sampling error, and the difference to these averages"
    lines = [["", "", "patch", "in cells", "+-", name, "difference"]]
    for symbol, row in rows.items():
        _, unit, factor, _ = PARAMETERS[symbol]
        values = [*(value * factor for value in row[:3]), np.nan if one[symbol] is None else one[symbol], row[3] * factor]
        lines.append([symbol, unit, *(NONE if np.isnan(value) else significant(value, n) for value, n in zip(values, (5, 5, 2, 5, 2), strict=True))])
    return "\n".join([f"\n{name}: its patch, {said}", *aligned(lines, "", names=2), ""])


def _remarks(one: dict[str, Any], document: dict[str, Any], found: dict[str, Any], _: Any) -> str:
    """Remarks on a surface: what its file says, what a scene did, and why parameters are missing."""
    said, missing = list(one["notes"]), one["points"] - one["measured"]
    if missing:
        said.append(f"{missing} of {one['points']} points are missing and take no part")
    if document["Sz"] == 0:
        said.append("flat: all its heights are equal, so what tells of their shape has no value")
    if found.get("below_pitch"):
        said.append("Sal and Str have no value: from each point to the next the heights are all but unrelated")
    if one["pitch"] is None:
        said.append("Sdq, Sdr, Sal and Str need the distance of the points: give --pitch")
    return f"\n{one['name']}: {one['format']}\n" + "".join(f"  {line}\n" for line in said)


def _short_names(ones: list[dict[str, Any]]) -> list[str]:
    """Names of files without their folder, unless another has the same; of maps of one run file what they are."""
    if len(ones) > 1 and all(one["map"] for one in ones) and len({one["name"].removesuffix(one["map"]) for one in ones}) == 1:
        return [one["map"] for one in ones]
    short = [one["name"].rsplit("/", 1)[-1] for one in ones]
    return [one["name"] if short.count(name) > 1 else name for one, name in zip(ones, short, strict=True)]


def significant(number: float, digits: int) -> str:
    """A number with so many significant digits; very large and very small ones with an exponent.

    Examples
    --------
    >>> significant(9.9996, 4), significant(1.5e-7, 2), significant(0.0, 3)
    ('10.00', '1.5e-7', '0')
    """
    mantissa, _, exponent = f"{number:.{digits - 1}e}".partition("e")
    if number == 0 or not exponent:
        return f"{number:.0f}"
    places = digits - 1 - int(exponent)
    return f"{number:.{max(places, 0)}f}" if -5 <= int(exponent) < 7 else f"{mantissa}e{int(exponent)}"


def less_than(bound: float, digits: int) -> str:
    """The upper bound of a positive number, rounded up.

    Examples
    --------
    >>> less_than(0.12341, 3), less_than(0.5, 3)
    ('< 0.124', '< 0.500')
    """
    nearest = float(significant(bound, digits))
    last = 10.0 ** (math.floor(math.log10(bound)) + 1 - digits)
    return f"< {significant(nearest + last if nearest < bound else nearest, digits)}"
