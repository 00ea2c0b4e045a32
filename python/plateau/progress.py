"""Progress of the program in notebooks and terminals: the program's own line, which it writes only to a terminal."""

import codecs
import fcntl
import os
import pty
import re
import struct
import subprocess
import sys
import termios
import tty
from collections.abc import Callable
from typing import Any

# Starts the program with this file descriptor as its standard error.
Start = Callable[[int], "subprocess.Popen[bytes]"]
# Returns the standard error of the program, without the lines of its bar.
Follow = Callable[[Start, Callable[[str], None] | None], str]

# Largest length of a line of the bar, characters.
COLUMNS = 120
ESCAPES = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")
BAR = re.compile(r"\d+ %.* left$")


def shower(wanted: bool | None) -> Callable[[str], None] | None:
    """The function that shows a line of progress in a notebook or a terminal; None if there is neither, or if no progress is wanted."""
    if wanted is False:
        return None
    if _in_notebook():
        return _in_cell()
    if wanted or sys.stderr.isatty():
        return _on_terminal
    return None


def follow_pipe(start: Start, show: Callable[[str], None] | None) -> str:
    """Starts the program and reads its messages to their end. There is no bar."""
    ours, theirs = os.pipe()
    with os.fdopen(ours, "rb") as stream:
        try:
            start(theirs)
        finally:
            os.close(theirs)
        return stream.read().decode(errors="replace")


def follow_terminal(start: Start, show: Callable[[str], None] | None) -> str:
    """The same with a terminal of its own, so that the program draws its bar; every line of that is shown."""
    ours, theirs = pty.openpty()
    try:
        tty.setraw(theirs)
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, COLUMNS, 0, 0))
        try:
            start(theirs)
        finally:
            os.close(theirs)
        said, rest = "", ""
        for text in _pieces(ours):
            *lines, rest = re.split(r"(?<=[\r\n])", rest + text)
            said += _messages(lines, show)
        return said + _messages([rest], show)
    finally:
        os.close(ours)
        if show is not None:
            show("")


def _pieces(descriptor: int) -> Any:
    """What comes from a terminal, until nobody has its other end any more."""
    # A character may arrive in two pieces.
    decoder = codecs.getincrementaldecoder("utf-8")(errors="replace")
    while True:
        try:
            piece = os.read(descriptor, 65536)
        except OSError:  # Linux says so
            return
        if not piece:
            return
        yield decoder.decode(piece)


def _messages(lines: list[str], show: Callable[[str], None] | None) -> str:
    """The lines that are messages; those of the bar are shown."""
    messages = ""
    for line in lines:
        text = ESCAPES.sub("", line)
        if BAR.search(text.rstrip()):
            if show is not None:
                show(text.strip())
        elif text.strip():
            messages += text.replace("\r", "\n")
    return messages


def _on_terminal(line: str) -> None:
    sys.stderr.write(f"\r\x1b[2K{line}")
    sys.stderr.flush()


def _in_notebook() -> bool:
    """Whether this is a kernel of Jupyter."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return shell is not None and hasattr(shell, "kernel")


def _in_cell() -> Callable[[str], None]:
    """Shows lines in one place of the output of a cell."""
    from IPython.display import Pretty, display  # type: ignore[import-not-found, unused-ignore]

    handle = display(Pretty(""), display_id=True)
    return lambda line: handle.update(Pretty(line))
