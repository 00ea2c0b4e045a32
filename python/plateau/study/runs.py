"""Runs at any points of a study: made by the program, kept in the journal of the study, none of them twice."""

import math
import os
import tempfile
import warnings
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pandas

from plateau.errors import InputError, PlateauError, PlateauWarning, RunFailed
from plateau.native import native
from plateau.progress import Progress
from plateau.study.data import Factor, Study
from plateau.study.results import analysed
from plateau.toml_text import toml_document
from plateau.units import whole

# Keys of a study file that say where its points are, and the settings of a fit.
OF_DESIGNS = {"resolution", "generators", "points", "trajectories", "levels", "alpha", "centre_points", "seed", "fit"}


def made_study(study: Study, points: pandas.DataFrame, *, progress: bool | None = None, retry: bool = False, **options: Any) -> Study:
    """Makes runs at points of a study that was opened by its file, each with all its seeds, and opens them as a study of their own.

    `points` have a column for each factor, SI units or words; ``point`` of the runs is their row, from 1. With `retry`, runs are made again
    that failed, or did not keep a series. Runs that failed have NaN; `options` are those of ``plateau.sweep``, as `jobs` and `workers`.
    """
    if study.path is None or "base" not in study.document:
        why = "it was opened without its study file" if study.path is None else "it has no base scene"
        raise InputError(f"{study.title}: no runs can be made, because {why}; give the study file of a study with a base scene")
    missing = [factor.name for factor in study.factors if factor.name not in points]
    if missing or points.empty:
        raise InputError(f"points to run: expected at least one, and a column for each factor; missing: {', '.join(missing) or 'points'}")
    # The program knows results by their scenes, so a study of the same folder finds them in its journal.
    with tempfile.TemporaryDirectory() as folder:
        path, factors = Path(folder) / "points.toml", study.factors
        values = {one.name.removesuffix(" (factor)"): [written(one, value) for value in points[one.name]] for one in factors}
        write_study(path, _document(study), pandas.DataFrame(values))
        try:
            made = finished(path, progress, retry, **options)
        except PlateauError as error:
            error.args = (str(error).replace(str(path), str(study.path)), *error.args[1:])
            raise
    runs = made.runs.assign(**{response.name: math.nan for response in study.responses if response.name not in made.runs})
    return replace(made, title=study.title, runs=runs[study.runs.columns], path=study.path)


def write_study(path: Path, document: Mapping[str, Any], points: pandas.DataFrame) -> None:
    """Writes a study file, and beside it the table of its points."""
    path.parent.mkdir(parents=True, exist_ok=True)
    points.to_csv(path.parent / document["file"], index=False)
    path.write_text(toml_document({"version": 1, "design": "csv", **document}), encoding="utf-8")


def finished(path: Path, progress: bool | None, retry: bool = False, directory: Path | None = None, **options: Any) -> Study:
    """Makes the missing runs of a study file and opens it; warns of runs that fail, unless all of them do."""
    failure = ""
    try:
        with warnings.catch_warnings():
            # That a run does not give a response is said of all runs below.
            warnings.filterwarnings("ignore", ".*has no value", PlateauWarning)
            make_missing(path, progress, retry, directory=directory, stacklevel=5, **options)
    except RunFailed as error:
        failure = str(error)
    made = analysed(path, directory)
    lacking = made.runs["state"] != "finished"
    if lacking.any():
        first = made.data["error"].values[lacking.to_numpy()][0] or failure
        message = f"{path}: {lacking.sum()} of {len(lacking)} runs did not end well; the first of them: {first}"
        if lacking.all():
            raise RunFailed(message)
        warnings.warn(message, PlateauWarning, stacklevel=4)
    return made


def make_missing(
    path: str | os.PathLike[str], progress: bool | None, retry: bool = False, *, directory: str | os.PathLike[str] | None = None,
    keep_files: bool = False, stacklevel: int = 4, jobs: int | None = None, workers: int | None = None, max_failures: int | None = None,
) -> None:  # fmt: skip
    """Makes the missing runs of a study file in this process."""
    given = [(jobs, "jobs", 1), (workers, "workers", 1), (max_failures, "failures", 0)]
    counts = [None if number is None else whole(number, what, least) for number, what, least in given]
    with Progress(progress, stacklevel) as shown:
        native().make_runs(path, directory, *counts, retry, keep_files, shown.tell)


def _document(study: Study) -> dict[str, Any]:
    """The study file for other points of a study."""
    here = Path(study.path or "").parent
    document = {key: value for key, value in study.document.items() if key not in OF_DESIGNS}
    responses = [dict(response) for response in document.get("response", []) if not response.get("imported")]
    for response in responses:
        if "measured_file" in response:
            response["measured_file"] = os.path.abspath(here / response["measured_file"])
    # Between levels of numbers there are other values; of words there are no others, and they say what is a word.
    kept = [("name", "key") if factor.is_number else ("name", "key", "levels") for factor in study.factors]
    factors = [{key: given[key] for key in keys if key in given} for given, keys in zip(document["factor"], kept, strict=True)]
    places = {"base": os.path.abspath(here / document["base"]), "directory": os.path.abspath(study.directory), "file": "points.csv"}
    return {**document, **places, "design": "csv", "order": "standard", "factor": factors, "response": responses}


def written(factor: Factor, value: Any) -> str:
    """A value of a factor, SI or a word, as study files have it: with as few digits as give exactly this value, so that runs are found."""
    if isinstance(value, str):
        return value
    if factor.whole:
        return str(round(value))
    number = float(factor.in_study_unit(value))
    texts = (f"{number:.{digits}g}" for digits in (15, 16, 17))
    text = next((text for text in texts if float(text) * factor.one + factor.zero == value), f"{number:.17g}")
    return f"{text} {factor.study_unit}".strip()
