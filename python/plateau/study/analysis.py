"""Effects: what the factors of a study do to its responses."""

import itertools
import os
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas
from scipy import optimize, stats

from plateau.errors import InputError, PlateauWarning, RunFailed
from plateau.study.model import (
    MODELS,
    ROUNDING,
    SOLE,
    Fitted,
    NothingToFit,
    Squares,
    Term,
    f_test,
    fitted,
    is_curved,
    misfit,
    named,
    owner,
)
from plateau.study.results import Numbers, Response, Study, analysed
from plateau.study.units import Unit, unit_for

# Powers of a response between which the best is looked for, and distance of those at which the search begins.
POWERS, STEP = (-5.0, 5.0), 0.05
TRANSFORMS = {"none": 1.0, "square root": 0.5, "log": 0.0}
# Inflation of variances above which terms are said to be correlated.
MOST_INFLATION = 10.0
# Values of a range up to which means are given at each.
MOST_VALUES = 10
# Terms of an equation beyond which nobody reads it.
MOST_TERMS = 4096


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
        By ``"coded"`` and ``"of the study"``, the factors of each product and its coefficient.
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
        """What is fitted, such as ``log(contact area, m2)``."""
        response = self.response
        unit = "" if response.unit == "1" else f", {response.unit}"
        return response.name if response.transform == "none" else f"{response.transform}({response.name}{unit})"

    @property
    def unit(self) -> str:
        """SI unit of what is fitted."""
        return self.response.unit if self.response.transform == "none" else "1"

    @property
    def summary(self) -> dict[str, Any]:
        """How well the model fits: shares of the variance that it explains, error, numbers of runs."""
        if self.fit is None:
            return {}
        fit, residual, total = self.fit, self.fit.residual, self.fit.total
        has_sole = bool((fit.leverages > 1.0 - SOLE).any())
        press = np.nan if has_sole or residual.freedom < 1 else float(((fit.residuals / (1.0 - fit.leverages)) ** 2).sum())
        return {
            "runs": len(fit.values),
            "missing": fit.missing,
            "mean": fit.mean,
            "middle": float(fit.coefficients[0]),
            "r_squared": 1.0 - residual.sum / total.sum,
            "adjusted_r_squared": 1.0 - residual.mean / total.mean,
            "predicted_r_squared": 1.0 - press / total.sum,
            "residual_standard_deviation": float(np.sqrt(fit.error)),
            "error_from": error_from(fit),
        }

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
        fit = self.fit
        if fit is None:
            return pandas.DataFrame(columns=[*factors, "mean", "low", "high", "observed", "runs", "unit"])
        names = [factor.name for factor in fit.study.factors]
        places = [names.index(name) for name in factors]
        cells = pandas.DataFrame(list(itertools.product(*(_places(fit, at, steps * (at == places[0])) for at in places))), columns=list(factors))
        numbers = [
            coding.numbers(cells[coding.factor.name]) if at in places else np.zeros((len(cells), coding.width))
            for at, coding in enumerate(fit.codings)
        ]
        found = fit.combined(rows := fit.products(numbers))
        reach = stats.t.ppf(0.5 + 0.5 * fit.confidence, found["freedom"]) * found["standard_error"]
        told = fit.fit.tells(rows)
        ends = {"mean": found["value"], "low": found["value"] - reach, "high": found["value"] + reach}
        at_cell = [np.logical_and.reduce([_same(fit.runs[name], row[name]) for name in factors]) for _, row in cells.iterrows()]
        return cells.assign(
            **{name: np.where(told, values, np.nan) for name, values in ends.items()},
            observed=[fit.values[own].mean() if own.any() else np.nan for own in at_cell],
            runs=[int(own.sum()) for own in at_cell],
            unit=self.unit,
        )

    @property
    def residuals(self) -> pandas.DataFrame:
        """Each run beside the model: fitted value, residual (also by its standard deviation), leverage and Cook's distance."""
        if self.fit is None:
            return pandas.DataFrame()
        fit, leverage = self.fit, self.fit.leverages
        free = np.where(1.0 - leverage > SOLE, 1.0 - leverage, np.nan)
        standardised = fit.residuals / np.sqrt(fit.error * free)
        return pandas.DataFrame(
            {
                "response": self.response.name,
                "run": fit.runs.index,
                "made_as": fit.study.runs.loc[fit.runs.index, "order"].to_numpy(),
                "replicate": fit.runs["replicate"].to_numpy(),
                "fitted": fit.values - fit.residuals,
                "residual": fit.residuals,
                "standardised": standardised,
                "leverage": leverage,
                # R. D. Cook, Technometrics 19, 15-18 (1977).
                "cooks_distance": standardised**2 * leverage / (free * len(fit.fit.kept)),
                "unit": self.unit,
            }
        )


def _same(values: pandas.Series, value: Any) -> Numbers:
    return np.asarray(values == value) if isinstance(value, str) else np.isclose(values.to_numpy(float), value, rtol=1e-9, atol=0.0)


def _places(fit: Fitted, at: int, steps: int = 0) -> list[Any]:
    """Where the means of a factor are given: levels, the values of few, and steps of ranges."""
    coding = fit.codings[at]
    if coding.classes is not None:
        return list(coding.classes)
    if steps:
        return coding.factor.value(np.linspace(-1.0, 1.0, steps)).tolist()
    coded = np.unique(np.round(coding.factor.coded(fit.runs[coding.factor.name]), 9))
    return list(coding.factor.value(coded if len(coded) <= MOST_VALUES else np.linspace(-1.0, 1.0, 5)))


def error_from(fit: Fitted) -> str:
    """What tells the error, in words."""
    if fit.residual_freedom == 0:
        return "none: the model is saturated"
    if np.isnan(fit.error):
        return "none: the model reproduces all responses"
    if fit.seeds > 1:
        return f"what each effect differs by between {fit.seeds} sets of seeds"
    interactions = not fit.chosen and not any(is_curved(fit, at) for at in range(len(fit.codings)))
    left_out = {"main": "interactions", "interactions": "interactions of third and higher order"} if interactions else {}
    said = left_out.get(fit.model, "what the model leaves out")
    if not fit.scatter[0].freedom:
        return f"pooled: {said}"
    return "replicates" if fit.lack_of_fit.freedom <= 0 else f"replicates, pooled with {said}"


# The table of variances ------------------------------------------------------------------------------------------------------------


def _untold(fit: Fitted) -> set[int]:
    """Columns that the runs do not tell: all of a combination of several, as an empty cell makes it; not those that repeat one other."""
    found: set[int] = set()
    for column, (parts, _) in fit.fit.relations.items():
        found |= {column, *parts} if len(parts) > 1 else {column}
    return found


def _aliases(fit: Fitted) -> list[list[str]]:
    """By mean, blocks and terms, the labels of the terms that they cannot be told from."""
    labels = ["mean", "replicate", *(fit.label(term) for term in fit.terms)]
    pairs = [(owner(fit, column), owner(fit, part)) for column, (parts, _) in fit.fit.relations.items() for part in parts or [0]]
    for at, term in enumerate(fit.terms):
        if fit.widths[at + 2] == 0:
            # A factor of which one level was observed has no column, and its interactions are those of the others.
            others = tuple(factor for factor in term if fit.codings[factor].width)
            pairs.append((at + 2, fit.terms.index(others) + 2 if others in fit.terms else 0))
    found: list[set[int]] = [set() for _ in labels]
    for one, other in pairs:
        if one != other:
            found[one].add(other)
            found[other].add(one)
    return [[labels[other] for other in sorted(others)] for others in found]


def _table(fit: Fitted, response: str, unit: str) -> pandas.DataFrame:
    """The analysis of variance with effects."""
    rows: list[dict[str, Any]] = []
    aliases, untold, least = _aliases(fit), _untold(fit), fit.fit
    spread = ((fit.design - fit.design.mean(axis=0)) ** 2).sum(axis=0)
    values = fit.values - fit.mean
    for at, (columns, width) in enumerate(zip(fit.columns, fit.widths, strict=True)):
        if at == 0 or at == 1 and fit.seeds < 2:
            continue
        term = fit.terms[at - 2] if at > 1 else None
        places = [place for place, column in enumerate(least.kept) if columns.start <= column < columns.stop]
        contrasts = least.root[places] @ least.basis.T
        # Orthonormal rows whose products with the responses are what the term explains, all others kept (type III).
        directions = np.linalg.qr(contrasts.T)[0].T if places else contrasts
        own = Squares(len(places), float(((directions @ values) ** 2).sum()))
        row: dict[str, Any] = {"response": response, "term": fit.label(term) if term is not None else "replicate"}
        row |= {"factors": term, "degrees_of_freedom": own.freedom, "sum_of_squares": own.sum, "mean_square": own.mean}
        row |= {"share": own.sum / fit.total.sum, "aliased_with": aliases[at]}
        is_told = len(places) == width > 0 and not untold & set(range(columns.start, columns.stop))
        if term is not None and fit.seeds > 1 and is_told and not np.isnan(fit.error):
            # The error over all seeds is what the term differs by between them, not what the model leaves.
            variances, freedoms = fit.errors(directions)
            error, freedom = float(variances.mean()), float(freedoms.sum())
            rest = Squares(round(fit.residual_freedom - freedom), max(fit.residual.sum - error * freedom, 0.0))
            ratio, _ = f_test(Squares(1, error), rest)
            row |= {"seed_ratio": ratio, "seed_p": float(stats.f.sf(ratio, freedom, rest.freedom))}
        else:
            error, freedom = fit.error, float(fit.residual_freedom)
        row["error_freedom"] = freedom if error > 0 else np.nan
        if is_told and error > 0:
            row["f"] = own.mean / error
            row["p"] = float(stats.f.sf(row["f"], own.freedom, freedom))
        if width == 1 and places:
            column = least.kept[places[0]]
            row["variance_inflation"] = float((contrasts[0] @ contrasts[0]) * spread[column]) or np.nan
            if term is not None:
                # Of centre points the coefficient is the difference.
                double = 2.0 if term else 1.0
                row |= {"coefficient": fit.coefficients[column], "effect": double * fit.coefficients[column]}
                if "f" in row:
                    row["standard_error"] = double * float(np.sqrt(error * (contrasts[0] @ contrasts[0])))
                    row["t"] = row["effect"] / row["standard_error"]
                    reach = float(stats.t.ppf(0.5 + 0.5 * fit.confidence, freedom)) * row["standard_error"]
                    row |= {"low": row["effect"] - reach, "high": row["effect"] + reach}
        rows.append(row)
    others = [("residual", fit.residual, (np.nan, np.nan))]
    if fit.scatter[0].freedom > 0:
        others += [("lack of fit", fit.lack_of_fit, fit.lack_of_fit_test), ("pure error", fit.scatter[0], (np.nan, np.nan))]
    for name, squares, (f, p) in [*others, ("total", fit.total, (np.nan, np.nan))]:
        row = {"response": response, "term": name, "degrees_of_freedom": squares.freedom, "sum_of_squares": squares.sum}
        rows.append(row | {"mean_square": squares.mean, "share": squares.sum / fit.total.sum, "f": f, "p": p, "aliased_with": []})
    table = pandas.DataFrame(rows).reindex(columns=COLUMNS)
    sizes = table.loc[[bool(term) for term in table["factors"]], "effect"].dropna().abs().to_numpy()
    table["margin_of_error"], table["simultaneous_margin_of_error"] = np.nan, np.nan
    if np.isnan(fit.error) and (judged := lenth(sizes, fit.confidence)) is not None:
        table.loc[table["effect"].notna(), ["margin_of_error", "simultaneous_margin_of_error"]] = judged[1:]
    return table.assign(unit=unit)


COLUMNS = ["response", "term", "factors", "degrees_of_freedom", "sum_of_squares", "mean_square", "f", "p", "share", "variance_inflation"]
COLUMNS += ["effect", "coefficient", "standard_error", "t", "low", "high", "error_freedom", "seed_ratio", "seed_p", "aliased_with"]


def lenth(sizes: Numbers, confidence: float) -> tuple[float, float, float] | None:
    """Pseudo standard error and margins of effects that have no error; None of fewer than six.

    R. V. Lenth, Technometrics 31, 469-473 (1989).
    """
    if len(sizes) < 6 or (first := 1.5 * float(np.median(sizes))) <= 1e-12 * sizes.max():
        return None
    error, freedom = 1.5 * float(np.median(sizes[sizes < 2.5 * first])), len(sizes) / 3.0
    tails = 0.5 + 0.5 * confidence, 0.5 + 0.5 * confidence ** (1.0 / len(sizes))
    margin, simultaneous = (float(stats.t.ppf(tail, freedom)) * error for tail in tails)
    return error, margin, simultaneous


# Powers ----------------------------------------------------------------------------------------------------------------------------


def box_cox(fit: Fitted) -> tuple[float, float, float] | None:
    """Power of the response that the model fits best, and the powers that fit hardly worse; None unless all responses are above 0.

    G. E. P. Box and D. R. Cox, J. R. Stat. Soc. B 26, 211-252 (1964): the likelihood of a power at its best is that of the residual sum
    of squares of (u^power - 1)/power, with u the response by its geometric mean.
    """
    scale, basis = fit.response, fit.fit.basis
    responses = scale.back(fit.values)
    if np.isnan(fit.error) or not (responses > 0).all() or len(basis) < basis.shape[1] + 3:
        return None
    logarithms = np.log(responses) - np.log(responses).mean()

    def likelihood(power: float) -> float:
        powers = logarithms if abs(power) < 1e-7 else np.expm1(power * logarithms) / power
        left = powers - basis @ (basis.T @ powers)
        return -0.5 * len(left) * float(np.log(left @ left))

    grid = np.linspace(*POWERS, round((POWERS[1] - POWERS[0]) / STEP) + 1)
    values = np.array([likelihood(power) for power in grid])
    near = float(grid[values.argmax()])
    bounds = max(near - STEP, POWERS[0]), min(near + STEP, POWERS[1])
    best = float(optimize.minimize_scalar(lambda power: -likelihood(power), bounds=bounds, method="bounded", options={"xatol": 1e-9}).x)
    least = likelihood(best) - 0.5 * float(stats.chi2.ppf(fit.confidence, 1))

    def end(powers: Numbers) -> float:
        inside = best
        for power in powers:
            if likelihood(power) < least:
                return float(optimize.brentq(lambda at: likelihood(at) - least, inside, power, xtol=1e-12))
            inside = float(power)
        return inside

    return best, end(grid[grid < best][::-1]), end(grid[grid > best])


def _advice(fit: Fitted, found: tuple[float, float, float] | None) -> str:
    """What the best power says of the transform: none where another one would not forecast points better that it does not know."""
    power = TRANSFORMS.get(fit.response.transform)
    if found is None or power is None or found[1] <= power <= found[2]:
        return ""
    left = fit.residuals / np.maximum(1.0 - fit.leverages, SOLE)
    if 1.0 - float(left @ left) / fit.total.sum > 0.999 and misfit(fit) is None:
        return ""
    best, low, high = found
    if low <= 1.0 <= high:
        name, said = "none", "try it without transform"
    else:
        allowed = [name for name in ("log", "square root") if low <= TRANSFORMS[name] <= high]
        name = min(allowed, key=lambda name: abs(TRANSFORMS[name] - best), default="")
        said = f'try transform = "{name}"'
    if not name:
        said = "none of the transforms is this power; keep the response as it is, and look for a bend in the residuals, "
        said += "which another --model may explain"
    else:
        other = Response(**{**vars(fit.response), "transform": name})
        own, others = fit.loo_error, fitted(fit.study, other, fit.model, confidence=fit.confidence).loo_error
        if others > 0.95 * own:
            return ""
    at_end = ", looked for between −5 and 5 alone" if low <= POWERS[0] or high >= POWERS[1] else ""
    return f"Box-Cox: lambda = {best:.2g} ({low:.2g} to {high:.2g}{at_end}): {said}"


# Equations -------------------------------------------------------------------------------------------------------------------------

# What a coefficient is multiplied by: numbers (0, factor), levels (1, factor, level) and centre points (2,), with sizes for rounding.
Products = dict[tuple[tuple[int, ...], ...], list[float]]


def equations(fit: Fitted) -> dict[str, pandas.DataFrame]:
    """The fitted model in coded units and in the units of the study; nothing where it is too long to be read."""
    found = {}
    for name in ("coded", "of the study"):
        products: Products = {(): [fit.coefficients[0]]}
        for term, columns in zip(fit.terms, fit.columns[2:], strict=True):
            _add(products, fit, term, np.where(np.abs(fit.coefficients[columns]) <= fit.rounding, 0.0, fit.coefficients[columns]), name)
            if len(products) > MOST_TERMS:
                return {}
        sums = {key: (sum(parts), sum(map(abs, parts))) for key, parts in sorted(products.items(), key=lambda one: (len(one[0]), one[0]))}
        kept = {key: value for key, (value, size) in sums.items() if abs(value) > 0.25 * ROUNDING * size or not key}
        rows = [{"variables": _product(fit, key), "coefficient": value} for key, value in kept.items()]
        found[name] = pandas.DataFrame(rows, columns=["variables", "coefficient"])
    return found


def _is_number(fit: Fitted, at: int) -> bool:
    coding = fit.codings[at]
    return coding.classes is None or coding.factor.is_number and len(coding.factor.levels) == len(coding.classes) == 2


def _add(products: Products, fit: Fitted, term: Term, coefficients: Numbers, units: str) -> None:
    """Adds a term, with the products of its numbers multiplied out."""
    classes = [at for at in term if not _is_number(fit, at)]
    grid = coefficients.reshape([fit.codings[at].width for at in classes])
    for place, at in enumerate(classes):
        contrasts = np.vstack([-np.ones(fit.codings[at].width), np.eye(fit.codings[at].width)])
        grid = np.moveaxis(np.tensordot(contrasts, grid, axes=(1, place)), 0, place)
    for index, coefficient in np.ndenumerate(grid):
        levels = [fit.codings[at].classes for at in classes]
        # By the place among all levels of the study.
        parts = [
            ((1, at, fit.study.factors[at].levels.index(found[own])),)
            for at, own, found in zip(classes, index, levels, strict=True)
            if found is not None
        ]
        begun = tuple(itertools.chain(*parts)) if term else ((2,),)
        multiplied = [(begun, float(coefficient))]
        for at in (at for at in term if _is_number(fit, at)):
            slope, shift = 1.0, 0.0
            if units == "of the study":
                factor = fit.study.factors[at]
                low, high = factor.in_study_unit(np.array(factor.ends))
                if factor.logarithmic:
                    low, high = np.log10(low), np.log10(high)
                slope, shift = 2.0 / (high - low), -(low + high) / (high - low)
            multiplied = [
                new
                for key, value in multiplied
                for new in (((*key, (0, at)), value * slope), (key, value * shift))
                if slope != 1.0 or new[1]
            ]
        for key, value in multiplied:
            products.setdefault(tuple(sorted(key)), []).append(value)


def _product(fit: Fitted, key: tuple[tuple[int, ...], ...]) -> str:
    """A product in words, such as ``load·speed``, ``load²`` or ``load·[pool contact]``."""
    parts = []
    for variable, same in itertools.groupby(key):
        if variable == (2,):
            parts.append("[centre points]")
            continue
        factor = fit.study.factors[variable[1]]
        name = named(factor) if variable[0] == 0 else f"[{factor.name} {factor.text(factor.levels[variable[2]])}]"
        parts.append(name + "²" * (len(list(same)) - 1))
    return "·".join(parts)


# The answer ------------------------------------------------------------------------------------------------------------------------


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
        return next(response for response in self.responses if response.response.name == name)

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
        rows = {
            one.response.name: {**one.summary, "unit": one.unit, "model": one.fit.model if one.fit else "", "cautions": one.cautions}
            for one in self.responses
        }
        return pandas.DataFrame.from_dict(rows, orient="index")

    @property
    def cautions(self) -> list[str]:
        """What holds of all responses."""
        return together(self.study)

    def document(self, files: Sequence[str] = ()) -> dict[str, Any]:
        """What ``plateau sweep effects --json`` prints."""
        repeats = int(self.study.runs["same_as"].duplicated().sum())
        return {
            "study": self.study.title,
            "repeats": repeats,
            "cautions": self.cautions,
            "responses": [_report(one) for one in self.responses],
            "files": list(files),
        }

    def text(self) -> str:
        """What the command prints."""
        repeats, said = int(self.study.runs["same_as"].duplicated().sum()), []
        if repeats:
            verb, counts = ("repeats", "counts") if repeats == 1 else ("repeat", "count")
            said.append(
                f"{repeats} of {len(self.study.runs)} runs {verb} another one and {counts} once with it: the same scene with the same seeds "
                "gives the same result. Only [replicates] with several seeds tell the pure error.\n"
            )
        return "\n".join([*said, *(caution + "\n" for caution in self.cautions), *map(_text, self.responses)])

    def figures(self) -> Any:
        """Draws main effects, interactions, sizes of effects and residuals."""
        from plateau.study.figures import effects_figures

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
    """The study, if it has results; runs without are said.

    Raises
    ------
    InputError
        If it asks for no response.
    RunFailed
        If no run has a value yet.
    """
    path = study.path or study.directory
    if not study.responses:
        raise InputError(
            f'{path}: no [[response]], so there is nothing to analyse; name one, such as dataset = "/series/contact_area_mean", at = "end"'
        )
    counts = study.runs["state"].value_counts()
    if not np.isfinite(study.runs[[response.name for response in study.responses]].to_numpy(float)).any():
        finished, imported = int(counts.get("finished", 0)), not any(response.series for response in study.responses)
        to_do = f"plateau sweep import {path} TABLE.csv brings them" if imported else f"plateau sweep run {path} makes the runs"
        to_do = f"the {finished} runs that finished have none: look at the responses" if finished and not imported else to_do
        raise RunFailed(f"{path}: there is no result to analyse yet; {to_do}")
    if left_out := len(study.runs) - int(counts.get("finished", 0)):
        failed, missing = int(counts.get("failed", 0)), int(counts.get("missing", 0))
        said = f"{left_out} of {len(study.runs)} runs have no results and are left out: {failed} failed, {missing} not made yet"
        warnings.warn(said, PlateauWarning, stacklevel=3)
    return study


def together(study: Study) -> list[str]:
    """Pairs of factors that change together in all runs: a sentence each."""
    places = {
        factor.name: [factor.levels.index(v) if not factor.is_number else v for v in study.runs[factor.name]] for factor in study.factors
    }
    said = []
    for one, other in itertools.combinations(places, 2):
        if np.ptp(places[one]) > 0 and np.ptp(places[other]) > 0 and abs(np.corrcoef(places[one], places[other])[0, 1]) > 0.999:
            what = "what one of them does cannot be told from what the other does"
            said.append(f"{one} and {other} change together in all runs: {what}")
    return said


def _effects(study: Study, response: Response, model: str | None, terms: str, confidence: float) -> ResponseEffects:
    """The analysis of one response."""
    try:
        fit = fitted(study, response, model, terms, confidence, centre=True)
    except NothingToFit as error:
        return ResponseEffects(response, None, str(error), pandas.DataFrame(columns=[*COLUMNS, "unit"]), None, "", {}, [])
    unit = response.unit if response.transform == "none" else "1"
    table, power = _table(fit, response.name, unit), box_cox(fit)
    cautions = list(fit.cautions)
    varied = table[(table["seed_ratio"] > 1.0) & (table["seed_p"] < 1.0 - confidence)]
    if len(varied):
        ratios = ", ".join(f"{row['term']} {row['seed_ratio']:.2g}" for _, row in varied.iterrows())
        said = f"seeds x factor exceeds the residual (ratio of mean squares): {ratios}; these effects differ between sets of seeds, and "
        said += "intervals tell of the mean over all seeds"
        cautions.append(said)
        warnings.warn(f"{response.name}: {said}", PlateauWarning, stacklevel=4)
    inflated = table[table["variance_inflation"] > MOST_INFLATION]
    if len(inflated):
        said = ", ".join(f"{row['term']} {row['variance_inflation']:.2g}" for _, row in inflated.iterrows())
        cautions.append(
            f"correlated with other terms, so that their effects are hardly told apart (variance inflation above {MOST_INFLATION:g}): {said}"
        )
    rows = table[table["factors"].notna() | (table["term"] == "replicate")]
    if abs(rows["share"].sum() - (1.0 - fit.residual.sum / fit.total.sum)) > 0.02:
        cautions.append(
            f"shares add up to {100 * rows['share'].sum():.0f} %, not to R²: terms are correlated, and a share is what is lost without the "
            "term and all others kept (type III)"
        )
    return ResponseEffects(response, fit, "", table, power, _advice(fit, power), equations(fit), cautions)


def _or_none(value: Any) -> Any:
    return None if isinstance(value, float) and not np.isfinite(value) else value


def _squares(squares: Squares, f: float = np.nan, p: float = np.nan) -> dict[str, Any]:
    return {"degrees_of_freedom": squares.freedom, "sum_of_squares": squares.sum, "f": _or_none(f), "p": _or_none(p)}


# Members of the document of a response that are null where nothing could be fitted.
REPORTED = "model model_reason mean middle r_squared adjusted_r_squared predicted_r_squared residual_standard_deviation residual".split()
REPORTED += "lack_of_fit pure_error misfit curvature box_cox terms_left_out aicc lenth".split()


def _report(one: ResponseEffects) -> dict[str, Any]:
    """A response in the document."""
    fit, response, table = one.fit, one.response, one.table
    report: dict[str, Any] = {"name": response.name, "unit": response.unit}
    report |= {"transform": None if response.transform == "none" else response.transform, "fitted": one.title, "error": one.error or None}
    if fit is None:
        report |= dict.fromkeys(REPORTED) | {"runs": 0, "missing": 0}
        return report | {"error_from": "", "equations": [], "terms": [], "cautions": []}
    terms = table[table["factors"].notna() | (table["term"] == "replicate")]
    centre = terms[terms["term"] == "centre points"]
    missed, has_parts = misfit(fit), fit.scatter[0].freedom > 0
    judged = lenth(terms.loc[[bool(term) for term in terms["factors"]], "effect"].dropna().abs().to_numpy(), fit.confidence)
    report |= {"model": fit.model, "model_reason": fit.reason, **{key: _or_none(value) for key, value in one.summary.items()}}
    report |= {
        "residual": _squares(fit.residual),
        "lack_of_fit": _squares(fit.lack_of_fit, *fit.lack_of_fit_test) if has_parts else None,
        "pure_error": _squares(fit.scatter[0]) if has_parts else None,
        "misfit": missed
        and {
            "f": _or_none(missed.f),
            "p": missed.p,
            "by_replicates": missed.by_replicates,
            "model_to_try": missed.model,
            "r_squared": _or_none(missed.r_squared),
        },
        "curvature": None
        if centre.empty or np.isnan(centre["f"].iloc[0])
        else {
            "difference": centre["effect"].iloc[0],
            "interval": [centre["low"].iloc[0], centre["high"].iloc[0]],
            "f": centre["f"].iloc[0],
            "p": centre["p"].iloc[0],
        },
        "box_cox": one.box_cox and {"lambda": one.box_cox[0], "interval": list(one.box_cox[1:])},
        "terms_left_out": [fit.label(term) for term in fit.left_out] if fit.chosen else None,
        "aicc": _or_none(fit.aicc),
        "equations": [{"units": name, "terms": terms.to_dict("records")} for name, terms in one.equations.items()],
        "lenth": dict(zip(("pseudo_standard_error", "margin_of_error", "simultaneous_margin_of_error"), judged, strict=True))
        if judged and np.isnan(fit.error)
        else None,
        "cautions": one.cautions,
    }
    names = ["degrees_of_freedom", "sum_of_squares", "share", "variance_inflation", "f", "p", "effect", "standard_error"]
    report["terms"] = [
        {
            "label": row["term"],
            **{name: _or_none(row[name]) for name in names},
            "interval": None if np.isnan(row["low"]) else [row["low"], row["high"]],
            "aliased_with": row["aliased_with"],
            "error_degrees_of_freedom": _or_none(row["error_freedom"]),
            "seed_ratio": _or_none(row["seed_ratio"]),
        }
        for row in terms.to_dict("records")
    ]
    return report


def _digits(value: float, width: float = np.nan) -> str:
    """A number with as many digits as the width of its interval leaves; four without."""
    if not np.isfinite(value):
        return ""
    if not np.isfinite(width) or width <= 0:
        return f"{value:.4g}".replace("-", "−")
    places = 1 - int(np.floor(np.log10(width)))
    if not 1e-3 <= max(abs(value), width) < 1e6:
        return f"{value:.{max(int(np.floor(np.log10(max(abs(value), width)))) + places, 0)}e}".replace("-", "−")
    return f"{round(value, places):.{max(places, 0)}f}".replace("-", "−")


def told(one: ResponseEffects) -> tuple[list[str], list[list[str]], list[str]]:
    """What is said of a response, the rows of its table with their heads, and what stands below it."""
    fit, table = one.fit, one.table
    if fit is None:
        return [one.response.name, one.error], [], []
    unit = unit_for(one.unit, float(np.abs(fit.values).max()))
    unit = Unit(one.unit, 1.0) if unit.offset else unit
    summary, scale = one.summary, unit.per_si
    model = f"model: {MODELS[fit.model]}" + (f"; {fit.reason}" if fit.reason else "")
    if fit.chosen:
        labels = ", ".join(fit.label(term) for term in fit.terms) or "the mean alone"
        left_out = ", ".join(fit.label(term) for term in fit.left_out) or "none"
        model = f"model: {labels}; chosen from {MODELS[fit.model]}\n  terms left out: {left_out}; AICc {fit.aicc:.5g}"
        model += f" instead of {fit.aicc_of_all:.5g} with all" if np.isfinite(fit.aicc_of_all) else ""
    shares = {"R²": "r_squared", "adjusted R²": "adjusted_r_squared", "predicted R²": "predicted_r_squared"}
    quality = [f"{name} {summary[key]:.4f}" for name, key in shares.items() if np.isfinite(summary[key])]
    p = fit.lack_of_fit_test[1]
    why = "no point has replicates" if not fit.scatter[0].freedom else "nothing is left for it"
    quality.append(f"lack of fit not tested: {why}" if np.isnan(p) else f"lack of fit p {_probability(p)}")
    mean = f"{_digits(fit.mean * scale)} {unit.symbol}".strip()
    error = f"error from {summary['error_from']}" if not np.isnan(fit.error) else f"error {summary['error_from']}"
    if np.isfinite(fit.error):
        error += f"; residual {_digits(np.sqrt(fit.error) * scale)} {unit.symbol}".rstrip()
    elif fit.residual_freedom == 0:
        error += (
            ", so no interval can be told: give [replicates] of seeds, such as those of the disc, or a smaller model such as --model main"
        )
    margins = table[["margin_of_error", "simultaneous_margin_of_error"]].dropna()
    if len(margins):
        error += ", margin of error {}, simultaneous {} (Lenth)".format(*(_digits(value * scale) for value in margins.iloc[0]))
    missing = f", {fit.missing} without a response" if fit.missing else ""
    lines = [one.response.name, model, ", ".join(quality), f"{len(fit.values)} runs{missing}, mean {mean}, {error}"]
    if one.response.transform != "none":
        lines.append(f"all results are those of {one.title}")
    lines += [f"caution: {caution}" for caution in one.cautions] + ([one.advice] if one.advice else [])
    heads = ["term", f"effect, {unit.symbol}" if unit.symbol else "effect", f"{100 * fit.confidence:.4g} % interval"]
    rows = [[*heads, "share", "df", "error df", "F", "p"]]
    own = table["factors"].notna() | (table["term"] == "replicate")
    left = ["residual", *(["lack of fit", "pure error"] if fit.lack_of_fit.freedom > 0 else [])]
    shown = pandas.concat([table[own].sort_values("share", ascending=False, kind="stable"), table[table["term"].isin(left) & ~own]])
    for row in shown.to_dict("records"):
        width = (row["high"] - row["low"]) / 2 * scale
        ends = [_digits(row[end] * scale, width) for end in ("low", "high")]
        name = row["term"] if row["term"] not in left[1:] else f"  {row['term']}"
        cells = [name, _digits(row["effect"] * scale, width), " … ".join(ends) if np.isfinite(width) else "", f"{100 * row['share']:.1f} %"]
        freedom = f"{row['error_freedom']:.3g}" if np.isfinite(row["error_freedom"]) else ""
        rows.append([*cells, str(row["degrees_of_freedom"]), freedom, _digits(row["f"]), _digits(row["p"])])
    aliased = table[[bool(others) for others in table["aliased_with"]]]
    below = [f"{row['term']} cannot be told from {', '.join(row['aliased_with'])}" for _, row in aliased.iterrows()]
    for name, terms in one.equations.items():
        said = "in coded units, −1 to 1 over each range" if name == "coded" else "in the units of the study"
        heading = one.title + (f" [{unit.symbol}]" if unit.symbol else "")
        pieces = [
            f"{'−' if row['coefficient'] < 0 else '+'} {abs(row['coefficient']) * scale:.6g} {row['variables']}".strip()
            for row in terms.to_dict("records")
        ]
        below += [f"{said}:", f"  {heading} = {' '.join(pieces).removeprefix('+ ')}"]
    return lines, rows, below


def _text(one: ResponseEffects) -> str:
    """The same as text."""
    lines, rows, below = told(one)
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for first, *cells in rows:
        lines.append("  ".join([first.ljust(widths[0]), *(cell.rjust(width) for cell, width in zip(cells, widths[1:], strict=True))]).rstrip())
    return "\n  ".join([*lines, *below]) + "\n"


def _probability(p: float) -> str:
    return "< 0.0001" if p < 1e-4 else f"= {p:.2g}"
