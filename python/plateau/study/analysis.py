"""Effects: what the factors of a study do to its responses."""

import itertools
import os
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas
from scipy import stats

from plateau.errors import InputError, PlateauWarning, RunFailed, UnknownNameError
from plateau.output_folder import plain
from plateau.study.effect_table import COLUMNS, box_cox, effect_table, lenth, transform_advice
from plateau.study.equations import equations
from plateau.study.model import SOLE, Fitted, NothingToFit, is_same
from plateau.study.model_choice import cautions, fitted, misfit
from plateau.study.data import Response, Study
from plateau.study.results import analysed
from plateau.units import shown_unit

# Inflation of variances above which terms are said to be correlated, and shares whose sum differs by more from R² of which it is said.
MOST_INFLATION, SHARES_DIFFER = 10.0, 0.02
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


@dataclass(frozen=True, repr=False)
class Effects:
    """What the factors of a study do to its responses.

    Attributes
    ----------
    study : Study
    responses : list of ResponseEffects
    confidence : float
    """

    study: Study
    responses: list[ResponseEffects]
    confidence: float

    def __getitem__(self, name: str) -> ResponseEffects:
        names = [one.response.name for one in self.responses]
        if name not in names:
            raise UnknownNameError(f"{name!r}: no response of {self.study.title!r}; there are {', '.join(names)}")
        return self.responses[names.index(name)]

    @property
    def table(self) -> pandas.DataFrame:
        """The analyses of variance of all responses, with effects."""
        return pandas.concat([response.table for response in self.responses], ignore_index=True)

    @property
    def residuals(self) -> pandas.DataFrame:
        """Each run beside the model of each response."""
        return pandas.concat([response.residuals for response in self.responses], ignore_index=True)

    @property
    def summary(self) -> pandas.DataFrame:
        """How well the models fit, a row for each response, with cautions."""
        rows = {one.response.name: one.summary | {"unit": one.unit, "cautions": one.cautions} for one in self.responses}
        return pandas.DataFrame.from_dict(rows, orient="index")

    @property
    def cautions(self) -> list[str]:
        """What to be careful about: of all responses, then of each with its name before it."""
        return [*together(self.study), *(f"{one.response.name}: {caution}" for one in self.responses for caution in one.cautions)]

    @property
    def repeats(self) -> int:
        """Runs that repeat another one and count once with it."""
        return int(self.study.runs["same_as"].duplicated().sum())

    def document(self, files: Sequence[str] = ()) -> dict[str, Any]:
        """What ``plateau sweep effects --json`` prints."""
        responses = [_report(one) for one in self.responses]
        return {"study": self.study.title, "repeats": self.repeats, "cautions": self.cautions, "responses": responses, "files": list(files)}

    def text(self) -> str:
        """What the command prints."""
        said = [caution + "\n" for caution in together(self.study)]
        if self.repeats:
            verb, counts = ("repeats", "counts") if self.repeats == 1 else ("repeat", "count")
            why = "the same scene with the same seeds gives the same result. Only [replicates] with several seeds tell the pure error."
            if self.study.document.get("centre_points", 1) > 1:
                why += " Leave out centre_points: one is enough, with a rotatable design, too."
            said.append(f"{self.repeats} of {len(self.study.runs)} runs {verb} another one and {counts} once with it: {why}\n")
        from plateau.study.effects_text import text_of

        return "\n".join([*said, *map(text_of, self.responses)])

    def figures(self) -> Any:
        """Draws main effects, interactions, sizes of effects and residuals."""
        from plateau.study.effects_figures import effects_figures

        return effects_figures(self)


def effects(study: Study | str | os.PathLike[str], model: str | None = None, terms: str = "all", confidence: float = 0.95) -> Effects:
    """Tells what the factors of a study do to its responses.

    Parameters
    ----------
    study : path or Study
        The study, TOML.
    model : str, optional
        ``"main"``, ``"interactions"``, ``"full"`` or ``"quadratic"``; one that the design allows unless given.
    terms : str
        ``"all"`` of the model, or ``"aicc"``: those with the least AICc.
    confidence : float
        Confidence level of intervals.

    Returns
    -------
    Effects

    Examples
    --------
    >>> found = effects("loads.toml")
    >>> found.table[["response", "term", "effect", "low", "high", "unit"]]
    """
    opened = usable(analysed(study))
    return Effects(opened, [_effects(opened, response, model, terms, confidence) for response in opened.responses], confidence)


def usable(study: Study) -> Study:
    """The study, if it has results; runs without are said."""
    path = study.path or study.directory
    if not study.responses:
        advice = 'name one, such as dataset = "/series/contact_area_mean", at = "end"'
        raise InputError(f"{path}: no [[response]], so there is nothing to analyse; {advice}")
    finished, failed = (int((study.runs["state"] == state).sum()) for state in ("finished", "failed"))
    if not np.isfinite(study.runs[[response.name for response in study.responses]].to_numpy(float)).any():
        to_do = f"the {finished} that finished have none: look at the responses" if finished else f"plateau sweep run {path} makes the runs"
        if not any(response.series for response in study.responses):
            to_do = f"plateau sweep import {path} TABLE.csv brings them"
        raise RunFailed(f"{path}: there is no result to analyse yet; {to_do}")
    if left_out := len(study.runs) - finished:
        why = f"{failed} failed, {left_out - failed} not made yet"
        warnings.warn(f"{left_out} of {len(study.runs)} runs have no results and are left out: {why}", PlateauWarning, stacklevel=3)
    return study


def together(study: Study) -> list[str]:
    """Pairs of factors that change together in all runs: a sentence each."""
    places = {one.name: study.runs[one.name] if one.is_number else pandas.factorize(study.runs[one.name])[0] for one in study.factors}
    alike = pandas.DataFrame(places).corr().abs() > 0.999
    said = "{} and {} change together in all runs: what one of them does cannot be told from what the other does"
    return [said.format(*pair) for pair in itertools.combinations(places, 2) if alike.loc[pair]]


def _effects(study: Study, response: Response, model: str | None, terms: str, confidence: float) -> ResponseEffects:
    """The analysis of one response."""
    try:
        fit = fitted(study, response, model, terms, confidence, centre=True)
    except NothingToFit as error:
        return ResponseEffects(response, None, str(error), pandas.DataFrame(columns=COLUMNS), None, "", {}, [])
    table, power, said_of_fit = effect_table(fit), box_cox(fit), cautions(fit)

    def listed(rows: pandas.DataFrame, column: str) -> str:
        return ", ".join(f"{row['term']} {row[column]:.2g}" for row in rows.to_dict("records"))

    if len(varied := table[(table["seed_ratio"] > 1.0) & (table["seed_p"] < 1.0 - confidence)]):
        said = f"seeds x factor exceeds the residual (ratio of mean squares): {listed(varied, 'seed_ratio')}; these effects differ between "
        said_of_fit.append(said + "sets of seeds, and intervals tell of the mean over all seeds")
        warnings.warn(f"{response.name}: {said_of_fit[-1]}", PlateauWarning, stacklevel=4)
    if len(inflated := table[table["variance_inflation"] > MOST_INFLATION]):
        said = f"correlated with other terms, so that their effects are hardly told apart (variance inflation above {MOST_INFLATION:g})"
        said_of_fit.append(f"{said}: {listed(inflated, 'variance_inflation')}")
    shares = float(table.loc[table["factors"].notna(), "share"].sum())
    if abs(shares - 1.0 + fit.residual.sum / fit.total.sum) > SHARES_DIFFER:
        said = "not to R²: terms are correlated, and a share is what is lost without the term and all others kept (type III)"
        said_of_fit.append(f"shares add up to {100 * shares:.0f} %, {said}")
    return ResponseEffects(response, fit, "", table, power, transform_advice(fit, power), equations(fit), said_of_fit)


def _report(one: ResponseEffects) -> dict[str, Any]:
    """A response in the document."""
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
