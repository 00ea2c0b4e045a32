"""Run files of the program, as h5py, netCDF4 and xarray see them: finished, and while they are written."""

import contextlib
import subprocess
import time

import h5py
import numpy as np
import xarray
from check_run_file import check, check_file
from checkout import PROGRAM, QUICK, Folder, changed, program


def is_being_written(path):
    """Whether the flags in the superblock (byte 11 of the file) say that a writer has the file open.

    Asked of the bytes: h5py would hand out the file that this process follows already.
    """
    with open(path, "rb") as file:
        return file.read(12)[11] != 0


class Follower:
    """Checks datasets that grow along one dimension of times: each has at least as many values, all finite, and none that was seen changes."""

    def __init__(self, file, times, followers):
        self.times = file[times]
        self.followers = {name: file[name] for name in followers}
        self.seen = np.empty(0)
        self.values = {name: [] for name in followers}

    def look(self):
        """Checks what is new; returns how many times that is."""
        self.times.refresh()
        times = self.times[...]
        old, new = self.seen.size, times.size
        check(np.array_equal(times[:old], self.seen), f"{self.times.name}: times that were seen have changed")
        check((np.diff(times) > 0).all(), f"{self.times.name} does not grow")
        for name, dataset in self.followers.items():
            dataset.refresh()
            check(dataset.shape[0] >= new, f"{name} has {dataset.shape[0]} entries for {new} times")
            values = dataset[old:new]
            check(np.isfinite(values).all(), f"{name} has values that are not finite")
            if values.ndim == 1:
                before = np.array(self.values[name])
                check(np.array_equal(dataset[:old], before), f"{name}: values that were seen have changed")
                self.values[name].extend(values)
        self.seen = times
        return new - old


class RunFile(Folder):
    def setUp(self):
        super().setUp()
        self.path = self.folder / "run.h5"

    def run_of(self, scene, *changes):
        program("run", scene, "-o", self.path, *changed(*changes))

    def test_a_run_is_as_the_format_says(self):
        self.run_of(QUICK)
        check_file(self.path)

    def test_only_the_maps_asked_for_are_there(self):
        self.run_of(QUICK, 'output.maps=["pressure"]', 'operation.duration="1 s"')
        check_file(self.path, ["pressure"])

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
        check_file(self.path, roughness=True)

    def test_a_reader_follows_a_run(self):
        # Long enough for several batches, whatever the machine; the follower ends with the run.
        changes = changed("operation.steps=400000", 'output.sample_every="0.05 s"')
        run = subprocess.Popen([PROGRAM, "run", QUICK, "-o", self.path, *changes], stdout=subprocess.DEVNULL)
        self.addCleanup(run.wait)
        self.addCleanup(run.kill)
        news, file = time.monotonic(), None
        while file is None:
            self.assertLess(time.monotonic(), news + 10, "there is no run file")
            time.sleep(0.02)
            with contextlib.suppress(OSError):
                file = h5py.File(self.path, "r", swmr=True)
        with file:
            self.assertEqual(file.attrs["state"], "running", "too late to follow")
            maps = [f"{body}/{name}" for body in ("disc", "pin") for name in file[body] if name != "base"]
            followers = [Follower(file, "time", [f"series/{name}" for name in file["series"]]), Follower(file, "map_time", maps)]
            ended = False
            while not ended:
                ended = not is_being_written(self.path)  # asked first, so that the last look sees everything
                if any(follower.look() for follower in followers):
                    news = time.monotonic()
                self.assertLess(time.monotonic(), news + 10, "nothing new for ten seconds")
                time.sleep(0.05)
        self.assertGreaterEqual(len(followers[0].seen), 10)
        self.assertEqual(run.wait(timeout=300), 0)
        with h5py.File(self.path) as file:
            self.assertEqual(file.attrs["state"], "finished")
