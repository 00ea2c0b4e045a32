#!/usr/bin/env python3
"""Draws a map of a run, by default the last heights of the disc, and prints what is in it.

python examples/disc_map.py quick.h5 -o disc_map.png
python examples/disc_map.py quick.h5 --map pin/pressure --time 60
"""

import argparse

import plateau

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("run", help="run file")
parser.add_argument("--map", default="disc/height", help="dataset, such as disc/height, disc/status, pin/pressure")
parser.add_argument("--time", type=float, help="the map nearest to this time, s; the last one unless given")
parser.add_argument("--polar", action="store_true", help="as a ring in the plane of the disc")
parser.add_argument("-o", "--output", default="map.png", help="picture to write")
arguments = parser.parse_args()

field = plateau.open_run(arguments.run)[arguments.map].plateau.at_time(arguments.time)
axes = field.plateau.plot(polar=arguments.polar)
axes.figure.savefig(arguments.output, dpi=150)
when = f"{arguments.map} at {float(field['map_time']):.6g} s"
names = field.plateau.status_names
if names:
    # The numbers of a status have no mean: what counts is how much of the area has which. Beyond a round pin there is no area.
    parts = [f"{name} {float(field.plateau.area_fraction(name)):.2%}" for name in names.values() if name != "absent"]
    print(f"{when}: {', '.join(parts)} of the area")
else:
    low, mean, high = (float(value) for value in (field.min(), field.plateau.area_mean(), field.max()))
    unit = "" if field.attrs["units"] == "1" else f" {field.attrs['units']}"
    print(f"{when}: from {low:.6g}{unit} to {high:.6g}{unit}, mean over the area {mean:.6g}{unit}")
