"""What the cell does with both rules of local debris, and with a strength of the build-up: writes mesh.json from the collected studies.

usage: evaluate.py, in the environment .venv of the checkout with PYTHONPATH=python
"""

import itertools
import re
import sys
from pathlib import Path

import numpy as np

import plateau

HERE = Path(__file__).parent
sys.path.append(str(HERE.parent / "riva2019"))
from as_json import as_text  # noqa: E402, where the other study is
from history import finished_runs, history  # noqa: E402

#: Length of a cell along the sliding direction in um, by the columns of the disc.
CELLS = {346: "100", 692: "50", 1384: "25", 2768: "12.5"}
END = 3000.0
#: Rules of studies that do not vary the transport length: with a strength it is 200 um.
WITHOUT = {"strength": "strength", "cell": "none"}
KEYS = ("filled", "contact_ratio", "run_in", "pin_secondary", "pressure_gini", "worn", "emitted")

#: Numbers of a run, by rule, disc, rows, time acceleration, cell and set of surfaces.
Found = dict[tuple[str, str, int, float, str, int], dict[str, float]]


def runs() -> Found:
    """Return the numbers of every finished run of the studies."""
    found: Found = {}
    for study in ("length", "strength", "cell"):
        for run, series in finished_runs(plateau.open_study(HERE / study).data):
            numbers = history(series, END)
            numbers["contact_ratio"] = numbers["contact_area_mean"] * (series["contact_ratio"] / series["contact_area"]).mean()
            numbers["worn"] = sum(series[name][-1] for name in ("worn_pin", "worn_resin", "worn_disc"))
            numbers["emitted"] = series["emitted"][-1]
            length = f"{float(run['transport_length']) * 1e6:g}" if "transport_length" in run else WITHOUT[study]
            surfaces = re.search(r"set-(\d+)-", str(run["surfaces"].item()))
            assert surfaces, run["surfaces"]
            cell = CELLS[int(run["disc_columns"])]
            key = (length, f"{float(run['heights']):g}", int(run["rows"]), float(run["time_acceleration"]), cell, int(surfaces[1]))
            found[key] = {name: float(numbers[name]) for name in KEYS}
    return found


def standard(values: list[float]) -> list[float]:
    """Mean and its standard error, and the number of values."""
    sample = np.array(values)
    error = sample.std(ddof=1) / np.sqrt(len(sample)) if len(sample) > 1 else np.nan
    return [float(sample.mean()), float(error), len(sample)]


def compared(found: Found, one: tuple[str, str, int, float, str], other: tuple[str, str, int, float, str]) -> dict[str, list[float]]:
    """Relative change from one setting to another, over the sets of surfaces that both have."""
    sets = sorted(key[5] for key in found if key[:5] == one and (*other, key[5]) in found)
    if not sets:
        return {}
    pairs = [(found[*one, number], found[*other, number]) for number in sets]
    return {name: standard([new[name] / old[name] - 1 for old, new in pairs]) for name in KEYS}


def main() -> None:
    """Write mesh.json."""
    found = runs()
    values: dict[str, object] = {}
    changes: dict[str, object] = {}
    cells = list(CELLS.values())
    for length in ("200", "150", "100", "none", "strength"):
        values[length] = {
            heights: {cell: of for cell in cells if (of := mean(found, (length, heights, 20, 100.0, cell)))} for heights in ("1", "0.1", "0.01")
        }
        changes[length] = {
            heights: {
                f"{coarse} to {fine}": change
                for coarse, fine in itertools.pairwise(cells)
                if (change := compared(found, (length, heights, 20, 100.0, coarse), (length, heights, 20, 100.0, fine)))
            }
            for heights in ("1", "0.1", "0.01")
        }
    rows = {
        heights: {cell: compared(found, ("200", heights, 20, 100.0, cell), ("200", heights, 40, 100.0, cell)) for cell in ("50", "25")}
        for heights in ("1", "0.1", "0.01")
    }
    accelerated = {
        length: {heights: compared(found, (length, heights, 20, 1.0, "50"), (length, heights, 20, 100.0, "50")) for heights in ("1", "0.1", "0.01")}
        for length in ("200", "strength")
    }
    results = {"values": values, "changes": changes, "rows": rows, "acceleration": accelerated, "runs": len(found)}
    (HERE / "mesh.json").write_text(as_text(results))


def mean(found: Found, setting: tuple[str, str, int, float, str]) -> dict[str, list[float]]:
    """Mean, standard error and number of runs of every quantity with a setting."""
    of = [numbers for key, numbers in found.items() if key[:5] == setting]
    return {name: standard([numbers[name] for numbers in of]) for name in KEYS} if of else {}


if __name__ == "__main__":
    main()
