"""The S-filter and the L-filter of a preparation on measured surfaces, beside scipy and surfalize."""

import math
import pathlib
import tempfile
import unittest
import warnings

import numpy as np
import surfalize
from checkout import QUICK, ROOT, SHARED
from scipy.ndimage import gaussian_filter
from surfalize.filter import GaussianFilter

import plateau


def prepared(file, shape, pitches, **prepare):
    """Heights of a pin whose cells are the pixels of a surface, prepared so; m, shape (columns, rows)."""
    (columns, rows), (pitch_x, pitch_y) = shape, pitches
    # A ring whose inner radius is half the width of the track.
    disc_columns = max(math.ceil(math.tau * rows * pitch_y / pitch_x), columns)
    mean_radius = disc_columns * pitch_x / math.tau
    half = 0.5 * rows * pitch_y
    mesh = {"inner_radius": f"{mean_radius - half!r} m", "outer_radius": f"{mean_radius + half!r} m"}
    mesh |= {"rows": rows, "disc_columns": disc_columns, "pin_columns": columns}
    changes = {"mesh": mesh, "operation.steps": 1, "disc.surface.flat": True, "pin.base.uniform": "primary", "output.maps": ["pin_height"]}
    changes |= {"pin.surface.file": file, "pin.prepare": {"level": "plane", **prepare}}
    # The load of so small a pin is warned of.
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings(action="ignore"):
        # The pin's z grows away from the disc.
        return -plateau.run(QUICK, f"{folder}/run.h5", set=changes)["pin/height"].values[0]


class Filters(unittest.TestCase):
    def check(self, file, columns, rows):
        read = surfalize.Surface.load(file)
        pitches = read.step_x * 1e-6, read.step_y * 1e-6
        plain = prepared(file, (columns, rows), pitches)
        spread = np.ptp(plain)
        sides = columns * pitches[0], rows * pitches[1]
        short, long = 8 * max(pitches), min(sides) / 3
        s_filter, l_filter = {"s_filter": f"{short!r} m"}, {"l_filter": f"{long!r} m"}
        for prepare, smooth in [
            (s_filter, lambda z, low: low(z, short)),
            (l_filter, lambda z, low: z - low(z, long)),
            (s_filter | l_filter, lambda z, low: low(z, short) - low(low(z, short), long)),
        ]:
            found = prepared(file, (columns, rows), pitches, **prepare)

            def scipy(z, nesting_index):
                # exp(-pi x^2/(alpha lambda)^2) is exp(-x^2/(2 sigma^2)) with sigma = alpha lambda/sqrt(2 pi).
                sigma = math.sqrt(math.log(2) / 2) / math.pi * nesting_index
                return gaussian_filter(z, [sigma / pitch for pitch in pitches], mode="reflect", truncate=9)

            def by_surfalize(z, nesting_index):
                surface = surfalize.Surface(z.T * 1e6, read.step_x, read.step_y)
                return GaussianFilter(nesting_index * 1e6, "lowpass")(surface).data.T * 1e-6

            with self.subTest(file=pathlib.Path(file).name, **prepare):
                np.testing.assert_allclose(found, smooth(plain, scipy), rtol=0, atol=1e-9 * spread)
                # It ends its weights at four sigma: 6.3e-5 of them are missing in each of two directions, twice.
                np.testing.assert_allclose(found, smooth(plain, by_surfalize), rtol=0, atol=4 * 6.4e-5 * spread)

    def test_the_surface_of_the_project(self):
        self.check(ROOT / "data/surfaces/afm_256x256.sdf", 256, 256)

    def test_measured_surfaces(self):
        if SHARED is None:
            self.skipTest("no folder shared/surfaces above the checkout (PLATEAU_SHARED names the folder shared)")
        for name, columns, rows in [
            ("lay_plu_384x288_iso1_binary64.sdf", 384, 288),
            ("afm_256x256_iso2_int32.sdf", 256, 256),
            ("alicona_200x296_iso1_int32.sdf", 200, 296),
        ]:
            self.check(SHARED / name, columns, rows)
