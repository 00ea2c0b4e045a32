"""The program against an independent model in extended precision (extended_precision.py), over random scenes of every option."""

import itertools
import sys
import unittest

import h5py
import numpy as np
import small_scenes
from checkout import ROOT, Folder, program
from extended_precision import IS_WIDER, VOLUMES, run

VECTORS = ROOT / "tests" / "vectors"
# Accepted deviation of heights, m.
HEIGHT = 1e-12
# Accepted deviation of series, in parts of the largest value of each; of the fractions, in parts of 1.
RELATIVE = 1e-9
FRACTIONS = {"contact_ratio", "pin_primary", "pin_secondary", "pin_none", "disc_secondary", "filled_fraction"}
# Captured fraction, share of the pin, time acceleration and share of fibres, dealt out over the scenes.
CHOICES = [(0.3, 0.5, 20, 0.4), (1.0, 0.3, 1, 0.7), (0.05, 1.0, 100, 0.2), (0.6, 0.0, 10, 0.5), (0.1, 0.8, 50, 0.4)]
# What materials of the pin, debris and operation take beyond the paper, each alone and all at once.
COUNTERFACE = {"pin_primary": {"wear_rate_against_secondary": "2e-13 1/Pa"}, "pin_secondary": {"wear_rate_against_secondary": "1e-14 1/Pa"}}
STRENGTH = {"pin_secondary": {"strength": "2e6 Pa"}}
# A little more than three columns at the mean radius of the small scenes.
TRANSPORT = {"transport_length": "0.0067 m"}
FRICTION = {
    "pressure_coefficient": 0.3,
    "shear_strength": "2e5 Pa",
    "maximum": 0.6,
    "secondary": {"pressure_coefficient": 0.2},
    "resin": {"shear_strength": "1e4 Pa"},
}
# Seeds of scenes in which a pool that has given all decides the result.
EMPTIED = [54, 64]


def plateaus(debris, captured_fraction, pad_share=0.5, formation=True, destruction=True):
    """The table of a scene, with the keys that this debris has."""
    common = {"captured_fraction": captured_fraction, "formation": formation}
    if debris == "local":
        return {"debris": "local", **common}
    return {"debris_pool": debris, "pad_share": pad_share, "destruction": destruction, **common}


def with_properties(materials, *additions):
    """Materials to which each addition gives properties."""
    names = {name: {} for name in materials}
    for addition in additions:
        for name, properties in addition.items():
            names[name] |= properties
    return {name: properties | names[name] for name, properties in materials.items()}


class Comparison(Folder):
    @classmethod
    def setUpClass(cls):
        if not IS_WIDER:
            reason = "NumPy's longdouble is no wider than float64 on this machine"
            print(f"nothing is compared in extended precision: {reason}", file=sys.stderr)
            raise unittest.SkipTest(reason)

    def assert_heights(self, expected, disc, pin):
        for name, height, found in [("disc", expected.disc_height, disc), ("pin", expected.pin_height, pin)]:
            self.assertEqual(found.shape, height.shape, name)
            deviation = np.abs(found - height)
            cell = tuple(map(int, np.unravel_index(deviation.argmax(), deviation.shape)))
            worst = float(deviation[cell])
            self.assertLessEqual(worst, HEIGHT, f"{name} height at (column, row) {cell} is {worst:.1e} m off")

    def assert_series(self, name, expected, found):
        self.assertEqual(len(found), len(expected), name)
        scale = 1 if name in FRACTIONS else np.abs(expected).max()
        deviation = np.abs(found - expected)
        worst = int(deviation.argmax())
        text = f"{name} of sample {worst} is {found[worst]:.12e} instead of {expected[worst]:.12e}"
        self.assertLessEqual(float(deviation[worst]), float(RELATIVE * scale), text)


class Vectors(Comparison):
    """The extended-precision model against vectors of another independent implementation."""

    def compare(self, folder):
        parameters, state = small_scenes.read(folder / "scene.toml")
        series = run(parameters, state)
        with h5py.File(folder / "expected.h5") as file:
            self.assert_heights(state, file["/disc/height"][()], file["/pin/height"][()])
            series["load"] = series["mean_pressure"] * series["contact_area"]
            for name in file["/series"]:
                self.assert_series(name, series[name], file["/series"][name][()])
            for name in VOLUMES:
                found = file.attrs["destroyed" if name == "returned" else name]
                self.assert_series(name, series[name][-1:], np.array([found]))

    def test_vectors(self):
        for name in ["flat", "rough", "track", "local", "pair", "reach"]:
            with self.subTest(vector=name):
                self.compare(VECTORS / name)


class Program(Comparison):
    def compare(self, seed, every=1, **options):
        """Both take all steps of a scene; the extended-precision series."""
        scene = small_scenes.write(self.folder, seed, sample_every_steps=every, **options)
        output = self.folder / "run.h5"
        program("run", scene, "-o", output, "--force")
        parameters, state = small_scenes.read(scene)
        series = run(parameters, state, every)
        with h5py.File(output) as file:
            self.assert_heights(state, file["/disc/height"][-1], file["/pin/height"][-1])
            for name, expected in series.items():
                found = file["/time"] if name == "time" else file["/series"][name]
                self.assert_series(name, expected, found[()])
        return series

    def compare_all(self, scenes, names):
        """Compares scenes, by their seeds; their series, in which all of these names happened: else nothing would be compared."""
        series = []
        for seed, options in scenes.items():
            _, _, time_acceleration, fibres = CHOICES[seed % len(CHOICES)]
            with self.subTest(seed=seed, **options):
                series.append(self.compare(seed, time_acceleration=time_acceleration, fibres=fibres, **options))
        for name in names:
            self.assertTrue(any(one[name][-1] > 0 for one in series), f"{name} is 0 in every scene")
        return series

    def test_pools_of_every_option(self):
        options = itertools.product(
            ["contact", "track"],
            ["explicit", "exponential"],
            [(True, True), (True, False), (False, True)],
            [small_scenes.ALIKE, small_scenes.DIFFERENT],
        )
        scenes = {}
        for seed, (debris, integrator, switches, materials) in enumerate(options):
            captured_fraction, pad_share, *_ = CHOICES[seed % len(CHOICES)]
            debris = plateaus(debris, captured_fraction, pad_share, *switches)
            scenes[seed] = {"plateaus": debris, "materials": materials, "integrator": integrator}
        self.compare_all(scenes, VOLUMES)

    def test_long_runs_with_a_pool_for_each_track(self):
        # A flat pin of which every track runs empty of debris again and again. What rounding would leave in an emptied pool,
        # about 1e-32 m3, would make cells at height 0 secondary, and grow to micrometres in these steps.
        for seed in EMPTIED:
            with self.subTest(seed=seed):
                self.compare(
                    seed, every=10, plateaus=plateaus("track", 0.3), materials=small_scenes.ALIKE, steps=4000, pin_roughness=0.0, resin_recess=0.0
                )

    def test_local_debris_of_every_option(self):
        options = itertools.product(
            ["explicit", "exponential"], [(1.0, True), (0.4, True), (1.0, False)], [small_scenes.ALIKE, small_scenes.DIFFERENT]
        )
        scenes = {}
        for seed, (integrator, (captured_fraction, formation), materials) in enumerate(options):
            debris = plateaus("local", captured_fraction, formation=formation)
            scenes[seed] = {"plateaus": debris, "materials": materials, "integrator": integrator}
        self.compare_all(scenes, set(VOLUMES) - {"returned"})

    def test_counterface_strength_transport_length_and_torque(self):
        # Debris, and which of counterface, strength, transport length and torque a scene has.
        parts = [
            ("local", (True, False, False, False)),
            ("local", (False, True, False, False)),
            ("local", (False, False, True, False)),
            ("local", (False, False, False, True)),
            ("local", (True, True, True, True)),
            ("contact", (True, True, False, True)),
            ("track", (True, True, False, False)),
        ]
        scenes = {}
        options = itertools.product(["explicit", "exponential"], parts)
        for seed, (integrator, (debris, (counterface, strength, transport, torque))) in enumerate(options, 100):
            additions = [COUNTERFACE] * counterface + [STRENGTH] * strength
            scenes[seed] = {
                "plateaus": plateaus(debris, 0.8) | (TRANSPORT if transport else {}),
                "materials": with_properties(small_scenes.DIFFERENT, *additions),
                "integrator": integrator,
                "friction": FRICTION if torque else None,
                "torque": torque,
                "steps": 150,
            }
        for options, one in zip(scenes.values(), self.compare_all(scenes, VOLUMES), strict=True):
            if "strength" in options["materials"]["pin_secondary"]:
                self.assertGreater(one["returned"][-1], 0)
