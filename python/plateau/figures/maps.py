"""Maps of disc and pin, in true proportions: their widths give their heights and that of a page, so pages are laid out here, in mm."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import zip_longest
from typing import Any

import numpy as np
import pandas
import xarray

from plateau.figures.drawing import Drawing, Subject, moment
from plateau.quantities import MAPS, STATUSES, Map
from plateau.run_file import array
from plateau.style import APART, GROUND, MM, NARROW, STATUS_COLOURS, WIDE, labelled, wrapped

# Debris thinner than THIN, m, is drawn as this status with this colour, and is none below LEAST.
THIN, FILM, FILM_COLOUR, LEAST = 0.1e-6, 3, "#f7d48f", 1e-15
# Part of the values, or of the load, beyond an end of the colours; pressures that differ by a larger factor have a logarithmic scale.
BEYOND, MOST_LINEAR = 0.005, 100.0
# Why cells are apart, of which the value is zero; more columns and rows than this are more than the points of a page.
ZERO = {"pin/pressure": "no contact", "disc/thickness": "none", "pin/thickness": "none"}
MOST_CELLS = {"disc_angle": 6000, "pin_angle": 2000, "radius": 1000}
# In mm: the highest page; room left of a map, right of maps with and without a colour bar, below a map for numbers; a line, a letter.
PAGE, LEFT, BAR, EDGE, NUMBERS, LINE, LETTER = 240.0, 14.0, 22.0, 3.0, 4.4, 3.6, 1.45
# In mm: highest map, and lowest one without stretching; longest and shortest colour bar; about the narrowest column of a page.
HIGHEST, LOWEST, LONGEST, SHORTEST, COLUMN = 85.0, 5.0, 60.0, 25.0, 52.0
# How maps are laid out: what the axis below is called; letters of that without places.
UNROLLED, SHORT = "arc length at the mean radius, mm; the disc moves →", 32
ARCS, POLAR = "arc length from the middle, mm; the disc moves →", "x, mm; the disc turns counter-clockwise"
# Figures: their maps and captions.
PRESSURE = "Contact pressure on the pin. The colours end at the pressure above which 0.5 % of the load is carried. "
PRESSURE += "They begin at zero, or on a logarithmic scale at that below which 0.5 % is carried."
HOT = "Temperature of the cells of the pin. The colours span 99 % of all cells. Pressures count as constant during a pass, and there is no "
HOT += "conduction along the surface: on rough discs the hottest cells may be too cold by half of their rise, or more."
TOPOGRAPHY = "Heights, positive toward the other body; those of the pin from its mean. The colours span 99 % of all heights of a body."
STATUS = "Status of the cells, with parts of the area. Thick build-up is debris of at least 0.1 µm; where it is thinner, it is paler."
BUILD_UP = "Thickness of the debris. The colours end at what 99.5 % of the covered cells of a body do not exceed; means are over all."
FIGURES = {
    "topography": (("disc/height", "pin/height"), TOPOGRAPHY),
    "status": (("disc/status", "pin/status"), STATUS),
    "build-up": (("disc/thickness", "pin/thickness"), BUILD_UP),
    "pressure": (("pin/pressure",), PRESSURE),
    "contact-temperature": (("pin/temperature",), HOT),
}
Legend = Sequence[tuple[str, str]]
LEGEND = [*zip(STATUS_COLOURS, map(": ".join, STATUSES), strict=False), (FILM_COLOUR, "the same, thinner than 0.1 µm")]


@dataclass
class Picture:
    """A map as it is drawn: in the unit that is shown, row by row from the inside, NaN where there is no cell; edges of cells, rad and mm;
    colours, which maps share, and the label of their bar; statuses have a legend."""

    values: Any
    angles: Any
    radii: Any
    form: str
    title: str = ""
    colours: dict[str, Any] = field(default_factory=dict)
    label: str = ""

    def corners(self) -> tuple[Any, Any]:
        """Corners of the cells, mm, of a map that is not unrolled."""
        angles, radii = np.meshgrid(self.angles, self.radii)
        return (radii * np.cos(angles), radii * np.sin(angles)) if self.form is POLAR else ((angles - np.mean(self.angles)) * radii, radii)

    @property
    def span(self) -> tuple[float, float]:
        """Width and height, mm."""
        x, y = self.corners() if self.form is POLAR else (self.angles * self.radii.mean(), self.radii)
        return float(np.ptp(x)), float(np.ptp(y))

    def fitted(self, room: float, least: float) -> tuple[int, float, float, float]:
        """Number of windows that are about `least` high, mm, their width and height, mm, and how many times the radius is stretched."""
        wide, high = self.span
        count = min(max(math.ceil(least * wide / (room * high)), 1), 6, self.values.shape[1]) if self.form is UNROLLED else 1
        width = min(room, HIGHEST * wide / (high * count))
        stretch = float(f"{max(LOWEST * wide / (count * width * high), 1.0):.2g}")
        return count, width, count * width * high / wide * stretch, stretch

    def below(self, letters: int, stretch: float) -> str:
        """Words below a map, in lines of about so many letters; maps of a figure have the same words."""
        words = self.form if letters >= len(UNROLLED) else self.form.replace(" at the mean radius", "").replace(" from the middle", "")
        words = words if letters >= SHORT else wrapped(words.replace("; ", "\n"), letters)
        return words + (f"\nradius stretched {stretch:g}×" if stretch > 1 else "")


def picture_of(cells: xarray.DataArray, is_polar: bool, title: str = "") -> Picture:
    """A map, row by row, as it is drawn; of very many cells those in the middle of each point."""
    places, edges = [], []
    for name, per_unit in (("radius", 1e3), (str(cells.dims[1]), 1.0)):
        centres = np.asarray(cells[name].values, float) * per_unit
        # Of a single cell the width is not known.
        half = (centres[1] - centres[0]) / 2 if len(centres) > 1 else abs(centres[0]) / 200
        count = min(len(centres), MOST_CELLS[name])
        places.append(((np.arange(count) + 0.5) * len(centres) / count).astype(int))
        edges.append(np.linspace(centres[0] - half, centres[-1] + half, count + 1))
    values = cells.values[np.ix_(*places)]
    # Only a round pin has no cells at its corners.
    is_round = cells.dims[1] == "pin_angle" and np.isnan(values[0, 0]) and np.isfinite(values).any()
    return Picture(values, edges[1], edges[0], POLAR if is_polar else ARCS if is_round else UNROLLED, title)


def colour(shown: Map, pictures: Sequence[Picture], cmap: str) -> None:
    """Gives maps common colours, for which each counts as much as the others; `FIGURES` tells their ends: few cells do not decide."""
    import matplotlib
    from matplotlib.colors import ListedColormap, LogNorm, Normalize

    # What is apart is not grey among greys.
    apart, name = ("#bfdcf2", "blue") if cmap == "greys" else (APART, "grey")
    is_pressure, is_span, norm, label = shown.path == "pin/pressure", shown.colours == "span", Normalize(-0.5, FILM + 0.5), ""
    colours: Any = ListedColormap([*STATUS_COLOURS[:FILM], FILM_COLOUR]).with_extremes(bad=GROUND)
    if shown.colours != "statuses":
        shares = [pandas.Series(dtype=float)]
        for picture in pictures:
            values, areas = picture.values, picture.radii[1:, None] + picture.radii[:-1, None]
            counted = np.isfinite(values) if is_span else values > 0
            weights = (values * areas if is_pressure else np.ones_like(values))[counted]
            shares.append(pandas.Series(weights / weights.sum(), values[counted]))
        below = pandas.concat(shares).sort_index().cumsum()
        low, high = below.index[below.searchsorted(np.array([BEYOND, 1 - BEYOND]) * below.iloc[-1])] if below.size else (0.0, 1.0)
        # What rounding makes of equal values is no range; else zero is below the colours.
        around = 0.01 if high - low <= 1e-9 * max(abs(low), abs(high)) else 0.0
        is_wide = is_pressure and high > MOST_LINEAR * low > 0
        norm = Normalize(low - around, high + around) if is_span else LogNorm(low, high) if is_wide else Normalize(1e-12 * high, high)
        colours = matplotlib.colormaps["Greys_r" if cmap == "greys" else cmap].with_extremes(under=None if is_span else apart, bad=GROUND)
        colours.colorbar_extend = "both" if is_span else "max"
        label = labelled(shown.what, shown.unit.symbol) + ("" if is_span else f"\n{name}: {ZERO[shown.path]}")
    for picture in pictures:
        picture.colours, picture.label = {"cmap": colours, "norm": norm}, label


def draw_map(panels: Sequence[Any], picture: Picture, size: tuple[float, float], letters: int, stretch: float) -> Any:
    """Draws one map into axes of this size, mm, for an unrolled ring several below each other; gives what a colour bar belongs to."""
    from matplotlib.colors import LogNorm
    from matplotlib.ticker import MaxNLocator

    values, radii, colours = picture.values, picture.radii, picture.colours
    if isinstance(colours["norm"], LogNorm):
        # Zero has no logarithm, and what is low has the lowest colour.
        low: Any = colours["norm"].vmin
        values = np.where(values > 0, np.maximum(values, low), np.where(values == 0, 1e-3 * low, values))
    ends = np.linspace(0, values.shape[1], len(panels) + 1).astype(int)
    for panel, begin, end in zip(panels, ends[:-1], ends[1:], strict=True):
        if picture.form is UNROLLED:
            extent = (*picture.angles[[begin, end]] * radii.mean(), radii[0], radii[-1])
            drawn = panel.imshow(values[:, begin:end], extent=extent, origin="lower", aspect=stretch, interpolation="nearest", **colours)
        else:
            drawn = panel.pcolormesh(*picture.corners(), values, rasterized=True, **colours)
            panel.set_aspect("equal")
        if picture.form is ARCS:
            panel.set(xlim=np.array([-0.5, 0.5]) * picture.span[0], ylim=radii[[0, -1]])
        panel.spines[:].set_visible(True)
        panel.yaxis.set_major_locator(MaxNLocator(max(min(int(size[1] / LINE / 1.4), 5), 1), steps=[1, 2, 5, 10]))
        if size[1] < 2.5 * LINE:
            panel.set_yticks(panel.get_ylim(), labels=[f"{radius:.4g}" for radius in panel.get_ylim()])
    panels[0].set_title(wrapped(picture.title, int(size[0] / LETTER)), pad=3)
    panels[-1].set_xlabel(picture.below(letters, stretch))
    # In the middle of all.
    middle = 0.5 if len(panels) % 2 else 1 + NUMBERS / (2 * size[1])
    panels[len(panels) // 2].set_ylabel("y, mm" if picture.form is POLAR else "radius, mm", y=middle)
    return drawn


def _legend(onto: Any, legend: Legend, **options: Any) -> None:
    """Says what colours mean."""
    from matplotlib.patches import Patch

    keys = [Patch(facecolor=colour, edgecolor="0.5", linewidth=0.3, label=text) for colour, text in legend]
    onto.legend(handles=keys, loc="upper left", handlelength=1.2, labelspacing=0.3, **options)


def pages(rows: Sequence[Sequence[Picture | None]], width: float, caption: str, legend: Legend, figure_of: Callable[..., Any]) -> list[Any]:
    """Lays out rows of maps in equal columns on pages of this width, mm."""
    room, columns = width - (EDGE if legend else BAR), 1 if width < 0.8 * WIDE else 2
    letters = int((room / max(map(len, rows)) - LEFT) / LETTER)
    # By the identity of their colours: the label of a bar, what it belongs to, and where that begins, ends and stands.
    figures, bars = list[Any](), dict[int, tuple[str, Any, float, float, float]]()

    def add(left: float, top: float, wide: float, high: float) -> Any:
        return figures[-1].add_axes((left / width, 1 - (top + high) / PAGE, wide / width, high / PAGE))

    def finish(end: float) -> None:
        for label, drawn, top, bottom, right in bars.values():
            high = max(min(bottom - top, LONGEST), SHORTEST)
            bar, end = add(right + 2.5, top, 3.0, high), max(end, top + high + 2.0)
            figures[-1].colorbar(drawn, cax=bar, label=wrapped(label, int(high / LETTER)))
        for axes in figures[-1].axes:
            box = axes.get_position(original=True)
            axes.set_position((box.x0, 1 - (1 - box.y0) * PAGE / end, box.width, box.height * PAGE / end))
        figures[-1].set_size_inches(width * MM, end * MM)
        bars.clear()

    top = PAGE
    for pictures in rows:
        each, least = room / len(pictures), (0.06 if len(pictures) == 1 else 0.04) * width
        fits = [(one, each * column + LEFT, *one.fitted(each - LEFT, least)) for column, one in enumerate(pictures) if one]
        above = LINE * max(wrapped(one.title, int(wide / LETTER)).count("\n") + 1 for one, _, _, wide, *_ in fits) + 1.5
        maps = max(count * high + (count - 1) * (NUMBERS + 1) for *_, count, _, high, _ in fits)
        below = LINE * max(one.below(letters, stretch).count("\n") + 1 for one, *_, stretch in fits) + NUMBERS + 2.0
        if top + above + maps + below > PAGE:
            if figures:
                finish(top)
            figures.append(figure_of(figsize=(width * MM, PAGE * MM), label=caption))
            top = 1.0
            if legend:
                _legend(figures[-1], legend, ncols=columns, borderaxespad=0.2)
                top += LINE * math.ceil(len(legend) / columns) + 1.0
        top += above
        for one, left, count, wide, high, stretch in fits:
            panels = [add(left, top + number * (high + NUMBERS + 1), wide, high) for number in range(count)]
            drawn = draw_map(panels, one, (wide, high), letters, stretch)
            if not legend:
                _, _, begin, _, right = bars.get(id(drawn.norm), (None, None, top, 0.0, 0.0))
                bars[id(drawn.norm)] = one.label, drawn, begin, top + maps, max(right, left + wide)
        top += maps + below
    finish(top)
    return figures


def in_axes(ax: Any, picture: Picture, legend: Legend) -> None:
    """Draws a map into axes that were given, a ring in one window."""
    box, (along, across) = ax.get_position(original=True), picture.span
    wide, high = (float(size) for size in (box.width, box.height) * ax.figure.get_size_inches() / MM)
    true = wide * across / along
    stretch = max(float(f"{high / true:.2g}"), 1.0) if picture.form is UNROLLED and true < LOWEST else 1.0
    drawn = draw_map([ax], picture, (wide, min(true * stretch, high)), int(wide / LETTER), stretch)
    if legend:
        _legend(ax, legend, bbox_to_anchor=(1.02, 1), borderaxespad=0)
    else:
        ax.figure.colorbar(drawn, ax=ax, label=picture.label)


def _read(subject: Subject, path: str, index: int) -> xarray.DataArray:
    """A map of a run at a moment, row by row, SI."""
    body, name = path.split("/")
    if name != "thickness":
        return array(subject.run, path).isel(map_time=index).transpose("radius", ...).load()
    thickness = MAPS[f"{body}/height"].sign * (_read(subject, f"{body}/height", index) - _read(subject, f"{body}/substrate", index))
    return thickness.where(~(thickness < LEAST), 0.0)


def _moments(drawing: Drawing, subject: Subject, shown: Map) -> Sequence[int]:
    """The moments of a run that are shown: of a map of the contact, unless told, the first and the last that have one."""
    if shown.path not in ("pin/pressure", "pin/temperature"):
        return subject.moments[-1:] if shown.what == "thickness" and not subject.is_chosen else subject.moments
    order = subject.moments if subject.is_chosen else np.flatnonzero(subject.map_time > 0).tolist()
    touching = [index for index in order if _read(subject, shown.path, index).max() > 0]
    if not touching:
        drawing.leave_out(subject, f"no map {shown.what} with a contact {'then' if subject.is_chosen else 'after the start'}")
    return touching if subject.is_chosen else sorted({*touching[:1], *touching[-1:]})


def _said(subject: Subject, shown: Map, index: int, recorded: xarray.DataArray, cells: xarray.DataArray) -> str:
    """Text above a map, which is given as recorded and as shown; thin films get a status of their own in the latter."""
    values, unit = cells.values, shown.unit.symbol

    def percent(of: xarray.DataArray) -> str:
        """The part of the area; rows farther out have larger cells."""
        part = float(of.where(cells.notnull()).weighted(cells["radius"]).mean())
        return f"{0.0 if part < 5e-5 else 100 * part:.3g}\u00a0%"

    if shown.colours == "statuses":
        text = f": none {percent(cells == 0)}, primary {percent(cells == 1)}, secondary {percent(cells == 2)}"
        if subject.has(f"{shown.body}/height", f"{shown.body}/substrate"):
            values[(values == 2) & (_read(subject, f"{shown.body}/thickness", index).values < THIN)] = FILM
            text += f"; thick build-up {percent(cells == 2)}"
        return text
    if shown.what == "thickness":
        mean = float(cells.weighted(cells["radius"]).mean())
        return f": on {percent(cells > 0)} of the area, mean over all of it {mean:.3g}\u00a0{unit}"
    if shown.about_mean:
        return f"; from the mean, z\u00a0=\u00a0{shown.unit.value(np.nanmean(recorded.values)):.4g}\u00a0{unit}"
    return "" if shown.body == "disc" else f"; at most {np.nanmax(values):.3g}\u00a0{unit}"


def draw_maps(drawing: Drawing, _: Sequence[Subject], paths: Sequence[str], caption: str) -> list[Any]:
    """Pages of maps with their common scales: those of several runs in columns, of a single run moments beside each other."""
    from matplotlib.figure import Figure

    found: dict[tuple[str, int], list[Picture]] = {}
    for path in paths:
        shown, pictures = MAPS[path], list[Picture]()
        needed = [f"{shown.body}/{name}" for name in ("height", "substrate")] if shown.what == "thickness" else [path]
        # Temperatures of cells are recorded on request.
        for subject in drawing.having(*needed, is_part=path == "pin/temperature"):
            for index in _moments(drawing, subject, shown):
                recorded = _read(subject, path, index)
                cells = recorded.copy(data=shown.shown(recorded.values))
                run, when = "" if drawing.only else f"{subject.label}\n", moment(subject.map_time[index]).replace(" ", "\u00a0")
                title = f"{run}{shown.body.capitalize()}, {when}{_said(subject, shown, index, recorded, cells)}"
                pictures.append(picture_of(cells, drawing.polar and shown.body == "disc", title))
                found.setdefault((path, subject.number), []).append(pictures[-1])
        colour(shown, pictures, drawing.cmap)
    legend = LEGEND if "disc/status" in paths else ()
    if found and drawing.ax is not None:
        figure, _ = drawing.panels(sum(map(len, found.values())), NARROW, caption)
        in_axes(drawing.ax, next(iter(found.values()))[0], legend)
        return [figure]
    numbers = sorted({number for _, number in found})
    is_ring = paths[0].startswith("disc") and not drawing.polar
    width = drawing.width or (WIDE if is_ring or len(numbers) > 1 or any(len(own) > 1 for own in found.values()) else NARROW)
    # Columns are runs, or moments of a single run, so many that rows are about equally long.
    count = len(numbers) if len(numbers) > 1 else max(map(len, found.values()), default=1)
    rows, across = list[Sequence[Picture | None]](), math.ceil(count / math.ceil(count / max(int(width / COLUMN), 1)))
    for begin in range(0, len(numbers), across):
        for path in paths:
            columns = [found.get((path, number), []) for number in numbers[begin : begin + across]]
            if len(numbers) == 1:
                # But those of an unrolled ring below each other.
                side = 1 if is_ring and path.startswith("disc") else across
                columns = [columns[0][first::side] for first in range(side)]
            rows += zip_longest(*columns, *[[]] * (across - len(columns) if len(numbers) > 1 else 0))
    return pages(rows, width, caption, legend, Figure) if rows else []
