"""Surfaces in the formats of instruments, converted to a file that the program reads: heights with coordinates and where they come from."""

import hashlib
import importlib.metadata
import io
import logging
import math
import os
import warnings
import zipfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import h5netcdf
import numpy as np

import plateau
from plateau.errors import InputError, MissingFileError, PlateauError, PlateauNote
from plateau.instrument_text import read_text
from plateau.output_folder import all_or_none, refuse_file

# What the program reads itself, by its first bytes.
NATIVE = (b"aISO-", b"bISO-", b"aBCR-", b"bBCR-", b"\x93NUMPY", b"\x89PNG")
# Formats that SurfaceTopography 1.27.1 does not read, or takes um for m in (.nms), by their first bytes and by their endings.
ONLY_SURFALIZE = ((0, b"DSCOMPRESSED"), (4, b"hdat_"), (0, b"SIMPLE  ="))
ONLY_SURFALIZE_ENDINGS = (".nms", ".cag", ".sflz")
# Points of a profile may be off an even spacing by this part of it.
OFF = 0.02


@dataclass
class Heights:
    """Heights of an instrument, peaks positive.

    Attributes
    ----------
    values : array
        Shape (columns, rows): x grows along the first axis, y along the second; m, NaN where no point was measured.
    pitch : tuple of float
        Distances of the points along x and y, m.
    by : str
        Program or library that read them, with its version.
    notes : list of str
        Notes that a user should know.
    """

    values: Any
    pitch: tuple[float, float]
    by: str
    notes: list[str] = field(default_factory=list)


def convert(path: str | os.PathLike[str], output: str | os.PathLike[str] | None = None, *, force: bool = False) -> str:
    """Converts a file of an instrument to HDF5 (netCDF-4), which ``plateau surface`` and scenes read.

    Parameters
    ----------
    path : path
        A file in any format that SurfaceTopography or surfalize reads, or a text export of Keyence or Zygo.
    output : path, optional
        File to write; unless given, `path` with the ending ``.h5``.
    force : bool
        Replace a file that is there.

    Returns
    -------
    str
        Path of the file. It has the heights, m, on coordinates x and y, m, and as attributes of the heights where they come from:
        name and SHA-256 of the file, and what read it. One that was converted from the same content stays as it is.

    Raises
    ------
    InputError
        If no library reads the file, or it states no unit or no distance of its points, or the output would replace a file.
    """
    source = Path(path)
    target = source.with_suffix(".h5") if output is None else Path(output)
    if target.suffix.lower() not in (".h5", ".nc"):
        raise InputError(f"{target} has the ending {target.suffix or 'of nothing'}, expected .h5")
    refuse_file(target, True, (source,))
    try:
        content = source.read_bytes()
    except FileNotFoundError as error:
        raise MissingFileError(f"{source}: there is no such file") from error
    except OSError as error:
        raise InputError(f"{source}: cannot be read: {error.strerror}") from error
    digest = hashlib.sha256(content).hexdigest()
    if not force and _is_of(target, digest):
        return str(target)
    refuse_file(target, force, (source,))
    found = _checked(source, read(source, content))
    for note in found.notes:
        warnings.warn(PlateauNote(f"{source}: {note}"), stacklevel=2)
    all_or_none(target.parent, {target.name: lambda place: _write(place, found, source.name, digest)}, force, (source,))
    return str(target)


def read(path: Path, content: bytes) -> Heights:
    """Heights of a file by whichever library reads it; `InputError` if none does, with what each says."""
    if content.startswith(NATIVE):
        raise InputError(f"{path} need not be converted: plateau surface and scenes read it as it is")
    text = read_text(path, content)
    if text is not None:
        values, pitch, notes = text
        return Heights(values, pitch, f"plateau {plateau.__version__}", notes)
    only = path.suffix.lower() in ONLY_SURFALIZE_ENDINGS or any(content[at:].startswith(mark) for at, mark in ONLY_SURFALIZE)
    said = []
    for name, by in (("SurfaceTopography", _by_surface_topography), ("surfalize", _by_surfalize)):
        if only and name != "surfalize":
            continue
        try:
            with warnings.catch_warnings(action="ignore"):
                return by(path, _unfolded(content))
        except (PlateauError, ImportError):
            raise
        # The libraries raise whatever a damaged file made of them.
        except Exception as error:
            said.append(f"{name}: {_first_line(error)}")
    raise InputError(
        f"{path}: no library reads it ({'; '.join(said)}); save it as SDF, or as text with unit and pitch, with the instrument's program"
    )


def _first_line(error: Exception) -> str:
    # SurfaceTopography tells what each of its readers said, line by line.
    lines = [line for line in str(error).splitlines() if line.strip()]
    return "knows no such format" if type(error).__name__ == "CannotDetectFileFormat" else (lines or [type(error).__name__])[0]


def _unfolded(content: bytes) -> bytes:
    """An X3P archive without the folder that some have around their entries, which neither library expects."""
    if not content.startswith(b"PK\x03\x04"):
        return content
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        roots = [name.removesuffix("main.xml") for name in archive.namelist() if name.endswith("/main.xml")]
        if len(roots) != 1 or "main.xml" in archive.namelist():
            return content
        made = io.BytesIO()
        with zipfile.ZipFile(made, "w") as plain:
            for name in archive.namelist():
                if name.startswith(roots[0]) and not name.endswith("/"):
                    plain.writestr(name.removeprefix(roots[0]), archive.read(name))
        return made.getvalue()


def _by_surface_topography(path: Path, content: bytes) -> Heights:
    import SurfaceTopography

    logging.getLogger("SurfaceTopography").setLevel(logging.ERROR)
    with SurfaceTopography.open_topography(io.BytesIO(content)) as reader:
        channels = reader.channels
        notes = []
        if len(channels) > 1:
            names = ", ".join(f'"{channel.name}"' for channel in channels)
            notes.append(f'has {len(channels)} channels of heights, {names}; "{reader.default_channel.name}" is taken')
        topography = reader.default_channel.topography()
    if topography.unit is None:
        raise InputError(f"{path}: states no unit of its heights; as a text with unit and pitch above the numbers the program reads it itself")
    topography = topography.to_unit("m")
    by = f"SurfaceTopography {importlib.metadata.version('SurfaceTopography')}"
    if not topography.is_uniform:
        positions, values = topography.positions_and_heights()
        values, step = _even(path, np.asarray(positions, float), np.asarray(values, float))
        return Heights(values[:, None], (step, step), by, notes)
    values = np.ma.filled(np.ma.asarray(topography.heights(), float), np.nan)
    pitch = topography.pixel_size
    # One line of a profile has one distance.
    if values.ndim == 1:
        return Heights(values[:, None], (float(pitch[0]),) * 2, by, notes)
    if isinstance(topography.info.get("raw_metadata"), dict) and topography.info["raw_metadata"].get("format_flavor") == "wyko":
        # Lines of the file are columns of the surface; SurfaceTopography takes them as rows.
        values, pitch = values.T, pitch[::-1]
    return Heights(values, (float(pitch[0]), float(pitch[1])), by, notes)


def _by_surfalize(path: Path, content: bytes) -> Heights:
    import surfalize

    surface = surfalize.Surface.load(io.BytesIO(content), format=path.suffix)
    # Rows are lines along x, the first at the smallest y; um.
    by = f"surfalize {importlib.metadata.version('surfalize')}"
    return Heights(np.asarray(surface.data, float).T * 1e-6, (float(surface.step_x) * 1e-6, float(surface.step_y) * 1e-6), by)


def _even(path: Path, positions: Any, values: Any) -> tuple[Any, float]:
    """Heights of a profile at an even distance, NaN where a point is not there, and this distance, m.

    Points are on a grid but for a part of its distance, or a tenth of them is not there, or their positions are rounded to a decimal place.
    """
    last = len(positions) - 1
    if last < 1 or (np.diff(positions) <= 0).any():
        raise InputError(f"{path}: the positions of the {last + 1} points of the profile do not grow from two points on")
    along = positions - positions[0]
    step, gaps = along[-1] / last, np.diff(along)
    off = along - step * np.arange(last + 1)
    if np.ptp(off) <= 2 * OFF * step:
        return values, float(step)
    steps = round(along[-1] / np.median(gaps))
    places = along * steps / along[-1]
    whole = np.rint(places).astype(int)
    if last + 1 >= 0.9 * (steps + 1) and np.ptp(places - whole) <= 2 * OFF and (np.diff(whole) > 0).all():
        holed = np.full(steps + 1, np.nan)
        holed[whole] = values
        return holed, float(along[-1] / steps)
    for digits in range(3):
        place = 10.0 ** (math.floor(math.log10(step)) - digits)
        in_places = positions / place
        if np.abs(in_places - np.rint(in_places)).max() <= 1e-6 and max(np.ptp(gaps), np.abs(off).max()) <= place * (1 + 1e-6):
            return values, float(step)
    raise InputError(f"{path}: the points of the profile are {gaps.min():g} to {gaps.max():g} m apart, expected an even distance: resample it")


def _checked(path: Path, found: Heights) -> Heights:
    """Refuses what is no surface."""
    values, pitch = found.values, found.pitch
    if values.ndim != 2 or values.size == 0 or not np.isfinite(values).any():
        raise InputError(f"{path}: no point of shape {values.shape} has a height")
    if not all(np.isfinite(one) and one > 0 for one in pitch):
        raise InputError(f"{path}: states no distance of its points")
    values = np.array(values, float)
    values[~np.isfinite(values)] = np.nan
    return Heights(values, pitch, found.by, found.notes)


def _is_of(path: Path, digest: str) -> bool:
    """Tells whether a file was converted from a content of this SHA-256."""
    try:
        with h5netcdf.File(path, "r") as file:
            return bool(file["height"].attrs["source_sha256"] == digest)
    except (OSError, KeyError):
        return False


def _write(path: Path, heights: Heights, name: str, digest: str) -> None:
    columns, rows = heights.values.shape
    with h5netcdf.File(path, "w") as file:
        file.dimensions = {"x": columns, "y": rows}
        for axis, count, pitch, about in (("x", columns, heights.pitch[0], "along sliding"), ("y", rows, heights.pitch[1], "outward")):
            coordinates = file.create_variable(axis, (axis,), float, data=pitch * np.arange(count))
            coordinates.attrs["units"], coordinates.attrs["long_name"] = "m", about
        dataset = file.create_variable("height", ("x", "y"), float, data=heights.values, compression="gzip", shuffle=True)
        dataset.attrs["units"] = "m"
        dataset.attrs["long_name"] = "measured height, peaks positive"
        dataset.attrs["pitch"] = np.array(heights.pitch)
        dataset.attrs["source_file"], dataset.attrs["source_sha256"], dataset.attrs["converted_by"] = name, digest, heights.by
