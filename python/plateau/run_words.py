"""The words of runs: ``plateau plot``, ``report`` and ``export``, each a thin layer on a function."""

import argparse
import math
from pathlib import Path

from plateau import figures
from plateau.command_line import Words, of_all, options, progress, several
from plateau.errors import InputError
from plateau.exports import FORMATS, export
from plateau.figures import FIGURES
from plateau.opened_runs import inputs_of, named_like, opened, warn, warn_of_times
from plateau.output_folder import put_together, refuse_file
from plateau.run_report import report
from plateau.style import saved
from plateau.units import quantity

COLOURS = ["viridis", "cividis", "inferno", "magma", "plasma", "greys"]
# Widths that figures can have, m: less has no room for a map and its colour bar.
LEAST_WIDTH, MOST_WIDTH = 0.06, 1.0
RUNS = "Run files, also of runs that go on or were stopped; at most 10"


def add(words: Words) -> None:
    """Adds the words of runs to a parser."""
    run = "  plateau run data/scenes/quick.toml -o quick.h5\n"
    made = words.word("plot", "Draw the figures of a run, or of several side by side", _plot, f"{run}  plateau plot quick.h5 -o figures")
    made.add_argument("runs", nargs="+", metavar="RUN", help=RUNS)
    _output(made, "DIR", 'Folder for the figures, made if it is not there; named like the run file, or "figures" for several, unless given')
    about = "Pixels, or lines and letters for web pages (svg) and papers (pdf) [default: png]"
    made.add_argument("--format", choices=("png", "svg", "pdf"), default="png", help=about)
    several(made, "--figure", "NAME", f"Draw this figure only; may be repeated: {', '.join(FIGURES)}", choices=list(FIGURES))
    about = 'Time of the maps to show, the nearest that was recorded ("100 s"); may be repeated. Unless given, the first and the last map'
    several(made, "--at", "TIME", about, type=_time)
    about = 'Width of the figures ("120 mm"), with letters of the same size; unless given, 88 mm or 180 mm. '
    about += "Those of 180 mm are made at least 120 mm wide"
    made.add_argument("--width", type=_width, metavar="LENGTH", help=about)
    made.add_argument("--cmap", choices=COLOURS, default="viridis", help="Colours of maps [default: viridis]")
    made.add_argument("--polar", action="store_true", help="Show the whole ring from above instead of unrolled")
    of_all(made, "Replace figures that exist")

    about = "Make one HTML page of a run, or of several to compare: the answer, figures, tables"
    made = words.word("report", about, _report, f"{run}  plateau report quick.h5 -o quick.html")
    made.add_argument("runs", nargs="+", metavar="RUN", help=f"{RUNS}, of which the others are compared with the first")
    _output(made, "HTML", 'Page to write; named like the run file, or "report.html" for several, unless given')
    of_all(made, "Replace the page if it exists")

    about = "Write a run file for other programs: tables, NumPy arrays, netCDF, ParaView's grids"
    made = words.word("export", about, _export, f"{run}  plateau export quick.h5 --to csv\n  plateau export quick.h5 --to vtk -o quick-vtk")
    made.add_argument("run", metavar="RUN", help="Run file, also of a run that goes on or was stopped")
    about = "Series as text, with --maps the maps (csv), or for Excel (xlsx); series and maps as arrays (npz, netcdf); "
    about += "maps on the cells of disc and pin, for ParaView (vtk)"
    made.add_argument("--to", "--format", required=True, choices=list(FORMATS), help=about)
    _output(made, "FILE", "File to write, for vtk the folder, made if it is not there; named like the run file unless given")
    made.add_argument("--maps", action="store_true", help="Write the maps too; for csv, as the other formats but xlsx have them anyway")
    made.add_argument("--decimal", choices=(".", ","), default=".", help="Decimal mark of csv [default: .]")
    made.add_argument(
        "--separator", metavar="SIGN", help='What separates the columns of csv, such as ";" or tab [default: , or ; with a decimal comma]'
    )
    of_all(made, "Replace files that exist")


def _output(made: argparse.ArgumentParser, what: str, about: str) -> None:
    made.add_argument("-o", "--output", type=Path, metavar=what, help=about)


def _time(text: str) -> float:
    """A time of a run, s."""
    return _quantity(text, "s", 0.0, math.inf, 'a time of at least 0 s, such as "100 s"')


def _width(text: str) -> float:
    """A width, mm."""
    return 1e3 * _quantity(text, "m", LEAST_WIDTH, MOST_WIDTH, f'a width from {1e3 * LEAST_WIDTH:g} mm to {1e3 * MOST_WIDTH:g} mm, such as "88 mm"')


def _quantity(text: str, si: str, least: float, most: float, expected: str) -> float:
    try:
        found = quantity(text, si)
    except InputError:
        found = math.nan
    if not least <= found <= most:
        raise argparse.ArgumentTypeError(f"{text}: expected {expected}")
    return found


def _plot(given: argparse.Namespace) -> str:
    runs = opened(given.runs)
    warn_of_times(runs, given.at)
    folder = given.output or (named_like(runs[0], "") if len(runs) == 1 else Path("figures"))
    inputs = inputs_of(runs)
    # What is in the way is told before anything is drawn.
    for name in given.figure or FIGURES:
        refuse_file(folder / f"{name}.{given.format}", given.force, inputs, "-o DIR names another folder")
    drawn = figures.drawn(runs, given.figure, given.at, width=given.width, cmap=given.cmap, polar=given.polar)
    files = saved(drawn, [given.format], progress=progress(given))
    put_together(folder, files, given.force, inputs)
    for path in sorted(folder.glob(f"*-[0-9]*.{given.format}")):
        if path.name not in files and path.stem.rpartition("-")[0] in FIGURES:
            warn(f"{path} is a page of an earlier call")
    # The first sentence of the caption.
    titles = [figure.get_label().split(". ")[0].rstrip(".") for figure in drawn.values()]
    return "".join(f"wrote {folder / name}: {title}\n" for name, title in zip(files, titles, strict=True))


def _report(given: argparse.Namespace) -> str:
    path = report(given.runs, given.output, force=given.force, progress=progress(given))
    return f"wrote {path} ({_size(path)})\n"


def _export(given: argparse.Namespace) -> str:
    written = export(given.run, given.to, given.output, **options(given, "maps", "decimal", "separator", "force"))
    return "".join(f"wrote {path} ({_size(path)})\n" for path in written)


def _size(path: str) -> str:
    """The size of a file, in words."""
    size = Path(path).stat().st_size
    return f"{size / 1e6:.1f} MB" if size >= 1e6 else f"{size / 1e3:.1f} kB"
