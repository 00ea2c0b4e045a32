"""Expected improvement: runs at points that may be better than all that were run, for responses that are dear and noisy."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas
from scipy import stats

from plateau.errors import InputError
from plateau.study.data import Numbers, Study
from plateau.study.goals import POINTS, ROUNDING, Problem, beyond_runs, overall
from plateau.study.surrogate import surrogates

# Draws of responses, and the improvement, as part of the way to the goal, that is worth no run.
DRAWS, WORTH = 256, 1e-3
# Coded places nearer than this are one point: its runs, with the same seeds, would tell nothing new.
NEAR = 0.02


def improved(
    problem: Problem, runs: int, made: Callable[[pandas.DataFrame], pandas.DataFrame], at_a_time: int = 1
) -> tuple[Problem, pandas.DataFrame]:
    """Makes so many runs at most where improvement is expected, the last ones where the mean is expected to be best.

    Of a round each point is chosen as if those before it had given what is expected. Gives the problem with all runs, and the points.
    """
    rows: list[dict[Any, Any]] = []
    left, number = runs // problem.study.seeds, 0
    if left < 1:
        raise InputError(f"runs = {runs}: expected {problem.study.seeds} or more, one for each set of seeds")
    problem = with_processes(problem, problem.study)
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
                as_if = [point.assign(**guess, replicate=1 + at) for at in range(problem.study.seeds)]
                believed = with_processes(believed, _with_runs(believed.study, as_if))
        if not chosen:
            break
        left -= len(chosen)
        new = made(pandas.DataFrame(chosen))
        means = new.groupby("point")[[response.name for response in problem.study.responses]].mean().to_dict("records")
        rows += [{"round": number} | point | mean for point, mean in zip(chosen, means, strict=True)]
        problem = with_processes(problem, _with_runs(problem.study, [new]))
    return problem, pandas.DataFrame(rows)


def _with_runs(study: Study, new: Sequence[pandas.DataFrame]) -> Study:
    runs = pandas.concat([study.runs, *(each.assign(state="finished") for each in new)], ignore_index=True)[study.runs.columns]
    # Equal points have one number.
    points = runs.groupby([factor.name for factor in study.factors], sort=False).ngroup() + 1
    numbers = pandas.RangeIndex(1, len(runs) + 1, name="run")
    return replace(study, runs=runs.assign(point=points, order=numbers, same_as=numbers).set_axis(numbers))


def with_processes(problem: Problem, study: Study) -> Problem:
    """The problem with processes that are fitted to the runs of a study."""
    own = replace(study, responses=[response for response in study.responses if response.name in problem.wanted])
    found = {one.response.name: replace(one, takes_process=one.process is not None) for one in surrogates(own, of_any_design=True)}
    return replace(problem, study=study, surrogates={**problem.surrogates, **found})


def expected_improvement(problem: Problem, points: pandas.DataFrame) -> Numbers:
    """By how much of the way to the goals points are expected to be better than the best mean of a point that was run.

    It is the best expected mean, as runs are noisy (V. Picheny and others, Struct. Multidisc. Optim. 48, 607-626 (2013)). What is as uncertain
    at points that were run, too, is nothing that more runs tell.
    """
    names = problem.wanted
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
    reached = overall(problem.goals, [np.maximum(goal.way(expected[goal.response]["value"]), 0.0) for goal in problem.goals])
    best = float(np.where(problem.keeps(expected), reached, 0.0).max())
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
    """Whether points are at one that was run."""
    known = problem.study.runs.drop_duplicates("point")
    is_near = np.ones((len(points), len(known)), bool)
    for factor in problem.study.factors:
        own, others = points[factor.name].to_numpy()[:, None], known[factor.name].to_numpy()
        is_near &= np.abs(factor.coded(own) - factor.coded(others)) < near if factor.is_number else own == others
    return np.asarray(is_near.any(axis=1))
