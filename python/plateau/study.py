"""Results of studies."""

import os
import tomllib
from pathlib import Path
from typing import NamedTuple

import pandas
import xarray

from plateau.errors import InputError, InputTypeError, MissingFileError
from plateau.run_file import locking


class Study(NamedTuple):
    """Results of a study.

    Attributes
    ----------
    table : pandas.DataFrame
        A row for each run: state, factors, responses. Quantities are in the unit of their column head: factors in that of the study,
        if it states all their levels in one unit, responses in SI units.
    data : xarray.Dataset
        Factors, responses and series of all runs, with the dimensions ``run`` and ``time`` (``sample`` if the runs have
        different times), SI units.
    """

    table: pandas.DataFrame
    data: xarray.Dataset


def open_study(path: str | os.PathLike[str]) -> Study:
    """Opens the results that ``plateau sweep collect`` has written.

    Parameters
    ----------
    path : path
        The folder with ``results.csv`` and ``results.h5``, or the study file (TOML) that names it.

    Returns
    -------
    Study
        Table and data.

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
    if folder.suffix == ".toml":
        folder = folder.parent / _directory(folder)
    csv, hdf5 = folder / "results.csv", folder / "results.h5"
    for file in (csv, hdf5):
        if not file.is_file():
            raise MissingFileError(f"{file}: there is no such file; plateau.collect makes it, or plateau.sweep with the runs")
    try:
        table, data = read_table(csv), xarray.load_dataset(hdf5, engine="h5netcdf", driver_kwds=locking(hdf5))
        # In CSV, words such as nan and 007 look like numbers, and =1+1 has an apostrophe before it.
        for name in set(table).intersection(data.data_vars) - {"state", "error"}:
            if data[name].dtype.kind in "OSU":
                table[name] = data[name].values
        return Study(table, data)
    except (OSError, ValueError) as error:
        raise InputError(f"{folder}: the results cannot be read: {error}; plateau.collect makes them anew") from error


def _directory(study: Path) -> str:
    """The folder of results that a study file names, relative to it."""
    try:
        return str(tomllib.loads(study.read_text(encoding="utf-8")).get("directory", study.stem))
    except FileNotFoundError:
        raise MissingFileError(f"{study}: there is no such study") from None
    except (OSError, ValueError) as error:
        raise InputError(f"{study}: cannot be read as a study: {error}") from error


def read_table(path: str | os.PathLike[str]) -> pandas.DataFrame:
    """Reads a table in CSV, with exactly the numbers of the file.

    Parameters
    ----------
    path : path

    Returns
    -------
    pandas.DataFrame
    """
    # From version 3.1, pandas does this by default and no longer accepts the option.
    version = tuple(map(int, pandas.__version__.split(".")[:2]))
    options = {} if version >= (3, 1) else {"float_precision": "round_trip"}
    return pandas.read_csv(path, **options)
