"""Checks of a finished run file against docs/run-file.md with h5py, netCDF4 and xarray.

Names, units and dimensions are written down here once more, from the text of the format and not from the program, so
that a change of the program shows.
"""

import datetime
import json
import re
import warnings

import h5py
import netCDF4
import numpy as np
import xarray

COORDINATES = {"radius": "m", "disc_angle": "rad", "pin_angle": "rad", "time": "s", "map_time": "s"}
SERIES = {
    "displacement": "m",
    "contact_area": "m2",
    "contact_area_mean": "m2",
    "contact_area_integral": "m2 s",
    "sliding_distance": "m",
    "contact_ratio": "1",
    "mean_pressure": "Pa",
    "max_pressure": "Pa",
    "worn_pin": "m3",
    "worn_resin": "m3",
    "worn_whole_pin": "m3",
    "lost_pin": "m3",
    "worn_disc": "m3",
    "pool": "m3",
    "emitted": "m3",
    "deposited_pin": "m3",
    "deposited_disc": "m3",
    "returned": "m3",
    "pin_primary": "1",
    "pin_secondary": "1",
    "pin_none": "1",
    "disc_secondary": "1",
    "filled_fraction": "1",
    "load_residual": "1",
    "balance_residual": "1",
}
ROUGHNESS = {f"{body}_{name}": unit for body in ("disc", "pin") for name, unit in {"sa": "m", "sq": "m", "ssk": "1", "sku": "1"}.items()}
ON_DISC = ("map_time", "disc_angle", "radius")
ON_PIN = ("map_time", "pin_angle", "radius")
# Name in a scene: (path, unit, dimensions); a status has no unit of its own.
MAPS = {
    "disc_height": ("disc/height", "m", ON_DISC),
    "disc_substrate": ("disc/substrate", "m", ON_DISC),
    "disc_status": ("disc/status", "1", ON_DISC),
    "pin_height": ("pin/height", "m", ON_PIN),
    "pin_substrate": ("pin/substrate", "m", ON_PIN),
    "pin_status": ("pin/status", "1", ON_PIN),
    "pressure": ("pin/pressure", "Pa", ON_PIN),
}
STATUSES = {"none": 0, "primary": 1, "secondary": 2}
ENUMERATIONS = {"disc/status", "pin/status", "pin/base"}
TIMES = {"time", "map_time"}
TEXTS = (
    "title program source_revision scene conventions Conventions references inputs seeds host decomposition instruction_set start_time end_time state"
).split()


def check(condition, message):
    """Fails with the message unless the condition holds."""
    if not condition:
        raise AssertionError(message)


def same(found, expected, what):
    """Fails unless two values are equal."""
    check(found == expected, f"{what}: found {found!r}, expected {expected!r}")


def expected_datasets(maps, roughness):
    """Path: (unit, dimensions) of every dataset of a file with these maps, with or without roughness."""
    datasets = {name: (unit, (name,)) for name, unit in COORDINATES.items() if maps or name != "map_time"}
    series = SERIES | (ROUGHNESS if roughness else {})
    datasets |= {f"series/{name}": (unit, ("time",)) for name, unit in series.items()}
    datasets |= {path: (unit, dimensions) for path, unit, dimensions in (MAPS[name] for name in maps)}
    datasets["pin/base"] = ("1", ("pin_angle", "radius"))
    return datasets


def check_h5py(file, datasets):
    """Shapes, types, filters, attributes and dimension scales, as plain h5py sees them."""
    found = {}
    file.visititems(lambda name, item: found.update({name: item}) if isinstance(item, h5py.Dataset) else None)
    same(sorted(found), sorted(datasets), "datasets")
    for path, (unit, dimensions) in datasets.items():
        dataset = found[path]
        same(dataset.attrs["units"], unit, f"units of {path}")
        check(len(dataset.attrs["long_name"]) > 3, f"{path} has no long_name")
        same(dataset.shape, tuple(file[name].shape[0] for name in dimensions), f"shape of {path}")
        same(dataset.maxshape, dataset.shape, f"largest shape of {path}")
        if path in ENUMERATIONS:
            same(h5py.check_enum_dtype(dataset.dtype), STATUSES, f"enumeration of {path}")
            same(dataset.dtype.itemsize, 1, f"bytes of a status of {path}")
            check(np.isin(dataset[...], list(STATUSES.values())).all(), f"{path} has values that are no status")
            same(list(dataset.attrs["flag_values"]), list(STATUSES.values()), f"flag_values of {path}")
            same(dataset.attrs["flag_values"].dtype.itemsize, 1, f"type of flag_values of {path}")
            same(dataset.attrs["flag_meanings"], " ".join(STATUSES), f"flag_meanings of {path}")
        else:
            same(dataset.dtype, np.dtype("<f8"), f"type of {path}")
            check(np.isfinite(dataset[...]).all(), f"{path} has values that are not finite")
        check(dataset.chunks is not None, f"{path} is not chunked")
        properties = dataset.id.get_create_plist()
        filters = [properties.get_filter(i)[0] for i in range(properties.get_nfilters())]
        same(filters, [h5py.h5z.FILTER_SHUFFLE, h5py.h5z.FILTER_DEFLATE], f"filters of {path}")
        if path in COORDINATES:
            check(h5py.h5ds.is_scale(dataset.id), f"{path} is no dimension scale")
            same(h5py.h5ds.get_scale_name(dataset.id).decode(), path, f"name of the scale {path}")
        else:
            for axis, name in enumerate(dimensions):
                same(dataset.dims[axis].keys(), [name], f"scales of axis {axis} of {path}")
                same(dataset.dims[axis][0].name, f"/{name}", f"scale of axis {axis} of {path}")
    for name in filter(file.__contains__, COORDINATES):
        users = [(file[reference].name, axis) for reference, axis in file[name].attrs.get("REFERENCE_LIST", ())]
        expected = [
            (f"/{path}", axis)
            for path, (_, dimensions) in datasets.items()
            for axis, dimension in enumerate(dimensions)
            if dimension == name and path != name
        ]
        same(sorted(users), sorted(expected), f"users of the scale {name}")


def check_time_of_series(path, file):
    """The series alone have their time: a link to that of the root, and so the coordinate of their dimension."""
    link = file.get("series/time", getlink=True)
    check(isinstance(link, h5py.SoftLink) and link.path == "/time", "series/time is no link to /time")
    for engine in ("h5netcdf", "netcdf4"):
        with xarray.open_dataset(path, group="series", engine=engine) as series:
            same(list(series.coords), ["time"], f"{engine}: coordinates of the series")
            check(np.array_equal(series.time, file["time"][...]), f"{engine}: times of the series")
            same(set(series.data_vars), set(file["series"]) - {"time"}, f"{engine}: series")
            last = series.contact_area.sel(time=float(file["time"][-1]))
            same(float(last), float(file["series/contact_area"][-1]), f"{engine}: selection by time")
    with netCDF4.Dataset(path) as netcdf:
        found = netcdf["series"].variables["time"]
        same((found.dimensions, found.units), (("time",), "s"), "netCDF4: time of the series")


def check_coordinates(file):
    """Cell centres are equally spaced; the ring closes; times grow."""
    angle = file["disc_angle"][...]
    step = 2 * np.pi / angle.size
    for name in ("disc_angle", "pin_angle"):
        values = file[name][...]
        check(np.allclose(values, (np.arange(values.size) + 0.5) * step, rtol=1e-14, atol=0), f"{name} off the centres")
    radius = file["radius"][...]
    check((radius > 0).all() and np.allclose(np.diff(radius, 2), 0, atol=1e-12 * radius[-1]), "radius not equally spaced")
    for name in filter(file.__contains__, TIMES):
        check((np.diff(file[name][...]) > 0).all(), f"{name} does not grow")


def check_roughness(file):
    """The series end with the area-weighted moments of the last maps, peaks positive on both bodies."""
    weights = file["radius"][...] / file["radius"][...].sum()
    for body, sign in (("disc", 1.0), ("pin", -1.0)):
        heights = sign * file[f"{body}/height"][-1]

        def mean(values):
            return (values * weights).sum() / len(heights)

        z = heights - mean(heights)
        sq = np.sqrt(mean(z**2))
        expected = {"sa": mean(abs(z)), "sq": sq, "ssk": mean(z**3) / sq**3, "sku": mean(z**4) / sq**4}
        for name, value in expected.items():
            found = file[f"series/{body}_{name}"][-1]
            check(np.isclose(found, value, rtol=1e-11), f"{body}_{name}: found {found!r}, expected {value!r}")


def check_attributes(attributes):
    """Root attributes, their types and the texts with a form of their own."""
    for name in TEXTS:
        check(isinstance(attributes.get(name), str), f"attribute {name} is {attributes.get(name)!r}, expected a text")
    same(int(attributes["format_version"]), 1, "format_version")
    check(np.issubdtype(np.asarray(attributes["format_version"]).dtype, np.integer), "format_version is no integer")
    same(attributes["conventions"], "CF-1.11", "conventions")
    same(attributes["Conventions"], "CF-1.11", "Conventions")
    check(re.fullmatch(r"plateau \d+\.\d+\.\d+.*", attributes["program"]), f"program {attributes['program']!r}")
    check("Tribology in Industry 41" in attributes["references"], "references do not name the paper")
    check(attributes["state"] in ("finished", "interrupted", "failed"), f"state {attributes['state']!r}")
    same("error" in attributes, attributes["state"] == "failed", "attribute error in a failed run only")
    check(int(attributes["workers"]) >= 1, "workers")
    start, end = (datetime.datetime.fromisoformat(attributes[name]) for name in ("start_time", "end_time"))
    same(start.utcoffset(), datetime.timedelta(0), "offset of start_time from UTC")
    wall = float(attributes["wall_time"])
    check(abs((end - start).total_seconds() - wall) < 1, f"wall_time {wall} s, but {end - start} from start to end")
    for file in json.loads(attributes["inputs"]):
        check(re.fullmatch("[0-9a-f]{64}", file["sha256"]) and file["path"], f"input {file}")
    check(all(isinstance(seed, int) for seed in json.loads(attributes["seeds"]).values()), "seeds")
    check("normal_force" in attributes["scene"] or "version" in attributes["scene"], "scene is no scene")


def check_netcdf4(path, datasets, reference):
    """Dimensions belong to the root and are found from the groups; statuses are of one named enumeration."""
    with netCDF4.Dataset(path) as file:
        same(set(file.dimensions), {path for path in datasets if path in COORDINATES}, "netCDF4 dimensions")
        for name, dimension in file.dimensions.items():
            same(dimension.isunlimited(), False, f"netCDF4: {name} unlimited")
        same({name: dict(kind.enum_dict) for name, kind in file.enumtypes.items()}, {"cell_status": STATUSES}, "enumtypes")
        for name, (unit, dimensions) in datasets.items():
            variable = file[name]
            same(variable.dimensions, dimensions, f"netCDF4: dimensions of {name}")
            same(variable.units, unit, f"netCDF4: units of {name}")
            if name in ENUMERATIONS:
                same(variable.datatype.enum_dict, STATUSES, f"netCDF4: type of {name}")
            check(np.array_equal(variable[...], reference[name][...]), f"netCDF4: values of {name}")
        same(file.getncattr("title"), reference.attrs["title"], "netCDF4: title")
        same(file.getncattr("scene"), reference.attrs["scene"], "netCDF4: scene")


def check_xarray(path, datasets, reference):
    """A tree whose groups inherit the coordinates of the root."""
    with xarray.open_datatree(path, engine="h5netcdf") as tree:
        for name, (unit, dimensions) in datasets.items():
            group, _, variable = name.rpartition("/")
            array = tree[group][variable] if group else tree[variable]
            same(array.dims, dimensions, f"xarray: dimensions of {name}")
            same(array.attrs.get("units"), unit, f"xarray: units of {name}")
            check(np.array_equal(array.values, reference[name][...]), f"xarray: values of {name}")
            for dimension in dimensions:
                same(array.coords[dimension].attrs["units"], COORDINATES[dimension], f"xarray: {dimension} of {name}")
        middle = float(reference["time"][reference["time"].size // 2])
        selected = tree["series"]["contact_area"].sel(time=middle, method="nearest")
        same(float(selected.time), middle, "xarray: selection by time")
        same(tree.attrs["title"], reference.attrs["title"], "xarray: title")


def check_file(path, maps=tuple(MAPS), roughness=False):
    """Checks the run file of a scene that asks for these maps, and for roughness or not."""
    datasets = expected_datasets(maps, roughness)
    with warnings.catch_warnings(action="error"), h5py.File(path, "r") as file:
        check(file["time"].size > 0, "no samples")
        check_attributes(dict(file.attrs))
        check_h5py(file, datasets)
        check_coordinates(file)
        check_time_of_series(path, file)
        if roughness:
            check_roughness(file)
        check_netcdf4(path, datasets, file)
        check_xarray(path, datasets, file)
