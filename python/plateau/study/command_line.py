"""Words that the package answers for the program: ``plateau sweep effects``, ``predict``, ``optimize``, ``sensitivity``, ``import``, ``plateau
fit`` and ``plateau compare``. Each is a thin layer on a function of `plateau.study`."""

import argparse
import json
import math
import os
import sys
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NoReturn

from plateau.errors import InputError, MissingPackageError, PlateauError, PlateauWarning

MODELS = ("main", "interactions", "full", "quadratic")
# What a table cell of CSV begins with that a spreadsheet would run.
FORMULAS = ("=", "+", "-", "@")


class Parser(argparse.ArgumentParser):
    """A parser whose errors are those of the program."""

    def error(self, message: str) -> NoReturn:
        raise InputError(f"{message}; {self.prog} --help tells more")


def sweep() -> NoReturn:
    """Runs ``plateau-sweep``."""
    sys.exit(main(["sweep", *sys.argv[1:]]))


def fit() -> NoReturn:
    """Runs ``plateau-fit``."""
    sys.exit(main(["fit", *sys.argv[1:]]))


def compare() -> NoReturn:
    """Runs ``plateau-compare``."""
    sys.exit(main(["compare", *sys.argv[1:]]))


def main(arguments: Sequence[str]) -> int:
    """Answers a word.

    Parameters
    ----------
    arguments : sequence of str
        The word and its arguments.

    Returns
    -------
    int
        Exit status: 0, 1 for a failed run, 2 for a wrong command line or input.
    """
    try:
        given = _parser().parse_args(arguments)
        warnings.showwarning = _quiet if given.quiet else _say
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            warnings.simplefilter("always", PlateauWarning)
            print(given.answer(given))
            sys.stdout.flush()
        return 0
    except PlateauError as error:
        print(f"plateau: {error}", file=sys.stderr)
        return 2 if isinstance(error, InputError) else 1
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        # Nobody reads on, as with `head`.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0


def _say(message: Warning | str, *_: Any) -> None:
    print(f"plateau: warning: {message}", file=sys.stderr)


def _quiet(*_: Any) -> None:
    """Says nothing."""


def _parser() -> Parser:
    called = os.environ.get("PLATEAU_CALLED", "plateau")
    parser = Parser(prog=called)
    words = parser.add_subparsers(required=True, metavar="COMMAND")
    study = words.add_parser("sweep", prog=f"{called} sweep").add_subparsers(required=True, metavar="COMMAND")

    def word(group: Any, name: str, about: str, answer: Callable[[argparse.Namespace], str]) -> Any:
        made = group.add_parser(name, help=about, description=about, prog=f"{called} {'sweep ' if group is study else ''}{name}")
        made.set_defaults(answer=answer)
        return made

    def common(made: Any, *, output: str | None = None, force: str = "Replace the files of an earlier call, and remove those that this call does not write") -> None:
        if output is not None:
            made.add_argument("-o", "--output", type=Path, metavar="DIR", help=output)
        made.add_argument("--force", action="store_true", help=force)
        made.add_argument("--json", action="store_true", help="Print one JSON document instead of text")
        made.add_argument("-q", "--quiet", action="store_true", help="Say errors only: no warnings, notes, progress")
        made.add_argument("-v", "--verbose", action="store_true", help="Say also what is done to surfaces")

    def confidence(made: Any) -> None:
        made.add_argument("--confidence", type=_share, default=0.95, metavar="P", help="Confidence level of intervals [default: 0.95]")

    def model(made: Any) -> None:
        made.add_argument("--model", choices=MODELS, help="What is fitted; unless given, what the design allows")
        made.add_argument("--terms", choices=("all", "aicc"), default="all", help="Which terms of it: all, or those that the runs support")
        confidence(made)

    def cores(made: Any) -> None:
        made.add_argument("--jobs", type=_count, metavar="N", help="Runs at a time; as many as there are cores unless given")
        made.add_argument("--workers", type=_count, default=1, metavar="N", help="Threads of each run [default: 1]")

    made = word(study, "effects", "Tell what the factors do: effects, analysis of variance, figures", _effects)
    made.add_argument("study", type=Path, help="Study file (TOML)")
    model(made)
    common(made, output='Folder for tables, figures and the page; "effects" in the study\'s own unless given')

    made = word(study, "predict", "Tell what responses are expected to be where no run was made", _predict)
    made.add_argument("study", type=Path, help="Study file (TOML)")
    made.add_argument("--at", action="append", default=[], metavar="FACTOR=VALUE", help='Set a factor, such as load="7 N"; may be repeated')
    made.add_argument("--grid", type=_count, metavar="N", help="Predict at so many values of each range and at all levels")
    made.add_argument("--points", type=Path, metavar="FILE", help="Predict at the points of a table in CSV, a column for each factor")
    made.add_argument("--extrapolate", action="store_true", help="Predict beyond the runs of the study, too")
    made.add_argument("--confirm", action="store_true", help="Make runs there, with all seeds of the study, and compare")
    made.add_argument("-o", "--output", type=Path, metavar="FILE", help="Write the predictions as a table in CSV")
    cores(made)
    model(made)
    common(made, force="Replace that file if it exists")

    made = word(study, "optimize", "Find the settings at which responses are best", _optimize)
    made.add_argument("study", type=Path, help="Study file (TOML)")
    for flag, example in (("maximize", "contact area=1 mm2..2 mm2"), ("minimize", "worn=0..1 mm3"), ("target", "filled=0.5..0.7..0.8")):
        made.add_argument(f"--{flag}", action="append", default=[], metavar="RESPONSE", help=f'A goal, such as "{example}"; may be repeated')
    made.add_argument("--limit", action="append", default=[], metavar="RESPONSE<=VALUE", help='Keep a response below or above a value: "filled<=0.9"')
    made.add_argument("--limit-on", choices=("mean", "means", "runs"), default="mean", help="What keeps the limits: the mean, its interval, that of a run")
    made.add_argument("--hold", action="append", default=[], metavar="FACTOR=VALUE", help='Hold a factor at a value, such as load="8 N"')
    made.add_argument("--importance", action="append", default=[], metavar="RESPONSE=NUMBER", help="How much a goal counts; 1 unless given")
    made.add_argument("--contour", metavar="FACTOR,FACTOR", help="Draw the desirability over two factors")
    made.add_argument("--runs", type=_count, metavar="N", help="Make so many runs on the way to the optimum, where improvement is expected")
    made.add_argument("--confirm", action="store_true", help="Make runs at the optimum, with all seeds of the study, and compare")
    cores(made)
    model(made)
    common(made, output='Folder for figures and table; "optimum" in the study\'s own unless given')

    made = word(study, "sensitivity", "Tell which part of a response's variation each factor has", _sensitivity)
    made.add_argument("study", type=Path, help="Study file (TOML)")
    confidence(made)
    common(made, output='Folder for table and figures; "sensitivity" in the study\'s own unless given')

    made = word(study, "import", "Take in responses that were measured or computed elsewhere", _import)
    made.add_argument("study", type=Path, help="Study file (TOML)")
    made.add_argument("table", type=Path, help="Table (CSV) with a column for each factor and for each response with imported = true")
    common(made, force="Replace values that were imported before")

    made = word(words, "fit", "Find the values of keys with which runs give what was measured", _fit)
    made.add_argument("study", type=Path, help="Study file (TOML) with measured values in its responses")
    made.add_argument("--plan", action="store_true", help="Say what is fitted to what and what it will cost, without running any")
    made.add_argument("--retry", action="store_true", help="Make runs again that failed before")
    cores(made)
    common(made, output='Folder for tables and figures; "fit" in the study\'s own unless given')

    made = word(words, "compare", "Tell what differs between scenes, and how sure that is: runs of each with the same seeds", _compare)
    made.add_argument("scenes", type=Path, nargs="+", metavar="SCENE", help="Scene files (TOML), two or more; the first is the reference")
    made.add_argument("--seeds", type=_count, default=5, metavar="N", help="Sets of seeds with which each scene is run [default: 5]")
    made.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="Change a key of all scenes; may be repeated")
    made.add_argument("--response", action="append", default=[], metavar="DATASET", help="A response besides those of all runs")
    cores(made)
    confidence(made)
    common(made, output='Folder for runs, tables, figures and the page; "comparison" unless given')
    return parser


def _count(text: str) -> int:
    number = int(text) if text.isdigit() else 0
    if number < 1:
        raise argparse.ArgumentTypeError(f"{text!r}, expected a whole number of at least 1")
    return number


def _share(text: str) -> float:
    try:
        share = float(text)
    except ValueError:
        share = math.nan
    if not 0.0 < share < 1.0:
        raise argparse.ArgumentTypeError(f"{text!r}, expected more than 0 and less than 1, such as 0.95")
    return share
