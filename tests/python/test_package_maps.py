"""Means, maps, build-up and figures of the Python package, against closed forms, sums written out by hand, and what the program prints;
and run files that are read while they are written and after a kill."""

import itertools
import os
import pathlib
import signal
import subprocess
import time
import unittest
import unittest.mock
import warnings

import h5py
import numpy as np
import xarray
from checkout import PROGRAM, changed, program
from package_scenes import PULSES, ROUND, SHORT, InFolder

import plateau
from plateau import means


def made_up(values, dtype=float):
    """A map of two angles and rows of radius 1 and 3, so that cells of the outer row have three times the area."""
    coordinates = {"disc_angle": [0.0, np.pi], "radius": [1.0, 3.0]}
    return xarray.DataArray(np.array(values, dtype), coordinates, ["disc_angle", "radius"], name="height")


class Means(unittest.TestCase):
    def test_standard_error_is_that_of_a_process_of_first_order(self):
        # The variance of a mean of n values in closed form, (1/n²) Σ φ^|i−k|, against the mean of 200 estimates. Chance moves that by
        # some hundredths, and the truncation makes it a little too large.
        random, count = np.random.default_rng(2), 500
        for alike in (0.0, 0.7):
            apart = np.abs(np.subtract.outer(np.arange(count), np.arange(count)))
            found = []
            for _ in range(200):
                values = np.empty(count)
                values[0] = random.standard_normal()
                for step, chance in enumerate(random.standard_normal(count - 1) * np.sqrt(1 - alike**2)):
                    values[step + 1] = alike * values[step] + chance
                found.append(means.standard_error(values) ** 2)
            self.assertAlmostEqual(np.mean(found) / ((alike**apart).sum() / count**2), 1.1, delta=0.2)

    def test_parts_of_a_run(self):
        time, turns = np.arange(1.0, 101.0), np.arange(1.0, 101.0) / 2
        self.assertEqual(means.last_tenth(time, None), (90.0, 100.0))
        # At least ten revolutions, and the whole run where that has no more.
        self.assertEqual(means.last_tenth(time, turns), (80.0, 100.0))
        self.assertEqual(means.last_tenth(time, turns / 10), (0.0, 100.0))
        # The integral of t is t²/2; between samples it is linear.
        found = means.mean_between(time, time**2 / 2, turns, 10.0, 20.0)
        self.assertAlmostEqual(found.value, 15.0)
        self.assertEqual((found.start, found.end, found.revolutions), (10.0, 20.0, 5.0))
        # Five blocks of a revolution each, with the means 11, 13, 15, 17, 19.
        self.assertAlmostEqual(found.error, means.standard_error(np.array([11.0, 13.0, 15.0, 17.0, 19.0])))
        self.assertTrue(np.isnan(means.mean_between(time, time**2 / 2, turns, 12.0, 20.0).error))
        self.assertAlmostEqual(means.mean_between(time, time**2 / 2, None, 0.0, 0.5).value, 0.5)
        for part in ((-1.0, 5.0), (5.0, 5.0), (5.0, 101.0)):
            with self.assertRaisesRegex(ValueError, "expected times in order"):
                means.mean_between(time, time, None, *part)

    def test_a_mean_is_over_the_time_in_which_there_is_a_value(self):
        # A value of 2 for 30 s, none for 40 s, 5 for 30 s.
        time = np.arange(1.0, 101.0)
        there = (time <= 30) | (time > 70)
        integral, known = np.cumsum(np.where(time <= 30, 2.0, 5.0) * there), np.cumsum(there * 1.0)

        def mean(start, end):
            return means.mean_between(time, integral, None, start, end, known)

        self.assertEqual([mean(*part).value for part in ((0, 30), (70, 100), (20, 90), (20, 50))], [2.0, 5.0, 4.0, 2.0])
        self.assertTrue(np.isnan(mean(40, 60).value))
        # Blocks without a value tell nothing of the error: ten of 2 and twenty of 5.
        self.assertAlmostEqual(mean(20, 90).error, means.standard_error(np.repeat([2.0, 5.0], [10, 20])), delta=1e-12)
        self.assertTrue(np.isnan(mean(28, 60).error))

    def test_a_mean_is_printed_with_its_unit_and_the_digits_that_are_known(self):
        # By hand: two digits of the error, the value to the same place.
        printed = {
            (5.1234e-7, 2.849e-8, "m2"): "(5.12 ± 0.28)e-07 m2",
            (300.123, 0.0999, "K"): "300.12 ± 0.10 K",
            (0.41268, 0.00231, "1"): "0.4127 ± 0.0023",
            (123456.0, 12345.6, "Pa"): "(1.23 ± 0.12)e+05 Pa",
            (2e7, 9.96e5, "Pa"): "(2.00 ± 0.10)e+07 Pa",
            (3.91877e-7, np.nan, "m2"): "3.919e-07 m2",
            (np.nan, np.nan, "K"): "nan K",
        }
        for (value, error, unit), text in printed.items():
            self.assertEqual(str(means.Mean(value, error, 54.0, 60.0, 85.0, unit)), f"{text} from 54 to 60 s")


class MadeUpMaps(unittest.TestCase):
    def test_means_count_areas_and_leave_out_what_is_not_there(self):
        self.assertAlmostEqual(made_up([[0, 4], [0, 4]]).plateau.area_mean().item(), 3.0)
        # (1·1 + 3·2) / (1 + 3)
        self.assertAlmostEqual(made_up([[1, 2], [np.nan, np.nan]]).plateau.area_mean().item(), 7 / 4)

    def test_fractions_of_statuses(self):
        flags = {"flag_values": [0, 1, 2], "flag_meanings": "none primary secondary"}
        outlined = {"flag_values": [0, 1, 2, 3], "flag_meanings": "none primary secondary absent"}
        status = made_up([[2, 1], [2, 0]], np.uint8).assign_attrs(flags)
        self.assertAlmostEqual(status.plateau.area_fraction("secondary").item(), 2 / 8)
        self.assertEqual(status.plateau.has_status("primary").values.tolist(), [[False, True], [False, False]])
        # Beyond a round pin: 1 / (1 + 1 + 3).
        absent = made_up([[2, 3], [1, 0]], np.uint8).assign_attrs(flags)
        self.assertAlmostEqual(absent.plateau.area_fraction("secondary").item(), 1 / 5)
        absent = absent.assign_attrs(outlined)
        parts = [absent.plateau.area_fraction(name).item() for name in ("none", "primary", "secondary")]
        self.assertAlmostEqual(sum(parts), 1)
        with self.assertRaisesRegex(ValueError, "absent cells are no part of the pin's area"):
            absent.plateau.area_fraction("absent")
        self.assertEqual(int(absent.plateau.has_status("absent").sum()), 1)
        with self.assertRaisesRegex(ValueError, "'half', there are: none, primary, secondary"):
            status.plateau.area_fraction("half")
        with self.assertRaisesRegex(ValueError, "this is no map of statuses"):
            made_up([[0, 0], [0, 0]]).plateau.has_status("none")

    def test_places(self):
        unrolled = made_up([[0, 4], [0, 4]]).plateau.unrolled()
        np.testing.assert_allclose(unrolled["arc_length"], [0.0, 2 * np.pi])
        self.assertEqual(unrolled.dims, ("arc_length", "radius"))
        plane = made_up([[0, 4], [0, 4]]).plateau.cartesian()
        np.testing.assert_allclose(plane["x"].transpose("disc_angle", "radius"), [[1, 3], [-1, -3]])
        np.testing.assert_allclose(plane["y"], 0.0, atol=1e-15)

    def test_what_is_no_map(self):
        with self.assertRaisesRegex(ValueError, "not a map; expected disc_angle or pin_angle"):
            xarray.DataArray([1.0], dims="time").plateau.area_mean()
        with self.assertRaisesRegex(plateau.InputError, "this tree is not a run"):
            xarray.DataTree().plateau.mean()


class Runs(InFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.run_ = plateau.run("quick.toml", "quick.h5", set=SHORT | PULSES)
        cls.round_ = plateau.run("quick.toml", "round.h5", set=ROUND | PULSES)

    def printed(self, run, rtol):
        """The mean of the contact area, which is the one that the program prints; both."""
        expected, found = run.attrs["summary"]["contact_area_last_tenth"], run.plateau.mean()
        np.testing.assert_allclose(
            [found.value, found.error, found.start, found.end, found.revolutions],
            [expected[key] for key in ("mean", "standard_error", "from", "to", "revolutions")],
            rtol=rtol,
        )
        return expected, found

    def test_the_mean_is_the_one_that_the_program_prints(self):
        for run in (self.run_, self.round_):
            _, found = self.printed(run, 1e-10)
            pressure = run.plateau.mean("mean_pressure", found.start, found.end)
            self.assertEqual(run.plateau.mean("mean_pressure", f"{found.start} s"), pressure)
            time, values = run["time"].values, run["series/mean_pressure"].values
            inside = time > found.start
            # Samples lie whole steps apart, so that their distances differ a little.
            self.assertAlmostEqual(pressure.value / values[inside].mean(), 1.0, delta=2e-3)
            self.assertGreater(pressure.error, 0)

    def test_the_mean_of_a_cycle_is_the_one_that_the_program_prints(self):
        # Standing before the first step, then two brakes, lifted and standing between; once, and three times so that the part begins later.
        rows = [(0, 5, 0), (3, 5, 0), (3, 5, 850), (13, 8, 300), (13, 0, 300), (20, 0, 850), (20, 5, 850), (31, 5, 0), (35, 5, 0)]
        points = [[f"{time} s", f"{load} N", f"{speed} rpm"] for time, load, speed in rows]
        scene = pathlib.Path("quick.toml").read_text(encoding="utf-8").splitlines()
        scene = "\n".join(line for line in scene if not line.startswith(("normal_force", "rotational_speed", "duration")))
        numbers = {"numerics.time_acceleration": 25, "output.sample_every": "0.5 s"}
        for repeat in (1, 3):
            cycle = f"[operation.cycle]\nrepeat = {repeat}\npoints = {points}"
            pathlib.Path("cycle.toml").write_text(scene.replace("[operation]", cycle), encoding="utf-8")
            with warnings.catch_warnings(action="ignore"):
                # Of brakes that have few revolutions.
                run = plateau.run("cycle.toml", f"cycle-{repeat}.h5", set=numbers)
            expected, found = self.printed(run, 1e-9)
            self.assertLess(expected["contact_time"], found.end - found.start - 3)

    def test_build_up_and_coverage(self):
        for run in (self.run_, self.round_):
            with h5py.File(run.attrs["summary"]["file"]) as file:
                disc = file["disc/height"][:] - file["disc/substrate"][:]
                pin = file["pin/substrate"][:] - file["pin/height"][:]
                there = np.isfinite(file["pin/height"][-1])
                weights = np.broadcast_to(file["radius"][:], there.shape)
                last = [file[f"series/{name}"][-1] for name in ("disc_secondary", "pin_primary", "pin_secondary")]
                secondary = file["pin/status"][-1] == 2
            np.testing.assert_array_equal(run.plateau.build_up("disc").values, disc)
            np.testing.assert_array_equal(run.plateau.build_up("pin").values, pin)
            mean = run.plateau.build_up("pin").plateau.area_mean().values[-1]
            self.assertAlmostEqual(mean / np.average(pin[-1][there], weights=weights[there]), 1.0, delta=1e-12)
            self.assertTrue((pin[-1][secondary] > 0).all() and secondary.any())
            # The program counts the cells of the last map itself.
            coverage = run.plateau.coverage().isel(map_time=-1)
            np.testing.assert_allclose([coverage[name].item() for name in sorted(coverage)], last, rtol=1e-9)
        self.assertFalse(there.all())

    def test_what_a_run_has_not(self):
        without = plateau.run("quick.toml", "few.h5", set=SHORT | {"output.maps": ["disc_height"]})
        with self.assertRaisesRegex(ValueError, "no map disc/substrate: name disc_substrate in output.maps"):
            without.plateau.build_up("disc")
        with self.assertRaisesRegex(ValueError, "no body is called 'rotor'"):
            without.plateau.build_up("rotor")
        with self.assertRaisesRegex(KeyError, "^the run has no series/warmth$") as caught:
            without.plateau.mean("warmth")
        self.assertIsInstance(caught.exception, plateau.UnknownNameError)
        with self.assertRaisesRegex(plateau.InputError, "from 10 to 90 s: expected times in order, between 0 and 20"):
            without.plateau.mean("mean_pressure", "10 s", "1.5 min")
        self.assertEqual(list(without.plateau.coverage()), [])
        self.assertEqual(len(without.plateau.events), 0)

    def test_totals_have_a_rate_and_no_mean(self):
        with h5py.File("quick.h5") as file:
            time, worn = file["time"][:], file["series/worn_pin"][:]
            # docs/run-file.md: volumes are cumulative but for the pool.
            volumes = {name for name, values in file["series"].items() if values.attrs["units"] == "m3"} - {"pool"}
        self.assertIn("worn_pin", volumes)
        for name in volumes | {"sliding_distance", "contact_area_integral"}:
            with self.assertRaisesRegex(plateau.InputError, rf"{name} is a total since the start of the run.*rate\('{name}'\)"):
                self.run_.plateau.mean(name)
        found = self.run_.plateau.rate("worn_pin", 10, 20)
        expected = (worn[-1] - np.interp(10, time, worn)) / 10
        self.assertAlmostEqual(found.value / expected, 1.0, delta=1e-9)
        self.assertGreater(found.error, 0)
        area = self.run_.plateau.mean("contact_area")
        self.assertEqual(self.run_.plateau.rate("contact_area_integral"), area)
        with self.assertRaisesRegex(plateau.InputError, r"filled_fraction is no total.*take mean\('filled_fraction'\)"):
            self.run_.plateau.rate("filled_fraction")
        with self.assertRaises(plateau.UnknownNameError):
            self.run_.plateau.rate("warmth")

    def test_tables(self):
        table = self.run_.plateau.series
        with h5py.File("quick.h5") as file:
            self.assertEqual(set(table), set(file["series"]) - {"time"})
            np.testing.assert_array_equal(table.index, file["time"][:])
            np.testing.assert_array_equal(table["emitted"], file["series/emitted"][:])

    def test_moments(self):
        height = self.run_["disc/height"]
        self.assertAlmostEqual(height.plateau.at_time(12.0)["map_time"].item(), 10.0, delta=0.01)
        self.assertTrue(height.plateau.at_time("0.2 min").equals(height.plateau.at_time(12.0)))
        self.assertEqual(height.plateau.at_time()["map_time"].item(), height["map_time"].values[-1])
        self.assertIs(self.run_["pin/base"].plateau.at_time(3.0).dims, self.run_["pin/base"].dims)

    def test_figures_show_what_is_in_the_run(self):
        axes = self.run_.plateau.plot()
        np.testing.assert_allclose(axes.lines[0].get_ydata(), self.run_["series/contact_area"].values * 1e6)
        axes = self.run_.plateau.plot("displacement")
        self.assertEqual(axes.get_ylabel(), "displacement, µm")
        np.testing.assert_allclose(axes.lines[0].get_ydata(), self.run_["series/displacement"].values * 1e6)
        self.assertEqual(self.run_.plateau.plot("sliding_distance").get_ylabel(), "sliding distance, m")
        for polar in (False, True):
            axes = self.round_["pin/pressure"].plateau.plot(polar=polar)
            drawn = axes.collections[0].get_array()
            np.testing.assert_allclose(np.ma.filled(drawn, np.nan), self.round_["pin/pressure"].values[-1].T / 1e6)
            self.assertIn("pressure, MPa\ngrey: no contact", [other.get_ylabel() for other in axes.figure.axes])
        axes = self.run_["disc/status"].plateau.plot(10.0)
        names = [text.get_text() for text in axes.figure.legends[0].get_texts()]
        self.assertEqual(names, ["none", "primary", "secondary"])
        drawn = np.hstack([panel.images[0].get_array() for panel in axes.figure.axes])
        np.testing.assert_array_equal(drawn, self.run_["disc/status"].plateau.at_time(10.0).values.T)

    def test_maps_can_be_read(self):
        import matplotlib.pyplot as plt

        height = self.run_["disc/height"]
        two = plt.subplots(nrows=2, figsize=(9, 6), layout="constrained")[1]
        self.run_["pin/pressure"].plateau.plot(ax=two[0])
        height.plateau.plot(ax=two[1])
        for figure in (two[0].figure, height.plateau.plot().figure):
            figure.canvas.draw()
            for panel in figure.axes:
                boxes = [label.get_window_extent() for label in panel.get_yticklabels() if label.get_text()]
                boxes.sort(key=lambda box: box.y0)
                # Labels beyond the ends of an axis are not drawn.
                shown = [box for box in boxes if panel.bbox.y0 - 10 < (box.y0 + box.y1) / 2 < panel.bbox.y1 + 10]
                self.assertGreaterEqual(len(shown), 2)
                self.assertTrue(all(below.y1 <= above.y0 for below, above in itertools.pairwise(shown)), panel.get_title())
        # A ring in one box is stretched, or it would be a line; a pin is in proportion.
        self.assertGreater(two[1].bbox.height, 100)
        self.assertEqual(two[0].get_aspect(), 1)
        self.assertGreater(two[1].get_aspect(), 10)
        self.assertEqual(two[1].get_xlabel(), f"arc length at the mean radius, mm; the disc moves →\nradius stretched {two[1].get_aspect():g}×")
        self.assertEqual(height.plateau.plot(polar=True).get_xlabel(), "x, mm; the disc turns counter-clockwise")

    def test_colours(self):
        title = self.run_["pin/height"].plateau.plot(0).get_title(loc="left")
        self.assertEqual(title.replace("\u00a0", " "), "Pin: height, positive toward the disc, 0 s")
        # What lies below the range has its lowest colour, not that of cells without contact.
        disc = self.run_["disc/height"].plateau.plot().images[0]
        self.assertEqual(*(disc.cmap(disc.norm(value)) for value in (-1e3, disc.norm.vmin)))
        # What the user says holds.
        cmap = self.run_["disc/height"].plateau.plot(cmap="magma", vmin=-5).images[0]
        self.assertEqual((cmap.cmap.name, cmap.norm.vmin), ("magma", -5))
        # Build-up, and a map that figures do not know.
        thickness = self.run_.plateau.build_up("pin")[-1].plateau.plot()
        np.testing.assert_allclose(thickness.images[0].get_array(), self.run_.plateau.build_up("pin").values[-1].T * 1e6)
        self.assertEqual(len(self.run_["pin/base"].plateau.plot().figure.legends), 1)


class Wrong(InFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        plateau.run("quick.toml", "short.h5", set=SHORT).close()

    def test_a_series_is_not_drawn_as_a_map(self):
        run = plateau.open_run("short.h5")
        for call in ("plot", "area_mean"):
            with self.assertRaisesRegex(plateau.InputError, r"contact_area is a series, .* run.plateau.plot\('contact_area'\)"):
                getattr(run["series/contact_area"].plateau, call)()
        with self.assertRaisesRegex(plateau.InputError, "expected a map at one moment"):
            run["disc/height"].isel(radius=0).plateau.plot()

    def test_what_is_not_a_run_file(self):
        os.mkfifo("pipe.h5")
        for path, told in (
            (".", "this is a folder"),
            ("pipe.h5", "not a regular file"),
            (None, "expected the path of a run file"),
            (3.5, "expected the path"),
        ):
            with self.assertRaisesRegex(plateau.InputError, told):
                plateau.open_run(path)
        with self.assertRaisesRegex(plateau.InputError, "quick.toml: cannot be read as a run file: it is not an HDF5 file; plateau.run"):
            plateau.open_run("quick.toml")

    def test_a_mean_of_statuses_is_refused(self):
        run = plateau.open_run("short.h5")
        with self.assertRaisesRegex(plateau.InputError, "area_fraction"):
            run["disc/status"].plateau.area_mean()
        self.assertEqual(run["disc/height"].plateau.area_mean().dims, ("map_time",))

    def test_a_package_that_is_missing(self):
        with unittest.mock.patch("importlib.util.find_spec", lambda name: None):
            with self.assertRaisesRegex(plateau.MissingPackageError, "pip install h5netcdf") as caught:
                plateau.open_run("short.h5")
        self.assertIsInstance(caught.exception, ImportError)


class Pauses(InFolder):
    def test_means_have_a_gap_while_nothing_rubs(self):
        # Between 2 s and 4 s the pin is lifted, from 6 s on the disc stands still.
        table = [("0", 5, 850), ("2", 0, 850), ("4", 5, 850), ("6", 5, 0), ("8", 5, 0)]
        lines = ["time [s],normal_force [N],rotational_speed [rpm]"]
        lines += [f"{time},{force},{speed}" for time, force, speed in table]
        pathlib.Path("cycle.csv").write_text("\n".join(lines) + "\n")
        pathlib.Path("city.toml").write_text(
            'extends = "quick.toml"\n[operation]\nduration = "8 s"\n[numerics]\ntime_acceleration = 2\n'
            '[operation.cycle]\nfile = "cycle.csv"\ninterpolation = "hold"\n'
        )
        run = plateau.run("city.toml")
        axes = run.plateau.plot()
        rubs = (run["series/normal_force"].values != 0) & (run["series/rotational_speed"].values != 0)
        self.assertTrue(rubs.any() and not rubs.all())
        for line in axes.lines:
            np.testing.assert_array_equal(np.isfinite(line.get_ydata()), rubs)
        [mean] = run.plateau.plot("contact_area_mean").lines
        np.testing.assert_array_equal(np.isfinite(mean.get_ydata()), rubs)
        # A series itself is drawn as it is.
        [single] = run.plateau.plot("contact_area").lines
        self.assertTrue(np.isfinite(single.get_ydata()).all())
        # A lifted pin has no displacement: the mean is over the samples that have one, also after the pause.
        with h5py.File("quick.h5") as file:
            time, values = file["time"][:], file["series/displacement"][:]
        there, steps = np.isfinite(values), np.diff(time, prepend=0.0)
        self.assertFalse(there.all())
        for first, last in ((5, 15), (15, 50), (45, 70), (0, len(time) - 1)):
            part = np.arange(len(time)) > first
            part &= (np.arange(len(time)) <= last) & there
            expected = (values * steps)[part].sum() / steps[part].sum()
            self.assertAlmostEqual(run.plateau.mean("displacement", time[first], time[last]).value / expected, 1.0, delta=1e-12)
        self.assertTrue(np.isnan(run.plateau.mean("displacement", 2.5, 3.5).value))


class Unfinished(InFolder):
    def test_a_file_that_was_cut_short_is_refused(self):
        plateau.run("quick.toml", "whole.h5", set={"operation.duration": "5 s"})
        whole = pathlib.Path("whole.h5").read_bytes()
        for length in (0, 11, 30000, len(whole) // 2, len(whole) - 1):
            pathlib.Path("short.h5").write_bytes(whole[:length])
            with self.assertRaisesRegex(plateau.InputError, "short.h5: cannot be read as a run file"):
                plateau.open_run("short.h5")

    def test_a_run_that_goes_on_and_one_that_was_killed(self):
        sets = changed('operation.duration="100000 s"', 'output.maps_at=["0 s"]')
        command = [PROGRAM, "run", "quick.toml", "-o", "going.h5", *sets]
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        looks, end = [], time.monotonic() + 120
        while len(looks) < 3 or len(looks[-1]["time"]) < 100:
            self.assertLess(time.monotonic(), end, "three looks at a growing run, and 100 samples, in two minutes")
            if pathlib.Path("going.h5").exists():
                try:
                    run = plateau.open_run("going.h5")
                except plateau.InputError:  # it has only just been made
                    continue
                if len(run["time"]) > (len(looks[-1]["time"]) if looks else 0):
                    looks.append(run)
                    with self.assertWarnsRegex(plateau.PlateauWarning, "running .or it was killed"):
                        plateau.export("going.h5", "npz", f"{len(looks)}.npz")
            time.sleep(0.1)
        self.assertEqual(process.poll(), None)
        process.send_signal(signal.SIGKILL)
        process.wait()
        killed = plateau.open_run("going.h5")
        self.assertEqual(killed.attrs["state"], "running")
        whole = pathlib.Path("going.h5").read_bytes()
        for length in (12, 48, 2048, len(whole) // 2):
            pathlib.Path("cut.h5").write_bytes(whole[:length])
            with self.assertRaisesRegex(plateau.InputError, f"cut.h5: cannot be read as a run file: it was cut short, to {length} bytes"):
                plateau.open_run("cut.h5")
        with self.assertRaisesRegex(plateau.InputError, "no sample yet"):
            killed.isel(time=slice(0, 0)).plateau.mean()
        for look in ("at_time", "plot"):
            with self.assertRaisesRegex(plateau.InputError, "no map has been recorded yet"):
                getattr(killed["disc/height"].isel(map_time=slice(0, 0)).plateau, look)()
        with self.assertWarns(plateau.PlateauWarning), h5py.File("going.h5", swmr=True) as file:
            plateau.export("going.h5", "npz", "killed.npz")
            samples, series = len(file["time"]), {name: values[:] for name, values in file["series"].items()}
            self.assertEqual((file.attrs["state"], len(killed["time"])), ("running", samples))
        # What was seen and exported stays.
        for number, run in enumerate([*looks, killed], 1):
            with np.load(f"{number}.npz" if run is not killed else "killed.npz") as arrays:
                self.assertEqual(str(arrays["state"]), "running")
                for name, values in series.items():
                    seen, kept = (values[: len(of["time"])] for of in (run, arrays))
                    self.assertTrue(np.isfinite(seen).all(), name)
                    np.testing.assert_array_equal(arrays[name], kept, name)
                    if name != "time":
                        np.testing.assert_array_equal(run[f"series/{name}"].values, seen, name)
        # What is made of the file afterwards is a run that has ended, with the same samples.
        program("repair", "going.h5")
        program("verify", "going.h5")
        with xarray.open_dataset("going.h5", group="series", engine="h5netcdf") as series:
            self.assertEqual((list(series.coords), series.sizes["time"]), (["time"], samples))
        repaired = plateau.open_run("going.h5")
        self.assertEqual(repaired.attrs["state"], "interrupted")
        self.assertEqual(set(repaired["series"].data_vars), set(killed["series"].data_vars))
        np.testing.assert_array_equal(repaired["series/pool"].values, killed["series/pool"].values)
        self.assertEqual(repaired.plateau.mean(), killed.plateau.mean())
        for name in ("disc/height", "pin/status", "pin/base"):
            self.assertEqual((killed[name].dims, killed[name].dtype), (repaired[name].dims, repaired[name].dtype))
            np.testing.assert_array_equal(killed[name].values, repaired[name].values)
        self.assertEqual(killed["pin/status"].plateau.status_names, repaired["pin/status"].plateau.status_names)

    def test_what_is_no_run_file(self):
        with self.assertRaisesRegex(FileNotFoundError, "^none.h5: there is no such run file$") as caught:
            plateau.open_run("none.h5")
        self.assertIsInstance(caught.exception, plateau.MissingFileError)
        pathlib.Path("text.h5").write_text("no HDF5")
        with self.assertRaisesRegex(plateau.InputError, "text.h5: cannot be read as a run file"):
            plateau.open_run("text.h5")
        with h5py.File("other.h5", "w") as file:
            file["values"] = [1, 2]
        with self.assertRaisesRegex(plateau.InputError, "other.h5: this HDF5 file is not a run file"):
            plateau.open_run("other.h5")


class Cycles(InFolder):
    def test_a_row_for_each_event(self):
        rows = [["0 s", "5 N", "850 rpm"], ["1 s", "5 N", "0 rpm"], ["1 s", "0 N", "0 rpm"], ["2 s", "0 N", "850 rpm"]]
        pathlib.Path("stops.toml").write_text(
            f'extends = "quick.toml"\n[operation]\nduration = "6 s"\n[operation.cycle]\npoints = {rows}\nrepeat = 3\n'
        )
        with self.assertWarnsRegex(plateau.PlateauWarning, "simulated revolutions"):
            run = plateau.run("stops.toml", "stops.h5", set={"output.maps_at": [], "numerics.time_acceleration": 2})
        with h5py.File("stops.h5") as file:
            np.testing.assert_array_equal(run.plateau.events["worn"], file["event/worn"][:])
        np.testing.assert_allclose(run.plateau.events["start"], [0, 2, 4], atol=0.01)
