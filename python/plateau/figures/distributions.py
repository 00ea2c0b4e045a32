"""How sizes of contact spots and plateaus, and heights, are distributed at the first and the last map."""

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from plateau import style
from plateau.figures.drawing import Drawing, Subject
from plateau.quantities import MAPS
from plateau.run_file import array
from plateau.units import unit_of

SECONDARY = 2
KINDS = {"pin/pressure": "contact spots of the pin", "pin/status": "secondary plateaus of the pin", "disc/status": "secondary plateaus of the disc"}
# Classes of heights; a distribution is on a logarithmic scale if a class has more than so many times the mean of the others.
CLASSES, MOST_LINEAR = 80, 6.0
# Parts of the heights beyond the axis, on either side; parts that points of the Abbott-Firestone curve are apart.
BEYOND, APART = 0.001, 0.005
# Runs of which also the first map has a line of heights, at most.
MOST_WITH_FIRST = 2


def maps_of(drawing: Drawing, path: str) -> Iterator[tuple[Subject, int, Any]]:
    """A map of the runs that have it: the run, which of its moments from the last one on, and the cells, those of a column in a row."""
    for subject in drawing.having(path):
        for place, index in enumerate(subject.moments, 1 - len(subject.moments)):
            yield subject, -place, array(subject.run, path).isel(map_time=index).transpose(..., "radius").values


def look(drawing: Drawing, subject: Subject, place: int) -> dict[str, Any]:
    """How the line of a moment is drawn: of a single run each in its colour, of several all but the last paler."""
    if drawing.only:
        return style.look(place) | {"label": subject.moment(subject.moments[-1 - place])}
    return {**subject.line, "label": subject.label} | ({"alpha": 0.4, "marker": None, "label": None} if place else {})


def note_of(drawing: Drawing, found: Sequence[tuple[Subject, int, Any]]) -> str:
    """Which maps the lines of several runs are of."""
    if drawing.only:
        return ""
    lasts, firsts = ({subject.moment(subject.moments[end]) for subject, *_ in found} for end in (-1, 0))
    ends = {"Last map": lasts} | ({"paler: first map": firsts} if any(place for _, place, _ in found) else {})
    return "; ".join(f"{end}, {next(iter(times))}" if len(times) == 1 else end for end, times in ends.items())


def areas_of(belongs: Any, radii: Any, angle: float, is_ring: bool) -> Any:
    """Areas, m², of groups of cells that share edges, the least first. Columns are so wide, rad; those of a ring close round it."""
    from scipy.ndimage import label

    labels, count = label(belongs)
    cells = np.broadcast_to(radii * (radii[1] - radii[0] if len(radii) > 1 else radii[0] / 100) * angle, belongs.shape)
    areas = np.bincount(labels.ravel(), cells.ravel(), count + 1)
    group = np.arange(count + 1)
    for first, last in zip(labels[0], labels[-1], strict=True) if is_ring else ():
        if first and last:
            group[group == group[last]] = group[first]
    areas = np.bincount(group, areas)[1:]
    return np.sort(areas[areas > 0])


def plateau_sizes(drawing: Drawing) -> list[Any]:
    """Number of contact spots, and of secondary plateaus, that are at least as large as an area, at the first and the last map."""
    kinds: dict[str, list[tuple[Subject, int, Any]]] = {}
    for path, title in KINDS.items():
        for subject, place, cells in maps_of(drawing, path):
            # The columns of the pin are those of the disc.
            radii, angle = array(subject.run, "radius").values, math.tau / subject.run.sizes["disc_angle"]
            areas = areas_of(cells == SECONDARY if "status" in path else cells > 0, radii, angle, path.startswith("disc"))
            kinds.setdefault(title, []).append((subject, place, areas))
    every = [one for found in kinds.values() for one in found if one[-1].size]
    if not every:
        for subject in drawing.subjects if kinds else []:
            drawing.leave_out(subject, "no contact and no plateaus in the maps that are shown")
        return []
    unit = unit_of("m2", max(areas[-1] for *_, areas in every))
    least, largest = (unit.value(end(areas[place] for *_, areas in every)) for end, place in ((min, 0), (max, -1)))
    caption = "Number of contact spots and of secondary plateaus that are at least as large as an area"
    figure, axes = drawing.panels(len(kinds), 50, caption, 3, sharex=True, sharey=True)
    for axis, (title, found) in zip(axes, kinds.items(), strict=True):
        for subject, place, areas in (one for one in found if one[-1].size):
            # Two points for each area, the number before and after it; the last step goes below the axis.
            x = np.repeat(unit.value(areas), 2)
            y = np.repeat(np.arange(len(areas), -1, -1.0), 2)[1:-1]
            axis.plot(np.insert(x, 0, 0.7 * least), np.insert(np.maximum(y, 0.1), 0, len(areas)), **look(drawing, subject, place))
        if not any(areas.size for *_, areas in found):
            axis.text(0.5, 0.5, "none in these maps", transform=axis.transAxes, ha="center")
        axis.set_title(title, loc="left")
        axis.set(xlabel=f"area, {unit.symbol}", ylabel="number at least as large")
        axis.label_outer()
    most = max(len(areas) for *_, areas in every)
    axes[0].set(xscale="log", yscale="log", xlim=(0.7 * least, 1.5 * largest), ylim=(0.7, 1.6 * max(most, 10)))
    return drawing.explained(figure, axes[0], note_of(drawing, every))


def heights(drawing: Drawing) -> list[Any]:
    """Distribution of the heights of disc and pin, and the Abbott-Firestone curve."""
    bodies, is_peaked = {}, False
    for one in (MAPS["disc/height"], MAPS["pin/height"]):
        found = []
        for subject, place, cells in maps_of(drawing, one.path):
            if place == 0 or len(drawing.subjects) <= MOST_WITH_FIRST:
                values = one.shown(cells)
                found.append((subject, place, np.sort(values[np.isfinite(values)])))
        if not found:
            continue
        ends = [values[round(part * (len(values) - 1))] for *_, values in found for part in (BEYOND, 1 - BEYOND)]
        margin = 0.05 * (max(ends) - min(ends)) or 1.0
        edges = np.linspace(min(ends) - margin, max(ends) + margin, CLASSES + 1)
        density = [np.diff(np.searchsorted(values, edges)) / len(values) / np.diff(edges) * 100 for *_, values in found]
        is_peaked |= any(one.max() > MOST_LINEAR * np.sort(one[one > 0])[:-1].mean() for one in density if (one > 0).sum() > 1)
        bodies[one] = found, edges, density
    if not bodies:
        return []
    caption = "Distribution of the heights, positive toward the other body, and Abbott-Firestone curve"
    figure, axes = drawing.panels(2 * len(bodies), 50, caption)
    part = np.arange(0, 1 + APART / 2, APART)
    for left, right, (body, (found, edges, density)) in zip(axes[::2], axes[1::2], bodies.items(), strict=True):
        for (subject, place, values), percent in zip(found, density, strict=True):
            line = look(drawing, subject, place)
            left.plot(np.where(percent > 0, percent, np.nan), (edges[:-1] + edges[1:]) / 2, **line)
            right.plot(100 * part, values[::-1][np.round(part * (len(values) - 1)).astype(int)], **line)
        for axis in (left, right):
            axis.set(ylim=(edges[0], edges[-1]), ylabel=f"{body.body}: {body.what}, {body.unit.symbol}")
        left.set(xscale="log" if is_peaked else "linear", xlabel=f"cells, % per {body.unit.symbol}")
        right.set(xlim=(0, 100), xlabel="material ratio, %")
    return drawing.explained(figure, axes[0], note_of(drawing, next(iter(bodies.values()))[0]))
