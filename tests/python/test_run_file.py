"""Run files of the program, as h5py, netCDF4 and xarray see them: finished, and while they are written."""

import pathlib
import subprocess
import sys
import time

import h5py
import numpy as np
import xarray
from checkout import PROGRAM, QUICK, Folder, changed, program

HERE = pathlib.Path(__file__).resolve().parent


class RunFile(Folder):
    def setUp(self):
        super().setUp()
        self.path = self.folder / "run.h5"

    def run_of(self, scene, *changes):
        program("run", scene, "-o", self.path, *changed(*changes))

    def begun(self, *changes):
        """A run that goes on, and is killed with the test."""
        run = subprocess.Popen([PROGRAM, "run", QUICK, "-o", self.path, *changed(*changes)], stdout=subprocess.DEVNULL)
        self.addCleanup(run.wait)
        self.addCleanup(run.kill)
        return run

    def script(self, name, *arguments):
        done = subprocess.run([sys.executable, HERE / name, self.path, *arguments], capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def wait_for_samples(self, count):
        """Returns once a reader sees so many samples."""
        for _ in range(600):
            time.sleep(0.1)
            if self.path.exists():
                with h5py.File(self.path, swmr=True) as file:
                    if len(file["time"]) >= count:
                        return
        self.fail(f"no {count} samples within a minute")

    def test_a_run_is_as_the_format_says(self):
        self.run_of(QUICK)
        self.script("check_run_file.py")

    def test_only_the_maps_asked_for_are_there(self):
        self.run_of(QUICK, 'output.maps=["pressure"]', 'operation.duration="1 s"')
        self.script("check_run_file.py", "--maps", "pressure")

    def test_events_are_a_group_with_a_dimension_of_its_own(self):
        self.run_of(QUICK.with_name("stops.toml"))
        with h5py.File(self.path) as file:
            # Stops of 425 revolutions a minute for 3 s on a mean radius of 20.5 mm.
            distance = 425 / 60 * 3 * 2 * np.pi * 20.5e-3
            np.testing.assert_allclose(file["event/distance"][1:], distance, rtol=1e-12)
            worn = sum(file[f"series/worn_{part}"][-1] for part in ("pin", "resin", "disc"))
            np.testing.assert_allclose(file["event/worn"][:].sum(), worn, rtol=1e-12)
        for engine in ("h5netcdf", "netcdf4"):
            with xarray.open_datatree(self.path, engine=engine) as tree:
                event = tree["event"]
                self.assertEqual((dict(event.sizes)["event"], list(event.event.values)), (6, [1, 2, 3, 4, 5, 6]))
                self.assertEqual([float(value) for value in event.start[1:3]], [14, 22])
                self.assertEqual(event.initial_speed.attrs["units"], "rad s-1")

    def test_roughness_is_that_of_the_maps(self):
        self.run_of(QUICK, "output.roughness=true", 'operation.duration="1 s"')
        self.script("check_run_file.py", "--roughness")

    def test_a_reader_follows_a_run(self):
        # Long enough for several batches, whatever the machine; the follower ends with the run.
        run = self.begun("operation.steps=400000", 'output.sample_every="0.05 s"')
        self.script("follow_run.py", "--samples", "10")
        self.assertEqual(run.wait(timeout=300), 0)
        with h5py.File(self.path) as file:
            self.assertEqual(file.attrs["state"], "finished")

    def test_a_killed_run_can_be_read(self):
        run = self.begun("operation.steps=100000000", 'output.sample_every="0.05 s"')
        self.wait_for_samples(100)
        run.kill()
        run.wait()
        with h5py.File(self.path, swmr=True) as file:
            samples = len(file["time"])
            self.assertGreaterEqual(samples, 100)
            for name, series in file["series"].items():
                self.assertTrue(np.isfinite(series[:samples]).all(), name)
            self.assertEqual(file.attrs["state"], "running")
        program("repair", self.path)
        with xarray.open_dataset(self.path, group="series", engine="h5netcdf") as series:
            self.assertEqual((list(series.coords), series.sizes["time"]), (["time"], samples))
        program("verify", self.path)
