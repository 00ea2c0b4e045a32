"""Simulations as objects: the program's bits, arrays that stay, heights, load and speed set between steps, and what interrupts them.

Expected numbers are those of the program's run files, closed forms of the load balance and of uniform motion, or of the other engine."""

import ast
import gc
import math
import os
import pathlib
import pickle
import resource
import signal
import subprocess
import sys
import threading
import time
import warnings

import h5py
import numpy as np
from checkout import QUICK, ROOT, program
from package_scenes import MAPS, InFolder

import plateau
from plateau.native import native

VECTORS = ROOT / "tests" / "vectors"


def state_of(simulation):
    """All that is compared: bytes of every field, and the sample."""
    return [getattr(simulation, name).tobytes() for name in MAPS], repr(simulation.sample())


def python(text, **options):
    # A shell may have had what runs in its background ignore the signal.
    text = "import os, signal, sys, time, plateau\nsignal.signal(signal.SIGINT, signal.default_int_handler)\n" + text
    return subprocess.Popen([sys.executable, "-c", text], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)


class Bits(InFolder):
    def setUp(self):
        # Of short cycles, and of more workers than there are cores.
        self.enterContext(warnings.catch_warnings(action="ignore", category=plateau.PlateauWarning))

    def test_every_vector_has_the_bits_of_the_program(self):
        for path in sorted(VECTORS.glob("*/scene.toml")):
            file = f"{path.parent.name}.h5"
            program("run", path, "-o", file, "-q")
            with h5py.File(file) as run:
                times, ends = run["time"][:], {name: run[where][-1] for name, where in MAPS.items() if where in run}
                series = {name: run["series"][name][:] for name in run["series"] if name != "time"}
            for workers in (1, 2, 3):
                simulation = plateau.Simulation(path, workers=workers)
                found = simulation.observe(time=times[-1], every=97)
                for when, row in zip(found["time"], found[list(series)].to_dict("records"), strict=True):
                    place = np.flatnonzero(times == when)
                    self.assertEqual(len(place), 1, (file, when))
                    expected = {name: values[place[0]] for name, values in series.items()}
                    self.assertEqual(repr({name: float(value) for name, value in expected.items()}), repr(row), (file, workers))
                self.assertGreater(len(found), 1)
                for name, expected in ends.items():
                    # Where the run ends in a pause, the pin may be lifted.
                    if name != "pressure" or times[-1] == simulation.time:
                        values = getattr(simulation, name)
                        self.assertEqual(values.tobytes(), expected.astype(values.dtype).tobytes(), (file, name, workers))

    def test_the_two_engines_agree_under_a_controller(self):
        ends = []
        for engine in ("fast", "plain"):
            simulation = plateau.Simulation(QUICK, engine=engine)
            for force in (5.0, 20.0, 1.0):
                simulation.normal_force, simulation.rotational_speed = force, f"{100 * force} rpm"
                simulation.advance(40)
            self.assertEqual(simulation.engine, engine)
            ends.append(simulation.sample())
        for name, value in ends[0].items():
            if not name.endswith("residual"):
                self.assertTrue(math.isclose(value, ends[1][name], rel_tol=1e-9, abs_tol=1e-21), name)

    def test_a_state_that_is_loaded_goes_on_with_the_same_bits(self):
        for path, workers in ((VECTORS / "heat/scene.toml", 2), (VECTORS / "track/scene.toml", 1), (QUICK, 3)):
            simulation = plateau.Simulation(path)
            simulation.advance(200)
            if path == QUICK:
                simulation.normal_force = 40.0
                simulation.advance(10)
                simulation.normal_force, simulation.rotational_speed = 7.0, "300 rpm"
            simulation.save("a.state")
            again = plateau.Simulation.load("a.state", workers=workers)
            self.assertEqual(state_of(again), state_of(simulation))
            for one in (simulation, again):
                one.advance(150)
            self.assertEqual(state_of(again), state_of(simulation))
        pathlib.Path("no.state").write_text("something else")
        with self.assertRaisesRegex(plateau.InputError, "no.state"):
            plateau.Simulation.load("no.state")
        with self.assertRaisesRegex(plateau.InputError, "none.state: there is no such state"):
            plateau.Simulation.load("none.state")
        with self.assertRaisesRegex(plateau.InputError, "no state of a simulation: take another name"):
            simulation.save("no.state")


class Fields(InFolder):
    def test_arrays_stay_when_the_simulation_is_gone(self):
        simulation = plateau.Simulation(QUICK)
        simulation.advance(50)
        fields = {name: getattr(simulation, name) for name in MAPS}
        kept = {name: values.copy() for name, values in fields.items()}
        self.assertEqual(fields["disc_height"].shape, (690, 20))
        self.assertEqual(fields["pin_height"].shape, (40, 20))
        self.assertEqual(fields["pin_status"].dtype, np.uint8)
        # A change of them would be lost.
        with self.assertRaisesRegex(ValueError, "read-only"):
            fields["disc_height"][:] = 0.0
        np.testing.assert_array_equal(simulation.disc_height, kept["disc_height"])
        simulation.advance(50)
        del simulation
        gc.collect()
        for name, values in kept.items():
            if name != "disc_height":
                np.testing.assert_array_equal(fields[name], values)

    def test_a_pin_that_is_moved_is_displaced_by_as_much(self):
        """All gaps shift alike, so the displacement does, and nothing else changes."""
        here, there = plateau.Simulation(QUICK), plateau.Simulation(QUICK)
        for simulation in (here, there):
            simulation.advance(300)
        shift = 2.0**-20
        there.set_heights(pin_height=there.pin_height + shift, pin_substrate=there.pin_substrate + shift)
        for simulation in (here, there):
            simulation.advance(1)
        one, other = here.sample(), there.sample()
        self.assertAlmostEqual((other["displacement"] - one["displacement"]) / shift, 1.0, delta=1e-9)
        self.assertEqual(one["contact_area"], other["contact_area"])
        np.testing.assert_allclose(there.pressure, here.pressure, rtol=1e-6)

    def test_what_is_set_is_read_and_changes_no_bit_by_itself(self):
        one, other = plateau.Simulation(QUICK, workers=2), plateau.Simulation(QUICK)
        for simulation in (one, other):
            simulation.advance(200)
        sample = other.sample()
        other.set_heights(disc_height=other.disc_height, disc_substrate=other.disc_substrate, pin_height=other.pin_height)
        self.assertEqual(other.sample(), sample)
        for simulation in (one, other):
            simulation.advance(200)
        self.assertEqual(state_of(one), state_of(other))
        worn = other.pin_substrate + 1e-6
        other.pin_substrate = worn
        np.testing.assert_array_equal(other.pin_substrate, worn)
        self.assertTrue((other.pin_status == 2).all())

    def test_heights_that_no_cell_can_have(self):
        simulation = plateau.Simulation(QUICK)
        simulation.advance(20)
        kept = state_of(simulation)
        disc, pin = simulation.disc_substrate, simulation.pin_substrate
        refused = [
            ({"disc_height": disc[1:]}, r"disc_height has the shape \(689, 20\), expected \(690, 20\)"),
            ({"disc_height": np.where(disc == disc.max(), np.nan, disc)}, "disc_height at .* is NaN, expected a finite number"),
            ({"disc_height": disc - 1e-6}, r"disc_height at \(column 0, row 0\) is .*, expected at least its substrate"),
            ({"pin_height": pin + 1e-6}, "pin_height at .*, expected at most its substrate"),
        ]
        for heights, message in refused:
            with self.assertRaisesRegex(plateau.InputError, message):
                simulation.set_heights(**heights)
        self.assertEqual(state_of(simulation), kept)
        without = plateau.Simulation(plateau.Scene(QUICK).replace({"plateaus.formation": False}))
        with self.assertRaisesRegex(plateau.InputError, "no plateaus form"):
            without.disc_height = without.disc_height + 1e-6

    def test_what_is_no_array_of_heights(self):
        simulation = plateau.Simulation(QUICK)
        heights = simulation.pin_height
        kept = heights.tobytes()
        for wrong in (
            heights.astype(complex),
            heights > 0.0,
            heights.astype(str),
            heights.astype(object),
            np.ma.masked_less(heights, 0.0),
            [[1.0], [1.0, 2.0]],
            [[10**400] * 20] * 40,
            "heights",
            None,
        ):
            with self.assertRaisesRegex(plateau.InputTypeError, "^pin_height is .*expected (an array|one) of numbers"):
                simulation.pin_height = wrong
        simulation.pin_height = heights.tolist()
        self.assertEqual(simulation.pin_height.tobytes(), kept)

    def test_columns_under_the_pin(self):
        """The first displacement carries the load with the overlaps of all pairs: k A u summed here."""
        simulation = plateau.Simulation(QUICK)
        gaps = simulation.pin_height - simulation.disc_height[simulation.under_pin]
        simulation.advance(1)
        overlap = simulation.displacement - gaps
        np.testing.assert_array_equal(simulation.pressure > 0.0, overlap > 0.0)
        self.assertAlmostEqual((simulation.pressure * simulation.cell_area).sum() / 5.0, 1.0, delta=1e-9)


class Control(InFolder):
    def test_load_and_speed_of_the_coming_steps(self):
        simulation = plateau.Simulation(QUICK)
        acceleration = simulation.scene["numerics.time_acceleration"]
        before = 0.0
        for force, speed in [(3.0, 50.0), (30.0, 20.0), (0.5, 70.0)]:
            simulation.normal_force, simulation.rotational_speed = force, speed
            self.assertEqual((simulation.normal_force, simulation.rotational_speed), (force, speed))
            simulation.advance(25)
            sample = simulation.sample()
            self.assertAlmostEqual(sample["mean_pressure"] * sample["contact_area"] / force, 1.0, delta=1e-9)
            took, before = simulation.time - before, simulation.time
            self.assertAlmostEqual(took / (25 * acceleration * simulation.step_angle / speed), 1.0, delta=1e-12)
        mean = 0.5 * (simulation.radius[0] + simulation.radius[-1])
        self.assertAlmostEqual(sample["sliding_distance"] / (75 * acceleration * simulation.step_angle * mean), 1.0, delta=1e-12)
        later = simulation.time + 1.0
        simulation.advance(time=later)
        self.assertTrue(later <= simulation.time < later + acceleration * simulation.step_angle / 70.0 * (1 + 1e-9))

    def test_what_cannot_be_set(self):
        simulation = plateau.Simulation(QUICK)
        for wrong in (0.0, -1.0, math.nan, math.inf):
            with self.assertRaisesRegex(plateau.InputError, "normal force is .*, expected a finite number of more than 0|expected a number in N"):
                simulation.normal_force = wrong
        with self.assertRaisesRegex(plateau.InputError, "gives a normal force"):
            simulation.braking_torque = 1.0
        with self.assertWarnsRegex(plateau.PlateauWarning, "time_acceleration") as warned:
            cycle = plateau.Simulation(VECTORS / "cycle/scene.toml")
        self.assertEqual(warned.filename, __file__)
        with self.assertRaisesRegex(plateau.InputError, "leave out .operation.cycle."):
            cycle.rotational_speed = 1.0
        for wrong in (-1, 1.5, True, "3", 2**64, 10**30):
            self.assertRaises(plateau.InputError, simulation.advance, wrong)
            self.assertRaises(plateau.InputError, simulation.observe, wrong)
        with self.assertRaisesRegex(plateau.InputError, "choose it, give a number"):
            plateau.Simulation(plateau.Scene(QUICK).replace({"numerics.time_acceleration": {"tolerance": 0.01, "max": 100}}))
        with self.assertRaisesRegex(plateau.InputError, 'expected "fast" or "plain"'):
            plateau.Simulation(QUICK, engine="slow")
        simulation.advance(2, watch=False)
        for wrong in ("1e300 rad/s", 1e-320):
            with self.assertRaisesRegex(plateau.InputError, "a step takes .* s, which is lost .* expected one nearer to 89"):
                simulation.rotational_speed = wrong
        with self.assertRaisesRegex(plateau.InputError, "pressures of step 2 were not kept"):
            simulation.sample()

    def test_arguments_that_nothing_can_hold(self):
        simulation, deep, half = plateau.Simulation(QUICK), [], "\ud800"
        for _ in range(100_000):
            deep = [deep]
        calls = [
            lambda: simulation.advance(time=10**400),
            lambda: simulation.advance(time=deep),
            lambda: simulation.save(half),
            lambda: setattr(simulation, "normal_force", half),
            lambda: plateau.Simulation.load("a\0b"),
            lambda: plateau.Simulation.load("a.state", workers=10**30),
            lambda: plateau.Simulation(QUICK, engine=half),
            lambda: plateau.Scene(half),
            lambda: plateau.Scene(QUICK, title=half),
            lambda: plateau.Scene(f"version = 1\n# {half}"),
            lambda: plateau.Scene(QUICK, title=deep),
            lambda: plateau.Scene(QUICK, rows=10**5000),
            lambda: plateau.Scene(QUICK)[3],
            lambda: plateau.run(QUICK, half),
            lambda: plateau.run(QUICK, "q.h5", engine=None),
            lambda: plateau.sweep("none.toml", jobs=-1),
            lambda: plateau.sweep("none.toml", max_failures=10**30),
        ]
        for place, call in enumerate(calls):
            with self.subTest(place), self.assertRaises(plateau.InputError) as caught:
                call()
            # It can be printed.
            str(caught.exception).encode()

    def test_a_step_that_failed_is_followed_by_nothing(self):
        for workers in (1, 2):
            simulation = plateau.Simulation(QUICK, workers=workers)
            simulation.advance(10)
            simulation.normal_force = 1e300
            with self.assertRaises(plateau.RunFailed):
                simulation.advance()
            for refused in (simulation.advance, simulation.sample, lambda: simulation.save("failed.state")):
                with self.assertRaisesRegex(plateau.RunFailed, "the simulation failed: "):
                    refused()
            self.assertFalse(os.path.exists("failed.state"))

    def test_a_cycle_ends(self):
        points = [["0 s", "5 N", "850 rpm"], ["0.1 s", "6 N", "850 rpm"]]
        simulation = plateau.Simulation(plateau.Scene(QUICK, operation={"cycle": {"points": points}, "duration": "0.1 s"}))
        simulation.advance(time=1.0)
        steps = simulation.steps
        with self.assertRaisesRegex(plateau.InputError, f"the cycle ends at 0.1 s, after step {steps}"):
            simulation.advance()
        self.assertEqual(simulation.steps, steps)

    def test_a_step_that_was_not_watched_can_be_saved_and_changed(self):
        watched, passed = plateau.Simulation(QUICK), plateau.Simulation(QUICK)
        watched.advance(20)
        passed.advance(20, watch=False)
        with self.assertRaisesRegex(plateau.InputError, "watch=True"):
            passed.sample()
        passed.pin_height = passed.pin_height
        passed.save("passed.state")
        again = plateau.Simulation.load("passed.state")
        watched.advance(20)
        again.advance(20)
        self.assertEqual(state_of(again), state_of(watched))

    def test_the_checkpoint_of_a_run_is_no_state(self):
        plateau.run(QUICK, "kept.h5", set={"operation.duration": "1 s"})
        with self.assertRaisesRegex(plateau.InputError, "no state of a simulation: take another name"):
            plateau.Simulation(QUICK).save("kept.h5.checkpoint")
        longer = plateau.run(QUICK, "kept.h5", extend_to="2 s")
        self.assertEqual(longer.attrs["state"], "finished")


class Processes(InFolder):
    def test_threads(self):
        alone = plateau.Simulation(QUICK)
        alone.advance(20000)
        beside = [plateau.Simulation(QUICK) for _ in range(2)]
        threads = [threading.Thread(target=simulation.advance, args=(20000,)) for simulation in beside]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for simulation in beside:
            self.assertEqual(state_of(simulation), state_of(alone))
        busy = threading.Thread(target=alone.advance, args=(300000,))
        busy.start()
        with self.assertRaisesRegex(plateau.InputError, "another thread uses this simulation"):
            while busy.is_alive():
                _ = alone.steps
        busy.join()

    def test_a_fork_is_refused_and_begins_anew(self):
        simulation = plateau.Simulation(QUICK, workers=2)
        simulation.advance(10)
        ours, theirs = os.pipe()
        child = os.fork()
        if child == 0:
            try:
                said = "nothing refused"
                try:
                    simulation.advance(1)
                except plateau.InputError as error:
                    said = str(error)
                del simulation
                anew = plateau.Simulation(QUICK, workers=2)
                anew.advance(10)
                os.write(theirs, f"{said} {anew.sample()['contact_area']!r}".encode())
            finally:
                os._exit(0)
        os.close(theirs)
        with os.fdopen(ours) as pipe:
            said = pipe.read()
        os.waitpid(child, 0)
        self.assertRegex(said, "of another process, whose threads a fork does not have")
        self.assertTrue(said.endswith(repr(simulation.sample()["contact_area"])), said)

    def test_pickling_is_refused(self):
        with self.assertRaisesRegex(TypeError, "save its state"):
            pickle.dumps(plateau.Simulation(QUICK))

    def expect_after_interrupt(self, process, seconds, expected):
        """What a process says that is interrupted so long after it has begun."""
        self.assertEqual(process.stdout.readline(), "begun\n")
        time.sleep(seconds)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=120)
        self.assertEqual(out, expected, err)

    def test_an_interrupt_stops_between_two_steps(self):
        process = python(
            f"s = plateau.Simulation({str(QUICK)!r}, workers=2)\nprint('begun', flush=True)\n"
            "try:\n    s.advance(10**12)\nexcept KeyboardInterrupt:\n    n = s.steps\n    s.sample(); s.advance(1)\n    print(s.steps - n, n > 0)"
        )
        self.expect_after_interrupt(process, 0.5, "1 True\n")

    def test_samples_before_an_interrupt_are_kept(self):
        process = python(
            f"s = plateau.Simulation({str(QUICK)!r})\nprint('begun', flush=True)\n"
            "try:\n    s.observe(10**12, every=10)\nexcept KeyboardInterrupt:\n"
            "    print(list(s.observed.index) == list(range(10, 10 * len(s.observed) + 1, 10)), 0 <= s.steps - s.observed.index[-1] <= 10)"
        )
        self.expect_after_interrupt(process, 1.0, "True True\n")

    def test_a_run_that_could_not_be_written_lets_go_of_its_file(self):
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (200_000, limits[1]))
        try:
            with self.assertRaisesRegex(plateau.RunFailed, "File too large"):
                plateau.run(QUICK, "full.h5")
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        there = os.stat("full.h5")
        opened = [os.stat(f"/proc/self/fd/{name}") for name in os.listdir("/proc/self/fd") if os.path.exists(f"/proc/self/fd/{name}")]
        self.assertNotIn((there.st_dev, there.st_ino), [(file.st_dev, file.st_ino) for file in opened])
        program("repair", "full.h5")
        self.assertEqual(plateau.open_run("full.h5").attrs["state"], "interrupted")

    def test_memory_stays_the_same_over_samples(self):
        simulation = plateau.Simulation(QUICK)

        def take(count):
            for _ in range(count):
                simulation.advance(1)
                simulation.sample()
                simulation.pin_height  # noqa: B018
            return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

        before = take(2000)
        self.assertLess(take(10000) - before, 2048)


class Stubs(InFolder):
    def test_they_are_those_of_the_module(self):
        subprocess.run(["sh", str(ROOT / "scripts/stubs.sh"), "_native.pyi"], check=True, timeout=60)
        found, kept = pathlib.Path("_native.pyi").read_text(), (ROOT / "python/plateau/_native.pyi").read_text()
        self.assertEqual(found, kept, "sh scripts/stubs.sh writes them anew")
        # What it tells is all that there is, so that nothing is left out.
        told = {item.name for item in ast.parse(found).body if isinstance(item, ast.ClassDef | ast.FunctionDef)}
        self.assertEqual(told, {name for name in vars(native()) if not name.startswith("_")})
