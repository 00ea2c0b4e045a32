#!/usr/bin/env python3
"""Draws the contact area of a run against time: single steps, and their mean over a revolution of the disc.

    python examples/contact_area.py quick.h5 -o contact_area.png          # pip install h5py matplotlib
"""

import argparse

import h5py
import matplotlib

matplotlib.use("Agg")  # draws into files, without a window
import matplotlib.pyplot as plt

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("run", help="run file")
parser.add_argument("-o", "--output", default="contact_area.png", help="picture to write")
arguments = parser.parse_args()

# swmr=True opens runs that go on, too; "time" tells how many samples are complete.
with h5py.File(arguments.run, swmr=True) as run:
    time = run["time"][:]
    single = run["series/contact_area"][: len(time)] * 1e6
    mean = run["series/contact_area_mean"][: len(time)] * 1e6
    title = run.attrs["title"]

figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
axes.plot(time, single, ".", color="0.7", markersize=2, label="single steps")
axes.plot(time, mean, color="tab:blue", label="mean of a revolution")
axes.set(title=title, xlabel="time, s", ylabel="contact area, mm²", ylim=(0, None))
axes.legend(markerscale=4)
figure.savefig(arguments.output, dpi=150)
print(f"contact area at {time[-1]:.6g} s: {single[-1]:.6g} mm2, mean of the last revolution {mean[-1]:.6g} mm2")
