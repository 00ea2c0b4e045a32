"""Fit to an experiment: which values of keys make runs give what was measured, how well that is known, and whether runs there agree."""

import math
import os
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas

from plateau.errors import InputError, RunFailed
from plateau.output_folder import plain
from plateau.program import call
from plateau.study.calibration import calibrated
from plateau.study.data import Answer, Numbers, Study
from plateau.study.fit_answer import Fit
from plateau.study.likelihood import Runs, Target
from plateau.study.measured import Measurement, measurements
from plateau.study.process import LEAST
from plateau.study.results import analysed
from plateau.study.runs import finished, made_study
from plateau.text_tables import listed
from plateau.units import unit_of, with_minus


def fit(
    study: Study | str | os.PathLike[str], *, jobs: int | None = None, workers: int | None = None, retry: bool = False, progress: bool | None = None
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
        Show progress.

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
    if any(can_run) and (path := opened.path) is not None:
        is_first = _is_first(opened, most)
        if is_first.all():
            opened = finished(path, progress, retry, opened.directory, jobs=jobs, workers=workers)
        else:
            points = opened.runs.loc[is_first, [factor.name for factor in opened.factors]].drop_duplicates()
            made_study(opened, points, progress=progress, retry=retry, jobs=jobs, workers=workers)
            opened = analysed(path, opened.directory)
            opened = replace(opened, runs=opened.runs[is_first], data=opened.data.isel(run=is_first))
        target, most, confidence = _task(opened)
    tables = [_table(opened)]

    def make(places: Numbers) -> Runs:
        points = pandas.DataFrame({factor.name: factor.value(column) for factor, column in zip(opened.factors, places.T, strict=True)})
        made = made_study(opened, points, progress=progress, retry=retry, jobs=jobs, workers=workers)
        tables.append(_table(made, tables[-1]["point"].max()))
        return _observed(replace(made, factors=opened.factors), target)

    try:
        outcome = calibrated(target, _observed(opened, target), make, opened.seeds, most, can_run)
    except ValueError as error:
        if isinstance(error, InputError):
            raise
        count = (opened.runs["state"] == "finished").sum()
        raise RunFailed(f"{opened.path or opened.title}: {error}; {count} of {len(opened.runs)} runs finished") from error
    runs = pandas.concat(tables, ignore_index=True)
    runs.insert(0, "run", np.arange(1, len(runs) + 1))
    return Fit(opened, target, outcome, confidence, most, runs)


def _is_first(study: Study, most: int) -> npt.NDArray[np.bool_]:
    """Marks the runs of the design that are made: of all points in the budget but one, for the most likely place, at least of `LEAST`."""
    points = study.runs.groupby([factor.name for factor in study.factors], sort=False).ngroup()
    return np.asarray(points < max(most // study.seeds - 1, LEAST))


def _table(study: Study, before: int = 0) -> pandas.DataFrame:
    """Runs of a study whose points have numbers from those before on."""
    names = [*(factor.name for factor in study.factors), *(response.name for response in study.responses)]
    runs = study.runs[["point", "replicate", "state", *names]]
    return runs.assign(point=runs["point"] + before, error=study.data["error"].values)


def _task(study: Study) -> tuple[Target, int, float]:
    """Target of the fit, largest number of runs, and the confidence of intervals."""
    where, asked = study.path or study.title, study.document.get("fit", {})
    measured = measurements(study)
    if not measured:
        such = 'measured = 0.70, uncertainty = 0.02, or measured_file = "FILE.csv" for a whole series'
        raise InputError(f"{where}: nothing was measured: give a [[response]] what was measured of it, such as {such}")
    for factor in study.factors:
        if not factor.is_range:
            advice = f"make one study for each of {', '.join(map(factor.text, factor.levels))}, fit each, and compare the misfits"
            advice = "give range = [lower, upper] in place of levels" if factor.is_number and not factor.whole else advice
            raise InputError(f'{where}: factor "{factor.name}" ({factor.keys}) has levels, and a fit looks for numbers between two ends: {advice}')
    runs, confidence, stated = (asked.get(key, usual) for key, usual in (("runs", 60), ("confidence", 0.95), ("discrepancy", 0.0)))
    names = [one.response.name for one in measured]
    if isinstance(stated, dict) and (unknown := [name for name in stated if name not in names]):
        raise InputError(f'{where}: fit.discrepancy: "{unknown[0]}" is no response that was measured; there are {", ".join(names)}')
    relative = [stated.get(name, 0.0) if isinstance(stated, dict) else stated for name in names]
    limits = [("fit.runs", runs, 1.0, 1e6), ("fit.confidence", confidence, 1e-6, 1.0 - 1e-9)]
    for key, value, low, high in (*limits, *(("fit.discrepancy", value, 0.0, 10.0) for value in relative)):
        if not isinstance(value, int | float) or isinstance(value, bool) or not low <= value <= high:
            raise InputError(f"{where}: {key} = {value}, expected {'at least 1' if key == 'fit.runs' else 'a part of 1, such as 0.05'}")
    return Target(measured, [float(value) for value in relative], _correlations(where, asked, measured)), int(runs), float(confidence)


def _correlations(where: Any, asked: dict[str, Any], measured: list[Measurement]) -> Numbers:
    """Correlations of the errors of single values."""
    singles = [one.response.name for one in measured if not one.is_series]
    correlations = np.eye(len(singles))
    stated = asked.get("correlations", [])
    for entry in stated if isinstance(stated, list) else [stated]:
        match entry:
            case [one, other, int() | float() as value] if one in singles and other in singles and one != other and -1.0 < value < 1.0:
                places = singles.index(one), singles.index(other)
                correlations[places] = correlations[places[::-1]] = value
            case _:
                expected = 'expected two responses with measured and a number, such as ["a", "b", 0.6]'
                raise InputError(f"{where}: fit.correlations: {entry}, {expected}")
    if len(singles) and np.linalg.eigvalsh(correlations).min() <= 1e-9:
        raise InputError(f"{where}: fit.correlations: no errors can be correlated like this all together; make them smaller")
    return correlations


def _observed(study: Study, target: Target) -> Runs:
    """Values that the runs of a study give of all that was measured."""
    is_first = (study.runs["same_as"] == study.runs.index).to_numpy()
    values = [_at_times(study, one) if one.is_series else study.runs[[one.response.name]].to_numpy(float) for one in target.measured]
    x = np.column_stack([factor.coded(study.runs[factor.name]) for factor in study.factors])
    return Runs(x[is_first], study.runs["replicate"].to_numpy()[is_first], [one[is_first] for one in values])


def _at_times(study: Study, one: Measurement) -> Numbers:
    """Series of the runs at the measured times."""
    found = np.full((len(study.runs), len(one.times)), math.nan)
    for run in range(len(found)) if one.response.series in study.data else ():
        series = study.data[one.response.series].values[run]
        times = study.data["sample_time"].values[run] if "sample_time" in study.data else study.data["time"].values
        told = np.isfinite(series) & np.isfinite(times)
        if told.any():
            last = times[told].max()
            if one.times[-1] > last * (1.0 + 1e-9):
                raise InputError(
                    f"{one.place}: the time is {one.times[-1]:g} s, and the runs end at {last:g} s: make them longer, with set = "
                    f"[\"operation.duration = '{one.times[-1]:g} s'\"], or leave out the lines after their end"
                )
            found[run] = np.interp(one.times, times[told], series[told], left=math.nan)
    if not np.isfinite(found).all(axis=1).any():
        raise RunFailed(f'{study.path or study.title}: response "{one.response.name}": no run has values at all of the measured times')
    return found


@dataclass(frozen=True, repr=False)
class Plan(Answer):
    """Plan of a fit: ``first_runs`` of the design and ``most`` in all, their wall time, s, and the memory of the largest, bytes."""

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
        """The text that ``plateau fit --plan`` prints."""
        keys, measured = [], []
        for factor in self.study.factors:
            scale = ", equal ratios" if factor.logarithmic else ""
            keys.append({"key": factor.name, "between": " … ".join(map(factor.shown, factor.ends)) + scale})
        for one in self.target.measured:
            said = unit_of(one.response.unit, one.values).text(one.values[0], one.uncertainties[0])
            said = f"{len(one.times)} points from {one.times[0]:g} to {one.times[-1]:g} s" if one.is_series else said
            measured.append({"response": one.response.name, "measured": said})
        lines = ["Looked for", *listed(keys), "", "Fitted to", *listed(measured), "", self.study.title]
        lines += [f"  first runs  {self.first_runs} runs", f"  at most     {self.most} runs"]
        if math.isfinite(self.estimated_time):
            lines += [f"  estimated   {self.estimated_time:.3g} s for all", f"  memory      {self.memory / 1e6:.3g} MB for each"]
        return with_minus("\n".join(lines))


def plan(study: Study | str | os.PathLike[str]) -> Plan:
    """Tells what a fit will do, without running any."""
    opened = analysed(study)
    target, most, _ = _task(opened)
    first, time, memory = len(opened.runs), math.nan, 0
    if opened.path is not None and "base" in opened.document:
        first = int(_is_first(opened, most).sum())
        estimate = call(["sweep", "plan", opened.path])
        time = float(np.mean(estimate["run_time"])) * max(most, first) / estimate["jobs"]
        memory = estimate["memory"] // estimate["jobs"]
    return Plan(opened, target, first, max(most, first), time, memory)
