"""Makes designs of this folder, which designs.rs compares with: python make.py (pyDOE3 1.6.2, scipy 1.17.1)."""

import importlib.metadata
import pathlib
import warnings

import numpy
import pyDOE3
import scipy
from scipy.stats import qmc

FOLDER = pathlib.Path(__file__).parent
PYDOE = f"pyDOE3 {importlib.metadata.version('pyDOE3')}"


def write(name, source, rows):
    lines = [",".join(f"{value:.17g}" for value in row) for row in numpy.asarray(rows, dtype=float)]
    (FOLDER / f"{name}.csv").write_text(f"# {source}\n" + "\n".join(lines) + "\n")


def main():
    write("full-2-3-4", f"{PYDOE}: fullfact([2, 3, 4]), levels from 0", pyDOE3.fullfact([2, 3, 4]))
    for name, generator in {
        "fraction-5-1": "a b c d abcd",
        "fraction-5-1-minus": "a b c d -abcd",
        "fraction-5-2": "a b c ab ac",
        "fraction-7-3": "a b c d abc abd acd",
        "fraction-7-4": "a b c ab ac bc abc",
        "fraction-8-4": "a b c d abc abd acd bcd",
        "fraction-15-11": "a b c d ab ac bc abc ad bd abd cd acd bcd abcd",
    }.items():
        write(name, f"{PYDOE}: fracfact('{generator}')", pyDOE3.fracfact(generator))
    for factors, alpha, centre in [
        (2, "orthogonal", (4, 4)),
        (3, "orthogonal", (4, 2)),
        (4, "orthogonal", (0, 3)),
        (2, "rotatable", (0, 0)),
        (4, "rotatable", (1, 2)),
    ]:
        call = f"ccdesign({factors}, center={centre}, alpha='{alpha}')"
        rows = pyDOE3.ccdesign(factors, center=centre, alpha=alpha)
        write(f"composite-{alpha}-{factors}", f"{PYDOE}: {call}", rows)
    rows = pyDOE3.ccdesign(3, center=(2, 1), alpha="rotatable", face="ccf")
    write("composite-face-3", f"{PYDOE}: ccdesign(3, center=(2, 1), alpha='rotatable', face='ccf')", rows)
    for factors in (3, 4, 5):
        write(f"behnken-{factors}", f"{PYDOE}: bbdesign({factors}, center=3)", pyDOE3.bbdesign(factors, center=3))
    sobol()


def sobol():
    """Some points, each after its number, as multiples of 2 to the power −30."""
    numbers = [*range(9), 1000, 1023, 1024, 40000, 65535, 65536, 70000]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        points = qmc.Sobol(101, scramble=False, bits=30).random(numbers[-1] + 1)
    rows = [[number, *(points[number] * 2**30)] for number in numbers]
    write("sobol", f"scipy {scipy.__version__}: qmc.Sobol(101, scramble=False, bits=30).random(70001) * 2**30", rows)


if __name__ == "__main__":
    main()
