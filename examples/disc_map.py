#!/usr/bin/env python3
"""Draws a map of a run, by default the last heights of the disc, and prints what is in it.

    python examples/disc_map.py quick.h5 -o disc_map.png                  # pip install "xarray>=2024.10" h5netcdf matplotlib
    python examples/disc_map.py quick.h5 --map pin/pressure --time 60
"""

import argparse

import matplotlib

matplotlib.use("Agg")  # draws into files, without a window
import matplotlib.pyplot as plt
import xarray

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("run", help="run file of a run that has ended")
parser.add_argument("--map", default="disc/height", help="dataset, such as disc/height, disc/status, pin/pressure")
parser.add_argument("--time", type=float, help="the map nearest to this time, s; the last one unless given")
parser.add_argument("-o", "--output", default="map.png", help="picture to write")
arguments = parser.parse_args()

with xarray.open_datatree(arguments.run, engine="h5netcdf") as run:
    maps = run[arguments.map]
    field = maps.isel(map_time=-1) if arguments.time is None else maps.sel(map_time=arguments.time, method="nearest")
    field = field.load()

angle, radius = field.dims
# The ring unrolled: arc length at the mean radius.
field = field.assign_coords({angle: field[angle] * float(field["radius"].mean()) * 1e3, radius: field[radius] * 1e3})
figure, axes = plt.subplots(figsize=(9, 3), layout="constrained")
picture = axes.pcolormesh(field[angle], field[radius], field.values.T, shading="nearest")
bar = figure.colorbar(picture, label=f"{arguments.map}, {field.attrs['units']}")
if names := field.attrs.get("flag_meanings", "").split():
    picture.set_clim(field.attrs["flag_values"][0], field.attrs["flag_values"][-1])
    bar.set_ticks(field.attrs["flag_values"], labels=names)
time = float(field["map_time"])
axes.set(title=f"{time:.6g} s", xlabel="arc length, mm", ylabel="radius, mm")
figure.savefig(arguments.output, dpi=150)
low, middle, high = (float(value) for value in (field.min(), field.mean(), field.max()))
print(f"{arguments.map} at {time:.6g} s: from {low:.6g} to {high:.6g} {field.attrs['units']}, mean of all cells {middle:.6g}")
