"""The word of surfaces that the package answers: ``plateau surface convert``."""

import argparse
from pathlib import Path

from plateau.command_line import Words, of_all
from plateau.errors import InputError
from plateau.surface_conversion import convert


def add(words: Words) -> None:
    """Adds the word to a parser."""
    about = "Convert files of instruments to HDF5, which scenes and plateau surface read"
    made = words.within("surface").word("convert", about, _convert, "  plateau surface convert scan.al3d\n  plateau surface scan.h5")
    made.add_argument("files", nargs="+", metavar="FILE", help="Files in any format that SurfaceTopography or surfalize reads")
    made.add_argument("-o", "--output", type=Path, metavar="OUT", help="File to write; unless given, beside the FILE, with the ending .h5")
    of_all(made, "Replace files that exist")


def _convert(given: argparse.Namespace) -> str:
    if given.output is not None and len(given.files) > 1:
        raise InputError(f"-o names one file, and {len(given.files)} are to be converted: leave it out, or give one FILE")
    return "".join(f"wrote {convert(path, given.output, force=given.force)}\n" for path in given.files)
