#!/usr/bin/env python3
"""Prints how much of the disc and the pin is plateau at every recorded map, and how thick the build-up is.

python examples/coverage.py quick.h5
"""

import argparse

import plateau

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("run", help="run file")
arguments = parser.parse_args()

run = plateau.open_run(arguments.run)
table = run.plateau.coverage().to_dataframe().rename(columns="{} [1]".format)
for body in ("disc", "pin"):
    # Mean over all cells, each with its area; micrometres.
    table[f"{body}_build_up [um]"] = run.plateau.build_up(body).plateau.area_mean().values * 1e6
table.index.name = "time [s]"
print(table.reset_index().to_string(index=False, float_format="{:.6f}".format))
