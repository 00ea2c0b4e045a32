"""Settings at which responses are best, as their surrogates expect it, and runs that look for better ones."""

import itertools
import os
import re
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas

from plateau.errors import InputError, PlateauWarning
from plateau.output_folder import plain
from plateau.study.analysis import together, usable
from plateau.study.data import Answer, Factor, Numbers, Study
from plateau.study.figure_axes import STEPS, dots, drawn_map, grid_points, held, positions, set_axis
from plateau.study.goals import ROUNDING, Goal, Limit, Problem, axes_of, beyond_runs, improved, is_run, overall, wanted
from plateau.study.prediction import INTERVALS, confirmed_by, confirmed_words, forecast_cells, forecast_table, reported, settings_at
from plateau.study.results import analysed
from plateau.study.runs import made_study
from plateau.study.settings import beyond_of, ends_of, in_short, joined, no_curve, region_of, straight_between
from plateau.study.surrogate import Surrogate, surrogates
from plateau.style import APART, CHOSEN, LINES, NARROW, QUIET, WIDE, Figures, in_style, labelled, new
from plateau.text_tables import listed
from plateau.units import Unit, unit_of, with_minus

# In differences that count: on a limit; in halves of a range: at its end, and so far from its middle that a model knows nothing.
ON_LIMIT, AT_END, FAR = 2e-3, 1e-3, 5.0


def canonical(function: Callable[[Numbers], Numbers], count: int) -> dict[str, Any]:
    """Canonical analysis of a quadratic function of coded places: ``stationary`` place (NaN without one) and ``value`` there,
    ``eigenvalues`` in ascending order with ``directions``, a column each, and the ``nature``: a ``"ridge"`` has an eigenvalue of 0.
    """
    unit = np.eye(count)
    middle, up, down = function(np.zeros((1, count)))[0], function(unit), function(-unit)
    both = function((unit[:, None] + unit).reshape(-1, count)).reshape(count, count)
    slope, matrix = (up - down) / 2.0, (both - up - up[:, None] + middle) / 2.0
    eigenvalues, directions = np.linalg.eigh(matrix)
    is_flat = np.abs(eigenvalues).min() <= 1e-6 * max(np.abs(eigenvalues).max(), np.abs(slope).max(), 1e-300)
    stationary = np.full(count, np.nan) if is_flat else -0.5 * np.linalg.solve(matrix, slope)
    nature = "ridge" if is_flat else "maximum" if eigenvalues[-1] < 0.0 else "minimum" if eigenvalues[0] > 0.0 else "saddle"
    value = middle + 0.5 * slope @ stationary
    return {"stationary": stationary, "value": float(value), "eigenvalues": eigenvalues, "directions": directions, "nature": nature}


@dataclass(frozen=True, repr=False)
class Optimum(Answer):
    """The best settings.

    Attributes
    ----------
    settings : pandas.DataFrame
        A row for each factor: ``factor``, ``unit``, ``value`` (SI or a word), ``text``.
    table : pandas.DataFrame
        A row for each response: ``unit``, ``value``, ``mean_low``, ``mean_high`` (of the mean), ``run_low``, ``run_high`` (of one more run),
        ``leverage``, ``cautions`` (in short), ``desirability``; and of runs at the place ``confirmed_runs``, their mean ``confirmed``, its
        ``confirmed_error``, and whether that mean ``is_within`` the interval of runs. SI units.
    desirability : float
        The mean of all goals; 0 if a limit is missed.
    at_ends : list of str
        Factors that are at an end of their range.
    canonical : list of dict
        Analyses of the quadratic models: ``response``, ``nature``, ``value`` at the stationary point, ``stationary`` (a row for each
        factor: ``value``, SI, ``coded``, ``is_within`` its range), ``eigenvalues`` and their ``directions`` in coded units of the factors.
    rounds : pandas.DataFrame
        The points that were run on the way: ``round``, factors, ``expected_improvement`` (part of the way of the goal), means of the responses.
    problem : Problem
        Goals, limits, and the study with the runs that were made on the way.
    looked_for : int
        Runs that were to be made on the way at most.
    """

    settings: pandas.DataFrame
    table: pandas.DataFrame
    desirability: float
    keeps_limits: bool
    at_ends: list[str]
    canonical: list[dict[str, Any]]
    rounds: pandas.DataFrame
    cautions: list[str]
    problem: Problem
    looked_for: int = 0

    def _margin(self, limit: Limit) -> float:
        return float(limit.margin(self.table[self.table["response"] == limit.response])[0])

    def document(self) -> dict[str, Any]:
        """The JSON of ``plateau sweep optimize --json``, SI units."""
        problem, rows, limits = self.problem, plain(self.table.to_dict("records")), []
        confirmed, worth = list(map(confirmed_by, rows)), {row["response"]: row["desirability"] for row in rows}
        for limit in problem.limits:
            ends, margin = {"least": None, "most": None, "least" if limit.is_least else "most": limit.value}, self._margin(limit)
            kept = {"is_kept": margin >= -ROUNDING, "holds_back": abs(margin) < ON_LIMIT}
            limits.append({"response": limit.response, **ends, "on": limit.on, **kept})
        names = ("response", "aim", "values", "importance")
        goals = [{name: getattr(goal, name) for name in names} | {"desirability": worth[goal.response]} for goal in problem.goals]
        settings = settings_at(problem.study, self.settings.set_index("factor")["value"], [factor.name for factor in problem.study.factors])
        responses = [reported(row, "no model could be fitted" if row["value"] is None else "") for row in rows]
        found = {"study": problem.study.title, "confidence": problem.confidence, "settings": settings, "responses": responses, "goals": goals}
        found |= {"desirability": self.desirability, "keeps_limits": self.keeps_limits, "limits": limits, "at_ends": self.at_ends}
        found |= {"region": region_of(problem.study), "confirmed": confirmed if any(confirmed) else None, "canonical": self.canonical}
        return found | {"rounds": plain(self.rounds.to_dict("records")), "cautions": self.cautions}

    def text(self) -> str:
        """The text that ``plateau sweep optimize`` prints."""
        problem, study = self.problem, self.problem.study
        found = "best at" if self.keeps_limits else "no settings within the ranges keep all limits; they are missed least at"
        lines = [study.title, f"  {found} {_place(study, self.settings['value'])}"]
        lines.append(f"  desirability {self.desirability:.3g}, searched in {region_of(study)}")
        cells, confirmed = [], []
        for row in self.table.to_dict("records"):
            name, (unit, cell) = row["response"], forecast_cells(study, row, problem.confidence)
            aims = [(goal.aim, [f"{unit.value(value):.4g}" for value in goal.values]) for goal in problem.goals if goal.response == name]
            limits = [_limit_words(limit, unit) for limit in problem.limits if limit.response == name]
            wanted = "; ".join([*(f"{AIMS[aim]} {' … '.join(values)}" for aim, values in aims), *limits])
            worth = "" if np.isnan(row["desirability"]) else f"{row['desirability']:.3g}"
            cells.append({**cell, "goal": wanted, "desirability": worth})
            confirmed += [f"  {name}: {confirmed_words(row, unit)}"] if row["confirmed_runs"] else []
        lines += listed(cells)
        for limit in problem.limits:
            unit, margin = _unit(problem, limit.response), self._margin(limit)
            words = f"{limit.response} {_limit_words(limit, unit)}"
            if margin < -ROUNDING:
                lines.append(f"  {words}: missed; {self._alone(limit, unit)}")
            elif margin < ON_LIMIT:
                risk = "; the predicted mean lies on it, so that about half of all runs will miss it: --limit-on runs keeps a margin"
                lines.append(f"  held back by {words}{risk if limit.on == 'mean' else ''}")
        if self.at_ends:
            lines.append(f"  at an end of the region: {', '.join(self.at_ends)}; the study knows nothing beyond it")
        factors = {factor.name: factor for factor in study.factors}
        for each in self.canonical:
            places, where = each["stationary"], ""
            if places and all(abs(row["coded"]) <= FAR for row in places):
                at = ", ".join(f"{row['factor']} = {factors[row['factor']].shown(row['value'])}" for row in places)
                where = f" at {at}{'' if all(row['is_within'] for row in places) else ', outside the ranges'}"
            elif places:
                where = " far outside the ranges"
            lines.append(f"  {each['response']}: the quadratic model has a {each['nature']}{where}")
        if self.looked_for:
            of = ", ".join(name for name, one in problem.surrogates.items() if one.takes_process)
            lines.append(f"  {of}: a Gaussian process told where runs may be better, and tells what is predicted")
            said = "nothing new was run: the best place that is expected was run before, and no other is expected to gain anything"
            if points := len(self.rounds):
                gain = self.rounds["expected_improvement"].iloc[-1]
                said = f"{'1 point was' if points == 1 else f'{points} points were'} run on the way, the last one expected to gain {gain:.2g}"
            lines.append(f"  {said}")
        if confirmed:
            lines += ["Confirmed by runs at this place, mean ± standard error", *confirmed]
        return with_minus("\n".join([*lines, *(f"  caution: {caution}" for caution in self.cautions), ""]))

    def _alone(self, limit: Limit, unit: Unit) -> str:
        """Words about how near a response comes to its limit if nothing else is wanted."""
        ends = (limit.value - 100.0 * limit.scale, limit.value + 100.0 * limit.scale)
        goal = Goal(limit.response, "maximize" if limit.is_least else "minimize", ends if limit.is_least else ends[::-1])
        problem = replace(self.problem, goals=[goal], limits=[limit])
        point = replace(problem, limits=[]).best()
        forecast = problem.forecasts(point)[limit.response]
        most = f"the {'most' if limit.is_least else 'least'} within the ranges is {unit.text(float(forecast['value'].iloc[0]))}"
        can = ", so that it can be kept alone, but not with the others" if limit.margin(forecast)[0] >= 0.0 else ""
        return f"{most}, at {_place(problem.study, point.iloc[0])}{can}"

    @in_style
    def figures(self, contour: str | None = None) -> Figures:
        """Draws the profiler and, where two numbers may be anywhere, the desirability over those that matter most, or over a pair by name."""
        problem, best, free = self.problem, self.settings.set_index("factor")["value"].to_dict(), self.problem.free
        pair = _contour_pair(free, contour)
        axes = {factor: axis for factor, axis in zip(problem.study.factors, problem.axes, strict=True) if axis is None or len(axis) > 1}
        if not axes:
            return {}
        figure, spans = _profiler(problem, best, axes)
        figures = {"profiler": figure}
        if pair or len(free) > 1:
            x, y = pair or sorted(sorted(free, key=lambda factor: -spans[factor.name])[:2], key=problem.study.factors.index)
            # The best settings, too, so that they are on the side of a limit where they belong.
            grid = [np.union1d(_range(factor, best[factor.name], 2 * STEPS), [best[factor.name]]) for factor in (x, y)]
            forecasts = problem.forecasts(grid_points(x, y, grid, best))
            values, margins = (each.reshape(len(grid[0]), len(grid[1])) for each in (problem.desirability(forecasts), problem.margins(forecasts)))
            kept = values[margins >= -ROUNDING]
            if len(kept) and np.ptp(kept) > 0.0:
                at = f", at {said}" if (said := held(problem.study.factors, best, (x, y))) else ""
                note = f"Star: best settings{at}" + ("; grey: a limit is missed" if problem.limits else "")
                shown, caption = np.clip(values, kept.min(), kept.max()), f"Desirability over {x.name} and {y.name}{at}"
                figures["contour"] = drawn_map((x, y), grid, shown, "desirability", caption, note)
                axis = figures["contour"].axes[0]
                if (missed := float(margins.min())) < -ROUNDING:
                    places = [factor.in_study_unit(each) for factor, each in zip((x, y), grid, strict=True)]
                    axis.contourf(*places, margins.T, [missed, -ROUNDING], colors=[APART], zorder=2.2)
                dots(axis, x, y, pandas.DataFrame([best]), "*", 9)
        return figures


def optimize(
    study: Study | str | os.PathLike[str], *, maximize: Sequence[str] = (), minimize: Sequence[str] = (), target: Sequence[str] = (),
    limit: Sequence[str] = (), limit_on: str = "mean", importance: Sequence[str] = (), hold: Mapping[str, Any] | Sequence[str] = (),
    model: str | None = None, confidence: float = 0.95, runs: int = 0, confirm: bool = False,
    jobs: int | None = None, workers: int | None = None, progress: bool | None = None,
) -> Optimum:  # fmt: skip
    """Finds the settings at which responses are best.

    Parameters
    ----------
    study : path or Study
    maximize, minimize : str or sequence of str
        Responses, each ``NAME`` or ``NAME=LOW..HIGH`` with the values at which it is worth nothing and everything; else those of the runs.
    target : str or sequence of str
        ``NAME=VALUE`` or ``NAME=LOW..VALUE..HIGH``.
    limit : str or sequence of str
        ``NAME<=VALUE`` or ``NAME>=VALUE``.
    limit_on : {"mean", "means", "runs"}
        Value that has to keep the limits: the expected mean, the interval of means, or that of one more run.
    importance : str or sequence of str
        ``NAME=NUMBER``: how much a goal counts, 1 unless given.
    hold : dict or sequence of str
        ``FACTOR=VALUE``.
    model, confidence
        See `effects`.
    runs : int
        Make up to so many runs where improvement is expected, between levels of numbers, too, one place after the other, each with all seeds.
        The best place that was run is given.
    confirm : bool
        Make runs at the best settings.
    jobs, workers, progress
        See ``plateau.sweep``.

    Returns
    -------
    Optimum
    """
    study = usable(analysed(study))
    stepped = [one for one in study.factors if runs and one.is_number and len(one.levels) > 2 and not one.whole]
    if stepped:
        # Runs are made between levels, too: models are those of points that may be anywhere.
        factors = [replace(one, levels=one.ends, is_range=True) if one in stepped else one for one in study.factors]
        study = replace(study, design="csv", factors=factors)
    goals, limits = wanted(study, {"maximize": maximize, "minimize": minimize, "target": target}, limit, limit_on, importance)

    def made(points: pandas.DataFrame) -> pandas.DataFrame:
        return made_study(study, points, jobs=jobs, workers=workers, retry=confirm, progress=progress).runs

    found = {one.response.name: one for one in surrogates(study, model, confidence)}
    for name in [*(goal.response for goal in goals), *(one.response for one in limits)]:
        if found[name].error:
            raise InputError(f'{study.path or study.title}: response "{name}": {found[name].error}')
    known = {name: one for name, one in found.items() if not one.error}
    is_curved = all(one.fit is not None and one.fit.model == "quadratic" for one in known.values())
    problem, rounds = Problem(study, known, goals, limits, axes_of(study, hold, is_curved), confidence), pandas.DataFrame()
    if runs:
        problem, rounds = improved(problem, runs, made, max(1, (jobs or os.cpu_count() or 1) // study.seeds))
    problem = beyond_runs(problem)
    best = problem.best()
    if runs:
        # The best of the places that were run, so that its own runs confirm it.
        points = problem.known[list(best.columns)]
        best = points.iloc[[int(problem.merit(points).argmax())]].reset_index(drop=True) if len(points) else best
    if confirm and not runs and is_run(problem, best, 1e-9).any():
        said = "a point of the study is at this place: the fit has used its runs, so that they confirm nothing"
        warnings.warn(said, PlateauWarning, stacklevel=2)
    confirming = made(best).drop_duplicates("same_as") if confirm or runs else None
    return replace(_told(problem, best, confirming, rounds), looked_for=runs)


def _place(study: Study, values: pandas.Series) -> str:
    """Settings of the factors, in their order, in words."""
    return ", ".join(f"{factor.name} = {factor.shown(value)}" for factor, value in zip(study.factors, values, strict=True))


def _unit(problem: Problem, name: str) -> Unit:
    return unit_of(problem.surrogates[name].response.unit, problem.study.runs[name])


AIMS = {"maximize": "large,", "minimize": "small,", "target": "near the middle of"}


def _limit_words(limit: Limit, unit: Unit) -> str:
    on = {"mean": "", "means": " for the interval of means", "runs": " for the interval of runs"}[limit.on]
    return f"{'≥' if limit.is_least else '≤'} {unit.text(limit.value)}{on}"


def _told(problem: Problem, best: pandas.DataFrame, confirming: pandas.DataFrame | None, rounds: pandas.DataFrame) -> Optimum:
    study = problem.study
    beyond = beyond_of(study, best)
    cautions = [*together(study), *no_curve(straight_between(study, best))]
    known = problem.surrogates.items()
    tables = {name: forecast_table(one, best, beyond, problem.confidence, confirming, [*cautions]) for name, one in known}
    cautions += [f"{name}: {said}" for name, table in tables.items() for said in table.attrs["cautions"]]
    table = pandas.DataFrame([(response.name, response.unit) for response in study.responses], columns=["response", "unit"])
    columns = ["response", "value", *INTERVALS, "leverage", "cautions", "confirmed", "confirmed_error", "confirmed_runs", "is_within"]
    table = table.merge(pandas.concat(tables.values())[columns], "left", on="response").fillna({"cautions": "", "confirmed_runs": 0})
    worth = {goal.response: float(goal.desirability(tables[goal.response]["value"])[0]) for goal in problem.goals}
    table["desirability"] = table["response"].map(worth)
    keeps = all(limit.margin(tables[limit.response])[0] >= -ROUNDING for limit in problem.limits)
    settings, at_ends = [], []
    for factor, axis in zip(study.factors, problem.axes, strict=True):
        value = best[factor.name].iloc[0]
        settings.append({"factor": factor.name, "unit": factor.unit, "value": value, "text": factor.text(value)})
        further = best.assign(**{factor.name: factor.value((1.0 + 2.0 * AT_END) * factor.coded(value))}) if axis is None else best
        if axis is None and abs(factor.coded(value)) > 1.0 - AT_END and beyond_of(study, further)[0]:
            at_ends.append(f"{factor.name} ({factor.shown(value)})")
    total = float(overall(problem.goals, [worth[goal.response] for goal in problem.goals])) if keeps else 0.0
    if keeps and total <= 0.0:
        cautions.append("a goal is worth nothing wherever the others are worth something: give wider values, such as NAME=LOW..HIGH")
        table["cautions"] = [joined([in_short(cautions[-1:]), own]) for own in table["cautions"]]
    said = _canonical(problem, best)
    return Optimum(pandas.DataFrame(settings), table, total, keeps, at_ends, said, rounds, cautions, problem)


def _canonical(problem: Problem, best: pandas.DataFrame) -> list[dict[str, Any]]:
    """The canonical analysis of each quadratic model over the numbers that may be anywhere, the others as at the best settings."""
    ranges, levels = problem.free, best.iloc[0].tolist()
    found = []
    for name, surrogate in problem.surrogates.items():
        if surrogate.takes_process or surrogate.fit is None or surrogate.fit.model != "quadratic" or not ranges:
            continue

        def value_at(coded: Numbers, of: Surrogate = surrogate) -> Numbers:
            return of.mean(problem.points(levels, coded))

        said, places = canonical(value_at, len(ranges)), []
        for factor, coded in zip(ranges, said["stationary"], strict=True) if said["nature"] != "ridge" else []:
            low, high = ends_of(problem.study, factor)
            with np.errstate(over="ignore"):
                at = float(factor.value(coded))
            place = {"factor": factor.name, "unit": factor.unit, "value": at, "coded": float(coded), "text": factor.text(at)}
            places.append({**place, "is_within": bool(low <= coded <= high)})
        value = float(surrogate.response.back(said["value"])) if places else None
        numbers = {of: said[of].tolist() for of in ("eigenvalues", "directions")}
        found.append({"response": name, "nature": said["nature"], "value": value, "stationary": places, **numbers})
    return found


def _profiler(problem: Problem, best: dict[str, Any], factors: Mapping[Factor, Any]) -> tuple[Any, dict[str, float]]:
    """Responses and their desirability along each factor, and how much the desirability changes along it."""
    shown, level, spans = problem.wanted, f"{100 * problem.confidence:g} %", {}
    caption = "Responses and their desirability along each factor, the others at the best settings"
    note = f"Bands: {level} interval of means; vertical lines: best settings" + (
        "; dotted: limits; grey: a limit is missed" if problem.limits else ""
    )
    size = (WIDE if len(factors) > 2 else NARROW), 14 + 34 * (len(shown) + 1)
    figure, axes = new(*size, caption, len(shown) + 1, len(factors), note, sharex="col", sharey="row")
    for column, (factor, levels) in enumerate(factors.items()):
        # The best settings, too: where limits hold them from both sides, no other place of the line keeps all of them.
        values = np.union1d(_range(factor, best[factor.name], STEPS), [best[factor.name]]) if levels is None else np.array(levels)
        points = pandas.DataFrame([best] * len(values)).assign(**{factor.name: values})
        forecasts, places = problem.forecasts(points, with_intervals=True), positions(factor, values)
        style = {"color": LINES[0], "linestyle": "-" if levels is None else "none", "marker": "" if levels is None else "o"}
        for row, name in enumerate(shown):
            unit, axis = _unit(problem, name), axes[row, column]
            low, middle, high = (unit.value(forecasts[name][end].to_numpy()) for end in ("mean_low", "value", "mean_high"))
            axis.plot(places, middle, **style)
            if levels is None:
                axis.fill_between(places, low, high, color=LINES[0], alpha=0.18, linewidth=0)
            else:
                axis.vlines(places, low, high, color=LINES[0], linewidth=1.0)
            for limit in (limit for limit in problem.limits if limit.response == name):
                axis.axhline(unit.value(limit.value), color=LINES[1], linestyle=":")
            axes[row, 0].set_ylabel(labelled(name, unit.symbol))
        desirability = problem.desirability(forecasts)
        kept = np.where(problem.keeps(forecasts), desirability, np.nan)
        spans[factor.name] = float(np.ptp(np.nan_to_num(kept)))
        axes[-1, column].plot(places, desirability, **(style | {"color": QUIET}))
        axes[-1, column].plot(places, kept, **style)
        is_best = np.asarray(values == best[factor.name])
        axes[-1, column].plot(np.asarray(places)[is_best], kept[is_best], "*", color=CHOSEN)
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
    # Names may have commas, too.
    pairs = {re.sub(r"\s*,\s*", ",", f"{one.name},{other.name}"): (one, other) for one, other in itertools.permutations(free, 2)}
    if (found := pairs.get(re.sub(r"\s*,\s*", ",", asked.strip()))) is None:
        expected = "expected two different factors that are numbers and not held, with a comma between"
        raise InputError(f"--contour {asked}: {expected}; there are {', '.join(one.name for one in free) or 'none here'}")
    return found
