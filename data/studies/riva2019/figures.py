"""Figures of the study: the paper's by their numbers, and those of what it leaves open.

usage: figures.py, in the environment .venv of the checkout with PYTHONPATH=python, after evaluate.py; figures.sh calls it
"""

import json
from pathlib import Path

import matplotlib
import numpy as np
import xarray
from discs import NAMES
from history import END, LONG_END, opened
from maps import BANDS, LATE
from matplotlib.colors import ListedColormap, LogNorm, Normalize
from tables import m_of, m_of_one

from plateau.style import APART, LINES, MM, STATUS_COLOURS, WIDE, wrapped

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = Path(__file__).parent
DOCS = HERE.parents[2] / "docs/images"
RESULTS = json.loads((HERE / "results.json").read_text())
# Those of the package, as README.md names them: black, blue, orange.
COLOURS = [LINES[5], LINES[0], LINES[6]]
# What stands beside the lines of the discs.
BESIDE = {"1": "rough disc (baseline)", "0.1": "disc with heights / 10", "0.01": "disc with heights / 100"}
STATUS = ListedColormap(STATUS_COLOURS[:3])
STATUSES = ["none (resin)", "primary", "secondary"]
# Width of all figures, inches.
ACROSS = WIDE * MM
# What docs/evidence/validation.md and README.md show.
SHOWN = ["fig08", "fig09", "fig10", "fig11", "fig12", "fig13", "fig14", "tornado", "radial", "pin", "friction", "friction-tornado"]
# Piece of the ring that is shown, columns: the paper's 8 mm.
PIECE = 160
# Readings of the rule that no scene has: starred where they stand beside those that have.
OTHER_READINGS = ("shared as a_p to a_d", "disc up to the disc ahead", "disc up to the pin ahead")

plt.style.use("plateau.plateau")

# The maps of a run that are drawn, by their names.
Maps = dict[str, xarray.DataArray]


def load(path: Path) -> Maps:
    """What is drawn of a run: maps of the start and the ends. Statuses follow from heights, and the coating does not wear."""
    times = opened(path)["map_time"].values
    run = opened(path).isel(map_time=sorted({int(np.argmin(np.abs(times - moment))) for moment in (0.0, END, LONG_END)}))
    maps = {name: run[name] for name in ("disc/height", "pin/height", "pin/pressure")}
    maps |= {"pin/build-up": run.plateau.build_up("pin"), "base": run["pin/base"]}
    maps["disc/build-up"] = maps["disc/height"] - maps["disc/height"][0]
    maps["disc/status"] = xarray.where(maps["disc/build-up"] > 0, 2, 1)
    maps["pin/status"] = xarray.where(maps["pin/build-up"] > 0, 2, maps["base"])
    return maps


def at(run: Maps, name: str, moment: float) -> xarray.DataArray:
    """A map at a moment, s; an error where none was recorded within a second of it."""
    return run[name].sel(map_time=moment, method="nearest", tolerance=1.0)


def edges(centres: np.ndarray) -> tuple[float, float]:
    """Where cells of equal width begin and end."""
    half = (centres[1] - centres[0]) / 2
    return centres[0] - half, centres[-1] + half


def draw(axes, values: xarray.DataArray, title: str, **how):
    """A map with the sliding direction along x and the radius along y, mm."""
    cells = values.plateau.unrolled()
    extent = (*edges(cells["arc_length"].values * 1e3), *edges(cells["radius"].values * 1e3))
    image = axes.imshow(values.T, origin="lower", extent=extent, interpolation="nearest", **how)
    axes.set(title=title, xlabel="along the track, mm", ylabel="radius, mm")
    return image


def save(figure, name: str) -> None:
    """Into the folder of figures, and into the documents where they show it."""
    (HERE / "figures").mkdir(exist_ok=True)
    figure.savefig(HERE / "figures" / f"{name}.png", dpi=200)
    if name in SHOWN:
        figure.savefig(DOCS / f"validation-{name}.png", dpi=200)
    plt.close(figure)


def of_three(runs: dict[str, Maps], name: str, values, label: str, norms) -> None:
    """A map of each disc's run, side by side; norms: the scale of each, or one for all."""
    common = isinstance(norms, Normalize)
    figure, axes = plt.subplots(1, 3, figsize=(ACROSS, 1.7), layout="constrained")
    for panel, (heights, run) in zip(axes, runs.items(), strict=True):
        # Where nothing is to be drawn.
        panel.set_facecolor(APART)
        image = draw(panel, values(run), NAMES[heights], norm=norms if common else norms(run))
        if not common:
            figure.colorbar(image, ax=panel, label=label, shrink=0.8)
    if common:
        figure.colorbar(image, ax=axes, label=label, shrink=0.8, extend="both")
    save(figure, name)


def scale(fields: list[xarray.DataArray]) -> Normalize:
    """From nearly the lowest to nearly the highest."""
    every = np.concatenate([field.values[np.isfinite(field.values)] for field in fields])
    return Normalize(*np.quantile(every, [0.005, 0.995]))


def of_the_start(run: Maps) -> Normalize:
    """The scale of the disc's heights at the start, so that what is open looks as it did then."""
    return scale([at(run, "disc/height", 0) * 1e6])


def with_strength() -> dict[str, dict[str, Maps]]:
    """Runs of the first set of surfaces by both rules, by the words of a row of panels."""
    names = {"plain rule": "set-local", "transport length 200 µm, strength 5 MPa": "strength"}
    paths = {words: {heights: HERE / "runs" / f"{name}-1-{heights}.h5" for heights in NAMES} for words, name in names.items()}
    return {words: {heights: load(path) | {"pin/usual status": usual_status(path)} for heights, path in of.items()} for words, of in paths.items()}


def usual_status(path: Path) -> xarray.DataArray:
    """The pin's status at the moment near the end whose share of secondary plateaus is nearest the mean of these moments."""
    run = opened(path)
    times = run["map_time"].values
    late = run.isel(map_time=np.flatnonzero((times > END - LATE) & (times < END + 1)))
    secondary = late.plateau.build_up("pin") > 0
    shares = secondary.mean(["pin_angle", "radius"]).values
    return xarray.where(secondary.isel(map_time=int(np.abs(shares - shares.mean()).argmin())), 2, run["pin/base"])


def of_both_rules(rows: dict[str, dict[str, Maps]], name: str, values, norm: Normalize, cmap=None, label: str = "") -> None:
    """A map of each disc's run, a row for each rule; without a label the colours are those of statuses."""
    figure, axes = plt.subplots(2, 3, figsize=(ACROSS, 3.3), layout="constrained")
    for panels, (words, runs) in zip(axes, rows.items(), strict=True):
        for panel, (heights, run) in zip(panels, runs.items(), strict=True):
            image = draw(panel, values(run), f"{words}\n{NAMES[heights]}" if panel is panels[0] else NAMES[heights], norm=norm, cmap=cmap)
    if label:
        figure.colorbar(image, ax=axes, label=label, shrink=0.8, extend="both")
    else:
        patches = [plt.Rectangle((0, 0), 1, 1, color=STATUS(number)) for number in range(3)]
        figure.legend(patches, STATUSES, loc="outside lower center", ncols=3)
    save(figure, name)


def inputs(run: Maps) -> None:
    """The paper's figures 5 to 7: what the runs begin with."""
    disc, pin = at(run, "disc/height", 0) * 1e6, at(run, "pin/height", 0) * 1e6
    figure, (above, below) = plt.subplots(2, 1, figsize=(5, 4), layout="constrained", height_ratios=[2, 1])
    figure.colorbar(draw(above, disc[:PIECE], "disc at the start, 8 mm of the ring"), ax=above, label="height, µm")
    arc = disc.plateau.unrolled()["arc_length"].values * 1e3
    below.plot(arc[:PIECE] - arc[0], disc[:PIECE, 40], color="black", lw=0.8)
    below.set(xlabel="along the track, mm", ylabel="height, µm", title="the same at the mean radius")
    save(figure, "fig05")
    figure, axes = plt.subplots(figsize=(4.5, 2.6), layout="constrained")
    draw(axes, run["base"], "pin: fibres (blue) in resin", cmap=STATUS, vmin=-0.5, vmax=2.5)
    save(figure, "fig06")
    figure, axes = plt.subplots(figsize=(4.5, 2.6), layout="constrained")
    figure.colorbar(draw(axes, -pin, "pin at the start, toward the disc"), ax=axes, label="height, µm")
    save(figure, "fig07")


def filling_of_the_baseline(run: Maps) -> None:
    """The paper's figure 8, and the length of the real test."""
    figure, axes = plt.subplots(1, 3, figsize=(ACROSS, 1.7), layout="constrained")
    for panel, moment in zip(axes, (0.0, END, LONG_END), strict=True):
        image = draw(panel, at(run, "disc/height", moment)[:PIECE] * 1e6, f"disc, baseline, {moment:.0f} s", norm=Normalize(-10, 10))
    figure.colorbar(image, ax=axes, label="height, µm", shrink=0.8, extend="both")
    save(figure, "fig08")


def contact_area() -> None:
    """The paper's figure 14, with pooled debris beside it. Every line has its name beside it, to be told in grey, too."""
    figure, axes = plt.subplots(figsize=(5.6, 3.2), layout="constrained")
    accelerations = {m_of_one("runs", heights) for heights in NAMES}
    for (heights, name), colour in zip(NAMES.items(), COLOURS, strict=True):
        m = "" if len(accelerations) == 1 else f", m = {m_of_one('runs', heights)}"
        for part, how in (("pooled_runs", {"lw": 0.9, "alpha": 0.7, "ls": "--"}), ("runs", {"lw": 1.5})):
            time, area = np.transpose(RESULTS[part][heights]["contact_area"])
            axes.plot(time, area * 1e6, color=colour, **how)
        place = (time[-1], area[-1] * 1e6 + 0.5) if time[-1] > END else (END + 60, area[-10:].mean() * 1e6 - 0.2)
        axes.annotate(BESIDE[heights] + m, place, color=colour, ha="right" if time[-1] > END else "left")
    how_fast = f", m = {accelerations.pop()}" if len(accelerations) == 1 else ""
    axes.plot([], [], color="grey", lw=1.5, label=f"local debris{how_fast}")
    axes.plot([], [], color="grey", lw=0.9, ls="--", label="the same disc with pooled debris, m = 1")
    axes.axvline(3000, color="grey", lw=0.6, ls=":")
    axes.annotate("end of the paper's simulations", (3000, 0.2), textcoords="offset points", xytext=(4, 0), color="grey")
    axes.set(xlabel="time, s", ylabel="contact area, mm², means of 50 s", xlim=(0, 7200), ylim=(0, None))
    axes.legend(loc="lower right", bbox_to_anchor=(1, 0.08))
    save(figure, "fig14")


def radial() -> None:
    """Filling against the radius."""
    figure, (axes, inner) = plt.subplots(1, 2, figsize=(ACROSS, 2.8), layout="constrained", width_ratios=[3, 2])
    of_baseline = RESULTS["sets"]["local"]["1"]
    bands = np.array([of_baseline[f"band_{number}"] for number in range(BANDS)]) * 100
    radius = 20 + (np.arange(BANDS) + 0.5) * 4 / BANDS
    axes.errorbar(
        radius, bands[:, 0], bands[:, 1], fmt="o", color="black", ms=3, capsize=2, lw=0.8, label=f"sets of surfaces, m = {m_of('sets')}, 95 %"
    )
    profile = [RESULTS["runs"]["1"]["disc"]["3000"][f"band_{number}"] * 100 for number in range(BANDS)]
    axes.plot(radius, profile, color=COLOURS[1], lw=1, label=f"one set, m = {m_of_one('runs', '1')}")
    axes.set(xlabel="radius, mm", ylabel="filled at 3000 s, %", title="baseline, local debris", ylim=(30, 100))
    axes.legend(loc="lower left")
    for place, rule in enumerate(RESULTS["each_set"]):
        values = np.array(RESULTS["each_set"][rule]["inner_over_outer"]["1"]) * 100
        mean, half = np.array(RESULTS["sets"][rule]["1"]["inner_over_outer"]) * 100
        inner.plot(np.full(len(values), place), values, "o", color="grey", ms=3, alpha=0.7)
        inner.errorbar(place + 0.2, mean, half, fmt="s", color="black", ms=4, capsize=3)
    inner.axhline(0, color="grey", lw=0.6)
    inner.set(title="each set, and mean with 95 %", ylabel="inner less outer half, points", xlim=(-0.4, 1.6), ylim=(-15, 15))
    inner.set_xticks(np.arange(len(RESULTS["each_set"])) + 0.1, list(RESULTS["each_set"]))
    save(figure, "radial")


def pin_over_sets() -> None:
    """What claims 3 and 4 ask of the pin, in each set of surfaces."""
    panels = {
        "pin_film": ("build-up on the pin, nm", 1e9),
        "pin_covered": ("pin, secondary by status, %", 100),
        "pin_loaded": ("secondary that carries load, %", 100),
        "sq_fibres": ("Sq of the fibres, nm", 1e9),
        "sq_pin": ("Sq of the whole pin, µm", 1e6),
    }
    figure, axes = plt.subplots(1, len(panels), figsize=(ACROSS, 2.2), layout="constrained")
    for panel, (key, (title, factor)) in zip(axes, panels.items(), strict=True):
        for rule, colour, place in (("local", COLOURS[1], -0.08), ("pooled", COLOURS[2], 0.08)):
            if rule not in RESULTS["each_set"]:
                continue
            values = np.array(list(RESULTS["each_set"][rule][key].values())) * factor
            panel.plot(np.arange(3) + place, values, "-o", color=colour, ms=2.5, lw=0.6, alpha=0.6)
        panel.set(title=wrapped(title, 20), xlim=(-0.4, 2.4), yscale="log" if key == "sq_fibres" else "linear")
        panel.set_xticks(range(3), ["heights", "/ 10", "/ 100"])
    axes[0].plot([], [], "-o", color=COLOURS[1], ms=2.5, lw=0.8, label="local")
    axes[0].plot([], [], "-o", color=COLOURS[2], ms=2.5, lw=0.8, label="pooled")
    axes[0].legend()
    save(figure, "pin")


def tornado() -> None:
    """What each choice does to four results, with the others at their defaults."""
    outcomes = {name: of for name, of in RESULTS["variants"]["outcomes"].items() if name != "default"}
    of_readings = RESULTS["readings"]["outcomes"]
    outcomes |= {f"{name} *": of for name, of in of_readings.items() if name in OTHER_READINGS}
    names = sorted(outcomes, key=lambda name: sum(abs(outcomes[name][key]["change"][0]) for key in outcomes[name]))
    default_of = RESULTS["variants"]["outcomes"]["default"]
    figure, axes = plt.subplots(1, len(default_of), figsize=(ACROSS, 5.2), layout="constrained", sharey=True)
    places = np.arange(len(names))
    for panel, outcome in zip(axes, default_of, strict=True):
        default = default_of[outcome]["value"][0] * 100
        change = np.array([outcomes[name][outcome]["change"] for name in names]) * 100
        colours = [COLOURS[1] if value > 0 else COLOURS[2] for value in change[:, 0]]
        panel.barh(places, change[:, 0], left=default, color=colours, height=0.7)
        panel.errorbar(default + change[:, 0], places, xerr=change[:, 1], fmt="none", ecolor="black", elinewidth=0.8, capsize=2)
        panel.axvline(default, color="black", lw=0.8)
        panel.set(title=wrapped(f"{outcome}, %", 26), xlabel=f"default {default:.1f} %")
    axes[0].set_yticks(places, names)
    save(figure, "tornado")


def build_up(run: Maps) -> xarray.DataArray:
    """Of the piece of the ring that is shown, µm."""
    return at(run, "disc/build-up", END)[:PIECE] * 1e6


def pin_height(run: Maps) -> xarray.DataArray:
    """Toward the disc, above the mean fibre, µm."""
    height = -at(run, "pin/height", END) * 1e6
    return height - height.values[run["base"].values == 1].mean()


def pressure(run: Maps) -> xarray.DataArray:
    """Where there is contact, MPa."""
    field = at(run, "pin/pressure", END) * 1e-6
    return field.where(field > 0)


def statuses_and_heights() -> None:
    """The paper's figures 10 to 12, without and with a strength of the build-up."""
    rows = with_strength()
    statuses = Normalize(-0.5, 2.5)
    of_both_rules(rows, "fig10", lambda run: at(run, "disc/status", END)[:PIECE], statuses, STATUS)
    every = [pin_height(run) for runs in rows.values() for run in runs.values()]
    of_both_rules(rows, "fig11", pin_height, scale(every), label="height above the mean fibre, µm")
    of_both_rules(rows, "fig12", lambda run: run["pin/usual status"], statuses, STATUS)


def main() -> None:
    # With the acceleration of the sets, as those of figures 10 to 12.
    runs = {heights: load(HERE / f"runs/quick-{heights}.h5") for heights in NAMES}
    inputs(runs["1"])
    filling_of_the_baseline(load(HERE / "runs/long.h5"))
    of_three(runs, "fig09", lambda run: at(run, "disc/height", END)[:PIECE] * 1e6, "height, µm", of_the_start)
    of_three(runs, "fig10b", build_up, "build-up, µm", lambda run: scale([build_up(run)]))
    of_three(runs, "fig13", pressure, "pressure, MPa", LogNorm(1, 30))
    statuses_and_heights()
    contact_area()
    radial()
    pin_over_sets()
    if RESULTS["variants"] and RESULTS["readings"]:
        tornado()


if __name__ == "__main__":
    main()
