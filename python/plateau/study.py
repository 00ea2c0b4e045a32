"""Results of studies."""

import os
import tomllib
from pathlib import Path
from typing import NamedTuple

import pandas
import xarray


class Study(NamedTuple):
    """Results of a study.

    Attributes
    ----------
    table : pandas.DataFrame
        A row for each run: state, factors, responses. Quantities are in the unit in the head of their column.
    data : xarray.Dataset
        Factors, responses and series of all runs, with the dimensions ``run`` and ``time`` (``sample`` where times differ from
        run to run), SI units.
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
    FileNotFoundError
        If no results have been collected there.

    Examples
    --------
    >>> table, data = open_study("loads.toml")
    >>> data["contact_area"].dims
    ('run', 'time')
    """
    folder = Path(path)
    if folder.suffix == ".toml":
        named = tomllib.loads(folder.read_text(encoding="utf-8")).get("directory", folder.stem)
        folder = folder.parent / named
    csv, hdf5 = folder / "results.csv", folder / "results.h5"
    for file in (csv, hdf5):
        if not file.is_file():
            raise FileNotFoundError(f"{file}: there is no such file; `plateau sweep collect` writes it")
    return Study(read_table(csv), xarray.load_dataset(hdf5, engine="h5netcdf"))


def read_table(path: str | os.PathLike[str]) -> pandas.DataFrame:
    """A table in CSV, with the numbers of the file to the bit.

    Parameters
    ----------
    path : path

    Returns
    -------
    pandas.DataFrame
    """
    # From version 3.1 on pandas does so anyway, and no longer wants to be told.
    version = tuple(map(int, pandas.__version__.split(".")[:2]))
    options = {} if version >= (3, 1) else {"float_precision": "round_trip"}
    return pandas.read_csv(path, **options)
