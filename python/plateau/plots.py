"""Quick figures of series and maps. matplotlib is imported only when something is drawn."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray

from plateau.errors import MissingPackageError
from plateau.looks import APART, Look, colours, in_drawn_unit, look_of
from plateau.run_file import array

# Approximate length of a window of an unrolled ring divided by its height, and the largest number of windows.
ELONGATION = 8.6
MOST_WINDOWS = 6
# In inches: the smallest height of a map without stretching; the distance between numbers of an axis.
LEAST_HEIGHT = 0.3
BETWEEN_NUMBERS = 0.3


def new_axes(**options: Any) -> Any:
    """Axes of a new figure, an array of them with ``nrows`` or ``ncols``.

    Parameters
    ----------
    **options
        Options of ``matplotlib.pyplot.subplots``.

    Returns
    -------
    matplotlib.axes.Axes
    """
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise MissingPackageError("figures need matplotlib: pip install 'plateau-brake[plot]', or pip install matplotlib") from error
    return plt.subplots(layout="constrained", **options)[1]


def draw_series(run: xarray.DataTree, series: Sequence[str], *, ax: Any = None) -> Any:
    """Draws series of a run against time.

    Parameters
    ----------
    run : xarray.DataTree
        A run, opened by `plateau.open_run`.
    series : sequence of str
        Names; the contact area if there are none.
    ax : matplotlib.axes.Axes, optional
        The axes to draw in; by default new axes.

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
            ax.plot(time, while_rubbing(run, values) if name.endswith("_mean") else values, label=drawn.attrs.get("long_name", name))
        label = series[0].replace("_", " ") if len(series) == 1 else ""
        ax.set_ylabel(", ".join(filter(None, [label, unit])))
    else:
        single, unit = in_drawn_unit(array(run, "series/contact_area"))
        ax.plot(time, while_rubbing(run, single), ".", color="0.7", markersize=2, label="single steps")
        mean = while_rubbing(run, in_drawn_unit(array(run, "series/contact_area_mean"))[0])
        ax.plot(time, mean, label="mean of a simulated revolution")
        ax.set(ylabel=f"contact area, {unit}", ylim=(0, None))
    ax.set(xlabel="time, s", title=run.attrs.get("title", ""))
    ax.legend(markerscale=4)
    return ax


def while_rubbing(run: xarray.DataTree, values: Any) -> Any:
    """Values of a contact, NaN while the pin is lifted or the disc stands still, because revolution means are then older.

    Parameters
    ----------
    run : xarray.DataTree
        A run, opened by `plateau.open_run`.
    values : array, shape (samples,)
        One for every sample.

    Returns
    -------
    array, shape (samples,)
    """
    # Runs without a cycle have neither, and no pauses.
    varied = [name for name in ("normal_force", "rotational_speed") if name in run["series"]]
    rubs = np.all([array(run, f"series/{name}").values != 0 for name in varied], axis=0) if varied else True
    return np.where(rubs, values, np.nan)


def draw_map(cells: xarray.DataArray, names: dict[int, str], *, polar: bool = False, ax: Any = None, **options: Any) -> Any:
    """Draws a map at one moment, with the colours and scales of the figures of the program, in true proportions.

    Parameters
    ----------
    cells : xarray.DataArray
        With two dimensions: an angle, rad, and ``radius``, m.
    names : dict
        Statuses and their names; empty for other maps.
    polar : bool
        In the plane of the disc; otherwise unrolled, over arc length at the mean radius.
    ax : matplotlib.axes.Axes, optional
        The axes to draw in; by default new axes, for a long ring several below each other.
    **options
        Options of ``pcolormesh``.

    Returns
    -------
    matplotlib.axes.Axes
        The lowest of the axes.
    """
    [angle] = [name for name in cells.dims if name != "radius"]
    cells = cells.transpose("radius", angle)
    angles, radii = np.meshgrid(edges(cells[angle].values), edges(cells["radius"].values) * 1e3)
    x, y = (radii * np.cos(angles), radii * np.sin(angles)) if polar else (angles * radii.mean(), radii)
    panels = panels_for(x, y, polar) if ax is None else [ax]
    look = look_of(cells, names)
    chosen = options_of(look, options)
    # The first column of each window, and the end of the last one.
    ends = np.linspace(0, x.shape[1] - 1, len(panels) + 1).astype(int)
    for panel, begin, end in zip(panels, ends[:-1], ends[1:], strict=True):
        part = np.s_[:, begin : end + 1]
        picture = panel.pcolormesh(x[part], y[part], look.values[:, begin:end], rasterized=True, **chosen)
        stretched = fit(panel, polar)
    last = panels[-1]
    bar = last.figure.colorbar(picture, ax=panels, label=look.label, extend="neither" if names else look.extend)
    if names:
        bar.set_ticks(list(names), labels=list(names.values()))
    # The direction of the disc, toward higher columns (model 1), is named as in the figures of the program.
    across = "x, mm; the disc turns against the clock" if polar else "arc length, mm; the disc moves \N{RIGHTWARDS ARROW}"
    moment = f", {float(cells['map_time']):.6g} s" if "map_time" in cells.coords else ""
    grey = f"; grey: {look.apart}" if look.apart else ""
    last.set_xlabel(across.replace(";", " (stretched);") if stretched else across)
    panels[len(panels) // 2].set_ylabel("y, mm" if polar else "radius, mm")
    panels[0].set_title((look.title or str(cells.attrs.get("long_name", cells.name))) + moment + grey)
    return last


def panels_for(x: Any, y: Any, polar: bool) -> list[Any]:
    """New axes for a map with these corners of cells, mm: for an unrolled ring several, as in the figures of the program.

    Parameters
    ----------
    x, y : array
        The corners.
    polar : bool
        Whether it is drawn in the plane of the disc.

    Returns
    -------
    list of matplotlib.axes.Axes
        From the top.
    """
    if polar:
        return [new_axes(figsize=(6, 5))]
    elongation = float(np.ptp(x) / np.ptp(y))
    windows = min(max(round(elongation / ELONGATION), 1), MOST_WINDOWS, x.shape[1] - 1)
    # Seven inches for the map, and half an inch above each window for numbers.
    height = 0.8 + windows * (0.5 + min(7 * windows / elongation, 5))
    return list(np.atleast_1d(new_axes(figsize=(9, height), nrows=windows)))


def fit(panel: Any, polar: bool) -> bool:
    """Gives a map true proportions, or stretches it if it would be too low to see; numbers of the radius do not overlap.

    Parameters
    ----------
    panel : matplotlib.axes.Axes
        With the map in it.
    polar : bool
        Whether it is drawn in the plane of the disc.

    Returns
    -------
    bool
        Whether it is stretched.
    """
    from matplotlib.ticker import MaxNLocator

    box = panel.get_position(original=True)
    # Also for a part of a figure.
    whole = panel.figure.bbox.size / panel.figure.dpi
    width, room = box.width * whole[0], box.height * whole[1]
    height = min(width * np.ptp(panel.get_ylim()) / np.ptp(panel.get_xlim()), room)
    stretched = not polar and height < min(LEAST_HEIGHT, room)
    panel.set_aspect("auto" if stretched else "equal")
    if not polar:
        numbers = int((room if stretched else height) / BETWEEN_NUMBERS)
        if numbers > 2:
            panel.yaxis.set_major_locator(MaxNLocator(min(numbers, 5)))
        else:
            panel.set_yticks(panel.get_ylim(), labels=[f"{radius:.4g}" for radius in panel.get_ylim()])
    return bool(stretched)


def options_of(look: Look, options: dict[str, Any]) -> dict[str, Any]:
    """Options of ``pcolormesh``: those of a look, changed by those of the user.

    Parameters
    ----------
    look : Look
        How the map is drawn.
    options : dict
        The options of the user.

    Returns
    -------
    dict
    """
    chosen = dict(look.options)
    if "norm" in options:
        chosen.pop("vmin", None)
        chosen.pop("vmax", None)
    elif "vmin" in options or "vmax" in options:
        chosen.pop("norm", None)
    chosen |= options
    if isinstance(chosen["cmap"], str):
        chosen["cmap"] = colours(chosen["cmap"], APART if look.apart else None)
    return chosen


def edges(centres: Any) -> Any:
    """Edges of cells.

    Parameters
    ----------
    centres : array, shape (n,)
        Their centres, at equal distances.

    Returns
    -------
    array, shape (n + 1,)
        For a single cell, whose width is not known, a hundredth around it.

    Examples
    --------
    >>> edges(np.array([1.0, 3.0, 5.0])).tolist()
    [0.0, 2.0, 4.0, 6.0]
    """
    width = centres[1] - centres[0] if len(centres) > 1 else abs(centres[0]) / 100
    return np.append(centres - width / 2, centres[-1] + width / 2)
