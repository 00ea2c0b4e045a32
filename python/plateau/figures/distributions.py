"""How sizes of contact spots and plateaus, and heights, are distributed at the first and the last map."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from plateau.figures.drawing import Drawing, Subject
from plateau.quantities import MAPS
from plateau.run_file import array
from plateau.style import DASHES, LINES, Figures, in_style
from plateau.units import unit_of

SECONDARY = 2
KINDS = {"pin/pressure": "contact spots of the pin", "pin/status": "secondary plateaus of the pin", "disc/status": "secondary plateaus of the disc"}
# Classes of heights; a distribution is on a logarithmic scale if a class has more than so many times the mean of the others.
CLASSES, MOST_LINEAR = 80, 6.0
# Parts of the heights beyond the axis, on either side; parts that points of the Abbott-Firestone curve are apart.
BEYOND, APART = 0.001, 0.005
# Runs of which also the first map has a line of heights, at most.
MOST_WITH_FIRST = 2


def look(drawing: Drawing, subject: Subject, place: int) -> dict[str, Any]:
    """How the line of a moment is drawn: of a single run each in its colour, of several all but the last paler."""
    moments = subject.moments
    if drawing.only:
        own = (len(moments) - 1 - place) % len(LINES)
        return {"color": LINES[own], "linestyle": DASHES[own], "label": subject.moment(moments[place])}
    paler = {"alpha": 0.4, "marker": None, "label": None}
    return {**subject.line, "label": subject.label, **(paler if place < len(moments) - 1 else {})}


def note_of(drawing: Drawing, shown: Sequence[Subject], has_first: bool = True) -> str:
    """Which maps the lines of several runs are of."""
    if drawing.only:
        return ""
    lasts, firsts = ({subject.moment(subject.moments[end]) for subject in shown} for end in (-1, 0))
    last = f"Last map{', ' + next(iter(lasts)) if len(lasts) == 1 else ''}"
    if not has_first or all(len(subject.moments) < 2 for subject in shown):
        return last
    return f"{last}; paler: first map{', ' + next(iter(firsts)) if len(firsts) == 1 else ''}"


def areas_of(belongs: Any, radii: Any, angle: float, is_ring: bool) -> Any:
    """Areas, m², of groups of cells that share edges, the least first. Columns are so wide, rad; those of a ring close round it."""
    from scipy.ndimage import label
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    labels, count = label(belongs)
    cells = np.broadcast_to(radii * (radii[1] - radii[0] if len(radii) > 1 else radii[0] / 100) * angle, belongs.shape)
    areas = np.bincount(labels.ravel(), cells.ravel(), count + 1)[1:]
    if is_ring and count:
        both = belongs[0] & belongs[-1]
        joined = coo_array((np.ones(both.sum()), (labels[0][both] - 1, labels[-1][both] - 1)), shape=(count, count))
        areas = np.bincount(connected_components(joined, directed=False)[1], areas)
    return np.sort(areas)


@in_style
def plateau_sizes(drawing: Drawing) -> Figures:
    """Number of contact spots, and of secondary plateaus, that are at least as large as an area, at the first and the last map."""
    kinds = {}
    for name, title in KINDS.items():
        body = name.split("/")[0]
        found = []
        for subject in drawing.with_maps(name):
            # The columns of the pin are those of the disc.
            radii, angle = array(subject.run, "radius").values, math.tau / subject.run.sizes["disc_angle"]
            for place, index in enumerate(subject.moments):
                cells = array(subject.run, name).isel(map_time=index).transpose(f"{body}_angle", "radius").values
                belongs = cells == SECONDARY if "status" in name else cells > 0
                found.append((subject, place, areas_of(belongs, radii, angle, body == "disc")))
        if found:
            kinds[title] = found
    every = [areas for found in kinds.values() for *_, areas in found if areas.size]
    if not every:
        for subject in drawing.subjects if kinds else []:
            drawing.leave_out(subject, "no contact and no plateaus in the maps that are shown")
        return {}
    unit = unit_of("m2", max(areas[-1] for areas in every))
    least, largest = (unit.value(end(areas[place] for areas in every)) for end, place in ((min, 0), (max, -1)))
    shown = list({id(subject): subject for found in kinds.values() for subject, *_ in found}.values())
    caption = "Number of contact spots and of secondary plateaus that are at least as large as an area"
    has_first = any(areas.size and place + 1 < len(subject.moments) for found in kinds.values() for subject, place, areas in found)
    figure, axes = drawing.grid(len(kinds), 50, caption, note_of(drawing, shown, has_first), 3, sharex=True, sharey=True)
    for axis, (title, found) in zip(axes, kinds.items(), strict=True):
        for subject, place, areas in (one for one in found if one[-1].size):
            # Two points for each area, the number before and after it; the last step goes below the axis.
            x = np.repeat(unit.value(areas), 2)
            y = np.repeat(np.arange(len(areas), -1, -1.0), 2)[1:-1]
            axis.plot(np.insert(x, 0, 0.7 * least), np.insert(np.maximum(y, 0.1), 0, len(areas)), **look(drawing, subject, place))
        if not any(areas.size for *_, areas in found):
            axis.text(0.5, 0.5, "none in these maps", transform=axis.transAxes, ha="center")
        axis.set_title(title, loc="left")
    most = max(len(areas) for areas in every)
    axes[0].set(xscale="log", yscale="log", xlim=(0.7 * least, 1.5 * largest), ylim=(0.7, 1.6 * max(most, 10)))
    for axis in axes:
        axis.set(xlabel=f"area, {unit.symbol}", ylabel="number at least as large")
        axis.label_outer()
    drawing.legend(figure, axes[0])
    return {"plateau-sizes": figure}


@in_style
def heights(drawing: Drawing) -> Figures:
    """Distribution of the heights of disc and pin, and the Abbott-Firestone curve."""
    all_shown = {name: drawing.with_maps(name) for name in ("disc/height", "pin/height")}
    all_shown = {name: shown for name, shown in all_shown.items() if shown}
    if not all_shown:
        return {}
    has_first = len(drawing.subjects) <= MOST_WITH_FIRST
    bodies = {}
    for name, shown in all_shown.items():
        found = []
        for subject in shown:
            for place, index in enumerate(subject.moments):
                if has_first or place == len(subject.moments) - 1:
                    values = MAPS[name].shown(array(subject.run, name).isel(map_time=index).values)
                    found.append((subject, place, np.sort(values[np.isfinite(values)])))
        ends = [values[round(part * (len(values) - 1))] for *_, values in found for part in (BEYOND, 1 - BEYOND)]
        margin = 0.05 * (max(ends) - min(ends)) or 1.0
        edges = np.linspace(min(ends) - margin, max(ends) + margin, CLASSES + 1)
        density = [np.diff(np.searchsorted(values, edges)) / len(values) / np.diff(edges) * 100 for *_, values in found]
        bodies[name] = (found, edges, density)
    is_peaked = any(
        one.max() > MOST_LINEAR * np.sort(one[one > 0])[:-1].mean() for _, _, density in bodies.values() for one in density if (one > 0).sum() > 1
    )
    subjects = next(iter(all_shown.values()))
    note = note_of(drawing, subjects, has_first)
    caption = "Distribution of the heights, positive toward the other body, and Abbott-Firestone curve"
    figure, axes = drawing.grid(2 * len(bodies), 50, caption, note)
    for left, right, (name, (found, edges, density)) in zip(axes[::2], axes[1::2], bodies.items(), strict=True):
        one = MAPS[name]
        for (subject, place, values), percent in zip(found, density, strict=True):
            line = look(drawing, subject, place)
            left.plot(np.where(percent > 0, percent, np.nan), (edges[:-1] + edges[1:]) / 2, **line)
            part = np.arange(0, 1 + APART / 2, APART)
            right.plot(100 * part, values[::-1][np.round(part * (len(values) - 1)).astype(int)], **line)
        for axis in (left, right):
            axis.set(ylim=(edges[0], edges[-1]), ylabel=f"{one.body}: {one.what}, {one.unit.symbol}")
        left.set(xscale="log" if is_peaked else "linear", xlabel=f"cells, % per {one.unit.symbol}")
        right.set(xlim=(0, 100), xlabel="material ratio, %")
    drawing.legend(figure, axes[0])
    return {"heights": figure}
