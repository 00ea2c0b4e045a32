#!/usr/bin/env python3
"""Compares runs: a table of their ends, and a figure of one series of all of them.

    python examples/compare_runs.py weak.h5 strong.h5 -o compare.png      # pip install h5py matplotlib
    python examples/compare_runs.py *.h5 --series filled_fraction
"""

import argparse
import pathlib

import h5py
import matplotlib

matplotlib.use("Agg")  # draws into files, without a window
import matplotlib.pyplot as plt

COLUMNS = ["contact_area_mean", "mean_pressure", "filled_fraction", "disc_secondary", "emitted"]

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("runs", nargs="+", help="run files")
parser.add_argument("--series", default="contact_area_mean", help="series that is drawn")
parser.add_argument("-o", "--output", default="compare.png", help="picture to write")
arguments = parser.parse_args()

figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
print("run".ljust(20), "time".rjust(12), *(name.rjust(18) for name in COLUMNS))
units = []
for path in arguments.runs:
    with h5py.File(path, swmr=True) as run:
        name = pathlib.Path(path).stem
        series, time = run["series"], run["time"][:]
        last = len(time) - 1
        print(name.ljust(20), f"{time[last]:12.6g}", *(f"{series[column][last]:18.6g}" for column in COLUMNS))
        drawn = series[arguments.series]
        axes.plot(time, drawn[: len(time)], label=name)
        units = [f"{series[column].attrs['units']}" for column in COLUMNS]
        axes.set(xlabel="time, s", ylabel=f"{arguments.series}, {drawn.attrs['units']}")
print("unit".ljust(20), "s".rjust(12), *(unit.rjust(18) for unit in units))
axes.legend()
figure.savefig(arguments.output, dpi=150)
