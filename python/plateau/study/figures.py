"""Figures of studies."""

import itertools
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas
from scipy import stats

from plateau.quantities import series_of
from plateau.study.data import Factor, Numbers, Response
from plateau.style import APART, CHOSEN, DASHES, LINES, NARROW, QUIET, WIDE, Figures, in_style, labelled, new, wrapped
from plateau.units import Unit, shown_unit, unit_for, unit_of, with_minus

if TYPE_CHECKING:
    from plateau.study.analysis import Effects, ResponseEffects
    from plateau.study.calibration import Fit
    from plateau.study.model import Fitted
    from plateau.study.optimum import Optimum
    from plateau.study.scene_comparison import Comparison
    from plateau.study.variance_parts import Sensitivity

# Most terms, and panels of pairs, of a figure; most panels beside each other.
MOST_TERMS, MOST_PAIRS, BESIDE = 20, 12, 4
# Standardised residuals beyond this have the number of their run.
FAR = 2.5
STEPS = 61


def file_names(names: Sequence[str]) -> list[str]:
    """Names of files for names of responses, all different, of plain letters."""
    found: list[str] = []
    for name in names:
        plain = re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")[:60] or "response"
        others = itertools.chain([plain], (f"{plain}-{number}" for number in itertools.count(2)))
        found.append(next(other for other in others if other not in found))
    return found


def _positions(factor: Factor, values: Any) -> Any:
    """Where values of a factor are on its axis: numbers in the unit of the study, words side by side."""
    return (
        factor.in_study_unit(np.asarray(values, float)) if factor.is_number else np.array([factor.levels.index(value) for value in values])
    )


def _axis(axis: Any, factor: Factor, way: str = "x", *, has_levels: bool = False) -> None:
    """The axis of a factor, with its levels alone if there is nothing between them."""
    own = getattr(axis, f"{way}axis")
    own.set_label_text(labelled(factor.name, shown_unit(factor.study_unit)))
    if not factor.is_number:
        own.set_ticks(range(len(factor.levels)), [wrapped(str(level), 12) for level in factor.levels])
        if way == "x":
            axis.set_xlim(-0.5, len(factor.levels) - 0.5)
            if sum(len(str(level)) for level in factor.levels) > 20:
                axis.tick_params(axis="x", rotation=90)
    elif factor.logarithmic:
        _logarithmic(axis, way)
    elif not 1e-3 <= np.abs(ends := factor.in_study_unit(np.array(factor.ends))).max() < 1e5 and ends.any():
        # A power of ten at the end of an axis would stand on its label.
        axis.locator_params(axis=way, nbins=3)
        own.set_major_formatter(lambda value, _: _number(value))
    if has_levels and factor.is_number and not factor.is_range and not factor.logarithmic and len(factor.levels) <= 4:
        own.set_ticks(factor.in_study_unit(np.array(factor.levels)))


def _logarithmic(axis: Any, way: str) -> None:
    """A logarithmic scale with few numbers, which do not touch."""
    from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter

    own = getattr(axis, f"{way}axis")
    getattr(axis, f"set_{way}scale")("log")
    low, high = sorted(own.get_view_interval())
    steps = LogLocator(subs=(1.0, 2.0, 5.0) if high < 100.0 * low else (1.0,))
    own.set_major_locator(MaxNLocator(4, steps=[1, 2, 2.5, 5, 10]) if high < 5.0 * low else steps)
    own.set_major_formatter(FuncFormatter(lambda value, _: _number(value)))
    own.set_minor_formatter(NullFormatter())


def _number(value: float) -> str:
    """A number as axes have it, with a power of ten if it is far from 1."""
    if value == 0.0 or 1e-3 <= abs(value) < 1e5:
        return with_minus(f"{value:.6g}")
    digits, power = f"{value:.3e}".split("e")
    times = "" if float(digits) == 1.0 else rf"{float(digits):g}\times"
    return rf"${times}10^{{{int(power)}}}$"


# Effects ---------------------------------------------------------------------------------------------------------------------------


@in_style
def effects_figures(found: "Effects") -> Figures:
    """Draws effects, means, interactions, residuals and surfaces of each response."""
    figures: Figures = {}
    for one, stem in zip(found.responses, file_names([one.response.name for one in found.responses]), strict=True):
        if one.fit is None:
            continue
        drawn = {
            "pareto": _pareto(one, one.fit),
            "main-effects": _main_effects(one, one.fit),
            "interactions": _interactions(one, one.fit),
            "residuals": _residuals(one, one.fit),
            "surface": _surface(one, one.fit),
        }
        figures |= {f"{stem}-{name}": figure for name, figure in drawn.items() if figure is not None}
    return figures


def _pareto(one: "ResponseEffects", fit: "Fitted") -> Any:
    """Effects with their intervals and shares of the variance, the largest share on top."""
    table = one.table[one.table["factors"].notna()].sort_values("share", ascending=False, kind="stable")
    left_out, table = len(table) - MOST_TERMS, table.head(MOST_TERMS)
    if table.empty:
        return None
    level = f"{100 * fit.confidence:g} %"
    has_effects = bool(table["effect"].notna().any())
    margins = table["margin_of_error"].dropna()
    notes = [f"Bars: {level} interval" if table["low"].notna().any() else "", f"filled: p < {1 - fit.confidence:.3g}"]
    notes = notes if table["p"].notna().any() else ["dotted: margin of error (Lenth)"] if len(margins) else []
    notes += [f"{left_out} smaller terms are not shown"] if left_out > 0 else []
    caption = f"{one.title}: effects with {level} intervals, and shares of the variance"
    height = 22 + 5 * len(table) + 4 * bool(notes)
    figure, axes = new(WIDE, height, caption, 1, 1 + has_effects, "; ".join(filter(None, notes)), sharey=True)
    places = np.arange(len(table))
    is_sure = (table["p"] < 1.0 - fit.confidence).to_numpy() | (table["effect"].abs() > table["margin_of_error"]).to_numpy()
    colours = np.where(is_sure, LINES[0], QUIET)
    if has_effects:
        unit = unit_for(one.unit, float(table["effect"].abs().max()))
        for place, colour, row in zip(places, colours, table.to_dict("records"), strict=True):
            effect, low, high = (row[name] * unit.per_si for name in ("effect", "low", "high"))
            if np.isfinite(low):
                axes[0, 0].plot([low, high], [place, place], color=colour, linewidth=1.4, solid_capstyle="butt")
            axes[0, 0].plot(effect, place, "o", color=colour, markerfacecolor=colour if row["p"] < 1.0 - fit.confidence else "white")
        for sign in (-1.0, 1.0) if len(margins) else ():
            axes[0, 0].axvline(sign * margins.iloc[0] * unit.per_si, color=LINES[1], linestyle=":")
        axes[0, 0].axvline(0.0, color=QUIET, linewidth=0.6)
        axes[0, 0].locator_params(axis="x", nbins=6)
        axes[0, 0].set_xlabel(
            labelled(f"effect on {one.title.split(',')[0] if one.response.transform == 'none' else one.title}", unit.of_differences)
        )
    axes[0, -1].barh(places, 100 * table["share"], height=0.6, color=colours)
    axes[0, -1].set(xlabel="share of the variance, %", xlim=(0, None))
    axes[0, 0].set_yticks(places, [wrapped(str(term), 40) for term in table["term"]])
    axes[0, 0].invert_yaxis()
    return figure


def _main_effects(one: "ResponseEffects", fit: "Fitted") -> Any:
    """Means at the levels of each factor."""
    own = [factor for at, factor in enumerate(fit.study.factors) if any(at in term for term in fit.terms)]
    if not own:
        return None
    columns = min(len(own), BESIDE)
    rows = -(-len(own) // columns)
    averaged = "the others averaged over their levels, ranges at their middle" if len(fit.study.factors) > 1 else ""
    level = f"{100 * fit.confidence:g} %"
    caption = f"{one.response.name}: means at the levels of each factor, {averaged or 'with intervals'}"
    # With squares, means over runs are not those at the middle of the others.
    is_straight = fit.model != "quadratic"
    said = [
        f"Bars and bands: {level} interval of the model’s mean" if np.isfinite(fit.error) else "",
        "rings: means of runs" if is_straight else "",
        averaged,
    ]
    note = "; ".join(filter(None, said))
    width = WIDE if columns > 2 else NARROW
    figure, axes = new(width, 12 + 46 * rows, caption, rows, columns, note, sharey=True)
    unit = unit_of(one.response.unit, one.response.back(fit.values))
    for axis, factor in zip(axes.flat, own, strict=False):
        means = one.means(factor.name)
        _means(axis, one.response, unit, factor, one.means(factor.name, steps=STEPS // 2), LINES[0], "-")
        if is_straight:
            axis.plot(_positions(factor, means[factor.name]), _shown(one.response, unit, means["observed"]), "o", mec=LINES[0], mfc="none")
        _axis(axis, factor, has_levels=True)
    _finished(axes, own, one.response, unit)
    return figure


def _shown(response: Response, unit: Unit, values: Any) -> Numbers:
    return np.asarray(unit.value(response.back(values)))


def _means(
    axis: Any, response: Response, unit: Unit, factor: Factor, means: pandas.DataFrame, colour: str, dashes: Any, **options: Any
) -> None:
    """Means with intervals: a line with a band over numbers, else points with bars."""
    x = _positions(factor, means[factor.name])
    middle, low, high = (_shown(response, unit, means[name]) for name in ("mean", "low", "high"))
    if factor.is_number:
        axis.fill_between(x, low, high, facecolor=(colour, 0.15), edgecolor=(colour, 0.6), linewidth=0.4)
        axis.plot(x, middle, color=colour, linestyle=dashes, **options)
    else:
        x = x + options.pop("aside", 0.0)
        axis.errorbar(x, middle, [middle - low, high - middle], fmt="o", color=colour, elinewidth=1.0, capsize=2, **options)
        axis.plot(x, middle, color=colour, linestyle=dashes, linewidth=0.6)


def _finished(axes: Any, own: Sequence[Any], response: Response, unit: Unit) -> None:
    """The common axis of panels; those that are left have nothing."""
    for axis in axes.flat[len(own) :]:
        axis.set_axis_off()
    for axis in axes[:, 0]:
        axis.set_ylabel(labelled(response.name, unit.symbol))
    if response.transform == "log":
        # It is fitted so.
        _logarithmic(axes[0, 0], "y")


def _interactions(one: "ResponseEffects", fit: "Fitted") -> Any:
    """Means at pairs of levels, for the pairs with the largest shares."""
    table = one.table[[isinstance(term, tuple) and len(set(term)) == 2 == len(term) for term in one.table["factors"]]]
    table = table.sort_values("share", ascending=False, kind="stable")
    if table.empty:
        return None
    left_out, pairs = len(table) - MOST_PAIRS, list(table["factors"].head(MOST_PAIRS))
    columns = min(len(pairs), 3)
    rows = -(-len(pairs) // columns)
    notes = [f"Bars and bands: {100 * fit.confidence:g} % interval of the model’s mean, the others averaged over their levels"]
    notes = notes if np.isfinite(fit.error) else ["The others averaged over their levels"]
    notes += [f"{left_out} pairs with smaller shares are not shown"] if left_out > 0 else []
    caption = f"{one.response.name}: means at pairs of levels, the pair with the largest share first"
    width = WIDE if columns > 1 else NARROW
    figure, axes = new(width, 12 + 56 * rows, caption, rows, columns, "; ".join(notes), sharey=True)
    unit = unit_of(one.response.unit, one.response.back(fit.values))
    for axis, pair in zip(axes.flat, pairs, strict=False):
        # Over the factor with more values, which is a number if there is one; a line for each level of the other.
        x, line = sorted((fit.study.factors[at] for at in pair), key=lambda factor: (factor.is_number, factor.is_range), reverse=True)
        means = one.means(x.name, line.name, steps=STEPS // 4)
        levels = list(dict.fromkeys(means[line.name]))
        if line.is_range:
            # Within the range: axial points are beyond it.
            levels = [level for level in levels if abs(line.coded(level)) < 1.0 + 1e-6]
        shown = (
            [levels[0], *([levels[len(levels) // 2]] if len(levels) % 2 else []), levels[-1]]
            if len(levels) > len(LINES) or line.is_range
            else levels
        )
        for number, level in enumerate(dict.fromkeys(shown)):
            own = means[[value == level for value in means[line.name]]]
            aside = 0.0 if x.is_number else 0.08 * (number - (len(shown) - 1) / 2)
            options = {"label": wrapped(line.shown(level), 16)} | ({} if x.is_number else {"aside": aside})
            _means(axis, one.response, unit, x, own, LINES[number], DASHES[number], **options)
        _axis(axis, x, has_levels=True)
        # As many beside each other as a panel is wide.
        beside = max(36 // (6 + max(len(line.shown(level)) for level in shown)), 1)
        style = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "ncols": beside, "columnspacing": 1.0}
        axis.legend(title=wrapped(line.name), title_fontsize=7, alignment="left", **style)
    _finished(axes, pairs, one.response, unit)
    return figure


def _residuals(one: "ResponseEffects", fit: "Fitted") -> Any:
    """Residuals against fitted values, in the order of the runs, and against normal quantiles."""
    if fit.residual_freedom == 0 or np.isnan(fit.error):
        return None
    table = one.residuals
    unit = unit_for(one.unit, float(table["residual"].abs().max()))
    of_fit = unit_of(one.response.unit, table["fitted"]) if one.response.transform == "none" else Unit("", 1.0)
    caption = f"{one.title}: residuals against fitted values, in the order of the runs, and against normal quantiles"
    figure, axes = new(WIDE, 60, caption, 1, 3)
    residuals, far = table["residual"].to_numpy() * unit.per_si, table["standardised"].abs().to_numpy() > FAR
    quantiles = np.full(len(table), np.nan)
    quantiles[np.argsort(residuals, kind="stable")] = stats.probplot(residuals, fit=False)[0]
    standardised = table["standardised"].to_numpy()
    of_residuals = labelled("residual", unit.of_differences)
    panels = [
        (of_fit.value(table["fitted"].to_numpy()), residuals, labelled("fitted", of_fit.symbol or one.title), of_residuals),
        (table["made_as"].to_numpy(), residuals, "order of the runs", of_residuals),
        (quantiles, standardised, "normal quantile", "residual, standard deviations"),
    ]
    for axis, (x, y, label, of_y) in zip(axes.flat, panels, strict=True):
        axis.plot(x, y, "o", color=LINES[0], alpha=0.7 if len(x) < 100 else 0.4, markeredgewidth=0)
        axis.set(xlabel=label, ylabel=of_y)
        for at in np.flatnonzero(far)[:12] if axis is not axes[0, 2] else ():
            axis.annotate(str(table["run"].iloc[at]), (x[at], y[at]), xytext=(3, 0), textcoords="offset points", fontsize=7, va="center")
    for axis in axes[0, :2]:
        axis.axhline(0.0, color=QUIET, linewidth=0.6)
    axes[0, 2].axline((0.0, 0.0), slope=1.0, color=QUIET, linewidth=0.6)
    return figure


def _surface(one: "ResponseEffects", fit: "Fitted") -> Any:
    """What the model expects over the two numbers with the largest shares."""
    factors, codings = fit.study.factors, fit.codings

    def goes_between(at: int) -> bool:
        classes = codings[at].classes
        return (
            factors[at].is_number
            and any(at in term for term in fit.terms)
            and (classes is None or len(factors[at].levels) == len(classes) == 2)
        )

    weights = {at: sum(row["share"] for row in one.table.to_dict("records") if at in _of(row["factors"])) for at in range(len(factors))}
    pair = sorted((at for at in weights if goes_between(at)), key=lambda at: -weights[at])[:2]
    if len(pair) < 2:
        return None
    others: dict[str, Any] = {}
    for at, factor in enumerate(factors):
        classes = codings[at].classes
        others[factor.name] = factor.value(0.0).item() if goes_between(at) or classes is None else classes[0]
    grid = [factors[at].value(np.linspace(-1.0, 1.0, STEPS)) for at in sorted(pair)]
    x, y = (factors[at] for at in sorted(pair))
    points = _grid_points(x, y, grid, others)
    rows = fit.matrix(points)
    values = np.where(fit.fit.tells(rows), one.response.back(rows @ fit.coefficients), np.nan).reshape(STEPS, STEPS)
    if not np.isfinite(values).any():
        return None
    held = ", ".join(f"{factor.name} = {factor.shown(others[factor.name], 4)}" for factor in factors if factor.name not in (x.name, y.name))
    caption = f"{one.response.name}: what the model expects over {x.name} and {y.name}" + (f", at {held}" if held else "")
    note = "; ".join(filter(None, [f"At {held}" if held else "", "dots: runs, whatever the others are" if held else "Dots: runs"]))
    unit = unit_of(one.response.unit, values)
    label, is_log = labelled(one.response.name, unit.symbol), one.response.transform == "log"
    return _map(x, y, grid, unit.value(values), label, caption, note, fit.study.runs, is_log)


def _of(term: Any) -> tuple[int, ...]:
    return term if isinstance(term, tuple) else ()


def _grid_points(x: Factor, y: Factor, grid: Sequence[Numbers], others: dict[str, Any]) -> pandas.DataFrame:
    """Points of a grid over two factors, those of the first one after each other; the others are held."""
    columns = dict(zip((x.name, y.name), (part.ravel() for part in np.meshgrid(*grid, indexing="ij")), strict=True))
    return pandas.DataFrame({**others, **columns})


def _map(
    x: Factor,
    y: Factor,
    grid: Sequence[Numbers],
    values: Numbers,
    label: str,
    caption: str,
    note: str,
    runs: pandas.DataFrame | None = None,
    is_log: bool = False,
) -> Any:
    """A map over two factors with lines of equal values, whose numbers are those of its bar."""
    from matplotlib.ticker import LogLocator

    figure, axes = new(NARROW, 76 + 4 * (len(note) // 60), caption, note=note)
    axis = axes[0, 0]
    across, along = x.in_study_unit(grid[0]), y.in_study_unit(grid[1])
    if np.ptp(values[np.isfinite(values)]) > 0:
        is_wide = is_log and (values > 0.0).all() and values.max() > 20.0 * values.min()
        options: dict[str, Any] = {"locator": LogLocator(subs=(1.0, 2.0, 5.0))} if is_wide else {"levels": 12}
        drawn = axis.contourf(across, along, values.T, cmap="viridis", **options)
        drawn.set_edgecolor("face")
        axis.contour(across, along, values.T, levels=drawn.levels[::2], colors="white", linewidths=0.6)
        # Every line has its number beside the bar, where it hides nothing.
        figure.colorbar(drawn, ax=axis, label=label, ticks=drawn.levels[::2], **({"format": "%g"} if is_wide else {}))
    if runs is not None:
        places = runs[[x.name, y.name]].drop_duplicates()
        style = {"mfc": "white", "mec": "black", "mew": 0.6, "ms": 3.5, "clip_on": False, "zorder": 5}
        axis.plot(x.in_study_unit(places[x.name]), y.in_study_unit(places[y.name]), "o", **style)
    _axis(axis, x)
    _axis(axis, y, "y")
    return figure


# Optimum ---------------------------------------------------------------------------------------------------------------------------


@in_style
def optimum_figures(found: "Optimum", contour: str | None = None) -> Figures:
    """Draws the profiler and, where two numbers may be anywhere, the desirability over those that matter most, or over a pair by name."""
    from plateau.study.goals import overall

    problem = found.problem
    best = pandas.DataFrame({row.factor: [row.value] for row in found.settings.itertuples()})
    factors = {factor.name: axis for factor, axis in zip(problem.study.factors, problem.axes, strict=True)}
    pair = contour_pair(problem.study.factors, [name for name, axis in factors.items() if axis is None], contour)

    def worth(points: pandas.DataFrame) -> Numbers:
        forecasts = problem.forecasts(points)
        each = [goal.desirability(forecasts[goal.response]["value"]) for goal in problem.goals]
        kept = [limit.margin(forecasts[limit.response]) >= -1e-9 for limit in problem.limits]
        return np.asarray(np.where(np.all(kept, axis=0) if kept else True, overall(problem.goals, each), np.nan))

    shown = list(problem.forecasts(best))
    own = [factor for factor in problem.study.factors if (axis := factors[factor.name]) is None or len(axis) > 1]
    if not own:
        return {}
    caption = "Responses and their desirability along each factor, the others at the best settings"
    level = f"{100 * problem.confidence:g} %"
    note = f"Bands: {level} interval of means; vertical lines: best settings" + ("; dotted: limits" if problem.limits else "")
    width = WIDE if len(own) > 2 else NARROW
    figure, axes = new(width, 14 + 34 * (len(shown) + 1), caption, len(shown) + 1, len(own), note, sharex="col", sharey="row")
    spans = {}
    for column, factor in enumerate(own):
        levels = factors[factor.name]
        values = _range(factor, best, STEPS) if levels is None else np.array(levels)
        points = pandas.concat([best] * len(values), ignore_index=True).assign(**{factor.name: values})
        forecasts, places = problem.forecasts(points, with_intervals=True), _positions(factor, values)
        style = {"color": LINES[0], "linestyle": "-" if levels is None else "none", "marker": "" if levels is None else "o"}
        for row, name in enumerate(shown):
            response, ends = problem.surrogates[name].response, forecasts[name]
            unit, axis = unit_of(response.unit, problem.study.runs[name]), axes[row, column]
            low, middle, high = (unit.value(ends[end].to_numpy()) for end in ("mean_low", "value", "mean_high"))
            axis.plot(places, middle, **style)
            if levels is None:
                axis.fill_between(places, low, high, color=LINES[0], alpha=0.18, linewidth=0)
            else:
                axis.vlines(places, low, high, color=LINES[0], linewidth=1.0)
            for limit in (limit for limit in problem.limits if limit.response == name):
                axis.axhline(unit.value(limit.value), color=LINES[1], linestyle=":")
            axes[row, 0].set_ylabel(labelled(name, unit.symbol))
        desirability = np.nan_to_num(worth(points))
        spans[factor.name] = float(np.ptp(desirability))
        axes[-1, column].plot(places, desirability, **style)
        _axis(axes[-1, column], factor)
        for axis in axes[:, column]:
            axis.axvline(float(_positions(factor, [best[factor.name].iloc[0]])[0]), color=CHOSEN, linewidth=0.8)
    axes[-1, 0].set(ylabel="desirability", ylim=(-0.03, 1.03))
    figures = {"profiler": figure}
    ranges = sorted((factor for factor in own if factors[factor.name] is None), key=lambda factor: -spans[factor.name])
    if pair or len(ranges) > 1:
        x, y = pair or sorted(ranges[:2], key=problem.study.factors.index)
        settings = {str(name): best[name].iloc[0] for name in best}
        grid = [_range(factor, best, 2 * STEPS) for factor in (x, y)]
        points = _grid_points(x, y, grid, settings)
        values = worth(points).reshape(2 * STEPS, 2 * STEPS)
        if np.isfinite(values).any() and np.nanmax(values) > np.nanmin(values):
            held = [f"{one.name} = {one.shown(settings[one.name], 4)}" for one in problem.study.factors if one not in (x, y)]
            at = f", at {', '.join(held)}" if held else ""
            note = f"Star: best settings{at}" + ("; grey: a limit is missed" if problem.limits else "")
            map_ = _map(x, y, grid, values, "desirability", f"Desirability over {x.name} and {y.name}{at}", note)
            map_.axes[0].set_facecolor(APART)
            star = x.in_study_unit(best[x.name]), y.in_study_unit(best[y.name])
            map_.axes[0].plot(*star, "*", mfc="white", mec="black", ms=9, mew=0.6, clip_on=False, zorder=5)
            figures["contour"] = map_
    return figures


def _range(factor: Factor, best: pandas.DataFrame, count: int) -> Numbers:
    """Values over a range, and as far beyond it as the best ones are, which may be those of an axial run."""
    place = float(factor.coded(best[factor.name].iloc[0]))
    return factor.value(np.linspace(min(place, -1.0), max(place, 1.0), count))


def contour_pair(factors: Sequence[Factor], free: Sequence[str], asked: str | None) -> tuple[Factor, Factor] | None:
    """The two factors of a contour that was asked for; refuses others than two different ones that may be anywhere in a range."""
    from plateau.errors import InputError

    if asked is None:
        return None
    by_name = {factor.name: factor for factor in factors}
    # Names may have commas, too.
    halves = [(asked[:at].strip(), asked[at + 1 :].strip()) for at, letter in enumerate(asked) if letter == ","]
    for one, other in halves:
        if one in by_name and other in by_name and one != other and one in free and other in free:
            return by_name[one], by_name[other]
    wanted = ", ".join(free) or "none here"
    raise InputError(
        f"--contour {asked}: expected two different factors that are numbers and not held, with a comma between; there are {wanted}"
    )


# Sensitivity -----------------------------------------------------------------------------------------------------------------------


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


# Fit -------------------------------------------------------------------------------------------------------------------------------


@in_style
def fit_figures(found: "Fit") -> Figures:
    """Draws profiles of the keys, regions of their pairs, and series beside what was measured."""
    factors, level = {factor.name: factor for factor in found.study.factors}, f"{100 * found.confidence:g} %"
    columns = min(len(factors), 3)
    caption = f"How far −2 ln L rises where a key is held at a value, the others at their most likely ones; shaded: {level} interval"
    width, note = (WIDE if columns > 1 else NARROW), f"Dashed: threshold of the {level} interval, which is shaded"
    figure, axes = new(width, 14 + 50 * -(-len(factors) // columns), caption, -(-len(factors) // columns), columns, note, sharey=True)
    for axis, (name, rows) in zip(axes.flat, found.profiles.groupby("key", sort=False), strict=False):
        factor, threshold = factors[str(name)], float(rows["threshold"].iloc[0])
        axis.plot(factor.in_study_unit(rows["value"]), rows["rise"], color=LINES[0])
        axis.axhline(threshold, color=QUIET, linestyle="--", linewidth=0.8)
        for row in found.keys[(found.keys["key"] == name) & found.keys["low"].notna()].to_dict("records"):
            axis.axvspan(*factor.in_study_unit(np.array([row["low"], row["high"]])), color=LINES[0], alpha=0.15, linewidth=0)
        axis.set_ylim(-0.05 * threshold, 3.0 * threshold)
        _axis(axis, factor)
    for axis in axes.flat[len(factors) :]:
        axis.set_axis_off()
    for axis in axes[:, 0]:
        axis.set_ylabel("rise of −2 ln L")
    figures: Figures = {"profiles": figure}
    regions = [(f"region-{'-'.join(file_names(names))}", names, *rest) for *names, x, y, z in found.regions for rest in [(x, y, z)]]
    for file, names, across, along, rises in regions:
        x, y = (factors[name] for name in names)
        caption = f"Where {x.name} and {y.name} may be: {level} region; dots: runs"
        figure, axes = new(
            NARROW, 76, caption, note=f"Shaded: {level} region; dots: runs" if not found.outcome.has_failed else "Dots: runs"
        )
        axis = axes[0, 0]
        if not found.outcome.has_failed:
            threshold = float(stats.chi2.ppf(found.confidence, 2))
            at = x.in_study_unit(across), y.in_study_unit(along)
            axis.contourf(*at, rises, [-1.0, threshold], colors=[LINES[0]], alpha=0.2)
            axis.contour(*at, rises, [threshold], colors=[LINES[0]], linewidths=1.0)
        axis.plot(x.in_study_unit(found.runs[x.name]), y.in_study_unit(found.runs[y.name]), "o", mfc="white", mec="black", mew=0.6, ms=3.0, clip_on=False)
        _axis(axis, x)
        _axis(axis, y, "y")
        figures[file] = figure
    measured = [(str(name), rows) for name, rows in found.series.groupby("response", sort=False)] if len(found.series) else []
    for (name, rows), stem in zip(measured, file_names([name for name, _ in measured]), strict=True):
        unit, time = unit_for(rows["unit"].iloc[0], float(rows["measured"].abs().max())), unit_for("s", float(rows["time"].max()))
        caption = f"{name}: measured, and what runs give at the most likely values; bars: one standard deviation"
        figure, axes = new(NARROW, 66, caption, note="Runs: at the most likely values; bars: one standard deviation")
        axis, at = axes[0, 0], time.value(rows["time"].to_numpy())
        middle, half = unit.value(rows["forecast"].to_numpy()), unit.per_si * rows["forecast_deviation"].to_numpy()
        bars, points = unit.per_si * rows["uncertainty"].to_numpy(), unit.value(rows["measured"].to_numpy())
        axis.errorbar(at, points, bars, fmt="o", color="black", mfc="white", elinewidth=0.6, capsize=2, label="measured")
        # Runs are told at the measured times alone: no line says what is between them.
        axis.errorbar(at, middle, half, fmt="s", color=LINES[0], ms=2.5, elinewidth=1.4, label="runs", zorder=3)
        axis.set(xlabel=labelled("time", time.symbol), ylabel=labelled(name, unit.symbol))
        figure.legend(loc="outside upper left", ncols=2)
        figures[f"series-{stem}"] = figure
    return figures


# Comparison ------------------------------------------------------------------------------------------------------------------------


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
