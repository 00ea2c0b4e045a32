"""The figure of ``plateau accuracy``: the error of runs against the time that they take."""

import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from plateau.errors import InputError, MissingFileError
from plateau.style import APART, LINES, NARROW, QUIET, in_style, logarithmic, new

# By the name in the document: what the runs of a ladder differ in, their mark, and whether a line goes through them.
LADDERS = {
    "time_acceleration": ("time acceleration", "o", True),
    "mesh": ("columns of the disc", "D", False),
    "tolerance": ("tolerance of the time acceleration", "s", False),
    "perturbation": ("heights times 1 + the number", "v", False),
}
# Where names may stand beside their points.
AROUND = [(1, 1), (1, 0), (1, -1), (-1, 1), (-1, 0), (-1, -1), (0, 1), (0, -1)]


@in_style
def plot_accuracy(folder_or_json: str | os.PathLike[str], ax: Any = None) -> Any:
    """Draws the largest error of the quantities of runs against the time that they took.

    Parameters
    ----------
    folder_or_json : path
        The folder that ``plateau accuracy`` writes, or its accuracy.json.
    ax : matplotlib.axes.Axes, optional
        The axes to draw in; by default those of a new figure.

    Returns
    -------
    matplotlib.axes.Axes
    """
    path = Path(folder_or_json)
    path = path / "accuracy.json" if path.is_dir() else path
    if not path.is_file():
        raise MissingFileError(f"{path} does not exist: plateau accuracy SCENE -o FOLDER writes accuracy.json there")
    told = json.loads(path.read_text(encoding="utf-8"))
    if not isinstance(told, dict) or not {"reference", "runs", "quantities"} <= set(told):
        raise InputError(f"{path} has no reference, runs and quantities: expected the accuracy.json of plateau accuracy")
    runs = [run for run in told["runs"] if (run["error"] or 0) > 0 and (run["wall_time"] or 0) > 0]
    # Chance far below all other errors would take most of the room.
    least = min((run["error"] for run in runs if run["ladder"] != "perturbation"), default=0.0)
    runs = [run for run in runs if run["ladder"] != "perturbation" or run["error"] >= 0.1 * least]
    quantities = ", ".join(name.replace("_", " ") for name in told["quantities"])
    caption = f"Largest error of the means over equal windows of physical time, against the wall time of the run: {quantities}."
    given, ax = ax, new(NARROW, 105, caption)[1][0, 0] if ax is None else ax
    ax.set(xscale="log", yscale="log", xlabel="run time, s", ylabel=f"error, {quantities}, %" if len(told["quantities"]) == 1 else "largest error, %")

    def points(some: list[dict[str, Any]]) -> Any:
        return np.array([[run["wall_time"], 100 * run["error"]] for run in some]).reshape(-1, 2)

    front = points(sorted((run for run in runs if run["on_front"] == 1), key=lambda run: float(run["wall_time"])))
    ax.plot(*front.T, color=APART, linewidth=5, solid_capstyle="round", label="no other run is quicker and more exact")
    for number, (name, (label, mark, is_joined)) in enumerate(LADDERS.items()):
        own = points([run for run in runs if run["ladder"] == name])
        if len(own):
            ax.plot(*own.T, mark, color=LINES[number], linestyle="-" if is_joined else "", label=label)
    reference = told["reference"]
    if reference["wall_time"]:
        label = f"time of the reference, time acceleration {reference['time_acceleration']:g}"
        ax.axvline(reference["wall_time"], color=QUIET, label=label)
    if reference["error"]:
        ax.axhline(100 * reference["error"], color=QUIET, linestyle="--", label="own error of the reference")
    ax.margins(0.12)
    logarithmic(ax, "x")
    logarithmic(ax, "y")
    if given is None:
        ax.figure.legend(loc="outside upper left")
    else:
        ax.legend()
    _name_points(ax, points(runs), [_name(run) for run in runs])
    return ax


def _name(run: dict[str, Any]) -> str:
    """The value of a run, with its time acceleration where both differ."""
    return f"{run['value']:g}, m = {run['time_acceleration']:g}" if run["ladder"] == "mesh" else f"{run['value']:g}"


def _name_points(ax: Any, points: Any, names: list[str]) -> None:
    """Writes a name beside each point, where it lies on no point and no other name; none where there is no room."""
    ax.figure.draw_without_rendering()
    places, written = ax.transData.transform(points), list[Any]()
    for point, name in zip(points, names, strict=True):
        for x, y in AROUND:
            aligned = {"ha": ("center", "left", "right")[x], "va": ("center", "bottom", "top")[y]}
            text = ax.annotate(name, point, (4 * x, 4 * y), textcoords="offset points", fontsize=7, in_layout=False, **aligned)
            box = text.get_window_extent()
            if ax.bbox.count_contains(box.corners()) == 4 and not box.count_contains(places) and not box.count_overlaps(written):
                written.append(box)
                break
            text.remove()
