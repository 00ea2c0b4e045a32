#!/usr/bin/env python3
"""What the pin sees of a front brake in a drive: braking torque and sliding speed from the speed of a car.

python3 data/cycles/front_brake.py data/cycles/wltc-class3b.csv > data/cycles/wltc-front-brake.csv

The brakes give what slows the car down beyond its road load (no engine braking, no recuperation). From one row to the next

    F_b = max(0, -m dv/dt - F_0 - F_2 v^2)       dv/dt, v: difference and mean of the two speeds
    T_b = s F_b r_w / 2                          torque of one front brake

and a row has the mean of T_b before and after it, so that straight lines between the rows have the energy of F_b. The pin rubs as the
pads do, with the same friction force per area at the same sliding speed. So its torque is that of the brake in the ratio of the areas and
of the radii, and its power is that of the brake in the ratio of the areas; no coefficient of friction is assumed:

    T   = T_b (A_pin / n_p A) (r_pin / r_e)      n_p pads of area A at the radius r_e
    v_s = v r_e / r_w

A standing car is held with a torque of its own, which has no effect but that the pads touch. The car is a compact one of 1.5 t; every
figure is a choice, given below.
"""

import argparse
import csv
import itertools
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
    ("hold-torque", 100.0, "N m of one front brake, while the car stands"),
    ("pin-area", 32.2e-6, "A_pin, m2, of the simulated pin: that of cermet.toml"),
    ("pin-radius", 22e-3, "r_pin, m, its mean radius on the simulated disc"),
]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("drive", help="CSV file: time [s], road_speed [km/h], one row a second")
    for name, value, meaning in CHOICES:
        parser.add_argument(f"--{name}", type=float, default=value, help=f"{meaning} (default {value:g})")
    car = parser.parse_args()
    with open(car.drive, newline="") as file:
        rows = [(float(row["time [s]"]), float(row["road_speed [km/h]"])) for row in csv.DictReader(file)]
    # N, between two rows; nothing brakes before the first and after the last.
    forces = [0.0]
    for (start, before), (end, after) in itertools.pairwise(rows):
        acceleration = (after - before) / 3.6 / (end - start)
        speed = (before + after) / 2 / 3.6
        forces.append(max(0.0, -car.mass * acceleration - car.rolling - car.air * speed**2))
    forces.append(0.0)
    of_the_pin = car.pin_area / (car.pads * car.pad_area) * car.pin_radius / car.effective_radius
    out = csv.writer(sys.stdout, lineterminator="\n")
    out.writerow(["time [s]", "braking_torque [N m]", "sliding_speed [m/s]", "road_speed [km/h]"])
    for number, (time, road_speed) in enumerate(rows):
        if any(speed for _, speed in rows[max(number - 1, 0) : number + 2]):
            force = (forces[number] + forces[number + 1]) / 2
            torque = car.front_share * force * car.wheel_radius / 2
        else:
            torque = car.hold_torque
        sliding = road_speed / 3.6 * car.effective_radius / car.wheel_radius
        out.writerow([f"{time:g}", f"{torque * of_the_pin:.6f}", f"{sliding:.4f}", f"{road_speed:g}"])


if __name__ == "__main__":
    main()
