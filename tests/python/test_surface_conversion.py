"""Files of instruments that ``plateau surface convert`` converts, as the program reads them then."""

import functools
import hashlib
import json
import math
import os
import pathlib
import shutil
import warnings

import h5py
import netCDF4
import numpy as np
import xarray
from checkout import PROGRAM, ROOT, SHARED, Folder, called

from plateau.errors import InputError
from plateau.surface_conversion import _even, convert

SAMPLES = pathlib.Path(__file__).resolve().parent / "data" / "instruments"
# What a reader that was written on its own, in Rust, gave of each.
EXPECTED = json.loads((SAMPLES / "heights.json").read_text(encoding="utf-8"))
# With its Python companions, which a checkout keeps in one folder.
program = functools.partial(called, env={**os.environ, "PATH": f"{ROOT / 'python' / 'bin'}:{os.environ['PATH']}"})


class Conversion(Folder):
    def convert(self, source):
        with warnings.catch_warnings(action="ignore"):
            return pathlib.Path(convert(source, self.folder / f"{source.name}.h5"))

    def read(self, path, *options):
        """Heights, m, column by column, and pitch, as the program reads and writes them."""
        again = self.folder / "again.h5"
        done = program("surface", path, "--to", again, "--force", *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        with h5py.File(again) as file:
            return file["height"][...], file["height"].attrs["pitch"]

    def test_every_sample_has_the_heights_of_another_reader(self):
        for name, expected in EXPECTED.items():
            with self.subTest(name=name):
                heights, pitch = self.read(self.convert(SAMPLES / name))
                np.testing.assert_allclose(pitch, expected["pitch"], rtol=1e-15)
                if "heights" not in expected:
                    found = [list(heights.shape), int(np.isnan(heights).sum()), heights[np.isfinite(heights)][0]]
                    self.assertEqual(found, [expected["shape"], expected["missing"], expected["first"]])
                    self.assertTrue(math.isclose(np.nansum(heights), expected["sum"], rel_tol=1e-13))
                    continue
                np.testing.assert_allclose(heights, np.array(expected["heights"], float), rtol=1e-15, atol=0)

    def test_text_exports_have_the_numbers_that_they_were_made_of(self):
        number = 1e-6 * np.arange(20.0).reshape(5, 4)
        for name in ["keyence.csv", "wyko.asc", "zygo.xyz", "zygo.asc", "spip.asc", "holographic.txt"]:
            with self.subTest(name=name):
                heights, _ = self.read(self.convert(SAMPLES / name))
                there = np.isfinite(heights)
                self.assertEqual(np.argwhere(~there).tolist(), [] if name == "holographic.txt" else [[2, 1]])
                np.testing.assert_allclose(heights[there], number[there], rtol=1e-15)

    def test_points_of_a_profile_are_even_but_for_rounding_and_holes(self):
        path, values = pathlib.Path("a.csv"), np.arange(20.0)
        rounded = np.round(np.arange(20) * 0.15625, 1) * 1e-6
        found, step = _even(path, rounded, values)
        self.assertEqual((found.tolist(), step), (values.tolist(), rounded[-1] / 19))
        found, step = _even(path, np.delete(np.arange(20.0), 7), np.delete(values, 7))
        self.assertTrue(step == 1.0 and np.isnan(found[7]) and np.array_equal(np.delete(found, 7), np.delete(values, 7)))
        for uneven in ([0.0, 1.0, 2.0, 3.31, 4.0], [0.0, 1.0, 3.0, 4.0, 7.0, 8.0], [0.0, 2.0, 1.0], [1.0]):
            with self.assertRaises(InputError):
                _even(path, np.array(uneven), np.zeros(len(uneven)))

    def test_measured_surfaces_have_the_parameters_of_other_programs(self):
        if SHARED is None:
            self.skipTest("no folder shared/surfaces above the checkout (PLATEAU_SHARED names the folder shared)")
        known = json.loads((SHARED / "values.json").read_text(encoding="utf-8"))
        for name, letter in [
            ("alicona_200x296.al3d", "A"),
            ("dhm_grooves_75x305.txt", "B"),
            ("lay_200x200.x3p", "C"),
            ("frt_missing_150x300.frt", "F"),
        ]:
            path = self.convert(SHARED / name)
            if letter == "C":
                # zipfile and numpy.frombuffer(bindata/data.bin, "<f8").reshape(200, 200), column by column.
                digest = hashlib.sha256(self.read(path)[0].astype("<f8").tobytes()).hexdigest()
                self.assertEqual(digest, "0fb16d4f3922af9797049d957a3ea1e2667b424549baf4b507dcc8f074d00140")
            found = json.loads(program("surface", path, "--json").stdout)
            expected = next(one["own"] for key, one in known.items() if key.startswith(letter))
            for parameter in ("Sa", "Sq", "Ssk", "Sku"):
                with self.subTest(name=name, parameter=parameter):
                    self.assertTrue(math.isclose(found[parameter], expected[parameter], rel_tol=1e-5), f"{found[parameter]}")

    def test_the_file_tells_where_it_comes_from_and_other_programs_read_it(self):
        source = SAMPLES / "wyko.asc"
        path = self.convert(source)
        digest = hashlib.sha256(source.read_bytes()).hexdigest()
        with h5py.File(path) as file:
            attributes = dict(file["height"].attrs)
            self.assertEqual((attributes["source_file"], attributes["source_sha256"]), ("wyko.asc", digest))
            self.assertTrue(attributes["converted_by"].startswith("SurfaceTopography "))
        with xarray.open_dataset(path) as opened:
            self.assertEqual((opened.height.dims, opened.x.attrs["units"]), (("x", "y"), "m"))
        with netCDF4.Dataset(path) as opened:
            self.assertEqual(opened["height"].shape, (5, 4))
        told = program("surface", path, "--json")
        self.assertIn(f"converted from wyko.asc (SHA-256 {digest}) by SurfaceTopography", told.stdout)

    def test_peaks_are_positive_on_the_pin_and_the_run_file_names_the_source(self):
        path = self.convert(SAMPLES / "wyko.asc")
        scene = self.folder / "scene.toml"
        scene.write_text(
            f'extends = "{ROOT}/data/scenes/quick.toml"\n[pin.surface]\nfile = "{path}"\n'
            '[pin.prepare]\nfill = "level"\nrepeat = true\npixel = "1 mm"\n[operation]\nduration = "1 s"\n[output]\nfile = "run.h5"\n',
            encoding="utf-8",
        )
        done = program("run", scene, "-o", self.folder / "run.h5")
        self.assertEqual(done.returncode, 0, done.stderr)
        with h5py.File(self.folder / "run.h5") as file:
            told = file.attrs["surfaces"]
        self.assertIn("converted from wyko.asc (SHA-256 ", told)
        self.assertIn("pin.surface: negated", told)

    def test_what_is_not_there_or_not_right_is_told(self):
        text = (SAMPLES / "keyence.csv").read_bytes()
        for name, content, expected in [
            ("a.csv", text.replace(b'"H\xf6he"\r\n"0', b'"Laser"\r\n"0'), 'line 10: the file holds "Laser", expected heights'),
            ("b.csv", text.replace(b'"12,0"', b'"12.0"'), "decimal points and decimal commas"),
            ("c.csv", text.replace(b'"Vertikal","4"', b'"Vertikal","5"'), "states 5 x 5 points, but there are 4 lines of 5"),
            ("d.csv", b'"XY Calibration","1","um"\n', "no line below its header names what it holds"),
            ("zygo.xyz", (SAMPLES / "zygo.xyz").read_bytes().replace(b"11 6 19", b"99 6 19"), "lie outside of the 5 x 4"),
            ("zygo.asc", (SAMPLES / "zygo.asc").read_bytes()[:-60], "states 20 phases"),
            ("plain.txt", b"# Channel: z\n# Width: 4 um\n# Height: 2 um\n1 2 3 4\n5 6 7 8\n", "states no unit of its heights"),
            ("picture.al3d", b"AliconaImaging\0\r\n", "no library reads it (SurfaceTopography: "),
            ("native.sdf", b"aISO-1.0\r\n", "need not be converted"),
        ]:
            with self.subTest(name=name):
                path = self.folder / name
                path.write_bytes(content)
                with self.assertRaises(InputError) as caught:
                    convert(path)
                self.assertIn(expected, str(caught.exception))
                self.assertIn(name, str(caught.exception))
        with self.assertRaises(FileNotFoundError):
            convert(self.folder / "nothing.al3d")

    def test_the_program_hands_over_and_new_converts(self):
        shutil.copy(SAMPLES / "float64.x3p", self.folder / "scan.x3p")
        told = program("surface", "scan.x3p")
        self.assertEqual((told.returncode, told.stdout), (2, ""))
        self.assertIn("this is an X3P file (.x3p), which is not read as it is; convert it: plateau surface convert FILE -o FILE.h5", told.stderr)
        done = program("surface", "convert", "scan.x3p")
        self.assertEqual((done.returncode, done.stdout), (0, "scan.x3p: heights are in scan.h5\n"), done.stderr)
        # The same once more is there already; of another file it is not.
        before = (self.folder / "scan.h5").stat().st_mtime_ns
        again = program("surface", "convert", "scan.x3p")
        self.assertEqual((again.returncode, again.stdout), (0, done.stdout), again.stderr)
        self.assertEqual((self.folder / "scan.h5").stat().st_mtime_ns, before)
        for content in (b"of somebody else", None):
            if content is None:
                shutil.copy(SAMPLES / "float32.x3p", self.folder / "scan.x3p")
            else:
                (self.folder / "other.h5").write_bytes(content)
            target = "scan.h5" if content is None else "other.h5"
            refused = program("surface", "convert", "scan.x3p", "-o", target)
            self.assertEqual(refused.returncode, 2)
            self.assertIn(f"{target} exists; give --force to replace it", refused.stderr)
        shutil.copy(SAMPLES / "float64.x3p", self.folder / "scan.x3p")
        made = program("new", "mine.toml", "--disc", "scan.x3p")
        self.assertEqual(made.returncode, 0, made.stderr)
        self.assertIn("scan.x3p: converted to scan.h5, which the scene names", made.stdout)
        self.assertIn('file = "scan.h5"', (self.folder / "mine.toml").read_text(encoding="utf-8"))
        # Without the package, the same line says what to run and to install.
        bare = {**os.environ, "PATH": "/usr/bin:/bin"}
        told = program("new", "other.toml", "--disc", "scan.x3p", env=bare)
        beside = pathlib.Path(PROGRAM).resolve().parent / "plateau-surface"
        if str(ROOT / "plateau") != PROGRAM and not beside.exists():
            self.assertEqual(told.returncode, 2, told.stdout)
            self.assertIn("pip install 'plateau-brake[all]'", told.stderr)
