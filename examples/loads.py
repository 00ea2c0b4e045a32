#!/usr/bin/env python3
"""Runs a scene under several loads and prints the contact area under each, with its standard error.

python examples/loads.py data/scenes/quick.toml --loads 5 10 20 --folder loads
"""

import argparse
import pathlib

import plateau

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("scene", help="scene file")
parser.add_argument("--loads", type=float, nargs="+", default=[5, 10, 20], help="normal forces, N")
parser.add_argument("--folder", type=pathlib.Path, default=pathlib.Path("loads"), help="where the run files go")
arguments = parser.parse_args()

arguments.folder.mkdir(exist_ok=True)
print("load [N]   contact area [mm2]   standard error [mm2]")
for load in arguments.loads:
    file = arguments.folder / f"{load:g}-N.h5"
    # What is there is not run again; what was stopped goes on.
    run = plateau.run(arguments.scene, file, set={"operation.normal_force": f"{load} N"}, resume=True)
    area = run.plateau.mean("contact_area")
    print(f"{load:8g} {area.value * 1e6:19.6g} {area.error * 1e6:21.6g}")
