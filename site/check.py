#!/usr/bin/env python3
"""Checks a built site: every link within it leads to a file, and to a place in it where it names one; every formula of the guide is there.

python3 site/check.py FOLDER
"""

import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

# Pages that mdBook makes besides; of the first the links are those of another folder.
NO_PAGES = {"404.html", "print.html", "toc.html"}


class Page(HTMLParser):
    """What a page links to, the places in it, and its formulas."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.links: list[str] = []
        self.places: set[str] = set()
        self.formulas: list[str] = []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        values = {name: value or "" for name, value in attrs}
        self.links += [values[name] for name in ("href", "src") if name in values]
        self.places |= {values[name] for name in ("id", "name") if name in values}
        if "formula" in values.get("class", "").split():
            self.formulas.append(values["data-tex"])


def problems(folder: Path) -> list[str]:
    """What is wrong with the site."""
    pages = {path: Page(path) for path in sorted(folder.rglob("*.html")) if path.name not in NO_PAGES}
    found = [] if pages else [f"{folder}: there is no page"]
    for path, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path.resolve()
            target = target / "index.html" if target.is_dir() else target
            if not target.is_file():
                found.append(f"{path.name}: {link} leads nowhere")
            elif parts.fragment and target in pages and unquote(parts.fragment) not in pages[target].places:
                found.append(f"{path.name}: {link}: there is no such place")
        text = re.sub(r"<(code|pre)\b.*?</\1>", "", path.read_text(encoding="utf-8"), flags=re.DOTALL)
        found += [f"{path.name}: a formula was left as it is: {tex}" for tex in re.findall(r"\$[^$<>]*\\[^$<>]*\$", text)]
    if not any(page.formulas for page in pages.values()):
        found.append("no page has a formula")
    return found


def main() -> None:
    found = problems(Path(sys.argv[1]).resolve())
    if found:
        sys.exit("\n".join(found))


if __name__ == "__main__":
    main()
