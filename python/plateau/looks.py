"""How maps are coloured: as in the figures of the program (docs/figures.md)."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import xarray

# What no cell is; cells that have no part in the range of a map, as those without contact; statuses in their order.
GROUND = "#ffffff"
APART = "#e4e4e4"
STATUS_COLOURS = [APART, "#005a9c", "#e69f00", GROUND]
# Part of the cells beyond each end of the colours.
BEYOND = 0.005
# Pressures that differ more than this many times are shown on a scale of equal ratios.
MOST_LINEAR = 100.0
# Units in which quantities are drawn: factor and name.
DRAWN = {"m2": (1e6, "mm²"), "m3": (1e9, "mm³"), "Pa": (1e-6, "MPa")}
# Lengths below this, m, are drawn in micrometres.
SMALL = 1e-3


@dataclass
class Look:
    """What is drawn of a map, and how."""

    values: Any
    # What the colours stand for, with the unit.
    label: str
    # Which ends of the colour bar are points: neither, min, max or both.
    extend: str = "neither"
    # What grey cells are; empty where there are none.
    apart: str = ""
    # What the map is, where it is drawn in another way than it is recorded.
    title: str = ""
    # Those of pcolormesh.
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
        The name is empty where there is no unit.
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
        # The z of the pin grows away from the disc, and its peaks are to be high.
        with_ground = np.isfinite(values)
        values = values[with_ground].mean() - values if with_ground.any() else values
        look = spanning(values, f"height toward the disc, {unit}")
        look.title = what.removesuffix(", positive away from the disc")
        return look
    return spanning(values, ", ".join(filter(None, [str(cells.name or ""), unit])))


def spanning(values: Any, label: str) -> Look:
    """Colours from nearly the least to nearly the greatest value.

    Parameters
    ----------
    values : array
        NaN where there is no cell.
    label : str
        What they are.

    Returns
    -------
    Look
    """
    finite = values[np.isfinite(values)]
    low, high = np.quantile(finite, [BEYOND, 1 - BEYOND]) if finite.size else (0.0, 0.0)
    return Look(values, label, "both", options={"cmap": colours("viridis"), "vmin": low, "vmax": high})


def from_zero(values: Any, label: str, apart: str, most_linear: float = np.inf) -> Look:
    """Colours from zero to nearly the greatest value; zero itself has none of them.

    Parameters
    ----------
    values : array
        NaN where there is no cell.
    label, apart : str
        What they are, and what cells with zero are.
    most_linear : float
        Values that differ more than this many times are on a scale of equal ratios.

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
        # A logarithm has no place for zero, which lies below all others then.
        values = np.where(values == 0, 1e-3 * above.min(), np.where(values > 0, np.maximum(values, low), values))
    return Look(values, label, "max", apart if above.size < np.isfinite(values).sum() else "", options=options)


def colours(name: str, under: str | None = None) -> Any:
    """The colours of a range.

    Parameters
    ----------
    name : str
        That of a colour map of matplotlib.
    under : str, optional
        The colour of what is below the range; the lowest one unless given.

    Returns
    -------
    matplotlib.colors.Colormap
        White where there is no number.
    """
    import matplotlib

    return matplotlib.colormaps[name].with_extremes(bad=GROUND, under=under)
