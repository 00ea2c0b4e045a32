"""Sensitivity: which part of a response's variance each factor has, over the whole of all ranges.

Sobol's indices of functions that may be true: of drawn coefficients or drawn processes, so that intervals carry what the surrogate does not
know. I. M. Sobol', Math. Comput. Simul. 55, 271-280 (2001); estimators of A. Saltelli et al., Comput. Phys. Commun. 181, 259-270 (2010), and of M.
J. W. Jansen, ibid. 117, 35-43 (1999), in SciPy; drawn processes: A. G. Journel, C. J. Huijbregts, Mining Geostatistics (1978),
VII. Elementary effects of Morris designs: M. D. Morris, Technometrics 33, 161-174 (1991); F. Campolongo et al., Environ. Model. Softw. 22,
1509-1518 (2007).
"""

import os
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas
from scipy import stats

from plateau.errors import PlateauWarning
from plateau.output_folder import plain
from plateau.study.analysis import together, usable
from plateau.study.data import Answer, Numbers, Response, Study
from plateau.study.figure_axes import file_names
from plateau.study.process import Process
from plateau.study.results import analysed
from plateau.study.settings import in_short, no_curve, not_smooth, straight_between
from plateau.study.surrogate import Surrogate, surrogates
from plateau.style import LINES, NARROW, QUIET, Figures, in_style, labelled, new, wrapped
from plateau.text_tables import listed
from plateau.units import unit_of, with_digits, with_minus

# Places of the sample, functions that are drawn, and cosines of each.
ROWS, FUNCTIONS, COSINES = 1024, 100, 200
SEEDS = "seeds"
# Columns as they are told.
EFFECTS = {"mean_size": "mean size μ*", "standard_error": "its error", "mean": "mean", "deviation": "deviation σ"}
PARTS = {"first_order": "alone (first order)", "total": "with interactions (total)"}
NUMBERS = ["mean_size", "mean", "deviation", "standard_error", "effects"]
COLUMNS = ["response", "factor", *(f"{name}{end}" for name in PARTS for end in ("", "_low", "_high")), *NUMBERS, "unit", "cautions"]


@dataclass(frozen=True, repr=False)
class Sensitivity(Answer):
    """Parts of the variance of each response that the factors have.

    Attributes
    ----------
    table : pandas.DataFrame
        A row for each response and factor. Of indices ``first_order`` and ``total`` with ends ``_low`` and ``_high``, parts from 0 to 1, with
        a row `seeds` for the part that seeds have in the variance of single runs. Of Morris designs ``mean_size``, ``mean``, ``deviation``,
        ``standard_error`` and ``effects`` (their number), per whole range in ``unit``. ``cautions`` of the factor, in short.
    variances : dict of float
        Variance of what is expected of each response over all ranges, SI.
    """

    study: Study
    table: pandas.DataFrame
    surrogates: list[Surrogate]
    variances: dict[str, float]
    confidence: float
    cautions: list[str]

    @property
    def is_morris(self) -> bool:
        """True if the table has elementary effects."""
        return self.study.design == "morris"

    def document(self) -> dict[str, Any]:
        """The JSON of ``plateau sweep sensitivity --json``."""
        responses = []
        for surrogate in self.surrogates:
            response, found = surrogate.response, {}
            rows = plain(self.table[self.table["response"] == surrogate.response.name].to_dict("records"))
            for row in rows:
                ends = {name: [row[f"{name}_low"], row[f"{name}_high"]] for name in PARTS}
                found[row["factor"]] = {name: {"value": row[name], "interval": None if None in ends[name] else ends[name]} for name in PARTS}
            effects = [{name: row[name] for name in ["factor", *NUMBERS]} for row in rows if self.is_morris]
            seeds = None if self.is_morris else found.pop(SEEDS, {}).get("total")
            indices = [] if self.is_morris else [{"factor": factor, **parts} for factor, parts in found.items()]
            said = f"of the {surrogate.words}; {surrogate.reason}" if indices else None
            report: dict[str, Any] = {"name": response.name, "unit": response.unit, "error": surrogate.error or None, "surrogate": said}
            report |= {"variance": self.variances.get(response.name), "indices": indices, "seeds": seeds, "elementary_effects": effects}
            responses.append(report)
        return {"study": self.study.title, "responses": responses, "cautions": self.cautions}

    def ranked(self, response: str) -> pandas.DataFrame:
        """The rows of a response, the largest part or effect first and the seeds last."""
        rows = self.table[self.table["response"] == response]
        is_seeds = rows["factor"] == SEEDS
        largest_first = rows[~is_seeds].sort_values("mean_size" if self.is_morris else "total", ascending=False, kind="stable")
        return pandas.concat([largest_first, rows[is_seeds]])

    def text(self) -> str:
        """The text that ``plateau sweep sensitivity`` prints."""
        lines = []
        for surrogate in self.surrogates:
            response, rows = surrogate.response, self.ranked(surrogate.response.name).to_dict("records")
            if surrogate.error or not rows:
                lines += [response.name, f"  {surrogate.error or 'the surrogate has the same value everywhere: no factor has a part'}", ""]
                continue
            unit, cells = unit_of(response.unit, self.study.runs[response.name]), [{"factor": row["factor"]} for row in rows]
            for cell, row in zip(cells, rows, strict=True):
                if self.is_morris:
                    error = row["standard_error"] * unit.per_si
                    cell |= {said: with_digits(row[name] * unit.per_si, error) for name, said in EFFECTS.items()}
                    cell["effects"] = str(row["effects"])
                else:
                    cell |= {said: _part(row, name) for name, said in PARTS.items()}
                    cell["factor"] += " (of single runs)" if row["factor"] == SEEDS else ""
            said = [f"{', '.join(filter(None, [response.name, unit.symbol]))}: elementary effects per whole range"]
            if not self.is_morris:
                of = f"intervals of {100 * self.confidence:g} % are for what the runs leave open of the function"
                said = [f"{response.name}: parts of the variance", f"  of the {surrogate.words}; {surrogate.reason}", f"  {of}"]
            lines += [*said, *listed(cells), ""]
        return with_minus("\n".join([*lines, *(f"caution: {caution}" for caution in self.cautions), ""]))

    @in_style
    def figures(self) -> Figures:
        """A figure for each response: parts of its variance, or elementary effects."""
        figures: Figures = {}
        draws, kind = (_drawn_elementary, "elementary-effects") if self.is_morris else (_drawn_indices, "indices")
        for surrogate, stem in zip(self.surrogates, file_names([one.response.name for one in self.surrogates]), strict=True):
            table = self.ranked(surrogate.response.name)
            if not surrogate.error and len(table):
                figures[f"{stem}-{kind}"] = draws(self, surrogate.response, table)
        return figures


def sensitivity(study: Study | str | os.PathLike[str], confidence: float = 0.95) -> Sensitivity:
    """Finds which part of the variance of each response each factor has.

    Parameters
    ----------
    study : path or Study
        Study, TOML; a Morris design gives elementary effects, any other Sobol's indices of what forecasts the response best.
    confidence : float
        Level of the intervals.

    Returns
    -------
    Sensitivity

    Examples
    --------
    >>> sensitivity("loads.toml").table[["response", "factor", "total", "total_low", "total_high"]]
    """
    opened = usable(analysed(study))
    is_morris = opened.design == "morris"
    known = surrogates(opened, confidence=confidence, of_any_design=not is_morris)
    middle = pandas.DataFrame({one.name: [float(one.value(0.0)) if one.is_range else one.levels[0]] for one in opened.factors})
    straight = [] if is_morris or all(one.takes_process for one in known) else straight_between(opened, middle)
    general = together(opened)
    cautions = [*general, *no_curve(straight)]
    two = ", ".join(factor.name for factor in opened.factors if factor.is_number and not factor.is_range and len(factor.levels) == 2)
    ranges = ", ".join(factor.name for factor in opened.factors if factor.is_range)
    if two and ranges and not is_morris:
        said = "numbers with two levels vary between these alone, which counts three times as much as an even variation over a range"
        cautions.append(f"{two}: {said}, as of {ranges}; give all of them range = [lower, upper] to compare their parts")
    for said in cautions:
        warnings.warn(said, PlateauWarning, stacklevel=2)
    tables, variances = [], {}
    for one in known:
        if is_morris:
            tables.append(elementary_effects(opened, one.response.name).assign(response=one.response.name, unit=one.response.unit, cautions=""))
        elif one.fit is not None:
            table, variances[one.response.name] = _indices(opened, one, confidence)
            untold = [factor.name for factor in one.fit.untold]
            bent = [] if one.takes_process else straight
            marks = [["not told by the runs"] * (name in untold) + no_curve([name] if name in bent else []) for name in table["factor"]]
            short = [in_short([*own, *general, *one.cautions, *not_smooth(one.missed)]) for own in marks]
            tables.append(table.assign(response=one.response.name, unit="1", cautions=short))
            if untold:
                at = ", ".join(f"{factor.name} = {factor.shown(one.fit.runs[factor.name].iloc[0])}" for factor in one.fit.untold)
                each = "it" if len(untold) == 1 else "each"
                why = f"the runs have one value of {each}, or change {each} with another factor or the seeds"
                advice = f"runs that change {each} alone would tell; parts of the others are those at {at}"
                cautions.append(f"{one.response.name}: no parts of {', '.join(untold)}: {why}; {advice}")
            rough = not_smooth(one.missed, most=", those of totals most,")
            cautions += [f"{one.response.name}: {caution}" for caution in [*one.cautions, *rough]]
    whole = pandas.concat(tables, ignore_index=True) if tables else pandas.DataFrame()
    return Sensitivity(opened, whole.reindex(columns=COLUMNS), known, variances, confidence, cautions)


def _indices(study: Study, one: Surrogate, confidence: float) -> tuple[pandas.DataFrame, float]:
    """Indices of what may be true of a response, and the variance of what is expected; factors that the runs do not tell are held."""
    count, names = len(study.factors), [factor.name for factor in study.factors]
    halves = np.split(stats.qmc.Sobol(2 * count, rng=np.random.default_rng(0)).random(ROWS), 2, axis=1)
    a, b = (pandas.DataFrame({one.name: _values(one, part[:, at]) for at, one in enumerate(study.factors)}) for part in halves)
    held = {factor.name: one._fit.runs[factor.name].iloc[0] for factor in one._fit.untold}
    if len(held) == count:
        return pandas.DataFrame({"factor": names}), 0.0
    a, b = a.assign(**held), b.assign(**held)
    places = pandas.concat([a, b, *(a.assign(**{name: b[name]}) for name in names)], ignore_index=True)
    process, random = one.process if one.takes_process else None, np.random.default_rng(1)
    drawn = drawn_models(one, places, random) if process is None else drawn_processes(process, one.rows(places), random)
    values = one.response.back(drawn).reshape(-1, count + 2, ROWS)
    variance, tail = values[:, :2].reshape(len(values), -1).var(axis=1), 50.0 * (1.0 - confidence)
    # Of one function of one factor SciPy would make a number of what it takes for an array.
    more = values if len(values) > 1 else np.repeat(values, 2, axis=0)
    found = stats.sobol_indices(func={"f_A": more[:, 0], "f_B": more[:, 1], "f_AB": more[:, 2:].swapaxes(0, 1)}, n=ROWS)
    rows: dict[str, Numbers] = {}
    for name, indices in (("first_order", found.first_order), ("total", found.total_order)):
        # What is the same everywhere has no parts.
        parts = np.where(variance[:, None] > 0.0, indices.reshape(-1, count)[: len(values)], np.nan)
        low, middle, high = np.nanpercentile(parts, [tail, 50.0, 100.0 - tail], axis=0)
        rows |= {name: middle, f"{name}_low": low, f"{name}_high": high}
    table = pandas.DataFrame({"factor": names, **rows})
    table.loc[table["factor"].isin(held), list(rows)] = np.nan
    if len(drawn) == 1:
        table[[f"{name}_{end}" for name in ("first_order", "total") for end in ("low", "high")]] = np.nan
    run, freedom = one._fit._run_variance
    if np.isfinite(run):
        # What other seeds change at a place, where the function is about a straight line.
        of_run = run * freedom / stats.chi2(freedom).rvs(len(drawn), random_state=np.random.default_rng(2))[:, None]
        ends = [one.response.back(drawn[:, : 2 * ROWS] + sign * np.sqrt(of_run)) for sign in (1.0, -1.0)]
        shares = (part := ((ends[0] - ends[1]) ** 2 / 4.0).mean(-1)) / (part + variance)
        low, middle, high = np.percentile(shares, [tail, 50.0, 100.0 - tail])
        table.loc[len(table), ["factor", "total", "total_low", "total_high"]] = [SEEDS, middle, low, high]
    return table, float(one.response.back(one.mean(places[: 2 * ROWS])).var())


def _values(factor: Any, even: Numbers) -> Any:
    """Values of a factor, even over its range or its levels."""
    return factor.value(2.0 * even - 1.0) if factor.is_range else np.array(factor.levels)[(even * len(factor.levels)).astype(int)]


def drawn_processes(process: Process, places: Numbers, random: np.random.Generator) -> Numbers:
    """Functions of a process that may be true (function, place): one without data, and what the data say of its differences from them."""
    result, share, seeds = [], 1.0 / process.runs, process.seeds
    sets = random.choice(len(process.logs), FUNCTIONS, p=process.probabilities)
    for chosen, times in zip(*np.unique(sets, return_counts=True), strict=True):
        own = process.solved(logs=process.logs[chosen])
        weights = own.forecast(places)[0][0]
        # By what the sets of seeds add at each place their mean is wrong.
        of_sets = weights @ process.added / (seeds * max(seeds - 1, 1)) ** 0.5
        for _ in range(times):
            # The spectrum of the correlation along an axis is Student's t of five degrees of freedom.
            frequency = random.standard_t(5, (COSINES, places.shape[1])) / own.lengths[0]
            at_points, at_places = _cosines((process.points, places), frequency, random)
            noise = np.sqrt(own.noise[0] * share) * random.standard_normal(len(share))
            scale = np.sqrt(process.calibration * own.square[0] / random.chisquare(process.freedom))
            result.append(scale * at_places + weights @ (process.means - process.offset - scale * (at_points + noise)) + process.offset)
            if seeds > 1:
                result[-1] += of_sets @ _student(seeds - 1, seeds, random)
    return np.array(result)


def _cosines(places: tuple[Numbers, ...], frequency: Numbers, random: np.random.Generator) -> list[Numbers]:
    """A random function with a variance of one at places: cosines of these frequencies."""
    phase, size = random.uniform(0.0, 2.0 * np.pi, COSINES), random.standard_normal(COSINES) * (2.0 / COSINES) ** 0.5
    return [np.cos(where @ frequency.T + phase) @ size for where in places]


def drawn_models(one: Surrogate, places: pandas.DataFrame, random: np.random.Generator) -> Numbers:
    """Models with other coefficients, by what these differ by between sets of seeds, and smooth functions of as much as the model misses."""
    fit, where, result = one._fit, one.rows(places), []
    rows, freedom, missed = fit.matrix(places), fit.residual_freedom, fit._missed[0]
    parts, of_parts = fit.fit.root * fit.error**0.5, float(freedom)
    if fit.seeds > 1 and not np.isnan(fit.error):
        parts, each = fit._between(fit.fit.root @ fit.fit.basis.T, fit._leaves)
        of_parts = float(each.mean())
    if np.isnan(parts).any():
        # Nothing tells the error.
        return np.array([rows @ fit.coefficients])
    for _ in range(FUNCTIONS):
        change, scale = parts @ _student(of_parts, parts.shape[1], random), np.sqrt(freedom / random.chisquare(freedom))
        frequency = random.standard_t(5, (COSINES, where.shape[1])) / np.exp(np.log(2.0) + random.standard_normal(where.shape[1]))
        beyond = np.sqrt(missed) * scale * _cosines((where,), frequency, random)[0]
        result.append(rows @ fit.coefficients + rows[:, fit.fit.kept] @ change + beyond)
    return np.array(result)


def _student(freedom: float, count: int, random: np.random.Generator) -> Numbers:
    """Values of Student's t with a common scale."""
    return np.asarray(random.standard_normal(count) * np.sqrt(freedom / random.chisquare(freedom)))


def elementary_effects(study: Study, response: str) -> pandas.DataFrame:
    """Elementary effects of the factors on a response, along the trajectories of a Morris design, per whole range or change of level."""
    # Means over the seeds; a point of which one is missing is left out, for its other seeds would be compared with other ones.
    at_point = study.runs.groupby("point")
    points, mean = at_point.first(), at_point[response].mean().where(at_point[response].count() == at_point.size())
    places = {one.name: one.coded(points[one.name]) / 2.0 if one.is_number else pandas.factorize(points[one.name])[0] for one in study.factors}
    steps = pandas.DataFrame(places, index=points.index, dtype=float).diff()
    words = [one.name for one in study.factors if not one.is_number]
    steps[words] = steps[words].ne(0.0).astype(float)
    # Within trajectories one factor changes at a time.
    is_step = steps.ne(0.0).sum(axis=1).eq(1) & (np.arange(len(steps)) % (len(study.factors) + 1) > 0)
    each = steps[is_step].where(steps.ne(0.0)).rdiv(mean.diff()[is_step], axis=0)
    size = each.abs()
    table = {"mean_size": size.mean(), "mean": each.mean(), "deviation": each.std(), "standard_error": size.sem(), "effects": each.count()}
    return pandas.DataFrame(table).rename_axis("factor").reset_index()


def _part(row: pandas.Series, name: str) -> str:
    value, low, high = (float(np.clip(row[each], 0.0, 1.0)) for each in (name, f"{name}_low", f"{name}_high"))
    if np.isnan(low):
        return "" if np.isnan(value) else f"{value:.2f}"
    shown = [with_digits(each, max((high - low) / 2.0, 0.01)) for each in (value, low, high)]
    return f"{shown[0]} ({shown[1]} … {shown[2]})"


def _drawn_indices(found: Sensitivity, response: Response, table: pandas.DataFrame) -> Any:
    """Parts alone and with interactions, with their intervals, the largest on top and the seeds below."""
    level = f"{100 * found.confidence:g} %"
    of_seeds = "; seeds: part of the variance of single runs" if SEEDS in set(table["factor"]) else ""
    note = f"Bars: {level} intervals of what the runs leave open{of_seeds}"
    figure, axes = new(NARROW, 30 + 7 * len(table), f"{response.name}: parts of the variance, with {level} intervals", note=note)
    axis, places = axes[0, 0], np.arange(len(table))
    for (kind, label), aside, colour, mark in zip(PARTS.items(), (-0.15, 0.15), LINES[:2], "os", strict=True):
        middle, low, high = (np.clip(table[f"{kind}{end}"].to_numpy(float), 0.0, 1.0) for end in ("", "_low", "_high"))
        bars = {"xerr": [middle - low, high - middle], "elinewidth": 1.4, "capsize": 2}
        axis.errorbar(middle, places + aside, fmt=mark, color=colour, label=label, **bars)
    axis.set(xlabel=labelled(f"part of the variance of {response.name}", ""), xlim=(-0.02, 1.02))
    axis.set_yticks(places, [wrapped(str(name)) for name in table["factor"]])
    axis.invert_yaxis()
    figure.legend(loc="outside upper left", ncols=2, columnspacing=1.0)
    return figure


def _drawn_elementary(found: Sensitivity, response: Response, table: pandas.DataFrame) -> Any:
    """Deviations of elementary effects against their mean sizes."""
    unit = unit_of(response.unit, found.study.runs[response.name])
    sizes, errors, deviations = (table[name].to_numpy(float) * unit.per_si for name in ("mean_size", "standard_error", "deviation"))
    caption = f"{response.name}: elementary effects over the whole range of each factor; above the line a factor acts unevenly or with others"
    figure, axes = new(NARROW, 76, caption, note="Bars: standard error; line: deviation = mean size")
    axis = axes[0, 0]
    axis.errorbar(sizes, deviations, xerr=np.nan_to_num(errors), fmt="o", color=LINES[0], capsize=2)
    for name, x, y in zip(table["factor"], sizes, deviations, strict=True):
        axis.annotate(wrapped(str(name)), (x, y), xytext=(3, 3), textcoords="offset points", fontsize=7)
    axis.axline((0.0, 0.0), slope=1.0, color=QUIET, linewidth=0.6)
    axis.set(xlabel=labelled("mean size of effects, μ*", unit.of_differences), ylabel=labelled("deviation of effects, σ", unit.of_differences))
    axis.set(xlim=(0.0, 1.15 * np.nanmax(sizes + np.nan_to_num(errors))), ylim=(-0.03 * np.nanmax(deviations, initial=1e-300), None))
    return figure
