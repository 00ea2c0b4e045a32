"""Figures of optima, sensitivities, fits and comparisons."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas
from scipy import stats

from plateau.errors import InputError
from plateau.quantities import series_of
from plateau.study.data import Factor, Numbers, Response
from plateau.study.figure_axes import STEPS, dots, drawn_map, file_names, grid_points, held, positions, set_axis
from plateau.style import APART, CHOSEN, DASHES, LINES, NARROW, QUIET, WIDE, Figures, in_style, labelled, new, wrapped
from plateau.units import unit_for, unit_of

if TYPE_CHECKING:
    from plateau.study.fit_answer import Fit
    from plateau.study.optimum import Optimum
    from plateau.study.scene_comparison import Comparison
    from plateau.study.variance_parts import Sensitivity


@in_style
def optimum_figures(found: "Optimum", contour: str | None = None) -> Figures:
    """Draws the profiler and, where two numbers may be anywhere, the desirability over those that matter most, or over a pair by name."""
    problem, best = found.problem, {row.factor: row.value for row in found.settings.itertuples()}
    axes_of = {factor.name: axis for factor, axis in zip(problem.study.factors, problem.axes, strict=True)}
    free = [factor for factor in problem.study.factors if axes_of[factor.name] is None]
    pair = _contour_pair(free, contour)
    own = [factor for factor in problem.study.factors if (axis := axes_of[factor.name]) is None or len(axis) > 1]
    if not own:
        return {}
    figure, spans = _profiler(found, best, own, axes_of)
    figures = {"profiler": figure}
    if pair or len(free) > 1:
        x, y = pair or sorted(sorted(free, key=lambda factor: -spans[factor.name])[:2], key=problem.study.factors.index)
        grid = [_range(factor, best[factor.name], 2 * STEPS) for factor in (x, y)]
        values = problem.worth(grid_points(x, y, grid, best)).reshape(2 * STEPS, 2 * STEPS)
        if np.isfinite(values).any() and np.nanmax(values) > np.nanmin(values):
            at = f", at {said}" if (said := held(problem.study.factors, best, (x, y))) else ""
            note = f"Star: best settings{at}" + ("; grey: a limit is missed" if problem.limits else "")
            figures["contour"] = drawn_map((x, y), grid, values, "desirability", f"Desirability over {x.name} and {y.name}{at}", note)
            figures["contour"].axes[0].set_facecolor(APART)
            dots(figures["contour"].axes[0], x, y, pandas.DataFrame([best]), "*", 9)
    return figures


def _profiler(found: "Optimum", best: dict[str, Any], own: Sequence[Factor], axes_of: dict[str, Any]) -> tuple[Any, dict[str, float]]:
    """Responses and their desirability along each factor, and how much the desirability changes along it."""
    problem, spans = found.problem, {}
    shown, level = problem.wanted, f"{100 * problem.confidence:g} %"
    caption = "Responses and their desirability along each factor, the others at the best settings"
    note = f"Bands: {level} interval of means; vertical lines: best settings" + ("; dotted: limits" if problem.limits else "")
    size = (WIDE if len(own) > 2 else NARROW), 14 + 34 * (len(shown) + 1)
    figure, axes = new(*size, caption, len(shown) + 1, len(own), note, sharex="col", sharey="row")
    for column, factor in enumerate(own):
        levels = axes_of[factor.name]
        values = _range(factor, best[factor.name], STEPS) if levels is None else np.array(levels)
        points = pandas.DataFrame([best] * len(values)).assign(**{factor.name: values})
        forecasts, places = problem.forecasts(points, with_intervals=True), positions(factor, values)
        style = {"color": LINES[0], "linestyle": "-" if levels is None else "none", "marker": "" if levels is None else "o"}
        for row, name in enumerate(shown):
            unit, axis = unit_of(problem.surrogates[name].response.unit, problem.study.runs[name]), axes[row, column]
            low, middle, high = (unit.value(forecasts[name][end].to_numpy()) for end in ("mean_low", "value", "mean_high"))
            axis.plot(places, middle, **style)
            if levels is None:
                axis.fill_between(places, low, high, color=LINES[0], alpha=0.18, linewidth=0)
            else:
                axis.vlines(places, low, high, color=LINES[0], linewidth=1.0)
            for limit in (limit for limit in problem.limits if limit.response == name):
                axis.axhline(unit.value(limit.value), color=LINES[1], linestyle=":")
            axes[row, 0].set_ylabel(labelled(name, unit.symbol))
        desirability = np.nan_to_num(problem.worth(points))
        spans[factor.name] = float(np.ptp(desirability))
        axes[-1, column].plot(places, desirability, **style)
        set_axis(axes[-1, column], factor)
        for axis in axes[:, column]:
            axis.axvline(positions(factor, [best[factor.name]])[0], color=CHOSEN, linewidth=0.8)
    axes[-1, 0].set(ylabel="desirability", ylim=(-0.03, 1.03))
    return figure, spans


def _range(factor: Factor, best: Any, count: int) -> Numbers:
    """Values over a range, and as far beyond it as the best one is, which may be that of an axial run."""
    place = float(factor.coded(best))
    return factor.value(np.linspace(min(place, -1.0), max(place, 1.0), count))


def _contour_pair(free: Sequence[Factor], asked: str | None) -> tuple[Factor, Factor] | None:
    """The two factors of a contour that was asked for; refuses others than two different ones that may be anywhere in a range."""
    if asked is None:
        return None
    by_name = {factor.name: factor for factor in free}
    # Names may have commas, too.
    for at in (at for at, letter in enumerate(asked) if letter == ","):
        one, other = by_name.get(asked[:at].strip()), by_name.get(asked[at + 1 :].strip())
        if one and other and one is not other:
            return one, other
    expected = "expected two different factors that are numbers and not held, with a comma between"
    raise InputError(f"--contour {asked}: {expected}; there are {', '.join(by_name) or 'none here'}")


@in_style
def sensitivity_figures(found: "Sensitivity") -> Figures:
    """Draws parts of the variance of each response, or elementary effects."""
    figures: Figures = {}
    draws, kind = (_elementary, "elementary-effects") if found.is_morris else (_indices, "indices")
    names = [surrogate.response.name for surrogate in found.surrogates]
    for surrogate, stem in zip(found.surrogates, file_names(names), strict=True):
        table = found.table[found.table["response"] == surrogate.response.name]
        if not surrogate.error and len(table):
            figures[f"{stem}-{kind}"] = draws(found, surrogate.response, table)
    return figures


def _indices(found: "Sensitivity", response: Response, table: pandas.DataFrame) -> Any:
    """Parts alone and with interactions, with their intervals, the largest on top and the seeds below."""
    level = f"{100 * found.confidence:g} %"
    is_seeds = (table["factor"] == "seeds") & table["first_order"].isna()
    table = pandas.concat([table[~is_seeds].sort_values("total", ascending=False, kind="stable"), table[is_seeds]])
    note = f"Bars: {level} intervals of what the runs leave open" + (
        "; seeds: part of the variance of single runs" if is_seeds.any() else ""
    )
    figure, axes = new(NARROW, 30 + 7 * len(table), f"{response.name}: parts of the variance, with {level} intervals", note=note)
    axis, places = axes[0, 0], np.arange(len(table))
    for kind, label, aside, colour, mark in (
        ("first_order", "alone (first order)", -0.15, LINES[0], "o"),
        ("total", "with interactions (total)", 0.15, LINES[1], "s"),
    ):
        middle, low, high = (np.clip(table[f"{kind}{end}"].to_numpy(float), 0.0, 1.0) for end in ("", "_low", "_high"))
        axis.errorbar(
            middle, places + aside, xerr=[middle - low, high - middle], fmt=mark, color=colour, elinewidth=1.4, capsize=2, label=label
        )
    axis.set(xlabel=labelled(f"part of the variance of {response.name}", ""), xlim=(-0.02, 1.02))
    axis.set_yticks(places, [wrapped(str(name)) for name in table["factor"]])
    axis.invert_yaxis()
    figure.legend(loc="outside upper left", ncols=2, columnspacing=1.0)
    return figure


def _elementary(found: "Sensitivity", response: Response, table: pandas.DataFrame) -> Any:
    """Deviations of elementary effects against their mean sizes."""
    unit = unit_of(response.unit, found.study.runs[response.name])
    sizes, errors, deviations = (table[name].to_numpy(float) * unit.per_si for name in ("mean_size", "standard_error", "deviation"))
    caption = (
        f"{response.name}: elementary effects over the whole range of each factor; above the line a factor acts unevenly or with others"
    )
    figure, axes = new(NARROW, 76, caption, note="Bars: standard error; line: deviation = mean size")
    axis = axes[0, 0]
    axis.errorbar(sizes, deviations, xerr=np.nan_to_num(errors), fmt="o", color=LINES[0], capsize=2)
    for name, x, y in zip(table["factor"], sizes, deviations, strict=True):
        axis.annotate(wrapped(str(name)), (x, y), xytext=(3, 3), textcoords="offset points", fontsize=7)
    axis.axline((0.0, 0.0), slope=1.0, color=QUIET, linewidth=0.6)
    axis.set(
        xlabel=labelled("mean size of effects, μ*", unit.of_differences), ylabel=labelled("deviation of effects, σ", unit.of_differences)
    )
    axis.set(xlim=(0.0, 1.15 * np.nanmax(sizes + np.nan_to_num(errors))), ylim=(-0.03 * np.nanmax(deviations, initial=1e-300), None))
    return figure


@in_style
def fit_figures(found: "Fit") -> Figures:
    """Draws profiles of the keys, regions of their pairs, and series beside what was measured."""
    factors, level = {factor.name: factor for factor in found.study.factors}, f"{100 * found.confidence:g} %"
    columns = min(len(factors), 3)
    caption = f"How far −2 ln L rises where a key is held at a value, the others at their most likely ones; shaded: {level} interval"
    rows, note = -(-len(factors) // columns), f"Dashed: threshold of the {level} interval, which is shaded"
    figure, axes = new(WIDE if columns > 1 else NARROW, 14 + 50 * rows, caption, rows, columns, note, sharey=True)
    for axis, (name, own) in zip(axes.flat, found.profiles.groupby("key", sort=False), strict=False):
        factor, threshold = factors[str(name)], float(own["threshold"].iloc[0])
        axis.plot(factor.in_study_unit(own["value"]), own["rise"], color=LINES[0])
        axis.axhline(threshold, color=QUIET, linestyle="--", linewidth=0.8)
        for row in found.keys[(found.keys["key"] == name) & found.keys["low"].notna()].to_dict("records"):
            axis.axvspan(*factor.in_study_unit(np.array([row["low"], row["high"]])), color=LINES[0], alpha=0.15, linewidth=0)
        axis.set_ylim(-0.05 * threshold, 3.0 * threshold)
        set_axis(axis, factor)
    for axis in axes.flat[len(factors) :]:
        axis.set_axis_off()
    for axis in axes[:, 0]:
        axis.set_ylabel("rise of −2 ln L")
    figures: Figures = {"profiles": figure}
    for one, other, across, along, rises in found.regions:
        x, y = factors[one], factors[other]
        shaded = f"{level} region; " if not found.outcome.has_failed else ""
        note = f"Shaded: {shaded}dots: runs" if shaded else "Dots: runs"
        figure, ((axis,),) = new(NARROW, 76, f"Where {one} and {other} may be: {shaded}dots: runs", note=note)
        if shaded:
            threshold, at = float(stats.chi2.ppf(found.confidence, 2)), (x.in_study_unit(across), y.in_study_unit(along))
            axis.contourf(*at, rises, [-1.0, threshold], colors=[LINES[0]], alpha=0.2)
            axis.contour(*at, rises, [threshold], colors=[LINES[0]], linewidths=1.0)
        dots(axis, x, y, found.runs, size=3.0)
        set_axis(axis, x)
        set_axis(axis, y, "y")
        figures[f"region-{'-'.join(file_names([one, other]))}"] = figure
    measured = dict(list(found.series.groupby("response", sort=False)))
    for (name, rows), stem in zip(measured.items(), file_names(list(map(str, measured))), strict=True):
        unit, time = unit_for(rows["unit"].iloc[0], float(rows["measured"].abs().max())), unit_for("s", float(rows["time"].max()))
        caption = f"{name}: measured, and what runs give at the most likely values; bars: one standard deviation"
        figure, ((axis,),) = new(NARROW, 66, caption, note="Runs: at the most likely values; bars: one standard deviation")
        at = time.value(rows["time"].to_numpy())
        marks = {"measured": ("measured", "uncertainty", "o", "black", 4.0), "runs": ("forecast", "forecast_deviation", "s", LINES[0], 2.5)}
        # Runs are told at the measured times alone: no line says what is between them.
        for label, (middle, half, mark, colour, size_of) in marks.items():
            values = unit.value(rows[middle].to_numpy()), unit.per_si * rows[half].to_numpy()
            style = {"mfc": "white", "elinewidth": 0.6, "capsize": 2} if label == "measured" else {"elinewidth": 1.4, "zorder": 3}
            axis.errorbar(at, *values, fmt=mark, color=colour, ms=size_of, label=label, **style)
        axis.set(xlabel=labelled("time", time.symbol), ylabel=labelled(str(name), unit.symbol))
        figure.legend(loc="outside upper left", ncols=2)
        figures[f"series-{stem}"] = figure
    return figures


@in_style
def comparison_figures(found: "Comparison") -> Figures:
    """Draws each series against time, mean with the standard deviation of runs, and below it the differences with their intervals."""
    figures: Figures = {}
    reference = next(iter(found.scenes))
    for series, curves in found.curves.groupby("series", sort=False):
        name, unit = series_of(str(series)).title, unit_for(curves["unit"].iloc[0], float(curves["mean"].abs().max()))
        of_time = unit_of("s", curves["time"])
        level = f"{100 * found.confidence:g} %"
        caption = f"{name} against time: means over the seeds with the standard deviation of runs, and differences with {level} intervals"
        note = f"Bands: standard deviation of runs; below, {level} interval of the difference from {reference} at each time alone"
        figure, axes = new(NARROW, 92, caption, 2, 1, note, sharex=True, height_ratios=[2, 1])
        top, below = axes[:, 0]
        for number, (scene, curve) in enumerate(curves.groupby("scene", sort=False)):
            colour, dashes = LINES[number % len(LINES)], DASHES[number % len(DASHES)]
            time, band = of_time.value(curve["time"]), {"color": colour, "alpha": 0.18, "linewidth": 0}
            middle, half = unit.value(curve["mean"].to_numpy()), unit.per_si * curve["deviation"].fillna(0.0).to_numpy()
            change, low, high = (unit.per_si * curve[end].to_numpy() for end in ("difference", "low", "high"))
            top.plot(time, middle, color=colour, linestyle=dashes, label=wrapped(str(scene), 30))
            top.fill_between(time, middle - half, middle + half, **band)
            below.plot(time, change, color=colour, linestyle=dashes)
            below.fill_between(time, low, high, **band)
        # Titles of series are longer than the axis.
        top.set_title(wrapped(name, 46), loc="left")
        top.set(ylabel=labelled("mean", unit.symbol))
        below.set(xlabel=labelled("time", of_time.symbol), ylabel=labelled("difference", unit.of_differences))
        below.axhline(0.0, color=QUIET, linewidth=0.6)
        figure.legend(*top.get_legend_handles_labels(), loc="outside upper left", ncols=2, columnspacing=1.0)
        figure.align_ylabels()
        figures[str(series)] = figure
    return figures
