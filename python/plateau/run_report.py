"""One page about runs for the browser and for print: the answer first, then figures, then tables; docs/figures.md describes it."""

import functools
import math
import os
import re
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
import pandas
import xarray

from plateau import figures, program
from plateau.errors import InputError, PlateauError, PlateauWarning
from plateau.html_page import listed, page, pictures, table
from plateau.means import LEAST_REVOLUTIONS, Mean
from plateau.opened_runs import Run, counted, inputs_of, labels_of, named_like, opened, read_files
from plateau.output_folder import followed, put, refuse_file
from plateau.quantities import CELSIUS, METRE, MM2, MM3, NEWTON, NUMBER, RPM, SERIES
from plateau.run_file import array, source
from plateau.style import NARROW, saved
from plateau.units import NUMBER as QUANTITY
from plateau.units import Unit, quantity, unit_for, unit_of, with_digits, with_minus

# As scenes have it, and as laboratories do.
WEAR_RATES = (Unit("1/Pa", 1.0), Unit("mm³/(N m)", 1e9))
UNKNOWN, METRES_PER_SECOND, NOTHING = "–", Unit("m/s", 1.0), Mean(math.nan, math.nan, math.nan, math.nan, math.nan)
# Columns of runs, or of quantities of events, that fit a printed page.
MOST_COLUMNS, MOST_QUANTITIES = 3, 8
# Endings of what other words make, or a browser.
NO_PAGES = (".pdf", ".png", ".svg", ".csv")
# The figures of the first page, of runs with friction, heat or emission, and of others.
FIRST_FIGURES = (("friction", "temperature", "emission", "contact-area"), ("contact-area", "filled", "status", "heights"))
# Series of which the largest value is told, the last one, and the mean, for they pulse with the contact area; the first two of runs with
# friction, heat or emission.
LARGEST = ["disc_temperature", "contact_temperature", "contact_temperature_max", "pin_temperature", "heat_residual"]
DISSIPATION = ["disc_temperature", "pin_temperature", "friction_work", "heat_lost", "emitted_mass", "pm10_mass", "pm25_mass", "particle_number"]
MEANS = ["contact_ratio", "mean_pressure", "max_pressure", "friction_coefficient", "pin_secondary", "pin_primary", "pin_none"]
AT_END = ("filled_fraction disc_secondary worn_whole_pin lost_pin worn_pin worn_resin worn_disc emitted deposited_pin deposited_disc pool").split()
# Numbers of several runs on the first page, by their names in the table of all numbers, and what they are called there.
ANSWERS = {
    "Coefficient of friction, mean": "coefficient of friction",
    "Largest mean temperature of the disc": "hottest disc",
    "Mass airborne as PM10, of the simulated pin": "PM10 of the pin",
    "PM10 of the whole brake, for the distance of the vehicle": "PM10 of the brake",
    "Volume worn off the whole simulated pin, plateaus and resin": "worn off the pin",
    "Disc filled": "disc filled",
    "Pin covered by secondary plateaus, mean": "secondary plateaus of the pin",
}
# Numbers of the whole brake, of runs with one, at their end.
BRAKE = [name for name in SERIES if name.startswith(("brake_", "pad_")) and name != "brake_torque"]
ORIGIN = ["program", "source_revision", "host", "instruction_set", "start_time", "end_time", "seeds", "surfaces", "conventions", "references"]


@dataclass(frozen=True)
class Measure:
    """A number of a run, SI, with its standard error if there is one."""

    name: str
    unit: Unit
    value: float = math.nan
    error: float = math.nan

    @property
    def text(self) -> str:
        # What is a part of cells may hardly scatter in time: more than four digits would be those of one mesh.
        if self.unit.symbol == "%" and self.error < 1e-2 * abs(self.value):
            places = max(3 - math.floor(math.log10(abs(100.0 * self.value))), 0)
            error = f" ± {100.0 * self.error:.{places}f}" if 100.0 * self.error >= 0.5 * 10.0**-places else ""
            return f"{100.0 * self.value:.{places}f}{error} %"
        return self.unit.text(self.value, self.error)

    def compared(self, first: "Measure") -> str:
        """The number, with its difference from that of the first run."""
        difference, error = self.value - first.value, math.hypot(self.error, first.error)
        if not math.isfinite(difference):
            return self.text
        if difference == 0:
            return f"{self.text} (same)"
        said = self.unit.text(difference, error, is_difference=True)
        if not math.isfinite(error):
            said = with_minus(f"{self.unit.per_si * difference:.3g} {self.unit.of_differences}".strip())
        # Percent of percent confuse; of what is 0, or has its 0 anywhere, there are none.
        is_ratio = self.unit.symbol != "%" and not self.unit.offset and first.value
        share = with_minus(f", {100 * difference / abs(first.value):+.1f} %") if is_ratio else ""
        return f"{self.text} ({'+' if difference > 0 else ''}{said.replace('%', 'points')}{share})"


class Told:
    """Content of a report on one run: its numbers, sentences and facts."""

    def __init__(self, run: xarray.DataTree, label: str) -> None:
        self.run, self.label, self.series = run, label, run.plateau.series
        # The time of the last sample, s.
        self.time, self.state = float(array(run, "time")[-1:].sum()), str(run.attrs.get("state", UNKNOWN))
        self.scene: dict[str, Any] = run.plateau.scene
        self.dissipates = any(name in self.series for name in ("friction_work", "disc_temperature", "pm10_mass"))
        self.has_cycle = "normal_force" in self.series
        # What only the program computes.
        self.summary, self.without = dict[str, Any](), ""
        try:
            with warnings.catch_warnings(action="ignore", category=PlateauWarning):
                self.summary = program.call(["summary", program.file_name(source(run), "a run file")]) or {}
        except PlateauError as error:
            self.without = f"Running in and time acceleration are left out, the program did not tell: {str(error).splitlines()[0]}."
        self.window = run.plateau.mean("contact_area") if len(self.series) and "contact_area" in self.series else NOTHING
        # The program knows how long a pulse takes.
        self.has_pulses = (self.summary.get("contact_area_last_tenth") or {}).get("standard_error", math.nan) is not None
        self.area = Measure("Contact area, mean ± standard error", MM2, self.window.value, self.known(self.window))

    def known(self, mean: Mean) -> float:
        """The standard error of a mean, NaN where the contact area has too few pulses in its last tenth."""
        return mean.error if self.has_pulses else math.nan

    def of(self, name: str) -> "pandas.Series[float]":
        """A series, without values if there is none."""
        return self.series.get(name, pandas.Series(dtype=float))

    def last(self, name: str) -> float:
        """The last value of a series, NaN if there is none."""
        return float(self.of(name).iloc[-1:].sum(min_count=1))

    def largest(self, name: str) -> float:
        return float(self.of(name).abs().max())

    def setting(self, table: str, key: str) -> str:
        return str(self.scene.get(table, {}).get(key, UNKNOWN))

    @property
    def wear_rate(self) -> float:
        """The specific wear rate of the whole pin, as a balance shows it, 1/Pa; NaN where the load changes, of which samples know only some."""
        force, way = self.scene.get("operation", {}).get("normal_force"), self.last("sliding_distance")
        return math.nan if self.has_cycle or force is None or not way > 0 else self.last("lost_pin") / (quantity(force, "N") * way)

    @property
    def pin_area(self) -> float:
        """The area of the pin, m²; NaN if there was no contact."""
        areas = self.of("contact_area") / self.of("contact_ratio").where(lambda ratio: ratio > 0)
        return float(areas.dropna().iloc[-1:].sum(min_count=1))

    @functools.cached_property
    def five(self) -> dict[str, str]:
        """Main numbers of the scene, as text with units, by name."""
        area, radius, way = self.pin_area, float(array(self.run, "radius").mean()), self.last("sliding_distance")
        if self.has_cycle:
            most, force = "at most ", _short(NEWTON, self.largest("normal_force"), 4)
            pressure = self.largest("normal_force") / area
            speed = radius * float((self.of("rotational_speed") * (self.of("normal_force") > 0)).max())
        else:
            most, force = "", self.setting("operation", "normal_force")
            pressure, speed = self.last("mean_pressure") * self.last("contact_ratio"), way / (self.time or math.nan)
        return {
            "normal force": f"{most}{force}",
            "nominal pressure": f"{most}{_short(unit_for('Pa', pressure), pressure)}",
            "sliding speed": f"{most}{_short(METRES_PER_SECOND, speed, 4)}",
            "simulated time, way": f"{unit_for('s', self.time or 1.0).text(self.time)}, {_short(METRE, way, 4)}",
            "area of the pin": _short(MM2, area),
        }

    def answer(self) -> Iterator[str]:
        """Yields the results, in sentences."""
        if self.dissipates and "friction_coefficient" in self.series and self.time:
            mean = self.run.plateau.mean("friction_coefficient", 0.0 if self.has_cycle else None)
            over = "over all events" if self.has_cycle else f"of {self.over}"
            most, values = self.setting("friction", "maximum"), self.of("friction_coefficient")
            at = float(np.isclose(values[values > 0], float(most)).mean()) if re.fullmatch(QUANTITY, most) else 0.0
            bound = f"; in {100 * at:.0f} % of the samples it is the maximum of the scene, {most}" if at > 0.005 else ""
            yield f"The coefficient of friction is {NUMBER.text(mean.value, self.known(mean))}, mean {over}{bound}"
        for name in ("disc_temperature", "contact_temperature"):
            if math.isfinite(value := self.largest(name)):
                yield f"The largest {SERIES[name].title} is {_short(CELSIUS, value)}"
        for name in ("pm10_mass", "pm25_mass", "brake_pm10_per_distance", "brake_pm25_per_distance", "pad_wear_per_distance", "pad_life"):
            if math.isfinite(value := self.last(name)):
                yield f"The {SERIES[name].title}, is {_short(unit_for('kg', value) if name.startswith('pm') else SERIES[name].unit, value)}"
        if math.isfinite(self.area.value):
            share = self.area.value / self.pin_area
            part = f", {100 * share:.3g} % of the pin" if math.isfinite(share) else ""
            yield f"The contact area is {self.area.text}{part}, mean of {self.over}"
        if math.isfinite(worn := self.last("worn_whole_pin")):
            rates = " = ".join(_short(unit, self.wear_rate, 4) for unit in WEAR_RATES)
            rate = f"; the specific wear rate of the whole pin is {rates}" if math.isfinite(self.wear_rate) else ""
            yield f"Worn off the simulated pin are {_short(unit_for('m3', worn), worn)}{rate}"
        if math.isfinite(filled := self.last("filled_fraction")):
            yield f"Debris fills {100 * filled:.3g} % of the disc's volume below its highest point"
        if not self.time:
            yield "There are no samples yet"
        if self.summary.get("running_in"):
            yield f"Running in: {with_minus(self.summary['running_in'])}"

    @property
    def over(self) -> str:
        """Time over which the contact area is averaged, in words."""
        contact = (self.summary.get("contact_area_last_tenth") or {}).get("contact_time")
        of = f", of which {contact:.4g} s in contact" if contact else ""
        return f"{self.window.start:.6g} to {self.window.end:.6g} s{of}" if math.isfinite(self.window.value) else UNKNOWN

    def notices(self) -> Iterator[str]:
        """Yields notices of what deserves attention, in sentences."""
        if self.state != "finished":
            yield f"The run is not finished: {self.told_state}. It has {counted(len(self.series), 'sample')}."
        if self.time and not math.isfinite(self.area.error):
            yield "The contact area has no standard error: too few samples, revolutions or pulses."
        elif self.window.revolutions < LEAST_REVOLUTIONS * (1 - 1e-9):
            yield "The contact area is the mean of fewer than ten simulated revolutions."
        tolerance, residual = self.setting("contact", "load_tolerance"), self.largest("load_residual")
        if re.fullmatch(QUANTITY, tolerance) and residual > float(tolerance):
            yield f"The load balance has a residual of {residual:.2g}, above the tolerance {tolerance}."
        if "contact_temperature_max" in self.series:
            yield (
                "Temperatures of cells count pressures as frozen during a pass and have no conduction along the surface: "
                "on rough discs the hottest may be half of their rise too low."
            )
        yield from filter(None, [self.without])

    @property
    def told_state(self) -> str:
        """The state in words."""
        error = f"failed: {self.run.attrs['error']}" if "error" in self.run.attrs else "failed"
        return {"running": "running, or killed", "interrupted": "interrupted by its user", "failed": error}.get(self.state, self.state)

    @functools.cached_property
    def measures(self) -> dict[str, Measure]:
        """The numbers of the run by their names, the same ones in the same order for every run."""

        def measure(name: str, value: float, before: str = "", after: str = "", error: float = math.nan) -> Measure:
            title = f"{before}{SERIES[name].title}{after}"
            return Measure(title[0].upper() + title[1:], SERIES[name].unit, value, error)

        found = []
        if self.dissipates:
            found += [measure(name, self.largest(name), "largest ") for name in LARGEST]
            found += [measure(name, self.last(name)) for name in DISSIPATION]
        found += [measure("brake_torque", self.largest("brake_torque"), "largest ")]
        found += [measure(name, self.last(name)) for name in BRAKE]
        found.append(self.area)
        means = {name: self.run.plateau.mean(name) for name in MEANS if self.time and name in self.series}
        found += [measure(name, mean.value, "", ", mean", self.known(mean)) for name, mean in means.items()]
        found += [measure(name, self.last(name)) for name in ("sliding_distance", "road_distance")]
        total = sum(self.last(name) for name in ("worn_pin", "worn_resin", "worn_disc"))
        found += [Measure("Worn volume of the simulated pin and the disc", MM3, total)]
        found += [measure(name, self.last(name)) for name in AT_END]
        found += [Measure(f"Specific wear rate of the whole pin, {unit.symbol}", unit, self.wear_rate) for unit in WEAR_RATES]
        for name, of in (("load_residual", "load"), ("balance_residual", "debris")):
            found.append(Measure(f"Largest residual of the {of} balance", NUMBER, self.largest(name)))
            found.append(Measure(f"Last residual of the {of} balance", NUMBER, abs(self.last(name))))
        return {one.name: one for one in found}

    @functools.cached_property
    def facts(self) -> dict[str, str]:
        """Facts of the run, by name: file, state, mesh, wall time, workers."""
        sizes, wall = self.run.sizes, float(self.run.attrs.get("wall_time", math.nan))
        duration = self.setting("operation", "duration")
        of = "" if self.state == "finished" or duration == UNKNOWN else f" of {duration}"
        path = Path(source(self.run))
        size = f" ({path.stat().st_size / 1e6:.3g} MB)" if path.is_file() else ""
        keys = [key for key in ("running_in", "running_in_time", "time_acceleration") if self.summary.get(key)]
        return {
            "Run file": f"{path}{size}",
            "State": self.told_state,
            "Simulated time": f"{self.time:.5g} s{of}",
            "Samples and times of maps": f"{len(self.series)} and {sizes.get('map_time', 0)}",
            "Mesh": f"{sizes['radius']} rows, {sizes['disc_angle']} columns of the disc, {sizes['pin_angle']} of the pin",
            "Wall time": unit_for("s", wall).text(wall),
            "Workers": f"{self.run.attrs.get('workers', UNKNOWN)}, {self.run.attrs.get('instruction_set', UNKNOWN)}",
            "Mean contact area is taken over": self.over,
            **{key.capitalize().replace("_", " "): with_minus(str(self.summary[key])) for key in keys},
        }


def _short(unit: Unit, value: float, digits: int = 3) -> str:
    """A value, SI, with so many digits."""
    rounded = float(f"{unit.value(value):.{digits}g}")
    return with_minus(f"{rounded:.6g} {unit.symbol}") if math.isfinite(value) else UNKNOWN


def report(runs: Run | Sequence[Run], output: str | os.PathLike[str] | None = None, *, force: bool = False, progress: bool | None = None) -> str:
    """Writes one page in HTML about a run, or about several that are compared with the first.

    Parameters
    ----------
    runs : path, xarray.DataTree, or a sequence of them
        Runs, at most ten.
    output : path, optional
        The page; by default in the working directory, named like the run file, or ``report.html`` for several.
    force : bool
        Replace the page if it exists.
    progress : bool, optional
        Show progress; by default in notebooks and terminals.

    Returns
    -------
    str
        The path of the page.
    """
    trees = opened(runs)
    path = Path(output) if output is not None else named_like(trees[0], ".html") if len(trees) == 1 else Path("report.html")
    if path.suffix.lower() in NO_PAGES:
        raise InputError(f"-o {path}: a report is a page in HTML, expected a name such as {path.with_suffix('.html')}; a browser prints it as PDF")
    path = followed(path)
    refuse_file(path, force, inputs_of(trees), "name another one with -o")
    put(path, report_page(trees, progress).encode())
    return str(path)


def report_page(runs: Sequence[xarray.DataTree], progress: bool | None = False) -> str:
    """The page about opened runs."""
    told = [Told(run, label) for run, label in zip(runs, labels_of(runs), strict=True)]
    drawn = figures.drawn(runs)
    files = saved(drawn, ["svg"], dpi=200, progress=progress)
    wanted = FIRST_FIGURES[0 if any(one.dissipates for one in told) else 1]
    # High ones of several panels have less room there.
    first = sorted((name for name in wanted if name in drawn), key=lambda name: drawn[name].get_figheight() * 25.4 > 90)[:2]
    # Two of one column of a journal beside each other.
    kind = "pair" if all(drawn[name].get_figwidth() * 25.4 < 1.2 * NARROW for name in first) else "stack"
    each = [(one.label, [*one.notices()]) for one in told]
    of = {notice: [label for label, own in each if notice in own] for _, notices in each for notice in notices}
    notices = [notice if len(labels) == len(told) else f"{', '.join(labels)}: {notice}" for notice, labels in of.items()]
    several, five = len(told) > 1, told[0].five
    tables, said = _compared(told) if several else ([table([*five], [[*five.values()]])], ". ".join(told[0].answer()))
    parts = [
        '<section class="first">',
        *tables,
        f'<p class="answer">{escape(said)}.</p>',
        f'<div class="{kind}">{pictures({name: drawn[name] for name in first}, files)}</div>',
        f'<div class="notice">{listed(notices)}</div>' if notices else "",
        "</section>",
        "<h2>Figures</h2>" if len(drawn) > len(first) else "",
        pictures({name: figure for name, figure in drawn.items() if name not in first}, files, len(first) + 1),
        "<h2>Numbers</h2>" + _numbers(told),
        _differences(told) if several else "",
        *(_events(one, several) for one in told if len(one.run.plateau.events)),
        "<h2>Scenes and provenance</h2>",
        *map(_provenance, told),
    ]
    return page(f"{len(told)} runs, compared with {told[0].label}" if several else told[0].label, *parts)


def _compared(told: Sequence[Told]) -> tuple[list[str], str]:
    """The tables that begin the page about several runs, and the answer."""
    texts = {name: [one.measures[name].text if name in one.measures else UNKNOWN for one in told] for name in ANSWERS}
    texts = {ANSWERS[name]: own for name, own in texts.items() if {*own} != {UNKNOWN}}
    of_scenes = table(["run", *told[0].five], [[one.label, *one.five.values()] for one in told])
    of_runs = table(["run", *texts], [[one.label, *row] for one, row in zip(told, zip(*texts.values(), strict=True), strict=True)])
    areas = [told[0].area.text, *(one.area.compared(told[0].area) for one in told[1:])]
    said = "The contact area is: " + "; ".join(f"{one.label} {area}" for one, area in zip(told, areas, strict=True))
    runs_in = "; ".join(f"{one.label}: {with_minus(one.summary['running_in'])}" for one in told if one.summary.get("running_in"))
    return [of_scenes, of_runs], said + (f". Running in: {runs_in}" if runs_in else "")


def _by_run(told: Sequence[Told], rows: dict[str, list[str]], head: str, kind: str = "words") -> str:
    """Tables with a column for each run; with as many as fit a page, each with the first run."""
    parts = []
    for start in range(1, max(len(told), 2), MOST_COLUMNS):
        heads = [one.label for one in (told[0], *told[start : start + MOST_COLUMNS])] if len(told) > 1 else ["value"]
        shown = {name: [texts[0], *texts[start : start + MOST_COLUMNS]] for name, texts in rows.items()}
        parts.append(table([head, *heads], [[name, *texts] for name, texts in shown.items() if {*texts} != {UNKNOWN}], kind))
    return "\n".join(parts)


def _numbers(told: Sequence[Told]) -> str:
    """Numbers, of which differences are from the first run, and facts."""
    numbers = {}
    for name in dict.fromkeys(name for one in told for name, measure in one.measures.items() if math.isfinite(measure.value)):
        first, *others = (one.measures.get(name, Measure(name, NUMBER)) for one in told)
        numbers[name] = [first.text, *(other.compared(first) for other in others)]
    facts = {name: [one.facts.get(name, UNKNOWN) for one in told] for name in dict.fromkeys(name for one in told for name in one.facts)}
    note = "Means are over the time of the mean contact area, all else is at the end of the run. "
    note += "Volumes, work, masses and particles are of the simulated pin, unless the whole brake is named."
    return f'<p class="quiet">{note}</p>{_by_run(told, numbers, "", "words values")}{_by_run(told, facts, "")}'


def _differences(told: Sequence[Told]) -> str:
    """Keys of scenes that differ."""
    scenes = pandas.concat([pandas.json_normalize(one.scene).iloc[0] for one in told], axis="columns").fillna(UNKNOWN).sort_index().map(str)
    rows = {str(key): texts for key, *texts in scenes.itertuples() if len({*texts}) > 1}
    return f"<h2>Keys of the scenes that differ</h2>{_by_run(told, rows, 'key')}" if rows else "<h2>Scenes</h2><p>Their scenes are the same.</p>"


def _events(told: Told, several: bool) -> str:
    """Tables of events, with as many quantities as fit a page."""
    events, columns = told.run.plateau.events, {}
    for name in events:
        si = str(told.run[f"event/{name}"].attrs.get("units", "1"))
        unit = RPM if si == "rad s-1" else unit_of(si, events[name])
        head = ", ".join(filter(None, [str(name).replace("_", " ").replace("pm10", "PM10"), unit.symbol]))
        columns[head] = [with_digits(number) or UNKNOWN for number in unit.value(events[name])]
    texts = pandas.DataFrame(columns, events.index + 1)
    parts = [f"<h2>Events{': ' + escape(told.label) if several else ''}</h2>"]
    for start in range(0, len(columns), MOST_QUANTITIES):
        shown = texts.iloc[:, start : start + MOST_QUANTITIES]
        parts.append(table(["event", *shown], [*shown.itertuples(name=None)]))
    return "\n".join(parts)


def _provenance(told: Told) -> str:
    """The origin of a run."""
    terms = [(name.replace("_", " "), str(told.run.attrs[name])) for name in ORIGIN if name in told.run.attrs]
    files = [[one["path"], one["sha256"]] for one in read_files(told.run)]
    return (
        f"<h3>{escape(told.label)}</h3>{table(['run file', source(told.run)], terms, 'words')}"
        f"{table(['file that was read', 'SHA-256'], files, 'words') if files else ''}"
        f"<h4>Resolved scene</h4><pre>{escape(str(told.run.attrs.get('scene', '')))}</pre>"
    )
