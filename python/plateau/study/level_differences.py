"""Differences between the levels of factors with three and more, with intervals that hold for all of them together."""

import itertools
import os
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import pandas
from scipy import optimize, stats

from plateau.errors import InputError
from plateau.study.analysis import usable
from plateau.study.data import Study
from plateau.study.model import Fitted, NothingToFit
from plateau.study.model_choice import fitted
from plateau.study.results import analysed
from plateau.study.text_tables import listed
from plateau.units import unit_for, with_digits


@dataclass(frozen=True, repr=False)
class LevelDifferences:
    """Differences between levels, on the scale of the fit.

    Attributes
    ----------
    table : pandas.DataFrame
        A row for each pair of levels of each factor: ``response``, ``factor``, ``level``, ``other``, ``difference`` (level less other, over
        all levels of the other factors), ``standard_error``, ``freedom``, ``low``, ``high``, ``p`` and ``unit``. Intervals hold for all
        pairs of a factor together at the confidence level, and p is for all of them.
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
        As for `effects`.
    confidence : float
        That all intervals of a factor hold together.

    Returns
    -------
    LevelDifferences

    Notes
    -----
    The error is that of the model: with sets of seeds what the factor differs by between them, else the residual. Of unequal numbers of
    runs the intervals are those of C. Y. Kramer, Biometrics 12, 307-310 (1956).
    """
    opened, rows = usable(analysed(study)), []
    for response in opened.responses:
        try:
            fit = fitted(opened, response, model, confidence=confidence)
        except NothingToFit:
            continue
        rows += [_of_factor(fit, at, control) for at, coding in enumerate(fit.codings) if len(coding.classes or ()) > 2]
    if rows and all(part is None for part in rows):
        raise InputError(f"{opened.title}: nothing tells the error of differences between levels; give [replicates] of seeds")
    if not any(part is not None and len(part) for part in rows):
        named = f" has a level {control!r} and" if control is not None else ""
        raise InputError(f"no factor{named} has three levels or more in the model: effects says the difference between two")
    return LevelDifferences(opened, pandas.concat(rows, ignore_index=True), "Tukey" if control is None else "Dunnett", confidence)


@lru_cache
def _tukey(confidence: float, levels: int, freedom: float) -> float:
    """How many standard errors the intervals of all differences reach; a sum over two variables, the same for many responses."""
    return float(stats.studentized_range.ppf(confidence, levels, freedom) / np.sqrt(2.0))


def _of_factor(fit: Fitted, at: int, control: str | None) -> pandas.DataFrame | None:
    """Differences of one factor, none if it has no such level; None where nothing tells the error."""
    coding = fit.codings[at]
    classes = list(coding.classes or ())
    names = [coding.factor.text(level) for level in classes]
    if control is not None and control not in names:
        return pandas.DataFrame()
    # The others are averaged: their contrasts are 0.
    numbers = [one.numbers(pandas.Series(classes)) if one is coding else np.zeros((len(classes), one.width)) for one in fit.codings]
    means = fit.products(numbers)
    pairs = [(one, other) for other, one in itertools.combinations(range(len(classes)), 2)]
    if control is not None:
        pairs = [(one, names.index(control)) for one in range(len(classes)) if names[one] != control]
    rows = np.array([means[one] - means[other] for one, other in pairs])
    weights = rows[:, fit.fit.kept] @ fit.fit.root @ fit.fit.basis.T
    # The error of the factor as a whole: levels are taken to differ alike between sets of seeds.
    variances, freedoms = fit.errors(np.linalg.svd(weights, full_matrices=False)[2][: len(classes) - 1])
    freedom = float(freedoms.sum() if fit.seeds > 1 else freedoms[0])
    errors = np.sqrt(variances.mean() * np.square(weights).sum(axis=1))
    differences = rows @ fit.coefficients
    differences[~(fit.fit.tells(means)[pairs].all(axis=1)) | np.isnan(errors)] = np.nan
    if np.isnan(freedom):
        return None
    if control is None:
        reach = _tukey(fit.confidence, len(classes), round(freedom, 6))
        chances = stats.studentized_range.sf(np.sqrt(2.0) * np.abs(differences) / errors, len(classes), freedom)
    else:
        lengths = np.linalg.norm(weights, axis=1)
        together = stats.multivariate_t(shape=weights @ weights.T / np.outer(lengths, lengths), df=round(freedom))

        def within(size: float) -> float:
            # C. W. Dunnett, J. Am. Stat. Assoc. 50, 1096-1121 (1955). Points of the same sequence each time: it is smooth.
            return float(together.cdf(np.full(len(pairs), size), lower_limit=np.full(len(pairs), -size), random_state=0, maxpts=100_000))

        tail = (1.0 - fit.confidence) / 2.0
        ends = 0.98 * stats.t.isf(tail, freedom), 1.02 * stats.t.isf(tail / len(pairs), freedom)
        reach = float(optimize.brentq(lambda size: within(size) - fit.confidence, *ends, xtol=1e-4))
        chances = np.array([1.0 - within(abs(size)) for size in differences / errors])
    whole = [(fit.response.name, coding.factor.name, names[one], names[other]) for one, other in pairs]
    table = pandas.DataFrame(whole, columns=["response", "factor", "level", "other"]).assign(difference=differences, standard_error=errors)
    table = table.assign(freedom=freedom, low=differences - reach * errors, high=differences + reach * errors, p=np.clip(chances, 0.0, 1.0))
    return table.assign(unit=fit.response.unit_of_fit)[table["difference"].notna()]
