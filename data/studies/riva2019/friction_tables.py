"""The tables of friction, from results.json."""

import numpy as np
from discs import NAMES
from tables import head, m_of, row, shown, value, with_interval

# The pin's part of the paper's ring, m2.
PATCH = np.pi * (24e-3**2 - 20e-3**2) * 161 / 2764
BETWEEN = "heights / 100 less baseline"


def three(found: dict[str, list[float]], form: str = ".4f") -> str:
    """Of the three discs the mean and its interval."""
    return ", ".join(with_interval(found[heights], 1, form) for heights in NAMES)


def counted(order: dict[str, float]) -> str:
    """In how many sets all three discs are in order."""
    return str(order["hits"])


def apart(compared: dict[str, object]) -> str:
    """What the smoothest disc has more than the roughest."""
    return with_interval(compared["between"]["0.01 less 1"], 1, ".4f")


def table_friction() -> str:
    """Friction of the three discs over time."""
    friction = value("friction")
    text = head(f"μ, m = {m_of('sets')}", "baseline, heights / 10, heights / 100", BETWEEN, f"in order in, of {value('set_count/local')}")
    for window in ("0 to 100 s", "2700 to 3000 s"):
        found = friction["local"]["windows"][window]
        text += row(window, three(found["discs"]), apart(found), counted(found["order"]))
    return text


def table_friction_loads() -> str:
    """Friction under other loads."""
    text = head(f"load on the paper's patch; m = {m_of('variants')}", "μ, 2700 to 3000 s", BETWEEN, "in order in, of 3")
    for load, found in value("friction/loads").items():
        text += row(f"{load} N, {shown(float(load) / PATCH * 1e-6, '.2f')} MPa", three(found["discs"], ".3f"), apart(found), counted(found["order"]))
    return text
