"""Values of the factors of a study as people state them, and whether its runs tell of them."""

import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas

from plateau.errors import InputError
from plateau.study.data import Factor, Study
from plateau.units import NUMBER, in_si

# Coded values that differ by less are the same.
SAME = 1e-9


def held_values(study: Study, said: Mapping[str, Any] | Sequence[str], where: str, is_curved: bool) -> dict[str, Any]:
    """Values of the factors that were set, SI units or words, by name."""
    held: dict[str, Any] = {}
    for name, value in said.items() if isinstance(said, Mapping) else [_assignment(study, text) for text in said]:
        factor = factor_named(study, name, where)
        if factor.name in held:
            raise InputError(f"{where}: {factor.name} is given twice")
        held[factor.name] = value_of(factor, value, where, is_curved)
    return held


def factor_named(study: Study, name: str, where: str) -> Factor:
    for factor in study.factors:
        if name.strip() in (factor.name, *factor.keys.split(", ")):
            return factor
    raise InputError(f"{where}: {name!r} is not a factor of the study, expected one of {', '.join(one.name for one in study.factors)}")


def _assignment(study: Study, text: str) -> tuple[str, str]:
    """Name and value of ``NAME=VALUE``; both may have ``=`` in them."""
    names = {name for factor in study.factors for name in (factor.name, *factor.keys.split(", "))}
    parts = [(text[: at.start()].strip(), text[at.end() :].strip()) for at in re.finditer("=", text)]
    return next((part for part in parts if part[0] in names), parts[0] if parts else (text, ""))


def value_of(factor: Factor, said: Any, where: str, is_curved: bool) -> Any:
    """A value of a factor, from a text with its unit, an SI number or a word."""
    if not factor.is_number:
        if str(said) not in factor.levels:
            raise InputError(f"{where}: {factor.name} = {said}: expected one of {', '.join(factor.levels)}")
        return str(said)
    value = said
    if isinstance(said, str):
        number = re.match(NUMBER, text := said.strip().replace("−", "-"))
        unit = text[number.end() :].strip() if number else ""
        if not number or bool(unit) < bool(factor.study_unit):
            what = f'a quantity such as "{factor.text(factor.ends[0])}"' if factor.study_unit else "a plain number"
            raise InputError(f"{where}: {factor.name} = {said}: expected {what}")
        # What a scene has may be given in any unit that measures the same.
        is_own = unit == factor.study_unit
        try:
            value = float(number[0]) * factor.one + factor.zero if is_own else in_si(number[0], unit, factor.unit or "1")
        except InputError as error:
            raise InputError(f"{where}: {factor.name} = {said}: {error}") from None
    if not np.isfinite(value) or factor.logarithmic and value <= 0:
        raise InputError(f"{where}: {factor.name} = {said}: expected a {'number above 0' if factor.logarithmic else 'number'}")
    if not factor.is_range:
        same = [level for level in factor.levels if abs(level - value) <= SAME * max(map(abs, factor.levels))]
        if not same and (factor.whole or len(factor.levels) > 2 and not is_curved):
            levels = ", ".join(map(factor.text, factor.levels))
            advice = "" if factor.whole else "; --model quadratic tells what lies between them"
            raise InputError(f"{where}: {factor.name} = {said}: the model knows the levels {levels} alone{advice}")
        value = same[0] if same else value
    return float(value)


def axis_of(factor: Factor, grid: int | None, is_curved: bool) -> list[Any]:
    """Values of a grid; the middle of a range or the first level without."""
    is_between = factor.is_number and (factor.is_range or not factor.whole and (len(factor.levels) == 2 or is_curved))
    if not is_between:
        return list(factor.levels) if grid else [factor.levels[0]]
    values = factor.value(np.linspace(-1.0, 1.0, max(grid, 1)) if grid and grid > 1 else [-1.0 if grid else 0.0])
    return [float(value) for value in (np.unique(np.round(values)) if factor.whole else values)]


def beyond_of(study: Study, places: pandas.DataFrame) -> list[str]:
    """By place, which factors are beyond the runs."""
    said: list[list[str]] = [[] for _ in range(len(places))]
    for factor in (factor for factor in study.factors if factor.is_number):
        run = factor.coded(study.runs[factor.name])
        ends, coded = (min(run.min(), -1.0), max(run.max(), 1.0)), factor.coded(places[factor.name].to_numpy(float))
        low, high = (factor.shown(float(factor.value(end)), with_unit=is_last) for end, is_last in zip(ends, (False, True), strict=True))
        for at in np.flatnonzero((coded < ends[0] - SAME) | (coded > ends[1] + SAME)):
            said[at].append(f"{factor.name} is beyond {low} to {high}")
    return [joined(one) for one in said]


def no_curve(study: Study, places: pandas.DataFrame) -> list[str]:
    """That the runs show no curve of factors with two values, between which there are places."""
    names = []
    for factor in (factor for factor in study.factors if factor.is_number):
        values = np.unique(np.round(factor.coded(study.runs[factor.name]), 9))
        if len(values) == 2 and (np.abs(factor.coded(places[factor.name].to_numpy(float))) < 1.0 - SAME).any():
            names.append(factor.name)
    if not names:
        return []
    said = f"{', '.join(names)}: the runs have two values of {'it' if len(names) == 1 else 'each'}, so that they show no curve: between these, "
    said += "forecasts follow a straight line, and their intervals do not know by how much the response bends; give a third value in the middle, "
    return [said + 'such as with design = "central-composite", and look with --confirm how far off a forecast is']


def joined(parts: Any) -> str:
    return "; ".join(dict.fromkeys(part for one in parts for part in str(one).split("; ") if part))
