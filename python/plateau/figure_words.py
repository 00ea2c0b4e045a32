"""The word ``plateau-figure``, by which the program has figures drawn of data that it has computed. It is no word of users."""

import argparse
from pathlib import Path

from plateau.command_line import Words, of_all
from plateau.figures.accuracy import plot_accuracy
from plateau.figures.fibres import fibre_map
from plateau.figures.surfaces import surfaces
from plateau.output_folder import put_together
from plateau.style import FORMATS, saved


def add(words: Words) -> None:
    """Adds the word to a parser."""
    about = "Draw data of the program: for the program itself; users call plateau surface or plateau accuracy"
    made = words.word("figure", about, _figure)
    made.add_argument("kind", choices=("surfaces", "fibre-map", "accuracy"), metavar="KIND", help="surfaces, fibre-map or accuracy")
    made.add_argument("data", type=Path, metavar="DATA", help="Folder of data, or accuracy.json")
    made.add_argument("-o", "--output", type=Path, default=Path(), metavar="DIR", help="Folder of the figures [default: this one]")
    made.add_argument("--format", action="append", choices=[*FORMATS], help="Format, may be repeated; all unless given")
    made.add_argument("--relief", action="store_true", help="Draw surfaces in perspective")
    of_all(made, "Replace files")


def _figure(given: argparse.Namespace) -> str:
    if given.kind == "accuracy":
        figures = {"accuracy": plot_accuracy(given.data).figure}
    else:
        figures = fibre_map(given.data) if given.kind == "fibre-map" else surfaces(given.data, "relief" if given.relief else "charts")
    files = saved(figures, given.format)
    put_together(given.output, files, given.force)
    return "".join(f"{given.output / name}\n" for name in files)
