"""The wheel as pip asks for it (PEP 517): maturin makes it of the package and its module in Rust, and puts the program beside it as a
script, which is built here before. Called as a program with options of ``maturin build``, it builds the program alone."""

import os
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

import maturin
from maturin import (  # noqa: F401
    get_requires_for_build_editable,
    get_requires_for_build_wheel,
    prepare_metadata_for_build_editable,
    prepare_metadata_for_build_wheel,
)

ROOT = Path(__file__).resolve().parents[2]
# Where maturin looks for scripts.
PROGRAM = ROOT / "packaging" / "wheel" / "scripts" / "plateau"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Builds the wheel."""
    build_program("--compatibility", "off")
    return maturin.build_wheel(wheel_directory, config_settings, metadata_directory)


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    """Builds the wheel of ``pip install -e``."""
    build_program("--compatibility", "off")
    return maturin.build_editable(wheel_directory, config_settings, metadata_directory)


def build_program(*options):
    """Builds the program as a wheel of its own, and takes it out of that."""
    with tempfile.TemporaryDirectory() as folder:
        command = ["maturin", "build", "--bindings", "bin", "--manifest-path", "crates/cli/Cargo.toml", "--release", "--locked", "--out", folder]
        # That wheel has the same scripts, and not one of before.
        PROGRAM.unlink(missing_ok=True)
        # Where there is no Rust, maturin gets one.
        subprocess.run([*command, *options], check=True, stdout=sys.stderr, env=maturin._get_env(), cwd=ROOT)
        with zipfile.ZipFile(next(Path(folder).glob("*.whl"))) as wheel:
            name = next(name for name in wheel.namelist() if name.endswith("/scripts/plateau"))
            PROGRAM.write_bytes(wheel.read(name))
    os.chmod(PROGRAM, 0o755)


if __name__ == "__main__":
    build_program(*sys.argv[1:])
