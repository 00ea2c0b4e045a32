"""The line that converts instruments' files by SurfaceTopography, and text that both it and the program read."""

import os
import pathlib
import shlex
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import sdfio
import SurfaceTopography

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PROGRAM = os.environ.get("PLATEAU_PROGRAM", str(ROOT / "plateau"))
# Measured surfaces that are not part of the project.
SHARED = ROOT.parent / "shared" / "surfaces"
CORPUS = ROOT / "crates" / "io" / "tests" / "corpus" / "surfaces"


def program(*arguments):
    command = [PROGRAM, "surface", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=300)


def by_surface_topography(path):
    """Heights in m, profile by profile, NaN where there is none, and pitch along and across them."""
    topography = SurfaceTopography.read_topography(str(path)).to_unit("m")
    heights = np.ma.filled(topography.heights().T, np.nan)
    return np.atleast_2d(heights), topography.pixel_size[0], topography.pixel_size[-1]


class Conversion(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def line(self):
        """The command of docs/surfaces-formats.md."""
        text = (ROOT / "docs" / "surfaces-formats.md").read_text(encoding="utf-8")
        found = [line for line in text.splitlines() if line.startswith("python -c ") and "SurfaceTopography" in line]
        self.assertEqual(len(found), 1)
        return found[0]

    def convert(self, source):
        target = self.folder / "out.sdf"
        words = [{"python": sys.executable, "IN": str(source), "OUT.sdf": str(target)}.get(w, w) for w in shlex.split(self.line())]
        done = subprocess.run(words, capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr)
        return target

    def test_the_program_says_the_same_line(self):
        source = self.folder / "a.al3d"
        source.write_bytes(b"AliconaImaging\0\r\n")
        self.assertIn(self.line(), program(source).stderr)

    def check(self, source):
        heights, along, across = by_surface_topography(source)
        target = self.convert(source)
        written = sdfio.read(target)
        np.testing.assert_array_equal(written.data, heights)
        self.assertEqual((written.header.x_scale, written.header.y_scale), (along, across))
        # What the program reads of it, in SDF once more.
        again = self.folder / "again.sdf"
        done = program(target, "--to", again, "--force")
        self.assertEqual(done.returncode, 0, done.stderr)
        np.testing.assert_array_equal(sdfio.read(again).data, heights)

    def test_every_measured_surface(self):
        if not SHARED.is_dir():
            print(f"skipped: {SHARED} is not there")
            self.skipTest(f"{SHARED} is not there")
        # SurfaceTopography does not read SDF ISO-2.0, which the program does.
        sources = [path for path in sorted(SHARED.iterdir()) if path.suffix in {".al3d", ".frt", ".sdf", ".txt", ".x3p"}]
        sources = [path for path in sources if "iso2" not in path.name]
        self.assertGreater(len(sources), 5)
        for source in sources:
            with self.subTest(source=source.name):
                self.check(source)

    def test_a_profile(self):
        profile = self.folder / "profile.hfm"
        lines = "".join(f"{8.5 + n / 1000};{np.sin(n)};1\n" for n in range(40))
        profile.write_text("X;Y;valid\n[mm];[um];[1/0]\n" + lines, encoding="utf-8")
        self.check(profile)
        done = program(self.folder / "out.sdf", "--profile-lay", "along")
        self.assertIn("40 x 1", done.stdout, done.stderr)


class Text(unittest.TestCase):
    def compare(self, name, *arguments, turned=False):
        """The program and SurfaceTopography read the same of a file of the corpus."""
        with tempfile.TemporaryDirectory() as folder:
            target = pathlib.Path(folder) / "out.sdf"
            done = program(CORPUS / name, "--to", target, *arguments)
            self.assertEqual(done.returncode, 0, done.stderr)
            found = sdfio.read(target)
        heights, along, across = by_surface_topography(CORPUS / name)
        if turned:
            heights, along, across = heights.T, across, along
        # Units are multiplied in another order: a few roundings.
        np.testing.assert_allclose(found.data, heights, rtol=1e-14, atol=0)
        pitches = [found.header.x_scale, found.header.y_scale]
        np.testing.assert_allclose(pitches, [along, across] if heights.shape[0] > 1 else [along] * 2, rtol=1e-12)

    def test_matrices(self):
        for name in ["gwyddion.txt", "holographic.txt", "spip.asc"]:
            with self.subTest(name=name):
                self.compare(name)

    def test_wyko(self):
        # Lines of the file are columns of the surface; SurfaceTopography takes them as they stand.
        self.compare("wyko.asc", turned=True)


if __name__ == "__main__":
    unittest.main()
