"""What the figures of runs have in common: the runs with their names and lines, the moments that are shown, what is left out."""

import os
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray

from plateau.errors import InputError, PlateauNote
from plateau.quantities import MAP_KEYS, Series, series_of
from plateau.run_file import array, source
from plateau.style import DASHES, LINES, NARROW, WIDE, new, plain
from plateau.units import Unit, unit_of

# More runs make no legible figure, and have no colours of their own.
MOST_RUNS = len(LINES)
# Of several runs each has its own, at other places of its line, so that equal lines are all seen.
MARKERS = "osD^v<>P"
# Height of a figure, mm, at most: that of a page.
HIGHEST = 235.0
# What the shades of events are called.
EVENTS = "events of the cycle"


@dataclass(frozen=True, eq=False)
class Subject:
    """A run with what it is called, and how its lines are drawn."""

    run: xarray.DataTree
    label: str
    colour: str
    dashes: Any
    # Its place among the runs if there are several, which marks its lines.
    number: int | None
    # Indices of the maps that are shown, in their order: the first and the last, or those that were asked for.
    moments: tuple[int, ...]
    # Whether they were asked for.
    is_chosen: bool = False

    @property
    def line(self) -> dict[str, Any]:
        """Options of its lines."""
        # In a cycle, marks would look like data.
        if self.number is None or self.has_cycle:
            return {"color": self.colour, "linestyle": self.dashes}
        marks = {"marker": MARKERS[self.number], "markevery": (0.04 + 0.035 * self.number, 0.3), "markersize": 3}
        return {"color": self.colour, "linestyle": self.dashes, **marks}

    @property
    def time(self) -> Any:
        """Times of the samples, s."""
        return np.asarray(array(self.run, "time").values)

    @property
    def map_time(self) -> Any:
        """Times of the maps, s."""
        return np.asarray(array(self.run, "map_time").values) if "map_time" in self.run.variables else np.array([])

    def has(self, name: str) -> bool:
        """Whether the run has a variable of this path, such as ``"series/contact_area"``."""
        group, _, own = name.rpartition("/")
        return group in self.run.children and own in self.run[group].data_vars

    def values(self, name: str) -> Any:
        """Values of a series, SI."""
        return np.asarray(array(self.run, f"series/{name}").values, float)

    def series(self, name: str) -> Series:
        """How a series is shown."""
        values = array(self.run, f"series/{name}")
        return series_of(name, str(values.attrs.get("units", "1")), values.values)

    @property
    def has_cycle(self) -> bool:
        """Whether load or speed change."""
        return self.has("series/normal_force") or self.has("series/rotational_speed")

    def while_rubbing(self, values: Any) -> Any:
        """Values of a contact, NaN while the pin is lifted or the disc stands still, because revolution means are then older."""
        for name in ("normal_force", "rotational_speed"):
            if self.has(f"series/{name}"):
                values = np.where(self.values(name) != 0, values, np.nan)
        return values

    def moment(self, index: int) -> str:
        """The time of a map, in words."""
        return moment(float(self.map_time[index]))


def moment(seconds: float) -> str:
    """A time, s, in words."""
    unit = unit_of("s", seconds) if seconds > 0 else Unit("s", 1.0)
    return f"{unit.value(seconds):.4g} {unit.symbol}"


@dataclass
class Drawing:
    """The runs of a call, how their figures are to look, and what is left out."""

    subjects: list[Subject]
    # Width, mm, if it is not the usual one; colours of ranges; the ring as a ring instead of unrolled; axes to draw in.
    width: float | None = None
    cmap: str = "viridis"
    polar: bool = False
    ax: Any = None
    # The figure that is drawn, and by run and what it does not have the figures that do without it.
    name: str = ""
    left_out: dict[tuple[str, str], list[str]] = field(default_factory=dict)

    def leave_out(self, subject: Subject, missing: str) -> None:
        """Notes what a run does not have of the figure that is drawn."""
        figures = self.left_out.setdefault((source(subject.run), missing), [])
        if self.name not in figures:
            figures.append(self.name)

    def say_left_out(self) -> None:
        """Warns of what was left out."""
        for (path, missing), figures in self.left_out.items():
            warnings.warn(f"{path} has {missing}: left out of {', '.join(figures)}", PlateauNote, stacklevel=4)

    def with_series(self, *names: str) -> list[Subject]:
        """The runs that have all these series and a sample; of the others it is noted that they are left out."""
        having = []
        for subject in self.subjects:
            missing = next((name for name in names if not subject.has(f"series/{name}")), None)
            if missing is not None:
                self.leave_out(subject, f"no series {missing}")
            elif not subject.time.size:
                self.leave_out(subject, "no samples")
            else:
                having.append(subject)
        return having

    def with_part(self, *names: str) -> list[Subject]:
        """The same of a part that scenes do without, such as friction: where no run has it, there is nothing to note."""
        is_there = any(all(subject.has(f"series/{name}") for name in names) for subject in self.subjects)
        return self.with_series(*names) if is_there else []

    def with_maps(self, *names: str) -> list[Subject]:
        """The runs that have all these maps (such as ``"disc/height"``) at a moment; of the others it is noted that they are left out."""
        having = []
        for subject in self.subjects:
            missing = next((name for name in names if not subject.has(name)), None)
            if missing is not None:
                self.leave_out(subject, f"no map {MAP_KEYS.get(missing, missing.replace('/', '_'))}")
            elif not subject.moments:
                self.leave_out(subject, "no maps yet")
            else:
                having.append(subject)
        return having

    def new(
        self, usual: float, height: float, caption: str, rows: int = 1, columns: int = 1, note: str = "", **options: Any
    ) -> tuple[Any, Any]:
        """Makes a figure and its axes, an array of two dimensions: of the usual width, mm, or of that which was asked for, but no
        narrower than two thirds of the usual one. Where axes are given, they are taken for a figure of one panel.

        Raises
        ------
        InputError
            If axes are given, and the figure has several panels.
        """
        if self.ax is not None:
            if rows * columns > 1:
                raise InputError(f"the figure {self.name} has {rows * columns} panels: leave ax out")
            return self.ax.figure, np.array([[self.ax]])
        width = usual if self.width is None else max(self.width, usual / 1.5)
        return new(width, height, caption, rows, columns, note, **options)

    def grid(self, panels: int, height: float, caption: str, note: str = "", columns: int = 2, **options: Any) -> tuple[Any, Any]:
        """A figure with so many panels of this height, mm, in so many columns if it is wide enough, and the list of its axes."""
        columns = 1 if (self.width or WIDE) < WIDE / 1.5 else min(panels, columns)
        rows = -(-panels // columns)
        figure, axes = self.new(WIDE if columns > 1 else NARROW, min(height * rows + 14, HIGHEST), caption, rows, columns, note, **options)
        for axis in axes.flat[panels:]:
            axis.remove()
        return figure, list(axes.flat[:panels])

    @property
    def only(self) -> Subject | None:
        """The run if it is the only one: it needs no colour of its own."""
        return self.subjects[0] if len(self.subjects) == 1 else None

    def legend(self, figure: Any, axis: Any, **options: Any) -> None:
        """Puts the legend of axes above the whole figure, with the name of the only run, or into axes that were given."""
        handles, labels = axis.get_legend_handles_labels()
        if self.ax is not None:
            self.ax.legend(handles, labels)
        elif handles:
            # Shades come before lines; they are less important.
            order = sorted(range(len(labels)), key=lambda index: (labels[index] == EVENTS) != options.get("reverse", False))
            # As many columns as the longest label leaves.
            columns = 1 if figure.get_figwidth() * 25.4 < 2 * (12 + 1.5 * max(map(len, labels))) else 2
            title = {"title": self.only.label, "alignment": "left"} if self.only and self.only.label not in labels else {}
            figure.legend(
                [handles[index] for index in order],
                [labels[index] for index in order],
                **{"loc": "outside upper left", "ncols": columns, "columnspacing": 1.0, **title, **options},
            )


def subjects_of(runs: Sequence[xarray.DataTree], at: Sequence[float] = ()) -> list[Subject]:
    """Runs as they are drawn.

    Parameters
    ----------
    runs : sequence of xarray.DataTree
        Opened runs, at most `MOST_RUNS`.
    at : sequence of float, optional
        Times, s; the maps that were recorded nearest to them are shown, instead of the first and the last.

    Returns
    -------
    list of Subject
    """
    if not 0 < len(runs) <= MOST_RUNS:
        raise InputError(f"{len(runs)} runs, expected 1 to {MOST_RUNS}: more cannot be told apart")
    subjects = []
    for number, (run, label) in enumerate(zip(runs, labels_of(runs), strict=True)):
        times = np.asarray(run["map_time"].values) if "map_time" in run.variables else np.array([])
        chosen = {int(np.argmin(np.abs(times - time))) for time in at} if times.size else set()
        moments = sorted(chosen) if chosen else sorted({0, len(times) - 1}) if times.size else []
        own = number if len(runs) > 1 else None
        subjects.append(Subject(run, plain(label), LINES[number], DASHES[number], own, tuple(moments), bool(chosen)))
    return subjects


def labels_of(runs: Sequence[xarray.DataTree]) -> list[str]:
    """The title of every run's scene; where titles are equal with the name of the file behind it, where these are, too, with its path."""
    candidates = []
    for run in runs:
        title = " ".join(str(run.attrs.get("title", "")).split())
        path = os.path.splitext(str(run.encoding.get("source") or ""))[0]
        name = os.path.basename(path)
        candidates.append([title, f"{title} ({name})", f"{title} ({path})"] if title else [name, name, path])

    def is_only(label: str) -> bool:
        return sum(label in others for others in candidates) == 1

    return [next((label for label in own if is_only(label)), own[-1]) for own in candidates]
