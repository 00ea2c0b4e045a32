"""Writes the numbers of results.json, strength.json and mesh.json into documents: docs/evidence/validation.md, mesh.md and the first
screen of README.md.

usage: write_docs.py [--check]: with --check only says whether they agree, as exit status

Templates have `{{path}}`, `{{path|format}}` and `{{path|factor|format}}`: a path in results.json, a factor and a Python format; with `*` in
the path for the three discs, one after the other. `{{table NAME ARGUMENT...}}` is one of tables.py, friction_tables.py or
strength_tables.py, `{{m runs}}` the time acceleration of a part of the study; `{{change LENGTH HEIGHTS HALVING QUANTITY}}` is one of the
mesh, `{{ratios LENGTH QUANTITY}}` those of the rough disc to the smoothest; `{{last tenth HEIGHTS END}}` is the mean contact area of a run
at m = 1 over the last tenth of the time to its end, mm². `{{PATH minus PATH|...}}` and `{{PATH relative to PATH|...}}` compare two;
`{{largest PATTERN|...}}` and `{{smallest PATTERN|...}}` are of the sizes of all numbers at paths with `*`. `{{wilson HITS OF}}` is an
interval of a share, `{{runs of STUDY...}}` a number of runs, `{{wear from 0 STRENGTH HEIGHTS}}` wear of the first 300 s and of the last.
"""

import re
import sys
from collections.abc import Callable
from pathlib import Path

import friction_tables
import strength_tables
import tables
from discs import NAMES
from tables import compared, every, last_tenth, m_of, runs_of, share_left, shown, told, value

HERE = Path(__file__).parent
ROOT = HERE.parents[2]
MARKS = "<!-- found by data/studies/riva2019 -->\n", "<!-- end of what was found -->\n"


#: Words of templates, each with the function that takes what stands behind it.
WORDS: dict[str, Callable[..., object]] = {
    "m ": m_of,
    "change ": strength_tables.change,
    "ratios ": strength_tables.ratios,
    "wilson ": share_left,
    "runs of ": runs_of,
    "wear from 0 ": strength_tables.wear_from_the_start,
    "last tenth ": lambda heights, end: last_tenth(heights, float(end)),
}


def one_of(path: str, factor: float, form: str | None) -> str:
    """What a template has a path for."""
    if form is None:
        return str(value(path))
    if " minus " in path or " relative to " in path:
        return shown(compared(path) * factor, form)
    for word, of in {"largest ": max, "smallest ": min}.items():
        if path.startswith(word):
            return shown(of(every(path.removeprefix(word))) * factor, form)
    if "*" in path:
        return ", ".join(told(value(path.replace("*", heights)), factor, form) for heights in NAMES)
    return told(value(path), factor, form)


def filled_in(template: str) -> str:
    """A template with its numbers."""

    def one(match: re.Match) -> str:
        what = match.group(1)
        if what.startswith("table "):
            name, *arguments = what.removeprefix("table ").split()
            module = next(of for of in (friction_tables, strength_tables, tables) if hasattr(of, f"table_{name}"))
            return getattr(module, f"table_{name}")(*arguments).rstrip("\n")
        for word, of in WORDS.items():
            if what.startswith(word):
                return str(of(*what.removeprefix(word).split()))
        path, *rest = what.split("|")
        try:
            return one_of(path, float(rest[0]) if len(rest) == 2 else 1.0, rest[-1] if rest else None)
        except KeyError:
            # Of a study that is not complete.
            print(f"results.json has no {path}", file=sys.stderr)
            return "(not run)"

    return re.sub(r"\{\{(.+?)\}\}", one, template)


def documents() -> dict[Path, str]:
    """Every document with its numbers."""
    readme = ROOT / "README.md"
    before, rest = readme.read_text().split(MARKS[0])
    after = rest.split(MARKS[1])[1]
    found = filled_in((HERE / "readme.md.in").read_text())
    return {
        ROOT / "docs/evidence/validation.md": filled_in((HERE / "validation.md.in").read_text()),
        ROOT / "docs/evidence/mesh.md": filled_in((HERE.parent / "mesh/mesh.md.in").read_text()),
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
