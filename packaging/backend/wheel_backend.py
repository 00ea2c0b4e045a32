"""The wheel as pip asks for it (PEP 517): maturin makes it of the package and its module in Rust, and puts the program beside it as a
script, which is built here before. Called as a program with options of ``maturin build``, it builds the program alone."""

import os
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from pathlib import Path

import maturin
from maturin import (  # noqa: F401
    get_maturin_pep517_args,
    get_requires_for_build_editable,
    get_requires_for_build_sdist,
    get_requires_for_build_wheel,
    prepare_metadata_for_build_editable,
    prepare_metadata_for_build_wheel,
)

ROOT = Path(__file__).resolve().parents[2]
# Where maturin looks for scripts.
PROGRAM = ROOT / "packaging" / "wheel" / "scripts" / "plateau"
# What the program is made of, which is more than the module.
COMPONENTS = ROOT / "packaging" / "program.cdx.json"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Builds the wheel."""
    build_program()
    return maturin.build_wheel(wheel_directory, with_components(config_settings), metadata_directory)


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    """Builds the wheel of ``pip install -e``."""
    build_program()
    return maturin.build_editable(wheel_directory, with_components(config_settings), metadata_directory)


def build_sdist(sdist_directory, config_settings=None):
    """Packs the checkout: what git knows, and the metadata. What maturin packs is without the crates of the program."""
    with tempfile.TemporaryDirectory() as folder:
        metadata = prepare_metadata_for_build_wheel(folder, config_settings)
        name = metadata.removesuffix(".dist-info")
        listed = subprocess.run(["git", "ls-files", "-z"], check=True, capture_output=True, text=True, cwd=ROOT)
        with tarfile.open(Path(sdist_directory, f"{name}.tar.gz"), "w:gz") as archive:
            for file in filter(None, listed.stdout.split("\0")):
                archive.add(ROOT / file, f"{name}/{file}")
            archive.add(Path(folder, metadata, "METADATA"), f"{name}/PKG-INFO")
    return f"{name}.tar.gz"


def with_components(config_settings):
    """Settings of a build whose wheel has the list of what the program is made of beside that of the module."""
    arguments = [*get_maturin_pep517_args(config_settings), "--sbom-include", str(COMPONENTS)]
    return {**(config_settings or {}), "maturin.build-args": arguments}


def build_program(*options):
    """Builds the program as a wheel of its own, and takes it out of that."""
    with tempfile.TemporaryDirectory() as folder:
        # That wheel has the same scripts, and not one of before.
        PROGRAM.unlink(missing_ok=True)
        arguments = ["--bindings", "bin", "--manifest-path", "crates/cli/Cargo.toml", "--locked", *options]
        name = maturin.build_wheel(folder, {"maturin.build-args": arguments})
        with zipfile.ZipFile(Path(folder, name)) as wheel:
            for target, ending in ((PROGRAM, "/scripts/plateau"), (COMPONENTS, ".cyclonedx.json")):
                target.write_bytes(wheel.read(next(file for file in wheel.namelist() if file.endswith(ending))))
    os.chmod(PROGRAM, 0o755)


if __name__ == "__main__":
    build_program(*sys.argv[1:])
