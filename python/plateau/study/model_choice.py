"""Choice of the model that is fitted to a response, and what it misses."""

from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas

from plateau.errors import InputError
from plateau.study.data import Response, Study
from plateau.study.model import CONTRIBUTES, LEAST_FREEDOM, MODELS, ROUNDING, Fitted, NothingToFit, Squares

# Most coefficients of a model that is tried beside another one.
MOST_TRIED = 300
# Values of a number in the runs up to which each is a part of the design; of more the halves of its range are.
MOST_PARTS = 5
NO_CURVE = "no factor that is a number has more than two values"


def fitted(study: Study, response: Response, model: str | None = None, confidence: float = 0.95, centre: bool = False) -> Fitted:
    """Fits a model to a response, with `centre` with a term of centre points; `NothingToFit` if all values are the same, or there are none."""
    if not 0.0 < confidence < 1.0:
        raise InputError(f"confidence level {confidence}: it lies between 0 and 1, such as 0.95")
    if model is not None and model not in MODELS:
        raise InputError(f"model {model!r}: expected one of {', '.join(MODELS)}")
    reason = "as asked for"
    if model is None:
        model, reason = _choice(study, response)
    runs, own = study.runs, _own(study, response)
    values = response.scaled(runs[response.name])
    if (beyond := np.isfinite(runs[response.name].to_numpy(float)) & ~np.isfinite(values)).any():
        takes = {"log": "more than 0", "square root": "of at least 0", "logit": "more than 0 and less than 1"}[response.transform]
        found = f"run {runs.index[beyond][0]} has the response {runs[response.name][beyond].iloc[0]:.6g} {response.unit}"
        advice = f'transform = "{response.transform}" takes values {takes}: leave the transform out, or ask for another response'
        raise InputError(f'{study.path or study.directory}: response "{response.name}": {found}, and {advice}')
    has = own & np.isfinite(values)
    missing, values = int((own & ~has).sum()), values[has]
    if not len(values):
        raise NothingToFit(f"fewer than two runs have a value of it ({missing} have none)")
    if (largest := float(np.abs(values).max())) > 1e60:
        raise NothingToFit(f"the response {largest:e} is beyond ±1e60")
    if np.ptp(values) <= max(ROUNDING * largest, 1e-60):
        raise NothingToFit(f"the response is {float(values[0])!r} in all {len(values)} observations: no factor has an effect on it")
    return Fitted(study, response, model, runs[has], values, reason, confidence, centre, missing)


def _own(study: Study, response: Response) -> npt.NDArray[np.bool_]:
    """Marks the runs that have a value of their own: what was measured elsewhere was measured for each run by itself."""
    return np.ones(len(study.runs), bool) if not response.series else ~study.runs["same_as"].duplicated().to_numpy()


def _choice(study: Study, response: Response) -> tuple[str, str]:
    """The model that is fitted unless another one is asked for, and why."""
    if study.design in ("central-composite", "box-behnken"):
        return "quadratic", ""
    if study.design == "plackett-burman":
        return "main", "a Plackett-Burman design mixes interactions with main effects"
    if study.design not in ("full-factorial", "fractional-factorial"):
        problem = no_squares(fitted(study, response, "quadratic"))
    else:
        problem = NO_CURVE
        if any(factor.is_range and study.runs[factor.name].nunique() > 2 for factor in study.factors):
            problem = "centre points tell of a curve, and not in which factor"
        if any(factor.is_number and not factor.is_range and len(factor.levels) > 2 for factor in study.factors):
            problem = "levels are compared one by one, which shows curves, too"
    return ("interactions", f"no squares: {problem}") if problem else ("quadratic", "")


def no_squares(fit: Fitted) -> str:
    """Reason why the runs do not allow the quadratic model that was fitted; empty if they do."""
    if not any(fit.is_curved):
        return NO_CURVE
    # Squares of numbers with two values are part of the mean.
    squares = {columns.start: term[0] for term, columns in zip(fit.terms, fit.columns[2:], strict=True) if len({*term}) < len(term)}
    straight = {column for column, at in squares.items() if not fit.is_curved[at]}
    coefficients = fit.design.shape[1] - len(straight)
    if (needed := coefficients - fit.seeds + 1) > fit.point_count:
        return f"{fit.point_count} different points are too few for {needed} coefficients"
    if coefficients + LEAST_FREEDOM > len(fit.values):
        return f"{len(fit.values)} runs are too few for {coefficients} coefficients and an error"
    owners = [fit.owner(column) for column in fit.fit.relations if column not in straight]
    aliased = dict.fromkeys(fit.label(fit.terms[at - 2]) if at > 1 else "replicate" for at in owners)
    return f"the runs cannot tell {', '.join(aliased)} from other terms" if aliased else ""


def misfit(fit: Fitted) -> dict[str, Any] | None:
    """Significant misfit of a model, by replicates or by models with all its terms and more (Bonferroni), and the model to try."""
    return _misfit(fit)[0]


# Cautions, advice and JSON ask for it, and each time all other models would be fitted.
@lru_cache(maxsize=32)
def _misfit(fit: Fitted) -> tuple[dict[str, Any] | None, Fitted | None]:
    """Misfit of a model, and the fit of the model to try."""
    if np.isnan(fit.error):
        return None, None
    own, level = fit.residual, 1.0 - fit.confidence
    others = [other for model in ("main", "interactions", "quadratic", "full") if model != fit.model and (other := _other(fit, model))]
    _, _, f, p = fit.lack_of_fit
    if by_replicates := p < level:
        found = [(f, p, other) for other in others if other.residual.mean < own.mean and other.residual.sum < own.sum]
    else:
        # Those of which each column of the model is a combination.
        most = CONTRIBUTES * np.maximum(np.linalg.norm(fit.design, axis=0), 1.0)
        larger = [other for other in others if (np.linalg.norm(other.fit.residuals(fit.design), axis=0) <= most).all()]
        larger = [other for other in larger if other.residual_freedom < own.freedom]
        added = [Squares(own.freedom - other.residual_freedom, max(own.sum - other.residual.sum, 0.0)) for other in larger]
        both = zip(added, larger, strict=True)
        tests = [fit.beyond(new, other.residual, other.design)[1:] if other.residual.sum > 0 else (np.inf, 0.0) for new, other in both]
        found = [(*test, other) for test, other in zip(tests, larger, strict=True) if test[1] < level / len(larger)]
        if not found:
            return None, None
    f, p, best = min(found, key=lambda one: one[2].residual.mean, default=(f, p, None))
    tried = {"model_to_try": best and best.model, "r_squared": best and 1.0 - best.residual.sum / best.total.sum}
    return {"f": f if np.isfinite(f) else None, "p": p, "by_replicates": by_replicates, **tried}, best


def _other(fit: Fitted, model: str) -> Fitted | None:
    """Another model of the same response; None if it cannot be fitted or leaves no error."""
    try:
        other = _with(fit, model)
    except InputError:
        return None
    # Squares that the runs do not allow are no advice.
    is_told = other.design.shape[1] <= MOST_TRIED and other.residual_freedom > 0
    return other if is_told and not (model == "quadratic" and no_squares(other)) else None


def _with(fit: Fitted, model: str) -> Fitted:
    """The fit of a model to the same response."""
    return fit if model == fit.model else fitted(fit.study, fit.response, model, fit.confidence, bool(fit.centre))


def replicates_advice(fit: Fitted) -> str:
    """Advice on what gives the effects of a saturated model an error."""
    smaller = ", or the smaller --model main" if _with(fit, "main").residual_freedom > 0 else ""
    return f"give [replicates] of seeds, such as those of the disc{smaller}"


def of_missing(fit: Fitted) -> list[str]:
    """Caution that runs have no value of the response, with the part of the design that has most of them."""
    if not fit.missing:
        return []
    runs, parts = fit.study.runs[_own(fit.study, fit.response)], list[tuple[str, npt.NDArray[np.bool_]]]()
    lacks = ~runs.index.isin(fit.runs.index)
    for factor in fit.study.factors:
        values = runs[factor.name].to_numpy()
        coded = np.round(factor.coded(values), 9) if factor.is_number else values
        if factor.is_number and len(np.unique(coded)) > MOST_PARTS:
            middle = factor.shown(float(factor.value(0.0)), 4)
            parts += [(f"{factor.name} below {middle}", coded < 0.0), (f"{factor.name} above {middle}", coded > 0.0)]
        else:
            parts += [(f"{factor.name} = {factor.shown(values[own.argmax()], 4)}", own) for own in (coded == one for one in dict.fromkeys(coded))]
    # Of those without a value that with most more than an even share.
    name, part = max(parts, key=lambda one: lacks[one[1]].sum() - lacks.mean() * one[1].sum())
    is_even = lacks[part].mean() <= lacks.mean() * (1.0 + 1e-9)
    where = f" (run {runs.index[lacks][0]})" if fit.missing == 1 else "" if is_even else f" ({lacks[part].sum()} of the {part.sum()} with {name})"
    said = f"{fit.missing} of {len(runs)} runs {'has' if fit.missing == 1 else 'have'} no value of it{where}: if such runs lack it because of "
    said += "how large it is there, as those do that have not run in, results are biased, and intervals do not tell by how much; "
    return [said + "make these runs, or longer ones, or take a response that all runs have"]


def cautions(fit: Fitted) -> list[str]:
    """Cautions to read before the model is believed: a sentence each."""
    said = of_missing(fit)
    missed, best = _misfit(fit)
    if missed is not None:
        p = "p < 0.0001" if missed["p"] < 1e-4 else f"p = {missed['p']:.2g}"
        better = 'no other --model explains more; narrow the ranges, or try scale = "logarithmic" for a factor'
        if best is not None:
            share = f"R² {missed['r_squared']:.4f} instead of {1.0 - fit.residual.sum / fit.total.sum:.4f}"
            better = f"try --model {best.model}, which explains more, {share}"
            if best.point_count <= len(best.own):
                better = f"--model {best.model} explains more, {share}, but all points: make runs at others, such as centre points"
        how = ": points differ from the model by more than replicates from each other" if missed["by_replicates"] else ""
        said.append(f"lack of fit{how} ({p}); {better}")
    if (freedom := fit.point_count - len(fit.own)) <= 0:
        smaller = " or --model main" if (main := _with(fit, "main")).point_count > len(main.own) else ""
        said.append(f"as many coefficients as points: runs cannot show what the model misses; more points{smaller} would")
    elif freedom < LEAST_FREEDOM:
        few = f"few points: {fit.point_count} for {len(fit.own)} coefficients"
        said.append(f"{few}, so that the fit hardly shows what the model misses")
    if fit.seeds == 1 and fit.response.series:
        said.append("one set of seeds: intervals hold for these seeds alone; [replicates] with several tell of others")
    if fit.seeds < 2 or np.isnan(fit.error):
        return said
    errors = fit.combined(np.eye(len(fit.coefficients)))["standard_error"]
    if same := _same(fit, errors):
        said.append(f"effects that do not differ between sets of seeds have no interval, F and p: {', '.join(same)}")
    if untested := _untested(fit, errors):
        said.append(untested)
    elif fit.seeds == 2 and len(same) < len(fit.terms):
        wide = "two sets of seeds leave one degree of freedom for the error, and intervals are wide"
        said.append(f"{wide}; a third makes them about 3.6 times as narrow")
    return said


def _same(fit: Fitted, errors: pandas.Series) -> list[str]:
    """Labels of the terms whose coefficients are the same in all sets of seeds."""
    own = [(term, [at for at in fit.own if columns.start <= at < columns.stop]) for term, columns in zip(fit.terms, fit.columns[2:], strict=True)]
    return [fit.label(term) for term, places in own if places and (errors[places] == 0.0).all()]


def _untested(fit: Fitted, errors: pandas.Series) -> str:
    """Caution that effects have no error, for sets of seeds lack points; empty if all have one."""
    without = dict.fromkeys(fit.label(fit.terms[fit.owner(at) - 2]) for at in fit.own if at and np.isnan(errors[at]))
    if not without:
        return ""
    missing, places = [], fit.runs.drop_duplicates("point").set_index("point")
    for replicate, own in fit.runs.groupby("replicate")["point"]:
        if len(others := places.drop(own.unique())):
            first = ", ".join(f"{factor.name} = {factor.shown(others[factor.name].iloc[0])}" for factor in fit.study.factors)
            missing.append(f"replicate {replicate} has no result at {len(others)} of {len(places)} points, such as {first}")
    why = f"their error is what they differ by between sets of seeds, and too few points have all sets ({'; '.join(missing)})"
    return f"effects without interval: {', '.join(without)}; {why}; make these runs, or take the set that lacks most out of `seeds`"
