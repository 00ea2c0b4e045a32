"""A study of scenes that are given one by one: its factors are the keys in which they differ."""

import csv
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from plateau.errors import InputError
from plateau.scenes import Scene
from plateau.study.scene_comparison import response_of
from plateau.toml_text import toml_document

# What tells scenes apart and is no factor.
NAMES = {"title", "output.file"}


def of_scenes(scenes: Sequence[Scene], directory: str | os.PathLike[str], responses: Sequence[str] = ("contact_area:mean",)) -> Path:
    """Writes a study file whose runs are these scenes; ``plateau.sweep`` makes them.

    Parameters
    ----------
    scenes : sequence of Scene
        Two or more, of the same parts of the model. A key in which they differ is a factor, with the name of the key.
    directory : path
        Folder of the study, which has the file ``study.toml`` then.
    responses : sequence of str
        As for `compare`.

    Returns
    -------
    Path
        The study file.

    Raises
    ------
    InputError
        If the scenes do not differ, or a factor would have no single value in each of them.
    """
    values = [dict(_leaves(scene.tables)) for scene in scenes]
    keys = sorted(set().union(*values) - NAMES)
    factors = [key for key in keys if any(one.get(key) != values[0].get(key) for one in values)]
    if not factors:
        raise InputError(f"{len(scenes)} scenes that do not differ: expected two or more, with other values of a key")
    for key in factors:
        if any(isinstance(one.get(key), list | type(None)) for one in values):
            raise InputError(f"{key}: the scenes differ in it, and it is a list or not in all of them, so it is no factor")
    folder = Path(directory)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scene.toml").write_text(scenes[0].toml, encoding="utf-8")
    with (folder / "points.csv").open("w", newline="", encoding="utf-8") as file:
        lines = csv.writer(file)
        lines.writerow(factors)
        lines.writerows([str(one[key]) for key in factors] for one in values)
    study = {"version": 1, "title": str(values[0]["title"]), "base": "scene.toml", "directory": ".", "design": "csv", "file": "points.csv"}
    tables = {"factor": [{"name": key, "key": key} for key in factors], "response": [response_of("", asked) for asked in responses]}
    path = folder / "study.toml"
    path.write_text(toml_document({**study, **tables}), encoding="utf-8")
    return path


def _leaves(table: Mapping[str, Any], above: str = "") -> Any:
    """Paths of keys and their values."""
    for name, value in table.items():
        if isinstance(value, Mapping):
            yield from _leaves(value, f"{above}{name}.")
        else:
            yield f"{above}{name}", value
