"""Distributions of the sizes of contact spots and plateaus, and of heights, at the first and the last map."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from plateau.figures.drawing import Drawing, Subject, moment
from plateau.quantities import MAPS
from plateau.run_file import array
from plateau.units import unit_of

SECONDARY = 2
KINDS = {"pin/pressure": "contact spots of the pin", "pin/status": "secondary plateaus of the pin", "disc/status": "secondary plateaus of the disc"}
# Classes of heights; a distribution is on a logarithmic scale if a class has more than so many times the mean of the others.
CLASSES, MOST_LINEAR = 80, 6.0
# Parts of the heights beyond the axis, on either side; parts that points of the Abbott-Firestone curve are apart.
BEYOND, APART = 0.001, 0.005
# Which map a line is of, its time, options of the line, and values in ascending order.
Found = list[tuple[str, str, dict[str, Any], Any]]
LAST, FIRST = "Last map", "paler: first map"


def _found(drawing: Drawing, path: str, values: Callable[..., Any]) -> Found:
    """Lines of what a function gives of run, path and cells of a map, those of a column in a row, for the runs that have it."""
    found = []
    for subject in drawing.having(path):
        for place, index in enumerate(subject.moments, 1 - len(subject.moments)):
            time, cells = moment(subject.map_time[index]), array(subject.run, path).isel(map_time=index).transpose(..., "radius")
            found.append((FIRST if place else LAST, time, drawing.look(subject, -place, time), values(subject, path, cells.values)))
    return found


def _explained(drawing: Drawing, figure: Any, axis: Any, found: Found) -> list[Any]:
    """A figure with its legend, and with what the lines of several runs are of."""
    times = {name: {time for one, time, *_ in found if one == name} for name in (LAST, FIRST)}
    said = "; ".join(f"{name}, {', '.join(own)}" if len(own) == 1 else name for name, own in times.items() if own)
    return drawing.explained(figure, axis, "" if drawing.only else said)


def areas_of(belongs: Any, radii: Any, angle: float, is_ring: bool) -> Any:
    """Areas, m², of groups of cells that share edges, the least first. Columns are `angle` wide, rad; those of a ring close round it."""
    from scipy.ndimage import label

    labels, count = label(belongs)
    cells = np.broadcast_to(radii * (radii[1] - radii[0] if len(radii) > 1 else radii[0] / 100) * angle, belongs.shape)
    areas, group = np.bincount(labels.ravel(), cells.ravel(), count + 1), np.arange(count + 1)
    for first, last in zip(labels[0], labels[-1], strict=True) if is_ring else ():
        if first and last:
            group[group == group[last]] = group[first]
    areas = np.bincount(group, areas)[1:]
    return np.sort(areas[areas > 0])


def plateau_sizes(drawing: Drawing, subjects: list[Subject]) -> list[Any]:
    """Number of contact spots, and of secondary plateaus, that are at least as large as an area, at the first and the last map."""

    def areas(subject: Subject, path: str, cells: Any) -> Any:
        # The columns of the pin are those of the disc.
        radii, angle = array(subject.run, "radius").values, math.tau / subject.run.sizes["disc_angle"]
        return areas_of(cells == SECONDARY if "status" in path else cells > 0, radii, angle, path.startswith("disc"))

    kinds = {title: found for path, title in KINDS.items() if (found := _found(drawing, path, areas))}
    every = [one for found in kinds.values() for one in found if one[-1].size]
    if not every:
        for subject in subjects if kinds else []:
            drawing.leave_out(subject, "no contact and no plateaus in the maps that are shown")
        return []
    unit, most = unit_of("m2", max(own[-1] for *_, own in every)), max(len(own) for *_, own in every)
    least, largest = unit.value(min(own[0] for *_, own in every)), unit.value(max(own[-1] for *_, own in every))
    caption = "Number of contact spots and of secondary plateaus that are at least as large as an area"
    figure, axes = drawing.panels(len(kinds), 50, caption, 3, sharex=True, sharey=True)
    for axis, (title, found) in zip(axes, kinds.items(), strict=True):
        for *_, line, own in (one for one in found if one[-1].size):
            # The last step goes below the axis.
            places, number = unit.value(own[[*range(len(own)), -1]]), [len(own), *range(len(own), 0, -1), 0.1]
            axis.plot([0.7 * least, *places], number, drawstyle="steps-pre", **line)
        if not any(own.size for *_, own in found):
            axis.text(0.5, 0.5, "none in these maps", transform=axis.transAxes, ha="center")
        axis.set(title=title, xlabel=f"area, {unit.symbol}", ylabel="number at least as large")
        axis.label_outer()
    axes[0].set(xscale="log", yscale="log", xlim=(0.7 * least, 1.5 * largest), ylim=(0.7, 1.6 * max(most, 10)))
    return _explained(drawing, figure, axes[0], every)


def heights(drawing: Drawing, subjects: list[Subject]) -> list[Any]:
    """Distribution of the heights of disc and pin, and the Abbott-Firestone curve."""
    paths = [path for path in ("disc/height", "pin/height") if drawing.having(path)]
    if not paths:
        return []
    caption = "Distribution of the heights, positive toward the other body, and Abbott-Firestone curve"
    figure, axes = drawing.panels(2 * len(paths), 50, caption)
    part, is_peaked = np.arange(0, 1 + APART / 2, APART), False
    for path, left, right in zip(paths, axes[::2], axes[1::2], strict=True):
        body = MAPS[path]
        found = _found(drawing, path, lambda _, path, cells: np.sort(MAPS[path].shown(cells)[np.isfinite(cells)]))
        ends = [values[round(end * (len(values) - 1))] for *_, values in found for end in (BEYOND, 1 - BEYOND)]
        margin = 0.05 * (max(ends) - min(ends)) or 1.0
        edges = np.linspace(min(ends) - margin, max(ends) + margin, CLASSES + 1)
        for *_, line, values in found:
            percent = np.histogram(values, edges)[0] / len(values) / np.diff(edges) * 100
            there = np.sort(percent[percent > 0])
            is_peaked |= len(there) > 1 and there[-1] > MOST_LINEAR * there[:-1].mean()
            left.plot(np.where(percent > 0, percent, np.nan), (edges[:-1] + edges[1:]) / 2, **line)
            right.plot(100 * part, values[::-1][np.round(part * (len(values) - 1)).astype(int)], **line)
        for axis in (left, right):
            axis.set(ylim=(edges[0], edges[-1]), ylabel=f"{body.body}: {body.what}, {body.unit.symbol}")
        left.set_xlabel(f"cells, % per {body.unit.symbol}")
        right.set(xlim=(0, 100), xlabel="material ratio, %")
    for axis in axes[::2]:
        axis.set_xscale("log" if is_peaked else "linear")
    return _explained(drawing, figure, axes[0], found)
