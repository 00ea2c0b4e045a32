"""Surrogates: what a response is expected to be where no run was made, from a polynomial or a Gaussian process."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas

from plateau.errors import InputError
from plateau.study.data import Factor, Numbers, Response, Study
from plateau.study.model import Fitted, NothingToFit
from plateau.study.model_choice import cautions, fitted
from plateau.study.process import Process
from plateau.units import unit_for, with_digits

WORDS = {"main": "main effects", "interactions": "main effects and interactions", "full": "interactions of all orders"}
# Designs that do not fill their ranges; in a table all numbers have to have more different values than these.
SPARSE = ("full-factorial", "fractional-factorial", "plackett-burman", "central-composite", "box-behnken", "morris")
MOST_FACTORIAL_LEVELS = 5
# Points for each factor that a process should have, and most that it takes.
POINTS_FOR_EACH, MOST_POINTS = 10, 1000


@dataclass(frozen=True, repr=False)
class Surrogate:
    """What forecasts a response: the model that was fitted to it, or a process, whichever forecasts points better that it does not know.

    Either is None where there is none, and `error` says why nothing could be fitted.
    """

    study: Study
    response: Response
    fit: Fitted | None
    process: Process | None
    takes_process: bool
    error: str = ""

    @property
    def words(self) -> str:
        """What it is, such as ``quadratic in log(wear)``."""
        return self._words(self.takes_process)

    def _words(self, is_process: bool) -> str:
        of = self.response.name if self.response.transform == "none" else f"{self.response.transform}({self.response.name})"
        if is_process:
            return "Gaussian process" + (f" of {of}" if self.response.transform != "none" else "")
        return f"{WORDS.get(self.fit.model, self.fit.model)} in {of}" if self.fit else ""

    @property
    def _loo_errors(self) -> list[float]:
        process = np.nan
        if self.process is not None:
            means, error = self.process.means, self.process.loo[0]
            process = float(np.sqrt(np.square(self.response.back(means) - self.response.back(means - error)).mean()))
        return [self.fit.loo_error if self.fit else np.nan, process]

    @property
    def loo_error(self) -> float:
        """Root of the mean square of leave-one-point-out errors, SI; NaN where it is not known."""
        return self._loo_errors[self.takes_process]

    @property
    def missed(self) -> float:
        """Part of the variance of the runs that leave-one-point-out errors have; NaN where they are not known."""
        return float((self.loo_error / self.study.runs[self.response.name].std(ddof=0)) ** 2)

    @cached_property
    def reason(self) -> str:
        """Leave-one-out errors of the candidates, and which one is taken."""
        values = self.study.runs[self.response.name].dropna().to_numpy(float)
        unit, deviation = unit_for(self.response.unit, float(np.abs(values).max())), values.std()

        def shown(error: float) -> str:
            size = f"{with_digits(error * unit.per_si, error * unit.per_si)} {unit.symbol}".strip()
            return "not known" if np.isnan(error) else f"{size} (Q² {1 - (error / deviation) ** 2:.3f})"

        errors = self._loo_errors if self.process is not None else self._loo_errors[:1]
        said = "leave-one-out error: " + ", ".join(f"{self._words(bool(at))} {shown(error)}" for at, error in enumerate(errors))
        if len(errors) > 1:
            is_known = not np.isnan(errors).any()
            said += "; the smaller one is taken" if is_known else "; what is not known cannot be compared, and the other one is taken"
        ends = [with_digits(unit.value(end), unit.per_si * deviation / 10) for end in (values.min(), values.max())]
        said += f"; the runs have {ends[0]} to {ends[1]} {unit.symbol}".rstrip()
        if self.loo_error >= deviation:
            said += "; it foretells a point no better than the mean of the runs does: these runs do not tell the response"
        return said

    @cached_property
    def cautions(self) -> list[str]:
        """What is to be known before it is believed: a sentence each."""
        if self.takes_process and self.process is not None:
            points, factors = len(self.process.points), len(self.study.factors)
            few = f"few points: {points} for {factors} factors; take {POINTS_FOR_EACH} for each factor or more"
            return [few] if points < POINTS_FOR_EACH * factors else []
        return cautions(self.fit) if self.fit else []

    def rows(self, points: pandas.DataFrame) -> Numbers:
        """Places for the process: coded numbers, and indicators of words."""
        return np.column_stack([column for factor in self.study.factors for column in _columns(self.study, factor, points)])

    def mean(self, points: pandas.DataFrame) -> Numbers:
        """Expected responses at points (a column for each factor, SI units or words), on the scale of the fit."""
        if self.takes_process and self.process is not None:
            return np.asarray(self.process.moments(self.rows(points))[0])
        return np.asarray(self._fit.matrix(points) @ self._fit.coefficients)

    def deviation(self, points: pandas.DataFrame) -> Numbers:
        """Standard deviations of the mean of many runs, on the scale of the fit; NaN where the runs do not tell it."""
        if self.takes_process and self.process is not None:
            _, own, seeds = self.process.moments(self.rows(points))
            return np.asarray(np.sqrt(own + seeds / self.process.seeds))
        return np.asarray(np.hypot(np.sqrt(self._fit.variances(points)["mean"].to_numpy()), self._apart(points)))

    def _apart(self, points: pandas.DataFrame) -> Numbers:
        """Differences of process and polynomial: what of the two is taken by its errors at few points may be wrong by as much."""
        if self.process is None:
            return np.zeros(len(points))
        return np.asarray(np.abs(self.process.moments(self.rows(points))[0] - self._fit.matrix(points) @ self._fit.coefficients))

    @property
    def _fit(self) -> Fitted:
        if self.fit is None:
            raise InputError(f"{self.response.name}: {self.error}")
        return self.fit

    def forecast(self, points: pandas.DataFrame, confidence: float = 0.95) -> pandas.DataFrame:
        """Forecasts with intervals: ``value``, ``mean_low``, ``mean_high``, ``run_low``, ``run_high``, in SI units, and ``leverage``."""
        if not self.takes_process or self.process is None:
            return self._fit.forecast(points, confidence, self._apart(points))
        leverage, names = self._fit.leverage(points), ["value", "mean_low", "mean_high", "run_low", "run_high"]
        found = self.process.intervals(self.rows(points), confidence)
        found[:, 3], found[:, 4] = np.minimum(found[:, 3], found[:, 1]), np.maximum(found[:, 4], found[:, 2])
        return pandas.DataFrame(self.response.back(found), columns=names, index=points.index).assign(leverage=leverage)


def _columns(study: Study, factor: Factor, points: pandas.DataFrame) -> list[Numbers]:
    """Columns of a factor for a process."""
    if factor.is_number:
        return [factor.coded(points[factor.name].to_numpy(float))]
    seen = [level for level in factor.levels if level in set(study.runs[factor.name])]
    if unknown := set(points[factor.name]) - set(seen):
        raise InputError(f"factor `{factor.name}` has no observation at {unknown.pop()}; there are {', '.join(map(str, seen))}")
    indicators = [(points[factor.name] == level).to_numpy(float) for level in seen]
    return indicators if len(seen) > 2 else indicators[1:] or indicators


def fills_ranges(study: Study) -> bool:
    """Whether the points of a study fill the ranges of its factors, so that a process can be better than a polynomial."""
    if study.design in ("latin-hypercube", "sobol"):
        return True
    counts = [study.runs[factor.name].nunique() for factor in study.factors if factor.is_number]
    return study.design not in SPARSE and all(count > MOST_FACTORIAL_LEVELS for count in counts)


def surrogates(study: Study, model: str | None = None, confidence: float = 0.95, of_any_design: bool = False) -> list[Surrogate]:
    """What forecasts each response; no process if a model is asked for, or points do not fill ranges, unless `of_any_design`."""
    return [_surrogate(study, one, model, confidence, of_any_design or fills_ranges(study)) for one in study.responses]


def _surrogate(study: Study, response: Response, model: str | None, confidence: float, may_be_process: bool) -> Surrogate:
    try:
        fit = fitted(study, response, model, confidence)
    except NothingToFit as error:
        return Surrogate(study, response, None, None, False, str(error))
    process = None
    if model is None and may_be_process and 3 <= fit.point_count <= MOST_POINTS:
        columns = [_columns(study, factor, fit.runs) for factor in study.factors]
        axes = [at for at, own in enumerate(columns) for _ in own]
        process = Process(np.column_stack([column for own in columns for column in own]), fit.values, fit.runs["replicate"], axes)
    both = Surrogate(study, response, fit, process, False)
    of_fit, of_process = both._loo_errors
    takes_process = process is not None and not of_fit <= of_process
    return Surrogate(study, response, fit, process, takes_process)
