"""Pages for the browser: tables and figures in one file, without scripts, for a screen in light or dark and for paper."""

import functools
import re
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from string import Template
from typing import Any

# Characters that hide, or turn the direction of, what follows them.
HIDING = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")


def page(title: str, *parts: str) -> str:
    """A page of parts in HTML; the title is plain text."""
    return HIDING.sub("\N{REPLACEMENT CHARACTER}", _frame().substitute(title=escape(title), body="\n".join(parts)))


@functools.cache
def _frame() -> Template:
    """Template of what stands around the parts, read when the first page is made."""
    return Template(Path(__file__).with_name("page.html").read_text(encoding="utf-8"))


def listed(items: Sequence[str]) -> str:
    """A list of plain texts."""
    return "<ul>" + "".join(f"<li>{escape(item)}</li>" for item in items) + "</ul>" if items else ""


def table(heads: Sequence[str], rows: Sequence[Sequence[str]], kind: str = "numbers") -> str:
    """A table of plain texts."""
    cells = [
        f"<tr>{''.join(f'<{of}>{escape(str(cell))}</{of}>' for cell in row)}</tr>" for of, row in [("th", heads), *(("td", row) for row in rows)]
    ]
    return f'<div class="wide"><table class="{kind}"><thead>{cells[0]}</thead><tbody>{"".join(cells[1:])}</tbody></table></div>'


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
