"""Words that the package answers for the program: ``plateau sweep effects``, ``predict``, ``optimize``, ``sensitivity``, ``import``, ``plateau
fit`` and ``plateau compare``. Each is a thin layer on a function of `plateau.study`."""

import argparse
import io
import json
import math
import os
import signal
import sys
import threading
import unicodedata
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from plateau.errors import InputError, PlateauError, PlateauWarning, RunFailed, RunStopped, in_program_words
from plateau.study.output_folder import plain, put, refuse_earlier, refuse_file, relative, write

if TYPE_CHECKING:
    import pandas

    from plateau.study.data import Study

MODELS = ("main", "interactions", "full", "quadratic")
# Columns of effects.csv that come first, as ever.
EFFECTS = (
    "response term degrees_of_freedom sum_of_squares mean_square f p share variance_inflation effect coefficient standard_error t low high"
)
EFFECTS += " margin_of_error simultaneous_margin_of_error aliased_with"


class Parser(argparse.ArgumentParser):
    """A parser whose errors are those of the program, and which takes whole names of options alone."""

    def __init__(self, **options: Any) -> None:
        super().__init__(allow_abbrev=False, **options)

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
        Exit status: 0, 1 for a failed run, 2 for a wrong command line or input, 128 and its number for a signal.
    """
    # Nothing is shown in windows, and a wrong backend would keep figures from being drawn.
    os.environ["MPLBACKEND"] = "agg"
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")
    try:
        with in_program_words(), _stoppable(), warnings.catch_warnings():
            given = _parser().parse_args(arguments)
            warnings.showwarning = _quiet if given.quiet else _say
            warnings.simplefilter("ignore")
            warnings.simplefilter("always", PlateauWarning)
            _print(given.answer(given))
        return 0
    except PlateauError as error:
        print(f"plateau: {shown(str(error))}", file=sys.stderr)
        if isinstance(error, RunStopped) and error.status:
            return int(error.status)
        return 2 if isinstance(error, InputError) else 1
    except ModuleNotFoundError as error:
        print(f"plateau: {error.name} is not installed: pip install 'plateau-brake[all]'", file=sys.stderr)
        return 1
    except _Stopped as stopped:
        return 128 + int(stopped.args[0])
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        # Nobody reads on, as with `head`.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except OSError as error:
        # Such as no folder for temporary files.
        print(f"plateau: {shown(str(error))}", file=sys.stderr)
        return 1


class _Stopped(BaseException):
    """A signal, with its number, that ends the program."""


@contextmanager
def _stoppable() -> Iterator[None]:
    """Ends runs before this process where it is asked to end: otherwise they would go on alone."""

    def stop(number: int, _: Any) -> NoReturn:
        raise _Stopped(number)

    if threading.current_thread() is not threading.main_thread():
        yield
        return
    # Whoever calls with nohup wants no end.
    kept = {one: signal.getsignal(one) for one in (signal.SIGTERM, signal.SIGHUP)}
    kept = {one: handler for one, handler in kept.items() if handler is signal.SIG_DFL}
    try:
        for one in kept:
            signal.signal(one, stop)
        yield
    finally:
        for one, handler in kept.items():
            signal.signal(one, handler)


def _say(message: Warning | str, *_: Any, **__: Any) -> None:
    print(f"plateau: warning: {shown(str(message))}", file=sys.stderr)


def _quiet(*_: Any, **__: Any) -> None:
    """Says nothing."""


def _print(text: str) -> None:
    try:
        print(shown(text), end="" if text.endswith("\n") else "\n")
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        raise RunFailed(f"cannot write to standard output: {error.strerror}") from error


def shown(text: str) -> str:
    """A text that can do nothing to a terminal: control characters and those that turn the direction of letters are written out.

    Parameters
    ----------
    text : str

    Returns
    -------
    str

    Examples
    --------
    >>> shown("a\x1b[31mb\n")
    'a\\\\u{1b}[31mb\\n'
    """
    return "".join(
        f"\\u{{{ord(one):x}}}" if unicodedata.category(one) in ("Cc", "Cf", "Zl", "Zp") and one not in "\n\t" else one for one in text
    )


def _parser() -> Parser:
    called = os.environ.get("PLATEAU_CALLED", "plateau")
    parser = Parser(prog=called)
    words = parser.add_subparsers(required=True, metavar="COMMAND")
    study = words.add_parser("sweep", prog=f"{called} sweep").add_subparsers(required=True, metavar="COMMAND")

    def word(group: Any, name: str, about: str, answer: Callable[[argparse.Namespace], str]) -> Any:
        made = group.add_parser(name, help=about, description=about, prog=f"{called} {'sweep ' if group is study else ''}{name}")
        made.set_defaults(answer=answer)
        if group is study:
            made.add_argument("study", type=Path, metavar="STUDY", help="Study file (TOML)")
        return made

    def common(
        made: Any,
        *,
        output: str | None = None,
        force: str = "Replace the files of an earlier call, and remove those that this call does not write",
    ) -> None:
        if output is not None:
            made.add_argument("-o", "--output", type=Path, metavar="DIR", help=output)
        made.add_argument("--force", action="store_true", help=force)
        made.add_argument("--json", action="store_true", help="Print one JSON document instead of text")
        made.add_argument("-q", "--quiet", action="store_true", help="Say errors only: no warnings, notes, progress")
        made.add_argument("-v", "--verbose", action="store_true", help="Say also what is done to surfaces")

    def confidence(made: Any) -> None:
        made.add_argument("--confidence", type=_share, default=0.95, metavar="P", help="Confidence level of intervals [default: 0.95]")

    def several(made: Any, flag: str, what: str, about: str) -> None:
        made.add_argument(flag, action="append", default=[], metavar=what, help=about)

    def model(made: Any) -> None:
        made.add_argument("--model", choices=MODELS, help="What is fitted; unless given, what the design allows")
        made.add_argument("--terms", choices=("all", "aicc"), default="all", help="Which terms of it: all, or those that the runs support")
        confidence(made)

    def cores(made: Any) -> None:
        made.add_argument("--jobs", type=_count, metavar="N", help="Runs at a time; as many as there are cores unless given")
        made.add_argument("--workers", type=_count, default=1, metavar="N", help="Threads of each run [default: 1]")

    made = word(study, "effects", "Tell what the factors do: effects, analysis of variance, figures", _effects)
    model(made)
    common(made, output='Folder for tables, figures and the page; "effects" in the study\'s own unless given')

    made = word(study, "predict", "Tell what responses are expected to be where no run was made", _predict)
    several(made, "--at", "FACTOR=VALUE", 'Set a factor, such as load="7 N"; may be repeated')
    made.add_argument("--grid", type=_count, metavar="N", help="Predict at so many values of each range and at all levels")
    made.add_argument("--points", type=Path, metavar="FILE", help="Predict at the points of a table in CSV, a column for each factor")
    made.add_argument("--extrapolate", action="store_true", help="Predict beyond the runs of the study, too")
    made.add_argument("--confirm", action="store_true", help="Make runs there, with all seeds of the study, and compare")
    made.add_argument("-o", "--output", type=Path, metavar="FILE", help="Write the predictions as a table in CSV")
    cores(made)
    model(made)
    common(made, force="Replace that file if it exists")

    made = word(study, "optimize", "Find the settings at which responses are best", _optimize)
    for flag, example in (("maximize", "contact area=1 mm2..2 mm2"), ("minimize", "worn=0..1 mm3"), ("target", "filled=0.5..0.7..0.8")):
        several(made, f"--{flag}", "RESPONSE", f'A goal, such as "{example}"; may be repeated')
    several(made, "--limit", "RESPONSE<=VALUE", 'Keep a response below or above a value: "filled<=0.9"')
    made.add_argument(
        "--limit-on", choices=("mean", "means", "runs"), default="mean", help="What keeps the limits: the mean, its interval, that of a run"
    )
    several(made, "--hold", "FACTOR=VALUE", 'Hold a factor at a value, such as load="8 N"')
    several(made, "--importance", "RESPONSE=NUMBER", "How much a goal counts; 1 unless given")
    made.add_argument("--contour", metavar="FACTOR,FACTOR", help="Draw the desirability over two factors")
    made.add_argument("--runs", type=_count, metavar="N", help="Make so many runs on the way to the optimum, where improvement is expected")
    made.add_argument("--confirm", action="store_true", help="Make runs at the optimum, with all seeds of the study, and compare")
    cores(made)
    model(made)
    common(made, output='Folder for figures and table; "optimum" in the study\'s own unless given')

    made = word(study, "sensitivity", "Tell which part of a response's variation each factor has", _sensitivity)
    confidence(made)
    common(made, output='Folder for table and figures; "sensitivity" in the study\'s own unless given')

    made = word(study, "import", "Take in responses that were measured or computed elsewhere", _import)
    made.add_argument(
        "table", type=Path, metavar="TABLE", help="Table (CSV) with a column for each factor and for each response with imported = true"
    )
    common(made, force="Replace values that were imported before")

    made = word(words, "fit", "Find the values of keys with which runs give what was measured", _fit)
    made.add_argument("study", type=Path, metavar="STUDY", help="Study file (TOML) with measured values in its responses")
    made.add_argument("--plan", action="store_true", help="Say what is fitted to what and what it will cost, without running any")
    made.add_argument("--retry", action="store_true", help="Make runs again that failed before")
    cores(made)
    common(made, output='Folder for tables and figures; "fit" in the study\'s own unless given')

    made = word(words, "compare", "Tell what differs between scenes, and how sure that is: runs of each with the same seeds", _compare)
    made.add_argument("scenes", type=Path, nargs="+", metavar="SCENE", help="Scene files (TOML), two or more; the first is the reference")
    made.add_argument("--seeds", type=_count, default=5, metavar="N", help="Sets of seeds with which each scene is run [default: 5]")
    several(made, "--set", "KEY=VALUE", "Change a key of all scenes; may be repeated")
    several(made, "--response", "DATASET", "A response besides those of all runs")
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


# Answers ---------------------------------------------------------------------------------------------------------------------------


def _told(given: argparse.Namespace, found: Any, folder: Path, files: list[str], title: str = "") -> str:
    """A document, or a text with the files, under a heading where the text does not end with one."""
    if given.json:
        return _json({**found.document(), "files": files})
    figures = sum(file.endswith(".png") for file in files)
    lines = [file for file in files if not file.endswith((".png", ".svg", ".pdf"))]
    lines += [f"{figures} figure{'s' if figures > 1 else ''} as PNG, SVG and PDF in {folder}"] if figures else []
    heading = [f"\n{title}"] if title else []
    return "\n".join([found.text().rstrip("\n"), *heading, *(f"  written  {line}" for line in lines), ""])


def _json(document: Mapping[str, Any]) -> str:
    return json.dumps(plain(document), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def csv_of(table: "pandas.DataFrame") -> bytes:
    """A table in CSV with all digits, empty where there is no number, and nothing in it that a spreadsheet would compute."""
    from plateau.study.text_tables import written_table

    def cell(value: Any) -> str:
        if isinstance(value, list | tuple):
            return "; ".join(map(str, value))
        value = plain(value)
        return "" if value is None else str(value).lower() if isinstance(value, bool) else str(value)

    return written_table(
        [list(map(str, table.columns)), *([cell(value) for value in row] for row in table.itertuples(index=False, name=None))]
    )


def _opened(given: argparse.Namespace, name: str, of: str | None = None) -> tuple["Study", Path, str | None]:
    """The study, the folder of the answer, and what its files are of; refuses a folder that is taken before any work is done."""
    from plateau.study.results import analysed

    study = analysed(given.study)
    folder = study.directory / name if given.output is None else given.output
    said = None if of is None else f"{of} {relative(given.study, folder)}"
    refuse_earlier(folder, said, given.force)
    return study, folder, said


def _inputs(study: "Study", *others: Path | None) -> tuple[Path, ...]:
    """Files that are never replaced: the study and what it names."""
    from plateau.study.kept_values import file_of

    here = Path(study.path or ".").parent
    tables = [study.document, *study.document.get("response", [])]
    named = [here / table[key] for table in tables for key in ("base", "file", "measured_file") if isinstance(table.get(key), str)]
    return tuple(path for path in (study.path, *named, file_of(study), *others) if path is not None)


def _options(given: argparse.Namespace, *names: str) -> dict[str, Any]:
    return {name: getattr(given, name) for name in names}


def _progress(given: argparse.Namespace) -> bool | None:
    """Whether progress is shown: not where nothing is to be said, else in terminals."""
    return False if given.quiet else None


def _effects(given: argparse.Namespace) -> str:
    from plateau.study.analysis import effects
    from plateau.study.figures import saved
    from plateau.study.page import effects_page

    study, folder, _ = _opened(given, "effects")
    found = effects(study, **_options(given, "model", "terms", "confidence"))
    figures, table = found.figures(), found.table
    drawn = saved(figures)
    columns = [*EFFECTS.split(), *(name for name in table if name not in EFFECTS.split() and name != "factors")]
    files = {"effects.csv": csv_of(table.reindex(columns=columns)), "residuals.csv": csv_of(found.residuals)}
    files |= {"effects.html": effects_page(found, figures, drawn).encode(), **drawn}
    return _told(given, found, folder, write(folder, files, force=given.force, inputs=_inputs(study)), study.title)


def _predict(given: argparse.Namespace) -> str:
    from plateau.study.prediction import predict
    from plateau.study.results import analysed

    study = analysed(given.study)
    inputs = _inputs(study, given.points)
    if given.output is not None:
        refuse_file(given.output, given.force, inputs)
    asked = _options(given, "at", "grid", "points", "extrapolate", "confirm", "model", "terms", "confidence", "jobs", "workers")
    found = predict(study, **asked)
    if given.output is not None:
        refuse_file(given.output, given.force, inputs)
        put(given.output, csv_of(found.wide))
    if given.json:
        return _json(found.document())
    count = len(found.places)
    return f"{study.title}\n  predicted at {count} places, written {given.output}\n" if given.output and count > 1 else found.text()


def _optimize(given: argparse.Namespace) -> str:
    from plateau.study.figures import saved
    from plateau.study.optimum import optimize

    study, folder, _ = _opened(given, "optimum")
    asked = _options(given, "maximize", "minimize", "target", "limit", "limit_on", "hold", "importance", "model", "terms", "confidence")
    found = optimize(study, **asked, runs=given.runs or 0, **_options(given, "confirm", "jobs", "workers"), progress=_progress(given))
    settings = found.settings.set_index("factor")["text"].rename(str.strip)
    files = {"optimum.csv": csv_of(found.table.assign(**settings)), **saved(found.figures(given.contour))}
    said = _told(given, found, folder, write(folder, files, force=given.force, inputs=_inputs(study)))
    if found.keeps_limits:
        return said
    _print(said)
    raise RunFailed("no settings within the ranges keep all limits")


def _sensitivity(given: argparse.Namespace) -> str:
    from plateau.study.figures import saved
    from plateau.study.variance_parts import sensitivity

    study, folder, _ = _opened(given, "sensitivity")
    found = sensitivity(study, confidence=given.confidence)
    files = {"sensitivity.csv": csv_of(found.table), **saved(found.figures())}
    return _told(given, found, folder, write(folder, files, force=given.force, inputs=_inputs(study)), study.title)


def _import(given: argparse.Namespace) -> str:
    from plateau.study.measured import import_values

    found = import_values(given.study, given.table, force=given.force)
    return _json(found.document()) if given.json else found.text()


def _fit(given: argparse.Namespace) -> str:
    from plateau.study.calibration import fit, plan
    from plateau.study.figures import saved

    if given.plan:
        planned = plan(given.study)
        return _json(planned.document()) if given.json else planned.text()
    study, folder, of = _opened(given, "fit", "fit")
    found = fit(study, **_options(given, "jobs", "workers", "retry"), progress=_progress(given))
    files = {**{name: csv_of(table) for name, table in found.tables.items()}, **saved(found.figures())}
    return _told(given, found, folder, write(folder, files, of=of, force=given.force, inputs=_inputs(study)))


def _compare(given: argparse.Namespace) -> str:
    from plateau.study.figures import saved
    from plateau.study.page import comparison_page
    from plateau.study.scene_comparison import compare

    folder = given.output or Path("comparison")
    of = "compare " + ", ".join(relative(scene, folder) for scene in given.scenes)
    refuse_earlier(folder, of, given.force)
    asked = _options(given, "set", "confidence", "jobs", "workers")
    found = compare(given.scenes, given.seeds, responses=given.response, output=folder, **asked, progress=_progress(given))
    figures = found.figures()
    drawn = saved(figures)
    files = {"comparison.html": comparison_page(found, figures, drawn).encode(), "comparison.csv": csv_of(found.table)}
    files |= {"means.csv": csv_of(found.means), "runs.csv": csv_of(found.runs), "curves.csv": csv_of(found.curves), **drawn}
    return _told(given, found, folder, write(folder, files, of=of, force=given.force, inputs=tuple(given.scenes)))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
