"""The model (docs/model.md) as it is written in Python: loops that Numba compiles (loops.py).

    step.py DIRECTORY

reads scene.json and the surfaces from DIRECTORY, tells its versions, then answers requests, one JSON text a line:

    {"do": "trace", "steps": N}     displacement, contact area and volume deposited so far after each of the next N steps
    {"do": "write"}                 writes the heights to DIRECTORY
    {"do": "advance", "steps": N}   makes N steps; the seconds that they took, the load evaluations of all steps so far

For scenes with local debris and formation, explicit wear, a disc that does not wear, and build-ups with the properties of
what they lie on. Fields are arrays (column, row); z grows from the disc
to the pin.
"""
import json
import math
import platform
import sys
import time
from pathlib import Path
from typing import NamedTuple

import numba
import numpy as np
from loops import step


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

    def __init__(self, step, directory):
        scene = json.loads((directory / "scene.json").read_text())
        rows, columns, ring = scene["rows"], scene["pin_columns"], scene["disc_columns"]
        z_p = np.fromfile(directory / "pin_height.f64", "<f8").reshape(columns, rows)
        self.fields = Fields(
            z_p=z_p,
            b_p=z_p.copy(),
            fibre=np.fromfile(directory / "pin_base.u8", "u1").reshape(columns, rows) == 1,
            z_d=np.fromfile(directory / "disc_height.f64", "<f8").reshape(ring, rows),
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
        self.step = step
        self.turned = 0
        self.displacement = math.nan
        self.contact_area = 0.0
        self.deposited = 0.0
        self.evaluations = 0

    def advance(self, steps):
        for _ in range(steps):
            self.displacement, self.contact_area, deposited, evaluations = self.step(
                self.fields, self.rules, self.turned, self.displacement
            )
            self.turned += 1
            self.deposited += deposited
            self.evaluations += evaluations


def answer(simulation, directory, request):
    if request["do"] == "advance":
        start = time.perf_counter()
        simulation.advance(request["steps"])
        return {"seconds": time.perf_counter() - start, "evaluations": simulation.evaluations}
    if request["do"] == "trace":
        trace = {"displacement": [], "contact_area": [], "deposited": []}
        for _ in range(request["steps"]):
            simulation.advance(1)
            for name, values in trace.items():
                values.append(float(getattr(simulation, name)))
        return trace
    if request["do"] == "write":
        simulation.fields.z_d.tofile(directory / "disc_height_after.f64")
        simulation.fields.z_p.tofile(directory / "pin_height_after.f64")
        return {}
    raise ValueError(f"unknown request {request}")


def main():
    directory = Path(sys.argv[1])
    versions = f"Python {platform.python_version()}, NumPy {np.__version__}, Numba {numba.__version__}"
    simulation = Simulation(step, directory)
    print(json.dumps({"versions": versions}), flush=True)
    for line in sys.stdin:
        print(json.dumps(answer(simulation, directory, json.loads(line))), flush=True)


if __name__ == "__main__":
    main()
