"""Exceptions and warnings: messages of the program, with classes for its exit statuses and in the words of Python."""

import os
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

# Commands and options in messages of the program, and their names here; longer ones come first.
WORDS = [
    (r"(?:[\w./-]*/)?plateau sweep run\b", "plateau.sweep"),
    (r"(?:[\w./-]*/)?plateau (?:sweep )?(run|check|collect)\b", r"plateau.\1"),
    (r"(?:[\w./-]*/)?plateau (?:sweep )?(effects|predict|optimize|sensitivity|fit|compare)\b", r"plateau.study.\1"),
    (r"(?:[\w./-]*/)?plateau sweep import\b", "plateau.study.import_values"),
    (r"--(force|resume|retry|extrapolate|confirm)\b", r"\1=True"),
    (r"--set ([\w.-]+)=", r'set["\1"] = '),
    (r"--model (\w+)", r'model="\1"'),
    (r"--extend-to TIME\b", "extend_to=TIME"),
    (r"--limit-on (\w+)", r'limit_on="\1"'),
    (r"--(set|workers|jobs|model|confidence|output|at|grid|points|limit|hold|maximize|minimize|target|importance|contour)\b", r"\1"),
    (r"--(extend|max)-(to|failures)\b", r"\1_\2"),
    (r"-o FILE\b", "output=FILE"),
    (r"-o\b", "output"),
]
# Not inside the name of a file.
IN_MESSAGES = [(re.compile(rf"(?<![\w./-]){word}"), here) for word, here in WORDS]


# Characters of a value in a message.
LONGEST = 80


class PlateauWarning(UserWarning):
    """A warning of the program."""

    def __init__(self, message: object = "") -> None:
        super().__init__(in_python(str(message)))


class PlateauNote(PlateauWarning):
    """A note: worth knowing, and no reason for doubt."""


class PlateauError(RuntimeError):
    """The program could not do what was asked.

    Parameters
    ----------
    message : str
        Text that says what was found, what was expected, where the problem is, and what to do.
    command : sequence of str
        The command line of the program; empty if the program was not called.
    status : int, optional
        Exit status of the program; negative if a signal ended it; None if it was not called.
    """

    def __init__(self, message: str, command: Sequence[str] = (), status: int | None = None) -> None:
        super().__init__(in_python(message))
        self.command = list(command)
        self.status = status

    def __str__(self) -> str:
        # The text of KeyError has quotes around the message.
        return str(self.args[0])


class InputError(PlateauError, ValueError):
    """A scene, a study, a file or an argument is wrong (exit status 2)."""


class MissingFileError(InputError, FileNotFoundError):
    """A file that was named does not exist."""


class MissingPackageError(PlateauError, ImportError):
    """A Python package that is needed is not installed."""


class UnknownNameError(InputError, KeyError):
    """A run has no series, map or status of this name, or scenes have no such key."""


class InputTypeError(InputError, TypeError):
    """A value has a type that is not allowed there."""


class RunFailed(PlateauError):
    """A run, or runs of a study, failed (exit status 1)."""


class RunStopped(PlateauError):
    """A signal stopped the run (exit status 128 and the number of the signal); ``resume=True`` continues it."""


def shown(value: object) -> str:
    """A value as messages show it, which is short, whatever it is.

    Examples
    --------
    >>> shown("5 N"), shown(10**5000), len(shown([0] * 1000))
    ("'5 N'", 'this int', 80)
    """
    try:
        text = repr(value)
    except (RecursionError, ValueError):
        # Too deep, or a whole number of thousands of digits.
        return f"this {type(value).__name__}"
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 1]}…"


@contextmanager
def in_program_words() -> Iterator[None]:
    """Leaves messages in the words of the program, for its commands."""
    kept = IN_MESSAGES.copy()
    IN_MESSAGES.clear()
    try:
        yield
    finally:
        IN_MESSAGES[:] = kept


def in_python(message: str) -> str:
    """A message of the program, with the Python names of options and commands.

    Examples
    --------
    >>> in_python("quick.h5 exists; give --force to replace it, or write elsewhere with -o FILE")
    'quick.h5 exists; give force=True to replace it, or write elsewhere with output=FILE'
    >>> in_python("1 of 4 failed; `plateau sweep collect` lists their errors, --retry makes them again")
    '1 of 4 failed; `plateau.collect` lists their errors, retry=True makes them again'
    """
    for word, here in IN_MESSAGES:
        message = word.sub(here, message)
    # Half of a character, as in names that are not UTF-8, could not be printed.
    return message.encode(errors="backslashreplace").decode()


def not_installed(name: str | None) -> str:
    """Message about a Python package that is missing, with the command that installs it.

    Examples
    --------
    >>> not_installed("scipy")
    "scipy is not installed: pip install 'plateau-brake[all]'"
    """
    return f"{name} is not installed: pip install 'plateau-brake[all]'"


def error_of(message: str, command: Sequence[str], status: int, files: Sequence[str] = ()) -> PlateauError:
    """The exception for an exit status of a command, or of what this process did with these files in its place."""
    # Messages begin with the file that they are about.
    named = (*command[1:], *files)
    if status == 2 and any(message.startswith((f"{word}: ", f"cannot read {word}: ")) and not os.path.exists(word) for word in named):
        return MissingFileError(message, command, status)
    if status == 2:
        return InputError(message, command, status)
    if status > 128:
        return RunStopped(message, command, status)
    if status == 1:
        return RunFailed(message, command, status)
    return PlateauError(message, command, status)
