"""Surrogates: what a response is expected to be where no run was made, from a polynomial or a Gaussian process."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import pandas

from plateau.errors import InputError
from plateau.study.data import Factor, Numbers, Response, Study
from plateau.study.model import Fitted, NothingToFit, f_test
from plateau.study.model_choice import cautions, fitted, of_missing
from plateau.study.process import Process
from plateau.units import unit_of, with_digits

WORDS = {"main": "main effects", "interactions": "main effects and interactions", "full": "interactions of all orders"}
# Designs that fill their ranges, so that a process can be better than a polynomial, and that do not; in a table all numbers have to have
# more different values than these.
FILLING = ("latin-hypercube", "sobol")
SPARSE = ("full-factorial", "fractional-factorial", "plackett-burman", "central-composite", "box-behnken", "morris")
MOST_FACTORIAL_LEVELS = 5
# Points for each factor that a process should have, and most that it takes.
POINTS_FOR_EACH, MOST_POINTS = 10, 1000


@dataclass(frozen=True, repr=False)
class Surrogate:
    """Surrogate of a response: the model that was fitted to it, or a process, whichever forecasts points better that it does not know.

    `fit` and `process` are None where there is none; `error` says why nothing could be fitted.
    """

    study: Study
    response: Response
    fit: Fitted | None
    process: Process | None
    takes_process: bool
    error: str = ""

    @property
    def _taken(self) -> Process | None:
        return self.process if self.takes_process else None

    @cached_property
    def _candidates(self) -> list[tuple[str, float]]:
        """Names of model and process, and roots of the mean squares of their leave-one-point-out errors, SI; NaN where not known."""
        response, process = self.response, self.process
        of = response.name if response.transform == "none" else f"{response.transform}({response.name})"
        found = [(f"{WORDS.get(self.fit.model, self.fit.model)} in {of}", self.fit.loo_error) if self.fit else ("", np.nan)]
        if process is not None:
            errors = response.back(process.means) - response.back(process.means - process.loo[0])
            found.append(("Gaussian process" + f" of {of}" * (response.transform != "none"), float(np.sqrt(np.square(errors).mean()))))
        return found

    @property
    def words(self) -> str:
        """Name of what forecasts, such as ``quadratic in log(wear)``."""
        return self._candidates[self.takes_process][0]

    @property
    def missed(self) -> float:
        """Part of the variance of the runs that leave-one-point-out errors have; NaN where they are not known."""
        return float((self._candidates[self.takes_process][1] / self.study.runs[self.response.name].std(ddof=0)) ** 2)

    @cached_property
    def reason(self) -> str:
        """Leave-one-out errors of the candidates, and which one is taken."""
        values = self.study.runs[self.response.name].dropna().to_numpy(float)
        unit, deviation = unit_of(self.response.unit, values), values.std()

        def shown(error: float) -> str:
            size = f"{with_digits(error * unit.per_si, error * unit.per_si)} {unit.symbol}".strip()
            return "not known" if np.isnan(error) else f"{size} (Q² {1 - (error / deviation) ** 2:.3f})"

        said = "leave-one-out error: " + ", ".join(f"{words} {shown(error)}" for words, error in self._candidates)
        if len(self._candidates) > 1:
            is_known = not np.isnan([error for _, error in self._candidates]).any()
            said += "; the smaller one is taken" if is_known else "; what is not known cannot be compared, and the other one is taken"
        ends = [with_digits(unit.value(end), unit.per_si * deviation / 10) for end in (values.min(), values.max())]
        said += f"; the runs have {ends[0]} to {ends[1]} {unit.symbol}".rstrip()
        if self._candidates[self.takes_process][1] >= deviation:
            said += "; it foretells a point no better than the mean of the runs does: these runs do not tell the response"
        return said

    @property
    def of_chance(self) -> list[str]:
        """Caution that what forecasts differ by may be scatter: the model is not significant, or the process foretells no better than the mean."""
        if (process := self._taken) is not None:
            # Of means of points, which scatter less than runs.
            missed = missed_by([process])
            is_chance, how = not missed < 1.0, f"points that were left out are missed by {100 * missed:.0f} % of their variance"
        else:
            p = f_test(self.fit.explained, self.fit.residual)[1] if self.fit else np.nan
            is_chance, how = self.fit is not None and p > 1.0 - self.fit.confidence, f"p = {p:.2g}"
        why = "what forecasts differ by, and where they are best, may be chance, of which intervals at the best place do not know"
        return (
            [f"the runs do not show that any factor has an effect ({how}): {why}; more sets of seeds or wider ranges may show one"]
            if is_chance
            else []
        )

    @cached_property
    def cautions(self) -> list[str]:
        """Cautions to read before a forecast is believed: a sentence each."""
        if self._taken is None:
            said = cautions(self.fit) if self.fit else []
        else:
            points, factors = len(self._taken.points), len(self.study.factors)
            few = f"few points: {points} for {factors} factors; take {POINTS_FOR_EACH} for each factor or more"
            said = of_missing(self._fit) + ([few] if points < POINTS_FOR_EACH * factors else [])
        if self.response.transform != "none" and self.fit and np.isfinite(self.fit._run_variance[0]):
            what = "a forecast, and its interval of means, is the median of runs with other seeds, not their arithmetic mean"
            said = [*said, f"transformed ({self.response.transform}): {what}"]
        return said

    def rows(self, points: pandas.DataFrame) -> Numbers:
        """Places for the process: coded numbers, and indicators of words."""
        return np.hstack([_columns(self.study, factor, points) for factor in self.study.factors])

    def mean(self, points: pandas.DataFrame) -> Numbers:
        """Expected responses at points (a column for each factor, SI units or words), on the scale of the fit."""
        if self._taken is not None:
            return np.asarray(self._taken.moments(self.rows(points))[0])
        return np.asarray(self._fit.matrix(points) @ self._fit.coefficients)

    def deviation(self, points: pandas.DataFrame) -> Numbers:
        """Standard deviations of the mean of many runs, on the scale of the fit; NaN where the runs do not tell it."""
        if self._taken is not None:
            _, own, seeds = self._taken.moments(self.rows(points))
            return np.asarray(np.sqrt(own + seeds / self._taken.seeds))
        return np.asarray(np.hypot(np.sqrt(self._fit.variances(points)["mean"].to_numpy()), self._apart(points)))

    def _apart(self, points: pandas.DataFrame) -> Any:
        """Differences of process and polynomial: what of the two is taken by its errors at few points may be wrong by as much."""
        process = self.process
        return 0.0 if process is None else np.abs(process.moments(self.rows(points))[0] - self._fit.matrix(points) @ self._fit.coefficients)

    @property
    def _fit(self) -> Fitted:
        if self.fit is None:
            raise InputError(f"{self.response.name}: {self.error}")
        return self.fit

    def forecast(self, points: pandas.DataFrame, confidence: float = 0.95) -> pandas.DataFrame:
        """Forecasts with intervals: ``value``, ``mean_low``, ``mean_high``, ``run_low``, ``run_high``, in SI units, and ``leverage``."""
        if self._taken is None:
            return self._fit.forecast(points, confidence, self._apart(points))
        names, found = ["value", "mean_low", "mean_high", "run_low", "run_high"], self._taken.intervals(self.rows(points), confidence)
        found[:, 3], found[:, 4] = np.minimum(found[:, 3], found[:, 1]), np.maximum(found[:, 4], found[:, 2])
        table = pandas.DataFrame(self.response.back(found), columns=names, index=points.index)
        return table.assign(leverage=self._fit.leverage(points))


def _columns(study: Study, factor: Factor, points: pandas.DataFrame) -> Numbers:
    """Columns of a factor for a process."""
    values = points[factor.name].to_numpy()
    if factor.is_number:
        return factor.coded(values)[:, None]
    seen = [level for level in factor.levels if level in set(study.runs[factor.name])]
    if unknown := set(values) - set(seen):
        raise InputError(f"factor `{factor.name}` has no observation at {unknown.pop()}; there are {', '.join(map(str, seen))}")
    # One of two words tells the other.
    return np.column_stack([values == level for level in (seen[1:] if len(seen) == 2 else seen)]).astype(float)


def surrogates(study: Study, model: str | None = None, confidence: float = 0.95, of_any_design: bool = False) -> list[Surrogate]:
    """Surrogate of each response; no process if a model is asked for, or points do not fill ranges, unless `of_any_design`."""
    counts = [study.runs[factor.name].nunique() for factor in study.factors if factor.is_number]
    has_many = study.design not in SPARSE and all(count > MOST_FACTORIAL_LEVELS for count in counts)
    found, may_be_process = [], model is None and (of_any_design or study.design in FILLING or has_many)
    for response in study.responses:
        fit, process, error = None, None, ""
        try:
            fit = fitted(study, response, model, confidence)
        except NothingToFit as why:
            error = str(why)
        if fit and may_be_process and 3 <= fit.point_count <= MOST_POINTS:
            columns = [_columns(study, factor, fit.runs) for factor in study.factors]
            axes = np.repeat(np.arange(len(columns)), [own.shape[1] for own in columns])
            process = Process(np.hstack(columns), fit.values, fit.runs["replicate"], axes)
        one = Surrogate(study, response, fit, process, False, error)
        is_better = process is not None and not one._candidates[0][1] <= one._candidates[1][1]
        found.append(replace(one, takes_process=is_better))
    return found


def missed_by(processes: Sequence[Process]) -> float:
    """Part of the variance of means of points, of all processes together, that errors at points left out have; NaN where means are alike."""
    missed, whole = sum(np.square(one.loo[0]).mean() for one in processes), sum(one.means.var() for one in processes)
    return float(missed / whole) if whole > 0.0 else np.nan
