"""The module in Rust, ``plateau._native``: of the wheel, or of the build of a checkout."""

import functools
import importlib
import importlib.machinery
import importlib.util
import os
import sys
from pathlib import Path
from types import ModuleType

from plateau.errors import MissingPackageError

NAME = "plateau._native"
# What cargo calls it.
LIBRARY = "libplateau_python.so"


@functools.cache
def native() -> ModuleType:
    """The module; it is loaded when it is needed first.

    Raises
    ------
    MissingPackageError
        If this is a checkout that is not built.
    """
    checkout = Path(__file__).resolve().parents[2]
    if (checkout / "Cargo.toml").is_file():
        for path in (Path(folder) / "release" / LIBRARY for folder in (os.environ.get("CARGO_TARGET_DIR"), checkout / "target") if folder):
            if path.is_file():
                return _loaded(path)
    try:
        return importlib.import_module(NAME)
    except ModuleNotFoundError as error:
        said = "the module plateau._native is not built: ./plateau --version builds it in a checkout, or install the package with pip"
        raise MissingPackageError(said) from error


def _loaded(path: Path) -> ModuleType:
    loader = importlib.machinery.ExtensionFileLoader(NAME, str(path))
    spec = importlib.util.spec_from_file_location(NAME, path, loader=loader)
    assert spec is not None
    module = importlib.util.module_from_spec(spec)
    loader.exec_module(module)
    sys.modules[NAME] = module
    return module
