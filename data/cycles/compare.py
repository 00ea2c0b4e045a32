#!/usr/bin/env python3
"""Contact area and filling in a drive and in constant operation with the same load times distance over the same distance.

    PYTHONPATH=python python3 data/cycles/compare.py drive.h5 constant.h5 docs/images/cycles-drive.png

Both are held against the volume worn, which is proportional to it (docs/model.md, 4.2), whatever carries the load where. Means
of the contact area are weighted by what is worn meanwhile. Needs the package plateau (docs/python.md) and matplotlib.
"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import plateau
from plateau.style import LINES

plt.style.use("plateau.plateau")
SPANS = 40
COLOURS = {"drive": LINES[0], "constant": LINES[6]}


def read(path):
    """At the samples: volume worn (m3), contact area as the mean of the last revolution (m2), filled fraction."""
    series = plateau.open_run(path).plateau.series
    worn = series["worn_pin"] + series["worn_resin"] + series["worn_disc"]
    return worn.to_numpy(), series["contact_area_mean"].to_numpy(), series["filled_fraction"].to_numpy()


def means(worn, area, edges):
    weight = np.diff(worn, prepend=0.0)
    sums = [np.histogram(worn, edges, weights=values)[0] for values in (weight * area, weight)]
    return sums[0] / sums[1]


def main():
    drive, constant, picture = sys.argv[1:]
    runs = {"drive": read(drive), "constant": read(constant)}
    edges = np.linspace(0.0, min(run[0][-1] for run in runs.values()), SPANS + 1)
    figure, (upper, lower) = plt.subplots(2, 1, figsize=(5.6, 4.6), sharex=True, layout="constrained")
    found = {}
    for name, (worn, area, filled) in runs.items():
        found[name] = means(worn, area, edges)
        upper.plot(worn * 1e9, area * 1e6, ".", ms=1.5, alpha=0.35, color=COLOURS[name])
        upper.plot((edges[:-1] + edges[1:]) * 0.5e9, found[name] * 1e6, color=COLOURS[name], label=name)
        lower.plot(worn * 1e9, filled * 100, color=COLOURS[name], label=name)
    upper.set_ylabel("contact area, mm²")
    lower.set_ylabel("disc filled, %")
    lower.set_xlabel("volume worn, mm³")
    upper.legend()
    figure.savefig(picture)
    for name, (worn, _, filled) in runs.items():
        half = [found[name][part].mean() * 1e6 for part in (slice(SPANS // 2), slice(SPANS // 2, None))]
        print(
            f"{name}: worn {worn[-1] * 1e9:.4f} mm3, filled {filled[-1] * 100:.2f} %, contact area {half[0]:.3f} mm2 over the first half "
            f"of what is worn, {half[1]:.3f} mm2 over the second"
        )


if __name__ == "__main__":
    main()
