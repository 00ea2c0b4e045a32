#!/usr/bin/env python3
"""Compares runs: a table of their ends, and a figure of one series of all of them.

    python examples/compare_runs.py weak.h5 strong.h5 -o compare.png
    python examples/compare_runs.py *.h5 --series filled_fraction
"""

import argparse
import pathlib

import pandas

import plateau
from plateau.plots import new_axes

COLUMNS = ["contact_area_mean", "mean_pressure", "filled_fraction", "disc_secondary", "emitted"]

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("runs", nargs="+", help="run files")
parser.add_argument("--series", default="contact_area_mean", help="series that is drawn")
parser.add_argument("-o", "--output", default="compare.png", help="picture to write")
arguments = parser.parse_args()

axes, rows, units = new_axes(figsize=(7, 4)), {}, {}
for path in arguments.runs:
    run = plateau.open_run(path)
    run.plateau.plot(arguments.series, ax=axes)
    axes.lines[-1].set_label(pathlib.Path(path).stem)
    rows[pathlib.Path(path).stem] = run.plateau.series[COLUMNS].reset_index().iloc[-1]
    units = {"time": "s"} | {name: run[f"series/{name}"].attrs["units"] for name in COLUMNS}
table = pandas.DataFrame(rows).transpose()
print(table.rename(columns=lambda name: f"{name} ({units[name]})").to_string(float_format="{:.6g}".format))
axes.set_title("")
axes.legend()
axes.figure.savefig(arguments.output, dpi=150)
