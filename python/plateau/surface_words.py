"""The words of surfaces that the package answers: ``plateau surface convert``, and one by which ``plateau surface`` describes."""

import argparse
from pathlib import Path

from plateau.command_line import Words, of_all
from plateau.errors import InputError
from plateau.surface_description import describe


def add(words: Words) -> None:
    """Adds the word to a parser."""
    surface = words.within("surface")
    about = "Convert files of instruments to HDF5, which scenes and plateau surface read"
    made = surface.word("convert", about, _convert, "  plateau surface convert scan.al3d\n  plateau surface scan.h5")
    made.add_argument("files", nargs="+", metavar="FILE", help="Files in any format that SurfaceTopography or surfalize reads")
    made.add_argument("-o", "--output", type=Path, metavar="OUT", help="File to write; unless given, beside the FILE, with the ending .h5")
    of_all(made, "Replace files that exist")
    made = surface.word("describe", "Describe data of the program: for the program itself; users call plateau surface", _describe)
    made.add_argument("data", type=Path, metavar="DATA", help="Folder of data")
    made.add_argument("--json", action="store_true", help="Print JSON")
    made.set_defaults(quiet=True)


def _describe(given: argparse.Namespace) -> str:
    return describe(given.data, given.json)


def _convert(given: argparse.Namespace) -> str:
    # What reads instruments takes longer to import than a surface to describe.
    from plateau.surface_conversion import convert

    if given.output is not None and len(given.files) > 1:
        raise InputError(f"-o names one file, and {len(given.files)} are to be converted: leave it out, or give one FILE")
    return "".join(f"{path}: heights are in {convert(path, given.output, force=given.force)}\n" for path in given.files)
