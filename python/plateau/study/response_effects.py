"""Effects of the factors of a study on one response: the analysis of variance with effects, means, and what the runs say of its scale."""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas
from scipy import optimize, stats

from plateau.output_folder import plain
from plateau.study.data import Response
from plateau.study.model import SOLE, Fitted, Squares, f_test, is_same
from plateau.study.model_choice import fitted, misfit
from plateau.units import shown_unit

# Powers of a response between which the best is looked for, and distance of those at which the search begins.
POWERS, STEP = (-5.0, 5.0), 0.05
TRANSFORMS = {"none": 1.0, "square root": 0.5, "log": 0.0}
COLUMNS = ["response", "term", "factors", "degrees_of_freedom", "sum_of_squares", "mean_square", "f", "p", "share", "variance_inflation"]
COLUMNS += ["effect", "coefficient", "standard_error", "t", "low", "high", "margin_of_error", "simultaneous_margin_of_error"]
COLUMNS += ["aliased_with", "error_freedom", "seed_ratio", "seed_p", "unit"]
# Values of a range up to which means are given at each.
MOST_VALUES = 10
# Members of the document of a response, null where nothing could be fitted; those of its summary.
SUMMARY = ["runs", "missing", "mean", "middle", "r_squared", "adjusted_r_squared", "predicted_r_squared", "predicted_r_squared_of_points"]
SUMMARY += ["residual_standard_deviation", "error_from"]
TESTS = ["residual", "lack_of_fit", "pure_error", "misfit", "curvature", "box_cox"]
NONE = dict.fromkeys(["model", "model_reason", *SUMMARY, *TESTS]) | {"runs": 0, "missing": 0, "error_from": ""}
NONE |= {"equations": [], "lenth": None, "terms": [], "cautions": []}


@dataclass(frozen=True, repr=False)
class ResponseEffects:
    """Effects of the factors on one response, on the scale of the fit.

    Attributes
    ----------
    fit : Fitted or None
        Model that was fitted; None where nothing could be.
    error : str
        Reason why nothing could be fitted; empty otherwise.
    table : pandas.DataFrame
        The analysis of variance, type III: a row for the sets of seeds (``replicate``), each term, the residual with its parts, and the
        total. ``effect`` is the difference between the ends of a factor; of a product half the difference between the effects of one
        factor at the ends of the other; of centre points that between them and the model of the others. Its error is that over all
        seeds, with ``error_freedom`` degrees of freedom; ``seed_ratio`` is the mean square of seeds x term by that of the rest of the
        residual, and ``seed_p`` the probability of a larger one if they were the same.
    box_cox : tuple of float, or None
        Power of the response that the model fits best, and the ends of the powers that fit hardly worse.
    advice : str
        Advice from that power on the transform; empty where there is nothing to say.
    equations : dict
        Equations by ``"coded"`` and ``"of the study"``: the ``variables`` of each product and its ``coefficient``.
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
        """Name of what is fitted, such as ``log(contact area, m²)``."""
        unit = "" if self.response.unit == "1" else f", {shown_unit(self.response.unit)}"
        return self.response.name if self.response.transform == "none" else f"{self.response.transform}({self.response.name}{unit})"

    @property
    def unit(self) -> str:
        """SI unit of what is fitted."""
        return self.response.unit_of_fit

    @property
    def terms(self) -> pandas.DataFrame:
        """The rows of sets of seeds and terms."""
        return self.table[self.table["factors"].notna()]

    @property
    def summary(self) -> dict[str, Any]:
        """Quality of the fit: shares of the variance that it explains, error, numbers of runs."""
        if (fit := self.fit) is None:
            return {}
        residual, total = fit.residual, fit.total
        is_free = residual.freedom > 0 and (fit.leverages <= 1.0 - SOLE).all()
        press = float(np.square(fit.residuals / (1.0 - fit.leverages)).sum()) if is_free else np.nan
        # With other seeds of its point in the fit, a run seems better foretold than a place without runs is.
        of_points = 1.0 - fit.press / total.sum if fit.seeds > 1 else np.nan
        shares = 1.0 - residual.sum / total.sum, 1.0 - residual.mean / total.mean, 1.0 - press / total.sum, of_points
        values = [len(fit.values), fit.missing, fit.mean, float(fit.coefficients[0]), *shares, fit.error**0.5, error_from(fit)]
        return dict(zip(SUMMARY, values, strict=True))

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
            coded = np.unique(np.round(coding.factor.coded(fit.runs[coding.factor.name]), 9)) if coding.classes is None else np.array([])
            if (steps and not places) or len(coded) > MOST_VALUES:
                coded = np.linspace(-1.0, 1.0, 5 if places or not steps else steps)
            places.append(list(coding.classes or coding.factor.value(coded)))
        cells = pandas.DataFrame(list(itertools.product(*places)), columns=list(factors))
        found = fit.combined(rows := fit.averaged(cells))
        reach = stats.t.ppf(0.5 + 0.5 * fit.confidence, found["freedom"]) * found["standard_error"]
        values = found["value"].where(pandas.Series(fit.tells(rows)))
        there = [fit.values[np.logical_and.reduce([is_same(fit.runs[name], row[name]) for name in factors])] for _, row in cells.iterrows()]
        means = {"mean": values, "low": values - reach, "high": values + reach, "observed": [own.mean() if len(own) else np.nan for own in there]}
        return cells.assign(**means, runs=list(map(len, there)), unit=self.unit)

    @property
    def residuals(self) -> pandas.DataFrame:
        """Each run beside the model: fitted value, residual (also by its standard deviation), leverage and Cook's distance."""
        if (fit := self.fit) is None:
            return pandas.DataFrame()
        free = np.where(1.0 - fit.leverages > SOLE, 1.0 - fit.leverages, np.nan)
        standardised = fit.residuals / np.sqrt(fit.error * free)
        # R. D. Cook, Technometrics 19, 15-18 (1977).
        distance = standardised**2 * fit.leverages / (free * len(fit.fit.kept))
        found = pandas.DataFrame({"response": self.response.name, "run": fit.runs.index}, index=fit.runs.index)
        found = found.assign(made_as=fit.runs["order"], replicate=fit.runs["replicate"], fitted=fit.values - fit.residuals, residual=fit.residuals)
        return found.assign(standardised=standardised, leverage=fit.leverages, cooks_distance=distance, unit=self.unit)


def error_from(fit: Fitted) -> str:
    """Source of the error, in words."""
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
    said = left_out.get("" if any(fit.is_curved) else fit.model, "what the model leaves out")
    if not fit.scatter[0].freedom:
        return f"pooled: {said}"
    return "replicates" if fit.lack_of_fit[0].freedom <= 0 else f"replicates, pooled with {said}"


def report_of(one: ResponseEffects) -> dict[str, Any]:
    """A response in the document of ``plateau sweep effects --json``."""
    fit, response, terms = one.fit, one.response, one.terms
    report: dict[str, Any] = {"name": response.name, "unit": response.unit, "fitted": one.title, "error": one.error or None}
    report |= {"transform": None if response.transform == "none" else response.transform} | NONE
    if fit is None:
        return report
    report |= {"model": fit.model, "model_reason": fit.reason, **one.summary, "misfit": misfit(fit), "cautions": one.cautions}
    for row in one.table[one.table["factors"].isna() & (one.table["term"] != "total")].to_dict("records"):
        report[row["term"].replace(" ", "_")] = {name: row[name] for name in ("degrees_of_freedom", "sum_of_squares", "f", "p")}
    for row in terms[(terms["term"] == "centre points") & terms["f"].notna()].to_dict("records"):
        report["curvature"] = {"difference": row["effect"], "interval": [row["low"], row["high"]], "f": row["f"], "p": row["p"]}
    report["box_cox"] = one.box_cox and {"lambda": one.box_cox[0], "interval": list(one.box_cox[1:])}
    report["equations"] = [{"units": units, "terms": products.to_dict("records")} for units, products in one.equations.items()]
    if np.isnan(fit.error) and (judged := lenth(terms, fit.confidence)):
        names = ("pseudo_standard_error", "margin_of_error", "simultaneous_margin_of_error")
        report["lenth"] = dict(zip(names, judged, strict=True))
    copied = [*COLUMNS[3:5], "share", "variance_inflation", "f", "p", "effect", "standard_error", "aliased_with", "seed_ratio"]
    report["terms"] = [
        {"label": row["term"], "interval": None if np.isnan(row["low"]) else [row["low"], row["high"]]}
        | {name: row[name] for name in copied}
        | {"error_degrees_of_freedom": row["error_freedom"]}
        for row in terms.to_dict("records")
    ]
    found: dict[str, Any] = plain(report)
    return found


def _aliases(fit: Fitted) -> tuple[set[int], list[list[str]]]:
    """Columns that the runs do not tell, and by mean, blocks and terms, the labels of the terms that they cannot be told from."""
    labels = ["mean", "replicate", *(fit.label(term) for term in fit.terms)]
    untold, pairs = set(), []
    for column, (parts, _) in fit.fit.relations.items():
        # Of two columns that are the same but for a factor the first is told, as the sum of both; not of seeds, nor of a combination of more.
        untold |= {column, *parts} if len(parts) > 1 or 1 in map(fit.owner, parts) else {column}
        pairs += [(fit.owner(column), fit.owner(part)) for part in parts or [0]]
    for at, term in enumerate(fit.terms):
        if not all(fit.codings[factor].width for factor in term):
            # A factor of which one level was observed has no column, and its interactions are those of the others.
            others = tuple(factor for factor in term if fit.codings[factor].width)
            pairs.append((at + 2, fit.terms.index(others) + 2 if others in fit.terms else 0))
    found: list[set[int]] = [set() for _ in labels]
    for one, other in (pair for pair in pairs if pair[0] != pair[1]):
        found[one].add(other)
        found[other].add(one)
    return untold, [[labels[other] for other in sorted(others)] for others in found]


def effect_table(fit: Fitted) -> pandas.DataFrame:
    """The analysis of variance with effects."""
    rows: list[dict[str, Any]] = []
    (untold, aliases), least, values = _aliases(fit), fit.fit, fit.values - fit.mean
    spread = np.square(fit.design - fit.design.mean(axis=0)).sum(axis=0)

    def told(name: str, squares: Squares, aliased_with: Sequence[str] = (), **more: Any) -> dict[str, Any]:
        row = {"term": name, "degrees_of_freedom": squares.freedom, "sum_of_squares": squares.sum, "mean_square": squares.mean}
        return row | {"share": squares.sum / fit.total.sum, "aliased_with": list(aliased_with)} | more

    for at, columns in list(enumerate(fit.columns))[1 if fit.seeds > 1 else 2 :]:
        is_blocks, term, width, error = at == 1, () if at == 1 else fit.terms[at - 2], columns.stop - columns.start, fit.residual
        places = [place for place, column in enumerate(least.kept) if columns.start <= column < columns.stop]
        weights = least.root[places] @ least.basis.T
        # Orthonormal rows whose products with the responses are what the term explains, all others kept (type III).
        directions = np.linalg.qr(weights.T)[0].T if places else weights
        own = Squares(len(places), float(np.square(fit.unless_rounding(directions @ values)).sum()))
        row = told("replicate" if is_blocks else fit.label(term), own, aliases[at], factors=term)
        if len(places) == width > 0 and not untold & set(range(columns.start, columns.stop)):
            if not is_blocks and fit.seeds > 1 and error.sum > 0:
                # The error over all seeds is what the term differs by between them, not what the model leaves.
                variances, freedoms = fit.errors(directions)
                error = Squares(float(freedoms.sum()), float(variances.mean() * freedoms.sum()))
                if error.sum > 0:
                    left, rounding = fit.residual.sum - error.sum, fit.rounding * (len(values) * fit.residual.sum) ** 0.5
                    rest = Squares(round(fit.residual_freedom - error.freedom), left if left > rounding else 0.0)
                    row["seed_ratio"], row["seed_p"] = f_test(error, rest)
            if error.sum > 0:
                row["f"], row["p"] = f_test(own, error)
                if not is_blocks and not fit.differs_alike(directions):
                    error, row["f"], row["p"] = fit.unlike(own, directions)
            # Without a residual there is none; an effect that does not differ between sets of seeds has an error of 0.
            if error.sum >= 0 and np.isfinite(fit.error):
                row["error_freedom"] = float(error.freedom)
        if width == 1 and places:
            column, variance = least.kept[places[0]], float(weights[0] @ weights[0])
            row["variance_inflation"] = variance * spread[column] or np.nan
            if not is_blocks:
                # Of centre points the coefficient is the difference.
                double, coefficient = 2.0 if term else 1.0, float(fit.coefficients[column])
                effect, deviation = double * coefficient, double * (error.mean * variance) ** 0.5 if "error_freedom" in row else np.nan
                row |= {"coefficient": coefficient, "effect": effect, "standard_error": deviation}
                if "f" in row:
                    reach = float(stats.t.ppf(0.5 + 0.5 * fit.confidence, error.freedom)) * deviation
                    row |= {"t": effect / deviation, "low": effect - reach, "high": effect + reach}
        rows.append(row)
    missed, error, f, p = fit.lack_of_fit
    rows.append(told("residual", fit.residual))
    if fit.scatter[0].freedom > 0:
        freedom = error.freedom if np.isfinite(f) else np.nan
        rows += [told("lack of fit", missed, f=f, p=p, error_freedom=freedom), told("pure error", fit.scatter[0])]
    table = pandas.DataFrame([*rows, told("total", fit.total)]).reindex(columns=COLUMNS)
    table["response"], table["unit"] = fit.response.name, fit.response.unit_of_fit
    if np.isnan(fit.error) and (judged := lenth(table, fit.confidence)) is not None:
        table.loc[table["effect"].notna(), ["margin_of_error", "simultaneous_margin_of_error"]] = judged[1:]
    return table


def lenth(table: pandas.DataFrame, confidence: float) -> tuple[float, float, float] | None:
    """Pseudo standard error and margins of effects without an error, none of fewer than six (R. V. Lenth, Technometrics 31, 469-473 (1989))."""
    sizes = table.loc[table["factors"].str.len() > 0, "effect"].dropna().abs().to_numpy(float)
    if len(sizes) < 6 or (first := 1.5 * float(np.median(sizes))) <= 1e-12 * sizes.max():
        return None
    if (error := 1.5 * float(np.median(sizes[sizes < 2.5 * first]))) <= 1e-12 * sizes.max():
        return None
    freedom = len(sizes) / 3.0
    tails = [0.5 + 0.5 * confidence, 0.5 + 0.5 * confidence ** (1.0 / len(sizes))]
    margin, simultaneous = (float(stats.t.ppf(tail, freedom)) * error for tail in tails)
    return error, margin, simultaneous


def box_cox(fit: Fitted) -> tuple[float, float, float] | None:
    """Power of the response that the model fits best, and the powers that fit hardly worse; None unless all responses are above 0.

    Likelihood: that of (u^power - 1)/power, u the response by its geometric mean (G. E. P. Box, D. R. Cox, J. R. Stat. Soc. B 26 (1964)).
    """
    responses, basis = fit.response.back(fit.values), fit.fit.basis
    if np.isnan(fit.error) or not (responses > 0).all() or fit.residual_freedom < 3:
        return None
    logarithms = np.log(responses) - np.log(responses).mean()

    def likelihood(power: float) -> float:
        powers = logarithms if abs(power) < 1e-7 else np.expm1(power * logarithms) / power
        left = powers - basis @ (basis.T @ powers)
        return -0.5 * len(left) * float(np.log(left @ left))

    grid = np.linspace(*POWERS, round((POWERS[1] - POWERS[0]) / STEP) + 1)
    near = float(grid[np.argmax([likelihood(power) for power in grid])])
    bounds = max(near - STEP, POWERS[0]), min(near + STEP, POWERS[1])
    best = float(optimize.minimize_scalar(lambda power: -likelihood(power), bounds=bounds, method="bounded", options={"xatol": 1e-9}).x)
    least = likelihood(best) - 0.5 * float(stats.chi2.ppf(fit.confidence, 1))

    def end(powers: list[float]) -> float:
        beyond = next((power for power in powers if likelihood(power) < least), None)
        return [best, *powers][-1] if beyond is None else float(optimize.brentq(lambda at: likelihood(at) - least, best, beyond, xtol=1e-12))

    return best, end(grid[grid < best][::-1].tolist()), end(grid[grid > best].tolist())


def transform_advice(fit: Fitted, found: tuple[float, float, float] | None) -> str:
    """Advice from the best power on the transform; empty where another one would not forecast points better that it does not know."""
    power = TRANSFORMS.get(fit.response.transform)
    if found is None or power is None or found[1] <= power <= found[2]:
        return ""
    left, (best, low, high) = fit.residuals / np.maximum(1.0 - fit.leverages, SOLE), found
    if 1.0 - float(left @ left) / fit.total.sum > 0.999 and misfit(fit) is None:
        # Nobody would see what is to be gained.
        return ""
    allowed = ["none"] if low <= 1.0 <= high else [name for name in ("log", "square root") if low <= TRANSFORMS[name] <= high]
    name = min(allowed, key=lambda name: abs(TRANSFORMS[name] - best), default="")
    said = "try it without transform" if name == "none" else f'try transform = "{name}"'
    if not name:
        said = "none of the transforms is this power; keep the response as it is, and look for a bend in the residuals, "
        said += "which another --model may explain"
    elif fitted(fit.study, replace(fit.response, transform=name), fit.model, confidence=fit.confidence).loo_error > 0.95 * fit.loo_error:
        return ""
    at_end = ", looked for between −5 and 5 alone" if low <= POWERS[0] or high >= POWERS[1] else ""
    return f"Box-Cox: lambda = {best:.2g} ({low:.2g} to {high:.2g}{at_end}): {said}"
