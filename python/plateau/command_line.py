"""The words that the package answers for the program, such as ``plateau sweep effects`` and ``plateau plot``: each is a thin layer on a
function."""

import argparse
import importlib
import io
import json
import math
import os
import signal
import sys
import threading
import traceback
import unicodedata
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, NoReturn

from plateau.errors import InputError, PlateauError, PlateauNote, PlateauWarning, RunFailed, RunStopped, in_program_words, not_installed

# Words, and the modules that add them to a parser.
OF_STUDIES, OF_RUNS, OF_PROGRAM = "plateau.study.words", "plateau.run_words", "plateau.figure_words"
WORDS = {"sweep": OF_STUDIES, "fit": OF_STUDIES, "compare": OF_STUDIES, "plot": OF_RUNS, "report": OF_RUNS, "export": OF_RUNS}
# By a word of its own the program asks for figures.
WORDS |= {"figure": OF_PROGRAM, "surface": "plateau.surface_words", "cycle": "plateau.cycle_words"}


class Parser(argparse.ArgumentParser):
    """A parser whose errors are those of the program, and which takes whole names of options alone."""

    def __init__(self, **options: Any) -> None:
        super().__init__(allow_abbrev=False, **options)

    def parse_known_args(self, *args: Any, **options: Any) -> Any:
        given, unknown = super().parse_known_args(*args, **options)
        # Of a word these would be told by the parser of all words, which does not know its options.
        if unknown:
            self.error(f"unrecognized arguments: {' '.join(unknown)}")
        return given, unknown

    def error(self, message: str) -> NoReturn:
        raise InputError(f"{message}; {self.prog} --help tells more")


def main(arguments: Sequence[str]) -> int:
    """Answers a word; gives the exit status: 0, 1 for a failed run, 2 for wrong input, 128 and its number for a signal."""
    # Nothing is shown in windows, and a wrong backend would keep figures from being drawn.
    os.environ["MPLBACKEND"] = "agg"
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")
    try:
        with in_program_words(), _stoppable() as check, warnings.catch_warnings():
            given = _parser(arguments[:1]).parse_args(arguments)
            warnings.showwarning = _quiet if given.quiet else _say
            warnings.simplefilter("ignore")
            warnings.simplefilter("always", PlateauWarning)
            answer = given.answer(given)
            check()
            show(answer)
        return 0
    except PlateauError as error:
        print(f"plateau: {shown(in_words(str(error)))}", file=sys.stderr)
        if isinstance(error, RunStopped) and error.status:
            return int(error.status)
        return 2 if isinstance(error, InputError) else 1
    except ModuleNotFoundError as error:
        print(f"plateau: {not_installed(error.name)}", file=sys.stderr)
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
    except Exception as error:
        # Of a file that other programs have changed no more may be known.
        if "-v" in arguments or "--verbose" in arguments:
            traceback.print_exc()
        said = shown(f"{type(error).__name__}: {error}".splitlines()[0])
        print(f"plateau: {said}; plateau verify tells whether a run file is as it was written, -v where this happened", file=sys.stderr)
        return 1


class _Stopped(BaseException):
    """A signal, with its number, that ends the program."""


@contextmanager
def _stoppable() -> Iterator[Callable[[], None]]:
    """Ends runs before this process where it is asked to end: otherwise they would go on alone. Gives a check of what was asked."""
    asked: list[int] = []

    def stop(number: int, _: Any) -> NoReturn:
        asked.append(number)
        raise KeyboardInterrupt if number == signal.SIGINT else _Stopped(number)

    def check() -> None:
        # Python goes on after an exception where objects are destroyed.
        if asked:
            raise _Stopped(asked[0])

    if threading.current_thread() is not threading.main_thread():
        yield check
        return
    # Whoever calls with nohup, or in the background, wants no end.
    kept = {one: signal.getsignal(one) for one in (signal.SIGTERM, signal.SIGHUP, signal.SIGINT)}
    kept = {one: handler for one, handler in kept.items() if handler in (signal.SIG_DFL, signal.default_int_handler)}
    try:
        for one in kept:
            signal.signal(one, stop)
        yield check
    finally:
        for one, handler in kept.items():
            signal.signal(one, handler)


def in_words(message: str) -> str:
    """A message of the package in words of the command line."""
    return message.replace("plateau.run(scene) makes", "plateau run SCENE makes").replace("plateau.open_study opens", "plateau sweep effects reads")


def _say(message: Warning | str, *_: Any, **__: Any) -> None:
    print(f"plateau: {'' if isinstance(message, PlateauNote) else 'warning: '}{shown(str(message))}", file=sys.stderr)


def _quiet(*_: Any, **__: Any) -> None:
    """Says nothing."""


def show(text: str) -> None:
    """Prints a text, in which nothing obeys a terminal."""
    try:
        print(shown(text), end="" if text.endswith("\n") else "\n")
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        raise RunFailed(f"cannot write to standard output: {error.strerror}") from error


def shown(text: str) -> str:
    r"""A text that can do nothing to a terminal: control characters and those that turn the direction of letters are written out.

    Examples
    --------
    >>> shown("a\x1b[31mb\n")
    'a\\u{1b}[31mb\n'
    """
    return "".join(f"\\u{{{ord(one):x}}}" if unicodedata.category(one) in ("Cc", "Cf", "Zl", "Zp") and one not in "\n\t" else one for one in text)


class Words:
    """Adds words to a parser, with the options that several of them have."""

    def __init__(self, group: Any, called: str) -> None:
        self._group, self._called = group, called

    def word(self, name: str, about: str, answer: Callable[[argparse.Namespace], str], example: str = "") -> Any:
        """Adds a word."""
        made = self._group.add_parser(
            name,
            help=about,
            description=about,
            prog=f"{self._called} {name}",
            epilog=f"Example:\n{example}" if example else None,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        made.set_defaults(answer=answer)
        return made

    def within(self, name: str) -> "Words":
        """Adds a word that has words of its own."""
        called = f"{self._called} {name}"
        return Words(self._group.add_parser(name, prog=called).add_subparsers(required=True, metavar="COMMAND"), called)


def of_all(made: Any, force: str) -> None:
    """Adds the options of all words."""
    made.add_argument("--force", action="store_true", help=force)
    made.add_argument("-q", "--quiet", action="store_true", help="Say errors only: no warnings, notes, progress")
    made.add_argument("-v", "--verbose", action="store_true", help="Say also what is done to surfaces")


def several(made: Any, flag: str, what: str, about: str, **options: Any) -> None:
    """Adds an option that may be repeated."""
    made.add_argument(flag, action="append", default=[], metavar=what, help=about, **options)


def _parser(first: Sequence[str]) -> Parser:
    called = os.environ.get("PLATEAU_CALLED", "plateau")
    parser = Parser(prog=called)
    words = Words(parser.add_subparsers(required=True, metavar="COMMAND"), called)
    # Only what answers is imported.
    for module in dict.fromkeys(WORDS[word] for word in first if word in WORDS) or dict.fromkeys(WORDS.values()):
        importlib.import_module(module).add(words)
    return parser


def count(text: str) -> int:
    """A whole number of at least 1."""
    number = int(text) if text.isdigit() else 0
    if number < 1:
        raise argparse.ArgumentTypeError(f"{text!r}, expected a whole number of at least 1")
    return number


def share(text: str) -> float:
    """A number between 0 and 1."""
    try:
        found = float(text)
    except ValueError:
        found = math.nan
    if not 0.0 < found < 1.0:
        raise argparse.ArgumentTypeError(f"{text!r}, expected more than 0 and less than 1, such as 0.95")
    return found


def json_of(document: Mapping[str, Any]) -> str:
    """A document in JSON."""
    # Not above: without NumPy this module is there to say so.
    from plateau.output_folder import plain

    return json.dumps(plain(document), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def options(given: argparse.Namespace, *names: str) -> dict[str, Any]:
    """Values of some of the arguments, by name."""
    return {name: getattr(given, name) for name in names}


def progress(given: argparse.Namespace) -> bool | None:
    """Value of ``progress`` for a call: False with ``--quiet``, else None, which shows it in terminals."""
    return False if given.quiet else None


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
