"""Plateau in Python: simulate a brake pin on a rough disc, open runs and studies, draw them.

>>> import plateau
>>> run = plateau.run("quick.toml", "first.h5", set={"operation.duration": "20 s"})
>>> run.attrs["state"]
'finished'
>>> area = run.plateau.mean("contact_area")
>>> print(f"{area.value * 1e6:.2f} mm2, standard error {area.error * 1e6:.2f} mm2")
0.51 mm2, standard error 0.03 mm2
>>> print(area)
(5.10 ± 0.30)e-07 m2 from 5.80051 to 20 s

All quantities are in SI units. The guide is docs/python.md of the project.
"""

import os
import sys
from importlib.metadata import PackageNotFoundError, version

from plateau.errors import MissingPackageError, not_installed

try:
    import numpy  # noqa: F401
    import pandas  # noqa: F401
    import xarray  # noqa: F401
except ModuleNotFoundError as error:
    missing = not_installed(error.name)
    # Of the words of the program, which are run as scripts or with -m, nobody wants a traceback.
    if sys.argv[0] == "-m" or os.path.basename(sys.argv[0]).startswith("plateau-"):
        sys.exit(f"plateau: {missing}")
    raise MissingPackageError(missing) from error

from plateau import study
from plateau.commands import check, collect, command
from plateau.drive_cycle import cycle
from plateau.errors import InputError, InputTypeError, MissingFileError, PlateauError, PlateauWarning, RunFailed, RunStopped, UnknownNameError
from plateau.exports import export
from plateau.figures import plot
from plateau.figures.accuracy import plot_accuracy
from plateau.figures.surfaces import plot_surfaces
from plateau.map_accessor import MapAccessor
from plateau.means import Mean
from plateau.program import find_program
from plateau.run_accessor import RunAccessor
from plateau.run_file import open_run
from plateau.run_report import report
from plateau.runs import run, sweep
from plateau.scenes import Scene
from plateau.simulation import Simulation
from plateau.study import Study, open_study

try:
    __version__ = version("plateau-brake")
except PackageNotFoundError:  # a checkout that is not installed
    __version__ = "0"

__all__ = [
    "InputError",
    "InputTypeError",
    "MapAccessor",
    "Mean",
    "MissingFileError",
    "MissingPackageError",
    "PlateauError",
    "PlateauWarning",
    "RunAccessor",
    "RunFailed",
    "RunStopped",
    "Scene",
    "Simulation",
    "Study",
    "UnknownNameError",
    "check",
    "collect",
    "command",
    "cycle",
    "export",
    "find_program",
    "open_run",
    "open_study",
    "plot",
    "plot_accuracy",
    "plot_surfaces",
    "report",
    "run",
    "study",
    "sweep",
]
