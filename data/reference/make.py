#!/usr/bin/env python3
"""Makes a reference for `plateau accuracy` of a run file: the series that are compared, without maps.

    PYTHONPATH=python python data/reference/make.py RUN.h5 REFERENCE.h5 [--until SECONDS]

With --until the run is cut there, as if operation.duration had been that; it must have come so far, but need not be finished.
A sample must lie there, at most a step later. Needs the package plateau (docs/python.md).
"""

import argparse
import re

import h5py
import numpy as np
import xarray

import plateau

SERIES = [
    "balance_residual",
    "contact_area",
    "contact_area_integral",
    "contact_area_mean",
    "contact_ratio",
    "disc_secondary",
    "emitted",
    "filled_fraction",
    "load_residual",
    "pin_secondary",
    "worn_disc",
    "worn_pin",
    "worn_resin",
]
# The digests are of the whole file; a cut run has not ended when the run did.
LEFT_OUT = {"attributes_sha256", "numbers_sha256", "execution_sha256", "end_time"}
# A step with m = 1 is far shorter, samples are never as close, s.
CLOSE = 1e-3


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("run")
    arguments.add_argument("reference")
    arguments.add_argument("--until", type=float, metavar="SECONDS")
    arguments = arguments.parse_args()
    with plateau.open_run(arguments.run) as run:
        kept = compared(run, arguments.until)
    # The axes are copied as they are stored, which is for h5py.
    with h5py.File(arguments.run, swmr=True) as source, h5py.File(arguments.reference, "w") as reference:
        make(kept, source, reference)


def compared(run: xarray.DataTree, until: float | None) -> xarray.Dataset:
    """What is compared, up to `until` (s) or to the end: series, and the attributes of the run."""
    time, attributes = run["time"].values, {name: value for name, value in run.attrs.items() if name not in LEFT_OUT}
    count = len(time)
    if until is not None:
        count = int(np.searchsorted(time, until - 1e-9)) + 1
        if count > len(time) or time[count - 1] > until + CLOSE:
            raise SystemExit(f"no sample at {until} s: the run has samples up to {time[-1]} s")
        duration = f'duration = "{until:g} s"'
        attributes["scene"], found = re.subn(r"(?m)^duration = .*$", duration, attributes["scene"])
        if found != 1:
            raise SystemExit(f"the scene of the run has {found} durations, expected one")
        attributes["state"] = "finished"
        attributes["title"] = f"{attributes['title']}, up to {until:g} s"
        if "wall_time" in attributes:
            attributes["wall_time"] *= time[count - 1] / time[-1]
    elif attributes["state"] != "finished":
        raise SystemExit(f"the run is {attributes['state']}, expected one that is finished; or give --until")
    series = run["series"].to_dataset()[SERIES].isel(time=slice(count))
    return series.load().assign_attrs(attributes)


def make(kept: xarray.Dataset, source: h5py.File, reference: h5py.File) -> None:
    """Writes what is compared, with the axes of the maps."""
    for name, value in kept.attrs.items():
        reference.attrs[name] = value
    for name in ["radius", "disc_angle", "pin_angle"]:
        source.copy(name, reference)
        strip(reference[name])
    write(reference, "time", kept["time"])
    reference["time"].make_scale("time")
    for name in SERIES:
        series = write(reference, f"series/{name}", kept[name])
        series.dims[0].attach_scale(reference["time"])


def write(reference: h5py.File, name: str, values: xarray.DataArray) -> h5py.Dataset:
    """A compressed dataset with unit and name."""
    dataset = reference.create_dataset(name, data=values.values, compression="gzip", shuffle=True)
    for attribute in ["units", "long_name"]:
        dataset.attrs[attribute] = values.attrs[attribute]
    return dataset


def strip(dataset: h5py.Dataset) -> None:
    """Takes away references into the other file."""
    for name in ["REFERENCE_LIST", "DIMENSION_LIST"]:
        if name in dataset.attrs:
            del dataset.attrs[name]


if __name__ == "__main__":
    main()
