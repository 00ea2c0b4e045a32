"""The model (docs/model.md) as it is written in Python: loops that Numba compiles (loops.py).

Reads lines of JSON and answers each with one. The first is a case: a scene with its surfaces, and what our program found in its first
steps, as pairs of a name and values. The answer has the versions, and how far what these loops find is from that. Each further line is
a number of steps to make; the answer has the seconds that they took, and the load evaluations of a step, mean over all so far.

For scenes with local debris and formation, explicit wear, a disc that does not wear, and build-ups with the properties of
what they lie on. Fields are arrays (column, row); z grows from the disc
to the pin.
"""

import json
import math
import platform
import sys
import time
from typing import NamedTuple

import numba
import numpy as np
from loops import step

# Largest accepted difference over the largest value.
TOLERANCE = 1e-10
# What is compared after every step: names, and those of the fields of a simulation.
TRACED = {"displacement": "displacement", "contact area": "contact_area", "deposited volume": "deposited"}


class Fields(NamedTuple):
    z_p: np.ndarray
    b_p: np.ndarray
    fibre: np.ndarray
    z_d: np.ndarray
    gap: np.ndarray
    stiffness: np.ndarray


class Rules(NamedTuple):
    area: np.ndarray  # of the cells of every row
    sliding: np.ndarray  # distance of one step in every row
    stiffness_plateau: float  # per area
    stiffness_resin: float
    wear_rate: float
    wear_height: float
    force: float
    tolerance: float
    captured: float
    reference_height: float  # highest disc height before the first step


class Simulation:
    """A pin on a disc, and the step that advances them."""

    def __init__(self, scene):
        rows, columns, ring = scene["rows"], scene["pin_columns"], scene["disc_columns"]
        z_p = np.array(scene["pin_height"]).reshape(columns, rows)
        self.fields = Fields(
            z_p=z_p,
            b_p=z_p.copy(),
            fibre=np.array(scene["pin_is_fibre"]).reshape(columns, rows),
            z_d=np.array(scene["disc_height"]).reshape(ring, rows),
            gap=np.empty_like(z_p),
            stiffness=np.empty_like(z_p),
        )

        width = (scene["outer_radius"] - scene["inner_radius"]) / rows
        angle = 2.0 * math.pi / ring
        radius = scene["inner_radius"] + (np.arange(rows) + 0.5) * width
        area = radius * width * angle

        def stiffness(pin):
            compliance = sum((1.0 - body["poisson_ratio"] ** 2) / body["youngs_modulus"] for body in (pin, scene["disc"]))
            return 1.0 / compliance / scene["foundation_height"]

        self.rules = Rules(
            area=area,
            sliding=scene["time_acceleration"] * radius * angle,
            stiffness_plateau=stiffness(scene["fibre"]),
            stiffness_resin=stiffness(scene["resin"]),
            wear_rate=scene["wear_rate"],
            wear_height=scene["wear_height"],
            force=scene["normal_force"],
            tolerance=scene["load_tolerance"],
            captured=scene["captured_fraction"],
            reference_height=float(self.fields.z_d.max()),
        )
        self.turned = 0
        self.displacement = math.nan
        self.contact_area = 0.0
        self.deposited = 0.0
        self.evaluations = 0

    def advance(self, steps):
        for _ in range(steps):
            self.displacement, self.contact_area, deposited, evaluations = step(self.fields, self.rules, self.turned, self.displacement)
            self.turned += 1
            self.deposited += deposited
            self.evaluations += evaluations


def differences(simulation, ours):
    """Makes the steps that ours are of: the largest difference over the largest value of each quantity, unless all its values are 0."""
    theirs = {name: [] for name in TRACED}
    for _ in range(len(dict(ours)["displacement"]) if ours else 0):
        simulation.advance(1)
        for name, field in TRACED.items():
            theirs[name].append(getattr(simulation, field))
    theirs["heights"] = np.concatenate([simulation.fields.z_d, simulation.fields.z_p]).ravel()

    found = []
    for quantity, expected in ours:
        expected = np.array(expected)
        difference = np.abs(theirs[quantity] - expected) / max(np.abs(expected).max(), sys.float_info.min)
        # What is not a number is the largest, and no agreement either
        worst = difference.argmax()
        if not difference[worst] <= TOLERANCE:
            sys.exit(
                f"Numba loops: {quantity} {worst} is {theirs[quantity][worst]} and ours {expected[worst]}, which differ by more than "
                f"{TOLERANCE} of the largest value; their times cannot be compared"
            )
        if expected.any():
            found.append([quantity, difference[worst]])
    return found


def main():
    case = json.loads(sys.stdin.readline())
    simulation = Simulation(case["scene"])
    versions = f"Python {platform.python_version()}, NumPy {np.__version__}, Numba {numba.__version__}"
    print(json.dumps({"versions": versions, "differences": differences(simulation, case["ours"])}), flush=True)
    for line in sys.stdin:
        start = time.perf_counter()
        simulation.advance(int(line))
        seconds = time.perf_counter() - start
        print(json.dumps({"seconds": seconds, "evaluations": simulation.evaluations / simulation.turned}), flush=True)


if __name__ == "__main__":
    main()
