"""Figures of series against time: contact area, friction, temperatures, filling and coverage, debris, emission."""

import math
from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
import pandas

from plateau.figures.courses import BAND, MOST, Course, calm, courses, draw, draw_steps, in_windows, note_of, time_axis, time_of
from plateau.figures.drawing import Drawing, Subject, moment
from plateau.quantities import CELSIUS, KMH, MM2, NUMBER, PERCENT, SERIES
from plateau.style import NARROW, WIDE, look, wrapped
from plateau.units import Unit, quantity, unit_of

# Windows of emission, at most.
MOST_OF_EMISSION = 60
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


def contact_area(drawing: Drawing, subjects: list[Subject]) -> list[Any]:
    """Mean over the last simulated revolution against time, and single steps; above it load and speed if a run has a cycle."""
    shown = courses(subjects, "contact_area_mean", MM2, True)
    single = [one for one in courses(subjects, "contact_area", MM2, True) if one.values.shape[1] == 1 and len(shown) <= MOST_BANDS]
    above = ["normal_force", "rotational_speed"] if any(one.has_cycle for one in subjects) and drawing.ax is None else []
    height, ratios = (58 + 22 * len(above)) / (len(above) + 1), {"height_ratios": [1] * len(above) + [2]} if above else {}
    figure, axes = drawing.panels(len(above) + 1, height, "Contact area against time", 1, WIDE if above else NARROW, **ratios)
    *upper, axis = axes
    time, duration = time_of(subjects), calm(shown)
    for one, name in zip(upper, above, strict=True):
        operation(one, subjects, name, time)
    kinds = {f"{'' if one.is_short else f'{100 * BAND[0]:.0f} to {100 * BAND[1]:.0f} % of '}single steps": one.is_short for one in single}
    label = next(iter(kinds), None) if drawing.only else None
    highest = max((draw_steps(axis, one, time, duration, label) for one in single), default=0.0)
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
            said = quantity(subject.run.plateau.scene["operation"][name], "N" if name == "normal_force" else "rad s-1")
            values = np.full(subject.time.size, said)
        draw(axis, Course(subject, subject.label, pandas.DataFrame(unit.value(values), subject.time)), time, 0.0)
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
        steps = steps[steps.notna() & (steps.index > 0)]
        steps = steps[:: max(1, math.ceil(len(steps) / MOST_MARKS))]
        right.plot(steps, subject.line.get("marker", "o"), color=subject.line["color"], markersize=2, markeredgewidth=0, alpha=0.7)
    is_wide = right.dataLim.x1 > 20 * right.dataLim.x0
    right.set(xscale="log" if is_wide else "linear", xlabel=f"mean contact pressure, {unit.symbol}", xlim=(None if is_wide else 0, None))
    left.set_ylabel("coefficient of friction")
    time_axis([left], subjects)
    note = note_of(shown, duration, f"{REVOLUTION}, weighted by load", f"dots: single steps, at most {MOST_MARKS} of a run")
    return drawing.explained(figure, left, note)


def in_panels(drawing: Drawing, subjects: list[Subject], names: Sequence[str], unit: Unit, caption: str, what: str) -> list[Any]:
    """Draws series of one unit: those of a single run in one panel, of several each in its own."""
    having = {name: [subject for subject in subjects if subject.has(f"series/{name}")] for name in names}
    found = {name: courses(those, name, unit) for name, those in having.items() if those}
    # Temperatures have peaks that nothing may take away.
    durations = {name: 0.0 if unit is CELSIUS else calm(shown) for name, shown in found.items()}
    count, duration = 1 if drawing.only else len(found), max(durations.values())
    figure, axes = drawing.panels(count, 62 if drawing.only else 48, caption)
    for number, (name, shown) in enumerate(found.items()):
        axis, title = axes[number % count], "valleys of the disc filled" if name == "filled_fraction" else SERIES[name].title
        for course in shown:
            own = look(number) | {"label": title} if drawing.only else {}
            draw(axis, course, time_of(subjects), duration if durations[name] else 0.0, unit is CELSIUS, **own)
        axis.set_ylabel(f"{what}, {unit.symbol}")
        axis.set_title("" if drawing.only else title, loc="left")
    for axis in axes if unit is PERCENT else ():
        axis.set_ylim(0, None)
    time_axis(axes, subjects)
    drawn = [course for shown in found.values() for course in shown]
    is_noted = duration or any(course.values.shape[1] > 1 for course in drawn)
    return drawing.explained(figure, axes[0], note_of(drawn if is_noted else [], duration, "mean"))


temperature = partial(in_panels, names=TEMPERATURES, unit=CELSIUS, caption="Temperatures against time", what="temperature")
filled = partial(in_panels, names=FILLED, unit=PERCENT, caption="Filled part of the valleys, and coverage, against time", what="fraction")


def debris(drawing: Drawing, subjects: list[Subject]) -> list[Any]:
    """Where the wear debris is, stacked, with all that was worn; below it the same without what was emitted."""
    every = [pandas.DataFrame({name: one.values(name) for name in (*PARTS, *SOURCES)}, one.time) for one in subjects]
    # At the start there was none.
    every = [parts.reindex(np.insert(parts.index, 0, 0.0), fill_value=0.0) for parts in every]
    is_there = pandas.concat(every).gt(0).any()
    there = [name for name in PARTS if is_there[name]]
    kept = [name for name in there if name != "emitted"]
    line = "worn off" + (", or back from plateaus that broke away" if is_there["returned"] else "")
    columns, figures = min(len(subjects), drawing.columns(3)), list[Any]()
    for first in range(0, len(subjects), columns):
        figure, axes = drawing.panels(2 * columns, 49, "Balance of the wear debris", columns, sharex=True, sharey="row")
        time_axis(axes, subjects)
        for names, sums, title, row in ((there, SOURCES, "debris", axes[:columns]), (kept, kept, "not emitted", axes[columns:])):
            highest = max(parts[[*sums]].sum(axis=1).max() for parts in every)
            unit, labels = unit_of("m3", highest), [SERIES[name].title.removesuffix(" of the simulated pin") for name in names]
            row[0].set(ylim=(0, 1.05 * unit.value(highest) or 1), ylabel=f"{title}, {unit.symbol}")
            for axis in row[len(subjects) - first :]:
                axis.set_visible(False)
            for axis, subject, parts in zip(row, subjects[first:], every[first:], strict=False):
                shown = parts.iloc[np.append(np.arange(0, len(parts) - 1, math.ceil(len(parts) / MOST)), len(parts) - 1)]
                at = time_of(subjects).value(shown.index)
                if names:
                    axis.stackplot(at, unit.value(shown[names].T), colors=[PARTS[name] for name in names], labels=labels, linewidth=0)
                if names is there:
                    axis.plot(at, unit.value(shown[[*sums]].sum(axis=1)), color="black", label=line)
                    axis.set_title("" if drawing.only else wrapped(subject.label, 90 // columns), loc="left")
        for axis in axes:
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
                paler = {"label": None, "alpha": 0.45} if place else {"label": subject.label}
                own = look(place) | {"label": label or "PM10"} if drawing.only else paler
                drawn.append((subject.line | own, per_metre(subject, whose + name) if is_road else rates(subject, whose + name, most)))
        unit = in_powers(prefix + ("m-1" if is_road else "s-1"), np.concatenate([values for _, values in drawn]))
        for line, values in drawn:
            axis.plot(time_of(subjects).value(values.index), unit.value(values), drawstyle="default" if is_road else "steps-post", **line)
        axis.set(ylim=(0, None), ylabel=f"{'emission factor' if is_road else 'rate'}, {unit.symbol}")
        axis.set_title(title, loc="left")
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


def rates(subject: Subject, name: str, most: int) -> Any:
    """What a total grows for each second in windows of equally many samples, by their starts, s; the last twice, for its end."""
    ends = in_windows(pandas.Series(subject.values(name), subject.time), most).tail(1)
    ends = pandas.concat([pandas.Series({0.0: 0.0}), ends[ends.index > 0]])
    return (ends.diff() / ends.index.diff()).shift(-1).ffill()


def per_metre(subject: Subject, name: str) -> Any:
    """A total over the way of the vehicle by then, by time, s, without the first twentieth of the way."""
    way = subject.values("road_distance")
    far = (way > 0) & (way >= 0.05 * np.nanmax(way))
    return pandas.Series(subject.values(name)[far] / way[far], subject.time[far])


def in_powers(si: str, values: Any) -> Unit:
    """The unit for the largest of values; thousands of those that have no prefix are in front of it."""
    unit = unit_of(si, values)
    power = 3 * int(math.log10(max(1.0, unit.value(float(np.nan_to_num(values).max(initial=0.0))))) // 3)
    return Unit(f"10{str(power).translate(str.maketrans('0123456789', '⁰¹²³⁴⁵⁶⁷⁸⁹'))} {unit.symbol}", unit.per_si / 10**power) if power else unit
