"""What strength of the build-up, transport length and wear by counterface do: writes strength.json.

usage: strength.py, in the environment .venv of the checkout with PYTHONPATH=python; run.sh calls it
"""

import json
from collections.abc import Callable
from pathlib import Path

import claims
import measures
import numpy as np
from discs import SCENES
from evaluate import as_text, flat, run_numbers, there
from history import END, LONG_END, at, history

import plateau

HERE = Path(__file__).parent
RUNS = HERE / "runs"
#: Strength of the build-up in Pa that no pressure reaches: none.
NONE = 1e12
#: Time over which wear is taken at the start and at the end, s.
WHILE = 300.0
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


def heights_of(scale: float) -> str:
    """Name of a disc by the factor on its heights."""
    return f"{scale:g}"


def numbers(series: dict[str, np.ndarray], end: float, load: float = LOAD) -> Numbers:
    """Numbers of a run at a time: those of every run, emitted volume, and specific wear of the whole pin at first and at last, 1/Pa."""
    time = series["time"]

    def wear(since: float, until: float) -> float:
        lost, way = (at(time, series[key], until) - at(time, series[key], since) for key in ("worn_whole_pin", "sliding_distance"))
        return lost / (load * way)

    found = {"first_wear": wear(time[0], WHILE), "wear": wear(end - WHILE, end), "emitted": at(time, series["emitted"], end)}
    return history(series, end) | found


def runs_of(study: str, key: str) -> list[tuple[str, str, dict[str, np.ndarray]]]:
    """Value of a factor, disc and series of every finished run of a collected study, sets of surfaces in their order."""
    data = plateau.open_study(HERE / study).data
    finished = data.isel(run=np.flatnonzero(data["state"] == "finished"))
    finished = finished.sortby("replicate") if "replicate" in finished else finished
    series = [name for name, values in finished.data_vars.items() if values.ndim == 2 and name != "sample_time"]
    found = []
    for number in range(finished.sizes["run"]):
        run = finished.isel(run=number)
        time = run["time" if "time" in run else "sample_time"].values
        known = np.isfinite(time)
        values = {name: run[name].values[known] for name in series} | {"time": time[known]}
        found.append((str(run[key].item()), heights_of(float(run["heights"])), values))
    return found


def by_value(study: str, key: str, end: float) -> dict[str, Discs]:
    """Numbers of the runs of a study at a time, by the value of a factor; values of which a disc is missing are left out."""
    found: dict[str, Discs] = {}
    for value, heights, series in runs_of(study, key):
        found.setdefault(value, {heights: [] for heights in SCENES})[heights].append(numbers(series, end))
    return {value: discs for value, discs in found.items() if all(discs.values())}


def holds(discs: Discs) -> dict[str, list[float]]:
    """Of each claim in how many sets it holds, of how many, and the 95 % interval of that share."""
    sets = min(map(len, discs.values()))
    found = {}
    for name, test in ASKED.items():
        hits = sum(bool(test(lambda key, heights, number=number: discs[heights][number][key])) for number in range(sets))
        found[name] = [hits, sets, *measures.wilson(hits, sets)]
    return found


def told(discs: Discs) -> dict[str, object]:
    """Means with intervals of each disc, and what holds."""
    return {"means": {heights: claims.intervals(runs) for heights, runs in discs.items()}, "holds": holds(discs)}


def levels(study: str, key: str, end: float) -> dict[str, object]:
    """Contact area over the last tenth and filling of each disc at the end of long runs, by the value of a factor."""
    found: dict[str, dict[str, list[Numbers]]] = {}
    for value, heights, series in runs_of(study, key):
        found.setdefault(value, {}).setdefault(heights, []).append(history(series, end))
    return {value: {heights: claims.intervals(runs) for heights, runs in discs.items()} for value, discs in found.items()}


def unknowns() -> dict[str, object]:
    """Filling with other correlation lengths and fibre fractions, set by set."""
    data = plateau.open_study(HERE / "unknowns").table
    found: dict[str, dict[str, list[float]]] = {}
    for _, run in data.iterrows():
        name = f"{run['correlation length [um]']:g} µm, {run['fibre fraction']:g}"
        found.setdefault(name, {}).setdefault(heights_of(run["heights"]), []).append(run["filled"])
    return found


def on_the_paper_s_mesh(name: str) -> dict[str, object]:
    """Runs with the paper's pin at both times, of the sets of which all three discs are there."""
    paths = {number: [RUNS / f"{name}-{number}-{heights}.h5" for heights in SCENES] for number in (1, 2, 3)}
    whole = [of_set for of_set in paths.values() if len(there(of_set)) == len(SCENES)]
    read = {path: run_numbers(path) for of_set in whole for path in of_set}
    discs = {heights: [flat(read[of_set[disc]]) for of_set in whole] for disc, heights in enumerate(SCENES)}
    late = {heights: [read[of_set[disc]]["history"][f"{LONG_END:.0f}"] for of_set in whole] for disc, heights in enumerate(SCENES)}
    return {
        "sets": len(whole),
        "means": {heights: claims.intervals(runs) for heights, runs in discs.items()},
        "late": {heights: claims.intervals(runs) for heights, runs in late.items()},
        "holds": claims.holds(discs),
    }


def main() -> None:
    """Write strength.json."""
    results = {
        "strengths": {value: told(discs) for value, discs in by_value("../strength", "strength", END).items()},
        "late": {value: told(discs) for value, discs in by_value("../strength", "strength", LONG_END).items()},
        "counterface": {value: told(discs) for value, discs in by_value("counterface", "strength", END).items()},
        "steady": levels("steady", "wear_rate_of_the_disc_s_build_up", 15000.0),
        "steady at 8000 s": levels("steady", "wear_rate_of_the_disc_s_build_up", 8000.0),
        "levels": levels("levels", "state", 30000.0),
        "unknowns": unknowns(),
        "full": {name: on_the_paper_s_mesh(name) for name in ("length", "strength")},
    }
    (HERE / "strength.json").write_text(as_text(results))


if __name__ == "__main__":
    main()
