"""One page about runs for the browser and for print: the answer first, then figures, then tables; docs/report.md describes it."""

import functools
import math
import os
import re
import tomllib
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from plateau import figures, program
from plateau.errors import InputError, PlateauError, PlateauWarning
from plateau.figures.drawing import labels_of
from plateau.html_page import listed, page, pictures, table
from plateau.means import LEAST_REVOLUTIONS, Mean
from plateau.opened_runs import Run, counted, inputs_of, named_like, opened, read_files
from plateau.output_folder import put, refuse_file
from plateau.quantities import CELSIUS, MM2, MM3, NUMBER, RPM, SERIES
from plateau.run_file import array, source
from plateau.style import NARROW, saved
from plateau.units import NUMBER as QUANTITY
from plateau.units import Unit, unit_for, unit_of

UNKNOWN, NOTHING = "–", Mean(math.nan, math.nan, math.nan, math.nan, math.nan)
# Columns of runs, or of quantities of events, that fit a printed page.
MOST_COLUMNS, MOST_QUANTITIES = 3, 8
# Endings of what other words make, or a browser.
NO_PAGES = (".pdf", ".png", ".svg", ".csv")
# The figures of the first page, of runs with friction, heat or emission, and of others.
FIRST_FIGURES = (("friction", "temperature", "emission", "contact-area"), ("contact-area", "filled", "status", "heights"))
# Series of which the mean is told, for they pulse with the contact area; those as they are at the end.
MEANS = "contact_ratio mean_pressure max_pressure friction_coefficient pin_secondary pin_primary pin_none".split()
AT_END = (
    "filled_fraction disc_secondary "
    "worn_whole_pin lost_pin worn_pin worn_resin worn_disc emitted deposited_pin deposited_disc pool"
).split()
DISSIPATION = "friction_work heat_lost emitted_mass pm10_mass pm25_mass particle_number".split()
LARGEST = "disc_temperature contact_temperature contact_temperature_max pin_temperature heat_residual".split()
# Numbers of several runs on the first page, by their names in the table of all numbers, and what they are called there.
ANSWERS = {
    "Coefficient of friction, mean": "coefficient of friction",
    "Largest mean temperature of the disc": "hottest disc",
    "Mass airborne as PM10, of the simulated pin": "PM10",
    "Volume worn off the whole simulated pin, plateaus and resin": "worn off the pin",
    "Disc filled": "disc filled",
    "Pin covered by secondary plateaus, mean": "secondary plateaus of the pin",
}
FOR_EACH_KM = {"pm10_mass": Unit("mg/km", 1e9), "pm25_mass": Unit("mg/km", 1e9), "particle_number": Unit("km⁻¹", 1e3)}
FOR_EACH = {"pm10_mass": "PM10", "pm25_mass": "PM2.5", "particle_number": "particles"}
ORIGIN = "program source_revision host instruction_set start_time end_time seeds surfaces conventions references".split()


@dataclass(frozen=True)
class Measure:
    """A number of a run, SI, with its standard error if there is one."""

    name: str
    unit: Unit
    value: float = math.nan
    error: float = math.nan

    @property
    def text(self) -> str:
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
            said = f"{self.unit.per_si * difference:.3g} {self.unit.of_differences}".strip().replace("-", "−")
        # Percent of percent confuse; of what is 0, or has its 0 anywhere, there are none.
        is_ratio = self.unit.symbol != "%" and not self.unit.offset and first.value
        share = f", {100 * difference / abs(first.value):+.1f} %".replace("-", "−") if is_ratio else ""
        return f"{self.text} ({'+' if difference > 0 else ''}{said.replace('%', 'points')}{share})"


class Told:
    """What there is to tell of a run."""

    def __init__(self, run: xarray.DataTree, label: str) -> None:
        self.run, self.label = run, label
        self.series = {str(name): np.asarray(values.values, float) for name, values in run["series"].data_vars.items()}
        self.time = np.asarray(array(run, "time"))
        try:
            self.scene: dict[str, Any] = tomllib.loads(str(run.attrs.get("scene", "")))
        except ValueError:
            self.scene = {}
        self.dissipates = any(name in self.series for name in ("friction_work", "disc_temperature", "pm10_mass"))
        self.has_cycle = "normal_force" in self.series or "rotational_speed" in self.series
        # What only the program computes.
        self.summary, self.without = dict[str, Any](), ""
        try:
            with warnings.catch_warnings(action="ignore", category=PlateauWarning):
                self.summary = program.call(["summary", program.file_name(source(run), "a run file")], progress=False) or {}
        except PlateauError as error:
            self.without = f"Running in and time acceleration are left out, the program did not tell: {str(error).splitlines()[0]}."
        self.window = run.plateau.mean("contact_area") if self.time.size and "contact_area" in self.series else NOTHING
        self.area = Measure("Contact area, mean ± standard error", MM2, self.window.value, self.window.error)

    def last(self, name: str) -> float:
        """The last value of a series, NaN if there is none."""
        return float(self.series[name][-1]) if self.time.size and name in self.series else math.nan

    def largest(self, name: str) -> float:
        values = np.abs(self.series.get(name, np.array([])))
        return float(np.nanmax(values)) if np.isfinite(values).any() else math.nan

    def setting(self, table: str, key: str) -> str:
        found = self.scene.get(table, {})
        return str(found.get(key, UNKNOWN)) if isinstance(found, dict) else UNKNOWN

    @property
    def pin_area(self) -> float:
        """The area of the pin, m²; NaN if there was no contact."""
        areas, ratios = self.series.get("contact_area", np.array([])), self.series.get("contact_ratio", np.array([]))
        there = np.flatnonzero(ratios[: len(areas)] > 0)
        return float(areas[there[-1]] / ratios[there[-1]]) if there.size else math.nan

    @property
    def five(self) -> list[str]:
        """The numbers of the scene that matter: force, pressure, speed, time, area of the pin."""
        force, area, radius = self.largest("normal_force"), self.pin_area, float(np.mean(array(self.run, "radius")))
        pressure = force / area if self.has_cycle else self.last("mean_pressure") * self.last("contact_ratio")
        pressed = self.series.get("normal_force", np.ones(1)) > 0
        speed = float(np.max(self.series.get("rotational_speed", np.zeros(1)) * pressed)) * radius if self.has_cycle else self.last("sliding_distance") / self.time[-1:].sum()
        most = "at most " if self.has_cycle else ""
        return [
            f"{most}{force:.4g} N" if self.has_cycle else self.setting("operation", "normal_force"),
            f"{most}{_short(unit_for('Pa', pressure), pressure)}",
            f"{most}{speed:.4g} m/s",
            f"{unit_of('s', self.time[-1:]).text(float(self.time[-1:].sum()))}, {self.last('sliding_distance'):.4g} m",
            _short(MM2, area),
        ]

    @property
    def answer(self) -> str:
        said = []
        if self.dissipates:
            if "friction_coefficient" in self.series and self.time.size:
                mean = self.run.plateau.mean("friction_coefficient", 0.0 if self.has_cycle else None)
                over = "over all events" if self.has_cycle else f"of {self.over}"
                most, values = self.setting("friction", "maximum"), self.series["friction_coefficient"]
                there = np.isfinite(values) & (values > 0)
                at = np.isclose(values[there], float(most)).mean() if there.any() and re.fullmatch(QUANTITY, most) else 0.0
                bound = f"; in {100 * at:.0f} % of the samples it is the maximum of the scene, {most}" if at > 0.005 else ""
                said.append(f"The coefficient of friction is {NUMBER.text(mean.value, mean.error)}, mean {over}{bound}")
            for name in ("disc_temperature", "contact_temperature"):
                if math.isfinite(value := self.largest(name)):
                    said.append(f"The largest {SERIES[name].title} is {_short(CELSIUS, value)}")
            road = self.last("road_distance")
            for name, what in (("pm10_mass", "PM10"), ("pm25_mass", "PM2.5")):
                if math.isfinite(mass := self.last(name)):
                    each = f", {_short(FOR_EACH_KM[name], mass / road)} of road" if road > 0 else ""
                    said.append(f"Airborne as {what} are {_short(unit_for('kg', mass), mass)} from the simulated pin{each}")
        if math.isfinite(self.area.value):
            share = self.area.value / self.pin_area
            part = f", {100 * share:.3g} % of the pin" if math.isfinite(share) else ""
            said.append(f"The contact area is {self.area.text}{part}, mean of {self.over}")
        worn, filled = self.last("worn_whole_pin"), self.last("filled_fraction")
        said += [f"Worn off the simulated pin are {_short(unit_for('m3', worn), worn)}"] if math.isfinite(worn) else []
        said += [f"Debris fills {100 * filled:.3g} % of the disc's volume below its highest point"] if math.isfinite(filled) else []
        said += [f"Running in: {self.summary['running_in']}"] if self.summary.get("running_in") else []
        return ". ".join(said or ["There are no samples yet"]) + "."

    @property
    def over(self) -> str:
        contact = (self.summary.get("contact_area_last_tenth") or {}).get("contact_time")
        of = f", of which {contact:.4g} s in contact" if contact else ""
        said = f"{self.window.start:.6g} to {self.window.end:.6g} s{of}"
        return said if math.isfinite(self.window.value) else UNKNOWN

    @property
    def warnings(self) -> list[str]:
        said, state = [], str(self.run.attrs.get("state", UNKNOWN))
        if state != "finished":
            said.append(f"The run is not finished: {self.state}. It has {counted(len(self.time), 'sample')}.")
        if self.time.size:
            if not math.isfinite(self.area.error):
                said.append("The contact area has no standard error: too few samples or revolutions.")
            elif self.window.revolutions < LEAST_REVOLUTIONS * (1 - 1e-9):
                said.append("The contact area is the mean of fewer than ten simulated revolutions.")
        tolerance, residual = self.setting("contact", "load_tolerance"), self.largest("load_residual")
        if re.fullmatch(QUANTITY, tolerance) and residual > float(tolerance):
            said.append(f"The load balance has a residual of {residual:.2g}, above the tolerance {tolerance}.")
        if "contact_temperature_max" in self.series:
            said.append(
                "Temperatures of cells count pressures as frozen during a pass and have no conduction along the surface: "
                "on rough discs the hottest may be half of their rise too low."
            )
        return said + ([self.without] if self.without else [])

    @property
    def state(self) -> str:
        state, error = str(self.run.attrs.get("state", UNKNOWN)), self.run.attrs.get("error")
        words = {"running": "running, or killed", "interrupted": "interrupted by its user", "failed": f"failed: {error}"}
        return words.get(state, state) if error or state != "failed" else state

    @functools.cached_property
    def measures(self) -> list[Measure]:
        """The numbers of the run, the same ones in the same order for every run."""
        def shown(name: str, value: float, before: str = "") -> Measure:
            title = before + SERIES[name].title if name in SERIES else before + name.replace("_", " ")
            return Measure(title[0].upper() + title[1:], SERIES[name].unit if name in SERIES else NUMBER, value)

        way = self.last("road_distance")
        own = [shown(name, self.largest(name), "largest ") for name in LARGEST]
        own += [shown(name, self.last(name)) for name in ("disc_temperature", "pin_temperature")]
        for name in DISSIPATION:
            own.append(shown(name, self.last(name)))
            if name in FOR_EACH_KM and way > 0:
                called = f"– for each kilometre of road: {FOR_EACH[name]}"
                own.append(Measure(called, FOR_EACH_KM[name], self.last(name) / way))
        total = sum(self.last(name) for name in ("worn_pin", "worn_resin", "worn_disc"))
        found = [*(own if self.dissipates else []), self.area]
        for name in MEANS if self.time.size else ():
            if name in self.series:
                mean = self.run.plateau.mean(name)
                found.append(Measure(f"{shown(name, 0.0).name}, mean", SERIES[name].unit, mean.value, mean.error))
        found += [shown("sliding_distance", self.last("sliding_distance")), shown("road_distance", way)]
        found += [Measure("Worn volume of the simulated pin and the disc", MM3, total)]
        found += [shown(name, self.last(name)) for name in AT_END]
        balances = (("load_residual", "load"), ("balance_residual", "debris"))
        return found + [Measure(f"Largest residual of the {of} balance", NUMBER, self.largest(name)) for name, of in balances]

    @property
    def facts(self) -> dict[str, str]:
        sizes, wall = self.run.sizes, float(self.run.attrs.get("wall_time", math.nan))
        duration = self.setting("operation", "duration")
        time = f"{float(self.time[-1:].sum()):.5g} s"
        path = Path(source(self.run))
        size = f" ({path.stat().st_size / 1e6:.3g} MB)" if path.is_file() else ""
        keys = ("running_in", "running_in_time", "time_acceleration")
        own = {key.capitalize().replace("_", " "): str(self.summary[key]) for key in keys if self.summary.get(key)}
        return {
            "Run file": f"{path}{size}",
            "State": self.state,
            "Simulated time": time if self.run.attrs.get("state") == "finished" or duration == UNKNOWN else f"{time} of {duration}",
            "Samples and times of maps": f"{len(self.time)} and {sizes.get('map_time', 0)}",
            "Mesh": f"{sizes['radius']} rows, {sizes['disc_angle']} columns of the disc, {sizes['pin_angle']} of the pin",
            "Wall time": unit_for("s", wall).text(wall),
            "Workers": f"{self.run.attrs.get('workers', UNKNOWN)}, {self.run.attrs.get('instruction_set', UNKNOWN)}",
            "Program": str(self.run.attrs.get("program", UNKNOWN)),
            "Mean contact area is taken over": self.over,
            **own,
        }


def _short(unit: Unit, value: float) -> str:
    shown = float(f"{unit.value(value):.3g}") if math.isfinite(value) else math.nan
    number = f"{shown:.0f}" if 1e3 <= abs(shown) < 1e6 else f"{shown:.3g}"
    return f"{number} {unit.symbol}".replace("-", "−") if math.isfinite(shown) else UNKNOWN


def report(runs: Run | Sequence[Run], output: str | os.PathLike[str] | None = None, *, force: bool = False) -> str:
    """Writes one page in HTML about a run, or about several that are compared with the first.

    Parameters
    ----------
    runs : path, xarray.DataTree, or a sequence of them
        At most eight.
    output : path, optional
        The page; by default in the working directory, named like the run file, or ``report.html`` for several.
    force : bool
        Replace the page if it exists.

    Returns
    -------
    str
        The path of the page.
    """
    trees = opened(runs)
    path = Path(output) if output is not None else named_like(trees[0], ".html") if len(trees) == 1 else Path("report.html")
    if path.suffix.lower() in NO_PAGES:
        name = path.with_suffix(".html")
        raise InputError(f"-o {path}: a report is a page in HTML, expected a name such as {name}; a browser prints it as PDF")
    refuse_file(path, force, inputs_of(trees), "name another one with -o")
    put(path, report_page(trees).encode())
    return str(path)


def report_page(runs: Sequence[xarray.DataTree]) -> str:
    """The page about opened runs."""
    told = [Told(run, label) for run, label in zip(runs, labels_of(runs), strict=True)]
    drawn = figures.drawn(runs)
    files = saved(drawn, ["svg"], dpi=200)
    wanted = FIRST_FIGURES[0 if any(one.dissipates for one in told) else 1]
    # High ones of several panels have less room there.
    first = sorted((name for name in wanted if name in drawn), key=lambda name: drawn[name].get_figheight() * 25.4 > 90)[:2]
    several = len(told) > 1
    # Two of one column of a journal beside each other.
    kind = "pair" if all(drawn[name].get_figwidth() * 25.4 < 1.2 * NARROW for name in first) else "stack"
    heads = ["normal force", "nominal pressure", "sliding speed", "simulated time, way", "area of the pin"]
    rows = [[one.label, *one.five] for one in told]
    by_names = [{measure.name: measure.text for measure in one.measures} for one in told]
    keys = [name for name in ANSWERS if any(own.get(name, UNKNOWN) != UNKNOWN for own in by_names)]
    first_rows = [[one.label, *(own.get(name, UNKNOWN) for name in keys)] for one, own in zip(told, by_names, strict=True)]
    of: dict[str, list[str]] = {}
    for one in told:
        for said in one.warnings:
            of.setdefault(said, []).append(one.label)
    notices = [said if len(labels) == len(told) else f"{', '.join(labels)}: {said}" for said, labels in of.items()]
    running = [f" Running in: {one.summary['running_in']}." if one.summary.get("running_in") else "" for one in told]
    answers = [
        f"{one.label}: contact area {one.area.compared(told[0].area)}.{own}" if several else one.answer
        for one, own in zip(told, running, strict=True)
    ]
    parts = [
        '<section class="first">',
        table(["run", *heads], rows) if several else table(heads, [rows[0][1:]]),
        table(["run", *(ANSWERS[name] for name in keys)], first_rows) if several else "",
        *(f'<p class="answer">{escape(said)}</p>' for said in answers),
        f'<div class="{kind}">{pictures({name: drawn[name] for name in first}, files)}</div>',
        f'<div class="notice">{listed(notices)}</div>' if notices else "",
        "</section>",
        "<h2>Figures</h2>" if len(drawn) > len(first) else "",
        pictures({name: figure for name, figure in drawn.items() if name not in first}, files, len(first) + 1),
        "<h2>Numbers</h2>" + _numbers(told),
        _differences(told) if several else "",
        *(_events(one, several) for one in told),
        "<h2>Residuals</h2>" + _residuals(told),
        "<h2>Scenes and provenance</h2>",
        *map(_provenance, told),
    ]
    return page(f"{len(told)} runs, compared with {told[0].label}" if several else told[0].label, *parts)


def _in_columns(told: Sequence[Told]) -> list[list[Told]]:
    """Runs in groups whose columns fit a page, each with the first."""
    others = told[1:]
    return [[told[0], *others[start : start + MOST_COLUMNS]] for start in range(0, max(len(others), 1), MOST_COLUMNS)]


def _numbers(told: Sequence[Told]) -> str:
    """Numbers, of which differences are from the first run, and facts."""
    of = "Volumes, work, masses and particles are of the simulated pin, not of a brake."
    numbers, facts = [], []
    for group in _in_columns(told):
        first, *others = [{measure.name: measure for measure in one.measures} for one in group]
        every = dict.fromkeys(name for own in (first, *others) for name, one in own.items() if math.isfinite(one.value))
        nothing = {name: Measure(name, NUMBER) for name in every}
        rows = [
            [name, (first.get(name) or nothing[name]).text]
            + [(own.get(name) or nothing[name]).compared(first.get(name) or nothing[name]) for own in others]
            for name in every
        ]
        heads = ["", *(one.label for one in group)] if len(told) > 1 else ["", "value"]
        numbers.append(table(heads, rows, "words values"))
        every = dict.fromkeys(name for one in group for name in one.facts)
        facts.append(table(heads, [[name, *(one.facts.get(name, UNKNOWN) for one in group)] for name in every], "words"))
    return "\n".join([f'<p class="quiet">Means are over the time of the mean contact area, all else is at the end of the run. {of}</p>', *numbers, *facts])


def _keys(scene: dict[str, Any], path: str = "") -> dict[str, Any]:
    """Keys of a scene with dots, and their values."""
    found: dict[str, Any] = {}
    for key, value in scene.items():
        found |= _keys(value, f"{path}{key}.") if isinstance(value, dict) else {f"{path}{key}": value}
    return found


def _differences(told: Sequence[Told]) -> str:
    scenes = {id(one): _keys(one.scene) for one in told}
    keys = sorted({key for scene in scenes.values() for key in scene})
    differ = [key for key in keys if len({repr(scene.get(key)) for scene in scenes.values()}) > 1]
    if not differ:
        return "<h2>Scenes</h2><p>Their scenes are the same.</p>"
    parts = ["<h2>Keys of the scenes that differ</h2>"]
    for group in _in_columns(told):
        rows = [[key, *(str(scenes[id(one)].get(key, UNKNOWN)) for one in group)] for key in differ]
        parts.append(table(["key", *(one.label for one in group)], rows, "words"))
    return "\n".join(parts)


def _events(told: Told, several: bool) -> str:
    events = told.run.plateau.events
    if events.empty:
        return ""
    columns = {}
    for name in events:
        si = str(told.run[f"event/{name}"].attrs.get("units", "1"))
        unit = RPM if si == "rad s-1" else unit_of(si, events[name])
        head = ", ".join(filter(None, [str(name).replace("_", " ").replace("pm10", "PM10"), unit.symbol]))
        columns[head] = [f"{number:.4g}".replace("-", "−") if np.isfinite(number) else UNKNOWN for number in unit.value(events[name].to_numpy())]
    heads = list(columns)
    parts = [f"<h2>Events{': ' + escape(told.label) if several else ''}</h2>"]
    for start in range(0, len(heads), MOST_QUANTITIES):
        some = heads[start : start + MOST_QUANTITIES]
        rows = [[str(row + 1), *(columns[head][row] for head in some)] for row in range(len(events))]
        parts.append(table(["event", *some], rows))
    return "\n".join(parts)


def _residuals(told: Sequence[Told]) -> str:
    heads = ["run", "load: largest", "load: last", "load: tolerance", "debris: largest", "debris: last"]
    rows = []
    for one in told:
        numbers = [(one.largest(name), abs(one.last(name))) for name in ("load_residual", "balance_residual")]
        (load, last_load), (debris, last_debris) = [[f"{number:.3g}".replace("-", "−") for number in pair] for pair in numbers]
        rows.append([one.label, load, last_load, one.setting("contact", "load_tolerance"), debris, last_debris])
    return table(heads, rows)


def _provenance(told: Told) -> str:
    terms = [(name.replace("_", " "), str(told.run.attrs[name])) for name in ORIGIN if name in told.run.attrs]
    files = [[one["path"], one["sha256"]] for one in read_files(told.run)]
    scene = escape(str(told.run.attrs.get("scene", "")))
    return (
        f"<h3>{escape(told.label)}</h3>{table(['run file', source(told.run)], terms, 'words')}"
        f"{table(['file that was read', 'SHA-256'], files, 'words') if files else ''}<h4>Resolved scene</h4><pre>{scene}</pre>"
    )
