"""Numbers of sets of seeds that a study needs, from the scatter between those of a pilot."""

import itertools
import os
import warnings
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import pandas
from scipy import stats

from plateau.errors import InputError, PlateauWarning
from plateau.study.analysis import Effects, effects
from plateau.study.data import Answer, Numbers, Study
from plateau.study.model import Fitted
from plateau.study.settings import in_short
from plateau.text_tables import listed
from plateau.units import quantity, unit_of, with_digits

# Beyond this nobody runs them.
MOST_SETS = 100_000
# Probability with which the larger number is enough.
SAFE = 0.9


@lru_cache
def _reaches(confidence: float) -> Numbers:
    """Half widths of intervals of means of 2, 3, ... values over their scatter."""
    count = np.arange(2, MOST_SETS + 1)
    return np.asarray(stats.t.ppf(0.5 + 0.5 * confidence, count - 1) / np.sqrt(count))


def sets_for(scatter: float, half_width: float, confidence: float = 0.95) -> float:
    """The smallest n with t(n - 1) scatter / sqrt(n) <= half width, that of the interval of a mean; infinite beyond 100 000."""
    enough = _reaches(confidence) * scatter <= half_width
    return 2.0 + float(enough.argmax()) if enough[-1] else np.inf


@dataclass(frozen=True, repr=False)
class SeedsNeeded(Answer):
    """Numbers of sets of seeds.

    Attributes
    ----------
    table : pandas.DataFrame
        A row for each effect, of three levels and more for the largest difference between two of them: ``response``, ``term``, ``effect``,
        ``scatter`` (its standard deviation between the sets of the pilot), ``half_width`` (the wanted one), ``unit``, ``sets``, and
        ``sets_safe``, which are enough with 90 % probability although the pilot knows the scatter from few sets; ``cautions``, in short.
    cautions : list of str
        What the numbers do not tell, and effects without one.
    """

    study: Study
    table: pandas.DataFrame
    cautions: list[str]

    def text(self) -> str:
        """The table for people."""
        lines, cells = [f"{self.study.title}: sets of seeds needed, from the scatter between those of the pilot"], []
        for row in self.table.to_dict("records"):
            unit = unit_of(row["unit"], self.table.loc[self.table["response"] == row["response"], "effect"])
            names = {"effect": row["effect"], "scatter": row["scatter"], "half width": row["half_width"]}
            numbers = {name: f"{with_digits(unit.per_si * value)} {unit.of_differences}".strip() for name, value in names.items()}
            sets = {"sets": f"{row['sets']:.0f}", "safe": f"{row['sets_safe']:.0f}"}
            cells.append({"response": row["response"], "term": row["term"], **numbers, **sets})
        return "\n".join([*lines, *listed(cells), *(f"  caution: {caution}" for caution in self.cautions), ""])


def seeds_needed(
    study: Effects | Study | str | os.PathLike[str], half_width: float | str | dict[str, float | str] | None = None, confidence: float = 0.95
) -> SeedsNeeded:
    """Tells how many sets of seeds give each effect an interval of a wanted half width.

    Parameters
    ----------
    study : path, Study or Effects
        The pilot, with two sets of seeds or more.
    half_width : float or str, or dict of them by response, optional
        Text with a unit, such as ``"0.05 mm2"``; a number is in the SI unit of what is fitted, which a warning says. Without it, the size of
        each effect; with so many sets its interval leaves out 0 in about half of all cases, with very few sets in more, and with those for half
        its size in 97 %.
    confidence : float

    Returns
    -------
    SeedsNeeded

    Raises
    ------
    InputError
        If the pilot has one set of seeds.
    """
    found = study if isinstance(study, Effects) else effects(study, confidence=confidence)
    if found.study.seeds < 2:
        raise InputError(f"{found.study.title}: one set of seeds shows no scatter; give [replicates] two at least, better five")
    fits, rows, bare = {one.response.name: one.fit for one in found.responses if one.fit}, [], dict[str, str]()
    every = [row for name, fit in fits.items() for row in _sizes(fit, found[name].table)]
    for row in (row for row in every if np.isfinite(row["standard_error"])):
        asked = half_width.get(row["response"]) if isinstance(half_width, dict) else half_width
        if isinstance(asked, int | float) and row["unit"] != "1":
            bare[row["response"]] = f"{row['response']}: half_width = {asked:g} is taken in {row['unit']}; give text with a unit"
        try:
            wanted = abs(row["effect"]) if asked is None else quantity(asked, row["unit"], needs_unit=row["unit"] != "1")
        except InputError as error:
            raise InputError(f'{row["response"]}: {error}; give each response its own, such as {{"contact area": "0.02 mm2"}}') from None
        # Sets that have no result yet tell nothing.
        scatter = row["standard_error"] * np.sqrt(fits[row["response"]].seeds)
        largest = scatter * np.sqrt(row["error_freedom"] / stats.chi2.ppf(1.0 - SAFE, row["error_freedom"]))
        sets = {"sets": sets_for(scatter, wanted, confidence), "sets_safe": sets_for(float(largest), wanted, confidence)}
        own = {name: row[name] for name in ("response", "term", "effect")}
        rows.append({**own, "scatter": scatter, "half_width": wanted, "unit": row["unit"], **sets})
    for said in bare.values():
        warnings.warn(said, PlateauWarning, stacklevel=2)
    of_each = {name: _left_out([row for row in every if row["response"] == name]) for name in fits}
    stated = half_width if isinstance(half_width, dict) else fits if half_width is not None else {}
    of_sizes = [name for name in dict.fromkeys(row["response"] for row in rows) if name not in stated]
    cautions, names = [f"{name}: {caution}" for name, own in of_each.items() for caution in own], ", ".join(of_sizes)
    if of_sizes:
        said = (
            f"half width is the size of each effect{'' if half_width is None else f' of {names}'}: with so many sets the interval of such an effect "
        )
        said += "leaves out 0 in about half of all cases, with very few sets in more; give half of its size as half_width, with which it does in 97 %"
        cautions.insert(0, said)
    short = {name: in_short([*(cautions[:1] if name in of_sizes else []), *own]) for name, own in of_each.items()}
    return SeedsNeeded(found.study, pandas.DataFrame([{**row, "cautions": short[row["response"]]} for row in rows]), cautions)


def _sizes(fit: Fitted, table: pandas.DataFrame) -> list[dict[Any, Any]]:
    """Rows of the effects in the analysis of variance; of a factor with three levels or more with the largest difference between two of them."""
    rows = table[table["factors"].notna() & (table["term"] != "replicate")].to_dict("records")
    return [row | _largest(fit, *row["factors"]) if len(row["factors"]) == 1 and fit.codings[row["factors"][0]].width > 1 else row for row in rows]


def _largest(fit: Fitted, at: int) -> dict[str, Any]:
    """The largest difference between two levels of a factor, over all levels of the others; nothing if the runs tell none, or no error."""
    factor, levels = fit.codings[at].factor, pandas.Series(fit.codings[at].classes)
    means = fit.averaged(levels.to_frame(factor.name))
    pairs = [(one, other) for other, one in itertools.combinations(np.flatnonzero(fit.tells(means)).tolist(), 2)]
    found = fit.combined(np.array([means[one] - means[other] for one, other in pairs]).reshape(len(pairs), means.shape[1]))
    if not (sizes := found["value"].abs().where(found["standard_error"].notna())).notna().any():
        return {}
    one, other = (factor.text(levels[level]) for level in pairs[int(sizes.idxmax())])
    value, deviation, freedom = found.loc[int(sizes.idxmax())]
    return {"term": f"{fit.label((at,))}: {one} less {other}", "effect": value, "standard_error": deviation, "error_freedom": freedom}


def _left_out(rows: list[dict[Any, Any]]) -> list[str]:
    """Cautions about effects that have no number of sets."""
    lacking = {row["term"]: len(row["factors"]) > 1 and row["degrees_of_freedom"] > 1 for row in rows if not np.isfinite(row["standard_error"])}
    whys = {
        True: "an interaction with a factor of three levels or more has no single size; a pilot with two of its levels tells the number",
        False: "the pilot tells no error of it; plateau.study.effects says what is missing",
    }
    named = {why: [term for term, own in lacking.items() if own == is_wide] for is_wide, why in whys.items()}
    return [f"no number of sets for {', '.join(terms)}: {why}" for why, terms in named.items() if terms]
