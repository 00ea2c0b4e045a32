"""Figures of series against time. Lines are means of very many samples, or of runs that differ in seeds alone; steps and events are beside."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import pandas

from plateau.figures.drawing import Drawing, Subject, moment
from plateau.quantities import CELSIUS, KMH, MM2, NUMBER, PERCENT, SERIES
from plateau.style import APART, NARROW, WIDE, look, number, wrapped
from plateau.units import Unit, quantity, unit_of

# Windows of time in which samples are put together, at most; those of a cycle, whose events are short; of emission.
MOST, MOST_OF_CYCLE, MOST_OF_EMISSION = 250, 1500, 60
# Samples of a window of which a band tells the extent, at least; the parts of them that are below its ends.
LEAST_OF_BAND, BAND = 20, (0.05, 0.95)
# A line that goes up and down by more than so many times its range is a weighted mean over this part of the longest such run.
MOST_WAY, PART, MOST_EVENTS = 3.0, 1 / 16, 100
# Runs whose single steps are drawn; samples that are marked: at most. Higher single steps, over the highest mean, are beyond the axis.
MOST_BANDS, MOST_MARKS, CEILING = 3, 200, 1.6
# Debris in the order of the stack from below; what it comes from.
PARTS = {"deposited_disc": "#005a9c", "deposited_pin": "#8cc4e8", "pool": "#c44e1c", "emitted": "#f0c362"}
SOURCES = ("worn_pin", "worn_resin", "worn_disc", "returned")
REVOLUTION = "mean of the last simulated revolution"
TEMPERATURES = ("contact_temperature_max", "contact_temperature_heated", "contact_temperature", "disc_temperature", "pin_temperature")
FILLED = ("filled_fraction", "disc_secondary", "pin_secondary", "pin_primary")
# Airborne: what panels show, with the prefix of its unit, and the name of each line.
AIRBORNE = {"airborne mass": ("kg ", {"pm10_mass": "PM10", "pm25_mass": "PM2.5"}), "number of airborne particles": ("", {"particle_number": ""})}


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
    found = []
    for _, own in pandas.Series(subjects, dtype=object).groupby([one.scene_without_seeds for one in subjects], sort=False):
        is_mean = len({str(one.run.attrs.get("seeds")) for one in own}) == len(own) > 2
        for some in [[*own]] if is_mean else [[one] for one in own]:
            time = min((one.time for one in some), key=lambda time: float(time[-1]))
            values = [one.while_rubbing(unit.value(one.values(name))) if rubbing else unit.value(one.values(name)) for one in some]
            columns = np.transpose([np.interp(time, one.time, column) for one, column in zip(some, values, strict=True)])
            label = f"{some[0].run.attrs.get('title', some[0].label)}: mean of {len(own)} seeds" if is_mean else some[0].label
            found.append(Course(some[0], label, pandas.DataFrame(columns, time)))
    return found


def in_windows(values: Any, most: int) -> Any:
    """Samples in at most so many groups of equally many that follow each other."""
    return values.groupby(np.arange(len(values)) // max(1, math.ceil(len(values) / most)))


def line_of(course: Course, duration: float) -> Any:
    """A line by time: means in windows; in a run without a cycle `weighted` over a duration, s."""
    most = MOST_OF_CYCLE if course.subject.has_cycle else MOST
    line = in_windows(course.values.reset_index(), most).mean().set_index("index")
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
    """Duration of means, s: 0 for windows, more if a line goes up and down all along, as with the place on the disc, like waves."""
    durations = [one.duration for one in every if not one.is_short and pulses(one.values.mean(axis=1).to_numpy())]
    return PART * max(durations, default=0.0)


def pulses(line: Any) -> bool:
    """Tells whether a line goes up and down all along."""
    return bool(np.nansum(np.abs(np.diff(line))) > MOST_WAY * np.ptp(line))


def draw(axis: Any, course: Course, time: Unit, duration: float, is_exact: bool = False, **options: Any) -> float:
    """Draws the line of a course, or exactly its values, and the range of seeds; gives the largest value."""
    line = course.values if is_exact else line_of(course, duration)
    at, options = time.value(line.index), {"label": course.label, **course.subject.line, **options}
    axis.plot(at, line.mean(axis=1, skipna=False), **options)
    if line.shape[1] > 1:
        axis.fill_between(at, line.min(axis=1), line.max(axis=1), color=options["color"], alpha=0.2, linewidth=0)
    return float(np.nan_to_num(line).max(initial=0.0))


def draw_steps(axis: Any, course: Course, time: Unit, duration: float, label: str | None) -> None:
    """Draws single steps as dots, or, where they are very many, as a band between percentiles."""
    values, look = course.values[0], {"color": course.subject.line["color"], "label": label}
    if course.is_short:
        # Very many are pixels, in drawings of lines, too.
        look |= {"markersize": 1.3, "markeredgewidth": 0, "rasterized": len(values) > MOST_OF_CYCLE}
        axis.plot(time.value(values.index), values, "o", alpha=0.35, **look)
        return
    most = min(MOST, len(values) // LEAST_OF_BAND, *([round(2 * course.duration / duration)] if duration else []))
    at = np.concatenate([values.index[:1], in_windows(values.index.to_series(), most).mean(), values.index[-1:]])
    low, high = (np.pad(in_windows(values, most).quantile(part), 1, "edge") for part in BAND)
    axis.fill_between(time.value(at), low, high, alpha=0.2, linewidth=0, **look)


def time_of(subjects: Sequence[Subject]) -> Unit:
    """The unit of the time of all runs."""
    return unit_of("s", max(float(subject.time[-1]) for subject in subjects))


def time_axis(axes: Iterable[Any], subjects: Sequence[Subject]) -> None:
    """Gives axes the time of all runs, and shades the events of a single run, last in legends: they are less important."""
    time, events = time_of(subjects), subjects[0].run.plateau.events if len(subjects) == 1 else pandas.DataFrame()
    for axis in axes:
        axis.set(xlim=(0, time.value(max(float(subject.time[-1]) for subject in subjects))), xlabel=f"time, {time.symbol}")
        if 0 < len(events) <= MOST_EVENTS:
            spans = time.value(np.column_stack([events["start"], events["end"] - events["start"]]))
            look = {"transform": axis.get_xaxis_transform(), "color": APART, "linewidth": 0, "zorder": 0, "label": "events of the cycle"}
            axis.broken_barh(spans, (0, 1), **look)


def note_of(every: Sequence[Course], duration: float, usual: str, *more: str) -> str:
    """Note on what lines and bands are, and on runs that are too short for the means of the others."""
    unit = unit_of("s", duration)
    said = [f"lines: {usual}"] if any(more) or len(every) > 1 else []
    if duration:
        said = [f"lines: weighted mean over {unit.value(duration):.3g} {unit.symbol} where values pulse as the resin wears"]
        other = [one.label for one in every if 2 * duration > one.duration or one.subject.has_cycle]
        said += [f"of {', '.join(dict.fromkeys(other))}: {usual}"] if other else []
    said += ["band of seeds: least to greatest"] if any(one.values.shape[1] > 1 for one in every) else []
    text = "; ".join([*said, *filter(None, more)])
    return text[:1].upper() + text[1:]


def contact_area(drawing: Drawing, subjects: list[Subject]) -> list[Any]:
    """Mean over the last simulated revolution against time, and single steps; above it load and speed if a run has a cycle."""
    shown = courses(subjects, "contact_area_mean", MM2, True)
    single = [one for one in courses(subjects, "contact_area", MM2, True) if one.values.shape[1] == 1 and len(shown) <= MOST_BANDS]
    above = ["normal_force", "rotational_speed"] if any(one.has_cycle for one in subjects) and drawing.ax is None else []
    ratios, usual = [1] * len(above) + [2], WIDE if above else NARROW
    figure, axes = drawing.panels(len(ratios), 58 if not above else 34, "Contact area against time", 1, usual, height_ratios=ratios)
    *upper, axis = axes
    time, duration = time_of(subjects), calm(shown)
    for one, name in zip(upper, above, strict=True):
        operation(one, subjects, name, time)
    kinds = {f"{'' if one.is_short else f'{100 * BAND[0]:.0f} to {100 * BAND[1]:.0f} % of '}single steps": one.is_short for one in single}
    label = next(iter(kinds), None) if drawing.only else None
    for one in single:
        draw_steps(axis, one, time, duration, label)
    highest = axis.dataLim.y1
    own: dict[str, Any] = {"label": "weighted mean" if duration else REVOLUTION} if drawing.only else {}
    largest = max(draw(axis, one, time, duration, **own) for one in shown)
    # The mean must be readable beside single steps.
    axis.set(ylim=(0, 1.05 * max(largest, min(highest, CEILING * largest)) or 1), ylabel=f"contact area, {MM2.symbol}")
    time_axis(axes, subjects)
    for one in upper:
        one.label_outer()
    figure.align_ylabels()
    more = [] if drawing.only else [f"{'dots' if is_dotted else 'bands'}: {kind}" for kind, is_dotted in kinds.items()]
    more += ["highest single steps are beyond the axis"] if highest > CEILING * largest > 0 else []
    return drawing.explained(figure, axis, note_of(shown, duration, REVOLUTION, *more), markerscale=3 if drawing.only else 1)


def operation(axis: Any, subjects: list[Subject], name: str, time: Unit) -> None:
    """Draws load or speed, that of the scene if a run has no cycle; the speed is that of the vehicle if all runs have it."""
    is_road = name == "rotational_speed" and all(subject.has("series/road_distance") for subject in subjects)
    unit = KMH if is_road else SERIES[name].unit
    for subject in subjects:
        if is_road:
            steps = np.diff(subject.time, prepend=0.0)
            values = np.diff(subject.values("road_distance"), prepend=0.0) / np.where(steps > 0, steps, np.nan)
        elif subject.has(f"series/{name}"):
            values = subject.values(name)
        else:
            values = quantity(subject.run.plateau.scene["operation"][name], "N" if name == "normal_force" else "rad s-1")
        draw(axis, Course(subject, subject.label, pandas.Series(unit.value(values), subject.time).to_frame()), time, 0.0)
    title = "speed of the\nvehicle" if is_road else "speed of the\ndisc" if name == "rotational_speed" else "normal\nforce"
    axis.set(ylim=(0, None), ylabel=f"{title}, {unit.symbol}")


def friction(drawing: Drawing, subjects: list[Subject]) -> list[Any]:
    """Coefficient of friction against time, and that of single steps against mean pressure."""
    shown = courses(subjects, "friction_coefficient_mean", NUMBER, True)
    time, duration = time_of(subjects), calm(shown)
    figure, (left, right) = drawing.panels(2, 60, "Coefficient of friction against time and against mean contact pressure", sharey=True)
    for course in shown:
        draw(left, course, time, duration)
    unit = unit_of("Pa", np.concatenate([subject.values("mean_pressure") for subject in subjects]))
    for subject in subjects:
        steps = pandas.Series(subject.while_rubbing(subject.values("friction_coefficient")), unit.value(subject.values("mean_pressure")))
        steps = in_windows(steps[steps.notna() & (steps.index > 0)], MOST_MARKS).head(1)
        right.plot(steps, subject.line.get("marker", "o"), color=subject.line["color"], markersize=2, markeredgewidth=0, alpha=0.7)
    is_wide = right.dataLim.x1 > 20 * right.dataLim.x0
    right.set(xscale="log" if is_wide else "linear", xlabel=f"mean contact pressure, {unit.symbol}", xlim=(None if is_wide else 0, None))
    left.set_ylabel("coefficient of friction")
    time_axis([left], subjects)
    note = note_of(shown, duration, f"{REVOLUTION}, weighted by load", f"dots: single steps, at most {MOST_MARKS} of a run")
    return drawing.explained(figure, left, note)


def in_panels(drawing: Drawing, subjects: list[Subject], names: Sequence[str], unit: Unit, caption: str, what: str) -> list[Any]:
    """Draws series of one unit: those of a single run in one panel, of several each in its own."""
    found = {name: courses(those, name, unit) for name in names if (those := [one for one in subjects if one.has(f"series/{name}")])}
    # Temperatures have peaks that nothing may take away.
    durations = {name: 0.0 if unit is CELSIUS else calm(shown) for name, shown in found.items()}
    count, duration = 1 if drawing.only else len(found), max(durations.values())
    figure, axes = drawing.panels(count, 62 if drawing.only else 48, caption)
    for place, (name, shown) in enumerate(found.items()):
        axis, title = axes[place % count], "valleys of the disc filled" if name == "filled_fraction" else SERIES[name].title
        for course in shown:
            own = look(place) | {"label": title} if drawing.only else {}
            draw(axis, course, time_of(subjects), duration if durations[name] else 0.0, unit is CELSIUS, **own)
        axis.set(title="" if drawing.only else title, ylabel=f"{what}, {unit.symbol}")
    for axis in axes if unit is PERCENT else ():
        axis.set_ylim(0, None)
    time_axis(axes, subjects)
    drawn = [course for shown in found.values() for course in shown]
    is_noted = duration or any(course.values.shape[1] > 1 for course in drawn)
    return drawing.explained(figure, axes[0], note_of(drawn if is_noted else [], duration, "mean"))


temperature = partial(in_panels, names=TEMPERATURES, unit=CELSIUS, caption="Temperatures against time", what="temperature")
filled = partial(in_panels, names=FILLED, unit=PERCENT, caption="Filled part of the valleys, and coverage, against time", what="fraction")


def debris(drawing: Drawing, subjects: list[Subject]) -> list[Any]:
    """Balance of the wear debris, stacked, with all that was worn; below it the same without what was emitted."""
    every = [totals(subject, [*PARTS, *SOURCES], MOST) for subject in subjects]
    is_there = pandas.concat(every).gt(0).any()
    there = [name for name in PARTS if is_there[name]]
    kept = [name for name in there if name != "emitted"]
    line = "worn off" + (", or back from plateaus that broke away" if is_there["returned"] else "")
    most, figures = drawing.columns(3), list[Any]()
    for first in range(0, len(subjects), most):
        page = [*zip(subjects, every, strict=True)][first : first + most]
        figure, axes = drawing.panels(2 * len(page), 49, "Balance of the wear debris", len(page), sharex=True, sharey="row")
        time_axis(axes, subjects)
        for names, sums, title, row in ((there, SOURCES, "debris", axes[: len(page)]), (kept, kept, "not emitted", axes[len(page) :])):
            highest = max(parts[[*sums]].sum(axis=1).max() for parts in every)
            unit, labels = unit_of("m3", highest), [SERIES[name].title.removesuffix(" of the simulated pin") for name in names]
            row[0].set(ylim=(0, 1.05 * unit.value(highest) or 1), ylabel=f"{title}, {unit.symbol}")
            for axis, (subject, parts) in zip(row, page, strict=True):
                at = time_of(subjects).value(parts.index)
                if names:
                    axis.stackplot(at, unit.value(parts[names].T), colors=[PARTS[name] for name in names], labels=labels, linewidth=0)
                if names is there:
                    axis.plot(at, unit.value(parts[[*sums]].sum(axis=1)), color="black", label=line)
                    axis.set_title("" if drawing.only else wrapped(subject.label, 90 // len(page)))
                axis.label_outer()
        note = "Sums since the start: debris that was deposited, worn off and deposited again counts twice"
        figures += drawing.explained(figure, axes[0], note, reverse=True)
    return figures


def emission(drawing: Drawing, subjects: list[Subject]) -> list[Any]:
    """Airborne mass and number of particles that are added in windows of time, and since the start for each kilometre of road."""
    on_road = [subject for subject in subjects if subject.has("series/road_distance")]
    # Windows of few pulses would beat with them.
    most = MOST_OF_EMISSION // 2 if calm(courses(subjects, "contact_area_mean", MM2)) else MOST_OF_EMISSION
    panels = [(title, *kind, is_road) for is_road in (False, True) if on_road or not is_road for title, kind in AIRBORNE.items()]
    whose = "brake_" if all(subject.has("series/brake_pm10_mass") for subject in subjects) else ""
    figure, axes = drawing.panels(len(panels), 50, f"Airborne emission of the {'whole brake' if whose else 'simulated pin'} against time")
    for axis, (title, prefix, names, is_road) in zip(axes, panels, strict=True):
        drawn = []
        for subject in on_road if is_road else subjects:
            for place, (name, label) in enumerate(names.items()):
                values = per_metre(subject, whose + name) if is_road else rates(subject, whose + name, most)
                drawn.append((drawing.look(subject, place, label or "PM10"), values))
        unit = unit_of(prefix + ("m-1" if is_road else "s-1"), np.concatenate([values for _, values in drawn]))
        for own, values in drawn:
            axis.plot(time_of(subjects).value(values.index), unit.value(values), drawstyle="default" if is_road else "steps-post", **own)
        axis.yaxis.set_major_formatter(lambda value, _: number(value))
        axis.set(title=title, ylim=(0, None), ylabel=f"{'emission factor' if is_road else 'rate'}, {unit.symbol}")
    time_axis(axes, subjects)
    # The area of the mesh is that in contact over the part that this is of it.
    areas = [] if whose else [MM2.value(one.values("contact_area").max() / (one.values("contact_ratio").max() or math.nan)) for one in subjects]
    spans = [float(np.median(np.diff(rates(one, "pm10_mass", most).index))) for one in subjects]
    area = ", ".join(dict.fromkeys(f"{area:.3g} {MM2.symbol}" for area in areas))
    span = ", ".join(dict.fromkeys(moment(float(f"{span:.2g}")) for span in spans))
    note = f"Of the {'whole brake' if whose else f'simulated pin, {area}, not of a brake'}; rates: means over {span}"
    note += "; emission factors: since the start, without the first twentieth of the way" if on_road else ""
    note += "; lines: PM10; paler: PM2.5" if len(subjects) > 1 else ""
    return drawing.explained(figure, axes[0], note)


def totals(subject: Subject, names: Sequence[str], most: int) -> Any:
    """Totals at the start, when there was nothing, and at the ends of windows of equally many samples, by time, s."""
    ends = in_windows(pandas.DataFrame({name: subject.values(name) for name in names}, subject.time), most).tail(1)
    return ends.reindex(ends.index.union([0.0]), fill_value=0.0)


def rates(subject: Subject, name: str, most: int) -> Any:
    """Growth of a total per second in windows of equally many samples, by their starts, s; the last twice, for its end."""
    ends = totals(subject, [name], most)[name]
    return (ends.diff() / ends.index.diff()).shift(-1).ffill()


def per_metre(subject: Subject, name: str) -> Any:
    """A total over the way of the vehicle by then, by time, s, without the first twentieth of the way."""
    way = subject.values("road_distance")
    far = (way > 0) & (way >= 0.05 * np.nanmax(way))
    return pandas.Series(subject.values(name)[far] / way[far], subject.time[far])
