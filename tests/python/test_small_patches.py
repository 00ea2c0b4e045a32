"""Measured patches that are smaller than the ring, tiled and extended by their statistics, are like the patches themselves."""

import math
import os
import pathlib
import tempfile
import unittest
import warnings

import numpy as np
import sdfio
from checkout import QUICK, SHARED
from package_scenes import InFolder

import plateau

SURFACES = (
    "alicona_200x296_iso1_int32",
    "lay_plu_384x288_iso1_binary64",
    "afm_256x256_iso2_int32",
    "frt_missing_150x300_iso1_int32",
    "pypi_afm_256x256_iso1_binary64",
)
# Cell, m, rows and columns of the ring, and the shorter side of the patches, m: tracks of 4 mm and, of what is tried for long, of 40 mm.
TRACKS = ((50e-6, 80, 400, 2.4e-3), (40e-3 / 120, 120, 450, 15e-3))[: 2 if "PLATEAU_LONG" in os.environ else 1]


def correlation_error(cells):
    """√(Σρ²/N): the standard error of the autocorrelation of N heights far from no lag (Bartlett 1946), over lags up to a third of the patch."""
    rows, columns = cells.shape
    shape = (2 * rows, 2 * columns)
    products, pairs = (np.fft.irfft2(np.abs(np.fft.rfft2(one, shape)) ** 2, shape) for one in (cells - cells.mean(), np.ones_like(cells)))
    x, y = np.arange(-(columns // 3), columns // 3 + 1), np.arange(-(rows // 3), rows // 3 + 1)
    places = np.ix_(y, x)
    return math.sqrt(((products[places] / pairs[places]) ** 2).sum() / cells.size) / cells.var()


@unittest.skipIf(SHARED is None, "the shared surfaces are not there")
class SmallPatches(InFolder):
    """Parameters of rings are those of the patch within three standard errors.

    The standard error is that of the jackknife over blocks, and where the parameter is a place at which the autocorrelation ρ falls to 0.2, with
    that of ρ: of ρ = exp(−(x/ℓ)²) the slope there is 2 ρ ln ρ = −0.64, so Sal has the relative error σ/0.64, and the ratio Str √2 of that. A
    random ring has the same errors of its own, less by the root of the areas; one that is tiled has parts of the patch more often than others,
    an error like that. Str is compared where it is determined, also without any one of the blocks; else it has no error.
    """

    def test_rings_are_like_their_patches(self):
        for name in SURFACES:
            with tempfile.TemporaryDirectory() as folder:
                surface = plateau.command("surface", SHARED / f"{name}.sdf", to=f"{folder}/heights.npy", json=True)
                heights = np.load(f"{folder}/heights.npy").T
            for track in TRACKS:
                for way in ("repeat = true", 'extend = "statistics", extend_seed = 1'):
                    with self.subTest(name=name, rows=track[1], way=way):
                        self.compare(heights, np.array(surface["pitch"]), *track, way)

    def compare(self, heights, pitch, cell, rows, columns, side, way):
        with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings(action="ignore"):
            # Pixels with the proportions of the file and the size that fits.
            pitch = pitch * side / min(pitch * heights.shape[::-1])
            sdfio.write(f"{folder}/patch.sdf", heights, x_scale=pitch[0], y_scale=pitch[1])
            prepare = f'{{ level = "plane", outliers = 6, fill = "interpolate", cutoff = "none", {way} }}'
            mean, half = cell * columns / math.tau, cell * rows / 2
            radii = f"inner_radius = '{mean - half!r} m', outer_radius = '{mean + half!r} m'"
            mesh = f"rows = {rows}, disc_columns = {columns}, pin_columns = 10, {radii}"
            pathlib.Path("ring.toml").write_text(
                f'extends = "{QUICK}"\ndisc.surface = {{ file = "{folder}/patch.sdf" }}\ndisc.prepare = {prepare}\nmesh = {{ {mesh} }}\n'
            )
            disc, _ = plateau.command("surface", prepare="ring.toml", json=True)
            plateau.command("surface", prepare="ring.toml", figure_data=folder)
            cells = np.load(f"{folder}/cells-0.npy")
        self.assertEqual(disc["comparison"]["cells"], list(cells.shape[::-1]))
        rho, more = correlation_error(cells) / 0.64, math.sqrt(1 + cells.size / (rows * columns))
        for symbol in ("Sa", "Sq", "Ssk", "Sku", "Sk", "Sdq", "Sal", "Str"):
            expected, error, difference = (disc["comparison"][of][symbol] for of in ("patch_in_cells", "sampling_error", "difference"))
            if symbol == "Str" and None in (expected, error, difference):
                continue
            error = more * math.hypot(error, {"Sal": rho, "Str": math.sqrt(2) * rho}.get(symbol, 0.0) * expected)
            self.assertLess(abs(difference), 3 * error, symbol)
