"""Writes the baseline's initial surfaces for symmetry.toml: as they are, mirrored, and turned.

usage: symmetry.py BASELINE SURFACES, in the same environment as evaluate.py: the baseline's run file and the file to write
"""

import sys

import h5py

import plateau

# The other sliding direction is the same as both surfaces mirrored along it. A disc that is turned lets the run begin elsewhere.
# Mirrored across the track, what was at the inner radius is at the outer.
WAYS = {
    "as-they-are": lambda disc, pin: (disc, pin),
    "other-direction": lambda disc, pin: (disc[::-1], pin[::-1]),
    "inside-out": lambda disc, pin: (disc[:, ::-1], pin[:, ::-1]),
    "half-a-turn": lambda disc, pin: (disc[[*range(len(disc) // 2, len(disc)), *range(len(disc) // 2)]], pin),
}


def main() -> None:
    with plateau.open_run(sys.argv[1]) as run, h5py.File(sys.argv[2], "w") as file:
        disc, pin = (run[f"{body}/height"][0].values for body in ("disc", "pin"))
        base = run["pin/base"].values
        for name, seen in WAYS.items():
            file[f"{name}/disc"], file[f"{name}/pin"] = seen(disc, pin)
            file[f"{name}/base"] = seen(disc, base)[1]


if __name__ == "__main__":
    main()
