"""Run files as trees of xarray, also of runs that are in progress or were killed."""

import difflib
import importlib.util
import os
import time
from typing import Any

import h5py
import xarray

from plateau.errors import InputError, InputTypeError, MissingFileError, MissingPackageError, PlateauError, UnknownNameError

# The beginning of every HDF5 file.
SIGNATURE = b"\x89HDF\r\n\x1a\n"
# Bytes of a superblock of version 3, which files have that are written while others read them, and where the end of the file stands in it.
SUPERBLOCK, END_OF_FILE = 48, slice(28, 36)
# Seconds during which a file may be shorter than its superblock says: the writer sets the end first.
PATIENCE = 1.0
# What HDF5 says of a file that cannot be locked, and of one that this process has opened without locks already.
NOT_LOCKED = ("unable to lock file", "file locking flag")
# Attributes that HDF5 and netCDF use themselves.
INTERNAL = {"CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST", "_Netcdf4Dimid", "_Netcdf4Coordinates", "_NCProperties"}


def open_run(path: str | os.PathLike[str]) -> xarray.DataTree:
    """Opens a run file.

    If the run has ended, values are read when they are used. If the run is in progress or was killed, all complete data are
    read at once: open it again to see later data.

    Parameters
    ----------
    path : path
        The run file.

    Returns
    -------
    xarray.DataTree
        Groups ``series``, ``disc``, ``pin`` and, with a cycle, ``event`` (docs/run-file.md). The accessor ``plateau`` of the tree
        and of its maps has means, build-up, coverage and plots.

    Raises
    ------
    MissingFileError
        If there is no such file; it is also a `FileNotFoundError`.
    InputError
        If it is not a run file.
    MissingPackageError
        If h5netcdf is not installed; xarray needs it to read run files.

    Examples
    --------
    >>> quick = open_run("quick.h5")
    >>> quick["disc/height"].dims
    ('map_time', 'disc_angle', 'radius')
    >>> quick["series/filled_fraction"].attrs["units"]
    '1'
    """
    try:
        path = os.fsdecode(path)
    except TypeError as error:
        raise InputTypeError(f"{path!r}: expected the path of a run file") from error
    if not path:
        raise InputError("the path of a run file is empty: name one")
    if os.path.isdir(path):
        raise InputError(f"{path}: this is a folder, expected a run file; plateau.open_study opens the results of a study")
    # Opening a pipe would wait for a process that writes into it.
    if os.path.exists(path) and not os.path.isfile(path):
        raise InputError(f"{path}: this is not a regular file, expected a run file")
    options: dict[str, Any] = {}
    try:
        # Refused while the file is being written, and after a kill.
        with h5py.File(path, "r", **(options := locking(path))) as file:
            ended = _state(file, path) != "running"
    except PlateauError:
        raise
    except FileNotFoundError:
        raise MissingFileError(f"{path}: there is no such run file") from None
    except (OSError, KeyError, RuntimeError):
        # In a file that no process writes, HDF5 would look for missing data many times. The run may have ended meanwhile.
        ended = not _is_marked(path)
    if ended:
        if importlib.util.find_spec("h5netcdf") is None:
            raise MissingPackageError("run files are read with h5netcdf: pip install h5netcdf")
        try:
            return xarray.open_datatree(path, engine="h5netcdf", driver_kwds=options)
        except (OSError, KeyError, RuntimeError) as error:
            raise _unreadable(path, error) from error
    _refuse_cut(path)
    try:
        with h5py.File(path, "r", swmr=True, **options) as file:
            _state(file, path)
            found = _complete_part(file)
            found.encoding["source"] = path
            return found
    except PlateauError:
        raise
    except (OSError, KeyError, RuntimeError) as error:
        raise _unreadable(path, error) from error


def locking(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Options of `h5py.File` for a file: without locks where it cannot be locked, as on many network file systems. A reader needs none.

    HDF5 refuses to open a file with locks and without at the same time. So where there are locks, files are opened with them, as
    other users of h5py in this process do.
    """
    try:
        with h5py.File(path, "r"):
            return {}
    except OSError as error:
        return {"locking": False} if any(text in str(error) for text in NOT_LOCKED) else {}


def array(run: xarray.DataTree, path: str) -> xarray.DataArray:
    """A variable of a run by its path, such as ``"series/contact_area"``; `UnknownNameError` if there is none."""
    try:
        found = run[path]
    except KeyError:
        group, _, name = path.rpartition("/")
        there = run[group].data_vars if group in run else run.data_vars
        near = difflib.get_close_matches(name, map(str, there), 1)
        raise UnknownNameError(f"the run has no {path}" + (f", did you mean {near[0]}?" if near else "")) from None
    if not isinstance(found, xarray.DataArray):
        raise UnknownNameError(f"{path} is a group of the run: expected a variable")
    return found


def source(run: xarray.DataTree) -> str:
    """The path of a run's file, from the working directory if it is in there; the title of a run without a file."""
    if not (path := str(run.encoding.get("source") or "")):
        return str(run.attrs.get("title", "run"))
    near = os.path.relpath(path)
    return path if near.startswith(os.pardir) else near


def _unreadable(path: str | os.PathLike[str], error: Exception) -> InputError:
    if os.path.isfile(path) and os.access(path, os.R_OK):
        with open(path, "rb") as file:
            is_hdf5 = file.read(len(SIGNATURE)) == SIGNATURE
        if not is_hdf5:
            advice = "plateau.run(scene) makes the run file of a scene"
            return InputError(f"{os.fspath(path)}: cannot be read as a run file: it is not an HDF5 file; {advice}")
    return InputError(f"{os.fspath(path)}: cannot be read as a run file: {error}")


def _is_marked(path: str | os.PathLike[str]) -> bool:
    """Tells whether the superblock of an HDF5 file says that a process writes it, or wrote it when it was killed."""
    with open(path, "rb") as file:
        superblock = file.read(12)
    return superblock.startswith(SIGNATURE) and len(superblock) == 12 and superblock[8] >= 3 and superblock[11] != 0


def _refuse_cut(path: str) -> None:
    """Refuses a copy that was cut short of a file that is marked as written: HDF5 would wait for what is missing."""
    until = time.monotonic() + PATIENCE
    while True:
        with open(path, "rb") as file:
            superblock = file.read(SUPERBLOCK)
        end = int.from_bytes(superblock[END_OF_FILE], "little") if len(superblock) == SUPERBLOCK else SUPERBLOCK
        size = os.path.getsize(path)
        if size >= end:
            return
        if time.monotonic() >= until:
            raise InputError(f"{path}: cannot be read as a run file: it was cut short, to {size} bytes of {end} or more: copy it again")
        time.sleep(PATIENCE / 10)


def _state(file: Any, path: str | os.PathLike[str]) -> Any:
    if "state" not in file.attrs or "series" not in file:
        raise InputError(f"{os.fspath(path)}: this HDF5 file is not a run file: it has no state, or no series")
    return file.attrs["state"]


def _complete_part(file: Any) -> xarray.DataTree:
    """Complete part of a file: of every series as many values as there are times, which are written last."""
    complete = {name: len(file[name]) for name in ("time", "map_time") if name in file}
    names = {"/": [name for name in file if isinstance(file[name], h5py.Dataset)]}
    names |= {group: list(file[group]) for group in file if isinstance(file[group], h5py.Group)}
    groups = {}
    for group, members in names.items():
        variables = {name: _variable(file[group][name], complete) for name in members if (group, name) != ("series", "time")}
        groups[group] = xarray.Dataset(variables, attrs=_attributes(file[group]))
    return xarray.DataTree.from_dict(groups)


def _variable(dataset: Any, complete: dict[str, int]) -> tuple[list[str], Any, dict[str, Any]]:
    """Dimensions, values and attributes."""
    dims = [dataset.name.rsplit("/", 1)[-1]] if dataset.is_scale else [dimension[0].name.rsplit("/", 1)[-1] for dimension in dataset.dims]
    parts = tuple(slice(complete.get(name)) for name in dims)
    values = dataset[parts]
    # Statuses are an enumeration there, and plain integers here.
    return dims, values.astype(values.dtype.base.str) if values.dtype.metadata else values, _attributes(dataset)


def _attributes(item: Any) -> dict[str, Any]:
    return {name: value for name, value in item.attrs.items() if name not in INTERNAL}
