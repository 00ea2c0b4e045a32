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

import sys
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

from plateau.errors import (
    InputError,
    InputTypeError,
    MissingFileError,
    MissingPackageError,
    PlateauError,
    PlateauWarning,
    RunFailed,
    RunStopped,
    UnknownNameError,
)
from plateau.late_names import found

if TYPE_CHECKING:
    from plateau import study
    from plateau.commands import check, collect, command
    from plateau.drive_cycle import cycle
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

# Where names are found when they are asked for first: with pandas and xarray all of them would take half a second.
HOMES = {"check": "commands", "collect": "commands", "command": "commands", "cycle": "drive_cycle", "export": "exports", "plot": "figures"}
HOMES |= {"plot_accuracy": "figures.accuracy", "plot_surfaces": "figures.surfaces", "MapAccessor": "map_accessor", "Mean": "means"}
HOMES |= {"find_program": "program", "RunAccessor": "run_accessor", "open_run": "run_file", "report": "run_report", "run": "runs", "sweep": "runs"}
HOMES |= {"Scene": "scenes", "Simulation": "simulation", "Study": "study", "open_study": "study"}


def __getattr__(name: str) -> Any:
    globals()[name] = _version() if name == "__version__" else found(__name__, HOMES, name)
    return globals()[name]


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


def _version() -> str:
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version("plateau-brake")
    except PackageNotFoundError:  # a checkout that is not installed
        return "0"


def register(xarray: Any) -> None:
    """Registers the accessors of runs and maps, which are imported when they are used first."""
    xarray.register_datatree_accessor("plateau")(lambda run: found(__name__, HOMES, "RunAccessor")(run))
    xarray.register_dataarray_accessor("plateau")(lambda array: found(__name__, HOMES, "MapAccessor")(array))


class AfterXarray(MetaPathFinder):
    """Registers the accessors when xarray is imported, by whomever."""

    def find_spec(self, name: str, path: Any, target: Any = None) -> ModuleSpec | None:
        """Finds xarray as others do, and has the accessors registered after it."""
        if name != "xarray":
            return None
        # Without itself, or it would be asked again; with it afterwards, for who finds does not always import.
        sys.meta_path.remove(self)
        try:
            spec = find_spec(name)
        finally:
            sys.meta_path.insert(0, self)
        if spec is not None and spec.loader is not None:
            execute = spec.loader.exec_module

            def execute_both(module: Any) -> None:
                execute(module)
                register(module)

            spec.loader.exec_module = execute_both  # type: ignore[method-assign]
        return spec


if "xarray" in sys.modules:
    register(sys.modules["xarray"])
else:
    sys.meta_path.insert(0, AfterXarray())

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
