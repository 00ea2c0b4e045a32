"""The contact temperature map: what the program writes, and what its two simplifications cost (docs/drive.md)."""

import math
import re
import tomllib
import unittest

import h5py
import numpy as np
import small_scenes
from checkout import ROOT, Folder, changed, program
from heat_chain import Chain, disc_of, quantity, resistance
from moving_source import Disc, History, Substance, bare_rise_of_waves, rise, rise_of_waves

SCENES = ROOT / "data" / "scenes"
HOT = tomllib.loads((SCENES / "cermet-hot.toml").read_text())
IRON = Substance(50, 7200, 500)
CERMET = Substance(15, 13500, 250)


def plateau_run(folder, scene, changes=()):
    """Runs a scene in a folder; the path of the run file."""
    out = folder / "run.h5"
    program("run", scene, "-o", out, "--force", "--workers", "1", *changed(*changes))
    return out


class Mesh:
    """The mesh of a scene and its motion."""

    def __init__(self, scene):
        mesh = scene["mesh"]
        inner, outer = quantity(mesh["inner_radius"]), quantity(mesh["outer_radius"])
        self.rows, self.disc_columns, self.columns = mesh["rows"], mesh["disc_columns"], mesh["pin_columns"]
        self.mean_radius = (inner + outer) / 2
        self.angle = 2 * math.pi / self.disc_columns
        self.speed = quantity(scene["operation"]["rotational_speed"])
        self.step = self.angle / self.speed
        self.area = (outer**2 - inner**2) / 2 * self.angle * self.columns
        self.cell = (self.mean_radius * self.angle, (outer - inner) / self.rows)
        self.radius = inner + (np.arange(self.rows) + 0.5) * self.cell[1]


class ClosedForms(unittest.TestCase):
    """The history in Fourier space has the known solutions."""

    def test_waves_on_a_half_space_and_on_a_coating(self):
        waves = np.concatenate([[0.0], np.geomspace(1, 1e6, 40)])
        for time in (2e-5, 4e-3):
            exact = bare_rise_of_waves(IRON, waves, time)
            np.testing.assert_allclose(rise_of_waves(Disc(IRON), waves, time), exact, rtol=1e-10)
            # A coating of the substrate's own substance shows nothing, a uniform flux has the series of Carslaw and Jaeger,
            # and waves much shorter than the coating's thickness do not reach the substrate.
            np.testing.assert_allclose(rise_of_waves(Disc(IRON, IRON, 6e-5), waves, time), exact, rtol=1e-10)
            coated = Disc(IRON, CERMET, 6e-5)
            np.testing.assert_allclose(rise_of_waves(coated, waves[:1], time), rise(coated, time), rtol=1e-10)
            short = np.array([5e5, 1e6])
            np.testing.assert_allclose(rise_of_waves(coated, short, time), bare_rise_of_waves(CERMET, short, time), rtol=1e-10)

    def test_a_uniform_flux_on_a_plane_has_its_series(self):
        for disc in (Disc(IRON), Disc(IRON, CERMET, 6e-5)):
            history = History(disc, 12, 6, (5e-5, 4e-5), 2.5e-5, 20, padded=(False, False))
            np.testing.assert_allclose(history.full(np.ones((20, 12, 6))), rise(disc, 20 * 2.5e-5), rtol=1e-9)

    def test_what_spreads_along_the_surface_is_conserved(self):
        # Surface integral of the rise = Σ flux · area · w, wherever the heat has gone.
        history = History(Disc(IRON), 10, 8, (5e-5, 5e-5), 2.5e-5, 30)
        fluxes = np.random.default_rng(1).random((30, 10, 8))
        expected = (fluxes.sum(axis=(1, 2)) * history.weights[::-1]).sum()
        self.assertAlmostEqual(history.spread(fluxes).sum() / expected, 1, places=12)

    def test_a_short_flux_on_one_cell(self):
        # A flash on the plane leaves Q/(b sqrt(π t)), times a Gaussian of variance 2 a t along each axis; over cells and over
        # the time of the flux the mean is taken by quadrature.
        cell, step, steps = (5e-5, 4e-5), 2.5e-5, 25
        history = History(Disc(IRON), 9, 7, cell, step, steps)
        fluxes = np.zeros((steps, 9, 7))
        fluxes[0, 0, 3] = 1
        nodes, parts = np.polynomial.legendre.leggauss(40)
        # In the root of the time since then, which takes the singularity away.
        low, high = math.sqrt((steps - 1) * step), math.sqrt(steps * step)
        roots = (high - low) / 2 * nodes + (high + low) / 2

        def part(distance, width, root):
            deviation = math.sqrt(2 * IRON.diffusivity) * root

            def twice(x):
                gauss = math.exp(-((x / deviation) ** 2) / 2) / math.sqrt(2 * math.pi)
                return x * (1 + math.erf(x / deviation / math.sqrt(2))) / 2 + deviation * gauss

            return (twice((distance + 1) * width) - 2 * twice(distance * width) + twice((distance - 1) * width)) / width

        # The disc cell has moved on to column 24, of which the pin sees none: what it gave to its neighbours is looked at.
        field = history.spread(fluxes)
        for column, row in ((24, 3), (23, 3), (24, 4), (20, 5)):
            means = [part(column - 24, cell[0], root) * part(row - 3, cell[1], root) for root in roots]
            expected = 2 / (IRON.effusivity * math.sqrt(math.pi)) * (high - low) / 2 * (parts * means).sum()
            self.assertLess(abs(field[column, row] - expected), 2e-4 * field.max(), (column, row))

    def test_a_band_that_moves_slowly(self):
        # Jaeger's band in its steady state, at a Péclet number V l/(2a) = 1 with the half width l: heat goes ahead, too.
        columns, width = 40, 1e-5
        speed = 2 * IRON.diffusivity / (columns / 2 * width)
        steps = 15 * columns
        history = History(Disc(IRON), columns, 1, (width, width), width / speed, steps, padded=(True, False))
        found = history.full(np.ones((steps, columns, 1)))[:, 0]
        # K0(z) = ∫ exp(−z cosh s) ds; what lies ahead of a point warms it less than what lies behind.
        s = np.linspace(0, 12, 1500)
        offset = (np.arange(4000) + 0.5) / 4000 * columns * width
        for column in (5, 20, 35):
            # At the end of a step the disc is half a column ahead of where it was in the mean of the step.
            distance = (column + 1) * width - offset
            z = speed * np.abs(distance) / (2 * IRON.diffusivity)
            bessel = np.array([np.trapezoid(np.exp(-value * np.cosh(s)), s) for value in z])
            sign = speed * distance / (2 * IRON.diffusivity)
            expected = (np.exp(sign) * bessel).sum() * columns * width / 4000 / (math.pi * IRON.conductivity)
            self.assertLess(abs(found[column] / expected - 1), 0.005, column)

    def test_a_fast_band_is_warmest_at_its_end(self):
        # High Péclet number: no conduction along the surface, and the mean is 2/3 of the trailing edge (Jaeger).
        columns = 200
        history = History(Disc(IRON), columns, 1, (1e-3, 1e-3), 1e-6, columns, padded=(True, False))
        found = history.full(np.ones((columns, columns, 1)))[:, 0]
        self.assertLess(abs(found[-1] / rise(Disc(IRON), columns * 1e-6) - 1), 0.02)
        self.assertLess(abs(found.mean() / found[-20:].mean() - 2 / 3), 0.02)
        np.testing.assert_allclose(history.frozen(np.ones((columns, 1)))[-1], rise(Disc(IRON), columns * 1e-6), rtol=1e-12)


class Program(Folder):
    """The map that the program writes is the formula."""

    def test_the_map_equals_the_formula(self):
        for coated in (True, False):
            with self.subTest(coated=coated):
                self.compare(coated)

    def compare(self, coated):
        thermal = dict(HOT["thermal"].items())
        if not coated:
            thermal["disc"] = {key: value for key, value in thermal["disc"].items() if key != "coating"}
        quick = tomllib.loads((SCENES / "quick.toml").read_text())
        mesh, acceleration = Mesh(quick), 20
        # The last steps belong to no interval that has ended.
        columns = mesh.disc_columns
        scene = {
            "version": 1,
            "extends": str(SCENES / "quick.toml"),
            "operation": {"steps": 6 * columns + 100},
            "friction": HOT["friction"],
            "thermal": thermal,
            "numerics": {"time_acceleration": acceleration},
            "output": {"sample_every_steps": columns, "contact_temperature": True},
        }
        path = self.folder / "scene.toml"
        path.write_text("\n".join(small_scenes.lines(scene)) + "\n")
        with h5py.File(plateau_run(self.folder, path)) as run:
            series = {name: values[()] for name, values in run["series"].items()}
            pressure, found = run["pin/pressure"][-1], run["pin/temperature"][-1]
            self.assertEqual(found.shape, (mesh.columns, mesh.rows))
        self.assertEqual(len(series["time"]), 7)

        load = quantity(quick["operation"]["normal_force"])
        friction = HOT["friction"]
        law = friction["pressure_coefficient"] + quantity(friction["shear_strength"]) * series["contact_area"] / load
        coefficient = np.minimum(law, friction["maximum"])
        np.testing.assert_allclose(series["friction_coefficient"], coefficient, rtol=1e-12)

        disc = disc_of(thermal["disc"])
        face = resistance(disc, mesh.columns, mesh.step, mesh.area)
        chain = Chain(thermal, face, mesh.speed)
        interval = columns * acceleration * mesh.step
        ambient = quantity(thermal["ambient"])
        work = np.concatenate([[0.0], series["friction_work"][:6]])
        for number, power in enumerate(np.diff(work) / interval):
            chain.advance(power, interval)
            self.assertAlmostEqual(series["contact_temperature"][number], ambient + chain.contact, delta=1e-9 * chain.contact)
        # The last sample reports the interval that ended before it.
        self.assertEqual(series["contact_temperature"][-1], series["contact_temperature"][-2])

        share = chain.into_disc / power
        flux = share * coefficient[-1] * pressure * mesh.speed * mesh.mean_radius
        rises = History(disc, mesh.columns, mesh.rows, mesh.cell, mesh.step, mesh.columns, padded=None).frozen(flux)
        expected = ambient + chain.disc_face + rises
        largest = expected.max() - ambient
        self.assertGreater(rises.max(), 1)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * largest)
        self.assertAlmostEqual(series["contact_temperature_max"][-1], expected.max(), delta=1e-9 * largest)
        area = np.where(pressure > 0, mesh.radius, 0)
        heated = (expected * area).sum() / area.sum()
        self.assertAlmostEqual(series["contact_temperature_heated"][-1], heated, delta=1e-9 * largest)


class Simplifications(Folder):
    """The map against the whole history of the flux, on the paper's three discs: within what the document states."""

    def stated(self):
        """Heights: least and largest of each column, of the rows with a coating after 51 s."""
        text = (ROOT / "docs" / "drive.md").read_text()
        rows = re.findall(r"^\| coated, 51 s \| heights (?:/ )?(\S*) ?\|(.*)\|$", text, re.MULTILINE)
        number = r"([+−]?[\d.]+) to ([+−]?[\d.]+)"
        return {
            heights: [tuple(float(value.replace("−", "-")) / 100 for value in re.search(number, cell).groups()) for cell in cells.split("|")]
            for heights, cells in rows
        }

    def test_deviations_are_as_stated(self):
        scene = tomllib.loads((SCENES / "cermet.toml").read_text())
        mesh, disc = Mesh(scene), disc_of(HOT["thermal"]["disc"])
        history = History(disc, mesh.columns, mesh.rows, mesh.cell, mesh.step, mesh.columns)
        stated = self.stated()
        self.assertEqual(sorted(stated), ["1", "10", "100"])
        for heights, bounds in stated.items():
            pressures = self.pressures(mesh, 1 / float(heights))
            with self.subTest(heights=heights):
                for (low, high), found in zip(bounds, deviations(history, pressures).values(), strict=True):
                    self.assertTrue(low <= found <= high, f"{found} is not from {low} to {high}")

    def pressures(self, mesh, scale, steps=20000, acceleration=100):
        """Pressures of as many steps as the pin has columns, up to the last."""
        # In the middle of each step, so that rounding takes no other step.
        times = [(number - 0.5) * acceleration * mesh.step for number in range(steps - mesh.columns + 1, steps + 1)]
        changes = [
            f"disc.prepare.scale={scale!r}",
            f"operation.steps={steps}",
            f"numerics.time_acceleration={acceleration}",
            f"output.maps_at={[f'{time!r} s' for time in times]}",
            'output.maps=["pressure"]',
            f"output.sample_every_steps={steps}",
        ]
        with h5py.File(plateau_run(self.folder, SCENES / "cermet.toml", changes)) as run:
            pressures = run["pin/pressure"][()]
        self.assertEqual(len(pressures), mesh.columns)
        return pressures


def deviations(history, fluxes):
    """The map against the history: deviations in parts of the history's rise of the cells in contact."""
    touches = fluxes[-1] > 0
    full, straight, frozen = history.full(fluxes), history.straight(fluxes), history.frozen(fluxes[-1])

    def rms(values):
        return math.sqrt((values[touches] ** 2).mean())

    hottest = np.unravel_index(np.where(touches, full, 0).argmax(), full.shape)
    return {
        "rms": rms(frozen - full) / rms(full),
        "mean": frozen[touches].mean() / full[touches].mean() - 1,
        "hottest cell": frozen[hottest] / full[hottest] - 1,
        "largest": frozen.max() / full.max() - 1,
        "mean, frozen pressures alone": frozen[touches].mean() / straight[touches].mean() - 1,
        "mean, conduction along the surface alone": straight[touches].mean() / full[touches].mean() - 1,
    }
