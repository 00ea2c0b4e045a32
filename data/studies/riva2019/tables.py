"""The tables of the documents, from results.json."""

import json
import tomllib
from pathlib import Path

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


def share(rule: str, claim: str) -> str:
    """In how many sets of surfaces a claim holds, with the interval of that share."""
    found = RESULTS["holds"][rule][claim]
    return f"{found['hits']} of {found['of']} ({found['low'] * 100:.0f} to {found['high'] * 100:.0f} %)"


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


# The paper's claims: its number, what is measured, and of each the quantity and the claim in claims.py.
ASKED = [
    ("1", "filled, by volume, %", "filled", 100, ".1f", "filled in order"),
    ("1", "… near the paper's 70, 90, almost", None, 0, "", "filled as in the paper"),
    ("2", "disc, secondary by status, %", "disc_secondary", 100, ".1f", "more on the disc"),
    ("3", "pin, secondary by status, %", "pin_covered", 100, ".1f", "more on the pin, by status"),
    ("3", "build-up on the pin, mean, nm", "pin_film", 1e9, ".0f", "more on the pin, by volume"),
    ("3", "pin, secondary that carries load, %", "pin_loaded", 100, ".1f", "more on the pin, that carries load"),
    ("4", "Sq of the fibres, nm", "sq_fibres", 1e9, ".0f", "smoother fibres"),
    ("4", "Sq where plateaus touch, nm", "sq_touching", 1e9, ".0f", "smoother where it touches"),
    ("4", "Sq of all plateaus, µm", "sq_plateaus", 1e6, ".2f", "smoother plateaus"),
    ("4", "Sq of the resin, µm", "sq_resin", 1e6, ".2f", "smoother resin"),
    ("4", "Sq of the whole pin, µm", "sq_pin", 1e6, ".2f", "smoother pin"),
    ("5", "pressure: Gini coefficient", "pressure_gini", 1, ".3f", "more even pressure"),
    ("6", "contact area, 2700 to 3000 s, mm²", "contact_area_mean", 1e6, ".2f", "lower contact area"),
    ("6", "… below three quarters of either smooth disc's", None, 0, "", "less than three quarters of it"),
    ("7", "run-in, to 90 %, s", "run_in", 1, ".0f", "longer run-in"),
    ("7", "drift, 2000 to 3000 s, % per 1000 s", "drift", 100, ".1f", "baseline not steady"),
    ("7", "… of heights / 10, not 0", None, 0, "", "heights / 10 not steady"),
    ("8", "inner less outer half, percentage points", "inner_over_outer", 100, ".1f", "fuller inside"),
    ("9", "half of the contact lies in spots below, µm", "contact_50", 1e6, ".0f", None),
    ("10", "mean pressure of the contact, MPa", "mean_pressure", 1e-6, ".2f", "higher pressure"),
    ("10", "coefficient of friction, 2700 to 3000 s", "friction", 1, ".4f", "higher friction"),
]


def table_claims() -> str:
    """The paper's claims, over sets of surfaces, and of the model itself where its runs have the number."""
    text = head(
        "claim", "measured, after 3000 s: baseline, heights / 10, heights / 100", f"local, m = {m_of('runs')}",
        f"local, m = {m_of('sets')}, {value('set_count/local')} sets", "holds in",
        f"pooled, m = {m_of('pooled-sets')}, {value('set_count/pooled')} sets", "holds in",
    )
    for number, name, key, factor, form, claim in ASKED:
        cells = [number, name]
        # Of the model itself: numbers, or whether it holds.
        alone = [] if key is None else [once("runs", heights, key) for heights in NAMES]
        if key == "contact_50":
            alone = [value(f"runs/{heights}/sizes/3000/pin_contact/50") for heights in NAMES]
        cells.append(", ".join(shown(one * factor, form) for one in alone) or yes(RESULTS["holds_once"][claim]["hits"]))
        for rule in ("local", "pooled"):
            if rule not in RESULTS["sets"]:
                cells += ["(not run)", ""]
                continue
            of = [] if key is None else [value(f"sets/{rule}/{heights}/{key}") for heights in NAMES]
            cells += [", ".join(with_interval(one, factor, form) for one in of), share(rule, claim) if claim else ""]
        text += row(*cells)
    return text


def yes(hits: int) -> str:
    """Whether a claim holds in the one set of the runs."""
    return "yes" if hits else "no"


# What the table of the runs tells of each, up to the contact area of the last tenth and from there on: name, factor, form, quantity.
FILLING = [
    ("filled, by volume, %", 100, ".1f", "filled"),
    ("filled, by area (within 0.1 µm), %", 100, ".1f", "filled_area"),
    ("disc, secondary (any film), %", 100, ".1f", "disc_secondary"),
    ("build-up on the disc, mean, µm", 1e6, ".2f", "mean_build_up"),
    ("highest above the highest of the start, µm", 1e6, ".2f", "highest"),
]
CONTACT = [
    ("contact area, last 100 s, mm²", 1e6, ".2f", "contact_area"),
    ("run-in: to 90 % of that, ± 25 s", 1, ".0f", "run_in"),
    ("run-in: change-point, s", 1, ".0f", "change_point"),
    ("drift in the last third, % per 1000 s", 100, ".2f", "drift"),
    ("± (95 %)", 100, ".2f", "drift_error"),
    ("pressure: Gini coefficient", 1, ".3f", "pressure_gini"),
    ("pressure: coefficient of variation", 1, ".2f", "pressure_variation"),
    ("pressure, mean, MPa", 1e-6, ".2f", "mean_pressure"),
    ("pin, secondary, %", 100, ".1f", "pin_covered"),
    ("pin, secondary that carries load, %", 100, ".1f", "pin_loaded"),
    ("build-up on the pin, mean, nm", 1e9, ".0f", "pin_film"),
    ("Sq of the fibres, nm", 1e9, ".0f", "sq_fibres"),
    ("Sq of the whole pin, µm", 1e6, ".2f", "sq_pin"),
    ("filling, inner less outer half, percentage points", 100, ".1f", "inner_over_outer"),
    ("deposited / worn, %", 100, ".1f", "deposited_over_worn"),
    ("worn / (κ × load × distance) − 1", 1, ".1e", "bookkeeping"),
    ("debris balance, largest residual", 1, ".1e", "balance_residual"),
]


def table_runs() -> str:
    """The runs of one set of surfaces, local and pooled."""
    locals_, pooled = [("runs", heights, "3000") for heights in NAMES], [("pooled_runs", heights, "3000") for heights in NAMES]
    columns = [*locals_, ("runs", "1", "7200"), *pooled]
    if "7200" not in value("runs/1/history"):
        columns.remove(("runs", "1", "7200"))
    text = head("at the end", *(
        f"{'local' if part == 'runs' else 'pooled'}: {NAMES[heights]}, {end} s, m = {m_of_one(part, heights)}"
        for part, heights, end in columns
    ))

    def lines(asked: list[tuple[str, float, str, str]]) -> str:
        text = ""
        for name, factor, form, key in asked:
            found = [once(part, heights, key, end) for part, heights, end in columns]
            text += row(name, *("" if one is None else shown(one * factor, form) for one in found))
        return text

    area = row("contact area, last tenth ± standard error, mm²",
               *(last_tenth(heights, float(end), part) for part, heights, end in columns))
    return text + lines(FILLING) + area + lines(CONTACT)


def table_error() -> str:
    """The acceleration of the sets and the model itself, on the same surfaces."""
    found = value("exactness")
    text = head("the same surfaces", *(
        f"{NAMES[heights]}, at {of['until']:.0f} s: m = " + ", ".join(f"{m:g}" for m in of["numbers"]["acceleration"])
        for heights, of in found.items()
    ))
    asked = {key: (name, factor, form) for _, name, key, factor, form, _ in ASKED if key}
    asked["drift"] = ("drift in the last third, % per 1000 s", 100, ".1f")
    asked["contact_area_mean"] = ("contact area, last tenth, mm²", 1e6, ".2f")
    asked["friction"] = ("coefficient of friction, last tenth", 1, ".4f")
    for key, (name, factor, form) in asked.items():
        if any(key in of["numbers"] for of in found.values()):
            pairs = [of["numbers"].get(key, []) for of in found.values()]
            text += row(name, *(", ".join(shown(one * factor, form) for one in pair) for pair in pairs))
    text += row("contact area over windows of 100 s, root mean square difference, %", *(shown(of["mean"] * 100, ".2f") for of in found.values()))
    text += row("… largest difference, %", *(shown(of["worst"] * 100, ".2f") for of in found.values()))
    return text


def table_starts() -> str:
    """The first 100 s with several accelerations."""
    text = head("after 100 s", "m", "contact area, 50 to 100 s, mm²", "filled, %", "disc, secondary, %")
    for heights, runs in value("starts").items():
        for one in runs:
            text += row(NAMES[heights], f"{one['acceleration']:g}", shown(one["contact_area"] * 1e6, ".2f"),
                        shown(one["filled_fraction"] * 100, ".2f"), shown(one["disc_secondary"] * 100, ".1f"))
    return text


def table_history() -> str:
    """Filling at the times of the maps."""
    times = list(value("runs/1/disc"))
    text = head("filled, by volume, %", *(f"{time} s" for time in times))
    for part, rule in (("runs", "local"), ("pooled_runs", "pooled")):
        for heights, name in NAMES.items():
            found = value(f"{part}/{heights}/disc")
            text += row(f"{rule}: {name}, m = {m_of_one(part, heights)}", *(shown(found[time]["filled"] * 100, ".1f") if time in found else "" for time in times))
    return text


def table_sizes() -> str:
    """Sizes of plateaus."""
    text = head("diameter, µm, of what holds 10, 50, 90 % of the area (number)",
                *(f"{name}, m = {m_of_one('runs', heights)}" for heights, name in NAMES.items()))
    names = {
        "pin_contact": "pin, in contact",
        "pin_plateaus": "pin, primary and secondary",
        "pin_thick": "pin, build-up of 0.1 µm and more",
        "disc_secondary": "disc, secondary",
        "disc_holes": "disc, holes deeper than 1 µm",
    }
    for key, name in names.items():
        cells = []
        for heights in NAMES:
            found = value(f"runs/{heights}/sizes/3000/{key}")
            cells.append(", ".join(shown(found[p] * 1e6, ".0f") for p in ("10", "50", "90")) + f" ({found['count']})"
                         if found["count"] else "none")
        text += row(name, *cells)
    return text


def table_round_pin() -> str:
    """The rig's round pin and the paper's patch."""
    numbers = {
        "contact area, mm²": ("contact_area_mean", 1e6, ".2f"),
        "part of the pin in contact, %": ("contact_fraction", 100, ".1f"),
        "mean pressure of the contact, MPa": ("mean_pressure", 1e-6, ".2f"),
        "Gini coefficient of the pressure": ("pressure_gini", 1, ".3f"),
        "filled, %": ("filled", 100, ".1f"),
        "disc, secondary, %": ("disc_secondary", 100, ".1f"),
        "pin, secondary, %": ("pin_secondary", 100, ".1f"),
        "run-in, s": ("run_in", 1, ".0f"),
    }
    pins = {"round": "round", "patch": "4 × 8 mm"}
    text = head("", *(f"{name}, {pin}" for name in NAMES.values() for pin in pins.values()))
    for name, (key, factor, form) in numbers.items():
        found = [value(f"round_pin/{pin}/{heights}/{key}") for heights in NAMES for pin in pins]
        text += row(name, *(with_interval(pair, factor, form) for pair in found))
    return text


def of_choices(part: str) -> str:
    """The numbers of some choices."""
    names = list(value(f"{part}/means")) if value(part) else []
    text = head(
        f"m = {m_of('variants')} unless it says otherwise", "filled, %", "disc, secondary, %", "contact area, mm²", "run-in, s", "Gini coefficient",
    )
    for name in names:
        means = value(f"{part}/means/{name}")
        text += row(name, *(
            ", ".join(with_interval(means[heights][key], factor, form) for heights in NAMES)
            for key, factor, form in (("filled", 100, ".1f"), ("disc_secondary", 100, ".0f"),
                                      ("contact_area_mean", 1e6, ".2f"), ("run_in", 1, ".0f"), ("pressure_gini", 1, ".3f"))
        ))
    return text


def table_variants() -> str:
    """Choices that scenes have."""
    return of_choices("variants")


def table_readings() -> str:
    """Readings that no scene has."""
    return of_choices("readings")


def table_conclusions() -> str:
    """In how many sets of surfaces every claim holds."""
    of_scenes, of_readings = (value(part).get("holds", {}) for part in ("variants", "readings"))
    if not of_scenes:
        return "(not run)"
    asked = [claim for claim in of_scenes["default"] if claim != "heights / 10 not steady"]
    text = head("holds in so many of three sets", *asked)
    others = {name: counts for name, counts in of_readings.items() if name not in of_scenes and name != "the rule as it stands"}
    for name, counts in (of_scenes | others).items():
        text += row(name, *(str(counts[claim]["hits"]) for claim in asked))
    return text


def table_symmetry() -> str:
    """The same surfaces seen otherwise."""
    text = head("surfaces", "filled, %", "contact area, 2700 to 3000 s, mm²", "run-in, s", "Gini coefficient of the pressure")
    for name, found in value("symmetry").items():
        text += row(
            name.replace("-", " "), shown(found["filled"] * 100, ".2f"), shown(found["contact_area_mean"] * 1e6, ".3f"),
            shown(found["run_in"], ".0f"), shown(found["pressure_gini"], ".3f"),
        )
    return text
