"""The tables of the documents, from results.json."""

import json
import math
import tomllib
from collections.abc import Iterator
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import measures
import numpy as np
from discs import NAMES, SCENES
from make_points import DEFAULT

from plateau.means import standard_error

HERE = Path(__file__).parent
RESULTS = json.loads((HERE / "results.json").read_text())
# Of a run of the study in parts.
RESULTS |= {"round_pin": json.loads((HERE / "round-pin.json").read_text())}


def value(path: str) -> object:
    """What is at a path of keys in results.json."""
    found = RESULTS
    for key in path.split("/"):
        found = found[int(key)] if isinstance(found, list) else found[key]
    return found


def every(pattern: str) -> list[float]:
    """Sizes of all numbers at paths of keys such as `rows/*/filled/0`."""
    found: list[Any] = [RESULTS]
    for key in pattern.split("/"):
        found = [entry for one in found for name, entry in entries(one) if fnmatchcase(str(name), key)]
    if not found:
        raise KeyError(pattern)
    return [abs(number) for number in found]


def entries(of: Any) -> Iterator[tuple[Any, Any]]:
    """What a dictionary or a list holds, each with its key or number."""
    return iter(of.items() if isinstance(of, dict) else enumerate(of))


def compared(path: str) -> float:
    """`PATH minus PATH`, or `PATH relative to PATH`, which is the ratio less one; of means without their intervals."""
    how = " minus " if " minus " in path else " relative to "
    one, other = (found[0] if isinstance(found, list) else found for found in map(value, path.split(how)))
    return one - other if how == " minus " else one / other - 1


def runs_of(*studies: str) -> int:
    """Number of runs of some studies, by their files: points times replicates."""
    found = 0
    for name in studies:
        study = tomllib.loads((HERE / f"{name}.toml").read_text())
        if study["design"] == "csv":
            lines = (HERE / study["file"]).read_text().splitlines()
            points = sum(not line.startswith("#") for line in lines) - 1
        else:
            points = math.prod(len(factor["levels"]) for factor in study["factor"])
        found += points * len(study["replicates"]["seeds"])
    return found


def share_left(hits: str, of: str) -> str:
    """The 95 % interval of a share of which so many of so many were seen, %."""
    return " to ".join(shown(100 * end, ".0f") for end in measures.wilson(int(hits), int(of)))


def shown(number: float, form: str) -> str:
    """A number as documents have it."""
    return format(number, form).replace("-", "−").replace(",", " ")


def with_interval(pair: list[float], factor: float, form: str) -> str:
    """Mean ± half width of the 95 % interval, where there is one."""
    mean, half = (entry * factor for entry in pair)
    if half != half:
        return shown(mean, form)
    return f"{shown(mean, form)} ± {shown(half, form)}"


def told(found: object, factor: float, form: str) -> str:
    """A number, or a mean with its interval."""
    return with_interval(found, factor, form) if isinstance(found, list) else shown(found * factor, form)


def last_tenth(heights: str, end: float, runs: str = "runs") -> str:
    """Mean contact area over the last tenth of a run and its standard error, mm²: of the means of 50 s that are kept of it."""
    middles, areas = np.array(value(f"{runs}/{heights}/contact_area")).T
    areas = areas[(middles > 0.9 * end) & (middles < end)] * 1e6
    return with_interval([areas.mean(), standard_error(areas)], 1, ".2f")


def m_of_one(part: str, heights: str) -> str:
    """The time acceleration of a run; runs that were kept are without."""
    return f"{RESULTS[part][heights].get('acceleration', 1.0):g}"


def m_of(part: str) -> str:
    """The time acceleration of a part of the study: of the runs what they have, of others what their scene says."""
    if part != "runs":
        return f"{accelerations()[part]:g}"
    found = [m_of_one("runs", heights) for heights in NAMES]
    return found[0] if len(set(found)) == 1 else ", ".join(found)


def acceleration(scene: Path) -> float:
    """The time acceleration of a scene, or of the one that it extends."""
    found = tomllib.loads(scene.read_text())
    given = found.get("numerics", {}).get("time_acceleration")
    return acceleration(scene.parent / found["extends"]) if given is None else float(given)


def accelerations() -> dict[str, float]:
    """The time acceleration of every part of the study, as scenes have it: numbers of different ones are not compared."""
    of_runs = {acceleration(HERE / f"{scene}.toml") for scene in [*SCENES.values(), "pooled"]}
    assert len(of_runs) == 1, f"the runs have accelerations {of_runs}"
    others = {name: acceleration(HERE / f"{name}.toml") for name in ("sets", "pooled-sets", "symmetry")}
    variants = float(DEFAULT["time acceleration"])
    assert variants == acceleration(HERE / "reduced.toml")
    return {"runs": of_runs.pop(), "variants": variants} | others


def row(*cells: str) -> str:
    """A line of a table."""
    return "| " + " | ".join(cells) + " |\n"


def head(*cells: str) -> str:
    """The first lines of a table."""
    return row(*cells) + "|" + "---|" * len(cells) + "\n"


def once(part: str, heights: str, key: str, end: str = "3000") -> float | None:
    """A number of a run at its end; none where it was not kept."""
    run = value(f"{part}/{heights}")
    for place in ("history", "pin", "disc"):
        if key in run.get(place, {}).get(end, {}):
            return run[place][end][key]
    return None


# The paper's claims: its number, what is measured, and of each the quantity and the claim in claims.py; without a quantity it is asked of
# the one before.
ASKED = [
    ("1", "filled, by volume, %", "filled", 100, ".1f", "filled in order"),
    ("1", "near the paper", None, 0, "", "filled as in the paper"),
    ("2", "disc, secondary by status, %", "disc_secondary", 100, ".1f", "more on the disc"),
    ("3", "pin, secondary by status, %", "pin_covered", 100, ".1f", "more on the pin, by status"),
    ("3", "build-up on the pin, mean, nm", "pin_film", 1e9, ".0f", "more on the pin, by volume"),
    ("3", "pin, secondary that carries load, %", "pin_loaded", 100, ".1f", "more on the pin, that carries load"),
    ("4", "Sq of the fibres, nm", "sq_fibres", 1e9, ".0f", "smoother fibres"),
    ("4", "Sq where plateaus touch, nm", "sq_touching", 1e9, ".0f", "smoother where it touches"),
    ("4", "Sq of the whole pin, µm", "sq_pin", 1e6, ".2f", "smoother pin"),
    ("5", "pressure: Gini coefficient", "pressure_gini", 1, ".3f", "more even pressure"),
    ("6", "contact area, 2700 to 3000 s, mm²", "contact_area_mean", 1e6, ".2f", "lower contact area"),
    ("6", "below three quarters of either", None, 0, "", "less than three quarters of it"),
    ("7", "run-in, to 90 %, s", "run_in", 1, ".0f", "longer run-in"),
    ("7", "drift, 2000 to 3000 s, % per 1000 s", "drift", 100, ".1f", "baseline not steady"),
    ("7", "heights / 10, not 0", None, 0, "", "heights / 10 not steady"),
    ("8", "inner less outer half, percentage points", "inner_over_outer", 100, ".1f", "fuller inside"),
    ("9", "half of the contact lies in spots below, µm", "contact_50", 1e6, ".0f", None),
]


def table_claims() -> str:
    """The paper's claims over sets of surfaces."""
    rows: list[list[str]] = []
    for number, name, key, factor, form, claim in ASKED:
        hits = str(RESULTS["holds"]["local"][claim]["hits"]) if claim else ""
        if key is None:
            rows[-1][-1] += f"; {name}: {hits}"
            continue
        rows.append([number, name, of_discs("sets/local", key, factor, form), hits])
    text = head("claim", "measured", f"m = {m_of('sets')}, {value('set_count/local')} sets", "in order in")
    return text + "".join(row(*cells) for cells in rows)


# What the table of the runs tells of each beside the claims: name, factor, form, quantity.
OF_RUNS = [
    ("run-in: change-point, s", 1, ".0f", "change_point"),
    ("drift in the last third, % per 1000 s", 100, ".2f", "drift"),
    ("deposited / worn, %", 100, ".1f", "deposited_over_worn"),
]


def table_runs() -> str:
    """The runs of one set of surfaces with local debris."""
    columns = [*((heights, "3000") for heights in NAMES), ("1", "7200")]
    if "7200" not in value("runs/1/history"):
        columns.pop()
    text = head(f"at the end, m = {m_of('runs')}", *(f"{NAMES[heights]}, {end} s" for heights, end in columns))
    text += row("contact area, last tenth ± standard error, mm²", *(last_tenth(heights, float(end)) for heights, end in columns))
    for name, factor, form, key in OF_RUNS:
        found = [(once("runs", heights, key, end), once("runs", heights, f"{key}_error", end)) for heights, end in columns]
        text += row(name, *(shown(one * factor, form) if error is None else with_interval([one, error], factor, form) for one, error in found))
    return text


def table_history() -> str:
    """Filling at the times of the maps."""
    times = list(value("runs/1/disc"))
    text = head(f"filled, by volume, %, m = {m_of('runs')}", *(f"{time} s" for time in times))
    for heights, name in NAMES.items():
        found = value(f"runs/{heights}/disc")
        text += row(name, *(shown(found[time]["filled"] * 100, ".1f") if time in found else "" for time in times))
    return text


def table_sizes() -> str:
    """Sizes of plateaus."""
    text = head(f"diameter, µm, of what holds 10, 50, 90 % of the area, m = {m_of('runs')}", *NAMES.values())
    names = {"pin_contact": "pin, in contact", "pin_thick": "pin, build-up of 0.1 µm and more"}
    for key, name in names.items():
        cells = []
        for heights in NAMES:
            found = value(f"runs/{heights}/sizes/3000/{key}")
            cells.append(", ".join(shown(found[p] * 1e6, ".0f") for p in ("10", "50", "90")))
        text += row(name, *cells)
    return text


def table_round_pin() -> str:
    """The rig's round pin and the paper's patch."""
    numbers = {
        "part in contact, %": ("contact_fraction", 100, ".1f"),
        "mean pressure, MPa": ("mean_pressure", 1e-6, ".2f"),
        "filled, %": ("filled", 100, ".1f"),
    }
    text = head("pin", *numbers)
    for pin, name in {"round": "round", "patch": "4 × 8 mm"}.items():
        text += row(name, *(of_discs(f"round_pin/{pin}", *number) for number in numbers.values()))
    return text


def of_discs(part: str, key: str, factor: float, form: str) -> str:
    """A quantity of the three discs."""
    return ", ".join(with_interval(value(f"{part}/{heights}/{key}"), factor, form) for heights in NAMES)


def table_pooled() -> str:
    """Pooled debris over sets of surfaces."""
    numbers = {
        "filled, %": ("filled", 100, ".1f"),
        "disc, secondary by status, %": ("disc_secondary", 100, ".1f"),
        "contact area, mm²": ("contact_area_mean", 1e6, ".2f"),
        "run-in, s": ("run_in", 1, ".0f"),
    }
    text = head(f"m = {m_of('pooled-sets')}, {value('set_count/pooled')} sets", "baseline, heights / 10, heights / 100")
    return text + "".join(row(name, of_discs("sets/pooled", *number)) for name, number in numbers.items())


# The claims that are asked of every choice, by the paper's numbers.
OF_CHOICES = {
    "filled in order": "1",
    "filled as in the paper": "near",
    "more on the disc": "2",
    "more even pressure": "5",
    "lower contact area": "6",
    "longer run-in": "7",
    "baseline not steady": "drift",
    "higher pressure": "10",
}


def table_choices() -> str:
    """Choices that scenes have and readings that no scene has: what comes out, and what does not hold in all sets of surfaces."""
    text = head("choice", "filled, %", "fails in one set or more")
    for part in ("variants", "readings"):
        for name, means in value(f"{part}/means").items():
            if name in ("the rule as it stands", *(f"resin set back by {depth} um" for depth in (2, 4, 16))):
                continue
            held = value(f"{part}/holds")[name]
            text += row(
                name,
                ", ".join(shown(means[heights]["filled"][0] * 100, ".1f") for heights in NAMES),
                ", ".join(number for claim, number in OF_CHOICES.items() if held[claim]["hits"] < held[claim]["of"]),
            )
    return text
