"""One step of the model (docs/model.md) as it is written in Python: Numba loops or NumPy arrays.

    step.py numba|numpy DIRECTORY

reads scene.json and the surfaces from DIRECTORY, tells its versions, then answers requests, one JSON text a line:

    {"do": "trace", "steps": N}     displacement, contact area and debris pool after each of the next N steps
    {"do": "write"}                 writes the heights to DIRECTORY
    {"do": "advance", "steps": N}   makes N steps; the seconds that they took, the load evaluations of all steps so far

For scenes with one debris pool, explicit wear, formation and destruction, a disc that does not wear, and build-ups
with the properties of what they lie on. Fields are arrays (column, row); z grows from the disc to the pin.
"""
import json
import math
import platform
import sys
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np

MOST_EVALUATIONS = 200


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
    pin_area: float
    stiffness_plateau: float  # per area
    stiffness_resin: float
    wear_rate: float
    wear_height: float
    force: float
    tolerance: float
    captured: float
    pad_share: float


def loops(fields, rules, turned, displacement, pool):
    """The step as loops over cells, for Numba."""
    z_p, b_p, fibre, z_d, gap, stiffness = fields
    area, sliding = rules.area, rules.sliding
    columns, rows = z_p.shape
    ring = z_d.shape[0]

    # Load balance: Newton's method from the last displacement
    highest = math.inf
    for j in range(columns):
        c = (j - turned) % ring
        for i in range(rows):
            gap[j, i] = z_p[j, i] - z_d[c, i]
            plateau = fibre[j, i] or z_p[j, i] < b_p[j, i]
            stiffness[j, i] = (rules.stiffness_plateau if plateau else rules.stiffness_resin) * area[i]
    if math.isnan(displacement):
        for j in range(columns):
            for i in range(rows):
                highest = min(highest, gap[j, i] + rules.force / stiffness[j, i])
        displacement = highest
    evaluations = 0
    while True:
        load, slope, contact_area = 0.0, 0.0, 0.0
        for j in range(columns):
            for i in range(rows):
                overlap = displacement - gap[j, i]
                if overlap > 0.0:
                    load += stiffness[j, i] * overlap
                    slope += stiffness[j, i]
                    contact_area += area[i]
        evaluations += 1
        if abs(load - rules.force) <= rules.tolerance * rules.force or evaluations == MOST_EVALUATIONS:
            break
        displacement += (rules.force - load) / slope

    # Wear, destruction and formation; column j + 1 is still as it was at the start of the step
    open_area = rules.pin_area - contact_area
    share = max(pool / open_area, 0.0) if open_area > 0.0 else 0.0
    worn, returned, deposited = 0.0, 0.0, 0.0
    for j in range(columns):
        c = (j - turned) % ring
        for i in range(rows):
            supported = j + 1 < columns and (fibre[j + 1, i] or z_p[j + 1, i] < b_p[j + 1, i])
            overlap = displacement - gap[j, i]
            if overlap > 0.0:
                if fibre[j, i] or z_p[j, i] < b_p[j, i]:
                    loss = rules.wear_rate * rules.stiffness_plateau * overlap * sliding[i]
                    if not fibre[j, i]:
                        loss = min(loss, b_p[j, i] - z_p[j, i])
                else:
                    loss = rules.wear_height
                worn += loss * area[i]
                z_p[j, i] += loss
                b_p[j, i] = max(b_p[j, i], z_p[j, i])
            if not fibre[j, i] and z_p[j, i] < b_p[j, i] and not supported:
                returned += (b_p[j, i] - z_p[j, i]) * area[i]
                z_p[j, i] = b_p[j, i]
            clearance = z_p[j, i] - z_d[c, i] - displacement
            if overlap <= 0.0 and clearance > 0.0:
                deposit = min(clearance, share)
                on_pin = rules.pad_share * deposit if supported else 0.0
                z_p[j, i] -= on_pin
                z_d[c, i] += deposit - on_pin
                deposited += deposit * area[i]
    return displacement, contact_area, pool + rules.captured * worn + returned - deposited, evaluations


def arrays(fields, rules, turned, displacement, pool):
    """The step as operations on whole arrays, for NumPy."""
    z_p, b_p, fibre, z_d, gap, stiffness = fields
    under = (np.arange(z_p.shape[0]) - turned) % z_d.shape[0]
    disc = z_d[under]
    secondary = z_p < b_p
    plateau = fibre | secondary
    supported = np.zeros_like(plateau)
    supported[:-1] = plateau[1:]

    # Load balance: Newton's method from the last displacement
    np.subtract(z_p, disc, out=gap)
    np.multiply(np.where(plateau, rules.stiffness_plateau, rules.stiffness_resin), rules.area, out=stiffness)
    if math.isnan(displacement):
        displacement = (gap + rules.force / stiffness).min()
    evaluations = 0
    while True:
        overlap = np.maximum(displacement - gap, 0.0)
        touches = overlap > 0.0
        load = (stiffness * overlap).sum()
        evaluations += 1
        if abs(load - rules.force) <= rules.tolerance * rules.force or evaluations == MOST_EVALUATIONS:
            break
        displacement += (rules.force - load) / (stiffness * touches).sum()
    contact_area = (touches * rules.area).sum()

    # Wear
    loss = overlap * (rules.wear_rate * rules.stiffness_plateau * rules.sliding)
    loss = np.where(secondary & ~fibre, np.minimum(loss, b_p - z_p), loss)
    loss = np.where(plateau, loss, rules.wear_height * touches)
    z_p += loss
    np.maximum(b_p, z_p, out=b_p)

    # Destruction
    build_up = np.where(fibre | supported, 0.0, b_p - z_p)
    np.copyto(z_p, b_p, where=build_up > 0.0)

    # Formation
    open_area = rules.pin_area - contact_area
    share = max(pool / open_area, 0.0) if open_area > 0.0 else 0.0
    clearance = np.where(touches, 0.0, z_p - disc - displacement)
    deposit = np.clip(clearance, 0.0, share)
    on_pin = np.where(supported, rules.pad_share * deposit, 0.0)
    z_p -= on_pin
    z_d[under] = disc + (deposit - on_pin)

    worn, returned, deposited = ((heights * rules.area).sum() for heights in (loss, build_up, deposit))
    return displacement, contact_area, pool + rules.captured * worn + returned - deposited, evaluations


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
            pin_area=float(columns * area.sum()),
            stiffness_plateau=stiffness(scene["fibre"]),
            stiffness_resin=stiffness(scene["resin"]),
            wear_rate=scene["wear_rate"],
            wear_height=scene["wear_height"],
            force=scene["normal_force"],
            tolerance=scene["load_tolerance"],
            captured=scene["captured_fraction"],
            pad_share=scene["pad_share"],
        )
        self.step = step
        self.turned = 0
        self.displacement = math.nan
        self.contact_area = 0.0
        self.pool = 0.0
        self.evaluations = 0

    def advance(self, steps):
        for _ in range(steps):
            self.displacement, self.contact_area, self.pool, evaluations = self.step(
                self.fields, self.rules, self.turned, self.displacement, self.pool
            )
            self.turned += 1
            self.evaluations += evaluations


def answer(simulation, directory, request):
    if request["do"] == "advance":
        start = time.perf_counter()
        simulation.advance(request["steps"])
        return {"seconds": time.perf_counter() - start, "evaluations": simulation.evaluations}
    if request["do"] == "trace":
        trace = {"displacement": [], "contact_area": [], "pool": []}
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
    kind, directory = sys.argv[1], Path(sys.argv[2])
    versions = f"Python {platform.python_version()}, NumPy {np.__version__}"
    if kind == "numba":
        import numba

        step = numba.njit(loops)
        versions += f", Numba {numba.__version__}"
    else:
        step = arrays
    simulation = Simulation(step, directory)
    print(json.dumps({"versions": versions}), flush=True)
    for line in sys.stdin:
        print(json.dumps(answer(simulation, directory, json.loads(line))), flush=True)


if __name__ == "__main__":
    main()
