#!/usr/bin/env python3
"""Loads the series of a run into pandas and prints their means over parts of the run.

    python examples/to_pandas.py quick.h5 --parts 4                       # pip install h5py pandas
"""

import argparse

import h5py
import pandas

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("run", help="run file")
parser.add_argument("--parts", type=int, default=4, help="parts of equal duration")
arguments = parser.parse_args()

with h5py.File(arguments.run, swmr=True) as run:
    time = pandas.Index(run["time"][:], name="time")
    series = {name: series[: len(time)] for name, series in run["series"].items() if name != "time"}
    table = pandas.DataFrame(series, index=time)

edges = [table.index[-1] * part / arguments.parts for part in range(arguments.parts + 1)]
parts = table.groupby(pandas.cut(table.index, edges), observed=True)
columns = ["contact_area_mean", "mean_pressure", "filled_fraction"]
print(f"{len(table)} samples of {len(table.columns)} series")
print(parts[columns].mean().to_string(float_format="{:.6g}".format))
