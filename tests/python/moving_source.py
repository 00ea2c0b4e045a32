"""Temperature of the disc's face under the pin from the whole history of the flux, with conduction along the surface.

The program's contact temperature map (docs/model.md, section 11) takes the pressures of one step for those of the whole pass
and conducts heat straight into the disc. Here both are left out: the disc is a half-space, with a coating if there is one, and
each wave number of the flux on its surface answers by itself. The flux is constant within a cell and a step; temperatures are
means over cells at the end of a step, above what the disc's face had before.
"""

import itertools
import math
from dataclasses import dataclass

import numpy as np

# Points of the contour of the inverse Laplace transform (Abate and Valkó 2004, fixed Talbot): 1e-10 in float64.
CONTOUR = 24
# How far from the pin heat is followed, in diffusion lengths 2 sqrt(a t) of the pass; beyond it is below exp(-16).
MARGIN = 4
# Aliases of a wave number that the mean over a cell is made of, on each side.
ALIASES = 6


@dataclass(frozen=True)
class Substance:
    """Conductivity W/(m K), density kg/m³, specific heat J/(kg K)."""

    conductivity: float
    density: float
    specific_heat: float

    @property
    def diffusivity(self):
        return self.conductivity / (self.density * self.specific_heat)

    @property
    def effusivity(self):
        return math.sqrt(self.conductivity * self.density * self.specific_heat)


@dataclass(frozen=True)
class Disc:
    """A half-space, with a coating of a thickness (m) if there is one."""

    substrate: Substance
    coating: Substance | None = None
    thickness: float = 0.0


def ierfc(x):
    return math.exp(-x * x) / math.sqrt(math.pi) - x * math.erfc(x)


def rise(disc, time):
    """U(t), K m²/W: rise of the surface under a uniform unit flux since t = 0 (Carslaw and Jaeger)."""
    if disc.coating is None:
        return 2 * math.sqrt(time / math.pi) / disc.substrate.effusivity
    if time == 0:
        return 0.0
    coating, substrate = disc.coating.effusivity, disc.substrate.effusivity
    reflection = (coating - substrate) / (coating + substrate)
    depth = disc.thickness / math.sqrt(disc.coating.diffusivity * time)
    # Beyond a depth of 30 ierfc is 0 in float64.
    terms = (reflection**k * ierfc(k * depth) for k in range(1, int(30 / depth) + 2))
    return 2 * math.sqrt(time) / coating * (1 / math.sqrt(math.pi) + 2 * sum(terms))


def weights(disc, count, step):
    """w_l = U((l + 1) Δt) − U(l Δt), of so many steps (s)."""
    return np.diff([rise(disc, number * step) for number in range(count + 1)])


def bare_rise_of_waves(substance, wave_numbers, time):
    """E(k, t) of a half-space, K m²/W: the same for a unit flux cos(k x), in closed form."""
    root = wave_numbers * math.sqrt(substance.diffusivity * time)
    erf = np.array([math.erf(value) for value in root])
    # The limit for k = 0 is 2 sqrt(t/π)/b.
    ratio = np.divide(erf, root, out=np.full_like(root, 2 / math.sqrt(math.pi)), where=root > 1e-8)
    return ratio * math.sqrt(time) / substance.effusivity


def rise_of_waves(disc, wave_numbers, time):
    """E(k, t) of any disc, K m²/W, by inversion of its Laplace transform."""
    angle = np.arange(1, CONTOUR) * np.pi / CONTOUR
    cotangent = 1 / np.tan(angle)
    pole = 2 * CONTOUR / 5 * np.concatenate([[1], angle * (cotangent + 1j)])
    factor = np.concatenate([[0.5], 1 + 1j * angle * (1 + cotangent**2) - 1j * cotangent]) * np.exp(pole)
    laplace = (pole / time)[:, None]

    def decay(substance):
        return np.sqrt(wave_numbers**2 + laplace / substance.diffusivity)

    admittance = disc.substrate.conductivity * decay(disc.substrate)
    impedance = 1 / admittance
    if disc.coating is not None:
        own = disc.coating.conductivity * decay(disc.coating)
        echo = (own - admittance) / (own + admittance) * np.exp(-2 * decay(disc.coating) * disc.thickness)
        impedance = (1 + echo) / (1 - echo) / own
    return 2 / (5 * time) * np.real(factor[:, None] * impedance / laplace).sum(axis=0)


def even(number):
    return 2 * math.ceil(number / 2)


class History:
    """Sums the history of a flux over so many steps, on a pin of (columns, rows) cells of a size (m, m)."""

    def __init__(self, disc, columns, rows, cell, step, steps, padded=(True, True)):
        self.disc, self.columns, self.rows, self.steps = disc, columns, rows, steps
        self.weights = weights(disc, steps, step)
        if padded is None:
            # For sums without conduction along the surface alone.
            return
        # Along an axis that is not padded the pattern repeats.
        margin = MARGIN * 2 * math.sqrt(disc.substrate.diffusivity * step * steps)
        needed = (columns + steps - 1 + margin / cell[0], rows + margin / cell[1])
        shape = zip(needed, (columns, rows), padded, strict=True)
        self.shape = tuple(even(count) if is_padded else own for count, own, is_padded in shape)
        self.kernel = self.kernel_of_means(cell, step)

    def kernel_of_means(self, cell, step):
        """What each wave of the flux leaves behind, step after step: flux and temperature are means over cells."""
        columns, rows = self.shape
        angles = 2 * np.pi * np.arange(columns // 2 + 1) / columns, 2 * np.pi * np.fft.rfftfreq(rows)
        # E falls smoothly with k: it is read from a table that is finer for small k.
        highest = math.hypot(*((2 * ALIASES + 1) * np.pi / size for size in cell))
        table = highest * np.linspace(0, 1, 2000) ** 3
        # Each wave that means over cells cannot tell from another one has its part in it.
        orders = range(-ALIASES, ALIASES + 1)
        aliases = []
        for order in itertools.product(orders, orders):
            along, across = (angle + 2 * np.pi * number for angle, number in zip(angles, order, strict=True))
            part = np.outer(np.sinc(along / (2 * np.pi)) ** 2, np.sinc(across / (2 * np.pi)) ** 2)
            aliases.append((np.hypot(along[:, None] / cell[0], across / cell[1]), part))
        kernel = np.zeros((self.steps, *aliases[0][1].shape))
        risen = np.zeros_like(table)
        for number in range(self.steps):
            before, risen = risen, self.rise_of_waves(table, (number + 1) * step)
            gain = risen - before
            for waves, part in aliases:
                kernel[number] += part * np.interp(waves, table, gain)
            # High waves answer at once and no more.
            aliases = [alias for alias in aliases if np.interp(alias[0].min(), table, gain) > 1e-6 * gain[0]]
        # The other half along the columns is the mirror image.
        return np.concatenate([kernel, kernel[:, (columns - 1) // 2 : 0 : -1]], axis=1)

    def rise_of_waves(self, waves, time):
        if self.disc.coating is None:
            return bare_rise_of_waves(self.disc.substrate, waves, time)
        return rise_of_waves(self.disc, waves, time)

    def in_disc_frame(self, flux, number):
        """Flux of the pin's cells, `number` steps before the last: the disc has moved on by as many columns."""
        field = np.zeros(self.shape)
        # Pin column j lay over the disc column that is now under j + number.
        field[(np.arange(self.columns) + number) % self.shape[0], : self.rows] = flux
        return field

    def spread(self, fluxes):
        """Rise of the whole surface at the last of the steps whose fluxes (step, column, row) are given."""
        total = 0
        for number in range(self.steps):
            total = total + self.kernel[number] * np.fft.rfft2(self.in_disc_frame(fluxes[-1 - number], number))
        return np.fft.irfft2(total, s=self.shape)

    def full(self, fluxes):
        """The same of the cells under the pin."""
        return self.spread(fluxes)[: self.columns, : self.rows]

    def straight(self, fluxes):
        """The same without conduction along the surface."""
        total = np.zeros((self.columns, self.rows))
        for number in range(min(self.steps, self.columns)):
            total[number:] += self.weights[number] * fluxes[-1 - number][: self.columns - number]
        return total

    def frozen(self, flux):
        """The program's map: no conduction along the surface, and this flux all the time."""
        return self.straight([flux] * self.steps)
