"""Friction of the discs (model.md section 10), from runs without it: it acts on neither contact nor wear, so their contact area is
that of runs with it. For evaluate.py."""

import itertools
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import choices
import claims
import measures
import numpy as np
from discs import SCENES
from history import END, WINDOW, opened, series_of
from readings import SEEDS

from plateau.means import mean_between

# Load of the paper's scene, N.
LOAD = 47.0
# Times over which the mean is taken, s: run-in is the change from the first 100 s to the last tenth.
WINDOWS = {"0 to 10 s": (0.0, 10.0), "0 to 100 s": (0.0, 100.0), "900 to 1000 s": (900.0, 1000.0), "2700 to 3000 s": (2700.0, END)}
FIRST, LAST = "0 to 100 s", "2700 to 3000 s"
# What one disc has more than another.
PAIRS = {"0.01 less 1": ("0.01", "1"), "0.1 less 1": ("0.1", "1"), "0.01 less 0.1": ("0.01", "0.1")}
# The start of runs without acceleration, and the length of its means, s.
START, SHORT = 100.0, 2.0
# Variants with another load, by the load of the same nominal pressure on the paper's patch, N.
LOADS = {"19.3": "load of 19.3 N on the whole pin", "47": "default", "94": "load of 94 N on the whole pin"}


@dataclass(frozen=True)
class Law:
    """Shear stress of what touches, shear_strength + pressure_coefficient · p, Pa, and the largest coefficient of friction. The
    values are those of the shipped scenes. They are chosen: model.md section 12."""

    pressure_coefficient: float = 0.33
    shear_strength: float = 0.75e6
    maximum: float = 0.6

    def without_ceiling(self, area: np.ndarray | float, load: float) -> np.ndarray | float:
        """Coefficient of friction of a contact area, m2, under a load, N, however large."""
        return self.pressure_coefficient + self.shear_strength * area / load

    def area_at_ceiling(self, load: float) -> float:
        """Contact area from which the ceiling holds, m2."""
        return (self.maximum - self.pressure_coefficient) * load / self.shear_strength


CHOSEN = Law()
# Nobody measured the three values for this pair. On sprayed cermet discs the coefficient of friction is 0.47 to 0.62 (Kılıç et al.,
# Materials Testing 64, 2022), 0.075 to either side of its middle. Changed so far, each of the first two moves it by about as much; the
# ceiling is put above all that was measured, and within it.
CHANGED = {
    "pressure_coefficient": (0.8 * CHOSEN.pressure_coefficient, 1.2 * CHOSEN.pressure_coefficient),
    "shear_strength": (0.5 * CHOSEN.shear_strength, 1.5 * CHOSEN.shear_strength),
    "maximum": (0.5, 0.7),
}

Series = dict[str, np.ndarray]
# Of each disc the series of its runs, one for each set of surfaces.
Discs = dict[str, list[Series]]


def mean_area(series: Series, start: float, end: float) -> float:
    """Mean contact area over a time, m2, from its integral, which knows every step."""
    return mean_between(series["time"], series["contact_area_integral"], None, start, end).value


def samples(series: Series, start: float, end: float, load: float, law: Law) -> tuple[np.ndarray, float]:
    """Coefficient of friction without ceiling: of single steps within a time, and its mean over every step of that time.

    A few samples miss the mean over all steps; they are moved so that they have it.
    """
    time, every_step = series["time"], law.without_ceiling(mean_area(series, start, end), load)
    # Samples are at the ends of steps, a part of a step beside the time that was asked for.
    within = (time > start) & (time <= end * (1 + 1e-6))
    single = law.without_ceiling(series["contact_area"][within], load)
    return (single + (every_step - single.mean()) if single.size else np.array([every_step])), every_step


def mean_over(series: Series, start: float, end: float, load: float = LOAD, law: Law = CHOSEN) -> float:
    """Mean coefficient of friction over a time. A ceiling cuts every step by itself, so the mean is that of samples after the cut."""
    return float(np.minimum(samples(series, start, end, load, law)[0], law.maximum).mean())


def at_the_end(series: Series, end: float = END) -> float:
    """Mean over the last tenth."""
    return mean_over(series, 0.9 * end, end)


def per_disc(discs: Discs, number: Callable[[Series], float]) -> dict[str, np.ndarray]:
    """A number of each run of each disc."""
    return {heights: np.array([number(series) for series in of_disc]) for heights, of_disc in discs.items()}


def intervals(values: dict[str, np.ndarray]) -> dict[str, tuple[float, float]]:
    """Mean of each disc, and the half width of its 95 % interval over the sets."""
    return {heights: measures.interval(of_disc) for heights, of_disc in values.items()}


def between(values: dict[str, np.ndarray]) -> dict[str, tuple[float, float]]:
    """What discs have more than others, of the same set of surfaces each."""
    return {name: measures.interval(values[more] - values[less]) for name, (more, less) in PAIRS.items()}


def order(values: dict[str, np.ndarray]) -> dict[str, float]:
    """In how many sets the smoother disc has more friction, all three in order."""
    runs = {heights: [{"friction": number} for number in of_disc] for heights, of_disc in values.items()}
    return claims.holds(runs)["higher friction"]


def compared(values: dict[str, np.ndarray]) -> dict[str, object]:
    """All that is said of a number of three discs."""
    return {"discs": intervals(values), "between": between(values), "order": order(values)}


def law_over(window: str, law: Law = CHOSEN, load: float = LOAD) -> Callable[[Series], float]:
    """The mean over a window by a law."""
    return lambda series: mean_over(series, *WINDOWS[window], load, law)


def ceiling(discs: Discs) -> dict[str, object]:
    """What the ceiling does in the last tenth: the share of samples that meet it, and by how much the mean of samples that are cut is
    less than the mean of all steps when that is cut, over the sets and at most. And the highest of all samples without ceiling."""

    def above(coefficient: np.ndarray | float) -> np.ndarray:
        return np.maximum(coefficient - CHOSEN.maximum, 0.0)

    found = {}
    for heights, of_disc in discs.items():
        single = [samples(series, *WINDOWS[LAST], LOAD, CHOSEN) for series in of_disc]
        taken = [above(one).mean() - above(every_step) for one, every_step in single]
        found[heights] = {
            "share": float(np.mean([(one > CHOSEN.maximum).mean() for one, _ in single])),
            "taken": float(np.mean(taken)),
            "largest": float(max(taken)),
        }
    highest = max(CHOSEN.without_ceiling(series["contact_area"].max(), LOAD) for of_disc in discs.values() for series in of_disc)
    return found | {"highest": float(highest)}


def of_sets(discs: Discs, acceleration: float) -> dict[str, object]:
    """Friction over sets of surfaces. A window that is shorter than a simulated revolution has not seen the ring: it is left out."""
    revolution = acceleration * 60 / 850
    means = {window: per_disc(discs, law_over(window)) for window, (start, end) in WINDOWS.items() if end - start >= revolution}
    edges = np.arange(0.0, END + WINDOW / 2, WINDOW)
    over_time = {heights: [] for heights in discs}
    for start, end in itertools.pairwise(edges):
        for heights, pair in intervals(per_disc(discs, lambda series, times=(start, end): mean_over(series, *times))).items():
            over_time[heights].append([float(start + end) / 2, *pair])
    return {
        "windows": {window: compared(values) for window, values in means.items()},
        "run_in": intervals({heights: means[LAST][heights] - means[FIRST][heights] for heights in discs}),
        "ceiling": ceiling(discs),
        "over_time": over_time,
    }


def of_choices(discs: Discs) -> dict[str, object]:
    """What other values of the law do in the last tenth, one at a time, and by how much they move friction where no ceiling is."""
    laws = {"as chosen": (None, CHOSEN)} | {
        f"{key} {end}": (value, replace(CHOSEN, **{key: value}))
        for key, values in CHANGED.items()
        for end, value in zip(("low", "high"), values, strict=True)
    }
    free = {name: per_disc(discs, law_over(LAST, replace(law, maximum=np.inf))) for name, (_, law) in laws.items()}
    return {
        name: compared(per_disc(discs, law_over(LAST, law)))
        | {
            "value": value,
            "without_ceiling": compared(free[name]),
            "moves": {heights: float(free[name][heights].mean() - free["as chosen"][heights].mean()) for heights in discs},
        }
        for name, (value, law) in laws.items()
    }


def of_loads(study: Path) -> dict[str, object]:
    """Friction in the last tenth under other loads: runs on the reduced mesh that had them from the start."""
    found: dict[str, Discs] = {load: {heights: [] for heights in SCENES} for load in LOADS}
    loads = {name: load for load, name in LOADS.items()}
    for name, heights, series in choices.runs_of(study, set(loads)):
        found[loads[name]][heights].append(series)
    if any(len(of_disc) < len(SEEDS) for discs in found.values() for of_disc in discs.values()):
        return {}
    values = {load: per_disc(discs, law_over(LAST, load=choices.load_of(LOADS[load]))) for load, discs in found.items()}
    return {
        load: compared(values[load])
        | {
            "more_than_at_94": intervals({heights: values[load][heights] - values["94"][heights] for heights in SCENES}),
            "without_ceiling": compared(per_disc(discs, law_over(LAST, replace(CHOSEN, maximum=np.inf), choices.load_of(LOADS[load])))),
            "contact_area": intervals(per_disc(discs, lambda series: mean_area(series, *WINDOWS[LAST]))),
        }
        for load, discs in found.items()
    }


def of_runs(paths: dict[str, Path]) -> dict[str, object]:
    """Friction of the runs of one set of surfaces, and its start."""
    discs = {heights: [read(path)] for heights, path in paths.items()}
    edges = np.arange(0.0, START + SHORT / 2, SHORT)
    return {
        "windows": {window: {heights: law_over(window)(of[0]) for heights, of in discs.items()} for window in WINDOWS},
        "ceiling": ceiling(discs),
        "start": {
            heights: [[float(start + SHORT / 2), mean_over(of[0], start, start + SHORT)] for start in edges[:-1]] for heights, of in discs.items()
        },
    }


def of_means(discs: dict[str, list[list[float]]]) -> dict[str, object]:
    """Friction of runs of which nothing but the mean contact area of each window was kept, as if there were no ceiling."""
    found = {}
    for window, (start, end) in WINDOWS.items():
        if end - start >= WINDOW:
            areas = {heights: np.array([area for time, area in of if start < time < end]) for heights, of in discs.items()}
            found[window] = {heights: float(CHOSEN.without_ceiling(of.mean(), LOAD)) for heights, of in areas.items()}
    return {"windows": found}


def read(path: Path) -> Series:
    """The series of a run."""
    return series_of(opened(path))
