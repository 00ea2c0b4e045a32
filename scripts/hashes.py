#!/usr/bin/env python3
"""Writes the digests of pinned Python packages into a list of requirements, so that pip installs these files and no others.

    python3 scripts/hashes.py REQUIREMENTS...

The digests are those that the package index names (PyPI, or PIP_INDEX_URL), of wheels for CPython 3.11 or newer on Linux and of sources. To be
run when a version in the list changes; remarks and the order of the list stay.
"""

import html
import os
import re
import sys
import urllib.request
from pathlib import Path

INDEX = os.environ.get("PIP_INDEX_URL", "https://pypi.org/simple").rstrip("/")
PIN = re.compile(r"^([A-Za-z0-9._-]+)==([^\s\\;]+)")
LINK = re.compile(r'<a [^>]*href="[^"#]*/([^"#/]+)#sha256=([0-9a-f]{64})"')
PYTHONS = re.compile(r"^(?:py3|py2\.py3|cp3(?:1[1-9]|[2-9][0-9])|cp3[0-9]+\.py3)$")
PLATFORMS = re.compile(r"any|linux_(?:x86_64|aarch64)|manylinux\w*_(?:x86_64|aarch64)")


def normalised(name: str) -> str:
    """A name as the index has it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def suits(file: str, version: str) -> bool:
    """Whether pip may install this file of the index for this version on a machine that the project runs on."""
    if file.endswith(".tar.gz"):
        return file.removesuffix(".tar.gz").endswith(f"-{version}")
    if not file.endswith(".whl"):
        return False
    parts = file.removesuffix(".whl").split("-")
    python, abi, platform = parts[-3:]
    is_old = abi == "abi3" and python.startswith("cp3")
    return parts[1] == version and (bool(PYTHONS.match(python)) or is_old) and bool(PLATFORMS.search(platform))


def digests(name: str, version: str) -> list[str]:
    """The digests of the files of a package."""
    request = urllib.request.Request(f"{INDEX}/{normalised(name)}/", headers={"Accept": "text/html"})
    with urllib.request.urlopen(request, timeout=60) as answer:
        page = answer.read().decode()
    found = {digest for file, digest in LINK.findall(page) if suits(html.unescape(file), version)}
    if not found:
        sys.exit(f"{INDEX}: {name} {version} has no file for CPython 3.11 or newer on Linux: is the version right?")
    return sorted(found)


def hashed(text: str) -> str:
    """The list with digests in place of those that it has."""
    lines = []
    for line in text.splitlines():
        pin = PIN.match(line)
        if pin:
            lines.append(" \\\n    ".join([pin[0], *(f"--hash=sha256:{digest}" for digest in digests(pin[1], pin[2]))]))
        elif not line.lstrip().startswith("--hash="):
            lines.append(line)
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    for name in sys.argv[1:]:
        Path(name).write_text(hashed(Path(name).read_text()))
