"""Effects: what the factors of a study do to its responses."""

import itertools
import os
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy as np
import pandas

from plateau import html_page
from plateau.errors import InputError, PlateauWarning, RunFailed, UnknownNameError
from plateau.study.data import Answer, Response, Study
from plateau.study.effects_figures import DRAWINGS
from plateau.study.effects_text import equations, text_of, told
from plateau.study.figure_axes import file_names
from plateau.study.model import NothingToFit
from plateau.study.model_choice import cautions, fitted
from plateau.study.response_effects import COLUMNS, ResponseEffects, box_cox, effect_table, report_of, transform_advice
from plateau.study.results import analysed
from plateau.study.settings import in_short
from plateau.style import Figures, in_style

# Inflation of variances above which terms are said to be correlated, and shares whose sum differs by more from R² of which it is said.
MOST_INFLATION, SHARES_DIFFER = 10.0, 0.02


@dataclass(frozen=True, repr=False)
class Effects(Answer):
    """Effects of the factors of a study on its responses; ``found["NAME"]`` has those on one of them."""

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
        """The analyses of variance of all responses, with effects, and ``cautions`` in short."""
        general = together(self.study)
        tables = [one.table.assign(cautions=in_short([*general, *one.cautions])) for one in self.responses]
        return pandas.concat(tables, ignore_index=True)

    @property
    def residuals(self) -> pandas.DataFrame:
        """Residuals: each run beside the model of each response."""
        return pandas.concat([response.residuals for response in self.responses], ignore_index=True)

    @property
    def summary(self) -> pandas.DataFrame:
        """Quality of the fit of each model, a row for each response, with cautions."""
        rows = {one.response.name: one.summary | {"unit": one.unit, "cautions": one.cautions} for one in self.responses}
        return pandas.DataFrame.from_dict(rows, orient="index")

    @property
    def cautions(self) -> list[str]:
        """Cautions about all responses, then about each with its name before it."""
        return [*together(self.study), *(f"{one.response.name}: {caution}" for one in self.responses for caution in one.cautions)]

    @property
    def repeats(self) -> int:
        """Runs that repeat another one and count once with it."""
        return int(self.study.runs["same_as"].duplicated().sum())

    def document(self) -> dict[str, Any]:
        """The JSON of ``plateau sweep effects --json``."""
        responses = [report_of(one) for one in self.responses]
        return {"study": self.study.title, "repeats": self.repeats, "cautions": self.cautions, "responses": responses}

    def text(self) -> str:
        """The text that ``plateau sweep effects`` prints."""
        said = [caution + "\n" for caution in together(self.study)]
        if self.repeats:
            verb, counts = ("repeats", "counts") if self.repeats == 1 else ("repeat", "count")
            why = "the same scene with the same seeds gives the same result. Only [replicates] with several seeds tell the pure error."
            if self.study.document.get("centre_points", 1) > 1:
                why += " Leave out centre_points: one is enough, with a rotatable design, too."
            said.append(f"{self.repeats} of {len(self.study.runs)} runs {verb} another one and {counts} once with it: {why}\n")
        return "\n".join([*said, *map(text_of, self.responses)])

    @in_style
    def figures(self) -> Figures:
        """Draws effects, means, interactions, residuals and surfaces of each response."""
        stems = zip(self.responses, file_names([one.response.name for one in self.responses]), strict=True)
        drawn = {f"{stem}-{name}": draw(one, one.fit) for one, stem in stems if one.fit for name, draw in DRAWINGS.items()}
        return {name: figure for name, figure in drawn.items() if figure is not None}

    def page(self, figures: Mapping[str, Any], files: Mapping[str, bytes]) -> str:
        """The page of ``plateau sweep effects`` with figures and their files."""
        factors = []
        for factor in self.study.factors:
            factors.append([factor.name, factor.keys, (" … " if factor.is_range else ", ").join(map(factor.shown, factor.levels))])
        states = ", ".join(f"{count} {state}" for state, count in self.study.runs["state"].value_counts().items())
        about = [
            f"design: {self.study.design}",
            f"runs: {states}",
            f"sets of seeds: {self.study.seeds}",
            *(f"caution: {said}" for said in self.cautions),
        ]
        parts = [html_page.listed(about), html_page.table(["factor", "keys", "values"], factors, "words")]
        for one, stem in zip(self.responses, file_names([one.response.name for one in self.responses]), strict=True):
            (name, *said), rows, below = told(one)
            parts += [f"<h2>{escape(name)}</h2>", html_page.listed(said), *([html_page.table(rows[0], rows[1:])] if rows else [])]
            parts += [f"<pre>{escape(chr(10).join(below))}</pre>"] if below else []
            own = [f"{stem}-{kind}" for kind in DRAWINGS]
            parts.append(html_page.pictures({name: figures[name] for name in own if name in figures}, files))
        return html_page.page(f"{self.study.title}: effects", *parts)


def effects(study: Study | str | os.PathLike[str], model: str | None = None, confidence: float = 0.95) -> Effects:
    """Tells what the factors of a study do to its responses.

    Parameters
    ----------
    study : path or Study
        The study, TOML.
    model : str, optional
        ``"main"``, ``"interactions"``, ``"full"`` or ``"quadratic"``; one that the design allows unless given.
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
    return Effects(opened, [_effects(opened, response, model, confidence) for response in opened.responses], confidence)


def usable(study: Study) -> Study:
    """The study, if it has results; warns of runs without."""
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
    varied = [(one, values) for one in study.factors if (values := study.runs[one.name]).nunique() > 1]
    places = {one.name: one.coded(values.to_numpy()) if one.is_number else pandas.factorize(values)[0] for one, values in varied}
    alike = pandas.DataFrame(places).corr().abs() > 0.999
    said = "{} and {} change together in all runs: what one of them does cannot be told from what the other does"
    return [said.format(*pair) for pair in itertools.combinations(places, 2) if alike.loc[pair]]


def _effects(study: Study, response: Response, model: str | None, confidence: float) -> ResponseEffects:
    """The analysis of one response."""
    try:
        fit = fitted(study, response, model, confidence, centre=True)
    except NothingToFit as error:
        return ResponseEffects(response, None, str(error), pandas.DataFrame(columns=COLUMNS), None, "", {}, [])
    table, power, said_of_fit = effect_table(fit), box_cox(fit), cautions(fit)

    def listed(rows: pandas.DataFrame, column: str) -> str:
        return ", ".join(f"{row['term']} {row[column]:.2g}" for row in rows.to_dict("records"))

    # Of many terms one has such a ratio by chance (Bonferroni).
    if len(varied := table[(table["seed_ratio"] > 1.0) & (table["seed_p"] < (1.0 - confidence) / max(table["seed_p"].count(), 1))]):
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
