"""Figures of series and of distributions show the numbers of the run file, in the units that they say. Numbers are read by h5py."""

import pathlib
import tomllib
import unittest
import unittest.mock
import warnings

import h5py
import matplotlib
import numpy as np
import xarray
from checkout import QUICK
from package_scenes import SHORT, InFolder
from small_scenes import lines

import plateau
from plateau import figures
from plateau.figures import maps
from plateau.figures.distributions import areas_of
from plateau.style import saved

HOT = tomllib.loads(QUICK.with_name("cermet-hot.toml").read_text())
# Time, s; load, N; speed of the disc, rpm, and of the vehicle, km/h.
CYCLE = [(0, 0, 850, 72), (2, 0, 850, 72), (2, 5, 850, 72), (6, 5, 425, 36), (6, 0, 425, 36), (10, 0, 850, 72), (10, 5, 850, 72), (16, 5, 0, 0)]


def series(path, *names):
    with h5py.File(path) as file:
        return [file["time" if name == "time" else f"series/{name}"][:] for name in names]


def line(axis, label):
    [found] = [line for line in axis.lines if line.get_label() == label]
    return found


def made_of(values, units):
    """A run of the first seed with these series, a sample a second."""
    [count] = {len(one) for one in values.values()}
    root = xarray.Dataset(coords={"time": np.arange(1.0, count + 1)}, attrs=plateau.open_run("seed-1.h5").attrs)
    own = xarray.Dataset({name: ("time", one, {"units": units}) for name, one in values.items()})
    return xarray.DataTree.from_dict({"/": root, "/series": own})


class Curves(InFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        rows = [",".join(map(str, row)) for row in CYCLE]
        pathlib.Path("drive.csv").write_text("\n".join(["time [s],normal_force [N],rotational_speed [rpm],road_speed [km/h]", *rows]) + "\n")
        # A disc as much smaller as the pin is.
        scene = HOT | {"extends": "quick.toml", "thermal": HOT["thermal"] | {"disc": HOT["thermal"]["disc"] | {"area": "3.25 cm^2"}}, "output": {}}
        scene |= {"operation": {"duration": "16 s", "cycle": {"file": "drive.csv", "interpolation": "linear"}}, "numerics": {"time_acceleration": 2}}
        pathlib.Path("drive.toml").write_text("\n".join(lines(scene)))
        plateau.run("drive.toml", "drive.h5")
        for seed in (1, 2, 3):
            plateau.run("quick.toml", f"seed-{seed}.h5", set=SHORT | {"disc.surface.synthetic.seed": seed})

    def test_contact_area(self):
        axis = plateau.plot("seed-1.h5", "contact-area").axes[0]
        time, mean, single = series("seed-1.h5", "time", "contact_area_mean", "contact_area")
        drawn = line(axis, "mean of the last simulated revolution")
        # 200 samples: each is drawn.
        np.testing.assert_allclose(drawn.get_xdata(), time)
        np.testing.assert_allclose(drawn.get_ydata(), 1e6 * mean)
        np.testing.assert_allclose(line(axis, "single steps").get_ydata(), 1e6 * single)
        self.assertEqual((axis.get_xlabel(), axis.get_ylabel(), axis.get_ylim()[0]), ("time, s", "contact area, mm²", 0))

    def test_cycles(self):
        force, speed, area = plateau.plot("drive.h5", "contact-area").axes
        time, load, turning, way = series("drive.h5", "time", "normal_force", "rotational_speed", "road_distance")
        self.assertEqual(force.get_ylabel(), "normal\nforce, N")
        np.testing.assert_allclose(force.lines[0].get_ydata(), load)
        self.assertEqual(speed.get_ylabel(), "speed of the\nvehicle, km/h")
        drawn = speed.lines[0].get_ydata()
        # The speeds of the table, at the middle of what lies between two samples.
        expected = np.interp(time - np.diff(time, prepend=0) / 2, [row[0] for row in CYCLE], [row[3] for row in CYCLE])
        np.testing.assert_allclose(drawn, expected, atol=0.6)
        self.assertAlmostEqual(float(np.sum(drawn / 3.6 * np.diff(time, prepend=0))), way[-1], delta=1e-6 * way[-1])
        rubs = (load > 0) & (turning > 0)
        self.assertTrue(rubs.any() and not rubs.all())
        for label in ("mean of the last simulated revolution", "single steps"):
            np.testing.assert_array_equal(np.isfinite(line(area, label).get_ydata()), rubs)
        with h5py.File("drive.h5") as file:
            ends = sorted([*file["event/start"][:], *file["event/end"][:]])
        [shades] = [one for one in area.collections if one.get_label() == "events of the cycle"]
        np.testing.assert_allclose(sorted({x for path in shades.get_paths() for x in path.vertices[:, 0]}), ends)

    def test_a_run_without_a_cycle_stands_beside_one_that_has_one(self):
        force, speed, _ = plateau.plot(["drive.h5", "seed-1.h5"], "contact-area").axes
        [time] = series("seed-1.h5", "time")
        # As in quick.toml; the speed of the vehicle is not known of both.
        for axis, expected, label in ((force, 5.0, "normal\nforce, N"), (speed, 850.0, "speed of the\ndisc, rpm")):
            one = axis.lines[1]
            np.testing.assert_allclose(one.get_xdata(), time)
            np.testing.assert_allclose(one.get_ydata(), expected)
            self.assertEqual(axis.get_ylabel(), label)
        np.testing.assert_allclose(speed.lines[0].get_ydata(), series("drive.h5", "rotational_speed")[0] * 30 / np.pi)

    def test_every_single_step_of_a_long_cycle_is_a_dot(self):
        area = np.random.default_rng(1).random(4000)
        run = made_of({"contact_area": 1e-6 * area, "contact_area_mean": 1e-6 * area, "normal_force": 1 + area, "rotational_speed": 1 + area}, "m2")
        dots = line(plateau.plot(run, "contact-area").axes[2], "single steps")
        np.testing.assert_allclose(dots.get_ydata(), area)
        # As pixels, also in drawings of lines.
        self.assertTrue(dots.get_rasterized())

    def test_runs_with_few_samples(self):
        for count in (0, 1, 2):
            run = plateau.open_run("drive.h5").isel(time=slice(count))
            # Maps are drawn once: they do not know of samples.
            drawn = {name: draw for name, draw in figures.FIGURES.items() if count == 0 or name not in maps.FIGURES}
            with warnings.catch_warnings(), unittest.mock.patch.dict(figures.FIGURES, drawn, clear=True):
                warnings.simplefilter("error")
                warnings.simplefilter("ignore", plateau.PlateauWarning)
                found = plateau.plot(run)
                saved(found, ["svg"])
                saved({"two": plateau.plot([run, "seed-1.h5"], "contact-area")}, ["svg"])
            self.assertEqual("temperature" in found, count > 0)

    def test_unfinished_runs_are_said(self):
        run = plateau.open_run("seed-1.h5").copy()
        run.attrs["state"] = "interrupted"
        with self.assertWarnsRegex(plateau.PlateauWarning, "seed-1.h5 is not finished: its state is interrupted, with 200 samples"):
            plateau.plot(run, "filled")
        with self.assertRaisesRegex(plateau.InputError, "11 runs: expected 1 to 10"):
            plateau.plot(["seed-1.h5"] * 11)

    def test_ten_runs_have_lines_and_axes_of_their_own(self):
        with self.assertWarnsRegex(plateau.PlateauWarning, "named more than once"):
            ten, one = plateau.plot(["seed-1.h5"] * 10, "contact-area"), plateau.plot("seed-1.h5", "contact-area")
        looks = {(line.get_color(), str(line.get_linestyle())) for line in ten.axes[0].lines if line.get_label().startswith("Quick")}
        self.assertEqual(len(looks), 10)
        high = []
        for figure in (ten, one):
            figure.draw_without_rendering()
            high.append(figure.axes[0].bbox.height / figure.dpi * 25.4)
        self.assertGreater(high[0], 0.8 * high[1])

    def test_friction(self):
        left, right = plateau.plot("drive.h5", "friction").axes
        load, turning, pressure, coefficient = series("drive.h5", "normal_force", "rotational_speed", "mean_pressure", "friction_coefficient")
        [mean] = series("drive.h5", "friction_coefficient_mean")
        np.testing.assert_allclose(left.lines[0].get_ydata(), np.where((load > 0) & (turning > 0), mean, np.nan))
        unit = {"kPa": 1e-3, "MPa": 1e-6}[right.get_xlabel().rsplit(" ", 1)[1]]
        both = {(round(p * unit, 9), c) for p, c in zip(pressure, coefficient, strict=True)}
        dots = right.lines[0].get_xydata()
        self.assertTrue(20 < len(dots) <= 200 and all((round(p, 9), c) in both for p, c in dots))

    def test_temperatures_and_filling(self):
        axis = plateau.plot("drive.h5", "temperature").axes[0]
        contact, disc = series("drive.h5", "contact_temperature", "disc_temperature")
        self.assertEqual(axis.get_ylabel(), "temperature, °C")
        np.testing.assert_allclose(line(axis, "mean temperature of the disc").get_ydata(), disc - 273.15)
        drawn = line(axis, "temperature of the contact").get_ydata()
        np.testing.assert_allclose(drawn, contact - 273.15)
        self.assertTrue(np.isnan(drawn).any())
        axis = plateau.plot("drive.h5", "filled").axes[0]
        self.assertEqual(axis.get_ylabel(), "fraction, %")
        np.testing.assert_allclose(
            line(axis, "pin covered by secondary plateaus").get_ydata(), 100 * series("drive.h5", "pin_secondary")[0], rtol=1e-12
        )

    def test_no_peak_is_lost(self):
        values = np.sin(np.arange(20000))
        values[[777, 12345]] = 50, -50
        values[15000:15010] = np.nan
        run = made_of({"disc_temperature": 300 + values, "pin_temperature": 300 + values}, "K")
        figure = plateau.plot(run, "temperature")
        np.testing.assert_allclose(line(figure.axes[0], "mean temperature of the disc").get_ydata(), 300 + values - 273.15)
        # Where several points of a line are within one of the picture, fewer are written.
        self.assertLess(len(saved({"figure": figure}, ["svg"])["figure.svg"]), 20000 * 2 * 10)

    def test_debris(self):
        figure = plateau.plot("seed-1.h5", "debris")
        above, below = figure.axes
        names = ("worn_pin", "worn_resin", "worn_disc", "returned", "deposited_disc", "deposited_pin", "pool", "emitted")
        values = dict(zip(names, series("seed-1.h5", *names), strict=True))
        unit = {"µm³": 1e18, "mm³": 1e9}[above.get_ylabel().rsplit(" ", 1)[1]]
        worn = unit * sum(values[name][-1] for name in names[:4])
        self.assertAlmostEqual(above.lines[0].get_ydata()[-1], worn, delta=1e-9 * worn)
        # The stack reaches the line.
        self.assertAlmostEqual(max(c.get_paths()[0].vertices[:, 1].max() for c in above.collections), worn, delta=1e-6 * worn)
        unit = {"µm³": 1e18, "mm³": 1e9}[below.get_ylabel().rsplit(" ", 1)[1]]
        kept = unit * max(sum(values[name] for name in names[4:7]))
        self.assertAlmostEqual(max(c.get_paths()[0].vertices[:, 1].max() for c in below.collections), kept, delta=1e-6 * kept)
        pages = plateau.plot([f"seed-{seed}.h5" for seed in (1, 2, 3)], "debris", width=88)
        self.assertEqual(len(pages), 3)

    def test_emission(self):
        figure = plateau.plot("drive.h5", "emission")
        mass, _number, mass_per_way, number_per_way = figure.axes
        time, pm25, particles, way = series("drive.h5", "time", "pm25_mass", "particle_number", "road_distance")
        drawn = line(mass, "PM2.5")
        ends, rates = drawn.get_xdata(), drawn.get_ydata()
        self.assertLessEqual(len(ends), 61)
        self.assertEqual(drawn.get_drawstyle(), "steps-post")
        unit = {"ng/s": 1e12, "µg/s": 1e9}[mass.get_ylabel().split(", ")[1]]
        # The area below the curve is all that was emitted.
        self.assertAlmostEqual(np.sum(np.diff(ends) * rates[:-1]), pm25[-1] * unit, delta=1e-9 * pm25[-1] * unit)
        power = number_per_way.get_ylabel().split(", ")[1]
        per_km = number_per_way.lines[0].get_ydata()[-1] * float(f"1e{'⁰¹²³⁴⁵⁶⁷⁸⁹'.index(power[2])}" if power.startswith("10") else 1)
        self.assertTrue(power.endswith("km⁻¹"))
        self.assertAlmostEqual(per_km, particles[-1] / (way[-1] / 1000), delta=1e-9 * per_km)
        area, ratio = series("drive.h5", "contact_area", "contact_ratio")
        self.assertIn(f"Of the simulated pin, {1e6 * area[-1] / ratio[-1]:.3g} mm²", figure.get_supxlabel().replace("\n", " "))
        # 72 km/h for two seconds before anything is emitted: zeros, and nothing for the first twentieth of the way.
        self.assertGreaterEqual(np.interp(mass_per_way.lines[0].get_xdata()[0], time, way), 0.05 * way[-1])

    def test_seeds_are_a_band(self):
        paths = [f"seed-{seed}.h5" for seed in (1, 2, 3)]
        axis = plateau.plot(paths, "contact-area").axes[0]
        [drawn] = axis.lines
        self.assertRegex(drawn.get_label(), ": mean of 3 seeds$")
        every = np.array([series(path, "contact_area_mean")[0] for path in paths]) * 1e6
        np.testing.assert_allclose(drawn.get_ydata(), every.mean(axis=0))
        [band] = axis.collections
        self.assertAlmostEqual(band.get_paths()[0].vertices[:, 1].max(), every.max())
        # Two seeds, and a load that differs, are lines of their own, as wide as each other.
        plateau.run("quick.toml", "load.h5", set=SHORT | {"operation.normal_force": "6 N"}, force=True)
        axis = plateau.plot([*paths[:2], "load.h5"], "filled").axes[0]
        self.assertEqual(len(axis.lines), 3)
        self.assertEqual(len({one.get_linewidth() for one in axis.lines}), 1)
        self.assertEqual(len({(one.get_linestyle(), one.get_marker()) for one in axis.lines}), 3)

    def test_pulses_are_no_waves(self):
        at = np.arange(4000)
        slow, pulse = 1e-6 * (1 + at / 4000), np.sin(at / 2.3)
        copy = made_of({"contact_area_mean": slow * (1 + 0.3 * pulse), "contact_area": slow * (1 + 0.5 * pulse)}, "m2")
        figure = plateau.plot(copy, "contact-area")
        drawn = line(figure.axes[0], "weighted mean")
        # At the begin there are few values on either side.
        np.testing.assert_allclose(drawn.get_ydata()[8:], 1 + (drawn.get_xdata()[8:] - 1) / 4000, rtol=0.005)
        self.assertIn("weighted mean over 250 s where values pulse", figure.get_supxlabel().replace("\n", " "))
        [band] = figure.axes[0].collections
        # 5 and 95 % of a sine are 0.988 of its amplitude.
        self.assertAlmostEqual(band.get_paths()[0].vertices[:, 1].max(), 2 * 1.494, delta=0.06)

    def test_spots_and_plateaus(self):
        def flooded(belongs, areas, is_ring):
            """Areas of groups, cell by cell."""
            left, found = {(int(c), int(r)) for c, r in np.argwhere(belongs)}, []
            while left:
                edge, area = [left.pop()], 0.0
                while edge:
                    column, row = edge.pop()
                    area += areas[row]
                    for c, r in ((column + 1, row), (column - 1, row), (column, row + 1), (column, row - 1)):
                        near = (c % len(belongs) if is_ring else c, r)
                        if near in left:
                            left.remove(near)
                            edge.append(near)
                found.append(area)
            return sorted(found)

        random = np.random.default_rng(3)
        radii, angle = np.array([1.0, 1.5, 2.0, 2.5]), 0.1
        for is_ring in (True, False):
            belongs = random.random((30, 4)) < 0.5
            belongs[[0, -1], 1] = True
            np.testing.assert_allclose(areas_of(belongs, radii, angle, is_ring), flooded(belongs, radii * 0.5 * angle, is_ring))
        with h5py.File("seed-1.h5") as file:
            radii, angles = file["radius"][:], file["disc_angle"][:]
            ring = flooded(file["disc/status"][-1] == 2, radii * (radii[1] - radii[0]) * 2 * np.pi / len(angles), True)
            spots = flooded(file["pin/pressure"][-1] > 0, radii * (radii[1] - radii[0]) * 2 * np.pi / len(angles), False)
        axes = plateau.plot("seed-1.h5", "plateau-sizes").axes
        for axis, title, areas in ((axes[0], "contact spots of the pin", spots), (axes[2], "secondary plateaus of the disc", ring)):
            self.assertEqual(axis.get_title(loc="left"), title)
            # The number at least as large, up to each area.
            drawn = axis.lines[-1].get_xydata()
            self.assertEqual(drawn[0, 1], len(areas))
            self.assertEqual(axis.lines[-1].get_drawstyle(), "steps-pre")
            np.testing.assert_allclose(drawn[1:-1, 0], 1e6 * np.array(areas), rtol=1e-6)
            np.testing.assert_array_equal(drawn[1:-1, 1], np.arange(len(areas), 0, -1))
        self.assertEqual(axes[0].get_xlabel(), "area, mm²")

    def test_heights(self):
        disc, disc_ratio, pin, pin_ratio = plateau.plot("seed-1.h5", "heights").axes
        with h5py.File("seed-1.h5") as file:
            on_disc, on_pin = 1e6 * file["disc/height"][-1].ravel(), -1e6 * file["pin/height"][-1].ravel()
        on_pin -= on_pin.mean()
        for density, ratio, heights in ((disc, disc_ratio, on_disc), (pin, pin_ratio, on_pin)):
            part, at = ratio.lines[-1].get_xydata()[50]
            self.assertAlmostEqual(part, 25.0)
            self.assertAlmostEqual(np.mean(heights >= at), 0.25, delta=0.01)
            drawn = density.lines[-1]
            percent, middle = drawn.get_xdata(), drawn.get_ydata()
            width = middle[1] - middle[0]
            self.assertAlmostEqual(np.nansum(percent) * width, 100.0, delta=0.5)
            for index in np.flatnonzero(np.isfinite(percent))[::7]:
                inside = np.mean(np.abs(heights - middle[index]) < width / 2)
                self.assertAlmostEqual(percent[index] * width / 100, inside, delta=0.002)
        self.assertEqual((pin.get_ylabel(), pin.get_xlabel()), ("pin: height toward the disc, µm", "cells, % per µm"))

    def test_a_layout_that_is_set_moves_nothing(self):
        def files():
            return saved({"friction": plateau.plot("drive.h5", "friction")})

        expected = files()
        for setting in ("figure.autolayout", "figure.constrained_layout.use"):
            with matplotlib.rc_context({setting: True}):
                self.assertTrue(files() == expected, setting)

    def test_calls(self):
        run = plateau.open_run("drive.h5")
        self.assertAlmostEqual(run.plateau.plot.contact_area(width="150 mm").get_figwidth(), 150 / 25.4)
        axis = run.plateau.plot()
        figure = run.plateau.plot.contact_area(ax=axis)
        self.assertIs(figure, axis.figure)
        self.assertIn("plateau_sizes", dir(run.plateau.plot))
        with self.assertRaisesRegex(plateau.UnknownNameError, "no figure is called 'warmth', there are: topography, .*contact-area"):
            plateau.plot(run, "warmth")
        with self.assertRaisesRegex(AttributeError, "no figure is called 'warmth'"):
            run.plateau.plot.warmth()
        with self.assertRaisesRegex(plateau.InputError, r"it needs runs of scenes with \[emission\]"):
            plateau.plot("seed-1.h5", "emission")
        with self.assertRaisesRegex(plateau.InputError, "has 2 panels: leave ax out"):
            plateau.plot(run, "friction", ax=axis)
        with self.assertRaisesRegex(plateau.InputError, "contact_area, worn_pin have different units"):
            run.plateau.plot("contact_area", "worn_pin")
        with self.assertWarnsRegex(plateau.PlateauWarning, "seed-1.h5 has no series pm10_mass: left out of emission"):
            plateau.plot(["drive.h5", "seed-1.h5"], "emission")
        found = plateau.plot("drive.h5")
        self.assertLessEqual({"contact-area", "friction", "temperature", "filled", "plateau-sizes", "debris", "emission", "heights"}, set(found))
