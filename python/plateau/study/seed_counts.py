"""Numbers of sets of seeds that a study needs, from the scatter between those of a pilot."""

import os
import warnings
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import pandas
from scipy import stats

from plateau.errors import InputError, PlateauWarning
from plateau.study.analysis import Effects, effects
from plateau.study.data import Answer, Numbers, Study
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
        A row for each effect: ``response``, ``term``, ``effect``, ``scatter`` (its standard deviation between the sets of the pilot),
        ``half_width`` (the wanted one), ``unit``, ``sets``, and ``sets_safe``, which are enough with 90 % probability although the pilot
        knows the scatter from few sets.
    """

    study: Study
    table: pandas.DataFrame

    def text(self) -> str:
        """The table for people."""
        lines, cells = [f"{self.study.title}: sets of seeds needed, from the scatter between those of the pilot"], []
        for row in self.table.to_dict("records"):
            unit = unit_of(row["unit"], self.table.loc[self.table["response"] == row["response"], "effect"])
            names = {"effect": row["effect"], "scatter": row["scatter"], "half width": row["half_width"]}
            numbers = {name: f"{with_digits(unit.per_si * value)} {unit.of_differences}".strip() for name, value in names.items()}
            sets = {"sets": f"{row['sets']:.0f}", "safe": f"{row['sets_safe']:.0f}"}
            cells.append({"response": row["response"], "term": row["term"], **numbers, **sets})
        return "\n".join([*lines, *listed(cells), ""])


def seeds_needed(
    study: Effects | Study | str | os.PathLike[str], half_width: float | str | dict[str, float | str] | None = None, confidence: float = 0.95
) -> SeedsNeeded:
    """Tells how many sets of seeds give each effect an interval of a wanted half width.

    Parameters
    ----------
    study : path, Study or Effects
        The pilot, with two sets of seeds or more.
    half_width : float or str, or dict of them by response, optional
        Text with a unit, such as ``"0.05 mm2"``; a number is in the SI unit of what is fitted, which a warning says. Without it, that with
        which each effect is told from none.
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
    table = found.table
    table = table[table["standard_error"].notna()]
    fits, rows, bare = {one.response.name: one.fit for one in found.responses}, [], dict[str, str]()
    for row in table.to_dict("records"):
        asked = half_width.get(row["response"]) if isinstance(half_width, dict) else half_width
        if isinstance(asked, int | float) and row["unit"] != "1":
            bare[row["response"]] = f'{row["response"]}: half_width = {asked:g} is taken in {row["unit"]}; give text with a unit'
        try:
            wanted = abs(row["effect"]) if asked is None else quantity(asked, row["unit"], needs_unit=row["unit"] != "1")
        except InputError as error:
            raise InputError(f'{row["response"]}: {error}; give each response its own, such as {{"contact area": "0.02 mm2"}}') from None
        # Sets that have no result yet tell nothing.
        scatter = row["standard_error"] * np.sqrt(fit.seeds if (fit := fits[row["response"]]) else np.nan)
        largest = scatter * np.sqrt(row["error_freedom"] / stats.chi2.ppf(1.0 - SAFE, row["error_freedom"]))
        sets = {"sets": sets_for(scatter, wanted, confidence), "sets_safe": sets_for(float(largest), wanted, confidence)}
        own = {name: row[name] for name in ("response", "term", "effect")}
        rows.append({**own, "scatter": scatter, "half_width": wanted, "unit": row["unit"], **sets})
    for said in bare.values():
        warnings.warn(said, PlateauWarning, stacklevel=2)
    return SeedsNeeded(found.study, pandas.DataFrame(rows))
