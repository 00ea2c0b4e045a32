"""The figures of runs: for one run, or for several side by side with common scales.

Each is a function of a `Drawing` that gives figures by the names of their files; what they show is in docs/figures.md.
"""

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

import xarray

from plateau.errors import InputError, UnknownNameError
from plateau.figures.distributions import heights, plateau_sizes
from plateau.figures.drawing import Drawing, subjects_of
from plateau.figures.maps import build_up, contact_temperature, pressure, status, topography
from plateau.figures.series import contact_area, debris, emission, filled, friction, temperature
from plateau.run_file import open_run
from plateau.style import Figures, in_style
from plateau.times import seconds
from plateau.units import quantity

if TYPE_CHECKING:
    import os

FIGURES: dict[str, Callable[[Drawing], Figures]] = {
    "topography": topography,
    "status": status,
    "build-up": build_up,
    "pressure": pressure,
    "contact-temperature": contact_temperature,
    "contact-area": contact_area,
    "friction": friction,
    "temperature": temperature,
    "filled": filled,
    "plateau-sizes": plateau_sizes,
    "debris": debris,
    "emission": emission,
    "heights": heights,
}
# What scenes must have for figures that most do without.
NEEDS = {
    "friction": "[friction]",
    "temperature": "[thermal]",
    "contact-temperature": "output.contact_temperature = true",
    "emission": "[emission]",
}


@in_style
def plot(
    runs: "xarray.DataTree | str | os.PathLike[str] | Sequence[xarray.DataTree | str | os.PathLike[str]]",
    name: str | None = None,
    *,
    at: float | str | Sequence[float | str] | None = None,
    width: float | str | None = None,
    cmap: str = "viridis",
    polar: bool = False,
    ax: Any = None,
) -> Any:
    """Draws figures of runs, as ``plateau plot`` does; docs/figures.md describes them.

    Parameters
    ----------
    runs : xarray.DataTree, path, or sequence of them
        Opened runs or their files, at most eight; several are drawn with common scales.
    name : str, optional
        The figure, one of `FIGURES`; by default all that there are.
    at : float or str, or sequence of them, optional
        Times, s, or text such as ``"500 s"``: the maps recorded nearest to them are shown, instead of the first and the last.
    width : float or str, optional
        Width of the figures, mm, or text such as ``"120 mm"``; by default one or two columns of a journal.
    cmap : str
        Colours of maps.
    polar : bool
        The disc as a ring seen from above, instead of unrolled.
    ax : matplotlib.axes.Axes, optional
        Axes to draw in, for a named figure of one panel.

    Returns
    -------
    matplotlib.figure.Figure or list or dict
        Of a name its figure, a list if it has several pages; otherwise all figures by the names of their files.

    Raises
    ------
    UnknownNameError
        If there is no figure of this name.
    InputError
        If the runs do not have what the figure shows.

    Examples
    --------
    >>> import plateau
    >>> figure = plateau.plot("quick.h5", "contact-area", width="120 mm")
    >>> figure.axes[0].get_ylabel()
    'contact area, mm²'
    >>> plateau.plot("quick.h5", "friction")
    Traceback (most recent call last):
    plateau.errors.InputError: nothing to draw of the figure friction: it needs runs of scenes with [friction]
    """
    name = None if name is None else name.replace("_", "-")
    if name is not None and name not in FIGURES:
        raise UnknownNameError(f"no figure is called {name!r}, there are: {', '.join(FIGURES)}")
    if name is None and ax is not None:
        raise InputError("ax is given for all figures: name the one that is drawn in it")
    several = [runs] if isinstance(runs, xarray.DataTree | str) or hasattr(runs, "__fspath__") else list(runs)
    opened = [run if isinstance(run, xarray.DataTree) else open_run(run) for run in several]
    times = [] if at is None else [seconds(at)] if isinstance(at, int | float | str) else [seconds(time) for time in at]
    wide = quantity(width, "m") * 1e3 if isinstance(width, str) else width
    drawing = Drawing(subjects_of(opened, times), wide, cmap, polar, ax)
    figures = _all_of(drawing, FIGURES if name is None else [name])
    if name is None:
        drawing.say_left_out()
        return figures
    if not figures:
        missing = ", ".join(f"{path} has {what}" for path, what in drawing.left_out)
        raise InputError(f"nothing to draw of the figure {name}: {missing or f'it needs runs of scenes with {NEEDS.get(name)}'}")
    drawing.say_left_out()
    return list(figures.values()) if len(figures) > 1 else next(iter(figures.values()))


@in_style
def drawn(runs: Sequence[xarray.DataTree], names: Sequence[str] = (), at: Sequence[float] = (), **look: Any) -> Figures:
    """Figures of opened runs, all unless some are named, by the names of their files; says what is left out."""
    drawing = Drawing(subjects_of(runs, at), **look)
    figures = _all_of(drawing, [name for name in FIGURES if not names or name in names])
    drawing.say_left_out()
    return figures


def _all_of(drawing: Drawing, names: Iterable[str]) -> Figures:
    figures: Figures = {}
    for drawing.name in names:
        figures |= FIGURES[drawing.name](drawing)
    return figures
