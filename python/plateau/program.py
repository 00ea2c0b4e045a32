"""The program: its place, and how to call it."""

import json
import os
import re
import shutil
import signal
import subprocess
import sysconfig
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from plateau.errors import InputError, InputTypeError, PlateauError, PlateauWarning, error_of, shown

# The beginning of every message of the program.
BEGIN = re.compile(r"^plateau: ", re.MULTILINE)


def find_program() -> str:
    """The program that is called.

    Returns
    -------
    str
        ``PLATEAU_PROGRAM`` if it is set; otherwise the program that was installed with this package, the program of the checkout of
        this package, or ``plateau`` on ``PATH``.

    Raises
    ------
    PlateauError
        If there is none of them.

    Examples
    --------
    >>> import os
    >>> os.access(find_program(), os.X_OK)
    True
    """
    given = os.environ.get("PLATEAU_PROGRAM")
    if given:
        found = shutil.which(given)
        if found is None:
            raise PlateauError(f"PLATEAU_PROGRAM is {given!r}, which is not a program: correct it or unset it")
        return found
    # Two folders up are site-packages, or the folder `python` of a checkout with its launcher beside it.
    package = Path(__file__).resolve().parent
    checkout = package.parents[1]
    beside = [Path(sysconfig.get_path("scripts", scheme)) / "plateau" for scheme in (_scheme("prefix"), _scheme("user"))]
    if (checkout / "Cargo.toml").is_file():
        beside.insert(0, checkout / "plateau")
    # `pip install --target` puts it beside the package.
    beside.append(package.parent / "bin" / "plateau")
    for path in beside:
        if path.is_file() and os.access(path, os.X_OK):
            return str(path)
    on_path = shutil.which("plateau")
    if on_path is None:
        raise PlateauError(
            "the program plateau is neither beside the Python package nor on PATH: install the package with pip, "
            "or set PLATEAU_PROGRAM to the program"
        )
    return on_path


def _scheme(key: Any) -> str:
    return sysconfig.get_preferred_scheme(key)


def call(arguments: Sequence[str | os.PathLike[str]]) -> Any:
    """Calls the program with ``--json``, as `listen` does, and returns the document; None if nothing was to be done."""
    document = listen([*arguments, "--json"], 4)
    try:
        return json.loads(document) if document.strip() else None
    except ValueError as error:
        raise PlateauError(f"{find_program()} printed no JSON ({error}): is it the program plateau, and of this version?") from error


def file_name(path: str | os.PathLike[str], what: str) -> str:
    """A path as an argument that the program does not read as an option; messages name `what` it is, such as "a scene".

    Examples
    --------
    >>> file_name("-x.toml", "a scene")
    './-x.toml'
    """
    try:
        name = os.fsdecode(path)
        os.fsencode(name)
    except TypeError as error:
        raise InputTypeError(f"{shown(path)}: expected the path of {what}") from error
    except UnicodeError:
        raise InputError(f"{shown(path)} has half of a character, which no path has: take it out") from None
    if "\0" in name:
        raise InputError(f"{shown(path)} has a character 0, which no path has: take it out")
    return os.path.join(".", name) if name.startswith("-") else name


def listen(arguments: Sequence[str | os.PathLike[str]], stacklevel: int = 3) -> str:
    """Calls the program and returns its standard output; its errors are `PlateauError`, its warnings `PlateauWarning`.

    `stacklevel` is the caller whose line is named in warnings.
    """
    try:
        command = [find_program(), *[os.fspath(argument) for argument in arguments]]
    except TypeError as error:
        raise InputTypeError(f"{error}: expected a path or text") from error
    for argument in command:
        if (b"\0" if isinstance(argument, bytes) else "\0") in argument:
            raise InputError(f"{argument!r} has a character 0, which no argument of a program can have: take it out")
    status, printed, said = _answer(command)
    messages = [message.strip() for message in BEGIN.split(said)]
    errors = [message for message in messages if message and not message.startswith("warning: ")]
    for message in messages:
        if message.startswith("warning: "):
            warnings.warn(message.removeprefix("warning: "), PlateauWarning, stacklevel=stacklevel)
    if status != 0:
        raise error_of(errors[-1] if errors else f"the program ended with status {status}", command, status)
    return printed


def _answer(command: list[str]) -> tuple[int, str, str]:
    """Exit status, standard output and messages of a command."""
    environment = dict(os.environ)
    # In a checkout, the program finds there the words that this package answers.
    words = Path(__file__).resolve().parents[1] / "bin"
    if (words / "plateau-sweep").is_file():
        environment["PATH"] = os.pathsep.join([str(words), environment.get("PATH", os.defpath)])
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=pipe, stderr=pipe, env=environment) as process:
        try:
            printed, said = process.communicate()
        except BaseException:
            # Ctrl-C in a notebook may reach this process alone. What is written is closed cleanly before this process continues.
            process.send_signal(signal.SIGINT)
            process.wait()
            raise
    return process.returncode, printed.decode(errors="replace"), said.decode(errors="replace")
