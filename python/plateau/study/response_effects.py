"""What the factors of a study do to one response."""

import itertools
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas
from scipy import stats

from plateau.output_folder import plain
from plateau.study.data import Response
from plateau.study.effect_table import COLUMNS, lenth
from plateau.study.model import SOLE, Fitted, is_same
from plateau.study.model_choice import misfit
from plateau.units import shown_unit

# Values of a range up to which means are given at each.
MOST_VALUES = 10
# Members of the document of a response, null where nothing could be fitted.
MEMBERS = ["model", "model_reason", "runs", "missing", "mean", "middle", "r_squared", "adjusted_r_squared", "predicted_r_squared"]
MEMBERS += ["residual_standard_deviation", "error_from", "residual", "lack_of_fit", "pure_error", "misfit", "curvature", "box_cox"]
MEMBERS += ["terms_left_out", "aicc", "equations", "lenth", "terms", "cautions"]


@dataclass(frozen=True, repr=False)
class ResponseEffects:
    """What the factors do to one response, on the scale of the fit.

    Attributes
    ----------
    response : Response
    fit : Fitted or None
        None where nothing could be fitted.
    error : str
        Why; empty otherwise.
    table : pandas.DataFrame
        The analysis of variance, type III: a row for the sets of seeds (``replicate``), each term, the residual with its parts, and the
        total. ``effect`` is the difference between the ends of a factor; of a product half the difference between the effects of one
        factor at the ends of the other; of centre points that between them and the model of the others. Its error is that over all
        seeds, with ``error_freedom`` degrees of freedom; ``seed_ratio`` is the mean square of seeds x term by that of the rest of the
        residual, and ``seed_p`` the probability of a larger one if they were the same.
    box_cox : tuple of float, or None
        Power of the response that the model fits best, and the ends of the powers that fit hardly worse.
    advice : str
        What that says of the transform; empty where there is nothing to say.
    equations : dict
        By ``"coded"`` and ``"of the study"``, the ``variables`` of each product and its ``coefficient``.
    cautions : list of str
    """

    response: Response
    fit: Fitted | None
    error: str
    table: pandas.DataFrame
    box_cox: tuple[float, float, float] | None
    advice: str
    equations: dict[str, pandas.DataFrame]
    cautions: list[str]

    @property
    def title(self) -> str:
        """What is fitted, such as ``log(contact area, m²)``."""
        unit = "" if self.response.unit == "1" else f", {shown_unit(self.response.unit)}"
        return self.response.name if self.response.transform == "none" else f"{self.response.transform}({self.response.name}{unit})"

    @property
    def unit(self) -> str:
        """SI unit of what is fitted."""
        return self.response.unit if self.response.transform == "none" else "1"

    @property
    def terms(self) -> pandas.DataFrame:
        """The rows of sets of seeds and terms."""
        return self.table[self.table["factors"].notna()]

    @property
    def summary(self) -> dict[str, Any]:
        """How well the model fits: shares of the variance that it explains, error, numbers of runs."""
        if (fit := self.fit) is None:
            return {}
        residual, total = fit.residual, fit.total
        is_free = residual.freedom > 0 and (fit.leverages <= 1.0 - SOLE).all()
        press = float(np.square(fit.residuals / (1.0 - fit.leverages)).sum()) if is_free else np.nan
        shares = 1.0 - residual.sum / total.sum, 1.0 - residual.mean / total.mean, 1.0 - press / total.sum
        values = [len(fit.values), fit.missing, fit.mean, float(fit.coefficients[0]), *shares, fit.error**0.5, error_from(fit)]
        return dict(zip(MEMBERS[2:11], values, strict=True))

    def means(self, *factors: str, steps: int = 0) -> pandas.DataFrame:
        """Means of the model at the levels of one factor or two, over all levels of the others and their middles.

        Parameters
        ----------
        *factors : str
            Names.
        steps : int
            Number of values of the first factor, if it has a range; those of the runs unless given.

        Returns
        -------
        pandas.DataFrame
            A row for each level, or pair of levels: the factors (SI or words), ``mean``, ``low``, ``high`` (over all seeds), ``observed``
            (the mean of the runs there; NaN without), ``runs``, ``unit``; on the scale of the fit.
        """
        if (fit := self.fit) is None:
            return pandas.DataFrame(columns=[*factors, "mean", "low", "high", "observed", "runs", "unit"])
        codings = {coding.factor.name: coding for coding in fit.codings}
        places: list[list[Any]] = []
        for coding in (codings[name] for name in factors):
            if coding.classes is not None:
                places.append(list(coding.classes))
                continue
            coded = np.unique(np.round(coding.factor.coded(fit.runs[coding.factor.name]), 9))
            if steps and not places or len(coded) > MOST_VALUES:
                coded = np.linspace(-1.0, 1.0, 5 if places or not steps else steps)
            places.append(list(coding.factor.value(coded)))
        cells = pandas.DataFrame(list(itertools.product(*places)), columns=list(factors))
        numbers = [one.numbers(cells[name]) if name in factors else np.zeros((len(cells), one.width)) for name, one in codings.items()]
        found = fit.combined(rows := fit.products(numbers))
        reach = stats.t.ppf(0.5 + 0.5 * fit.confidence, found["freedom"]) * found["standard_error"]
        values = found["value"].where(pandas.Series(fit.fit.tells(rows)))
        at_cell = [np.logical_and.reduce([is_same(fit.runs[name], row[name]) for name in factors]) for _, row in cells.iterrows()]
        observed = [fit.values[own].mean() if own.any() else np.nan for own in at_cell]
        ends = {"mean": values, "low": values - reach, "high": values + reach}
        return cells.assign(**ends, observed=observed, runs=[int(own.sum()) for own in at_cell], unit=self.unit)

    @property
    def residuals(self) -> pandas.DataFrame:
        """Each run beside the model: fitted value, residual (also by its standard deviation), leverage and Cook's distance."""
        if (fit := self.fit) is None:
            return pandas.DataFrame()
        free = np.where(1.0 - fit.leverages > SOLE, 1.0 - fit.leverages, np.nan)
        standardised = fit.residuals / np.sqrt(fit.error * free)
        # R. D. Cook, Technometrics 19, 15-18 (1977).
        distance = standardised**2 * fit.leverages / (free * len(fit.fit.kept))
        which = {"response": self.response.name, "run": fit.runs.index, "made_as": fit.runs["order"], "replicate": fit.runs["replicate"]}
        values = {"fitted": fit.values - fit.residuals, "residual": fit.residuals, "standardised": standardised}
        return pandas.DataFrame(which | values | {"leverage": fit.leverages, "cooks_distance": distance, "unit": self.unit})


def error_from(fit: Fitted) -> str:
    """What tells the error, in words."""
    if fit.residual_freedom == 0:
        return "none: the model is saturated"
    if np.isnan(fit.error):
        return "none: the model reproduces all responses"
    if fit.seeds > 1:
        cells = fit.runs.groupby(["point", "replicate"]).size()
        is_complete = len(cells) == fit.seeds * fit.point_count and cells.nunique() == 1
        how = "" if is_complete else ", not all at the same points: degrees of freedom after Bell and McCaffrey"
        return f"what each effect differs by between {fit.seeds} sets of seeds{how}"
    left_out = {"main": "interactions", "interactions": "interactions of third and higher order"}
    said = left_out.get(fit.model if fit.left_out is None and not any(fit.is_curved) else "", "what the model leaves out")
    if not fit.scatter[0].freedom:
        return f"pooled: {said}"
    return "replicates" if fit.lack_of_fit[0].freedom <= 0 else f"replicates, pooled with {said}"


def report_of(one: ResponseEffects) -> dict[str, Any]:
    """A response in the document of ``plateau sweep effects --json``."""
    fit, response, terms = one.fit, one.response, one.terms
    report: dict[str, Any] = {"name": response.name, "unit": response.unit, "fitted": one.title, "error": one.error or None}
    report |= {"transform": None if response.transform == "none" else response.transform} | dict.fromkeys(MEMBERS)
    if fit is None:
        return report | {"runs": 0, "missing": 0, "error_from": "", "equations": [], "terms": [], "cautions": []}
    report |= {"model": fit.model, "model_reason": fit.reason} | {key: plain(value) for key, value in one.summary.items()}
    for row in one.table[one.table["factors"].isna() & (one.table["term"] != "total")].to_dict("records"):
        squares = {name: plain(row[name]) for name in ("degrees_of_freedom", "sum_of_squares", "f", "p")}
        report[row["term"].replace(" ", "_")] = squares
    for row in terms[(terms["term"] == "centre points") & terms["f"].notna()].to_dict("records"):
        report["curvature"] = {"difference": row["effect"], "interval": [row["low"], row["high"]], "f": row["f"], "p": row["p"]}
    report |= {"misfit": misfit(fit), "box_cox": one.box_cox and {"lambda": one.box_cox[0], "interval": list(one.box_cox[1:])}}
    if fit.left_out is not None:
        report |= {"terms_left_out": [fit.label(term) for term in fit.left_out], "aicc": plain(fit.aicc)}
    report["equations"] = [{"units": units, "terms": products.to_dict("records")} for units, products in one.equations.items()]
    if np.isnan(fit.error) and (judged := lenth(terms.loc[terms["factors"].str.len() > 0, "effect"], fit.confidence)):
        names = ("pseudo_standard_error", "margin_of_error", "simultaneous_margin_of_error")
        report["lenth"] = dict(zip(names, judged, strict=True))
    copied = [*COLUMNS[3:5], "share", "variance_inflation", "f", "p", "effect", "standard_error", "aliased_with", "seed_ratio"]
    report["terms"] = [
        {"label": row["term"], "interval": None if np.isnan(row["low"]) else [row["low"], row["high"]]}
        | {name: plain(row[name]) for name in copied}
        | {"error_degrees_of_freedom": plain(row["error_freedom"])}
        for row in terms.to_dict("records")
    ]
    return report | {"cautions": one.cautions}
