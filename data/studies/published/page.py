"""Writes docs/evidence/published.md, of published.md.in and results.json.

usage: page.py [--check]: with --check only says whether they agree, as exit status

In the template `{{plain SIGN WHERE}}` and `{{strength SIGN WHERE}}` are a difference with its interval, by the plain rule and with a strength, and
whether it has the sign that was published, + or -, or ? where none was. WHERE is `factors/effects/RESPONSE/FACTOR` or
`skewness/differences/RESPONSE/PAIR` in results.json. `{{table of_skewness}}`, `{{table of_factors}}` and `{{changed}}`, the signs that change with a
strength, are functions of this file.
"""

import json
import math
import re
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
PAGE = HERE.parents[2] / "docs/evidence/published.md"
RESULTS = json.loads((HERE / "results.json").read_text())

# How a response is shown: its name in tables, the unit of differences, what they are multiplied by, format. Logarithms become per cent.
SHOWN = {
    "coefficient of friction": ("friction", "", 1.0, ".3f"),
    "contact area": ("contact area", "%", None, ".1f"),
    "filled": ("filled", "points", 100.0, ".1f"),
    "lost by the pin": ("lost by the pin", "%", None, ".1f"),
    "PM10": ("PM10", "%", None, ".1f"),
}


def at(where: str, rule: str = "plain") -> Any:
    """What is at a path of keys in results.json, such as a value and the ends of its interval."""
    found: Any = RESULTS[rule]
    for key in where.split("/"):
        found = found[key]
    return found


def change(where: str, rule: str = "plain") -> str:
    """A difference ± half of its interval."""
    _, _, factor, form = SHOWN[where.split("/")[2]]
    value, low, high = (100.0 * math.expm1(one) if factor is None else factor * one for one in at(where, rule))
    return f"{value:+{form}} ± {(high - low) / 2:{form}}".replace("-", "−")


def sign(found: list[float]) -> int:
    """The sign of a difference, 0 where its interval has both."""
    _, low, high = found
    return (low > 0.0) - (high < 0.0)


def judged(published: str, where: str, rule: str) -> str:
    """A difference, and whether it has the sign that was published."""
    said = f"{change(where, rule)} {SHOWN[where.split('/')[2]][1]}".rstrip()
    if published == "?":
        return said
    return f"{said}, " + {0: "not resolved", int(f"{published}1"): "agrees"}.get(sign(at(where, rule)), "**does not agree**")


def row(*cells: str) -> str:
    """A line of a table."""
    return "| " + " | ".join(cells) + " |\n"


def of_skewness() -> str:
    """Means of discs of every skewness, with peaks and cut."""
    forms = {"coefficient of friction": (1.0, ".3f"), "filled": (100.0, ".0f"), "lost by the pin": (1e9, ".2f"), "PM10": (1e9, ".0f")}
    text = row("skewness", "heights", "friction", "filled, %", "lost by the pin, mm³", "PM10, µg") + "|---|---|---|---|---|---|\n"
    for cut, name in {"none": "as they are", "3 um": "cut at 3 µm"}.items():
        for skewness in ("-1", "0", "1"):
            cells = []
            for response, (factor, form) in forms.items():
                ends = at(f"skewness/means/{response}/{skewness}, {cut}")
                value, low, high = (factor * (math.exp(one) if SHOWN[response][2] is None else one) for one in ends)
                cells.append(f"{value:{form}} ± {(high - low) / 2:{form}}")
            text += row(skewness.replace("-", "−"), name, *cells)
    return text


def of_factors() -> str:
    """What twice of each factor does to each response."""
    text = row("twice the", *(f"{name}, {unit}".rstrip(", ") for name, unit, _, _ in SHOWN.values())) + "|" + "---|" * (1 + len(SHOWN)) + "\n"
    for factor in at("factors/effects/PM10"):
        text += row(factor, *(change(f"factors/effects/{response}/{factor}") for response in SHOWN))
    return text


def changed() -> str:
    """Which differences have one sign by the plain rule and the other with a strength."""
    places = {(factor, response): f"factors/effects/{response}/{factor}" for factor in at("factors/effects/PM10") for response in SHOWN}
    places |= {("skewness", response): f"skewness/differences/{response}/1 less -1" for response in SHOWN}
    found: dict[str, list[str]] = {}
    for (factor, response), where in places.items():
        if sign(at(where)) * sign(at(where, "strength")) < 0:
            found.setdefault(factor, []).append(SHOWN[response][0])
    said = "; ".join(f"{factor} ({', '.join(responses)})" for factor, responses in found.items())
    return f"{sum(map(len, found.values()))} of {len(places)}" + (f": {said}" if said else "")


def page() -> str:
    """The page with its numbers."""

    def one(match: re.Match[str]) -> str:
        what, _, rest = match.group(1).partition(" ")
        if what == "table":
            return {"of_skewness": of_skewness, "of_factors": of_factors}[rest]().rstrip("\n")
        if what == "changed":
            return changed()
        published, where = rest.split(" ", 1)
        return judged(published, where, what)

    return re.sub(r"\{\{(.+?)\}\}", one, (HERE / "published.md.in").read_text())


def main() -> int:
    text = page()
    if "--check" not in sys.argv[1:]:
        PAGE.write_text(text)
    elif not PAGE.exists() or PAGE.read_text() != text:
        print(f"{PAGE.name} and data/studies/published/results.json disagree: page.py writes it anew")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
