"""Differences between the levels of factors with three and more, with intervals that hold for all of them together."""

import itertools
import os
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas
from scipy import optimize, stats

from plateau.errors import InputError
from plateau.study.analysis import usable
from plateau.study.model import Fitted, NothingToFit, fitted
from plateau.study.results import Study, analysed
from plateau.study.units import unit_for


@dataclass(frozen=True, repr=False)
class LevelDifferences:
    """Differences between levels, on the scale of the fit.

    Attributes
    ----------
    study : Study
    table : pandas.DataFrame
        A row for each pair of levels of each factor: ``response``, ``factor``, ``level``, ``other``, ``difference`` (level less other, over
        all levels of the other factors), ``standard_error``, ``freedom``, ``low``, ``high``, ``p`` and ``unit``. Intervals hold for all pairs
        of a factor together at the confidence level, and p is for all of them.
    method : str
        ``"Tukey"`` for all pairs, ``"Dunnett"`` against one level.
    confidence : float
    """

    study: Study
    table: pandas.DataFrame
    method: str
    confidence: float

    def document(self) -> dict[str, Any]:
        """The table for JSON."""
        rows = self.table.astype(object).where(self.table.notna(), None).to_dict("records")
        return {"study": self.study.title, "method": self.method, "confidence": self.confidence, "differences": rows}

    def text(self) -> str:
        """The table for people."""
        said = []
        for (response, factor), rows in self.table.groupby(["response", "factor"], sort=False):
            unit = unit_for(rows["unit"].iloc[0], float(rows["difference"].abs().max()))
            shown = rows[["level", "other", "difference", "low", "high", "p"]].copy()
            shown[["difference", "low", "high"]] *= unit.per_si
            said.append(
                f"{response}: {factor}{f', {unit.symbol}' if unit.symbol else ''}\n{shown.to_string(index=False, float_format=lambda value: f'{value:.4g}')}\n"
            )
        return "\n".join([f"Differences between levels, simultaneous {100 * self.confidence:g} % intervals ({self.method})\n", *said])


def levels(
    study: Study | str | os.PathLike[str],
    control: str | None = None,
    model: str | None = None,
    confidence: float = 0.95,
) -> LevelDifferences:
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
        for at in range(len(fit.codings)):
            if fit.codings[at].classes is not None and len(fit.codings[at].classes or ()) > 2:
                rows += _of_factor(fit, at, control)
    if not rows:
        named = f" has a level {control!r} and" if control is not None else ""
        raise InputError(f"no factor{named} has three levels or more in the model: effects says the difference between two")
    return LevelDifferences(opened, pandas.DataFrame(rows), "Tukey" if control is None else "Dunnett", confidence)


def _of_factor(fit: Fitted, at: int, control: str | None) -> list[dict[str, Any]]:
    """Differences of one factor."""
    coding = fit.codings[at]
    classes = list(coding.classes or ())
    names = [coding.factor.text(level) for level in classes]
    if control is not None and control not in names:
        return []
    # The others are averaged: their contrasts are 0.
    own = coding.numbers(pandas.Series(classes))
    means = fit.products([own if other == at else np.zeros((len(classes), fit.codings[other].width)) for other in range(len(fit.codings))])
    first = names.index(control) if control is not None else None
    pairs = [(one, first) for one in range(len(classes)) if one != first] if first is not None else None
    pairs = pairs or [(one, other) for other, one in itertools.combinations(range(len(classes)), 2)]
    contrasts = np.array([means[one] - means[other] for one, other in pairs])
    weights = contrasts[:, fit.fit.kept] @ fit.fit.root @ fit.fit.basis.T
    # The error of the factor as a whole: levels are taken to differ alike between sets of seeds.
    directions = np.linalg.svd(weights, full_matrices=False)[2][: len(classes) - 1]
    variances, freedoms = fit.errors(directions)
    error, freedom = float(variances.mean()), float(freedoms.sum() if fit.seeds > 1 else freedoms[0])
    errors = np.sqrt(error * (weights**2).sum(axis=1))
    differences = contrasts @ fit.coefficients
    told = fit.fit.tells(means)
    if np.isnan(error):
        reach = np.nan
        chances = np.full(len(pairs), np.nan)
    elif control is None:
        reach = float(stats.studentized_range.ppf(fit.confidence, len(classes), freedom)) / np.sqrt(2.0)
        chances = stats.studentized_range.sf(np.sqrt(2.0) * np.abs(differences) / errors, len(classes), freedom)
    else:
        shape = (weights @ weights.T) / np.sqrt(np.outer((weights**2).sum(axis=1), (weights**2).sum(axis=1)))
        together = stats.multivariate_t(shape=shape, df=round(freedom), seed=0)

        def within(size: float) -> float:
            # C. W. Dunnett, J. Am. Stat. Assoc. 50, 1096-1121 (1955). Points of the same sequence each time: it is smooth.
            ends = np.full(len(pairs), size)
            return float(together.cdf(ends, lower_limit=-ends, random_state=0))

        single, most = (
            float(stats.t.ppf(1.0 - tail, freedom)) for tail in ((1 - fit.confidence) / 2, (1 - fit.confidence) / 2 / len(pairs))
        )
        reach = float(optimize.brentq(lambda size: within(size) - fit.confidence, 0.98 * single, 1.02 * most, xtol=1e-4))
        chances = np.array([1.0 - within(abs(size)) for size in differences / errors])
    rows = []
    for place, (one, other) in enumerate(pairs):
        known = told[one] and told[other]
        low, high = (differences[place] + side * reach * errors[place] if known else np.nan for side in (-1.0, 1.0))
        rows.append(
            {
                "response": fit.response.name,
                "factor": coding.factor.name,
                "level": names[one],
                "other": names[other],
                "difference": differences[place] if known else np.nan,
                "standard_error": errors[place] if known else np.nan,
                "freedom": freedom,
                "low": low,
                "high": high,
                "p": float(np.clip(chances[place], 0.0, 1.0)) if known else np.nan,
                "unit": fit.response.unit if fit.response.transform == "none" else "1",
            }
        )
    return rows
