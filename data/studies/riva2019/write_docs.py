"""Writes the numbers of results.json into documents: docs/validation.md and the first screen of README.md.

usage: write_docs.py [--check]: with --check only says whether they agree, as exit status

Templates have `{{path}}`, `{{path|format}}` and `{{path|factor|format}}`: a path in results.json, a factor and a Python
format. `{{table NAME}}` is one of the tables below, `{{m runs}}` the time acceleration of a part of the study, and
`{{last tenth HEIGHTS END}}` the mean contact area of a run at m = 1 over the last tenth of the time to its end, mm².
"""

import json
import re
import sys
import tomllib
from pathlib import Path

import measures
import numpy as np
from discs import NAMES, SCENES
from make_points import DEFAULT

HERE = Path(__file__).parent
ROOT = HERE.parents[2]
MARKS = "<!-- found by data/studies/riva2019 -->\n", "<!-- end of what was found -->\n"
RESULTS = json.loads((HERE / "results.json").read_text())


def value(path: str) -> object:
    """What is at a path of keys in results.json."""
    found = RESULTS
    for key in path.split("/"):
        found = found[key]
    return found


def shown(number: float, form: str) -> str:
    """A number as documents have it."""
    return format(number, form).replace("-", "−").replace(",", " ")


def with_interval(pair: list[float], factor: float, form: str) -> str:
    """Mean ± half width of the 95 % interval."""
    mean, half = (entry * factor for entry in pair)
    return f"{shown(mean, form)} ± {shown(half, form)}"


def acceleration(scene: Path) -> float:
    """The time acceleration of a scene, or of the one that it extends."""
    found = tomllib.loads(scene.read_text())
    given = found.get("numerics", {}).get("time_acceleration")
    return acceleration(scene.parent / found["extends"]) if given is None else float(given)


def accelerations() -> dict[str, float]:
    """The time acceleration of every part of the study: numbers of different ones are not compared."""
    of_runs = {acceleration(HERE / f"{scene}.toml") for scene in SCENES.values()}
    assert len(of_runs) == 1, f"the runs have accelerations {of_runs}"
    others = {name: acceleration(HERE / f"{name}.toml") for name in ("sets", "symmetry")}
    return {"runs": of_runs.pop(), "variants": float(DEFAULT["time acceleration"])} | others


def last_tenth(heights: str, end: float) -> str:
    """Mean contact area over the last tenth of a run and its standard error, mm²: of the means of 50 s that are kept of it."""
    middles, areas = np.array(value(f"runs/{heights}/contact_area")).T
    areas = areas[(middles > 0.9 * end) & (middles < end)] * 1e6
    return with_interval([areas.mean(), measures.standard_error(areas)], 1, ".2f")


def row(*cells: str) -> str:
    """A line of a table."""
    return "| " + " | ".join(cells) + " |\n"


def head(*cells: str) -> str:
    """The first lines of a table."""
    return row(*cells) + "|" + "---|" * len(cells) + "\n"


def table_runs() -> str:
    """The runs without time acceleration."""
    ends = [*((heights, "3000") for heights in NAMES), ("1", "7200")]
    text = head("at the end", *NAMES.values(), "baseline, 7200 s")

    def line(name: str, factor: float, form: str, key: str) -> str:
        def one(run: str, end: str) -> str:
            return shown(value(f"runs/{run}/{'history' if '/' not in key else 'maps'}/{end}/{key.lstrip('/')}") * factor, form)

        return row(name, *(one(run, end) for run, end in ends))

    text += line("filled, by volume, %", 100, ".1f", "filled")
    text += line("filled, by area (within 0.1 µm), %", 100, ".1f", "/filled_area")
    text += line("disc covered by 0.5 µm and more, %", 100, ".1f", "/covered/disc")
    text += line("pin covered by 0.1 µm and more, %", 100, ".1f", "/covered/pin")
    text += line("build-up on the disc, mean, µm", 1e6, ".2f", "/mean_build_up")
    text += line("highest above the highest of the start, µm", 1e6, ".2f", "/highest")
    text += row(
        "contact area, mean of the last tenth ± standard error, mm²", *(last_tenth(run, float(end)) for run, end in ends)
    )
    text += line("contact area, last 100 s, mm²", 1e6, ".2f", "contact_area")
    text += line("run-in: to 90 % of that, ± 25 s", 1, ".0f", "run_in")
    text += line("run-in: change-point, s", 1, ".0f", "change_point")
    text += line("drift in the last third, % per 1000 s", 100, ".2f", "drift")
    text += line("± (95 %)", 100, ".2f", "drift_error")
    text += line("pressure: coefficient of variation", 1, ".2f", "pressure_variation")
    text += line("pressure: Gini coefficient", 1, ".2f", "pressure_gini")
    text += line("pressure, mean, MPa", 1e-6, ".2f", "mean_pressure")
    text += line("roughness of the pin, Sq, µm", 1e6, ".2f", "pin_sq")
    text += line("pin, secondary, %", 100, ".1f", "pin_secondary")
    text += line("disc, secondary (any film), %", 100, ".1f", "disc_secondary")
    text += line("filling, inner less outer half, percentage points", 100, ".1f", "/inner_over_outer")
    text += line("worn / (κ × load × distance) − 1", 1, ".1e", "bookkeeping")
    text += line("debris balance, largest residual", 1, ".1e", "balance_residual")
    return text


def table_sizes() -> str:
    """Sizes of plateaus."""
    text = head("diameter of plateaus, µm: 10, 50, 90 % of their area lies in smaller ones", *NAMES.values())
    names = {
        "pin_contact": "pin, in contact",
        "pin_plateaus": "pin, primary and secondary",
        "pin_thick": "pin, build-up of 0.1 µm and more",
        "disc_lowlands_filled": "disc, lowlands filled to the top",
        "disc_holes": "disc, holes deeper than 1 µm",
    }
    for key, name in names.items():
        cells = []
        for heights in NAMES:
            sizes = value(f"runs/{heights}/maps/3000/plateau_diameter").get(key)
            count = value(f"runs/{heights}/maps/3000/plateau_count/{key}")
            cells.append(
                "none" if sizes is None else ", ".join(shown(sizes[p] * 1e6, ".0f") for p in ("10", "50", "90")) + f" ({count})"
            )
        text += row(name, *cells)
    return text


def table_history() -> str:
    """Filling at the times of the maps."""
    times = list(value("runs/1/maps"))
    text = head("filled, by volume, %", *(f"{time} s" for time in times))
    for heights, name in NAMES.items():
        maps = value(f"runs/{heights}/maps")
        text += row(name, *(shown(maps[time]["filled"] * 100, ".1f") if time in maps else "" for time in times))
    return text


def table_variants() -> str:
    """The numbers of every variant."""
    text = head(
        f"variant, at m = {accelerations()['variants']:g} unless it says otherwise",
        *(f"{name}: filled, %" for name in NAMES.values()), *(f"{name}: contact area, mm²" for name in NAMES.values()),
        "baseline: run-in, s",
    )
    for name, means in value("variants/means").items():
        filled = (with_interval(means[heights]["filled"], 100, ".1f") for heights in NAMES)
        area = (with_interval(means[heights]["contact_area"], 1e6, ".2f") for heights in NAMES)
        text += row(name, *filled, *area, with_interval(means["1"]["run_in"], 1, ".0f"))
    return text


def table_conclusions() -> str:
    """In how many sets of surfaces every conclusion holds."""
    holds, seeds = value("variants/holds"), value("variants/seeds")
    claims = list(next(iter(holds.values())))
    text = head("the rougher disc has", *claims)
    for name, counts in holds.items():
        cells = ("yes" if counts[claim] == seeds else "no" if counts[claim] == 0 else f"{counts[claim]} of {seeds}"
                 for claim in claims)
        text += row(name, *cells)
    return text


def table_symmetry() -> str:
    """The same surfaces seen otherwise."""
    text = head("surfaces", "filled, %", "contact area, mm²", "run-in, s", "Gini coefficient of the pressure")
    for name, found in value("symmetry").items():
        text += row(
            name.replace("-", " "), shown(found["filled"] * 100, ".2f"), shown(found["contact_area"] * 1e6, ".3f"),
            shown(found["run_in"], ".0f"), shown(found["pressure_gini"], ".3f"),
        )
    return text


def filled_in(template: str) -> str:
    """A template with its numbers."""
    def one(match: re.Match) -> str:
        what = match.group(1)
        if what.startswith("table "):
            return globals()["table_" + what.removeprefix("table ")]().rstrip("\n")
        if what.startswith("m "):
            return f"{accelerations()[what.removeprefix('m ')]:g}"
        if what.startswith("last tenth "):
            heights, end = what.removeprefix("last tenth ").split()
            return last_tenth(heights, float(end))
        path, *rest = what.split("|")
        found = value(path)
        if not rest:
            return str(found)
        factor = float(rest[0]) if len(rest) == 2 else 1.0
        return with_interval(found, factor, rest[-1]) if isinstance(found, list) else shown(found * factor, rest[-1])

    return re.sub(r"\{\{(.+?)\}\}", one, template)


def documents() -> dict[Path, str]:
    """Every document with its numbers."""
    readme = ROOT / "README.md"
    before, rest = readme.read_text().split(MARKS[0])
    after = rest.split(MARKS[1])[1]
    found = filled_in((HERE / "readme.md.in").read_text())
    return {
        ROOT / "docs/validation.md": filled_in((HERE / "validation.md.in").read_text()),
        readme: before + MARKS[0] + found + MARKS[1] + after,
    }


def main() -> int:
    texts = documents()
    stale = [path for path, text in texts.items() if not path.exists() or path.read_text() != text]
    for path in stale:
        if "--check" in sys.argv[1:]:
            print(f"{path.relative_to(ROOT)} and data/studies/riva2019/results.json disagree: write_docs.py writes it anew")
        else:
            path.write_text(texts[path])
    return 1 if "--check" in sys.argv[1:] and stale else 0


if __name__ == "__main__":
    sys.exit(main())
