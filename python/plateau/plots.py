"""Quick figures of series and maps. matplotlib is asked for when something is drawn, and not before."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray

from plateau.run_file import array

# Units in which quantities are drawn: factor and name.
DRAWN = {"m2": (1e6, "mm²"), "m3": (1e9, "mm³"), "Pa": (1e-6, "MPa")}
# Lengths below this, m, are drawn in micrometres.
SMALL = 1e-3
STATUS_COLOURS = ["#d9d9d9", "#4c72b0", "#dd8452", "#ffffff"]


def new_axes(**options: Any) -> Any:
    """Axes of a new figure, an array of them with ``nrows`` or ``ncols``.

    Parameters
    ----------
    **options
        Those of ``matplotlib.pyplot.subplots``.

    Returns
    -------
    matplotlib.axes.Axes
    """
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise ImportError("figures need matplotlib: pip install 'plateau-brake[plot]'") from error
    return plt.subplots(layout="constrained", **options)[1]


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


def draw_series(run: xarray.DataTree, series: Sequence[str], *, ax: Any = None) -> Any:
    """Draws series of a run against time.

    Parameters
    ----------
    run : xarray.DataTree
        As `plateau.open_run` gives it.
    series : sequence of str
        Names; the contact area unless there are any.
    ax : matplotlib.axes.Axes, optional
        Where; new axes unless given.

    Returns
    -------
    matplotlib.axes.Axes
    """
    ax = new_axes(figsize=(7, 4)) if ax is None else ax
    time = array(run, "time").values
    if series:
        for name in series:
            drawn = array(run, f"series/{name}")
            values, unit = in_drawn_unit(drawn)
            ax.plot(time, values, label=drawn.attrs.get("long_name", name))
        label = series[0].replace("_", " ") if len(series) == 1 else ""
        ax.set_ylabel(", ".join(filter(None, [label, unit])))
    else:
        single, unit = in_drawn_unit(array(run, "series/contact_area"))
        ax.plot(time, single, ".", color="0.7", markersize=2, label="single steps")
        ax.plot(time, in_drawn_unit(array(run, "series/contact_area_mean"))[0], label="mean of a revolution")
        ax.set(ylabel=f"contact area, {unit}", ylim=(0, None))
    ax.set(xlabel="time, s", title=run.attrs.get("title", ""))
    ax.legend(markerscale=4)
    return ax


def draw_map(cells: xarray.DataArray, names: dict[int, str], *, polar: bool = False, ax: Any = None, **options: Any) -> Any:
    """Draws a map at one moment.

    Parameters
    ----------
    cells : xarray.DataArray
        With two dimensions: an angle, rad, and ``radius``, m.
    names : dict
        Statuses and their names; empty for other maps.
    polar : bool
        In the plane of the disc; else unrolled, over arc length at the mean radius.
    ax : matplotlib.axes.Axes, optional
        Where; new axes unless given.
    **options
        Those of ``pcolormesh``.

    Returns
    -------
    matplotlib.axes.Axes
    """
    ax = new_axes(figsize=(6, 5) if polar else (9, 3)) if ax is None else ax
    [angle] = [name for name in cells.dims if name != "radius"]
    cells = cells.transpose("radius", angle)
    angles, radii = np.meshgrid(edges(cells[angle].values), edges(cells["radius"].values) * 1e3)
    if polar:
        places = (radii * np.cos(angles), radii * np.sin(angles))
    else:
        places = (angles * radii.mean(), radii)
    if names:
        from matplotlib.colors import ListedColormap

        colours = ListedColormap(STATUS_COLOURS[: max(names) + 1])
        options = {"cmap": colours, "vmin": -0.5, "vmax": max(names) + 0.5} | options
    values, unit = in_drawn_unit(cells)
    picture = ax.pcolormesh(*places, values, rasterized=True, **options)
    bar = ax.figure.colorbar(picture, ax=ax, label=unit)
    if names:
        bar.set_ticks(list(names), labels=list(names.values()))
    labels = ("x, mm", "y, mm") if polar else ("arc length, mm", "radius, mm")
    moment = f", {float(cells['map_time']):.6g} s" if "map_time" in cells.coords else ""
    ax.set(xlabel=labels[0], ylabel=labels[1], title=str(cells.attrs.get("long_name", cells.name)) + moment)
    if polar:
        ax.set_aspect("equal")
    return ax


def edges(centres: Any) -> Any:
    """Edges of cells.

    Parameters
    ----------
    centres : array, shape (n,)
        Their centres, at equal distances.

    Returns
    -------
    array, shape (n + 1,)
        Of a single cell, of which the width is not known, a hundredth around it.

    Examples
    --------
    >>> edges(np.array([1.0, 3.0, 5.0])).tolist()
    [0.0, 2.0, 4.0, 6.0]
    """
    width = centres[1] - centres[0] if len(centres) > 1 else abs(centres[0]) / 100
    return np.append(centres - width / 2, centres[-1] + width / 2)
