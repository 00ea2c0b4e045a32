#!/usr/bin/env python3
"""Compares runs: a table, and a figure of one series of all of them.

The table has means over the last tenth of each run, that of the contact area with its standard error, and values at the end. The contact
area pulses, so that the lines of several runs would cover each other. The figure has weighted means over a tenth of the shortest run
instead; the weights fall linearly to nothing on both sides.

    python examples/compare_runs.py weak.h5 strong.h5 -o compare.png
    python examples/compare_runs.py *.h5 --series filled_fraction
"""

import argparse
import pathlib

import matplotlib.pyplot as plt
import pandas

import plateau

AT_END = ["filled_fraction", "disc_secondary", "emitted"]

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("runs", nargs="+", help="run files")
parser.add_argument("--series", default="contact_area_mean", help="series that is drawn")
parser.add_argument("-o", "--output", default="compare.png", help="picture to write")
arguments = parser.parse_args()

runs = {pathlib.Path(path).stem: plateau.open_run(path) for path in arguments.runs}
rows = {}
for name, run in runs.items():
    area, end = run.plateau.mean("contact_area"), run.plateau.series.iloc[-1]
    means = {"time [s]": end.name, "contact_area [m2]": area.value, "standard_error [m2]": area.error}
    means["mean_pressure [Pa]"] = run.plateau.mean("mean_pressure").value
    rows[name] = means | {f"{series} [{run[f'series/{series}'].attrs['units']}]": end[series] for series in AT_END}
print(pandas.DataFrame.from_dict(rows, orient="index").to_string(float_format="{:.6g}".format))

figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
span = min(row["time [s]"] for row in rows.values()) / 20
for name, run in runs.items():
    run.plateau.plot(arguments.series, ax=axes)
    line, samples = axes.lines[-1], max(round(len(run["time"]) * span / rows[name]["time [s]"]), 1)
    # A running mean of a running mean has such weights.
    drawn = pandas.Series(line.get_ydata()).rolling(samples, center=True).mean().rolling(samples, center=True).mean()
    line.set(ydata=drawn, label=name)
axes.relim()
axes.autoscale()
axes.set_title(f"weighted mean over {2 * span:.3g} s")
axes.legend()
figure.savefig(arguments.output, dpi=150)
