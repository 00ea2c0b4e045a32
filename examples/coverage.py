#!/usr/bin/env python3
"""Prints how much of the disc and the pin is plateau at every recorded map, weighted with the area of the cells.

    python examples/coverage.py quick.h5                                  # pip install h5py numpy
"""

import argparse

import h5py
import numpy as np

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("run", help="run file")
arguments = parser.parse_args()


def fraction(status, value, area):
    """Area of the cells with this status over that of all cells; the area of a cell goes with its radius."""
    return ((status == value) * area).sum() / (area.sum() * len(status))


with h5py.File(arguments.run, swmr=True) as run:
    area = run["radius"][:]
    statuses = h5py.check_enum_dtype(run["pin/base"].dtype)
    times = run["map_time"][:] if "map_time" in run else []
    print("time/s".rjust(12), "disc secondary".rjust(16), "pin primary".rjust(16), "pin secondary".rjust(16))
    for index, time in enumerate(times):
        cells = []
        for dataset, name in [("disc/status", "secondary"), ("pin/status", "primary"), ("pin/status", "secondary")]:
            found = fraction(run[dataset][index], statuses[name], area) if dataset in run else np.nan
            cells.append(f"{found:16.6f}")
        print(f"{time:12.6g}", *cells)
