"""Runs that a call names: opened, with what deserves to be said of them, and the files that are not to be replaced."""

import json
import os
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import xarray

from plateau.errors import InputError, PlateauNote, PlateauWarning
from plateau.run_file import array, open_run, source

# A path, or an opened run.
Run = str | os.PathLike[str] | xarray.DataTree
MOST_RUNS = 10
# Part of the last time that a time may be beyond the maps without a word.
BEYOND = 1e-3


def opened(runs: Run | Sequence[Run]) -> list[xarray.DataTree]:
    """Runs that are shown together, at most ten; warns of those that are not finished, or named twice.

    Parameters
    ----------
    runs : path, xarray.DataTree, or a sequence of them

    Returns
    -------
    list of xarray.DataTree

    Raises
    ------
    InputError
        If there are too many of them, or a file is no run file.
    """
    named = [runs] if isinstance(runs, str | os.PathLike | xarray.DataTree) else list(runs)
    if not 0 < len(named) <= MOST_RUNS:
        raise InputError(f"{len(named)} runs: expected 1 to {MOST_RUNS}, more make no legible figure; name fewer")
    trees = [run if isinstance(run, xarray.DataTree) else open_run(run) for run in named]
    seen = set()
    for run in trees:
        state = str(run.attrs.get("state"))
        if state != "finished":
            said = "running (or it was killed)" if state == "running" else state
            warn(f"{source(run)} is not finished: its state is {said}, with {counted(run.sizes.get('time', 0), 'sample')}")
        real = os.path.realpath(source(run))
        if real in seen:
            warn(f"{source(run)} is named more than once")
        seen.add(real)
    return trees


def labels_of(runs: Sequence[xarray.DataTree]) -> list[str]:
    """The title of every run's scene; where titles are equal with the name of the file behind it, where these are, too, with its path."""
    paths = [os.path.splitext(str(run.encoding.get("source") or ""))[0] for run in runs]
    titles = [" ".join(str(run.attrs.get("title", "")).split()) for run in runs]
    labels = titles = [title if len(title) <= 200 else f"{title[:199]}…" for title in titles]
    for files in (map(os.path.basename, paths), paths):
        named = zip(labels, titles, files, strict=True)
        labels = [label if label and labels.count(label) == 1 else f"{known} ({file})" if known else file for label, known, file in named]
    return labels


def counted(number: int, what: str) -> str:
    """A number of things in words: ``"1 sample"``."""
    return f"{number} {what}{'' if number == 1 else 's'}"


def inputs_of(runs: Sequence[xarray.DataTree]) -> tuple[Path, ...]:
    """The run files, and the files that they were made of: none of them is replaced by what is made of the runs."""
    return tuple(Path(path) for run in runs for path in (source(run), *(one["path"] for one in read_files(run))))


def read_files(run: xarray.DataTree) -> list[dict[str, str]]:
    """The files that a run has read: path and digest (sha256)."""
    try:
        found: Any = json.loads(str(run.attrs.get("inputs", "[]")))
        return [{"path": str(one["path"]), "sha256": str(one["sha256"])} for one in found]
    except (ValueError, TypeError, KeyError):
        return []


def named_like(run: xarray.DataTree, ending: str) -> Path:
    """A path in the working directory, named like a run file with another ending."""
    return Path(Path(source(run)).stem + ending)


def warn_of_times(runs: Sequence[xarray.DataTree], at: Sequence[float]) -> None:
    """Warns where a map is asked for, by a time in s, before the first or after the last one of a run."""
    for run in runs:
        times: Any = array(run, "map_time").values if run.sizes.get("map_time") else []
        for time in at if len(times) else ():
            # Maps are of the step that comes to their time.
            place = {time < times[0] - BEYOND * times[-1]: "before the first", time > times[-1] * (1 + BEYOND): "after the last"}.get(True)
            if place:
                nearest = times[0 if place == "before the first" else -1]
                warn(f"{source(run)}: {time:.4g} s is {place} recorded map, that of {nearest:.4g} s is shown")


def warn(message: str) -> None:
    """Gives a warning of the package."""
    warnings.warn(message, PlateauWarning, stacklevel=4)


def note(message: str, stacklevel: int = 4) -> None:
    """Says what is worth knowing, in a warning that names the line so many calls up."""
    warnings.warn(PlateauNote(message), stacklevel=stacklevel)
