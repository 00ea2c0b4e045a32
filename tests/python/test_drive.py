"""The shipped drive: what its brake does is what the car asks for, by the speed of the car alone."""

import csv
import itertools
import math
import subprocess
import sys
import unittest

import h5py
from package_scenes import ROOT, InFolder

import plateau

CYCLES = ROOT / "data" / "cycles"
SCENE = ROOT / "data" / "scenes" / "drive.toml"
# The car of front_brake.py: mass, kg, and road load, N and N s²/m²; half of 70 % of what it brakes is one front wheel's.
MASS, ROLLING, AIR, ONE_WHEEL = 1500.0, 130.0, 0.45, 0.35
# The pin is 161 of 2764 columns of a ring from 20 to 24 mm, the pads are 100 cm².
SHARE = math.pi * (24e-3**2 - 20e-3**2) * 161 / 2764 / 100e-4


def kinetic_and_road(before, after, seconds):
    """Kinetic energy that a car loses between two speeds, m/s, and what of it the road takes, J.

    With a straight line between the speeds, ∫v dt and ∫v³ dt are D (v₀ + v₁)/2 and D (v₀ + v₁)(v₀² + v₁²)/4.
    """
    kinetic = MASS / 2 * (before**2 - after**2)
    return kinetic, seconds * (before + after) * (ROLLING / 2 + AIR / 4 * (before**2 + after**2))


def braking_energy(until):
    """Energy that the car's brakes take until a time, s, in J."""
    with open(CYCLES / "wltc-class3b.csv", newline="") as file:
        rows = [(float(row["time [s]"]), float(row["road_speed [km/h]"]) / 3.6) for row in csv.DictReader(file)]
    losses = [kinetic_and_road(one[1], other[1], other[0] - one[0]) for one, other in itertools.pairwise(rows) if other[0] <= until]
    return sum(max(0.0, kinetic - road) for kinetic, road in losses)


class Drive(InFolder):
    def test_the_shipped_cycle_is_what_the_script_writes(self):
        command = [sys.executable, "-B", str(CYCLES / "front_brake.py"), str(CYCLES / "wltc-class3b.csv")]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        self.assertEqual(done.stdout, (CYCLES / "wltc-front-brake.csv").read_text())

    def test_friction_work_is_the_braking_energy_of_the_car(self):
        plateau.run(SCENE, "drive.h5", set={"operation.duration": "200 s", "numerics.time_acceleration": 10})
        expected = ONE_WHEEL * SHARE * braking_energy(200.0)
        with h5py.File("drive.h5") as run:
            work = run["series/friction_work"][-1]
        self.assertLess(abs(work / expected - 1.0), 0.01)


if __name__ == "__main__":
    unittest.main()
