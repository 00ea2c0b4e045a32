"""What ``plateau surface`` tells, as docs/surface.md describes it; numbers are found another way."""

import json
import math
import pathlib
import unittest
import unittest.mock
import warnings

import h5py
import numpy as np
from checkout import QUICK, ROOT, word
from package_scenes import InFolder

import plateau

# An AFM scan, of which values.json of the shared surfaces has the parameters (letter G).
AFM = ROOT / "data" / "surfaces" / "afm_256x256.sdf"
# 4 x 3 points, µm: a slope along x, with a point missing.
SMALL = """aISO-1.0
ManufacID = test
CreateDate = 010120250000
ModDate = 010120250000
NumPoints = 4
NumProfiles = 3
Xscale = 2e-6
Yscale = 5e-6
Zscale = 1e-6
Zresolution = -1
Compression = 0
DataType = 7
CheckType = 0
*
0 1 2 3
0 1 BAD 3
0 1 2 3
*
"""


def described(*arguments, **options):
    with warnings.catch_warnings(action="ignore"):
        # Of small patches, and of those with few heights.
        return plateau.command("surface", *arguments, json=True, **options)


def table(*arguments, **options):
    with warnings.catch_warnings(action="ignore"):
        return plateau.command("surface", *arguments, **options)


def cell(text, symbol):
    """The cell of a parameter in the table of one surface."""
    return next(line for line in text.splitlines() if line.startswith(f"{symbol:5} ")).split()[-1]


def quick(**edits):
    """A scene with other values of a few keys."""
    pathlib.Path("scene.toml").write_text(f'extends = "{QUICK}"\n' + "".join(f"{key} = {value}\n" for key, value in edits.items()))
    return "scene.toml"


class SurfaceCommand(InFolder):
    def setUp(self):
        pathlib.Path("small.sdf").write_text(SMALL)

    def test_json_has_the_symbols_of_the_standard(self):
        surface = described(AFM)
        # Shared values to all digits; the Sk family with its tolerance.
        expected = {"Sa": 0.007850630292339372, "Sq": 0.010084618656752626, "Ssk": 0.3330687746659863, "Sku": 3.065286171324044}
        expected |= {"Sz": 0.05503606503315581, "Sdq": 0.4280487450660783, "Sdr": 8.282255201236532}
        for name, value in expected.items():
            self.assertAlmostEqual(surface[name] / value, 1, delta=1e-6)
        for name, value in {
            "Sk": 0.02176493496909058,
            "Spk": 0.013370115360182578,
            "Svk": 0.009136651324949466,
            "Smr1": 15.1351958,
            "Smr2": 87.8276,
        }.items():
            self.assertAlmostEqual(surface[name] / value, 1, delta=5e-3)
        self.assertEqual((surface["columns"], surface["rows"], surface["coverage"], surface["level"]), (256, 256, 1.0, "least-squares plane"))
        self.assertAlmostEqual(surface["pitch"][0], 1.953125e-3)
        # Every number of a surface has a unit, and every unit a number.
        self.assertLessEqual(surface["units"].keys(), surface.keys())
        self.assertLessEqual(set(surface["units"].values()), {"um", "1", "%", "deg"})
        numbers = {name for name, value in surface.items() if isinstance(value, int | float)}
        self.assertEqual(numbers - surface["units"].keys(), {"columns", "rows", "points", "measured"})

    def test_several_surfaces_are_an_array_and_the_columns_of_a_table(self):
        surfaces = described("small.sdf", AFM)
        self.assertEqual([(one["points"], one["measured"]) for one in surfaces], [(12, 11), (65_536, 65_536)])
        self.assertEqual(surfaces[0]["name"], "small.sdf")
        text = table("small.sdf", AFM)
        self.assertTrue(text.splitlines()[0].endswith("small.sdf      afm_256x256.sdf"), text)
        self.assertEqual(cell(text, "Sq"), "0.0100846")
        self.assertRegex(text, r"(?m)^size .* 8 um x 15 um +500 nm x 500 nm$")
        self.assertIn("small.sdf: an SDF ISO-1.0 ASCII file", text)
        self.assertIn("  1 of 12 points are missing and take no part\n", text)
        self.assertTrue(all(line == line.rstrip() for line in text.splitlines()))

    def test_level_decides_what_is_taken_out(self):
        # The slope is a plane. Its heights 0, 1, 2, 3 occur 3, 3, 2 and 3 times: Σ z = 16, Σ z² = 38 over 11 points.
        self.assertEqual([described("small.sdf", **level)["Sq"] for level in ({}, {"level": "plane"})], [0, 0])
        for level in ("none", "mean"):
            self.assertAlmostEqual(described("small.sdf", level=level)["Sq"], math.sqrt(38 / 11 - (16 / 11) ** 2), delta=1e-14)

    def test_a_slope_that_is_levelled_is_flat(self):
        surface, text = described("small.sdf"), table("small.sdf")
        for name in ("Sa", "Sq", "Sz", "Sk", "Spk", "Svk", "Vmc", "Sdq", "Sdr", "Ra_x", "Rq_y"):
            self.assertEqual((surface[name], cell(text, name)), (0, "0"), name)
        for name in ("Ssk", "Sku", "Smr1", "Smr2", "Sal", "Str", "Rsk_x", "Rku_y"):
            self.assertEqual((surface[name], cell(text, name)), (None, "-"), name)
        self.assertIn("flat: all its heights are equal", text)
        self.assertNotIn("flat:", table("small.sdf", level="none"))

    def test_heights_that_are_unrelated_from_point_to_point_have_no_length(self):
        np.savetxt("noise.txt", np.random.default_rng(1).normal(size=(50, 60)), header="unit: um\npitch: 2 um")
        surface, text = described("noise.txt"), table("noise.txt")
        for name in ("Sal", "Str"):
            self.assertEqual((surface[name], cell(text, name)), (None, "-"))
        self.assertIsNone(surface["Str_below"])
        self.assertIn("Sal and Str have no value", text)

    def test_without_a_pitch_what_needs_none_is_given(self):
        np.save("heights.npy", 0.2e-6 * (np.arange(120.0) ** 2 % 17).reshape(12, 10))
        without, with_one = described("heights.npy"), described("heights.npy", pitch="2 um, 0.5 um")
        self.assertEqual((without["pitch"], without["size"], with_one["size"]), (None, None, [24, 5]))
        for name in ("Sa", "Sk", "Vmp", "Ra_x", "Rku_y"):
            self.assertEqual(without[name], with_one[name])
        self.assertEqual(with_one.keys() - without.keys(), {"Sdq", "Sdr", "Sal", "Str", "Std", "Str_below"})
        self.assertIn("Sdq, Sdr, Sal and Str need the distance of the points: give --pitch", table("heights.npy"))

    def test_a_bound_is_told_where_the_lay_does_not_end(self):
        np.savetxt("lay.txt", np.tile(np.sin(np.arange(60) / 3), (50, 1)), header="unit: um\npitch: 2 um")
        bound = described("lay.txt")["Str_below"]
        told = next(line for line in table("lay.txt").splitlines() if line.startswith("Str ")).split("< ")[1]
        self.assertTrue(bound <= float(told) < bound + 1e-3, (bound, told))

    def test_a_lay_is_told_and_the_rotation_that_turns_it_offered(self):
        # 100 x 100 points of 20 um: grooves of 1 um, 0.2 mm apart, at an angle to x, and steps of 0.1 um beside them.
        x, y = np.meshgrid(np.arange(100), np.arange(100))
        along, across = "along sliding, x of the file", "across sliding, along y of the file"
        cases = [
            (90, "90 deg", across, "90 deg)", along),
            (30, "-30 deg", "oblique to sliding, x of the file", "Std 30", along),
            (-50, "50 deg", "oblique to sliding, x of the file", "Std \u2212", along),
            (0, "90 deg", along, "Std 0 deg", across),
        ]
        for degrees, rotate, runs, angle, then in cases:
            turn = math.radians(degrees)
            heights = np.sin(2 * np.pi / 10 * (y * math.cos(turn) - x * math.sin(turn))) + (x * 7919 + y * 104729 + x * y * 31) % 17 / 170
            np.savetxt("lay.txt", heights, "%.4f", header="unit: um\npitch: 20 um")
            said = plateau.command("new", "mine.toml", disc="lay.txt", force=True)
            text = pathlib.Path("mine.toml").read_text()
            told = next(line for line in text.splitlines() if line.startswith("# rotate"))
            self.assertTrue(f'rotate = "{rotate}"' in told and runs in told, told)
            self.assertTrue(f"its lay runs {runs}" in said and "(Str < " in said and angle in said, said)
            # Turned so, the patch, read with x for y, has it the other way.
            pathlib.Path("turned.toml").write_text(text.replace("\n# rotate", "\nrotate"))
            pathlib.Path("turned").mkdir(exist_ok=True)
            table(prepare="turned.toml", figure_data="turned")
            said = plateau.command("new", "again.toml", disc="turned/heights-0.npy", pitch="20 um", force=True)
            self.assertIn(f"its lay runs {across if then == along else along}", said)

    def test_a_converted_surface_is_the_same_surface(self):
        def parameters(*arguments, **options):
            # What differs is the file itself.
            return {name: value for name, value in described(*arguments, **options).items() if name not in ("name", "format", "notes")}

        original = parameters(AFM)
        for to in ("out.sdf", "out.h5"):
            self.assertEqual(parameters(AFM, to=to), original)
            self.assertEqual(parameters(to), original)
        table(AFM, to="out.npy")
        self.assertEqual(parameters("out.npy", pitch="1.953125 nm"), original)

    def test_a_scene_shows_what_it_makes_of_its_surfaces(self):
        disc, pin = described(prepare=QUICK)
        self.assertEqual(
            [(one["name"], one["columns"], one["rows"], one["level"]) for one in (disc, pin)],
            [("disc", 690, 20, "nothing"), ("pin", 40, 20, "nothing")],
        )
        # Cut at one rms height of 3 µm: the highest points are there above the mean before it.
        self.assertTrue(3.0 < disc["Sp"] < 3.5 and disc["Sq"] < 3.0)
        # 30 % fibres stand 8 µm above the resin, peaks positive.
        self.assertTrue(pin["Ssk"] > 0.5 and pin["Sz"] > 8.0)
        self.assertTrue(any("cut at 3 um" in note for note in disc["notes"]))
        self.assertNotIn("comparison", disc)
        text = table(AFM, prepare=QUICK)
        self.assertEqual(text.splitlines()[0].split(), ["afm_256x256.sdf", "disc", "pin"])
        self.assertIn("pin.surface: resin set back by 8 um", text)

    def test_a_patch_is_shown_beside_what_a_scene_makes_of_it(self):
        # 256 pixels of 3 um are 0.768 mm: narrower than the track of 1 mm. They hold 4 cells of 186.7 um along and 15 of 50 um.
        for way in ("repeat = true", 'extend = "statistics", extend_seed = 5'):
            scene = quick(**{"disc.surface": f'{{ file = "{AFM}" }}', "disc.prepare": f'{{ level = "plane", pixel = "3 um", scale = 300, {way} }}'})
            disc, pin = described(prepare=scene)
            self.assertNotIn("comparison", pin)
            compared = disc["comparison"]
            self.assertEqual(compared["cells"], [4, 15])
            # The patch is the whole scan, 300 times as high; form and pixel change no height.
            self.assertAlmostEqual(compared["patch"]["Sq"] / (300 * 0.010084618656752626), 1, delta=1e-6)
            for name in ("Sa", "Sq", "Sdq", "Rq_y"):
                self.assertAlmostEqual(compared["difference"][name], disc[name] - compared["patch_in_cells"][name], delta=1e-12)
                self.assertGreater(compared["sampling_error"][name], 0)
            # Averages over cells are no rougher than the patch.
            self.assertLess(compared["patch_in_cells"]["Sq"], compared["patch"]["Sq"])
            self.assertLess(disc["Sz"], compared["patch"]["Sz"])
            self.assertIsNone(compared["sampling_error"]["Sz"])
            text = table(prepare=scene, plot="both.png", force=True)
            self.assertIn("averaged over 4 x 15 cells of 186.7 um x 50 um", text)
            self.assertIn(["patch", "in", "cells", "+-", "disc", "difference"], [line.split() for line in text.splitlines()])
            self.assertIn("wrote both.png", text)
            self.assertTrue(pathlib.Path("both.png").is_file())

    def test_heights_of_a_run_are_described_before_and_after(self):
        plateau.run(QUICK, "run.h5", set={"operation.duration": "2 s", "output.maps_at": ["0 s", "1 s", "2 s"]}, force=True)
        maps = [("disc/height", 0), ("disc/height", 2), ("pin/height", 0), ("pin/height", 2)]
        found = described("run.h5", level="mean")
        with h5py.File("run.h5") as run:
            for one, (name, moment) in zip(found, maps, strict=True):
                # The pin's peaks are at its least z.
                heights = (-1 if name.startswith("pin") else 1) * run[name][moment]
                self.assertAlmostEqual(one["Sq"] / (1e6 * heights.std()), 1, delta=1e-9)
                self.assertAlmostEqual(one["Sp"] / (1e6 * (heights.max() - heights.mean())), 1, delta=1e-9)
        # Maps are those of the first step at or after their time; the table need not repeat the file.
        for one, begin in zip(found, ("disc height, 0 s", "disc height, 2.00", "pin height, 0 s", "pin height, 2.00"), strict=True):
            self.assertTrue(one["name"].startswith(f"run.h5 {begin}"), one["name"])
        heads = table("run.h5").splitlines()[0]
        self.assertTrue("disc height, 0 s" in heads and "run.h5" not in heads, heads)
        # One of them, written for other programs.
        table("run.h5", dataset="disc/height", at="0.9 s", to="worn.sdf", force=True)
        recorded = described("run.h5", dataset="disc/height", at="1 s", level="mean")
        self.assertAlmostEqual(described("worn.sdf", level="mean")["Sq"] / recorded["Sq"], 1, delta=1e-9)

    def test_the_data_of_figures_are_those_that_are_told(self):
        pathlib.Path("figures").mkdir()
        scene = ROOT / "data" / "scenes" / "measured.toml"
        found = described("small.sdf", prepare=scene)
        self.assertEqual(table("small.sdf", prepare=scene, figure_data="figures"), "")
        drawn = json.loads(pathlib.Path("figures/surfaces.json").read_text())
        self.assertEqual([one["title"] for one in drawn], ["small.sdf", "disc patch", "disc", "pin"])
        for one, told in zip(drawn[:1] + drawn[2:], found, strict=True):
            for name in ("columns", "rows", "points", "measured", "pitch", "Sq", "Sk", "Sal"):
                self.assertEqual(one[name], told[name], name)
            # The heights as they are drawn, line by line.
            heights = np.load(f"figures/{one['heights']}")
            self.assertEqual(heights.shape, (one["rows"], one["columns"]))
            self.assertAlmostEqual(1e6 * np.nanstd(heights), told["Sq"], delta=1e-9)
        self.assertTrue(pathlib.Path("figures/fibre_map.json").is_file())

    def test_what_needs_too_much_memory_is_told(self):
        pathlib.Path("data").mkdir()
        np.save("data/heights-0.npy", np.zeros((3, 4)))
        one = {"name": "small.sdf", "grid": {"heights": "heights-0.npy", "columns": 4, "rows": 3, "pitch": None}}
        pathlib.Path("data/surfaces.json").write_text(json.dumps([one]))
        with unittest.mock.patch("plateau.surface_description.parameters", side_effect=MemoryError("no room")):
            status, _, said = word("surface", "describe", "data")
        self.assertEqual(status, 2)
        self.assertIn("small.sdf: its 4 x 3 points can be read, but to describe them needs more memory", said)
