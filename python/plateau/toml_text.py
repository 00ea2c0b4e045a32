"""Values and tables in the form of TOML."""

import os
from collections.abc import Mapping
from json import dumps
from typing import Any

from plateau.errors import InputError, InputTypeError, shown
from plateau.units import text_of

TOO_DEEP = "nested too deep, expected lists and dictionaries of a few levels"


def toml_document(table: Mapping[str, Any]) -> str:
    """A table in the form of TOML, a line for each key."""
    return "".join(f"{dumps(key)} = {toml_of(value)}\n" for key, value in table.items())


def in_utf8(text: str, what: str) -> str:
    """The text, which may be written as UTF-8."""
    try:
        text.encode()
    except UnicodeError:
        raise InputError(f"{what} has half of a character, which no file can hold: {shown(text)}") from None
    return text


def change_of(key: str, value: Any) -> str:
    """A key and its value, as after ``--set``."""
    try:
        return in_utf8(f"{key}={toml_of(value)}", "its value")
    except RecursionError:
        raise InputError(f"the value of {key} is {TOO_DEEP}") from None
    except InputError as error:
        error.args = (f"{key}: {error}",)
        raise


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
        if isinstance(value, int) and abs(value) >= 2**63:
            raise InputError(f"{shown(value)} is too large a number, expected a whole one below 2^63")
        return repr(value)
    if isinstance(value, str | os.PathLike):
        return dumps(os.fspath(value), ensure_ascii=False)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{dumps(key)} = {toml_of(part)}" for key, part in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(toml_of, value)) + "]"
    raise InputTypeError(f"{shown(value)} is not a value of a scene: expected text, a number, True or False, a list or a dictionary")
