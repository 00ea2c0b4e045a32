"""Common parts of all figures: their look (``plateau.mplstyle``), colours, sizes and files."""

import functools
import io
import re
import textwrap
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

from plateau.errors import MissingPackageError
from plateau.progress import Progress
from plateau.units import with_minus

P = ParamSpec("P")
R = TypeVar("R")

# Figures by the names of their files; the label of a figure is its caption.
Figures = dict[str, Any]
MM = 1 / 25.4
# Widths of one and of two columns of a journal, mm.
NARROW, WIDE = 88.0, 180.0
# Formats, and how they are written: quickly, and so that equal figures give equal files.
FORMATS: dict[str, dict[str, Any]] = {
    "png": {"pil_kwargs": {"compress_level": 3}},
    "svg": {"metadata": {"Date": None, "Creator": None}},
    "pdf": {"metadata": {"CreationDate": None, "ModDate": None}},
}
# Places without a cell; cells outside the range of a map, such as cells without contact; statuses in their order.
GROUND, APART = "#ffffff", "#e4e4e4"
STATUS_COLOURS = [APART, "#005a9c", "#e69f00", GROUND]
# Lines, most of them after M. Okabe and K. Ito (those of the style file); what is less important; a place that was chosen.
LINES = [STATUS_COLOURS[1], "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#000000", "#d55e00", "#8c6d1f"]
QUIET, CHOSEN = "#6b6b6b", "#d55e00"
DASHES: list[Any] = ["-", "--", "-.", ":", (0, (4, 1, 1, 1, 1, 1)), (0, (1, 1)), (0, (6, 2)), (0, (3, 1, 1, 1))]
MARKERS = "osD^v<>P"
# Letters of a label on one line.
LETTERS = 24


def look(number: int) -> dict[str, Any]:
    """Options of a line among others: no two of 64 are alike."""
    return {"color": LINES[number % len(LINES)], "linestyle": DASHES[(number + number // len(LINES)) % len(DASHES)]}


def in_style(draws: Callable[P, R]) -> Callable[P, R]:
    """Draws in the look of the package, whatever the settings of matplotlib are."""

    @functools.wraps(draws)
    def drawn(*arguments: P.args, **options: P.kwargs) -> R:
        try:
            import matplotlib
        except ImportError as error:
            raise MissingPackageError("figures need matplotlib: pip install 'plateau-brake[all]', or pip install matplotlib") from error
        with matplotlib.rc_context(matplotlib.rcParamsDefault | _look()):
            return draws(*arguments, **options)

    return drawn


@functools.cache
def _look() -> Any:
    import matplotlib

    return matplotlib.rc_params_from_file(Path(__file__).with_name("plateau.mplstyle"), use_default_template=False)


def saved(
    figures: Mapping[str, Any], formats: Sequence[str] | None = None, dpi: int | None = None, progress: bool | None = False
) -> dict[str, bytes]:
    """Files of figures by name with ending, of all formats unless told; equal figures give equal files.

    `dpi` is also that of maps within svg and pdf.
    """
    import matplotlib

    files: dict[str, bytes] = {}
    # Without a layout of the user's, which would take the place of the one that is found here.
    layout = {"figure.autolayout": False, "figure.constrained_layout.use": False}
    with matplotlib.rc_context(_look() | layout), Progress(progress) as told:
        for at, (name, figure) in enumerate(figures.items()):
            told.show(at / len(figures), f"figure {at + 1} of {len(figures)}")
            figure.dpi = dpi or matplotlib.rcParams["savefig.dpi"]
            # The places of all that is drawn are the same in each format. Found by savefig, they would take a drawing of their own.
            if engine := figure.get_layout_engine():
                engine.execute(figure)
                figure.set_layout_engine(None)
            for form in formats or FORMATS:
                with io.BytesIO() as file:
                    figure.savefig(file, format=form, dpi=figure.dpi, **FORMATS[form])
                    files[f"{name}.{form}"] = file.getvalue()
    return files


def new(width: float, height: float, caption: str, rows: int = 1, columns: int = 1, note: str = "", **options: Any) -> tuple[Any, Any]:
    """Makes a figure of this size, mm, and its axes, an array of two dimensions; a note stands below them."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width * MM, height * MM), layout="constrained", label=caption)
    noted(figure, note)
    return figure, figure.subplots(rows, columns, squeeze=False, **options)


def noted(figure: Any, note: str) -> None:
    """Writes a note, if there is one, below the axes of a figure."""
    if note:
        figure.supxlabel(wrapped(note, round(0.68 * figure.get_figwidth() / MM)), fontsize=7, color=QUIET, x=0.01, ha="left")


def wrapped(text: str, letters: int = LETTERS) -> str:
    """Breaks the lines of a text into lines of so many letters."""
    return "\n".join(textwrap.fill(line, max(letters, 1), break_on_hyphens=False) for line in plain(text).split("\n"))


def plain(text: str) -> str:
    """A text in which matplotlib finds no formula, which would be between two $."""
    return re.sub(r"(?<!\\)\$", r"\\$", text)


def labelled(name: str, unit: str) -> str:
    """The label of an axis: what it is, and the unit behind a comma if there is one."""
    return wrapped(", ".join(filter(None, [name, unit])), 36)


def logarithmic(axis: Any, way: str) -> None:
    """A logarithmic scale with few numbers, which do not touch."""
    from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter

    own = getattr(axis, f"{way}axis")
    getattr(axis, f"set_{way}scale")("log")
    low, high = sorted(own.get_view_interval())
    steps = LogLocator(subs=(1.0, 2.0, 5.0) if high < 100.0 * low else (1.0,))
    own.set_major_locator(MaxNLocator(4, steps=[1, 2, 2.5, 5, 10]) if high < 5.0 * low else steps)
    own.set_major_formatter(FuncFormatter(lambda value, _: number(value)))
    own.set_minor_formatter(NullFormatter())


def number(value: float) -> str:
    """A number as axes have it, with a power of ten if it is far from 1."""
    if value == 0.0 or 1e-3 <= abs(value) < 1e5:
        return with_minus(f"{value:.6g}")
    digits, power = f"{value:.3e}".split("e")
    times = "" if float(digits) == 1.0 else rf"{float(digits):g}\times"
    return rf"${times}10^{{{int(power)}}}$"
