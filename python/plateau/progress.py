"""Progress of what takes long, as one line in a notebook or a terminal."""

import sys
import time
import warnings
from collections.abc import Callable
from typing import Any

from plateau.errors import PlateauWarning

# Characters of the bar, and seconds before it is shown and between two of its lines.
WIDTH, PATIENCE = 28, 0.2


class Progress:
    """Warns, and shows progress; `tell` is what the module in Rust calls.

    Parameters
    ----------
    wanted : bool, optional
        Show progress; by default in notebooks and terminals.
    stacklevel : int
        The caller whose line is named in warnings, from `tell` on.
    """

    def __init__(self, wanted: bool | None, stacklevel: int = 3) -> None:
        self._show, self._stacklevel = shower(wanted), stacklevel
        self._start = self._last = time.monotonic()

    def tell(self, kind: str, said: Any) -> None:
        """Takes a warning, or how far all is."""
        if kind == "warning":
            warnings.warn(said, PlateauWarning, stacklevel=self._stacklevel)
        elif kind == "progress":
            done, end, (ended, failed) = said
            more = f"{ended} runs" + (f", {failed} failed" if failed else "") if ended else f"{done:.4g} of {end:.4g}"
            self.show(done / end, more)

    def steps(self, done: int, last: int) -> None:
        """Shows how many steps are taken."""
        self.show(done / last, f"step {done} of {last}")

    def show(self, part: float, words: str) -> None:
        """Shows a part of all, not too often."""
        now = time.monotonic()
        if self._show is None or now - self._last < PATIENCE:
            return
        self._last = now
        filled = round(WIDTH * min(part, 1.0))
        left = f"{(now - self._start) * (1.0 / part - 1.0):.0f} s" if part > 0.0 else "?"
        self._show(f"{'#' * filled}{'.' * (WIDTH - filled)} {100.0 * part:3.0f} %  {words}  {left} left")

    def __enter__(self) -> "Progress":
        return self

    def __exit__(self, *_: object) -> None:
        if self._show is not None and self._last > self._start:
            self._show("")


def shower(wanted: bool | None) -> Callable[[str], None] | None:
    """The function that shows a line of progress in a notebook or a terminal; None if there is neither, or if no progress is wanted."""
    if wanted is False:
        return None
    if _in_notebook():
        return _in_cell()
    if wanted or sys.stderr.isatty():
        return _on_terminal
    return None


def _on_terminal(line: str) -> None:
    sys.stderr.write(f"\r\x1b[2K{line}")
    sys.stderr.flush()


def _in_notebook() -> bool:
    """Tells whether this is a kernel of Jupyter."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return shell is not None and hasattr(shell, "kernel")


def _in_cell() -> Callable[[str], None]:
    """Shows lines in one place of the output of a cell."""
    from IPython.display import Pretty, display  # type: ignore[import-not-found, unused-ignore]

    handle = display(Pretty(""), display_id=True)
    return lambda line: handle.update(Pretty(line))
