"""The tables of friction, from results.json."""

import numpy as np
from discs import NAMES
from tables import head, m_of, row, shown, value, with_interval

# The pin's part of the paper's ring, m2.
PATCH = np.pi * (24e-3**2 - 20e-3**2) * 161 / 2764
# The law's numbers as documents have them: sign, factor, form, unit.
SIGNS = {
    "pressure_coefficient": ("α", 1, ".3f", ""), "shear_strength": ("τ₀", 1e-6, ".3f", " MPa"),
    "maximum": ("μ_max", 1, ".1f", ""),
}
BETWEEN = "heights / 100 less baseline"


def three(found: dict[str, list[float]], form: str = ".4f", factor: float = 1) -> str:
    """Of the three discs the mean and its interval."""
    return ", ".join(with_interval(found[heights], factor, form) for heights in NAMES)


def counted(order: dict[str, float]) -> str:
    """In how many sets all three discs are in order."""
    return f"{order['hits']} of {order['of']}"


def apart(compared: dict[str, object]) -> str:
    """What the smoothest disc has more than the roughest."""
    return with_interval(compared["between"]["0.01 less 1"], 1, ".4f")


def table_friction() -> str:
    """Friction of the three discs over time, with both rules."""
    friction, rules = value("friction"), {"local": "sets", "pooled": "pooled-sets"}
    text = head(
        "μ: baseline, heights / 10, heights / 100", f"local, m = {m_of('runs')}", "pooled, m = 1",
        *(cell for rule, part in rules.items() for cell in (f"{rule}, m = {m_of(part)}", BETWEEN, "in order in")),
    )
    windows = friction["runs"]["windows"]
    for window, of_runs in windows.items():
        pooled = friction["pooled_runs"]["windows"].get(window)
        cells = [window, *(", ".join(shown(of[heights], ".4f") for heights in NAMES) if of else "" for of in (of_runs, pooled))]
        for rule in rules:
            found = friction.get(rule, {"windows": {}})["windows"].get(window)
            cells += [three(found["discs"]), apart(found), counted(found["order"])] if found else ["", "", ""]
        text += row(*cells)
    cells = ["the last less the first 100 s"]
    for part in ("runs", "pooled_runs"):
        first, last = (friction[part]["windows"][window] for window in ("0 to 100 s", "2700 to 3000 s"))
        cells.append(", ".join(shown(last[heights] - first[heights], ".4f") for heights in NAMES))
    for rule in rules:
        cells += [three(friction[rule]["run_in"]) if rule in friction else "", "", ""]
    return text + row(*cells)


def table_friction_loads() -> str:
    """Friction under other loads."""
    text = head(
        f"load on the paper's patch, nominal pressure; m = {m_of('variants')}", "μ, 2700 to 3000 s", BETWEEN, "in order in",
        "without ceiling", BETWEEN, "contact area, mm²",
    )
    for load, found in value("friction/loads").items():
        free = found["without_ceiling"]
        text += row(
            f"{load} N, {shown(float(load) / PATCH * 1e-6, '.2f')} MPa", three(found["discs"], ".3f"), apart(found), counted(found["order"]),
            three(free["discs"], ".3f"), apart(free), three(found["contact_area"], ".2f", 1e6),
        )
    return text


def named(name: str, changed: object) -> str:
    """What was changed in the law, as documents have it."""
    if changed is None:
        return name
    sign, factor, form, unit = SIGNS[name.rsplit(" ", 1)[0]]
    return f"{sign} = {shown(changed * factor, form)}{unit}"


def table_friction_choices() -> str:
    """Friction with other numbers in its law."""
    text = head(f"changed; local, m = {m_of('sets')}", "μ, 2700 to 3000 s", BETWEEN, "in order in", f"without ceiling: {BETWEEN}")
    for name, found in value("friction/choices").items():
        text += row(named(name, found["value"]), three(found["discs"]), apart(found), counted(found["order"]), apart(found["without_ceiling"]))
    return text
