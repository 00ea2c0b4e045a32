"""What strength of the build-up, transport length and wear by counterface do: writes strength.json.

usage: strength.py, in the environment .venv of the checkout with PYTHONPATH=python; run.sh calls it
"""

from collections.abc import Callable
from pathlib import Path

import claims
import measures
import numpy as np
from as_json import as_text
from discs import SCENES
from evaluate import flat, run_numbers, there
from history import END, LONG_END, at, finished_runs, history

import plateau

HERE = Path(__file__).parent
RUNS = HERE / "runs"
#: Time over which wear is taken at the start and at the end, s. At the start it is from the first sample on: before, resin, which is
#: set back, does not touch, and nothing but fibres wears.
WHILE, FIRST = 300.0, 10.0
#: Load of the reduced ring, N.
LOAD = 11.7

Numbers = dict[str, float]
#: Of each disc the numbers of its runs, set by set.
Discs = dict[str, list[Numbers]]


def lower(key: str) -> Callable[[claims.Of], bool]:
    """The rough disc has less than both smooth ones."""
    return lambda of: of(key, "1") < min(of(key, "0.1"), of(key, "0.01"))


#: What is asked of every strength: by its name, whether it is so in a set of surfaces.
ASKED: dict[str, Callable[[claims.Of], bool]] = {
    "filled as in the paper": claims.near_the_paper,
    "less on the rough disc": lower("disc_secondary"),
    "more, the smoother the disc": claims.rising("disc_secondary"),
    "less on the rough disc's pin": lower("pin_secondary"),
    "more on the pin, the smoother the disc": claims.rising("pin_secondary"),
    "more even pressure": lambda of: of("pressure_gini", "1") > max(of("pressure_gini", "0.1"), of("pressure_gini", "0.01")),
    "more even, the smoother the disc": claims.falling("pressure_gini"),
    "lower contact area": lower("contact_area_mean"),
    "larger area, the smoother the disc": claims.rising("contact_area_mean"),
    "longer run-in": claims.falling("run_in"),
    "heights / 10 not steady": lambda of: of("drift", "0.1") > of("drift_error", "0.1"),
    "wears more on the rough disc": lambda of: of("wear", "1") > max(of("wear", "0.1"), of("wear", "0.01")),
    "wear falls": lambda of: of("wear", "1") < of("first_wear", "1"),
    "wear falls, heights / 10": lambda of: of("wear", "0.1") < of("first_wear", "0.1"),
    "wear falls, heights / 100": lambda of: of("wear", "0.01") < of("first_wear", "0.01"),
    "emits more on the rough disc": lambda of: of("emitted", "1") > max(of("emitted", "0.1"), of("emitted", "0.01")),
}


def numbers(series: dict[str, np.ndarray], end: float, load: float = LOAD) -> Numbers:
    """Numbers of a run at a time: those of every run, emitted volume, and specific wear of the whole pin at first and at last, 1/Pa."""
    time = series["time"]

    def wear(since: float, until: float) -> float:
        lost, way = (at(time, series[key], until) - at(time, series[key], since) for key in ("worn_whole_pin", "sliding_distance"))
        return lost / (load * way)

    found = {"first_wear": wear(FIRST, WHILE), "wear": wear(end - WHILE, end), "emitted": at(time, series["emitted"], end)}
    return history(series, end) | found


def by_value(study: str, key: str, end: float) -> dict[str, Discs]:
    """Numbers of the finished runs of a collected study at a time, by the value of a factor; values of which a disc is missing are left out."""
    found: dict[str, Discs] = {}
    for run, series in finished_runs(plateau.open_study(HERE / study).data):
        discs = found.setdefault(str(run[key].item()), {heights: [] for heights in SCENES})
        discs[f"{float(run['heights']):g}"].append(numbers(series, end))
    return {value: discs for value, discs in found.items() if all(discs.values())}


def holds(discs: Discs) -> dict[str, list[float]]:
    """Of each claim in how many sets it holds, of how many, and the 95 % interval of that share."""
    sets = min(map(len, discs.values()))
    found = {}
    for name, test in ASKED.items():
        hits = sum(bool(test(lambda key, heights, number=number: discs[heights][number][key])) for number in range(sets))
        found[name] = [hits, sets, *measures.wilson(hits, sets)]
    return found


def above_the_rough_disc(discs: Discs) -> dict[str, tuple[float, float]]:
    """Contact area of each smooth disc over that of the rough one with the same surfaces, less one."""
    found = {}
    for heights in ("0.1", "0.01"):
        mean, half = claims.ratio(discs, "contact_area_mean", heights, "1")
        found[heights] = (mean - 1, half)
    return found


def means(discs: Discs) -> dict[str, object]:
    """Means with intervals of each disc."""
    return {heights: claims.intervals(runs) for heights, runs in discs.items()}


def told(discs: Discs) -> dict[str, object]:
    """Means with intervals of each disc, and what holds."""
    return {"means": means(discs), "holds": holds(discs)}


def steady() -> dict[str, object]:
    """Levels at the end of long runs by the wear rate of the disc's build-up, how far they differ, and the filling set by set."""
    found = {}
    for rate, discs in by_value("steady", "wear_rate_of_the_disc_s_build_up", 15000.0).items():
        filled = {heights: [run["filled"] for run in runs] for heights, runs in discs.items()}
        found[rate] = told(discs) | {"above_the_rough_disc": above_the_rough_disc(discs), "filled": filled}
    return found


def unknowns() -> dict[str, object]:
    """Filling with other correlation lengths and fibre fractions, set by set."""
    data = plateau.open_study(HERE / "unknowns").table
    found: dict[str, dict[str, list[float]]] = {}
    for _, run in data.iterrows():
        name = f"{run['correlation length [um]']:g} µm, {run['fibre fraction']:g}"
        found.setdefault(name, {}).setdefault(f"{run['heights']:g}", []).append(run["filled"])
    return found


def on_the_paper_s_mesh(name: str) -> dict[str, object]:
    """Runs with the paper's pin at both times, of the sets of which all three discs are there."""
    paths = {number: [RUNS / f"{name}-{number}-{heights}.h5" for heights in SCENES] for number in (1, 2, 3)}
    whole = [of_set for of_set in paths.values() if len(there(of_set)) == len(SCENES)]
    read = {path: run_numbers(path) for of_set in whole for path in of_set}
    discs = {heights: [flat(read[of_set[disc]]) for of_set in whole] for disc, heights in enumerate(SCENES)}
    late = {heights: [read[of_set[disc]]["history"][f"{LONG_END:.0f}"] for of_set in whole] for disc, heights in enumerate(SCENES)}
    return {"sets": len(whole), "means": means(discs), "late": means(late), "holds": claims.holds(discs)}


def main() -> None:
    """Write strength.json."""
    results = {
        "strengths": {value: told(discs) for value, discs in by_value("../strength", "strength", END).items()},
        "late": {value: told(discs) for value, discs in by_value("../strength", "strength", LONG_END).items()},
        "counterface": {value: told(discs) for value, discs in by_value("counterface", "strength", END).items()},
        "steady": steady(),
        "levels": {value: means(discs) for value, discs in by_value("levels", "state", 30000.0).items()},
        "unknowns": unknowns(),
        "full": {name: on_the_paper_s_mesh(name) for name in ("length", "strength")},
    }
    (HERE / "strength.json").write_text(as_text(results))


if __name__ == "__main__":
    main()
