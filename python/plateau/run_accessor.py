"""Accessor of runs: ``run.plateau``."""

import functools
import tomllib
from collections.abc import Callable
from typing import Any

import numpy as np
import pandas
import xarray

from plateau.errors import InputError, UnknownNameError
from plateau.figures import FIGURES, plot
from plateau.figures.drawing import subjects_of
from plateau.map_accessor import MapAccessor
from plateau.means import Array, Mean, last_tenth, mean_between
from plateau.quantities import series_of
from plateau.run_file import array
from plateau.style import NARROW, in_style, labelled, new
from plateau.units import quantity

# Series that are totals since the start of a run (docs/run-file.md).
TOTALS = frozenset(
    "contact_area_integral sliding_distance contact_time road_distance worn_pin worn_resin worn_whole_pin lost_pin worn_disc emitted "
    "deposited_pin deposited_disc returned friction_work heat_lost emitted_mass pm10_mass pm25_mass particle_number "
    "pad_wear brake_emitted_mass brake_pm10_mass brake_pm25_mass brake_particle_number".split()
)


class RunPlot:
    """Draws a run: called, series; and each figure of docs/figures.md by its name, such as ``run.plateau.plot.contact_area()``.

    The figures have the options of `plateau.plot`.
    """

    def __init__(self, run: xarray.DataTree) -> None:
        self._run = run

    @in_style
    def __call__(self, *series: str, ax: Any = None) -> Any:
        """Draws series against time.

        Parameters
        ----------
        *series : str
            Names of series with equal units; by default the contact area of single steps and of the last revolution.
        ax : matplotlib.axes.Axes, optional
            The axes to draw in; by default new axes.

        Returns
        -------
        matplotlib.axes.Axes
        """
        [subject] = subjects_of([self._run])
        known = {name: array(self._run, f"series/{name}") for name in series or ("contact_area", "contact_area_mean")}
        if len({str(values.attrs.get("units", "1")) for values in known.values()}) > 1:
            raise InputError(f"{', '.join(known)} have different units: draw them one by one")
        first, *others = known
        unit = series_of(first, str(known[first].attrs.get("units", "1")), known[first].values).unit
        ax = new(NARROW, 60, f"{first} of {subject.label}")[1][0, 0] if ax is None else ax
        for name, values in known.items():
            shown, label = unit.value(subject.values(name)), values.attrs.get("long_name", name)
            look = {} if series or name != first else {"color": "0.7", "marker": ".", "markersize": 2, "linestyle": ""}
            ax.plot(subject.time, subject.while_rubbing(shown) if name.endswith("_mean") or not series else shown, label=label, **look)
        title = first.replace("_", " ") if len(series) < 2 else ""
        ax.set(xlabel="time, s", ylabel=labelled(title, unit.symbol), title=subject.label)
        if others:
            ax.legend()
        return ax

    def __getattr__(self, name: str) -> Callable[..., Any]:
        if name not in dir(self):
            raise AttributeError(f"no figure is called {name!r}, there are: {', '.join(_figures())}")
        return functools.partial(plot, self._run, name.replace("_", "-"))

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *_figures()]


def _figures() -> list[str]:
    return [name.replace("-", "_") for name in FIGURES]


class RunAccessor:
    """A run, opened by `plateau.open_run`.

    Examples
    --------
    >>> import plateau
    >>> run = plateau.open_run("quick.h5")
    >>> run.plateau.scene["operation"]["normal_force"]
    '5 N'
    """

    def __init__(self, run: xarray.DataTree) -> None:
        if "series" not in run.children:
            raise InputError("this tree is not a run: expected the tree that plateau.open_run gives, with the group series")
        self._run = run

    @property
    def scene(self) -> dict[str, Any]:
        """The resolved scene, every key with its value."""
        return tomllib.loads(self._run.attrs["scene"])

    @property
    def series(self) -> pandas.DataFrame:
        """All series, a column for each in SI units; the index is the time, s."""
        # Not with the coordinates of maps: the table would have a row for each of their combinations.
        series = self._run.children["series"].to_dataset(inherit=False)
        columns = {name: values.values for name, values in series.data_vars.items()}
        return pandas.DataFrame(columns, index=pandas.Index(self._values("time"), name="time"))

    @property
    def events(self) -> pandas.DataFrame:
        """A row for each event of the cycle that has ended, SI units; no row for a run without a cycle."""
        if "event" not in self._run.children:
            return pandas.DataFrame()
        events = self._run.children["event"].to_dataset(inherit=False)
        return pandas.DataFrame({name: values.values for name, values in events.data_vars.items()})

    def mean(self, series: str = "contact_area", start: float | str | None = None, end: float | str | None = None) -> Mean:
        """Mean of a series over a part of the run, with its standard error.

        The mean of the contact area is calculated from its integral, which includes every step, over the time in contact. It is the number
        that ``plateau run`` prints. In other series, a sample represents the time since the previous sample; where a sample has no value,
        as a temperature of a lifted pin, this time is left out. `plateau.means.mean_between` describes the standard error. It takes into
        account that neighbouring values are correlated.

        Parameters
        ----------
        series : str
            Name of a series.
        start, end : float or str, optional
            Ends of the part, s, or text such as ``"5 min"``; by default the last tenth of the run, at least ten simulated revolutions.

        Returns
        -------
        Mean
            Value and error in the unit of the series. Where the contact area pulses, and what follows it, the error is too small if the
            part has fewer than three pulses; ``plateau check`` tells their time.

        Raises
        ------
        InputError
            If the run has no such series (`UnknownNameError`), the times are no part of the run, or the series is a total since its start,
            such as ``worn_pin``; `rate` tells how fast that grows.

        Examples
        --------
        >>> import plateau
        >>> filled = plateau.open_run("quick.h5").plateau.mean("filled_fraction")
        >>> bool(0 < filled.error < filled.value < 1)
        True
        >>> plateau.open_run("quick.h5").plateau.mean("filled_fraction", "30 s", "1 min").start
        30.0
        >>> str(plateau.open_run("quick.h5").plateau.mean("contact_area")).endswith(" m2 from 45.8005 to 60 s")
        True
        """
        time = self._sample_times()
        if series in TOTALS and series in self._run["series"]:
            raise InputError(
                f"{series} is a total since the start of the run, and its mean says nothing: "
                f"rate({series!r}) is how fast it grows, series[{series!r}].iloc[-1] how much it is at the end"
            )
        if f"{series}_integral" in self._run["series"]:
            # With a cycle, the contact area is that of the time in contact: while the pin is lifted there is none.
            known = self._values("series/contact_time") if "contact_time" in self._run["series"] else None
            found = self._mean_of(time, self._values(f"series/{series}_integral"), start, end, known)
        else:
            values, steps = self._values(f"series/{series}"), np.diff(time, prepend=0.0)
            there = np.isfinite(values)
            integral, known = np.cumsum(np.where(there, values, 0.0) * steps), np.cumsum(there * steps)
            found = self._mean_of(time, integral, start, end, None if there.all() else known)
        return found._replace(unit=self._unit(series))

    def rate(self, series: str, start: float | str | None = None, end: float | str | None = None) -> Mean:
        """Mean growth rate of a total over a part of the run, with its standard error.

        Parameters
        ----------
        series : str
            A series that is a total since the start of the run: ``worn_pin``, ``worn_resin``, ``worn_whole_pin``, ``lost_pin``, ``worn_disc``,
            ``emitted``, ``sliding_distance``, ``friction_work``, ``pm10_mass``, ...
        start, end : float or str, optional
            See `mean`.

        Returns
        -------
        Mean
            Value and error in the unit of the series per second.

        Raises
        ------
        InputError
            If the run has no such series (`UnknownNameError`), it is no total, or the times are no part of the run.

        Examples
        --------
        >>> import plateau
        >>> wear = plateau.open_run("quick.h5").plateau.rate("worn_pin")
        >>> bool(0 < wear.error < wear.value)
        True
        """
        values = self._values(f"series/{series}")
        if series not in TOTALS:
            raise InputError(f"{series} is no total since the start of the run: take mean({series!r})")
        unit = self._unit(series)
        found = self._mean_of(self._sample_times(), values, start, end)
        per_second = unit.removesuffix(" s") if unit.endswith(" s") else f"{unit} s-1"
        return found._replace(unit=per_second.removeprefix("1 "))

    def _mean_of(self, time: Array, integral: Array, start: float | str | None, end: float | str | None, known_time: Array | None = None) -> Mean:
        revolutions = self._revolutions()
        first, last = last_tenth(time, revolutions)
        begin, stop = (quantity(default if given is None else given, "s") for given, default in ((start, first), (end, last)))
        return mean_between(time, integral, revolutions, begin, stop, known_time)

    def _unit(self, series: str) -> str:
        return str(array(self._run, f"series/{series}").attrs.get("units", "1"))

    def build_up(self, body: str) -> xarray.DataArray:
        """Thickness of the build-up on every cell: the distance of the height from the substrate, away from the body.

        Parameters
        ----------
        body : {"disc", "pin"}

        Returns
        -------
        xarray.DataArray
            Thickness, m, with the dimensions of the map of heights.

        Raises
        ------
        UnknownNameError
            If there is no such body, or the run does not have its maps of height and substrate.

        Examples
        --------
        >>> import plateau
        >>> run = plateau.open_run("quick.h5")
        >>> bool((run.plateau.build_up("pin") >= 0).all())
        True
        """
        if body not in ("disc", "pin"):
            raise UnknownNameError(f"no body is called {body!r}, there are: disc, pin")
        for name in ("height", "substrate"):
            if body not in self._run.children or name not in self._run[body]:
                raise UnknownNameError(f"the run has no map {body}/{name}: name {body}_{name} in output.maps of the scene")
        height, substrate = array(self._run, f"{body}/height"), array(self._run, f"{body}/substrate")
        # The z of the pin increases away from the disc, into the body of the pin.
        thickness = height - substrate if body == "disc" else substrate - height
        return thickness.assign_attrs(units="m", long_name=f"thickness of the build-up on the {body}")

    def coverage(self) -> xarray.Dataset:
        """Area fractions of plateaus at every recorded map.

        Returns
        -------
        xarray.Dataset
            ``disc_secondary``, ``pin_primary``, ``pin_secondary`` with the dimension ``map_time``, if the maps exist.

        Examples
        --------
        >>> import plateau
        >>> sorted(plateau.open_run("quick.h5").plateau.coverage())
        ['disc_secondary', 'pin_primary', 'pin_secondary']
        """
        wanted = [("disc", "secondary"), ("pin", "primary"), ("pin", "secondary")]
        return xarray.Dataset(
            {
                f"{body}_{status}": MapAccessor(array(self._run, f"{body}/status")).area_fraction(status)
                for body, status in wanted
                if body in self._run.children and "status" in self._run[body]
            }
        )

    @property
    def plot(self) -> "RunPlot":
        """Draws series, or figures: see `RunPlot`.

        Examples
        --------
        >>> import plateau
        >>> run = plateau.open_run("quick.h5")
        >>> run.plateau.plot("filled_fraction").get_ylabel()
        'filled fraction, %'
        >>> run.plateau.plot.contact_area().axes[0].get_ylabel()
        'contact area, mm²'
        """
        return RunPlot(self._run)

    def _values(self, name: str) -> Array:
        return np.asarray(array(self._run, name).values, dtype=np.float64)

    def _sample_times(self) -> Array:
        """Times of the samples; there must be at least one."""
        time = self._values("time")
        if time.size == 0:
            raise InputError("the run has no sample yet, so there is no mean: open it again when it has gone on")
        return time

    def _revolutions(self) -> Array | None:
        """Simulated revolutions until every sample; one stands for as many revolutions as the time acceleration."""
        series = self._run["series"]
        if "sliding_distance" not in series:
            return None
        if "time_acceleration" in series:
            acceleration: Any = self._values("series/time_acceleration")
        else:
            given = self.scene.get("numerics", {}).get("time_acceleration", 1.0)
            acceleration = float(given) if isinstance(given, int | float) else 1.0
        way = 2 * np.pi * float(self._values("radius").mean())
        return np.cumsum(np.diff(self._values("series/sliding_distance"), prepend=0.0) / (way * acceleration))
