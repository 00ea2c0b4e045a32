"""What the maps of a run say."""

import measures
import numpy as np
import xarray
from pin import THICK, of_the_pin

# Build-up from which a cell of the disc counts as covered by more than a film, m.
THICK_ON_THE_DISC = 0.5e-6
# How near to the highest of the start counts as filled, m.
NEAR = 0.1e-6
# Time before the end of which the pin's maps are averaged, s: five cycles of the resin.
LATE = 56.0
BANDS = 16


def maps_at(run: xarray.DataTree, moment: float) -> xarray.DataTree:
    """A run with the maps of a moment, s, alone; an error where none were recorded within a second of it."""
    return run.sel(map_time=moment, method="nearest", tolerance=1.0)


def at_the_end(run: xarray.DataTree, end: float) -> dict[str, float]:
    """Build-up and roughness of the pin, means of the maps near the end."""
    times, base, radius = (run[name].values for name in ("map_time", "pin/base", "radius"))
    late = run.isel(map_time=np.flatnonzero((times > end - LATE) & (times < end + 1)))
    fields = (late["pin/height"], late.plateau.build_up("pin"), late["pin/pressure"])
    maps = zip(*(field.values for field in fields), strict=True)
    found = [of_the_pin(height, film, base, pressure, radius) for height, film, pressure in maps]
    return {key: float(np.mean([one[key] for one in found])) for key in found[0]} | {"maps": float(len(found))}


def of_the_disc(run: xarray.DataTree, moment: float) -> dict[str, float]:
    """Filling and build-up of the disc. What it lies on is the initial surface: the coating does not wear."""
    initial, height = run["disc/height"][0].load(), maps_at(run, moment)["disc/height"].load()
    build_up, depth = height - initial, initial.max() - initial
    before, now, radius = initial.values, height.values, run["radius"].values
    profile = measures.radial_filling(before, now, radius, BANDS)
    return {
        "filled": measures.filled_volume(before, now, radius),
        "filled_area": measures.filled_area(before, now, radius, NEAR),
        "covered_disc": float((build_up >= THICK_ON_THE_DISC).plateau.area_mean()),
        "initial_depth": float(depth.plateau.area_mean()),
        "mean_build_up": float(build_up.plateau.area_mean()),
        "highest": float(now.max() - before.max()),
        "inner_over_outer": float(profile[: BANDS // 2].mean() - profile[BANDS // 2 :].mean()),
        # Where the deepest fifth of the area was.
        "open_where_deepest": measures.open_where_deepest(before, now, radius, 0.2),
        **{f"band_{band}": float(filled) for band, filled in enumerate(profile)},
    }


def sizes(run: xarray.DataTree, moment: float) -> dict[str, dict]:
    """Diameters of plateaus that hold 10, 50 and 90 % of their area, and how many there are."""
    initial, radius = run["disc/height"][0].values, run["radius"].values
    then = maps_at(run, moment)
    height, film, pressure = (then["disc/height"].values, then.plateau.build_up("pin").values, then["pin/pressure"].values)
    reference = initial.max()
    cell = radius.mean() * 2 * np.pi / height.shape[0] * np.diff(radius).mean()
    pieces = {
        "pin_contact": measures.plateau_sizes(pressure > 0, False),
        "pin_plateaus": measures.plateau_sizes((film > 0) | (run["pin/base"].values == 1), False),
        "pin_thick": measures.plateau_sizes(film >= THICK, False),
        "disc_secondary": measures.plateau_sizes(height > initial, True),
        "disc_lowlands_filled": measures.plateau_sizes((initial < reference) & (height >= reference - NEAR), True),
        "disc_holes": measures.plateau_sizes(height < reference - 1e-6, True),
    }
    return {name: {"count": len(cells)} | (measures.diameters(cells * cell, [10, 50, 90]) if len(cells) else {}) for name, cells in pieces.items()}


def open_depth(run: xarray.DataTree, moment: float) -> np.ndarray:
    """How far every cell of the disc still is below the highest of the start, m."""
    return (run["disc/height"][0].max() - maps_at(run, moment)["disc/height"]).clip(0).values
