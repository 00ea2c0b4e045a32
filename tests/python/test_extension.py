"""Rings made by the statistics of a patch carry the pin as cut-outs of the surface from which the patch comes."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("PLATEAU_PROGRAM", str(ROOT / "plateau"))

# The paper's mesh, cells of 50 um.
COLUMNS, ROWS, PATCH = 2764, 80, 64
# Rings, and patches, that are cut out of the surface.
CUTS = 8
# Correlation length over the size of a cell, rms height in m.
LENGTH, RMS = 120 / 50, 3e-6

SCENE = """
version = 1
extends = "{cermet}"
[operation]
duration = "60 s"
[disc.surface]
file = "{surface}"
{pitch}
[disc.prepare]
cutoff = "3 um"
{extend}
[numerics]
time_acceleration = 50
[output]
maps_at = []
"""


def large_surface(seed):
    """A Gaussian surface with the autocorrelation exp(-(r/LENGTH)^2), periodic, as long as all cut-outs."""
    shape = (CUTS * COLUMNS, 256)
    noise = np.fft.rfft2(np.random.default_rng(seed).standard_normal(shape))
    along, across = np.fft.fftfreq(shape[0])[:, None], np.fft.rfftfreq(shape[1])[None, :]
    field = np.fft.irfft2(noise * np.exp(-0.5 * (np.pi * LENGTH) ** 2 * (along**2 + across**2)), s=shape)
    return RMS / field.std() * field


def contact_area(folder, heights, extension=""):
    """Contact area after 60 s on a ring, m2: the mean of the last 10 s."""
    np.save(folder / "surface.npy", heights)
    pitch = 'pitch = "50 um"' if extension else ""
    scene = SCENE.format(cermet=ROOT / "data/scenes/cermet.toml", surface=folder / "surface.npy", pitch=pitch, extend=extension)
    (folder / "scene.toml").write_text(scene)
    command = [PROGRAM, "run", folder / "scene.toml", "-o", folder / "run.h5", "--force", "--workers", "1"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    if done.returncode:
        raise AssertionError(done.stderr)
    with h5py.File(folder / "run.h5") as run:
        time, integral = run["series/time"][:], run["series/contact_area_integral"][:]
    return np.diff(np.interp([50.0, time[-1]], time, integral))[0] / (time[-1] - 50.0)


class Extension(unittest.TestCase):
    def test_extended_rings_carry_the_pin_as_the_surface_does(self):
        surface = large_surface(11)
        cuts = [surface[cut * COLUMNS : (cut + 1) * COLUMNS] for cut in range(CUTS)]
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            of_cuts = np.array([contact_area(folder, cut[:, :ROWS]) for cut in cuts])
            # Patches from rows that no ring has.
            extend = 'extend = "statistics"\nextend_seed = {}'
            of_patches = np.array(
                [contact_area(folder, cut[:PATCH, ROWS + 2 : ROWS + 2 + PATCH], extend.format(seed)) for seed, cut in enumerate(cuts)]
            )
        print(f"contact area, mm2: cut-outs {of_cuts * 1e6}, extended {of_patches * 1e6}")
        # The two means by Welch's test, at three standard errors, and the scatter of rings: that of the patches adds to it. A patch
        # knows its rms height with the relative error sqrt(pi LENGTH^2 / (2 PATCH^2)) / sqrt(2), 3.3 %.
        error = np.sqrt((of_cuts.var(ddof=1) + of_patches.var(ddof=1)) / CUTS)
        self.assertLess(abs(of_patches.mean() - of_cuts.mean()), 3 * error)
        self.assertLess(of_patches.std(ddof=1) / of_patches.mean(), 0.1)


if __name__ == "__main__":
    unittest.main()
