"""The S-filter and the L-filter of a preparation on measured surfaces, beside scipy and surfalize."""

import math
import pathlib
import tempfile
import unittest

import h5py
import numpy as np
import surfalize
from checkout import ROOT, SHARED, program
from scipy.ndimage import gaussian_filter
from surfalize.filter import GaussianFilter

SCENE = """version = 1
[mesh]
inner_radius = "{inner!r} m"
outer_radius = "{outer!r} m"
rows = {rows}
disc_columns = {disc_columns}
pin_columns = {columns}
[operation]
normal_force = "1 N"
sliding_speed = "2 m/s"
steps = 1
[contact]
foundation_height = "50 um"
[materials]
disc_primary = {{ youngs_modulus = "100 GPa", poisson_ratio = 0.27, specific_wear_rate = "0 1/Pa" }}
pin_primary = {{ youngs_modulus = "1 GPa", poisson_ratio = 0.27, specific_wear_rate = "0 1/Pa" }}
pin_resin = {{ youngs_modulus = "0.1 MPa", poisson_ratio = 0.27, wear_height = "0 um" }}
[plateaus]
debris = "local"
[disc.surface]
flat = true
[pin.base]
uniform = "primary"
[pin.surface]
file = '{file}'
[pin.prepare]
{prepare}
[output]
maps_at = ["0 s"]
maps = ["pin_height"]
"""


def prepared(file, shape, pitches, prepare):
    """Heights of a pin whose cells are the pixels of a surface, prepared so; m, shape (columns, rows)."""
    (columns, rows), (pitch_x, pitch_y) = shape, pitches
    # A ring whose inner radius is half the width of the track.
    disc_columns = max(math.ceil(math.tau * rows * pitch_y / pitch_x), columns)
    mean_radius = disc_columns * pitch_x / math.tau
    half = 0.5 * rows * pitch_y
    with tempfile.TemporaryDirectory() as folder:
        scene, run = (pathlib.Path(folder) / name for name in ("scene.toml", "run.h5"))
        scene.write_text(
            SCENE.format(
                inner=mean_radius - half,
                outer=mean_radius + half,
                rows=rows,
                disc_columns=disc_columns,
                columns=columns,
                file=file,
                prepare=prepare,
            )
        )
        program("run", scene, "-o", run)
        with h5py.File(run) as content:
            # The pin's z grows away from the disc.
            return -content["pin/height"][0]


class Filters(unittest.TestCase):
    def check(self, file, columns, rows):
        read = surfalize.Surface.load(file)
        pitches = read.step_x * 1e-6, read.step_y * 1e-6
        plain = prepared(file, (columns, rows), pitches, 'level = "plane"')
        spread = np.ptp(plain)
        sides = columns * pitches[0], rows * pitches[1]
        short, long = 8 * max(pitches), min(sides) / 3
        for prepare, smooth in [
            ('s_filter = "{short!r} m"', lambda z, low: low(z, short)),
            ('l_filter = "{long!r} m"', lambda z, low: z - low(z, long)),
            ('s_filter = "{short!r} m"\nl_filter = "{long!r} m"', lambda z, low: low(z, short) - low(low(z, short), long)),
        ]:
            prepare = 'level = "plane"\n' + prepare.format(short=short, long=long)
            found = prepared(file, (columns, rows), pitches, prepare)

            def scipy(z, nesting_index):
                # exp(-pi x^2/(alpha lambda)^2) is exp(-x^2/(2 sigma^2)) with sigma = alpha lambda/sqrt(2 pi).
                sigma = math.sqrt(math.log(2) / 2) / math.pi * nesting_index
                return gaussian_filter(z, [sigma / pitch for pitch in pitches], mode="reflect", truncate=9)

            def by_surfalize(z, nesting_index):
                surface = surfalize.Surface(z.T * 1e6, read.step_x, read.step_y)
                return GaussianFilter(nesting_index * 1e6, "lowpass")(surface).data.T * 1e-6

            with self.subTest(file=pathlib.Path(file).name, prepare=prepare):
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
