"""Writes the numbers of results.json into documents: docs/validation.md and the first screen of README.md.

usage: write_docs.py [--check]: with --check only says whether they agree, as exit status

Templates have `{{path}}`, `{{path|format}}` and `{{path|factor|format}}`: a path in results.json, a factor and a Python
format; with `*` in the path for the three discs, one after the other. `{{table NAME}}` is one of tables.py, `{{m runs}}` the
time acceleration of a part of the study, `{{holds RULE CLAIM}}` in how many sets a claim holds, and `{{last tenth HEIGHTS END}}`
the mean contact area of a run at m = 1 over the last tenth of the time to its end, mm².
"""

import re
import sys
import tomllib
from pathlib import Path

import tables
from discs import NAMES, SCENES
from make_points import DEFAULT
from tables import last_tenth, share, told, value

HERE = Path(__file__).parent
ROOT = HERE.parents[2]
MARKS = "<!-- found by data/studies/riva2019 -->\n", "<!-- end of what was found -->\n"


def acceleration(scene: Path) -> float:
    """The time acceleration of a scene, or of the one that it extends."""
    found = tomllib.loads(scene.read_text())
    given = found.get("numerics", {}).get("time_acceleration")
    return acceleration(scene.parent / found["extends"]) if given is None else float(given)


def accelerations() -> dict[str, float]:
    """The time acceleration of every part of the study: numbers of different ones are not compared."""
    of_runs = {acceleration(HERE / f"{scene}.toml") for scene in [*SCENES.values(), "pooled"]}
    assert len(of_runs) == 1, f"the runs have accelerations {of_runs}"
    others = {name: acceleration(HERE / f"{name}.toml") for name in ("sets", "symmetry")}
    # Tables have it in their heads.
    assert others["sets"] == float(DEFAULT["time acceleration"]) == acceleration(HERE / "reduced.toml") == 100
    return {"runs": of_runs.pop(), "variants": float(DEFAULT["time acceleration"])} | others


def one_of(path: str, factor: float, form: str | None) -> str:
    """What a template has a path for."""
    if form is None:
        return str(value(path))
    if "*" in path:
        return ", ".join(told(value(path.replace("*", heights)), factor, form) for heights in NAMES)
    return told(value(path), factor, form)


def filled_in(template: str) -> str:
    """A template with its numbers."""
    def one(match: re.Match) -> str:
        what = match.group(1)
        if what.startswith("table "):
            return getattr(tables, "table_" + what.removeprefix("table "))().rstrip("\n")
        if what.startswith("m "):
            return f"{accelerations()[what.removeprefix('m ')]:g}"
        if what.startswith("last tenth "):
            heights, end = what.removeprefix("last tenth ").split()
            return last_tenth(heights, float(end))
        if what.startswith("holds "):
            return share(*what.removeprefix("holds ").split(" ", 1))
        path, *rest = what.split("|")
        return one_of(path, float(rest[0]) if len(rest) == 2 else 1.0, rest[-1] if rest else None)

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
