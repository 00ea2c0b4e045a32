"""Values and tables in the form of TOML."""

import os
from collections.abc import Mapping
from json import dumps
from typing import Any

from plateau.errors import InputTypeError
from plateau.units import text_of


def toml_document(table: Mapping[str, Any]) -> str:
    """A table in the form of TOML, a line for each key."""
    return "".join(f"{dumps(key)} = {toml_of(value)}\n" for key, value in table.items())


def toml_of(value: Any) -> str:
    """A value in the form of TOML; a number with a unit, as of pint, is text.

    Examples
    --------
    >>> toml_of({"rows": 10, "title": "µ"})
    '{ "rows" = 10, "title" = "µ" }'
    """
    if hasattr(value, "magnitude") and hasattr(value, "units"):
        return dumps(text_of(value), ensure_ascii=False)
    if hasattr(value, "tolist"):  # of NumPy
        value = value.tolist()
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int | float):
        return repr(value)
    if isinstance(value, str | os.PathLike):
        return dumps(os.fspath(value), ensure_ascii=False)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{dumps(key)} = {toml_of(part)}" for key, part in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(toml_of, value)) + "]"
    raise InputTypeError(f"{value!r} is not a value of a scene: expected text, a number, True or False, a list or a dictionary")
