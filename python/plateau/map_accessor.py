"""Accessor of maps: ``run["disc/height"].plateau``."""

from typing import Any

import numpy as np
import xarray

from plateau.errors import InputError, UnknownNameError
from plateau.figures import maps
from plateau.figures.drawing import moment
from plateau.quantities import ABSENT, MAPS, Map
from plateau.style import STATUS_COLOURS, WIDE, in_style
from plateau.units import quantity, unit_of

ANGLES = ("disc_angle", "pin_angle")


class MapAccessor:
    """Maps of disc and pin: cells with the dimensions ``disc_angle`` or ``pin_angle`` (rad) and ``radius`` (m).

    Cells at a larger radius are larger, so every mean here is weighted with the area of the cells.

    Examples
    --------
    >>> import plateau
    >>> run = plateau.open_run("quick.h5")
    >>> height = run["disc/height"]
    >>> height.plateau.area_mean().dims
    ('map_time',)
    """

    def __init__(self, cells: xarray.DataArray) -> None:
        self._cells = cells

    @property
    def _angle(self) -> str:
        for name in ANGLES:
            if name in self._cells.dims and "radius" in self._cells.coords:
                return name
        if self._cells.dims == ("time",) and self._cells.name is not None:
            name = str(self._cells.name)
            raise InputError(f"{name} is a series, and this is for maps; draw a series with run.plateau.plot({name!r})")
        raise InputError(f"dimensions {self._cells.dims}: this is not a map; expected disc_angle or pin_angle, and radius")

    def area_mean(self) -> xarray.DataArray:
        """Mean over all cells, weighted with their areas; cells outside a round pin are left out.

        Returns
        -------
        xarray.DataArray
            In the unit of the map; the dimensions of the map without angle and radius.
        """
        if self.status_names:
            raise InputError("this is a map of statuses, whose numbers have no mean: area_fraction(name) gives the part of the area with one")
        over = [self._angle, "radius"]
        return self._cells.weighted(self._cells["radius"]).mean(over, keep_attrs=True)

    @property
    def status_names(self) -> dict[int, str]:
        """Statuses and their names; empty for other maps.

        Examples
        --------
        >>> import plateau
        >>> plateau.open_run("quick.h5")["disc/status"].plateau.status_names
        {0: 'none', 1: 'primary', 2: 'secondary'}
        """
        names = str(self._cells.attrs.get("flag_meanings", "")).split()
        return {int(value): name for value, name in zip(self._cells.attrs.get("flag_values", ()), names, strict=True)}

    def has_status(self, name: str) -> xarray.DataArray:
        """The cells that have a status.

        Parameters
        ----------
        name : str
            ``"none"``, ``"primary"`` or ``"secondary"``.

        Returns
        -------
        xarray.DataArray of bool
            With the shape of the map.
        """
        values = [value for value, known in self.status_names.items() if known == name]
        if not values:
            known = ", ".join(self.status_names.values())
            raise UnknownNameError(f"no status is called {name!r}, " + (f"there are: {known}" if known else "this is no map of statuses"))
        return self._cells == values[0]

    def area_fraction(self, name: str) -> xarray.DataArray:
        """Area of the cells with a status, divided by the area of all cells of the body.

        Parameters
        ----------
        name : str
            ``"none"``, ``"primary"`` or ``"secondary"``. Their fractions add up to 1, also for a round pin. ``"absent"`` is refused,
            because such cells are not part of the pin.

        Returns
        -------
        xarray.DataArray
            Between 0 and 1; the dimensions of the map without angle and radius.

        Examples
        --------
        >>> import plateau
        >>> run = plateau.open_run("quick.h5")
        >>> counted = run["disc/status"].plateau.area_fraction("secondary")[-1]
        >>> bool(abs(counted - run["series/disc_secondary"][-1]) < 1e-9)
        True
        """
        if name == self.status_names.get(ABSENT):
            raise InputError(f"{name} cells are no part of the pin's area: ask for none, primary or secondary, or has_status({name!r})")
        area, over = self._cells["radius"], [self._angle, "radius"]
        there = (self._cells != ABSENT) * area
        return (self.has_status(name) * area).sum(over) / there.sum(over)

    def unrolled(self) -> xarray.DataArray:
        """The map with the arc length at the mean radius instead of the angle.

        Returns
        -------
        xarray.DataArray
            With the dimension ``arc_length``, m, instead of the angle.
        """
        radius = float(self._cells["radius"].mean())
        attributes = {"units": "m", "long_name": "arc length at the mean radius"}
        arc = self._cells[self._angle].copy(data=self._cells[self._angle].values * radius)
        arc.attrs = attributes
        return self._cells.assign_coords(arc_length=arc).swap_dims({self._angle: "arc_length"})

    def cartesian(self) -> xarray.DataArray:
        """The map with Cartesian coordinates in the plane of the disc, beside its polar coordinates.

        Returns
        -------
        xarray.DataArray
            With the coordinates ``x`` and ``y``, m, of every cell, from the axis of the disc.
        """
        angle, radius = self._cells[self._angle], self._cells["radius"]
        places = {"x": radius * np.cos(angle), "y": radius * np.sin(angle)}
        named = {name: place.assign_attrs(units="m", long_name=name) for name, place in places.items()}
        return self._cells.assign_coords(named)

    def at_time(self, time: float | str | None = None) -> xarray.DataArray:
        """The map with the recorded time nearest to a given time.

        Parameters
        ----------
        time : float or str, optional
            Time, s, or text with a unit such as ``"1 min"``; by default that of the last map.

        Returns
        -------
        xarray.DataArray
            Without the dimension ``map_time``; a map without this dimension is returned unchanged.
        """
        if "map_time" not in self._cells.dims:
            return self._cells
        if self._cells.sizes["map_time"] == 0:
            raise InputError("no map has been recorded yet: open the run again when it has gone on")
        if time is None:
            return self._cells.isel(map_time=-1)
        return self._cells.sel(map_time=quantity(time, "s"), method="nearest")

    @in_style
    def plot(self, time: float | str | None = None, *, polar: bool = False, ax: Any = None, **options: Any) -> Any:
        """Draws the map, unrolled or as a ring, with the colours of the program's figures; needs matplotlib.

        Heights of the pin are drawn positive toward the disc, relative to their mean.

        Parameters
        ----------
        time : float or str, optional
            See `at_time`.
        polar : bool
            Draw a ring in the plane of the disc.
        ax : matplotlib.axes.Axes, optional
            The axes to draw in; by default new axes, for an unrolled ring several below each other.
        **options
            Options of ``imshow``, or of ``pcolormesh`` for a ring and a round pin, such as ``cmap``, ``vmin`` and ``norm``.

        Returns
        -------
        matplotlib.axes.Axes
            The lowest of them.

        Examples
        --------
        >>> import plateau
        >>> axes = plateau.open_run("quick.h5")["disc/height"].plateau.plot()
        >>> axes.get_xlabel()
        'arc length at the mean radius, mm; the disc moves →'
        """
        cells = self.at_time(time)
        if set(cells.dims) != {self._angle, "radius"}:
            raise InputError(f"dimensions {cells.dims}: expected a map at one moment, with an angle and the radius")
        names, body = self.status_names, self._angle.removesuffix("_angle")
        long_name, unit = str(cells.attrs.get("long_name", cells.name)), str(cells.attrs.get("units", "1"))
        path = f"{body}/{'thickness' if 'thickness' in long_name else cells.name}"
        other = Map(path, long_name, str(cells.name or ""), unit_of(unit, cells.values), "statuses" if names else "span")
        shown = MAPS.get(path, other)
        title = shown.title + (f", {moment(float(cells['map_time']))}" if "map_time" in cells.coords else "")
        cells = cells.transpose("radius", self._angle)
        picture = maps.picture_of(cells.copy(data=shown.shown(cells.values)), polar, title)
        maps.colour(shown, [picture], options.pop("cmap") if isinstance(options.get("cmap"), str) else "viridis")
        # What is asked for holds.
        norm = picture.colours["norm"]
        norm.vmin, norm.vmax = options.pop("vmin", norm.vmin), options.pop("vmax", norm.vmax)
        picture.colours |= options
        legend = [(STATUS_COLOURS[value], name) for value, name in names.items() if value != ABSENT]
        if ax is not None:
            maps.in_axes(ax, picture, legend)
            return ax
        import matplotlib.pyplot as plt

        [figure] = maps.pages([[picture]], WIDE, title, legend, plt.figure)
        return figure.axes[-1 if legend else -2]
