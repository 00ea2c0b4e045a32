"""Runs and studies in this process, written as those of the program are."""

import json
import os
from collections.abc import Mapping
from typing import Any

import xarray

from plateau.commands import collect
from plateau.errors import InputError, InputTypeError
from plateau.native import native
from plateau.program import file_name
from plateau.progress import Progress
from plateau.run_file import open_run
from plateau.scenes import Scene, engine_name, scene_of
from plateau.study.data import Study
from plateau.study.runs import make_missing
from plateau.units import quantity

# A path, as usual in Python.
Path = str | os.PathLike[str]
# What makes files of these endings of a run.
MADE_OF_RUNS = dict.fromkeys([".csv", ".npz", ".pvd", ".vtk"], "plateau.export")
MADE_OF_RUNS |= {**dict.fromkeys([".png", ".svg", ".pdf"], "plateau.plot"), ".html": "plateau.report"}


def run(
    scene: Path | Mapping[str, Any] | Scene,
    output: Path | None = None,
    *,
    set: Mapping[str, Any] | None = None,
    workers: int | str | None = None,
    engine: str = "fast",
    force: bool = False,
    resume: bool = False,
    extend_to: float | str | None = None,
    progress: bool | None = None,
) -> xarray.DataTree:
    """Runs a scene and opens its run file.

    Ctrl-C stops it between two steps, closes the file and leaves a checkpoint; after a kill, too, ``resume=True`` goes on.

    Parameters
    ----------
    scene : path, str, mapping or Scene
        See `Scene`.
    output : path, optional
        The run file; by default the one that the scene names.
    set : mapping, optional
        Keys of the scene and their values; a physical quantity is text with its unit.
    workers : int or "auto", optional
        Threads that share the run.
    engine : {"fast", "plain"}
        See `Simulation`.
    force : bool
        Replace an existing run file.
    resume : bool
        Continue a run that was stopped or killed.
    extend_to : float or str, optional
        Continue beyond the end of a run, to this time, s, or text with a unit such as ``"2 h"``.
    progress : bool, optional
        Show progress; by default in notebooks and terminals.

    Returns
    -------
    xarray.DataTree
        As for `open_run`; its ``attrs["summary"]`` is the summary of the program, a dictionary in SI units. It does not exist if
        ``resume`` found a finished run.

    Raises
    ------
    InputError, RunFailed
        With the message of the program.

    Examples
    --------
    >>> heavy = run("quick.toml", "heavy.h5", set={"operation.normal_force": "10 N", "operation.duration": "2 s"})
    >>> heavy.attrs["summary"]["steps"]
    978
    >>> run("quick.toml", "light.h5", set={"operation.normal_force": 1})  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    plateau.errors.InputError: operation.normal_force = 1: ... 1 has no unit, expected a force such as "47 N" (N, kN, mN)
    """
    if set is not None and not isinstance(set, Mapping):
        raise InputTypeError(f'set = {set!r}: expected a dictionary, such as set={{"operation.normal_force": "20 N"}}')
    changes = dict(set or {})
    if workers is not None:
        changes["numerics.workers"] = workers
    if extend_to is not None:
        changes["operation.duration"] = extend_to if isinstance(extend_to, str) else f"{quantity(extend_to, 's')!r} s"
    made = scene_of(scene, changes, 2)
    mode = "extend" if extend_to is not None else "resume" if resume else "new"
    file = None if output is None else file_name(output, "a run file")
    _refuse_other_format(os.fspath(made._resolved.output) if file is None else file)
    with Progress(progress) as shown:
        summary: str | None = native().run(made._resolved, file, force, mode, engine_name(engine), shown.tell)
    if summary is None:
        # The run to continue is finished: nothing was done.
        return open_run(made._resolved.output if file is None else file)
    known = json.loads(summary)
    opened = open_run(known["file"])
    opened.attrs["summary"] = known
    return opened


def _refuse_other_format(file: str) -> None:
    """Refuses a name that says that a run file is what `export`, `plot` and `report` make of it."""
    stem, ending = os.path.splitext(file)
    if ending.lower() in MADE_OF_RUNS:
        what = MADE_OF_RUNS[ending.lower()]
        raise InputError(f"{file}: a run file is HDF5, expected a name such as {stem}.h5; afterwards {what} makes {ending} of it")


def sweep(
    study: Path,
    *,
    jobs: int | None = None,
    workers: int | None = None,
    max_failures: int | None = None,
    retry: bool = False,
    keep_files: bool = False,
    directory: Path | None = None,
    force: bool = False,
    progress: bool | None = None,
) -> Study:
    """Makes the missing runs of a study, and opens its results.

    Parameters
    ----------
    study : path
        The study, TOML.
    jobs : int, optional
        Number of runs at the same time; by default the number of cores.
    workers : int, optional
        Threads of each run.
    max_failures : int, optional
        Stop after this number of failed runs; by default the other runs continue.
    retry : bool
        Make failed runs again.
    keep_files : bool
        Keep the run file of every run, in ``runs`` of the folder of the results; runs that have none are made again.
    directory : path, optional
        Folder of the results; by default the one that the study names.
    force : bool
        Replace tables even by ones with fewer finished runs.
    progress : bool, optional
        Show progress; by default in notebooks and terminals.

    Returns
    -------
    Study
        Table and data.

    Raises
    ------
    InputError, RunFailed
        With the message of the program. Results of runs that have ended are kept; `collect` opens them.

    Examples
    --------
    >>> results = sweep("loads.toml")
    >>> results.table["load [N]"].tolist()
    [5.0, 10.0]
    """
    options: dict[str, Any] = {"jobs": jobs, "workers": workers, "max_failures": max_failures}
    make_missing(file_name(study, "a study"), progress, retry, directory=directory, keep_files=keep_files, **options)
    return collect(study, directory=directory, force=force)
