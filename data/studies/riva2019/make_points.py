"""Writes points.csv, the points of open-questions.toml: every variant with each of the paper's three discs.

A variant changes one thing of the default; a mesh takes its time acceleration with it, so that a step stands for the same
time, and a pool its captured fraction.
"""

import csv
from pathlib import Path

from discs import NAMES

DEFAULT = {
    "debris": "local",
    "captured fraction": "1",
    "captured resin fraction": "1",
    "resin recess": "8 um",
    "disc secondary wear rate": "0 1/Pa",
    "wear rate": "5e-14 1/Pa",
    "wear height": "5 um",
    "normal force": "11.7 N",
    "integrator": "explicit",
    "time acceleration": "500",
    "rows": "40",
    "disc columns": "1382",
    "pin columns": "80",
}


def both(fraction: float) -> dict[str, str]:
    """Debris of plateaus and of resin captured alike."""
    return {"captured fraction": f"{fraction:g}", "captured resin fraction": f"{fraction:g}"}


VARIANTS = {
    "default": {},
    "resin debris leaves": {"captured resin fraction": "0"},
    "disc build-up wears, 5e-14": {"disc secondary wear rate": "5e-14 1/Pa"},
    "disc build-up wears, 5e-15": {"disc secondary wear rate": "5e-15 1/Pa"},
    "captured fraction 0.5": both(0.5),
    "resin set back by 2 um": {"resin recess": "2 um"},
    "resin set back by 16 um": {"resin recess": "16 um"},
    "pool of the contact": {"debris": "contact", **both(0.06)},
    "wear rate 1e-13": {"wear rate": "1e-13 1/Pa"},
    "wear rate 2.5e-14": {"wear rate": "2.5e-14 1/Pa"},
    "load of 94 N on the whole pin": {"normal force": "23.4 N"},
    "load of 19.3 N on the whole pin": {"normal force": "4.8 N"},
    "mesh 100 um": {"rows": "20", "disc columns": "691", "pin columns": "40", "time acceleration": "250"},
    "time acceleration 100": {"time acceleration": "100"},
    "mesh 25 um": {"rows": "80", "disc columns": "2764", "pin columns": "160", "time acceleration": "1000"},
    "pool for each track": {"debris": "track", **both(0.06)},
    "captured fraction 0.25": both(0.25),
    "resin set back by 4 um": {"resin recess": "4 um"},
    "disc build-up wears, 5e-16": {"disc secondary wear rate": "5e-16 1/Pa"},
    "wear height 2 um": {"wear height": "2 um"},
    "exponential wear": {"integrator": "exponential"},
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
