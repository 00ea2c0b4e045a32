"""Runs that the Python package has opened can be saved by xarray, and are opened where files cannot be locked."""

import os
import pathlib
import subprocess
import warnings

import netCDF4
import numpy as np
import xarray
from checkout import python
from package_scenes import ROUND, SHORT, STUDY, InFolder

import plateau

HERE = pathlib.Path(__file__).resolve().parent


class Saved(InFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        plateau.run("quick.toml", "run.h5", set=SHORT)
        plateau.run("quick.toml", "round.h5", set=ROUND)

    def setUp(self):
        # h5netcdf warns of the fill value of HDF5, 0, which no reader takes for a missing value.
        self.enterContext(warnings.catch_warnings())
        warnings.filterwarnings("ignore", "Creating variable with default fill_value 0")

    def check_equal(self, found, expected):
        """The same variables with the same values, types, dimensions and attributes."""
        self.assertEqual(set(found.variables), set(expected.variables))
        for name, variable in expected.variables.items():
            again = found[name].variable
            self.assertEqual((again.dims, again.dtype, set(again.attrs)), (variable.dims, variable.dtype, set(variable.attrs)), name)
            np.testing.assert_array_equal(again.values, variable.values, name)

    def test_a_run_is_saved_and_is_a_run_again(self):
        for path in ("run.h5", "round.h5"):
            for engine in ("h5netcdf", "netcdf4"):
                run = plateau.open_run(path)
                run.to_netcdf("copy.nc", engine=engine)
                copy = plateau.open_run("copy.nc")
                self.assertEqual(copy.attrs["scene"], run.attrs["scene"])
                for group in ("/", "series", "disc", "pin"):
                    self.check_equal(copy[group].to_dataset(inherit=False), run[group].to_dataset(inherit=False))
                self.assertEqual(copy.plateau.mean("contact_area"), run.plateau.mean("contact_area"))
                with netCDF4.Dataset("copy.nc") as file:
                    self.assertFalse(any(dimension.isunlimited() for dimension in file.dimensions.values()))
                    self.assertEqual(np.ma.count_masked(file["disc/status"][...]), 0)
                copy.close()

    def test_a_group_is_saved(self):
        for engine in ("h5netcdf", "netcdf4"):
            for group in ("series", "disc", "pin"):
                with xarray.open_dataset("run.h5", group=group, engine=engine) as read:
                    read.to_netcdf("group.nc", engine=engine)
                    with xarray.open_dataset("group.nc", engine=engine) as again:
                        self.check_equal(again, read)
            last = plateau.open_run("run.h5")["disc"].to_dataset().isel(map_time=-1)
            last.to_netcdf("map.nc", engine=engine)
            with xarray.open_dataset("map.nc", engine=engine) as again:
                self.check_equal(again, last)


class WithoutLocks(InFolder):
    def test_runs_and_studies_are_opened(self):
        plateau.run("quick.toml", "run.h5", set=SHORT)
        pathlib.Path("study.toml").write_text(STUDY)
        plateau.sweep("study.toml", progress=False)
        compiler = os.environ.get("CC", "cc")
        subprocess.run([compiler, "-shared", "-fPIC", "-o", "no_locks.so", HERE / "no_locks.c"], check=True, timeout=120)
        text = (
            # This test tells nothing where h5py itself asks for no lock.
            "import h5py, plateau\ntry:\n    h5py.File('run.h5')\nexcept OSError as error:\n    print(error)\n"
            "run, study = plateau.open_run('run.h5'), plateau.open_study('study.toml')\n"
            "print(len(run['time']), run['disc/height'].values.shape[0], len(study.table))\n"
        )
        environment = os.environ | {"LD_PRELOAD": str(pathlib.Path("no_locks.so").absolute())}
        environment.pop("HDF5_USE_FILE_LOCKING", None)
        refused, found = python(text, env=environment).splitlines()
        self.assertEqual(found, "200 3 4")
        self.assertIn("unable to lock file", refused)
