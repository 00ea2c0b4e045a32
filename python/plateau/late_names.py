"""Names of a package that are found when they are asked for first, so that nobody waits for what is not used."""

from collections.abc import Mapping
from importlib import import_module
from importlib.util import find_spec
from typing import Any

from plateau.errors import MissingPackageError, not_installed


def found(package: str, homes: Mapping[str, str], name: str) -> Any:
    """What a name of a package is: what the module in `homes` has by that name, or a module of the package.

    Raises
    ------
    AttributeError
        If it is neither.
    MissingPackageError
        If the module needs a package that is not installed.
    """
    if name not in homes and find_spec(f"{package}.{name}") is None:
        raise AttributeError(f"module {package!r} has no attribute {name!r}")
    try:
        module = import_module(f"{package}.{homes.get(name, name)}")
    except ModuleNotFoundError as error:
        raise MissingPackageError(not_installed(error.name)) from error
    return getattr(module, name) if name in homes else module
