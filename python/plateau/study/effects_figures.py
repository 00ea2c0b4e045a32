"""Figures of effects: their sizes, means at levels and pairs of levels, residuals, and the surface over two factors."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy import stats

from plateau.study.data import Factor
from plateau.study.figure_axes import STEPS, dots, drawn_map, grid_points, held, positions, set_axis
from plateau.study.model import Fitted
from plateau.study.response_effects import ResponseEffects
from plateau.style import LINES, NARROW, QUIET, WIDE, labelled, logarithmic, look, new, wrapped
from plateau.units import Unit, unit_for, unit_of

# Most terms, and panels of pairs, of a figure; most panels beside each other.
MOST_TERMS, MOST_PAIRS, BESIDE = 20, 12, 3
# Standardised residuals beyond this have the number of their run.
FAR = 2.5


def _pareto(one: ResponseEffects, fit: Fitted) -> Any:
    """Effects with their intervals and shares of the variance, the largest share on top."""
    table = one.terms.sort_values("share", ascending=False, kind="stable")
    left_out, table = len(table) - MOST_TERMS, table.head(MOST_TERMS)
    if table.empty:
        return None
    level, has_effects = f"{100 * fit.confidence:g} %", bool(table["effect"].notna().any())
    notes = [f"Bars: {level} interval"] if table["low"].notna().any() else []
    notes += [f"filled: p < {1 - fit.confidence:.3g}"] if table["p"].notna().any() else []
    notes += [f"{left_out} smaller terms are not shown"] if left_out > 0 else []
    caption = f"{one.title}: effects with {level} intervals, and shares of the variance"
    figure, axes = new(WIDE, 26 + 5 * len(table), caption, 1, 1 + has_effects, "; ".join(notes), sharey=True)
    places, colours = np.arange(len(table)), np.where(table["p"] < 1.0 - fit.confidence, LINES[0], QUIET)
    if has_effects:
        unit, axis = unit_for(one.unit, float(table["effect"].abs().max())), axes[0, 0]
        for place, colour, row in zip(places, colours, table.to_dict("records"), strict=True):
            effect, low, high = (row[name] * unit.per_si for name in ("effect", "low", "high"))
            axis.plot([low, high], [place, place], color=colour, linewidth=1.4, solid_capstyle="butt")
            axis.plot(effect, place, "o", color=colour, markerfacecolor=colour if row["p"] < 1.0 - fit.confidence else "white")
        axis.axvline(0.0, color=QUIET, linewidth=0.6)
        axis.locator_params(axis="x", nbins=6)
        name = one.response.name if one.response.transform == "none" else one.title
        axis.set_xlabel(labelled(f"effect on {name}", unit.of_differences))
    axes[0, -1].barh(places, 100 * table["share"], height=0.6, color=colours)
    axes[0, -1].set(xlabel="share of the variance, %", xlim=(0, None))
    axes[0, 0].set_yticks(places, [wrapped(str(term), 40) for term in table["term"]])
    axes[0, 0].invert_yaxis()
    return figure


def _main_effects(one: ResponseEffects, fit: Fitted) -> Any:
    own = [[factor] for at, factor in enumerate(fit.study.factors) if any(at in term for term in fit.terms)]
    # With squares, means over runs are not those at the middle of the others.
    notes = ["rings: means of runs"] if fit.model != "quadratic" else []
    notes += ["the others averaged over their levels, ranges at their middle"] if len(fit.study.factors) > 1 else []
    return _means(one, fit, own, f"{one.response.name}: means at the levels of each factor", notes)


def _interactions(one: ResponseEffects, fit: Fitted) -> Any:
    table = one.table[[isinstance(term, tuple) and len(set(term)) == 2 == len(term) for term in one.table["factors"]]]
    pairs, left_out = table.sort_values("share", ascending=False, kind="stable")["factors"].head(MOST_PAIRS), len(table) - MOST_PAIRS
    # Over the factor with more values, which is a number if there is one; a line for each level of the other.
    own = [sorted((fit.study.factors[at] for at in pair), key=lambda one: (one.is_number, one.is_range), reverse=True) for pair in pairs]
    notes = ["the others averaged over their levels", *([f"{left_out} pairs with smaller shares are not shown"] if left_out > 0 else [])]
    return _means(one, fit, own, f"{one.response.name}: means at pairs of levels, the pair with the largest share first", notes)


def _means(one: ResponseEffects, fit: Fitted, groups: Sequence[list[Factor]], caption: str, notes: list[str]) -> Any:
    """Means at the levels of a factor, with a line for each level of another one if there is one, in a panel for each group."""
    if not groups:
        return None
    columns = min(len(groups), BESIDE)
    notes = [f"Bars and bands: {100 * fit.confidence:g} % interval of the model’s mean", *notes] if np.isfinite(fit.error) else notes
    size = (WIDE if columns > 1 else NARROW), 12 + 52 * -(-len(groups) // columns)
    figure, axes = new(*size, caption, -(-len(groups) // columns), columns, "; ".join(notes), sharey=True)
    unit = unit_of(one.response.unit, one.response.back(fit.values))
    for axis, (x, *others) in zip(axes.flat, groups, strict=False):
        means = one.means(x.name, *(other.name for other in others), steps=STEPS // 3)
        levels = _levels(others[0], list(dict.fromkeys(means[others[0].name]))) if others else [None]
        for number, level in enumerate(levels):
            own = means if level is None else means[[value == level for value in means[others[0].name]]]
            middle, low, high = (unit.value(one.response.back(own[name])) for name in ("mean", "low", "high"))
            style = look(number) | {"label": None if level is None else wrapped(others[0].shown(level), 16)}
            if x.is_number:
                band = {"facecolor": (LINES[number], 0.15), "edgecolor": (LINES[number], 0.6), "linewidth": 0.4}
                axis.fill_between(positions(x, own[x.name]), low, high, **band)
                axis.plot(positions(x, own[x.name]), middle, **style)
            else:
                places = positions(x, own[x.name]) + 0.08 * (number - (len(levels) - 1) / 2)
                axis.errorbar(places, middle, [middle - low, high - middle], marker="o", elinewidth=1.0, capsize=2, linewidth=0.6, **style)
        if others:
            # As many beside each other as a panel is wide.
            beside = max(36 // (6 + max(len(others[0].shown(level)) for level in levels)), 1)
            place = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "ncols": beside, "columnspacing": 1.0}
            axis.legend(title=wrapped(others[0].name), title_fontsize=7, alignment="left", **place)
        elif fit.model != "quadratic":
            of_runs = one.means(x.name)
            axis.plot(positions(x, of_runs[x.name]), unit.value(one.response.back(of_runs["observed"])), "o", mec=LINES[0], mfc="none")
        set_axis(axis, x, has_levels=True)
    for axis in axes.flat[len(groups) :]:
        axis.set_axis_off()
    for axis in axes[:, 0]:
        axis.set_ylabel(labelled(one.response.name, unit.symbol))
    if one.response.transform == "log":
        # It is fitted so.
        logarithmic(axes[0, 0], "y")
    return figure


def _levels(factor: Factor, levels: list[Any]) -> list[Any]:
    """Levels of many that are shown: the ends and the middle; of a range those within, for axial points are beyond it."""
    if factor.is_range:
        levels = [level for level in levels if abs(factor.coded(level)) < 1.0 + 1e-6]
    elif len(levels) <= len(LINES):
        return levels
    return list(dict.fromkeys([levels[0], *([levels[len(levels) // 2]] if len(levels) % 2 else []), levels[-1]]))


def _residuals(one: ResponseEffects, fit: Fitted) -> Any:
    """Residuals against fitted values, in the order of the runs, and against normal quantiles."""
    if fit.residual_freedom == 0 or np.isnan(fit.error):
        return None
    table = one.residuals
    unit = unit_for(one.unit, float(table["residual"].abs().max()))
    of_fit = unit_of(one.response.unit, table["fitted"]) if one.response.transform == "none" else Unit("", 1.0)
    caption = f"{one.title}: residuals against fitted values, in the order of the runs, and against normal quantiles"
    figure, axes = new(WIDE, 60, caption, 1, 3)
    residuals, standardised = table["residual"].to_numpy() * unit.per_si, table["standardised"].to_numpy()
    quantiles = stats.probplot(residuals, fit=False)[0][np.argsort(np.argsort(residuals, kind="stable"))]
    of_residuals = labelled("residual", unit.of_differences)
    panels = [(of_fit.value(table["fitted"].to_numpy()), residuals, labelled("fitted", of_fit.symbol or one.title), of_residuals)]
    panels += [(table["made_as"].to_numpy(), residuals, "order of the runs", of_residuals)]
    panels += [(quantiles, standardised, "normal quantile", "residual, standard deviations")]
    for axis, (x, y, label, of_y) in zip(axes.flat, panels, strict=True):
        axis.plot(x, y, "o", color=LINES[0], alpha=0.7 if len(x) < 100 else 0.4, markeredgewidth=0)
        if y is residuals:
            axis.axhline(0.0, color=QUIET, linewidth=0.6)
        else:
            axis.axline((0.0, 0.0), slope=1.0, color=QUIET, linewidth=0.6)
        axis.set(xlabel=label, ylabel=of_y)
        for at in np.flatnonzero(np.abs(standardised) > FAR)[:12] if y is residuals else ():
            axis.annotate(str(table["run"].iloc[at]), (x[at], y[at]), xytext=(3, 0), textcoords="offset points", fontsize=7, va="center")
    return figure


def _surface(one: ResponseEffects, fit: Fitted) -> Any:
    """Map of what the model expects over the two numbers with the largest shares."""
    factors = fit.study.factors
    between = [at for at, coding in enumerate(fit.codings) if coding.is_straight and any(at in term for term in fit.terms)]
    shares = {at: sum(row["share"] for row in one.terms.to_dict("records") if at in row["factors"]) for at in between}
    pair = sorted(sorted(between, key=lambda at: -shares[at])[:2])
    if len(pair) < 2:
        return None
    x, y = (factors[at] for at in pair)
    others = {one.factor.name: one.factor.value(0.0).item() if one.is_straight else (one.classes or ())[0] for one in fit.codings}
    grid = [factor.value(np.linspace(-1.0, 1.0, STEPS)) for factor in (x, y)]
    rows = fit.matrix(grid_points(x, y, grid, others))
    values = np.where(fit.tells(rows), one.response.back(rows @ fit.coefficients), np.nan).reshape(STEPS, STEPS)
    if not np.isfinite(values).any():
        return None
    at = held(factors, others, (x, y))
    caption = f"{one.response.name}: what the model expects over {x.name} and {y.name}" + (f", at {at}" if at else "")
    unit, note = unit_of(one.response.unit, values), f"At {at}; dots: runs, whatever the others are" if at else "Dots: runs"
    label = labelled(one.response.name, unit.symbol)
    figure = drawn_map((x, y), grid, unit.value(values), label, caption, note, one.response.transform == "log")
    dots(figure.axes[0], x, y, fit.study.runs)
    return figure


# By the ends of their names, in the order in which pages have them.
DRAWINGS = {"pareto": _pareto, "main-effects": _main_effects, "interactions": _interactions, "residuals": _residuals, "surface": _surface}
