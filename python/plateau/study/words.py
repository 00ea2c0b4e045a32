"""The words of studies: ``plateau sweep effects``, ``predict``, ``optimize``, ``sensitivity``, ``import``, ``plateau fit`` and ``plateau
compare``. Each is a thin layer on a function of `plateau.study`."""

import argparse
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pandas

from plateau import study as studies
from plateau.command_line import Words, count, json_of, of_all, options, progress, several, share, show
from plateau.errors import RunFailed
from plateau.output_folder import plain, put, refuse_earlier, refuse_file, relative, write
from plateau.study.data import Study
from plateau.study.kept_values import file_of
from plateau.study.results import analysed
from plateau.style import saved
from plateau.text_tables import written_table

EARLIER = "Replace the files of an earlier call, and remove those that this call does not write"
OTHER = "Replace the files of another call, too, not only those of the same one, and remove those that this call does not write"
# Options of several words.
SHARED: dict[str, dict[str, Any]] = {
    "--jobs": {"type": count, "metavar": "N", "help": "Runs at a time; as many as there are cores unless given"},
    "--workers": {"type": count, "default": 1, "metavar": "N", "help": "Threads of each run [default: 1]"},
    "--model": {"choices": ("main", "interactions", "full", "quadratic"), "help": "What is fitted; unless given, what the design allows"},
    "--confidence": {"type": share, "default": 0.95, "metavar": "P", "help": "Confidence level of intervals [default: 0.95]"},
}
CORES, MODEL = ("--jobs", "--workers"), ("--model", "--confidence")


def add(words: Words) -> None:
    """Adds the words of studies to a parser."""
    study = words.within("sweep")

    def word(group: Words, name: str, about: str, answer: Callable[[argparse.Namespace], str], example: str) -> Any:
        made = group.word(name, about, answer, f"  plateau {'sweep ' if group is study else ''}{name} {example}")
        if name != "compare":
            what = " with measured values in its responses" if name == "fit" else ""
            made.add_argument("study", type=Path, metavar="STUDY", help=f"Study file (TOML){what}")
            made.add_argument("--directory", type=Path, metavar="DIR", help="Folder of the results; overrides `directory` of the study")
        return made

    def shared(made: Any, *flags: str, output: str | None = None, force: str = EARLIER) -> None:
        for flag in flags:
            made.add_argument(flag, **SHARED[flag])
        if output is not None:
            made.add_argument("-o", "--output", type=Path, metavar="DIR", help=output)
        made.add_argument("--json", action="store_true", help="Print one JSON document instead of text")
        of_all(made, force)

    made = word(study, "effects", "Tell what the factors do: effects, analysis of variance, figures", _effects, "data/studies/published/factors.toml")
    shared(made, *MODEL, output='Folder for tables, figures and the page; "effects" in the study\'s own unless given')

    made = word(
        study, "predict", "Tell what responses are expected to be where no run was made", _predict, 'data/studies/answer.toml --at load="7 N"'
    )
    several(made, "--at", "FACTOR=VALUE", 'Set a factor, such as load="7 N"; may be repeated')
    made.add_argument("--grid", type=count, metavar="N", help="Predict at so many values of each range and at all levels")
    made.add_argument("--points", type=Path, metavar="FILE", help="Predict at the points of a table in CSV, a column for each factor")
    made.add_argument("--extrapolate", action="store_true", help="Predict beyond the runs of the study, too")
    made.add_argument("--confirm", action="store_true", help="Make runs there, with all seeds of the study, and compare")
    made.add_argument("-o", "--output", type=Path, metavar="FILE", help="Write the predictions as a table in CSV")
    shared(made, *CORES, *MODEL, force="Replace that file if it exists")

    made = word(
        study, "optimize", "Find the settings at which responses are best", _optimize, 'data/studies/answer.toml --minimize "worn off the pin"'
    )
    for flag, example in (("maximize", "contact area=1 mm2..2 mm2"), ("minimize", "worn=0..1 mm3"), ("target", "filled=0.5..0.7..0.8")):
        several(made, f"--{flag}", "RESPONSE", f'A goal, such as "{example}"; may be repeated')
    several(made, "--limit", "RESPONSE<=VALUE", 'Keep a response below or above a value: "filled<=0.9"')
    about = "What keeps the limits: the mean, its interval, that of a run"
    made.add_argument("--limit-on", choices=("mean", "means", "runs"), default="mean", help=about)
    several(made, "--hold", "FACTOR=VALUE", 'Hold a factor at a value, such as load="8 N"')
    several(made, "--importance", "RESPONSE=NUMBER", "How much a goal counts; 1 unless given")
    made.add_argument("--contour", metavar="FACTOR,FACTOR", help="Draw the desirability over two factors")
    made.add_argument(
        "--runs",
        type=count,
        metavar="N",
        help="Make so many runs on the way to the optimum, where improvement is expected, between levels of numbers, too",
    )
    made.add_argument("--confirm", action="store_true", help="Make runs at the optimum, with all seeds of the study, and compare")
    shared(made, *CORES, *MODEL, output='Folder for figures and table; "optimum" in the study\'s own unless given')

    made = word(study, "sensitivity", "Tell which part of a response's variation each factor has", _sensitivity, "data/studies/answer.toml")
    shared(made, "--confidence", output='Folder for table and figures; "sensitivity" in the study\'s own unless given')

    made = word(study, "import", "Take in responses that were measured or computed elsewhere", _import, "study.toml measured.csv")
    about = "Table (CSV) with a column for each factor and for each response with imported = true"
    made.add_argument("table", type=Path, metavar="TABLE", help=about)
    shared(made, force="Replace values that were imported before")

    made = word(
        words, "fit", "Find the values of keys with which runs give what was measured", _fit, "data/studies/fit-captured-fraction.toml --plan"
    )
    made.add_argument("--plan", action="store_true", help="Say what is fitted to what and what it will cost, without running any")
    made.add_argument("--retry", action="store_true", help="Make runs again that failed before")
    shared(made, *CORES, output='Folder for tables and figures; "fit" in the study\'s own unless given', force=OTHER)

    made = word(
        words,
        "compare",
        "Tell what differs between scenes, and how sure that is: runs of each with the same seeds",
        _compare,
        "data/scenes/quick.toml data/scenes/stops.toml --seeds 3",
    )
    made.add_argument("scenes", type=Path, nargs="+", metavar="SCENE", help="Scene files (TOML), two or more; the first is the reference")
    made.add_argument("--seeds", type=count, default=5, metavar="N", help="Sets of seeds with which each scene is run [default: 5]")
    several(made, "--set", "KEY=VALUE", "Change a key of all scenes; may be repeated")
    about = 'What is compared in place of what usually matters, such as mean_pressure, worn_pin:end or "contact_area:reaches 0.8"; without a '
    about += "question the mean over the last tenth of the run, of totals and of filled_fraction the end; may be repeated"
    several(made, "--response", "DATASET[:QUESTION]", about)
    shared(made, *CORES, "--confidence", output='Folder for runs, tables, figures and the page; "comparison" unless given', force=OTHER)


def _told(
    given: argparse.Namespace, found: Any, folder: Path, content: Mapping[str, Any], inputs: tuple[Path, ...], title: str = "", of: str | None = None
) -> str:
    """Writes tables, pages and drawings; gives a document, or a text with the files, under a heading where the text does not end with one."""
    encoded = {name: one if isinstance(one, bytes) else one.encode() if isinstance(one, str) else csv_of(one) for name, one in content.items()}
    files = write(folder, encoded, of=of, force=given.force, inputs=inputs)
    if given.json:
        return json_of({**found.document(), "files": files})
    figures = sum(file.endswith(".png") for file in files)
    lines = [file for file in files if not file.endswith((".png", ".svg", ".pdf"))]
    lines += [f"{figures} figure{'s' if figures > 1 else ''} as PNG, SVG and PDF in {folder}"] if figures else []
    heading = [f"\n{title}"] if title else []
    return "\n".join([found.text().rstrip("\n"), *heading, *(f"  written  {line}" for line in lines), ""])


def csv_of(table: pandas.DataFrame) -> bytes:
    """A table in CSV with all digits, empty where there is no number, and nothing in it that a spreadsheet would compute."""

    def cell(value: Any) -> str:
        if isinstance(value, list | tuple):
            return "; ".join(map(str, value))
        value = plain(value)
        return "" if value is None else str(value).lower() if isinstance(value, bool) else str(value)

    return written_table([list(map(str, table)), *(list(map(cell, row)) for row in table.itertuples(index=False, name=None))])


def _opened(
    given: argparse.Namespace, name: str, of: str | None = None, check: Callable[[argparse.Namespace, Study], object] = lambda *_: None
) -> tuple[Study, Path, str | None]:
    """The study, the folder of the answer, and what its files are of; what `check` refuses, or a folder that is taken, before any work is done."""
    study = analysed(given.study, given.directory)
    check(given, study)
    folder = study.directory / name if given.output is None else given.output
    said = None if of is None else f"{of} {relative(given.study, folder)}"
    refuse_earlier(folder, said, given.force)
    return study, folder, said


def _inputs(study: Study, *others: Path | None) -> tuple[Path, ...]:
    """Files that are never replaced: the study and what it names."""
    here = Path(study.path or ".").parent
    tables = [study.document, *study.document.get("response", [])]
    named = [here / table[key] for table in tables for key in ("base", "file", "measured_file") if isinstance(table.get(key), str)]
    return tuple(path for path in (study.path, *named, file_of(study), *others) if path is not None)


def _effects(given: argparse.Namespace) -> str:
    study, folder, _ = _opened(given, "effects")
    found = studies.effects(study, **options(given, "model", "confidence"))
    drawn = saved(figures := found.figures(), progress=progress(given))
    tables = {"effects.csv": found.table.drop(columns="factors"), "residuals.csv": found.residuals}
    return _told(given, found, folder, {**tables, "effects.html": found.page(figures, drawn), **drawn}, _inputs(study), study.title)


def _predict(given: argparse.Namespace) -> str:
    study = analysed(given.study, given.directory)
    inputs = _inputs(study, given.points)
    if given.output is not None:
        refuse_file(given.output, given.force, inputs)
    asked = options(given, "at", "grid", "points", "extrapolate", "confirm", "model", "confidence", "jobs", "workers")
    found = studies.predict(study, **asked, progress=progress(given))
    if given.output is not None:
        refuse_file(given.output, given.force, inputs)
        put(given.output, csv_of(found.wide))
    if given.json:
        return json_of(found.document())
    count = len(found.places)
    return f"{study.title}\n  predicted at {count} places, written {given.output}\n" if given.output and count > 1 else found.text()


def _optimize(given: argparse.Namespace) -> str:
    study, folder, _ = _opened(given, "optimum", check=_goals)
    asked = options(given, "maximize", "minimize", "target", "limit", "limit_on", "hold", "importance", "model", "confidence")
    found = studies.optimize(study, **asked, runs=given.runs or 0, **options(given, "confirm", "jobs", "workers"), progress=progress(given))
    table = found.table.assign(**found.settings.set_index("factor")["text"].rename(str.strip))
    said = _told(given, found, folder, {"optimum.csv": table, **saved(found.figures(given.contour), progress=progress(given))}, _inputs(study))
    if found.keeps_limits:
        return said
    show(said)
    raise RunFailed("no settings within the ranges keep all limits")


def _goals(given: argparse.Namespace, study: Study) -> object:
    """Refuses goals and limits that cannot be."""
    from plateau.study.analysis import usable
    from plateau.study.goals import wanted

    with warnings.catch_warnings(action="ignore"):
        # They are given when they are sought.
        usable(study)
    aims = {aim: getattr(given, aim) or () for aim in ("maximize", "minimize", "target")}
    return wanted(study, aims, given.limit or (), given.limit_on, given.importance or ())


def _sensitivity(given: argparse.Namespace) -> str:
    study, folder, _ = _opened(given, "sensitivity")
    found = studies.sensitivity(study, confidence=given.confidence)
    return _told(
        given, found, folder, {"sensitivity.csv": found.table, **saved(found.figures(), progress=progress(given))}, _inputs(study), study.title
    )


def _import(given: argparse.Namespace) -> str:
    found = studies.import_values(analysed(given.study, given.directory), given.table, force=given.force)
    return json_of(found.document()) if given.json else found.text()


def _fit(given: argparse.Namespace) -> str:
    from plateau.study.fit_of_study import plan

    if given.plan:
        planned = plan(analysed(given.study, given.directory))
        return json_of(planned.document()) if given.json else planned.text()
    study, folder, of = _opened(given, "fit", "fit")
    found = studies.fit(study, **options(given, "jobs", "workers", "retry"), progress=progress(given))
    return _told(given, found, folder, {**found.tables, **saved(found.figures(), progress=progress(given))}, _inputs(study), of=of)


def _compare(given: argparse.Namespace) -> str:
    folder = given.output or Path("comparison")
    # Of other responses figures would be removed; more seeds only make an answer surer.
    of = ", ".join([*(relative(scene, folder) for scene in given.scenes), *given.set, *given.response])
    of = f"compare {of}".replace("\n", "\\n")
    refuse_earlier(folder, of, given.force)
    asked = options(given, "set", "confidence", "jobs", "workers")
    found = studies.compare(given.scenes, given.seeds, responses=given.response, output=folder, **asked, progress=progress(given))
    drawn = saved(figures := found.figures(), progress=progress(given))
    tables = {"comparison.csv": found.table, "means.csv": found.means, "runs.csv": found.runs, "curves.csv": found.curves}
    return _told(given, found, folder, {"comparison.html": found.page(figures, drawn), **tables, **drawn}, tuple(given.scenes), of=of)
