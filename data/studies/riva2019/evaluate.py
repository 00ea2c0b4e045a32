"""What the runs of the study say, as numbers: writes results.json from the run files and the collected study.

usage: evaluate.py, in the environment .venv of the checkout; run.sh calls it
"""

import json
from pathlib import Path

import h5py
import measures
import numpy as np
from discs import SCENES
from make_points import DEFAULT, VARIANTS

HERE = Path(__file__).parent
# Times of the paper's results and, for the baseline, of the end of the real test, s.
END, LONG_END = 3000.0, 7200.0
# Build-ups from which a cell counts as covered, m: any film makes it secondary, and the pin's are thin.
THICKNESS = {"disc": 0.5e-6, "pin": 0.1e-6}
# How near to the highest of the start counts as filled, m.
NEAR = 0.1e-6
SETS = range(1, 11)
WAYS = ["as-they-are", "other-direction", "inside-out", "half-a-turn"]
# Duration of a step, s: 2764 columns, 850 rpm.
STEP = 60 / 850 / 2764
# Specific wear rate of plateaus on the pin, 1/Pa.
WEAR_RATE = 5e-14
# Length of the means that run-in and drift are taken of, s.
WINDOW = 50.0
# Time at the end over which samples of the pressure are averaged.
LAST = 300.0


def force_of(variant: str) -> float:
    """Load of a variant, N."""
    return float((DEFAULT | VARIANTS[variant])["normal force"].removesuffix(" N"))


def series_of(file: h5py.File) -> dict[str, np.ndarray]:
    """All series of a run that came to its end, and their time."""
    assert file.attrs["state"] == "finished", f"{file.filename} is {file.attrs['state']}"
    return {name: values[:] for name, values in file["series"].items()} | {"time": file["time"][:]}


def at(time: np.ndarray, values: np.ndarray, moment: float) -> float:
    """Value of a series at a moment, linear between samples."""
    return float(np.interp(moment, time, values))


def window_means(time: np.ndarray, integral: np.ndarray, end: float, width: float = WINDOW):
    """Middles of windows up to the end, and the means in them, from the integral, which knows every step."""
    edges = np.arange(0.0, end + width / 2, width)
    values = np.diff(np.interp(edges, np.r_[0.0, time], np.r_[0.0, integral])) / width
    return edges[:-1] + width / 2, values


def history(series: dict[str, np.ndarray], end: float = END, variant: str = "default") -> dict[str, float]:
    """What the series of a run say up to a time."""
    time = series["time"]
    middles, area = window_means(time, series["contact_area_integral"], end)
    last = measures.mean_of_last(area, 2)
    distance = at(time, series["sliding_distance"], end)
    worn_pin = at(time, series["worn_pin"], end)
    drift = measures.drift(middles[middles > end * 2 / 3], area[middles > end * 2 / 3])
    return {
        "filled": at(time, series["filled_fraction"], end),
        "contact_area": last,
        "run_in": measures.run_in(middles, area, 0.9),
        "change_point": measures.change_point(middles, area),
        # Relative to the mean, per 1000 s; with the half width of its 95 % interval.
        "drift": drift[0] * 1000,
        "drift_error": drift[1] * 1000,
        # They vary as the pin goes round the ring.
        **{
            key: float(series[key][(time > end - LAST) & (time <= end * (1 + 1e-9))].mean())
            for key in ("pressure_variation", "pressure_gini", "mean_pressure")
        },
        "pin_sq": at(time, series["pin_sq"], end),
        "disc_sq": at(time, series["disc_sq"], end),
        "pin_secondary": at(time, series["pin_secondary"], end),
        "disc_secondary": at(time, series["disc_secondary"], end),
        "worn_pin": worn_pin,
        "worn_resin": at(time, series["worn_resin"], end),
        "worn_disc": at(time, series["worn_disc"], end),
        # Worn off the pin's plateaus over what load, distance and wear rate say, less one.
        "bookkeeping": worn_pin / (WEAR_RATE * force_of(variant) * distance) - 1,
        "balance_residual": float(np.abs(series["balance_residual"]).max()),
        "load_residual": float(np.abs(series["load_residual"]).max()),
    }


def maps(file: h5py.File, moment: float) -> dict[str, object]:
    """What the maps of one moment say."""
    number = measures.number_at(file["map_time"][:], moment)
    radius = file["radius"][:]
    initial, height = file["disc/height"][0], file["disc/height"][number]
    substrate = file["disc/substrate"][number]
    reference = initial.max()
    build_up = {"disc": height - substrate, "pin": file["pin/substrate"][number] - file["pin/height"][number]}
    pressure = file["pin/pressure"][number]
    status = {body: file[f"{body}/status"][number] for body in ("disc", "pin")}
    sizes = {
        "pin_plateaus": measures.plateau_sizes(status["pin"] > 0, False),
        "pin_contact": measures.plateau_sizes(pressure > 0, False),
        "pin_thick": measures.plateau_sizes(build_up["pin"] >= THICKNESS["pin"], False),
        "disc_lowlands_filled": measures.plateau_sizes((initial < reference) & (height >= reference - NEAR), True),
        "disc_holes": measures.plateau_sizes(height < reference - 1e-6, True),
    }
    cell = radius.mean() * 2 * np.pi / height.shape[0] * np.diff(radius).mean()
    profile = measures.radial_filling(initial, height, radius, 16)
    return {
        "filled": measures.filled_volume(initial, height, radius),
        "filled_area": measures.filled_area(initial, height, radius, NEAR),
        "covered": {body: measures.share(build >= THICKNESS[body], radius) for body, build in build_up.items()},
        "initial_depth": float(measures.mean(reference - initial, radius)),
        "mean_build_up": float(measures.mean(build_up["disc"], radius)),
        "highest": float(height.max() - reference),
        "radial_filling": profile.tolist(),
        "inner_over_outer": float(profile[:8].mean() - profile[8:].mean()),
        "plateau_diameter": {
            name: measures.diameters(cells * cell, [10, 50, 90]) for name, cells in sizes.items() if len(cells)
        },
        "plateau_count": {name: len(cells) for name, cells in sizes.items()},
        # Where the deepest fifth of the area was.
        "open_where_deepest": measures.open_where_deepest(initial, height, radius, 0.2),
    }


def run_numbers(path: Path) -> dict[str, object]:
    """All numbers of a run without time acceleration."""
    with h5py.File(path) as file:
        series = series_of(file)
        ends = [END, LONG_END] if series["time"][-1] > END + 1 else [END]
        middles, area = window_means(series["time"], series["contact_area_integral"], ends[-1])
        return {
            "program": str(file.attrs["program"]),
            "revision": str(file.attrs["source_revision"]),
            "host": str(file.attrs["host"]),
            "steps": round(series["time"][-1] / STEP),
            "wall_time": float(file.attrs["wall_time"]),
            "history": {f"{end:.0f}": history(series, end) for end in ends},
            "maps": {f"{moment:.0f}": maps(file, moment) for moment in file["map_time"][1:]},
            "contact_area": [[float(t), float(a)] for t, a in zip(middles, area, strict=True)],
        }


def variants(path: Path) -> dict[str, object]:
    """The open questions: of every variant and disc the numbers of each replicate."""
    found: dict[str, dict[str, list]] = {name: {heights: [] for heights in SCENES} for name in VARIANTS}
    # In the order of points.csv.
    keys = [(name, heights) for name in VARIANTS for heights in SCENES]
    with h5py.File(path) as file:
        assert set(file["state"].asstr()[:]) == {"finished"}, "not every run of open-questions.toml is finished"
        names = [name for name, data in file.items() if data.ndim == 2 and name != "sample_time"]
        for row in range(len(file["run"])):
            name, heights = keys[int(file["point"][row]) - 1]
            time = file["time"][:] if "time" in file else file["sample_time"][row]
            there = np.isfinite(time)
            series = {key: file[key][row][there] for key in names} | {"time": time[there]}
            numbers = history(series, variant=name)
            numbers["wall_time"] = float(file["wall_time"][row])
            found[name][heights].append((int(file["replicate"][row]), numbers))
    return {
        name: {heights: [numbers for _, numbers in sorted(runs, key=lambda run: run[0])] for heights, runs in discs.items()}
        for name, discs in found.items()
    }


# What the paper concludes of rough (1), smoother (0.1) and smoothest (0.01) disc, each as something to be seen in one set of
# surfaces.
CONCLUSIONS = {
    "filling": lambda of: of("filled", "1") < of("filled", "0.1") <= of("filled", "0.01"),
    "lower contact area": lambda of: of("contact_area", "1") < 0.75 * min(of("contact_area", "0.1"), of("contact_area", "0.01")),
    "longer run-in": lambda of: of("run_in", "1") > of("run_in", "0.1") > of("run_in", "0.01"),
    "less uniform pressure": lambda of: of("pressure_gini", "1") > of("pressure_gini", "0.1") > of("pressure_gini", "0.01"),
    "rougher pin": lambda of: of("pin_sq", "1") > of("pin_sq", "0.1") > of("pin_sq", "0.01"),
    "less on the pin": lambda of: of("pin_secondary", "1") < of("pin_secondary", "0.1") < of("pin_secondary", "0.01"),
    "less on the disc": lambda of: of("disc_secondary", "1") < of("disc_secondary", "0.1") < of("disc_secondary", "0.01"),
}


def ratio(quantity: str, of: str, over: str):
    """Ratio of a quantity of two discs in each set of surfaces."""
    return lambda discs: [
        one[quantity] / other[quantity] for one, other in zip(discs[of], discs[over], strict=True)
    ]


def plain(quantity: str, heights: str):
    """A quantity of a disc in each set of surfaces."""
    return lambda discs: [numbers[quantity] for numbers in discs[heights]]


# What the tornado charts show.
OUTCOMES = {
    "filled, baseline": plain("filled", "1"),
    "filled, heights / 10": plain("filled", "0.1"),
    "filled, heights / 100": plain("filled", "0.01"),
    "contact area, baseline over heights / 100": ratio("contact_area", "1", "0.01"),
}


def summary(found: dict[str, dict[str, list]]) -> dict[str, object]:
    """Means over the sets of surfaces with 95 % intervals, what holds of the conclusions, and changes against the default."""
    means, holds, outcomes = {}, {}, {}
    for name, discs in found.items():
        means[name] = {heights: intervals(runs) for heights, runs in discs.items()}
        seeds = range(len(discs["1"]))
        holds[name] = {
            claim: sum(test(lambda key, heights, seed=seed: discs[heights][seed][key]) for seed in seeds)
            for claim, test in CONCLUSIONS.items()
        }
        outcomes[name] = {}
        for outcome, of in OUTCOMES.items():
            values, default = of(discs), of(found["default"])
            # The same surfaces with and without the change: what they have in common drops out.
            change = measures.interval([one - other for one, other in zip(values, default, strict=True)])
            outcomes[name][outcome] = {"value": measures.interval(values), "change": change}
    count = sum(len(runs) for discs in found.values() for runs in discs.values())
    return {"means": means, "holds": holds, "outcomes": outcomes, "seeds": len(found["default"]["1"]), "runs": count}


def calibration(found: dict[str, dict[str, list]], wanted: float) -> dict[str, object]:
    """The captured fraction at which the baseline is filled as wanted, and what it predicts of the other discs."""
    levels = {"captured fraction 0.045": 0.045, "default": 0.06, "captured fraction 0.09": 0.09}
    fractions, predicted = [], {"0.1": [], "0.01": []}
    for seed in range(len(found["default"]["1"])):
        def filled(heights: str, seed: int = seed) -> list[float]:
            return [found[name][heights][seed]["filled"] for name in levels]

        fraction = float(np.interp(wanted, filled("1"), list(levels.values())))
        fractions.append(fraction)
        for heights, values in predicted.items():
            values.append(float(np.interp(fraction, list(levels.values()), filled(heights))))
    return {
        "captured_fraction": measures.interval(fractions),
        "predicted": {heights: measures.interval(values) for heights, values in predicted.items()},
    }


def symmetry() -> dict[str, dict[str, float]]:
    """Runs of the same surfaces seen otherwise."""
    found = {}
    for way in WAYS:
        with h5py.File(HERE / "runs" / f"{way}.h5") as file:
            found[way] = history(series_of(file))
    return found


def sets() -> dict[str, list[dict[str, float]]]:
    """The three discs with ten sets of surfaces: what maps and series of each run say at the end."""
    found = {}
    for heights in SCENES:
        found[heights] = []
        for seed in SETS:
            with h5py.File(HERE / "runs" / f"set-{seed}-{heights}.h5") as file:
                of_series, of_maps = history(series_of(file)), maps(file, END)
            of_maps |= {f"covered_{body}": share for body, share in of_maps["covered"].items()}
            of_maps |= {f"contact_{part}": size for part, size in of_maps["plateau_diameter"]["pin_contact"].items()}
            of_maps |= {f"band_{number}": filled for number, filled in enumerate(of_maps["radial_filling"])}
            # The filling is in the series, too.
            found[heights].append({key: number for key, number in of_maps.items() if isinstance(number, float)} | of_series)
    return found


def intervals(runs: list[dict[str, float]]) -> dict[str, tuple[float, float]]:
    """Mean and half width of its 95 % interval of every number of some runs."""
    return {key: measures.interval([run[key] for run in runs]) for key in runs[0]}


def books(runs: list[dict[str, float]]) -> dict[str, float]:
    """What the balances of many runs leave at worst."""
    rests = ("bookkeeping", "balance_residual", "load_residual")
    return {key: max(abs(run[key]) for run in runs) for key in rests} | {"runs": len(runs)}


def acceleration() -> dict[str, float]:
    """Error of the contact area at m = 200 against m = 1 with the same surfaces, root mean square over windows of 100 s."""
    areas = []
    for name in ("baseline", "as-they-are"):
        with h5py.File(HERE / "runs" / f"{name}.h5") as file:
            series = series_of(file)
            areas.append(window_means(series["time"], series["contact_area_integral"], END, 100.0)[1])
            wall_time = float(file.attrs["wall_time"])
    exact, quick = areas
    return {"error": float(np.sqrt(((quick - exact) ** 2).sum() / (exact**2).sum())), "wall_time": wall_time}


def core_hours() -> float:
    """Wall time of all runs, each of which has one worker, h."""
    seconds = 0.0
    for path in [*(HERE / "runs").glob("*.h5"), HERE / "open-questions/results.h5"]:
        with h5py.File(path) as file:
            seconds += float(file.attrs.get("wall_time", 0.0))
            seconds += float(file["wall_time"][:].sum()) if "wall_time" in file else 0.0
    return seconds / 3600


def rounded(value: object) -> object:
    """With as many digits as anybody reads."""
    match value:
        case float():
            return float(f"{value:.6g}")
        case dict():
            return {key: rounded(entry) for key, entry in value.items()}
        case list() | tuple():
            return [rounded(entry) for entry in value]
    return value


def main() -> None:
    runs = {heights: run_numbers(HERE / "runs" / f"{scene}.h5") for heights, scene in SCENES.items()}
    seen_otherwise, of_sets, found = symmetry(), sets(), variants(HERE / "open-questions" / "results.h5")
    of_variants = [run for discs in found.values() for runs in discs.values() for run in runs]
    to_the_end = [list(run["history"].values())[-1] for run in runs.values()]
    every = [*to_the_end, *seen_otherwise.values(), *(run for of_disc in of_sets.values() for run in of_disc), *of_variants]
    results = {
        "runs": runs,
        "acceleration": acceleration(),
        "symmetry": seen_otherwise,
        "sets": {heights: intervals(of_disc) for heights, of_disc in of_sets.items()},
        "calibration": calibration(found, 0.7),
        "variants": summary(found),
        "books": books(every),
        "core_hours": core_hours(),
    }
    (HERE / "results.json").write_text(json.dumps(rounded(results), indent=1) + "\n")


if __name__ == "__main__":
    main()
