#!/usr/bin/env python3
"""Loads the series of a run into pandas and prints their means over parts of the run.

python examples/to_pandas.py quick.h5 --parts 4
"""

import argparse

import pandas

import plateau

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("run", help="run file")
parser.add_argument("--parts", type=int, default=4, help="parts of equal duration")
arguments = parser.parse_args()

run = plateau.open_run(arguments.run)
table = run.plateau.series
edges = [table.index[-1] * part / arguments.parts for part in range(arguments.parts + 1)]
parts = table.groupby(pandas.cut(table.index, edges), observed=True)
columns = ["contact_area_mean", "mean_pressure", "filled_fraction"]
print(f"{len(table)} samples of {len(table.columns)} series")
means = parts[columns].mean().rename(columns={name: f"{name} [{run['series'][name].attrs['units']}]" for name in columns})
print(means.rename_axis(columns="time [s]").to_string(float_format="{:.6g}".format))
