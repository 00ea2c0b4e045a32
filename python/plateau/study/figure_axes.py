"""Axes of factors, and maps over two of them."""

import itertools
import re
from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas

from plateau.study.data import Factor, Numbers
from plateau.style import NARROW, labelled, logarithmic, new, number, wrapped
from plateau.units import shown_unit

# Places of a line.
STEPS = 61


def file_names(names: Sequence[str]) -> list[str]:
    """Names of files for names of responses, all different, of plain letters."""
    found: list[str] = []
    for name in names:
        plain = re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")[:60] or "response"
        others = itertools.chain([plain], (f"{plain}-{number}" for number in itertools.count(2)))
        found.append(next(other for other in others if other not in found))
    return found


def positions(factor: Factor, values: Any) -> Numbers:
    """Positions of values of a factor on its axis: numbers in the unit of the study, words side by side."""
    if factor.is_number:
        return factor.in_study_unit(np.asarray(values, float))
    return np.array([factor.levels.index(value) for value in values], float)


def set_axis(axis: Any, factor: Factor, way: str = "x", *, has_levels: bool = False) -> None:
    """Sets up the axis of a factor, with its levels alone if there is nothing between them."""
    own = getattr(axis, f"{way}axis")
    own.set_label_text(labelled(factor.name, shown_unit(factor.study_unit)))
    if not factor.is_number:
        own.set_ticks(range(len(factor.levels)), [wrapped(str(level), 12) for level in factor.levels])
        axis.set_xlim(-0.5, len(factor.levels) - 0.5)
        if sum(len(str(level)) for level in factor.levels) > 20:
            axis.tick_params(axis="x", rotation=90)
    elif factor.logarithmic:
        logarithmic(axis, way)
    elif not 1e-3 <= np.abs(ends := factor.in_study_unit(np.array(factor.ends))).max() < 1e5 and ends.any():
        # A power of ten at the end of an axis would stand on its label.
        axis.locator_params(axis=way, nbins=3)
        own.set_major_formatter(lambda value, _: number(value))
    if has_levels and factor.is_number and not factor.is_range and not factor.logarithmic and len(factor.levels) <= 4:
        own.set_ticks(factor.in_study_unit(np.array(factor.levels)))


def grid_points(x: Factor, y: Factor, grid: Sequence[Numbers], others: dict[str, Any]) -> pandas.DataFrame:
    """Points of a grid over two factors, those of the first one after each other; the others are held."""
    columns = dict(zip((x.name, y.name), (part.ravel() for part in np.meshgrid(*grid, indexing="ij")), strict=True))
    return pandas.DataFrame({**others, **columns})


def held(factors: Sequence[Factor], values: dict[str, Any], but: tuple[Factor, Factor]) -> str:
    """Values at which all factors but two are held, in words."""
    return ", ".join(f"{one.name} = {one.shown(values[one.name], 4)}" for one in factors if one not in but)


def drawn_map(
    axes: tuple[Factor, Factor], grid: Sequence[Numbers], values: Numbers, label: str, caption: str, note: str, is_log: bool = False
) -> Any:
    """A map over two factors with lines of equal values, whose numbers are those of its bar."""
    from matplotlib.ticker import LogLocator

    figure, ((axis,),) = new(NARROW, 76 + 4 * (len(note) // 60), caption, note=note)
    at = [factor.in_study_unit(values) for factor, values in zip(axes, grid, strict=True)]
    if np.ptp(values[np.isfinite(values)]) > 0:
        is_wide = is_log and (values > 0.0).all() and values.max() > 20.0 * values.min()
        options: dict[str, Any] = {"locator": LogLocator(subs=(1.0, 2.0, 5.0))} if is_wide else {"levels": 12}
        filled = axis.contourf(*at, values.T, cmap="viridis", **options)
        filled.set_edgecolor("face")
        axis.contour(*at, values.T, levels=filled.levels[::2], colors="white", linewidths=0.6)
        # Every line has its number beside the bar, where it hides nothing.
        figure.colorbar(filled, ax=axis, label=label, ticks=filled.levels[::2], **({"format": "%g"} if is_wide else {}))
    set_axis(axis, axes[0])
    set_axis(axis, axes[1], "y")
    return figure


def dots(axis: Any, x: Factor, y: Factor, points: pandas.DataFrame, mark: str = "o", size: float = 3.5) -> None:
    """Draws points of two factors, such as runs."""
    at = points[[x.name, y.name]].drop_duplicates()
    style = {"mfc": "white", "mec": "black", "mew": 0.6, "ms": size, "clip_on": False, "zorder": 5}
    axis.plot(x.in_study_unit(at[x.name]), y.in_study_unit(at[y.name]), mark, **style)
