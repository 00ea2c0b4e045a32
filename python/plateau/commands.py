"""The commands of the program as functions."""

import os
import warnings
from collections.abc import Mapping
from json import dumps
from typing import Any

import xarray

from plateau.errors import InputError, InputTypeError, PlateauWarning
from plateau.program import call, file_name, listen
from plateau.run_file import open_run
from plateau.study.data import Study
from plateau.study.results import open_study
from plateau.units import quantity

# A path, as usual in Python.
Path = str | os.PathLike[str]


def run(
    scene: Path,
    output: Path | None = None,
    *,
    set: Mapping[str, Any] | None = None,
    workers: int | str | None = None,
    force: bool = False,
    resume: bool = False,
    extend_to: float | str | None = None,
    progress: bool | None = None,
) -> xarray.DataTree:
    """Runs a scene and opens its run file.

    Parameters
    ----------
    scene : path
        The scene, TOML.
    output : path, optional
        The run file; by default the one that the scene names.
    set : mapping, optional
        Keys of the scene and their values; a physical quantity is text with its unit.
    workers : int or "auto", optional
        Threads that share the run.
    force : bool
        Replace an existing run file.
    resume : bool
        Continue a run that was stopped or killed.
    extend_to : float or str, optional
        Continue beyond the end of a run, to this time, s, or text with a unit such as ``"2 h"``.
    progress : bool, optional
        Whether progress is shown; by default in notebooks and terminals.

    Returns
    -------
    xarray.DataTree
        As for `open_run`; its ``attrs["summary"]`` is the summary of the program, a dictionary in SI units. It does not exist if
        ``resume`` found a finished run.

    Raises
    ------
    InputError, RunFailed, RunStopped
        With the message of the program.

    Examples
    --------
    >>> heavy = run("quick.toml", "heavy.h5", set={"operation.normal_force": "10 N", "operation.duration": "2 s"})
    >>> heavy.attrs["summary"]["steps"]
    978
    >>> run("quick.toml", "light.h5", set={"operation.normal_force": 1})  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    plateau.errors.InputError: set["operation.normal_force"] = 1: ... 1 has no unit, expected a force such as "47 N" (N, kN, mN)
    """
    arguments = ["run", file_name(scene, "a scene"), *_scene_arguments(set, workers)]
    if output is not None:
        arguments += ["--output", file_name(output, "a run file")]
    if extend_to is not None:
        arguments += ["--extend-to", extend_to if isinstance(extend_to, str) else f"{quantity(extend_to, 's')!r} s"]
    arguments += [flag for flag, given in (("--force", force), ("--resume", resume)) if given]
    summary = call(arguments, progress)
    if summary is None:
        # The run to continue is finished: nothing was done.
        return open_run(_output_of(scene, set) if output is None else output)
    opened = open_run(summary["file"])
    opened.attrs["summary"] = summary
    return opened


def check(scene: Path, *, set: Mapping[str, Any] | None = None, workers: int | str | None = None) -> dict[str, Any]:
    """Checks a scene without running it.

    Parameters
    ----------
    scene, set, workers
        As for `run`.

    Returns
    -------
    dict
        The resolved scene (``scene``, TOML), and what the run needs: ``steps``, ``samples``, ``memory`` (bytes),
        ``estimated_time`` (s), ``warnings``, ...

    Examples
    --------
    >>> check("quick.toml", set={"mesh.rows": 10, "output.file": "ten-rows.h5"})["rows"]
    10
    """
    return dict(call(["check", file_name(scene, "a scene"), *_scene_arguments(set, workers)], progress=False))


def sweep(
    study: Path,
    *,
    jobs: int | None = None,
    workers: int | None = None,
    max_failures: int | None = None,
    retry: bool = False,
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
    progress : bool, optional
        Whether progress is shown; by default in notebooks and terminals.

    Returns
    -------
    Study
        Table and data.

    Raises
    ------
    InputError, RunFailed, RunStopped
        With the message of the program. Results of runs that have ended are kept; `collect` opens them.

    Examples
    --------
    >>> results = sweep("loads.toml")
    >>> results.table["load [N]"].tolist()
    [5.0, 10.0]
    """
    arguments = ["sweep", "run", file_name(study, "a study")]
    for flag, value in (("--jobs", jobs), ("--workers", workers), ("--max-failures", max_failures)):
        if value is not None:
            arguments += [flag, str(value)]
    call(arguments + (["--retry"] if retry else []), progress)
    return collect(study)


def collect(study: Path) -> Study:
    """Collects the existing results of a study, complete or not, and opens them.

    Parameters
    ----------
    study : path
        The study, TOML.

    Returns
    -------
    Study
        Table and data; runs without result have the state ``missing`` or ``failed``.
    """
    call(["sweep", "collect", file_name(study, "a study")], progress=False)
    return open_study(study)


def command(*arguments: Any, json: bool = False, progress: bool | None = None, **options: Any) -> Any:
    """Calls any command of the program, with its options as keywords.

    Parameters
    ----------
    *arguments : str or path
        The command and its arguments: ``"surface", "disc.sdf"``.
    json : bool
        Whether the command prints JSON, which is returned as Python objects. ``plateau COMMAND --help`` says which commands can do this.
    progress : bool, optional
        Whether progress is shown; by default in notebooks and terminals.
    **options
        Options of the command, with ``_`` instead of ``-``: ``force=True`` is ``--force``, ``output="figures"`` is ``--output figures``, a
        list repeats the option. ``set`` takes a mapping, as for `run`. Options that are None or False are left out.

    Returns
    -------
    object
        With ``json``, the document: dictionaries, lists, numbers and text; None if nothing was printed. Otherwise the printed text.

    Raises
    ------
    InputError, RunFailed, RunStopped
        With the message of the program.

    Examples
    --------
    >>> found = command("surface", "--prepare", "quick.toml", json=True)
    >>> [surface["name"] for surface in found]
    ['disc', 'pin']
    >>> print(command("plot", "quick.h5", figure=["status", "heights"], output="figures", force=True), end="")
    wrote figures/status.png: Status of the cells, with parts of the area
    wrote figures/heights.png: Distribution of the heights, positive toward the other body, and Abbott-Firestone curve
    """
    line: list[Path] = [argument if isinstance(argument, os.PathLike) else str(argument) for argument in arguments]
    for name, given in options.items():
        flag = f"--{name.replace('_', '-')}"
        if isinstance(given, Mapping):
            given = [f"{key}={toml_of(value)}" for key, value in given.items()]
        if given is True:
            line.append(flag)
        elif given is not None and given is not False:
            for value in given if isinstance(given, list | tuple) else [given]:
                line += [flag, os.fspath(value) if isinstance(value, os.PathLike) else str(value)]
    return call(line, progress) if json else listen(line, progress)


def _output_of(scene: Path, changes: Mapping[str, Any] | None) -> str:
    """The run file that a scene names."""
    with warnings.catch_warnings():
        # It is known to exist.
        warnings.simplefilter("ignore", PlateauWarning)
        files = check(scene, set=changes)["files"]
    return str(next(file["resolved"] for file in files if file["access"] == "writes"))


def _scene_arguments(changes: Mapping[str, Any] | None, workers: int | str | None) -> list[Path]:
    arguments: list[Path] = []
    if changes is not None and not isinstance(changes, Mapping):
        raise InputTypeError(f'set = {changes!r}: expected a dictionary, such as set={{"operation.normal_force": "20 N"}}')
    for key, value in (changes or {}).items():
        if not isinstance(key, str) or "=" in key:
            raise InputError(f"set: {key!r} is not a key of a scene, expected text such as \"operation.normal_force\"")
        arguments += ["--set", f"{key}={toml_of(value)}"]
    if workers is not None:
        arguments += ["--workers", str(workers)]
    return arguments


def toml_document(table: Mapping[str, Any]) -> str:
    """A table in the form of TOML, a line for each key."""
    return "".join(f"{dumps(key)} = {toml_of(value)}\n" for key, value in table.items())


def toml_of(value: Any) -> str:
    """A value in the form of TOML."""
    if hasattr(value, "tolist"):  # of NumPy
        value = value.tolist()
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int | float):
        return repr(value)
    if isinstance(value, str | os.PathLike):
        return dumps(os.fspath(value), ensure_ascii=False)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{dumps(key)} = {toml_of(part)}" for key, part in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(toml_of, value)) + "]"
    raise InputTypeError(f"{value!r} is not a value of a scene: expected text, a number, True or False, a list or a dictionary")
