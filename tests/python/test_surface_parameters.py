"""Parameters of surfaces: in closed form where it is known, as other programs have them, and as this program computed them in Rust."""

import json
import math
import pathlib
import statistics
import unittest
import warnings
from math import tau

import numpy as np
from checkout import ROOT, SHARED

import plateau
from plateau.surface_parameters import PARAMETERS, _Curve, parameters, sampling_errors

PITCH = (2e-6, 5e-7)


def grid(columns, rows, height):
    """Heights over the indices of column and row."""
    y, x = np.indices((rows, columns)).astype(float)
    return height(x, y) + 0.0 * x


class ClosedForms(unittest.TestCase):
    def near(self, found, expected, relative):
        self.assertAlmostEqual(found / expected, 1.0, delta=relative)

    def test_slopes_of_a_plane(self):
        # z = 3 x + 4 y: Sdq = 5, Sdr = the root of 26, less 1, and nothing changes where a point is missing.
        plane = grid(20, 30, lambda x, y: 3 * 2e-6 * x + 4 * 5e-7 * y)
        for missing in (0, 40):
            plane.flat[:missing:13] = np.nan
            found = parameters(plane, PITCH)
            self.near(found["Sdq"], 5.0, 1e-12)
            self.near(found["Sdr"], math.sqrt(26) - 1, 1e-12)

    def test_slopes_of_a_pyramid(self):
        # One peak of height h on 3 x 3 points of pitch 1: along either axis the middle line has two differences of h among six. Each of the four
        # cells has, of its four corner triangles, one with the squared slope 2h² at the peak, two with h², one that is flat.
        h, pyramid = 0.75, np.zeros((3, 3))
        pyramid[1, 1] = h
        found = parameters(pyramid, (1.0, 1.0))
        self.near(found["Sdq"], math.sqrt(4 / 6) * h, 1e-14)
        self.near(found["Sdr"], (math.sqrt(1 + 2 * h * h) + 2 * math.sqrt(1 + h * h) + 1) / 4 - 1, 1e-14)
        # Digits that the difference of nearly equal areas would lose: Sdr is half the square of the slope.
        self.near(parameters(1e-9 * pyramid, (1.0, 1.0))["Sdr"], h * h * 1e-18 / 2, 1e-12)

    def test_profiles_of_a_sinusoid(self):
        # A sine over whole periods along x on anything that changes across: Ra is the sum (2/n) cot(pi/n) of n points a period, n divisible by 4.
        heights = grid(200, 60, lambda x, y: np.sin(tau * x / 40) + 5 * y * y)
        found = parameters(heights, PITCH)
        self.near(found["Ra_x"], 2 / 40 / math.tan(math.pi / 40), 1e-10)
        self.near(found["Rq_x"], math.sqrt(0.5), 1e-10)
        self.near(found["Rku_x"], 1.5, 1e-9)
        self.assertAlmostEqual(found["Rsk_x"], 0.0, delta=1e-9)
        powers = [np.mean(np.arange(60.0) ** k) for k in (4, 2)]
        self.near(found["Rq_y"], 5 * math.sqrt(powers[0] - powers[1] ** 2), 1e-9)
        # A row with less than half of its points does not count.
        heights[7, 99:] = np.nan
        self.near(parameters(heights, PITCH)["Rq_x"], math.sqrt(0.5), 1e-10)

    def test_the_autocorrelation_of_a_sinusoid(self):
        # cos(kx) has the autocorrelation cos(ks), for ever the same along y: Str has no value, but is below Sal over the longest line that stays
        # above 0.2, to the edge of the window beside the place at which the wave has fallen.
        found = parameters(grid(4000, 64, lambda x, y: np.cos(tau * x / 40)), PITCH)
        length = math.acos(0.2) / tau * 40 * 2e-6
        self.near(found["Sal"], length, 5e-3)
        self.near(found["Str_below"], length / math.hypot(length, 32 * 5e-7), 0.06)
        self.assertTrue(math.isnan(found["Str"]))

    def test_the_autocorrelation_of_waves_in_two_directions(self):
        # cos(kx) + cos(ly), equal parts: r = (cos ks + cos lt)/2, followed in small steps.
        found = parameters(grid(1200, 2400, lambda x, y: np.cos(tau * x / 40) + np.cos(tau * y / 80)), PITCH)
        angles, distance = np.linspace(0, math.pi / 2, 901), np.arange(0, 40e-6, 1e-8)[:, None]
        r = 0.5 * (np.cos(tau / 80e-6 * distance * np.cos(angles)) + np.cos(tau / 40e-6 * distance * np.sin(angles)))
        reaches = distance[np.argmax(r <= 0.2, axis=0), 0]
        self.near(found["Sal"], reaches.min(), 0.02)
        self.near(found["Str"], reaches.min() / reaches.max(), 0.04)

    def test_the_direction_of_a_lay_is_that_of_its_grooves(self):
        # With noise of half their rms height and a tenth of the points missing, on points that are 4 times as far apart along x, too.
        noise = np.random.default_rng(8).normal(size=40_000)
        for degrees in (0, 10, 45, 87, 90, -20, -75):
            sine, cosine = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
            for columns, rows, pitch, wave in ((200, 200, (1e-6, 1e-6), 12.3e-6), (100, 400, (4e-6, 1e-6), 33e-6)):
                heights = grid(columns, rows, lambda x, y: np.cos(tau * (y * pitch[1] * cosine - x * pitch[0] * sine) / wave))
                heights = math.sqrt(2) * heights + 0.5 * noise.reshape(rows, columns)
                heights.flat[3::10] = np.nan
                found = parameters(heights, pitch)["Std"]
                # A wave of the length w over the reach R has a width of w/R: here from 4 to 9 degrees.
                self.assertLess(abs((math.degrees(found) - degrees + 90) % 180 - 90), 0.3)
                self.assertTrue(-math.pi / 2 < found <= math.pi / 2)

    def test_what_varies_from_point_to_point_has_no_length(self):
        noise = np.random.default_rng(5).normal(size=(201, 301))
        holed = noise.copy()
        holed.flat[::3] = np.nan
        # A lay of lines of one point across ends nowhere along x, but how wide it is nobody knows.
        for heights in (noise, holed, np.repeat(noise[:, :1], 300, axis=1)):
            found = parameters(heights, PITCH)
            self.assertTrue(found["below_pitch"] and all(math.isnan(found[name]) for name in ("Sal", "Str", "Std", "Str_below")))
        # Means of two points along either axis have r = 1/2 at the next one: linear, it falls to 0.2 at 1.6 points; between the axes sooner.
        smooth = noise[1:] + noise[:-1]
        found = parameters(smooth[:, 1:] + smooth[:, :-1], PITCH)
        self.near(found["Sal"], 1.6 * 5e-7, 0.03)
        self.near(found["Str"], 0.25, 0.05)
        # Along y alone: what is left along x ends before the next point, so that the longest distance is unknown.
        found = parameters(smooth, PITCH)
        self.near(found["Sal"], 1.6 * 5e-7, 0.03)
        self.assertTrue(math.isnan(found["Str"]) and math.isnan(found["Str_below"]))

    def test_missing_points_take_no_part(self):
        # A third is missing at random: within the sampling error of 40 000 heights, 1/√N for Sq and a few times that for the others.
        random = np.random.default_rng(6)
        whole = random.normal(size=(200, 300))
        part = np.where(random.random(whole.shape) < 1 / 3, np.nan, whole)
        found, expected = parameters(part, PITCH), parameters(whole, PITCH)
        for name, relative in (("Sq", 0.015), ("Sk", 0.05), ("Rq_y", 0.015), ("Sdq", 0.02)):
            self.near(found[name], expected[name], relative)

    def test_what_the_heights_do_not_determine_is_no_number(self):
        found = parameters(np.zeros((10, 12)), PITCH)
        for name in PARAMETERS:
            shape = any(part in name for part in ("sk", "ku", "Smr", "Sal", "Str", "Std"))
            self.assertTrue(math.isnan(found[name]) if shape else found[name] == 0.0, name)
        self.assertFalse(found["below_pitch"])
        self.assertEqual(parameters(np.full((3, 2), np.nan), PITCH), {})
        for columns, rows in ((1, 1), (1, 9), (9, 1), (2, 2)):
            found = parameters(grid(columns, rows, lambda x, y: x + y * y), PITCH)
            self.assertEqual(math.isnan(found["Sk"]), columns * rows < 5)
        self.assertFalse({"Sdq", "Sdr", "Sal", "Str", "Std"} & parameters(np.eye(9), None).keys())

    def test_the_core_of_the_normal_distribution(self):
        # Heights at equal steps of the distribution function, and for N → ∞ Sk to Smr2 of the shared folder of surfaces, of which half the last
        # digit is unknown.
        normal, count = statistics.NormalDist(), 200_000
        found = parameters(np.array([[normal.inv_cdf((place + 0.5) / count) for place in range(count)]]), None)
        for name, expected, half_digit in (
            ("Sk", 2.57395, 5e-6),
            ("Spk", 0.945, 5e-5),
            ("Svk", 0.945, 5e-5),
            ("Smr1", 0.09905, 5e-6),
            ("Smr2", 0.90095, 5e-6),
        ):
            self.assertAlmostEqual(found[name], expected, delta=1.2 * half_digit + 1e-5)

    def test_a_uniform_distribution(self):
        # Heights (i + 1/2)/n: the curve is a straight line from 1 to 0, and all of it core; Vm(p) = p²/2, Vv(p) = (1 - p)²/2, to 1/n.
        count = 90_000
        found = parameters(((np.arange(count) * 7919 % count + 0.5) / count).reshape(300, 300), None)
        expected = {"Sa": 0.25, "Sq": 12**-0.5, "Sku": 1.8, "Sz": 1 - 1 / count, "Sk": 1.0}
        for name, value in expected.items():
            self.near(found[name], value, 1e-9)
        self.assertTrue(found["Spk"] < 1e-4 > found["Svk"] and found["Smr1"] < 2e-3 and found["Smr2"] > 0.99998)
        expected = {"Vmp": 0.005, "Vmc": 0.315, "Vvc": 0.385, "Vvv": 0.02, "Vm": 0.32, "Vv": 0.405, "Sxp": 0.475}
        for name, value in expected.items():
            self.near(found[name], value, 120 / count)

    def test_material_ratio_and_height_are_inverse(self):
        # By hand: heights 3, 2, 2, 1 less their mean 2.
        curve = _Curve(np.array([-1.0, 0.0, 0.0, 1.0]))
        self.assertEqual([curve.reaching(height) for height in (1.5, 1, 0.5, 0, -0.5, -1, -9)], [0, 1, 1, 3, 3, 4, 4])
        self.assertEqual(curve.at([0, 0.25, 0.26, 0.75, 0.8, 1]).tolist(), [1, 1, 0, 0, -1, -1])
        self.assertEqual((curve.material(-0.5), curve.void(-0.5)), (0.625, 0.125))

    def test_of_secants_that_are_equal_but_for_rounding_the_first_is_taken(self):
        # Ten heights 0.1 apart, each ten times, on a large offset: every secant over 40 % falls by 0.4 or, from where a step begins, 0.3 less.
        heights = np.repeat(0.1 * np.arange(10), 10).reshape(10, 10)
        for offset in (0.0, 3.7, 1e3):
            found = parameters(heights + offset, None)
            self.assertAlmostEqual(found["Sk"], parameters(heights, None)["Sk"], delta=1e-9)

    def test_sampling_errors_of_independent_normal_heights(self):
        # σ/√(2N) of the rms, √(6/N) of the skewness, √(24/N) of the kurtosis; four relative errors 1/√(2(B - 1)) of a jackknife.
        heights = np.random.default_rng(5).normal(size=(100, 150))
        found = sampling_errors(heights, (1.0, 1.0))
        for name, factor in (("Sq", 0.5), ("Ssk", 6), ("Sku", 24)):
            self.near(found[name], math.sqrt(factor / heights.size), 4 * 0.144)
        self.assertTrue(math.isnan(found["Sz"]) and math.isnan(found["Std"]))


class OtherPrograms(unittest.TestCase):
    """`values.json` of the shared surfaces: surfalize 0.19.2, slippy 0.5.2 and SurfaceTopography 1.27.1 after taking out the least-squares plane."""

    # File, letter of its values, distance of neighbouring stored heights, µm, and Sal, µm, and Str of the same autocorrelation followed in 3600
    # directions with cubic splines.
    ROWS = (
        ("alicona_200x296_iso1_int32.sdf", "A", 3.5558e-5, (12.406849, 0.460349)),
        ("alicona_200x296_iso1_int16_ascii.sdf", "A", 3.2845e-5, (12.406893, 0.460352)),
        ("lay_plu_384x288_iso1_binary64.sdf", "D", 0.0, (49.100353, None)),
        ("afm_256x256_iso2_int32.sdf", "E", 3.009e-10, None),
        ("frt_missing_150x300_iso1_int32.sdf", "F", 1.414e-7, None),
        ("pypi_afm_256x256_iso1_binary64.sdf", "G", 0.0, (0.060459, 0.698083)),
    )

    @unittest.skipIf(SHARED is None, "the shared surfaces are not there")
    def test_they_agree(self):
        values = json.loads((SHARED / "values.json").read_text().replace("NaN", "null"))
        for file, letter, step, spatial in self.ROWS:
            with warnings.catch_warnings(action="ignore"):
                # Of heights that stand for none.
                found = plateau.command("surface", SHARED / file, json=True)
            peers = next(of for name, of in values.items() if name.startswith(letter))
            points, compared = found["measured"], 0

            def agrees(peer, names, relative, absolute=0.0):
                for name in names:
                    expected = peers[peer].get(name) if peer in peers else None
                    if expected is not None:
                        self.assertAlmostEqual(found[name], expected, delta=relative * abs(expected) + absolute, msg=f"{file}, {name}, {peer}")
                        yield name

            # Beside 1e-6 there is what the file has rounded: of a height half a step, of means over all points relative errors step/√12 over Sq √n,
            # 3 and 4 of them, taken 10 times.
            rounded = step / (found["Sq"] * math.sqrt(points))
            for peer in ("own", "surfalize", "slippy"):
                compared += len([*agrees(peer, ("Sa", "Sq", "Sp", "Sv", "Sz"), 1e-6, step)])
                compared += len([*agrees(peer, ("Ssk", "Sku"), 1e-6 + 12 * rounded, 12 * rounded)])
            self.assertGreaterEqual(compared, 11, file)
            if letter == "F":
                # surfalize refuses missing points. Another program's curve from every point counts half of a spike that we count whole.
                half = found["Sp"] / 2 / points
                self.assertEqual(len([*agrees("exact_sk", ("Sk", "Svk"), 5e-3), *agrees("exact_sk", ("Smr1", "Smr2"), 0.0, 0.05)]), 4)
                self.assertEqual(len([*agrees("exact_sk", ("Spk",), 5e-3, 200 * half / found["Smr1"])]), 1)
                continue
            # It takes 10 000 quantiles for the curve, we every point; of the volumes it sums them up to the one before the material ratio.
            self.assertEqual(len([*agrees("surfalize", ("Sk", "Spk", "Svk"), 5e-3), *agrees("surfalize", ("Smr1", "Smr2"), 0.0, 0.05)]), 5)
            self.assertEqual(len([*agrees("surfalize", ("Vmp", "Vmc", "Vvc", "Vvv", "Sxp"), 4e-3)]), 5)
            # Rounding adds to every difference, at random, which mostly cancels, and squared, which does not.
            part = step / (found["Sdq"] * min(found["pitch"]))
            slope = 1e-9 + 3 * part / math.sqrt(points) + part * part
            self.assertEqual(len([*agrees("surfalize", ("Sdq",), slope), *agrees("surfalize", ("Sdr",), 2 * slope)]), 2)
            # It looks for the crossing of a spline at 1000 places, beside the difference of the interpolations: 0.1 points of 28 or more.
            self.assertEqual(len([*agrees("surfalize", ("Sal",), 0.1 / 28 + 1e-3)]), 1)
            if spatial:
                self.assertAlmostEqual(found["Sal"] / spatial[0], 1, delta=0.1 / 28)
                self.assertTrue(found["Str_below"] < 0.5 if spatial[1] is None else abs(found["Str"] / spatial[1] - 1) < 0.2 / 28)

    def test_the_numbers_are_those_of_the_program_in_rust(self):
        # expected/surfaces.json: `plateau surface ARGUMENTS --json` of the last program that computed them itself.
        recorded = json.loads((pathlib.Path(__file__).parent / "expected" / "surfaces.json").read_text())
        for arguments, surfaces in recorded.items():
            found = plateau.command("surface", *(ROOT / one if "/" in one else one for one in arguments.split()), json=True)
            for one, expected in zip(found if isinstance(found, list) else [found], surfaces, strict=True):
                self.same(one, expected, arguments)

    def same(self, found, expected, what):
        for name, value in expected.items():
            if isinstance(value, dict):
                self.same(found[name], value, f"{what}, {name}")
            elif value is None or isinstance(value, list):
                self.assertEqual(found[name], value, f"{what}, {name}")
            else:
                # Heights that are tiled are equal but for rounding, which chose the secant then.
                relative = 1e-4 if "prepare" in what and name in ("Sk", "Spk", "Svk", "Smr1", "Smr2") else 1e-9
                self.assertAlmostEqual(found[name], value, delta=relative * max(abs(value), 1e-3), msg=f"{what}, {name}")
