"""The tables of strength, levels and what the paper does not give, from strength.json, and of the mesh, from mesh.json."""

import itertools
import json
from collections.abc import Iterable
from pathlib import Path

from discs import NAMES
from make_points import DEFAULT
from strength import FIRST, WHILE
from tables import ASKED, RESULTS, head, row, shown, value, with_interval

HERE = Path(__file__).parent
RESULTS |= {"strength": json.loads((HERE / "strength.json").read_text()), "mesh": json.loads((HERE.parent / "mesh/mesh.json").read_text())}
#: No strength is asked for as one that nothing reaches.
NONE = 1e12

#: What tables of strengths have of each disc: heading, key, factor, form.
OF_STRENGTHS = [
    ("filled, %", "filled", 100, ".1f"),
    ("pin, secondary, %", "pin_secondary", 100, ".1f"),
    ("area, mm²", "contact_area_mean", 1e6, ".2f"),
    ("run-in, s", "run_in", 1, ".0f"),
    ("wear at first", "first_wear", 1e13, ".2f"),
    ("… at the end", "wear", 1e13, ".2f"),
    ("emitted, mm³", "emitted", 1e9, ".2f"),
]
#: Claims of strength.py, in the words of the table.
CLAIMS = {
    "filled as in the paper": "1, near the paper's",
    "less on the rough disc": "2, against both",
    "more, the smoother the disc": "2, strict order",
    "less on the rough disc's pin": "3, by status, against both",
    "more on the pin, the smoother the disc": "3, strict order",
    "more even pressure": "5, against both",
    "more even, the smoother the disc": "5, strict order",
    "lower contact area": "6, against both",
    "larger area, the smoother the disc": "6, strict order",
    "longer run-in": "7, run-in, strict order",
    "heights / 10 not steady": "7, heights / 10 not steady",
    "wears more on the rough disc": "rough disc wears more than both",
    "wear falls": "wear falls, rough disc",
    "wear falls, heights / 10": "wear falls, heights / 10",
    "wear falls, heights / 100": "wear falls, heights / 100",
    "emits more on the rough disc": "rough disc emits more than both",
}


def named(strength: str) -> str:
    """A strength as tables have it."""
    return "none" if float(strength) >= NONE else f"{float(strength) / 1e6:g} MPa"


def strengths(part: str = "strengths") -> dict[str, dict]:
    """What was found of every strength, the lowest first."""
    return dict(sorted(value(f"strength/{part}").items(), key=lambda one: float(one[0])))


def table_means(part: str, *keys: str) -> str:
    """Means over sets of surfaces of the three discs after 3000 s with every strength, and the widest of their intervals."""
    found, asked = strengths(part), [one for one in OF_STRENGTHS if one[1] in keys]
    text = head("strength", *(heading for heading, *_ in asked))
    for strength, of in found.items():
        cells = (", ".join(shown(of["means"][heights][key][0] * factor, form) for heights in NAMES) for _, key, factor, form in asked)
        text += row(named(strength), *cells)
    half = (max(of["means"][heights][key][1] for of in found.values() for heights in NAMES) * factor for _, key, factor, _ in asked)
    return text + row("± at most", *(shown(one, form) for one, (*_, form) in zip(half, asked, strict=True)))


def from_the_start(first_wear: float) -> float:
    """Specific wear of the pin from 0 s on, 1/Pa, from that which begins with the first sample: until then only fibres wear."""
    fibres = float(DEFAULT["wear rate"].split()[0])
    return (fibres * FIRST + first_wear * (WHILE - FIRST)) / WHILE


def wear_from_the_start(strength: str, heights: str) -> str:
    """The same of a strength, in MPa, and a disc, 1e-13 1/Pa, and the wear at the end."""
    of = value(f"strength/strengths/{float(strength) * 1e6}/means/{heights}")
    return " to ".join(shown(wear * 1e13, ".2f") for wear in (from_the_start(of["first_wear"][0]), of["wear"][0]))


def table_strength_claims() -> str:
    """In how many sets of surfaces each claim holds with each strength; below the table those that hold in as many with every strength."""
    counted = {words: [of["holds"][claim][0] for of in strengths().values()] for claim, words in CLAIMS.items()}
    late = "wears more on the rough disc"
    text = head("holds in so many of ten sets (*against both*: the rough disc)", *map(named, strengths()))
    alike: dict[int, list[str]] = {}
    for words, counts in counted.items():
        if len(set(counts)) == 1:
            alike.setdefault(counts[0], []).append(words)
        else:
            text += row(words, *map(str, counts))
        if words == CLAIMS[late]:
            text += row("… after 7200 s", *(str(of["holds"][late][0]) for of in strengths("late").values()))
    told = " ".join(f"In {count}: {'; '.join(claims)}." for count, claims in sorted(alike.items(), reverse=True))
    return f"{text}\nAlike with every strength and with none. {told}\n"


def table_levels() -> str:
    """Contact area at the end of long runs, by the wear rate of the disc's build-up."""
    text = head("wear, 1/Pa", "area of the last tenth, mm²", "filled, %")
    found = {"plain rule": list(value("strength/levels").values())[-1]}
    found |= {shown(float(rate), "g"): of["means"] for rate, of in sorted(value("strength/steady").items(), key=lambda one: float(one[0]))}
    quantities = (("contact_area_mean", 1e6, ".2f"), ("filled", 100, ".1f"))
    for name, discs in found.items():
        text += row(name, *(", ".join(shown(discs[of][key][0] * factor, form) for of in NAMES) for key, factor, form in quantities))
    widest = (max(discs[of][key][1] for discs in found.values() for of in NAMES) * factor for key, factor, _ in quantities)
    return text + row("± at most", *(shown(one, form) for one, (*_, form) in zip(widest, quantities, strict=True)))


def table_unknowns() -> str:
    """Filling with other correlation lengths and fibre fractions, set by set."""
    text = head("correlation length, fibre fraction: filled in three sets, %", *NAMES.values())
    for name, discs in value("strength/unknowns").items():
        text += row(name, *(", ".join(shown(100 * one, ".0f") for one in discs[heights]) for heights in NAMES))
    return text


#: What is told of the paper's pin with and without a strength, of what tables.py asks of sets.
OF_FULL = ("filled", "disc_secondary", "pin_covered", "sq_fibres", "pressure_gini", "contact_area_mean", "run_in")


def with_widest(found: list[list[float]], factor: float, form: str) -> str:
    """Means of the three discs ± the widest of their intervals."""
    means = ", ".join(shown(mean * factor, form) for mean, _ in found)
    return f"{means} (± {shown(max(half for _, half in found) * factor, form)})"


def table_full() -> str:
    """The paper's pin with a transport length, with and without a strength: means, and in how many sets the order is strict."""
    kinds = {"length": "no strength", "strength": "5 MPa"}
    sets = value("strength/full/strength/sets")
    text = head("claim", f"measured, {sets} sets", *(cell for name in kinds.values() for cell in (name, "in order in")))
    for number, words, key, factor, form, claim in (one for one in ASKED if one[2] in OF_FULL):
        cells = []
        for kind in kinds:
            found = value(f"strength/full/{kind}")
            cells += [with_widest([found["means"][heights][key] for heights in NAMES], factor, form), str(found["holds"][claim]["hits"])]
        text += row(number, words, *cells)
    late = [with_widest([value(f"strength/full/{kind}/late/{heights}/filled") for heights in NAMES], 100, ".1f") for kind in kinds]
    return text + row("", "filled after 7200 s, %", late[0], "", late[1], "")


#: Quantities of the mesh: heading, key, factor, form.
OF_MESH = [
    ("filled, %", "filled", 100, ".1f"),
    ("contact ratio, %", "contact_ratio", 100, ".1f"),
    ("run-in, s", "run_in", 1, ".0f"),
    ("pin, secondary, %", "pin_secondary", 100, ".1f"),
    ("Gini", "pressure_gini", 1, ".3f"),
]
CELLS = ("100", "50", "25", "12.5")


def with_error(found: list[float] | None, factor: float, form: str) -> str:
    """Mean ± standard error; nothing where there is none."""
    return with_interval(found[:2], factor, form) if found else ""


def change(length: str, heights: str, *what: str) -> str:
    """A change by a halving of the cell, such as `50 to 25 filled`, with its sign."""
    *halving, key = what
    found = value(f"mesh/changes/{length}/{heights}/{' '.join(halving)}/{key}")
    return f"{shown(100 * found[0], '+.1f')} ± {shown(100 * found[1], '.1f')} %"


def ratios(rule: str, key: str) -> str:
    """A quantity of the rough disc over that of heights / 100, for every cell from 50 um down."""
    rough, smooth = (value(f"mesh/values/{rule}/{heights}") for heights in ("1", "0.01"))
    return ", ".join(shown(rough[cell][key][0] / smooth[cell][key][0], ".2f") for cell in CELLS[1:])


def table_lengths() -> str:
    """Filling with every rule on the mesh of 25 um."""
    text = head("filled, %, cells of 25 µm", *NAMES.values())
    names = {"200": "200 µm", "150": "150 µm", "100": "100 µm", "none": "one cell"}
    for length, name in names.items():
        text += row(name, *(with_error(value(f"mesh/values/{length}/{heights}/25/filled"), 100, ".1f") for heights in NAMES))
    return text


def table_mesh(length: str, *keys: str, discs: Iterable[str] = NAMES) -> str:
    """Quantities on every mesh, and their change by the last halvings, with one transport length or the plain rule."""
    cells = [cell for cell in CELLS if cell in value(f"mesh/values/{length}/1")]
    halvings = [f"{coarse} to {fine}" for coarse, fine in itertools.pairwise(cells)]
    text = head("quantity", "disc", *(f"{cell} µm" for cell in cells), *(f"{halving} µm, %" for halving in halvings[-2:]))
    for heading, key, factor, form in OF_MESH:
        for heights in discs if key in keys else ():
            of = value(f"mesh/values/{length}/{heights}")
            changes = value(f"mesh/changes/{length}/{heights}")
            values = (with_error(of.get(cell, {}).get(key), factor, form) for cell in cells)
            text += row(heading, NAMES[heights], *values, *(with_error(changes.get(halving, {}).get(key), 100, ".1f") for halving in halvings[-2:]))
    return text


def table_mesh_rough(length: str, *keys: str) -> str:
    """The same for the rough disc alone."""
    return table_mesh(length, *keys, discs=["1"])


def table_halvings(*lengths: str) -> str:
    """Change of the filling by the last halvings of the cell with some transport lengths."""
    halvings = ("50 to 25", "25 to 12.5")
    text = head("length", "disc", *(f"{halving} µm, %" for halving in halvings))
    for length in lengths:
        for heights, name in NAMES.items():
            changes = value(f"mesh/changes/{length}/{heights}")
            text += row(f"{length} µm", name, *(with_error(changes[halving]["filled"], 100, ".1f") for halving in halvings))
    return text


def table_mesh_acceleration(rule: str) -> str:
    """What the time acceleration of 100 does."""
    names = {key: heading.split(",")[0] for heading, key, *_ in OF_MESH}
    text = head("m = 100 instead of 1, one set, change in %", *names.values())
    for heights, name in NAMES.items():
        change = value(f"mesh/acceleration/{rule}/{heights}")
        text += row(name, *(with_error(change[key], 100, ".1f") for key in names))
    return text
