"""The figure of a pin's fibres, from the folder of data that ``plateau surface --figure-data`` writes: the micrograph, the base of the pin's
cells, and both bodies as they lie on each other."""

import os
from pathlib import Path
from typing import Any

import numpy as np

from plateau.style import DASHES, GROUND, LINES, WIDE, Figures, in_style, new
from plateau.surface_data import Surface, read, thinned, told
from plateau.units import unit_for

# Points along the longer side of a picture, and columns and rows of a ring that are drawn; lengths of the pin that are shown beside it.
MOST_POINTS, MOST_COLUMNS, MOST_ROWS, BESIDE = 1000, 720, 60, 0.6
# Seams of tiles that are still told apart.
MOST_SEAMS = 400
FIBRE, RESIN, OUTLINE, PIN = LINES[1], "#3c3c46", LINES[6], LINES[3]
SEAM: dict[str, Any] = {"color": "#ff3b3b", "linestyle": DASHES[1], "linewidth": 1.0}
NOTE = """The ring is seen as the pin lies on it before the first step. The disc moves in the direction of the arrow and enters under the
leading edge."""


@in_style
def fibre_map(folder: str | os.PathLike[str]) -> Figures:
    """Draws the fibre map of a folder of data: the base of the pin's cells beside the micrograph that it comes from, and on the ring."""
    from matplotlib.colors import ListedColormap
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    found = told(folder, "fibre_map.json")
    disc = next(one for one in read(folder) if one.body == "disc" and not one.told["is_patch"])
    x, y = (0.5e3 * length for length in found["extent"])
    micrograph, fibre, base = (found[name] and np.load(Path(folder) / found[name]) for name in ("micrograph", "fibre", "base"))
    panels = 1 if micrograph is None else 2
    caption = "The base of the pin's cells, fibre or resin" + (", beside the micrograph that it comes from," if panels == 2 else "")
    height = min(WIDE / panels * y / x + 30, 160) + 0.5 * WIDE
    figure, axes = new(WIDE, height, f"{caption} and on the disc.", 2, 2, " ".join(NOTE.split()))
    meanings: list[Any] = [Patch(color=FIBRE, label="fibre"), Patch(color=RESIN, label="resin")]
    if micrograph is None:
        axes[0, 0].remove()
    else:
        half = [0.5e3 * length for length in found["picture"]]
        meanings += _micrograph(axes[0, 0], micrograph, fibre, half, found["is_tiled"])
    colours = ListedColormap([RESIN, FIBRE, GROUND, GROUND])
    own, (ring, near) = axes[0, 1], axes[1]
    scale = unit_for("m", max(abs(part) for part in disc.central(0.005)))
    for axis, title in ((own, "base of the pin"), (ring, "pin on the ring"), (near, "the same, near the pin; arrow: sliding")):
        drawn = None if axis is own else _ring(axis, found, disc, scale, axis is near)
        shown, above = (base, 0) if axis is own else (np.ma.masked_equal(base, 3), 3)
        axis.imshow(shown, cmap=colours, vmin=0, vmax=3, interpolation="nearest", extent=(-x, x, -y, y), zorder=above)
        axis.plot(*(1e3 * np.array(found["leading_edge"])).T, color=PIN, linewidth=2, zorder=4)
        axis.set_title(title)
    for draw, end, part in ((own.axvline, x, half[0]), (own.axhline, y, half[1])) if found["is_tiled"] else ():
        outward = np.arange(part, end, 2 * part)
        for place in np.append(-outward, outward) if outward.size <= MOST_SEAMS else []:
            draw(place, **SEAM)
    room = BESIDE * 2 * x
    near.set(xlim=(-x - room, x + room), ylim=(-y - 0.5 * room, y + 0.5 * room))
    near.annotate("", (x + 0.9 * room, 0), (x + 0.1 * room, 0), arrowprops={"arrowstyle": "->", "color": "black", "linewidth": 1.5}, zorder=4)
    figure.colorbar(drawn, ax=list(axes[1]), location="bottom", aspect=60, extend="both", label=f"height of the disc, {scale.symbol}")
    for axis in (axis for axis in figure.axes if axis in axes):
        axis.set(xlabel="x, mm", ylabel="y, mm")
    meanings.append(Line2D([], [], color=PIN, linewidth=2, label="leading edge"))
    if found["is_tiled"] or found["seams"]["angles"]:
        meanings.append(Line2D([], [], **SEAM, label="seam of tiles"))
    figure.legend(handles=meanings, loc="outside upper left", ncols=5)
    return {"fibre-map": figure}


def _micrograph(axis: Any, micrograph: Any, fibre: Any, half: list[float], is_tiled: bool) -> list[Any]:
    """The micrograph with the outline of what was taken for fibre; what there is to say in the legend."""
    from matplotlib.lines import Line2D

    x, y = half
    axis.imshow(thinned(micrograph, MOST_POINTS), cmap="gray", vmin=0, vmax=255, extent=(-x, x, -y, y))
    axis.set_title("micrograph" + (", a tile of the base" if is_tiled else ""))
    if not 0 < fibre.mean() < 1:
        return []
    parts = thinned(fibre, MOST_POINTS)
    across, down = (of * ((2 * np.arange(n) + 1) / n - 1) for of, n in ((x, parts.shape[1]), (y, parts.shape[0])))
    axis.contour(across, -down, parts, [0.5], colors=[OUTLINE], linewidths=0.6)
    return [Line2D([], [], color=OUTLINE, label="outline of what was taken for fibre")]


def _ring(axis: Any, found: dict[str, Any], disc: Surface, scale: Any, is_near: bool) -> Any:
    """Heights of the disc, of the whole ring or near the pin, with the seams of its tiles."""
    rows, columns = disc.heights.shape
    mean, step = found["mean_radius"], 2 * np.pi / columns
    inner, high = mean - 0.5 * rows * found["row_height"], rows * found["row_height"]
    # Angles from the middle of the pin, of whose columns the first lies on the first of the disc.
    first = -0.5 * found["pin_columns"] * step
    reach = min(BESIDE + 1, 0.5 * columns / found["pin_columns"]) * found["pin_columns"] if is_near else 0.5 * columns
    begin = round(0.5 * found["pin_columns"] - reach)
    taken = np.arange(begin, begin + min(round(2 * reach), columns))
    every = max(-(-len(taken) // MOST_COLUMNS), 1)
    over = max(-(-rows // MOST_ROWS), 1)
    heights = scale.value(disc.heights[::over][:, taken[::every] % columns] - disc.mean)
    angles = first + step * np.append(taken[::every], taken[-1] + 1)
    radii = inner + high * np.minimum(np.arange(heights.shape[0] + 1) * over / rows, 1.0)
    low, top = scale.value(np.array(disc.central(0.005)))

    def places(radius: Any, angle: Any) -> tuple[Any, Any]:
        return 1e3 * radius * np.sin(angle), 1e3 * (radius * np.cos(angle) - mean)

    drawn = axis.pcolormesh(*places(radii[:, None], angles), heights, vmin=low, vmax=max(top, low + 1e-9), cmap="viridis", rasterized=True)
    axis.set_aspect("equal")
    seams = [(np.array([inner, inner + high]), first + angle) for angle in found["seams"]["angles"] if len(found["seams"]["angles"]) <= MOST_SEAMS]
    seams += [(radius, angles) for radius in found["seams"]["radii"] if len(found["seams"]["radii"]) <= MOST_SEAMS]
    for radius, angle in seams:
        axis.plot(*places(radius, angle), **SEAM)
    return drawn
