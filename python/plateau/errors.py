"""Exceptions and warnings: what the program says, in the classes of its exit statuses."""

from collections.abc import Sequence


class PlateauWarning(UserWarning):
    """What the program warns of, in its own words."""


class PlateauError(RuntimeError):
    """The program could not do what was asked.

    Parameters
    ----------
    message : str
        What the program says: what was found, what was expected, where, and what to do.
    command : sequence of str
        The command line.
    status : int
        The exit status; negative if a signal ended the program.
    """

    def __init__(self, message: str, command: Sequence[str] = (), status: int = 1) -> None:
        super().__init__(message)
        self.command = list(command)
        self.status = status


class InputError(PlateauError, ValueError):
    """A scene, a study, a file or an argument is wrong (exit status 2)."""


class RunFailed(PlateauError):
    """A run, or runs of a study, failed (exit status 1)."""


class RunStopped(PlateauError):
    """A signal stopped the run (exit status 128 and the number of the signal); ``resume=True`` goes on with it."""


def error_of(message: str, command: Sequence[str], status: int) -> PlateauError:
    """The exception for an exit status."""
    if status == 2:
        return InputError(message, command, status)
    if status > 128:
        return RunStopped(message, command, status)
    if status == 1:
        return RunFailed(message, command, status)
    return PlateauError(message, command, status)
