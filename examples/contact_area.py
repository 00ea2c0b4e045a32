#!/usr/bin/env python3
"""Draws the contact area of a run against time: single steps, and their mean over a revolution of the disc.

python examples/contact_area.py quick.h5 -o contact_area.png
"""

import argparse

import plateau

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("run", help="run file, also of a run that goes on or was killed")
parser.add_argument("-o", "--output", default="contact_area.png", help="picture to write")
arguments = parser.parse_args()

run = plateau.open_run(arguments.run)
axes = run.plateau.plot()
axes.figure.savefig(arguments.output, dpi=150)

last = run["series"].isel(time=-1)
single, mean = (float(last[name]) * 1e6 for name in ("contact_area", "contact_area_mean"))
print(f"contact area at {float(last['time']):.6g} s: {single:.6g} mm2, mean of the last revolution {mean:.6g} mm2")
area = run.plateau.mean("contact_area")
print(f"mean from {area.start:.6g} to {area.end:.6g} s: {area.value * 1e6:.6g} mm2, standard error {area.error * 1e6:.6g} mm2")
