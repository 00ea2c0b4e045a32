"""Rings made by the statistics of a patch carry the pin as cut-outs of the surface from which the patch comes."""

import os

import numpy as np
from checkout import ROOT, Folder

import plateau

# The paper's mesh has cells of 50 um; surfaces are measured in pixels of a quarter of that. Pixels of ring and patch.
COLUMNS, ROWS, PATCH = 4 * 2764, 4 * 80, 4 * 64
PIXEL = 2 * np.pi * 22e-3 / COLUMNS
# Pairs of a ring and a patch that are cut out of one surface; in short as many as tell a scatter.
CUTS = 8 if "PLATEAU_LONG" in os.environ else 3
# Correlation length over the size of a pixel, rms height in m.
LENGTH, RMS = 120e-6 / PIXEL, 3e-6


def large_surface(seed):
    """A Gaussian surface with the autocorrelation exp(-(r/LENGTH)^2), periodic, as long as a ring and wide enough for a patch beside it."""
    shape = (COLUMNS, ROWS + PATCH + 64)
    noise = np.fft.rfft2(np.random.default_rng(seed).standard_normal(shape))
    along, across = np.fft.fftfreq(shape[0])[:, None], np.fft.rfftfreq(shape[1])[None, :]
    field = np.fft.irfft2(noise * np.exp(-0.5 * (np.pi * LENGTH) ** 2 * (along**2 + across**2)), s=shape)
    # Of the population, not of this surface: every surface has an rms height of its own. The sum of squares over all harmonics.
    all_across = np.fft.fftfreq(shape[1])[None, :]
    variance = np.exp(-((np.pi * LENGTH) ** 2) * (along**2 + all_across**2)).mean()
    return RMS / np.sqrt(variance) * field


def contact_area(folder, heights, **extension):
    """Contact area after 60 s on a ring, m2: the mean of the last 10 s."""
    np.save(folder / "surface.npy", heights)
    # A hair more than a ring's part, so that rounding leaves no gap.
    surface = {"file": folder / "surface.npy", "pitch": f"{PIXEL * (1 + 1e-12):.17g} m"}
    changes = {"operation.duration": "60 s", "disc.surface": surface, "disc.prepare": {"cutoff": "3 um", **extension}, "output.maps_at": []}
    with plateau.run(ROOT / "data/scenes/cermet.toml", folder / "run.h5", set=changes, workers=1, force=True) as run:
        time, integral = run["time"].values, run["series/contact_area_integral"].values
    return np.diff(np.interp([50.0, time[-1]], time, integral))[0] / (time[-1] - 50.0)


class Extension(Folder):
    def test_extended_rings_carry_the_pin_as_the_surface_does(self):
        of_rings, of_patches = np.empty(CUTS), np.empty(CUTS)
        for cut in range(CUTS):
            surface = large_surface(cut)
            # The patch has no row of the ring.
            patch = surface[:PATCH, ROWS + 32 : ROWS + 32 + PATCH]
            of_rings[cut] = contact_area(self.folder, surface[:, :ROWS])
            of_patches[cut] = contact_area(self.folder, patch, extend="statistics", extend_seed=cut)
        print(f"contact area, mm2: cut-outs {of_rings * 1e6}, extended {of_patches * 1e6}")
        # The two means by Welch's test, at three standard errors. A patch knows its rms height with the relative error
        # sqrt(pi/4) LENGTH/PATCH, 3.3 %, so extended rings scatter more than cut-outs.
        error = np.sqrt((of_rings.var(ddof=1) + of_patches.var(ddof=1)) / CUTS)
        self.assertLess(abs(of_patches.mean() - of_rings.mean()), 3 * error)
        self.assertLess(of_patches.std(ddof=1) / of_patches.mean(), 0.1)
