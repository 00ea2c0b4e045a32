"""What becomes of the results with other choices: scenes of open-questions.toml, and readings that no scene has (variants.py)."""

import json
import sys
from collections.abc import Collection, Iterator
from pathlib import Path

import claims
import measures
import numpy as np
import xarray
from discs import SCENES
from history import finished_runs, history
from make_points import DEFAULT, VARIANTS
from readings import READINGS, SEEDS

import plateau

# Of every choice and disc the numbers of each set of surfaces.
Found = dict[str, dict[str, list[dict[str, float]]]]


def setting(variant: str, name: str) -> float:
    """A number that a variant has, in its unit there."""
    return float((DEFAULT | VARIANTS[variant])[name].split()[0])


def load_of(variant: str) -> float:
    """Load of a variant, N."""
    return setting(variant, "normal force")


def wear_of(variant: str) -> float:
    """Wear rate times load of a variant, m3/m."""
    return load_of(variant) * setting(variant, "wear rate")


def whole(found: Found) -> Found:
    """The choices of which every disc and set of surfaces is there."""
    missing = [name for name, discs in found.items() if any(len(runs) < len(SEEDS) for runs in discs.values())]
    if missing:
        print("not there:", *missing, sep="\n  ", file=sys.stderr)
    return {name: discs for name, discs in found.items() if name not in missing}


def collected(study: Path) -> xarray.Dataset | None:
    """What was collected of a study; none where nothing was."""
    try:
        return plateau.open_study(study).data
    except plateau.MissingFileError:
        return None


def runs_of(study: Path, variants: Collection[str]) -> Iterator[tuple[str, str, dict[str, np.ndarray]]]:
    """Variant, disc and series of every run of some variants in the collected study, sets of surfaces in their order."""
    data = collected(study)
    if data is None:
        return
    # In the order of points.csv.
    keys = [(name, heights) for name in VARIANTS for heights in SCENES]
    for run, series in finished_runs(data):
        name, heights = keys[int(run["point"]) - 1]
        if name in variants:
            yield name, heights, series


def of_scenes(study: Path) -> Found:
    """The variants that scenes have, from the collected study."""
    found = {name: {heights: [] for heights in SCENES} for name in VARIANTS}
    for name, heights, series in runs_of(study, VARIANTS):
        found[name][heights].append(history(series, load=wear_of(name)))
    return whole(found)


def of_readings(path: Path) -> tuple[Found, list[dict[str, float]]]:
    """The readings that no scene has, and how the rule as it stands agrees with the program."""
    kept = json.loads(path.read_text())
    check, found = kept.pop("check"), {name: {heights: [] for heights in SCENES} for name in READINGS}
    for key, numbers in kept.items():
        name, heights, _ = key.rsplit(", ", 2)
        found[name][heights].append(numbers)
    return whole(found), check


# What the tornado charts show: a quantity, and the disc, or the two of which it is the ratio.
OUTCOMES = {
    "filled, baseline": ("filled", "1", None),
    "filled, heights / 10": ("filled", "0.1", None),
    "filled, heights / 100": ("filled", "0.01", None),
    "contact area, baseline over heights / 100": ("contact_area_mean", "1", "0.01"),
}


def outcome(discs: dict[str, list[dict[str, float]]], what: tuple[str, str, str | None]) -> np.ndarray:
    """One of the outcomes, in each set of surfaces."""
    key, disc, over = what
    values = np.array([numbers[key] for numbers in discs[disc]])
    return values if over is None else values / np.array([numbers[key] for numbers in discs[over]])


def summary(found: Found, default: str) -> dict[str, object]:
    """Means over the sets of surfaces with 95 % intervals, what holds of the claims, and changes against the default."""
    means, holds, outcomes = {}, {}, {}
    if default not in found:
        return {}
    for name, discs in found.items():
        means[name] = {heights: claims.intervals(runs) for heights, runs in discs.items()}
        holds[name] = claims.holds(discs)
        outcomes[name] = {}
        for title, what in OUTCOMES.items():
            values = outcome(discs, what)
            # The same surfaces with and without the change: what they have in common drops out.
            change = measures.interval(values - outcome(found[default], what))
            outcomes[name][title] = {"value": measures.interval(values), "change": change}
    runs = sum(len(runs) for discs in found.values() for runs in discs.values())
    return {"means": means, "holds": holds, "outcomes": outcomes, "seeds": len(found[default]["1"]), "runs": runs}
