"""What the maps of a run say."""

import h5py
import measures
import numpy as np
from pin import THICK, of_the_pin

# Build-up from which a cell of the disc counts as covered by more than a film, m.
THICK_ON_THE_DISC = 0.5e-6
# How near to the highest of the start counts as filled, m.
NEAR = 0.1e-6
# Time before the end of which the pin's maps are averaged, s: five cycles of the resin.
LATE = 56.0
BANDS = 16


def at_the_end(file: h5py.File, end: float) -> dict[str, float]:
    """Build-up and roughness of the pin, means of the maps near the end."""
    times, base, radius = file["map_time"][:], file["pin/base"][:], file["radius"][:]
    late = np.flatnonzero((times > end - LATE) & (times < end + 1))
    found = [
        of_the_pin(file["pin/height"][number], file["pin/substrate"][number], base, file["pin/pressure"][number], radius)
        for number in late
    ]
    return {key: float(np.mean([one[key] for one in found])) for key in found[0]} | {"maps": float(len(found))}


def of_the_disc(file: h5py.File, moment: float) -> dict[str, float]:
    """Filling and build-up of the disc. What it lies on is the initial surface: the coating does not wear."""
    number, radius = measures.number_at(file["map_time"][:], moment), file["radius"][:]
    initial, height = file["disc/height"][0], file["disc/height"][number]
    build_up, profile = height - initial, measures.radial_filling(initial, height, radius, BANDS)
    return {
        "filled": measures.filled_volume(initial, height, radius),
        "filled_area": measures.filled_area(initial, height, radius, NEAR),
        "covered_disc": measures.share(build_up >= THICK_ON_THE_DISC, radius),
        "initial_depth": float(measures.mean(initial.max() - initial, radius)),
        "mean_build_up": float(measures.mean(build_up, radius)),
        "highest": float(height.max() - initial.max()),
        "inner_over_outer": float(profile[: BANDS // 2].mean() - profile[BANDS // 2 :].mean()),
        # Where the deepest fifth of the area was.
        "open_where_deepest": measures.open_where_deepest(initial, height, radius, 0.2),
        **{f"band_{band}": float(filled) for band, filled in enumerate(profile)},
    }


def sizes(file: h5py.File, moment: float) -> dict[str, dict]:
    """Diameters of plateaus that hold 10, 50 and 90 % of their area, and how many there are."""
    number, radius = measures.number_at(file["map_time"][:], moment), file["radius"][:]
    initial, height = file["disc/height"][0], file["disc/height"][number]
    reference, film = initial.max(), file["pin/substrate"][number] - file["pin/height"][number]
    cell = radius.mean() * 2 * np.pi / height.shape[0] * np.diff(radius).mean()
    pieces = {
        "pin_contact": measures.plateau_sizes(file["pin/pressure"][number] > 0, False),
        "pin_plateaus": measures.plateau_sizes((film > 0) | (file["pin/base"][:] == 1), False),
        "pin_thick": measures.plateau_sizes(film >= THICK, False),
        "disc_secondary": measures.plateau_sizes(height > initial, True),
        "disc_lowlands_filled": measures.plateau_sizes((initial < reference) & (height >= reference - NEAR), True),
        "disc_holes": measures.plateau_sizes(height < reference - 1e-6, True),
    }
    return {
        name: {"count": len(cells)} | (measures.diameters(cells * cell, [10, 50, 90]) if len(cells) else {})
        for name, cells in pieces.items()
    }


def open_depth(file: h5py.File, moment: float) -> np.ndarray:
    """How far every cell of the disc still is below the highest of the start, m."""
    height = file["disc/height"][measures.number_at(file["map_time"][:], moment)]
    return (file["disc/height"][0].max() - height).clip(0)
