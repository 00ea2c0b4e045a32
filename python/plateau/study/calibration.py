"""Fit to an experiment: which values of keys make runs give what was measured, how well that is known, and whether runs there agree."""

import itertools
import math
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pandas
from scipy import optimize, stats

from plateau.errors import InputError, RunFailed
from plateau.program import call
from plateau.study.data import Factor, Numbers, Study
from plateau.study.likelihood import NEAR, SETTLED, Likelihood, Runs, Target
from plateau.study.measured import measurements
from plateau.output_folder import plain
from plateau.study.results import analysed
from plateau.study.runs import finished, made_study
from plateau.units import shown_unit, unit_for, with_minus

# Points before the next fit; points that are kept for the most likely place; rounds without a gain after which none is expected.
AT_A_TIME, RESERVE, PATIENCE = 4, 2, 3
# Confidence of the check of a forecast, and by how much -2 ln L may be above the least at a place that runs have checked.
CHECK, SAME = 0.99, 1.0
# Places of a profile, and along each key of a region: without other keys, and where each place is a search.
PLACES, SIDES = 41, (41, 15)
# Exponents of products below this are none; how many times as well as its leading key a product is known that is told beside the keys.
EXPONENT, BETTER = 0.05, 3.0
ENDS = {
    "settled": "further runs are expected to change little",
    "budget": "the limit of runs in [fit] is reached",
    "nowhere else": "every place that counts was run",
    "no gain": "more would hardly help, for runs scatter too much",
    "no runs": "what is fitted was imported, and no runs are made",
}


@dataclass(frozen=True)
class Outcome:
    """The last fit, how many were made one after the other, why no more runs were (one of `ENDS`), and runs at most likely places."""

    likelihood: Likelihood
    rounds: int
    ended: str
    checks: list[dict[str, Any]]

    @property
    def has_failed(self) -> bool:
        """Whether runs contradict the forecast at the most likely place."""
        return bool(self.checks) and not self.checks[-1]["held"]


def calibrated(target: Target, runs: Runs, make: Callable[[Numbers], Runs], seeds: int, most: int, can_run: Sequence[bool]) -> Outcome:
    """Makes runs where they teach most, and the last of them at the most likely place; where these contradict, all is fitted again.

    `make` makes runs at coded places with all seeds; `can_run` tells of each measurement whether runs give it.
    """
    shares, checks, ended = list[float](), list[dict[str, Any]](), ""
    asked = np.array([])
    for rounds in itertools.count(1):
        likelihood = Likelihood(target, runs)
        asked = np.array([can_run[term.of] for term in likelihood.terms])
        if checks:
            # What the runs say themselves: the place that they were made at is still the most likely one, or nearly.
            last = checks[-1]
            last["rise"] = float(likelihood.rise(last["place"])[0])
            last["held"] = last["held"] and last["rise"] <= SAME and not likelihood.agrees_by_ignorance
            if last["held"]:
                return Outcome(likelihood, rounds, ended, checks)
        left = (most - len(runs.x)) // seeds if asked.any() else 0
        free = left - min(RESERVE, left)
        places, _ = likelihood.next_places(min(AT_A_TIME, free), seeds, can_run)
        share = float(likelihood.share_by_term()[asked].max()) if asked.any() else 0.0
        if not asked.any():
            ended = "no runs"
        elif share <= SETTLED:
            ended = "settled"
        elif not free:
            ended = "budget"
        elif not len(places):
            ended = "nowhere else"
        elif _has_no_gain([*shares, share], likelihood.next_places(min(free, 24), seeds, can_run)[1]):
            ended = "no gain"
        else:
            shares.append(share)
            runs = runs.with_more(make(places))
            continue
        place = likelihood.snapped(likelihood.best)
        known = np.abs(runs.x - place).max(axis=1) < 1e-9
        if asked.any() and known.any():
            checks.append(_check(likelihood, place, asked, None))
            if checks[-1]["held"]:
                checks[-1]["rise"] = float(likelihood.rise(place)[0])
                return Outcome(likelihood, rounds, ended, checks)
            # The same runs would tell the same: others beside it are made.
            places = likelihood.next_places(min(1, left), seeds, can_run)[0]
            if not len(places):
                return Outcome(likelihood, rounds, ended, checks)
            runs = runs.with_more(make(places))
            checks.pop()
            continue
        if not left:
            return Outcome(likelihood, rounds, ended, checks)
        more = make(place[None])
        checks.append(_check(likelihood, place, asked, more))
        runs = runs.with_more(more)
        shares.clear()
    raise RunFailed("the fit did not end")


def _has_no_gain(shares: Sequence[float], then: float) -> bool:
    """Whether runs are not expected to shorten an interval by more than what a settled fit leaves, or have not for some rounds."""

    def gains(before: float, after: float) -> bool:
        return 1.0 + before > (1.0 + SETTLED) * (1.0 + after)

    if then <= SETTLED:
        return False
    rounds = len(shares) - PATIENCE
    return not gains(shares[-1], then) or rounds > 0 and not gains(min(shares[:rounds]), min(shares[rounds:]))


def _check(likelihood: Likelihood, place: Numbers, asked: Any, more: Runs | None) -> dict[str, Any]:
    """What was forecast at a place against what runs give there; against the runs left out where there are some already."""
    means, own, _ = (each[0] for each in likelihood.moments(place[None]))
    processes = [term.process for term in likelihood.terms]
    if more is None:
        at = [int(np.abs(process.points - place).max(axis=1).argmin()) for process in processes]
        errors, deviations = (np.array([process.loo()[which][one] for process, one in zip(processes, at, strict=True)]) for which in (0, 1))
        found, variances = np.array([process.means[one] for process, one in zip(processes, at, strict=True)]), deviations**2
        means = found - errors
    else:
        found = np.nanmean(likelihood.of_runs(more), axis=0)
        variances = own + np.array([process.run_variance for process in processes]) / len(more.x)
    # What is small against the measurement does not count.
    squares = (found - means) ** 2 / (variances + SETTLED * np.diag(likelihood.covariance))
    told = asked & np.isfinite(squares)
    held = told.any() and bool(squares[told].sum() <= stats.chi2.ppf(CHECK, told.sum()))
    said = {"place": place, "forecast": means, "deviation": np.sqrt(variances), "runs": found}
    return {**said, "held": held, "of": [term.of for term in likelihood.terms]}


@dataclass(frozen=True, repr=False)
class Fit:
    """What a fit tells of keys and responses, in SI units.

    Attributes
    ----------
    study : Study
        As it was after the first runs.
    keys : pandas.DataFrame
        A row for each piece of the interval of each key: ``key``, ``unit``, ``most_likely``, ``low``, ``high``, ``open_below``, ``open_above``. NaN
        where a key may be anywhere, or where runs contradict the forecast.
    responses : pandas.DataFrame
        Single values at the most likely place: ``measured``, ``uncertainty``, ``forecast``, ``surrogate_deviation`` (for want of runs),
        ``seeds_deviation`` (for want of seeds), ``seed_to_seed`` (of runs), ``leave_one_out_error``, ``discrepancy`` (that the model is given).
    series : pandas.DataFrame
        Measured series beside what runs give at the most likely place, by time.
    profiles : pandas.DataFrame
        How far -2 ln L rises where a key is held at a value, and the threshold of its interval.
    checks : pandas.DataFrame
        Runs at most likely places against what was forecast there, for each response (a series as its components).
    runs : pandas.DataFrame
        All runs.
    misfit, freedom, p : float, int, float
        Squares of forecast less measured over the variances of measurement, stated discrepancy and seeds; the probability of a larger one.
    determined : str or None
        Products of keys that are determined where the keys are not, or far better than they are.
    notes : list of str
        What is to be known before intervals are used.
    outcome : Outcome
    target : Target
    confidence : float
    first_points, most : int
        Points of the design; runs at most.
    """

    study: Study
    keys: pandas.DataFrame
    responses: pandas.DataFrame
    series: pandas.DataFrame
    profiles: pandas.DataFrame
    checks: pandas.DataFrame
    runs: pandas.DataFrame
    misfit: float
    freedom: int
    p: float
    determined: str | None
    notes: list[str]
    outcome: Outcome
    target: Target
    confidence: float
    first_points: int
    most: int

    @property
    def table(self) -> pandas.DataFrame:
        """The keys."""
        return self.keys

    @property
    def cautions(self) -> list[str]:
        """What is to be known before intervals are used."""
        return self.notes

    @property
    def tables(self) -> dict[str, pandas.DataFrame]:
        """Tables by the names of their files."""
        found = {"keys.csv": self.keys, "responses.csv": self.responses, "series.csv": self.series, "profiles.csv": self.profiles}
        found |= {"checks.csv": self.checks, "runs.csv": self.runs}
        return {name: table for name, table in found.items() if len(table) or name in ("keys.csv", "responses.csv", "profiles.csv")}

    @cached_property
    def regions(self) -> list[tuple[str, str, Numbers, Numbers, Numbers]]:
        """For each pair of keys: their names, values of both, and how far -2 ln L rises, a row for each value of the second."""
        likelihood, factors, found = self.outcome.likelihood, self.study.factors, list[tuple[str, str, Numbers, Numbers, Numbers]]()
        side = SIDES[len(factors) > 2]
        for one, other in itertools.combinations(range(len(factors)), 2):
            likely = likelihood.places[likelihood.values <= likelihood.least + 12.0]
            axes = [np.linspace(max(likely[:, at].min() - 0.1, -1.0), min(likely[:, at].max() + 0.1, 1.0), side) for at in (one, other)]
            if len(factors) == 2:
                rises = likelihood.rise(np.stack(np.meshgrid(*axes), -1).reshape(-1, 2)).reshape(side, side)
            else:
                rises = np.empty((side, side))
                for row, column in np.ndindex(side, side):
                    held = {one: float(axes[0][column]), other: float(axes[1][row])}
                    rises[row, column] = best_with(likelihood, held, likelihood.best)[1] - likelihood.least
            values = [factors[at].value(axis) for at, axis in zip((one, other), axes, strict=True)]
            found.append((factors[one].name, factors[other].name, values[0], values[1], rises))
        return found

    def document(self, files: Sequence[str] = ()) -> dict[str, Any]:
        """The JSON of ``plateau fit --json``; None where there is no number."""
        keys = []
        for factor in self.study.factors:
            rows = self.keys[self.keys["key"] == factor.name]
            pieces = rows[rows["low"].notna()][["low", "high", "open_below", "open_above"]].to_dict("records")
            is_open = len(pieces) == 1 and pieces[0]["open_below"] and pieces[0]["open_above"]
            likely = float(rows["most_likely"].iloc[0])
            about = {"name": factor.name, "keys": factor.keys.split(", "), "unit": factor.unit, "most_likely": likely}
            keys.append({**about, "interval": pieces, "undetermined": is_open})
        likelihood, responses = self.outcome.likelihood, self.responses.rename(columns={"response": "name"}).to_dict("records")
        found = {"study": self.study.title, "keys": keys, "responses": responses}
        found |= {"series": series} if (series := self._series_summary()) else {}
        found |= {"confidence": self.confidence, "misfit": self.misfit, "degrees_of_freedom": self.freedom, "p": self.p}
        found |= {"determined": self.determined, "notes": self.notes, "runs": len(likelihood.runs.x), "runs_at_most": self.most}
        found |= {"rounds": self.outcome.rounds, "ended": self.outcome.ended}
        found |= {"surrogate_share": float(likelihood.share_by_term().max()), "check": self._check_word()}
        return dict(plain(found | {"checks": self.checks.to_dict("records"), "files": list(files)}))

    def _check_word(self) -> str:
        return "failed" if self.outcome.has_failed else "held" if self.outcome.checks else "none"

    def _series_summary(self) -> list[dict[str, Any]]:
        likelihood, found = self.outcome.likelihood, []
        for at, components in likelihood.components.items():
            one = self.target.measured[at]
            away = _away(likelihood, at)
            points, alike = len(one.times), float((away[1:] * away[:-1]).sum() / max((away**2).sum(), 1e-300))
            said = {"name": one.response.name, "unit": one.response.unit, "points": points, "correlation_time": one.correlation_time}
            said |= {"independent_points": float(np.linalg.solve(one.correlations, np.ones(points)).sum())}
            said |= {"components": components.basis.shape[1], "apart": float(np.sqrt((away**2).mean())), "successive": alike}
            found.append(said)
        return found

    def text(self) -> str:
        """What ``plateau fit`` prints."""
        level, lines = f"{100.0 * self.confidence:g} %", []
        for factor in self.study.factors:
            rows = self.keys[self.keys["key"] == factor.name]
            likely = rows["most_likely"].iloc[0]
            pieces = " or ".join(_interval(factor, row) for _, row in rows.iterrows() if math.isfinite(row["low"]))
            told = [factor.name, factor.shown(likely, 4) if math.isfinite(likely) else "–", pieces or "none: runs contradict the forecast"]
            lines.append(dict(zip(["key", "most likely", f"{level} interval"], told, strict=True)))
        blocks = ["Keys", _columns(lines)]
        lines = []
        for _, row in self.responses.iterrows():
            unit = unit_for(row["unit"], max(abs(row["measured"]), abs(row["forecast"])))
            deviation = math.hypot(row["surrogate_deviation"], row["seeds_deviation"])
            away = (row["forecast"] - row["measured"]) / math.hypot(row["uncertainty"], deviation, row["discrepancy"])
            scatter = row["seed_to_seed"]
            apart = f"{scatter * unit.per_si:.2g} {unit.symbol}".strip() if math.isfinite(scatter) else "not known"
            line = {"response": row["response"], "measured": unit.text(row["measured"], row["uncertainty"])}
            line |= {"runs give": unit.text(row["forecast"], deviation), "seed to seed": apart}
            lines.append(line | {"apart": f"{away:.1f} deviations".replace("-0.0", "0.0")})
        blocks += ["\nResponses at the most likely values", _columns(lines)] if lines else []
        lines = [
            {
                "response": one["name"],
                "points": one["points"],
                "count as": f"{one['independent_points']:.3g} independent",
                "components": one["components"],
                "apart": f"{one['apart']:.2g} uncertainties apart (root mean square)",
            }
            for one in self._series_summary()
        ]
        blocks += ["\nSeries at the most likely values", _columns(lines)] if lines else []
        said = [*([self.determined] if self.determined else []), *self.notes]
        blocks += ["\nTo be known", *(f"  {line}" for line in said)] if said else []
        runs, seeds = self.outcome.likelihood.runs, self.study.seeds
        points = len(np.unique(np.round(runs.x, 9), axis=0))
        each = f", {seeds} seeds each" if seeds > 1 else ""
        more = f"{self.first_points} points of the design and {points - self.first_points} more{each}"
        chi = f"χ² = {self.misfit:.3g}"
        test = f" with {self.freedom} {'degree' if self.freedom == 1 else 'degrees'} of freedom, p = {self.p:.2g}"
        discrepancy = {one.response.name: size for one, size in zip(self.target.measured, self.target.discrepancies, strict=True) if size}
        stated = ", ".join(f"{100.0 * size:.3g} % in {name}" for name, size in discrepancy.items())
        check = {
            "held": "the last runs, at the most likely place, agree with what was forecast there",
            "failed": "failed: runs at the most likely place contradict what was forecast there, so there is no interval",
            "none": f"none: no runs {'are made' if self.outcome.ended == 'no runs' else 'were left for the most likely place'}",
        }
        summary = {
            "runs": f"{len(runs.x)} of at most {max(self.most, len(runs.x))}: {more}; {ENDS[self.outcome.ended]}",
            "check": check[self._check_word()],
            "misfit": chi + (test if self.freedom else "; there are no more measurements than keys, so the misfit cannot be tested"),
            "model": f"standard uncertainty of the model: {stated}"
            if stated
            else "taken for exact; [fit] discrepancy = 0.05 gives it an uncertainty of 5 %",
        }
        return with_minus("\n".join([*blocks, "", self.study.title, *(f"  {name:<8} {words}" for name, words in summary.items())]))

    def figures(self) -> dict[str, Any]:
        """Draws profiles of the keys, regions of their pairs, series."""
        from plateau.study.figures import fit_figures

        return dict(fit_figures(self))


def _columns(lines: list[dict[str, Any]]) -> str:
    heads = list(lines[0])
    rows = [heads, *([str(line[head]) for head in heads] for line in lines)]
    widths = [max(len(row[at]) for row in rows) for at in range(len(heads))]
    return "\n".join(
        "  " + "  ".join(cell.rjust(width) if at else cell.ljust(width) for at, (cell, width) in enumerate(zip(row, widths, strict=True)))
        for row in rows
    )


def _interval(factor: Factor, row: pandas.Series) -> str:
    low, high = factor.shown(row["low"], 4), factor.shown(row["high"], 4)
    bare = factor.shown(row["low"], 4, with_unit=False)
    if row["open_below"] and row["open_above"]:
        return f"not determined by these data: anywhere from {bare} to {high}"
    if row["open_below"]:
        return f"up to {high}; the data set no lower limit"
    return f"from {low} on; the data set no upper limit" if row["open_above"] else f"{bare} … {high}"


def fit(
    study: Study | str | os.PathLike[str],
    *,
    jobs: int | None = None,
    workers: int | None = None,
    retry: bool = False,
    progress: bool | None = None,
) -> Fit:
    """Finds the values of keys with which runs give what was measured, and makes the runs for it.

    Parameters
    ----------
    study : path or Study
        A study with ranges of keys and measured values of responses.
    jobs, workers : int, optional
        Runs at a time, and threads of each.
    retry : bool
        Make runs again that failed before.
    progress : bool, optional
        Whether progress is shown.

    Returns
    -------
    Fit

    Raises
    ------
    InputError, RunFailed
        If there is nothing to fit, or runs fail.
    """
    opened = analysed(study)
    target, most, confidence = _task(opened)
    can_run = [bool(opened.path) and "base" in opened.document and not one.response.asked.get("imported") for one in target.measured]
    if any(can_run) and opened.path is not None:
        opened = finished(opened.path, progress, retry, jobs=jobs, workers=workers)
        target, most, confidence = _task(opened)
    tables = [_table(opened)]

    def make(places: Numbers) -> Runs:
        points = pandas.DataFrame({factor.name: factor.value(column) for factor, column in zip(opened.factors, places.T, strict=True)})
        made = made_study(opened, points, progress, retry, jobs=jobs, workers=workers)
        table = _table(made)
        tables.append(table.assign(point=table["point"] + tables[-1]["point"].max()))
        return _observed(made, opened.factors, target)

    try:
        outcome = calibrated(target, _observed(opened, opened.factors, target), make, opened.seeds, most, can_run)
    except ValueError as error:
        if isinstance(error, InputError):
            raise
        count = (opened.runs["state"] == "finished").sum()
        raise RunFailed(f"{opened.path or opened.title}: {error}; {count} of {len(opened.runs)} runs finished") from error
    runs = pandas.concat(tables, ignore_index=True)
    runs.insert(0, "run", np.arange(1, len(runs) + 1))
    return told(opened, target, outcome, confidence, most, runs)


def _table(study: Study) -> pandas.DataFrame:
    names = [*(factor.name for factor in study.factors), *(response.name for response in study.responses)]
    return study.runs[["point", "replicate", "state", *names]].assign(error=study.data["error"].values)


def _task(study: Study) -> tuple[Target, int, float]:
    """What is fitted to, runs at most, and the confidence of intervals."""
    where, asked = study.path or study.title, study.document.get("fit", {})
    measured = measurements(study)
    if not measured:
        raise InputError(
            f"{where}: nothing was measured: give a [[response]] what was measured of it, such as measured = 0.70, uncertainty = 0.02, or "
            'measured_file = "FILE.csv" for a whole series'
        )
    for factor in study.factors:
        if not factor.is_range:
            said = f'{where}: factor "{factor.name}" ({factor.keys}) has levels, and a fit looks for numbers between two ends'
            if factor.is_number and not factor.whole:
                raise InputError(f"{said}: give range = [lower, upper] in place of levels")
            raise InputError(
                f"{said}: make one study for each of {', '.join(map(factor.text, factor.levels))}, fit each, and compare the misfits"
            )
    number: dict[str, Any] = {key: asked.get(key, usual) for key, usual in (("runs", 60), ("confidence", 0.95), ("discrepancy", 0.0))}
    stated, names = number["discrepancy"], [one.response.name for one in measured]
    if isinstance(stated, dict) and (unknown := [name for name in stated if name not in names]):
        raise InputError(f'{where}: fit.discrepancy: "{unknown[0]}" is no response that was measured; there are {", ".join(names)}')
    relative = [stated.get(name, 0.0) if isinstance(stated, dict) else stated for name in names]
    limits = [("fit.runs", number["runs"], 1.0, 1e6), ("fit.confidence", number["confidence"], 1e-6, 1.0 - 1e-9)]
    for key, value, low, high in (*limits, *(("fit.discrepancy", value, 0.0, 10.0) for value in relative)):
        if not isinstance(value, int | float) or isinstance(value, bool) or not low <= value <= high:
            raise InputError(f"{where}: {key} = {value}, expected {'at least 1' if key == 'fit.runs' else 'a part of 1, such as 0.05'}")
    singles = [one.response.name for one in measured if not one.is_series]
    correlations = np.eye(len(singles))
    for entry in asked.get("correlations", []):
        is_triple = isinstance(entry, list) and len(entry) == 3
        if not (is_triple and set(entry[:2]) <= set(singles) and entry[0] != entry[1] and -1.0 < entry[2] < 1.0):
            raise InputError(
                f'{where}: fit.correlations: {entry}, expected two responses with measured and a number, such as ["a", "b", 0.6]'
            )
        one, other = map(singles.index, entry[:2])
        correlations[one, other] = correlations[other, one] = entry[2]
    if len(singles) and np.linalg.eigvalsh(correlations).min() <= 1e-9:
        raise InputError(f"{where}: fit.correlations: no errors can be correlated like this all together; make them smaller")
    return Target(measured, [float(value) for value in relative], correlations), int(number["runs"]), float(number["confidence"])


def _observed(study: Study, factors: Sequence[Factor], target: Target) -> Runs:
    """What the runs of a study give of all that was measured."""
    is_first = (study.runs["same_as"] == study.runs.index).to_numpy()
    values = []
    for one in target.measured:
        if not one.is_series:
            values.append(study.runs[one.response.name].to_numpy(float)[is_first, None])
            continue
        found = np.full((len(study.runs), len(one.times)), math.nan)
        if one.response.series in study.data:
            series = study.data[one.response.series].values
            for run in range(len(found)):
                times = study.data["sample_time"].values[run] if "sample_time" in study.data else study.data["time"].values
                told = np.isfinite(series[run]) & np.isfinite(times)
                if told.any():
                    last = times[told].max()
                    if one.times[-1] > last * (1.0 + 1e-9):
                        raise InputError(
                            f"{one.place}: the time is {one.times[-1]:g} s, and the runs end at {last:g} s: make them longer, with set = "
                            f"[\"operation.duration = '{one.times[-1]:g} s'\"], or leave out the lines after their end"
                        )
                    found[run] = np.interp(one.times, times[told], series[run][told], left=math.nan)
        if not np.isfinite(found).all(axis=1).any():
            raise RunFailed(f'{study.path or study.title}: response "{one.response.name}": no run has values at all of the measured times')
        values.append(found[is_first])
    x = np.column_stack([factor.coded(study.runs[factor.name]) for factor in factors])
    return Runs(x[is_first], study.runs["replicate"].to_numpy()[is_first], values)


def best_with(likelihood: Likelihood, held: dict[int, float], start: Numbers) -> tuple[Numbers, float]:
    """The most likely place with some keys held: from a start, and from the most likely known place nearby."""
    starts = [start]
    is_near = np.all([np.abs(likelihood.places[:, key] - value) <= 1.5 * NEAR for key, value in held.items()], axis=0)
    if is_near.any() and len(held) < likelihood.keys:
        starts.append(likelihood.places[is_near][likelihood.values[is_near].argmin()])
    return min((likelihood.climbed(one, held) for one in starts), key=lambda found: found[1])


def profile(likelihood: Likelihood, key: int, threshold: float) -> tuple[Numbers, Numbers, list[tuple[float, float]]]:
    """Coded values of a key with how far -2 ln L rises there, and the pieces in which it stays below a threshold."""
    best, (axes, deviation) = likelihood.best, likelihood.shape(likelihood.best)
    width = math.sqrt(float(np.square(axes[key] * deviation).sum()))
    values = np.unique(np.clip([*np.linspace(-1.0, 1.0, PLACES), *(best[key] + width * np.linspace(-4.0, 4.0, 17))], -1.0, 1.0))
    rises, places = np.empty(len(values)), np.empty((len(values), likelihood.keys))
    middle = int(np.abs(values - best[key]).argmin())
    for steps in (range(middle, len(values)), range(middle - 1, -1, -1)):
        last = best
        for at in steps:
            last, value = best_with(likelihood, {key: float(values[at])}, last)
            rises[at], places[at] = value - likelihood.least, last

    def crossing(at: int) -> float:
        def above(value: float) -> float:
            start = places[at if abs(value - values[at]) < abs(value - values[at + 1]) else at + 1]
            return best_with(likelihood, {key: value}, start)[1] - likelihood.least - threshold

        ends = above(values[at]), above(values[at + 1])
        return float(optimize.brentq(above, values[at], values[at + 1], xtol=1e-4) if ends[0] * ends[1] < 0.0 else values[at])

    inside = rises <= threshold
    ends = [crossing(int(at)) for at in np.flatnonzero(inside[1:] != inside[:-1])]
    ends = [*([-1.0] if inside[0] else []), *ends, *([1.0] if inside[-1] else [])]
    return values, np.maximum(rises, 0.0), list(zip(ends[::2], ends[1::2], strict=True))


def told(study: Study, target: Target, outcome: Outcome, confidence: float, most: int, runs: pandas.DataFrame) -> Fit:
    """All that a fit tells, from its last likelihood."""
    likelihood, threshold = outcome.likelihood, float(stats.chi2.ppf(confidence, 1))
    keys, profiles = [], []
    for at, factor in enumerate(study.factors):
        values, rises, pieces = profile(likelihood, at, threshold)
        profiles.append(pandas.DataFrame({"key": factor.name, "value": factor.value(values), "rise": rises, "threshold": threshold}))
        is_anywhere = pieces == [(-1.0, 1.0)]
        likely = math.nan if is_anywhere or outcome.has_failed else float(factor.value(likelihood.best[at]))
        for low, high in [(math.nan, math.nan)] if outcome.has_failed else pieces:
            ends = {"low": float(factor.value(low)), "high": float(factor.value(high))}
            ends |= {"open_below": low == -1.0, "open_above": high == 1.0}
            keys.append({"key": factor.name, "unit": factor.unit, "most_likely": likely, **ends})
    means, own, of_seeds = (each[0] for each in likelihood.moments(likelihood.best[None]))
    responses, series = [], []
    for at, one in enumerate(target.measured):
        terms = [number for number, term in enumerate(likelihood.terms) if term.of == at]
        about = {"response": one.response.name, "unit": one.response.unit}
        if one.is_series:
            components = likelihood.components[at]
            forecast = components.root @ (components.mean + components.basis @ means[terms])
            deviation = np.sqrt(np.square(components.root @ components.basis) @ (own + of_seeds)[terms])
            columns = {"time": one.times, "measured": one.values, "uncertainty": one.uncertainties}
            series.append(pandas.DataFrame({**about, **columns, "forecast": forecast, "forecast_deviation": deviation}))
            continue
        (number,) = terms
        process = likelihood.terms[number].process
        scatter = math.sqrt(process.run_variance + of_seeds[number] * process.seeds) if process.seeds > 1 else math.nan
        row = {**about, "measured": one.values[0], "uncertainty": one.uncertainties[0], "forecast": means[number]}
        row |= {"surrogate_deviation": math.sqrt(own[number]), "seeds_deviation": math.sqrt(of_seeds[number]), "seed_to_seed": scatter}
        row |= {"leave_one_out_error": float(np.sqrt(np.square(process.loo()[0]).mean()))}
        responses.append(row | {"discrepancy": abs(target.discrepancies[at] * one.values[0])})
    names = ["response", "unit", "measured", "uncertainty", "forecast", "surrogate_deviation", "seeds_deviation", "seed_to_seed"]
    names += ["leave_one_out_error", "discrepancy"]
    checks = []
    for number, check in enumerate(outcome.checks, 1):
        at_keys = {factor.name: float(factor.value(value)) for factor, value in zip(study.factors, check["place"], strict=True)}
        for at, of in enumerate(check["of"]):
            one = target.measured[of].response
            unit = "uncertainties, of a component" if target.measured[of].is_series else one.unit
            line = {"check": number, **at_keys, "response": one.name, "unit": unit}
            checks.append({**line, **{what: float(check[what][at]) for what in ("forecast", "deviation", "runs")}, "held": check["held"]})
    misfit, freedom = float(likelihood.misfit(likelihood.best[None], with_processes=False)[0]), likelihood.freedom
    found = Fit(
        study=study,
        keys=pandas.DataFrame(keys),
        responses=pandas.DataFrame(responses, columns=names),
        series=pandas.concat(series, ignore_index=True) if series else pandas.DataFrame(columns=["response"]),
        profiles=pandas.concat(profiles, ignore_index=True),
        checks=pandas.DataFrame(checks),
        runs=runs,
        misfit=misfit,
        freedom=freedom,
        p=float(stats.chi2.sf(misfit, freedom)) if freedom else math.nan,
        determined=None if outcome.has_failed else _determined(study.factors, likelihood, threshold, keys),
        notes=[],
        outcome=outcome,
        target=target,
        confidence=confidence,
        first_points=int(study.runs["point"].nunique()),
        most=most,
    )
    found.notes.extend(_notes(found))
    return found


def products(slopes: Numbers, halves: Numbers, threshold: float) -> tuple[list[tuple[Numbers, float]] | None, list[tuple[Numbers, float]]]:
    """Exponents of keys, with 1 for the leading one, of products that are determined where the keys are not, or are known far better.

    `slopes` are those of the responses over their deviations, by logarithms of keys as multiples of `halves`, half their ranges. Each
    product has the factor by which it may be off; the determined ones are None if all keys are.
    """
    curvature = slopes.T @ slopes
    values, axes = np.linalg.eigh(curvature)
    known = values > threshold

    def reduced(rows: Numbers) -> Numbers:
        for at in range(len(rows)):
            pivot = int(np.abs(rows[at]).argmax())
            rows[at] /= rows[at, pivot]
            others = np.arange(len(rows)) != at
            rows[others] -= np.outer(rows[others, pivot], rows[at])
        return np.where(np.abs(rows) < EXPONENT, 0.0, rows)

    if not known.all():
        along = axes[:, known]
        rows = reduced((along / halves[:, None]).T)
        return [(row, math.exp(math.sqrt(threshold * float(np.sum((row * halves @ along) ** 2 / values[known]))))) for row in rows], []
    covariance = np.linalg.inv(curvature) * np.outer(halves, halves)
    deviation = np.sqrt(np.diag(covariance))
    values, axes = np.linalg.eigh(covariance / np.outer(deviation, deviation))
    is_better = np.sqrt(np.maximum(values, 0.0)) * BETTER <= np.abs(axes).max(axis=0)
    rows = reduced((axes[:, is_better] / deviation[:, None]).T)
    found = [(row, math.exp(math.sqrt(threshold * float(row @ covariance @ row)))) for row in rows]
    return None, [one for one in found if np.count_nonzero(one[0]) > 1]


def _determined(factors: Sequence[Factor], likelihood: Likelihood, threshold: float, keys: list[dict[str, Any]]) -> str | None:
    """Products in words; None where there is nothing to say."""
    ends, best = np.array([factor.ends for factor in factors]), likelihood.best
    if (ends <= 0.0).any():
        return None
    halves = 0.5 * np.log(ends[:, 1] / ends[:, 0])
    values = np.array([float(factor.value(at)) for factor, at in zip(factors, best, strict=True)])
    by_log = np.where([factor.logarithmic for factor in factors], 1.0 / halves, 2.0 * values / (ends[:, 1] - ends[:, 0]))
    found, better = products(likelihood.slopes(best) * (by_log * halves), halves, threshold)
    where = "near the most likely values"

    def words(row: Numbers, times: float) -> str:
        powers = [
            (factors[at], round(float(row[at]), 4), values[at])
            for at in sorted(np.flatnonzero(row).tolist(), key=lambda at: (row[at] != 1.0, at))
        ]
        name = " × ".join(factor.name if power == 1.0 else with_minus(f"{factor.name}^{power:g}") for factor, power, _ in powers)
        value = math.prod(float(factor.in_study_unit(value)) ** power for factor, power, value in powers)
        units = " and ".join(shown_unit(factor.study_unit) for factor, _, _ in powers if factor.study_unit)
        return f"{name} = {value:.4g} ({value / times:.4g} … {value * times:.4g}{', with ' + units if units else ''})"

    if found is None:
        said, verb = [words(*one) for one in better], "is" if len(better) == 1 else "are"
        return f"{' and '.join(said)} {verb} known far better than the keys in it, {where}." if said else None
    if not found:
        is_closed = any(not row["open_below"] and not row["open_above"] for row in keys)
        return None if is_closed else f"{where[0].upper()}{where[1:]} these data determine none of the keys."
    if all(np.count_nonzero(row) < 2 for row, _ in found):
        return None
    return f"Only {' and '.join(words(*one) for one in found)} {'is' if len(found) == 1 else 'are'} determined by these data, {where}."


def _away(likelihood: Likelihood, at: int) -> Numbers:
    """Deviations of a measured series from what runs give at the most likely place, independent and of deviation 1."""
    components = likelihood.components[at]
    means = likelihood.moments(likelihood.best[None])[0][0]
    scores = means[[number for number, term in enumerate(likelihood.terms) if term.of == at]]
    return np.asarray(components.measured - components.mean - components.basis @ scores)


def _notes(fit: Fit) -> list[str]:
    """What is to be known before intervals are used."""
    notes, likelihood, outcome = [], fit.outcome.likelihood, fit.outcome
    names = [one.response.name for one in fit.target.measured]
    if outcome.has_failed:
        check = outcome.checks[-1]
        places = zip(fit.study.factors, check["place"], strict=True)
        where = ", ".join(f"{factor.name} = {factor.shown(float(factor.value(at)), 4)}" for factor, at in places)
        worst = int(np.nanargmax(np.abs(check["runs"] - check["forecast"]) / check["deviation"]))
        notes.append(
            f"Runs at the most likely place ({where}) contradict the forecast, most in {names[check['of'][worst]]}, and no runs were left to find "
            "another place: there are no most likely values and no intervals. More runs in [fit] go on from here."
        )
    elif not outcome.checks:
        notes.append("No runs were made at the most likely place, so the forecast there is not checked.")
    if fit.p < 0.05:
        degrees = f"{fit.freedom} {'degree' if fit.freedom == 1 else 'degrees'} of freedom"
        notes.append(
            f"No values within these ranges give all that was measured: misfit χ² = {fit.misfit:.3g} with {degrees}, p = {fit.p:.2g}. The "
            "intervals are those of a model that does not fit; [fit] discrepancy states by how much the model may be off."
        )
    if fit.study.seeds < 2 and outcome.ended != "no runs":
        notes.append(
            "Each point was run with one set of surfaces, so what differs from one to the next is not known; a process may take it for shape, and "
            "an interval may be too short. [replicates] with several seeds tells it."
        )
    scatters = {row["response"]: (row["seed_to_seed"], row["seeds_deviation"], row["uncertainty"]) for _, row in fit.responses.iterrows()}
    _, _, of_seeds = (each[0] for each in likelihood.moments(likelihood.best[None]))
    for number, term in enumerate(likelihood.terms):
        if term.of in likelihood.components and term.process.seeds > 1:
            one = math.sqrt(term.process.run_variance + of_seeds[number] * term.process.seeds), math.sqrt(of_seeds[number]), 1.0
            scatters[names[term.of]] = max(scatters.get(names[term.of], one), one)
    for name, (scatter, of_mean, uncertainty) in scatters.items():
        if scatter > uncertainty:
            notes.append(
                f"Runs with other seeds scatter in {name} by more than the uncertainty of the measurement. Specimens may do the same: unless the "
                "measurement is a mean of many specimens, add that scatter to its uncertainty."
            )
        if of_mean > 0.5 * uncertainty:
            notes.append(
                f"The mean of {name} over the seeds is known no better than to half the uncertainty of the measurement: more seeds in [replicates] "
                "make the intervals shorter."
            )
    for _, row in fit.responses.iterrows():
        far = abs(row["forecast"] - row["measured"]) / math.hypot(row["uncertainty"], row["seeds_deviation"], row["discrepancy"])
        if not fit.freedom and far > 2.0:
            notes.append(
                f"At the most likely values {row['response']} of the runs is {far:.2g} standard deviations away from what was measured: no values "
                "within these ranges give all that was measured."
            )
    for at in likelihood.components:
        away, times = _away(likelihood, at), fit.target.measured[at].times
        alike = float((away[1:] * away[:-1]).sum() / max((away**2).sum(), 1e-300))
        if len(away) >= 8 and alike > 2.0 / math.sqrt(len(away)):
            time = -float(np.median(np.diff(times))) / math.log(min(alike, 0.99))
            advice = "a longer correlation_time" if fit.target.measured[at].correlation_time else f'correlation_time = "{time:.2g} s"'
            notes.append(
                f"Successive points of {names[at]} deviate alike (correlation {alike:.2g}): they tell less than so many independent points, and the "
                f"intervals are too short. If the errors of the measurement are like that, give {advice} in its [[response]]; if not, the runs "
                "cannot follow the series."
            )
    shares = likelihood.share_by_term()
    if shares.max() > SETTLED:
        part = f"{100.0 * shares.max():.0f} % of" if shares.max() < 2.0 else f"{shares.max():.2g} times"
        name = names[likelihood.terms[int(shares.argmax())].of]
        more = {
            "no gain": "all runs that [fit] allows besides would hardly lessen it: runs scatter from one surface, or one place, to the next. More sets of "
            "seeds in [replicates] lessen that; if a single specimen was measured, add its scatter to the uncertainty.",
            "no runs": "more points in the design make the intervals shorter.",
        }
        known = f"The forecasts are not exact: near the most likely values their variance is up to {part} that of the measurement of {name}"
        notes.append(f"{known}; {more.get(outcome.ended, 'more runs in [fit] make the intervals shorter.')}")
    return notes


@dataclass(frozen=True)
class Plan:
    """What a fit will do.

    Attributes
    ----------
    study : Study
    target : Target
    first_runs, most : int
        Runs of the design, and in all.
    estimated_time : float
        Wall time of all, s.
    memory : int
        Of the largest run, bytes.
    """

    study: Study
    target: Target
    first_runs: int
    most: int
    estimated_time: float
    memory: int

    def document(self) -> dict[str, Any]:
        """The JSON of ``plateau fit --plan --json``."""
        keys, responses = [factor.name for factor in self.study.factors], [one.response.name for one in self.target.measured]
        known = {"first_runs": self.first_runs, "runs_at_most": self.most, "estimated_time": self.estimated_time, "memory": self.memory}
        return dict(plain({"study": self.study.title, "keys": keys, "responses": responses, **known}))

    def text(self) -> str:
        """What ``plateau fit --plan`` prints."""
        keys = []
        for factor in self.study.factors:
            low, high = map(factor.shown, factor.ends)
            keys.append({"key": factor.name, "between": f"{low} … {high}{', equal ratios' if factor.logarithmic else ''}"})
        measured = []
        for one in self.target.measured:
            unit = unit_for(one.response.unit, float(np.abs(one.values).max()))
            said = (
                f"{len(one.times)} points from {one.times[0]:g} to {one.times[-1]:g} s"
                if one.is_series
                else unit.text(one.values[0], one.uncertainties[0])
            )
            measured.append({"response": one.response.name, "measured": said})
        rows = {"first runs": f"{self.first_runs} runs", "at most": f"{self.most} runs"}
        if math.isfinite(self.estimated_time):
            rows |= {"estimated": f"{self.estimated_time:.3g} s for all", "memory": f"{self.memory / 1e6:.3g} MB for each"}
        lines = [f"  {name:<10}  {words}" for name, words in rows.items()]
        return with_minus("\n".join(["Looked for", _columns(keys), "\nFitted to", _columns(measured), "", self.study.title, *lines]))


def plan(study: Study | str | os.PathLike[str]) -> Plan:
    """Tells what a fit will do, without running any.

    Parameters
    ----------
    study : path or Study

    Returns
    -------
    Plan
    """
    opened = analysed(study)
    target, most, _ = _task(opened)
    first, time, memory = len(opened.runs), math.nan, 0
    if opened.path is not None and "base" in opened.document:
        estimate = call(["sweep", "plan", opened.path], progress=False)
        jobs, mean = estimate["jobs"], float(np.mean(estimate["run_time"]))
        time, memory = mean * max(most, first) / jobs, estimate["memory"] // jobs
    return Plan(opened, target, first, max(most, first), time, memory)
