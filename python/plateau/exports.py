"""Run files in the formats of other programs; docs/figures.md has names, columns and shapes."""

import json
import os
from functools import partial
from io import BytesIO
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas
import xarray

from plateau.errors import InputError, MissingPackageError, not_installed
from plateau.opened_runs import Run, inputs_of, named_like, note, opened
from plateau.output_folder import Files, all_or_none, followed
from plateau.run_file import array, source
from plateau.units import quantity

# Formats, with endings of names; rows of a sheet of Excel below the heads; columns that have other names than in run files.
FORMATS = {"csv": (".csv", ".tsv", ".txt"), "xlsx": (".xlsx",), "npz": (".npz",), "netcdf": (".nc", ".nc4"), "vtk": ("-vtk",)}
MOST_ROWS, COLUMNS = 1_048_575, {"map_time": "time", "disc_angle": "angle", "pin_angle": "angle"}


def export(
    run: Run, to: Literal["csv", "xlsx", "npz", "netcdf", "vtk"], output: str | os.PathLike[str] | None = None, *,
    maps: bool = False, decimal: str = ".", separator: str | None = None, force: bool = False,
) -> list[str]:  # fmt: skip
    """Writes a run in the format of another program.

    Parameters
    ----------
    run : path or xarray.DataTree
    to : {"csv", "xlsx", "npz", "netcdf", "vtk"}
    output : path, optional
        The file, for vtk the folder; by default in the working directory, named like the run file.
    maps : bool
        Write the maps, too, as csv; xlsx has none, and the other formats have them anyway.
    decimal, separator : str, optional
        Decimal mark and separator of csv; ``"tab"`` is one, too. Unless given, a comma separates, with a decimal comma a semicolon.
    force : bool
        Replace files that exist.

    Returns
    -------
    list of str
        Paths of what was written: all files, or none of them.
    """
    [tree] = opened(run)
    sign = "\t" if separator in ("tab", "\\t") else separator or {",": ";"}.get(decimal, ",")
    if to not in FORMATS:
        raise InputError(f"{to!r} is no format: expected {', '.join(FORMATS)}")
    if (to != "csv" and (decimal, sign) != (".", ",")) or (to == "xlsx" and maps):
        raise InputError(f"{to} has no {'maps' if maps else 'decimal mark or separator to choose'}: leave that out, or take csv")
    if decimal not in (".", ",") or len(sign) != 1 or sign.isalnum() or sign in "\"'+-.\r\n" or sign == decimal:
        raise InputError(f"decimal mark {decimal!r} with separator {separator!r}: expected . or , and a sign of no number, such as ;")
    endings = FORMATS[to]
    path = followed(named_like(tree, endings[0]) if output is None else Path(output))
    if path.suffix.lower() not in ("", *endings) and to != "vtk":
        raise InputError(f"-o {path}: {to} is written to a file whose name ends in {' or '.join(endings)}, such as {path.stem}{endings[0]}")
    one = {"xlsx": _xlsx, "npz": _npz, "netcdf": _netcdf}.get(to)
    try:
        files = {path.name: partial(one, tree)} if one else _vtk(tree) if to == "vtk" else _csv(tree, path, maps, sep=sign, decimal=decimal)
        return all_or_none(path if to == "vtk" else path.parent, files, force, inputs_of([tree]))
    except ModuleNotFoundError as error:
        raise MissingPackageError(not_installed(error.name)) from error


def _of(run: xarray.DataTree, group: str) -> xarray.Dataset:
    """Variables of a group, statuses as plain integers; notes which body has no maps."""
    found = run[group].to_dataset()[[*run[group].data_vars]] if group in run.children else xarray.Dataset()
    if group in ("disc", "pin") and not found.sizes.get("map_time"):
        note(f"{source(run)} has no maps of the {group}: they are left out")
    return found.assign({name: values.astype(values.dtype.str) for name, values in found.items() if values.dtype.metadata})


def _maps(run: xarray.DataTree) -> dict[str, xarray.Dataset]:
    """The maps of each body and moment, by the names of files."""
    found = {body: _of(run, body) for body in ("disc", "pin")}
    return {f"{body}-{index:04}": maps.isel(map_time=[index]) for body, maps in found.items() for index in range(maps.sizes.get("map_time", 0))}


def _tables(run: xarray.DataTree) -> dict[str, xarray.Dataset]:
    """Data of the tables by name: series and, if there are any, events."""
    events = _of(run, "event")
    return {"series": _of(run, "series")} | ({"events": events.assign_coords(event=np.arange(1, events.sizes["event"] + 1))} if events else {})


def _table(data: xarray.Dataset) -> pandas.DataFrame:
    """A table of data behind their axes, with heads that no spreadsheet computes."""
    # Of a copy: what is read for a table does not stay in memory.
    table = data.copy().to_dataframe(max((one.dims for one in data.values()), key=len)).reset_index()
    heads = [name if name == "event" else f"{COLUMNS.get(name, name)} [{data[name].attrs.get('units', '1')}]" for name in table]
    return table.set_axis([head if head[0].isalnum() else f"'{head}" for head in heads], axis="columns")


def _csv(run: xarray.DataTree, path: Path, with_maps: bool, **marks: str) -> Files:
    def write(place: Path, data: xarray.Dataset) -> None:
        _table(data).to_csv(place, index=False, na_rep="NaN", lineterminator="\n", **marks)

    tables = _tables(run) | (_maps(run) if with_maps else {})
    return {path.name if name == "series" else f"{path.stem}-{name}{path.suffix}": partial(write, data=data) for name, data in tables.items()}


def _xlsx(run: xarray.DataTree, place: Path) -> None:
    about = [(name, line) for name in ("title", "state", "program", "scene") for line in str(run.attrs.get(name, "")).splitlines()]
    tables = {name: _table(data) for name, data in _tables(run).items()} | {"about": pandas.DataFrame(about, columns=["what", "text"])}
    if (most := max(map(len, tables.values()))) > MOST_ROWS:
        raise InputError(f"a table of {most} rows: a sheet of Excel has {MOST_ROWS} below its heads; take csv or npz")
    # Texts stay texts: nothing is a formula or a link. By way of memory, for an archive that cannot be closed complains once more.
    options = {"strings_to_formulas": False, "strings_to_urls": False, "in_memory": True}
    with pandas.ExcelWriter(book_bytes := BytesIO(), "xlsxwriter", engine_kwargs={"options": options}) as book:
        for name, table in tables.items():
            table.to_excel(book, sheet_name=name, index=False, freeze_panes=(1, 1))
    place.write_bytes(book_bytes.getbuffer())


def _npz(run: xarray.DataTree, place: Path) -> None:
    arrays: dict[str, Any] = {str(name): values for name, values in run.to_dataset().coords.items()}
    for group in ("series", "event", "disc", "pin"):
        for name, values in _of(run, group).items():
            arrays[str(name) if group == "series" or name in ("pressure", "temperature") else f"{group}_{name}"] = values
    arrays["units"] = json.dumps({name: values.attrs.get("units", "1") for name, values in arrays.items()}, sort_keys=True)
    # Into a file that is open, for to a name NumPy adds an ending.
    with place.open("wb") as file:
        np.savez_compressed(file, **(arrays | {name: str(run.attrs.get(name, "")) for name in ("title", "state", "scene")}))


def _netcdf(run: xarray.DataTree, place: Path) -> None:
    whole = run.assign({body: xarray.DataTree(_of(run, body)) for body in ("disc", "pin")})
    # By way of memory: a disk that is full while HDF5 writes ends the process.
    place.write_bytes(whole.to_netcdf(engine="h5netcdf"))


def _vtk(run: xarray.DataTree) -> Files:
    from pyevtk.hl import gridToVTK

    mesh, rows, moments = run.plateau.scene["mesh"], array(run, "radius").values, _maps(run)
    inner = quantity(mesh.get("inner_radius", "0 m"), "m") or quantity(mesh["mean_radius"], "m") - quantity(mesh["pin_width"], "m") / 2
    radius = np.linspace(inner, rows[0] + rows[-1] - inner, len(rows) + 1)[:, None, None]

    def grid(place: Path, maps: xarray.Dataset) -> None:
        cells = {str(name): values.values.T[..., None] for name, values in maps.copy().squeeze("map_time").items()}
        # The disc's ring closes.
        turns = np.arange(next(iter(cells.values())).shape[1] + 1)[None, :, None] / run.sizes["disc_angle"] % 1
        corners = [np.asfortranarray(radius * of) for of in (np.cos(2 * np.pi * turns), np.sin(2 * np.pi * turns), 0 * turns)]
        gridToVTK(str(place.with_suffix("")), *corners, cells)

    def collection(place: Path) -> None:
        own = {name: maps["map_time"].item() for name, maps in moments.items() if name.startswith(place.stem)}
        grids = "".join(f'<DataSet timestep="{time}" group="" part="0" file="{name}.vts"/>' for name, time in own.items())
        place.write_text(f'<VTKFile type="Collection" version="0.1"><Collection>{grids}</Collection></VTKFile>\n')

    files: dict[str, Any] = {f"{name}.vts": partial(grid, maps=maps) for name, maps in moments.items()}
    return files | {f"{name.split('-')[0]}.pvd": collection for name in moments}
