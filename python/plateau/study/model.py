"""Models of responses: terms of the factors, fitted by least squares, and what they forecast."""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import pandas
from scipy import stats

from plateau.errors import InputError
from plateau.study.results import Factor, Numbers, Response, Study

# Factors of a term, by index, in ascending order; a square names its factor twice, and the term of centre points has none.
Term = tuple[int, ...]

MODELS = {
    "main": "main effects",
    "interactions": "main effects and interactions of two factors",
    "full": "main effects and interactions of all orders",
    "quadratic": "main effects, interactions of two factors and squares",
}
# A column depends on others if no more of it than this is left, relative to its length.
DEPENDENT = 1e-8
# A column takes part in a combination if it contributes more than this, relative to the length of the result.
CONTRIBUTES = 1e-6
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


class NothingToFit(InputError):
    """The runs tell nothing of this response."""


@dataclass(frozen=True)
class Coding:
    """How the values of a factor become numbers: coded units, or contrasts between the levels that were observed.

    Contrasts sum to zero: the first level has -1 in all of them, each other one 1 in one of its own.
    """

    factor: Factor
    classes: tuple[object, ...] | None

    @classmethod
    def of(cls, factor: Factor, observed: pandas.Series, model: str) -> "Coding":
        """Codes a factor as a model needs it."""
        if len(set(factor.levels)) < 2:
            raise NothingToFit(f"factor `{factor.name}`: at least two different levels are needed")
        if factor.is_range or model == "quadratic" and factor.is_number:
            return cls(factor, None)
        found = set(observed)
        levels = [level for level in dict.fromkeys(factor.levels) if level in found]
        return cls(factor, tuple(sorted(levels) if factor.is_number else levels))

    @property
    def width(self) -> int:
        """Number of columns."""
        return 1 if self.classes is None else len(self.classes) - 1

    def numbers(self, values: pandas.Series) -> Numbers:
        """Columns for values."""
        if self.classes is None or len(self.factor.levels) == 2 and len(self.classes) == 2 and self.factor.is_number:
            # Between two levels that are numbers the model is straight.
            return self.factor.coded(values.to_numpy(float))[:, None]
        place = pandas.Index(self.classes).get_indexer(pandas.Index(values))
        if self.factor.is_number:
            near = np.isclose(values.to_numpy(float)[:, None], np.array(self.classes, float), rtol=1e-9, atol=0.0)
            place = np.where(near.any(axis=1), near.argmax(axis=1), -1)
        if (place < 0).any():
            value = values.iloc[int(np.argmax(place < 0))]
            raise InputError(
                f"factor `{self.factor.name}` has no observation at {self.factor.text(value)}; "
                f"there are {', '.join(self.factor.text(level) for level in self.classes)}"
            )
        return np.vstack([-np.ones(self.width), np.eye(self.width)])[place]


def named(factor: Factor) -> str:
    """Name of a factor as a model has it."""
    return f"log₁₀ {factor.name}" if factor.logarithmic else factor.name


def terms_of(model: str, widths: Sequence[int], is_number: Sequence[bool], points: int) -> list[Term]:
    """Terms of a model but the mean, lower orders first and squares last."""
    count = len(widths)
    columns = [1] + [0] * count
    for width in widths:
        for order in range(count, 0, -1):
            columns[order] += width * columns[order - 1]
    order = {"main": 1, "full": count}.get(model, 2)
    if model == "full":
        # Up to the order at which there are as many coefficients as points.
        for more in range(2, count + 1):
            if sum(columns[:more]) >= points or sum(columns[: more + 1]) > MOST_COLUMNS:
                order = more - 1
                break
    order = min(order, count)
    squares = [(at, at) for at in range(count) if model == "quadratic" and is_number[at]]
    if (total := sum(columns[: order + 1]) + len(squares)) > MOST_COLUMNS:
        raise NothingToFit(
            f"the model has {total} coefficients, at most {MOST_COLUMNS} can be estimated: leave out interactions or factors"
        )
    return [term for size in range(1, order + 1) for term in itertools.combinations(range(count), size)] + squares


@dataclass(frozen=True)
class LeastSquares:
    """Least squares with columns that may depend on each other: of such columns the first keep their coefficients.

    Attributes
    ----------
    kept : list of int
        Columns that have a coefficient.
    relations : dict
        For each other column the kept columns that it is a combination of, and how many of each kept column there are in it.
    root : numpy.ndarray
        Times its transpose it is the covariance of the kept coefficients in units of the error's variance.
    basis : numpy.ndarray
        Orthogonal basis of the kept columns, a row for each observation.
    """

    kept: list[int]
    relations: dict[int, tuple[list[int], Numbers]]
    root: Numbers
    basis: Numbers

    @classmethod
    def of(cls, matrix: Numbers) -> "LeastSquares":
        """Prepares the fit to a model matrix."""
        kept: list[int] = []
        basis = np.zeros((len(matrix), 0))
        for column, values in enumerate(matrix.T):
            # Twice, so that rounding leaves nothing along the basis.
            rest = values - basis @ (basis.T @ values)
            rest = rest - basis @ (basis.T @ rest)
            if len(kept) < len(matrix) and np.linalg.norm(rest) > DEPENDENT * np.linalg.norm(values):
                kept.append(column)
                basis = np.column_stack([basis, rest / np.linalg.norm(rest)])
        root = np.asarray(np.linalg.inv(basis.T @ matrix[:, kept]), float)
        lengths = np.linalg.norm(matrix, axis=0)
        relations = {}
        for column in sorted(set(range(matrix.shape[1])) - set(kept)):
            weights = root @ (basis.T @ matrix[:, column])
            parts = np.abs(weights) * lengths[kept] > CONTRIBUTES * lengths[column]
            relations[column] = ([kept[at] for at in np.flatnonzero(parts)], weights)
        return cls(kept, relations, root, basis)

    def coefficients(self, values: Numbers) -> Numbers:
        """Coefficients of the kept columns."""
        return np.asarray(self.root @ (self.basis.T @ values))

    def residuals(self, values: Numbers) -> Numbers:
        """What the fit leaves."""
        left = values - self.basis @ (self.basis.T @ values)
        return np.asarray(left - self.basis @ (self.basis.T @ left))

    def tells(self, rows: Numbers) -> Numbers:
        """Whether the runs tell the value for rows of the model matrix: whether columns that are combinations are the same ones there."""
        told = np.ones(len(rows), bool)
        for column, (parts, weights) in self.relations.items():
            # What is a multiple of the mean, as the square of a number with two values is, does not count.
            if parts not in ([], [0]):
                size = np.maximum(np.abs(rows).max(axis=1), 1.0)
                told &= np.abs(rows[:, column] - rows[:, self.kept] @ weights) <= CONTRIBUTES * size
        return told


@dataclass(frozen=True)
class Squares:
    """A sum of squares with its degrees of freedom."""

    freedom: int
    sum: float

    @property
    def mean(self) -> float:
        """The mean square; NaN without degrees of freedom."""
        return self.sum / self.freedom if self.freedom > 0 else np.nan


@dataclass(frozen=True, repr=False)
class Fitted:
    """A model that was fitted to a response on its scale.

    Attributes
    ----------
    study : Study
    response : Response
    model : str
        ``"main"``, ``"interactions"``, ``"full"`` or ``"quadratic"``.
    reason : str
        Why it is that one; empty where there is nothing to say.
    terms : list of tuple of int
        Factors of each term, by index; a square names its factor twice.
    codings : list of Coding
        How each factor becomes numbers.
    runs : pandas.DataFrame
        The runs that were fitted, each once: factors, ``replicate`` and ``point``, numbered by equal settings, from 0.
    values : numpy.ndarray
        Their responses on the scale of the fit.
    missing, repeated : int
        Runs without a response, and those that repeat another one.
    confidence : float
    centre : dict
        Factors of the term of centre points and where they are there, coded; empty without that term.
    chosen : bool
        Whether terms were chosen by AICc.
    left_out : list of tuple of int
        Terms that the choice by AICc left out.
    aicc, aicc_of_all : float
        Criterion of the terms that were kept, and of all; NaN where none was chosen.
    """

    study: Study
    response: Response
    model: str
    reason: str
    terms: list[Term]
    codings: list[Coding]
    runs: pandas.DataFrame
    values: Numbers
    missing: int
    repeated: int
    confidence: float = 0.95
    centre: dict[int, float] = field(default_factory=dict)
    chosen: bool = False
    left_out: list[Term] = field(default_factory=list)
    aicc: float = np.nan
    aicc_of_all: float = np.nan

    def label(self, term: Term) -> str:
        """Label of a term, such as ``load × speed`` or ``load²``."""
        if not term:
            return "centre points"
        names = [named(self.study.factors[at]) for at in term]
        return f"{names[0]}²" if len(term) == 2 and term[0] == term[1] else " × ".join(names)

    @cached_property
    def seeds(self) -> int:
        """Number of sets of seeds."""
        return int(self.runs["replicate"].nunique())

    @cached_property
    def widths(self) -> list[int]:
        """Number of columns of the mean, of the blocks (0 without) and of each term."""
        return [1, self.seeds - 1, *(int(np.prod([self.codings[at].width for at in term])) for term in self.terms)]

    @cached_property
    def columns(self) -> list[slice]:
        """Columns of mean, blocks and terms in the design."""
        ends = np.cumsum([0, *self.widths])
        return [slice(int(start), int(end)) for start, end in itertools.pairwise(ends)]

    def matrix(self, points: pandas.DataFrame) -> Numbers:
        """Rows of the model matrix at points, averaged over blocks.

        Parameters
        ----------
        points : pandas.DataFrame
            A column for each factor, SI units or words.

        Returns
        -------
        numpy.ndarray
        """
        return self.products([coding.numbers(points[coding.factor.name]) for coding in self.codings])

    def products(self, numbers: Sequence[Numbers]) -> Numbers:
        """Rows of the model matrix of the numbers of all factors, averaged over blocks."""
        count = len(numbers[0]) if numbers else 0
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
    def design(self) -> Numbers:
        """The model matrix of the runs, with blocks."""
        matrix = self.matrix(self.runs)
        block = np.unique(self.runs["replicate"], return_inverse=True)[1]
        matrix[:, 1 : self.seeds] = np.vstack([-np.ones(self.seeds - 1), np.eye(self.seeds - 1)])[block]
        return matrix

    @cached_property
    def fit(self) -> LeastSquares:
        """The fit with blocks."""
        return LeastSquares.of(self.design)

    @cached_property
    def mean(self) -> float:
        """Mean of the responses, on the scale of the fit."""
        return float(self.values.mean())

    @cached_property
    def coefficients(self) -> Numbers:
        """Coefficients of all columns; 0 where others have the estimate."""
        coefficients = np.zeros(self.design.shape[1])
        coefficients[self.fit.kept] = self.fit.coefficients(self.values - self.mean)
        coefficients[0] += self.mean
        return coefficients

    @cached_property
    def rounding(self) -> float:
        """Size below which residuals are rounding."""
        return float(ROUNDING * np.abs(self.values).max())

    @cached_property
    def residuals(self) -> Numbers:
        """What the model leaves of each run; zero if that is rounding."""
        left = self.fit.residuals(self.values - self.mean)
        return np.zeros_like(left) if self.is_rounding(left) else left

    def is_rounding(self, residuals: Numbers) -> bool:
        """Whether residuals are nothing but rounding."""
        return bool(np.linalg.norm(residuals) <= self.rounding * np.sqrt(len(residuals)))

    def squares(self, residuals: Numbers, freedom: int) -> Squares:
        """Sum of squares of residuals; 0 if they are rounding."""
        return Squares(freedom, 0.0 if freedom <= 0 or self.is_rounding(residuals) else float(residuals @ residuals))

    @property
    def residual_freedom(self) -> int:
        """Degrees of freedom that the model leaves."""
        return len(self.values) - len(self.fit.kept)

    @cached_property
    def residual(self) -> Squares:
        """What the model leaves."""
        return self.squares(self.residuals, self.residual_freedom)

    @cached_property
    def total(self) -> Squares:
        """Deviations from the mean."""
        return Squares(len(self.values) - 1, float(np.square(self.values - self.mean).sum()))

    @cached_property
    def error(self) -> float:
        """Mean square of the residual; NaN where nothing, or nothing but rounding, is left."""
        return self.residual.mean if self.residual.sum > 0 else np.nan

    @cached_property
    def point_count(self) -> int:
        """Number of different points."""
        return int(self.runs["point"].max()) + 1

    @cached_property
    def scatter(self) -> tuple[Squares, Numbers]:
        """Pure error: what runs of a point differ by, but for their blocks, and the part of each run."""
        columns = np.column_stack([np.eye(self.point_count)[self.runs["point"]], self.design[:, 1 : self.seeds]])
        fit = LeastSquares.of(columns)
        left = fit.residuals(self.values - self.mean)
        return self.squares(left, len(self.values) - len(fit.kept)), left

    @cached_property
    def lack_of_fit(self) -> Squares:
        """What means of points differ by from the model."""
        pure, left = self.scatter
        # Their difference, not that of the sums: it may be far smaller than either.
        return self.squares(self.residuals - left, self.residual_freedom - pure.freedom)

    @cached_property
    def lack_of_fit_test(self) -> tuple[float, float]:
        """F and p of the lack of fit against the pure error; NaN where it cannot be tested."""
        return f_test(self.lack_of_fit, self.scatter[0])

    @cached_property
    def leverages(self) -> Numbers:
        """How much each run determines its own fitted value, 0 to 1."""
        return np.asarray(np.minimum(np.square(self.fit.basis).sum(axis=1), 1.0))

    @cached_property
    def _held_out(self) -> Numbers:
        """By point, the mean residual of the fit and of the fit without the point."""
        held_out = np.full((self.point_count, 2), np.nan)
        for point in range(self.point_count):
            own = np.flatnonzero(self.runs["point"] == point)
            rows = self.fit.basis[own]
            values, vectors = np.linalg.eigh(np.eye(len(own)) - rows @ rows.T)
            if values.min() >= SOLE:
                missed = vectors @ (vectors.T @ self.residuals[own] / values)
                held_out[point] = self.residuals[own].mean(), missed.mean()
        return held_out

    @property
    def loo(self) -> Numbers:
        """Leave-one-point-out errors, observed less forecast, on the scale of the fit; NaN of a point that has a coefficient of its own."""
        return self._held_out[:, 1]

    @property
    def loo_error(self) -> float:
        """Root of the mean square of leave-one-point-out errors, SI; NaN if fewer than three quarters of the points can be left out."""
        known = ~np.isnan(self.loo)
        if known.mean() < 0.75:
            return np.nan
        mean = pandas.Series(self.values).groupby(self.runs["point"].to_numpy()).mean().to_numpy()[known]
        return float(np.sqrt(np.square(self.response.back(mean) - self.response.back(mean - self.loo[known])).mean()))

    # Error from seeds --------------------------------------------------------------------------------------------------------

    def combined(self, rows: Numbers) -> pandas.DataFrame:
        """Linear combinations of the coefficients, with their errors over all seeds.

        With several sets of seeds the error is what the combination differs by between them. If all sets have the same points this
        is the error of the mean of one estimate for each set, with a degree of freedom less than there are sets; else sums of the
        sets are weighted as in R. M. Bell and D. F. McCaffrey, Survey Methodology 28, 169-181 (2002). Without sets of seeds it is
        the residual.

        Parameters
        ----------
        rows : numpy.ndarray
            A row for each combination, as those of `matrix`.

        Returns
        -------
        pandas.DataFrame
            ``value``, ``standard_error`` and ``freedom``, NaN without an error.
        """
        fit = self.fit
        variances, freedoms = self.errors(rows[:, fit.kept] @ fit.root @ fit.basis.T)
        return pandas.DataFrame({"value": rows @ self.coefficients, "standard_error": np.sqrt(variances), "freedom": freedoms})

    def errors(self, weights: Numbers) -> tuple[Numbers, Numbers]:
        """Variances of weighted sums of the responses, and their degrees of freedom, as in `combined`.

        Parameters
        ----------
        weights : numpy.ndarray
            A row for each sum, a column for each run.

        Returns
        -------
        tuple of numpy.ndarray
        """
        if self.seeds < 2 or np.isnan(self.error):
            variances = self.error * (weights**2).sum(axis=1)
            return variances, np.where(np.isnan(variances), np.nan, float(self.residual_freedom))
        # Deviations of runs from the mean model of all blocks.
        without = self.design.copy()
        without[:, 1 : self.seeds] = 0.0
        leaves = np.eye(len(self.values)) - without[:, self.fit.kept] @ self.fit.root @ self.fit.basis.T
        left = leaves @ (self.values - self.mean)
        member = np.eye(self.seeds)[np.unique(self.runs["replicate"], return_inverse=True)[1]]
        variances, freedoms = np.full(len(weights), np.nan), np.full(len(weights), np.nan)
        for at, weight in enumerate(weights):
            by_set = (weight[:, None] * member).T
            # What each set tells of the sum, scaled so that its square has the right mean if all runs scatter alike.
            spread, expected = by_set @ leaves, (by_set**2).sum(axis=1)
            found = (spread**2).sum(axis=1)
            scale = np.sqrt(np.divide(expected, found, out=np.zeros_like(found), where=found > DEPENDENT * expected.sum()))
            covariance = scale[:, None] * (spread @ spread.T) * scale
            if np.trace(covariance) > 0:
                variances[at] = float(((scale * (by_set @ left)) ** 2).sum())
                freedoms[at] = np.trace(covariance) ** 2 / (covariance**2).sum()
        return variances, freedoms

    # Forecasts ---------------------------------------------------------------------------------------------------------------

    @cached_property
    def _missed(self) -> tuple[float, float]:
        """Variance by which the mean response of a point differs from the model beyond scatter, and its degrees of freedom.

        It is that which errors at points that were left out support. Without replicates scatter is not known: all of it is taken
        to be missed.
        """
        known = self._held_out[~np.isnan(self.loo)]
        pure = self.scatter[0]
        terms = len(self.fit.kept) - sum(column < self.seeds for column in self.fit.kept[1:])
        freedom = self.point_count - terms
        if freedom <= 0 or not len(known):
            return (0.0, 1.0) if pure.freedom > 0 else (np.nan, np.nan)
        runs = self.runs["point"].value_counts()
        left = float((known[:, 0] * known[:, 1]).mean())
        if pure.freedom > 0:
            left = max(left - pure.mean * float((1.0 / runs).mean()), 0.0)
        else:
            left = max(left, self.residual.mean)
        # With one or two degrees of freedom the quantile would say more of itself than of the errors; `cautions` tells of few points.
        return left, float(max(freedom, LEAST_FREEDOM))

    @cached_property
    def _point_root(self) -> Numbers:
        """Root of the covariance of coefficients if each point were run once, in units of the error's variance."""
        first = self.runs.drop_duplicates("point")
        rows = self.matrix(first)[:, self._kept]
        return np.asarray(np.linalg.pinv(rows))

    @property
    def _kept(self) -> list[int]:
        return [column for column in self.fit.kept if not 1 <= column < self.seeds]

    def leverage(self, points: pandas.DataFrame) -> Numbers:
        """Leverage of points: variance of the model there in units of that of a point, each point of the study counted once."""
        return np.asarray(((self.matrix(points)[:, self._kept] @ self._point_root) ** 2).sum(axis=1))

    @cached_property
    def most_leverage(self) -> float:
        """The largest leverage of a point of the study; a forecast beyond it is an extrapolation."""
        return float(self.leverage(self.runs).max())

    @cached_property
    def _run_variance(self) -> tuple[float, float]:
        """Variance of runs of one point with other seeds, and its degrees of freedom; NaN without replicates."""
        pure = self.scatter[0]
        if pure.freedom < 1:
            return np.nan, np.nan
        if self.seeds < 2:
            return pure.mean, float(pure.freedom)
        within = self.values - pandas.Series(self.values).groupby(self.runs["point"].to_numpy()).transform("mean").to_numpy()
        blocks = max(float(within @ within) - pure.sum, 0.0)
        count = self.seeds - 1
        variance = float(within @ within) / (pure.freedom + count)
        parts = (blocks / count) ** 2 * count + pure.mean**2 * pure.freedom
        return variance, float((blocks + pure.sum) ** 2 / parts) if parts > 0 else np.nan

    def variances(self, points: pandas.DataFrame) -> pandas.DataFrame:
        """Means of the model at points and their variances, on the scale of the fit.

        Parameters
        ----------
        points : pandas.DataFrame
            A column for each factor, SI units or words.

        Returns
        -------
        pandas.DataFrame
            ``value``; ``mean`` and ``mean_freedom``, variance of the mean over all seeds and its degrees of freedom; ``run`` and
            ``run_freedom``, those of one more run; ``leverage``. NaN where the runs do not tell the response.
        """
        rows = self.matrix(points)
        leverage, pure = self.leverage(points), self.scatter[0]
        found = self.combined(rows)
        if self.seeds < 2:
            share = (rows[:, self.fit.kept] @ self.fit.root) ** 2
            known = pure.freedom > 0
            found["standard_error"] = np.sqrt(pure.mean * share.sum(axis=1)) if known else 0.0
            found["freedom"] = float(max(pure.freedom, 1))
        missed, missed_freedom = self._missed
        run, run_freedom = self._run_variance
        own = found["standard_error"].to_numpy() ** 2, found["freedom"].to_numpy()
        parts: list[tuple[Numbers, Numbers | float]] = [own, (missed * (1.0 + leverage), missed_freedom)]
        mean, mean_freedom = _satterthwaite(parts)
        one, one_freedom = (mean, mean_freedom) if np.isnan(run) else _satterthwaite([*parts, (run * np.ones(len(rows)), run_freedom)])
        told = self.fit.tells(rows)
        columns = {"mean": mean, "mean_freedom": mean_freedom, "run": one, "run_freedom": one_freedom}
        columns = {name: np.where(told, values, np.nan) for name, values in columns.items()}
        return pandas.DataFrame({"value": found["value"].to_numpy(), **columns, "leverage": leverage}, index=points.index)

    def forecast(self, points: pandas.DataFrame, confidence: float | None = None) -> pandas.DataFrame:
        """Forecasts with intervals, no narrower than errors at points that were left out support.

        Parameters
        ----------
        points : pandas.DataFrame
            A column for each factor, SI units or words.
        confidence : float, optional
            That of the fit unless given.

        Returns
        -------
        pandas.DataFrame
            ``value``, ``mean_low``, ``mean_high`` of the mean over all seeds, ``run_low``, ``run_high`` of one more run, in SI units, and
            ``leverage``.
        """
        found = self.variances(points)
        tail = 0.5 + 0.5 * (confidence or self.confidence)
        mean = stats.t.ppf(tail, found["mean_freedom"]) * np.sqrt(found["mean"])
        # With few seeds the mean has fewer degrees of freedom than one run; its interval is no longer for that.
        run = np.maximum(stats.t.ppf(tail, found["run_freedom"]) * np.sqrt(found["run"]), mean)
        ends = {"mean_low": -mean, "mean_high": mean, "run_low": -run, "run_high": run}
        columns = {name: self.response.back(found["value"] + end) for name, end in ends.items()}
        value = self.response.back(found["value"])
        return pandas.DataFrame({"value": value, **columns, "leverage": found["leverage"]}, index=points.index)

    @cached_property
    def cautions(self) -> list[str]:
        """What is to be known before the model is believed."""
        return cautions(self)


def _satterthwaite(parts: Sequence[tuple[Numbers, Numbers | float]]) -> tuple[Numbers, Numbers]:
    """Sum of variances and its degrees of freedom, after F. E. Satterthwaite, Biometrics Bulletin 2, 110-114 (1946)."""
    total = np.sum([np.asarray(part, float) for part, _ in parts], axis=0)
    spread = np.sum([np.asarray(part, float) ** 2 / freedom for part, freedom in parts], axis=0)
    with np.errstate(invalid="ignore", divide="ignore"):
        return total, np.where(spread > 0, total**2 / spread, np.nan)


def f_test(squares: Squares, error: Squares) -> tuple[float, float]:
    """F and p of a mean square against another one; NaN where there is none."""
    if not (squares.freedom > 0 and error.freedom > 0 and error.mean > 0):
        return np.nan, np.nan
    f = squares.mean / error.mean
    return f, float(stats.f.sf(f, squares.freedom, error.freedom))


# Choice of the model ---------------------------------------------------------------------------------------------------------------


def fitted(
    study: Study, response: Response, model: str | None = None, terms: str = "all", confidence: float = 0.95, centre: bool = False
) -> Fitted:
    """Fits a model to a response.

    Parameters
    ----------
    study : Study
    response : Response
        One of the study.
    model : str, optional
        ``"main"``, ``"interactions"``, ``"full"`` or ``"quadratic"``; one that the design allows unless given.
    terms : str
        ``"all"`` of the model, or ``"aicc"``: those with the least AICc.
    confidence : float
        Confidence level, between 0 and 1.
    centre : bool
        Whether centre points have a term of their own where their squares cannot be told apart (Minitab's Ct Pt).

    Returns
    -------
    Fitted

    Raises
    ------
    NothingToFit
        If the response has no values, or the same one in all runs.
    InputError
        If a value is beyond the domain of the transform, or an argument is wrong.
    """
    if not 0.0 < confidence < 1.0:
        raise InputError(f"confidence level {confidence}: it lies between 0 and 1, such as 0.95")
    if model is not None and model not in MODELS:
        raise InputError(f"model {model!r}: expected one of {', '.join(MODELS)}")
    if terms not in ("all", "aicc"):
        raise InputError(f"terms {terms!r}: expected all or aicc")
    if model is None:
        model, reason = _choice(study, response)
    else:
        reason = "as asked for"
    whole = _whole(study, response, model, reason, confidence, centre)
    return _selected(whole) if terms == "aicc" else whole


def _whole(study: Study, response: Response, model: str, reason: str, confidence: float, centre: bool = False) -> Fitted:
    """The fit with all terms of a model."""
    runs = study.runs
    # What was measured elsewhere was measured for each run by itself.
    own = np.ones(len(runs), bool) if not response.series else ~runs["same_as"].duplicated().to_numpy()
    values = response.scaled(runs[response.name])
    beyond = np.isfinite(runs[response.name].to_numpy(float)) & ~np.isfinite(values)
    if beyond.any():
        at = int(np.argmax(beyond))
        takes = {"log": "more than 0", "square root": "of at least 0", "logit": "more than 0 and less than 1"}[response.transform]
        raise InputError(
            f'response "{response.name}": run {runs.index[at]} has the response {runs[response.name].iloc[at]:.6g} {response.unit}, and '
            f'transform = "{response.transform}" takes values {takes}: leave the transform out, or ask for another response'
        )
    has = own & np.isfinite(values)
    missing, repeated = int((own & ~has).sum()), int((~own).sum())
    values = values[has]
    if not len(values):
        raise NothingToFit(f"fewer than two runs have a value of it ({missing} have none)")
    if np.abs(values).max() > 1e150:
        raise NothingToFit(f"the response {np.abs(values).max():e} is beyond ±1e150")
    if np.ptp(values) <= max(ROUNDING * np.abs(values).max(), 1e-150):
        raise NothingToFit(f"the response is {float(values[0])!r} in all {len(values)} observations: no factor has an effect on it")
    kept = runs.loc[has, ["replicate", *(factor.name for factor in study.factors)]].copy()
    codings = [Coding.of(factor, kept[factor.name], model) for factor in study.factors]
    keys = [_keys(factor, kept[factor.name]) for factor in study.factors]
    kept["point"] = np.unique(np.column_stack(keys), axis=0, return_inverse=True)[1].reshape(-1)
    widths, numbers = [coding.width for coding in codings], [factor.is_number for factor in study.factors]
    terms = terms_of(model, widths, numbers, int(kept["point"].max()) + 1)
    fit = Fitted(study, response, model, reason, terms, codings, kept, values, missing, repeated, confidence)
    if centre and model != "quadratic" and (middle := _centre(fit)):
        return replace(fit, terms=[*terms, ()], centre=middle)
    return fit


def _centre(fit: Fitted) -> dict[int, float]:
    """Coded middles of the numbers, if those with more than two values have them at the same points and are at their ends elsewhere."""
    curved = [at for at in range(len(fit.codings)) if is_curved(fit, at)]
    coded = {at: fit.codings[at].factor.coded(fit.runs[fit.codings[at].factor.name]) for at in curved}
    middles = {at: float(values[np.abs(values).argmin()]) for at, values in coded.items()}
    marks = [np.abs(values - middles[at]) < SAME for at, values in coded.items()]
    at_ends = all((np.abs(np.abs(coded[at][~mark]) - 1.0) < SAME).all() for at, mark in zip(coded, marks, strict=True))
    return middles if curved and at_ends and all((mark == marks[0]).all() for mark in marks) else {}


def _keys(factor: Factor, values: pandas.Series) -> Numbers:
    """Numbers that tell one setting from another; values that differ by rounding are the same."""
    if factor.is_number:
        return np.asarray(np.round(factor.coded(values) * 1e9))
    return np.asarray(pandas.Index(factor.levels).get_indexer(pandas.Index(values)), float)


def is_curved(fit: Fitted, at: int) -> bool:
    """Whether a factor is a number of the model and was observed at more than two values."""
    factor = fit.study.factors[at]
    return fit.codings[at].classes is None and len(np.unique(_keys(factor, fit.runs[factor.name]))) > 2


def _choice(study: Study, response: Response) -> tuple[str, str]:
    """The model that is fitted unless another one is asked for, and why."""
    if study.design in ("central-composite", "box-behnken"):
        return "quadratic", ""
    if study.design == "plackett-burman":
        return "main", "a Plackett-Burman design mixes interactions with main effects"
    if study.design in ("full-factorial", "fractional-factorial"):
        if any(factor.is_number and not factor.is_range and len(factor.levels) > 2 for factor in study.factors):
            return "interactions", "no squares: levels are compared one by one, which shows curves, too"
        if any(factor.is_range and study.runs[factor.name].nunique() > 2 for factor in study.factors):
            return "interactions", "no squares: centre points tell of a curve, and not in which factor"
        return "interactions", "no squares: no factor that is a number has more than two values"
    problem = no_squares(_whole(study, response, "quadratic", "", 0.95))
    return ("interactions", f"no squares: {problem}") if problem else ("quadratic", "")


def no_squares(fit: Fitted) -> str | None:
    """Why the runs do not allow a quadratic model; None if they do."""
    curved = [is_curved(fit, at) for at in range(len(fit.codings))]
    if not any(curved):
        return "no factor that is a number has more than two values"
    # Squares of numbers with two values are part of the mean.
    straight = [len(term) == 2 and term[0] == term[1] and not curved[term[0]] for term in fit.terms]
    coefficients = 1 + sum(width for width, is_straight in zip(fit.widths[2:], straight, strict=True) if not is_straight)
    if coefficients > fit.point_count:
        return f"{fit.point_count} different points are too few for {coefficients} coefficients"
    if coefficients + fit.seeds - 1 + LEAST_FREEDOM > len(fit.values):
        return f"{len(fit.values)} runs are too few for {coefficients + fit.seeds - 1} coefficients and an error"
    of_straight = {fit.columns[at + 2].start for at, is_straight in enumerate(straight) if is_straight}
    owners = [owner(fit, column) for column in fit.fit.relations if column not in of_straight]
    aliased = list(dict.fromkeys(fit.label(fit.terms[at - 2]) if at > 1 else "replicate" for at in owners))
    return f"the runs cannot tell {', '.join(aliased)} from other terms" if aliased else None


def owner(fit: Fitted, column: int) -> int:
    """Which of mean (0), blocks (1) and terms (from 2) a column is of."""
    return next(at for at, columns in enumerate(fit.columns) if columns.start <= column < columns.stop)


def _selected(whole: Fitted) -> Fitted:
    """The fit with the terms that have the least AICc. Terms come and go one at a time; one stays while it is a part of another one.

    C. M. Hurvich and C.-L. Tsai, Biometrika 76, 297-307 (1989).
    """
    values, count = whole.values - whole.mean, len(whole.values)

    def criterion(kept: frozenset[int]) -> float:
        columns = [column for at in (0, 1, *(term + 2 for term in sorted(kept))) for column in range(count_columns)[whole.columns[at]]]
        fit = LeastSquares.of(whole.design[:, columns])
        left, k = fit.residuals(values), len(fit.kept) + 1
        if count - k - 1 <= 0:
            return np.inf
        squares = max(float(left @ left), count * whole.rounding**2)
        return float(count * np.log(squares / count) + 2 * k + 2 * k * (k + 1) / (count - k - 1))

    def is_part(one: int, other: int) -> bool:
        part, rest = whole.terms[one], whole.terms[other]
        return 0 < len(part) < len(rest) and set(part) <= set(rest)

    def may_change(kept: frozenset[int], term: int) -> bool:
        others = [other for other in range(len(whole.terms)) if other != term]
        if term in kept:
            return not any(other in kept and is_part(term, other) for other in others)
        return all(other in kept or not is_part(other, term) for other in others)

    def improved(kept: frozenset[int]) -> tuple[float, frozenset[int]]:
        least = criterion(kept)
        while changes := [kept ^ {term} for term in range(len(whole.terms)) if may_change(kept, term)]:
            value, best = min(((criterion(change), change) for change in changes), key=lambda found: found[0])
            if not (value < least - 1e-9 or value == least == np.inf and len(best) < len(kept)):
                break
            least, kept = value, best
        return least, kept

    count_columns = whole.design.shape[1]
    own = {owner(whole, column) - 2 for column in whole.fit.kept}
    everything = frozenset(term for term in own if term >= 0)
    aicc, kept = min((improved(everything), improved(frozenset())), key=lambda found: found[0])
    left_out = [term for at, term in enumerate(whole.terms) if at not in kept]
    of_all = criterion(everything)
    return replace(whole, terms=[whole.terms[at] for at in sorted(kept)], chosen=True, left_out=left_out, aicc=aicc, aicc_of_all=of_all)


# What a model misses ---------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Misfit:
    """A significant lack of fit: its test, whether replicates tell it, and the model to try, with its share."""

    f: float
    p: float
    by_replicates: bool
    model: str | None
    r_squared: float


def misfit(fit: Fitted) -> Misfit | None:
    """Finds what a model misses, if that is significant at the confidence level.

    Replicates tell it, or a model that has all terms of this one and more: with several such models the level is divided by their
    number, after Bonferroni.
    """
    if np.isnan(fit.error):
        return None
    own, level = fit.residual, 1.0 - fit.confidence
    others = [other for model in ("main", "interactions", "quadratic", "full") if (other := _other(fit, model)) is not None]

    def share(other: Fitted) -> float:
        return 1.0 - other.residual.sum / other.total.sum

    f, p = fit.lack_of_fit_test
    if p < level:
        better = [other for other in others if other.residual.mean < own.mean and other.residual.sum < own.sum]
        best = min(better, key=lambda other: other.residual.mean, default=None)
        return Misfit(f, p, True, best.model if best else None, share(best) if best else np.nan)
    larger = [other for other in others if other.residual_freedom < own.freedom and _contains(other, fit)]
    tested = []
    for other in larger:
        added = Squares(own.freedom - other.residual_freedom, max(own.sum - other.residual.sum, 0.0))
        f, p = f_test(added, other.residual) if other.residual.sum > 0 else (np.inf, 0.0)
        if p < level / len(larger):
            tested.append((other.residual.mean, f, p, other))
    if not tested or fit.chosen:
        # That terms which were left out explain something is no news.
        return None
    _, f, p, best = min(tested, key=lambda found: found[0])
    return Misfit(f, p, False, best.model, share(best))


def _other(fit: Fitted, model: str) -> Fitted | None:
    """Another model of the same response; None if it cannot be fitted or leaves no error."""
    if model == fit.model:
        return None
    try:
        other = _whole(fit.study, fit.response, model, "", fit.confidence, () in fit.terms)
    except InputError:
        return None
    if sum(other.widths) > 300 or other.residual_freedom <= 0 or model == "quadratic" and no_squares(other):
        return None
    return other


def _contains(larger: Fitted, smaller: Fitted) -> bool:
    """Whether each column of a model is a combination of those of the larger one."""
    left = smaller.design - larger.fit.basis @ (larger.fit.basis.T @ smaller.design)
    return bool((np.linalg.norm(left, axis=0) <= CONTRIBUTES * np.maximum(np.linalg.norm(smaller.design, axis=0), 1.0)).all())


def cautions(fit: Fitted) -> list[str]:
    """What is to be known before a model is believed: a sentence each."""
    said = []
    if (missed := misfit(fit)) is not None:
        p = "p < 0.0001" if missed.p < 1e-4 else f"p = {missed.p:.2g}"
        own = 1.0 - fit.residual.sum / fit.total.sum
        better = f"try --model {missed.model}, which explains more, R² {missed.r_squared:.4f} instead of {own:.4f}"
        if not missed.by_replicates:
            said.append(f"lack of fit ({p}): {better}")
        else:
            other = 'no other --model explains more; narrow the ranges, or try scale = "logarithmic" for a factor'
            said.append(
                f"lack of fit: points differ from the model by more than replicates from each other ({p}); {better if missed.model else other}"
            )
    freedom = fit.point_count - len(fit._kept)
    if freedom <= 0:
        said.append("as many coefficients as points: the runs cannot show what the model misses; more points or a smaller --model would")
    elif freedom < LEAST_FREEDOM:
        said.append(f"few points: {fit.point_count} for {len(fit._kept)} coefficients, so that the fit hardly shows what the model misses")
    if fit.seeds == 2:
        said.append(
            "two sets of seeds leave one degree of freedom for the error, and intervals are wide; a third makes them about 3.6 times as narrow"
        )
    if fit.chosen:
        said.append("terms were chosen by AICc from the same runs: F, p and intervals are too favourable and are no tests")
    return said
