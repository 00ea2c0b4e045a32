#!/usr/bin/env python3
"""Checks that a wheel holds the package, its module in Rust, the program, the licences and the notices, and that neither of both asks for
a newer glibc than the name of the wheel says.

    python3 scripts/wheel_check.py WHEEL
"""

import re
import sys
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# Program and module are far smaller with debug information left out than with it.
LARGEST = 40_000_000


def problems(wheel: Path) -> list[str]:
    """What is wrong with a wheel."""
    name, version, _, _, platform = wheel.stem.split("-")
    with zipfile.ZipFile(wheel) as archive:
        files = {member.filename: member for member in archive.infolist()}
        info, program = f"{name}-{version}.dist-info", f"{name}-{version}.data/scripts/plateau"
        package = ROOT / "python"
        modules = [str(path.relative_to(package)) for path in (package / "plateau").rglob("*.py")]
        words = [f"{name}-{version}.data/scripts/{path.name}" for path in (ROOT / "packaging/wheel/scripts").iterdir()]
        texts = [f"{info}/licenses/{text}" for text in ("LICENSE-MIT", "LICENSE-APACHE", "THIRD-PARTY-NOTICES")]
        module = "plateau/_native.abi3.so"
        components = f"{info}/sboms/program.cdx.json"
        wanted = ["plateau/py.typed", "plateau/_native.pyi", *modules, *words, *texts, program, module, components]
        found = [f"it has no {file}" for file in wanted if file not in files]
        if found:
            return found
        if not files[program].external_attr >> 16 & 0o111:
            found.append("the program cannot be executed")
        notices = archive.read(f"{info}/licenses/THIRD-PARTY-NOTICES").decode()
        found += [f"the notices do not name {work}" for work in ("hdf5-metno-src", "libz-sys") if work not in notices]
        allowed = tuple(map(int, re.findall(r"manylinux_(\d+)_(\d+)", platform)[0]))
        for built in (program, module):
            if files[built].file_size > LARGEST:
                found.append(f"{built} has {files[built].file_size} bytes: it is not stripped")
            asked = {tuple(map(int, text.split(b"."))) for text in re.findall(rb"GLIBC_(\d+\.\d+)", archive.read(built))}
            if max(asked) > allowed:
                found.append(f"{built} asks for glibc {max(asked)}, the name of the wheel says {allowed}")
    return found


def main() -> None:
    wheel = Path(sys.argv[1])
    found = problems(wheel)
    if found:
        sys.exit("\n".join(f"{wheel.name}: {problem}" for problem in found))


if __name__ == "__main__":
    main()
