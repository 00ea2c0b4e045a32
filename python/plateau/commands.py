"""Commands that the program answers, as functions."""

import os
import tempfile
import warnings
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from typing import Any

from plateau.errors import InputError, InputTypeError, PlateauWarning, shown
from plateau.program import call, file_name, listen
from plateau.scenes import Scene, scene_of
from plateau.study.data import Study
from plateau.study.results import at, open_study
from plateau.toml_text import change_of

# A path, as usual in Python.
Path = str | os.PathLike[str]


def check(scene: Path | Mapping[str, Any] | Scene, *, set: Mapping[str, Any] | None = None, workers: int | str | None = None) -> dict[str, Any]:
    """Checks a scene without running it.

    Parameters
    ----------
    scene, set, workers
        See `run`.

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
    if isinstance(scene, Mapping) or (isinstance(scene, str) and "\n" in scene):
        # The program warns, too.
        with warnings.catch_warnings(action="ignore", category=PlateauWarning):
            scene = scene_of(scene, {}, 2)
    with _file_of(scene) as name:
        found = dict(call(["check", name, *_scene_arguments(set, workers)]))
    if isinstance(scene, Scene):
        found["files"] = [file for file in found["files"] if file["path"] != name]
    return found


@contextmanager
def _file_of(scene: Path | Scene) -> Iterator[str]:
    """A file with a scene: its own, or one for a while. That is in the working directory, from where the scene names files."""
    if not isinstance(scene, Scene):
        yield file_name(scene, "a scene")
        return
    with tempfile.NamedTemporaryFile("w", dir=os.curdir, prefix=".scene-", suffix=".toml", encoding="utf-8") as file:
        file.write(scene.toml)
        file.flush()
        yield os.path.relpath(file.name)


def collect(study: Path, *, directory: Path | None = None, force: bool = False) -> Study:
    """Collects the existing results of a study, complete or not, and opens them.

    Parameters
    ----------
    study : path
        The study, TOML.
    directory : path, optional
        Folder of the results; by default the one that the study names.
    force : bool
        Replace tables even by ones with fewer finished runs.

    Returns
    -------
    Study
        Table and data; runs without result have the state ``missing`` or ``failed``.
    """
    call(["sweep", "collect", file_name(study, "a study"), *at(directory), *(["--force"] if force else [])])
    return open_study(study, directory=directory)


def command(*arguments: Any, json: bool = False, **options: Any) -> Any:
    """Calls any command of the program, with its options as keywords.

    Parameters
    ----------
    *arguments : str, path or Scene
        The command and its arguments: ``"surface", "disc.sdf"``.
    json : bool
        True if the command prints JSON, which is returned as Python objects. ``plateau COMMAND --help`` says which commands can do this.
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
    line: list[Path] = []
    with ExitStack() as files:
        for argument in arguments:
            named = files.enter_context(_file_of(argument)) if isinstance(argument, Scene) else argument
            line.append(named if isinstance(named, os.PathLike) else str(named))
        for name, given in options.items():
            flag = f"--{name.replace('_', '-')}"
            if isinstance(given, Mapping):
                given = [change_of(key, value) for key, value in given.items()]
            if given is True:
                line.append(flag)
            elif given is not None and given is not False:
                for value in given if isinstance(given, list | tuple) else [given]:
                    line += [flag, os.fspath(value) if isinstance(value, os.PathLike) else str(value)]
        return call(line) if json else listen(line)


def _scene_arguments(changes: Mapping[str, Any] | None, workers: int | str | None) -> list[Path]:
    arguments: list[Path] = []
    if changes is not None and not isinstance(changes, Mapping):
        raise InputTypeError(f'set = {changes!r}: expected a dictionary, such as set={{"operation.normal_force": "20 N"}}')
    for key, value in (changes or {}).items():
        if not isinstance(key, str) or "=" in key:
            raise InputError(f'set: {shown(key)} is not a key of a scene, expected text such as "operation.normal_force"')
        arguments += ["--set", change_of(key, value)]
    if workers is not None:
        arguments += ["--workers", str(workers)]
    return arguments
