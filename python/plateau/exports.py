"""Run files in the formats of other programs; docs/export.md has names, columns and shapes."""

import importlib.util
import json
import math
import os
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas
import xarray

from plateau.errors import InputError, MissingPackageError
from plateau.opened_runs import Run, inputs_of, named_like, note, opened
from plateau.output_folder import all_or_none
from plateau.run_file import array, source
from plateau.units import quantity

# Formats, with the ends of names, and the package that writes each.
FORMATS = {"csv": (".csv", "pandas"), "xlsx": (".xlsx", "xlsxwriter"), "npz": (".npz", "numpy")}
FORMATS |= {"netcdf": (".nc", "h5netcdf"), "vtk": ("-vtk", "pyevtk")}
# Rows of a sheet of Excel below the heads.
MOST_ROWS = 1_048_575
# Names of maps as arrays, where they are not those of body and map.
NAMES = {"pin/pressure": "pressure", "pin/temperature": "temperature"}
# Files by their names, each with what writes it to a path.
Files = dict[str, Callable[[Path], object]]


def export(
    run: Run,
    to: Literal["csv", "xlsx", "npz", "netcdf", "vtk"],
    output: str | os.PathLike[str] | None = None,
    *,
    maps: bool = False,
    decimal: str = ".",
    separator: str | None = None,
    force: bool = False,
) -> list[str]:
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
    if to != "csv" and (decimal, sign) != (".", ",") or to == "xlsx" and maps:
        raise InputError(f"{to} has no {'maps' if maps else 'decimal mark or separator to choose'}: leave that out, or take csv")
    if decimal not in (".", ",") or len(sign) != 1 or sign.isalnum() or sign in "\"'+-.\r\n" or sign == decimal:
        raise InputError(f"decimal mark {decimal!r} with separator {separator!r}: expected . or , and a sign of no number, such as ;")
    if importlib.util.find_spec(FORMATS[to][1]) is None:
        raise MissingPackageError(f"{to} is written with {FORMATS[to][1]}: pip install 'plateau-brake[all]'")
    path = named_like(tree, FORMATS[to][0]) if output is None else Path(output)
    job = _Job(tree, path, maps, {"sep": sign, "decimal": decimal})
    files: Files = getattr(job, to)()
    folder = path if to == "vtk" else path.parent
    with all_or_none(folder, files, force, inputs_of([tree])) as places:
        for write, place in zip(files.values(), places, strict=True):
            write(place)
    return [str(folder / name) for name in files]


@dataclass
class _Job:
    """What is written of a run: each method gives the files of a format."""

    run: xarray.DataTree
    path: Path
    with_maps: bool
    marks: dict[str, str]

    def array(self, path: str, index: int | None = None) -> xarray.DataArray:
        """A variable, of maps at a moment; without maps there are no times of them."""
        is_missing = path == "map_time" and path not in self.run.variables
        values = xarray.DataArray(np.empty(0), dims=path, attrs={"units": "s"}) if is_missing else array(self.run, path)
        return values if index is None or "map_time" not in values.dims else values[index]

    def paths(self, group: str) -> list[str]:
        return [f"{group}/{name}" for name in (self.run[group].data_vars if group in self.run.children else ())]

    def units(self, paths: dict[str, str]) -> dict[str, str]:
        return {name: str(self.array(path).attrs.get("units", "1")) for name, path in paths.items()}

    def bodies(self) -> dict[str, list[str]]:
        """The bodies that have maps, and paths of these, with the base of the pin behind them; says which have none."""
        found = {body: sorted(self.paths(body), key=lambda path: "map_time" not in self.array(path).dims) for body in ("disc", "pin")}
        there = {body: paths for body, paths in found.items() if paths and self.array(paths[0]).sizes.get("map_time")}
        for body in found.keys() - there:
            note(f"{source(self.run)} has no maps of the {body}: they are left out")
        return there

    def table(self, first: dict[str, Any], paths: list[str], index: int | None = None) -> pandas.DataFrame:
        """A table with heads that no spreadsheet computes."""
        heads = [f"{name} [{unit}]" for name, unit in self.units({path.split("/")[1]: path for path in paths}).items()]
        columns = [self.array(path, index).values.ravel() for path in paths]
        return pandas.DataFrame(first | {head if head[0].isalnum() else f"'{head}": own for head, own in zip(heads, columns, strict=True)})

    def tables(self) -> dict[str, pandas.DataFrame]:
        """Series, and events if there are any."""
        series, events = self.table({"time [s]": self.array("time")}, self.paths("series")), self.table({}, self.paths("event"))
        events.insert(0, "event", np.arange(1, len(events) + 1))
        return {"series": series, "events": events} if len(events) else {"series": series}

    def cells(self, body: str, maps: list[str], index: int) -> pandas.DataFrame:
        """A row for each cell of a body."""
        axes = self.array("map_time").values[index], self.array(f"{body}_angle").values, self.array("radius").values
        places = map(np.ravel, np.meshgrid(*axes, indexing="ij"))
        return self.table(dict(zip(["time [s]", "angle [rad]", "radius [m]"], places, strict=True)), maps, index)

    def csv(self) -> Files:
        def write(table: Callable[[], pandas.DataFrame], place: Path) -> None:
            table().to_csv(place, index=False, na_rep="NaN", lineterminator="\n", **self.marks)

        tables = self.tables()
        files: Files = {self.path.name: partial(write, lambda: tables["series"])}
        files |= {f"{self.path.stem}-events.csv": partial(write, lambda: tables["events"])} if "events" in tables else {}
        for body, maps in self.bodies().items() if self.with_maps else ():
            for index in range(self.run.sizes["map_time"]):
                files[f"{self.path.stem}-{body}-{index:04}.csv"] = partial(write, partial(self.cells, body, maps, index))
        return files

    def xlsx(self) -> Files:
        attributes, tables = self.run.attrs, self.tables()
        about = [(name, line) for name in ("title", "state", "program", "scene") for line in str(attributes.get(name, "")).splitlines()]
        tables["about"] = pandas.DataFrame(about, columns=["what", "text"])
        if (most := max(map(len, tables.values()))) > MOST_ROWS:
            raise InputError(f"a table of {most} rows: a sheet of Excel has {MOST_ROWS} below its heads; take csv or npz")

        def write(place: Path) -> None:
            # Texts stay texts: nothing is a formula or a link.
            options = dict.fromkeys(("strings_to_formulas", "strings_to_urls", "strings_to_numbers"), False)
            with pandas.ExcelWriter(place, engine="xlsxwriter", engine_kwargs={"options": options}) as book:
                for name, table in tables.items():
                    table.to_excel(book, sheet_name=name, index=False, freeze_panes=(1, 1))

        return {self.path.name: write}

    def npz(self) -> Files:
        """Arrays one after the other, of maps a moment at a time: `numpy.savez` needs all of them in memory."""
        paths = {name: name for name in ("time", "radius", "disc_angle", "pin_angle", "map_time")}
        paths |= {path.split("/")[1]: path for path in self.paths("series")}
        paths |= {NAMES.get(path, path.replace("/", "_")): path for group in ("event", "disc", "pin") for path in self.paths(group)}
        texts = {name: str(self.run.attrs.get(name, "")) for name in ("title", "state", "scene")}
        texts["units"] = json.dumps(self.units(paths), sort_keys=True)

        def write(place: Path) -> None:
            with zipfile.ZipFile(place, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
                for name in (*paths, *texts):
                    values = self.array(paths[name]) if name in paths else xarray.DataArray(texts[name])
                    head = {"descr": np.dtype(values.dtype.str).str, "fortran_order": False, "shape": values.shape}
                    with archive.open(f"{name}.npy", "w", force_zip64=True) as file:
                        np.lib.format.write_array_header_1_0(file, head)
                        for part in values if values.ndim > 1 else [values]:
                            file.write(part.values.tobytes())

        return {self.path.name: write}

    def netcdf(self) -> Files:
        """A map after the other, statuses as plain integers."""
        encoding = {
            node.path: {name: {"dtype": one.dtype.str, "zlib": one.size > 0, "complevel": 1} for name, one in node.data_vars.items()}
            for node in self.run.subtree
        }
        return {self.path.name: lambda place: self.run.to_netcdf(place, engine="h5netcdf", encoding=encoding)}

    def vtk(self) -> Files:
        from pyevtk.hl import gridToVTK
        from pyevtk.vtk import VtkGroup

        mesh, times, rows = self.run.plateau.scene["mesh"], self.array("map_time").values, self.array("radius").values
        inner = quantity(mesh.get("inner_radius", "0 m"), "m") or quantity(mesh["mean_radius"], "m") - quantity(mesh["pin_width"], "m") / 2
        radius = np.linspace(inner, rows[0] + rows[-1] - inner, len(rows) + 1)[:, None, None]

        def grid(body: str, maps: list[str], index: int, place: Path) -> None:
            angle = np.arange(self.run.sizes[f"{body}_angle"] + 1)[None, :, None] * math.tau / self.run.sizes["disc_angle"]
            # The ring closes.
            angle[:, -1] *= body == "pin"
            corners = [np.asfortranarray(radius * of) for of in (np.cos(angle), np.sin(angle), 0 * angle)]
            cells = {path.split("/")[1]: self.array(path, index).values.T[..., None] for path in maps}
            gridToVTK(str(place.with_suffix("")), *corners, cells)

        def collection(names: list[str], place: Path) -> None:
            group = VtkGroup(str(place.with_suffix("")))
            for name, time in zip(names, times.tolist(), strict=True):
                group.addFile(str(place.with_name(name)), time)
            group.save()

        files: Files = {}
        for body, maps in self.bodies().items():
            names = [f"{body}-{index:04}.vts" for index in range(len(times))]
            files |= {name: partial(grid, body, maps, index) for index, name in enumerate(names)}
            files[f"{body}.pvd"] = partial(collection, names)
        if not files:
            note("nothing is written: this format has maps only")
        return files
