"""Series against time: contact area, friction, temperatures, filling and coverage, debris, emission; and any series of a run."""

import dataclasses
import json
import math
import tomllib
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import xarray

from plateau.errors import InputError
from plateau.figures.drawing import EVENTS, Drawing, Subject, moment, subjects_of
from plateau.quantities import CELSIUS, KMH, MM2, NUMBER, PERCENT, SERIES
from plateau.run_file import array
from plateau.style import APART, DASHES, LINES, NARROW, WIDE, Figures, in_style, labelled, new, wrapped
from plateau.units import Unit, unit_of

# Windows of time in which samples are put together, at most; those of a cycle, whose events are short; those of emission.
MOST, MOST_OF_CYCLE, MOST_OF_EMISSION = 250, 1500, 60
# Samples of a window of which a band tells the extent, at least; the percentiles that it reaches from and to.
LEAST_OF_BAND, BAND = 20, (5, 95)
# Runs whose single steps are drawn; samples that are marked; events that are shaded: at most.
MOST_BANDS, MOST_MARKS, MOST_EVENTS = 3, 200, 100
# A line that goes up and down by more than so many times its range is a weighted mean over this part of the longest run; what single
# steps are higher than so many times the highest mean is beyond the axis.
MOST_WAY, PART, CEILING = 3.0, 1 / 16, 1.6
# Debris in the order of the stack from below; what it comes from.
PARTS = {"deposited_disc": "#005a9c", "deposited_pin": "#8cc4e8", "pool": "#c44e1c", "emitted": "#f0c362"}
SOURCES = ("worn_pin", "worn_resin", "worn_disc", "returned")
REVOLUTION = "mean of the last simulated revolution"


@dataclasses.dataclass(frozen=True)
class Course:
    """A series of a run, or of runs that differ in seeds alone: then their mean, and the values of all."""

    subject: Subject
    time: Any
    values: Any
    seeds: Any = None

    @property
    def duration(self) -> float:
        """s"""
        return float(self.time[-1] - self.time[0])

    @property
    def is_dotted(self) -> bool:
        """Whether single steps are dots: a band would go over the gaps of a cycle."""
        return len(self.time) <= MOST or self.subject.has_cycle


def courses(subjects: Sequence[Subject], name: str, unit: Unit, rubbing: bool = False) -> list[Course]:
    """A series of runs in a unit, if wanted with gaps where nothing rubs; three or more that differ in seeds alone become one."""
    found, groups = [], dict[str, list[Course]]()
    for subject in subjects:
        values = unit.value(subject.values(name))
        course = Course(subject, subject.time, subject.while_rubbing(values) if rubbing else values)
        groups.setdefault(without_seeds(subject.run), []).append(course)
    for own in groups.values():
        if len({str(one.subject.run.attrs.get("seeds")) for one in own}) < max(len(own), 3):
            found += own
            continue
        time = min((one.time for one in own), key=lambda time: float(time[-1]))
        every = np.array([np.interp(time, one.time, one.values) for one in own])
        label = f"{own[0].subject.run.attrs.get('title', own[0].subject.label)}: mean of {len(own)} seeds"
        found.append(Course(dataclasses.replace(own[0].subject, label=label), time, every.mean(axis=0), every))
    return found


def without_seeds(run: xarray.DataTree) -> str:
    """The scene of a run without its seeds and its output."""
    tables = json.loads(json.dumps(tomllib.loads(str(run.attrs["scene"])) | {"output": 0}, sort_keys=True, default=str), object_hook=seedless)
    return json.dumps(tables)


def seedless(table: dict[str, Any]) -> dict[str, Any]:
    """A table without a seed."""
    return {key: value for key, value in table.items() if key != "seed"}


def in_windows(values: Any, most: int) -> Any:
    """Samples in at most so many windows of equally many, a row each; the last is filled up with NaN."""
    length = max(1, math.ceil(len(values) / most))
    return np.append(values, np.full(-len(values) % length, np.nan)).reshape(-1, length)


def means(time: Any, values: Any, most: int) -> tuple[Any, Any]:
    """Means of time and value in windows, over the samples that have a value, if there are any."""
    times, parts = in_windows(time, most), in_windows(values, most)
    there = np.isfinite(parts)
    known = np.where(there.any(axis=1, keepdims=True), there, np.isfinite(times))
    with np.errstate(invalid="ignore"):
        return np.where(known, times, 0).sum(axis=1) / known.sum(axis=1), np.where(there, parts, 0).sum(axis=1) / there.sum(axis=1)


def line_of(course: Course, duration: float) -> tuple[Any, Any]:
    """Times and values of a line: means in windows, or, if this duration, s, fits twice into a run without a cycle, means over it, of weights
    that decrease to zero. They need as many values behind as before, so this line ends before the run does.
    """
    time, values = means(course.time, course.values, MOST_OF_CYCLE if course.subject.has_cycle else MOST)
    beside = round(duration * (len(time) - 1) / (course.duration or 1) / 2)
    if beside < 2 or 2 * duration > course.duration or course.subject.has_cycle:
        return time, values
    found = []
    for at in range(len(values) + 1 - beside):
        reach = min(beside - 1, at)
        found.append(np.average(values[at - reach : at + reach + 1], weights=reach + 1 - np.abs(np.arange(-reach, reach + 1))))
    return time[: len(found)], np.array(found)


def calm(every: Sequence[Course]) -> float:
    """Over how long a time, s, means go: 0 for those of windows; longer if a line goes up and down all along, as with the place of the
    pin on the disc, which would look like waves, or is, beside others, one block.
    """
    long = [one for one in every if len(one.time) > MOST and not one.subject.has_cycle]
    is_any = any(np.nansum(np.abs(np.diff(one.values))) > MOST_WAY * np.ptp(one.values) for one in long)
    return PART * max(one.duration for one in long) if is_any else 0.0


def draw(axis: Any, course: Course, time: Unit, duration: float, **options: Any) -> float:
    """Draws the line of a course, and the range of seeds; gives the largest value."""
    at, values = line_of(course, duration)
    options = {"label": course.subject.label, **course.subject.line, **options}
    axis.plot(time.value(at), values, **options)
    # A value alone between two gaps makes no line.
    there = np.pad(np.isfinite(values), 1)
    alone = there[1:-1] & ~there[:-2] & ~there[2:]
    if alone.any():
        axis.plot(time.value(at[alone]), values[alone], ".", color=options["color"], markersize=1.5)
    if course.seeds is not None:
        values = np.array([line_of(dataclasses.replace(course, values=one), duration)[1] for one in course.seeds])
        axis.fill_between(time.value(at), values.min(axis=0), values.max(axis=0), color=options["color"], alpha=0.2, linewidth=0)
    return float(np.nanmax(values, initial=0.0))


def steps_of(course: Course, duration: float) -> tuple[Any, Any, Any]:
    """Times of single steps, with the ends of a band of percentiles; if there are few or a cycle, twice their values."""
    if course.is_dotted:
        values = course.values[:: math.ceil(len(course.time) / MOST_OF_CYCLE)]
        return course.time[:: math.ceil(len(course.time) / MOST_OF_CYCLE)], values, values
    most = min(MOST, len(course.time) // LEAST_OF_BAND, *([round(2 * course.duration / duration)] if duration else []))
    at = np.concatenate([course.time[:1], means(course.time, course.time, most)[0], course.time[-1:]])
    low, high = (np.pad(part, 1, "edge") for part in np.nanpercentile(in_windows(course.values, most), BAND, axis=1))
    return at, low, high


def time_axis(axes: Iterable[Any], subjects: Sequence[Subject], label: bool = True) -> Unit:
    """Gives axes the time of all runs, and shades the events of a single run; gives the unit of time."""
    end = max(float(subject.time[-1]) for subject in subjects)
    time, run = unit_of("s", end), subjects[0].run
    is_cycle = len(subjects) == 1 and "event" in run.children
    spans = time.value(np.array([array(run, f"event/{name}").values for name in ("start", "end")])).T if is_cycle else np.empty((0, 2))
    for axis in axes:
        axis.set(xlim=(0, time.value(end)), xlabel=f"time, {time.symbol}" if label else "")
        if 0 < len(spans) <= MOST_EVENTS:
            bars = [(start, end - start) for start, end in spans]
            axis.broken_barh(bars, (0, 1), transform=axis.get_xaxis_transform(), color=APART, linewidth=0, zorder=0, label=EVENTS)
    return time


def note_of(every: Sequence[Course], duration: float, usual: str, *more: str) -> str:
    """What lines and bands are, and which runs are too short for the means of the others."""
    unit = unit_of("s", duration)
    said = [f"lines: {usual}"] if any(more) or len(every) > 1 else []
    if duration:
        said = [f"lines: weighted mean over {unit.value(duration):.3g} {unit.symbol} where values pulse as the resin wears"]
        other = [one.subject.label for one in every if 2 * duration > one.duration or one.subject.has_cycle]
        said += [f"of {', '.join(dict.fromkeys(other))}: {usual}"] if other else []
    said += ["band of seeds: least to greatest"] if any(one.seeds is not None for one in every) else []
    text = "; ".join([*said, *filter(None, more)])
    return text[:1].upper() + text[1:]


@in_style
def contact_area(drawing: Drawing) -> Figures:
    """Mean over the last simulated revolution against time, and single steps; above it load and speed of runs with a cycle."""
    subjects = drawing.with_series("contact_area", "contact_area_mean")
    if not subjects:
        return {}
    shown = courses(subjects, "contact_area_mean", MM2, True)
    steps = [one for one in courses(subjects, "contact_area", MM2, True) if one.seeds is None and len(shown) <= MOST_BANDS]
    cycles = [subject for subject in subjects if subject.has_cycle and drawing.ax is None]
    above = [name for name in ("normal_force", "rotational_speed") if any(one.has(f"series/{name}") for one in cycles)]
    duration = calm(shown)
    reach = [(one, *steps_of(one, duration)) for one in steps]
    largest = max(float(np.nanmax(line_of(one, duration)[1], initial=0.0)) for one in shown)
    highest = max((float(np.nanmax(high, initial=0.0)) for *_, high in reach), default=0.0)
    kinds = {"dots" if one.is_dotted else "bands": f"{'' if one.is_dotted else f'{BAND[0]} to {BAND[1]} % of '}single steps" for one in steps}
    more = [] if drawing.only else [f"{kind}: {what}" for kind, what in kinds.items()]
    # The mean must be readable beside single steps.
    more += ["highest single steps are beyond the axis"] if highest > CEILING * largest > 0 else []
    note = note_of(shown, duration, REVOLUTION, *more)
    ratios: dict[str, Any] = {"height_ratios": [1] * len(above) + [2]} if above else {}
    usual = (WIDE if cycles else NARROW, 72 + 22 * len(above))
    figure, axes = drawing.new(*usual, "Contact area against time", len(above) + 1, 1, note, **ratios)
    *upper, axis = axes[:, 0]
    time_axis(upper, subjects, label=False)
    time = time_axis([axis], subjects)
    for one, name in zip(upper, above, strict=True):
        one.tick_params(labelbottom=False)
        operation(one, cycles, name, time)
    for one, at, low, high in reach:
        look = {"color": one.subject.colour, "label": next(iter(kinds.values())) if drawing.only else None}
        if one.is_dotted:
            axis.plot(time.value(at), high, "o", alpha=0.35, markersize=1.3, markeredgewidth=0, **look)
        else:
            axis.fill_between(time.value(at), low, high, alpha=0.2, linewidth=0, **look)
    own = {"label": "weighted mean" if duration else REVOLUTION} if drawing.only else {}
    largest = max(draw(axis, one, time, duration, **own) for one in shown)
    axis.set(ylim=(0, 1.05 * max(largest, min(highest, CEILING * largest)) or 1), ylabel=f"contact area, {MM2.symbol}")
    figure.align_ylabels()
    drawing.legend(figure, axis, markerscale=3 if drawing.only else 1)
    return {"contact-area": figure}


def operation(axis: Any, subjects: Sequence[Subject], name: str, time: Unit) -> None:
    """Draws load or speed; the speed is that of the vehicle if all runs have it."""
    is_road = name == "rotational_speed" and all(subject.has("series/road_distance") for subject in subjects)
    for subject in subjects:
        if is_road:
            steps = np.diff(subject.time, prepend=0.0)
            values = KMH.value(np.diff(subject.values("road_distance"), prepend=0.0) / np.where(steps > 0, steps, np.nan))
        elif subject.has(f"series/{name}"):
            values = SERIES[name].unit.value(subject.values(name))
        else:
            continue
        draw(axis, Course(subject, subject.time, values), time, 0.0)
    title = "speed of the\nvehicle" if is_road else "speed of the\ndisc" if name == "rotational_speed" else "normal\nforce"
    axis.set(ylim=(0, None), ylabel=f"{title}, {KMH.symbol if is_road else SERIES[name].unit.symbol}")


@in_style
def friction(drawing: Drawing) -> Figures:
    """Coefficient of friction against time, and that of single steps against mean pressure."""
    names = ("friction_coefficient_mean", "friction_coefficient", "mean_pressure")
    subjects = drawing.with_part(*names)
    if not subjects:
        return {}
    shown = courses(subjects, names[0], NUMBER, True)
    duration = calm(shown)
    note = note_of(shown, duration, f"{REVOLUTION}, weighted by load", f"dots: single steps, at most {MOST_MARKS} of a run")
    figure, (left, right) = drawing.grid(2, 60, "Coefficient of friction against time and against mean contact pressure", note, sharey=True)
    time = time_axis([left], subjects)
    for course in shown:
        draw(left, course, time, duration)
    unit = unit_of("Pa", np.concatenate([subject.values(names[2]) for subject in subjects]))
    every = np.array([])
    for subject in subjects:
        pressure, coefficient = unit.value(subject.values(names[2])), subject.while_rubbing(subject.values(names[1]))
        touching = np.flatnonzero((pressure > 0) & np.isfinite(coefficient))
        touching = touching[:: max(1, math.ceil(len(touching) / MOST_MARKS))]
        marker = subject.line.get("marker", "o")
        right.plot(pressure[touching], coefficient[touching], marker, color=subject.colour, markersize=2, markeredgewidth=0, alpha=0.7)
        every = np.append(every, pressure[touching])
    right.set_xscale("log" if every.size and every.max() > 20 * every.min() else "linear")
    right.set(xlabel=f"mean contact pressure, {unit.symbol}", xlim=(None if right.get_xscale() == "log" else 0, None))
    left.set_ylabel("coefficient of friction")
    drawing.legend(figure, left)
    return {"friction": figure}


def in_panels(drawing: Drawing, name: str, titles: dict[str, str], unit: Unit, caption: str, what: str) -> Figures:
    """Draws series of one unit: those of a single run in one panel, of several each in its own; nothing if no run has any."""
    subjects = drawing.with_part(list(titles)[-1])
    if not subjects:
        return {}
    found = {one: courses([subject for subject in subjects if subject.has(f"series/{one}")], one, unit) for one in titles}
    found = {one: shown for one, shown in found.items() if shown}
    every = [course for shown in found.values() for course in shown]
    duration = 0.0 if unit is CELSIUS else max(calm(shown) for shown in found.values())
    seeds = next((shown for shown in found.values() if any(one.seeds is not None for one in shown)), [])
    note = note_of(every if duration else seeds, duration, "mean")
    is_one = drawing.only is not None
    figure, axes = drawing.grid(1 if is_one else len(found), 54 + 4 * len(found) if is_one else 48, caption, note)
    time = time_axis(axes, subjects)
    for number, (series, shown) in enumerate(found.items()):
        axis = axes[0 if is_one else number]
        for course in shown:
            own = {"label": titles[series], "color": LINES[number], "linestyle": DASHES[number]} if drawing.only else {}
            if unit is CELSIUS and course.seeds is None:
                at = extremes(course.values)
                axis.plot(time.value(course.time[at]), course.values[at], **{"label": course.subject.label, **course.subject.line, **own})
            else:
                draw(axis, course, time, duration if calm(shown) else 0.0, **own)
        axis.set_ylabel(f"{what}, {unit.symbol}")
        axis.set_title("" if is_one else titles[series], loc="left")
    for axis in axes if unit is PERCENT else ():
        axis.set_ylim(0, None)
    drawing.legend(figure, axes[0])
    return {name: figure}


def extremes(values: Any) -> Any:
    """Indices of the least and the greatest value of windows, and of both sides of every gap, so that no peak is lost."""
    parts = in_windows(values, 2 * MOST)
    begin, gaps = np.arange(len(parts)) * parts.shape[1], np.flatnonzero(np.diff(np.isfinite(values)))
    least, greatest = (begin + np.argmax(np.where(np.isfinite(parts), sign * parts, -np.inf), axis=1) for sign in (-1, 1))
    return np.unique(np.concatenate([[0, len(values) - 1], least, greatest, gaps, gaps + 1]))


@in_style
def temperature(drawing: Drawing) -> Figures:
    """Temperatures of contact, disc and pin, and of the pin's cells where they were recorded."""
    names = ("contact_temperature_max", "contact_temperature_heated", "contact_temperature", "disc_temperature", "pin_temperature")
    titles = {name: SERIES[name].title for name in names}
    return in_panels(drawing, "temperature", titles, CELSIUS, "Temperatures against time", "temperature")


@in_style
def filled(drawing: Drawing) -> Figures:
    """Filled part of the valleys of the disc, and parts of the areas of disc and pin that are plateaus."""
    titles = {name: SERIES[name].title for name in ("filled_fraction", "disc_secondary", "pin_secondary", "pin_primary")}
    titles["filled_fraction"] = "valleys of the disc filled"
    return in_panels(drawing, "filled", titles, PERCENT, "Filled part of the valleys, and coverage, against time", "fraction")


@in_style
def debris(drawing: Drawing) -> Figures:
    """Where the wear debris is, stacked, with all that was worn; below it the same without what was emitted."""
    subjects = drawing.with_series(*PARTS, *SOURCES)
    # At the start there was none.
    every = [{name: np.insert(subject.values(name), 0, 0.0) for name in (*PARTS, *SOURCES)} for subject in subjects]
    worn = [np.sum([parts[name] for name in SOURCES], axis=0) for parts in every]
    there = [name for name in PARTS if any(np.any(parts[name] > 0) for parts in every)]
    kept = [name for name in there if name != "emitted"]
    rows = [(there, "debris", worn), (kept, "not emitted", [sum((parts[name] for name in kept), np.zeros(1)) for parts in every])]
    note = "Sums since the start: debris that was deposited, worn off and deposited again counts twice"
    line = "worn off" + (", or back from plateaus that broke away" if any(np.any(parts["returned"] > 0) for parts in every) else "")
    columns = min(len(subjects), 3 if (drawing.width or WIDE) >= WIDE / 1.5 else 1)
    figures: Figures = {}
    for first in range(0, len(subjects), columns or 1):
        width = NARROW if columns == 1 else WIDE
        figure, axes = drawing.new(width, 112, "Balance of the wear debris", 2, columns, note, sharex=True, sharey="row")
        time_axis(axes[0], subjects, label=False)
        time = time_axis(axes[1], subjects)
        for row, (names, title, totals) in enumerate(rows):
            unit = unit_of("m3", np.concatenate(totals))
            labels = [SERIES[name].title.removesuffix(" of the simulated pin") for name in names]
            for number, axis in zip(range(first, len(subjects)), axes[row], strict=False):
                at = np.insert(subjects[number].time, 0, 0.0)
                chosen = np.append(np.arange(0, len(at) - 1, math.ceil(len(at) / MOST)), len(at) - 1)
                at, stack = time.value(at[chosen]), [unit.value(every[number][name][chosen]) for name in names]
                if names:
                    axis.stackplot(at, stack, colors=[PARTS[name] for name in names], labels=labels, linewidth=0)
                if row == 0:
                    axis.plot(at, unit.value(worn[number][chosen]), color="black", label=line)
                    axis.set_title("" if drawing.only else wrapped(subjects[number].label, 90 // columns), loc="left")
            top = max(float(np.max(total)) for total in totals)
            axes[row, 0].set(ylim=(0, 1.05 * unit.value(top) or 1), ylabel=f"{title}, {unit.symbol}")
        for axis in axes[:, len(subjects) - first :].flat:
            axis.set_visible(False)
        drawing.legend(figure, axes[0, 0], reverse=True)
        figures[f"debris-{first // columns + 1}" if first else "debris"] = figure
    return figures


def rates(time: Any, values: Any, most: int) -> tuple[Any, Any]:
    """The start and the ends of windows with equally many samples, and what a total grows in each for each second, the last twice."""
    ends = np.unique(np.nanmax(in_windows(time, most), axis=1))
    ends = np.insert(ends[ends > 0], 0, 0.0)
    found = np.diff(np.interp(ends, np.insert(time, 0, 0.0), np.insert(values, 0, 0.0))) / np.diff(ends)
    return ends, np.append(found, found[-1:])


def per_metre(subject: Subject, values: Any) -> tuple[Any, Any]:
    """Times, and a total over the way of the vehicle by then, without the first twentieth of the way."""
    way = subject.values("road_distance")
    far = np.flatnonzero((way > 0) & (way >= 0.05 * np.nanmax(way)))
    far = far[::-1][:: math.ceil(len(far) / (2 * MOST)) or 1][::-1]
    return subject.time[far], values[far] / way[far]


@in_style
def emission(drawing: Drawing) -> Figures:
    """Airborne mass and number of particles that are added in windows of time, and since the start for each kilometre of road."""
    subjects = drawing.with_part("pm10_mass", "pm25_mass", "particle_number")
    if not subjects:
        return {}
    on_road = [subject for subject in subjects if subject.has("series/road_distance")]
    # Windows of few pulses would beat with them.
    most = MOST_OF_EMISSION // 2 if calm(courses(subjects, "contact_area_mean", MM2)) else MOST_OF_EMISSION
    # The area of the mesh is that in contact over the part that this is of it.
    areas = [MM2.value(one.values("contact_area").max() / (one.values("contact_ratio").max() or math.nan)) for one in subjects]
    spans = [moment(float(f"{np.median(np.diff(rates(one.time, one.time, most)[0])):.2g}")) for one in subjects]
    said = ", ".join(dict.fromkeys(f"{area:.3g} {MM2.symbol}" for area in areas)), ", ".join(dict.fromkeys(spans))
    note = f"Of the simulated pin, {said[0]}, not of a brake; rates: means over {said[1]}"
    note += "; emission factors: since the start, without the first twentieth of the way" if on_road else ""
    note += "; lines: PM10; paler: PM2.5" if len(subjects) > 1 else ""
    figure, axes = drawing.grid(4 if on_road else 2, 50, "Airborne emission of the simulated pin against time", note)
    time = time_axis(axes, subjects)
    for number, axis in enumerate(axes):
        is_number, is_road = number % 2 == 1, number > 1
        drawn = []
        for subject in on_road if is_road else subjects:
            for place, name in enumerate(["particle_number"] if is_number else ["pm10_mass", "pm25_mass"]):
                values = subject.values(name)
                own = {"color": LINES[place], "linestyle": DASHES[place], "label": ["PM10", "PM2.5"][place]} if drawing.only else {}
                line = {**subject.line, "label": None if place else subject.label, "alpha": 0.45 if place and not own else 1.0, **own}
                drawn.append((line, *(per_metre(subject, values) if is_road else rates(subject.time, values, most))))
        unit = in_powers(("" if is_number else "kg ") + ("m-1" if is_road else "s-1"), np.concatenate([values for *_, values in drawn]))
        for line, at, values in drawn:
            axis.plot(time.value(at), unit.value(values), drawstyle="default" if is_road else "steps-post", **line)
        axis.set(ylim=(0, None), ylabel=f"{'emission factor' if is_road else 'rate'}, {unit.symbol}")
        axis.set_title("number of airborne particles" if is_number else "airborne mass", loc="left")
    drawing.legend(figure, axes[0])
    return {"emission": figure}


def in_powers(si: str, values: Any) -> Unit:
    """The unit for the largest of values; thousands of those that have no prefix are in front of it."""
    unit = unit_of(si, values)
    power = 3 * int(math.log10(max(1.0, unit.value(float(np.nanmax(values, initial=0.0))))) // 3)
    return Unit(f"10{str(power).translate(str.maketrans('0123456789', '⁰¹²³⁴⁵⁶⁷⁸⁹'))} {unit.symbol}", unit.per_si / 10**power) if power else unit


@in_style
def draw_series(run: xarray.DataTree, names: Sequence[str], ax: Any = None) -> Any:
    """Draws series of a run of equal units against time, and gives the axes; if none is named, the contact area and its mean."""
    [subject] = subjects_of([run])
    known = {name: array(run, f"series/{name}") for name in names or ("contact_area", "contact_area_mean")}
    if len({str(values.attrs.get("units", "1")) for values in known.values()}) > 1:
        raise InputError(f"{', '.join(known)} have different units: draw them one by one")
    first = next(iter(known))
    unit = subject.series(first).unit
    ax = new(NARROW, 60, f"{first} of {subject.label}")[1][0, 0] if ax is None else ax
    for number, (name, values) in enumerate(known.items()):
        shown, label = unit.value(subject.values(name)), values.attrs.get("long_name", name)
        look = {"color": "0.7", "marker": ".", "markersize": 2, "linestyle": ""} if not names and not number else {}
        ax.plot(subject.time, subject.while_rubbing(shown) if name.endswith("_mean") or not names else shown, label=label, **look)
    ax.set(xlabel="time, s", ylabel=labelled(first.replace("_", " ") if len(names) < 2 else "", unit.symbol), title=subject.label)
    if len(known) > 1:
        ax.legend()
    return ax
