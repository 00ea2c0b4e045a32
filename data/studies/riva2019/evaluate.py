"""What the runs of the study say, as numbers: writes results.json from the run files and the collected study.

usage: evaluate.py, in the environment .venv of the checkout with PYTHONPATH=python; run.sh calls it
"""

import itertools
import json
import sys
from dataclasses import asdict
from pathlib import Path

import choices
import claims
import friction
import maps
import measures
import numpy as np
import xarray
from as_json import as_text
from discs import SCENES
from history import END, LONG_END, at, history, opened, reached, run_of, series_of, window_means

HERE = Path(__file__).parent
RUNS = HERE / "runs"
# The study of other choices.
CHOICES = HERE / "open-questions"
# As run.sh has them. What is not there yet is left out, and said.
SETS = range(1, 11)
RULES = ("local", "pooled")
# Runs with other pins on one and the same disc, the baseline of the first set and of the runs of one set of surfaces.
PINS = ["set-local-1-1", *(f"pin-{number}" for number in (2, 3, 4, 5))]
WAYS = ["as-they-are", "other-direction", "inside-out", "half-a-turn"]
# Their surfaces, which symmetry.py writes beside the runs.
SURFACES = "symmetry-surfaces.h5"
# Duration of a step, s: 2764 columns, 850 rpm.
STEP = 60 / 850 / 2764
# Wear rate of plateaus on the pin times load, m3/m.
WEAR = 5e-14 * 47
# Time of the comparison of the start of runs, s.
START = 100.0


def run_numbers(path: Path) -> dict[str, object]:
    """All numbers of a run, or of what there is of one that came past the end of the paper's."""
    run = opened(path)
    series, times = series_of(run), run["map_time"].values[1:]
    ends = [end for end in (END, LONG_END) if end <= series["time"][-1]]
    assert ends, f"{path} came to {series['time'][-1]:.0f} s only"
    middles, area = window_means(series["time"], series["contact_area_integral"], (series["time"][-1] + 1) // 50 * 50)
    # Of the maps near an end, which pin.py averages, the last is enough for the disc.
    late = [moment for moment in times if any(end - maps.LATE < moment < end - 1 for end in ends)]
    return {
        "program": str(run.attrs["program"]),
        "revision": str(run.attrs["source_revision"]),
        "host": str(run.attrs["host"]),
        "wall_time": float(run.attrs.get("wall_time", np.nan)),
        "acceleration": acceleration(run),
        "steps": round(float(series["time"][-1]) / STEP / acceleration(run)),
        "history": {f"{end:.0f}": history(series, end, WEAR) | {"friction": friction.at_the_end(series, end)} for end in ends},
        "pin": {f"{end:.0f}": maps.at_the_end(run, end) for end in ends},
        "disc": {f"{moment:.0f}": maps.of_the_disc(run, moment) for moment in times if moment not in late},
        "sizes": {f"{end:.0f}": maps.sizes(run, end) for end in ends},
        "contact_area": [[float(t), float(a)] for t, a in zip(middles, area, strict=True)],
    }


def there(paths: list[Path]) -> list[Path]:
    """The runs that came to the end, of some."""
    missing = [path.name for path in paths if reached(path) < END]
    if missing:
        print("not there:", *missing, file=sys.stderr)
    return [path for path in paths if path.name not in missing]


def paths_of_sets(rule: str) -> dict[str, list[Path]]:
    """The runs of each disc with the sets of surfaces of which all three discs are there."""
    paths = {seed: [RUNS / f"set-{rule}-{seed}-{heights}.h5" for heights in SCENES] for seed in SETS}
    whole = [paths[seed] for seed in SETS if len(there(paths[seed])) == len(SCENES)]
    return {heights: [of_set[disc] for of_set in whole] for disc, heights in enumerate(SCENES)}


def of_the_model() -> dict[str, object]:
    """The runs of one set of surfaces, without time acceleration if run.sh made them. Of a disc whose run has not come to the end of
    the paper's, the run with the acceleration of the sets stands in, and documents say so."""
    paths = {heights: run_of(RUNS, heights) for heights in SCENES}
    for heights, path in paths.items():
        if SCENES[heights] != path.stem:
            print(f"{path.name} stands in for {SCENES[heights]}.h5", file=sys.stderr)
    return {heights: run_numbers(path) for heights, path in paths.items()}


def acceleration(run: xarray.DataTree) -> float:
    """The time acceleration of a run."""
    return float(run.plateau.scene["numerics"]["time_acceleration"])


def exactness() -> dict[str, dict[str, object]]:
    """The acceleration of the sets against that of the runs, on the same surfaces, as far as the latter came: each number twice, and
    differences of contact areas over windows of 100 s."""
    found = {}
    for heights, scene in SCENES.items():
        until = min(END, reached(RUNS / f"{scene}.h5") // 100 * 100)
        if until < 500 or reached(RUNS / f"quick-{heights}.h5") < END:
            continue
        pairs = []
        for name in (scene, f"quick-{heights}"):
            run = opened(RUNS / f"{name}.h5")
            series = series_of(run)
            numbers = history(series, until) | {"acceleration": acceleration(run), "friction": friction.at_the_end(series, until)}
            areas = window_means(series["time"], series["contact_area_integral"], until, 100.0)[1]
            pairs.append((numbers | (maps.at_the_end(run, END) if until == END else {}), areas))
        (exact, exact_areas), (near, near_areas) = pairs
        found[heights] = {
            "until": until,
            "numbers": {key: [exact[key], near[key]] for key in exact if key in near},
            "worst": float(np.abs(near_areas / exact_areas - 1).max()),
            "mean": float(np.sqrt(((near_areas - exact_areas) ** 2).sum() / (exact_areas**2).sum())),
        }
    return found


def starts() -> dict[str, dict[str, object]]:
    """The first 100 s with several accelerations, among them the starts of runs without any where there are such
    (runs/start-HEIGHTS.h5)."""
    found = {}
    for heights, scene in SCENES.items():
        of_disc = []
        for path in [RUNS / f"{name}-{heights}.h5" for name in ("start", "quick")] + [RUNS / f"{scene}.h5"]:
            if reached(path) < START:
                continue
            run = opened(path)
            series = series_of(run)
            numbers = {key: at(series["time"], series[key], START) for key in ("filled_fraction", "disc_secondary")}
            # Its mean from half of the time on.
            area = window_means(series["time"], series["contact_area_integral"], START, START / 2)[1][1]
            of_disc.append({"acceleration": acceleration(run), "contact_area": float(area), **numbers})
        found[heights] = sorted(of_disc, key=lambda one: one["acceleration"])
    return found


def flat(run: dict[str, object], end: str = "3000") -> dict[str, float]:
    """The numbers of a run at its end, without levels."""
    contact = {f"contact_{part}": size for part, size in run["sizes"][end]["pin_contact"].items()}
    return run["disc"][end] | run["pin"][end] | run["history"][end] | contact


def pooled_runs() -> dict[str, object]:
    """The runs with pooled debris and without time acceleration: those of run.sh, or the numbers that were kept of some."""
    paths = {heights: RUNS / f"pooled-{heights}.h5" for heights in SCENES}
    if all(path.exists() for path in paths.values()):
        return {heights: run_numbers(path) for heights, path in paths.items()}
    return json.loads((HERE / "pooled-kept.json").read_text())


def pins_on_one_disc() -> dict[str, object]:
    """Whether the disc decides which lowlands stay open: the same disc, the baseline of one set, under several pins."""
    depths, inner = [], []
    paths = there([run_of(RUNS, "1"), *(RUNS / f"{pin}.h5" for pin in PINS)])
    if len(paths) < 2:
        return {}
    for path in paths:
        run = opened(path)
        depths.append(maps.open_depth(run, END))
        inner.append(maps.of_the_disc(run, END)["inner_over_outer"])
        initial = run["disc/height"][0].values
    pairs = [np.corrcoef(one.ravel(), other.ravel())[0, 1] for one, other in itertools.combinations(depths, 2)]
    return {
        "pins": len(paths),
        # Of the depths that are still open, between two pins, and with the depth at the start.
        "alike": [float(np.mean(pairs)), float(min(pairs)), float(max(pairs))],
        "with_the_start": float(np.mean([np.corrcoef(depth.ravel(), -initial.ravel())[0, 1] for depth in depths])),
        "inner_over_outer": measures.interval(inner),
    }


def symmetry() -> dict[str, dict[str, float]]:
    """Runs of the same surfaces seen otherwise."""
    found = {}
    for path in there([RUNS / f"{way}.h5" for way in WAYS]):
        found[path.stem] = history(series_of(opened(path)), load=WEAR)
    return found


def of_friction(paths: dict[str, dict[str, list[Path]]], pooled: dict[str, object]) -> dict[str, object]:
    """Friction over sets of surfaces with both rules, of the runs of one set, with other numbers of its law and under other loads."""
    series = {rule: {heights: [friction.read(path) for path in of] for heights, of in discs.items()} for rule, discs in paths.items()}
    accelerations = {rule: acceleration(opened(discs["1"][0])) for rule, discs in paths.items()}
    return {rule: friction.of_sets(discs, accelerations[rule]) for rule, discs in series.items()} | {
        "runs": friction.of_runs({heights: run_of(RUNS, heights) for heights in SCENES}),
        "pooled_runs": friction.of_means({heights: run["contact_area"] for heights, run in pooled.items()}),
        "choices": friction.of_choices(series["local"]) if "local" in series else {},
        "law": asdict(friction.CHOSEN) | {"area_at_ceiling": friction.CHOSEN.area_at_ceiling(friction.LOAD)},
        "loads": friction.of_loads(CHOICES),
    }


def books(runs: list[dict[str, float]]) -> dict[str, float]:
    """What the balances of many runs leave at worst."""
    rests = ("bookkeeping", "balance_residual", "load_residual")
    return {key: max(abs(run[key]) for run in runs) for key in rests} | {"runs": len(runs)}


def core_hours() -> float:
    """Wall time of all runs of the program, each of which has one worker, h."""
    seconds = 0.0
    for path in RUNS.glob("*.h5"):
        if path.name != SURFACES:
            seconds += float(opened(path).attrs.get("wall_time", 0.0))
    others = choices.collected(CHOICES)
    return (seconds + (0.0 if others is None else float(others["wall_time"].values.sum()))) / 3600


def main() -> None:
    runs, pooled = of_the_model(), pooled_runs()
    paths = {rule: of_rule for rule in RULES if (of_rule := paths_of_sets(rule))["1"]}
    sets = {rule: {heights: [flat(run_numbers(path)) for path in of] for heights, of in discs.items()} for rule, discs in paths.items()}
    seen_otherwise = symmetry()
    scenes = choices.of_scenes(CHOICES)
    readings, check = choices.of_readings(RUNS / "readings.json")
    every = [
        *(list(run["history"].values())[-1] for run in runs.values()),
        *seen_otherwise.values(),
        *(run for of_rule in sets.values() for of_disc in of_rule.values() for run in of_disc),
        *(run for discs in scenes.values() for of_disc in discs.values() for run in of_disc),
    ]
    results = {
        "runs": runs,
        "pooled_runs": pooled,
        "exactness": exactness(),
        "starts": starts(),
        "sets": {rule: {heights: claims.intervals(of) for heights, of in discs.items()} for rule, discs in sets.items()},
        "each_set": {
            rule: {
                key: {heights: [run[key] for run in of] for heights, of in discs.items()}
                for key in ("pin_film", "pin_covered", "pin_loaded", "sq_fibres", "sq_pin", "inner_over_outer")
            }
            for rule, discs in sets.items()
        },
        "ratio": {rule: {over: claims.ratio(discs, "contact_area_mean", "1", over) for over in ("0.1", "0.01")} for rule, discs in sets.items()},
        "holds": {rule: claims.holds(discs) for rule, discs in sets.items()},
        "holds_once": claims.holds({heights: [flat(run)] for heights, run in runs.items()}),
        "friction": of_friction(paths, pooled),
        "pins": pins_on_one_disc(),
        "symmetry": seen_otherwise,
        "set_count": {rule: len(sets[rule]["1"]) if rule in sets else 0 for rule in RULES},
        "variants": choices.summary(scenes, "default"),
        "readings": choices.summary(readings, "the rule as it stands"),
        "check": {"steps": max(one["steps"] for one in check), "worst": max(max(one["disc"], one["pin"]) for one in check)},
        "books": books(every),
        "core_hours": core_hours(),
    }
    (HERE / "results.json").write_text(as_text(results))


if __name__ == "__main__":
    main()
