"""Results of studies: the file that ``plateau sweep collect`` writes, as factors, responses and runs."""

import json
import math
import os
import tempfile
import tomllib
from pathlib import Path
from typing import Any

import pandas
import xarray

from plateau.errors import InputError, InputTypeError, MissingFileError
from plateau.program import call, file_name
from plateau.run_file import locking
from plateau.study.data import Factor, Response, Study
from plateau.study.kept_values import KeptValues
from plateau.units import with_unit


def open_study(path: str | os.PathLike[str], *, directory: str | os.PathLike[str] | None = None) -> Study:
    """Opens the results that ``plateau sweep collect`` has written.

    Parameters
    ----------
    path : path
        The folder with ``results.csv`` and ``results.h5``, or the study file (TOML) that names it.
    directory : path, optional
        With a study file, the folder if it is another one than it names.

    Returns
    -------
    Study
        Factors, responses, runs.

    Raises
    ------
    MissingFileError
        If there is no such study, or no results have been collected there; it is a `FileNotFoundError`, too.
    InputError
        If one of the files cannot be read.

    Examples
    --------
    >>> table, data = open_study("loads.toml")
    >>> data["contact_area"].dims
    ('run', 'time')
    """
    try:
        folder = Path(path)
    except TypeError as error:
        raise InputTypeError(f"{path!r}: expected the folder of the results, or the study file") from error
    study = folder if folder.suffix == ".toml" else None
    if study is not None:
        folder = _directory(study, directory)
    return _opened(folder, study, folder)


def analysed(study: "Study | str | os.PathLike[str]", directory: str | os.PathLike[str] | None = None) -> Study:
    """Collects what there is of a study now, without writing into its folder, and opens it; one that was opened stays as it is."""
    if isinstance(study, Study):
        return study
    path = Path(file_name(study, "a study"))
    if path.is_dir():
        return open_study(path)
    with tempfile.TemporaryDirectory() as folder:
        call(["sweep", "collect", path, *at(directory), "--output", folder])
        return _opened(Path(folder), path, _directory(path, directory))


def at(directory: str | os.PathLike[str] | None) -> list[str]:
    """Arguments of the program that say where the results of a study are."""
    return [] if directory is None else [f"--directory={os.fspath(directory)}"]


def _opened(folder: Path, study: Path | None, directory: Path) -> Study:
    csv, hdf5 = folder / "results.csv", folder / "results.h5"
    for file in (csv, hdf5):
        if not file.is_file():
            raise MissingFileError(f"{file}: there is no such file; plateau sweep collect makes it")
    try:
        # Exactly the numbers of the file; from version 3.1, pandas does so by default and no longer accepts the option.
        exactly: Any = {} if tuple(map(int, pandas.__version__.split(".")[:2])) >= (3, 1) else {"float_precision": "round_trip"}
        table, data = pandas.read_csv(csv, **exactly), xarray.load_dataset(hdf5, engine="h5netcdf", driver_kwds=locking(hdf5))
        # In CSV, words such as nan and 007 look like numbers, and =1+1 has an apostrophe before it.
        for name in set(table).intersection(data.variables) - {"state", "error"}:
            if data[name].dtype.kind in "OSU":
                table[name] = data[name].values
        document = tomllib.loads(str(data.attrs["study"]))
        variables = [data[name] for name in data.variables]
        of_factors, of_responses = ([one for one in variables if one.attrs.get("role") == role] for role in ("factor", "response"))
        own = {name: data[name].values for name in ("point", "replicate", "order", "same_as", "state")}
        index = pandas.Index(data["run"].values.astype(int), name="run")

        factors = [_factor(values) for values in of_factors]
        columns = own | {factor.name: values.values for factor, values in zip(factors, of_factors, strict=True)}
        named = {_name(values, "response", set(columns)): values for values in of_responses}
        runs = pandas.DataFrame(columns | {name: values.values for name, values in named.items()}, index=index)
        asked = {str(table.get("name", table.get("dataset", "").rsplit("/")[-1])): table for table in document.get("response", [])}
        responses, (title, design) = [_response(values, asked, name) for name, values in named.items()], map(data.attrs.get, ("title", "design"))
        if len(table) != len(runs):
            raise InputError(f"{csv} has {len(table)} rows and {hdf5.name} {len(runs)} runs, expected as many; plateau sweep collect makes them anew")
        study_of = Study(str(title), str(design), factors, responses, runs, table, data, document, study, directory)
    except InputError:
        raise
    except (OSError, ValueError, KeyError) as error:
        raise InputError(f"{folder}: the results cannot be read: {error}; plateau sweep collect makes them anew") from error
    return _with_imported(study_of)


def _with_imported(study: Study) -> Study:
    """A study with the values of its imported responses."""
    if not any(response.asked.get("imported") for response in study.responses):
        return study
    values = KeptValues(study).values
    units = {response.name: response.unit for response in study.responses}
    for name in map(str, values):
        study.runs[name] = values[name]
        study.table[with_unit(name, units[name])] = values[name].to_numpy()
    if "error" in study.table:
        study.table["error"] = study.table.pop("error")
    if "base" not in study.document:
        # Where no runs are made, those with values are finished.
        state = study.runs["state"].where(~values.notna().any(axis=1), "finished")
        study.runs["state"] = study.table["state"] = state.to_numpy()
    return study


# Columns that stand beside those of factors in tables of runs and answers.
COLUMNS = {"point", "replicate", "order", "same_as", "state", "error", "run", "place", "response", "unit", "value", "leverage", "beyond", "cautions"}
COLUMNS |= {
    "mean",
    "low",
    "high",
    "observed",
    "runs",
    "round",
    "expected_improvement",
    "is_within",
    "confirmed",
    "check",
    "forecast",
    "deviation",
    "held",
}


def _name(values: xarray.DataArray, role: str, taken: set[str]) -> str:
    """A name, with its role where a column of tables has it; so do the heads of results.csv."""
    name = str(values.attrs["name"])
    return f"{name} ({role})" if name in taken else name


def _factor(values: xarray.DataArray) -> Factor:
    said, labels = values.attrs, json.loads(str(values.attrs["levels"]))
    is_number = values.dtype.kind == "f"
    # Of a table of one's own there are the values that it has.
    found = sorted(set(values.values.tolist()))
    is_range, ends = not labels and "low" in said, (float(said.get("low", 0.0)), float(said.get("high", 0.0)))
    if is_range:
        levels: tuple[Any, ...] = ends
    elif not is_number:
        # Words of a table in the order in which they appear.
        levels = tuple(labels or dict.fromkeys(values.values.tolist()))
    else:
        levels = ends if "low" in said else tuple(found)
        if (len(levels) == 2 and len(found) > 2) or (not labels and len(found) > 2) or len(levels) > MOST_LEVELS:
            # Between two levels there are points of a response surface, and a table has values where they are.
            levels, is_range = (min(levels), max(levels)) if len(levels) > 2 else levels, True
    name, keys, unit = _name(values, "factor", COLUMNS), str(said["keys"]), str(said.get("units", ""))
    in_study = str(said.get("study_units", "")), float(said.get("study_unit", 1.0)), float(said.get("study_zero", 0.0))
    return Factor(name, keys, unit, levels, is_range, said["scale"] == "logarithmic", bool(said["whole"]), *in_study)


# Numbers of a factor up to which they are levels; with more it has a range.
MOST_LEVELS = 10


def _response(values: xarray.DataArray, asked: dict[str, Any], name: str) -> Response:
    said, (low, high) = values.attrs, (float(values.attrs.get(name, end)) for name, end in (("valid_min", -math.inf), ("valid_max", math.inf)))
    unit, series = str(said.get("units", "1")), str(said.get("series", ""))
    return Response(name, unit, series, str(said["transform"]), low, high, asked.get(str(said["name"]), {}))


def _directory(study: Path, given: str | os.PathLike[str] | None) -> Path:
    """The folder of the results of a study: the one that is given, else the one that it names."""
    if given is not None:
        return Path(given)
    try:
        return study.parent / str(tomllib.loads(study.read_text(encoding="utf-8")).get("directory", study.stem))
    except FileNotFoundError:
        raise MissingFileError(f"{study}: there is no such study") from None
    except (OSError, ValueError) as error:
        raise InputError(f"{study}: cannot be read as a study: {error}") from error
