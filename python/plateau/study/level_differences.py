"""Differences between the levels of factors with three and more, with intervals that hold for all of them together."""

import itertools
import os
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
import pandas
from scipy import optimize, special, stats

from plateau.errors import InputError
from plateau.study.analysis import usable
from plateau.study.data import Answer, Numbers, Study
from plateau.study.model import Fitted, NothingToFit
from plateau.study.model_choice import cautions, fitted
from plateau.study.results import analysed
from plateau.study.settings import in_short
from plateau.text_tables import listed
from plateau.units import unit_for, with_digits


@dataclass(frozen=True, repr=False)
class LevelDifferences(Answer):
    """Differences between levels, on the scale of the fit.

    Attributes
    ----------
    table : pandas.DataFrame
        A row for each pair of levels of each factor that the runs tell apart: ``response``, ``factor``, ``level``, ``other``, ``difference``
        (level less other, over all levels of the other factors), ``standard_error``, ``freedom``, ``low``, ``high``, ``p``, ``unit`` and
        ``cautions``, in short. Intervals hold for all pairs of a factor together at the confidence level, and p is for all of them.
    method : str
        ``"Tukey"`` for all pairs, ``"Dunnett"`` against one level.
    """

    study: Study
    table: pandas.DataFrame
    method: str
    confidence: float

    def text(self) -> str:
        """The table for people."""
        said = []
        for (response, factor), rows in self.table.groupby(["response", "factor"], sort=False):
            unit, cells = unit_for(rows["unit"].iloc[0], float(rows["difference"].abs().max())), []
            for row in rows.to_dict("records"):
                width = 0.5 * unit.per_si * (row["high"] - row["low"])
                numbers = {name: with_digits(unit.per_si * row[name], width) for name in ("difference", "low", "high")}
                cells.append({"level": row["level"], "other": row["other"], **numbers, "p": with_digits(row["p"])})
            said += ["", f"{response}: {', '.join(filter(None, [factor, unit.of_differences]))}", *listed(cells)]
        return "\n".join([f"Differences between levels, simultaneous {100 * self.confidence:g} % intervals ({self.method})", *said, ""])


def levels(study: Study | str | os.PathLike[str], control: str | None = None, model: str | None = None, confidence: float = 0.95) -> LevelDifferences:
    """Compares the levels of all factors that have three and more.

    Parameters
    ----------
    study : path or Study
        The study, TOML.
    control : str, optional
        A level, as text, with which all others of its factor are compared (Dunnett); without it all pairs are (Tukey).
    model : str, optional
        See `effects`.
    confidence : float
        Confidence with which all intervals of a factor hold together.

    Returns
    -------
    LevelDifferences

    Notes
    -----
    The error is that of the model: with sets of seeds what the factor differs by between them, else the residual. Of unequal numbers of
    runs the intervals are those of C. Y. Kramer, Biometrics 12, 307-310 (1956), and against one level those of C. W. Dunnett, J. Am. Stat.
    Assoc. 50, 1096-1121 (1955), where other factors make correlations no products with the nearest ones that are (J. C. Hsu, J. Comput.
    Graph. Stat. 1, 151-168 (1992)).
    """
    opened, tables, reasons = usable(analysed(study)), list[pandas.DataFrame](), dict[str, list[str]]()
    for response in opened.responses:
        try:
            fit = fitted(opened, response, model, confidence=confidence)
        except NothingToFit as error:
            reasons.setdefault(str(error), []).append(response.name)
            continue
        short = in_short(cautions(fit))
        for at, coding in enumerate(fit.codings):
            names = [coding.factor.text(level) for level in coding.classes or ()]
            if len(names) > 2 and (control is None or control in names):
                try:
                    tables.append(_of_factor(fit, at, names, control).assign(cautions=short))
                except NothingToFit as error:
                    reasons.setdefault(str(error), []).append(coding.factor.name)
    if not tables:
        named = f" has a level {control!r} and" if control is not None else ""
        said = "; ".join(f"{', '.join(dict.fromkeys(names))}: {why}" for why, names in reasons.items())
        said = said or f"no factor{named} has three levels or more in the model: effects says the difference between two"
        raise InputError(f"{opened.title}: {said}")
    return LevelDifferences(opened, pandas.concat(tables, ignore_index=True), "Tukey" if control is None else "Dunnett", confidence)


def _of_factor(fit: Fitted, at: int, names: list[str], control: str | None) -> pandas.DataFrame:
    """Differences of one factor; `NothingToFit` if the runs tell none, or no error."""
    coding = fit.codings[at]
    means = fit.averaged(pandas.DataFrame({coding.factor.name: coding.classes}))
    pairs = [(one, other) for other, one in itertools.combinations(range(len(names)), 2)]
    if control is not None:
        pairs = [(one, names.index(control)) for one in range(len(names)) if names[one] != control]
    told = fit.tells(means)
    if not (pairs := [pair for pair in pairs if told[list(pair)].all()]):
        advice = "" if fit.model == "main" else ', or give model = "main"'
        why = "some combinations with levels of other factors have no run, so that no difference between levels can be told"
        raise NothingToFit(f"{why}: make these runs{advice}")
    rows = np.array([means[one] - means[other] for one, other in pairs])
    weights = rows[:, fit.fit.kept] @ fit.fit.root @ fit.fit.basis.T
    _, sizes, directions = np.linalg.svd(weights, full_matrices=False)
    directions, lengths = directions[sizes > 1e-9 * sizes[0]], np.linalg.norm(weights, axis=1)
    if fit.differs_alike(directions):
        # The error of the factor as a whole.
        variances, own = fit.errors(directions)
        variances, freedoms = (np.full(len(pairs), value) for value in (variances.mean(), own.sum() if fit.seeds > 1 else own[0]))
    else:
        # That of each difference, as P. A. Games and J. F. Howell, Journal of Educational Statistics 1, 113-125 (1976).
        variances, freedoms = fit.errors(weights / lengths[:, None])
    if np.isnan(freedoms).any():
        raise NothingToFit("nothing tells the error of differences between levels; give [replicates] of seeds")
    if not variances.any():
        raise NothingToFit("its levels differ by the same in all sets of seeds, so that nothing tells an error")
    differences, errors = rows @ fit.coefficients, np.where(variances > 0.0, np.sqrt(variances) * lengths, np.nan)
    outside = partial(_range_beyond, len({level for pair in pairs for level in pair}))
    if control is not None:
        outside = partial(_any_beyond, _shared(weights @ weights.T / np.outer(lengths, lengths)))
    # Wider than that of one difference alone, and narrower than C. E. Bonferroni's of more differences than there are.
    tail, reaches = (1.0 - fit.confidence) / 2.0, {}
    for freedom in set(freedoms):
        ends = 0.98 * stats.t.isf(tail, freedom), stats.t.isf(tail / len(names) ** 2, freedom)
        reaches[freedom] = float(optimize.brentq(lambda size, of: _tail(outside, size, of) - 2.0 * tail, *ends, args=(freedom,), xtol=1e-6))
    reach = np.array([reaches[freedom] for freedom in freedoms])
    chances = [_tail(outside, size, freedom) for size, freedom in zip(np.abs(differences / errors), freedoms, strict=True)]
    whole = [(fit.response.name, coding.factor.name, names[one], names[other]) for one, other in pairs]
    table = pandas.DataFrame(whole, columns=["response", "factor", "level", "other"]).assign(difference=differences, standard_error=errors)
    table = table.assign(freedom=freedoms, low=differences - reach * errors, high=differences + reach * errors, p=chances)
    return table.assign(unit=fit.response.unit_of_fit)


def _tail(outside: Callable[[Numbers, Numbers], Numbers], size: float, freedom: float) -> float:
    """Probability that the largest difference is beyond a size, in standard errors.

    Sum over the error and a normal variable of what is `outside`: 1 less what is within would be rounding alone far out.
    """
    # About the error, relative to its expectation, of which most of that comes, and as far as exp(-30) of it.
    far = (30.0 / freedom) ** 0.5
    logs, step = np.linspace(-far * (1.0 + far), 0.5 * np.log1p(2.0 * far * (1.0 + far)), 120, retstep=True)
    squares = freedom**2 / (freedom + size**2) * np.exp(2.0 * logs)
    weights = 2.0 * step * squares * stats.chi2.pdf(squares, freedom)
    places = np.arange(-38.0, 38.0, 0.125)
    # NaN without an error.
    return min(float(0.125 * stats.norm.pdf(places) @ outside(places[:, None], size * np.sqrt(squares / freedom)) @ weights), 1.0)


def _range_beyond(levels: int, highest: Numbers, size: Numbers) -> Numbers:
    """Probability that the lowest of several levels is farther below the highest one than √2 times a size (J. W. Tukey's range)."""
    below, far = special.ndtr(highest), special.ndtr(highest - 2.0**0.5 * size)
    return np.asarray(levels * far * sum(below**power * (below - far) ** (levels - 2 - power) for power in range(levels - 1)))


def _any_beyond(shares: Numbers, shared: Numbers, size: Numbers) -> Numbers:
    """Probability that any of several normal variables, each with its share of a common one, is beyond ± a size."""
    beyond = np.zeros(np.broadcast_shapes(shared.shape, size.shape))
    for share in shares:
        rest = (1.0 - share**2) ** 0.5
        beyond += (1.0 - beyond) * (special.ndtr((share * shared - size) / rest) + special.ndtr((-share * shared - size) / rest))
    return beyond


def _shared(correlations: Numbers) -> Numbers:
    """Shares of a variable that all have, whose products are the correlations, or nearest to them."""
    pairs, starts = np.triu_indices(len(correlations), 1), np.full(len(correlations), 0.7)
    # With less of their own the steps of the sum would be too wide; with more, p is larger.
    found = optimize.least_squares(lambda shares: (np.outer(shares, shares) - correlations)[pairs], starts, bounds=(-0.995, 0.995))
    return np.asarray(found.x)
