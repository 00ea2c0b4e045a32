"""Colours of maps, as in the figures of the program (docs/figures.md)."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray

# Places without a cell; cells outside the range of a map, such as cells without contact; statuses in their order.
GROUND = "#ffffff"
APART = "#e4e4e4"
STATUS_COLOURS = [APART, "#005a9c", "#e69f00", GROUND]
# Lines and groups of studies, after M. Okabe and K. Ito; what is less important; a place that was chosen.
LINES = [STATUS_COLOURS[1], "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#000000"]
QUIET, CHOSEN = "#6b6b6b", "#d55e00"
# Fraction of the cells beyond each end of the colours.
BEYOND = 0.005
# If pressures differ by more than this factor, their scale is logarithmic.
MOST_LINEAR = 100.0
# Units in which quantities are drawn: factor and name.
DRAWN = {"m2": (1e6, "mm²"), "m3": (1e9, "mm³"), "Pa": (1e-6, "MPa")}
# Lengths below this, m, are drawn in micrometres.
SMALL = 1e-3


@dataclass
class Look:
    """The drawn values of a map, and their colours."""

    values: Any
    # The quantity of the colours, with the unit.
    label: str
    # Which ends of the colour bar are points: neither, min, max or both.
    extend: str = "neither"
    # The meaning of grey cells; empty if there are none.
    apart: str = ""
    # The name of the map, if it is not drawn as it is recorded.
    title: str = ""
    # Options of pcolormesh.
    options: dict[str, Any] = field(default_factory=dict)


def in_drawn_unit(values: xarray.DataArray) -> tuple[Any, str]:
    """Values in the unit in which they are drawn, and its name.

    Parameters
    ----------
    values : xarray.DataArray
        With the attribute ``units``, SI.

    Returns
    -------
    tuple of array and str
        The name is empty if there is no unit.
    """
    unit, numbers = str(values.attrs.get("units", "1")), values.values
    if unit == "m" and numbers.size and np.nanmax(np.abs(numbers), initial=0.0) < SMALL:
        return numbers * 1e6, "µm"
    factor, name = DRAWN.get(unit, (1.0, "" if unit == "1" else unit))
    return numbers * factor, name


def look_of(cells: xarray.DataArray, names: dict[int, str]) -> Look:
    """How a map is drawn.

    Parameters
    ----------
    cells : xarray.DataArray
        At one moment.
    names : dict
        Statuses and their names; empty for other maps.

    Returns
    -------
    Look
    """
    from matplotlib.colors import ListedColormap

    if names:
        options = {"cmap": ListedColormap(STATUS_COLOURS[: max(names) + 1]), "vmin": -0.5, "vmax": max(names) + 0.5}
        return Look(cells.values, "", options=options)
    values, unit = in_drawn_unit(cells)
    what = str(cells.attrs.get("long_name", cells.name))
    if "contact pressure" in what:
        return from_zero(values, f"pressure, {unit}", "no contact", MOST_LINEAR)
    if "thickness" in what:
        return from_zero(values, f"thickness, {unit}", "nothing has built up")
    if cells.name in ("height", "substrate") and "pin_angle" in cells.dims:
        # The z of the pin increases away from the disc, but its peaks must be high.
        with_ground = np.isfinite(values)
        values = values[with_ground].mean() - values if with_ground.any() else values
        look = spanning(values, f"height toward the disc, {unit}")
        look.title = what.removesuffix(", positive away from the disc")
        return look
    return spanning(values, ", ".join(filter(None, [str(cells.name or ""), unit])))


def spanning(values: Any, label: str) -> Look:
    """Colours from nearly the smallest to nearly the largest value.

    Parameters
    ----------
    values : array
        NaN if there is no cell.
    label : str
        The name of the quantity.

    Returns
    -------
    Look
    """
    finite = values[np.isfinite(values)]
    low, high = np.quantile(finite, [BEYOND, 1 - BEYOND]) if finite.size else (0.0, 0.0)
    return Look(values, label, "both", options={"cmap": colours("viridis"), "vmin": low, "vmax": high})


def from_zero(values: Any, label: str, apart: str, most_linear: float = np.inf) -> Look:
    """Colours from zero to nearly the largest value; zero itself has another colour.

    Parameters
    ----------
    values : array
        NaN if there is no cell.
    label, apart : str
        The name of the quantity, and the name of cells with zero.
    most_linear : float
        If values differ by more than this factor, the scale is logarithmic.

    Returns
    -------
    Look
    """
    from matplotlib.colors import LogNorm

    above = values[np.isfinite(values) & (values > 0)]
    low, high = np.quantile(above, [BEYOND, 1 - BEYOND]) if above.size else (1.0, 1.0)
    # Zero is just below the range.
    options: dict[str, Any] = {"cmap": colours("viridis", APART), "vmin": 1e-9 * high, "vmax": high}
    if high > most_linear * low:
        options = {"cmap": colours("viridis", APART), "norm": LogNorm(low, high)}
        # Zero has no logarithm: it is below all other values.
        values = np.where(values == 0, 1e-3 * above.min(), np.where(values > 0, np.maximum(values, low), values))
    return Look(values, label, "max", apart if above.size < np.isfinite(values).sum() else "", options=options)


def colours(name: str, under: str | None = None) -> Any:
    """The colours of a range.

    Parameters
    ----------
    name : str
        Name of a colour map of matplotlib.
    under : str, optional
        The colour below the range; by default the lowest colour.

    Returns
    -------
    matplotlib.colors.Colormap
        White if there is no number.
    """
    import matplotlib

    return matplotlib.colormaps[name].with_extremes(bad=GROUND, under=under)
