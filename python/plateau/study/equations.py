"""Equations of fitted models, in coded units and in the units of the study."""

import itertools

import numpy as np
import pandas

from plateau.study.data import Numbers
from plateau.study.model import ROUNDING, Fitted, contrasts, named

# Terms of an equation beyond which nobody reads it.
MOST_TERMS = 4096
# What a coefficient is multiplied by: numbers (0, factor), levels (1, factor, level) and centre points (2,), in this order.
Product = tuple[tuple[int, ...], ...]


def equations(fit: Fitted) -> dict[str, pandas.DataFrame]:
    """By ``"coded"`` and ``"of the study"``, the ``variables`` of each product and its ``coefficient``; nothing where there are too many."""
    found = {}
    for units in ("coded", "of the study"):
        parts = [_parts(fit, at, units) for at in range(len(fit.codings))]
        sums: dict[Product, list[float]] = {(): [fit.coefficients[0]]}
        for term, columns in zip(fit.terms, fit.columns[2:], strict=True):
            choices: list[list[dict[Product, float]]] = [parts[at] for at in term] if term else [[{((2,),): 1.0}]]
            for own, value in zip(itertools.product(*choices), _without_rounding(fit, columns), strict=True):
                for factors in itertools.product(*(each.items() for each in own)):
                    product = tuple(sorted(itertools.chain.from_iterable(key for key, _ in factors)))
                    sums.setdefault(product, []).append(value * float(np.prod([weight for _, weight in factors])))
            if len(sums) > MOST_TERMS:
                return {}
        # What is smaller than the rounding of its parts is nothing.
        kept = {key: sum(parts) for key, parts in sums.items() if not key or abs(sum(parts)) > 0.25 * ROUNDING * sum(map(abs, parts))}
        rows = [(_words(fit, key), kept[key]) for key in sorted(kept, key=lambda key: (len(key), key))]
        found[units] = pandas.DataFrame(rows, columns=["variables", "coefficient"])
    return found


def _without_rounding(fit: Fitted, columns: slice) -> Numbers:
    return np.where(np.abs(fit.coefficients[columns]) <= fit.rounding, 0.0, fit.coefficients[columns])


def _parts(fit: Fitted, at: int, units: str) -> list[dict[Product, float]]:
    """What each column of a factor is: a multiple of its number and a constant, or multiples of its levels."""
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
