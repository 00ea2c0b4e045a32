"""The rig's round pin beside the paper's patch of 4 by 8 mm, under the same load: writes round-pin.json.

usage: round_pin.py, in the environment .venv of the checkout with PYTHONPATH=python; run.sh calls it
"""

import sys
from pathlib import Path

import measures
from discs import SCENES
from history import END, history, opened, reached, series_of

HERE = Path(__file__).parent
RUNS = HERE / "runs"
# Sets of surfaces, and what the runs of both pins are called.
SETS = (1, 2, 3)
PINS = {"round": "round-{seed}-{heights}", "patch": "set-local-{seed}-{heights}"}
# What is compared: numbers of history.py; besides, the area of the pin and the part of it that is in contact.
KEYS = ("contact_area_mean", "filled", "disc_secondary", "pin_secondary", "mean_pressure", "pressure_gini", "run_in")


def numbers(path: Path) -> dict[str, float]:
    """Those of one run."""
    series = series_of(opened(path))
    found = history(series)
    area = series["contact_area"][-1] / series["contact_ratio"][-1]
    return {key: found[key] for key in KEYS} | {"contact_fraction": float(found["contact_area_mean"] / area), "pin_area": float(area)}


def main() -> int:
    from evaluate import as_text

    found: dict[str, dict[str, object]] = {}
    for pin, name in PINS.items():
        paths = {heights: [RUNS / f"{name.format(seed=seed, heights=heights)}.h5" for seed in SETS] for heights in SCENES}
        missing = [path.name for of_disc in paths.values() for path in of_disc if reached(path) < END]
        if missing:
            print("not there:", *missing, file=sys.stderr)
            return 1
        found[pin] = {}
        for heights, of_disc in paths.items():
            runs = [numbers(path) for path in of_disc]
            found[pin][heights] = {key: measures.interval([run[key] for run in runs]) for key in runs[0]}
    (HERE / "round-pin.json").write_text(as_text(found))
    return 0


if __name__ == "__main__":
    sys.exit(main())
