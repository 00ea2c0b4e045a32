"""Filling and contact of the rough disc against the cell, with both rules: docs/images/mesh.png, from mesh.json.

usage: PYTHONPATH=python figure.py, in the environment .venv of the checkout
"""

import json
from pathlib import Path

import matplotlib

from plateau.style import LINES, MM, WIDE

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402, after the choice of what draws

HERE = Path(__file__).parent
#: The plain rule is dashed.
RULES = {
    "none": ("debris moves by one cell", LINES[5], "--", "o"),
    "200": ("transport length 200 µm", LINES[0], "-", "s"),
    "150": ("150 µm", LINES[6], "-", "^"),
    "100": ("100 µm", LINES[2], "-", "v"),
}
QUANTITIES = {"filled": "disc filled after 3000 s, %", "contact_ratio": "part of the pin in contact, %"}


def main() -> None:
    """Draw both quantities of the rough disc, with standard errors."""
    plt.style.use("plateau.plateau")
    values = json.loads((HERE / "mesh.json").read_text())["values"]
    figure, axes = plt.subplots(1, 2, figsize=(WIDE * MM, 2.8), layout="constrained")
    for axis, (key, label) in zip(axes, QUANTITIES.items(), strict=True):
        for rule, (name, colour, line, mark) in RULES.items():
            of = values[rule]["1"]
            cells = [float(cell) for cell in of]
            means, errors = ([100 * of[cell][key][part] for cell in of] for part in (0, 1))
            axis.errorbar(cells, means, errors, label=name, color=colour, linestyle=line, marker=mark, markersize=4, linewidth=1, capsize=2)
        axis.set(xscale="log", xlabel="cell along the sliding direction, µm", ylabel=label, ylim=(0, None))
        axis.set_xticks([100, 50, 25, 12.5], ["100", "50", "25", "12.5"])
        axis.minorticks_off()
        axis.invert_xaxis()
    axes[0].legend(loc="lower left")
    figure.savefig(HERE.parents[2] / "docs/images/mesh.png", dpi=200)


if __name__ == "__main__":
    main()
