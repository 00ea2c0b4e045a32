"""Models of responses: terms of the factors, fitted by least squares, and what they forecast."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pandas
from scipy import stats

from plateau.errors import InputError
from plateau.study.data import Factor, Numbers, Response, Study

# Factors of a term, by index, in ascending order; a square names its factor twice, and the term of centre points has none.
Term = tuple[int, ...]

MODELS = {
    "main": "main effects",
    "interactions": "main effects and interactions of two factors",
    "full": "main effects and interactions of all orders",
    "quadratic": "main effects, interactions of two factors and squares",
}
# A column depends on others if no more of it than the first is left, relative to its length; those of which there is more than the
# second in it are what it depends on.
DEPENDENT, CONTRIBUTES = 1e-8, 1e-6
# Residuals below this, relative to the largest response, are rounding.
ROUNDING = 16 * np.finfo(float).eps
# A point whose own weight in its fit comes this near to 1 has a coefficient of its own.
SOLE = 1e-9
# Coded values that differ by less are the same.
SAME = 1e-6
# Most coefficients of a model.
MOST_COLUMNS = 2000
# Degrees of freedom that squares should leave for the error; with fewer, intervals are too wide to tell anything.
LEAST_FREEDOM = 3
# Chance from which on what scatters unlike between sets of seeds is not taken to be alike.
ALIKE = 0.1


class NothingToFit(InputError):
    """The runs tell nothing of this response."""


def contrasts(levels: int) -> Numbers:
    """Contrasts that sum to zero, a row for each level: the first has -1 in all of them, each other one 1 in one of its own."""
    return np.vstack([-np.ones(levels - 1), np.eye(levels - 1)])


@dataclass(frozen=True)
class Coding:
    """Coding of the values of a factor as numbers: coded units, or contrasts between the levels (``classes``) that were observed."""

    factor: Factor
    classes: tuple[object, ...] | None
    width: int

    @classmethod
    def of(cls, factor: Factor, observed: pandas.Series, model: str) -> "Coding":
        """Codes a factor as a model needs it."""
        if len(set(factor.levels)) < 2:
            raise NothingToFit(f"factor `{factor.name}`: at least two different levels are needed")
        if factor.is_range or (model == "quadratic" and factor.is_number):
            return cls(factor, None, 1)
        levels = [level for level in dict.fromkeys(factor.levels) if level in set(observed)]
        return cls(factor, tuple(sorted(levels) if factor.is_number else levels), len(levels) - 1)

    @property
    def is_straight(self) -> bool:
        """True if the model is straight along its numbers: along a range, and between two levels."""
        return self.classes is None or (self.factor.is_number and len(self.factor.levels) == len(self.classes) == 2)

    def numbers(self, values: pandas.Series) -> Numbers:
        """Columns for values."""
        if self.is_straight:
            return self.factor.coded(values.to_numpy(float))[:, None]
        levels = self.classes or ()
        same = [is_same(values, level) for level in levels]
        if not (known := np.any(same, axis=0)).all():
            found = self.factor.text(values[~known].iloc[0])
            there = ", ".join(self.factor.text(level) for level in levels)
            raise InputError(f"factor `{self.factor.name}` has no observation at {found}; there are {there}")
        return np.asarray(contrasts(len(levels))[np.argmax(same, axis=0)])


def is_same(values: pandas.Series, level: object) -> Numbers:
    """Tells which values are a level; numbers may differ by rounding."""
    if isinstance(level, str):
        return np.asarray(values == level)
    return np.asarray(np.isclose(values.to_numpy(float), float(str(level)), rtol=1e-9, atol=0.0))


def named(factor: Factor) -> str:
    """Name of a factor as a model has it."""
    return f"log₁₀ {factor.name}" if factor.logarithmic else factor.name


class LeastSquares:
    """Least squares with columns that may depend on each other: of such columns the first keep their coefficients.

    `kept` are those; `relations` has for each other column the kept ones that it is a combination of, and how much of each is in it. `root`
    times its transpose is the covariance of the coefficients in units of the error's variance, and `basis` an orthogonal basis of the
    kept columns, a row for each observation.
    """

    def __init__(self, matrix: Numbers) -> None:
        self.kept: list[int] = []
        self.basis = np.zeros((len(matrix), 0))
        for column, values in enumerate(matrix.T):
            rest = self.residuals(values)
            if len(self.kept) < len(matrix) and np.linalg.norm(rest) > DEPENDENT * np.linalg.norm(values):
                self.kept.append(column)
                self.basis = np.column_stack([self.basis, rest / np.linalg.norm(rest)])
        self.root = np.asarray(np.linalg.inv(self.basis.T @ matrix[:, self.kept]), float)
        lengths = np.linalg.norm(matrix, axis=0)
        self.relations: dict[int, tuple[list[int], Numbers]] = {}
        for column in sorted(set(range(matrix.shape[1])) - set(self.kept)):
            weights = self.coefficients(matrix[:, column])
            parts = np.flatnonzero(np.abs(weights) * lengths[self.kept] > CONTRIBUTES * lengths[column])
            self.relations[column] = ([self.kept[at] for at in parts], weights)

    def coefficients(self, values: Numbers) -> Numbers:
        """Coefficients of the kept columns."""
        return np.asarray(self.root @ (self.basis.T @ values))

    def residuals(self, values: Numbers) -> Numbers:
        """Residuals of the fit; taken twice, so that rounding leaves nothing along the basis."""
        left = values - self.basis @ (self.basis.T @ values)
        return np.asarray(left - self.basis @ (self.basis.T @ left))


@dataclass(frozen=True)
class Squares:
    """A sum of squares with its degrees of freedom; the mean is NaN without any."""

    freedom: float
    sum: float

    @property
    def mean(self) -> float:
        """The mean square."""
        return self.sum / self.freedom if self.freedom > 0 else np.nan


class Fitted:
    """A model that was fitted to a response, on the scale of the response.

    Its `runs` were fitted, each once, with equal settings as one `point`; their `sets` of seeds are blocks. `columns` are those of the mean, the
    blocks and each term in `design`, and `coefficients` are 0 where others have the estimate. `centre` has the coded places of the term of
    centre points, and `error` is the mean square of the residual, NaN where nothing but rounding is left.
    """

    def __init__(
        self, study: Study, response: Response, model: str, runs: pandas.DataFrame, values: Numbers,
        reason: str = "", confidence: float = 0.95, centre: bool = False, missing: int = 0,
    ) -> None:  # fmt: skip
        self.study, self.response, self.model, self.reason, self.confidence = study, response, model, reason, confidence
        self.values, self.missing = values, missing
        self.codings = [Coding.of(factor, runs[factor.name], model) for factor in study.factors]
        keys = pandas.DataFrame({one.name: np.round(one.coded(runs[one.name]) * 1e9) if one.is_number else runs[one.name] for one in study.factors})
        self.is_curved = [coding.classes is None and keys[coding.factor.name].nunique() > 2 for coding in self.codings]
        self.runs, self.sets = runs.assign(point=keys.groupby(list(keys)).ngroup().to_numpy()), pandas.factorize(runs["replicate"], sort=True)[0]
        self.seeds, self.point_count = int(self.sets.max()) + 1, int(self.runs["point"].max()) + 1
        self.centre = self._centre() if centre and model != "quadratic" else {}
        self.terms = self._terms() + ([()] if self.centre else [])
        widths = [1, self.seeds - 1, *(math.prod(self.codings[at].width for at in term) for term in self.terms)]
        self.columns = [slice(int(end) - width, int(end)) for end, width in zip(np.cumsum(widths), widths, strict=True)]
        self.design = self.matrix(runs)
        self.design[:, self.columns[1]] = contrasts(self.seeds)[self.sets]
        self.fit, self.mean = LeastSquares(self.design), float(values.mean())
        self.rounding = float(ROUNDING * np.abs(values).max())
        self.coefficients = np.zeros(self.design.shape[1])
        self.coefficients[self.fit.kept] = self.fit.coefficients(values - self.mean)
        self.coefficients[0] += self.mean
        self.coefficients[np.abs(self.coefficients) <= self.rounding] = 0.0
        self.residuals = self.unless_rounding(self.fit.residuals(values - self.mean))
        self.residual_freedom = len(values) - len(self.fit.kept)
        self.residual = Squares(self.residual_freedom, float(self.residuals @ self.residuals) if self.residual_freedom else 0.0)
        self.total = Squares(len(values) - 1, float(np.square(values - self.mean).sum()))
        self.error = self.residual.mean if self.residual.sum > 0 else np.nan
        self.leverages = np.minimum(np.square(self.fit.basis).sum(axis=1), 1.0)
        # Columns without those of blocks.
        self.own = [column for column in self.fit.kept if not 1 <= column < self.seeds]

    def unless_rounding(self, residuals: Numbers) -> Numbers:
        """Residuals, or sums with orthonormal weights; 0 where they are nothing but rounding."""
        return np.zeros_like(residuals) if np.linalg.norm(residuals) <= self.rounding * len(residuals) ** 0.5 else residuals

    def _terms(self) -> list[Term]:
        """Terms of the model but the mean, lower orders first and squares last."""
        count, terms, columns = len(self.codings), list[Term](), 1
        squares = [(at, at) for at in range(count) if self.model == "quadratic" and self.study.factors[at].is_number]
        for order in range(1, min({"main": 1, "full": count}.get(self.model, 2), count) + 1):
            more = list(itertools.combinations(range(count), order))
            wider = columns + sum(math.prod(self.codings[at].width for at in term) for term in more)
            # Up to the order at which there are as many coefficients as points.
            if self.model == "full" and order > 1 and (columns >= self.point_count or wider > MOST_COLUMNS):
                break
            terms, columns = terms + more, wider
        if (total := columns + len(squares)) > MOST_COLUMNS:
            advice = f"at most {MOST_COLUMNS} can be estimated: leave out interactions or factors"
            raise NothingToFit(f"the model has {total} coefficients, {advice}")
        return terms + squares

    def _centre(self) -> dict[int, float]:
        """Coded middles of the numbers, if those with more than two values have them at the same points and are at their ends elsewhere."""
        coded = {at: factor.coded(self.runs[factor.name]) for at, factor in enumerate(self.study.factors) if self.is_curved[at]}
        middles = {at: float(values[np.abs(values).argmin()]) for at, values in coded.items()}
        marks = [np.abs(values - middles[at]) < SAME for at, values in coded.items()]
        are_ends = [(np.abs(np.abs(values[~mark]) - 1.0) < SAME).all() for values, mark in zip(coded.values(), marks, strict=True)]
        return middles if all(are_ends) and all((mark == marks[0]).all() for mark in marks) else {}

    def label(self, term: Term) -> str:
        """Label of a term, such as ``load × speed`` or ``load²``."""
        names = [named(self.study.factors[at]) for at in term] or ["centre points"]
        return f"{names[0]}²" if len(term) == 2 and term[0] == term[1] else " × ".join(names)

    def owner(self, column: int) -> int:
        """Index of what a column belongs to: mean (0), blocks (1) or a term (from 2)."""
        return next(at for at, columns in enumerate(self.columns) if columns.start <= column < columns.stop)

    def tells(self, rows: Numbers) -> Numbers:
        """Tells for which rows of the model matrix the runs determine the value: columns that are combinations are the same ones there."""
        told = np.ones(len(rows), bool)
        for column, (parts, weights) in self.fit.relations.items():
            # What is a multiple of the mean, as the square of a number with two values is, does not count; a factor with one value does.
            if parts not in ([], [0]) or self._factor_of(column) is not None:
                size = np.maximum(np.abs(rows).max(axis=1), 1.0)
                told &= np.abs(rows[:, column] - rows[:, self.fit.kept] @ weights) <= CONTRIBUTES * size
        return told

    @property
    def untold(self) -> list[Factor]:
        """Factors of which nothing is told: they have one value, or change with another factor or the seeds."""
        found: set[int | None] = {at for at, coding in enumerate(self.codings) if not coding.width}
        for column, (parts, _) in self.fit.relations.items():
            alike = {self._factor_of(each) for each in (column, *parts)} - {None}
            # Of few points many factors are combinations of each other, and a process tells them nevertheless.
            found |= alike if self._factor_of(column) is not None and len(alike) <= 2 else set()
        return [factor for at, factor in enumerate(self.study.factors) if at in found]

    def _factor_of(self, column: int) -> int | None:
        """Index of the factor alone that a column is of; None of the mean, blocks and other terms."""
        term = ((), (), *self.terms)[self.owner(column)]
        return term[0] if len(term) == 1 else None

    def matrix(self, points: pandas.DataFrame) -> Numbers:
        """Rows of the model matrix, averaged over blocks, at points: a column for each factor, SI units or words."""
        return self.products([coding.numbers(points[coding.factor.name]) for coding in self.codings])

    def averaged(self, places: pandas.DataFrame) -> Numbers:
        """Rows of the model matrix at values of some factors, over all levels of the others and their middles: their contrasts are 0."""
        named = [(one, one.factor.name) for one in self.codings]
        return self.products([one.numbers(places[name]) if name in places else np.zeros((len(places), one.width)) for one, name in named])

    def products(self, numbers: Sequence[Numbers]) -> Numbers:
        """Rows of the model matrix, averaged over blocks, of the numbers of all factors."""
        count = len(numbers[0]) if numbers else len(self.values)
        parts = [np.ones((count, 1)), np.zeros((count, self.seeds - 1))]
        for term in self.terms:
            product = np.ones((count, 1))
            if not term:
                product *= np.all([np.abs(numbers[at] - middle) < SAME for at, middle in self.centre.items()], axis=0)
            for at in term:
                product = (product[:, :, None] * numbers[at][:, None, :]).reshape(count, -1)
            parts.append(product)
        return np.hstack(parts)

    @cached_property
    def within(self) -> Numbers:
        """Responses less the mean of their point."""
        return np.asarray(self.values - pandas.Series(self.values).groupby(self.runs["point"].to_numpy()).transform("mean"))

    @cached_property
    def scatter(self) -> tuple[Squares, Numbers]:
        """Pure error: what runs of a point differ by, but for their blocks, and the part of each run."""
        blocks = pandas.DataFrame(self.design[:, self.columns[1]])
        blocks = blocks - blocks.groupby(self.runs["point"].to_numpy()).transform("mean")
        # What points leave of blocks is nothing but rounding where each point is in one block only.
        fit = LeastSquares(blocks.where(blocks.abs() > 1e-12, 0.0).to_numpy())
        left = self.unless_rounding(fit.residuals(self.within))
        freedom = len(left) - self.point_count - len(fit.kept)
        return Squares(freedom, float(left @ left) if freedom > 0 else 0.0), left

    @cached_property
    def lack_of_fit(self) -> tuple[Squares, Squares, float, float]:
        """Squares by which means of points differ from the model, their error, F and p; NaN where it cannot be tested."""
        pure, left = self.scatter
        # Their difference, not that of the sums: it may be far smaller than either.
        missed, freedom = self.unless_rounding(self.residuals - left), self.residual_freedom - pure.freedom
        squares = Squares(freedom, float(missed @ missed) if freedom > 0 else 0.0)
        return squares, *self.beyond(squares, pure, pandas.get_dummies(self.runs["point"]).to_numpy(float))

    def beyond(self, squares: Squares, residual: Squares, columns: Numbers) -> tuple[Squares, float, float]:
        """Error, F and p of what further columns explain; `residual` is what they leave, the error with one set of seeds.

        With several it is what they differ by between sets, as that of an effect; more for some than for others.
        """
        f, p = f_test(squares, residual)
        if self.seeds < 2 or np.isnan(f):
            return residual, f, p
        weights = LeastSquares(np.column_stack([self.fit.basis, columns])).basis[:, len(self.fit.kept) :].T
        parts, freedoms = self._between(weights, self._leaves - weights.T @ weights)
        return _corrected(squares, parts, freedoms)

    @cached_property
    def _held_out(self) -> Numbers:
        """Mean residual of the fit, and of the fit without the point, by point, and the squares of the latter, added up over its runs."""
        held_out = np.full((self.point_count, 3), np.nan)
        for point in range(self.point_count):
            own = np.flatnonzero(self.runs["point"] == point)
            rows = self.fit.basis[own]
            values, vectors = np.linalg.eigh(np.eye(len(own)) - rows @ rows.T)
            if values.min() >= SOLE:
                missed = vectors @ (vectors.T @ self.residuals[own] / values)
                held_out[point] = self.residuals[own].mean(), missed.mean(), missed @ missed
        return held_out

    @property
    def loo(self) -> Numbers:
        """Leave-one-point-out errors, observed less forecast, on the scale of the fit; NaN of a point that has a coefficient of its own."""
        return self._held_out[:, 1]

    @property
    def explained(self) -> Squares:
        """Squares that the factors explain beside the sets of seeds."""
        blocks = LeastSquares(self.design[:, : self.columns[1].stop])
        left = blocks.residuals(self.values - self.mean)
        return Squares(len(self.fit.kept) - len(blocks.kept), max(float(left @ left) - self.residual.sum, 0.0))

    @property
    def press(self) -> float:
        """Sum of the squares by which runs differ from the fit without their point; NaN if a point has a coefficient of its own."""
        return float(self._held_out[:, 2].sum())

    @property
    def loo_error(self) -> float:
        """Root of the mean square of leave-one-point-out errors, SI; NaN if fewer than three quarters of the points can be left out."""
        if (known := ~np.isnan(self.loo)).mean() < 0.75:
            return np.nan
        mean = pandas.Series(self.values).groupby(self.runs["point"].to_numpy()).mean().to_numpy()[known]
        return float(np.sqrt(np.square(self.response.back(mean) - self.response.back(mean - self.loo[known])).mean()))

    def combined(self, rows: Numbers) -> pandas.DataFrame:
        """``value``, ``standard_error`` and ``freedom`` of linear combinations of the coefficients, with rows as those of `matrix`."""
        variances, freedoms = self.errors(rows[:, self.fit.kept] @ self.fit.root @ self.fit.basis.T)
        return pandas.DataFrame({"value": rows @ self.coefficients, "standard_error": np.sqrt(variances), "freedom": freedoms})

    def errors(self, weights: Numbers) -> tuple[Numbers, Numbers]:
        """Variances of weighted sums (rows of `weights`) of the responses over all seeds, and their degrees of freedom; NaN without an error.

        Variance: what the sum differs by between sets of seeds, of incomplete sets with the right mean if runs scatter alike (R. M. Bell
        and D. F. McCaffrey, Survey Methodology 28, 169-181 (2002)); with one set of seeds that of the residual.
        """
        if self.seeds < 2 or np.isnan(self.error):
            variances = self.error * np.square(weights).sum(axis=1)
            return variances, np.where(np.isnan(variances), np.nan, float(self.residual_freedom))
        parts, freedoms = self._between(weights, self._leaves)
        return np.square(parts).sum(axis=1), freedoms

    @cached_property
    def _leaves(self) -> Numbers:
        """Residual matrix of the mean model of all blocks: what it leaves of the runs."""
        without = self.design.copy()
        without[:, self.columns[1]] = 0.0
        return np.asarray(np.eye(len(self.values)) - without[:, self.fit.kept] @ self.fit.root @ self.fit.basis.T)

    def differs_alike(self, directions: Numbers) -> bool:
        """Tells whether sums with these orthonormal weights scatter alike between sets of seeds, as far as these tell.

        Test: statistic of S. John, Biometrika 58, 123-127 (1971), tr C²/(tr C)² of their covariance C, against that of normal variables.
        """
        if self.seeds < 2 or len(directions) < 2:
            return True
        parts, freedoms = self._between(directions, self._leaves)
        if np.isnan(freedoms).any() or not (parts**2).sum() > 0:
            return True

        def statistic(parts: Numbers) -> Numbers:
            covariance = parts @ parts.swapaxes(-1, -2)
            return np.asarray(np.square(covariance).sum((-2, -1)) / np.trace(covariance, axis1=-2, axis2=-1) ** 2)

        normal = np.random.default_rng(0).standard_normal((999, len(directions), max(round(float(freedoms.mean())), 1)))
        return bool((statistic(normal) >= statistic(parts)).mean() > ALIKE)

    def unlike(self, squares: Squares, directions: Numbers) -> tuple[Squares, float, float]:
        """Error, F and p of what a term of these orthonormal weights explains, where its sums scatter unlike between sets of seeds."""
        return _corrected(squares, *self._between(directions, self._leaves))

    def _between(self, weights: Numbers, leaves: Numbers) -> tuple[Numbers, Numbers]:
        """Parts of sets of seeds in weighted sums of what a model leaves, with squares that add up to variances, and degrees of freedom."""
        left, member = leaves @ (self.values - self.mean), np.eye(self.seeds)[self.sets]
        parts, freedoms = np.full((len(weights), self.seeds), np.nan), np.full(len(weights), np.nan)
        for at, weight in enumerate(weights):
            by_set = (weight[:, None] * member).T
            spread, expected = by_set @ leaves, np.square(by_set).sum(axis=1)
            found = np.square(spread).sum(axis=1)
            scale = np.sqrt(np.divide(expected, found, out=np.zeros_like(found), where=found > DEPENDENT * expected.sum()))
            covariance = scale[:, None] * (spread @ spread.T) * scale
            if np.trace(covariance) > 0:
                own = by_set @ left
                # What differs between sets by rounding alone is the same.
                parts[at] = scale * own if np.linalg.norm(own) > self.rounding * np.abs(weight).sum() else 0.0
                freedoms[at] = np.trace(covariance) ** 2 / np.square(covariance).sum()
        return parts, freedoms

    @cached_property
    def _missed(self) -> tuple[float, float]:
        """Variance by which means of points that were left out differ from the model beyond scatter, and its degrees of freedom."""
        known, pure, freedom = self._held_out[~np.isnan(self.loo)], self.scatter[0], self.point_count - len(self.own)
        if freedom <= 0 or not len(known):
            return (0.0, 1.0) if pure.freedom > 0 else (np.nan, np.nan)
        left = float((known[:, 0] * known[:, 1]).mean())
        if pure.freedom > 0:
            left = max(left - pure.mean * float((1.0 / self.runs["point"].value_counts()).mean()), 0.0)
            # What is beyond scatter: with one or two degrees of freedom the quantile would say more of itself than of that.
            return left, float(max(freedom, LEAST_FREEDOM))
        return max(left, self.residual.mean), float(freedom)

    @cached_property
    def _run_parts(self) -> list[tuple[float, float]]:
        """Parts of the variance of runs of one point with other seeds, with their degrees of freedom; none without replicates.

        First that in which sets of seeds differ as a whole, if there are several.
        """
        pure, count = self.scatter[0], self.seeds - 1
        if pure.freedom < 1 or (all_of_it := float(self.within @ self.within)) <= 0:
            return []
        freedom = pure.freedom + count
        of_sets = [(max(all_of_it - pure.sum, 0.0) / freedom, float(count))] if count else []
        return [*of_sets, (pure.sum / freedom, pure.freedom)]

    @cached_property
    def _run_variance(self) -> tuple[float, float]:
        """Variance of runs of one point with other seeds, and its degrees of freedom; NaN without replicates."""
        total, freedom = _satterthwaite(*self._run_parts or [(np.nan, np.nan)])
        return float(total), float(freedom)

    @cached_property
    def _point_root(self) -> Numbers:
        return np.asarray(np.linalg.pinv(self.matrix(self.runs.drop_duplicates("point"))[:, self.own]))

    def leverage(self, points: pandas.DataFrame) -> Numbers:
        """Leverage of points: variance of the model there in units of that of a point, each point of the study counted once."""
        return np.asarray(np.square(self.matrix(points)[:, self.own] @ self._point_root).sum(axis=1))

    @cached_property
    def most_leverage(self) -> float:
        """The largest leverage of a point of the study; a forecast beyond it is an extrapolation, be it inside all ranges."""
        return float(self.leverage(self.runs).max())

    def variances(self, points: pandas.DataFrame) -> pandas.DataFrame:
        """Means of the model at points (a column for each factor, SI units or words) and their variances, on the scale of the fit.

        ``value``; ``mean`` and ``mean_freedom``, variance of the mean over all seeds and its degrees of freedom; ``run`` and ``run_freedom``,
        those of one more run; ``leverage``. NaN where the runs do not tell the response.
        """
        rows, leverage, pure = self.matrix(points), self.leverage(points), self.scatter[0]
        if self.seeds > 1:
            found = self.combined(rows)
            own = found["standard_error"].to_numpy() ** 2, found["freedom"].to_numpy()
        else:
            share = np.square(rows[:, self.fit.kept] @ self.fit.root).sum(axis=1)
            own = share * (pure.mean if pure.freedom > 0 else 0.0), np.full(len(rows), float(max(pure.freedom, 1)))
        beyond = self._missed[0] * (1.0 + leverage), self._missed[1]
        mean = one = _satterthwaite(own, beyond)
        if self._run_parts:
            # Of what sets differ by (runs, if there is one set) the error of their mean is a part: both are as large or small together.
            (part, part_freedom), *rest = self._run_parts
            shared = np.minimum(own[0], part / self.seeds) if rest else own[0]
            one = _satterthwaite((own[0] - shared, own[1]), (shared + part, part_freedom), *rest, beyond)
        told, names = self.tells(rows), ("mean", "mean_freedom", "run", "run_freedom")
        columns = {name: np.where(told, values, np.nan) for name, values in zip(names, (*mean, *one), strict=True)}
        return pandas.DataFrame({"value": rows @ self.coefficients, **columns, "leverage": leverage}, index=points.index)

    def forecast(self, points: pandas.DataFrame, confidence: float | None = None, apart: Any = 0.0) -> pandas.DataFrame:
        """``value`` with ``mean_low`` and ``mean_high`` of the mean over all seeds, ``run_low`` and ``run_high`` of one more run, SI, and
        ``leverage``; intervals are no narrower than errors at points that were left out support.

        `apart` is the standard deviation of what values may be wrong by besides, on the scale of the fit.
        """
        found = self.variances(points)
        tail = 0.5 + 0.5 * (confidence or self.confidence)
        mean = stats.t.ppf(tail, found["mean_freedom"]) * np.sqrt(found["mean"])
        # With few seeds the mean has fewer degrees of freedom than one run; its interval is no longer for that.
        run = np.maximum(stats.t.ppf(tail, found["run_freedom"]) * np.sqrt(found["run"]), mean)
        mean, run = (np.hypot(reach, stats.norm.ppf(tail) * apart) for reach in (mean, run))
        ends = {"value": 0.0, "mean_low": -mean, "mean_high": mean, "run_low": -run, "run_high": run}
        columns = {name: self.response.back(found["value"] + end) for name, end in ends.items()}
        return pandas.DataFrame({**columns, "leverage": found["leverage"]}, index=points.index)


def _satterthwaite(*parts: tuple[Any, Any]) -> tuple[Numbers, Numbers]:
    """Sum of variances and its degrees of freedom, after F. E. Satterthwaite, Biometrics Bulletin 2, 110-114 (1946)."""
    total = np.asarray(sum(part for part, _ in parts))
    spread = np.asarray(sum(part**2 / freedom for part, freedom in parts))
    return total, np.divide(total**2, spread, out=np.full_like(total, np.nan), where=spread > 0)


def _corrected(squares: Squares, parts: Numbers, freedoms: Numbers) -> tuple[Squares, float, float]:
    """Error, F and p of squares of sums of which each set of seeds has these parts, with these degrees of freedom.

    Unequal differences between sets take degrees of freedom (S. W. Greenhouse and S. Geisser, Psychometrika 24, 95-112 (1959)).
    """
    if not (whole := float(np.square(parts).sum())) > 0:
        return Squares(0.0, 0.0), np.nan, np.nan
    effective = whole**2 / float(np.square(parts.T @ parts).sum())
    freedom = effective * float(freedoms.mean())
    f = squares.mean / (mean := whole / len(parts))
    return Squares(freedom, mean * freedom), f, float(stats.f.sf(f, effective, freedom))


def f_test(squares: Squares, error: Squares) -> tuple[float, float]:
    """F and p of a mean square against another one; NaN where there is none."""
    if not (squares.freedom > 0 and error.freedom > 0 and error.mean > 0):
        return np.nan, np.nan
    return squares.mean / error.mean, float(stats.f.sf(squares.mean / error.mean, squares.freedom, error.freedom))
