"""Effects for people: words and tables, equations in coded units and in the units of the study."""

import itertools

import numpy as np
import pandas

from plateau.study.model import MODELS, ROUNDING, Fitted, contrasts, named
from plateau.study.model_choice import replicates_advice
from plateau.study.response_effects import ResponseEffects
from plateau.text_tables import aligned
from plateau.units import Unit, unit_for, with_digits, with_minus

# Terms of an equation beyond which nobody reads it.
MOST_TERMS = 4096
# What a coefficient is multiplied by: numbers (0, factor), levels (1, factor, level) and centre points (2,), in this order.
Product = tuple[tuple[int, ...], ...]


def told(one: ResponseEffects) -> tuple[list[str], list[list[str]], list[str]]:
    """Words about a response, the rows of its table with their heads, and the lines below it."""
    if (fit := one.fit) is None:
        return [one.response.name, one.error], [], []
    unit, table, summary = unit_for(one.unit, float(np.abs(fit.values).max())), one.table, one.summary
    unit = Unit(one.unit, 1.0) if unit.offset else unit
    scale, symbol = unit.per_si, f" {unit.symbol}".rstrip()
    lines = [one.response.name, f"model: {MODELS[fit.model]}" + (f"; {fit.reason}" if fit.reason else "")]
    names = {"R²": "r_squared", "adjusted R²": "adjusted_r_squared", "predicted R²": "predicted_r_squared"}
    names["of points left out"] = "predicted_r_squared_of_points"
    quality = [f"{name} {summary[key]:.4f}" for name, key in names.items() if np.isfinite(summary[key])]
    missed, _, _, p = fit.lack_of_fit
    why = "nothing tells its error" if missed.freedom > 0 else "nothing is left for it"
    why = why if fit.scatter[0].freedom else "no point has replicates"
    quality.append(f"lack of fit not tested: {why}" if np.isnan(p) else f"lack of fit p {'< 0.0001' if p < 1e-4 else f'= {p:.2g}'}")
    error = f"error {'' if np.isnan(fit.error) else 'from '}{summary['error_from']}"
    error += f"; residual {with_digits(fit.error**0.5 * scale)}{symbol}" if np.isfinite(fit.error) else ""
    if fit.residual_freedom == 0:
        error += f", so no interval can be told: {replicates_advice(fit)}"
    for _, margins in table[["margin_of_error", "simultaneous_margin_of_error"]].dropna().head(1).iterrows():
        error += ", margin of error {}, simultaneous {} (Lenth)".format(*(with_digits(value * scale) for value in margins))
    missing = f", {fit.missing} without a response" if fit.missing else ""
    lines += [", ".join(quality), f"{len(fit.values)} runs{missing}, mean {with_digits(fit.mean * scale)}{symbol}, {error}"]
    lines += [f"all results are those of {one.title}"] if one.response.transform != "none" else []
    lines += [f"caution: {caution}" for caution in one.cautions] + ([one.advice] if one.advice else [])
    interval = f"{100 * fit.confidence:.4g} % interval"
    rows = [["term", f"effect,{symbol}" if symbol else "effect", interval, "share", "df", "error df", "F", "p"]]
    parts = ["lack of fit", "pure error"] if fit.lack_of_fit[0].freedom > 0 else []
    left_over = table[table["factors"].isna() & table["term"].isin(["residual", *parts])]
    for row in pandas.concat([one.terms.sort_values("share", ascending=False, kind="stable"), left_over]).to_dict("records"):
        width = (row["high"] - row["low"]) / 2 * scale
        interval = " … ".join(with_digits(row[end] * scale, width) for end in ("low", "high")) if np.isfinite(width) else ""
        freedom = f"{row['error_freedom']:.3g}" if np.isfinite(row["error_freedom"]) else ""
        name = ("  " if row["term"] in parts else "") + row["term"]
        cells = [name, with_digits(row["effect"] * scale, width), interval, f"{100 * row['share']:.1f} %"]
        rows.append([*cells, str(row["degrees_of_freedom"]), freedom, with_digits(row["f"]), with_digits(row["p"])])
    aliased = [(row["term"], ", ".join(row["aliased_with"])) for row in table.to_dict("records") if row["aliased_with"]]
    below = [f"{term} cannot be told from {others}" for term, others in aliased]
    for units, products in one.equations.items():
        said = "in coded units, −1 to 1 over each range" if units == "coded" else "in the units of the study"
        signed = [("−" if value < 0 else "+", abs(value) * scale, words) for words, value in products.itertuples(index=False)]
        pieces = [f"{sign} {value:.6g} {words}".strip() for sign, value, words in signed]
        below += [f"{said}:", f"  {one.title}{f' [{unit.symbol}]' if symbol else ''} = {' '.join(pieces).removeprefix('+ ')}"]
    if any("[centre points]" in words for products in one.equations.values() for words in products["variables"]):
        below.append("[centre points] is 1 at the centre points, where a curve shows that is left out elsewhere, and 0 at all other points")
    return list(map(with_minus, lines)), rows, list(map(with_minus, below))


def text_of(one: ResponseEffects) -> str:
    """Text of a response, as ``plateau sweep effects`` prints it."""
    lines, rows, below = told(one)
    return "\n  ".join([*lines, *(aligned(rows, indent="") if rows else []), *below]) + "\n"


def equations(fit: Fitted) -> dict[str, pandas.DataFrame]:
    """Equations by ``"coded"`` and ``"of the study"``: ``variables`` and ``coefficient`` of each product; none if there are too many."""
    found = {}
    for units in ("coded", "of the study"):
        parts = [_parts(fit, at, units) for at in range(len(fit.codings))]
        sums: dict[Product, list[float]] = {(): [fit.coefficients[0]]}
        for term, columns in zip(fit.terms, fit.columns[2:], strict=True):
            choices: list[list[dict[Product, float]]] = [parts[at] for at in term] if term else [[{((2,),): 1.0}]]
            for own, value in zip(itertools.product(*choices), fit.coefficients[columns], strict=True):
                for factors in itertools.product(*(each.items() for each in own)):
                    product = tuple(sorted(itertools.chain.from_iterable(key for key, _ in factors)))
                    sums.setdefault(product, []).append(value * float(np.prod([weight for _, weight in factors])))
            if len(sums) > MOST_TERMS:
                return {}
        # What is smaller than the rounding of its parts is nothing.
        kept = {key: sum(parts) for key, parts in sums.items() if abs(sum(parts)) > 0.25 * ROUNDING * sum(map(abs, parts))}
        kept.setdefault((), 0.0)
        rows = [(_words(fit, key), kept[key]) for key in sorted(kept, key=lambda key: (len(key), key))]
        found[units] = pandas.DataFrame(rows, columns=["variables", "coefficient"])
    return found


def _parts(fit: Fitted, at: int, units: str) -> list[dict[Product, float]]:
    """Parts of each column of a factor: a multiple of its number and a constant, or multiples of its levels."""
    coding, factor = fit.codings[at], fit.study.factors[at]
    if coding.is_straight:
        if units == "coded":
            return [{((0, at),): 1.0}]
        low, high = (np.log10 if factor.logarithmic else np.asarray)(factor.in_study_unit(np.array(factor.ends)))
        return [{((0, at),): 2.0 / (high - low)} | ({(): -(low + high) / (high - low)} if low + high else {})]
    levels = [((1, at, factor.levels.index(level)),) for level in coding.classes or ()]
    return [{level: float(weight) for level, weight in zip(levels, column, strict=True) if weight} for column in contrasts(len(levels)).T]


def _words(fit: Fitted, product: Product) -> str:
    """A product in words, such as ``load·speed``, ``load²`` or ``load·[pool contact]``."""
    words = []
    for (kind, *which), same in itertools.groupby(product):
        factor = fit.study.factors[which[0]] if which else None
        level = f"[{factor.name} {factor.shown(factor.levels[which[1]])}]" if factor and kind == 1 else "[centre points]"
        words.append((named(factor) if factor and kind == 0 else level) + "²" * (len(list(same)) - 1))
    return "·".join(words)
