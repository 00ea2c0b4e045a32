"""A study of scenes that are given one by one: its factors are the keys in which they differ."""

import csv
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from plateau.errors import InputError
from plateau.scenes import scene_of
from plateau.study.scene_comparison import response_of
from plateau.toml_text import toml_document

# What tells scenes apart and is no factor.
NAMES = {"title", "output.file"}


def of_scenes(
    scenes: Sequence[Any], directory: str | os.PathLike[str], responses: str | Sequence[str] = "contact_area:mean", *, force: bool = False
) -> Path:
    """Writes a study file whose runs are these scenes; ``plateau.sweep`` makes them.

    Parameters
    ----------
    scenes : sequence
        Two or more, each as for `Scene`, of the same parts of the model. A key in which they differ is a factor, with the name of the key.
    directory : path
        Folder of the study, which has the file ``study.toml`` then.
    responses : str or sequence of str
        As for `compare`: ``"contact_area:mean"``, ``"worn_pin:end"``.
    force : bool
        Write the files of a study that is there anew; its results stay.

    Returns
    -------
    Path
        The study file.

    Raises
    ------
    InputError
        If the scenes do not differ, or a factor would have no single value in each of them, or there is a study in the folder.
    """
    made = [scene_of(scene, {}, 2) for scene in scenes]
    values = [dict(_leaves(scene.tables)) for scene in made]
    keys = sorted(set().union(*values) - NAMES)
    factors = [key for key in keys if any(one.get(key) != values[0].get(key) for one in values)]
    if not factors:
        raise InputError(f"{len(scenes)} scenes that do not differ: expected two or more, with other values of a key")
    for key in factors:
        if any(isinstance(one.get(key), list | type(None)) for one in values):
            raise InputError(f"{key}: the scenes differ in it, and it is a list or not in all of them, so it is no factor")
    asked = [responses] if isinstance(responses, str) else responses
    tables = {"factor": [{"name": key, "key": key} for key in factors], "response": [response_of("", response) for response in asked]}
    folder = Path(directory)
    path = folder / "study.toml"
    if path.exists() and not force:
        raise InputError(f"{path} exists: take another folder, or force=True to write its files anew")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "scene.toml").write_text(made[0].toml, encoding="utf-8")
    with (folder / "points.csv").open("w", newline="", encoding="utf-8") as file:
        lines = csv.writer(file)
        lines.writerow(factors)
        lines.writerows([str(value).lower() if isinstance(value := one[key], bool) else str(value) for key in factors] for one in values)
    study = {"version": 1, "title": str(values[0]["title"]), "base": "scene.toml", "directory": ".", "design": "csv", "file": "points.csv"}
    path.write_text(toml_document({**study, **tables}), encoding="utf-8")
    return path


def _leaves(table: Mapping[str, Any], above: str = "") -> Any:
    """Paths of keys and their values."""
    for name, value in table.items():
        if isinstance(value, Mapping):
            yield from _leaves(value, f"{above}{name}.")
        else:
            yield f"{above}{name}", value
