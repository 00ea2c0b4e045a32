"""Print how large the project is: files and lines of code, comments and tests by crate, packages in the lock file, words of docs.

usage: python3 scripts/size.py [REVISION ...]      for each revision, HEAD unless given
"""

import subprocess
import sys
from collections import Counter
from pathlib import PurePosixPath


def git(*arguments: str) -> bytes:
    """Return what git prints."""
    return subprocess.run(["git", *arguments], capture_output=True, check=True).stdout


def contents(revision: str) -> dict[str, str]:
    """Return the text of every file of a revision that is counted, by its path."""
    counted = (".rs", ".py", ".md", "Cargo.lock")
    paths = [path for path in git("ls-tree", "-r", "--name-only", revision).decode().splitlines() if path.endswith(counted)]
    asked = "".join(f"{revision}:{path}\n" for path in paths).encode()
    told = subprocess.run(["git", "cat-file", "--batch"], input=asked, capture_output=True, check=True).stdout
    found, start = {}, 0
    for path in paths:
        end = told.index(b"\n", start)
        size = int(told[start:end].split()[2])
        found[path] = told[end + 1 : end + 1 + size].decode(errors="replace")
        start = end + 1 + size + 1
    return found


def lines_of(text: str, in_tests: bool) -> Counter[str]:
    """Count lines of Rust without tests, code and comments of them, and lines of tests: from `#[cfg(test)]` and a module on."""
    count: Counter[str] = Counter()
    lines = [line.strip() for line in text.splitlines()]
    for number, line in enumerate(lines):
        if line == "#[cfg(test)]" and any(later.startswith("mod ") and later.endswith("{") for later in lines[number + 1 : number + 3]):
            in_tests = True
        count["tests" if in_tests else "lines"] += 1
        if line and not in_tests:
            count["comments" if line.startswith("//") else "code"] += 1
    return count


def sizes(revision: str) -> dict[str, dict[str, int]]:
    """Count a revision: by row of the table, its numbers."""
    rows: dict[str, Counter[str]] = {}
    for path, text in contents(revision).items():
        parts = PurePosixPath(path).parts
        if path.endswith(".rs"):
            is_product = parts[0] == "crates" and parts[2] == "src"
            row = "/".join(parts[:2]) if is_product else "tests in Rust"
            rows.setdefault(row, Counter()).update(lines_of(text, not is_product), files=1)
            if is_product:
                rows.setdefault("crates, all", Counter()).update(lines_of(text, False), files=1)
        elif path.endswith(".py"):
            row = {"python": "python/plateau", "tests": "tests in Python"}.get(parts[0], "other Python")
            rows.setdefault(row, Counter()).update(files=1, lines=len(text.splitlines()))
        elif path == "Cargo.lock":
            rows["packages in Cargo.lock"] = Counter(files=text.count("[[package]]"))
        elif parts[0] == "docs":
            rows.setdefault("docs, words", Counter()).update(files=1, lines=len(text.split()))
    return {row: dict(count) for row, count in sorted(rows.items())}


def main() -> None:
    """Print one table with the numbers of every revision."""
    revisions = sys.argv[1:] or ["HEAD"]
    try:
        found = [sizes(revision) for revision in revisions]
    except subprocess.CalledProcessError as error:
        sys.exit(f"size.py: {error.stderr.decode().strip()}")
    columns = ("files", "lines", "code", "comments", "tests")
    print("| what | " + " | ".join(f"{column}: {', '.join(revisions)}" for column in columns) + " |")
    print("|" + "---|" * (len(columns) + 1))
    for row in sorted(set().union(*found)):
        cells = (", ".join(str(of.get(row, {}).get(column, "")) for of in found).strip(", ") for column in columns)
        print(f"| {row} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
