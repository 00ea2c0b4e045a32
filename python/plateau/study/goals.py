"""Goals and limits of responses, their desirability, and the search for the point where that is largest.

Expected improvement: runs at points that may be better than all that were run, for responses that are dear and noisy.
"""

import itertools
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
import pandas
from scipy import optimize, stats

from plateau.errors import InputError
from plateau.study.data import Factor, Numbers, Response, Study
from plateau.study.model import is_same
from plateau.study.settings import axis_of, beyond_of, each_of, ends_of, held_values, reach_of
from plateau.study.surrogate import Surrogate, surrogates
from plateau.units import quantity

# Typed more strictly than it can be called.
minimize: Any = optimize.minimize
# Points looked at in all and at least at each combination of levels, combinations at most, and points from which the search goes on.
POINTS, LEAST_POINTS, MOST_COMBINATIONS, STARTS = 4096, 16, 100_000, 4
# What is missed by less, in differences that count, is missed by rounding.
ROUNDING = 1e-10
# Draws of responses, and the improvement, as part of the way to the goal, that is worth no run.
DRAWS, WORTH = 256, 1e-3
# Coded places nearer than this are one point: its runs, with the same seeds, would tell nothing new.
NEAR = 0.02


@dataclass(frozen=True)
class Goal:
    """Goal of a response: `values` from worth nothing to worth everything, of a target to worth nothing again, SI.

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
        ways = [(np.asarray(response, float) - end) / (best - end) for end in (low, *self.values[2:])]
        return np.asarray(np.minimum.reduce(ways))

    def desirability(self, response: Any) -> Numbers:
        """Desirability, 0 to 1 (G. Derringer and R. Suich, Journal of Quality Technology 12, 214-219 (1980)); 0 of NaN."""
        return np.nan_to_num(np.clip(self.way(response), 0.0, 1.0))


@dataclass(frozen=True)
class Limit:
    """Limit that a response has to keep, SI: at least or at most `value`. `scale` is a difference that counts."""

    response: str
    is_least: bool
    value: float
    on: str
    scale: float

    def margin(self, forecast: pandas.DataFrame) -> Numbers:
        """Distance from the limit of what has to keep it, in differences that count; negative beyond it."""
        name = "value" if self.on == "mean" else f"{self.on.removesuffix('s')}_{'low' if self.is_least else 'high'}"
        kept = forecast[name].fillna(forecast["value"]).to_numpy()
        return np.asarray((kept - self.value if self.is_least else self.value - kept) / self.scale)


def overall(goals: Sequence[Goal], desirabilities: Sequence[Any]) -> Numbers:
    """The geometric mean of desirabilities, weighted by importance: what makes one response worth nothing no other can save."""
    with np.errstate(divide="ignore"):
        logs = sum(goal.importance * np.log(np.asarray(each)) for goal, each in zip(goals, desirabilities, strict=True))
    return np.asarray(np.exp(logs / sum(goal.importance for goal in goals)))


# A merit, the levels of a point, and its place in the cube.
Start = tuple[float, tuple[Any, ...], Numbers]


@dataclass(frozen=True)
class Problem:
    """Goals, limits and region of a search: ``axes`` has the levels of each factor; None if it may be anywhere in its range."""

    study: Study
    surrogates: dict[str, Surrogate]
    goals: list[Goal]
    limits: list[Limit]
    axes: list[list[Any] | None]
    confidence: float

    @property
    def free(self) -> list[Factor]:
        """Factors that may be anywhere in their range."""
        return [factor for factor, axis in zip(self.study.factors, self.axes, strict=True) if axis is None]

    def points(self, levels: Sequence[Any], coded: Numbers) -> pandas.DataFrame:
        """Points of the factors at levels, and at coded places of the others."""
        columns: dict[str, Any] = {factor.name: [level] * len(coded) for factor, level in zip(self.study.factors, levels, strict=True)}
        return pandas.DataFrame(columns | {factor.name: factor.value(place) for factor, place in zip(self.free, coded.T, strict=True)})

    @property
    def known(self) -> pandas.DataFrame:
        """Points that were run at values that the search may take, one row each."""
        points = self.study.runs.drop_duplicates("point")
        for factor, axis in zip(self.study.factors, self.axes, strict=True):
            if axis is not None:
                points = points[np.any([is_same(points[factor.name], level) for level in axis], axis=0)]
        return points

    @cached_property
    def _region(self) -> tuple[Numbers, float]:
        """Coded ends of the factors that may be anywhere, and how far from the middle the search goes in all of them together."""
        return np.array([ends_of(self.study, factor) for factor in self.free]).reshape(-1, 2), reach_of(self.study)

    def within(self, levels: Sequence[Any], cube: Numbers) -> Numbers:
        """Coded places in the region of the design of points of a cube from -1 to 1: what is too far out comes back towards the middle."""
        ends, reach = self._region
        places = ends[:, 0] + (cube + 1.0) / 2.0 * (ends[:, 1] - ends[:, 0])
        numbers = [(factor, level) for factor, level in zip(self.study.factors, levels, strict=True) if level is not None and factor.is_number]
        left = reach**2 - sum(float(factor.coded(level)) ** 2 for factor, level in numbers)
        away = np.sqrt(np.square(places).sum(axis=1, keepdims=True))
        return np.asarray(places * np.minimum(1.0, max(left, 0.0) ** 0.5 / np.maximum(away, 1e-300)))

    @property
    def wanted(self) -> list[str]:
        """Names of the responses with a goal or a limit."""
        return list(dict.fromkeys([*(goal.response for goal in self.goals), *(limit.response for limit in self.limits)]))

    def forecasts(self, points: pandas.DataFrame, *, with_intervals: bool = False) -> dict[str, pandas.DataFrame]:
        """Forecasts of the responses that are wanted, by name."""
        needs = {limit.response for limit in self.limits if limit.on != "mean"} | set(self.wanted if with_intervals else ())
        values = {name: one.response.back(one.mean(points)) for name, one in self.surrogates.items() if name in set(self.wanted) - needs}
        found = {name: pandas.DataFrame({"value": value}) for name, value in values.items()}
        return found | {name: self.surrogates[name].forecast(points, self.confidence) for name in needs}

    def desirability(self, forecasts: dict[str, pandas.DataFrame]) -> Numbers:
        """The mean desirability, whether limits are kept or not."""
        return overall(self.goals, [goal.desirability(forecasts[goal.response]["value"]) for goal in self.goals])

    def margins(self, forecasts: dict[str, pandas.DataFrame]) -> Numbers:
        """Distance from the nearest limit, in differences that count; negative beyond one, infinite without any."""
        margins = [limit.margin(forecasts[limit.response]) for limit in self.limits]
        return np.asarray(np.min(margins, axis=0) if margins else np.full(len(next(iter(forecasts.values()))), np.inf))

    def keeps(self, forecasts: dict[str, pandas.DataFrame]) -> Numbers:
        """Tells whether forecasts keep all limits."""
        return np.asarray(self.margins(forecasts) >= -ROUNDING)

    def merit(self, points: pandas.DataFrame) -> Numbers:
        """Merit: above 0 the mean desirability; below 0 how far a limit is missed or a response worth nothing, which tells the way back."""
        found = self.forecasts(points)
        ways = [goal.way(found[goal.response]["value"]) for goal in self.goals]
        merit = overall(self.goals, [np.clip(way, 0.0, 1.0) for way in ways])
        short = sum(np.minimum(way, 0.0) for way in ways)
        merit = np.where(merit > 0.0, merit, np.maximum(short / (1.0 - short), -1.0))
        missed = sum((np.maximum(-limit.margin(found[limit.response]), 0.0) for limit in self.limits), np.zeros(len(points)))
        return np.nan_to_num(np.where(missed > ROUNDING, -2.0 - missed, merit), nan=-1e9)

    def at(self, levels: Sequence[Any], cube: Numbers) -> pandas.DataFrame:
        """Points of the factors at levels, and in the region at points of the cube."""
        return self.points(levels, self.within(levels, np.clip(cube, -1.0, 1.0)))

    def starts(self, merit: Callable[[pandas.DataFrame], Numbers], count: int = POINTS) -> list[Start]:
        """Points at which something is large, the largest first, of many: at each combination of levels spread over the region."""
        choices = [[None] if axis is None else axis for axis in self.axes]
        if (combinations := int(np.prod([len(choice) for choice in choices], dtype=float))) > MOST_COMBINATIONS:
            raise InputError(f"the levels have {combinations} combinations, at most {MOST_COMBINATIONS} are looked at: hold some of the factors")
        bits, ranges = int(np.ceil(np.log2(max(count // combinations, LEAST_POINTS)))), len(self.free)
        cube = 2.0 * stats.qmc.Sobol(ranges, rng=0).random_base2(bits) - 1.0 if ranges else np.zeros((1, 0))
        starts: list[Start] = []
        for levels in itertools.product(*choices):
            merits = merit(self.at(levels, cube))
            starts += [(float(merits[at]), levels, cube[at]) for at in np.argsort(-merits, kind="stable")[:STARTS]]
            starts = sorted(starts, key=lambda start: -start[0])[:STARTS]
        return starts

    def simplex(self, merit: Callable[[pandas.DataFrame], Numbers], start: Start) -> Start:
        """Goes on from a start by simplices, whatever corners there are."""
        value, levels, place = start
        inward = 0.1 * np.where(place > 0.0, -1.0, 1.0) * np.eye(len(place))
        options = {"maxfev": 60 * len(place), "xatol": 1e-5, "fatol": 1e-9, "initial_simplex": np.vstack([place, place + inward])}
        bounds = [(-1.0, 1.0)] * len(place)
        found = minimize(lambda x: -merit(self.at(levels, x[None]))[0], place, method="Nelder-Mead", bounds=bounds, options=options)
        return (-float(found.fun), levels, np.clip(found.x, -1.0, 1.0)) if -found.fun > value else start

    def best(self) -> pandas.DataFrame:
        """The point of the largest merit, one row."""
        starts = self.starts(self.merit)
        best = starts[0]
        if self.free:
            best = max(map(self._climbed, starts), key=lambda found: found[0])
            best = self._climbed(self.simplex(self.merit, best))
        return self.at(best[1], best[2][None])

    def _climbed(self, start: Start) -> Start:
        """Goes on from a start along slopes and limits."""
        merit, levels, place = start
        step = 1e-5 * np.eye(len(place))

        @lru_cache(maxsize=8)
        def smooth(cube: bytes) -> tuple[Numbers, Numbers]:
            """Minus the logarithm of the desirability and the margins of the limits, and their slopes, of one forecast of all places."""
            x = np.frombuffer(cube)
            found = self.forecasts(self.points(levels, self.within(levels, np.vstack([x, x + step, x - step]))))
            logs = sum(goal.importance * np.log(np.maximum(goal.way(found[goal.response]["value"]), 1e-9)) for goal in self.goals)
            values = np.column_stack([-logs, *(limit.margin(found[limit.response]) for limit in self.limits)])
            return values[0], ((values[1 : 1 + len(x)] - values[1 + len(x) :]) / 2e-5).T

        kept = {"type": "ineq", "fun": lambda x: smooth(x.tobytes())[0][1:], "jac": lambda x: smooth(x.tobytes())[1][1:].copy()}
        options: dict[str, Any] = {"bounds": [(-1.0, 1.0)] * len(place), "constraints": kept if self.limits else (), "options": {"ftol": 1e-13}}
        options["jac"] = lambda x: smooth(x.tobytes())[1][0].copy()
        with warnings.catch_warnings(action="ignore", category=RuntimeWarning):
            x = np.clip(minimize(lambda x: smooth(x.tobytes())[0][0], place, method="SLSQP", **options).x, -1.0, 1.0)
        found = float(self.merit(self.at(levels, x[None]))[0]) if np.isfinite(x).all() else -np.inf
        return (found, levels, x) if found > merit else start


def beyond_runs(problem: Problem) -> Problem:
    """The problem whose goals end at the best that is expected within the ranges, if that is better than all runs."""
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


def improved(
    problem: Problem, runs: int, made: Callable[[pandas.DataFrame], pandas.DataFrame], at_a_time: int = 1
) -> tuple[Problem, pandas.DataFrame]:
    """Makes so many runs at most where improvement is expected, the last ones where the mean is expected to be best.

    Each point of a round is chosen as if those before it had given what is expected. Gives the problem with all runs, and the points.
    """
    rows: list[dict[Any, Any]] = []
    left, number = runs // problem.study.seeds, 0
    if left < 1:
        raise InputError(f"runs = {runs}: expected {problem.study.seeds} or more, one for each set of seeds")
    problem = with_processes(problem)
    while left > 0:
        number, believed = number + 1, problem
        chosen: list[dict[Any, Any]] = []
        while len(chosen) < min(at_a_time, left):
            point, gain = _promising(believed)
            if is_last := gain < WORTH or len(chosen) + 1 == left:
                point, left = beyond_runs(believed).best(), len(chosen) + 1
                gain = float(expected_improvement(believed, point)[0])
            if not is_run(believed, point).any():
                chosen.append({**point.iloc[0].to_dict(), "expected_improvement": gain})
            if is_last:
                break
            if len(chosen) < min(at_a_time, left):
                guess = {name: surrogate.response.back(surrogate.mean(point))[0] for name, surrogate in believed.surrogates.items()}
                believed = with_processes(believed, *(point.assign(**guess, replicate=1 + at) for at in range(problem.study.seeds)))
        if not chosen:
            break
        left -= len(chosen)
        new = made(pandas.DataFrame(chosen))
        means = new.groupby("point")[[response.name for response in problem.study.responses]].mean().to_dict("records")
        rows += [{"round": number} | point | mean for point, mean in zip(chosen, means, strict=True)]
        problem = with_processes(problem, new)
    return problem, pandas.DataFrame(rows)


def with_processes(problem: Problem, *new: pandas.DataFrame) -> Problem:
    """The problem with processes that are fitted to the runs of its study and to new ones."""
    study = problem.study
    if new:
        runs = pandas.concat([study.runs, *(each.assign(state="finished") for each in new)], ignore_index=True)[study.runs.columns]
        # Equal points have one number.
        points = runs.groupby([factor.name for factor in study.factors], sort=False).ngroup() + 1
        numbers = pandas.RangeIndex(1, len(runs) + 1, name="run")
        study = replace(study, runs=runs.assign(point=points, order=numbers, same_as=numbers).set_axis(numbers))
    own = replace(study, responses=[response for response in study.responses if response.name in problem.wanted])
    found = {one.response.name: replace(one, takes_process=one.process is not None) for one in surrogates(own, of_any_design=True)}
    return replace(problem, study=study, surrogates={**problem.surrogates, **found})


def expected_improvement(problem: Problem, points: pandas.DataFrame) -> Numbers:
    """Part of the way to the goals by which points are expected to be better than the best mean of a point that was run.

    The best mean is the expected one, as runs are noisy (V. Picheny and others, Struct. Multidisc. Optim. 48, 607-626 (2013)). What is as
    uncertain at points that were run, too, is nothing that more runs tell.
    """
    names = problem.wanted
    runs = problem.study.runs.drop_duplicates("point")
    draws = stats.norm.ppf(stats.qmc.Sobol(len(names), rng=0).random(DRAWS) * (1.0 - 1e-9) + 0.5e-9)
    values, kept, forecasts = {}, np.ones((len(points), DRAWS), bool), problem.forecasts(points)
    for name, z in zip(names, draws.T, strict=True):
        surrogate = problem.surrogates[name]
        open_part = np.sqrt(np.maximum(surrogate.deviation(points) ** 2 - surrogate.deviation(runs).min() ** 2, 0.0))
        values[name] = surrogate.response.back(surrogate.mean(points)[:, None] + open_part[:, None] * z)
    for limit in problem.limits:
        change = (values[limit.response] - forecasts[limit.response][["value"]].to_numpy()) / limit.scale
        kept &= limit.margin(forecasts[limit.response])[:, None] + (change if limit.is_least else -change) >= -ROUNDING
    expected = problem.forecasts(problem.known)
    reached = overall(problem.goals, [np.maximum(goal.way(expected[goal.response]["value"]), 0.0) for goal in problem.goals])
    best = float(np.where(problem.keeps(expected), reached, 0.0).max(initial=0.0))
    merit = overall(problem.goals, [np.maximum(goal.way(values[goal.response]), 0.0) for goal in problem.goals])
    return np.asarray((np.maximum(merit - best, 0.0) * kept).mean(axis=1))


def _promising(problem: Problem) -> tuple[pandas.DataFrame, float]:
    """The point of the largest expected improvement that was not run, and how large that is."""

    def gains(points: pandas.DataFrame) -> Numbers:
        return np.where(is_run(problem, points), 0.0, expected_improvement(problem, points))

    start, *_ = problem.starts(gains, POINTS // 4)
    gain, levels, place = problem.simplex(gains, start) if start[0] > 0.0 and start[2].size else start
    return problem.at(levels, place[None]), gain


def is_run(problem: Problem, points: pandas.DataFrame, near: float = NEAR) -> Numbers:
    """Tells whether points are at one that was run."""
    known = problem.study.runs.drop_duplicates("point")
    is_near = np.ones((len(points), len(known)), bool)
    for factor in problem.study.factors:
        own, others = points[factor.name].to_numpy()[:, None], known[factor.name].to_numpy()
        is_near &= np.abs(factor.coded(own) - factor.coded(others)) < near if factor.is_number else own == others
    return np.asarray(is_near.any(axis=1))


def named(names: Sequence[str], text: str, signs: Sequence[str]) -> tuple[str, str, str]:
    """The name that a text begins with, the longest that fits, the sign behind it and what stands behind that."""
    for name in sorted(names, key=len, reverse=True):
        rest = text.strip().removeprefix(name).lstrip()
        sign = next((sign for sign in signs if rest.startswith(sign)), "")
        if text.strip().startswith(name) and (sign or not rest):
            return name, sign, rest.removeprefix(sign).strip()
    known = ", ".join(map(repr, names))
    if not text.strip().startswith(tuple(names)):
        raise InputError(f'"{text}": there is none of this name, expected one of {known}')
    raise InputError(f'"{text}": expected {" or ".join(sign + "VALUE" for sign in signs)} behind one of {known}')


def _value(option: str, text: str, said: str, response: Response) -> float:
    """A value of a response, SI, that an option names in its text."""
    bare = response.unit == "1"
    try:
        return quantity(said, response.unit, needs_unit=not bare, example=None if bare else f"1 {response.unit}")
    except InputError as error:
        raise InputError(f'{option} "{text}": {error}') from None


def wanted(
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

    for aim, text in ((aim, text) for aim, texts in given.items() for text in each_of(texts)):
        name, _, said = named(list(responses), text, ["="])
        values = [_value(f"--{aim}", text, value, responses[name]) for value in said.split("..")] if said else []
        low, high = observed(name)
        if name in goals:
            raise InputError(f'"{name}" has two goals, expected one; a --limit may stand beside it')
        if not values and aim != "target":
            if low == high:
                raise InputError(f'--{aim} "{text}": all runs have {low:g}, so there is nothing to choose; give NAME=LOW..HIGH to go on')
            values = [low, high]
        elif len(values) == 1 and aim == "target":
            if not low <= values[0] <= high:
                has = f"the runs have {low:.6g} to {high:.6g} {responses[name].unit}"
                raise InputError(f'--target "{text}": {has}; to aim beyond give LOW..VALUE..HIGH')
            reach = max(high - values[0], values[0] - low)
            values = [values[0] - reach, values[0], values[0] + reach]
        if len(values) != (3 if aim == "target" else 2) or not all(a < b for a, b in itertools.pairwise(values)):
            expected = "NAME=VALUE or NAME=LOW..VALUE..HIGH" if aim == "target" else "NAME or NAME=LOW..HIGH"
            raise InputError(f'--{aim} "{text}": expected {expected}, with values that ascend')
        goals[name] = Goal(name, aim, tuple(values[::-1] if aim == "minimize" else values), is_of_runs=not said)
    if not goals:
        raise InputError("no goal: give --maximize, --minimize or --target with a response")
    for text in each_of(importance):
        name, _, said = named(list(goals), text, ["="])
        if not 0.01 <= (power := quantity(said, "1", needs_unit=False)) <= 100.0:
            raise InputError(f'--importance "{text}": expected a number between 0.01 and 100')
        goals[name] = replace(goals[name], importance=power)
    found = []
    for text in each_of(limits):
        name, sign, said = named(list(responses), text, ["<=", ">="])
        low, high = observed(name)
        found.append(Limit(name, sign == ">=", _value("--limit", text, said, responses[name]), limit_on, high - low if high > low else 1.0))
    return list(goals.values()), found


def axes_of(study: Study, hold: Mapping[str, Any] | Sequence[str], is_curved: bool) -> list[list[Any] | None]:
    """Values that each factor may have: its levels, the value that it is held at, or None for any in its range."""
    held = held_values(study, hold, "--hold", is_curved)
    place = pandas.DataFrame({factor.name: [held.get(factor.name, axis_of(factor, None, is_curved)[0])] for factor in study.factors})
    if beyond := beyond_of(study, place)[0]:
        raise InputError(f"--hold: {beyond}; the search stays in the region of the design")
    axes: list[list[Any] | None] = []
    for factor in study.factors:
        whole = range(int(np.ceil(factor.ends[0])), int(factor.ends[1]) + 1) if factor.whole and factor.is_range else factor.levels
        is_between = factor.is_number and not factor.whole and (factor.is_range or len(factor.levels) == 2 or is_curved)
        axes.append([held[factor.name]] if factor.name in held else None if is_between else list(whole))
    return axes
