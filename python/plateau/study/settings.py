"""Values of the factors of a study as people state them, and whether its runs tell of them."""

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas

from plateau.errors import InputError
from plateau.study.data import Factor, Study
from plateau.units import NUMBER, in_si

# Coded values that differ by less are the same, and by less than the second as people type them.
SAME, ROUNDED = 1e-9, 1e-5
# Part of the variance that a surrogate may miss at points left out before its smoothness is said to matter.
MISSED = 0.1


def held_values(study: Study, said: Mapping[str, Any] | Sequence[str], where: str, is_curved: bool) -> dict[str, Any]:
    """Values of the factors that were set, SI units or words, by name."""
    held: dict[str, Any] = {}
    names = {name for factor in study.factors for name in factor.names}
    for name, value in said.items() if isinstance(said, Mapping) else [_assignment(names, text) for text in said]:
        factor = factor_named(study, name, where)
        if factor.name in held:
            raise InputError(f"{where}: {factor.name} is given twice")
        held[factor.name] = value_of(factor, value, where, is_curved)
    return held


def factor_named(study: Study, name: str, where: str) -> Factor:
    for factor in study.factors:
        if name.strip() in factor.names:
            return factor
    raise InputError(f"{where}: {name!r} is not a factor of the study, expected one of {', '.join(one.name for one in study.factors)}")


def _assignment(names: set[str], text: str) -> tuple[str, str]:
    """Name and value of ``NAME=VALUE``; both may have ``=`` in them."""
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
    if not np.isfinite(value) or (factor.logarithmic and value <= 0):
        raise InputError(f"{where}: {factor.name} = {said}: expected a {'number above 0' if factor.logarithmic else 'number'}")
    if not factor.is_range:
        same = [level for level in factor.levels if abs(level - value) <= SAME * max(map(abs, factor.levels))]
        if not same and (factor.whole or (len(factor.levels) > 2 and not is_curved)):
            levels = ", ".join(map(factor.text, factor.levels))
            advice = "" if factor.whole else "; --model quadratic tells what lies between them"
            raise InputError(f"{where}: {factor.name} = {said}: the model knows the levels {levels} alone{advice}")
        value = same[0] if same else value
    return float(value)


def axis_of(factor: Factor, grid: int | None, is_curved: bool) -> list[Any]:
    """Values of a grid; the middle of a range or the first level without."""
    is_between = factor.is_number and (factor.is_range or (not factor.whole and (len(factor.levels) == 2 or is_curved)))
    if not is_between:
        return list(factor.levels) if grid else [factor.levels[0]]
    values = factor.value(np.linspace(-1.0, 1.0, max(grid, 1)) if grid and grid > 1 else [-1.0 if grid else 0.0])
    return [float(value) for value in (np.unique(np.round(values)) if factor.whole else values)]


def ends_of(study: Study, factor: Factor) -> tuple[float, float]:
    """Coded ends of the region of a factor: those of its range, and beyond it those of the runs, such as axial ones."""
    runs = factor.coded(study.runs[factor.name])
    return float(min(runs.min(), -1.0)), float(max(runs.max(), 1.0))


def reach_of(study: Study) -> float:
    """Distance from the middle to the farthest place of the region in all numbers together, coded: a corner of the ranges, or a run."""
    coded = [factor.coded(study.runs[factor.name]) for factor in study.factors if factor.is_number]
    return float(max(len(coded), np.square(coded).sum(axis=0).max(initial=0.0)) ** 0.5)


def region_of(study: Study) -> str:
    """The region of the design, in which forecasts are made and the best is searched, in words."""
    said = "the ranges of the factors"
    ends = {factor: ends_of(study, factor) for factor in study.factors if factor.is_number}
    far = [(factor, end) for factor, end in ends.items() if end[0] < -1.0 - SAME or end[1] > 1.0 + SAME]
    if not far:
        return said
    shown = ", ".join(f"{factor.name} {' … '.join(factor.shown(float(factor.value(at)), 4) for at in end)}" for factor, end in far)
    return f"{said}, and around them as far as runs are: {shown}, all together no farther from the middle than runs or corners of the ranges"


def beyond_of(study: Study, places: pandas.DataFrame) -> list[str]:
    """Factors, by place, that are beyond the region of the design: the ranges, and around them what is no farther out than runs are."""
    said: list[list[str]] = [[] for _ in range(len(places))]
    coded = {factor: factor.coded(places[factor.name].to_numpy(float)) for factor in study.factors if factor.is_number}
    for factor, own in coded.items():
        ends = ends_of(study, factor)
        low, high = (factor.shown(float(factor.value(end)), with_unit=is_last) for end, is_last in zip(ends, (False, True), strict=True))
        for at in np.flatnonzero((own < ends[0] - SAME) | (own > ends[1] + SAME)):
            said[at].append(f"{factor.name} is beyond {low} to {high}")
    away = np.sqrt(sum((own**2 for own in coded.values()), np.zeros(len(places))))
    for at in np.flatnonzero(away > reach_of(study) + ROUNDED):
        names = [factor.name for factor, own in coded.items() if abs(own[at]) > 1.0 + SAME]
        if not said[at]:
            said[at].append(f"{' and '.join(names)} are together farther from the middle than all runs")
    return [joined(one) for one in said]


def straight_between(study: Study, places: pandas.DataFrame) -> list[str]:
    """Names of factors with two values in runs with a result, between which there are places."""
    runs = study.runs[study.runs[[one.name for one in study.responses]].notna().any(axis=1)]
    straight = [factor for factor in study.factors if factor.is_number and len(np.unique(np.round(factor.coded(runs[factor.name]), 9))) == 2]
    return [one.name for one in straight if (np.abs(one.coded(places[one.name].to_numpy(float))) < 1.0 - SAME).any()]


def no_curve(names: list[str]) -> list[str]:
    """Caution that the runs show no curve of factors with two values."""
    if not names:
        return []
    said = f"no curve of {', '.join(names)}: the runs have two values of {'it' if len(names) == 1 else 'each'}, and between these forecasts "
    said += "follow a straight line, and their intervals do not know by how much the response bends; give a third value in the middle, "
    return [said + 'such as with design = "central-composite", and look with predict --confirm how far off a forecast is']


def not_smooth(missed: float, points: str = "points", most: str = "") -> list[str]:
    """Caution that a surrogate misses so much of the variance at points that were left out; none of a small part. `most` names intervals."""
    if not missed > MISSED:
        return []
    said = f"{points} that were left out are missed by {100 * min(missed, 1.0):.0f} % of the variance: intervals hold for smooth responses, and are "
    return [said + f"too short{most} if it has a threshold or a kink; narrower ranges or more points tell whether it has one"]


def each_of(texts: str | Sequence[str]) -> Sequence[str]:
    """Texts; one alone is a sequence of one."""
    return [texts] if isinstance(texts, str) else texts


def in_short(cautions: Iterable[str]) -> str:
    """Cautions as tables have them: what they begin with."""
    return joined(caution.split(":")[0].split(" (")[0] for caution in cautions)


def joined(parts: Any) -> str:
    return "; ".join(dict.fromkeys(part for one in parts for part in str(one).split("; ") if part))
