"""The figures of surfaces, from the folder of data that ``plateau surface --figure-data`` writes: map, distribution, material ratio curve,
power spectrum and autocorrelation of each, or its relief."""

import os
import tempfile
from collections.abc import Sequence
from typing import Any, Literal

import numpy as np

from plateau.commands import command
from plateau.errors import InputError
from plateau.program import file_name
from plateau.style import APART, DASHES, LINES, QUIET, WIDE, Figures, in_style, new, wrapped
from plateau.surface_data import Surface, autocorrelation, in_bands, read, thinned
from plateau.units import Unit, unit_for

# Surfaces on a page and the height of each, mm; points that are drawn along a side of a map and of a relief.
ON_PAGE, BLOCK, MOST_POINTS, MOST_OF_RELIEF = 3, 75.0, 1000, 150
# A ring is shown in windows of about this length over their height; one that is longer or higher than that is stretched.
ELONGATION, MOST_WINDOWS, LONGEST, HIGHEST = 8.6, 4, 20.0, 2.0
# Classes of the distribution.
CLASSES = 64
# The autocorrelation at Sal, how far it is shown, over Sal, and the range of the power, powers of ten.
DECAYED, LAGS, DECADES = 0.2, 8.0, 9.0
# Axes of the heights: number, name, look of lines.
DIRECTIONS: list[tuple[int, str, dict[str, Any]]] = [
    (1, "x", {"color": LINES[0], "linewidth": 0.9}),
    (0, "y", {"color": LINES[6], "linewidth": 0.9, "linestyle": DASHES[1]}),
]
NOTE = """Heights are counted from their mean. Material ratio: line through the flattest 40 % of the curve; the core has the height Sk,
the triangles Spk and Svk. Power spectral density (PSD): one-sided, mean over all profiles along x or y, each less its mean, with a Hann
window; its integral is the mean square of these profiles. Autocorrelation: mean over all pairs of points, over Sq²; dotted: Sal, at which
it falls to 0.2 in the direction in which it does so first."""


class Scale:
    """Spans of axes and colours: the same for surfaces that belong together."""

    def __init__(self, together: Sequence[Surface]) -> None:
        spans = np.array([[one.central(0.001), one.core, one.central(0.005)] for one in together])
        low, high = spans[:, :2].min(), spans[:, :2].max()
        room = max(0.06 * (high - low), 1e-10)
        self.height = unit_for("m", 0.5 * (high - low))
        self.heights = self.height.value(np.array([low - room, high + room]))
        self.colours = self.height.value(np.array([spans[:, 2].min(), max(spans[:, 2].max(), spans[:, 2].min() + 1e-10)]))
        lengths = [length for one in together for length in one.size]
        self.length = unit_for("m", max(lengths)) if together[0].told["pitch"] else Unit("pitch", 1.0)
        shortest = [one.value("Sal") for one in together if np.isfinite(one.value("Sal"))]
        self.lags = self.length.value(min(LAGS * max(shortest, default=np.inf), 0.5 * max(lengths)))
        frequencies, powers = (np.concatenate(every) for every in zip(*(one for each in together for one in each.spectra), strict=True))
        self.frequencies = np.array([frequencies.min(), frequencies.max()]) / self.length.per_si
        least = max(powers[powers > 0].min(initial=np.inf), powers.max() * 10**-DECADES)
        self.power = self.of_power(np.array([least / 2, 2 * powers.max()]))

    def of_power(self, density: Any) -> Any:
        """Densities of the power, m³, as they are shown."""
        return density * self.height.per_si**2 * self.length.per_si


@in_style
def surfaces(folder: str | os.PathLike[str], view: Literal["charts", "relief"] = "charts") -> Figures:
    """Draws the surfaces of a folder of data, several on a page; those of one body have the same scales."""
    if view not in ("charts", "relief"):
        raise InputError(f'view = {view!r}: expected "charts" or "relief"')
    found = [one for one in read(folder) if view == "charts" or min(one.heights.shape) > 1]
    if not found:
        raise InputError(f"{folder} has no surface to draw: a profile has no relief")
    scaled = [(one, Scale([other for other in found if other is one or (one.body and other.body == one.body)])) for one in found]
    draw, some = (_charts, ON_PAGE) if view == "charts" else (_reliefs, 2 * ON_PAGE)
    pages = [scaled[begin : begin + some] for begin in range(0, len(scaled), some)]
    return {f"surfaces-{number}" if number > 1 else "surfaces": draw(page) for number, page in enumerate(pages, 1)}


def _charts(page: list[tuple[Surface, Scale]]) -> Any:
    caption = "Map of the heights, their distribution, material ratio curve, power spectral density and autocorrelation."
    note, widths = " ".join(NOTE.split()), {"width_ratios": [1.25, 1, 1]}
    figure, axes = new(WIDE, BLOCK * len(page) + 14, caption, 2 * len(page), 3, note, gridspec_kw=widths)
    for row, (surface, scale) in enumerate(page):
        own = axes[2 * row : 2 * row + 2]
        _map(figure, own[0, 0].get_gridspec()[2 * row : 2 * row + 2, 0], surface, scale)
        for axis, draw in zip(own[:, 1:].flat, (_distribution, _material_ratio, _power, _correlation), strict=True):
            draw(axis, surface, scale)
        own[0, 0].remove()
        own[1, 0].remove()
    return figure


def _map(figure: Any, place: Any, surface: Surface, scale: Scale) -> None:
    """The map in proportion, one that is long in windows below each other."""
    from matplotlib.ticker import MaxNLocator

    columns, (x, y), (low, high) = surface.heights.shape[1], map(scale.length.value, surface.size), scale.colours
    count = min(max(round(x / y / ELONGATION), 1), MOST_WINDOWS, columns)
    window = x / count
    stretch = max(window / y / LONGEST, min(HIGHEST * window / y, 1.0))
    axes = [figure.add_subplot(one, facecolor=APART) for one in place.subgridspec(count, 1, hspace=0.0)]
    for number, axis in enumerate(axes):
        begin, end = number * columns // count, (number + 1) * columns // count
        heights = scale.height.value(thinned(surface.heights[:, begin:end], MOST_POINTS) - surface.mean)
        extent = (x * begin / columns, x * end / columns, 0, y)
        drawn = axis.imshow(heights, origin="lower", extent=extent, vmin=low, vmax=high, aspect=stretch, interpolation="nearest")
        if count > 1:
            # Two numbers on a low one would touch.
            ends = MaxNLocator(1, steps=[1, 2, 4, 5, 10]).tick_values(0, y)
            axis.yaxis.set_major_formatter("{x:g}")
            axis.set_yticks([one for one in ends if 0 < one <= y or (one == 0 and window < 12 * y)])
    axes[-1].set_xlabel(f"x, {scale.length.symbol}")
    axes[count // 2].set_ylabel(f"y, {scale.length.symbol}", y=0.5 if count % 2 else 1.5)
    bounds = scale.height.value(np.array([surface.curve.min(), surface.curve.max()]))
    beyond = ("neither", "min", "max", "both")[int(bounds[0] < low) + 2 * int(bounds[1] > high)]
    # Above the map, so that maps begin at the same height, whatever their proportion.
    bar = figure.colorbar(drawn, ax=axes, location="top", aspect=30, extend=beyond, label=f"height, {scale.height.symbol}")
    missing = 1.0 - surface.told["measured"] / surface.told["points"]
    said = [wrapped(surface.told["title"], 36)] + ([f"grey: no height, {100 * missing:.3g} %"] if missing else [])
    said += [f"{'y' if stretch > 1 else 'x'} stretched {max(stretch, 1 / stretch):.3g} times"] if stretch != 1 else []
    bar.ax.set_title("\n".join(said))


def _distribution(axis: Any, surface: Surface, scale: Scale) -> None:
    edges = np.linspace(scale.heights[0], scale.heights[1], CLASSES + 1)
    known = scale.height.value(np.asarray(surface.heights)[np.isfinite(surface.heights)] - surface.mean)
    parts = 100 * np.histogram(known, edges)[0] / known.size
    axis.stairs(parts, edges, orientation="horizontal", fill=True, color="#a9c8e4")
    axis.stairs(parts, edges, orientation="horizontal", color=LINES[0], linewidth=0.6)
    axis.set(xlim=(0, None), ylim=scale.heights, xlabel="points per class, %", ylabel=f"height, {scale.height.symbol}")
    said = f"\nbeyond axis: {100 - parts.sum():.2g} %" if parts.sum() < 100 - 1e-9 else ""
    axis.set_title(f"{surface.text('Sq', 'Ssk')}\n{surface.text('Sku', 'Sp', 'Sv')}{said}", fontsize=7)


def _material_ratio(axis: Any, surface: Surface, scale: Scale) -> None:
    lower, upper = scale.height.value(np.array(surface.core))
    peaks, dales = (scale.height.value(surface.value(name)) for name in ("Spk", "Svk"))
    first, last = (100 * surface.value(name) for name in ("Smr1", "Smr2"))
    axis.fill([0, 0, first], [upper, upper + peaks, upper], [100, 100, last], [lower, lower - dales, lower], color="#f3c9a8", linewidth=0)
    axis.hlines([lower, upper], 0, 100, color=QUIET, linewidth=0.5)
    axis.plot([0, 100], [upper, lower], color=LINES[6], linewidth=0.8)
    axis.plot(np.linspace(0, 100, len(surface.curve)), scale.height.value(surface.curve), linewidth=1.4)
    axis.set(xlim=(0, 100), ylim=scale.heights, xlabel="material ratio, %")
    axis.tick_params(labelleft=False)
    axis.set_title(f"{surface.text('Sk')}\n{surface.text('Spk', 'Svk')}\n{surface.text('Smr1', 'Smr2')}", fontsize=7)


def _power(axis: Any, surface: Surface, scale: Scale) -> None:
    from matplotlib.ticker import NullFormatter

    length, height = scale.length.symbol, scale.height.symbol
    for (_, name, look), spectrum in zip(DIRECTIONS, surface.spectra, strict=True):
        frequency, density = in_bands(*spectrum)
        axis.plot(frequency / scale.length.per_si, scale.of_power(density), label=f"along {name}", **look)
    if scale.power[1] > 0:
        axis.set(xscale="log", yscale="log", xlim=scale.frequencies, ylim=scale.power)
    axis.set(xlabel=f"spatial frequency, {length}⁻¹", ylabel=f"PSD, {height}³" if height == length else f"PSD, {height}² {length}")
    for one in (axis.xaxis, axis.yaxis):
        one.set_minor_formatter(NullFormatter())
    # Where other charts have their parameters.
    axis.legend(loc="lower left", bbox_to_anchor=(0, 1), ncols=2, borderaxespad=0)


def _correlation(axis: Any, surface: Surface, scale: Scale) -> None:
    for along, name, look in DIRECTIONS:
        lags, values = autocorrelation(surface.heights, surface.pitch[along], along)
        axis.plot(scale.length.value(lags), values, label=f"along {name}", **look)
    shortest, least = scale.length.value(surface.value("Sal")), axis.get_ylim()[0]
    axis.plot([0, shortest, shortest], [DECAYED, DECAYED, least], ":", color="black")
    axis.set(xlim=(0, scale.lags), ylim=(least, 1.05), xlabel=f"lag, {scale.length.symbol}", ylabel="autocorrelation")
    axis.set_title(surface.text("Sal", "Str"), fontsize=7)


def _reliefs(page: list[tuple[Surface, Scale]]) -> Any:
    columns, rows = min(len(page), 2), -(-len(page) // 2)
    figure, axes = new(0.5 * WIDE * columns, 62 * rows, "Surfaces in perspective.", rows, columns, subplot_kw={"projection": "3d"})
    for axis in axes.flat[len(page) :]:
        axis.remove()
    for axis, (surface, scale) in zip(axes.flat, page, strict=False):
        (x, y), length, height = surface.size, scale.length, scale.height
        # Of a ring the beginning.
        part = min(x, 2 * y)
        heights = thinned(surface.heights[:, : max(round(part / surface.pitch[1]), 2)], MOST_OF_RELIEF)
        places = np.meshgrid(*(length.value(of / n * (np.arange(n) + 0.5)) for of, n in zip((part, y), heights.shape[::-1], strict=True)))
        look = {"cmap": "viridis", "vmin": scale.colours[0], "vmax": scale.colours[1], "linewidth": 0, "antialiased": False}
        shown = np.clip(height.value(heights - surface.mean), *scale.heights)
        axis.plot_surface(*places, shown, rcount=MOST_OF_RELIEF, ccount=MOST_OF_RELIEF, **look)
        axis.set(xlabel=f"x, {length.symbol}", ylabel=f"y, {length.symbol}", zlabel=f"height, {height.symbol}", zlim=scale.heights)
        axis.set_box_aspect((max(part, 0.5 * y), y, 0.35 * y), zoom=0.8)
        axis.locator_params(nbins=4, steps=[1, 2, 5, 10])
        axis.xaxis.labelpad = 8
        axis.set_title(wrapped(surface.told["title"], 40), loc="center", y=0.95)
    return figure


def plot_surfaces(
    *files: str | os.PathLike[str], prepare: str | os.PathLike[str] | None = None, view: Literal["charts", "relief"] = "charts", **options: Any
) -> Figures:
    """Draws surfaces: map, distribution of the heights, material ratio curve, power spectral density and autocorrelation.

    Parameters
    ----------
    *files : path
        Surface files or run files.
    prepare : path, optional
        A scene, of which the prepared disc and pin are drawn, too, with the patches that they are made of.
    view : {"charts", "relief"}
        Map and charts, or the surfaces in perspective.
    **options
        Options of ``plateau surface``, such as ``level="quadratic"`` or ``pitch="0.5 um"``, as for `command`.

    Returns
    -------
    dict
        Figures by their names: several surfaces on each.
    """
    with tempfile.TemporaryDirectory() as folder:
        command("surface", *(file_name(file, "a surface") for file in files), prepare=prepare, figure_data=folder, **options)
        return surfaces(folder, view)
