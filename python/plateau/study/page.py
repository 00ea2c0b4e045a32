"""Pages for the browser: tables and figures in one file, without scripts, for a screen in light or dark and for paper."""

import re
from collections.abc import Mapping, Sequence
from html import escape
from string import Template
from typing import TYPE_CHECKING, Any

from plateau.study.figures import file_names

if TYPE_CHECKING:
    import pandas

    from plateau.study.analysis import Effects
    from plateau.study.scene_comparison import Comparison

PAGE = Template("""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'">
<title>$title</title>
<style>
:root { color-scheme: light dark; --text: #1c1c1c; --ground: #ffffff; --quiet: #6b6b6b; --line: #d8d8d8 }
@media (prefers-color-scheme: dark) { :root { --text: #e8e8e8; --ground: #16181b; --quiet: #a5a5a5; --line: #3c3f44 } }
body { margin: 2rem auto; padding: 0 1rem; max-width: 60rem; font: 16px/1.5 system-ui, sans-serif; color: var(--text); background: var(--ground) }
h1 { font-size: 1.6rem } h2 { font-size: 1.25rem; margin-top: 2.5rem; border-bottom: 1px solid var(--line) }
.wide { overflow-x: auto }
table { border-collapse: collapse; font-size: .875rem; font-variant-numeric: tabular-nums }
th, td { padding: .2rem .5rem; text-align: right; border-bottom: 1px solid var(--line); white-space: nowrap }
th:first-child, td:first-child, .words td, .words th { text-align: left }
pre { white-space: pre-wrap; font-size: .8125rem }
figure { margin: 1.5rem 0; break-inside: avoid }
figure svg { max-width: 100%; height: auto; background: #ffffff }
figcaption, .quiet { color: var(--quiet); font-size: .875rem }
@media print { body { max-width: none; margin: 0; font-size: 10pt; color: #000000; background: #ffffff } h2, tr { break-after: avoid } }
</style>
</head>
<body>
<h1>$title</h1>
$body
</body>
</html>
""")
NOTE = (
    "Differences are means over pairs of runs with the same seed, with t intervals ({level}); with more than two scenes, intervals and sureness hold for "
    "all differences of a response together (Bonferroni). Sure at: 1 − p/2, how sure the sign is."
)


def page(title: str, *parts: str) -> str:
    """A page of parts in HTML; the title is plain text."""
    return PAGE.substitute(title=escape(title), body="\n".join(parts))


def listed(items: Sequence[str]) -> str:
    """A list of plain texts."""
    return "<ul>" + "".join(f"<li>{escape(item)}</li>" for item in items) + "</ul>" if items else ""


def table(heads: Sequence[str], rows: Sequence[Sequence[str]], kind: str = "numbers") -> str:
    """A table of plain texts."""
    cells = [
        f"<tr>{''.join(f'<{of}>{escape(str(cell))}</{of}>' for cell in row)}</tr>"
        for of, row in [("th", heads), *(("td", row) for row in rows)]
    ]
    return f'<div class="wide"><table class="{kind}"><thead>{cells[0]}</thead><tbody>{"".join(cells[1:])}</tbody></table></div>'


def table_of(frame: "pandas.DataFrame", kind: str = "numbers") -> str:
    """A table of the cells of a DataFrame."""
    return table(list(frame.columns), frame.to_numpy().tolist(), kind)


def pictures(figures: Mapping[str, Any], files: Mapping[str, bytes]) -> str:
    """Figures with their captions; names within drawings are made different from each other."""
    parts = []
    for number, (name, figure) in enumerate(figures.items(), 1):
        drawing = files[f"{name}.svg"].decode()
        drawing = re.sub(r"<metadata>.*?</metadata>", "", drawing[drawing.index("<svg") :], flags=re.DOTALL)
        drawing = re.sub(r'(\bid="|href="#|url\(#)', rf"\g<1>{name}-", drawing)
        caption = escape(figure.get_label())
        drawing = drawing.replace("<svg ", f'<svg role="img" aria-label="{caption}" ', 1)
        parts.append(f"<figure>{drawing}<figcaption>Figure {number}. {caption}</figcaption></figure>")
    return "\n".join(parts)


def effects_page(found: "Effects", figures: Mapping[str, Any], files: Mapping[str, bytes]) -> str:
    """The page of ``plateau sweep effects``."""
    from plateau.study.analysis import told

    study = found.study
    factors = [[factor.name, factor.keys, " … ".join(map(factor.text, factor.levels)) if factor.is_range else ", ".join(map(factor.text, factor.levels))]
               for factor in study.factors]  # fmt: skip
    states = ", ".join(f"{count} {state}" for state, count in study.runs["state"].value_counts().items())
    parts = [
        listed(
            [
                f"design: {study.design}",
                f"runs: {states}",
                f"sets of seeds: {study.seeds}",
                *(f"caution: {said}" for said in found.cautions),
            ]
        )
    ]
    parts.append(table(["factor", "keys", "values"], factors, "words"))
    for one, stem in zip(found.responses, file_names([one.response.name for one in found.responses]), strict=True):
        (name, *said), rows, below = told(one)
        parts += [f"<h2>{escape(name)}</h2>", listed(said)]
        parts += [table(rows[0], rows[1:])] if rows else []
        parts += [f"<pre>{escape(chr(10).join(below))}</pre>"] if below else []
        own = [f"{stem}-{kind}" for kind in ("pareto", "main-effects", "interactions", "residuals", "surface")]
        parts.append(pictures({name: figures[name] for name in own if name in figures}, files))
    return page(f"{study.title}: effects", *parts)


def comparison_page(found: "Comparison", figures: Mapping[str, Any], files: Mapping[str, bytes]) -> str:
    """The page of ``plateau compare``."""
    scenes = table(["scene", "file"], list(map(list, found.scenes.items())), "words")
    note = f'<p class="quiet">{escape(NOTE.format(level=f"{100 * found.confidence:g} %"))}</p>'
    return page(found.title, scenes, listed(found.said()), table_of(found.shown()), note, pictures(figures, files))
