"""Results of studies: the file that ``plateau sweep collect`` writes, as factors, responses and runs."""

import json
import math
import os
import tempfile
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pandas
import xarray

from plateau.errors import InputError, InputTypeError, MissingFileError
from plateau.program import call, file_name
from plateau.run_file import locking

Numbers = npt.NDArray[np.float64]

# Scales on which a response can be fitted, and the way back. It never falls, so that ends of intervals stay ends.
TRANSFORMS: dict[str, tuple[Any, Any]] = {
    "none": (lambda y: y, lambda y: y),
    "log": (np.log, np.exp),
    "square root": (np.sqrt, lambda y: np.maximum(y, 0.0) ** 2),
    "logit": (lambda y: np.log(y) - np.log1p(-y), lambda y: 1.0 / (1.0 + np.exp(-y))),
}


@dataclass(frozen=True)
class Factor:
    """A factor of a study.

    Attributes
    ----------
    name : str
        Its name in the study.
    keys : str
        The keys of the scene that it sets; empty if it is set elsewhere.
    unit : str
        SI unit of its numbers; ``"1"`` without a unit, ``""`` for words.
    levels : tuple
        What it is set to, in the order of the study: numbers in SI units or words; the two ends of a range.
    is_range : bool
        Whether it may have any value between two ends.
    logarithmic : bool
        Whether equal steps of the range are equal ratios.
    whole : bool
        Whether its numbers are whole.
    study_unit : str
        The unit in which the study states it; empty without one.
    one, zero : float
        What one and 0 of that unit are in SI units.
    """

    name: str
    keys: str
    unit: str
    levels: tuple[Any, ...]
    is_range: bool
    logarithmic: bool
    whole: bool
    study_unit: str
    one: float
    zero: float

    @property
    def is_number(self) -> bool:
        """Whether its values are numbers."""
        return bool(self.levels) and not isinstance(self.levels[0], str)

    @property
    def ends(self) -> tuple[float, float]:
        """The smallest and the largest of its numbers, SI."""
        return (self.levels[0], self.levels[1]) if self.is_range else (min(self.levels), max(self.levels))

    def coded(self, values: Any) -> Numbers:
        """Places between the ends: -1 at the lower one, 1 at the upper one.

        Parameters
        ----------
        values : array_like of float
            Values in SI units.

        Returns
        -------
        numpy.ndarray
        """
        low, high = self.ends
        place = np.asarray(values, float)
        if self.logarithmic:
            low, high, place = math.log(low), math.log(high), np.log(place)
        return np.asarray((2.0 * place - (low + high)) / (high - low))

    def value(self, coded: Any) -> Numbers:
        """Values in SI units at coded places; the inverse of `coded`.

        Parameters
        ----------
        coded : array_like of float

        Returns
        -------
        numpy.ndarray
        """
        (low, high), share = self.ends, (np.asarray(coded, float) + 1.0) / 2.0
        return np.asarray(low * (high / low) ** share if self.logarithmic else low + (high - low) * share)

    def in_study_unit(self, values: Any) -> Numbers:
        """Numbers in the unit of the study.

        Parameters
        ----------
        values : array_like of float
            Values in SI units.

        Returns
        -------
        numpy.ndarray
        """
        return np.asarray((np.asarray(values, float) - self.zero) / self.one)

    def text(self, value: Any) -> str:
        """A value for people, such as ``"7 N"``.

        Parameters
        ----------
        value : float or str
            In SI units, or a word.

        Returns
        -------
        str
        """
        if isinstance(value, str):
            return value
        return f"{float(self.in_study_unit(value)):.6g} {self.study_unit}".strip()


@dataclass(frozen=True)
class Response:
    """A response of a study.

    Attributes
    ----------
    name : str
        Its name in the study.
    unit : str
        SI unit; ``"1"`` for plain numbers.
    series : str
        The series of a run that it is taken from; empty for imported values.
    transform : str
        The scale on which it is fitted: ``"none"``, ``"log"``, ``"square root"`` or ``"logit"``.
    low, high : float
        What it can be at least and at most; infinite without such a bound.
    asked : dict
        Its table in the study file: ``measured``, ``uncertainty``, ``mean``, ...
    """

    name: str
    unit: str
    series: str
    transform: str
    low: float
    high: float
    asked: dict[str, Any]

    def scaled(self, values: Any) -> Numbers:
        """Values on the scale of the fit.

        Parameters
        ----------
        values : array_like of float
            SI units.

        Returns
        -------
        numpy.ndarray
            Not finite where the scale has no such value.
        """
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(TRANSFORMS[self.transform][0](np.asarray(values, float)))

    def back(self, values: Any) -> Numbers:
        """Values of a fit in SI units, no more than can be.

        Parameters
        ----------
        values : array_like of float
            On the scale of the fit.

        Returns
        -------
        numpy.ndarray
        """
        return np.asarray(np.clip(TRANSFORMS[self.transform][1](np.asarray(values, float)), self.low, self.high))


@dataclass(frozen=True, repr=False)
class Study:
    """A study and its results; ``table, data = study`` takes it apart.

    Attributes
    ----------
    title : str
    design : str
        Kind of the design, such as ``"full-factorial"``.
    factors : list of Factor
    responses : list of Response
    runs : pandas.DataFrame
        A row for each run, by its number: ``point``, ``replicate``, ``order``, ``same_as``, ``state``, and by their names all factors and
        responses, in SI units or words; NaN where a run gives no response.
    errors : pandas.DataFrame
        Standard errors of responses, where runs have them.
    table : pandas.DataFrame
        The same for people: quantities in the unit of their column head.
    data : xarray.Dataset
        Factors, responses and series of all runs, with the dimensions ``run`` and ``time`` (``sample`` if the runs have
        different times), SI units.
    document : dict
        The study file.
    path : Path or None
        The study file, if it was opened by it.
    directory : Path
        The folder of its results.
    """

    title: str
    design: str
    factors: list[Factor]
    responses: list[Response]
    runs: pandas.DataFrame
    errors: pandas.DataFrame
    table: pandas.DataFrame
    data: xarray.Dataset
    document: dict[str, Any]
    path: Path | None
    directory: Path

    def __iter__(self) -> Iterator[Any]:
        return iter((self.table, self.data))

    def __repr__(self) -> str:
        names = ", ".join(factor.name for factor in self.factors), ", ".join(response.name for response in self.responses)
        return f"Study {self.title!r}: {self.design}, {len(self.runs)} runs; factors: {names[0]}; responses: {names[1]}"

    @property
    def seeds(self) -> int:
        """Number of sets of seeds with which each point is run; 1 without replicates."""
        return int(self.runs["replicate"].max()) if len(self.runs) else 1


def open_study(path: str | os.PathLike[str]) -> Study:
    """Opens the results that ``plateau sweep collect`` has written.

    Parameters
    ----------
    path : path
        The folder with ``results.csv`` and ``results.h5``, or the study file (TOML) that names it.

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
        folder = study.parent / _directory(study)
    return _opened(folder, study, folder)


def analysed(study: "Study | str | os.PathLike[str]") -> Study:
    """Collects what there is of a study now, without writing into its folder, and opens it.

    Parameters
    ----------
    study : path or Study
        The study, TOML; or one that was opened, which stays as it is.

    Returns
    -------
    Study
    """
    if isinstance(study, Study):
        return study
    path = Path(file_name(study, "a study"))
    if path.is_dir():
        return open_study(path)
    with tempfile.TemporaryDirectory() as folder:
        call(["sweep", "collect", path, "--output", folder], progress=False)
        return _opened(Path(folder), path, path.parent / _directory(path))


def _opened(folder: Path, study: Path | None, directory: Path) -> Study:
    csv, hdf5 = folder / "results.csv", folder / "results.h5"
    for file in (csv, hdf5):
        if not file.is_file():
            raise MissingFileError(f"{file}: there is no such file; plateau sweep collect makes it, or plateau sweep run with the runs")
    try:
        table, data = read_table(csv), xarray.load_dataset(hdf5, engine="h5netcdf", driver_kwds=locking(hdf5))
        # In CSV, words such as nan and 007 look like numbers, and =1+1 has an apostrophe before it.
        for name in set(table).intersection(data.data_vars) - {"state", "error"}:
            if data[name].dtype.kind in "OSU":
                table[name] = data[name].values
        document = tomllib.loads(str(data.attrs["study"]))
        with_role = {role: [data[name] for name in data.data_vars if data[name].attrs.get("role") == role] for role in ROLES}
        own = {name: data[name].values for name in ("point", "replicate", "order", "same_as", "state")}
        index = pandas.Index(data["run"].values.astype(int), name="run")

        def columns(role: str) -> dict[str, Any]:
            return {str(values.attrs["name"]): values.values for values in with_role[role]}

        if taken := [(role, name) for role in ROLES[:2] for name in columns(role) if name in own]:
            raise InputError(
                f'{study or folder}: {taken[0][0]} "{taken[0][1]}": tables of runs have a column of this name; give it another one'
            )
        asked = {str(table.get("name", table.get("dataset", "").rsplit("/")[-1])): table for table in document.get("response", [])}
        study_of = Study(
            title=str(data.attrs["title"]),
            design=str(data.attrs["design"]),
            factors=[_factor(values) for values in with_role["factor"]],
            responses=[_response(values, asked) for values in with_role["response"]],
            runs=pandas.DataFrame({**own, **columns("factor"), **columns("response")}, index=index),
            errors=pandas.DataFrame(columns("standard error"), index=index),
            table=table,
            data=data,
            document=document,
            path=study,
            directory=directory,
        )
    except InputError:
        raise
    except (OSError, ValueError, KeyError) as error:
        raise InputError(f"{folder}: the results cannot be read: {error}; plateau sweep collect makes them anew") from error
    return _with_imported(study_of)


def _with_imported(study: Study) -> Study:
    """A study with the values of its imported responses."""
    if not any(response.asked.get("imported") for response in study.responses):
        return study
    from plateau.study.measured import imported_values

    values = imported_values(study)
    units = {response.name: response.unit for response in study.responses}
    for name in map(str, values):
        study.runs[name] = values[name]
        study.table[name if units[name] == "1" else f"{name} [{units[name]}]"] = values[name].to_numpy()
    if "error" in study.table:
        study.table["error"] = study.table.pop("error")
    if "base" not in study.document:
        # Where no runs are made, those with values are finished.
        state = study.runs["state"].where(~values.notna().any(axis=1), "finished")
        study.runs["state"] = study.table["state"] = state.to_numpy()
    return study


ROLES = ("factor", "response", "standard error")


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
        if len(levels) == 2 and len(found) > 2 or not labels and len(found) > 2 or len(levels) > MOST_LEVELS:
            # Between two levels there are points of a response surface, and a table has values where they are.
            levels, is_range = (min(levels), max(levels)) if len(levels) > 2 else levels, True
    return Factor(
        name=str(said["name"]),
        keys=str(said["keys"]),
        unit=str(said.get("units", "")),
        levels=levels,
        is_range=is_range,
        logarithmic=said["scale"] == "logarithmic",
        whole=bool(said["whole"]),
        study_unit=str(said.get("study_units", "")),
        one=float(said.get("study_unit", 1.0)),
        zero=float(said.get("study_zero", 0.0)),
    )


# Numbers of a factor up to which they are levels; with more it has a range.
MOST_LEVELS = 10


def _response(values: xarray.DataArray, asked: dict[str, Any]) -> Response:
    said = values.attrs
    return Response(
        name=str(said["name"]),
        unit=str(said.get("units", "1")),
        series=str(said.get("series", "")),
        transform=str(said["transform"]),
        low=float(said.get("valid_min", -math.inf)),
        high=float(said.get("valid_max", math.inf)),
        asked=asked.get(str(said["name"]), {}),
    )


def _directory(study: Path) -> str:
    """The folder of results that a study file names, relative to it."""
    try:
        return str(tomllib.loads(study.read_text(encoding="utf-8")).get("directory", study.stem))
    except FileNotFoundError:
        raise MissingFileError(f"{study}: there is no such study") from None
    except (OSError, ValueError) as error:
        raise InputError(f"{study}: cannot be read as a study: {error}") from error


def read_table(path: str | os.PathLike[str]) -> pandas.DataFrame:
    """Reads a table in CSV, with exactly the numbers of the file."""
    # From version 3.1, pandas does this by default and no longer accepts the option.
    version = tuple(map(int, pandas.__version__.split(".")[:2]))
    options: Any = {} if version >= (3, 1) else {"float_precision": "round_trip"}
    table: pandas.DataFrame = pandas.read_csv(path, **options)
    return table
