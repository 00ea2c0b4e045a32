"""Surfaces that the program writes (`plateau surface FILE --to OUT`), as surfalize, SurfaceTopography and sdfio read them."""

import numpy as np
import sdfio
import SurfaceTopography
import surfalize
from checkout import Folder, program

# Pitches that are no round numbers, different along x and y, so that nothing can be exchanged unnoticed.
X_PITCH, Y_PITCH = 1e-6 / 3, 7e-6 / 11


def by_sdfio(path):
    file = sdfio.read(path)
    return file.data, file.header.x_scale, file.header.y_scale


def by_surfalize(path):
    surface = surfalize.Surface.load(path)
    return surface.data * 1e-6, surface.step_x * 1e-6, surface.step_y * 1e-6


def by_surface_topography(path):
    topography = SurfaceTopography.read_topography(path).to_unit("m")
    heights = np.ma.filled(topography.heights(), np.nan)
    return heights.T, *topography.pixel_size


def heights(rows, columns, missing):
    """Heights of 1 um that differ everywhere, in m, profile by profile."""
    z = np.random.default_rng(1).normal(scale=1e-6, size=(rows, columns))
    z += 1e-6 * np.arange(columns) / columns
    if missing:
        z[0, 0] = z[rows - 1, 1] = np.nan
        z[rows // 3, columns // 4 : columns // 2] = np.nan
    return z


class Written(Folder):
    def convert(self, z, name):
        """The file that the program makes of a file with these heights."""
        source, target = self.folder / "source.sdf", self.folder / name
        sdfio.write(source, z, x_scale=X_PITCH, y_scale=Y_PITCH)
        program("surface", source, "--level", "none", "--to", target)
        return target

    def check(self, path, z, readers):
        for read in readers:
            with self.subTest(reader=read.__name__):
                found, x_pitch, y_pitch = read(path)
                self.assertEqual(found.shape, z.shape)
                np.testing.assert_array_equal(np.isnan(found), np.isnan(z))
                # Two of them calculate in um: a few roundings.
                np.testing.assert_allclose(found, z, rtol=1e-15, atol=0)
                np.testing.assert_allclose([x_pitch, y_pitch], [X_PITCH, Y_PITCH], rtol=1e-15)
        if by_sdfio in readers:
            np.testing.assert_array_equal(by_sdfio(path)[0], z)

    def test_sdf_iso_1(self):
        for missing in [False, True]:
            z = heights(37, 53, missing)
            path = self.convert(z, f"missing-{missing}.sdf")
            self.assertEqual(path.read_bytes()[:8], b"aISO-1.0" if missing else b"bISO-1.0")
            self.check(path, z, [by_sdfio, by_surfalize, by_surface_topography])

    def test_sdf_iso_2(self):
        # A side of more points than ISO-1.0 counts. SurfaceTopography does not read ISO-2.0.
        z = heights(2, 70_000, missing=False)
        path = self.convert(z, "long.sdf")
        self.assertEqual(path.read_bytes()[:8], b"bISO-2.0")
        self.check(path, z, [by_sdfio, by_surfalize])
