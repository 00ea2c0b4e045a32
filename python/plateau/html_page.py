"""Pages for the browser: tables and figures in one file, without scripts, for a screen in light or dark and for paper."""

import re
from collections.abc import Mapping, Sequence
from html import escape
from string import Template
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas

PAGE = Template("""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; img-src data:">
<title>$title</title>
<style>
:root { color-scheme: light dark; --text: #1c1c1c; --ground: #ffffff; --quiet: #6b6b6b; --line: #d8d8d8 }
@media (prefers-color-scheme: dark) { :root { --text: #e8e8e8; --ground: #16181b; --quiet: #a5a5a5; --line: #3c3f44 } }
body { margin: 2rem auto; padding: 0 1rem; max-width: 60rem; font: 16px/1.5 system-ui, sans-serif; color: var(--text); background: var(--ground) }
h1 { font-size: 1.6rem } h2 { font-size: 1.25rem; margin-top: 2.5rem; border-bottom: 1px solid var(--line) }
.wide { overflow-x: auto; margin: 1rem 0 }
table { border-collapse: collapse; font-size: .875rem; font-variant-numeric: tabular-nums }
th, td { padding: .2rem .5rem; text-align: right; border-bottom: 1px solid var(--line); vertical-align: top }
td { white-space: nowrap } th { vertical-align: bottom }
th:first-child, td:first-child, .words td, .words th { text-align: left }
.words td { white-space: pre-line; overflow-wrap: anywhere } .words td:first-child { overflow-wrap: normal; min-width: 8rem }
.values td { overflow-wrap: normal } .values td:nth-child(2):last-child { white-space: nowrap }
pre { white-space: pre-wrap; overflow-wrap: anywhere; font-size: .8125rem }
.answer { font-size: 1.125rem } .notice { border-left: 4px solid #d55e00; padding-left: 1rem }
.pair { display: grid; grid-template-columns: repeat(auto-fit, minmax(20rem, 1fr)); gap: 1rem; align-items: start } .pair figure { margin: 0 }
figure { margin: 1.5rem 0; break-inside: avoid }
figure svg { max-width: 100%; height: auto; background: #ffffff }
figcaption, .quiet { color: var(--quiet); font-size: .875rem }
@page { size: A4; margin: 15mm }
@media print {
body { max-width: none; margin: 0; padding: 0; font-size: 9.5pt; line-height: 1.35; color: #000000; background: #ffffff }
.wide { overflow: visible } table { font-size: 8pt } th, td { padding: 1pt 4pt } pre { font-size: 7.5pt; columns: 2 }
h1, h2, h3, h4 { break-after: avoid } tr { break-inside: avoid } thead { display: table-header-group }
.first { break-after: page } .first figure { margin: 4pt 0 } .first figure svg { max-height: 66mm; width: auto } .first p { margin: 4pt 0 } .answer { font-size: 10.5pt } .pair { grid-template-columns: 1fr 1fr }
}
</style>
</head>
<body>
<h1>$title</h1>
$body
</body>
</html>
""")
# Characters that hide, or turn the direction of, what follows them.
HIDING = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")


def page(title: str, *parts: str) -> str:
    """A page of parts in HTML; the title is plain text."""
    return HIDING.sub("\N{REPLACEMENT CHARACTER}", PAGE.substitute(title=escape(title), body="\n".join(parts)))


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


def pictures(figures: Mapping[str, Any], files: Mapping[str, bytes], first: int = 1) -> str:
    """Figures with their captions, numbered from the first on; names within drawings are made different from each other."""
    parts = []
    for number, (name, figure) in enumerate(figures.items(), first):
        drawing = files[f"{name}.svg"].decode()
        drawing = re.sub(r"<metadata>.*?</metadata>", "", drawing[drawing.index("<svg") :], flags=re.DOTALL)
        drawing = re.sub(r'(\bid="|href="#|url\(#)', rf"\g<1>{name}-", drawing)
        caption = escape(figure.get_label())
        drawing = drawing.replace("<svg ", f'<svg role="img" aria-label="{caption}" ', 1)
        parts.append(f"<figure>{drawing}<figcaption>Figure {number}. {caption}</figcaption></figure>")
    return "\n".join(parts)
