"""Predictions: what responses are expected to be where no run was made, and what runs there give."""

import itertools
import os
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas

from plateau.errors import InputError, InputTypeError, PlateauWarning
from plateau.output_folder import plain
from plateau.study.analysis import together, usable
from plateau.study.data import Answer, Study
from plateau.study.kept_values import factor_value
from plateau.study.results import analysed
from plateau.study.runs import made_study
from plateau.study.settings import (
    SAME,
    axis_of,
    beyond_of,
    factor_named,
    held_values,
    in_short,
    joined,
    no_curve,
    region_of,
    straight_between,
    value_of,
)
from plateau.study.surrogate import Surrogate, surrogates
from plateau.text_tables import listed, read_text_table
from plateau.units import Unit, unit_for, unit_of, with_digits, with_minus, with_unit

# Most places of a grid.
MOST_PLACES = 1_000_000
INTERVALS = ["mean_low", "mean_high", "run_low", "run_high"]


@dataclass(frozen=True, repr=False)
class Prediction(Answer):
    """Forecasts of the responses of a study at places.

    Attributes
    ----------
    places : pandas.DataFrame
        A column for each factor, SI units or words.
    given : list of str
        Factors that were set; others are in the middle of their range, or at their first level.
    table : pandas.DataFrame
        A row for each place and response: ``place`` (from 1), factors, ``response``, ``unit``, ``value``, ``mean_low``, ``mean_high`` (of the mean
        over all seeds), ``run_low``, ``run_high`` (of one more run), ``leverage``, ``beyond`` (factors outside the runs), ``cautions``, and of
        runs there ``confirmed``, ``confirmed_error``, ``confirmed_runs``, ``is_within`` the interval of runs. SI units.
    """

    study: Study
    places: pandas.DataFrame
    given: list[str]
    table: pandas.DataFrame
    surrogates: list[Surrogate]
    confidence: float
    cautions: list[str]

    @property
    def wide(self) -> pandas.DataFrame:
        """A row for each place: what ``--output`` writes."""
        # As in results.csv: numbers in the unit of the study.
        numbers = {factor.name: factor.in_study_unit(self.places[factor.name]) for factor in self.study.factors if factor.is_number}
        heads = {factor.name: with_unit(factor.name, factor.study_unit) for factor in self.study.factors}
        wide = self.places.assign(**numbers).rename(columns=heads)
        names = ["value", *INTERVALS] + ["confirmed", "confirmed_error", "confirmed_runs"] * bool(self.table["confirmed_runs"].any())
        for response in self.study.responses:
            rows = self.table[self.table["response"] == response.name]
            for name in names:
                words = {"value": "", "confirmed_error": "confirmed standard error"}.get(name, name.replace("_", " "))
                head = with_unit(f"{response.name} {words}".strip(), "" if name == "confirmed_runs" else response.unit)
                wide[head] = rows[name].to_numpy()
        at_place = self.table.groupby("place", sort=False)
        return wide.assign(beyond=at_place["beyond"].first().to_numpy(), cautions=[joined(own["cautions"]) for _, own in at_place])

    def document(self) -> dict[str, Any]:
        """The JSON of ``plateau sweep predict --json``, SI units."""
        places = []
        for (_, rows), (_, place) in zip(self.table.groupby("place", sort=False), self.places.iterrows(), strict=True):
            told, beyond = plain(rows.to_dict("records")), list(filter(None, rows["beyond"].iloc[0].split("; ")))
            responses = [reported(row, one.error) for row, one in zip(told, self.surrogates, strict=True)]
            for report, row in zip(responses, told, strict=True):
                report |= {"leverage": row["leverage"], "cautions": list(filter(None, row["cautions"].split("; ")))}
            made = confirmed if any(confirmed := list(map(confirmed_by, told))) else None
            settings = settings_at(self.study, place, self.given)
            places.append({"settings": settings, "beyond": beyond, "responses": responses, "confirmed": made})
        found = {"study": self.study.title, "confidence": self.confidence, "region": region_of(self.study), "cautions": self.cautions}
        return found | {"models": [surrogate.words or None for surrogate in self.surrogates], "places": places}

    def text(self) -> str:
        """The text that ``plateau sweep predict`` prints."""
        lines: list[str] = []
        for (number, rows), (_, place) in zip(self.table.groupby("place", sort=False), self.places.iterrows(), strict=True):
            asked = {one.name: "" if one.name in self.given else " (not given)" for one in self.study.factors}
            where = ", ".join(f"{one.name} = {one.shown(place[one.name])}{asked[one.name]}" for one in self.study.factors)
            lines += [self.study.title if number == 1 else "", f"  at {where}"]
            cells = []
            for row in rows.to_dict("records"):
                unit, cell = forecast_cells(self.study, row, self.confidence)
                cell |= {"confirmed": confirmed_words(row, unit)} if rows["confirmed_runs"].any() else {}
                cells.append(cell | {"": row["beyond"]} if row["beyond"] else cell)
            lines += listed(cells)
        made = self.table[self.table["confirmed_runs"] > 0]
        if len(self.places) > 1 and len(made):
            for name, rows in made.groupby("response", sort=False):
                apart = float(np.sqrt(np.square(rows["confirmed"] - rows["value"]).mean()))
                within = f"{int(rows['is_within'].sum())} of {len(rows)} places within the interval of runs"
                far = unit_for(rows["unit"].iloc[0], apart).text(apart, is_difference=True)
                lines.append(f"  {name}: means of runs are {far} apart, {within}")
        lines += [f"  {one.response.name}: {one.error or one.reason}" for one in self.surrogates if one.process is not None or one.error]
        return with_minus("\n".join([*lines, *(f"  caution: {caution}" for caution in self.cautions), ""]))


def forecast_cells(study: Study, row: dict[Any, Any], confidence: float) -> tuple[Unit, dict[str, str]]:
    """The unit of a forecast, and its value and intervals for people; digits follow the interval."""
    unit, level = unit_of(row["unit"], study.runs[row["response"]]), f"{100 * confidence:g} %"
    ends = [unit.value(row[name]) for name in INTERVALS]
    width = (ends[1] - ends[0]) / 2 if np.isfinite(ends[0]) else np.nan
    value, *shown = (with_digits(value, width) or "–" for value in (unit.value(row["value"]), *ends))
    pairs = [" … ".join(shown[at : at + 2]) if np.isfinite(ends[at]) else "–" for at in (0, 2)]
    name = ", ".join(filter(None, [row["response"], unit.symbol]))
    return unit, {"response": name, "predicted": value, f"{level} of means": pairs[0], f"{level} of runs": pairs[1]}


def confirmed_words(row: dict[Any, Any], unit: Unit) -> str:
    """Result of runs at a place, mean ± standard error, for people."""
    judged = "" if row["is_within"] is None else f", {'within' if row['is_within'] else 'outside'} the interval of runs"
    return f"{unit.text(row['confirmed'], row['confirmed_error'])}, {row['confirmed_runs']:.0f} runs{judged}"


def settings_at(study: Study, place: pandas.Series, given: Sequence[str]) -> list[dict[str, Any]]:
    """Values of the factors at a place for JSON."""
    return [
        {"factor": one.name, "value": one.text(place[one.name]), "number": place[one.name] if one.is_number else None, "given": one.name in given}
        for one in study.factors
    ]


def reported(row: dict[Any, Any], error: str) -> dict[str, Any]:
    """A forecast of a response for JSON."""
    ends = {of: [row[f"{of}_low"], row[f"{of}_high"]] for of in ("mean", "run")}
    intervals = {f"{of}_interval": None if None in end else end for of, end in ends.items()}
    return {"name": row["response"], "unit": row["unit"], "value": row["value"], **intervals, "error": error or None}


def confirmed_by(row: dict[Any, Any]) -> dict[str, Any] | None:
    """Result of runs at the place, for JSON; None without any."""
    count = int(row["confirmed_runs"])
    made = {"runs": count, "mean": row["confirmed"], "standard_error": row["confirmed_error"]}
    return {**made, "within_run_interval": row["is_within"]} if count else None


def predict(
    study: Study | str | os.PathLike[str], at: Mapping[str, Any] | Sequence[str] = (), grid: int | None = None,
    points: pandas.DataFrame | str | os.PathLike[str] | None = None, *, extrapolate: bool = False, confirm: bool = False,
    model: str | None = None, confidence: float = 0.95, jobs: int | None = None, workers: int | None = None, progress: bool | None = None,
) -> Prediction:  # fmt: skip
    """Predicts the responses of a study.

    Parameters
    ----------
    study : path or Study
    at : dict or list of str
        Values of factors, such as ``{"load": "7 N"}``, ``{"load": 7.0}`` (SI) or ``["load=7 N"]``. Others are in the middle of their range, or
        at their first level.
    grid : int, optional
        Predict at so many values of each range and at all levels, but for factors of `at`.
    points : path or DataFrame, optional
        Predict at the rows of a table (CSV): a column for each factor, such as ``load [N]``, or ``load`` with quantities or SI units.
    extrapolate : bool
        Predict beyond the runs, too.
    confirm : bool
        Make runs there, with all seeds of the study.
    model : str, optional
        See `effects`.
    confidence : float
        Level of the intervals.
    jobs, workers, progress
        See ``plateau.sweep``.

    Returns
    -------
    Prediction

    Examples
    --------
    >>> predict("loads.toml", {"load": "7 N"}).table[["response", "value", "mean_low", "mean_high", "unit"]]
    """
    opened = usable(analysed(study))
    known = surrogates(opened, model, confidence)
    is_curved = all(one.fit.model == "quadratic" for one in known if one.fit)
    if not isinstance(at, Mapping) and not all(isinstance(text, str) for text in at):
        raise InputTypeError(f'at = {at!r}: expected a dictionary, such as {{"load": "7 N"}}; several places are points=DataFrame(...)')
    held = held_values(opened, at, "--at", is_curved)
    if points is not None:
        places, given = _rows(opened, points, held, is_curved)
    else:
        # A grid of very many is refused before it is made.
        step = min(grid or 0, MOST_PLACES + 1)
        axes = {one.name: [held[one.name]] if one.name in held else axis_of(one, step, is_curved) for one in opened.factors}
        if step > MOST_PLACES or np.prod([float(len(axis)) for axis in axes.values()]) > MOST_PLACES:
            raise InputError(f"--grid {grid}: more than {MOST_PLACES} places; hold factors with --at")
        places = pandas.DataFrame(list(itertools.product(*axes.values())), columns=list(axes))
        given = list(axes) if grid else list(held)
    beyond = beyond_of(opened, places)
    if not extrapolate and (first := next((at for at, said in enumerate(beyond) if said), None)) is not None:
        which = f"place {first + 1}: " if len(places) > 1 else ""
        raise InputError(f"{which}{beyond[first]}; the model knows nothing there, give --extrapolate to see what it says nevertheless")
    made = made_study(opened, places, jobs=jobs, workers=workers, progress=progress).runs if confirm else None
    general = [*together(opened), *no_curve(straight_between(opened, places))]
    for said in general:
        warnings.warn(said, PlateauWarning, stacklevel=2)
    tables = [forecast_table(one, places, beyond, confidence, made, general) for one in known]
    cautions = general + [f"{one.response.name}: {said}" for one, table in zip(known, tables, strict=True) for said in table.attrs["cautions"]]
    table = pandas.concat([table.assign(own=own) for own, table in enumerate(tables)]).sort_values(["place", "own"], ignore_index=True)
    return Prediction(opened, places, given, table.drop(columns="own"), known, confidence, cautions)


def forecast_table(
    one: Surrogate, places: pandas.DataFrame, beyond: list[str], confidence: float, made: pandas.DataFrame | None, general: list[str]
) -> pandas.DataFrame:
    """Forecasts of a response, with what is to be known of each; `general` is to be known of all responses."""
    names, response, notes = ["value", *INTERVALS, "leverage"], one.response, [*one.cautions, *one.of_chance]
    found = one.forecast(places, confidence)[names] if one.fit else pandas.DataFrame(np.nan, index=places.index, columns=names)
    said: list[list[str]] = [[] for _ in range(len(places))]
    most = one.fit.most_leverage if one.fit else np.inf
    bounds = [bound for bound in (response.low, response.high) if np.isfinite(bound)]
    is_cut = found[["value", *INTERVALS]].isin(bounds).any(axis=1)
    advice = "" if response.transform != "none" else f'; transform = "{"logit" if response.high == 1.0 else "log"}" keeps to what can be'
    is_far, is_untold = found["leverage"] > most * (1.0 + SAME), found["mean_low"].isna() & (one.fit is not None)
    of_all = in_short([*general, *notes])
    marked = {
        f"extrapolation: leverage is above {most:.3g}, the largest of the runs": is_far,
        "no interval: the runs do not tell it there, or leave no error; terms that cannot be told from others count as nothing": is_untold,
        f"cut: intervals are cut at {' and '.join(f'{bound:g}' for bound in bounds)}, for less or more cannot be{advice}": is_cut,
    }
    for long, marks in marked.items():
        if marks.any():
            notes.append(long + (f" ({int(marks.sum())} of {len(places)} places)" if len(places) > 1 else ""))
        for at in np.flatnonzero(marks):
            said[at].append(long.split(":")[0])
    cautions = [joined([of_all, *own]) for own in said]
    table = places.assign(response=response.name, unit=response.unit, **found, beyond=beyond, cautions=cautions)
    kinds = ["mean", "sem", "count"]
    runs = pandas.DataFrame(columns=kinds) if made is None else made.groupby("point")[response.name].agg(kinds)
    runs = runs.reindex(range(1, len(places) + 1)).astype(float).set_axis(places.index)
    is_known = runs["count"].gt(0) & table["run_low"].notna()
    within = (table["run_low"].le(runs["mean"]) & table["run_high"].ge(runs["mean"])).astype(object).where(is_known, None)
    counts = runs["count"].fillna(0).astype(int)
    table = table.assign(confirmed=runs["mean"], confirmed_error=runs["sem"], confirmed_runs=counts, is_within=within)
    table.insert(0, "place", np.arange(1, len(places) + 1))
    table.attrs["cautions"] = notes
    return table


def _rows(study: Study, points: Any, held: dict[str, Any], is_curved: bool) -> tuple[pandas.DataFrame, list[str]]:
    """The rows of a table, and the factors that they have."""
    columns: dict[str, list[Any]] = {}
    if isinstance(points, pandas.DataFrame):
        for head in points.columns:
            factor = factor_named(study, head, f"points: column {head!r}")
            columns[factor.name] = [value_of(factor, value, f"points: row {at}", is_curved) for at, value in enumerate(points[head])]
        count = len(points)
    else:
        table = read_text_table(Path(points))
        count = len(table.rows)
        for column, head in enumerate(table.heads):
            factor = factor_named(study, table.named(column)[0], f"{table.path}: column {head!r}")
            values = (factor_value(table, row, column, factor) for row in range(count))
            columns[factor.name] = [value_of(factor, value, table.place(row), is_curved) for row, value in enumerate(values)]
    rest = {one.name: held.get(one.name, axis_of(one, None, is_curved)[0]) for one in study.factors}
    places = pandas.DataFrame({one.name: columns.get(one.name, rest[one.name]) for one in study.factors}, index=range(count))
    return places, [*columns, *held]
