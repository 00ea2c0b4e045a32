"""What the series of a run say up to a time."""

from collections.abc import Iterator
from functools import cache
from pathlib import Path

import measures
import numpy as np
import xarray
from discs import SCENES

import plateau

# Times of the paper's results and, for the baseline, of the end of the real test, s.
END, LONG_END = 3000.0, 7200.0
# Length of the means that run-in and drift are taken of, s: several cycles of the resin.
WINDOW = 50.0
# Time at the end over which samples are averaged: pressure and coverage vary with the cycle of the resin and the place on
# the ring.
LAST = 300.0
AVERAGED = ("pressure_variation", "pressure_gini", "mean_pressure", "pin_sq", "disc_sq", "pin_secondary")
AT_THE_END = ("disc_secondary", "worn_pin", "worn_resin", "worn_disc")


@cache
def opened(path: Path) -> xarray.DataTree:
    """A run, also one that goes on. Opening takes longer than reading, so that it is done once for each."""
    return plateau.open_run(path)


def reached(path: Path) -> float:
    """The time that a run came to; 0 where there is none."""
    return float(opened(path)["time"][-1]) if path.exists() else 0.0


def run_of(runs: Path, heights: str) -> Path:
    """The run of a disc that came to the end of the paper's: that of its scene, or else that with the acceleration of the sets."""
    path = runs / f"{SCENES[heights]}.h5"
    return path if reached(path) >= END else runs / f"quick-{heights}.h5"


def series_of(run: xarray.DataTree) -> dict[str, np.ndarray]:
    """All series of a run as far as it came, and their time."""
    table = run.plateau.series
    return {name: table[name].to_numpy() for name in table} | {"time": table.index.to_numpy()}


def finished_runs(data: xarray.Dataset) -> Iterator[tuple[xarray.Dataset, dict[str, np.ndarray]]]:
    """Every finished run of a collected study with all its series and their time, sets of surfaces in their order."""
    series = [name for name, values in data.data_vars.items() if values.ndim == 2 and name != "sample_time"]
    finished = data.isel(run=np.flatnonzero(data["state"] == "finished"))
    finished = finished.sortby("replicate") if "replicate" in finished else finished
    for number in range(finished.sizes["run"]):
        run = finished.isel(run=number)
        time = run["time" if "time" in run else "sample_time"].values
        there = np.isfinite(time)
        yield run, {key: run[key].values[there] for key in series} | {"time": time[there]}


def at(time: np.ndarray, values: np.ndarray, moment: float) -> float:
    """Value of a series at a moment, linear between samples."""
    return float(np.interp(moment, time, values))


def window_means(time: np.ndarray, integral: np.ndarray, end: float, width: float = WINDOW):
    """Middles of windows up to the end, and the means in them, from the integral, which knows every step."""
    edges = np.arange(0.0, end + width / 2, width)
    values = np.diff(np.interp(edges, np.r_[0.0, time], np.r_[0.0, integral])) / width
    return edges[:-1] + width / 2, values


def history(series: dict[str, np.ndarray], end: float = END, load: float = 0.0) -> dict[str, float]:
    """The numbers of a run; with `load`, the product of wear rate and load, m3/m, what the books of wear leave."""
    time = series["time"]
    middles, area = window_means(time, series["contact_area_integral"], end)
    third = middles > end * 2 / 3
    drift = measures.drift(middles[third], area[third])
    last = (time > end - LAST) & (time <= end * (1 + 1e-6))
    found = {
        "filled": at(time, series["filled_fraction"], end),
        "contact_area": measures.mean_of_last(area, 2),
        # Over the last tenth.
        "contact_area_mean": float(area[middles > 0.9 * end].mean()),
        "run_in": measures.run_in(middles, area, 0.9),
        "change_point": measures.change_point(middles, area),
        # Relative to the mean, per 1000 s; with the half width of its 95 % interval.
        "drift": drift[0] * 1000,
        "drift_error": drift[1] * 1000,
        **{key: float(series[key][last].mean()) for key in AVERAGED if key in series},
        **{key: at(time, series[key], end) for key in AT_THE_END if key in series},
    }
    worn = sum(at(time, series[key], end) for key in ("worn_pin", "worn_resin", "worn_disc") if key in series)
    deposited = sum(at(time, series[key], end) for key in ("deposited_pin", "deposited_disc"))
    found["deposited_over_worn"] = deposited / worn
    if load > 0:
        # Worn off the pin's plateaus over what load, distance and wear rate say, less one.
        found["bookkeeping"] = found["worn_pin"] / (load * at(time, series["sliding_distance"], end)) - 1
        found |= {key: float(np.abs(series[key]).max()) for key in ("balance_residual", "load_residual")}
    return found
