#!/usr/bin/env python3
"""Prepares the pages of docs/ for the site, as a preprocessor of mdBook: formulas become elements that KaTeX fills, and links to files of
the repository lead there, if PLATEAU_REPOSITORY has its address, else they become plain text.
"""

import html
import json
import os
import re
import sys
from typing import Any

FENCE = re.compile(r"^(```+|~~~+)(\w*)[^\n]*\n(.*?)^\1[ \t]*$\n?", re.MULTILINE | re.DOTALL)
# Inline code, a formula on a line of its own or within one, a link to the first page of the guide, or one out of the folder of the page.
INLINE = re.compile(
    r"(`+)(?!`).*?(?<!`)\1(?!`)|^\$\$(?P<display>.+?)\$\$$|\$(?P<formula>[^\s$](?:[^$\n]*[^\s$])?)\$(?!\d)|\]\((?P<up>(?:\.\./)*)(?:README\.md(?P<place>#[^)\s]*)?|(?<=/)(?P<path>[^)\s]*))\)",
    re.DOTALL | re.MULTILINE,
)
LINK_TEXT = re.compile(r"\[((?:[^\[\]]|\[[^\[\]]*\])*)\]\(plain:\)")


def element(tex: str, tag: str) -> str:
    """An element with a formula as an attribute, of which Markdown leaves the text alone, also in tables."""
    text = html.escape(tex.strip(), quote=True).replace("|", "&#124;").replace("\n", " ")
    return f'<{tag} class="formula" data-tex="{text}"></{tag}>'


def inline(text: str, repository: str, depth: int) -> str:
    """Text between fences, of a page so many folders below that of the guide."""

    def replaced(match: re.Match[str]) -> str:
        if match["display"]:
            return element(match["display"], "div")
        if match["formula"]:
            return element(match["formula"], "span")
        if match["up"] is None:
            return match[0]
        folders = match["up"].count("/")
        if folders > depth:
            target = match["path"] or f"README.md{match['place'] or ''}"
            return f"]({repository}/{target})" if repository else "](plain:)"
        # The first page of the guide is that of the site.
        return match[0] if match["path"] or folders < depth else f"]({match['up']}index.md{match['place'] or ''})"

    return LINK_TEXT.sub(r"\1", INLINE.sub(replaced, text))


def page(text: str, repository: str, path: str = "") -> str:
    """A page of the guide, at a path in its folder."""
    parts, end, depth = [], 0, path.count("/")
    for fence in FENCE.finditer(text):
        parts.append(inline(text[end : fence.start()], repository, depth))
        parts.append(element(fence[3], "div") + "\n" if fence[2] == "math" else fence[0])
        end = fence.end()
    return "".join([*parts, inline(text[end:], repository, depth)])


def chapters(items: list[Any], repository: str) -> None:
    """All chapters of a book, with those below them."""
    for item in items:
        if isinstance(item, dict) and (chapter := item.get("Chapter")):
            chapter["content"] = page(chapter["content"], repository, chapter["path"] or "")
            chapters(chapter["sub_items"], repository)


def main() -> None:
    if len(sys.argv) > 1 and sys.argv[1] == "supports":
        sys.exit(sys.argv[2] != "html")
    _, book = json.load(sys.stdin)
    # The name changed with mdBook 0.5.
    chapters(book.get("items", book.get("sections", [])), os.environ.get("PLATEAU_REPOSITORY", "").rstrip("/"))
    json.dump(book, sys.stdout)


if __name__ == "__main__":
    main()
