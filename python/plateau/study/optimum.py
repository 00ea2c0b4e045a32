"""Settings at which responses are best, as their surrogates expect it, and runs that look for better ones."""

import itertools
import os
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import pandas
from scipy import optimize as search
from scipy import stats

from plateau.errors import InputError
from plateau.study.results import Numbers, Response, Study, analysed
from plateau.study.runs import make_runs
from plateau.study.surrogate import Surrogate, surrogates
from plateau.study.units import Unit, parsed, unit_for

# Typed more strictly than it can be called.
minimize: Any = search.minimize
# Points looked at in all and at least at each combination of levels, combinations at most, and points from which the search goes on.
POINTS, LEAST_POINTS, MOST_COMBINATIONS, STARTS = 4096, 16, 100_000, 4
# Parts of the difference that counts: on a limit, kept but for rounding; parts of a range: at its end.
ON_LIMIT, ROUNDING, AT_END = 2e-3, 1e-9, 1e-3
# Draws of responses for the expected improvement, and the improvement, as part of the way to the goal, that is worth no run.
DRAWS, WORTH = 256, 1e-3


@dataclass(frozen=True)
class Goal:
    """What a response should be: `values` from worth nothing to worth everything, of a target to worth nothing again, SI.

    `is_of_runs` says that the values are those of the runs, beyond which there may be better ones.
    """

    response: str
    aim: str
    values: tuple[float, ...]
    importance: float = 1.0
    is_of_runs: bool = False

    def way(self, response: Any) -> Numbers:
        """The part of the way from worth nothing to worth everything, beyond 0 and 1, too."""
        low, best = self.values[:2]
        up = (np.asarray(response, float) - low) / (best - low)
        return np.asarray(
            up if len(self.values) == 2 else np.minimum(up, (self.values[2] - np.asarray(response)) / (self.values[2] - best))
        )

    def desirability(self, response: Any) -> Numbers:
        """Desirability, 0 to 1 (G. Derringer and R. Suich, Journal of Quality Technology 12, 214-219 (1980)); 0 of NaN."""
        return np.nan_to_num(np.clip(self.way(response), 0.0, 1.0))


@dataclass(frozen=True)
class Limit:
    """What a response has to keep, SI: at least or at most `value`. `scale` is a difference that counts."""

    response: str
    is_least: bool
    value: float
    on: str
    scale: float

    def margin(self, forecast: pandas.DataFrame) -> Numbers:
        """How far what has to keep the limit is from it, in differences that count; negative beyond it."""
        name = "value" if self.on == "mean" else f"{self.on.removesuffix('s')}_{'low' if self.is_least else 'high'}"
        kept = forecast[name].fillna(forecast["value"]).to_numpy()
        return np.asarray((kept - self.value if self.is_least else self.value - kept) / self.scale)


def overall(goals: Sequence[Goal], desirabilities: Sequence[Any]) -> Numbers:
    """The geometric mean of desirabilities, weighted by importance: what makes one response worth nothing no other can save."""
    with np.errstate(divide="ignore"):
        logs = sum(goal.importance * np.log(np.asarray(each)) for goal, each in zip(goals, desirabilities, strict=True))
    return np.exp(logs / sum(goal.importance for goal in goals))


# A merit, the levels of a point, and its coded place in the ranges.
Start = tuple[float, tuple[Any, ...], Numbers]


@dataclass(frozen=True)
class Problem:
    """What is searched for, and where: ``axes`` has the levels of each factor; None if it may be anywhere in its range."""

    study: Study
    surrogates: dict[str, Surrogate]
    goals: list[Goal]
    limits: list[Limit]
    axes: list[list[Any] | None]
    confidence: float

    def points(self, levels: Sequence[Any], coded: Numbers) -> pandas.DataFrame:
        """Points of the factors at levels, and at coded places of the others."""
        columns, place = {}, iter(coded.T)
        for factor, axis, level in zip(self.study.factors, self.axes, levels, strict=True):
            columns[factor.name] = factor.value(next(place)) if axis is None else [level] * len(coded)
        return pandas.DataFrame(columns)

    def forecasts(self, points: pandas.DataFrame, *, with_intervals: bool = False) -> dict[str, pandas.DataFrame]:
        """What surrogates expect of the responses that are wanted."""
        found = {}
        for name in dict.fromkeys([*(goal.response for goal in self.goals), *(limit.response for limit in self.limits)]):
            surrogate = self.surrogates[name]
            needs = with_intervals or any(limit.response == name and limit.on != "mean" for limit in self.limits)
            value = pandas.DataFrame({"value": surrogate.response.back(surrogate.mean(points))})
            found[name] = surrogate.forecast(points, self.confidence) if needs else value
        return found

    def merit(self, points: pandas.DataFrame) -> Numbers:
        """Above 0 the mean desirability; below 0 how far a limit is missed or a response is worth nothing, so that the way back is known."""
        found = self.forecasts(points)
        ways = [goal.way(found[goal.response]["value"]) for goal in self.goals]
        merit = overall(self.goals, [np.clip(way, 0.0, 1.0) for way in ways])
        short = sum(np.minimum(way, 0.0) for way in ways)
        merit = np.where(merit > 0.0, merit, np.maximum(short / (1.0 - short), -1.0))
        missed = sum((np.maximum(-limit.margin(found[limit.response]), 0.0) for limit in self.limits), np.zeros(len(points)))
        return np.nan_to_num(np.where(missed > ROUNDING, -2.0 - missed, merit), nan=-1e9)

    def spread(self, count: int = POINTS) -> list[tuple[tuple[Any, ...], Numbers]]:
        """All combinations of levels, each with coded points spread over the ranges."""
        choices = [[None] if axis is None else axis for axis in self.axes]
        if (combinations := int(np.prod([len(choice) for choice in choices], dtype=float))) > MOST_COMBINATIONS:
            raise InputError(
                f"the levels have {combinations} combinations, at most {MOST_COMBINATIONS} are looked at: hold some of the factors"
            )
        ranges = self.axes.count(None)
        bits = int(np.ceil(np.log2(max(count // combinations, LEAST_POINTS))))
        places = 2.0 * stats.qmc.Sobol(ranges, rng=0).random_base2(bits) - 1.0 if ranges else np.zeros((1, 0))
        return [(levels, places) for levels in itertools.product(*choices)]

    def best(self) -> pandas.DataFrame:
        """The point of the largest merit, one row."""
        starts: list[Start] = []
        for levels, places in self.spread():
            merits = self.merit(self.points(levels, places))
            starts += [(merits[at], levels, places[at]) for at in np.argsort(-merits, kind="stable")[:STARTS]]
            starts = sorted(starts, key=lambda start: -start[0])[:STARTS]
        best = starts[0]
        if self.axes.count(None):
            best = max((self._climbed(start, ["SLSQP"]) for start in starts), key=lambda found: found[0])
            best = self._climbed(best, ["Nelder-Mead", "SLSQP"])
        return self.points(best[1], best[2][None])

    def _climbed(self, start: Start, methods: Sequence[str]) -> Start:
        """Goes on from a start: along slopes and limits, and by simplices where these have corners."""
        merit, levels, place = start
        bounds, step = [(-1.0, 1.0)] * len(place), 1e-5 * np.eye(len(place))

        def fall(x: Numbers) -> float:
            return -float(self.merit(self.points(levels, x[None]))[0])

        def smooth(places: Numbers) -> Numbers:
            found = self.forecasts(self.points(levels, places))
            logs = sum(goal.importance * np.log(np.maximum(goal.way(found[goal.response]["value"]), 1e-9)) for goal in self.goals)
            return np.column_stack([-logs, *(limit.margin(found[limit.response]) for limit in self.limits)])

        def slopes(x: Numbers) -> Numbers:
            both = smooth(np.vstack([x + step, x - step]))
            return np.asarray((both[: len(x)] - both[len(x) :]) / 2e-5)

        kept = [
            {"type": "ineq", "fun": lambda x, at=at: smooth(x[None])[0, at], "jac": lambda x, at=at: slopes(x)[:, at]}
            for at in range(1, 1 + len(self.limits))
        ]
        options: dict[str, Any] = {"SLSQP": {"fun": lambda x: smooth(x[None])[0, 0], "jac": lambda x: slopes(x)[:, 0], "constraints": kept, "options": {"ftol": 1e-14}}}
        options["Nelder-Mead"] = {"fun": fall, "options": {"xatol": 1e-5, "fatol": 1e-9, "maxfev": 60 * len(place)}}
        for method in methods:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", RuntimeWarning)
                x = np.clip(minimize(x0=place, method=method, bounds=bounds, **options[method]).x, -1.0, 1.0)
            if np.isfinite(x).all() and -fall(x) > merit:
                merit, place = -fall(x), x
        return merit, levels, place


def canonical(function: Callable[[Numbers], Numbers], count: int) -> dict[str, Any]:
    """Canonical analysis of a quadratic function.

    Parameters
    ----------
    function : callable
        Values at coded places, an array with a row for each.
    count : int
        Number of factors.

    Returns
    -------
    dict
        ``stationary`` (coded place; NaN if there is none), ``value`` there, ``eigenvalues`` in ascending order, ``directions`` (a column each),
        ``nature``: ``"maximum"``, ``"minimum"``, ``"saddle"``, or ``"ridge"`` if an eigenvalue is 0 but for rounding.
    """
    unit = np.eye(count)
    middle, up, down = function(np.zeros((1, count)))[0], function(unit), function(-unit)
    slope, matrix = (up - down) / 2.0, np.diag((up + down) / 2.0 - middle)
    for i, j in itertools.combinations(range(count), 2):
        both = function((unit[i] + unit[j])[None])[0]
        matrix[i, j] = matrix[j, i] = (both - up[i] - up[j] + middle) / 2.0
    eigenvalues, directions = np.linalg.eigh(matrix)
    is_flat = np.abs(eigenvalues).min() <= 1e-6 * max(np.abs(eigenvalues).max(), np.abs(slope).max(), 1e-300)
    stationary = np.full(count, np.nan) if is_flat else -0.5 * np.linalg.solve(matrix, slope)
    nature = "ridge" if is_flat else "maximum" if eigenvalues[-1] < 0.0 else "minimum" if eigenvalues[0] > 0.0 else "saddle"
    value = middle + 0.5 * slope @ stationary
    return {"stationary": stationary, "value": float(value), "eigenvalues": eigenvalues, "directions": directions, "nature": nature}


@dataclass(frozen=True)
class Optimum:
    """The best settings.

    Attributes
    ----------
    study : Study
        With the runs that were made on the way.
    settings : pandas.DataFrame
        A row for each factor: ``factor``, ``unit``, ``value`` (SI or a word), ``text``.
    table : pandas.DataFrame
        A row for each response: ``unit``, ``value``, ``mean_low``, ``mean_high`` (of the mean), ``run_low``, ``run_high`` (of one more run),
        ``desirability``; and of runs at the place ``runs``, ``mean``, ``standard_error``, ``is_within`` the interval of runs. SI units.
    goals, limits : list
    desirability : float
        The mean of all goals; 0 if a limit is missed.
    keeps_limits : bool
    at_ends : list of str
        Factors that are at an end of their range.
    canonical : list of dict
        Of each response with a quadratic model: ``response``, ``nature``, ``value`` at the stationary point, ``stationary`` (a row for each
        factor: ``value``, SI, ``coded``, ``is_within`` its range), ``eigenvalues`` and their ``directions`` in coded units of the factors.
    rounds : pandas.DataFrame
        The points that were run on the way: ``round``, factors, ``expected_improvement`` (part of the way of the goal), means of the responses.
    confidence : float
    cautions : list of str
    """

    study: Study
    settings: pandas.DataFrame
    table: pandas.DataFrame
    goals: list[Goal]
    limits: list[Limit]
    desirability: float
    keeps_limits: bool
    at_ends: list[str]
    canonical: list[dict[str, Any]]
    rounds: pandas.DataFrame
    confidence: float
    cautions: list[str]
    problem: Problem = field(repr=False)

    def _margin(self, limit: Limit) -> float:
        return float(limit.margin(self.table[self.table["response"] == limit.response])[0])

    def document(self) -> dict[str, Any]:
        """The JSON of ``plateau sweep optimize --json``, SI units."""

        def plain(value: Any) -> Any:
            return None if isinstance(value, float) and not np.isfinite(value) else value

        rows = [{name: plain(value) for name, value in row.items()} for row in self.table.to_dict("records")]
        responses = [
            {
                "name": row["response"], "unit": row["unit"], "value": row["value"], "error": None if row["value"] is not None else "no model",
                "mean_interval": [row["mean_low"], row["mean_high"]] if row["mean_low"] is not None else None,
                "run_interval": [row["run_low"], row["run_high"]] if row["run_low"] is not None else None,
            }
            for row in rows
        ]  # fmt: skip
        confirmed = [
            {"runs": row["runs"], "mean": row["mean"], "standard_error": row["standard_error"], "within_run_interval": row["is_within"]}
            if row["runs"]
            else None
            for row in rows
        ]
        of_goal = {row["response"]: row["desirability"] for row in rows}
        return {
            "study": self.study.title,
            "confidence": self.confidence,
            "settings": [
                {"factor": row["factor"], "value": row["text"], "number": row["value"] if row["unit"] else None, "given": True}
                for row in self.settings.to_dict("records")
            ],
            "responses": responses,
            "goals": [
                {"response": goal.response, "aim": goal.aim, "values": list(goal.values), "importance": goal.importance, "desirability": of_goal[goal.response]}
                for goal in self.goals
            ],
            "desirability": self.desirability,
            "keeps_limits": self.keeps_limits,
            "limits": [
                {
                    "response": limit.response, "least": limit.value if limit.is_least else None, "most": None if limit.is_least else limit.value,
                    "on": limit.on, "is_kept": self._margin(limit) >= -ROUNDING, "holds_back": abs(self._margin(limit)) < ON_LIMIT,
                }
                for limit in self.limits
            ],
            "at_ends": self.at_ends,
            "confirmed": confirmed if any(confirmed) else None,
            "canonical": self.canonical,
            "rounds": [{name: plain(value) for name, value in row.items()} for row in self.rounds.to_dict("records")],
            "cautions": self.cautions,
        }  # fmt: skip

    def text(self) -> str:
        """What ``plateau sweep optimize`` prints."""
        responses = {response.name: response for response in self.study.responses}
        found = "best at" if self.keeps_limits else "no settings within the ranges keep all limits; they are missed least at"
        place = ", ".join(f"{row.factor} = {row.text}" for row in self.settings.itertuples())
        lines = [self.study.title, f"  {found} {place}", f"  desirability {self.desirability:.3g}"]
        level, cells, confirmed = f"{100 * self.confidence:g} %", [], []
        for row in self.table.to_dict("records"):
            unit = _unit(self.study, responses[row["response"]])
            goals = [
                f"{AIMS[goal.aim]} {' … '.join(f'{unit.value(value):.4g}' for value in goal.values)}" for goal in self._of(row, self.goals)
            ]
            wanted = "; ".join([*goals, *(_limit_words(limit, unit) for limit in self._of(row, self.limits))])
            cell = {"response": ", ".join(filter(None, [row["response"], unit.symbol])), "predicted": f"{unit.value(row['value']):.4g}"}
            for name, of in (("mean", "means"), ("run", "runs")):
                cell[f"{level} of {of}"] = f"{unit.value(row[f'{name}_low']):.4g} … {unit.value(row[f'{name}_high']):.4g}"
            worth = "" if np.isnan(row["desirability"]) else f"{row['desirability']:.3g}"
            cells.append({**cell, "goal": wanted, "desirability": worth})
            if row["runs"]:
                is_within = "within" if row["is_within"] else "outside"
                mean = unit.text(row["mean"], row["standard_error"])
                confirmed.append(f"  {row['response']}: {mean}, {row['runs']} runs, {is_within} the interval of runs")
        lines += ["  " + line for line in pandas.DataFrame(cells).to_string(index=False).splitlines()]
        for limit in self.limits:
            unit = _unit(self.study, responses[limit.response])
            words, margin = f"{limit.response} {_limit_words(limit, unit)}", self._margin(limit)
            if margin < -ROUNDING:
                lines.append(f"  {words}: missed; {self._alone(limit, unit)}")
            elif margin < ON_LIMIT:
                risk = "; the predicted mean lies on it, so that about half of all runs will miss it: --limit-on runs keeps a margin"
                lines.append(f"  held back by {words}{risk if limit.on == 'mean' else ''}")
        if self.at_ends:
            lines.append(f"  at an end of the range: {', '.join(self.at_ends)}; the study knows nothing beyond it")
        for each in self.canonical:
            at = ", ".join(f"{row['factor']} = {row['text']}" for row in each["stationary"])
            where = "" if all(row["is_within"] for row in each["stationary"]) else ", outside the ranges"
            lines.append(f"  {each['response']}: the quadratic model has a {each['nature']}{f' at {at}{where}' if at else ''}")
        if confirmed:
            lines += ["Confirmed by runs at this place, mean ± standard error", *confirmed]
        if len(self.rounds):
            lines.append(
                f"{len(self.rounds)} points were run on the way, the last one expected to gain {self.rounds['expected_improvement'].iloc[-1]:.2g}"
            )
        return "\n".join([*lines, *(f"  caution: {caution}" for caution in self.cautions), ""])

    @staticmethod
    def _of(row: dict[str, Any], wanted: Sequence[Any]) -> list[Any]:
        return [one for one in wanted if one.response == row["response"]]

    def _alone(self, limit: Limit, unit: Unit) -> str:
        """How near a response comes to its limit if nothing else is wanted."""
        ends = (limit.value - 100.0 * limit.scale, limit.value + 100.0 * limit.scale)
        goal = Goal(limit.response, "maximize" if limit.is_least else "minimize", ends if limit.is_least else ends[::-1])
        problem = replace(self.problem, goals=[goal], limits=[replace(limit)])
        point = replace(problem, limits=[]).best()
        forecast = problem.forecasts(point)[limit.response]
        most = f"the {'most' if limit.is_least else 'least'} within the ranges is {unit.text(float(forecast['value'].iloc[0]))}, at "
        can = ", so that it can be kept alone, but not with the others" if limit.margin(forecast)[0] >= 0.0 else ""
        return most + ", ".join(f"{factor.name} = {factor.text(point[factor.name].iloc[0])}" for factor in self.study.factors) + can

    def figures(self) -> dict[str, Any]:
        """The profiler: desirability and responses along each factor through the best settings."""
        from matplotlib.figure import Figure

        names = [factor for factor, axis in zip(self.study.factors, self.problem.axes, strict=True) if axis is None or len(axis) > 1]
        best = pandas.DataFrame({row.factor: [row.value] for row in self.settings.itertuples()})
        shown = list(self.problem.forecasts(best))
        figure = Figure(figsize=(2.6 * len(names) + 1.0, 2.0 * len(shown) + 2.5), layout="constrained")
        axes = figure.subplots(len(shown) + 1, len(names), sharex="col", sharey="row", squeeze=False)
        for column, factor in enumerate(names):
            axis = self.problem.axes[self.study.factors.index(factor)]
            values = factor.value(np.linspace(-1.0, 1.0, 61)) if axis is None else np.array(axis)
            points = pandas.concat([best] * len(values), ignore_index=True).assign(**{factor.name: values})
            found = self.problem.forecasts(points, with_intervals=True)
            x = factor.in_study_unit(values) if factor.is_number else values
            for row, name in enumerate(shown):
                unit = _unit(self.study, self.problem.surrogates[name].response)
                y = found[name]
                axes[row, column].plot(x, unit.value(y["value"]), "-" if axis is None else "o")
                axes[row, column].fill_between(x, unit.value(y["mean_low"]), unit.value(y["mean_high"]), alpha=0.2, linewidth=0)
                axes[row, 0].set_ylabel(", ".join(filter(None, [name, unit.symbol])))
            worth = overall(self.goals, [goal.desirability(found[goal.response]["value"]) for goal in self.goals])
            axes[-1, column].plot(x, worth, "k-" if axis is None else "ko")
            axes[-1, column].set_xlabel(", ".join(filter(None, [factor.name, factor.study_unit])))
            at = best[factor.name].iloc[0]
            for each in axes[:, column]:
                each.axvline(float(factor.in_study_unit(at)) if factor.is_number else at, color="C3", linewidth=0.8)
        axes[-1, 0].set_ylabel("desirability")
        return {"profiler": figure}


def optimize(
    study: Study | str | os.PathLike[str],
    *,
    maximize: Sequence[str] = (),
    minimize: Sequence[str] = (),
    target: Sequence[str] = (),
    limit: Sequence[str] = (),
    limit_on: str = "mean",
    importance: Sequence[str] = (),
    hold: Sequence[str] = (),
    model: str | None = None,
    terms: str = "all",
    confidence: float = 0.95,
    runs: int = 0,
    confirm: bool = False,
    jobs: int | None = None,
    workers: int | None = None,
    progress: bool | None = None,
) -> Optimum:
    """Finds the settings at which responses are best.

    Parameters
    ----------
    study : path or Study
    maximize, minimize : sequence of str
        Responses, each ``NAME`` or ``NAME=LOW..HIGH`` with the values at which it is worth nothing and everything; else those of the runs.
    target : sequence of str
        ``NAME=VALUE`` or ``NAME=LOW..VALUE..HIGH``.
    limit : sequence of str
        ``NAME<=VALUE`` or ``NAME>=VALUE``.
    limit_on : {"mean", "means", "runs"}
        What has to keep the limits: what is expected, the interval of means, or that of one more run.
    importance : sequence of str
        ``NAME=NUMBER``: how much a goal counts, 1 unless given.
    hold : sequence of str
        ``FACTOR=VALUE``.
    model, terms, confidence
        As for `effects`.
    runs : int
        Make up to so many runs where improvement is expected, one place after the other, each with all seeds. The best place that was run is given.
    confirm : bool
        Make runs at the best settings.
    jobs, workers, progress
        As for ``plateau.sweep``.

    Returns
    -------
    Optimum
    """
    study = analysed(study)
    goals, limits = _wanted(study, {"maximize": maximize, "minimize": minimize, "target": target}, limit, limit_on, importance)

    def made(points: pandas.DataFrame) -> pandas.DataFrame:
        return make_runs(study, points, jobs=jobs, workers=workers, retry=confirm, progress=progress)

    found = {one.response.name: one for one in surrogates(study, model, terms, confidence)}
    for one in [*goals, *limits]:
        if found[one.response].error:
            raise InputError(f'{study.path or study.title}: response "{one.response}": {found[one.response].error}')
    known = {name: one for name, one in found.items() if not one.error}
    is_curved = all(one.fit is not None and one.fit.model == "quadratic" for one in known.values())
    problem, rounds, confirming = (
        Problem(study, known, goals, limits, _axes(study, hold, is_curved or runs > 0), confidence),
        pandas.DataFrame(),
        None,
    )
    if runs:
        problem, rounds = improved(problem, runs, made, max(1, (jobs or os.cpu_count() or 1) // study.seeds))
    problem = _beyond_runs(problem)
    best = problem.best()
    if runs:
        # The best of the places that were run, so that its own runs confirm it.
        points = problem.study.runs.drop_duplicates("point").reset_index(drop=True)[list(best.columns)]
        best = points.iloc[[int(problem.merit(points).argmax())]].reset_index(drop=True)
    if confirm or runs:
        confirming = made(best).drop_duplicates("same_as")
    return _told(problem, best, confirming, rounds)


def improved(
    problem: Problem, runs: int, made: Callable[[pandas.DataFrame], pandas.DataFrame], at_a_time: int = 1
) -> tuple[Problem, pandas.DataFrame]:
    """Makes runs where improvement is expected, and fits Gaussian processes anew after each round.

    Parameters
    ----------
    problem : Problem
    runs : int
        At most so many, those with each seed counted. The last ones are made where the mean is expected to be best.
    made : callable
        Makes the runs at points.
    at_a_time : int
        Points of a round: after the first one, each is chosen as if the ones before it had given what is expected of them.

    Returns
    -------
    tuple of Problem and DataFrame
        With all runs in its study, and the points with the improvement that was expected of them.
    """
    rows: list[dict[str, Any]] = []
    left, number = runs // problem.study.seeds, 0
    if left < 1:
        raise InputError(f"runs = {runs}: expected {problem.study.seeds} or more, one for each set of seeds")
    problem = _with_processes(problem, problem.study)
    while left > 0:
        number, chosen, believed = number + 1, [], problem
        while len(chosen) < min(at_a_time, left):
            point, gain = _promising(believed)
            if is_last := gain < WORTH or len(chosen) + 1 == left:
                point, left = _beyond_runs(believed).best(), len(chosen) + 1
                gain = float(expected_improvement(believed, point)[0])
            if not _is_run(believed, point).any():
                chosen.append({**point.iloc[0].to_dict(), "expected_improvement": gain})
            if is_last:
                break
            if len(chosen) < min(at_a_time, left):
                guess = {name: surrogate.response.back(surrogate.mean(point))[0] for name, surrogate in believed.surrogates.items()}
                believed = _with_processes(
                    believed, _with_runs(believed.study, [point.assign(**guess, replicate=1 + at) for at in range(problem.study.seeds)])
                )
        if not chosen:
            break
        left -= len(chosen)
        new = made(pandas.DataFrame(chosen))
        means = new.groupby("point")[[response.name for response in problem.study.responses]].mean().to_dict("records")
        rows += [{"round": number, **point, **mean} for point, mean in zip(chosen, means, strict=True)]
        problem = _with_processes(problem, _with_runs(problem.study, [new]))
    return problem, pandas.DataFrame(rows)


def _with_runs(study: Study, new: Sequence[pandas.DataFrame]) -> Study:
    runs = pandas.concat([study.runs, *(each.assign(state="finished") for each in new)], ignore_index=True)[study.runs.columns]
    # Equal points have one number.
    points = runs.groupby([factor.name for factor in study.factors], sort=False).ngroup() + 1
    return replace(
        study,
        runs=runs.assign(point=points, order=range(1, len(runs) + 1), same_as=range(1, len(runs) + 1)).set_axis(range(1, len(runs) + 1)),
    )


def _with_processes(problem: Problem, study: Study) -> Problem:
    """The problem with processes that are fitted to the runs of a study."""
    wanted = dict.fromkeys(one.response for one in [*problem.goals, *problem.limits])
    own = replace(study, responses=[response for response in study.responses if response.name in wanted])
    found = {one.response.name: replace(one, takes_process=one.process is not None) for one in surrogates(own, of_any_design=True)}
    return replace(problem, study=study, surrogates={**problem.surrogates, **found})


def expected_improvement(problem: Problem, points: pandas.DataFrame) -> Numbers:
    """By how much of the way to the goals points are expected to be better than the best mean of a point that was run.

    The reference is the best expected mean, not the best run, as runs are noisy (V. Picheny and others, Structural and Multidisciplinary
    Optimization 48, 607-626 (2013)). What is as uncertain at points that were run, too, is nothing that more runs tell. Points that miss a
    limit improve nothing.

    Parameters
    ----------
    problem : Problem
        With processes.
    points : pandas.DataFrame

    Returns
    -------
    numpy.ndarray
    """
    names = list(problem.forecasts(points.head(1)))
    known = problem.study.runs.drop_duplicates("point")
    draws = stats.norm.ppf(stats.qmc.Sobol(len(names), rng=0).random(DRAWS) * (1.0 - 1e-9) + 0.5e-9)
    values, kept, forecasts = {}, np.ones((len(points), DRAWS), bool), problem.forecasts(points)
    for name, z in zip(names, draws.T, strict=True):
        surrogate = problem.surrogates[name]
        open_part = np.sqrt(np.maximum(surrogate.deviation(points) ** 2 - surrogate.deviation(known).min() ** 2, 0.0))
        values[name] = surrogate.response.back(surrogate.mean(points)[:, None] + open_part[:, None] * z)
    for limit in problem.limits:
        change = (values[limit.response] - forecasts[limit.response][["value"]].to_numpy()) / limit.scale
        kept &= limit.margin(forecasts[limit.response])[:, None] + (change if limit.is_least else -change) >= -ROUNDING
    expected = problem.forecasts(known)
    keeps = np.all([limit.margin(expected[limit.response]) >= -ROUNDING for limit in problem.limits] or [[True] * len(known)], axis=0)
    reached = overall(problem.goals, [np.maximum(goal.way(expected[goal.response]["value"]), 0.0) for goal in problem.goals])
    best = float(np.where(keeps, reached, 0.0).max())
    merit = overall(problem.goals, [np.maximum(goal.way(values[goal.response]), 0.0) for goal in problem.goals])
    return np.asarray((np.maximum(merit - best, 0.0) * kept).mean(axis=1))


def _promising(problem: Problem) -> tuple[pandas.DataFrame, float]:
    """The point of the largest expected improvement that was not run, and how large that is."""
    best: Start = (-1.0, (), np.zeros(0))
    for levels, places in problem.spread(POINTS // 4):
        points = problem.points(levels, places)
        gains = np.where(_is_run(problem, points), 0.0, expected_improvement(problem, points))
        if gains.max() > best[0]:
            best = (float(gains.max()), levels, places[gains.argmax()])
    gain, levels, place = best
    if len(place) and gain > 0.0:

        def fall(x: Numbers) -> float:
            at = problem.points(levels, np.clip(x, -1.0, 1.0)[None])
            return 0.0 if _is_run(problem, at)[0] else -float(expected_improvement(problem, at)[0])

        options = {
            "maxfev": 40 * len(place),
            "initial_simplex": np.clip(place + 0.1 * np.vstack([0.0 * place, np.eye(len(place))]) * np.where(place > 0, -1, 1), -1, 1),
        }
        found = minimize(fall, place, method="Nelder-Mead", bounds=[(-1.0, 1.0)] * len(place), options=options)
        if -found.fun > gain:
            gain, place = -float(found.fun), np.clip(found.x, -1.0, 1.0)
    return problem.points(levels, place[None]), gain


# Coded places nearer than this are one point: its runs, with the same seeds, would tell nothing new.
NEAR = 0.02


def _is_run(problem: Problem, points: pandas.DataFrame) -> Numbers:
    """Whether points are at one that was run."""
    known = problem.study.runs.drop_duplicates("point")
    is_near = np.ones((len(points), len(known)), bool)
    for factor in problem.study.factors:
        own, others = points[factor.name].to_numpy()[:, None], known[factor.name].to_numpy()
        is_near &= np.abs(factor.coded(own) - factor.coded(others)) < NEAR if factor.is_number else own == others
    return np.asarray(is_near.any(axis=1))


def _unit(study: Study, response: Response) -> Unit:
    return unit_for(response.unit, float(np.nanmax(np.abs(study.runs[response.name].to_numpy(float)), initial=0.0)))


AIMS = {"maximize": "large,", "minimize": "small,", "target": "near the middle of"}


def _limit_words(limit: Limit, unit: Unit) -> str:
    on = {"mean": "", "means": " for the interval of means", "runs": " for the interval of runs"}[limit.on]
    return f"{'≥' if limit.is_least else '≤'} {unit.text(limit.value)}{on}"


def _named(names: Sequence[str], text: str, signs: Sequence[str]) -> tuple[str, str, str]:
    """The name that a text begins with, the longest that fits, the sign behind it and what stands behind that."""
    for name in sorted(names, key=len, reverse=True):
        rest = text.strip().removeprefix(name).lstrip()
        sign = next((sign for sign in signs if rest.startswith(sign)), "")
        if text.strip().startswith(name) and (sign or not rest):
            return name, sign, rest.removeprefix(sign).strip()
    raise InputError(f'"{text}": expected {" or ".join(sign + "VALUE" for sign in signs)} behind one of {", ".join(map(repr, names))}')


def _wanted(
    study: Study, given: dict[str, Sequence[str]], limits: Sequence[str], limit_on: str, importance: Sequence[str]
) -> tuple[list[Goal], list[Limit]]:
    """Goals and limits of the words."""
    responses = {response.name: response for response in study.responses}
    goals: dict[str, Goal] = {}

    def observed(name: str) -> tuple[float, float]:
        values = study.runs[name][np.isfinite(study.runs[name])]
        if values.empty:
            raise InputError(f'"{name}": no run has this response')
        return float(values.min()), float(values.max())

    for aim, text in ((aim, text) for aim, texts in given.items() for text in texts):
        name, _, said = _named(list(responses), text, ["="])
        values = [parsed(responses[name].unit, value) for value in said.split("..")] if said else []
        low, high = observed(name)
        if name in goals:
            raise InputError(f'"{name}" has two goals, expected one; a --limit may stand beside it')
        if not values and aim != "target":
            values = [low, high]
        elif len(values) == 1 and aim == "target":
            if not low <= values[0] <= high:
                raise InputError(
                    f'--target "{text}": the runs have {low:.6g} to {high:.6g} {responses[name].unit}; to aim beyond give LOW..VALUE..HIGH'
                )
            reach = max(high - values[0], values[0] - low)
            values = [values[0] - reach, values[0], values[0] + reach]
        if len(values) != (3 if aim == "target" else 2) or not all(a < b for a, b in itertools.pairwise(values)):
            expected = (
                "NAME=VALUE or NAME=LOW..VALUE..HIGH"
                if aim == "target"
                else "NAME, of which not all runs have the same value, or NAME=LOW..HIGH"
            )
            raise InputError(f'--{aim} "{text}": expected {expected}, with values that ascend')
        goals[name] = Goal(name, aim, tuple(values[::-1] if aim == "minimize" else values), is_of_runs=not said)
    if not goals:
        raise InputError("no goal: give --maximize, --minimize or --target with a response")
    for text in importance:
        name, _, said = _named(list(goals), text, ["="])
        if not 0.01 <= (power := parsed("1", said)) <= 100.0:
            raise InputError(f'--importance "{text}": expected a number between 0.01 and 100')
        goals[name] = replace(goals[name], importance=power)
    found = []
    for text in limits:
        name, sign, said = _named(list(responses), text, ["<=", ">="])
        low, high = observed(name)
        found.append(Limit(name, sign == ">=", parsed(responses[name].unit, said), limit_on, high - low if high > low else 1.0))
    return list(goals.values()), found


def _axes(study: Study, hold: Sequence[str], is_curved: bool) -> list[list[Any] | None]:
    """Where each factor may be."""
    held = {}
    for text in hold:
        name, _, said = _named([factor.name for factor in study.factors], text, ["="])
        factor = next(factor for factor in study.factors if factor.name == name)
        value: Any = said
        if factor.is_number:
            number = said.removesuffix(factor.study_unit).strip()
            value = float(number) * factor.one + factor.zero if number != said or not factor.study_unit else parsed(factor.unit, said)
            low, high = min(study.runs[name].min(), factor.ends[0]), max(study.runs[name].max(), factor.ends[1])
            if not low - 1e-9 * abs(low) <= value <= high + 1e-9 * abs(high):
                raise InputError(f"--hold: {name} is beyond {factor.text(low)} to {factor.text(high)}; the search stays within the ranges")
        elif value not in factor.levels:
            raise InputError(f"--hold {text}: expected one of {', '.join(factor.levels)}")
        held[name] = value
    axes: list[list[Any] | None] = []
    for factor in study.factors:
        is_between = factor.is_number and not factor.whole and (factor.is_range or len(factor.levels) == 2 or is_curved)
        whole = (
            list(range(int(np.ceil(factor.ends[0])), int(factor.ends[1]) + 1)) if factor.whole and factor.is_range else list(factor.levels)
        )
        axes.append([held[factor.name]] if factor.name in held else None if is_between else whole)
    return axes


def _beyond_runs(problem: Problem) -> Problem:
    """The problem whose goals end at the best that is expected within the ranges, if that is better than all runs: else all that is better
    were worth the same."""
    goals = []
    for goal in problem.goals:
        if goal.is_of_runs:
            worst, best = goal.values
            far = replace(goal, values=(worst - 100.0 * (best - worst), best + 100.0 * (best - worst)))
            alone = replace(problem, goals=[far], limits=[])
            found = float(alone.forecasts(alone.best())[goal.response]["value"].iloc[0])
            goal = replace(goal, values=(worst, max(best, found) if best > worst else min(best, found)))
        goals.append(goal)
    return replace(problem, goals=goals)


def _told(problem: Problem, best: pandas.DataFrame, confirming: pandas.DataFrame | None, rounds: pandas.DataFrame) -> Optimum:
    study, rows, cautions = problem.study, [], []
    for response in study.responses:
        surrogate = problem.surrogates.get(response.name)
        forecast = surrogate.forecast(best, problem.confidence).iloc[0].to_dict() if surrogate else {"value": np.nan}
        row = {
            "response": response.name,
            "unit": response.unit,
            **forecast,
            "desirability": np.nan,
            "runs": 0,
            "mean": np.nan,
            "standard_error": np.nan,
        }
        row["is_within"] = None
        for goal in problem.goals:
            if goal.response == response.name:
                row["desirability"] = float(goal.desirability(row["value"]))
        if confirming is not None and len(values := confirming[response.name].dropna()):
            is_within = bool(row["run_low"] <= values.mean() <= row["run_high"]) if np.isfinite(row.get("run_low", np.nan)) else None
            row |= {"runs": len(values), "mean": values.mean(), "standard_error": values.sem(), "is_within": is_within}
        cautions += [f"{response.name}: {caution}" for caution in (surrogate.cautions if surrogate else [])]
        rows.append(row)
    table = pandas.DataFrame(rows)
    keeps = all(limit.margin(table[table["response"] == limit.response])[0] >= -ROUNDING for limit in problem.limits)
    worth = {row["response"]: row["desirability"] for row in rows}
    settings, at_ends = [], []
    for factor, axis in zip(study.factors, problem.axes, strict=True):
        value = best[factor.name].iloc[0]
        settings.append({"factor": factor.name, "unit": factor.unit, "value": value, "text": factor.text(value)})
        if axis is None and abs(factor.coded(value)) > 1.0 - AT_END:
            at_ends.append(f"{factor.name} ({factor.text(value)})")
    total = float(overall(problem.goals, [worth[goal.response] for goal in problem.goals])) if keeps else 0.0
    if keeps and total <= 0.0:
        cautions.append("a goal is worth nothing wherever the others are worth something; give wider values, such as NAME=LOW..HIGH")
    return Optimum(
        study, pandas.DataFrame(settings), table, problem.goals, problem.limits, total, keeps, at_ends, _canonical(problem, best), rounds,
        problem.confidence, cautions, problem,
    )  # fmt: skip


def _canonical(problem: Problem, best: pandas.DataFrame) -> list[dict[str, Any]]:
    """The canonical analysis of each quadratic model over the numbers that may be anywhere, the others as at the best settings."""
    ranges = [factor for factor, axis in zip(problem.study.factors, problem.axes, strict=True) if axis is None]
    levels = [best[factor.name].iloc[0] for factor in problem.study.factors]
    found = []
    for name, surrogate in problem.surrogates.items():
        if surrogate.takes_process or surrogate.fit is None or surrogate.fit.model != "quadratic" or not ranges:
            continue

        def value_at(coded: Numbers, of: Surrogate = surrogate) -> Numbers:
            return of.mean(problem.points(levels, coded))

        said = canonical(value_at, len(ranges))
        places = []
        for factor, coded in zip(ranges, said["stationary"], strict=True) if said["nature"] != "ridge" else []:
            value = float(factor.value(coded))
            places.append(
                {
                    "factor": factor.name,
                    "unit": factor.unit,
                    "value": value,
                    "coded": float(coded),
                    "text": factor.text(value),
                    "is_within": bool(abs(coded) <= 1.0),
                }
            )
        value = float(surrogate.response.back(said["value"])) if places else None
        numbers = {"eigenvalues": said["eigenvalues"].tolist(), "directions": said["directions"].tolist()}
        found.append({"response": name, "nature": said["nature"], "value": value, "stationary": places, **numbers})
    return found
