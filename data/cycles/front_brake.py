#!/usr/bin/env python3
"""What a front brake sees of a drive: pad pressure and sliding speed from the speed of a car.

python3 data/cycles/front_brake.py data/cycles/wltc-class3b.csv > data/cycles/wltc-front-brake.csv

The brakes give what slows the car down beyond its road load (no engine braking, no recuperation):

    F_b = max(0, -m a - F_0 - F_2 v^2)       a: central difference of the speed
    p   = s F_b r_w / (2 n_p mu r_e A)        s/2 of it on one front wheel, n_p pads of area A at the radius r_e
    v_s = v r_e / r_w

A standing car is held with a pressure of its own. The car is a compact one of 1.5 t; every figure is a choice, given below.
"""

import argparse
import csv
import sys

CHOICES = [
    ("mass", 1500.0, "m, kg"),
    ("rolling", 130.0, "F_0, N"),
    ("air", 0.45, "F_2, N s2/m2"),
    ("front-share", 0.7, "s, part of the brake force on the front axle"),
    ("wheel-radius", 0.31, "r_w, m"),
    ("effective-radius", 0.115, "r_e, m"),
    ("pads", 2, "n_p, pads of a brake"),
    ("pad-area", 50e-4, "A, m2"),
    ("friction", 0.4, "mu"),
    ("hold-pressure", 0.2e6, "Pa, while the car stands"),
]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("drive", help="CSV file: time [s], road_speed [km/h], one row a second")
    for name, value, meaning in CHOICES:
        parser.add_argument(f"--{name}", type=float, default=value, help=f"{meaning} (default {value:g})")
    car = parser.parse_args()
    with open(car.drive, newline="") as file:
        rows = [(float(row["time [s]"]), float(row["road_speed [km/h]"])) for row in csv.DictReader(file)]
    out = csv.writer(sys.stdout, lineterminator="\n")
    out.writerow(["time [s]", "nominal_pressure [MPa]", "sliding_speed [m/s]", "road_speed [km/h]"])
    for number, (time, road_speed) in enumerate(rows):
        before, after = rows[max(number - 1, 0)], rows[min(number + 1, len(rows) - 1)]
        speed = road_speed / 3.6
        if road_speed == 0.0 and before[1] == after[1] == 0.0:
            pressure = car.hold_pressure
        else:
            acceleration = (after[1] - before[1]) / 3.6 / (after[0] - before[0])
            force = max(0.0, -car.mass * acceleration - car.rolling - car.air * speed**2)
            at_the_disc = car.front_share * force / 2 * car.wheel_radius / car.effective_radius
            pressure = at_the_disc / (car.pads * car.friction * car.pad_area)
        sliding = speed * car.effective_radius / car.wheel_radius
        out.writerow([f"{time:g}", f"{pressure / 1e6:.4f}", f"{sliding:.4f}", f"{road_speed:g}"])


if __name__ == "__main__":
    main()
