"""Common parts of the figures of runs: the runs with their names and lines, the moments that are shown, what is left out."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray

from plateau.errors import InputError
from plateau.opened_runs import labels_of
from plateau.quantities import MAP_KEYS
from plateau.run_file import array, source
from plateau.style import MARKERS, MM, NARROW, WIDE, look, new, noted, plain
from plateau.units import Unit, unit_of

# Height of a figure, mm, at most: that of a page; that of a line of a legend, and lines for which there is room.
HIGHEST, LINE, MOST_LINES = 235.0, 3.6, 3


class Subject:
    """A run: its label, its place among the runs, whether it has a cycle, times of samples and of maps, s, and which maps are shown."""

    def __init__(self, run: xarray.DataTree, label: str, number: int, is_only: bool, at: Sequence[float]) -> None:
        self.run, self.label, self.number, self.is_only, self.is_chosen = run, plain(label), number, is_only, bool(at)
        # True if load and speed change; times of the samples, s.
        self.has_cycle, self.time = self.has("series/normal_force"), np.asarray(array(run, "time").values)
        self.map_time = times = np.asarray(run["map_time"].values) if "map_time" in run.variables else np.array([])
        self.moments = sorted({int(np.argmin(np.abs(times - time))) for time in at} or {0, len(times) - 1}) if times.size else []

    @property
    def scene_without_seeds(self) -> str:
        """The scene without its seeds and its output, in words that are equal where these scenes are."""
        return re.sub(r"'seed': \d+", "", str(self.run.plateau.scene | {"output": 0}))

    def has(self, *paths: str) -> bool:
        """Tells whether the run has all these variables, such as ``"series/contact_area"``."""
        names = (path.split("/") for path in paths)
        return all(group in self.run.children and name in self.run[group].data_vars for group, name in names)

    def values(self, name: str) -> Any:
        """Values of a series, SI."""
        return np.asarray(array(self.run, f"series/{name}").values, float)

    @property
    def line(self) -> dict[str, Any]:
        """Options of its lines: each run has its own marks, at other places of its line, so that equal lines are all seen."""
        # In a cycle, marks would look like data.
        if self.is_only or self.has_cycle:
            return look(self.number)
        mark = MARKERS[(self.number + self.number // len(MARKERS)) % len(MARKERS)]
        return look(self.number) | {"marker": mark, "markevery": (0.04 + 0.025 * self.number, 0.3), "markersize": 3}

    def while_rubbing(self, values: Any) -> Any:
        """Values of a contact, NaN while the pin is lifted or the disc stands still, because revolution means are then older."""
        rubs = not self.has_cycle or (self.values("normal_force") != 0) & (self.values("rotational_speed") != 0)
        return np.where(rubs, values, np.nan)


def moment(seconds: float) -> str:
    """A time, s, in words."""
    unit = unit_of("s", seconds) if seconds > 0 else Unit("s", 1.0)
    return f"{unit.value(seconds):.4g} {unit.symbol}"


@dataclass
class Drawing:
    """The runs of a call; width, mm, if not the usual one, colours and axes of their figures; what is left out."""

    subjects: list[Subject]
    width: float | None = None
    cmap: str = "viridis"
    polar: bool = False
    ax: Any = None
    # The figure that is drawn; by run and what it does not have the figures that do without it, as keys.
    name: str = ""
    left_out: dict[tuple[str, str], dict[str, None]] = field(default_factory=dict)

    @property
    def only(self) -> Subject | None:
        """The run if it is the only one: it needs no colour of its own."""
        return self.subjects[0] if len(self.subjects) == 1 else None

    def columns(self, most: int) -> int:
        """Panels beside each other for which there is room, of so many at most."""
        return most if (self.width or WIDE) >= WIDE / 1.5 else 1

    def having(self, *paths: str, is_part: bool = False) -> list[Subject]:
        """The runs that have these series or maps, and one of them; others are noted, but for a part, such as friction, that no run has."""
        if is_part and not any(subject.has(*paths) for subject in self.subjects):
            return []
        found, is_series = [], paths[0].startswith("series/")
        for subject in self.subjects:
            if missing := next((path.removeprefix("series/") for path in paths if not subject.has(path)), ""):
                self.leave_out(subject, f"no {'series' if is_series else 'map'} {MAP_KEYS.get(missing, missing.replace('/', '_'))}")
            elif not (subject.time.size if is_series else subject.moments):
                self.leave_out(subject, "no samples" if is_series else "no maps yet")
            else:
                found.append(subject)
        return found

    def look(self, subject: Subject, place: int, name: str) -> dict[str, Any]:
        """Options of a line among those of a run: of a single run each has its name and colour, of several all but the first are paler."""
        if self.only:
            return look(place) | {"label": name}
        return subject.line | ({"alpha": 0.4, "marker": None, "label": None} if place else {"label": subject.label})

    def leave_out(self, subject: Subject, missing: str) -> None:
        """Notes what a run does not have of the figure that is drawn."""
        self.left_out.setdefault((source(subject.run), missing), {})[self.name] = None

    def panels(self, count: int, height: float, caption: str, columns: int = 2, usual: float | None = None, **options: Any) -> tuple[Any, Any]:
        """Makes a figure, at least two thirds as wide as usual, mm, with panels of this height in so many columns at most; gives their axes."""
        if self.ax is not None:
            if count > 1:
                raise InputError(f"the figure {self.name} has {count} panels: leave ax out")
            return self.ax.figure, [self.ax]
        columns = min(count, self.columns(columns))
        rows, usual = -(-count // columns), usual or (WIDE if columns > 1 else NARROW)
        width = usual if self.width is None else max(self.width, usual / 1.5)
        figure, axes = new(width, min(height * rows + 14, HIGHEST), caption, rows, columns, **options)
        for axis in axes.flat[count:]:
            axis.remove()
        return figure, list(axes.flat[:count])

    def explained(self, figure: Any, axis: Any, note: str = "", **options: Any) -> list[Any]:
        """A figure as the only page, with the legend of axes, above it but in axes that were given, and a note below."""
        handles, labels = axis.get_legend_handles_labels()
        if self.ax is not None:
            self.ax.legend(handles, labels)
            return [figure]
        noted(figure, note)
        if handles:
            # As many columns as the longest label leaves; a long legend takes no room from the axes.
            columns = 1 if figure.get_figwidth() / MM < 2 * (12 + 1.5 * max(map(len, labels))) else 2
            more = LINE * max(math.ceil(len(labels) / columns) - MOST_LINES, 0)
            figure.set_figheight(min(figure.get_figheight() + more * MM, HIGHEST * MM))
            named = {"title": self.only.label, "alignment": "left"} if self.only and self.only.label not in labels else {}
            figure.legend(handles, labels, loc="outside upper left", ncols=columns, columnspacing=1.0, **named, **options)
        return [figure]


def subjects_of(runs: Sequence[xarray.DataTree], at: Sequence[float] = ()) -> list[Subject]:
    """Opened runs as they are drawn, with the maps that were recorded nearest to times, s, or with the first and the last."""
    return [Subject(run, label, number, len(runs) == 1, at) for number, (run, label) in enumerate(zip(runs, labels_of(runs), strict=True))]
