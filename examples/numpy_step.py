#!/usr/bin/env python3
"""A step of the model (docs/model.md, local debris) in NumPy, beside the plain model of the program: a place to try a rule on all cells.

    python examples/numpy_step.py data/scenes/quick.toml --steps 200

It prints how far both are apart. The scene has local debris without transport length, strength, wear rates against secondary plateaus, heat
or a cycle.
"""

import argparse

import numpy as np

import plateau

RESIN, PRIMARY, SECONDARY = 0, 1, 2
# Parts of the model that this step does not have.
BEYOND = ("transport_length", "strength =", "wear_rate_against_secondary", "[thermal", "[operation.cycle]", "braking_torque")


def pascal(scene, key):
    """A value in Pa, or per Pa."""
    return float(scene[key].split()[0]) * {"Pa": 1.0, "MPa": 1e6, "GPa": 1e9, "1/Pa": 1.0}[scene[key].split()[1]]


class Model:
    """Heights of pin and disc, (columns, rows), and the step that all of them take."""

    def __init__(self, scene, simulation):
        if scene["plateaus.debris"] != "local" or any(key in scene.toml for key in BEYOND):
            raise SystemExit(f"expected a scene with local debris, and without {', '.join(BEYOND)}")
        self.pin, self.pin_base = simulation.pin_height.copy(), simulation.pin_substrate.copy()
        self.disc, self.disc_base = simulation.disc_height.copy(), simulation.disc_substrate.copy()
        self.is_resin, self.area, self.steps = simulation.pin_base == RESIN, simulation.cell_area, 0
        self.reference, self.load = self.disc.max(), simulation.normal_force
        self.sliding = scene["numerics.time_acceleration"] * simulation.radius * simulation.step_angle
        self.is_explicit, self.forms = scene["numerics.integrator"] == "explicit", scene["plateaus.formation"]
        self.captured = scene["plateaus.captured_fraction"]
        self.resin_loss = float(scene["materials.pin_resin.wear_height"].split()[0]) * 1e-6  # um
        height = float(scene["contact.foundation_height"].split()[0]) * 1e-6

        def compliance(name):
            return (1.0 - scene[f"materials.{name}.poisson_ratio"] ** 2) / pascal(scene, f"materials.{name}.youngs_modulus")

        pins, discs = ("pin_resin", "pin_primary", "pin_secondary"), ("disc_primary", "disc_secondary")
        self.stiffness = np.array([[1.0 / (compliance(pin) + compliance(disc)) / height for disc in discs] for pin in pins])
        self.pin_rate = np.array([0.0] + [pascal(scene, f"materials.{pin}.specific_wear_rate") for pin in pins[1:]])
        self.disc_rate = np.array([pascal(scene, f"materials.{disc}.specific_wear_rate") for disc in discs])

    def step(self):
        """Takes a step; gives the displacement, m."""
        under = (np.arange(len(self.pin)) - self.steps) % len(self.disc)
        disc, disc_base = self.disc[under], self.disc_base[under]
        status = np.where(self.pin < self.pin_base, SECONDARY, np.where(self.is_resin, RESIN, PRIMARY))
        covered = (disc > disc_base).astype(int)
        gap, stiffness = self.pin - disc, self.stiffness[status, covered]
        displacement = balance(self.load, gap, stiffness * self.area)
        overlap = np.maximum(displacement - gap, 0.0)
        touches, plateau_ahead = displacement > gap, status[1:] != RESIN

        # Wear: build-up first, then what it stands on.
        pin_rate, disc_rate = self.pin_rate[status], self.disc_rate[covered]
        own = np.where(self.is_resin, 0.0, self.pin_rate[PRIMARY])
        pin_lost = build_up_first(
            self.pin_base - self.pin, self.raw(pin_rate, disc_rate, stiffness, overlap), self.raw(own, disc_rate, stiffness, overlap)
        )
        pin_lost = np.where(touches & (status == RESIN), self.resin_loss, pin_lost)
        coating = self.raw(self.disc_rate[0], pin_rate, stiffness, overlap)
        disc_lost = build_up_first(disc - disc_base, self.raw(disc_rate, pin_rate, stiffness, overlap), coating)
        self.pin = self.pin + pin_lost
        self.pin_base = np.maximum(self.pin_base, self.pin)
        disc = disc - disc_lost
        disc_base = np.minimum(disc_base, disc)

        # Debris of the cell ahead fills the gap behind it: the pin up to the plateau ahead, then the disc up to its highest height.
        if self.forms:
            caught = self.captured * (pin_lost + disc_lost)[1:]
            ahead = np.where(plateau_ahead, self.pin[1:], np.inf)
            on_pin_at_most = np.maximum(self.pin[:-1] - ahead, 0.0)
            room = on_pin_at_most + np.maximum(self.reference - disc[:-1], 0.0)
            clearance = self.pin[:-1] - disc[:-1] - displacement
            deposit = np.where(touches[:-1], 0.0, np.maximum(np.minimum(np.minimum(clearance, room), caught), 0.0))
            on_pin = np.minimum(deposit, on_pin_at_most)
            self.pin[:-1] -= on_pin
            disc[:-1] += deposit - on_pin
        self.disc[under], self.disc_base[under] = disc, disc_base
        self.steps += 1
        return displacement

    def raw(self, own, other, stiffness, overlap):
        """Loss of a cell with the wear rate `own` that faces one with `other`, m."""
        if self.is_explicit:
            return own * stiffness * overlap * self.sliding
        both = own + other
        share = np.divide(own, both, out=np.zeros(np.shape(both)), where=both > 0.0)
        return overlap * -np.expm1(-both * stiffness * self.sliding) * share


def balance(load, gap, stiffness):
    """The displacement that carries a load: with the gaps in order, on the first piece of a piecewise linear load."""
    order = np.argsort(gap, axis=None)
    gap, stiffness = gap.ravel()[order], stiffness.ravel()[order]
    found = gap[0] + (load + np.cumsum(stiffness * (gap - gap[0]))) / np.cumsum(stiffness)
    return found[np.argmax(found <= np.append(gap[1:], np.inf))]


def build_up_first(build_up, raw, below):
    """What a cell loses: its build-up, then of what is below it the part of the step that is left."""
    left = 1.0 - np.divide(build_up, raw, out=np.ones(np.shape(raw)), where=raw > 0.0)
    return np.where(build_up <= 0.0, raw, np.where(raw < build_up, raw, build_up + left * below))


def main():
    """Takes the steps and compares."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", help="scene file")
    parser.add_argument("--steps", type=int, default=200, help="steps to take")
    arguments = parser.parse_args()

    scene = plateau.Scene(arguments.scene)
    simulation = plateau.Simulation(scene, engine="plain")
    model = Model(scene, simulation)
    apart = 0.0
    for _ in range(arguments.steps):
        displacement = model.step()
        simulation.advance()
        apart = max(apart, abs(displacement - simulation.displacement))
    heights = max(abs(model.pin - simulation.pin_height).max(), abs(model.disc - simulation.disc_height).max())
    print(f"{arguments.steps} steps: displacements at most {apart:.1e} m apart, heights {heights:.1e} m; displacement {displacement * 1e6:.6f} um")


if __name__ == "__main__":
    main()
