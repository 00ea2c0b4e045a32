"""Filling and contact of the rough disc against the cell, with both rules: docs/images/mesh.png, from mesh.json.

usage: PYTHONPATH=python figure.py, in the environment .venv of the checkout
"""

import json
import math
from pathlib import Path

import matplotlib

from plateau.style import LINES, MM, WIDE

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = Path(__file__).parent
#: The plain rule is dashed.
RULES = {
    "none": ("debris moves by one cell", LINES[5], "--", "o"),
    "200": ("transport length 200 µm", LINES[0], "-", "s"),
    "150": ("150 µm", LINES[6], "-", "^"),
    "100": ("100 µm", LINES[2], "-", "v"),
}
QUANTITIES = {"filled": "disc filled after 3000 s, %", "contact_ratio": "part of the pin in contact, %"}


def course(values: dict, changes: dict, key: str) -> list[tuple[float, float, float]]:
    """Cell, mean and standard error of a quantity on every mesh.

    A mesh with fewer sets of surfaces than the coarser one has that one's mean, with the change of the sets that both have: for their own
    mean would show which sets they are.
    """
    found: list[tuple[float, float, float]] = []
    before, many = "", 0
    for cell, numbers in values.items():
        mean, error, sets = numbers[key]
        if sets < many:
            change, spread, _ = changes[f"{before} to {cell}"][key]
            _, coarser, doubt = found[-1]
            mean, error = coarser * (1 + change), math.hypot(doubt * (1 + change), coarser * spread)
        found.append((float(cell), mean, error))
        before, many = cell, sets
    return found


def main() -> None:
    """Draw both quantities of the rough disc, with standard errors."""
    plt.style.use("plateau.plateau")
    results = json.loads((HERE / "mesh.json").read_text())
    figure, axes = plt.subplots(1, 2, figsize=(WIDE * MM, 2.8), layout="constrained")
    for axis, (key, label) in zip(axes, QUANTITIES.items(), strict=True):
        for rule, (name, colour, line, mark) in RULES.items():
            cells, *parts = zip(*course(results["values"][rule]["1"], results["changes"][rule]["1"], key), strict=True)
            means, errors = ([100 * one for one in part] for part in parts)
            axis.errorbar(cells, means, errors, label=name, color=colour, linestyle=line, marker=mark, markersize=4, linewidth=1, capsize=2)
        axis.set(xscale="log", xlabel="cell along the sliding direction, µm", ylabel=label, ylim=(0, None))
        axis.set_xticks([100, 50, 25, 12.5], ["100", "50", "25", "12.5"])
        axis.minorticks_off()
        axis.invert_xaxis()
    axes[0].legend(loc="lower left")
    figure.savefig(HERE.parents[2] / "docs/images/mesh.png", dpi=200)


if __name__ == "__main__":
    main()
