"""Writes points.csv, the points of open-questions.toml: every variant with each of the paper's three discs.

A variant changes one thing of the default, but for the last ones, which change several on purpose.
"""

import csv
from pathlib import Path

from discs import NAMES

DEFAULT = {
    "captured fraction": "0.06",
    "captured resin fraction": "0.06",
    "pad share": "0.5",
    "debris pool": "contact",
    "disc secondary wear rate": "0 1/Pa",
    "destruction": "true",
    "normal force": "47 N",
    "integrator": "explicit",
    "time acceleration": "200",
    "rows": "80",
    "disc columns": "2764",
    "pin columns": "161",
}


def both(fraction: float) -> dict[str, str]:
    """Debris of plateaus and of resin captured alike."""
    return {"captured fraction": f"{fraction:g}", "captured resin fraction": f"{fraction:g}"}


VARIANTS = {
    "default": {},
    "captured fraction 0.045": both(0.045),
    "captured fraction 0.09": both(0.09),
    "pad share 0": {"pad share": "0"},
    "pad share 0.75": {"pad share": "0.75"},
    "pad share 1": {"pad share": "1"},
    "track pool": {"debris pool": "track"},
    "disc build-up wears, 5e-16": {"disc secondary wear rate": "5e-16 1/Pa"},
    "disc build-up wears, 5e-15": {"disc secondary wear rate": "5e-15 1/Pa"},
    "disc build-up wears, 6e-15": {"disc secondary wear rate": "6e-15 1/Pa"},
    "disc build-up wears, 5e-14": {"disc secondary wear rate": "5e-14 1/Pa"},
    "no destruction": {"destruction": "false"},
    "19.3 N": {"normal force": "19.3 N"},
    "resin debris leaves": {"captured resin fraction": "0"},
    "resin debris leaves, more of the rest stays": {"captured resin fraction": "0", "captured fraction": "0.2"},
    "mesh 25 um": {"rows": "160", "disc columns": "5528", "pin columns": "322", "time acceleration": "400"},
    "mesh 100 um": {"rows": "40", "disc columns": "1382", "pin columns": "81", "time acceleration": "100"},
    "time acceleration 100": {"time acceleration": "100"},
    "time acceleration 500": {"time acceleration": "500"},
    "exponential wear": {"integrator": "exponential"},
    "pad share 0.95, all debris stays": {"pad share": "0.95", **both(1.0)},
    "pad share 1, all debris stays": {"pad share": "1", **both(1.0)},
}


def main() -> None:
    with Path(__file__).with_name("points.csv").open("w", newline="") as file:
        file.write("# Made by make_points.py: every variant with each of the three discs.\n")
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["heights", *DEFAULT])
        for changes in VARIANTS.values():
            assert changes.keys() <= DEFAULT.keys()
            for heights in NAMES:
                table.writerow([heights, *(DEFAULT | changes).values()])


if __name__ == "__main__":
    main()
