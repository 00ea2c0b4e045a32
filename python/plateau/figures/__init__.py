"""The figures of runs: for one run, or for several side by side with common scales; docs/figures.md says what they show."""

from collections.abc import Sequence
from functools import partial
from typing import Any

import xarray

from plateau.errors import InputError, UnknownNameError
from plateau.figures import maps, series
from plateau.figures.distributions import heights, plateau_sizes
from plateau.figures.drawing import Drawing, subjects_of
from plateau.opened_runs import Run, note, opened
from plateau.style import Figures, in_style
from plateau.units import quantity

# What gives the pages of a figure, none if no run has what it shows, and the series that runs need for it.
FIGURES: dict[str, tuple[Any, ...]] = {
    name: (partial(maps.draw_maps, paths=paths, caption=said),) for name, (paths, said) in maps.FIGURES.items()
} | {
    "contact-area": (series.contact_area, "contact_area", "contact_area_mean"),
    "friction": (series.friction, "friction_coefficient_mean", "friction_coefficient", "mean_pressure"),
    "temperature": (series.temperature, "pin_temperature"),
    "filled": (series.filled, "pin_primary"),
    "plateau-sizes": (plateau_sizes,),
    "debris": (series.debris, *series.PARTS, *series.SOURCES),
    "emission": (series.emission, "pm10_mass", "pm25_mass", "particle_number"),
    "heights": (heights,),
}
# What scenes must have for figures that most do without.
NEEDS = {"friction": "[friction]", "temperature": "[thermal]", "emission": "[emission]", "contact-temperature": "output.contact_temperature = true"}


@in_style
def plot(
    runs: Run | Sequence[Run],
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
        Opened runs or their files, at most ten; several are drawn with common scales.
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
    times = [] if at is None else [at] if isinstance(at, int | float | str) else at
    wide = quantity(width, "m") * 1e3 if isinstance(width, str) else width
    figures = drawn(opened(runs), [] if name is None else [name], [quantity(time, "s") for time in times], width=wide, cmap=cmap, polar=polar, ax=ax)
    return figures if name is None else list(figures.values()) if len(figures) > 1 else next(iter(figures.values()))


@in_style
def drawn(runs: Sequence[xarray.DataTree], names: Sequence[str] = (), at: Sequence[float] = (), **look: Any) -> Figures:
    """Figures of opened runs, all unless some are named, by the names of their files; `InputError` if the runs have none of those named."""
    drawing, figures = Drawing(subjects_of(runs, at), **look), Figures()
    for drawing.name in (name for name in FIGURES if not names or name in names):
        draw, *needed = FIGURES[drawing.name]
        subjects = drawing.having(*(f"series/{one}" for one in needed), is_part=drawing.name in NEEDS) if needed else drawing.subjects
        pages = draw(drawing, subjects) if subjects else []
        figures |= {f"{drawing.name}-{number}" if number > 1 else drawing.name: page for number, page in enumerate(pages, 1)}
    if names and not figures:
        missing = [f"{path} has {what}" for path, what in drawing.left_out]
        said = ", ".join(missing) or f"it needs runs of scenes with {' or '.join(NEEDS[name] for name in names if name in NEEDS)}"
        raise InputError(f"nothing to draw of the figure {' or '.join(names)}: {said}")
    for (path, what), parts in drawing.left_out.items():
        note(f"{path} has {what}: left out of {', '.join(parts)}")
    return figures
