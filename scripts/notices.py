#!/usr/bin/env python3
"""Write the licences and copyright notices of everything that is compiled into the program and the Python module, on standard output.

Whoever gives the program away puts them beside it:

    python3 scripts/notices.py > THIRD-PARTY-NOTICES

Equal texts stand there once, below the crates that have them. The crates are those that cargo builds into the program on this
machine; arguments, such as --features mpi, are passed on to cargo.
"""

import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# What a crate says of its licence, and of libraries in C that it brings along.
PATTERNS = ("LICEN[CS]E*", "COPYING*", "NOTICE*", "UNLICENSE*", "COPYRIGHT*")
LIBRARIES = {"hdf5-metno-src": ["ext/hdf5/LICENSE"], "libz-sys": ["src/zlib/LICENSE"]}


def cargo(*arguments):
    command = ["cargo", *arguments, "--locked", "--manifest-path", str(ROOT / "Cargo.toml")]
    return subprocess.run(command, stdout=subprocess.PIPE, check=True, text=True).stdout


def built_in(options):
    """Names and versions of the crates in the program and the module, without those that only help to build it."""
    tree = cargo("tree", "-p", "plateau", "-p", "plateau-python", "-e", "normal,no-proc-macro", "--prefix", "none", "--format", "{p}", *options)
    return {tuple(line.split()[:2]) for line in tree.splitlines() if line}


def texts(crate):
    folder = Path(crate["manifest_path"]).parent
    files = {file for pattern in PATTERNS for file in folder.glob(pattern) if file.is_file()}
    files |= {folder / file for file in LIBRARIES.get(crate["name"], [])}
    # Some crates state a licence and hold no text. All of those may be had under Apache 2.0, whose text is always the same.
    if not files:
        if "Apache-2.0" not in (crate["license"] or ""):
            sys.exit(f"{crate['name']} {crate['version']}: found no file with its licence, {crate['license']}")
        files = {ROOT / "LICENSE-APACHE"}
    return [file.read_text(errors="replace") for file in sorted(files)]


def main():
    wanted = built_in(sys.argv[1:])
    version = subprocess.run(["rustc", "-vV"], stdout=subprocess.PIPE, check=True, text=True).stdout
    host = next(line.removeprefix("host: ") for line in version.splitlines() if line.startswith("host: "))
    metadata = json.loads(cargo("metadata", "--format-version", "1", "--filter-platform", host, *sys.argv[1:]))
    crates = [crate for crate in metadata["packages"] if (crate["name"], "v" + crate["version"]) in wanted]
    if len(crates) < len(wanted):
        sys.exit(f"{len(wanted) - len(crates)} of {len(wanted)} crates are not where cargo says")
    works = [(f"{crate['name']} {crate['version']}", text) for crate in crates if crate["source"] for text in texts(crate)]

    # Texts that differ in their line breaks alone are equal.
    shared = {}
    for name, text in works:
        shared.setdefault(" ".join(text.split()), (text.strip(), set()))[1].add(name)
    print("Plateau contains works of others, under the licences that follow each list of them.")
    print("The standard library of Rust, by the Rust Project Contributors, is under MIT or Apache 2.0.")
    for text, names in sorted(shared.values(), key=lambda work: sorted(work[1])):
        print("\n" + "=" * 80 + "\n" + "\n".join(sorted(names)) + "\n\n" + text)


if __name__ == "__main__":
    main()
