"""The chain of heat from the pin's holder to the air round the disc (docs/model.md, section 11), as dense matrices.

Unknowns are the layers of the pin, those of the disc, each counted from the contact, and the contact itself, which stores
nothing: one linear system for each sub-step.
"""

import math
import re

import numpy as np
from moving_source import Disc, Substance, rise

LAYERS = 8
GROWTH = 1.4
CONTACT = 2 * LAYERS
UNITS = {"m": 1, "mm": 1e-3, "um": 1e-6, "cm^2": 1e-4, "mm^2": 1e-6, "rpm": 2 * math.pi / 60, "MPa": 1e6}
UNITS |= dict.fromkeys(("W/(m K)", "kg/m^3", "J/(kg K)", "W/K", "J/(K rad)", "N"), 1)


def quantity(text):
    """A quantity of a scene in SI units; temperatures in degC in K."""
    number, unit = re.fullmatch(r"(\S+) (.+)", text).groups()
    return float(number) + 273.15 if unit == "degC" else float(number) * UNITS[unit]


def substance(table):
    return Substance(*(quantity(table[key]) for key in ("conductivity", "density", "specific_heat")))


def disc_of(table):
    """What a disc cell passes under the pin as: the table [thermal.disc]."""
    coating = table.get("coating")
    if coating is None:
        return Disc(substance(table))
    return Disc(substance(table), substance(coating), quantity(coating["thickness"]))


def resistance(disc, columns, step, area):
    """R of the disc's face, K/W, where it moves on by a column in each step (s) under a pin of an area (m²)."""
    moving = np.mean([rise(disc, (column + 1) * step) for column in range(columns)]) / area
    at_rest = 0.479 / (disc.substrate.conductivity * math.sqrt(area))
    return (moving**-2 + at_rest**-2) ** -0.5


class Chain:
    """Temperatures above the ambient, K, of a scene's table [thermal] at a rotational speed (rad/s)."""

    def __init__(self, thermal, face, speed):
        pin, disc = thermal["pin"], thermal["disc"]
        count = CONTACT + 1
        self.flow, self.capacity = np.zeros((count, count)), np.zeros(count)
        for first, body, length in ((0, pin, pin["length"]), (LAYERS, disc, disc["thickness"])):
            what, area = substance(body), quantity(body["area"])
            thickness = quantity(length) * GROWTH ** np.arange(LAYERS) / (GROWTH ** np.arange(LAYERS)).sum()
            self.capacity[first : first + LAYERS] = what.density * what.specific_heat * area * thickness
            through = thickness / (what.conductivity * area)
            for layer in range(LAYERS - 1):
                self.link(first + layer, first + layer + 1, (through[layer] + through[layer + 1]) / 2)
            self.link(CONTACT, first, through[0] / 2 + (face if body is disc else 0))
        # To what stays at ambient temperature.
        self.flow[LAYERS - 1, LAYERS - 1] += quantity(pin["cooling"])
        self.flow[LAYERS, LAYERS] += quantity(disc["cooling"]) + quantity(disc["cooling_per_speed"]) * speed
        self.face = face
        self.first = quantity(disc["thickness"]) / (GROWTH ** np.arange(LAYERS)).sum() / 2
        self.first /= quantity(disc["conductivity"]) * quantity(disc["area"])
        self.excess = np.zeros(count)

    def link(self, one, other, resistance):
        for here, there in ((one, other), (other, one)):
            self.flow[here, here] += 1 / resistance
            self.flow[here, there] -= 1 / resistance

    def advance(self, power, time):
        """Takes a power (W) for a time (s), by implicit Euler in equal sub-steps of at most 0.1 s."""
        count = math.ceil(time / 0.1 - 1e-9)
        inertia = np.diag(self.capacity / (time / count))
        source = np.zeros(len(self.excess))
        source[CONTACT] = power
        for _ in range(count):
            self.excess = np.linalg.solve(inertia + self.flow, inertia @ self.excess + source)

    @property
    def contact(self):
        return self.excess[CONTACT]

    @property
    def into_disc(self):
        """Power into the disc, W."""
        return (self.excess[CONTACT] - self.excess[LAYERS]) / (self.face + self.first)

    @property
    def disc_face(self):
        """The disc's face beside what passes under the pin."""
        return self.contact - self.into_disc * self.face
