"""Lines of series against time: of very many samples means, of runs that differ in seeds alone their mean; single steps; events."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas

from plateau.figures.drawing import Subject
from plateau.run_file import array
from plateau.style import APART
from plateau.units import Unit, unit_of

# Windows of time in which samples are put together, at most; those of a cycle, whose events are short.
MOST, MOST_OF_CYCLE = 250, 1500
# Samples of a window of which a band tells the extent, at least; the parts of them that are below its ends.
LEAST_OF_BAND, BAND = 20, (0.05, 0.95)
# A line that goes up and down by more than so many times its range is a weighted mean over this part of the longest run.
MOST_WAY, PART, MOST_EVENTS = 3.0, 1 / 16, 100


@dataclass
class Course:
    """A series of a run, in the unit that is shown, by its times, s; of runs that differ in seeds alone a column for each."""

    subject: Subject
    label: str
    values: Any

    def __post_init__(self) -> None:
        self.duration = float(self.values.index[-1] - self.values.index[0])
        # A band would have too few samples, or go over the gaps of a cycle: each sample is drawn.
        self.is_short = len(self.values) <= MOST or self.subject.has_cycle


def courses(subjects: Sequence[Subject], name: str, unit: Unit, rubbing: bool = False) -> list[Course]:
    """A series of runs in a unit, if wanted with gaps where nothing rubs; three or more that differ in seeds alone become one."""
    found, every = [], pandas.Series(subjects, dtype=object)
    for _, own in every.groupby([one.scene_without_seeds for one in subjects], sort=False):
        is_mean = own.map(lambda one: str(one.run.attrs.get("seeds"))).nunique() == len(own) > 2
        for some in [[*own]] if is_mean else [[one] for one in own]:
            time = min((one.time for one in some), key=lambda time: float(time[-1]))
            values = [one.while_rubbing(unit.value(one.values(name))) if rubbing else unit.value(one.values(name)) for one in some]
            columns = {number: np.interp(time, one.time, column) for number, (one, column) in enumerate(zip(some, values, strict=True))}
            label = f"{some[0].run.attrs.get('title', some[0].label)}: mean of {len(own)} seeds" if is_mean else some[0].label
            found.append(Course(some[0], label, pandas.DataFrame(columns, time)))
    return found


def in_windows(values: Any, most: int) -> Any:
    """Samples in at most so many groups of equally many that follow each other."""
    return values.groupby(np.arange(len(values)) // max(1, math.ceil(len(values) / most)))


def line_of(course: Course, duration: float) -> Any:
    """A line by time: means in windows, at the mean time of samples with a value; in a run without a cycle `weighted` over a duration, s."""
    most, values = MOST_OF_CYCLE if course.subject.has_cycle else MOST, course.values
    times = pandas.DataFrame({"known": values.index.where(values.notna().all(axis=1)), "all": values.index})
    times = in_windows(times, most).mean()
    line = in_windows(values, most).mean().set_index(times["known"].fillna(times["all"]))
    return line if course.subject.has_cycle else weighted(line, duration, course.duration)


def weighted(line: Any, duration: float, whole: float) -> Any:
    """Means of a line over a duration, s, that fits twice into the whole, with weights that fall to zero.

    Such weights need as many values behind as before, so the line ends earlier.
    """
    beside = round(duration * (len(line) - 1) / (whole or 1) / 2)
    if beside < 2 or 2 * duration > whole:
        return line

    def around(at: int) -> Any:
        reach = min(beside - 1, at)
        return np.average(line.to_numpy()[at - reach : at + reach + 1], axis=0, weights=np.bartlett(2 * reach + 3)[1:-1])

    return pandas.DataFrame([around(at) for at in range(len(line) + 1 - beside)], line.index[: len(line) + 1 - beside])


def calm(every: Sequence[Course]) -> float:
    """How long means are, s: 0 for windows, more if a line goes up and down all along, as with the place on the disc: it looks like waves."""
    long = [one for one in every if not one.is_short]
    is_any = any(pulses(one.values.mean(axis=1).to_numpy()) for one in long)
    return PART * max(one.duration for one in long) if is_any else 0.0


def pulses(line: Any) -> bool:
    """Whether a line goes up and down all along."""
    return bool(np.nansum(np.abs(np.diff(line))) > MOST_WAY * np.ptp(line))


def draw(axis: Any, course: Course, time: Unit, duration: float, is_exact: bool = False, **options: Any) -> float:
    """Draws the line of a course, or exactly its values, and the range of seeds; gives the largest value."""
    line = course.values if is_exact else line_of(course, duration)
    at, values = time.value(line.index), line.mean(axis=1, skipna=False)
    options = {"label": course.label, **course.subject.line, **options}
    axis.plot(at, values, **options)
    # A value alone between two gaps makes no line.
    alone = values.notna() & values.shift().isna() & values.shift(-1).isna()
    if alone.any():
        axis.plot(at[alone], values[alone], ".", color=options["color"], markersize=1.5)
    if line.shape[1] > 1:
        axis.fill_between(at, line.min(axis=1), line.max(axis=1), color=options["color"], alpha=0.2, linewidth=0)
    return float(np.nan_to_num(line).max(initial=0.0))


def draw_steps(axis: Any, course: Course, time: Unit, duration: float, label: str | None) -> float:
    """Draws single steps as dots, or, where they are very many, as a band between percentiles; gives the highest."""
    values, look = course.values[0], {"color": course.subject.line["color"], "label": label}
    if course.is_short:
        # Very many are pixels, in drawings of lines, too.
        look |= {"markersize": 1.3, "markeredgewidth": 0, "rasterized": len(values) > MOST_OF_CYCLE}
        axis.plot(time.value(values.index), values, "o", alpha=0.35, **look)
        return float(np.nan_to_num(values).max(initial=0.0))
    most = min(MOST, len(values) // LEAST_OF_BAND, *([round(2 * course.duration / duration)] if duration else []))
    at = np.concatenate([values.index[:1], in_windows(values.index.to_series(), most).mean(), values.index[-1:]])
    low, high = (np.pad(in_windows(values, most).quantile(part), 1, "edge") for part in BAND)
    axis.fill_between(time.value(at), low, high, alpha=0.2, linewidth=0, **look)
    return float(np.nan_to_num(high).max(initial=0.0))


def time_of(subjects: Sequence[Subject]) -> Unit:
    """The unit of the time of all runs."""
    return unit_of("s", max(float(subject.time[-1]) for subject in subjects))


def time_axis(axes: Iterable[Any], subjects: Sequence[Subject]) -> None:
    """Gives axes the time of all runs, and shades the events of a single run, last in legends: they are less important."""
    time, run = time_of(subjects), subjects[0].run
    is_cycle = len(subjects) == 1 and "event" in run.children
    spans = time.value(np.array([array(run, f"event/{name}").values for name in ("start", "end")])).T if is_cycle else []
    for axis in axes:
        axis.set(xlim=(0, time.value(max(float(subject.time[-1]) for subject in subjects))), xlabel=f"time, {time.symbol}")
        if 0 < len(spans) <= MOST_EVENTS:
            look = {"transform": axis.get_xaxis_transform(), "color": APART, "linewidth": 0, "zorder": 0, "label": "events of the cycle"}
            axis.broken_barh([(start, end - start) for start, end in spans], (0, 1), **look)


def note_of(every: Sequence[Course], duration: float, usual: str, *more: str) -> str:
    """What lines and bands are, and which runs are too short for the means of the others."""
    unit = unit_of("s", duration)
    said = [f"lines: {usual}"] if any(more) or len(every) > 1 else []
    if duration:
        said = [f"lines: weighted mean over {unit.value(duration):.3g} {unit.symbol} where values pulse as the resin wears"]
        other = [one.label for one in every if 2 * duration > one.duration or one.subject.has_cycle]
        said += [f"of {', '.join(dict.fromkeys(other))}: {usual}"] if other else []
    said += ["band of seeds: least to greatest"] if any(one.values.shape[1] > 1 for one in every) else []
    text = "; ".join([*said, *filter(None, more)])
    return text[:1].upper() + text[1:]
